//! Deformation of the material points by a nodal displacement, theory-manual equation (T2.6), with F-bar (T3.2),
//! (T3.3), in each iteration.

use crate::dynamics::damping::{Damping, Viscous};
use crate::grid::{Shape, transfer};
use crate::kinematics::{Gradient, Kinematics};
use crate::lanes::{Eight, Lanes, Simd};
use crate::material::{LayeredMaterial, MOST_STATE, MaterialError, Moduli, Response};
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;
use crate::tensor::{Symmetric, Tensor};

/// Deformation increment dF (-) and the Kirchhoff stress (Pa) that it causes, at one point or several.
pub type Stressed<R> = (Tensor<R>, Symmetric<R>);

/// Deformation increment of every material point.
#[derive(Clone, Debug)]
pub struct DeformationIncrement<K: Kinematics<D>, const D: usize> {
    /// Displacement gradient of the step (-, step 4a); NaN at a point that inverted.
    grad: Vec<K::Gradient>,
    /// Mean S(dJ) at every point (-, steps 4c, 4e); `None` without F-bar.
    mean: Option<Vec<f64>>,
    /// Damping that adds a viscous stress to the stress of the law.
    damping: Damping,
    /// Kirchhoff pressure that a second field carries at every point (Pa); subtracted from the stress of the material.
    pub(crate) field_pressure: Option<Vec<f64>>,
}

impl<K: Kinematics<D>, const D: usize> DeformationIncrement<K, D> {
    /// Computes the deformation under the nodal displacement `u` (m). A point that inverted gets a non-finite dF, which
    /// the constitutive law rejects. All ranks detect this together when the norms of the residual are reduced.
    pub fn of(
        model: &Model<K, D>,
        shape: &Shape<D>,
        nodes: &GridState<D>,
        points: &Points<D>,
        u: &[f64],
        halo: &dyn Halo,
    ) -> Self {
        let grad = transfer::gradients::<K, D, _>(shape, &points.x, u, |_, grad| {
            let dJ = K::jacobian::<f64>(&grad);
            if dJ > 0.0 && dJ.is_finite() {
                grad
            } else {
                K::Gradient::from_element(f64::NAN)
            }
        });
        let trial = Self {
            grad,
            mean: None,
            damping: Damping::of(model, nodes),
            field_pressure: None,
        };
        let mean = model.stabilisation.averages().then(|| {
            nodes.mean_dilation(model, shape, points, halo, |p| match trial.dJ(p) {
                // An inverted point must not spoil the averages of other points.
                inverted if inverted.is_nan() => 1.0,
                dJ => dJ,
            })
        });
        Self { mean, ..trial }
    }

    /// Returns dF of point `p` (-).
    #[inline]
    pub fn dF(&self, p: usize) -> Tensor {
        K::deformation::<f64>(&self.grad[p])
    }

    /// Returns dJ of point `p` (-).
    #[inline]
    pub(crate) fn dJ(&self, p: usize) -> f64 {
        K::jacobian::<f64>(&self.grad[p])
    }

    /// Returns the mean S(dJ) of point `p` (-); 1 without F-bar.
    #[inline]
    pub(crate) fn mean_dJ(&self, p: usize) -> f64 {
        self.mean.as_ref().map_or(1.0, |mean| mean[p])
    }

    /// Returns the F-bar factor r_p of (T3.2), S(dJ)_p / dJ_p; 1 without F-bar.
    #[inline]
    pub fn ratio(&self, p: usize) -> f64 {
        self.mean.as_ref().map_or(1.0, |mean| mean[p] / self.dJ(p))
    }

    /// Returns J-bar/J of point `p` at the end of the step (-).
    pub(crate) fn dilation(&self, points: &Points<D>, p: usize) -> f64 {
        self.ratio(p) * points.dilation_of(p)
    }

