//! Consistent spatial tangent of the Kirchhoff stress, theory-manual equation (T4.4).

use super::Response;
use crate::tensor::Tensor;

impl Response {
    /// Returns the tangent of this response for use with many gradients.
    #[inline]
    pub fn tangent(&self) -> Tangent {
        Tangent::of(self)
    }

    /// Returns the change dτ (Pa) for a spatial gradient `l = ∂(δu)/∂x` of a displacement increment, see
    /// [`Tangent::apply`].
    pub fn linearise(&self, l: &Tensor) -> Tensor {
        self.tangent().apply(l)
    }
}

/// Linear map from the spatial gradient of a displacement increment to dτ, in the axes of the trial b.
#[derive(Clone, Copy, Debug)]
pub struct Tangent {
    /// Axes of b, one per row (-).
    axes: Tensor,
    /// Eigenvalues of the trial b (-).
    b: [f64; 3],
    /// Derivatives `D_AB = ∂τ_A/∂ε_B` of principal values (Pa).
    principal: Tensor,
    /// Differences `(τ_A - τ_B)/(b_A - b_B)` of the pairs 12, 23 and 13 (Pa).
    chord: [f64; 3],
}

/// Pairs of axes, in the order of the pairs in [`Tangent`].
pub(super) const PAIRS: [(usize, usize); 3] = [(0, 1), (1, 2), (0, 2)];

impl Tangent {
    pub(super) fn of(response: &Response) -> Self {
        let axis = response.trial.axis();
        Self {
            axes: Tensor::from_fn(|i, j| axis[i][j]),
            b: response.trial.b,
            principal: response.flowed.tangent(response.moduli),
            chord: PAIRS.map(|(a, b)| secant_modulus(response, a, b)),
        }
    }

    /// Returns dτ for the spatial gradient `l`: `dτ_AA = Σ_B D_AB l_BB`,
    /// `dτ_AB = (τ_A - τ_B)/(b_A - b_B) (l_AB b_B + b_A l_BA)` in the axes of the trial b.
    pub fn apply(&self, l: &Tensor) -> Tensor {
        let l = self.axes * l * self.axes.transpose();
        let mut d_tau = Tensor::from_diagonal(&(self.principal * l.diagonal()));
        for ((a, b), chord) in PAIRS.into_iter().zip(self.chord) {
            let shear = chord * (l[(a, b)] * self.b[b] + self.b[a] * l[(b, a)]);
            d_tau[(a, b)] = shear;
            d_tau[(b, a)] = shear;
        }
        self.axes.transpose() * d_tau * self.axes
    }
}

/// Returns `(τ_A - τ_B)/(b_A - b_B) = (τ_A - τ_B)/(ε_A - ε_B) · ln(1 + x)/(2 x b_B)`, x = b_A/b_B - 1.
///
/// The second factor tends to 1/(2b) for equal eigenvalues.
fn secant_modulus(response: &Response, a: usize, b: usize) -> f64 {
    let trial = &response.trial;
    let x = (trial.b[a] - trial.b[b]) / trial.b[b];
    let log = if x == 0.0 { 1.0 } else { x.ln_1p() / x };
    slope(response, a, b) * log / (2.0 * trial.b[b])
}

/// Returns `(τ_A - τ_B)/(ε_A - ε_B)` of the law (Pa).
pub(super) fn slope(response: &Response, a: usize, b: usize) -> f64 {
    let tau = response.tau;
    let eps = response.trial.eps;
    response
        .flowed
        .secant_modulus(response.moduli, tau[a] - tau[b], eps[a] - eps[b])
}
