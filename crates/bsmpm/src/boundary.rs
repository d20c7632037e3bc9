//! Boundary conditions and loads: supports, footings, loads, absorbing faces, contact and rigid bodies. They prescribe
//! nodal displacements, or add forces to the residual.
//!
//! `(T6.1)` is equation (6.1) of the theory manual, `crates/bsmpm-book/src/theory/boundaries.md`.

pub mod absorbing;
pub mod anchor;
pub mod contact;
pub mod coulomb;
pub mod load;
pub mod rigid;
pub mod strip;
pub mod surface;

use crate::schedule::TimeInterval;
pub use anchor::Idle;
pub use coulomb::{Contact, ContactReport};
pub use load::Load;
pub use rigid::{RigidBody, RigidReport, RigidState};
pub use strip::{MotionShare, Path, Strip, StripContact, StripReport};
pub use surface::{Anchors, Surface, SurfacePoint};

use crate::exact::Exact;
use crate::grid::Grid;
use crate::nodal::Nodal;
use crate::parallel::{Halo, OwnedNodes};
use crate::points::Points;
use crate::tensor::Vector;
use crate::water::crossed::CumulativeFlux;

/// Motion of one face of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support<const D: usize> {
    /// axis that the face is normal to
    pub axis: usize,
    /// the face at the axis' upper end
    pub upper: bool,
    /// per component: velocity of the prescribed motion (m per unit of time), 0 where it is held, `None` where free
    pub velocity: [Option<f64>; D],
    /// what the face does to the material where nothing is prescribed
    pub contact: Option<Contact>,
    /// whether it lets waves out
    pub absorbs: bool,
    /// whether the ground beside it moves as a free field, by whose motion and stress it is driven; it absorbs then
    pub follows: bool,
}

impl<const D: usize> Support<D> {
    /// All components held.
    pub fn fixed(axis: usize, upper: bool) -> Self {
        Self::moving(axis, upper, [Some(0.0); D])
    }

    /// These velocities prescribed, m per unit of time.
    pub fn moving(axis: usize, upper: bool, velocity: [Option<f64>; D]) -> Self {
        Self {
            axis,
            upper,
            velocity,
            contact: None,
            absorbs: false,
            follows: false,
        }
    }

    /// Nothing held, but what the contact does.
    pub fn contact(axis: usize, upper: bool, contact: Contact) -> Self {
        Self {
            contact: Some(contact),
            ..Self::moving(axis, upper, [None; D])
        }
    }

    /// Nothing held but the state of the start; waves leave.
    pub fn absorbing(axis: usize, upper: bool) -> Self {
        Self {
            absorbs: true,
            ..Self::moving(axis, upper, [None; D])
        }
    }

    /// Beside a free field: what differs from its motion leaves.
    pub fn free_field(axis: usize, upper: bool) -> Self {
        Self {
            follows: true,
            ..Self::absorbing(axis, upper)
        }
    }

    /// The normal component held.
    pub fn roller(axis: usize, upper: bool) -> Self {
        let mut velocity = [None; D];
        velocity[axis] = Some(0.0);
        Self::moving(axis, upper, velocity)
    }

    /// Whether it moves the material.
    fn is_driven(&self) -> bool {
        self.velocity.iter().flatten().any(|&velocity| velocity != 0.0)
    }

    /// Whether by the nodal `reaction` it pushes the material beside the edge that a node of it may be on.
    fn pushes(&self, grid: &Grid<D>, reaction: &[f64], node: usize) -> bool {
        let within = reaction.get(Nodal::<D>::at(grid.off_edges(node, self.axis), self.axis));
        within.is_some_and(|&within| if self.upper { within < 0.0 } else { within > 0.0 })
    }
}

/// All that holds and loads a scene besides gravity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundary<const D: usize> {
    /// Supports of the faces; where faces meet, the one named last decides a component that both prescribe.
    pub supports: Vec<Support<D>>,
    /// Faces of the grid that material may leave through: the axis, and whether it is the upper one.
    pub outlets: Vec<(usize, bool)>,
    /// Rigid strips.
    pub strips: Vec<Strip<D>>,
    /// Per strip, whether it lies on ground that stands without it, and has no part in the state of the start; empty:
    /// all have.
    pub resting: Vec<bool>,
    /// Tractions and point loads.
    pub loads: Vec<Load<D>>,
    /// Rigid bodies.
    pub rigid: Vec<RigidBody<D>>,
    /// Per material, parts of a cell that its points reach to each side at the start: 0.5 over their number along an
    /// axis; half a cell where it is not reported. For faces that material comes off, and the water's level.
    pub reach: Vec<f64>,
}

