//! Kelvin-Voigt damping: beside the law's stress a viscous one, the elastic stiffness times the rate of elastic strain.
//!
//! `τ_v = (β/Δt) D : (e - Δεᵖ)`, `e = ½ ln ΔF̄ ΔF̄ᵀ` the strain of the step, Δεᵖ what of it is plastic, D : Δεᵖ what
//! the return took from the trial stress, and β the material's retardation time: a wave of the circular frequency ω has
//! the damping ratio βω/2. By the mean rate of the step it takes energy in every step in which nothing flows, however
//! long, and a motion at constant velocity or a rotation feels nothing of it. It comes half a step late, which raises
//! the frequency by the share βω²Δt/4. Both strains are logarithms, as their difference is small where soil flows:
//! ½ (ΔF̄ ΔF̄ᵀ - I) dilates by γ²/2 under a shear γ.
//!
//! With the rate of all strain the stress would have no bound where material flows: the clay of
//! `cases/shaken_slope.toml` slips .031 m with 5 % at 2 Hz by it, .270 m by that of elastic strain, .286 m without.
//!
//! What smoothing takes from the elastic strain after a step comes back as a strain in the next, at whose rate damping
//! carries a part of the stress that the law should: the short collapse with 2 % at 5 Hz, steps of 1, .5 and .25 ms,
//! has a run-out of .479, .504 and .532 m with consistent F-bar (.474, .452, .467 without damping), .435, .427, .405
//! with modified F-bar (.458, .467, .476), .448, .443, .432 with F-bar (.455, .444, .442), .483, .520, .540 with none
//! (.488, .535, .542). The rate would have to leave out what was smoothed, which the points would have to keep.

use crate::material::{MaterialError, Response, Tangent};
use crate::model::Model;
use crate::points::Points;
use crate::step::inertia::Inertia;
use crate::step::nodes::Nodes;
use crate::tensor::{Symmetric, Tensor};

/// β/Δt of every material; empty where none has any.
#[derive(Clone, Debug, Default)]
pub struct Damping(Vec<f64>);

/// The viscous stress of a point, and how it changes.
pub struct Viscous {
    /// Pa
    pub tau: Symmetric,
    /// J/m3  what it dissipates in the step per reference volume
    pub dissipation: f64,
    elastic: Response, // to the strain of the step, by moduli times β/Δt
    share: f64,        // β/Δt
}

impl Damping {
    /// Of a step; none without inertia, whose time is none, and of a state that no step has led to.
    pub fn of<K, const D: usize>(model: &Model<K, D>, nodes: &Nodes<D>) -> Self {
        let steps = |inertia: &&Inertia| inertia.dt > 0.0 && !model.damping.is_empty();
        let Some(inertia) = nodes.inertia.as_ref().filter(steps) else {
            return Self::default();
        };
        Self(model.damping.iter().map(|time| time / inertia.dt).collect())
    }

    /// What multiplies the elastic stiffness of a material.
    #[inline(always)]
    pub fn relative(&self, material: u16) -> Option<f64> {
        self.0.get(usize::from(material)).copied().filter(|&relative| relative > 0.0)
    }

    /// Lamé's moduli of point `p` times β/Δt, Pa; `None` where it has no damping.
    #[inline(always)]
    pub fn lame<K, const D: usize>(&self, model: &Model<K, D>, points: &Points<D>, p: usize) -> Option<(f64, f64)> {
        let relative = self.relative(points.material[p])?;
        let material = &model.materials[usize::from(points.material[p])];
        let (lambda, mu) = material.elastic().lame();
        let factor = relative * material.relative_stiffness(points.height(p));
        Some((factor * lambda, factor * mu))
    }
}

impl Viscous {
    /// Under the deformation ΔF̄ of a step, with Lamé's moduli times β/Δt, where a return took `returned`, Pa, from the
    /// trial stress, if it did, and β/Δt; a `gap` that was open before, as a logarithm of volume, is no strain.
    ///
    /// # Errors
    /// A step that is no strain.
    pub fn of(
        dF: &Tensor,
        lame: (f64, f64),
        (returned, share): (Option<Symmetric>, f64),
        gap: f64,
    ) -> Result<Self, MaterialError> {
        let elastic = Response::elastic(&Symmetric::of(&(dF * dF.transpose())), lame)?;
        let mut tau = elastic.tau();
        if let Some(returned) = returned {
            tau.0.iter_mut().zip(returned.0).for_each(|(tau, taken)| *tau -= taken * share);
        }
        if gap > 0.0 {
            tau.0[..3].iter_mut().for_each(|normal| *normal += (lame.0 + lame.1 * (2.0 / 3.0)) * gap);
        }
        let dissipation = tau.full().dot(&elastic.trial_strain().full());
        Ok(Self { tau, dissipation, elastic, share })
    }

    /// The stress beside `tau`, Pa.
    #[inline]
    pub fn beside(&self, mut tau: Symmetric) -> Symmetric {
        tau.0.iter_mut().zip(self.tau.0).for_each(|(tau, more)| *tau += more);
        tau
    }

    /// How the stress changes with a spatial gradient at the end of the step, Pa, where `returned` is how that changes
    /// which the return took.
    pub fn tangent(&self, returned: Option<[Tangent; 2]>) -> impl Fn(&Tensor) -> Tensor + use<> {
        let (elastic, share) = (self.elastic.tangent(), self.share);
        move |l| {
            let all = elastic.apply(l);
            returned.as_ref().map_or(all, |[trial, tau]| all - (trial.apply(l) - tau.apply(l)) * share)
        }
    }
}
