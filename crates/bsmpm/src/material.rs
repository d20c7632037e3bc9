//! Constitutive laws (chapter 4 of the theory manual). A law computes the Kirchhoff stress and the new elastic state
//! from the trial elastic state, theory-manual equation (T3.3).
//!
//! All laws are isotropic and use principal Hencky strains (T4.1). State variables are stored at the material points.
//! Stresses are in Pa, tension positive, in descending order.

mod cam_clay;
mod cut_off;
mod drucker_prager;
mod elastic;
mod graded;
mod hencky;
mod law;
mod layered;
mod mobilised;
mod mohr_coulomb;
mod mu_i;
mod response;
mod softening;
mod spectral;
mod stiffness;
mod tangent;
mod von_mises;

pub use cam_clay::CamClay;
pub use cut_off::{CutOff, DruckerPragerCutOff, MohrCoulombCutOff, TensileStrength, VonMisesCutOff};
pub use drucker_prager::{DruckerPrager, Match};
pub use elastic::{Elastic, Moduli};
pub use graded::{GradedLaw, Profile};
pub use hencky::Hencky;
pub use law::{Branch, Law, Projection, Separation, Variable, split};
pub use layered::{LayeredMaterial, state_width};
pub use mohr_coulomb::MohrCoulomb;
pub use mu_i::MuI;
pub use response::Response;
pub use softening::{Decay, Rate, SofteningMohrCoulomb, Strength};
pub use stiffness::Stiffness;
pub use tangent::Tangent;
pub use von_mises::VonMises;

use crate::real::Real;
use crate::tensor::{Symmetric, Tensor};
use spectral::Spectrum;
use std::borrow::Cow;

