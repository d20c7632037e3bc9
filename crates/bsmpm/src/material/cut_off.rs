//! Tension cut-off of other laws, theory-manual equations (T4.19) to (T4.23): Rankine planes with associated flow, and
//! a tensile strength that may decrease with the plastic strain across cracks.

use super::drucker_prager::DruckerPrager;
use super::law::{Branch, Law, MOST_PARAMETERS, Projection, Separation, Variable};
use super::mohr_coulomb::MohrCoulomb;
use super::softening::Decay;
use super::von_mises::VonMises;
use super::{Elastic, MOST_STATE, Moduli};
use crate::real::{Real, three};
use crate::tensor::Tensor;

/// Mohr-Coulomb or Tresca law with a tension cut-off.
pub type MohrCoulombCutOff = CutOff<MohrCoulomb>;
/// Drucker-Prager law with a tension cut-off.
pub type DruckerPragerCutOff = CutOff<DruckerPrager>;
/// Von Mises law with a tension cut-off.
pub type VonMisesCutOff = CutOff<VonMises>;

/// Largest number of evaluations of the wrapped law in a return; bisection at every third needs as many.
const EVALUATIONS: usize = 160;
/// Error of the largest principal stress, relative to the trial stress, that is round-off.
const AGREED: f64 = 4.0 * f64::EPSILON;
/// Pivot, relative to the shear modulus, below which the tangent does not depend on the crack strain of an axis.
const PIVOT: f64 = 1e-12;

/// Tensile strength, and its decrease with the crack strain κ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensileStrength {
    /// Strength f_t without cracks (Pa), at least 0.
    pub strength: f64,
    /// Crack strain κ_r at the end of the decrease, or with exponential decay at 95 % of it (-); 0 for a constant
    /// strength.
    pub strain: f64,
    /// Form of the decrease to 0.
    pub decay: Decay,
    /// Whether strength reduction divides the tensile strength, too.
    pub is_reduced: bool,
}

impl TensileStrength {
    /// Returns whether the strength decreases with the crack strain.
    fn softens(&self) -> bool {
        self.strain > 0.0 && self.strength > 0.0
    }

    /// Returns the strength after the crack strain κ (Pa), and its derivative.
    #[inline(always)]
    fn after<R: Real>(&self, kappa: R) -> (R, R) {
        let whole = kappa.like(self.strength);
        if !self.softens() {
            return (whole, kappa.like(0.0));
        }
        let (progress, rate) = self.decay.progress(kappa, self.strain);
        (whole - progress * self.strength, -(rate * self.strength))
    }

    /// Returns the strength after strength reduction.
    fn reduced(self, factor: f64) -> Self {
        let divisor = if self.is_reduced { factor } else { 1.0 };
        Self {
            strength: self.strength / divisor,
            ..self
        }
    }
}

/// Law `L` whose principal stresses are at most the tensile strength: `τ_A ≤ f_t(κ)`.
///
/// The wrapped law must be linear elastic, and its return must not increase the largest principal stress.
#[derive(Clone, Debug, PartialEq)]
pub struct CutOff<L> {
    law: L,
    tension: TensileStrength,
}

/// Return data.
#[derive(Clone, Copy, Debug)]
pub struct CutOffReturn<R: Real, F> {
    /// Return data of the wrapped law for the trial stress that the cracks leave.
    inner: F,
    /// Whether that trial stress yields.
    inner_yields: R::Mask,
    /// Whether a crack opens across each principal axis.
    opens: [R::Mask; 3],
    /// Growth of κ (-).
    growth: R,
    /// Derivative of the tensile strength with respect to κ (Pa).
    slope: R,
}

impl<L> CutOff<L> {
    /// Creates the cut-off of a law.
    pub fn new(law: L, tension: TensileStrength) -> Self {
        Self { law, tension }
    }

    /// Returns the wrapped law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// Returns the tensile strength and its decrease.
    pub fn tension(&self) -> TensileStrength {
        self.tension
    }
}

