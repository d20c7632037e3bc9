//! What holds and loads the bodies: supports at the faces of the grid, rigid strips, tractions and point loads.
#![doc = include_str!("boundary.md")]

pub mod anchor;
pub mod load;
pub mod strip;
pub mod surface;

pub use load::Load;
pub use strip::{Path, Strip, StripReport};
pub use surface::{Anchors, Surface, SurfacePoint};

use crate::exact::Exact;
use crate::grid::Grid;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::tensor::Vector;

/// Motion of one face of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support<const D: usize> {
    /// axis that the face is normal to
    pub axis: usize,
    /// the face at the axis' upper end
    pub upper: bool,
    /// per component: velocity of the prescribed motion (m per unit of time), 0 where it is held, `None` where free
    pub velocity: [Option<f64>; D],
}

impl<const D: usize> Support<D> {
    /// All components held.
    pub fn fixed(axis: usize, upper: bool) -> Self {
        Self { axis, upper, velocity: [Some(0.0); D] }
    }

    /// The normal component held.
    pub fn roller(axis: usize, upper: bool) -> Self {
        let mut velocity = [None; D];
        velocity[axis] = Some(0.0);
        Self { axis, upper, velocity }
    }
}

/// All that holds and loads a scene besides gravity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundary<const D: usize> {
    /// Supports of the faces; where faces meet, the one named last decides a component that both prescribe.
    pub supports: Vec<Support<D>>,
    /// Rigid strips.
    pub strips: Vec<Strip<D>>,
    /// Tractions and point loads.
    pub loads: Vec<Load<D>>,
}

impl<const D: usize> Boundary<D> {
    /// The state of strips and loads at the start: no traction, every point at its place.
    pub fn surface(&self) -> Surface<D> {
        let at_rest = |strip: &Strip<D>| vec![Vector::zeros(); strip.points.len()];
        Surface {
            traction: self.strips.iter().map(at_rest).collect(),
            position: self.loads.iter().map(|load| load.points.iter().map(|point| point.x).collect()).collect(),
            anchors: Anchors::default(),
        }
    }

    /// The faces of the grid that no material leaves, per axis the lower and the upper one: their normal component is
    /// held.
    pub fn closed(&self) -> [[bool; 2]; D] {
        let mut closed = [[false; 2]; D];
        for support in &self.supports {
            closed[support.axis][usize::from(support.upper)] = support.velocity[support.axis] == Some(0.0);
        }
        closed
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

    /// Force of every support on the body: the nodal `reaction` summed over the components that it decides, N.
    pub fn reactions(&self, grid: &Grid<D>, reaction: &[f64], halo: &dyn Halo) -> Vec<Vec<f64>> {
        let owned = halo.owned();
        let mut counted = vec![false; reaction.len()];
        let mut sums = vec![Exact::default(); self.supports.len() * D];
        for (support, sum) in self.supports.iter().zip(sums.chunks_exact_mut(D)).rev() {
            for node in grid.face_nodes(support.axis, support.upper) {
                for component in (0..D).filter(|&component| support.velocity[component].is_some()) {
                    if !std::mem::replace(&mut counted[Nodal::<D>::at(node, component)], true) && owned.contains(&node)
                    {
                        sum[component].add(reaction[Nodal::<D>::at(node, component)]);
                    }
                }
            }
        }
        halo.total(&sums).chunks_exact(D).map(<[f64]>::to_vec).collect()
    }
}
