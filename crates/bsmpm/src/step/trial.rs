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
    /// -  dJ-bar / dJ under F-bar (steps 4c, 4e)
    ratio: Option<Vec<f64>>,
}

impl Trial {
    /// Deformation under the nodal displacement `u`. A point that inverted gets a dF that is not finite, which the
    /// constitution refuses: all ranks decide together once the residual's norms are reduced.
    pub fn of<K: Kinematics<D>, const D: usize>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        nodes: &Nodes,
        points: &Points<D>,
        u: &[f64],
        halo: &dyn Halo,
    ) -> Self {
        let mut trial = Self { dF: Vec::with_capacity(points.len()), ratio: None };
        let averaged = model.stabilisation != Stabilisation::None;
        let mut dJ = Vec::with_capacity(if averaged { points.len() } else { 0 });
        transfer::gradients(shape, u, |_, grad| {
            let dF = Tensor::identity() + K::gradient(&grad);
            let determinant = dF.determinant();
            let sound = determinant > 0.0 && determinant.is_finite();
            if averaged {
                dJ.push(if sound { determinant } else { 1.0 });
            }
            trial.dF.push(if sound { dF } else { Tensor::from_element(f64::NAN) });
        });
        if averaged {
            trial.average(model, shape, nodes, points, dJ, halo);
        }
        trial
    }

    /// Step (4e): dJ-bar_p = sum_I N_Ip (1/m_I sum_p N_Ip m_p dJ_p).
    fn average<K: Kinematics<D>, const D: usize>(
        &mut self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        nodes: &Nodes,
        points: &Points<D>,
        mut dJ: Vec<f64>,
        halo: &dyn Halo,
    ) {
        let nodal = nodes.average(shape, points, model.weighting, halo, |p| [dJ[p]]);
        transfer::to_points(shape, &nodal, |p, [dJ_bar]| dJ[p] = dJ_bar / dJ[p]);
        self.ratio = Some(dJ);
    }

    /// Whether F-bar acts.
    pub fn is_averaged(&self) -> bool {
        self.ratio.is_some()
    }

    /// d ln(dJ-bar/dJ) of every point for a change of dF with the spatial gradient l, from `trace` = tr l:
    /// S[dJ tr l] / S[dJ] - tr l. `None` without F-bar.
    pub fn dilation_rate<K: Kinematics<D>, const D: usize>(
        &self,
        scene: &Scene<'_, K, D>,
        trace: &[f64],
    ) -> Option<Vec<f64>> {
        let ratio = self.ratio.as_ref()?;
        let Scene { model, shape, nodes, points, halo, .. } = *scene;
        let dJ: Vec<f64> = self.dF.iter().map(|dF| dF.determinant()).collect();
        let nodal = nodes.average(shape, points, model.weighting, halo, |p| [dJ[p] * trace[p]]);
        let mut rate = Vec::with_capacity(dJ.len());
        transfer::to_points(shape, &nodal, |p, [mean]| rate.push(mean / (ratio[p] * dJ[p]) - trace[p]));
        Some(rate)
    }

    /// Steps (4f)-(4i): trial b^e of point `p` under dF-bar, and the constitution's answer.
    #[inline]
    pub fn respond<K: Kinematics<D>, const D: usize>(
        &self,
        model: &Model<K, D>,
        points: &Points<D>,
        p: usize,
    ) -> Result<Response, MaterialError> {
        let b_trial: Symmetric = match &self.ratio {
            Some(ratio) => K::push_forward(&K::dilate(&self.dF[p], ratio[p]), &points.b_e[p]),
            None => K::push_forward(&self.dF[p], &points.b_e[p]),
        };
        model.respond(points, p, &b_trial)
    }
}
