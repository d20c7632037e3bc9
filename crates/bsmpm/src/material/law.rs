//! Interface of constitutive laws. A new law is a file in this folder that implements [`Law`], and a line in
//! `material.rs`.

use super::{Elastic, Moduli};
use crate::real::Real;
use crate::tensor::Tensor;

/// Parameter of a law, or state variable that points store, 0 at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variable {
    /// Name of a state variable in frames, or of a parameter in cases.
    pub name: &'static str,
    /// Unit, "-" for none.
    pub unit: &'static str,
}

impl Variable {
    /// Creates a variable with its name and unit.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit }
    }
}

/// Largest number of parameters of a law.
pub(super) const MOST_PARAMETERS: usize = 8;

/// Isotropic law in principal values, descending: Hencky strain to Kirchhoff stress.
pub trait Law {
    /// Return data for the tangent and the state.
    type Flow<R: Real>: Copy;
    /// Parameters besides the elastic ones; at most eight.
    const PARAMETERS: &'static [Variable] = &[];
    /// State variables; at most eight.
    const STATE: &'static [Variable] = &[];
    /// Whether the law limits the stress.
    const YIELDS: bool = true;
    /// Whether points are evaluated side by side (SIMD). Long laws are not, which keeps the code of the others short.
    const IN_LANES: bool = true;

    /// Whether elastic stress is linear in strain, with [`Law::moduli`]. A nonlinear law implements [`Law::stress`],
    /// [`Law::strain`] and [`Law::energy`]. It provides return data also without yielding, for tangent and elastic
    /// state; the branch is then [`Branch::Elastic`].
    const LINEAR: bool = true;

    /// Returns the elastic part.
    fn elastic(&self) -> &Elastic;

    /// Returns the parameters in the order of [`Law::PARAMETERS`].
    fn parameters(&self) -> Vec<f64>;

    /// Returns the law with other numbers, in the order of [`Law::PARAMETERS`]; options that are not numbers are kept.
    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self;

    /// Returns the elastic moduli; those at b_e = I if elasticity is nonlinear.
    fn moduli(&self) -> Moduli;

    /// Returns the elastic stress of principal strains (Pa).
    #[inline(always)]
    fn stress<R: Real>(&self, eps: [R; 3]) -> [R; 3] {
        self.moduli().stress(eps)
    }

    /// Returns the principal strains of an elastic stress (Pa); not finite if there are none.
    fn strain(&self, tau: [f64; 3]) -> [f64; 3] {
        self.moduli().strain(tau)
    }

    /// Returns the energy of principal elastic strains (J/m3).
    fn energy(&self, eps: [f64; 3]) -> f64 {
        self.moduli().energy(eps)
    }

    /// Sets the state, initially zero, that belongs to an initial principal stress (Pa), for laws with nonlinear
    /// elasticity.
    fn initial_state(&self, _tau: [f64; 3], _state: &mut [f64]) {}

    /// Returns the law for a step of length `dt` (s); `None` if the law does not depend on it.
    fn with_time_step(&self, _dt: f64) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// Returns the yield function of a stress (Pa), positive outside the yield surface.
    fn yield_function<R: Real>(&self, tau: [R; 3], state: &[R]) -> R;

    /// Returns an elastic trial stress (Pa) to the yield surface. `state` is that of the last step, in the order of
    /// [`Law::STATE`].
    ///
    /// SIMD evaluation requires that this function and all functions it calls are `#[inline(always)]`. A NaN trial
    /// counts as yielding.
    fn return_map<R: Real>(&self, trial: [R; 3], state: &[R]) -> Projection<R, Self::Flow<R>>;

    /// Returns the part of the yield surface that the return ended on.
    fn branch(flow: &Self::Flow<f64>) -> Branch;

    /// Returns `D_AB = ∂τ_A/∂ε_B` of principal values after a return (Pa).
    fn tangent(flow: &Self::Flow<f64>, moduli: Moduli) -> Tensor;

    /// Returns `(τ_A - τ_B)/(ε_A - ε_B)` (Pa) for the differences `tau` and `eps` ≥ 0 after a return.
    ///
    /// It lies in 0..2μ, since returns reduce stress differences; the bounds limit the round-off of small differences.
    /// The default is 0 for equal strains, because stresses near an edge return to it.
    fn secant_modulus(_flow: &Self::Flow<f64>, moduli: Moduli, tau: f64, eps: f64) -> f64 {
        if eps > 0.0 {
            (tau / eps).max(0.0).min(2.0 * moduli.mu)
        } else {
            0.0
        }
    }

    /// Returns the principal elastic strains after a return to the stress `tau` (Pa).
    #[inline]
    fn elastic_strain(_flow: &Self::Flow<f64>, moduli: Moduli, tau: [f64; 3]) -> [f64; 3] {
        moduli.strain(tau)
    }