    /// Returns the rate of ln ratio_p for a displacement whose spatial gradient l has the trace `trace`_p at every
    /// point: S(dJ tr l)_p / S(dJ)_p - tr l_p. `None` without F-bar. One exchange with the neighbours.
    pub fn dilation_rate(&self, problem: &Problem<'_, K, D>, trace: &[f64]) -> Option<Vec<f64>> {
        let mean = self.mean.as_ref()?;
        let Problem {
            model,
            shape,
            nodes,
            points,
            halo,
            ..
        } = *problem;
        let mut rate = nodes.mean_dilation(model, shape, points, halo, |p| self.dJ(p) * trace[p]);
        rate.iter_mut()
            .zip(mean)
            .zip(trace)
            .for_each(|((rate, mean), trace)| *rate = *rate / mean - trace);
        Some(rate)
    }

    /// Returns whether F-bar acts.
    pub fn is_averaged(&self) -> bool {
        self.mean.is_some()
    }

    /// Computes steps (4f)-(4i) for eight points: dF and the stress. Returns `None` if
    /// [`DeformationIncrement::respond`] must be used: for points of several materials, graded or damped materials,
    /// open gaps, and laws without a vectorised form.
    #[inline(always)]
    pub fn respond_in_lanes<S: Simd>(
        &self,
        model: &Model<K, D>,
        points: &Points<D>,
        simd: S,
        eight: Eight,
    ) -> Option<Stressed<Lanes<S>>> {
        let material = points.material[eight.points().start];
        let LayeredMaterial::Uniform(law) = &model.materials[usize::from(material)] else {
            return None;
        };
        let is_alone = self.damping.relative(material).is_some() || points.gap.is_some();
        if is_alone || eight.points().any(|p| points.material[p] != material) {
            return None;
        }
        let grad = eight.of(&self.grad);
        let grad = K::Gradient::of(|i, j| Lanes::from_fn(simd, |lane| grad[lane][(i, j)]));
        let dF = K::deformation(&grad);
        let mut dF_bar = dF;
        if let Some(mean) = &self.mean {
            let mean = eight.of(mean);
            let dJ = K::jacobian::<Lanes<S>>(&grad);
            dF_bar = K::dilate(&dF, Lanes::from_fn(simd, |lane| *mean[lane]) / dJ);
        }
        let zero = Lanes::splat(simd, 0.0);
        let b_e = match (points.b_e.planar(), points.b_e.whole()) {
            (Some(planar), _) => {
                let b_e = eight.of(planar);
                let b_e = |k: usize| Lanes::from_fn(simd, |lane| b_e[lane][k]);
                Symmetric([b_e(0), b_e(1), b_e(2), b_e(3), zero, zero])
            }
            (_, whole) => {
                let b_e = eight.of(whole?);
                let b_e = |k: usize| Lanes::from_fn(simd, |lane| b_e[lane][k]);
                Symmetric([b_e(0), b_e(1), b_e(2), b_e(3), b_e(4), b_e(5)])
            }
        };
        let b_trial = K::push_forward(&dF_bar, &b_e).0;
        let mut state = [zero; MOST_STATE];
        let width = points.state_of(eight.point(0)).len();
        for (k, variable) in state[..width].iter_mut().enumerate() {
            *variable = Lanes::from_fn(simd, |lane| points.state_of(eight.point(lane))[k]);
        }
        let mut tau = if D == 2 {
            let [xx, yy, zz, xy, ..] = b_trial;
            law.stress([xx, yy, zz, xy], &state[..width])?
        } else {
            law.stress_in_space(b_trial, &state[..width])?
        };
        if let Some(pressure) = &self.field_pressure {
            let pressure = eight.of(pressure);
            let pressure = Lanes::from_fn(simd, |lane| *pressure[lane]);
            tau = Symmetric(std::array::from_fn(
                |k| if k < 3 { tau.0[k] - pressure } else { tau.0[k] },
            ));
        }
        Some((dF, tau))
    }

    /// Returns the viscous stress of point `p`, in addition to the `response` of its law, if it has damping.
    #[inline]
    pub fn viscous(&self, model: &Model<K, D>, points: &Points<D>, p: usize, response: &Response) -> Option<Viscous> {
        let moduli = self.damping.moduli(model, points, p)?;
        let share = self.damping.relative(points.material[p])?;
        let dF_bar = K::dilate(&self.dF(p), self.ratio(p));
        let strained = K::push_forward(&dF_bar, &points.smoothing_of(p));
        Viscous::of(&strained, moduli, response.returned(), share, points.gap_of(p)).ok()
    }

