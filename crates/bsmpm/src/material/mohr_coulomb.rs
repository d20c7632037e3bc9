//! Mohr-Coulomb and Tresca laws, theory-manual equations (T4.5) to (T4.7): perfectly plastic, non-associated. All
//! return mappings have closed forms.

use super::law::{Branch, FRICTIONAL, Law, Projection, Separation, Strength, Variable, frictional};
use super::{Elastic, Moduli};
use crate::real::{Real, choose};
use crate::tensor::Tensor;
use std::ops::{Add, Div, Mul, Sub};

/// Law with the elastic domain `f = (τ₁ - τ₃) + (τ₁ + τ₃) sin φ - 2 c cos φ ≤ 0`. The plastic potential has the same
/// form with ψ.
#[derive(Clone, Debug, PartialEq)]
pub struct MohrCoulomb {
    elastic: Elastic,
    friction: f64,
    dilation: f64,
    cohesion: f64,
    separation: Separation,
    pyramid: Pyramid,
}

/// Pyramid and return mapping, with the same parameters for all points, or with those of each (`P` as wide as the
/// points).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pyramid<P: Real = f64> {
    moduli: Moduli,
    pub slopes: Slopes<P>,
    /// Strength c cos φ (Pa).
    pub strength: P,
    shift: P, // τ₁ at yield for τ₃ = 0 (Pa)
    slope: P, // ½/(λ sin φ sin ψ + μ (1 + sin φ sin ψ)) (1/Pa), a factor of f in the return to a face
}

/// Numbers of points, with parameters of the same width or one for all.
pub(super) trait ParameterArithmetic<P>:
    Real + Add<P, Output = Self> + Sub<P, Output = Self> + Mul<P, Output = Self> + Div<P, Output = Self>
{
}

impl<P, R> ParameterArithmetic<P> for R where
    R: Real + Add<P, Output = R> + Sub<P, Output = R> + Mul<P, Output = R> + Div<P, Output = R>
{
}

/// Whether a return ended on an edge or at the apex; otherwise on a face.
#[derive(Clone, Copy, Debug)]
pub struct Corners<R: Real> {
    left_edge: R::Mask,
    right_edge: R::Mask,
    apex: R::Mask,
}

impl Corners<f64> {
    /// Returns the part of the yield surface after a return.
    #[inline]
    pub(super) fn branch(&self) -> Branch {
        match self {
            Self { right_edge: true, .. } => Branch::RightEdge,
            Self { left_edge: true, .. } => Branch::LeftEdge,
            Self { apex: true, .. } => Branch::Apex,
            _ => Branch::Face,
        }
    }
}

/// Return data: the part of the yield surface, and the slopes for the tangent.
#[derive(Clone, Copy, Debug)]
pub struct MohrCoulombReturn<R: Real> {
    corners: Corners<R>,
    slopes: Slopes,
}

/// Slopes of the yield surface and of the plastic potential.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes<P = f64> {
    pub(super) sin_phi: P,
    pub(super) sin_psi: P,
}

/// Edge of the yield surface, with the plane of trial stresses that return to a point of the edge.
struct YieldEdge<P> {
    /// Direction of the edge per unit of τ₃: (N, 1, 1) or (N, N, 1), N = (1 - sin φ)/(1 + sin φ).
    along: [P; 3],
    /// Strain q normal to both plastic flow directions, q · εᵖ = 0; q · ε is thus unchanged by the return.
    kept: [P; 3],
    /// 18 K μ C q without cancellation, with the elastic compliance C: `w = 9 K dev q + 2μ tr(q) I`.
    weight: [P; 3],
    /// Product `w · along`, positive for all ν, φ and ψ (Pa²).
    slope: P,
}

impl<P: Real> Slopes<P> {
    /// Returns `N = (1 - sin φ)/(1 + sin φ)`, the ratio of principal stresses at yield without cohesion.
    #[inline(always)]
    fn ratio(self) -> P {
        (self.sin_phi.like(1.0) - self.sin_phi) / (self.sin_phi + 1.0)
    }

    /// Returns 1 - sin ψ and 1 + sin ψ.
    #[inline(always)]
    fn flow(self) -> (P, P) {
        (self.sin_psi.like(1.0) - self.sin_psi, self.sin_psi + 1.0)
    }

    /// Returns the right edge (τ₂ = τ₃), on which the planes 1-3 and 1-2 flow together.
    #[inline(always)]
    fn right(self, moduli: Moduli) -> YieldEdge<P> {
        let (minus, plus) = self.flow();
        let one = self.sin_psi.like(1.0);
        let dev = self.sin_psi * (6.0 * moduli.bulk());
        let trace = (self.sin_psi + 3.0) * (2.0 * moduli.mu);
        YieldEdge::new(
            [self.ratio(), one, one],
            [minus, plus, plus],
            [trace - dev * 2.0, trace + dev, trace + dev],
        )
    }

