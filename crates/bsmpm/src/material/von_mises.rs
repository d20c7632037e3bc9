//! Von Mises plasticity with linear isotropic hardening (de Souza Neto et al., 2008, sections 7.3 and 7.4): clay without
//! drainage whose strength does not depend on the direction of shear, metal.
//!
//! One elastic trial stress returns along its own deviator, which is the radius of a cylinder.

use super::law::{Branch, Flow, Law, Variable, split};
use super::{Elastic, Moduli};
use crate::tensor::Tensor;

/// Elastic inside `q = √(3/2) |s| ≤ σ_y + H κ`, s the deviator of τ and κ the equivalent plastic strain; associated.
#[derive(Clone, Debug, PartialEq)]
pub struct VonMises {
    elastic: Elastic,
    moduli: Moduli,
    yield_stress: f64,
    hardening: f64,
}

/// What a return leaves.
#[derive(Clone, Copy, Debug)]
pub struct VonMisesReturn {
    /// (-)  principal deviator of the trial over its norm
    direction: [f64; 3],
    /// (-)  q after the return over that of the trial
    kept: f64,
    /// (-)  dq of the return over dq of the trial
    followed: f64,
    /// (-)  growth of κ
    growth: f64,
}

impl VonMises {
    /// A law with the uniaxial yield stress σ_y > 0 (Pa) and the hardening modulus H ≥ 0 (Pa), dσ_y per plastic strain.
    pub fn new(elastic: Elastic, yield_stress: f64, hardening: f64) -> Self {
        let moduli = elastic.moduli();
        Self { elastic, moduli, yield_stress, hardening }
    }

    /// The stress that q reaches after the plastic strain of `state`, Pa.
    #[inline]
    fn strength(&self, state: &[f64]) -> f64 {
        self.yield_stress + self.hardening * state[0]
    }
}

impl Law for VonMises {
    type Flow = VonMisesReturn;
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

    fn with(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        Self::new(elastic, parameters[0], parameters[1])
    }

    /// `f = q - σ_y - H κ`.
    #[inline]
    fn excess(&self, tau: [f64; 3], state: &[f64]) -> f64 {
        1.5_f64.sqrt() * split(tau).2 - self.strength(state)
    }

    /// `Δκ = (q_trial - σ_y - H κ)/(3μ + H)`, `s = s_trial (1 - 3μ Δκ/q_trial)`.
    #[inline]
    fn project(&self, trial: [f64; 3], state: &[f64]) -> Option<([f64; 3], VonMisesReturn)> {
        let (mean, deviator, norm) = split(trial);
        let (q, strength) = (1.5_f64.sqrt() * norm, self.strength(state));
        if q <= strength {
            return None;
        }
        let shear = 3.0 * self.moduli.mu;
        let growth = (q - strength) / (shear + self.hardening);
        // Not 1 - 3μ Δκ/q, which cancels where the trial is far outside.
        let kept = (self.hardening * q + shear * strength) / ((shear + self.hardening) * q);
        let tau = deviator.map(|s| mean + kept * s);
        let direction = deviator.map(|s| s / norm);
        Some((tau, VonMisesReturn { direction, kept, followed: self.hardening / (shear + self.hardening), growth }))
    }

    fn hardens(&self) -> bool {
        self.hardening > 0.0
    }

    fn reduced(self, factor: f64) -> Self {
        Self::new(self.elastic, self.yield_stress / factor, self.hardening / factor)
    }
}

impl Flow for VonMisesReturn {
    #[inline]
    fn branch(&self) -> Branch {
        Branch::Face
    }

    /// `K I ⊗ I + 2μ (r (I₄ - ⅓ I ⊗ I) + (r' - r) n ⊗ n)`: r = q/q_trial along the surface, r' = dq/dq_trial across it.
    fn tangent(&self, moduli: Moduli) -> Tensor {
        let Self { direction: n, kept, followed, .. } = *self;
        let entry = |a: usize, b: usize| {
            let deviator = if a == b { 2.0 / 3.0 } else { -1.0 / 3.0 };
            moduli.bulk() + 2.0 * moduli.mu * (kept * deviator + (followed - kept) * n[a] * n[b])
        };
        Tensor::from_fn(entry)
    }

    /// All differences are kept alike.
    fn chord(&self, moduli: Moduli, _differences: (f64, f64)) -> f64 {
        2.0 * moduli.mu * self.kept
    }

    fn advance(&self, state: &mut [f64]) {
        state[0] += self.growth;
    }
}
