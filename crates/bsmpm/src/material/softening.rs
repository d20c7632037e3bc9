//! Mohr-Coulomb law whose strength depends on plastic strain, theory-manual equation (T4.11), and optionally on the
//! strain rate (T4.13). The shear band width scales the softening strain of the case (T4.12).

pub use super::law::Strength;
use super::law::{Branch, Law, Projection, Variable, split};
use super::mohr_coulomb::{Corners, Pyramid, Slopes};
use super::{Elastic, Moduli};
use crate::real::{Real, three};
use crate::tensor::Tensor;

/// Dependence of the strength on κ/κ_r, the ratio of plastic strain to that of the residual strength.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decay {
    /// Linear up to κ_r, then constant.
    #[default]
    Linear,
    /// Exponential, `1 - exp(-3 κ/κ_r)`: 95 % of the change at κ_r.
    Exponential,
}

impl Decay {
    /// Returns the fraction of the change after the plastic strain κ, 0 to 1, and its derivative; `residual` is the
    /// plastic strain κ_r of the residual strength.
    #[inline(always)]
    pub(super) fn progress<R: Real>(self, kappa: R, residual: f64) -> (R, R) {
        let along = kappa / residual;
        let none = kappa.like(0.0);
        match self {
            Self::Linear => {
                let done = along.like(1.0).at_most(along); // a NaN is kept
                let progress = R::choose(done, along.like(1.0), along);
                (progress, R::choose(done, none, along.like(1.0 / residual)))
            }
            Self::Exponential => {
                let every = !along.below(none);
                let left = none.unless(every, [along, none], |[along, _]| (-RATE * along).exp());
                (left.like(1.0) - left, left * (RATE / residual))
            }
        }
    }
}

/// Dependence of the cohesion on the rate of plastic shear γ̇ᵖ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// Relative growth per decade of the rate, μ_r.
    pub per_decade: f64,
    /// Reference rate below which there is no growth (1/s).
    pub reference: f64,
}

/// Rate of the exponential decay.
const RATE: f64 = 3.0;
/// Largest number of evaluations of the return; bisection alone needs as many.
const EVALUATIONS: usize = 80;
/// Ratio of the bounds below which the logarithm is nearly linear and secants are used.
const STRAIGHT: f64 = 8.0;
/// Tolerances for the agreement of the plastic strain assumed in the strength with that of the return: relative to the
/// latter, and to the elastic strain of the trial, which limits the accuracy.
const AGREED: [f64; 2] = [1e-13, 1e-14];

/// Mohr-Coulomb law whose strength depends on the plastic strain κ.
#[derive(Clone, Debug, PartialEq)]
pub struct SofteningMohrCoulomb {
    elastic: Elastic,
    moduli: Moduli,
    peak: Strength,
    residual: Strength,
    strain: f64,
    decay: Decay,
    first: [f64; 3],  // sin φ, sin ψ, c cos φ (Pa) at the peak
    change: [f64; 3], // residual less peak values
    rate: Option<Rate>,
    dt: f64, // length of the step (s); infinite outside of one
}

/// Returns the parameters of the yield surface: sin φ, sin ψ (-) and c cos φ (Pa).
fn yield_parameters(strength: Strength) -> [f64; 3] {
    let Strength {
        friction_angle,
        dilation_angle,
        cohesion,
    } = strength;
    [
        friction_angle.sin(),
        dilation_angle.min(friction_angle).sin(),
        cohesion * friction_angle.cos(),
    ]
}

/// Return data.
#[derive(Clone, Copy, Debug)]
pub struct SofteningReturn<R: Real> {
    corners: Corners<R>,
    /// Trial stress (Pa).
    trial: [R; 3],
    /// Stress after the return (Pa).
    tau: [R; 3],
    slopes: Slopes<R>,
    /// Strength c cos φ (Pa).
    strength: R,
    /// Derivatives of sin φ, sin ψ and c cos φ (Pa) with respect to κ.
    rates: [R; 3],
    /// Growth of κ (-).
    growth: R,
}

impl SofteningMohrCoulomb {
    /// Creates a law with the strength `peak` without plastic strain and `residual` at the plastic strain κ_r > 0; 0 ≤
    /// φ < π/2 and 0 ≤ ψ ≤ φ (rad), c ≥ 0 (Pa).
    pub fn new(elastic: Elastic, peak: Strength, residual: Strength, strain: f64, decay: Decay) -> Self {
        let first = yield_parameters(peak);
        let last = yield_parameters(residual);
        let moduli = elastic.moduli();
        let change = [0, 1, 2].map(|k| last[k] - first[k]);
        Self {
            elastic,
            moduli,
            peak,
            residual,
            strain,
            decay,
            first,
            change,
            rate: None,
            dt: f64::INFINITY,
        }
    }