    /// Returns the left edge (τ₁ = τ₂), on which the planes 1-3 and 2-3 flow together.
    #[inline(always)]
    fn left(self, moduli: Moduli) -> YieldEdge<P> {
        let (minus, plus) = self.flow();
        let one = self.sin_psi.like(1.0);
        let trace = (self.sin_psi.like(3.0) - self.sin_psi) * (2.0 * moduli.mu);
        let dev = self.sin_psi * (6.0 * moduli.bulk());
        let ratio = self.ratio();
        YieldEdge::new(
            [ratio, ratio, one],
            [minus, minus, plus],
            [trace - dev, trace - dev, trace + dev * 2.0],
        )
    }
}

impl Slopes {
    /// Returns `D_AB = ∂τ_A/∂ε_B` (Pa) for a fixed yield surface: `D - (D m)(D n)ᵀ/(n · D m)` on the face,
    /// `a qᵀ/(q · C a)` on an edge of direction a, and 0 at the apex.
    pub(super) fn tangent(self, branch: Branch, moduli: Moduli) -> Tensor {
        match branch {
            Branch::Elastic => moduli.tangent(),
            Branch::Apex => Tensor::zeros(),
            Branch::Face => {
                let n = [1.0 + self.sin_phi, 0.0, self.sin_phi - 1.0];
                let m = [1.0 + self.sin_psi, 0.0, self.sin_psi - 1.0];
                let d_n = moduli.stress(n);
                let d_m = moduli.stress(m);
                let product = self.sin_phi * self.sin_psi;
                let scale = 4.0 * (moduli.lambda * product + moduli.mu * (1.0 + product));
                moduli.tangent() - Tensor::from_fn(|i, j| d_m[i] * d_n[j] / scale)
            }
            edge => {
                let edge = if edge == Branch::LeftEdge {
                    self.left(moduli)
                } else {
                    self.right(moduli)
                };
                let scale = 18.0 * moduli.bulk() * moduli.mu / edge.slope;
                Tensor::from_fn(|i, j| scale * edge.along[i] * edge.kept[j])
            }
        }
    }
}

impl<P: Real> YieldEdge<P> {
    #[inline(always)]
    fn new(along: [P; 3], kept: [P; 3], weight: [P; 3]) -> Self {
        let slope = weight[0] * along[0] + weight[1] * along[1] + weight[2] * along[2];
        Self {
            along,
            kept,
            weight,
            slope,
        }
    }

    /// Returns τ₃ after the return to this edge: `τ₃ = w · (τ_trial - o)/(w · along)`, with the point o of the edge for
    /// τ₃ = 0.
    #[inline(always)]
    fn third<R: ParameterArithmetic<P>>(&self, trial: [R; 3], origin: [P; 3]) -> R {
        let [first, second, third] = [trial[0] - origin[0], trial[1] - origin[1], trial[2]];
        (first * self.weight[0] + second * self.weight[1] + third * self.weight[2]) / self.slope
    }
}

impl<P: Real> Pyramid<P> {
    /// Creates the pyramid from sin φ, sin ψ and c cos φ (Pa).
    #[inline(always)]
    pub(super) fn new(moduli: Moduli, slopes: Slopes<P>, strength: P) -> Self {
        let product = slopes.sin_phi * slopes.sin_psi;
        Self {
            moduli,
            slopes,
            strength,
            shift: strength * 2.0 / (slopes.sin_phi + 1.0),
            slope: product.like(0.5) / (product * moduli.lambda + (product + 1.0) * moduli.mu),
        }
    }

    /// Returns `f = (τ₁ - τ₃) + (τ₁ + τ₃) sin φ - 2 c cos φ`.
    #[inline(always)]
    pub(super) fn yield_function<R: ParameterArithmetic<P>>(&self, tau: [R; 3]) -> R {
        (tau[0] - tau[2]) + (tau[0] + tau[2]) * self.slopes.sin_phi - self.strength * 2.0
    }

    /// Returns a trial stress to the pyramid; also whether it yields, and on which edge or apex the return ends.
    ///
    /// τ₁ follows from τ₃ and f = 0, so that the result satisfies yield condition and order to machine precision even
    /// if it is much smaller than the trial.
    #[inline(always)]
    pub(super) fn return_map<R: ParameterArithmetic<P>>(&self, trial: [R; 3]) -> ([R; 3], R::Mask, Corners<R>) {
        let excess = self.yield_function(trial);
        let inside = excess.at_most(excess.like(0.0));
        let none = inside & !inside;
        let mut corners = Corners {
            left_edge: none,
            right_edge: none,
            apex: none,
        };
        let mut tau = trial;
        if R::any(!inside) {
            let (face, keeps_order) = self.face(trial, excess);
            tau = choose(inside, trial, face);
            let beyond = !(inside | keeps_order);
            if R::any(beyond) {
                let (edge, is_right, is_edge) = self.edge(trial);
                corners.right_edge = beyond & is_edge & is_right;
                corners.left_edge = beyond & is_edge & !is_right;
                corners.apex = beyond & !is_edge;
                let tip = excess.like(0.0) + self.strength / self.slopes.sin_phi;
                tau = choose(beyond, choose(is_edge, edge, [tip; 3]), tau);
            }
        }
        (tau, !inside, corners)
    }

