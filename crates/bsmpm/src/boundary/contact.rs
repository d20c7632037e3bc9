//! Frictional contact at nodes on the faces of the grid, theory-manual equations (T7.1) to (T7.4).
//! [`solve::contact`](crate::solve::contact) corrects the contact statuses (open, stick, slip).

mod gap;
mod neutral;
mod node;

use super::coulomb::{ContactReport, Status, ratio};
use super::{Boundary, Support};
use crate::exact::Exact;
use crate::grid::Grid;
use crate::model::Model;
use crate::nodal::Nodal;
use crate::parallel::{Halo, LinearSolver};
use crate::points::MappedPoints;
use crate::tensor::Vector;
pub(super) use gap::face_cell;
use gap::{ROUNDING, gaps};
use node::ContactNode;

/// Steps ahead of the meeting from which on material is near the face: it may be faster or slower than it starts.
const MEETING: f64 = 2.0;

/// All nodes on faces with contact in one step: the same on every rank that shares a node.
#[derive(Clone, Debug, Default)]
pub struct Contacts<const D: usize> {
    nodes: Vec<ContactNode<D>>,
    released: Vec<bool>, // of nodes that have come to slide in the last correction
    /// N m  first energy of the step's iteration, by which those that follow with other statuses are judged
    pub first_energy: Option<f64>,
}

impl<const D: usize> Contacts<D> {
    /// Of the `boundary` in a step from `t`: of nodes with components that are `free`, in the statuses that the last
    /// displacement had, `guess`, if there is one; `water_force` is what pore water carries of the normal forces, N.
    /// One exchange with the neighbours a face that lifts.
    pub fn of<K>(
        model: &Model<K, D>,
        mapped: MappedPoints<'_, D>,
        free: &[bool],
        t: f64,
        guess: &[f64],
        water_force: Option<&[f64]>,
        halo: &dyn Halo,
    ) -> Self {
        let Model { boundary, grid, .. } = model;
        let mut nodes = Vec::new();
        for (support, face) in boundary.supports.iter().enumerate() {
            let Some(law) = face.contact else { continue };
            let gaps = law
                .lifts
                .then(|| gaps(boundary, grid, mapped, face.axis, face.upper, halo));
            for node in grid.face_nodes(face.axis, face.upper) {
                if !free[Nodal::<D>::at(node, face.axis)] {
                    continue;
                }
                let along = std::array::from_fn(|component| {
                    component != face.axis
                        && free[Nodal::<D>::at(node, component)]
                        && !is_decided_beside(boundary, grid, face, node, component)
                });
                let inward = if face.upper { -1.0 } else { 1.0 };
                let gap = gaps.as_ref().map_or(0.0, |gaps| gaps[node]);
                let mut at = ContactNode {
                    node,
                    support,
                    axis: face.axis,
                    inward,
                    law,
                    along,
                    gap,
                    water_force: water_force.map_or(0.0, |force| force[Nodal::<D>::at(node, face.axis)]),
                    status: Status::Open,
                    is_neutral: false,
                    rested: [false; D],
                    transverse_stiffness: 0.0,
                    slip_length: 0.0,
                };
                let had_material = had_material(grid, face, node, guess);
                at.predict_status(t, guess, face_cell(grid, face.axis, face.upper), had_material);
                nodes.push(at);
            }
        }
        let released = vec![false; nodes.len()];
        Self {
            nodes,
            released,
            first_energy: None,
        }
    }

    /// Whether there is no such node on this rank.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The components that are `free`, and those that the statuses decide.
    pub fn movable(&self, free: &[bool]) -> Vec<bool> {
        let mut movable = free.to_vec();
        for at in &self.nodes {
            for component in (0..D).filter(|&component| at.decides(component)) {
                movable[Nodal::<D>::at(at.node, component)] = true;
            }
        }
        movable
    }

    /// Marks what is an unknown, and prescribes what is not (m), as the statuses say.
    pub fn apply(&self, free: &mut [bool], prescribed: &mut [Option<f64>]) {
        for at in &self.nodes {
            for (component, held) in at.holds().into_iter().enumerate().filter(|(c, _)| at.decides(*c)) {
                let place = Nodal::<D>::at(at.node, component);
                (free[place], prescribed[place]) = (held.is_none(), held);
            }
        }
    }

