//! Frictional contact at nodes on the faces of the grid, theory-manual equations (T7.1) to (T7.4).
//! [`solve::contact`](crate::solve::contact) corrects the contact statuses (open, stick, slip).

mod gap;
mod interaction;
mod neutral;
mod node;

use super::coulomb::{ContactReport, Status, ratio};
use crate::boundary::{Boundary, Support};
use crate::exact::Exact;
use crate::grid::Grid;
use crate::linear::MatrixAssembly;
use crate::model::Model;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::MappedPoints;
use crate::tensor::Vector;
pub(super) use gap::face_cell;
use gap::{ROUNDING, gaps};
pub use interaction::begin;
use node::ContactNode;

/// Material counts as near a face if it could reach it within this number of steps at its present velocity, which may
/// change in the step.
const MEETING: f64 = 2.0;

/// All contact nodes of one step. Ranks that share a node have the same data.
#[derive(Clone, Debug, Default)]
pub struct Contacts<const D: usize> {
    nodes: Vec<ContactNode<D>>,
    released: Vec<bool>, // per node: changed from stick in the last correction
}

impl<const D: usize> Contacts<D> {
    /// Creates the contact nodes of a step: nodes of contact faces whose normal component is `free`. All are open until
    /// [`Self::predict_statuses`]. `water_force` is the part of the normal forces that pore water carries (N). One
    /// ghost exchange per face that allows separation.
    pub fn of<K>(
        model: &Model<K, D>,
        mapped: MappedPoints<'_, D>,
        free: &[bool],
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
                nodes.push(ContactNode {
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
                });
            }
        }
        let released = vec![false; nodes.len()];
        Self { nodes, released }
    }

    /// Drops nodes and components that are no longer `free`, and predicts the statuses in a step from time `t`, from
    /// `guess`, the displacement of the last step (m; may be empty).
    pub fn predict_statuses(&mut self, boundary: &Boundary<D>, grid: &Grid<D>, free: &[bool], t: f64, guess: &[f64]) {
        self.nodes.retain(|at| free[Nodal::<D>::at(at.node, at.axis)]);
        self.released = vec![false; self.nodes.len()];
        for at in &mut self.nodes {
            for (component, along) in at.along.iter_mut().enumerate() {
                *along &= free[Nodal::<D>::at(at.node, component)];
            }
            let face = &boundary.supports[at.support];
            let had_material = had_material(grid, face, at.node, guess);
            at.predict_status(t, guess, face_cell(grid, face.axis, face.upper), had_material);
        }
    }

    /// Applies the statuses: marks components as free or prescribed, and sets prescribed displacements (m).
    pub fn apply_statuses(&self, free: &mut [bool], prescribed: &mut [Option<f64>]) {
        for at in &self.nodes {
            for (component, held) in at.holds().into_iter().enumerate().filter(|(c, _)| at.decides(*c)) {
                let place = Nodal::<D>::at(at.node, component);
                (free[place], prescribed[place]) = (held.is_none(), held);
            }
        }
    }

    /// Sets the prescribed velocity (m/s) to zero for components that were at rest in contact and are predicted to
    /// remain so, as for fixed supports.
    pub fn set_at_rest(&self, velocities: &mut [Option<f64>]) {
        for at in &self.nodes {
            for component in (0..D).filter(|&component| at.rested[component]) {
                velocities[Nodal::<D>::at(at.node, component)] = Some(0.0);
            }
        }
    }

    /// Marks the components that contact may stop in a step of `dt` (s) with initial nodal velocities `v` (m/s): those
    /// of nodes in contact or near it that were not at rest.
    pub fn mark_stoppable(&self, v: &[f64], dt: f64, moving: &mut Vec<bool>) {
        if !self.nodes.is_empty() {
            moving.resize(v.len(), false);
        }
        for at in &self.nodes {
            let near = at.gap <= MEETING * dt * v[Nodal::<D>::at(at.node, at.axis)].abs();
            for component in (0..D).filter(|&component| near && at.decides(component) && !at.rested[component]) {
                moving[Nodal::<D>::at(at.node, component)] = true;
            }
        }
    }

    /// Adds friction under the displacement `u` (m) to the out-of-balance force and to the `reaction` (N), which
    /// already contains the normal forces.
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

    /// Adds the contribution of friction to the product of the tangent stiffness with `v` (m). `out` already contains
    /// the product of all components; `reaction` decides where friction acts.
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

    /// Adds the stiffness of friction across the direction of slip (3-D).
    pub fn add_stiffness(&self, matrix: &mut dyn MatrixAssembly, halo: &dyn Halo) {
        let owned = halo.owned();
        for at in self.nodes.iter().filter(|at| owned.contains(at.node)) {
            if let Some(block) = at.resists() {
                matrix.add_block_among(&[at.node], &block);
            }
        }
    }

    /// Corrects every status that the displacement `u` (m) and its `reaction` (N) contradict by more than `force` (N).
    /// Returns the number of corrected nodes on all ranks. One reduction.
    pub fn correct_statuses(&mut self, u: &[f64], reaction: &[f64], force: f64, edge: f64, halo: &dyn Halo) -> usize {
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

    /// Returns the work of the contact forces of this rank (J): of normal forces, non-zero only where a gap closes, and
    /// of friction.
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

    /// Returns the results of every contact face under the converged displacement `u` (m) and the `reaction` (N). Two
    /// reductions per face.
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

/// Returns whether another contact face decides a component at a node: the face normal to that component, or, at an
/// edge in 3-D, a face with friction that meets a smooth one.
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

/// Returns whether a node is on a face.
fn is_on<const D: usize>(grid: &Grid<D>, node: usize, face: &Support<D>) -> bool {
    let last = grid.axes()[face.axis].functions() - 1;
    grid.node_at(node)[face.axis] == if face.upper { last } else { 0 }
}

/// Returns whether the next node inwards from a face moved in the last step, by its displacement `guess` (m).
fn had_material<const D: usize>(grid: &Grid<D>, face: &Support<D>, node: usize, guess: &[f64]) -> bool {
    let mut behind = grid.node_at(node);
    let at = behind[face.axis];
    behind[face.axis] = if face.upper { at.saturating_sub(1) } else { at + 1 };
    let u = grid
        .node_index(&behind)
        .and_then(|node| guess.get(Nodal::<D>::of(node)));
    u.is_some_and(|u| u.iter().any(|u| *u != 0.0))
}
