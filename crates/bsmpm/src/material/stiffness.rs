//! Symmetric positive definite approximation (Higham, 1988) of the tangent at a yielding material point, theory-manual
//! equation (T5.7), for the stiffness matrix.

use super::Response;
use super::law::Branch;
use super::tangent::{PAIRS, slope};
use crate::kinematics::Gradient;
use crate::tensor::Tensor;
use std::f64::consts::FRAC_1_SQRT_2;

/// Fraction of the elastic stiffness. Smaller values need fewer iterations in small steps, and more in large ones
/// (decisions of the manual, 2026-11-21).
const ELASTIC: f64 = 0.1;
/// Plastic strain below which a response counts as elastic. A stress on the yield surface exceeds it or not by
/// round-off, which must not change the stiffness.
const FLOW: f64 = 1e-10;
/// 1/sqrt(6).
const FRAC_1_SQRT_6: f64 = 0.408_248_290_463_863;
/// Orthonormal basis of isochoric principal strains.
const SHAPES: [[f64; 3]; 2] = [
    [FRAC_1_SQRT_2, -FRAC_1_SQRT_2, 0.0],
    [FRAC_1_SQRT_6, FRAC_1_SQRT_6, -2.0 * FRAC_1_SQRT_6],
];

/// Stiffness as a linear map of the symmetric part of a displacement gradient, in the axes of the trial b.
#[derive(Clone, Copy, Debug)]
pub struct Stiffness {
    /// Axes of b, one per row (-).
    axes: Tensor,
    /// Principal stresses per principal strain, symmetric positive definite (Pa).
    principal: Tensor,
    /// Shear moduli of the pairs of axes 12, 23 and 13, positive (Pa).
    shear: [f64; 3],
}

impl Stiffness {
    pub(super) fn of(response: &Response) -> Self {
        let moduli = response.flowed.elastic_moduli(response.moduli);
        let tangent = response.flowed.tangent(response.moduli);
        let deviatoric = positive([[0, 0], [1, 1], [0, 1]].map(|[i, j]| {
            let terms = (0..9).map(|k| {
                let entry = 0.5 * (tangent[(k / 3, k % 3)] + tangent[(k % 3, k / 3)]);
                SHAPES[i][k / 3] * entry * SHAPES[j][k % 3]
            });
            terms.sum()
        }));
        let [a, b, c] = [0, 1, 2].map(|k| stiffened(deviatoric[k], if k < 2 { 2.0 * moduli.mu } else { 0.0 }));
        let bulk = stiffened(tangent.sum().max(0.0) / 9.0, moduli.bulk());
        let [first, second] = SHAPES;
        let axis = response.trial.axis();
        Self {
            axes: Tensor::from_fn(|i, j| axis[i][j]),
            principal: Tensor::from_fn(|i, j| {
                let mixed = first[i] * second[j] + second[i] * first[j];
                bulk + a * first[i] * first[j] + b * second[i] * second[j] + c * mixed
            }),
            shear: PAIRS.map(|(a, b)| stiffened(0.5 * slope(response, a, b), moduli.mu)),
        }
    }

    /// Returns the stresses of all unit displacement gradients of the geometry (Pa). In the axes of b they are
    /// `D_AB ε_BB` and `2 G_AB ε_AB`, with the symmetric part ε of the gradient. `seen` reduces a stress to the
    /// components that do work on gradients, the adjoint of the conversion of gradients to tensors.
    ///
    /// The map is `Σ D_AB v_A ⊗ v_B + Σ G_AB w_AB ⊗ w_AB`, with v_A the reduced `n_A n_Aᵀ` and w_AB the reduced
    /// `n_A n_Bᵀ + n_B n_Aᵀ`, so that unit gradients and stresses need no rotation.
    #[inline(always)]
    pub fn moduli<G: Gradient<D>, const D: usize>(&self, seen: impl Fn(&Tensor) -> G) -> G::Moduli {
        let n = &self.axes;
        let dyad = |a: usize| seen(&Tensor::from_fn(|i, j| n[(a, i)] * n[(a, j)]));
        let pair =
            |(a, b): (usize, usize)| seen(&Tensor::from_fn(|i, j| n[(a, i)] * n[(b, j)] + n[(b, i)] * n[(a, j)]));
        let v = [dyad(0), dyad(1), dyad(2)];
        let w = [pair(PAIRS[0]), pair(PAIRS[1]), pair(PAIRS[2])];
        let mut moduli = G::moduli(|_, _| G::zeros());
        for m in 0..3 {
            let [a, b, c] = [self.principal[(m, 0)], self.principal[(m, 1)], self.principal[(m, 2)]];
            let stress = v[0] * a + v[1] * b + v[2] * c;
            let shear = w[m] * self.shear[m];
            for k in 0..D {
                (0..k).for_each(|l| moduli[(k, l)] = moduli[(l, k)]);
                for l in k..G::SLOPES {
                    moduli[(k, l)] += stress * v[m][(k, l)] + shear * w[m][(k, l)];
                }
            }
        }
        moduli
    }
}

impl Response {
    /// Returns the stiffness of a yielding response for use with many gradients; `None` if it equals the linear elastic
    /// one, except for round-off.
    #[inline]
    pub fn yielding(&self) -> Option<Stiffness> {
        if self.branch() == Branch::Elastic {
            return (!self.flowed.is_linear()).then(|| Stiffness::of(self));
        }
        let trial = self.principal_eps_trial();
        let elastic = self.principal_eps_e();
        let flows = (0..3).any(|k| (trial[k] - elastic[k]).abs() > FLOW);
        (flows || !self.flowed.is_linear()).then(|| Stiffness::of(self))
    }
}

/// Adds the fraction of the elastic modulus to a plastic modulus.
fn stiffened(plastic: f64, elastic: f64) -> f64 {
    plastic + ELASTIC * (elastic - plastic)
}

/// Removes the negative eigenvalue, if any, from the symmetric matrix [[a, c], [c, b]].
fn positive([a, b, c]: [f64; 3]) -> [f64; 3] {
    let mean = 0.5 * (a + b);
    let radius = (0.25 * (a - b).powi(2) + c * c).sqrt();
    let most = mean + radius;
    let least = mean - radius;
    if least >= 0.0 {
        [a, b, c]
    } else if most <= 0.0 {
        [0.0; 3]
    } else {
        [a - least, b - least, c].map(|entry| most / (2.0 * radius) * entry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_positive_part_keeps_positive_eigenvalues_and_drops_others() {
        assert_eq!(positive([2.0, 1.0, 0.5]), [2.0, 1.0, 0.5]);
        assert_eq!(positive([-2.0, -1.0, 0.5]), [0.0; 3]);
        // Eigenvalues 3 along (1, 1)/sqrt 2 and -1 across it.
        assert_eq!(positive([1.0, 1.0, 2.0]), [1.5, 1.5, 1.5]);
    }
}
