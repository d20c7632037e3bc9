//! Mohr-Coulomb plasticity (section 2.2; de Souza Neto et al., 2008, Boxes 8.4 to 8.7): perfect, non-associated.
//!
//! With no hardening each return is linear, so all are in closed form, and region by region:
//! face, the edges τ₁ = τ₂ (left) and τ₂ = τ₃ (right), apex. Tresca is φ = ψ = 0, which has no apex.

use super::law::{Branch, FRICTIONAL, Law, Projection, Separation, Variable, frictional, reduced};
use super::{Elastic, Moduli};
use crate::real::{Real, three};
use crate::tensor::Tensor;

/// Elastic inside `f = (τ₁ - τ₃) + (τ₁ + τ₃) sin φ - 2 c cos φ ≤ 0`, with the same form in ψ as plastic potential.
#[derive(Clone, Debug, PartialEq)]
pub struct MohrCoulomb {
    elastic: Elastic,
    friction: f64,
    dilation: f64,
    cohesion: f64,
    separation: Separation,
    // What every response needs, formed once:
    moduli: Moduli,
    slopes: Slopes, // sin φ and sin ψ
    strength: f64,  // Pa  c cos φ
    shift: f64,     // Pa  τ₁ at yield where τ₃ = 0
    slope: f64,     // 1/Pa  ½/(λ sin φ sin ψ + μ (1 + sin φ sin ψ)), multiplier over excess of a return to a face
}

/// What a return leaves: where the stress lies, on a face unless told, and the two sines that its tangent needs.
#[derive(Clone, Copy, Debug)]
pub struct MohrCoulombReturn<R: Real> {
    left_edge: R::Mask,
    right_edge: R::Mask,
    apex: R::Mask,
    slopes: Slopes,
}

/// Slopes of the yield surface and of the plastic potential.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slopes {
    sin_phi: f64,
    sin_psi: f64,
}

/// An edge of the yield surface with the plane of trial stresses that return to each of its points.
struct YieldEdge {
    /// Direction of the edge where τ₃ grows by one: (N, 1, 1) or (N, N, 1), N = (1 - sin φ)/(1 + sin φ).
    along: [f64; 3],
    /// Normal in strain to both plastic flows, which an edge return therefore keeps: q · εᵖ = 0.
    kept: [f64; 3],
    /// 18 K μ C q without cancellation, C the elastic compliance: `w = 9 K dev q + 2μ tr(q) I`.
    weight: [f64; 3],
    /// Pa²  `w · along`, positive for all ν, φ and ψ.
    slope: f64,
}

impl Slopes {
    /// `N = (1 - sin φ)/(1 + sin φ)`, the smaller over the larger principal stress at yield without cohesion.
    #[inline]
    fn ratio(self) -> f64 {
        (1.0 - self.sin_phi) / (1.0 + self.sin_phi)
    }

    /// The right edge (τ₂ = τ₃), on which the potentials of the planes 1-3 and 1-2 flow together.
    #[inline]
    fn right(self, moduli: Moduli) -> YieldEdge {
        let (minus, plus) = (1.0 - self.sin_psi, 1.0 + self.sin_psi);
        let (dev, trace) = (6.0 * moduli.bulk() * self.sin_psi, 2.0 * moduli.mu * (3.0 + self.sin_psi));
        YieldEdge::new([self.ratio(), 1.0, 1.0], [minus, plus, plus], [trace - 2.0 * dev, trace + dev, trace + dev])
    }

    /// The left edge (τ₁ = τ₂), on which the potentials of the planes 1-3 and 2-3 flow together.
    #[inline]
    fn left(self, moduli: Moduli) -> YieldEdge {
        let (minus, plus) = (1.0 - self.sin_psi, 1.0 + self.sin_psi);
        let (dev, trace) = (6.0 * moduli.bulk() * self.sin_psi, 2.0 * moduli.mu * (3.0 - self.sin_psi));
        let ratio = self.ratio();
        YieldEdge::new([ratio, ratio, 1.0], [minus, minus, plus], [trace - dev, trace - dev, trace + 2.0 * dev])
    }
}

