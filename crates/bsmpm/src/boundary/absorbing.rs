//! Absorbing faces of the grid, theory-manual equations (T6.11) to (T6.13), (T6.15): nodal dashpots, and constant nodal
//! forces that carry static loads, in residual and stiffness.

use super::contact::face_cell;
use super::{Boundary, Support};
use crate::grid::{Grid, Shape, transfer};
use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::Points;
use crate::step::inertia::Inertia;
use crate::tensor::Vector;

/// What an absorbing face does to one component of a node.
#[derive(Clone, Copy, Debug)]
struct Dashpot {
    /// of the window
    component: usize,
    /// N s/m  ∫ N_I ρ c dA
    impedance: f64,
    /// N  in the state of the start; beside a free field its stress among it
    held: f64,
    /// m/s  velocity beside it that it does not resist
    beside: f64,
    /// number of the face among those that absorb, and of the node on it
    place: [usize; 2],
}

/// The dashpots of one step: the same on every rank that shares a node.
#[derive(Clone, Debug, Default)]
pub struct Dashpots(Vec<Dashpot>);

impl Dashpots {
    /// Of the faces of the `boundary` that absorb, at components that are `free`; `impedance` of a point, kg m/s: its
    /// mass times the speed of compression and of shear waves. One exchange with the neighbours a face.
    pub fn of<K: Kinematics<D>, const D: usize>(
        boundary: &Boundary<D>,
        grid: &Grid<D>,
        shape: &Shape<D>,
        points: &Points<D>,
        impedance: impl Fn(usize) -> [f64; 2] + Sync,
        free: &[bool],
        halo: &dyn Halo,
    ) -> Self {
        let mut dashpots = Vec::new();
        for (number, face) in boundary.absorbing().enumerate() {
            let edge = face_cell(grid, face.axis, face.upper);
            let last = face.last_cell(grid);
            let nodal = halo.assemble_ghosts(&transfer::to_nodes(shape, |p| match grid.locate(&points.x[p]) {
                Some(cell) if cell[face.axis] == last => {
                    let weight = weight_on::<K, D>(grid, face, &points.x[p]);
                    impedance(p).map(|of| of / edge * weight)
                }
                _ => [0.0; 2],
            }));
            let held = points.surface.held.get(number);
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

    /// Drives those of a face, by its number among those that absorb, by the force of what is beside its nodes, N,
    /// and by its velocity, m/s.
    pub fn drive<const D: usize>(&mut self, face: usize, force: &[Vector<D>], velocity: &[Vector<D>]) {
        for at in self.0.iter_mut().filter(|at| at.place[0] == face) {
            let component = at.component % D;
            at.held += force[at.place[1]][component];
            at.beside = velocity[at.place[1]][component];
        }
    }

    /// Adds their forces at the end of the step, N, to what is out of balance and to the `reaction`.
    pub fn add_forces(&self, inertia: &Inertia, u: &[f64], f_oob: &mut [f64], reaction: &mut [f64]) {
        for &Dashpot {
            component,
            impedance,
            held,
            beside,
            ..
        } in &self.0
        {
            let force = held - impedance * (inertia.velocity(component, u[component]) - beside);
            f_oob[component] += force;
            reaction[component] += force;
        }
    }

    /// N/m  component by component, what they resist a displacement with.
    pub fn stiffness<'a>(&'a self, inertia: &'a Inertia) -> impl Iterator<Item = (usize, f64)> + 'a {
        self.0
            .iter()
            .map(|at| (at.component, at.impedance * inertia.velocity_factor(at.component)))
    }

    /// J  work of the dashpots on this rank's own nodes, relative to what is beside them, without that of what
    /// holds the start.
    pub fn work<const D: usize>(&self, inertia: &Inertia, u: &[f64], halo: &dyn Halo) -> Vec<f64> {
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

impl<const D: usize> Support<D> {
    /// The cell at the face along its axis.
    pub fn last_cell(&self, grid: &Grid<D>) -> usize {
        if self.upper {
            grid.axes()[self.axis].cells() - 1
        } else {
            0
        }
    }
}

impl<const D: usize> Boundary<D> {
    /// The faces that absorb, in the order of the supports.
    pub fn absorbing(&self) -> impl Iterator<Item = &Support<D>> {
        self.supports.iter().filter(|support| support.absorbs)
    }

    /// The same with absorbing faces that hold instead, as ground at rest is held: the normal component, and all where
    /// the face lies across the `pull` of gravity.
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

    /// Whether forces are those of the nodes of the faces that absorb, or none.
    pub fn fits(&self, grid: &Grid<D>, held: &[Vec<Vector<D>>]) -> bool {
        held.is_empty()
            || self
                .absorbing()
                .map(|face| nodes_on(grid, face))
                .eq(held.iter().map(Vec::len))
    }

    /// N  of every node of every absorbing face the nodal `reaction` that holds the state of the start, each once: the
    /// same on every rank.
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
            halo.all_reduce_sum(&mut forces); // of one rank each: exact
            held.push(forces.chunks_exact(D).map(Vector::from_column_slice).collect());
        }
        held
    }
}

/// Weight of the place of a face at a point at `x`, m, over the point's own: a point's mass weighs by its own radius,
/// what it says of the face by the face's.
fn weight_on<K: Kinematics<D>, const D: usize>(grid: &Grid<D>, face: &Support<D>, x: &Vector<D>) -> f64 {
    let length = grid.axes()[face.axis].length();
    let mut on_face = *x;
    on_face[face.axis] = if face.upper { length } else { 0.0 };
    K::weight(&on_face) / K::weight(x)
}

/// The axes along a face.
fn along<const D: usize>(normal: usize) -> impl Iterator<Item = usize> {
    (0..D).filter(move |&axis| axis != normal)
}

/// Nodes of a face of the whole grid.
fn nodes_on<const D: usize>(grid: &Grid<D>, face: &Support<D>) -> usize {
    along::<D>(face.axis)
        .map(|axis| grid.axes()[axis].functions())
        .product()
}

/// Number of a node (local) among those of its face of the whole grid.
fn number_on<const D: usize>(grid: &Grid<D>, face: &Support<D>, node: usize) -> usize {
    let node = grid.node_at(node);
    along::<D>(face.axis).fold(0, |number, axis| number * grid.axes()[axis].functions() + node[axis])
}

/// Sum of what the nodes behind a node of the face have, in the cell at it: of splines that is 1 across the face, so
/// that what the points of the cell bring along is integrated along the face alone.
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
