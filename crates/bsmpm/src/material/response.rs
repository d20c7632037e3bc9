//! Stress that a constitutive law returns at one material point, as principal values and axes.

use super::law::Branch;
use super::spectral::Spectrum;
use super::{Flowed, MaterialError, Moduli};
use crate::tensor::{Symmetric, Tensor};

/// Response of one point in the axes of the trial b; principal values are descending.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    b_trial: Symmetric,
    pub(super) trial: Spectrum,
    pub(super) moduli: Moduli,
    pub(super) tau: [f64; 3],
    pub(super) flowed: Flowed,
}

impl Response {
    #[inline]
    pub(super) fn new(b_trial: Symmetric, trial: Spectrum, moduli: Moduli, tau: [f64; 3], flowed: Flowed) -> Self {
        Self {
            b_trial,
            trial,
            moduli,
            tau,
            flowed,
        }
    }

    /// Returns the elastic response to a left Cauchy-Green tensor with the given moduli.
    ///
    /// # Errors
    /// As [`Material::respond`](super::Material::respond).
    pub fn elastic(b: &Symmetric, moduli: Moduli) -> Result<Self, MaterialError> {
        let spectrum = Spectrum::of(b)?;
        Ok(Self::new(
            *b,
            spectrum,
            moduli,
            moduli.stress(spectrum.eps),
            Flowed::Elastic,
        ))
    }

    /// Returns the Hencky strain of the trial state, `½ ln b_trial`.
    pub fn trial_strain(&self) -> Symmetric {
        self.trial.assemble(self.trial.eps)
    }

    /// Returns the Kirchhoff stress (Pa): `τ = Σ_A τ_A n_A ⊗ n_A` (Eq. 10).
    #[inline]
    pub fn tau(&self) -> Symmetric {
        self.trial.assemble(self.tau)
    }

    /// Returns the elastic left Cauchy-Green tensor after the return: `bᵉ = Σ_A exp(2 εᵉ_A) n_A ⊗ n_A`.
    ///
    /// Without plastic flow it is bitwise identical to the trial tensor.
    pub fn b_e(&self) -> Symmetric {
        if self.branch() == Branch::Elastic {
            return self.b_trial;
        }
        let eps_e = self.principal_eps_e();
        if eps_e[0] > 1.0 || eps_e[2] < -1.0 {
            return self.trial.assemble(eps_e.map(|e| (2.0 * e).exp()));
        }
        // Assembling b - I keeps the relative accuracy of small strains.
        let mut b = self.trial.assemble(eps_e.map(|e| (2.0 * e).exp_m1()));
        b.0[..3].iter_mut().for_each(|c| *c += 1.0);
        b
    }

    /// Returns the part of the yield surface on which the stress lies.
    #[inline]
    pub fn branch(&self) -> Branch {
        self.flowed.branch()
    }

    /// Returns the gap after the return as a logarithm of volume: `g = tr ε_trial - tr εᵉ` at the apex, else 0.
    ///
    /// In the next step, material with a gap starts from `b_trial exp(⅔ g)`, that is `ε_trial + g/3 I`. It stays at the
    /// apex until the gap has closed, and then resists at the volume at which it separated. This is the volume
    /// correction of Klár et al. (2016), "Drucker-Prager elastoplasticity for sand animation". g is constant during a
    /// step, so the form of the tangent does not change. Dilation by ψ on faces and edges is no gap.
    #[inline]
    pub fn gap(&self) -> f64 {
        if self.branch() != Branch::Apex {
            return 0.0;
        }
        let trial = self.trial.eps;
        let elastic = self.principal_eps_e();
        ((trial[0] + trial[1] + trial[2]) - (elastic[0] + elastic[1] + elastic[2])).max(0.0)
    }

    /// Returns the equivalent plastic strain of this return, `Δεᵖ = √(2/3) |dev(ε_trial - εᵉ)|`; 0 if elastic.
    #[inline]
    pub fn plastic_increment(&self) -> f64 {
        if self.branch() == Branch::Elastic {
            return 0.0;
        }
        let eps_e = self.principal_eps_e();
        let eps = self.trial.eps;
        let flow = [eps[0] - eps_e[0], eps[1] - eps_e[1], eps[2] - eps_e[2]];
        let a = flow[0] - flow[1];
        let b = flow[1] - flow[2];
        let c = flow[2] - flow[0];
        // |dev x|² is a third of the sum of squared differences.
        (2.0 * (a * a + b * b + c * c)).sqrt() / 3.0
    }