impl YieldEdge {
    #[inline]
    fn new(along: [f64; 3], kept: [f64; 3], weight: [f64; 3]) -> Self {
        Self { along, kept, weight, slope: dot(weight, along) }
    }

    /// τ₃ after the return to this edge: `τ₃ = w · (τ_trial - o)/(w · along)`, o the edge's point where τ₃ = 0.
    #[inline(always)]
    fn third<R: Real>(&self, trial: [R; 3], origin: [f64; 3]) -> R {
        let [first, second, third] = [trial[0] - origin[0], trial[1] - origin[1], trial[2]];
        (first * self.weight[0] + second * self.weight[1] + third * self.weight[2]) / self.slope
    }
}

impl MohrCoulomb {
    /// A law with friction angle 0 ≤ φ < π/2 (rad), dilation angle 0 ≤ ψ ≤ φ (rad) and cohesion c ≥ 0 (Pa).
    pub fn new(elastic: Elastic, friction: f64, dilation: f64, cohesion: f64) -> Self {
        let slopes = Slopes { sin_phi: friction.sin(), sin_psi: dilation.sin() };
        let (moduli, product) = (elastic.moduli(), slopes.sin_phi * slopes.sin_psi);
        let strength = cohesion * friction.cos();
        Self {
            elastic,
            friction,
            dilation,
            cohesion,
            separation: Separation::default(),
            moduli,
            slopes,
            strength,
            shift: 2.0 * strength / (1.0 + slopes.sin_phi),
            slope: 0.5 / (moduli.lambda * product + moduli.mu * (1.0 + product)),
        }
    }

    /// The law with another answer to what comes apart.
    pub fn separating(self, separation: Separation) -> Self {
        Self { separation, ..self }
    }

    /// Return along `τ = τ_trial - Δγ D m`, `Δγ = f/(4λ sin φ sin ψ + 4μ(1 + sin φ sin ψ))`, and where it keeps the
    /// order.
    #[inline(always)]
    fn face<R: Real>(&self, trial: [R; 3], excess: R) -> ([R; 3], R::Mask) {
        let (Moduli { lambda, mu }, sin_psi) = (self.moduli, self.slopes.sin_psi);
        let half = excess * self.slope;
        let second = trial[1] - half * lambda * sin_psi;
        let third = trial[2] - half * (lambda * sin_psi - mu * (1.0 - sin_psi));
        let first = third * self.slopes.ratio() + self.shift;
        // Beyond the apex f = 0 and the order exclude each other, so this test covers the apex too.
        ([first, second, third], second.at_most(first) & third.at_most(second))
    }
}

impl MohrCoulomb {
    /// Return to the edge that the face return crosses first, whether that is the right one, and where it is not beyond
    /// the apex (never when sin φ = 0).
    #[inline(always)]
    fn edge<R: Real>(&self, trial: [R; 3]) -> ([R; 3], R::Mask, R::Mask) {
        let Self { slopes, moduli, shift, .. } = *self;
        let (upper, lower) = (trial[0] - trial[1], trial[1] - trial[2]);
        let is_right = (lower * (1.0 + slopes.sin_psi)).below(upper * (1.0 - slopes.sin_psi));
        let (right, left) = (
            slopes.right(moduli).third(trial, [shift, 0.0, 0.0]),
            slopes.left(moduli).third(trial, [shift, shift, 0.0]),
        );
        let third = R::choose(is_right, right, left);
        let first = third * slopes.ratio() + shift;
        ([first, R::choose(is_right, third, first), third], is_right, third.at_most(first))
    }
}

impl Law for MohrCoulomb {
    type Flow<R: Real> = MohrCoulombReturn<R>;
    const PARAMETERS: &'static [Variable] = &FRICTIONAL;

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    #[inline]
    fn moduli(&self) -> Moduli {
        self.moduli
    }

    fn parameters(&self) -> Vec<f64> {
        vec![self.friction, self.dilation, self.cohesion]
    }

