//! Unknowns of a step: which nodal components are free, prescribed, or tied to others.

use crate::grid::Grid;
use crate::parallel::Halo;
use crate::step::apart::MaterialNodeSets;
use crate::step::extension::Extension;

/// Choice of the unknowns, equal on all ranks that share a node.
#[derive(Clone, Debug)]
pub struct Constraints<const D: usize> {
    /// Per node: whether its spline covers an occupied cell.
    pub active: Vec<bool>,
    /// Prescribed displacement of the step per component (m); `None` where it is not prescribed.
    pub prescribed: Vec<Option<f64>>,
    /// Per component: whether it is an unknown of the linear system.
    pub free: Vec<bool>,
    /// Splines that are tied to others, if any.
    pub extension: Option<Extension<D>>,
    /// Nodes that only one material touches, in a case with several materials.
    pub apart: Option<MaterialNodeSets>,
    /// Active nodes, over all ranks.
    pub active_nodes: usize,
    /// Unknowns, over all ranks.
    pub unknowns: usize,
    /// Active nodes without mass, over all ranks.
    pub massless_nodes: usize,
}

impl<const D: usize> Constraints<D> {
    /// Creates the constraints before splines are tied, and before nodes are counted.
    pub fn new(active: Vec<bool>, prescribed: Vec<Option<f64>>, free: Vec<bool>) -> Self {
        Self {
            active,
            prescribed,
            free,
            extension: None,
            apart: None,
            active_nodes: 0,
            unknowns: 0,
            massless_nodes: 0,
        }
    }

    /// Sets the tied components of a nodal displacement or its change, D numbers per node, see [`Extension::extend`].
    pub fn extend(&self, grid: &Grid<D>, u: &mut [f64], halo: &dyn Halo) {
        if let Some(extension) = &self.extension {
            extension.extend(grid, u, halo);
        }
    }

    /// Moves nodal forces, D numbers per node, from tied components to unknowns, see [`Extension::reduce`].
    pub fn reduce(&self, forces: &mut [&mut [f64]], halo: &dyn Halo) {
        if let Some(extension) = &self.extension {
            extension.reduce(forces, halo);
        }
    }
}
