//! Kelvin-Voigt damping: adds the viscous stress, theory-manual equation (T5.6), to the stress of the law in each
//! iteration.

use crate::material::Moduli;
use crate::material::{MaterialError, Response};
use crate::model::Model;
use crate::points::Points;
use crate::step::nodes::GridState;
use crate::tensor::{Symmetric, Tensor};

/// β/Δt of every material (-); empty without damping.
#[derive(Clone, Debug, Default)]
pub struct Damping(Vec<f64>);

/// Viscous stress of a point and its derivative.
pub struct Viscous {
    /// Viscous Kirchhoff stress (Pa).
    pub tau: Symmetric,
    elastic: Response, // to the strain of the step, with moduli times β/Δt
    share: f64,        // β/Δt
}

impl Damping {
    /// Computes the ratios of a step. Without inertia, or in a state that no step led to, there is no damping.
    pub fn of<K, const D: usize>(model: &Model<K, D>, nodes: &GridState<D>) -> Self {
        match &nodes.inertia {
            Some(inertia) if inertia.dt > 0.0 => Self(model.damping.iter().map(|time| time / inertia.dt).collect()),
            _ => Self::default(),
        }
    }

    /// Returns the ratio of viscous to elastic stiffness of a material, if it is damped.
    #[inline(always)]
    pub fn relative(&self, material: u16) -> Option<f64> {
        self.0
            .get(usize::from(material))
            .copied()
            .filter(|&relative| relative > 0.0)
    }

    /// Returns Lamé's moduli of point `p` times β/Δt (Pa); `None` without damping.
    #[inline(always)]
    pub fn moduli<K, const D: usize>(&self, model: &Model<K, D>, points: &Points<D>, p: usize) -> Option<Moduli> {
        let relative = self.relative(points.material[p])?;
        let material = &model.materials[usize::from(points.material[p])];
        let Moduli { lambda, mu } = material.elastic().moduli();
        let factor = relative * material.relative_stiffness(points.height(p));
        Some(Moduli {
            lambda: factor * lambda,
            mu: factor * mu,
        })
    }
}

impl Viscous {
    /// Computes the viscous stress from the strain of a step as a left Cauchy-Green tensor, ΔF̄ c ΔF̄ᵀ. `moduli` are
    /// Lamé's moduli times β/Δt, `returned` is the stress that the return mapping removed (Pa), if it did, and `share`
    /// is β/Δt. A `gap` that was open before (logarithm of volume) is not strain.
    ///
    /// # Errors
    /// If the step has no valid strain.
    pub fn of(
        strained: &Symmetric,
        moduli: Moduli,
        returned: Option<Symmetric>,
        share: f64,
        gap: f64,
    ) -> Result<Self, MaterialError> {
        let elastic = Response::elastic(strained, moduli)?;
        let mut tau = elastic.tau();
        if let Some(returned) = returned {
            tau.0
                .iter_mut()
                .zip(returned.0)
                .for_each(|(tau, taken)| *tau -= taken * share);
        }
        if gap > 0.0 {
            tau.0[..3]
                .iter_mut()
                .for_each(|normal| *normal += (moduli.lambda + moduli.mu * (2.0 / 3.0)) * gap);
        }
        Ok(Self { tau, elastic, share })
    }

    /// Returns the viscous stress plus `tau` (Pa).
    #[inline]
    pub fn beside(&self, mut tau: Symmetric) -> Symmetric {
        tau.0.iter_mut().zip(self.tau.0).for_each(|(tau, more)| *tau += more);
        tau
    }

    /// Returns the change of the viscous stress with a spatial gradient at the end of the step (Pa). `returned` is the
    /// change of the stress that the return mapping removed.
    pub fn tangent<R: Fn(&Tensor) -> Tensor>(&self, returned: Option<R>) -> impl Fn(&Tensor) -> Tensor + use<R> {
        let elastic = self.elastic.tangent();
        let share = self.share;
        move |l| {
            let all = elastic.apply(l);
            returned.as_ref().map_or(all, |returned| all - returned(l) * share)
        }
    }
}