    /// Adds to the velocities (m/s) that are prescribed those of components that have been at rest on a face and stay
    /// there as far as is known: what they start the step with, as components that supports hold.
    pub fn rest(&self, velocities: &mut [Option<f64>]) {
        for at in &self.nodes {
            for component in (0..D).filter(|&component| at.rested[component]) {
                velocities[Nodal::<D>::at(at.node, component)] = Some(0.0);
            }
        }
    }

    /// Marks components that the face may stop in a step of `dt` (s) in which the nodes start with `v`, m/s: those on
    /// or near it that have not been at rest.
    pub fn moving(&self, v: &[f64], dt: f64) -> Vec<bool> {
        let mut moving = if self.is_empty() {
            Vec::new()
        } else {
            vec![false; v.len()]
        };
        for at in &self.nodes {
            let near = at.gap <= MEETING * dt * v[Nodal::<D>::at(at.node, at.axis)].abs();
            for component in (0..D).filter(|&component| near && at.decides(component) && !at.rested[component]) {
                moving[Nodal::<D>::at(at.node, component)] = true;
            }
        }
        moving
    }

    /// Adds friction under the displacement `u` (m), N, to what is out of balance and to the `reaction`, which has the
    /// normal forces.
    pub fn add_friction(&self, u: &[f64], f_oob: &mut [f64], reaction: &mut [f64]) {
        for at in &self.nodes {
            let Status::Slip(direction) = at.status else { continue };
            let limit = at.limit(reaction);
            let friction = at.friction_force(&direction, &at.slip(u), limit);
            for component in (0..D).filter(|&component| at.along[component] && limit > 0.0) {
                f_oob[Nodal::<D>::at(at.node, component)] += friction[component];
                reaction[Nodal::<D>::at(at.node, component)] = friction[component];
            }
        }
    }

    /// Adds what friction adds to the product of the derivative of the forces with `v` (m), which `out` holds at all
    /// components, where `reaction` acts.
    pub fn add_derivative(&self, reaction: &[f64], v: &[f64], out: &mut [f64]) {
        for at in &self.nodes {
            let Status::Slip(direction) = at.status else { continue };
            let acts = at.limit(reaction) > 0.0;
            let factor = if acts { at.law.friction * at.inward } else { 0.0 };
            let normal = out[Nodal::<D>::at(at.node, at.axis)];
            let beside = if acts {
                at.friction_force(&direction, &at.slip(v), 0.0)
            } else {
                Vector::zeros()
            };
            for component in (0..D).filter(|&component| at.along[component]) {
                out[Nodal::<D>::at(at.node, component)] += factor * direction[component] * normal - beside[component];
            }
        }
    }

    /// Adds what resists slips beside the directions of friction to the stiffness.
    pub fn assemble(&self, solver: &mut dyn LinearSolver, halo: &dyn Halo) {
        let owned = halo.owned();
        for at in self.nodes.iter().filter(|at| owned.contains(at.node)) {
            if let Some(block) = at.resists() {
                solver.add_block_among(&[at.node], &block);
            }
        }
    }

    /// Corrects every status that the displacement `u` (m) and the `reaction` (N) under it contradict by more than
    /// `force`, N; how many there were over all ranks.
    pub fn correct(&mut self, u: &[f64], reaction: &[f64], force: f64, edge: f64, halo: &dyn Halo) -> usize {
        let owned = halo.owned();
        let mut corrected = [0.0];
        for (at, released) in self.nodes.iter_mut().zip(&mut self.released) {
            let asked = at.corrected(u, reaction, force, ROUNDING * edge);
            *released = at.status == Status::Stick && asked.status != Status::Stick;
            let is_new = at.transverse_stiffness == 0.0 && asked.transverse_stiffness > 0.0;
            let is_corrected = asked.status != at.status || is_new;
            corrected[0] += f64::from(u8::from(is_corrected && owned.contains(at.node)));
            (at.status, at.transverse_stiffness, at.slip_length) =
                (asked.status, asked.transverse_stiffness, asked.slip_length);
        }
        halo.all_reduce_sum(&mut corrected);
        corrected[0] as usize
    }

