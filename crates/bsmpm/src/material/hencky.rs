//! Hencky elasticity (section 2.2, Eqs 9 and 10): linear between logarithmic strain and Kirchhoff stress.

use super::law::{Law, Never};
use super::{Elastic, Moduli};

/// Elastic at any strain: `τ = Dᵉ ½ ln bᵉ`; the state after the step is the trial state.
#[derive(Clone, Debug, PartialEq)]
pub struct Hencky {
    /// The two constants.
    pub elastic: Elastic,
}

impl Law for Hencky {
    type Flow = Never;
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

    fn with(&self, elastic: Elastic, _parameters: &[f64]) -> Self {
        Self { elastic }
    }

    fn excess(&self, _tau: [f64; 3], _state: &[f64]) -> f64 {
        f64::NEG_INFINITY
    }

    #[inline]
    fn project(&self, _trial: [f64; 3], _state: &[f64]) -> Option<([f64; 3], Never)> {
        None
    }

    fn reduced(self, _factor: f64) -> Self {
        self
    }
}