    /// Returns the law with a cohesion that grows with the shear rate.
    pub fn at_rate(self, rate: Rate) -> Self {
        Self {
            rate: Some(rate),
            ..self
        }
    }

    /// Returns the factor of the cohesion if κ grows by `growth` in the step, and its derivative.
    #[inline(always)]
    fn quickened<R: Real>(&self, growth: R) -> (R, R) {
        let (Some(Rate { per_decade, .. }), Some(least)) = (self.rate, self.slowest()) else {
            return (growth.like(1.0), growth.like(0.0));
        };
        let quick = growth.like(least).below(growth);
        let over = growth / least;
        let decades = growth.like(0.0).unless(quick, [over, over], |[over, _]| over.log10());
        let slope = growth.like(per_decade / std::f64::consts::LN_10) / growth;
        (decades * per_decade + 1.0, R::choose(quick, slope, growth.like(0.0)))
    }

    /// Returns the pyramid after the plastic strain κ, which has grown by `growth` in the step.
    #[inline(always)]
    fn pyramid<R: Real>(&self, kappa: R, growth: R) -> Pyramid<R> {
        let (progress, _) = self.decay.progress(kappa, self.strain);
        let [sin_phi, sin_psi, strength] = three(|k| progress * self.change[k] + self.first[k]);
        let strength = if self.rate.is_some() {
            strength * self.quickened(growth).0
        } else {
            strength
        };
        Pyramid::new(self.moduli, Slopes { sin_phi, sin_psi }, strength)
    }

    /// Returns the plastic strain of a return, `√(2/3) |dev(τ_trial - τ)|/(2μ)`.
    #[inline(always)]
    fn growth<R: Real>(&self, trial: [R; 3], tau: [R; 3]) -> R {
        split(three(|k| trial[k] - tau[k])).2 * ((2.0_f64 / 3.0).sqrt() / (2.0 * self.moduli.mu))
    }

    /// Returns the growth of κ in the step at the reference rate, if there is one.
    fn slowest(&self) -> Option<f64> {
        self.rate.map(|rate| self.dt * rate.reference / 3.0_f64.sqrt())
    }

    /// Returns the growth of κ that is consistent with the strength it leads to, by the secant method safeguarded by
    /// bisection; NaN without convergence. Rate-dependent strength varies with the logarithm of the growth over many
    /// decades: the logarithm is bisected until the bounds are so close that it is nearly linear.
    #[inline(always)]
    fn solve<R: Real>(&self, trial: [R; 3], kappa: R) -> R {
        let none = kappa.like(0.0);
        let size = trial[0].magnitude() + trial[1].magnitude() + trial[2].magnitude();
        let round_off = size * (AGREED[1] / (2.0 * self.moduli.mu));
        let mut low = none;
        let mut high = none.like(f64::INFINITY);
        let mut growth = none;
        let mut last_growth = none;
        let mut last_gap = none;
        let mut found = none.like(f64::NAN);
        let mut sought = none.at_most(none);
        for _ in 0..EVALUATIONS {
            let made = self.growth(trial, self.pyramid(kappa + growth, growth).return_map(trial).0);
            let gap = made - growth;
            // If strength decreases faster than stress, the bounds meet before all digits agree.
            let met = high.below(none.like(f64::INFINITY)) & (high - low).at_most(high * 4e-16);
            let agrees = gap.magnitude().at_most(made * AGREED[0] + round_off) | met;
            found = R::choose(sought & agrees, growth, found);
            sought = sought & !agrees;
            if !R::any(sought) {
                break;
            }
            low = R::choose(none.below(gap), growth, low);
            high = R::choose(gap.below(none), growth, high);
            let bounded = high.below(none.like(f64::INFINITY));
            let slope = (gap - last_gap) / (growth - last_growth);
            let secant = growth - gap / slope;
            let mut middle = (low + high) * 0.5;
            let mut inside = low.below(secant) & secant.below(high);
            if let Some(slowest) = self.slowest() {
                let slowest = none.like(slowest);
                let is_far = bounded & slowest.below(high) & (low * STRAIGHT).below(high);
                let by_logarithm = R::choose(low.below(slowest), slowest, (low * high).root());
                middle = R::choose(is_far, by_logarithm, middle);
                inside = inside & !is_far;
            }
            let middle = R::choose(bounded, middle, made);
            (last_growth, last_gap) = (growth, gap);
            growth = R::choose(inside, secant, middle);
        }
        found
    }
}

