//! Isotropic elasticity between Hencky strain and Kirchhoff stress, theory-manual equation (T4.2).

use crate::real::{Real, three};
use crate::tensor::Tensor;

/// Isotropic linear elasticity between Hencky strain and Kirchhoff stress: `τ = λ tr(ε) I + 2μ ε`.
#[derive(Clone, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Poisson's ratio ν, -1 < ν < ½ (-).
    pub poisson: f64,
}

impl Elastic {
    /// Returns the constrained modulus `M = λ + 2μ`, stress per strain without lateral strain (Pa).
    pub fn oedometric(&self) -> f64 {
        let Moduli { lambda, mu } = self.moduli();
        lambda + 2.0 * mu
    }

    /// Returns the Lamé constants: `λ = E ν/((1 + ν)(1 - 2ν))`, `μ = E/(2(1 + ν))`.
    #[inline]
    pub fn moduli(&self) -> Moduli {
        let mu = 0.5 * self.young / (1.0 + self.poisson);
        let lambda = 2.0 * mu * self.poisson / (1.0 - 2.0 * self.poisson);
        Moduli { lambda, mu }
    }
}

/// Lamé constants (Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moduli {
    /// First Lamé constant λ (Pa).
    pub lambda: f64,
    /// Shear modulus μ (Pa).
    pub mu: f64,
}

impl Moduli {
    /// Returns the stress `τ_A = λ Σ_B ε_B + 2μ ε_A`.
    #[inline(always)]
    pub(super) fn stress<R: Real>(&self, eps: [R; 3]) -> [R; 3] {
        let spherical = (eps[0] + eps[1] + eps[2]) * self.lambda;
        three(|k| spherical + eps[k] * (2.0 * self.mu))
    }

    /// Returns the inverse of [`Moduli::stress`]: `ε_A = (τ_A - p)/(2μ) + p/(3K)`, p being the mean stress.
    #[inline]
    pub(super) fn strain(&self, tau: [f64; 3]) -> [f64; 3] {
        let mean = (tau[0] + tau[1] + tau[2]) / 3.0;
        let spherical = mean / (3.0 * self.bulk());
        tau.map(|t| (t - mean) / (2.0 * self.mu) + spherical)
    }

    /// Returns the tangent `D_AB = ∂τ_A/∂ε_B = λ + 2μ δ_AB`.
    pub(super) fn tangent(&self) -> Tensor {
        Tensor::from_element(self.lambda) + Tensor::identity() * (2.0 * self.mu)
    }

    /// Returns the energy per volume (J/m3): `½ λ tr(ε)² + μ ε : ε`.
    pub(super) fn energy(&self, eps: [f64; 3]) -> f64 {
        0.5 * self.lambda * (eps[0] + eps[1] + eps[2]).powi(2) + self.mu * eps.iter().map(|e| e * e).sum::<f64>()
    }

    /// Returns the bulk modulus `K = λ + ⅔ μ`.
    #[inline]
    pub(super) fn bulk(&self) -> f64 {
        self.lambda + self.mu * (2.0 / 3.0)
    }
}