    /// ψ is at most φ.
    fn with(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        let [friction, dilation, cohesion] = frictional(parameters);
        Self::new(elastic, friction, dilation, cohesion).separating(self.separation)
    }

    /// `f = (τ₁ - τ₃) + (τ₁ + τ₃) sin φ - 2 c cos φ`.
    #[inline(always)]
    fn excess<R: Real>(&self, tau: [R; 3], _state: &[R]) -> R {
        (tau[0] - tau[2]) + (tau[0] + tau[2]) * self.slopes.sin_phi - 2.0 * self.strength
    }

    /// τ₁ is always taken from τ₃ by f = 0, so the result satisfies yield and order to the last digits even where it
    /// is much smaller than the trial.
    #[inline(always)]
    fn project<R: Real>(&self, trial: [R; 3], state: &[R]) -> Projection<R, MohrCoulombReturn<R>> {
        let Self { slopes, strength, .. } = *self;
        let excess = self.excess(trial, state);
        let inside = excess.at_most(excess.like(0.0));
        let none = inside & !inside;
        let mut flow = MohrCoulombReturn { left_edge: none, right_edge: none, apex: none, slopes };
        let mut tau = trial;
        if R::any(!inside) {
            let (face, keeps_order) = self.face(trial, excess);
            tau = three(|k| R::choose(inside, trial[k], face[k]));
            let beyond = !(inside | keeps_order);
            if R::any(beyond) {
                let (edge, is_right, is_edge) = self.edge(trial);
                flow.right_edge = beyond & is_edge & is_right;
                flow.left_edge = beyond & is_edge & !is_right;
                flow.apex = beyond & !is_edge;
                let tip = excess.like(strength / slopes.sin_phi);
                tau = three(|k| R::choose(beyond, R::choose(is_edge, edge[k], tip), tau[k]));
            }
        }
        Projection { tau, yields: !inside, flow }
    }

    #[inline]
    fn branch(flow: &MohrCoulombReturn<f64>) -> Branch {
        match flow {
            MohrCoulombReturn { right_edge: true, .. } => Branch::RightEdge,
            MohrCoulombReturn { left_edge: true, .. } => Branch::LeftEdge,
            MohrCoulombReturn { apex: true, .. } => Branch::Apex,
            _ => Branch::Face,
        }
    }

    /// On the face `D - (D m)(D n)ᵀ/(n · D m)`, on an edge of direction a `a qᵀ/(q · C a)`, at the apex zero.
    fn tangent(flow: &MohrCoulombReturn<f64>, moduli: Moduli) -> Tensor {
        let slopes = flow.slopes;
        match Self::branch(flow) {
            Branch::Elastic => moduli.tangent(),
            Branch::Apex => Tensor::zeros(),
            Branch::Face => {
                let normal = |sin: f64| [1.0 + sin, 0.0, sin - 1.0];
                let (n, m) = (normal(slopes.sin_phi), normal(slopes.sin_psi));
                let (d_n, d_m) = (moduli.stress(n), moduli.stress(m));
                let product = slopes.sin_phi * slopes.sin_psi;
                let scale = 4.0 * (moduli.lambda * product + moduli.mu * (1.0 + product));
                moduli.tangent() - Tensor::from_fn(|i, j| d_m[i] * d_n[j] / scale)
            }
            edge => {
                let edge = if edge == Branch::LeftEdge { slopes.left(moduli) } else { slopes.right(moduli) };
                let scale = 18.0 * moduli.bulk() * moduli.mu / edge.slope;
                Tensor::from_fn(|i, j| scale * edge.along[i] * edge.kept[j])
            }
        }
    }

    fn reduced(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        let (friction, dilation, cohesion) = reduced((self.friction, self.dilation, self.cohesion), factor);
        Self::new(self.elastic, friction, dilation, cohesion).separating(self.separation)
    }

    fn dilation(&self) -> f64 {
        self.dilation
    }

    fn separation(&self) -> Separation {
        self.separation
    }
}

#[inline]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