impl Law for SofteningMohrCoulomb {
    type Flow<R: Real> = SofteningReturn<R>;
    const PARAMETERS: &'static [Variable] = &[
        Variable::new("friction_angle", "rad"),
        Variable::new("dilation_angle", "rad"),
        Variable::new("cohesion", "Pa"),
        Variable::new("residual_friction_angle", "rad"),
        Variable::new("residual_dilation_angle", "rad"),
        Variable::new("residual_cohesion", "Pa"),
        Variable::new("softening_strain", "-"),
    ];
    const STATE: &'static [Variable] = &[Variable::new("plastic_shear_strain", "-")];
    /// A shared function would slow Mohr-Coulomb runs by 3 to 5 %.
    const IN_LANES: bool = false;

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.moduli
    }

    fn parameters(&self) -> Vec<f64> {
        let Self {
            peak, residual, strain, ..
        } = *self;
        let [first, last] =
            [peak, residual].map(|strength| [strength.friction_angle, strength.dilation_angle, strength.cohesion]);
        [&first[..], &last, &[strain]].concat()
    }

    /// Returns the law with other parameters; ψ is limited to φ.
    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        let peak = strength(&parameters[..3]);
        let residual = strength(&parameters[3..6]);
        let strain = parameters[6];
        Self {
            rate: self.rate,
            dt: self.dt,
            ..Self::new(elastic, peak, residual, strain, self.decay)
        }
    }

    fn with_time_step(&self, dt: f64) -> Option<Self> {
        self.rate.map(|_| Self { dt, ..self.clone() })
    }

    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], state: &[R]) -> R {
        self.pyramid(state[0], state[0].like(0.0)).yield_function(tau)
    }

    #[inline(never)]
    fn return_map<R: Real>(&self, trial: [R; 3], state: &[R]) -> Projection<R, SofteningReturn<R>> {
        let kappa = state[0];
        let (_, yields, _) = self.pyramid(kappa, kappa.like(0.0)).return_map(trial);
        let growth = if R::any(yields) {
            self.solve(trial, kappa)
        } else {
            kappa.like(0.0)
        };
        let growth = R::choose(yields, growth, kappa.like(0.0));
        let pyramid = self.pyramid(kappa + growth, growth);
        let (_, rate) = self.decay.progress(kappa + growth, self.strain);
        let (projected, _, corners) = pyramid.return_map(trial);
        let tau = three(|k| R::choose(yields, projected[k], trial[k]));
        let mut rates = three(|k| rate * self.change[k]);
        if self.rate.is_some() {
            let (quickened, slope) = self.quickened(growth);
            rates[2] = rates[2] * quickened + pyramid.strength / quickened * slope;
        }
        let slopes = pyramid.slopes;
        let strength = pyramid.strength;
        Projection {
            tau,
            yields,
            flow: SofteningReturn {
                corners,
                trial,
                tau,
                slopes,
                strength,
                rates,
                growth,
            },
        }
    }

    #[inline]
    fn branch(flow: &SofteningReturn<f64>) -> Branch {
        flow.corners.branch()
    }

    /// Returns `A + b ⊗ (I - A C) v/(1 + v · C b)`: A is the tangent of a fixed surface, b = ∂τ/∂κ at a fixed trial,
    /// and `v = ⅔ dev Δεᵖ/Δκ` the derivative of κ with respect to plastic strain.
    fn tangent(flow: &SofteningReturn<f64>, moduli: Moduli) -> Tensor {
        let perfect = flow.slopes.tangent(Self::branch(flow), moduli);
        if flow.growth == 0.0 {
            return perfect;
        }
        let along = flow.along(moduli);
        let plastic = moduli.strain([0, 1, 2].map(|k| flow.trial[k] - flow.tau[k]));
        let mean = (plastic[0] + plastic[1] + plastic[2]) / 3.0;
        let v = plastic.map(|strain| (strain - mean) / (1.5 * flow.growth));
        let scale = 1.0 + dot(v, moduli.strain(along));
        // v · (dε - C A dε), column by column.
        let seen = [0, 1, 2].map(|b| v[b] - dot(v, moduli.strain([0, 1, 2].map(|a| perfect[(a, b)]))));
        perfect + Tensor::from_fn(|a, b| along[a] * seen[b] / scale)
    }

    fn advance(flow: &SofteningReturn<f64>, state: &mut [f64]) {
        state[0] += flow.growth;
    }

    fn reduced(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        let peak = self.peak.reduced(factor);
        let residual = self.residual.reduced(factor);
        Self {
            rate: self.rate,
            dt: self.dt,
            ..Self::new(self.elastic, peak, residual, self.strain, self.decay)
        }
    }

    fn hardens(&self) -> bool {
        self.residual.friction_angle > self.peak.friction_angle || self.residual.cohesion > self.peak.cohesion
    }

    fn softens(&self) -> bool {
        self.change != [0.0; 3] || self.rate.is_some()
    }

    fn dilation(&self) -> f64 {
        self.peak.dilation_angle.max(self.residual.dilation_angle)
    }
}

