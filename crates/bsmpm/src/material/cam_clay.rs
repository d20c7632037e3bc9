//! Modified Cam-clay at finite strain, theory-manual equations (T4.14) to (T4.16), after Borja and Tamagnini (1998).

use super::law::{Branch, Law, Projection, Variable, split};
use super::{Elastic, Moduli};
use crate::real::{Real, three};
use crate::tensor::Tensor;

/// Largest number of evaluations of the return; bisection alone needs as many.
const EVALUATIONS: usize = 100;

/// Modified Cam-clay: pressure-dependent elasticity within an ellipse that plastic compression enlarges and dilation
/// shrinks.
#[derive(Clone, Debug, PartialEq)]
pub struct CamClay {
    elastic: Elastic,
    moduli: Moduli,
    numbers: [f64; 5],
    constants: Constants,
}

/// Constants of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Constants {
    swelling: f64,  // κ̂
    hardening: f64, // λ̂ - κ̂
    ratio: f64,     // M
    mu: f64,        // Pa
    reference: f64, // p_r (Pa)
}

/// Return data, also for a trial that does not yield.
#[derive(Clone, Copy, Debug)]
pub struct CamClayReturn<R: Real> {
    constants: Constants,
    yields: R::Mask,
    /// Principal deviator of the trial divided by its norm (-); 0 without a deviator.
    direction: [R; 3],
    /// Volumetric strain of the elastic state (-).
    volume: R,
    /// Mean pressure p, and in `deviator` the deviatoric stress q (Pa).
    pressure: R,
    deviator: R,
    /// Preconsolidation pressure p_c (Pa).
    preconsolidation: R,
    /// Plastic multiplier of the gradient of f (1/Pa).
    multiplier: R,
}

impl CamClay {
    /// Creates a law from `[κ, λ, M, p_c, ocr]`. The slopes 0 < κ < λ < 1 of swelling and first loading are those of ln
    /// v over ln p, and M > 0. The initial p_c (Pa) is given, or, if it is 0, the ellipse is `ocr` ≥ 1 times as large
    /// as that through the initial stress. The shear modulus is that of `elastic`, whose bulk modulus K applies at the
    /// pressure κ̂ K.
    pub fn new(elastic: Elastic, [kappa, lambda, ratio, preconsolidation, ocr]: [f64; 5]) -> Self {
        let moduli = elastic.moduli();
        let swelling = kappa / (1.0 - kappa);
        let compression = lambda / (1.0 - lambda);
        let hardening = compression - swelling;
        let reference = swelling * moduli.bulk();
        let constants = Constants {
            swelling,
            hardening,
            ratio,
            mu: moduli.mu,
            reference,
        };
        Self {
            elastic,
            moduli,
            numbers: [kappa, lambda, ratio, preconsolidation, ocr],
            constants,
        }
    }

    /// Returns the pressure at which the bulk modulus equals that of the elastic part (Pa).
    pub fn reference_pressure(&self) -> f64 {
        self.constants.reference
    }
}

impl Constants {
    /// Returns the yield function divided by p_c, `f/p_c` (Pa).
    #[inline(always)]
    fn yield_function<R: Real>(&self, pressure: R, deviator: R, preconsolidation: R) -> R {
        let slope = deviator / self.ratio;
        slope * slope / preconsolidation + pressure * (pressure / preconsolidation - 1.0)
    }

    /// Returns, for the stress ratio η = r M after the return, the reduction d of the volumetric strain, p_c, and the
    /// elastic shear strain. The trial has the pressure π = `pressure`, and `before` is p_c of the last step.
    ///
    /// On the ellipse p = p_c/(1 + r²). Since p and p_c are exponential functions of the volume change d,
    /// `d = κ̂ (λ̂ - κ̂)/λ̂ ln(p_c,n/(π (1 + r²)))`.
    #[inline(always)]
    fn at_ratio<R: Real>(&self, r: R, pressure: R, before: R) -> (R, R, R) {
        let share = self.swelling * self.hardening / (self.swelling + self.hardening);
        let lost = logarithm(before / (pressure * (r * r + 1.0))) * share;
        let preconsolidation = before * exponential(lost / -self.hardening);
        (
            lost,
            preconsolidation,
            preconsolidation * r * (self.ratio / (3.0 * self.mu)) / (r * r + 1.0),
        )
    }