/// Trial stress that cracks leave.
struct Opened<R: Real> {
    tau: [R; 3],
    /// Whether a crack opens across each axis.
    opens: [R::Mask; 3],
}

/// Returns `τ_trial - D γ` for the crack strains γ ≥ 0 with the sum κ that lower the largest stresses to one level:
/// `min(τ_A, level) - λ κ`, with `Σ max(τ_A - level, 0) = 2μ κ`.
///
/// With k cracks the level is `(Σ τ_A over the k largest - 2μ κ)/k`; the right k gives the largest of these.
#[inline(always)]
fn opened<R: Real>(moduli: Moduli, trial: [R; 3], kappa: R) -> Opened<R> {
    let released = kappa * (2.0 * moduli.mu);
    let one = trial[0] - released;
    let two = (trial[0] + trial[1] - released) / 2.0;
    let three_axes = (trial[0] + trial[1] + trial[2] - released) / 3.0;
    let level = larger(larger(one, two), three_axes);
    let opens = [level.below(trial[0]), level.below(trial[1]), level.below(trial[2])];
    let tau = three(|k| R::choose(opens[k], level, trial[k]) - kappa * moduli.lambda);
    Opened { tau, opens }
}

/// Returns the sum κ of the crack strains that alone lower the largest stress to a `target` (Pa).
#[inline(always)]
fn opening<R: Real>(moduli: Moduli, trial: [R; 3], target: f64) -> R {
    let Moduli { lambda, mu } = moduli;
    let one = (trial[0] - target) / (2.0 * mu + lambda);
    let two = (trial[0] + trial[1] - 2.0 * target) / (2.0 * (mu + lambda));
    let three_axes = (trial[0] + trial[1] + trial[2] - 3.0 * target) / (3.0 * moduli.bulk());
    larger(larger(one, two), three_axes)
}

#[inline(always)]
fn larger<R: Real>(a: R, b: R) -> R {
    R::choose(a.below(b), b, a)
}

impl<L: Law> CutOff<L> {
    /// Number of state variables of the wrapped law; κ follows them.
    const INNER_STATE: usize = L::STATE.len();
    /// Number of parameters of the wrapped law; those of the tensile strength follow them.
    const INNER_PARAMETERS: usize = L::PARAMETERS.len();
    const ALL_PARAMETERS: [Variable; MOST_PARAMETERS] = {
        let mut all = [Variable::new("", "-"); MOST_PARAMETERS];
        let mut k = 0;
        while k < Self::INNER_PARAMETERS {
            all[k] = L::PARAMETERS[k];
            k += 1;
        }
        all[k] = Variable::new("tensile_strength", "Pa");
        all[k + 1] = Variable::new("crack_opening", "-");
        all
    };
    const ALL_STATE: [Variable; MOST_STATE] = {
        let mut all = [Variable::new("", "-"); MOST_STATE];
        let mut k = 0;
        while k < Self::INNER_STATE {
            all[k] = L::STATE[k];
            k += 1;
        }
        all[k] = Variable::new("crack_strain", "-");
        all
    };
    const IS_LINEAR: () = assert!(L::LINEAR);

