//! Constitutive laws (chapter 4 of the theory manual). A law computes the Kirchhoff stress and the new elastic state
//! from the trial elastic state, theory-manual equation (T3.3).
//!
//! All laws are isotropic and use principal Hencky strains (T4.1). State variables are stored at the material points.
//! Stresses are in Pa, tension positive, in descending order.

mod cam_clay;
mod drucker_prager;
mod elastic;
mod graded;
mod hencky;
mod law;
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
pub use drucker_prager::{DruckerPrager, Match};
pub use elastic::{Elastic, Moduli};
pub use graded::{GradedLaw, Profile};
pub use hencky::Hencky;
pub use law::{Branch, Law, Projection, Separation, Variable, split};
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

/// The enum of all laws with its dispatch, and that of what their returns leave.
macro_rules! laws {
    ($($(#[$doc:meta])* $module:ident::$Law:ident,)*) => {
        /// A material of the case.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Material {
            $($(#[$doc])* $Law($module::$Law),)*
            /// One of the others, with parameters that depend on the height.
            Graded(GradedLaw),
        }

        /// What the return of a response left; elastic without one.
        #[derive(Clone, Copy, Debug)]
        pub(super) enum Flowed {
            Elastic,
            $($Law(<$module::$Law as Law>::Flow<f64>),)*
        }

        impl Material {
            /// The elastic part of the law; of a graded one where it is stiffest.
            pub fn elastic(&self) -> &Elastic {
                match self {
                    $(Self::$Law(law) => law.elastic(),)*
                    Self::Graded(law) => law.stiffest(),
                }
            }

            /// Dilation angle, rad; the largest of a graded law, before a reduction of strength.
            pub fn dilation(&self) -> f64 {
                match self {
                    $(Self::$Law(law) => law.dilation(),)*
                    Self::Graded(law) => law.most().dilation(),
                }
            }

            /// What becomes of the volume that opens at the apex.
            pub fn separation(&self) -> Separation {
                match self {
                    $(Self::$Law(law) => law.separation(),)*
                    Self::Graded(law) => law.most().separation(),
                }
            }

            /// Whether its stress is limited.
            pub fn yields(&self) -> bool {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::YIELDS,)*
                    Self::Graded(law) => law.most().yields(),
                }
            }

            /// Whether some part of its strength grows with plastic strain.
            pub fn hardens(&self) -> bool {
                match self {
                    $(Self::$Law(law) => law.hardens(),)*
                    Self::Graded(law) => law.most().hardens(),
                }
            }

            /// Whether [`Material::stress`] can tell.
            #[inline(always)]
            fn is_in_lanes(&self) -> bool {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::IN_LANES,)*
                    Self::Graded(_) => false,
                }
            }

            /// Whether its strength follows plastic strain to another last value.
            pub fn softens(&self) -> bool {
                match self {
                    $(Self::$Law(law) => law.softens(),)*
                    Self::Graded(law) => law.most().softens(),
                }
            }

            /// Whether its elastic stress is linear in the strain, so that there is a state without stress.
            pub fn is_linear(&self) -> bool {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::LINEAR,)*
                    Self::Graded(law) => law.most().is_linear(),
                }
            }

            /// Principal elastic strains of a stress at the start (Pa), and the law's state there, in the place of
            /// zeros; of a graded law through [`Material::at`] only. No numbers where the law has no such stress.
            pub fn initial_state(&self, tau: [f64; 3], state: &mut [f64]) -> [f64; 3] {
                match self {
                    $(Self::$Law(law) => {
                        law.initial_state(tau, state);
                        law.strain(tau)
                    })*
                    Self::Graded(law) => law.most().initial_state(tau, state),
                }
            }

            /// State variables of its points.
            pub fn state(&self) -> &'static [Variable] {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::STATE,)*
                    Self::Graded(law) => law.most().state(),
                }
            }

            /// Names and units of its parameters besides the elastic ones.
            pub fn parameter_names(&self) -> &'static [Variable] {
                match self {
                    $(Self::$Law(_) => <$module::$Law as Law>::PARAMETERS,)*
                    Self::Graded(law) => law.most().parameter_names(),
                }
            }

            /// Its parameters in the order of their names; of a graded law the largest of each.
            pub fn parameters(&self) -> Vec<f64> {
                match self {
                    $(Self::$Law(law) => law.parameters(),)*
                    Self::Graded(law) => law.most().parameters(),
                }
            }

            /// The law with other numbers, the same at all heights; see [`Law::with_parameters`].
            pub fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
                match self {
                    $(Self::$Law(law) => Self::$Law(law.with_parameters(elastic, parameters)),)*
                    Self::Graded(law) => law.most().with_parameters(elastic, parameters),
                }
            }

            /// The law in a step of the length `dt`, s; `None` where that does not matter to it.
            pub fn at_time_step(&self, dt: f64) -> Option<Self> {
                match self {
                    $(Self::$Law(law) => law.at_time_step(dt).map(Self::$Law),)*
                    Self::Graded(law) => law.at_time_step(dt).map(Self::Graded),
                }
            }

            /// The law with its strength divided by `factor` (section 3.2).
            pub fn reduced(self, factor: f64) -> Self {
                match self {
                    $(Self::$Law(law) => Self::$Law(law.reduced(factor)),)*
                    Self::Graded(law) => Self::Graded(law.reduced(factor)),
                }
            }

            /// Energy of elastic principal strains, J/m3.
            fn energy(&self, eps: [f64; 3]) -> f64 {
                match self {
                    $(Self::$Law(law) => law.energy(eps),)*
                    Self::Graded(law) => law.stiffest().moduli().energy(eps),
                }
            }

            /// The yield function of a principal stress (Pa, descending) in a `state`, Pa: positive outside; of a
            /// graded law that of the largest parameters.
            pub fn yield_function(&self, tau: [f64; 3], state: &[f64]) -> f64 {
                match self {
                    $(Self::$Law(law) => law.yield_function(tau, state),)*
                    Self::Graded(law) => law.most().yield_function(tau, state),
                }
            }

            /// Kirchhoff stress in Pa of a point, or of several, by components XX, YY, ZZ, XY of `b_trial` and the
            /// `state` of the last step, which has the law's variables first: as [`Material::respond`] has it. `None`
            /// where only that can tell: of a graded or long law, and of trials of which one is no strain.
            #[inline(always)]
            pub fn stress<R: Real>(&self, b_trial: [R; 4], state: &[R]) -> Option<Symmetric<R>> {
                if !self.is_in_lanes() {
                    return None;
                }
                self.stress_of(&Spectrum::planar(b_trial)?, state)
            }

            /// The same by all components; `None` also where XZ and YZ of one are none.
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

            /// The response to a trial elastic left Cauchy-Green tensor, `b_trial = ΔF bᵉ ΔFᵀ` (Eq. 7), of a point in
            /// the `state` of the last step, which has the law's variables first; a graded law answers through
            /// [`Material::at`] only, and elastically here.
            ///
            /// # Errors
            /// When `b_trial` has a component that is not finite, or an eigenvalue that is not positive.
            // Always inlined: who wants the stress only does not pay for the rest of the response.
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
                    Self::Graded(law) => {
                        let moduli = law.stiffest().moduli();
                        (moduli, moduli.stress(spectrum.eps), Flowed::Elastic)
                    }
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

            /// `D_AB = ∂τ_A/∂ε_B`, Pa.
            pub fn tangent(&self, moduli: Moduli) -> Tensor {
                match self {
                    Self::Elastic => moduli.tangent(),
                    $(Self::$Law(flow) => $module::$Law::tangent(flow, moduli),)*
                }
            }

            /// See [`Law::secant_modulus`]; 2μ if elastic.
            pub fn secant_modulus(&self, moduli: Moduli, tau: f64, eps: f64) -> f64 {
                match self {
                    Self::Elastic => 2.0 * moduli.mu,
                    $(Self::$Law(flow) => $module::$Law::secant_modulus(flow, moduli, tau, eps),)*
                }
            }

            /// Whether the elastic part of the stress is linear in the strain, the same at all stresses.
            #[inline]
            pub fn is_linear(&self) -> bool {
                match self {
                    Self::Elastic => true,
                    $(Self::$Law(_) => <$module::$Law as Law>::LINEAR,)*
                }
            }

            /// See [`Law::elastic_strain`].
            pub fn elastic_strain(&self, moduli: Moduli, tau: [f64; 3]) -> [f64; 3] {
                match self {
                    Self::Elastic => moduli.strain(tau),
                    $(Self::$Law(flow) => $module::$Law::elastic_strain(flow, moduli, tau),)*
                }
            }

            /// See [`Law::elastic_moduli`].
            pub fn elastic_moduli(&self, moduli: Moduli) -> Moduli {
                match self {
                    Self::Elastic => moduli,
                    $(Self::$Law(flow) => $module::$Law::elastic_moduli(flow, moduli),)*
                }
            }

            /// See [`Law::elastic_energy`].
            pub fn elastic_energy(&self, moduli: Moduli, eps: [f64; 3]) -> f64 {
                match self {
                    Self::Elastic => moduli.energy(eps),
                    $(Self::$Law(flow) => $module::$Law::elastic_energy(flow, moduli, eps),)*
                }
            }

            /// Puts the state after the return in the place of that before it.
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
    /// Elastic at any strain.
    hencky::Hencky,
    /// Elastic, perfectly plastic with friction, dilation and cohesion.
    mohr_coulomb::MohrCoulomb,
    /// Mohr-Coulomb's strength with a cone in the place of its pyramid.
    drucker_prager::DruckerPrager,
    /// Elastic, plastic without friction, hardening linearly.
    von_mises::VonMises,
    /// Mohr-Coulomb's strength that follows the plastic strain.
    softening::SofteningMohrCoulomb,
    /// Elastic by the pressure, plastic by the largest that it has seen: modified Cam-clay.
    cam_clay::CamClay,
    /// Dense granular flow whose friction grows with the rate of shear.
    mu_i::MuI,
}

