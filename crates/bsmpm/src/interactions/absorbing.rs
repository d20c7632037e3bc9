//! Absorbing faces of the grid, theory-manual equations (T6.11) to (T6.13), (T6.15): nodal dashpots, and constant nodal
//! forces that carry static loads, in residual and stiffness.

use super::contact::face_cell;
use super::{EquilibriumState, Interaction, InteractionReports, InteractionWork, NodalForces, StepContext, StepStart};
use crate::boundary::{Boundary, Support};
use crate::dynamics::inertia::Inertia;
use crate::error::StepError;
use crate::grid::{Grid, transfer};
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::model::Regime;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::tensor::Vector;

/// Dashpot and constant force of an absorbing face at one nodal component.
#[derive(Clone, Copy, Debug)]
struct Dashpot {
    /// Index of the local nodal component.
    component: usize,
    /// Dashpot coefficient ∫ N_I ρ c dA (N s/m).
    impedance: f64,
    /// Constant force that carries the initial stress (N), including the free field's force.
    held: f64,
    /// Velocity of the adjacent free field (m/s), relative to which the dashpot acts; 0 without a free field.
    beside: f64,
    /// Index among the absorbing faces, and index of the node on that face.
    place: [usize; 2],
}

/// The dashpots of one step. Ranks that share a node have the same ones.
#[derive(Clone, Debug, Default)]
struct Dashpots(Vec<Dashpot>);

impl Dashpots {
    /// Computes the dashpots of all absorbing faces at components that no support prescribes; none without inertia. One
    /// ghost exchange per face.
    fn of<K: Kinematics<D>, const D: usize>(start: &StepStart<'_, K, D>) -> Self {
        let mut dashpots = Vec::new();
        let StepStart {
            model,
            shape,
            points,
            halo,
            ..
        } = *start;
        if model.regime != Regime::Dynamic {
            return Self::default();
        }
        let boundary = &model.boundary;
        let grid = &model.grid;
        let free = &start.constraints.free;
        for (number, face) in boundary.absorbing().enumerate() {
            let edge = face_cell(grid, face.axis, face.upper);
            let last = face.last_cell(grid);
            let nodal = halo.assemble_ghosts(&transfer::to_nodes(shape, |p| match grid.locate(&points.x[p]) {
                Some(cell) if cell[face.axis] == last => {
                    let weight = weight_on::<K, D>(grid, face, &points.x[p]);
                    model.impedance(points, p).map(|of| of / edge * weight)
                }
                _ => [0.0; 2],
            }));
            let held = start.input.state.held.get(number);
            for node in grid.face_nodes(face.axis, face.upper) {
                let [compression, shear] = across(grid, face, node, &nodal);
                let place = [number, number_on(grid, face, node)];
                for component in (0..D).filter(|&component| free[Nodal::<D>::at(node, component)]) {
                    let impedance = if component == face.axis { compression } else { shear };
                    let held = held.map_or(0.0, |held| held[place[1]][component]);
                    let component = Nodal::<D>::at(node, component);
                    dashpots.push(Dashpot {
                        component,
                        impedance,
                        held,
                        beside: 0.0,
                        place,
                    });
                }
            }
        }
        Self(dashpots)
    }

    /// Applies the free field to the absorbing face with index `face`: nodal forces (N) and velocities (m/s), one per
    /// node of the face.
    fn drive<const D: usize>(&mut self, face: usize, force: &[Vector<D>], velocity: &[Vector<D>]) {
        for at in self.0.iter_mut().filter(|at| at.place[0] == face) {
            let component = at.component % D;
            at.held += force[at.place[1]][component];
            at.beside = velocity[at.place[1]][component];
        }
    }

    /// Adds the forces of the dashpots at the end of the step (N) to the out-of-balance force and the `reaction`.
    fn add_forces(&self, inertia: &Inertia, u: &[f64], forces: NodalForces<'_>) {
        for &Dashpot {
            component,
            impedance,
            held,
            beside,
            ..
        } in &self.0
        {
            let force = held - impedance * (inertia.velocity(component, u[component]) - beside);
            forces.f_oob[component] += force;
            forces.reaction[component] += force;
        }
    }

    /// Returns the nodal components and their dashpot stiffness (N/m): the derivative of the force with respect to the
    /// displacement.
    fn stiffness<'a>(&'a self, inertia: &'a Inertia) -> impl Iterator<Item = (usize, f64)> + 'a {
        self.0
            .iter()
            .map(|at| (at.component, at.impedance * inertia.velocity_factor(at.component)))
    }