    /// Returns the growth of κ for which the largest stress of the wrapped law is the tensile strength, where `opens`;
    /// by the secant method safeguarded by bisection.
    ///
    /// κ lies between 0, where the stress is too large, and the value at which the cracks alone lower it to the least
    /// strength.
    #[inline(always)]
    fn solve<R: Real>(&self, trial: [R; 3], state: &[R], opens: R::Mask) -> R {
        let moduli = self.law.moduli();
        let before = state[Self::INNER_STATE];
        let none = before.like(0.0);
        let size = trial[0].magnitude() + trial[1].magnitude() + trial[2].magnitude();
        let least = if self.tension.softens() {
            0.0
        } else {
            self.tension.strength
        };
        let mut low = none;
        let mut high = opening(moduli, trial, least);
        let mut growth = high;
        let mut last_growth = none;
        let mut last_excess = none;
        let mut found = high;
        let mut sought = opens;
        for evaluation in 0..EVALUATIONS {
            let left = opened(moduli, trial, growth).tau;
            let tau = self.law.return_map(left, state).tau;
            let excess = tau[0] - self.tension.after(before + growth).0;
            let agrees = excess.magnitude().at_most(size * AGREED) | (high - low).at_most(high * f64::EPSILON);
            found = R::choose(sought & agrees, growth, found);
            sought = sought & !agrees;
            if !R::any(sought) {
                break;
            }
            low = R::choose(none.below(excess), growth, low);
            high = R::choose(excess.below(none), growth, high);
            let secant = growth - excess * (growth - last_growth) / (excess - last_excess);
            let inside = low.below(secant) & secant.below(high);
            let middle = (low + high) * 0.5;
            (last_growth, last_excess) = (growth, excess);
            growth = if evaluation % 3 == 2 {
                middle
            } else {
                R::choose(inside, secant, middle)
            };
        }
        found
    }
}

impl<L: Law> Law for CutOff<L> {
    type Flow<R: Real> = CutOffReturn<R, L::Flow<R>>;
    const PARAMETERS: &'static [Variable] = Self::ALL_PARAMETERS.split_at(Self::INNER_PARAMETERS + 2).0;
    const STATE: &'static [Variable] = Self::ALL_STATE.split_at(Self::INNER_STATE + 1).0;
    const IN_LANES: bool = false;

    fn elastic(&self) -> &Elastic {
        self.law.elastic()
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.law.moduli()
    }