    /// Returns the ratio r = η/M for which the plastic strain is normal to the ellipse:
    /// `2 r d/M + (s_trial - s)(1 - r²) = 0`. The root lies between the critical state, r = 1, and the ratio without
    /// volume change. Newton's method is safeguarded by bisection.
    #[inline(always)]
    fn solve<R: Real>(&self, pressure: R, shear: R, before: R) -> R {
        let one = pressure.like(1.0);
        let none = pressure.like(0.0);
        let wet = (before * 0.5).at_most(pressure);
        let highest = (before / pressure - 1.0).magnitude().root();
        let mut low = R::choose(wet, none, one);
        let mut high = R::choose(wet, one, highest);
        let trial = shear * (3.0 * self.mu / self.ratio) / pressure;
        let inside = low.below(trial) & trial.below(high);
        let mut r = R::choose(inside, trial, (low + high) * 0.5);
        let mut sought = none.at_most(none);
        // With a = κ̂ (λ̂ - κ̂)/λ̂, d = a ln(p_c,n/π) - a ln(1 + r²), so that dd/dr = -2 a r/(1 + r²). Then dp_c/dr =
        // -p_c/(λ̂ - κ̂) dd/dr, and s = M p_c r/(3 μ (1 + r²)).
        for _ in 0..EVALUATIONS {
            let (lost, preconsolidation, kept) = self.at_ratio(r, pressure, before);
            let square = r * r;
            let rest = shear - kept;
            let value = r * lost * (2.0 / self.ratio) + rest * (one - square);
            low = R::choose(none.below(value), r, low);
            high = R::choose(value.below(none), r, high);
            let share = self.swelling * self.hardening / (self.swelling + self.hardening);
            let along = r * (-2.0 * share) / (square + 1.0);
            let grown = preconsolidation * along / -self.hardening;
            let of_shear = (grown * r + preconsolidation * (one - square) / (square + 1.0))
                * (self.ratio / (3.0 * self.mu))
                / (square + 1.0);
            let slope = (lost + r * along) * (2.0 / self.ratio) - of_shear * (one - square) - r * rest * 2.0;
            let step = r - value / slope;
            let next = R::choose(low.at_most(step) & step.at_most(high), step, (low + high) * 0.5);
            // The bounds may also have met: the middle of neighbouring floats is one of them.
            let found = (next - r).magnitude().at_most(r * 2e-16) | value.at_most(none) & none.at_most(value);
            r = R::choose(sought & !found, next, r);
            sought = sought & !found;
            if !R::any(sought) {
                break;
            }
        }
        r
    }
}