    /// Returns the stress to a face along `τ = τ_trial - Δγ D m` with `Δγ = f/(4λ sin φ sin ψ + 4μ(1 + sin φ sin ψ))`,
    /// and whether the order of principal stresses is kept.
    #[inline(always)]
    fn face<R: ParameterArithmetic<P>>(&self, trial: [R; 3], excess: R) -> ([R; 3], R::Mask) {
        let Moduli { lambda, mu } = self.moduli;
        let sin_psi = self.slopes.sin_psi;
        let half = excess * self.slope;
        let second = trial[1] - half * lambda * sin_psi;
        let third = trial[2] - half * (sin_psi * lambda - (sin_psi.like(1.0) - sin_psi) * mu);
        let first = third * self.slopes.ratio() + self.shift;
        // Beyond the apex f = 0 and the order exclude each other, so this test includes the apex.
        ([first, second, third], second.at_most(first) & third.at_most(second))
    }

    /// Returns the stress to the edge that the return to a face crosses first; also whether that is the right edge, and
    /// whether the result is not beyond the apex (always true for sin φ = 0).
    #[inline(always)]
    fn edge<R: ParameterArithmetic<P>>(&self, trial: [R; 3]) -> ([R; 3], R::Mask, R::Mask) {
        let Self {
            slopes, moduli, shift, ..
        } = *self;
        let upper = trial[0] - trial[1];
        let lower = trial[1] - trial[2];
        let (minus, plus) = slopes.flow();
        let none = shift.like(0.0);
        let is_right = (lower * plus).below(upper * minus);
        let right = slopes.right(moduli).third(trial, [shift, none, none]);
        let left = slopes.left(moduli).third(trial, [shift, shift, none]);
        let third = R::choose(is_right, right, left);
        let first = third * slopes.ratio() + shift;
        (
            [first, R::choose(is_right, third, first), third],
            is_right,
            third.at_most(first),
        )
    }
}

impl MohrCoulomb {
    /// Creates a law with the friction angle 0 ≤ φ < π/2 (rad), the dilation angle 0 ≤ ψ ≤ φ (rad) and the cohesion c ≥
    /// 0 (Pa).
    pub fn new(elastic: Elastic, friction: f64, dilation: f64, cohesion: f64) -> Self {
        let slopes = Slopes {
            sin_phi: friction.sin(),
            sin_psi: dilation.sin(),
        };
        let pyramid = Pyramid::new(elastic.moduli(), slopes, cohesion * friction.cos());
        Self {
            elastic,
            friction,
            dilation,
            cohesion,
            separation: Separation::default(),
            pyramid,
        }
    }

    /// Returns the law with another treatment of the volume that opens at the apex.
    pub fn separating(self, separation: Separation) -> Self {
        Self { separation, ..self }
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
        self.pyramid.moduli
    }

    fn parameters(&self) -> Vec<f64> {
        vec![self.friction, self.dilation, self.cohesion]
    }

    /// Returns the law with other parameters; ψ is limited to φ.
    fn with_parameters(&self, elastic: Elastic, parameters: &[f64]) -> Self {
        let [friction, dilation, cohesion] = frictional(parameters);
        Self::new(elastic, friction, dilation, cohesion).separating(self.separation)
    }

    #[inline(always)]
    fn yield_function<R: Real>(&self, tau: [R; 3], _state: &[R]) -> R {
        self.pyramid.yield_function(tau)
    }

    #[inline(always)]
    fn return_map<R: Real>(&self, trial: [R; 3], _state: &[R]) -> Projection<R, MohrCoulombReturn<R>> {
        let (tau, yields, corners) = self.pyramid.return_map(trial);
        Projection {
            tau,
            yields,
            flow: MohrCoulombReturn {
                corners,
                slopes: self.pyramid.slopes,
            },
        }
    }

    #[inline]
    fn branch(flow: &MohrCoulombReturn<f64>) -> Branch {
        flow.corners.branch()
    }

    fn tangent(flow: &MohrCoulombReturn<f64>, moduli: Moduli) -> Tensor {
        flow.slopes.tangent(Self::branch(flow), moduli)
    }

    fn reduced(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        let Strength {
            friction_angle,
            dilation_angle,
            cohesion,
        } = Strength {
            friction_angle: self.friction,
            dilation_angle: self.dilation,
            cohesion: self.cohesion,
        }
        .reduced(factor);
        Self::new(self.elastic, friction_angle, dilation_angle, cohesion).separating(self.separation)
    }

    fn dilation(&self) -> f64 {
        self.dilation
    }

    fn separation(&self) -> Separation {
        self.separation
    }
}