    /// Returns `tau` plus the viscous stress of point `p` (Pa). `response` is that of the law at this point.
    #[inline]
    pub fn damped(
        &self,
        model: &Model<K, D>,
        points: &Points<D>,
        p: usize,
        response: &Response,
        tau: Symmetric,
    ) -> Symmetric {
        self.viscous(model, points, p, response)
            .map_or(tau, |viscous| viscous.beside(tau))
    }

    /// Returns the work of the viscous stress of point `p` in the step per reference volume (J/m3), if it has damping.
    pub(crate) fn damping_takes(&self, model: &Model<K, D>, points: &Points<D>, p: usize) -> Option<f64> {
        let viscous = self.viscous_at(model, points, p)?;
        Some(viscous.tau.full().dot(&self.strain(p)?))
    }

    /// Computes the viscous stress of point `p` without a given response of the law, if the point has damping.
    fn viscous_at(&self, model: &Model<K, D>, points: &Points<D>, p: usize) -> Option<Viscous> {
        self.damping.relative(points.material[p])?;
        self.viscous(model, points, p, &self.respond(model, points, p).ok()?)
    }

    /// Returns `tau` plus the viscous stress of point `p` (Pa), without a given response.
    pub(crate) fn damped_at(&self, model: &Model<K, D>, points: &Points<D>, p: usize, tau: Symmetric) -> Symmetric {
        self.viscous_at(model, points, p)
            .map_or(tau, |viscous| viscous.beside(tau))
    }

    /// Returns `tau` of the material minus the pressure of a second field at point `p` (Pa).
    #[inline]
    pub fn pressed(&self, p: usize, mut tau: Symmetric) -> Symmetric {
        if let Some(pressure) = &self.field_pressure {
            tau.0[..3].iter_mut().for_each(|normal| *normal -= pressure[p]);
        }
        tau
    }

    /// Returns the Kirchhoff pressure of a second field at point `p` (Pa), if there is one.
    #[inline]
    pub(crate) fn field_pressure_at(&self, p: usize) -> Option<f64> {
        self.field_pressure.as_ref().map(|pressure| pressure[p])
    }

    /// Returns the Hencky strain of point `p` in the step, `½ ln (I + e)` with e = dF-bar dF-bar^T - I; `None` for an
    /// inverted point. For small e the series ½ (e - e²/2 + e³/3 - e⁴/4) saves an eigenvalue problem; its error is
    /// below 1e-12.
    pub(crate) fn strain(&self, p: usize) -> Option<Tensor> {
        let dF_bar = K::dilate(&self.dF(p), self.ratio(p));
        let strained = K::push_forward(&dF_bar, &Symmetric::IDENTITY);
        let one = Tensor::identity();
        let e = strained.full() - Tensor::identity();
        if e.amax() < SMALL {
            return Some(e * (one - e * (one * 0.5 - e * (one / 3.0 - e * 0.25))) * 0.5);
        }
        Some(
            Response::elastic(&strained, Moduli { lambda: 0.0, mu: 0.0 })
                .ok()?
                .trial_strain()
                .full(),
        )
    }

    /// Computes steps (4f)-(4i): trial b^e of point `p` under dF-bar, expanded by its gap, and the response of the law.
    #[inline(always)]
    pub fn respond(&self, model: &Model<K, D>, points: &Points<D>, p: usize) -> Result<Response, MaterialError> {
        let dF = self.dF(p);
        let b_trial: Symmetric = match &self.mean {
            Some(_) => K::push_forward(&K::dilate(&dF, self.ratio(p)), &points.b_e.at(p)),
            None => K::push_forward(&dF, &points.b_e.at(p)),
        };
        match points.gap_of(p) {
            0.0 => model.respond(points, p, &b_trial),
            gap => model.respond(points, p, &b_trial.scaled((2.0 / 3.0 * gap).exp())),
        }
    }
}

/// Largest component of e for which the logarithm is replaced by a series.
const SMALL: f64 = 1e-3;
