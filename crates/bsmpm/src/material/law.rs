//! Interface of constitutive laws. A new law is a file in this folder that implements [`Law`], and a line in
//! `material.rs`.

use super::{Elastic, Moduli};
use crate::real::Real;
use crate::tensor::Tensor;

/// A number of a law: a parameter, or a state variable that points carry from step to step, 0 at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variable {
    /// as frames name a state variable and cases a parameter
    pub name: &'static str,
    /// its unit, "-" for none
    pub unit: &'static str,
}

impl Variable {
    /// A variable by its name and unit.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit }
    }
}

/// Parameters of one law at most.
pub(super) const MOST_PARAMETERS: usize = 8;

/// An isotropic law on principal values: Hencky strain in, Kirchhoff stress out, both descending.
pub trait Law {
    /// What a return leaves for its tangent and its state.
    type Flow<R: Real>: Copy;
    /// Parameters besides the elastic ones; at most eight.
    const PARAMETERS: &'static [Variable] = &[];
    /// State variables; at most eight.
    const STATE: &'static [Variable] = &[];
    /// Whether its stress is limited.
    const YIELDS: bool = true;
    /// Whether its points are computed side by side; a long law's are not, so that the code of the others stays short.
    const IN_LANES: bool = true;

    /// Whether its elastic stress is linear in the strain, by [`Law::moduli`]. A law whose is not has its own
    /// [`Law::stress`], [`Law::strain`] and [`Law::energy`], and keeps what a projection leaves also where the trial
    /// does not yield: that gives tangent and elastic state then, and its branch is [`Branch::Elastic`].
    const LINEAR: bool = true;

    /// The elastic part.
    fn elastic(&self) -> &Elastic;

    /// Its parameters, in the order of [`Law::PARAMETERS`].
    fn parameters(&self) -> Vec<f64>;

    /// The law with other numbers, in the order of [`Law::PARAMETERS`]; what is no number stays.
    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self;

    /// Its moduli; of elasticity that is not linear those at b_e = I.
    fn moduli(&self) -> Moduli;

    /// Elastic stress of principal strains, Pa.
    #[inline(always)]
    fn stress<R: Real>(&self, eps: [R; 3]) -> [R; 3] {
        self.moduli().stress(eps)
    }

    /// Principal strains of an elastic stress, Pa; no numbers where there are none.
    fn strain(&self, tau: [f64; 3]) -> [f64; 3] {
        self.moduli().strain(tau)
    }

    /// Energy of elastic principal strains, J/m3.
    fn energy(&self, eps: [f64; 3]) -> f64 {
        self.moduli().energy(eps)
    }

    /// Puts the state that belongs to a principal stress at the start, Pa, into the place of zeros; of a law whose
    /// elasticity is not linear.
    fn initial_state(&self, _tau: [f64; 3], _state: &mut [f64]) {}

    /// The law in a step of the length `dt`, s; `None` where that does not matter to it.
    fn at_time_step(&self, _dt: f64) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// The yield function of a stress, Pa; positive where that is outside.
    fn yield_function<R: Real>(&self, tau: [R; 3], state: &[R]) -> R;

    /// The return of an elastic trial stress, Pa. `state` is that of the last step, in the order of [`Law::STATE`].
    ///
    /// It runs on vectors if it and all that it calls are `#[inline(always)]`. A trial that is not a number yields.
    fn return_map<R: Real>(&self, trial: [R; 3], state: &[R]) -> Projection<R, Self::Flow<R>>;

    /// Where on the yield surface the stress lies after a return.
    fn branch(flow: &Self::Flow<f64>) -> Branch;

    /// `D_AB = ∂τ_A/∂ε_B`, Pa, of principal values after a return.
    fn tangent(flow: &Self::Flow<f64>, moduli: Moduli) -> Tensor;

