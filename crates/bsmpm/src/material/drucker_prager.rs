//! Drucker-Prager law, theory-manual equations (T4.8), (T4.9): perfectly plastic, non-associated. Stresses return to
//! the cone or its tip.

use super::law::{Branch, FRICTIONAL, Law, Projection, Strength, Variable, frictional, split};
use super::{Elastic, Moduli};
use crate::real::{Real, three};
use crate::tensor::Tensor;

/// Where the cone meets Mohr-Coulomb's pyramid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Match {
    /// At the edges of triaxial compression: outside of it elsewhere.
    Outer,
    /// At the edges of triaxial extension.
    Inner,
    /// Where both have the same limit load in plane strain, with associated flow: see
    /// [`DruckerPrager::strength_in_plane_strain`] for less dilation.
    #[default]
    PlaneStrain,
}

impl Match {
    /// Of an angle (rad) its slope in the mean stress, η or η_ψ, and of the friction angle the factor ξ of the
    /// cohesion.
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

/// Elastic inside `√J₂ + η p - ξ c ≤ 0`, p the mean stress; plastic potential `√J₂ + η_ψ p`.
#[derive(Clone, Debug, PartialEq)]
pub struct DruckerPrager {
    elastic: Elastic,
    friction: f64,
    dilation: f64,
    cohesion: f64,
    fit: Match,
    // What every response needs, formed once:
    moduli: Moduli,
    slopes: [f64; 2], // η and η_ψ
    strength: f64,    // Pa  ξ c
}

/// What a return leaves.
#[derive(Clone, Copy, Debug)]
pub struct DruckerPragerReturn<R: Real> {
    /// to the tip, where the rest has no meaning
    apex: R::Mask,
    /// (-)  principal deviator of the trial over its norm
    direction: [R; 3],
    /// (-)  √J₂ after the return over that of the trial
    kept: R,
    /// η and η_ψ
    slopes: [f64; 2],
}

impl DruckerPrager {
    /// A law that meets the pyramid of friction angle 0 ≤ φ < π/2 (rad), dilation angle 0 ≤ ψ ≤ φ (rad) and cohesion
    /// c ≥ 0 (Pa) as `fit` says.
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

    /// Shear strength over that of Mohr-Coulomb where plastic flow goes on in plane strain.
    ///
    /// No plastic strain along the normal makes its deviatoric stress -⅔ η_ψ √J₂, so that the radius of Mohr's circle
    /// is `√(1 - η_ψ²/3) (ξ c - η m)/(1 - η η_ψ/3)`, m the mean stress in the plane, for `c cos φ - m sin φ`: the ratio
    /// of the terms in m, without friction of those in c.
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

    /// √J₂ over that of the cone which meets the pyramid elsewhere, at any mean stress: all have one tip.
    pub fn strength_over(&self, other: Match) -> f64 {
        self.fit.slopes(self.friction).1 / other.slopes(self.friction).1
    }

    /// Where the cone meets the pyramid.
    pub fn fit(&self) -> Match {
        self.fit
    }

    /// Slope η of the cone, and its √J₂ at p = 0 in Pa.
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

    /// ψ is at most φ.
    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        let [friction, dilation, cohesion] = frictional(parameters);
        Self::new(elastic, friction, dilation, cohesion, self.fit)
    }

    /// `f = √J₂ + η p - ξ c`.
    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], _state: &[R]) -> R {
        let (mean, _, norm) = split(tau);
        norm * std::f64::consts::FRAC_1_SQRT_2 + mean * self.slopes[0] - self.strength
    }

    /// `Δγ = (√J₂ + η p - ξ c)/(μ + K η η_ψ)`, `p - K η_ψ Δγ`, and √J₂ from f = 0; where that is negative the tip,
    /// p = ξ c/η.
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
        let returned = three(|k| R::choose(apex, tip, p + kept * deviator[k]));
        let tau = three(|k| R::choose(yields, returned[k], trial[k]));
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

    /// With `A = 1/(μ + K η η_ψ)`, n the direction and r what is kept of √J₂:
    /// `2μ r (I₄ - ⅓ I ⊗ I) + 2μ (1 - r - μ A) n ⊗ n - √2 μ A K (η n ⊗ I + η_ψ I ⊗ n) + K (1 - K η η_ψ A) I ⊗ I`;
    /// at the tip 0.
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

    /// All differences are kept alike.
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