    /// Returns the plastic dissipation of this return per reference volume (J/m3), `τ : (ε_trial - εᵉ)`; 0 if elastic.
    #[inline]
    pub fn dissipation(&self) -> f64 {
        if self.branch() == Branch::Elastic {
            return 0.0;
        }
        let eps_e = self.principal_eps_e();
        let eps = self.trial.eps;
        (0..3).map(|k| self.tau[k] * (eps[k] - eps_e[k])).sum()
    }

    /// Returns the elastic energy per reference volume after the return (J/m3); `½ λ tr(εᵉ)² + μ εᵉ : εᵉ` if elasticity
    /// is linear.
    #[inline]
    pub fn elastic_energy(&self) -> f64 {
        self.flowed.elastic_energy(self.moduli, self.principal_eps_e())
    }

    /// Returns the principal Kirchhoff stress, descending (Pa).
    #[inline]
    pub fn principal_tau(&self) -> [f64; 3] {
        self.tau
    }

    /// Returns the principal Hencky strain of the trial state, descending: `ε = ½ ln b_trial` (Eq. 9).
    #[inline]
    pub fn principal_eps_trial(&self) -> [f64; 3] {
        self.trial.eps
    }

    /// Returns the principal elastic Hencky strain after the return, descending: `εᵉ = D⁻¹ τ` if elasticity is linear.
    #[inline]
    pub fn principal_eps_e(&self) -> [f64; 3] {
        if self.branch() == Branch::Elastic {
            self.trial.eps
        } else {
            self.flowed.elastic_strain(self.moduli, self.tau)
        }
    }

    /// Returns the stress reduction `D : (ε_trial - εᵉ)` by the return (Pa), with the moduli D of the law; `None`
    /// without plastic flow.
    pub fn returned(&self) -> Option<Symmetric> {
        if let Some(trial) = self.unreturned().filter(|_| self.flowed.is_linear()) {
            let trial = trial.tau().0;
            let tau = self.tau().0;
            return Some(Symmetric(std::array::from_fn(|k| trial[k] - tau[k])));
        }
        let eps_e = self.principal_eps_e();
        let eps = self.trial.eps;
        let plastic = [0, 1, 2].map(|k| eps[k] - eps_e[k]);
        (self.branch() != Branch::Elastic).then(|| self.trial.assemble(self.moduli.stress(plastic)))
    }

    /// Returns the second-order works of the step per reference volume (J/m3; Hill, 1958): `Δε : D : Δε` of elastic
    /// material, and the same less `Δε : D : Δεᵖ`. Δε is the strain of the step and D follows from the moduli of the
    /// law. `gap` is the gap before the step, which is part of the trial strain.
    pub fn second_order_works(&self, strain: &Tensor, gap: f64) -> [f64; 2] {
        let Moduli { lambda, mu } = self.moduli;
        let volumetric = strain.trace();
        let elastic = lambda * volumetric.powi(2) + 2.0 * mu * strain.dot(strain);
        let returned = self.returned().map_or(0.0, |returned| returned.full().dot(strain));
        [elastic, elastic - returned + self.moduli.bulk() * gap * volumetric]
    }

    /// Returns the derivative of [`Response::returned`] with respect to a spatial gradient (Pa). With nonlinear
    /// elasticity the mean stress is corrected for the difference of the bulk modulus after the return from that of the
    /// law.
    pub fn change_of_returned(&self) -> Option<impl Fn(&Tensor) -> Tensor + use<>> {
        let trial = self.unreturned()?.tangent();
        let own = self.tangent();
        let stiffer = self.moduli.bulk() / self.flowed.elastic_moduli(self.moduli).bulk() - 1.0;
        Some(move |l: &Tensor| {
            let tau = own.apply(l);
            trial.apply(l) - tau - Tensor::identity() * (stiffer * tau.trace() / 3.0)
        })
    }

    /// Returns the linear elastic response to the same trial with the moduli of this one; `None` without plastic flow.
    fn unreturned(&self) -> Option<Self> {
        let yields = self.branch() != Branch::Elastic;
        yields.then(|| Self {
            tau: self.moduli.stress(self.trial.eps),
            flowed: Flowed::Elastic,
            ..*self
        })
    }

    /// Replaces the state of the law before the return by that after it.
    pub fn advance(&self, state: &mut [f64]) {
        self.flowed.advance(state);
    }
}
