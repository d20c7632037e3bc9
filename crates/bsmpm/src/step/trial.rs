//! Step (4): deformation of the points under a nodal displacement, and its F-bar (Eqs 15-18).

use crate::grid::{Shape, transfer};
use crate::kinematics::Kinematics;
use crate::material::{MaterialError, Response};
use crate::model::Model;
use crate::points::Points;
use crate::seam::Halo;
use crate::stabilisation::Stabilisation;
use crate::step::equilibrium::Scene;
use crate::step::nodes::Nodes;
use crate::tensor::{Symmetric, Tensor};

/// Increment of the deformation of every point.
#[derive(Clone, Debug)]
pub struct Trial {
    /// -  dF (step 4a)
    pub dF: Vec<Tensor>,
    /// what F-bar averages
    dilation: Option<Dilation>,
}

/// Dilation of every point and its average (steps 4c, 4e).
#[derive(Clone, Debug)]
struct Dilation {
    /// -  w dJ: dJ, or J under Zhao's F-bar
    own: Vec<f64>,
    /// -  S(w dJ)
    mean: Vec<f64>,
}

impl Trial {
    /// Deformation under the nodal displacement `u`. A point that inverted gets a dF that is not finite, which the
    /// constitution refuses: all ranks decide together once the residual's norms are reduced.
    pub fn of<K: Kinematics<D>, const D: usize>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        nodes: &Nodes<D>,
        points: &Points<D>,
        u: &[f64],
        halo: &dyn Halo,
    ) -> Self {
        let averaged = model.stabilisation.averages();
        let mut own = Vec::with_capacity(if averaged { points.len() } else { 0 });
        let mut dF = Vec::with_capacity(points.len());
        transfer::gradients(shape, u, |p, grad| {
            let increment = Tensor::identity() + K::gradient(&grad);
            let dJ = increment.determinant();
            let sound = dJ > 0.0 && dJ.is_finite();
            if averaged {
                own.push(weight(model.stabilisation, points, p) * if sound { dJ } else { 1.0 });
            }
            dF.push(if sound { increment } else { Tensor::from_element(f64::NAN) });
        });
        let dilation = averaged.then(|| {
            let mean = nodes.mean_dilation(shape, points, model.weighting, halo, |p| own[p]);
            Dilation { own, mean }
        });
        Self { dF, dilation }
    }

    /// ratio_p = kept_p S(w dJ)_p / (w_p dJ_p), which F-bar multiplies the dilation of point `p` with; 1 without F-bar.
    #[inline]
    pub fn ratio<const D: usize>(&self, points: &Points<D>, p: usize) -> f64 {
        let kept = points.dilation.as_ref().map_or(1.0, |dilation| 1.0 / dilation[p]);
        self.averaged(p) * kept
    }

    /// S(w dJ)_p / (w_p dJ_p): what is kept for the next step where J is averaged as a whole.
    #[inline]
    pub(super) fn averaged(&self, p: usize) -> f64 {
        self.dilation.as_ref().map_or(1.0, |dilation| dilation.mean[p] / dilation.own[p])
    }

    /// Rate of ln ratio_p for a displacement whose spatial gradient has the trace `trace`_p at every point:
    /// S(w dJ tr l)_p / S(w dJ)_p - tr l_p. `None` without F-bar; one exchange with the neighbours.
    pub fn dilation_rate<K: Kinematics<D>, const D: usize>(
        &self,
        scene: &Scene<'_, K, D>,
        trace: &[f64],
    ) -> Option<Vec<f64>> {
        let Dilation { own, mean } = self.dilation.as_ref()?;
        let Scene { model, shape, nodes, points, halo, .. } = *scene;
        let mut rate = nodes.mean_dilation(shape, points, model.weighting, halo, |p| own[p] * trace[p]);
        rate.iter_mut().zip(mean).zip(trace).for_each(|((rate, mean), trace)| *rate = *rate / mean - trace);
        Some(rate)
    }

    /// Whether F-bar acts.
    pub fn is_averaged(&self) -> bool {
        self.dilation.is_some()
    }

    /// Steps (4f)-(4i): trial b^e of point `p` under dF-bar, widened by its gap, and the constitution's answer.
    #[inline]
    pub fn respond<K: Kinematics<D>, const D: usize>(
        &self,
        model: &Model<K, D>,
        points: &Points<D>,
        p: usize,
    ) -> Result<Response, MaterialError> {
        let b_trial: Symmetric = match &self.dilation {
            Some(_) => K::push_forward(&K::dilate(&self.dF[p], self.ratio(points, p)), &points.b_e[p]),
            None => K::push_forward(&self.dF[p], &points.b_e[p]),
        };
        match points.gap_of(p) {
            0.0 => model.respond(points, p, &b_trial),
            gap => model.respond(points, p, &b_trial.scaled((2.0 / 3.0 * gap).exp())),
        }
    }
}

/// w_p: J at the start of the step where the total J is averaged, else 1.
#[inline]
fn weight<const D: usize>(stabilisation: Stabilisation, points: &Points<D>, p: usize) -> f64 {
    if stabilisation == Stabilisation::FBarZhao { points.F[p].determinant() } else { 1.0 }
}