    /// `(τ_A - τ_B)/(ε_A - ε_B)`, Pa, where these differ by `tau` and `eps` ≥ 0 after a return.
    ///
    /// In 0..2μ, since returns shrink stress differences; here 0 of equal strains, as what is near an edge returns to
    /// it. The bounds keep rounding of a tiny difference inside.
    fn secant_modulus(_flow: &Self::Flow<f64>, moduli: Moduli, tau: f64, eps: f64) -> f64 {
        if eps > 0.0 {
            (tau / eps).max(0.0).min(2.0 * moduli.mu)
        } else {
            0.0
        }
    }

    /// Principal elastic strains after a return to the stress `tau`, Pa.
    #[inline]
    fn elastic_strain(_flow: &Self::Flow<f64>, moduli: Moduli, tau: [f64; 3]) -> [f64; 3] {
        moduli.strain(tau)
    }

    /// Elastic moduli after a return.
    #[inline]
    fn elastic_moduli(_flow: &Self::Flow<f64>, moduli: Moduli) -> Moduli {
        moduli
    }

    /// Energy of the elastic strains `eps` after a return, J/m3.
    #[inline]
    fn elastic_energy(_flow: &Self::Flow<f64>, moduli: Moduli, eps: [f64; 3]) -> f64 {
        moduli.energy(eps)
    }

    /// Puts the state after a return in the place of that before it.
    fn advance(_flow: &Self::Flow<f64>, _state: &mut [f64]) {}

    /// The law with its strength divided by `factor` (section 3.2).
    fn reduced(self, factor: f64) -> Self;

    /// Dilation angle, rad.
    fn dilation(&self) -> f64 {
        0.0
    }

    /// Whether some part of its strength grows with plastic strain.
    fn hardens(&self) -> bool {
        false
    }

    /// Whether its strength follows plastic strain to another last value, so that what it carries depends on how far it
    /// is strained.
    fn softens(&self) -> bool {
        false
    }

    /// What becomes of the volume that opens at an apex.
    fn separation(&self) -> Separation {
        Separation::Forgotten
    }
}

/// The return of a trial stress.
#[derive(Clone, Copy, Debug)]
pub struct Projection<R: Real, F> {
    /// Pa  the stress after it, descending; the trial where that does not yield
    pub tau: [R; 3],
    /// where the trial yields
    pub yields: R::Mask,
    /// what the return leaves; without a meaning where there is none
    pub flow: F,
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

/// Parameters of laws with friction: φ, ψ, c.
pub(super) const FRICTIONAL: [Variable; 3] = [
    Variable::new("friction_angle", "rad"),
    Variable::new("dilation_angle", "rad"),
    Variable::new("cohesion", "Pa"),
];

/// These parameters, with ψ at most φ.
pub(super) fn frictional(parameters: &[f64]) -> [f64; 3] {
    [parameters[0], parameters[1].min(parameters[0]), parameters[2]]
}

/// Strength of soil with friction and cohesion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strength {
    /// Friction angle φ, rad.
    pub friction_angle: f64,
    /// Dilation angle ψ, rad.
    pub dilation_angle: f64,
    /// Cohesion c, Pa.
    pub cohesion: f64,
}

impl Strength {
    /// Returns the strength divided by a strength reduction factor: `φ_f = atan(tan φ/SRF)`, `ψ_f = min(ψ, φ_f)`,
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

/// Mean, deviator and norm of the deviator of principal values.
#[inline(always)]
pub fn split<R: Real>(tau: [R; 3]) -> (R, [R; 3], R) {
    let mean = (tau[0] + tau[1] + tau[2]) / 3.0;
    // By differences, so that the deviator has no trace even where the mean is many orders larger.
    let upper = tau[0] - tau[1];
    let lower = tau[1] - tau[2];
    let whole = tau[0] - tau[2];
    let deviator = [(upper + whole) / 3.0, (lower - upper) / 3.0, -(whole + lower) / 3.0];
    let squares = deviator[0] * deviator[0] + deviator[1] * deviator[1] + deviator[2] * deviator[2];
    (mean, deviator, squares.root())
}