impl<const D: usize> Boundary<D> {
    /// m  how far point `p`, as it is deformed, reaches to each side along an axis.
    pub fn reach_along(&self, grid: &Grid<D>, points: &Points<D>, p: usize, axis: usize) -> f64 {
        let start = grid
            .locate(&(points.x[p] - points.u[p]))
            .or_else(|| grid.locate(&points.x[p]));
        let share = self.reach.get(usize::from(points.material[p])).copied().unwrap_or(0.5);
        let half = start.map_or(Vector::zeros(), |cell| grid.cell_box(&cell).1 * share);
        let F = points.F.at(p);
        (0..D).map(|j| F[(axis, j)].abs() * half[j]).sum()
    }

    /// A place of the material's surface, or that on the face which holds the material where the place lies beyond it,
    /// as one that is reported by the material beside it may.
    pub fn kept_in(&self, grid: &Grid<D>, mut x: Vector<D>) -> Vector<D> {
        for Support {
            axis,
            upper,
            velocity,
            contact,
            ..
        } in &self.supports
        {
            if velocity[*axis] == Some(0.0) || contact.is_some() {
                let length = grid.axes()[*axis].length();
                x[*axis] = if *upper {
                    x[*axis].min(length)
                } else {
                    x[*axis].max(0.0)
                };
            }
        }
        x
    }

    /// Whether a load or the motion of a strip turns sharply in a step.
    pub fn turns(&self, interval: TimeInterval) -> bool {
        self.loads.iter().any(|load| load.turns(interval))
            || self
                .strips
                .iter()
                .any(|strip| strip.acts() && strip.path.turns(interval))
    }

    /// Whether something moves as prescribed in the step from `t` to `t + dt`: a face, a strip or a rigid body.
    pub fn moves(&self, t: f64, dt: f64) -> bool {
        let mut strips = self.strips.iter().filter(|strip| strip.acts());
        let mut bodies = self.rigid.iter().filter(|body| body.acts);
        self.supports.iter().any(Support::is_driven)
            || strips.any(|strip| strip.path.at(t) != strip.path.at(t + dt))
            || bodies.any(|body| body.prescribed(t) != body.prescribed(t + dt))
    }

    /// Whether something moves as prescribed in the step from `t` to `t + dt`, and everything that does has the
    /// velocity that it had in the step of length `last_dt` before.
    pub fn moves_steadily(&self, t: f64, last_dt: f64, dt: f64) -> bool {
        let mut moves = self.supports.iter().any(Support::is_driven);
        for strip in self.strips.iter().filter(|strip| strip.acts()) {
            let places = [t - last_dt, t, t + dt].map(|t| strip.path.at(t));
            let Some(velocity) = steady_velocity(&places, last_dt, dt) else {
                return false;
            };
            moves |= velocity.norm() > 0.0;
        }
        for body in self.rigid.iter().filter(|body| body.acts) {
            let places = [t - last_dt, t, t + dt].map(|t| body.prescribed(t));
            let Some(velocity) = steady_velocity(&places, last_dt, dt) else {
                return false;
            };
            moves |= velocity.norm() > 0.0;
        }
        moves
    }

    /// The state of strips and loads at the start: no traction, every point at its place.
    pub fn surface(&self) -> Surface<D> {
        let at_rest = self
            .strips
            .iter()
            .map(|strip| vec![Vector::zeros(); strip.points.len()]);
        let places = self
            .loads
            .iter()
            .map(|load| load.points.iter().map(|point| point.x).collect());
        Surface {
            traction: at_rest.collect(),
            position: places.collect(),
            pressure: self.loads.iter().map(Load::at_rest).collect(),
            anchors: Anchors::default(),
            held: Vec::new(),
            bodies: self.rigid.iter().map(RigidBody::at_rest).collect(),
            crossed: CumulativeFlux::default(),
            flowed: None,
        }
    }

    /// Whether anything that acts has friction: faces, strips or rigid bodies.
    pub fn has_friction(&self) -> bool {
        let faces = self.supports.iter().filter_map(|support| support.contact);
        let strips = self
            .strips
            .iter()
            .filter(|strip| strip.acts())
            .filter_map(|strip| strip.contact);
        let laws = faces.chain(strips.map(|contact| contact.law)).map(|law| law.friction);
        laws.chain(self.rigid.iter().filter(|body| body.acts).map(|body| body.friction))
            .any(|friction| friction > 0.0)
    }

    /// The faces of the grid that no material leaves, per axis the lower and the upper one: their normal component is
    /// held.
    pub fn closed(&self) -> [[bool; 2]; D] {
        let mut closed = [[false; 2]; D];
        for support in &self.supports {
            let held = support
                .contact
                .map(|contact| !contact.lifts)
                .or(support.absorbs.then_some(true));
            closed[support.axis][usize::from(support.upper)] =
                held.unwrap_or(support.velocity[support.axis] == Some(0.0));
        }
        closed
    }

    /// Whether material at `x`, m, has left the grid, and through outlets alone.
    pub fn lets_out(&self, grid: &Grid<D>, x: &Vector<D>) -> bool {
        let left = (0..D).filter_map(|axis| match x[axis] {
            x if x < 0.0 => Some((axis, false)),
            x if x > grid.axes()[axis].length() => Some((axis, true)),
            _ => None,
        });
        let mut left = left.peekable();
        left.peek().is_some() && left.all(|face| self.outlets.contains(&face))
    }

