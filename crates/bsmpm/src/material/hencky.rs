//! Hencky elasticity (section 2.2, Eqs 9 and 10): linear between logarithmic strain and Kirchhoff stress.

use super::Elastic;

/// Elastic at any strain: `τ = Dᵉ ½ ln bᵉ`; the state after the step is the trial state.
#[derive(Clone, Debug, PartialEq)]
pub struct Hencky {
    /// The two constants.
    pub elastic: Elastic,
}
