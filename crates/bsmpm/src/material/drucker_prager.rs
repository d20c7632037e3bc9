//! Drucker-Prager law, theory-manual equations (T4.8), (T4.9): perfectly plastic, non-associated. Stresses return to
//! the cone or its tip.

use super::law::{Branch, FRICTIONAL, Law, Projection, Strength, Variable, frictional, joined, split};
use super::{Elastic, Moduli};
use crate::real::{Real, choose, three};
use crate::tensor::Tensor;

/// Fit of the cone to the Mohr-Coulomb pyramid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Match {
    /// At the edges of triaxial compression; elsewhere the cone is outside of the pyramid.
    Outer,
    /// At the edges of triaxial extension.
    Inner,
    /// At equal limit loads in plane strain with associated flow; for less dilation see
    /// [`DruckerPrager::strength_in_plane_strain`].
    #[default]
    PlaneStrain,
}

impl Match {
    /// Returns the slope η or η_ψ in the mean stress for an angle (rad), and the factor ξ of the cohesion if it is the
    /// friction angle.
    fn slopes(self, angle: f64) -> (f64, f64) {
        let sin = angle.sin();
        let cos = angle.cos();
        let tan = angle.tan();
        match self {
            Self::Outer => (
                6.0 * sin / (3_f64.sqrt() * (3.0 - sin)),
                6.0 * cos / (3_f64.sqrt() * (3.0 - sin)),
            ),
            Self::Inner => (
                6.0 * sin / (3_f64.sqrt() * (3.0 + sin)),
                6.0 * cos / (3_f64.sqrt() * (3.0 + sin)),
            ),
            Self::PlaneStrain => {
                let root = (9.0 + 12.0 * tan * tan).sqrt();
                (3.0 * tan / root, 3.0 / root)
            }
        }
    }
}

/// Law with the elastic domain `√J₂ + η p - ξ c ≤ 0`, p being the mean stress, and the plastic potential `√J₂ + η_ψ p`.
#[derive(Clone, Debug, PartialEq)]
pub struct DruckerPrager {
    elastic: Elastic,
    friction: f64,
    dilation: f64,
    cohesion: f64,
    fit: Match,
    // Precomputed for all responses:
    moduli: Moduli,
    slopes: [f64; 2], // η and η_ψ
    strength: f64,    // ξ c (Pa)
}

/// Return data.
#[derive(Clone, Copy, Debug)]
pub struct DruckerPragerReturn<R: Real> {
    /// Whether the stress returned to the apex; the other data are then meaningless.
    apex: R::Mask,
    /// Principal deviator of the trial divided by its norm (-).
    direction: [R; 3],
    /// Ratio of √J₂ after the return to that of the trial (-).
    kept: R,
    /// Slopes η and η_ψ.
    slopes: [f64; 2],
}

impl DruckerPrager {
    /// Creates a law fitted by `fit` to the pyramid with the friction angle 0 ≤ φ < π/2 (rad), the dilation angle 0 ≤ ψ
    /// ≤ φ (rad) and the cohesion c ≥ 0 (Pa).
    pub fn new(elastic: Elastic, friction: f64, dilation: f64, cohesion: f64, fit: Match) -> Self {
        let moduli = elastic.moduli();
        let (eta, xi) = fit.slopes(friction);
        let slopes = [eta, fit.slopes(dilation).0];
        Self {
            elastic,
            friction,
            dilation,
            cohesion,
            fit,
            moduli,
            slopes,
            strength: xi * cohesion,
        }
    }

    /// Returns the ratio of the shear strength to that of Mohr-Coulomb for continued plastic flow in plane strain.
    ///
    /// Zero plastic strain normal to the plane gives the deviatoric stress -⅔ η_ψ √J₂ in that direction. The radius of
    /// Mohr's circle is then `√(1 - η_ψ²/3) (ξ c - η m)/(1 - η η_ψ/3)`, with the mean stress m in the plane, compared
    /// to `c cos φ - m sin φ`. The ratio is that of the terms in m; without friction that of the terms in c.
    pub fn strength_in_plane_strain(&self) -> f64 {
        let [eta, eta_psi] = self.slopes;
        let (sin, cos) = self.friction.sin_cos();
        let slope = if sin > 0.0 {
            eta / sin
        } else {
            self.fit.slopes(0.0).1 / cos
        };
        slope * (1.0 - eta_psi * eta_psi / 3.0).sqrt() / (1.0 - eta * eta_psi / 3.0)
    }

    /// Returns the ratio of √J₂ to that of a cone with another fit. It does not depend on the mean stress, because all
    /// fits have the same apex.
    pub fn strength_over(&self, other: Match) -> f64 {
        self.fit.slopes(self.friction).1 / other.slopes(self.friction).1
    }

    /// Returns the fit of the cone to the pyramid.
    pub fn fit(&self) -> Match {
        self.fit
    }