    /// Prescribed velocity of every nodal component of the window (D per node), `None` where it is free.
    pub fn velocities(&self, grid: &Grid<D>) -> Vec<Option<f64>> {
        let mut prescribed = vec![None; grid.nodes() * D];
        for support in &self.supports {
            for node in grid.face_nodes(support.axis, support.upper) {
                for (component, velocity) in support.velocity.iter().enumerate() {
                    if velocity.is_some() {
                        prescribed[Nodal::<D>::at(node, component)] = *velocity;
                    }
                }
            }
        }
        prescribed
    }

    /// Whether some face has contact instead of holding.
    pub fn has_contact(&self) -> bool {
        self.supports.iter().any(|support| support.contact.is_some())
    }

    /// Lower and upper faces of every axis that have contact.
    pub fn contact_faces(&self) -> [[bool; 2]; D] {
        let mut faces = [[false; 2]; D];
        for support in self.supports.iter().filter(|support| support.contact.is_some()) {
            faces[support.axis][usize::from(support.upper)] = true;
        }
        faces
    }

    /// Whether some strip has.
    pub fn has_strip_contact(&self) -> bool {
        self.strips.iter().any(|strip| strip.contact.is_some())
    }

    /// Force of every support on the body: the nodal `reaction` summed over the components that it decides, N. What two
    /// supports hold at their common edge counts for the one that it is normal to, which has the pressure there; for
    /// one in contact, too, where it pushes beside the edge.
    pub fn reactions(&self, grid: &Grid<D>, reaction: &[f64], halo: &dyn Halo) -> Vec<Vec<f64>> {
        let supports = &self.supports[..];
        let mut sums = ReactionSums {
            supports,
            grid,
            reaction,
            owned: halo.owned(),
            counted: vec![false; reaction.len()],
            sums: vec![Exact::default(); supports.len() * D],
        };
        let in_contact: Vec<usize> = (0..supports.len()).filter(|&k| supports[k].contact.is_some()).collect();
        // Who holds goes first, then what pushes, then what has friction.
        for (number, support) in supports.iter().enumerate().rev() {
            sums.add(number, |_, c| c == support.axis && support.velocity[c].is_some());
        }
        for &number in &in_contact {
            let support = &supports[number];
            sums.add(number, |node, c| {
                c == support.axis && support.pushes(grid, reaction, node)
            });
        }
        for (number, support) in supports.iter().enumerate().rev() {
            sums.add(number, |_, c| c != support.axis && support.velocity[c].is_some());
        }
        for &number in &in_contact {
            sums.add(number, |_, c| c == supports[number].axis);
        }
        // Along an edge in space that it shares with a face with friction, a smooth one decides nothing.
        for has_friction in [true, false] {
            for (number, support) in supports.iter().enumerate() {
                if support
                    .contact
                    .is_some_and(|contact| (contact.friction > 0.0) == has_friction)
                {
                    sums.add(number, |_, c| c != support.axis);
                }
            }
        }
        for (number, _) in supports.iter().enumerate().filter(|(_, support)| support.absorbs) {
            sums.add(number, |_, _| true);
        }
        halo.reproducible_sum(&sums.sums)
            .chunks_exact(D)
            .map(<[f64]>::to_vec)
            .collect()
    }
}

/// Sums over the nodes of every support of the reaction, of which each component counts once.
struct ReactionSums<'a, const D: usize> {
    supports: &'a [Support<D>],
    grid: &'a Grid<D>,
    reaction: &'a [f64],
    owned: OwnedNodes,
    counted: Vec<bool>,
    sums: Vec<Exact>, // D of every support
}

impl<const D: usize> ReactionSums<'_, D> {
    /// Adds to the sums of a support what it `decides`, by node and component.
    fn add(&mut self, number: usize, decides: impl Fn(usize, usize) -> bool) {
        let support = &self.supports[number];
        for node in self.grid.face_nodes(support.axis, support.upper) {
            for component in (0..D).filter(|&component| decides(node, component)) {
                let place = Nodal::<D>::at(node, component);
                if !std::mem::replace(&mut self.counted[place], true) && self.owned.contains(node) {
                    self.sums[number * D + component].add(self.reaction[place]);
                }
            }
        }
    }
}

fn steady_velocity<const N: usize>(places: &[Vector<N>; 3], last_dt: f64, dt: f64) -> Option<Vector<N>> {
    let before = (places[1] - places[0]) / last_dt;
    let now = (places[2] - places[1]) / dt;
    ((now - before).norm() <= SAME_VELOCITY * now.norm().max(before.norm())).then_some(now)
}

/// Relative difference up to which two velocities are the same.
const SAME_VELOCITY: f64 = 1e-6;
