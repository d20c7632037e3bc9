//! Data of a step that do not change during its iterations.

use crate::boundary::strip::StripConstraints;
use crate::grid::Shape;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::step::mass::Mass;
use crate::step::nodes::GridState;

/// Everything that is fixed while a step is iterated.
pub struct Problem<'a, K, const D: usize> {
    /// grid, materials, supports and the measures of convergence
    pub model: &'a Model<K, D>,
    /// step (1)
    pub shape: &'a Shape<D>,
    /// step (2)
    pub nodes: &'a GridState<D>,
    /// strips, attached to the nodes
    pub attachments: &'a StripConstraints<D>,
    /// state at t
    pub points: &'a Points<D>,
    /// the other ranks
    pub halo: &'a dyn Halo,
}

impl<'a, K, const D: usize> Problem<'a, K, D> {
    /// The mass matrix, in dynamics.
    pub fn mass(&self) -> Mass<'_, D> {
        self.nodes.mass(self.model, self.shape, self.points, self.halo)
    }

    /// What the points weigh in the integrals of the stress, m^D of the reference volume.
    #[inline]
    pub fn volume(&self) -> &'a [f64] {
        self.nodes.volume(self.points)
    }
}