    /// Returns the slope η of the cone and its √J₂ at p = 0 (Pa).
    pub fn cone(&self) -> (f64, f64) {
        (self.slopes[0], self.strength)
    }
}

impl Law for DruckerPrager {
    type Flow<R: Real> = DruckerPragerReturn<R>;
    const PARAMETERS: &'static [Variable] = &FRICTIONAL;

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.moduli
    }

    fn parameters(&self) -> Vec<f64> {
        vec![self.friction, self.dilation, self.cohesion]
    }

    /// Returns the law with other parameters; ψ is limited to φ.
    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        let [friction, dilation, cohesion] = frictional(parameters);
        Self::new(elastic, friction, dilation, cohesion, self.fit)
    }

    /// Returns `f = √J₂ + η p - ξ c`.
    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], _state: &[R]) -> R {
        let (mean, _, norm) = split(tau);
        norm * std::f64::consts::FRAC_1_SQRT_2 + mean * self.slopes[0] - self.strength
    }

    /// Returns the stress to the cone: `Δγ = (√J₂ + η p - ξ c)/(μ + K η η_ψ)`, mean stress `p - K η_ψ Δγ`, and √J₂ from
    /// f = 0. If that √J₂ is negative, the stress returns to the apex p = ξ c/η.
    #[inline(always)]
    fn return_map<R: Real>(&self, trial: [R; 3], _state: &[R]) -> Projection<R, DruckerPragerReturn<R>> {
        let Moduli { mu, .. } = self.moduli;
        let [eta, eta_psi] = self.slopes;
        let (mean, deviator, norm) = split(trial);
        let root = norm * std::f64::consts::FRAC_1_SQRT_2;
        let zero = mean.like(0.0);
        let excess = root + mean * eta - self.strength;
        let yields = !excess.at_most(zero);
        if !R::any(yields) {
            let flow = DruckerPragerReturn {
                apex: yields,
                direction: deviator,
                kept: root,
                slopes: self.slopes,
            };
            return Projection {
                tau: trial,
                yields,
                flow,
            };
        }
        let bulk = self.moduli.bulk();
        let p = mean - excess * (bulk * eta_psi) / (mu + bulk * eta * eta_psi);
        let after = -(p * eta) + self.strength;
        let apex = after.below(zero) | root.at_most(zero);
        let kept = after / root;
        let tip = mean.like(self.strength / eta);
        let returned = choose(apex, [tip; 3], joined(p, kept, deviator));
        let tau = choose(yields, returned, trial);
        let direction = three(|k| deviator[k] / norm);
        Projection {
            tau,
            yields,
            flow: DruckerPragerReturn {
                apex,
                direction,
                kept,
                slopes: self.slopes,
            },
        }
    }

    #[inline]
    fn branch(flow: &DruckerPragerReturn<f64>) -> Branch {
        if flow.apex { Branch::Apex } else { Branch::Face }
    }

    /// Returns the tangent. With `A = 1/(μ + K η η_ψ)`, the direction n and the ratio r of √J₂ it is `2μ r (I₄ - ⅓ I ⊗
    /// I) + 2μ (1 - r - μ A) n ⊗ n - √2 μ A K (η n ⊗ I + η_ψ I ⊗ n) + K (1 - K η η_ψ A) I ⊗ I`; 0 at the apex.
    fn tangent(flow: &DruckerPragerReturn<f64>, moduli: Moduli) -> Tensor {
        let DruckerPragerReturn {
            direction: n,
            kept,
            slopes: [eta, eta_psi],
            apex,
        } = *flow;
        if apex {
            return Tensor::zeros();
        }
        let mu = moduli.mu;
        let bulk = moduli.bulk();
        let inverse = 1.0 / (mu + bulk * eta * eta_psi);
        let mixed = std::f64::consts::SQRT_2 * mu * inverse * bulk;
        Tensor::from_fn(|a, b| {
            let deviator = if a == b { 2.0 / 3.0 } else { -1.0 / 3.0 };
            2.0 * mu * (kept * deviator + (1.0 - kept - mu * inverse) * n[a] * n[b])
                - mixed * (eta * n[a] + eta_psi * n[b])
                + bulk * mu * inverse
        })
    }

    /// Returns 2μ r: the return scales all stress differences equally.
    fn secant_modulus(flow: &DruckerPragerReturn<f64>, moduli: Moduli, _tau: f64, _eps: f64) -> f64 {
        if flow.apex { 0.0 } else { 2.0 * moduli.mu * flow.kept }
    }

    fn reduced(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        let Strength {
            friction_angle,
            dilation_angle,
            cohesion,
        } = Strength {
            friction_angle: self.friction,
            dilation_angle: self.dilation,
            cohesion: self.cohesion,
        }
        .reduced(factor);
        Self::new(self.elastic, friction_angle, dilation_angle, cohesion, self.fit)
    }

    fn dilation(&self) -> f64 {
        self.dilation
    }
}