    fn parameters(&self) -> Vec<f64> {
        let own = [self.tension.strength, self.tension.strain];
        [&self.law.parameters()[..], &own].concat()
    }

    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        let (inner, own) = parameters.split_at(Self::INNER_PARAMETERS);
        Self {
            law: self.law.with_parameters(elastic, inner),
            tension: TensileStrength {
                strength: own[0],
                strain: own[1],
                ..self.tension
            },
        }
    }

    /// Returns the larger of the yield function of the wrapped law and `τ₁ - f_t(κ)`.
    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], state: &[R]) -> R {
        let tension = tau[0] - self.tension.after(state[Self::INNER_STATE]).0;
        larger(self.law.yield_function(tau, state), tension)
    }

    /// Returns a trial stress to the wrapped law's yield surface, if that satisfies the cut-off; otherwise opens cracks
    /// until it does.
    ///
    /// The final limit to the strength removes round-off. It does not violate the wrapped law, because it reduces
    /// differences of principal stresses and their mean.
    #[inline(never)]
    fn return_map<R: Real>(&self, trial: [R; 3], state: &[R]) -> Projection<R, Self::Flow<R>> {
        let () = Self::IS_LINEAR;
        let before = state[Self::INNER_STATE];
        let none = before.like(0.0);
        let sheared = self.law.return_map(trial, state);
        let cracks = !sheared.tau[0].at_most(self.tension.after(before).0);
        if !R::any(cracks) {
            return Projection {
                tau: sheared.tau,
                yields: sheared.yields,
                flow: CutOffReturn {
                    inner: sheared.flow,
                    inner_yields: sheared.yields,
                    opens: [cracks; 3],
                    growth: none,
                    slope: none,
                },
            };
        }
        let growth = R::choose(cracks, self.solve(trial, state, cracks), none);
        let Opened { tau, opens } = opened(self.law.moduli(), trial, growth);
        let inner = self.law.return_map(tau, state);
        let (strength, slope) = self.tension.after(before + growth);
        let tau = three(|k| R::choose(cracks & strength.below(inner.tau[k]), strength, inner.tau[k]));
        Projection {
            tau,
            yields: cracks | inner.yields,
            flow: CutOffReturn {
                inner: inner.flow,
                inner_yields: inner.yields,
                opens: [cracks & opens[0], cracks & opens[1], cracks & opens[2]],
                growth,
                slope,
            },
        }
    }

    /// Returns the corner of the cut-off by the number of cracks; with one crack that of the wrapped law.
    fn branch(flow: &CutOffReturn<f64, L::Flow<f64>>) -> Branch {
        match flow.opens {
            [.., true] => Branch::Apex,
            [_, true, _] => Branch::LeftEdge,
            _ if flow.inner_yields => L::branch(&flow.inner),
            _ => Branch::Face,
        }
    }

    /// Returns `A - A_{·c} (A_{cc} + f_t')⁻¹ A_{c·}`: A is the tangent of the wrapped law at the trial stress that the
    /// cracks leave, c the axes with cracks; f_t' is added to all entries of A_{cc}.
    ///
    /// This follows from `dτ = A (dε - dγ)` and `dτ_c = f_t' Σ dγ`. Where an edge of the wrapped law and two cracks
    /// meet, only the sum of the crack strains has an effect, and the second one is set to 0.
    fn tangent(flow: &CutOffReturn<f64, L::Flow<f64>>, moduli: Moduli) -> Tensor {
        let inner = if flow.inner_yields {
            L::tangent(&flow.inner, moduli)
        } else {
            moduli.tangent()
        };
        let cracks = flow.cracks();
        // Gauss-Jordan elimination of `left dγ = right dε`, one row per crack.
        let mut left = inner.add_scalar(flow.slope);
        let mut right = inner;
        for pivot in 0..cracks {
            let scale = left[(pivot, pivot)];
            if scale.abs() <= PIVOT * moduli.mu {
                left.fill_column(pivot, 0.0);
                left.fill_row(pivot, 0.0);
                right.fill_row(pivot, 0.0);
                continue;
            }
            for row in (0..cracks).filter(|row| *row != pivot) {
                let factor = left[(row, pivot)] / scale;
                for k in 0..3 {
                    left[(row, k)] -= factor * left[(pivot, k)];
                    right[(row, k)] -= factor * right[(pivot, k)];
                }
            }
            for k in 0..3 {
                left[(pivot, k)] /= scale;
                right[(pivot, k)] /= scale;
            }
        }
        Tensor::from_fn(|a, b| inner[(a, b)] - (0..cracks).map(|c| inner[(a, c)] * right[(c, b)]).sum::<f64>())
    }

    /// Returns the secant modulus of the wrapped law without cracks. With one crack, equal strains belong to the other
    /// two axes, whose difference the crack does not change.
    fn secant_modulus(flow: &CutOffReturn<f64, L::Flow<f64>>, moduli: Moduli, tau: f64, eps: f64) -> f64 {
        let cracks = flow.cracks();
        if cracks > 0 && eps > 0.0 {
            (tau / eps).max(0.0).min(2.0 * moduli.mu)
        } else if cracks > 1 {
            0.0
        } else if flow.inner_yields {
            L::secant_modulus(&flow.inner, moduli, tau, eps)
        } else {
            2.0 * moduli.mu
        }
    }

    fn advance(flow: &CutOffReturn<f64, L::Flow<f64>>, state: &mut [f64]) {
        if flow.inner_yields {
            L::advance(&flow.inner, state);
        }
        state[Self::INNER_STATE] += flow.growth;
    }

    fn reduced(self, factor: f64) -> Self {
        Self {
            law: self.law.reduced(factor),
            tension: self.tension.reduced(factor),
        }
    }

    fn dilation(&self) -> f64 {
        self.law.dilation()
    }

    fn hardens(&self) -> bool {
        self.law.hardens()
    }

    fn softens(&self) -> bool {
        self.law.softens() || self.tension.softens()
    }

    fn separation(&self) -> Separation {
        self.law.separation()
    }
}

impl<F> CutOffReturn<f64, F> {
    /// Returns the number of cracks that open; they are normal to the first axes.
    fn cracks(&self) -> usize {
        self.opens.iter().filter(|opens| **opens).count()
    }
}
