//! Work of the pore water in a step, and dissipation by seepage, theory-manual equation (T8.18).

use crate::exact::Exact;
use crate::field::pore_water::flow::{Flow, Soil};
use crate::field::pore_water::residual::ExcessPressure;
use crate::field::pore_water::residual::FlowState;
use crate::grid::transfer::scalars;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::over_layers;
use crate::points::Points;
use crate::solve::found::StepSolution;
use crate::step::problem::Problem;

/// Work of pore water on this rank (J); see the energy balance in [`crate::energy`].
#[derive(Clone, Debug)]
pub struct Work {
    /// External work `- dt sum V0 J w . drive - sum p out`: of the driving term, and of water that crosses surfaces.
    /// The work that lifts water into pores above the hydrostatic level, or is released below it, is subtracted.
    pub external: Exact,
    /// Dissipation by seepage, `- dt sum V0 J w . (dF^-T grad p + drive)`, never negative.
    pub seepage: Exact,
    /// Storage `sum V0 p (zeta - zeta^n)`, with the whole pressure for changes of saturation. It includes the
    /// difference between the second-order balance and flow over the full dt.
    pub stored: Exact,
    /// Work of the stabilisation term.
    pub tau: Exact,
    /// Energy of compressed water and of suction in emptied pores, at the end of the step.
    pub held: Exact,
}

impl Work {
    /// Computes the work of the step solution `found` before the points are updated; `None` without pore-water flow.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
    ) -> Option<Self> {
        let Problem {
            model, points, halo, ..
        } = *problem;
        let pores = problem.nodes.field.as_ref()?;
        let balance = found.field.as_ref()?;
        let water = model.water.as_ref()?;
        let flow = water.flow.as_ref()?;
        let weight = water.unit_weight;
        let now = pores.differences.now;
        let dt = pores.duration / now;
        let each = scalars::scalars(&pores.shape, &found.p, |p, pressure, gradient| {
            let Some(wet) = &pores.wet[p] else { return [0.0; 5] };
            let dF = found.trial.dF(p);
            let dilation = found.trial.dilation(points, p);
            let excess = ExcessPressure {
                value: pressure,
                gradient,
            };
            let Some(state) = FlowState::at(model, points, p, wet, &dF, dilation, excess) else {
                return [f64::NAN; 5];
            };
            let soil = flow.soils[usize::from(points.material[p])].as_ref();
            let held = soil.map_or(0.0, |soil| held(flow, soil, state.pores, pressure, state.whole, weight));
            let through = dt * wet.volume;
            let fall = (0..D).map(|i| wet.drive[i] * (0..D).map(|j| dF[(i, j)] * state.flux[j]).sum::<f64>());
            let fall = -through * fall.sum::<f64>();
            let driven = through * state.flux.dot(&gradient);
            let taken = wet.volume * (state.content - wet.content);
            // Changes of saturation occur at the whole pressure. Water that suction keeps above the hydrostatic level
            // has been lifted there.
            let filled = soil.map_or(0.0, |soil| {
                let before = soil.retained(wet.pressure, weight).saturation;
                wet.volume * soil.content(flow.bulk, state.J, state.whole) * (state.retained.saturation - before)
            });
            let lifted = (wet.ambient - wet.borne) * taken + wet.borne * filled;
            [
                fall + lifted,
                fall - driven,
                pressure * (taken - wet.volume * wet.goes_on) + lifted + (1.0 - now) * driven,
                state.lumped * wet.tau_of(gradient).dot(&gradient),
                wet.volume * held,
            ]
        });
        let sum = |k: usize| -> Exact { each.iter().map(|of| of[k]).collect() };
        let mut external = sum(0);
        let mut stored = sum(2);
        let flows = [(&mut external, 1.0 / now), (&mut stored, (1.0 - now) / now)];
        for (sum, times) in flows {
            *sum -= &pores.drainage.work(&found.p, times);
            *sum -= &over_layers(halo, 1, |node| times * found.p[node] * balance.out[node]);
        }
        Some(Self {
            external,
            seepage: sum(1),
            stored,
            tau: sum(3),
            held: sum(4),
        })
    }
}

/// Returns the energy of compressed water and of suction in emptied pores over the points of this rank at time `t` (J).
pub fn in_points<K, const D: usize>(model: &Model<K, D>, points: &Points<D>, t: f64) -> Exact {
    let flow = model
        .water
        .as_ref()
        .and_then(|water| Some((water, water.flow.as_ref()?)));
    let Some((water, flow)) = flow else { return Exact::ZERO };
    let mut sum = Exact::ZERO;
    for (p, x) in points.x.iter().enumerate() {
        let Some(soil) = &flow.soils[usize::from(points.material[p])] else {
            continue;
        };
        let excess = points
            .pore_pressure
            .as_ref()
            .map_or_else(|| water.excess_at_start(x), |excess| excess[p]);
        let still = if flow.retains() {
            water.still_pressure(x, t)
        } else {
            0.0
        };
        let pores = soil.pores(points.F.at(p).determinant() * points.dilation_of(p));
        sum.add(points.volume[p] * held(flow, soil, pores, excess, excess + still, water.unit_weight));
    }
    sum
}

/// Returns the energy per reference volume (J/m^D): of water compressed by the `excess` pressure, and of suction in
/// pores that are emptied from saturation to the `whole` pressure.
fn held<const D: usize>(flow: &Flow<D>, soil: &Soil<D>, pores: f64, excess: f64, whole: f64, weight: f64) -> f64 {
    let emptied = soil
        .retention
        .as_ref()
        .map_or(0.0, |retention| retention.stored(whole, weight));
    pores * (0.5 * excess * excess / flow.bulk + emptied)
}