    /// J  work of the faces' forces on this rank: of the normal ones that of the blows by which gaps close, as a face
    /// at rest works nothing; and that of friction.
    pub fn work(&self, u: &[f64], reaction: &[f64], halo: &dyn Halo) -> [Exact; 2] {
        let owned = halo.owned();
        let mut work = [Exact::ZERO; 2];
        for at in self
            .nodes
            .iter()
            .filter(|at| at.status != Status::Open && owned.contains(at.node))
        {
            let normal = Nodal::<D>::at(at.node, at.axis);
            work[0].add(reaction[normal] * u[normal]);
            work[1].add(0.5 * at.friction(reaction).dot(&at.slip(u)));
        }
        work
    }

    /// What every face with contact did under the converged displacement `u`, m, with the `reaction`, N.
    pub fn report(&self, boundary: &Boundary<D>, u: &[f64], reaction: &[f64], halo: &dyn Halo) -> Vec<ContactReport> {
        let owned = halo.owned();
        let mut reports = Vec::new();
        for (support, _) in boundary
            .supports
            .iter()
            .enumerate()
            .filter(|(_, support)| support.contact.is_some())
        {
            let mut sums: [Exact; 6] = std::array::from_fn(|_| Exact::ZERO);
            let mut ends = [f64::NEG_INFINITY; 2];
            let own = self
                .nodes
                .iter()
                .filter(|at| at.support == support && owned.contains(at.node));
            for at in own.filter(|at| at.gap.is_finite()) {
                let pushed = at.pushed(reaction).max(0.0);
                let slip = at.slip(u);
                let slides = matches!(at.status, Status::Slip(_)) && slip.norm() > 0.0;
                let friction = at.friction(reaction);
                let gap = (at.gap + at.inward * u[Nodal::<D>::at(at.node, at.axis)]).max(0.0);
                let closed = f64::from(u8::from(at.status != Status::Open));
                let sliding = if slides { pushed } else { 0.0 };
                let each = [1.0, closed, pushed, sliding, pushed * slip.norm(), -friction.dot(&slip)];
                sums.iter_mut().zip(each).for_each(|(sum, value)| sum.add(value));
                ends = [ends[0].max(-gap), ends[1].max(gap)];
            }
            let [nodes, closed, pushed, sliding, slipped, dissipated] =
                halo.reproducible_sum(&sums).try_into().unwrap_or([0.0; 6]);
            halo.all_reduce_max(&mut ends);
            let gap = if nodes > 0.0 { [-ends[0], ends[1]] } else { [0.0; 2] };
            let closed = ratio(closed, nodes);
            let sliding = ratio(sliding, pushed);
            let slip = ratio(slipped, pushed);
            reports.push(ContactReport {
                support,
                nodes: nodes as usize,
                closed,
                sliding,
                slip,
                dissipated,
                gap,
            });
        }
        reports
    }
}

/// Whether another face with contact decides a component at a node of a face: one normal to it or, along an edge in
/// space that a smooth face shares with one with friction, the latter.
fn is_decided_beside<const D: usize>(
    boundary: &Boundary<D>,
    grid: &Grid<D>,
    face: &Support<D>,
    node: usize,
    component: usize,
) -> bool {
    let is_smooth = D > 2 && face.contact.is_some_and(|law| law.friction == 0.0);
    boundary.supports.iter().any(|other| {
        let is_rival = other.contact.is_some() && other.axis != face.axis;
        let has_friction = other.contact.is_some_and(|law| law.friction > 0.0);
        let decides = other.axis == component || is_smooth && has_friction;
        is_rival && decides && is_on(grid, node, other)
    })
}

/// Whether a node is on a face.
fn is_on<const D: usize>(grid: &Grid<D>, node: usize, face: &Support<D>) -> bool {
    let last = grid.axes()[face.axis].functions() - 1;
    grid.node_at(node)[face.axis] == if face.upper { last } else { 0 }
}

/// Whether the node behind a node of a face has moved in the last displacement, `guess`, m.
fn had_material<const D: usize>(grid: &Grid<D>, face: &Support<D>, node: usize, guess: &[f64]) -> bool {
    let mut behind = grid.node_at(node);
    let at = behind[face.axis];
    behind[face.axis] = if face.upper { at.saturating_sub(1) } else { at + 1 };
    let u = grid
        .node_index(&behind)
        .and_then(|node| guess.get(Nodal::<D>::of(node)));
    u.is_some_and(|u| u.iter().any(|u| *u != 0.0))
}
