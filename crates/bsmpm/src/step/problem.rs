//! Data of a step that do not change during its iterations.

use crate::dynamics::mass::Mass;
use crate::grid::Shape;
use crate::interactions::StepContext;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::step::nodes::GridState;

/// Quantities that stay constant during the iterations of a step.
pub struct Problem<'a, K, const D: usize> {
    /// Grid, materials, supports and convergence criteria.
    pub model: &'a Model<K, D>,
    /// Shape functions at the material points, step (1).
    pub shape: &'a Shape<D>,
    /// Nodal quantities, step (2).
    pub nodes: &'a GridState<D>,
    /// Material points at the start of the step.
    pub points: &'a Points<D>,
    /// Communication with the other ranks.
    pub halo: &'a dyn Halo,
}

impl<'a, K, const D: usize> Problem<'a, K, D> {
    /// Returns the mass matrix (for dynamics).
    pub fn mass(&self) -> Mass<'_, D> {
        self.nodes.mass(self.model, self.shape, self.points, self.halo)
    }

    /// Returns the data of the step that interactions use.
    pub fn context(&self) -> StepContext<'a, D> {
        self.nodes.context(self.model, self.shape, self.points, self.halo)
    }

    /// Returns the integration weights of the points for the stress (m^D of reference volume).
    #[inline]
    pub fn volume(&self) -> &'a [f64] {
        self.nodes.volume(self.points)
    }
}