/// Defines the enum of all laws with its dispatch, and the enum of their return data.
macro_rules! laws {
    ($($(#[$doc:meta])* $module:ident::$Law:ident,)*) => {
        /// Constitutive law with its parameters at one height.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Material {
            $($(#[$doc])* $Law($module::$Law),)*
        }

        /// Return data of a response; `Elastic` without a return.
        #[derive(Clone, Copy, Debug)]
        pub(super) enum Flowed {
            Elastic,
            $($Law(<$module::$Law as Law>::Flow<f64>),)*
        }

        impl Material {
            /// Returns the elastic part of the law.
            pub fn elastic(&self) -> &Elastic {
                match self {
                    $(Self::$Law(law) => law.elastic(),)*
                }
            }

            /// Returns the dilation angle (rad).
            pub fn dilation(&self) -> f64 {
                match self {
                    $(Self::$Law(law) => law.dilation(),)*
                }
            }

            /// Returns the treatment of the volume that opens at the apex.
            pub fn separation(&self) -> Separation {
                match self {
                    $(Self::$Law(law) => law.separation(),)*
                }
            }

            /// Returns whether the law limits the stress.
            pub fn yields(&self) -> bool {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::YIELDS,)*
                }
            }

            /// Returns whether any part of the strength increases with plastic strain.
            pub fn hardens(&self) -> bool {
                match self {
                    $(Self::$Law(law) => law.hardens(),)*
                }
            }

            /// Returns whether [`Material::stress`] supports the law.
            #[inline(always)]
            fn is_in_lanes(&self) -> bool {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::IN_LANES,)*
                }
            }

            /// Returns whether the strength changes with plastic strain.
            pub fn softens(&self) -> bool {
                match self {
                    $(Self::$Law(law) => law.softens(),)*
                }
            }

            /// Returns whether elastic stress is linear in strain, so that a stress-free state exists.
            pub fn is_linear(&self) -> bool {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::LINEAR,)*
                }
            }

            /// Returns the principal elastic strains of an initial stress (Pa), and sets the initial state of the law
            /// in `state`, which contains zeros. The strains are not finite if the law cannot have the stress.
            pub fn initial_state(&self, tau: [f64; 3], state: &mut [f64]) -> [f64; 3] {
                match self {
                    $(Self::$Law(law) => {
                        law.initial_state(tau, state);
                        law.strain(tau)
                    })*
                }
            }

            /// Returns the state variables of a point.
            pub fn state(&self) -> &'static [Variable] {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::STATE,)*
                }
            }

            /// Returns names and units of the parameters besides the elastic ones.
            pub fn parameter_names(&self) -> &'static [Variable] {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::PARAMETERS,)*
                }
            }

            /// Returns the parameters in the order of their names.
            pub fn parameters(&self) -> Vec<f64> {
                match self {
                    $(Self::$Law(law) => law.parameters(),)*
                }
            }

            /// Returns the law with other parameters, see [`Law::with_parameters`].
            pub fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
                match self {
                    $(Self::$Law(law) => Self::$Law(law.with_parameters(elastic, parameters)),)*
                }
            }

            /// Returns the law for a step of length `dt` (s); `None` if the law does not depend on it.
            pub fn with_time_step(&self, dt: f64) -> Option<Self> {
                match self {
                    $(Self::$Law(law) => law.with_time_step(dt).map(Self::$Law),)*
                }
            }

            /// Returns the law with its strength divided by `factor` (section 3.2 of the paper).
            pub fn reduced(self, factor: f64) -> Self {
                match self {
                    $(Self::$Law(law) => Self::$Law(law.reduced(factor)),)*
                }
            }

            /// Returns the energy of principal elastic strains (J/m3).
            fn energy(&self, eps: [f64; 3]) -> f64 {
                match self {
                    $(Self::$Law(law) => law.energy(eps),)*
                }
            }

            /// Returns the yield function of a principal stress (Pa, descending) in a `state` (Pa), positive outside
            /// the yield surface.
            pub fn yield_function(&self, tau: [f64; 3], state: &[f64]) -> f64 {
                match self {
                    $(Self::$Law(law) => law.yield_function(tau, state),)*
                }
            }

            /// Returns the Kirchhoff stress (Pa) of one point, or of several, as [`Material::respond`], from the
            /// components XX, YY, ZZ, XY of `b_trial` and the `state` of the last step, in which the variables of the
            /// law come first. Returns `None` for laws that [`Material::respond`] alone supports, and unless all trials
            /// are finite and positive definite.
            #[inline(always)]
            pub fn stress<R: Real>(&self, b_trial: [R; 4], state: &[R]) -> Option<Symmetric<R>> {
                if !self.is_in_lanes() {
                    return None;
                }
                self.stress_of(&Spectrum::planar(b_trial)?, state)
            }

            /// Returns the same for all six components; `None` also if XZ and YZ of a point are zero.
            #[inline(always)]
            pub fn stress_in_space<R: Real>(&self, b_trial: [R; 6], state: &[R]) -> Option<Symmetric<R>> {
                if !self.is_in_lanes() {
                    return None;
                }
                self.stress_of(&Spectrum::general(b_trial)?, state)
            }

            #[inline(always)]
            fn stress_of<R: Real>(&self, spectrum: &Spectrum<R>, state: &[R]) -> Option<Symmetric<R>> {
                let tau = match self {
                    $(Self::$Law(law) if <$module::$Law as Law>::IN_LANES => law.return_map(law.stress(spectrum.eps), state).tau,)*
                    _ => return None,
                };
                Some(spectrum.assemble(tau))
            }

            /// Computes the response to a trial elastic left Cauchy-Green tensor, `b_trial = ΔF bᵉ ΔFᵀ` (Eq. 7), from
            /// the `state` of the last step, in which the variables of the law come first.
            ///
            /// # Errors
            /// If `b_trial` has a component that is not finite, or an eigenvalue that is not positive.
            // Always inlined, so that callers that need only the stress do not compute the rest.
            #[inline(always)]
            pub fn respond(&self, b_trial: &Symmetric, state: &[f64]) -> Result<Response, MaterialError> {
                let spectrum = Spectrum::of(b_trial)?;
                let (moduli, tau, flowed) = match self {
                    $(Self::$Law(law) => {
                        let moduli = law.moduli();
                        let Projection { tau, yields, flow } = law.return_map(law.stress(spectrum.eps), state);
                        let linear = <$module::$Law as Law>::LINEAR;
                        if !linear && !(tau[0].is_finite() && tau[2].is_finite()) {
                            return Err(MaterialError::NoStress(spectrum.eps));
                        }
                        (moduli, tau, if yields || !linear { Flowed::$Law(flow) } else { Flowed::Elastic })
                    })*
                };
                Ok(Response::new(*b_trial, spectrum, moduli, tau, flowed))
            }
        }

        $(const _: () = assert!(<$module::$Law as Law>::STATE.len() <= MOST_STATE);)*
        $(const _: () = assert!(<$module::$Law as Law>::PARAMETERS.len() <= law::MOST_PARAMETERS);)*

        impl Flowed {
            #[inline]
            pub fn branch(&self) -> Branch {
                match self {
                    Self::Elastic => Branch::Elastic,
                    $(Self::$Law(flow) => $module::$Law::branch(flow),)*
                }
            }

            /// Returns `D_AB = ∂τ_A/∂ε_B` (Pa).
            pub fn tangent(&self, moduli: Moduli) -> Tensor {
                match self {
                    Self::Elastic => moduli.tangent(),
                    $(Self::$Law(flow) => $module::$Law::tangent(flow, moduli),)*
                }
            }

            /// Returns the secant modulus, see [`Law::secant_modulus`]; 2μ if elastic.
            pub fn secant_modulus(&self, moduli: Moduli, tau: f64, eps: f64) -> f64 {
                match self {
                    Self::Elastic => 2.0 * moduli.mu,
                    $(Self::$Law(flow) => $module::$Law::secant_modulus(flow, moduli, tau, eps),)*
                }
            }

            /// Returns whether the elastic part is linear, the same at all stresses.
            #[inline]
            pub fn is_linear(&self) -> bool {
                match self {
                    Self::Elastic => true,
                    $(Self::$Law(_) => <$module::$Law as Law>::LINEAR,)*
                }
            }

            /// Returns the principal elastic strains, see [`Law::elastic_strain`].
            pub fn elastic_strain(&self, moduli: Moduli, tau: [f64; 3]) -> [f64; 3] {
                match self {
                    Self::Elastic => moduli.strain(tau),
                    $(Self::$Law(flow) => $module::$Law::elastic_strain(flow, moduli, tau),)*
                }
            }

            /// Returns the elastic moduli, see [`Law::elastic_moduli`].
            pub fn elastic_moduli(&self, moduli: Moduli) -> Moduli {
                match self {
                    Self::Elastic => moduli,
                    $(Self::$Law(flow) => $module::$Law::elastic_moduli(flow, moduli),)*
                }
            }

            /// Returns the elastic energy, see [`Law::elastic_energy`].
            pub fn elastic_energy(&self, moduli: Moduli, eps: [f64; 3]) -> f64 {
                match self {
                    Self::Elastic => moduli.energy(eps),
                    $(Self::$Law(flow) => $module::$Law::elastic_energy(flow, moduli, eps),)*
                }
            }

            /// Replaces the state before the return by that after it.
            pub fn advance(&self, state: &mut [f64]) {
                match self {
                    Self::Elastic => {}
                    $(Self::$Law(flow) => $module::$Law::advance(flow, state),)*
                }
            }
        }
    };
}