impl SofteningReturn<f64> {
    /// Returns `∂τ/∂κ` at a fixed trial (Pa), from `τ = τ_trial - D Σ γ m` and `f = n · τ - 2 c cos φ = 0` of the
    /// flowing planes: `(n · D m) γ' = n' · τ - 2 (c cos φ)' - n · D m' γ`, `τ' = -D Σ (m γ' + m' γ)`.
    fn along(&self, moduli: Moduli) -> [f64; 3] {
        let sin_phi = self.slopes.sin_phi;
        let planes: &[Plane] = match self.corners.branch() {
            Branch::Apex => return [(self.rates[2] - self.rates[0] * self.strength / sin_phi) / sin_phi; 3],
            Branch::RightEdge => &[(0, 2), (0, 1)],
            Branch::LeftEdge => &[(0, 2), (1, 2)],
            _ => &[(0, 2)],
        };
        let flowing = FlowingPlanes {
            planes,
            slopes: self.slopes,
            moduli,
        };
        let multipliers = flowing.solve(|plane| dot(flowing.normal(plane), self.trial) - 2.0 * self.strength);
        let turned = flowing.stress(|plane| normal(plane, self.rates[1], self.rates[1]), multipliers);
        let rates = flowing.solve(|plane| {
            let driven = dot(normal(plane, self.rates[0], self.rates[0]), self.tau) - 2.0 * self.rates[2];
            driven - dot(flowing.normal(plane), turned)
        });
        let followed = flowing.stress(|plane| flowing.direction(plane), rates);
        [0, 1, 2].map(|k| -followed[k] - turned[k])
    }
}

/// One or two planes of the pyramid with plastic flow.
struct FlowingPlanes<'a> {
    planes: &'a [Plane],
    slopes: Slopes,
    moduli: Moduli,
}

impl FlowingPlanes<'_> {
    /// Returns the gradient n of the yield function of a plane.
    fn normal(&self, plane: Plane) -> [f64; 3] {
        normal(plane, 1.0 + self.slopes.sin_phi, self.slopes.sin_phi - 1.0)
    }

    /// Returns the flow direction m of a plane.
    fn direction(&self, plane: Plane) -> [f64; 3] {
        normal(plane, 1.0 + self.slopes.sin_psi, self.slopes.sin_psi - 1.0)
    }

    /// Solves `n_a · D Σ_b m_b x_b = right_a` and returns x; the second component is 0 for one plane.
    fn solve(&self, right: impl Fn(Plane) -> f64) -> [f64; 2] {
        let first = right(self.planes[0]);
        let a = self.entry(0, 0);
        if self.planes.len() == 1 {
            return [first / a, 0.0];
        }
        let second = right(self.planes[1]);
        let b = self.entry(0, 1);
        let c = self.entry(1, 0);
        let d = self.entry(1, 1);
        let determinant = a * d - b * c;
        [
            (first * d - b * second) / determinant,
            (a * second - c * first) / determinant,
        ]
    }

    /// Returns `n_a · D m_b` (Pa).
    fn entry(&self, a: usize, b: usize) -> f64 {
        dot(
            self.normal(self.planes[a]),
            self.moduli.stress(self.direction(self.planes[b])),
        )
    }

    /// Returns the stress D Σ direction · factor over the planes.
    fn stress(&self, direction: impl Fn(Plane) -> [f64; 3], factors: [f64; 2]) -> [f64; 3] {
        let mut strain = [0.0; 3];
        for (&plane, factor) in self.planes.iter().zip(factors) {
            let direction = direction(plane);
            (0..3).for_each(|k| strain[k] += direction[k] * factor);
        }
        self.moduli.stress(strain)
    }
}

/// Creates a strength from `numbers`: φ, ψ, c.
fn strength(numbers: &[f64]) -> Strength {
    Strength {
        friction_angle: numbers[0],
        dilation_angle: numbers[1],
        cohesion: numbers[2],
    }
}

/// Indices of the larger and the smaller principal stress of a plane of the pyramid.
type Plane = (usize, usize);

/// Returns a vector with the given components at the indices of a plane, and 0 elsewhere.
fn normal((i, j): Plane, larger: f64, smaller: f64) -> [f64; 3] {
    let mut normal = [0.0; 3];
    (normal[i], normal[j]) = (larger, smaller);
    normal
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
