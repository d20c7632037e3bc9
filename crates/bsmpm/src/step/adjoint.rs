//! Internal force of consistent F-bar in dilatant material, theory-manual equation (T3.9). It replaces the mean stress
//! in (T5.1).

use crate::kinematics::Kinematics;
use crate::material::LayeredMaterial;
use crate::model::Model;
use crate::points::Points;
use crate::step::problem::Problem;
use crate::step::trial::DeformationIncrement;
use crate::tensor::{Symmetric, Tensor};

/// Dilation angle above which the adjoint force is used (rad): 6 degrees. In the short collapse it reduces noise above
/// a threshold between 5 and 7.5 degrees.
const DILATANT: f64 = 0.105;

/// Returns whether a material dilates so much that the adjoint force is used. Materials with and without this force
/// belong to different [`Groups`](crate::stabilisation::Groups).
pub fn is_dilatant(material: &LayeredMaterial) -> bool {
    material.dilation() > DILATANT
}

/// Marks the points that have the adjoint force.
#[derive(Clone, Debug)]
pub struct Adjoint {
    groups: Vec<bool>,
}

impl Adjoint {
    /// Selects groups with a dilatant material, under consistent and sub-grid F-bar; `None` if there are none.
    pub fn of<K, const D: usize>(model: &Model<K, D>) -> Option<Self> {
        if !model.stabilisation.lowers() {
            return None;
        }
        let mut groups = vec![false; model.groups.count()];
        for (number, material) in model.materials.iter().enumerate() {
            groups[model.groups.of(number as u16)] |= is_dilatant(material);
        }
        groups.contains(&true).then_some(Self { groups })
    }

    /// Returns whether point `p` has the adjoint force.
    #[inline]
    pub fn has<K, const D: usize>(&self, model: &Model<K, D>, points: &Points<D>, p: usize) -> bool {
        self.groups[model.groups.of(points.material[p])]
    }
}

/// Averaged mean stress times volume, pi-bar, of the points with the adjoint force (J).
#[derive(Clone, Debug)]
pub struct Pressures(Option<Vec<Option<f64>>>);

impl Pressures {
    /// Computes the pressures of a trial deformation. One exchange with the neighbours if any point has the adjoint
    /// force.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        trial: &DeformationIncrement<K, D>,
    ) -> Self {
        let Some(adjoint) = Adjoint::of(problem.model) else {
            return Self(None);
        };
        let Problem { model, points, .. } = *problem;
        let volume = problem.volume();
        let transposed = transposed(problem, &adjoint, trial, |p| match trial.respond(model, points, p) {
            Ok(response) => volume[p] * works::<K, D>(&response.tau().full()) / trial.mean_dJ(p),
            Err(_) => 0.0, // the residual refuses such a point
        });
        let pressures = transposed
            .into_iter()
            .enumerate()
            .map(|(p, pressure)| adjoint.has(model, points, p).then_some(pressure));
        Self(Some(pressures.collect()))
    }

    /// Returns pi-bar of point `p` (J), if it has the adjoint force.
    #[inline]
    pub fn at(&self, p: usize) -> Option<f64> {
        self.0.as_ref().and_then(|pressures| pressures[p])
    }

    /// Returns the Kirchhoff stress whose internal force acts at point `p` (Pa): `tau` with its mean stress replaced by
    /// pi-bar / `volume`.
    #[inline]
    pub fn acting<K: Kinematics<D>, const D: usize>(&self, p: usize, volume: f64, mut tau: Symmetric) -> Symmetric {
        if let Some(pressure) = self.at(p) {
            let more = pressure / volume - works::<K, D>(&tau.full());
            tau.0[..3].iter_mut().for_each(|normal| *normal += more);
        }
        tau
    }
}

/// Computes m_p w_p dJ_p sum_A A_p (1/m_A) sum_r A_r value_r over points r with the adjoint force, the transpose of the
/// average.
pub fn transposed<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    adjoint: &Adjoint,
    trial: &DeformationIncrement<K, D>,
    value: impl Fn(usize) -> f64 + Sync,
) -> Vec<f64> {
    let Problem {
        model,
        shape,
        nodes,
        points,
        halo,
        ..
    } = *problem;
    let weights = nodes.dilation_weights(model, points);
    let mut sums = nodes.mean_dilation(model, shape, points, halo, |p| {
        if adjoint.has(model, points, p) {
            value(p) / weights[p]
        } else {
            0.0
        }
    });
    for (p, sum) in sums.iter_mut().enumerate() {
        *sum *= weights[p] * trial.dJ(p);
    }
    sums
}

/// Returns the work of a stress per unit of dilation in the grid's directions.
#[inline]
pub fn works<K: Kinematics<D>, const D: usize>(stress: &Tensor) -> f64 {
    stress.diagonal().dot(&K::dilation().diagonal())
}
