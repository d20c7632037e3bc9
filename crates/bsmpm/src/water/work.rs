//! What the water of a step works: the balance of the water, tested by the excess pressure.

use crate::exact::Exact;
use crate::grid::transfer::scalars;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::over_layers;
use crate::points::Points;
use crate::solve::found::Found;
use crate::step::problem::Problem;
use crate::water::residual::Flowing;

/// J, on this rank; see the [books](crate::energy).
#[derive(Clone, Debug)]
pub struct Work {
    /// `- dt sum V0 J w . drive - sum p out`: what drives water through the ground, and what comes in or goes out
    pub external: Exact,
    /// `- dt sum V0 J w . (dF^-T grad p + drive)`, never negative
    pub seepage: Exact,
    /// `sum V0 p (zeta - zeta^n)`
    pub stored: Exact,
    /// of the term that makes the pair of splines stable
    pub tau: Exact,
    /// in the water that is compressed, at the end
    pub compressed: Exact,
}

impl Work {
    /// Of what was found, before the points have taken it; `None` where no water flows.
    pub fn of<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, found: &Found<K, D>) -> Option<Self> {
        let Problem { model, nodes, points, halo, .. } = *problem;
        let (pores, balance) = (nodes.pores.as_ref()?, found.water.as_ref()?);
        let bulk = model.water.as_ref()?.flow.as_ref()?.bulk;
        let each = scalars::scalars(&pores.shape, &found.p, |p, pressure, gradient| {
            let Some(wet) = &pores.wet[p] else { return [0.0; 5] };
            let dF = found.trial.dF(p);
            let deformed = (&dF, found.trial.dilation(model, points, p));
            let Some(state) = Flowing::at(model, (points, p), wet, deformed, (pressure, gradient)) else {
                return [f64::NAN; 5];
            };
            let through = pores.dt * wet.volume;
            let fall = (0..D).map(|i| wet.drive[i] * (0..D).map(|j| dF[(i, j)] * state.flux[j]).sum::<f64>());
            let fall = -through * fall.sum::<f64>();
            [
                fall,
                fall - through * state.flux.dot(&gradient),
                wet.volume * pressure * (state.content - wet.content),
                wet.tau_of(gradient).dot(&gradient),
                wet.volume * compressed(state.pores, pressure, bulk),
            ]
        });
        let sum = |k: usize| -> Exact { each.iter().map(|of| of[k]).collect() };
        let mut external = sum(0);
        external -= &pores.drainage.work(&found.p);
        external -= &over_layers(halo, 1, |node| found.p[node] * balance.out[node]);
        Some(Self { external, seepage: sum(1), stored: sum(2), tau: sum(3), compressed: sum(4) })
    }
}

/// J  in the water of the points, compressed by the excess pressure; nothing where water is incompressible.
pub fn in_points<K, const D: usize>(model: &Model<K, D>, points: &Points<D>) -> Exact {
    let flow = model.water.as_ref().and_then(|water| water.flow.as_ref());
    let Some((flow, pressure)) = flow.zip(points.pore_pressure.as_ref()) else { return Exact::ZERO };
    let of = |p: usize| {
        let soil = flow.soils[usize::from(points.material[p])].as_ref();
        soil.map_or(0.0, |soil| {
            let pores = soil.pores(points.F.at(p).determinant() * points.dilation_of(p));
            points.volume[p] * compressed(pores, pressure[p], flow.bulk)
        })
    };
    (0..points.len()).map(of).collect()
}

/// J/m^D  to p/K_w of it
fn compressed(pores: f64, pressure: f64, bulk: f64) -> f64 {
    0.5 * pores * pressure * pressure / bulk
}
