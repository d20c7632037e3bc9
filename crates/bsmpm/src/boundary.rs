//! Boundary conditions and loads: supports, footings, loads, absorbing faces, contact and rigid bodies. They prescribe
//! nodal displacements, or add forces to the residual.

pub mod anchor;
pub mod surface;

use crate::interactions::coulomb::Contact;
use crate::interactions::load::Load;
use crate::interactions::rigid::RigidBody;
use crate::interactions::strip::Strip;
use crate::schedule::TimeInterval;
pub use anchor::{AnchoredPoints, Idle};
pub use surface::{Anchors, SurfacePoint};

use crate::exact::Exact;
use crate::field::pore_water::crossed::CrossedVolumes;
use crate::grid::Grid;
use crate::interactions::state::InteractionState;
use crate::nodal::Nodal;
use crate::parallel::{Halo, OwnedNodes};
use crate::points::Points;
use crate::tensor::Vector;

/// Support of one face of the grid: prescribed motion, contact, absorbing boundary or free field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support<const D: usize> {
    /// Axis normal to the face.
    pub axis: usize,
    /// Whether the face is at the upper end of the axis.
    pub upper: bool,
    /// Prescribed velocity of each component (m per unit of time); 0: fixed, `None`: free.
    pub velocity: [Option<f64>; D],
    /// Contact law of the components without a prescribed velocity.
    pub contact: Option<Contact>,
    /// Whether the face is an absorbing boundary.
    pub absorbs: bool,
    /// Whether a free-field column drives the face; `absorbs` is then true, too.
    pub follows: bool,
}

impl<const D: usize> Support<D> {
    /// Fixes all components.
    pub fn fixed(axis: usize, upper: bool) -> Self {
        Self::moving(axis, upper, [Some(0.0); D])
    }

    /// Prescribes the velocities of the components (m per unit of time).
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

    /// Defines a face with contact and no prescribed component.
    pub fn contact(axis: usize, upper: bool, contact: Contact) -> Self {
        Self {
            contact: Some(contact),
            ..Self::moving(axis, upper, [None; D])
        }
    }

    /// Defines an absorbing face. Constant nodal forces carry the initial stress there.
    pub fn absorbing(axis: usize, upper: bool) -> Self {
        Self {
            absorbs: true,
            ..Self::moving(axis, upper, [None; D])
        }
    }

    /// Defines an absorbing face that a free-field column drives: the face absorbs the difference from the column's
    /// motion.
    pub fn free_field(axis: usize, upper: bool) -> Self {
        Self {
            follows: true,
            ..Self::absorbing(axis, upper)
        }
    }

    /// Fixes the normal component.
    pub fn roller(axis: usize, upper: bool) -> Self {
        let mut velocity = [None; D];
        velocity[axis] = Some(0.0);
        Self::moving(axis, upper, velocity)
    }

    /// Returns whether a prescribed velocity is not zero.
    fn is_driven(&self) -> bool {
        self.velocity.iter().flatten().any(|&velocity| velocity != 0.0)
    }

    /// Returns whether the face pushes the material next to the edge on which `node` may lie, by the nodal `reaction`
    /// (N) of the nearest node off the edge.
    fn pushes(&self, grid: &Grid<D>, reaction: &[f64], node: usize) -> bool {
        let within = reaction.get(Nodal::<D>::at(grid.off_edges(node, self.axis), self.axis));
        within.is_some_and(|&within| if self.upper { within < 0.0 } else { within > 0.0 })
    }
}

/// Supports, footings, loads and rigid bodies of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundary<const D: usize> {
    /// Supports of the faces. Where two faces meet, the last one in the list decides a component that both prescribe.
    pub supports: Vec<Support<D>>,
    /// Faces through which material may leave the grid: axis, and whether the face is the upper one.
    pub outlets: Vec<(usize, bool)>,
    /// Rigid footings and prescribed segments.
    pub strips: Vec<Strip<D>>,
    /// Per strip: whether it rests on soil that is in equilibrium without it, and is excluded from the initial state.
    /// Empty: no strip is excluded.
    pub resting: Vec<bool>,
    /// Tractions and point loads.
    pub loads: Vec<Load<D>>,
    /// Rigid bodies.
    pub rigid: Vec<RigidBody<D>>,
    /// Per material: half width of a material point's domain at the start, in cell edges: 0.5 divided by the number of
    /// points per cell along an axis. The default is 0.5. Contact gaps and the water level use it.
    pub reach: Vec<f64>,
}

impl<const D: usize> Boundary<D> {
    /// Returns the half width of the deformed domain of material point `p` along an axis (m).
    pub fn reach_along(&self, grid: &Grid<D>, points: &Points<D>, p: usize, axis: usize) -> f64 {
        let start = grid
            .locate(&(points.x[p] - points.u[p]))
            .or_else(|| grid.locate(&points.x[p]));
        let share = self.reach.get(usize::from(points.material[p])).copied().unwrap_or(0.5);
        let half = start.map_or(Vector::zeros(), |cell| grid.cell_box(&cell).1 * share);
        let F = points.F.at(p);
        (0..D).map(|j| F[(axis, j)].abs() * half[j]).sum()
    }

