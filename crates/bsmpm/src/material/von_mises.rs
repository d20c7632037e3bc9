//! Von Mises law with linear isotropic hardening (T4.10).

use super::law::{Branch, Law, Projection, Variable, joined, split};
use super::{Elastic, Moduli};
use crate::real::{Real, choose, three};
use crate::tensor::Tensor;

/// Associated plasticity with the elastic domain `q = √(3/2) |s| ≤ σ_y + H κ`: s is the deviator of τ, κ the equivalent
/// plastic strain.
#[derive(Clone, Debug, PartialEq)]
pub struct VonMises {
    elastic: Elastic,
    moduli: Moduli,
    yield_stress: f64,
    hardening: f64,
}

/// Return data.
#[derive(Clone, Copy, Debug)]
pub struct VonMisesReturn<R> {
    /// Principal deviator of the trial divided by its norm (-).
    direction: [R; 3],
    /// Ratio of q after the return to that of the trial (-).
    kept: R,
    /// Derivative of q after the return with respect to q of the trial (-).
    followed: f64,
    /// Growth of κ (-).
    growth: R,
}

impl VonMises {
    /// Creates a law with the uniaxial yield stress σ_y > 0 (Pa) and the hardening modulus H ≥ 0 (Pa), dσ_y per plastic
    /// strain.
    pub fn new(elastic: Elastic, yield_stress: f64, hardening: f64) -> Self {
        let moduli = elastic.moduli();
        Self {
            elastic,
            moduli,
            yield_stress,
            hardening,
        }
    }

    /// Returns the yield stress for the plastic strain in `state` (Pa).
    #[inline(always)]
    fn strength<R: Real>(&self, state: &[R]) -> R {
        state[0] * self.hardening + self.yield_stress
    }
}

impl Law for VonMises {
    type Flow<R: Real> = VonMisesReturn<R>;
    const PARAMETERS: &'static [Variable] = &[Variable::new("yield_stress", "Pa"), Variable::new("hardening", "Pa")];
    const STATE: &'static [Variable] = &[Variable::new("hardening_strain", "-")];

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.moduli
    }

    fn parameters(&self) -> Vec<f64> {
        vec![self.yield_stress, self.hardening]
    }

    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        Self::new(elastic, parameters[0], parameters[1])
    }

    /// Returns `f = q - σ_y - H κ`.
    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], state: &[R]) -> R {
        split(tau).2 * 1.5_f64.sqrt() - self.strength(state)
    }

    /// Returns the stress along the deviator: `Δκ = (q_trial - σ_y - H κ)/(3μ + H)`, `s = s_trial (1 - 3μ Δκ/q_trial)`.
    #[inline(always)]
    fn return_map<R: Real>(&self, trial: [R; 3], state: &[R]) -> Projection<R, VonMisesReturn<R>> {
        let (mean, deviator, norm) = split(trial);
        let q = norm * 1.5_f64.sqrt();
        let strength = self.strength(state);
        let yields = !q.at_most(strength);
        if !R::any(yields) {
            let flow = VonMisesReturn {
                direction: deviator,
                kept: q,
                followed: 0.0,
                growth: q,
            };
            return Projection {
                tau: trial,
                yields,
                flow,
            };
        }
        let shear = 3.0 * self.moduli.mu;
        let growth = (q - strength) / (shear + self.hardening);
        // The form 1 - 3μ Δκ/q would cancel for trials far outside.
        let kept = (q * self.hardening + strength * shear) / (q * (shear + self.hardening));
        let tau = choose(yields, joined(mean, kept, deviator), trial);
        let direction = three(|k| deviator[k] / norm);
        let followed = self.hardening / (shear + self.hardening);
        Projection {
            tau,
            yields,
            flow: VonMisesReturn {
                direction,
                kept,
                followed,
                growth,
            },
        }
    }

    fn branch(_flow: &VonMisesReturn<f64>) -> Branch {
        Branch::Face
    }

    /// Returns `K I ⊗ I + 2μ (r (I₄ - ⅓ I ⊗ I) + (r' - r) n ⊗ n)` with r = q/q_trial and r' = dq/dq_trial.
    fn tangent(flow: &VonMisesReturn<f64>, moduli: Moduli) -> Tensor {
        let VonMisesReturn {
            direction: n,
            kept,
            followed,
            ..
        } = *flow;
        Tensor::from_fn(|a, b| {
            let deviator = if a == b { 2.0 / 3.0 } else { -1.0 / 3.0 };
            moduli.bulk() + 2.0 * moduli.mu * (kept * deviator + (followed - kept) * n[a] * n[b])
        })
    }

    /// Returns 2μ r: the return scales all stress differences equally.
    fn secant_modulus(flow: &VonMisesReturn<f64>, moduli: Moduli, _tau: f64, _eps: f64) -> f64 {
        2.0 * moduli.mu * flow.kept
    }

    fn advance(flow: &VonMisesReturn<f64>, state: &mut [f64]) {
        state[0] += flow.growth;
    }

    fn hardens(&self) -> bool {
        self.hardening > 0.0
    }

    fn reduced(self, factor: f64) -> Self {
        Self::new(self.elastic, self.yield_stress / factor, self.hardening / factor)
    }
}
