//! Weights of the averages over material points, equations 16 to 20 of Xie et al. (2023), and the projection to the
//! nodes and back.

use crate::grid::{Shape, transfer};
use crate::model::{AverageWeight, Model};
use crate::parallel::Halo;
use crate::points::Points;
use crate::stabilisation::{GroupedPoints, Stabilisation};

/// Fraction of the largest nodal mass below which a node has no velocity, acceleration or average, so that 1/m stays
/// bounded.
pub(super) const MASSLESS: f64 = 1e-14;

/// Weights of averages over points, separate for each group of materials, and of integrals.
#[derive(Clone, Debug)]
pub(super) struct Averages<const D: usize> {
    /// Weights of the nodes (m^D or kg); `None`: the weights in `GridState`.
    pub weight: Option<Vec<f64>>,
    /// Weight at and below which a node has no average.
    pub threshold: f64,
    /// Weight in `GridState` at and below which a node counts as massless.
    pub massless: f64,
    /// Splines of degree q - 1 at the points and their nodal weights, for averages of dilations under consistent and
    /// sub-grid F-bar. Numbered like the nodes (see [`Shape::lowered`]); splines without points have zero weight.
    pub lower: Option<(Shape<D>, Vec<f64>)>,
    /// Weights of the points in averages of dilations (m^D or kg); `None`: as in all averages.
    pub of_points: Option<Vec<f64>>,
    /// Weights of the points in the integrals of the stress (m^D); `None`: their volumes.
    pub fitted: Option<Vec<f64>>,
}

/// Lumped L2 projection onto the splines of `shape` (Eqs 16, 17).
pub(super) struct Projection<'a, const D: usize> {
    pub shape: &'a Shape<D>,
    pub weight: &'a [f64],
    pub threshold: f64, // weight at and below which a projected value is zero
}

impl<const D: usize> Projection<'_, D> {
    /// Returns `found(p, mean)` with the projected `value` at every point p. `weights` are those of the points.
    pub fn average<const C: usize, T: Clone + Send>(
        &self,
        grouped: GroupedPoints<'_>,
        weights: &[f64],
        halo: &dyn Halo,
        value: impl Fn(usize) -> [f64; C] + Sync,
        found: impl Fn(usize, [f64; C]) -> T + Sync,
    ) -> Vec<T> {
        let mut nodal = halo.assemble_ghosts(&transfer::to_nodes_grouped(self.shape, grouped, |p| {
            value(p).map(|v| weights[p] * v)
        }));
        transfer::divide(&mut nodal, self.weight, self.threshold);
        transfer::to_points_grouped(self.shape, grouped, &nodal, found)
    }
}

impl<const D: usize> Averages<D> {
    /// Computes the weights of averages. `massless` is the threshold of the nodes' own weights.
    pub fn of<K>(model: &Model<K, D>, shape: &Shape<D>, points: &Points<D>, massless: f64, halo: &dyn Halo) -> Self {
        let weights = weights(model.weighting, points);
        let grouped = model.grouped(points);
        let of_points: Option<Vec<f64>> = (model.is_coupled() && model.stabilisation.lowers()).then(|| {
            weights
                .iter()
                .zip(points.F.iter())
                .map(|(weight, F)| weight * F.determinant())
                .collect()
        });
        let lower = model.stabilisation.lowers().then(|| {
            let mut lower = shape.lowered(&model.grid, points);
            if model.stabilisation == Stabilisation::SubgridFBar {
                lower = lower.merged(&model.grid, grouped, halo);
            }
            let weight = scatter_grouped(&lower, grouped, of_points.as_deref().unwrap_or(weights), halo);
            (lower, weight)
        });
        let own = grouped.count() > 1 || model.weighting != model.inertial_weighting();
        let of_nodes = (model.stabilisation.averages() && own).then(|| scatter_grouped(shape, grouped, weights, halo));
        Self {
            threshold: of_nodes.as_ref().map_or(massless, |weight| threshold(weight, halo)),
            massless,
            weight: of_nodes,
            lower,
            of_points,
            fitted: None,
        }
    }
}

/// Returns the weights of the points (kg or m^D).
pub(super) fn weights<const D: usize>(weighting: AverageWeight, points: &Points<D>) -> &[f64] {
    match weighting {
        AverageWeight::Mass => &points.mass,
        AverageWeight::Volume => &points.volume,
    }
}

/// Sums the points' `weights` at the nodes, separately for each group of materials.
fn scatter_grouped<const D: usize>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    weights: &[f64],
    halo: &dyn Halo,
) -> Vec<f64> {
    halo.assemble_ghosts(&transfer::to_nodes_grouped(shape, grouped, |p| [weights[p]]))
}

/// Returns the weight at and below which a node counts as massless.
pub(super) fn threshold(weight: &[f64], halo: &dyn Halo) -> f64 {
    let mut heaviest = [weight.iter().copied().fold(0.0, f64::max)];
    halo.all_reduce_max(&mut heaviest);
    MASSLESS * heaviest[0]
}