    /// Returns the position `x` (m) of the material's surface, moved back onto the face if it lies beyond a face with
    /// zero normal velocity or with contact. Positions that nearby material points yield can lie beyond such a face.
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

    /// Returns whether the amplitude of a load or the path of a strip changes its slope sharply in the interval.
    pub fn turns(&self, interval: TimeInterval) -> bool {
        self.loads.iter().any(|load| load.turns(interval))
            || self
                .strips
                .iter()
                .any(|strip| strip.acts() && strip.path.turns(interval))
    }

    /// Returns whether a face, a strip or a rigid body has a prescribed motion in the step from `t` to `t + dt`.
    pub fn moves(&self, t: f64, dt: f64) -> bool {
        let mut strips = self.strips.iter().filter(|strip| strip.acts());
        let mut bodies = self.rigid.iter().filter(|body| body.acts);
        self.supports.iter().any(Support::is_driven)
            || strips.any(|strip| strip.path.at(t) != strip.path.at(t + dt))
            || bodies.any(|body| body.prescribed(t) != body.prescribed(t + dt))
    }

    /// Returns whether there is prescribed motion in the step from `t` to `t + dt`, and all of it has the same velocity
    /// as in the previous step, whose length was `last_dt`.
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

    /// Returns the initial state of all interactions: no traction, and every surface point at its initial position.
    pub fn initial_state(&self) -> InteractionState<D> {
        let at_rest = self
            .strips
            .iter()
            .map(|strip| vec![Vector::zeros(); strip.points.len()]);
        let places = self
            .loads
            .iter()
            .map(|load| load.points.iter().map(|point| point.x).collect());
        InteractionState {
            traction: at_rest.collect(),
            position: places.collect(),
            pressure: self.loads.iter().map(Load::at_rest).collect(),
            anchors: Anchors::default(),
            held: Vec::new(),
            bodies: self.rigid.iter().map(RigidBody::at_rest).collect(),
            crossed: CrossedVolumes::default(),
            flowed: None,
            columns: Vec::new(),
        }
    }

    /// Returns whether any active face, strip or rigid body has friction.
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

    /// Returns the faces that no material leaves, per axis the lower and the upper one: zero normal velocity,
    /// absorbing, or contact without separation.
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

    /// Returns whether material at `x` (m) has left the grid, and through outlets only.
    pub fn lets_out(&self, grid: &Grid<D>, x: &Vector<D>) -> bool {
        let left = (0..D).filter_map(|axis| match x[axis] {
            x if x < 0.0 => Some((axis, false)),
            x if x > grid.axes()[axis].length() => Some((axis, true)),
            _ => None,
        });
        let mut left = left.peekable();
        left.peek().is_some() && left.all(|face| self.outlets.contains(&face))
    }

    /// Returns the prescribed velocity of every local nodal component, D per node; `None`: free.
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

    /// Returns whether any face has contact.
    pub fn has_contact(&self) -> bool {
        self.supports.iter().any(|support| support.contact.is_some())
    }

    /// Returns, per axis, whether the lower and the upper face have contact.
    pub fn contact_faces(&self) -> [[bool; 2]; D] {
        let mut faces = [[false; 2]; D];
        for support in self.supports.iter().filter(|support| support.contact.is_some()) {
            faces[support.axis][usize::from(support.upper)] = true;
        }
        faces
    }

    /// Returns whether any strip has contact.
    pub fn has_strip_contact(&self) -> bool {
        self.strips.iter().any(|strip| strip.contact.is_some())
    }

    /// Returns the force of every support on the body (N): the sum of the nodal `reaction` over the components that the
    /// support decides. Each component counts once. At a common edge of two supports, it counts for the support that is
    /// normal to it, because that one carries the pressure; for a support in contact only if it pushes the material
    /// next to the edge. One reduction over all ranks.
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
        // Order of precedence: prescribed normal components, contact that pushes, prescribed tangential components,
        // contact normals, friction, absorbing faces.
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
        // In 3-D, a smooth face decides nothing along its edge with a face that has friction.
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

/// Sums of the nodal reaction over the nodes of every support. Each component counts once.
struct ReactionSums<'a, const D: usize> {
    supports: &'a [Support<D>],
    grid: &'a Grid<D>,
    reaction: &'a [f64],
    owned: OwnedNodes,
    counted: Vec<bool>,
    sums: Vec<Exact>, // D per support
}

impl<const D: usize> ReactionSums<'_, D> {
    /// Adds the reaction components that satisfy `decides(node, component)` to the sums of support `number`.
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

/// Returns the velocity at the end if both steps between the three positions have the same velocity.
fn steady_velocity<const N: usize>(places: &[Vector<N>; 3], last_dt: f64, dt: f64) -> Option<Vector<N>> {
    let before = (places[1] - places[0]) / last_dt;
    let now = (places[2] - places[1]) / dt;
    ((now - before).norm() <= SAME_VELOCITY * now.norm().max(before.norm())).then_some(now)
}

/// Relative difference below which two velocities count as equal.
const SAME_VELOCITY: f64 = 1e-6;