    /// Returns the elastic moduli after a return.
    #[inline]
    fn elastic_moduli(_flow: &Self::Flow<f64>, moduli: Moduli) -> Moduli {
        moduli
    }

    /// Returns the energy of the elastic strains `eps` after a return (J/m3).
    #[inline]
    fn elastic_energy(_flow: &Self::Flow<f64>, moduli: Moduli, eps: [f64; 3]) -> f64 {
        moduli.energy(eps)
    }

    /// Replaces the state before the return by that after it.
    fn advance(_flow: &Self::Flow<f64>, _state: &mut [f64]) {}

    /// Returns the law with its strength divided by `factor` (section 3.2 of the paper).
    fn reduced(self, factor: f64) -> Self;

    /// Returns the dilation angle (rad).
    fn dilation(&self) -> f64 {
        0.0
    }

    /// Returns whether any part of the strength increases with plastic strain.
    fn hardens(&self) -> bool {
        false
    }

    /// Returns whether the strength changes with plastic strain, so that the resistance depends on the deformation.
    fn softens(&self) -> bool {
        false
    }

    /// Returns the treatment of the volume that opens at the apex.
    fn separation(&self) -> Separation {
        Separation::Forgotten
    }
}

/// Result of the return of a trial stress.
#[derive(Clone, Copy, Debug)]
pub struct Projection<R: Real, F> {
    /// Stress after the return, descending; the trial stress without yielding (Pa).
    pub tau: [R; 3],
    /// Whether the trial stress yields.
    pub yields: R::Mask,
    /// Return data; meaningless without yielding, unless elasticity is nonlinear.
    pub flow: F,
}

/// Part of the yield surface on which the stress lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Branch {
    /// Inside or on the yield surface, without a return.
    Elastic,
    /// Smooth part: a cone, or a plane of a pyramid with τ₁ > τ₂ > τ₃.
    Face,
    /// Edge τ₁ = τ₂.
    LeftEdge,
    /// Edge τ₂ = τ₃.
    RightEdge,
    /// Apex τ₁ = τ₂ = τ₃.
    Apex,
}

/// Treatment of the volume that opens when the stress returns to the apex and the material separates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Separation {
    /// The volume is plastic strain: the material resists recompression immediately, however loose.
    #[default]
    Forgotten,
    /// The volume is a gap that must close first, see [`Response::gap`](super::Response::gap).
    Closing,
}

/// Parameters of frictional laws: φ, ψ, c.
pub(super) const FRICTIONAL: [Variable; 3] = [
    Variable::new("friction_angle", "rad"),
    Variable::new("dilation_angle", "rad"),
    Variable::new("cohesion", "Pa"),
];

/// Returns these parameters with ψ limited to φ.
pub(super) fn frictional(parameters: &[f64]) -> [f64; 3] {
    [parameters[0], parameters[1].min(parameters[0]), parameters[2]]
}

/// Strength of soil with friction and cohesion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strength {
    /// Friction angle φ (rad).
    pub friction_angle: f64,
    /// Dilation angle ψ (rad).
    pub dilation_angle: f64,
    /// Cohesion c (Pa).
    pub cohesion: f64,
}

impl Strength {
    /// Returns the strength divided by a strength reduction factor SRF: `φ_f = atan(tan φ/SRF)`, `ψ_f = min(ψ, φ_f)`,
    /// `c_f = c/SRF`.
    pub(super) fn reduced(self, factor: f64) -> Self {
        let friction_angle = (self.friction_angle.tan() / factor).atan();
        Self {
            friction_angle,
            dilation_angle: self.dilation_angle.min(friction_angle),
            cohesion: self.cohesion / factor,
        }
    }
}

/// Returns mean, deviator and norm of the deviator of principal values.
#[inline(always)]
pub fn split<R: Real>(tau: [R; 3]) -> (R, [R; 3], R) {
    let mean = (tau[0] + tau[1] + tau[2]) / 3.0;
    // Differences make the deviator traceless even if the mean is larger by many orders of magnitude.
    let upper = tau[0] - tau[1];
    let lower = tau[1] - tau[2];
    let whole = tau[0] - tau[2];
    let deviator = [(upper + whole) / 3.0, (lower - upper) / 3.0, -(whole + lower) / 3.0];
    let squares = deviator[0] * deviator[0] + deviator[1] * deviator[1] + deviator[2] * deviator[2];
    (mean, deviator, squares.root())
}

/// Returns principal values from their mean and a multiple of a deviator, the inverse of [`split`]. Without a closure
/// it is inlined for all number types also where a law is evaluated several times.
#[inline(always)]
pub fn joined<R: Real>(mean: R, factor: R, deviator: [R; 3]) -> [R; 3] {
    [
        mean + factor * deviator[0],
        mean + factor * deviator[1],
        mean + factor * deviator[2],
    ]
}