    /// Returns the work of the dashpots at this rank's owned nodes (J), relative to the motion of the free field. The
    /// work of the constant forces is not included.
    fn work<const D: usize>(&self, inertia: &Inertia, u: &[f64], halo: &dyn Halo) -> Vec<f64> {
        let owned = halo.owned();
        let mut works = Vec::new();
        for at in self
            .0
            .iter()
            .filter(|at| owned.contains(Nodal::<D>::node(at.component)))
        {
            let faster = inertia.velocity(at.component, u[at.component]) - at.beside;
            works.push(-at.impedance * faster * (u[at.component] - at.beside * inertia.dt));
        }
        works
    }
}

/// Action of a free-field column on the nodes of the face that it drives.
#[derive(Clone, Debug)]
pub struct ColumnAction<const D: usize> {
    /// Index of the face among the absorbing faces.
    pub face: usize,
    /// Force of the column's stress on every node of the face (N).
    pub force: Vec<Vector<D>>,
    /// This force at the start of the column's first step (N), with initial stress. It is part of the forces that carry
    /// the initial stress; the column carries it from now on.
    pub start: Option<Vec<Vector<D>>>,
    /// Velocity at every node of the face (m/s).
    pub velocity: Vec<Vector<D>>,
}

/// Absorbing faces in one step, with the free-field columns that drive some of them.
#[derive(Debug)]
struct AbsorbingFaces<const D: usize> {
    dashpots: Dashpots,
    columns: Vec<ColumnAction<D>>,
}

/// Begins the absorbing faces of a step, if there are any.
pub fn begin<K: Kinematics<D>, const D: usize>(start: &StepStart<'_, K, D>) -> Option<Box<dyn Interaction<D>>> {
    start.model.boundary.absorbing().next()?;
    let mut dashpots = Dashpots::of(start);
    for column in start.input.columns {
        let force = less(&column.force, column.start.as_deref());
        dashpots.drive(column.face, &force, &column.velocity);
    }
    Some(Box::new(AbsorbingFaces {
        dashpots,
        columns: start.input.columns.to_vec(),
    }))
}

/// Returns the nodal forces (N) less those at the start.
pub(super) fn less<const D: usize>(forces: &[Vector<D>], start: Option<&[Vector<D>]>) -> Vec<Vector<D>> {
    match start {
        Some(start) => forces.iter().zip(start).map(|(force, start)| force - start).collect(),
        None => forces.to_vec(),
    }
}

impl<const D: usize> Interaction<D> for AbsorbingFaces<D> {
    fn note_unknowns(&mut self, context: &StepContext<'_, D>, _last: &[f64]) {
        self.dashpots.0.retain(|at| context.constraints.free[at.component]);
    }

    fn add_reaction(&self, context: &StepContext<'_, D>, u: &[f64], forces: NodalForces<'_>) {
        if let Some(inertia) = context.inertia {
            self.dashpots.add_forces(inertia, u, forces);
        }
    }

    fn add_nodal_product(&self, context: &StepContext<'_, D>, _reaction: &[f64], v: &[f64], out: &mut [f64]) {
        if let Some(inertia) = context.inertia {
            let stiffness = self.dashpots.stiffness(inertia);
            stiffness.for_each(|(component, stiffness)| out[component] += stiffness * v[component]);
        }
    }

    fn add_damping(&self, inertia: &Inertia, diagonal: &mut [f64]) {
        let stiffness = self.dashpots.stiffness(inertia);
        stiffness.for_each(|(component, stiffness)| diagonal[component] += stiffness);
    }

    fn add_work(&self, context: &StepContext<'_, D>, at: &EquilibriumState<'_>, work: &mut InteractionWork) {
        if let Some(inertia) = context.inertia {
            let works = self.dashpots.work::<D>(inertia, at.u, context.halo).into_iter();
            work.friction.extend(works.map(|work| 0.5 * work));
        }
    }

    fn finish(
        &self,
        _context: &StepContext<'_, D>,
        _at: &EquilibriumState<'_>,
        after: &mut InteractionState<D>,
        _reports: &mut InteractionReports,
    ) -> Result<(), StepError> {
        for ColumnAction { face, start, .. } in &self.columns {
            if let Some(held) = after.held.get_mut(*face) {
                *held = less(held, start.as_deref());
            }
        }
        Ok(())
    }
}

impl<const D: usize> Support<D> {
    /// Returns the index, along the axis, of the cells at the face.
    pub fn last_cell(&self, grid: &Grid<D>) -> usize {
        if self.upper {
            grid.axes()[self.axis].cells() - 1
        } else {
            0
        }
    }
}