impl Law for CamClay {
    type Flow<R: Real> = CamClayReturn<R>;
    const PARAMETERS: &'static [Variable] = &[
        Variable::new("kappa_star", "-"),
        Variable::new("lambda_star", "-"),
        Variable::new("critical_state_ratio", "-"),
        Variable::new("preconsolidation", "Pa"),
        Variable::new("ocr", "-"),
    ];
    const STATE: &'static [Variable] = &[Variable::new("preconsolidation", "Pa")];
    const IN_LANES: bool = false;
    const LINEAR: bool = false;

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.moduli
    }

    fn parameters(&self) -> Vec<f64> {
        self.numbers.to_vec()
    }

    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        Self::new(elastic, std::array::from_fn(|k| parameters[k]))
    }

    #[inline(always)]
    fn stress<R: Real>(&self, eps: [R; 3]) -> [R; 3] {
        let volume = eps[0] + eps[1] + eps[2];
        let mean = exponential(volume / -self.constants.swelling) * -self.constants.reference;
        three(|k| mean + (eps[k] - volume / 3.0) * (2.0 * self.constants.mu))
    }

    /// Returns the principal strains of a stress; NaN for a tensile mean stress.
    fn strain(&self, tau: [f64; 3]) -> [f64; 3] {
        let mean = (tau[0] + tau[1] + tau[2]) / 3.0;
        let volume = -self.constants.swelling * (-mean / self.constants.reference).ln();
        tau.map(|tau| (tau - mean) / (2.0 * self.constants.mu) + volume / 3.0)
    }

    /// Returns `p_r κ̂ exp(-ε_v/κ̂) + μ |dev ε|²`, relative to zero pressure.
    fn energy(&self, eps: [f64; 3]) -> f64 {
        let volume = eps[0] + eps[1] + eps[2];
        let squares: f64 = eps.iter().map(|eps| (eps - volume / 3.0).powi(2)).sum();
        let Constants {
            swelling,
            reference,
            mu,
            ..
        } = self.constants;
        swelling * reference * (-volume / swelling).exp() + mu * squares
    }

    fn initial_state(&self, tau: [f64; 3], state: &mut [f64]) {
        let (mean, _, norm) = split(tau);
        let [.., preconsolidation, ocr] = self.numbers;
        let slope = 1.5_f64.sqrt() * norm / self.constants.ratio;
        state[0] = if preconsolidation > 0.0 {
            preconsolidation
        } else {
            ocr * (slope * slope / -mean - mean)
        };
    }

    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], state: &[R]) -> R {
        let (mean, _, norm) = split(tau);
        self.constants.yield_function(-mean, norm * 1.5_f64.sqrt(), state[0])
    }

    #[inline(never)]
    fn return_map<R: Real>(&self, trial: [R; 3], state: &[R]) -> Projection<R, CamClayReturn<R>> {
        let constants = self.constants;
        let before = state[0];
        let (mean, part, norm) = split(trial);
        let none = mean.like(0.0);
        let pressure = -mean;
        let q = norm * 1.5_f64.sqrt();
        let yields = !constants.yield_function(pressure, q, before).at_most(none);
        let shear = q / (3.0 * constants.mu);
        let r = if R::any(yields) {
            constants.solve(pressure, shear, before)
        } else {
            none
        };
        let (lost, after, kept) = constants.at_ratio(r, pressure, before);
        let square = r * r + 1.0;
        // Components of the plastic strain along the normal, either of which may be zero.
        let along = [
            after * (r * r - 1.0) / square,
            after * r * (2.0 / constants.ratio) / square,
        ];
        let multiplier = (lost * along[0] + (shear - kept) * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let returned = after / square;
        let over = R::choose(none.below(q), returned * r * constants.ratio / q, none);
        let direction = three(|k| R::choose(none.below(norm), part[k] / norm, none));
        let tau = three(|k| R::choose(yields, over * part[k] - returned, trial[k]));
        // Under an expansion so large that the pressure underflows, no elastic state exists.
        let tau = three(|k| R::choose(none.below(pressure), tau[k], none.like(f64::NAN)));
        let volume = logarithm(pressure / constants.reference) * -constants.swelling;
        let flow = CamClayReturn {
            constants,
            yields,
            direction,
            volume: R::choose(yields, volume - lost, volume),
            pressure: R::choose(yields, returned, pressure),
            deviator: R::choose(yields, returned * r * constants.ratio, q),
            preconsolidation: R::choose(yields, after, before),
            multiplier: R::choose(yields, multiplier, none),
        };
        Projection { tau, yields, flow }
    }

    fn branch(flow: &CamClayReturn<f64>) -> Branch {
        if flow.yields { Branch::Face } else { Branch::Elastic }
    }

    /// Returns the tangent of a return along the normal from `∂P/∂ε_v, ∂P/∂ε_s; ∂Q/∂ε_v, ∂Q/∂ε_s` (Borja and Tamagnini,
    /// 1998, section 3.3): the three equations are linearised and the multiplier is eliminated.
    fn tangent(flow: &CamClayReturn<f64>, _moduli: Moduli) -> Tensor {
        let CamClayReturn {
            constants,
            direction: n,
            preconsolidation,
            multiplier,
            ..
        } = *flow;
        let Constants {
            swelling,
            hardening,
            ratio,
            mu,
            ..
        } = constants;
        let mean = -flow.pressure;
        let bulk = flow.pressure / swelling;
        let growth = preconsolidation / hardening; // of p_c with the volume
        let normal = [2.0 * mean + preconsolidation, 2.0 * flow.deviator / (ratio * ratio)];
        let scale = [
            1.0 + multiplier * (2.0 * bulk + growth),
            1.0 + multiplier * 6.0 * mu / (ratio * ratio),
        ];
        let rate = [normal[0] * bulk + mean * growth, 3.0 * mu * normal[1]]; // of f with elastic strains
        let drive = rate[0] * normal[0] / scale[0] + rate[1] * normal[1] / scale[1];
        let turned = 2.0 * mu * flow.kept();
        let along = (2.0_f64 / 3.0).sqrt();
        // Changes of P and Q per unit of each principal strain, which is also the change of volume.
        let mut moved = n.map(|n| [bulk, 3.0 * mu * (along * n)]);
        if flow.yields {
            for (moved, n) in moved.iter_mut().zip(n) {
                let right = [1.0 + multiplier * growth, along * n];
                let by = (rate[0] * right[0] / scale[0] + rate[1] * right[1] / scale[1] - mean * growth) / drive;
                *moved = [
                    bulk * (right[0] - normal[0] * by) / scale[0],
                    3.0 * mu * (right[1] - normal[1] * by) / scale[1],
                ];
            }
        }
        Tensor::from_fn(|a, b| {
            let [mean, deviator] = moved[b];
            let across = if a == b { 2.0 / 3.0 } else { -1.0 / 3.0 } - n[a] * n[b];
            mean + along * deviator * n[a] + turned * across
        })
    }

    /// Returns 2μ times the ratio of shear strains: the return scales all differences equally.
    fn secant_modulus(flow: &CamClayReturn<f64>, moduli: Moduli, _tau: f64, _eps: f64) -> f64 {
        2.0 * moduli.mu * flow.kept()
    }

    fn elastic_strain(flow: &CamClayReturn<f64>, moduli: Moduli, tau: [f64; 3]) -> [f64; 3] {
        tau.map(|tau| (tau + flow.pressure) / (2.0 * moduli.mu) + flow.volume / 3.0)
    }

    fn elastic_moduli(flow: &CamClayReturn<f64>, moduli: Moduli) -> Moduli {
        let bulk = flow.pressure / flow.constants.swelling;
        Moduli {
            lambda: bulk - moduli.mu * (2.0 / 3.0),
            ..moduli
        }
    }

    fn elastic_energy(flow: &CamClayReturn<f64>, moduli: Moduli, _eps: [f64; 3]) -> f64 {
        flow.constants.swelling * flow.pressure + flow.deviator.powi(2) / (6.0 * moduli.mu)
    }

    fn advance(flow: &CamClayReturn<f64>, state: &mut [f64]) {
        state[0] = flow.preconsolidation;
    }

    /// Reduces the friction angle φ of the critical state in triaxial compression, `M = 6 sin φ/(3 - sin φ)`; p_c is
    /// unchanged.
    fn reduced(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        let [kappa, lambda, ratio, preconsolidation, ocr] = self.numbers;
        let sin = (3.0 * ratio / (6.0 + ratio)).min(1.0);
        let reduced = (sin.asin().tan() / factor).atan().sin();
        let ratio = 6.0 * reduced / (3.0 - reduced);
        Self::new(self.elastic, [kappa, lambda, ratio, preconsolidation, ocr])
    }

    fn softens(&self) -> bool {
        true
    }
}

impl CamClayReturn<f64> {
    /// Returns the ratio of the elastic shear strain after the return to that of the trial (-).
    fn kept(&self) -> f64 {
        let Constants { mu, ratio, .. } = self.constants;
        1.0 / (1.0 + 6.0 * mu * self.multiplier / (ratio * ratio))
    }
}

#[inline(always)]
fn exponential<R: Real>(x: R) -> R {
    x.unless(!x.below(x), [x, x], |[x, _]| x.exp())
}

#[inline(always)]
fn logarithm<R: Real>(x: R) -> R {
    x.unless(!x.below(x), [x, x], |[x, _]| x.ln())
}