/// Numbers of state of one law at most.
pub const MOST_STATE: usize = 8;

/// Numbers of state that the points of these materials carry.
pub fn state_width<'a>(materials: impl IntoIterator<Item = &'a Material>) -> usize {
    materials
        .into_iter()
        .map(|material| material.state().len())
        .max()
        .unwrap_or(0)
}

impl Material {
    /// The law of a point that was placed at `height` (m from the grid's lower corner).
    #[inline]
    pub fn at(&self, height: f64) -> Cow<'_, Self> {
        match self {
            Self::Graded(law) => Cow::Owned(law.at(height)),
            uniform => Cow::Borrowed(uniform),
        }
    }

    /// Young's modulus at `height` over that of [`Material::elastic`].
    #[inline]
    pub fn relative_stiffness(&self, height: f64) -> f64 {
        if let Self::Graded(law) = self {
            law.relative_stiffness(height)
        } else {
            1.0
        }
    }

    /// Young's modulus at a height, Pa.
    pub fn young_at(&self, height: f64) -> f64 {
        self.elastic().young * self.relative_stiffness(height)
    }

    /// Whether parameters depend on the height.
    pub fn is_graded(&self) -> bool {
        matches!(self, Self::Graded(_))
    }

    /// Elastic energy per reference volume of the state `b_e`, J/m3; of a graded law through [`Material::at`] only.
    ///
    /// # Errors
    /// When `b_e` is not finite or not positive definite.
    pub fn elastic_energy(&self, b_e: &Symmetric) -> Result<f64, MaterialError> {
        Ok(self.energy(Spectrum::of(b_e)?.eps))
    }
}

/// Why a material has no response.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A component of the trial tensor is NaN, infinite or beyond 1e100.
    #[error("the deformation in this step is not finite (elastic left Cauchy-Green tensor {0:?})")]
    NotFinite([f64; 6]),
    /// An eigenvalue of the trial tensor is not positive, or below 1e-100: the step has turned the material inside out.
    #[error(
        "the step turns the material inside out (smallest eigenvalue of the elastic left Cauchy-Green tensor {0:e}, must \
         be positive)"
    )]
    NotPositive(f64),
    /// The law has no stress for these principal strains, or no state: a pressure beyond all numbers, or one that was
    /// never given at the start.
    #[error("the material model has no finite stress at the principal elastic strains {0:?}")]
    NoStress([f64; 3]),
}
