//! The elastic law: Kirchhoff stress linear in logarithmic strain.

use super::law::{Branch, Law, Projection};
use super::{Elastic, Moduli};
use crate::real::Real;
use crate::tensor::Tensor;

/// Elastic law `τ = Dᵉ ½ ln bᵉ`; the state after the step is the trial state.
#[derive(Clone, Debug, PartialEq)]
pub struct Hencky {
    /// Elastic constants.
    pub elastic: Elastic,
}

impl Law for Hencky {
    type Flow<R: Real> = ();
    const YIELDS: bool = false;

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.elastic.moduli()
    }

    fn parameters(&self) -> Vec<f64> {
        Vec::new()
    }

    fn with_parameters(&self, elastic: Elastic, _parameters: &[f64]) -> Self {
        Self { elastic }
    }

    fn yield_function<R: Real>(&self, tau: [R; 3], _state: &[R]) -> R {
        tau[0].like(f64::NEG_INFINITY)
    }

    #[inline(always)]
    fn return_map<R: Real>(&self, trial: [R; 3], _state: &[R]) -> Projection<R, ()> {
        let never = trial[0].like(1.0).below(trial[0].like(0.0));
        Projection {
            tau: trial,
            yields: never,
            flow: (),
        }
    }

    fn branch(_flow: &()) -> Branch {
        Branch::Elastic
    }

    fn tangent(_flow: &(), moduli: Moduli) -> Tensor {
        moduli.tangent()
    }

    fn reduced(self, _factor: f64) -> Self {
        self
    }
}