impl<const D: usize> Boundary<D> {
    /// Returns the absorbing faces in the order of the supports.
    pub fn absorbing(&self) -> impl Iterator<Item = &Support<D>> {
        self.supports.iter().filter(|support| support.absorbs)
    }

    /// Returns the boundary for an initial state at rest: rollers replace the absorbing faces, and the face normal to
    /// the largest component of `pull` (gravity) becomes fixed. Rigid bodies are removed.
    pub fn at_rest(&self, pull: Option<Vector<D>>) -> Self {
        let mut held = self.clone();
        held.rigid.clear();
        for face in held.supports.iter_mut().filter(|support| support.absorbs) {
            let across = pull.is_some_and(|pull| pull.iamax() == face.axis && pull[face.axis] != 0.0);
            *face = match across {
                true => Support::fixed(face.axis, face.upper),
                false => Support::roller(face.axis, face.upper),
            };
        }
        held
    }

    /// Returns whether `held` is empty or has one force per node of every absorbing face.
    pub fn fits(&self, grid: &Grid<D>, held: &[Vec<Vector<D>>]) -> bool {
        held.is_empty()
            || self
                .absorbing()
                .map(|face| nodes_on(grid, face))
                .eq(held.iter().map(Vec::len))
    }

    /// Returns the forces that carry the initial stress at the nodes of every absorbing face (N), from the nodal
    /// `reaction`. Each component counts once. All ranks obtain the same result. One reduction per face.
    pub fn held(&self, grid: &Grid<D>, reaction: &[f64], halo: &dyn Halo) -> Vec<Vec<Vector<D>>> {
        let owned = halo.owned();
        let mut counted = vec![false; reaction.len()];
        let mut held = Vec::new();
        for face in self.absorbing() {
            let mut forces = vec![0.0; nodes_on(grid, face) * D];
            let nodes = grid.face_nodes(face.axis, face.upper).into_iter();
            for node in nodes.filter(|&node| owned.contains(node)) {
                for component in 0..D {
                    let place = Nodal::<D>::at(node, component);
                    if !std::mem::replace(&mut counted[place], true) {
                        forces[Nodal::<D>::at(number_on(grid, face, node), component)] = reaction[place];
                    }
                }
            }
            halo.all_reduce_sum(&mut forces); // exact: one rank has each value
            held.push(forces.chunks_exact(D).map(Vector::from_column_slice).collect());
        }
        held
    }
}

/// Returns the geometry weight at the projection of `x` (m) onto the face, divided by the weight at `x`. In
/// axisymmetry, a material point's mass contains its own radius, but the face needs the radius of the face.
fn weight_on<K: Kinematics<D>, const D: usize>(grid: &Grid<D>, face: &Support<D>, x: &Vector<D>) -> f64 {
    let length = grid.axes()[face.axis].length();
    let mut on_face = *x;
    on_face[face.axis] = if face.upper { length } else { 0.0 };
    K::weight(&on_face) / K::weight(x)
}

/// Returns the axes along a face.
fn along<const D: usize>(normal: usize) -> impl Iterator<Item = usize> {
    (0..D).filter(move |&axis| axis != normal)
}

/// Returns the number of nodes of a face of the whole grid.
fn nodes_on<const D: usize>(grid: &Grid<D>, face: &Support<D>) -> usize {
    along::<D>(face.axis)
        .map(|axis| grid.axes()[axis].functions())
        .product()
}

/// Returns the index of a local node on its face of the whole grid.
fn number_on<const D: usize>(grid: &Grid<D>, face: &Support<D>, node: usize) -> usize {
    let node = grid.node_at(node);
    along::<D>(face.axis).fold(0, |number, axis| number * grid.axes()[axis].functions() + node[axis])
}

/// Sums the nodal values (two per node) over the q + 1 nodes in the line from `node` into the grid. Across the face
/// their splines sum to 1, so the sum is the integral over the face with the shape functions along the face alone.
fn across<const D: usize>(grid: &Grid<D>, face: &Support<D>, node: usize, nodal: &[f64]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for behind in 0..=grid.order() {
        let mut at = grid.node_at(node);
        at[face.axis] = if face.upper { at[face.axis] - behind } else { behind };
        let of = grid
            .node_index(&at)
            .map_or(&[0.0; 2][..], |at| &nodal[Nodal::<2>::of(at)]);
        sum.iter_mut().zip(of).for_each(|(sum, of)| *sum += of);
    }
    sum
}