laws! {
    /// Linear elasticity in logarithmic strain.
    hencky::Hencky,
    /// Perfect plasticity with friction, dilation and cohesion.
    mohr_coulomb::MohrCoulomb,
    /// Drucker-Prager cone fitted to Mohr-Coulomb strength.
    drucker_prager::DruckerPrager,
    /// Frictionless plasticity with linear hardening.
    von_mises::VonMises,
    /// Mohr-Coulomb strength that depends on plastic strain.
    softening::SofteningMohrCoulomb,
    /// Modified Cam-clay: pressure-dependent elasticity, hardening by plastic compression.
    cam_clay::CamClay,
    /// Dense granular flow with friction that increases with the shear rate.
    mu_i::MuI,
    /// Mohr-Coulomb with a tension cut-off.
    cut_off::MohrCoulombCutOff,
    /// Drucker-Prager with a tension cut-off.
    cut_off::DruckerPragerCutOff,
    /// Von Mises with a tension cut-off.
    cut_off::VonMisesCutOff,
}

/// Largest number of state variables of a law.
pub const MOST_STATE: usize = 8;

impl Material {
    /// Returns the law without its tension cut-off, if it has one.
    pub fn without_cut_off(&self) -> Cow<'_, Self> {
        match self {
            Self::MohrCoulombCutOff(law) => Cow::Owned(Self::MohrCoulomb(law.law().clone())),
            Self::DruckerPragerCutOff(law) => Cow::Owned(Self::DruckerPrager(law.law().clone())),
            Self::VonMisesCutOff(law) => Cow::Owned(Self::VonMises(law.law().clone())),
            whole => Cow::Borrowed(whole),
        }
    }

    /// Returns the elastic energy per reference volume for `b_e` (J/m3).
    ///
    /// # Errors
    /// If `b_e` is not finite or not positive definite.
    pub fn elastic_energy(&self, b_e: &Symmetric) -> Result<f64, MaterialError> {
        Ok(self.energy(Spectrum::of(b_e)?.eps))
    }
}

/// Reason why a material has no response.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A component of the trial tensor is NaN, infinite or beyond 1e100.
    #[error("the deformation in this step is not finite (elastic left Cauchy-Green tensor {0:?})")]
    NotFinite([f64; 6]),
    /// An eigenvalue of the trial tensor is not positive, or below 1e-100: the step inverts the material.
    #[error(
        "the step turns the material inside out (smallest eigenvalue of the elastic left Cauchy-Green tensor {0:e}, must \
         be positive)"
    )]
    NotPositive(f64),
    /// The law has no finite stress at these principal strains, or no initial state was set.
    #[error("the material model has no finite stress at the principal elastic strains {0:?}")]
    NoStress([f64; 3]),
}
