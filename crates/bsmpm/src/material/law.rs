//! What a law is: a file beside this one that implements [`Law`], and a line in the list of `material.rs`.

use super::{Elastic, Moduli};
use crate::tensor::Tensor;

/// A state variable of a law, which the points carry from step to step; 0 at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variable {
    /// as frames name it
    pub name: &'static str,
    /// its unit, "-" for none
    pub unit: &'static str,
}

/// An isotropic law on principal values: Hencky strain in, Kirchhoff stress out, both descending.
pub trait Law {
    /// What a return leaves for its tangent and its state.
    type Flow: Flow;
    /// State variables.
    const STATE: &'static [Variable] = &[];

    /// The elastic part.
    fn elastic(&self) -> &Elastic;

    /// Its moduli.
    fn moduli(&self) -> Moduli;

    /// The stress after the return of an elastic trial stress (Pa), and its flow; `None` where the trial does not yield.
    /// `state` is that of the last step, in the order of [`Law::STATE`].
    fn project(&self, trial: [f64; 3], state: &[f64]) -> Option<([f64; 3], Self::Flow)>;

    /// The law with its strength divided by `factor` (section 3.2).
    fn reduced(self, factor: f64) -> Self;

    /// Dilation angle, rad.
    fn dilation(&self) -> f64 {
        0.0
    }

    /// Whether its strength grows with plastic strain, without a limit.
    fn hardens(&self) -> bool {
        false
    }

    /// What becomes of the volume that opens at an apex.
    fn separation(&self) -> Separation {
        Separation::Forgotten
    }
}

/// What a return leaves.
pub trait Flow: Copy {
    /// Where on the yield surface the stress lies.
    fn branch(&self) -> Branch;

    /// `D_AB = ∂τ_A/∂ε_B`, Pa, of principal values.
    fn tangent(&self, moduli: Moduli) -> Tensor;

    /// `(τ_A - τ_B)/(ε_A - ε_B)`, Pa, where these differ by `tau` and `eps` ≥ 0.
    ///
    /// In 0..2μ, since returns shrink stress differences; here 0 of equal strains, as what is near an edge returns to it.
    /// The bounds keep rounding of a tiny difference inside.
    fn chord(&self, moduli: Moduli, (tau, eps): (f64, f64)) -> f64 {
        if eps > 0.0 { (tau / eps).max(0.0).min(2.0 * moduli.mu) } else { 0.0 }
    }

    /// Puts the state after the return in the place of that before it.
    fn advance(&self, _state: &mut [f64]) {}
}

/// Where on the yield surface the stress lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Branch {
    /// Inside or on the yield surface: no return.
    Elastic,
    /// A smooth part of it: a cone, or one plane of a pyramid, τ₁ > τ₂ > τ₃.
    Face,
    /// The edge τ₁ = τ₂.
    LeftEdge,
    /// The edge τ₂ = τ₃.
    RightEdge,
    /// The tip, τ₁ = τ₂ = τ₃.
    Apex,
}

/// What becomes of the volume that opens where the stress returns to the apex: the material has come apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Separation {
    /// It is plastic and forgotten: the material resists at once when it is compressed again, however loose.
    #[default]
    Forgotten,
    /// It is a gap that closes first: see [`Response::gap`](super::Response::gap).
    Closing,
}

/// What the return of a law that never yields leaves: there is none.
#[derive(Clone, Copy, Debug)]
pub enum Never {}

impl Flow for Never {
    fn branch(&self) -> Branch {
        match *self {}
    }
    fn tangent(&self, _moduli: Moduli) -> Tensor {
        match *self {}
    }
}

/// Friction and dilation angle (rad) and cohesion (Pa), divided by a strength reduction factor: `atan(tan φ/SRF)`,
/// `ψ_f = min(ψ, φ_f)`, `c/SRF`.
pub(super) fn reduced((friction, dilation, cohesion): (f64, f64, f64), factor: f64) -> (f64, f64, f64) {
    let reduced = (friction.tan() / factor).atan();
    (reduced, dilation.min(reduced), cohesion / factor)
}

/// Mean, deviator and norm of the deviator of principal values.
#[inline]
pub fn split(tau: [f64; 3]) -> (f64, [f64; 3], f64) {
    let mean = (tau[0] + tau[1] + tau[2]) / 3.0;
    let deviator = tau.map(|t| t - mean);
    (mean, deviator, deviator.iter().map(|s| s * s).sum::<f64>().sqrt())
}
