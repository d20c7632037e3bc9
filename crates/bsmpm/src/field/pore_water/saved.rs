//! Updates pore pressure and mass of the material points after convergence, theory-manual equation (T8.12).

use crate::exact::Exact;
use crate::field::FieldBalance;
use crate::field::pore_water::backward::is_smooth;
use crate::field::pore_water::crossed::{CrossedVolumes, PreviousFlow};
use crate::field::pore_water::flow::{DrainedFace, Flow};
use crate::field::pore_water::nodes::{PorePressureField, face_functions};
use crate::field::pore_water::residual::{ExcessPressure, FlowState};
use crate::grid::transfer::scalars;
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::solve::found::StepSolution;
use crate::step::problem::Problem;
use crate::step::trial::DeformationIncrement;
use crate::tensor::Vector;

/// Settlement away from a drained face, in cells, from which on it is reported. A column that had settled by 0.1 cells
/// was 1 % short of its settlement, by 0.3 cells 4 %; with a gap of one cell it settled no more.
const OFF: f64 = 0.2;
/// Distance from the face, in cells, within which points belong to it; no regular row of points, (k + 1/2)/n, lies
/// exactly there.
const NEAR: f64 = 0.6;

/// Ground at a drained face of the grid, which does not follow the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceReport {
    /// Number of points initially within 0.6 cells of the face.
    pub near: usize,
    /// Number of those that have moved away by more than 0.2 cells.
    pub off: usize,
    /// Number of pressure functions on the face with ground in their support.
    pub held: usize,
}

/// Pore-water results of an accepted step, over all ranks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaterReport {
    /// Increase of the stored water (m3).
    pub stored: f64,
    /// Water through the surfaces of the ground, including the part carried over by the second-order difference (m3).
    pub crossed: CrossedVolumes,
    /// Number of surface points with material nearby, for every drain, then every inflow.
    pub held: Vec<usize>,
    /// Largest distance between initially neighbouring surface points in cells, for every drain, then every inflow.
    pub torn: Vec<f64>,
    /// Ground at every drained face of the grid.
    pub faces: Vec<FaceReport>,
    /// Sum of the residual; stored + outflow - residual is round-off (m3).
    pub left: f64,
    /// Relative residual of the water balance at acceptance, see
    /// [`WaterBalance::measure`](crate::field::pore_water::residual::WaterBalance::measure).
    pub measure: f64,
    /// Number of unknown pressures.
    pub unknowns: usize,
}

impl WaterReport {
    /// Completes the results with the water that the points have taken in in a step `dt` (m3, s), and enters the flow
    /// into the `state` of the interactions.
    pub fn complete<K, const D: usize>(
        &mut self,
        model: &Model<K, D>,
        content: f64,
        dt: f64,
        state: &mut InteractionState<D>,
    ) {
        self.stored = content;
        state.crossed.add(1.0, &self.crossed);
        state.flowed = is_smooth(model).then(|| PreviousFlow {
            dt,
            crossed: self.crossed.clone(),
            left: self.left,
        });
    }

    /// Returns the results of the step solution `found`, after the flow `before` of the last step, before the points
    /// are updated; `None` without pore-water flow. Two reductions, three with drained faces.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
        before: Option<&PreviousFlow>,
    ) -> Option<Self> {
        let Problem { model, nodes, halo, .. } = *problem;
        let pores = nodes.field.as_ref()?;
        let water = found.field.as_ref()?;
        let flow = model.water.as_ref()?.flow.as_ref()?;
        let owned = halo.owned();
        let mut counted = vec![false; water.out.len()];
        let mut sums = vec![Exact::ZERO; flow.faces.len()];
        // Where two faces meet, the last one of the input determines the pressure.
        for (face, sum) in flow.faces.iter().zip(&mut sums).rev().filter(|(face, _)| face.acts) {
            let nodes = face_functions(&model.grid, face.axis, face.upper).into_iter();
            for node in nodes.filter(|&node| owned.contains(node)) {
                if !std::mem::replace(&mut counted[node], true) {
                    sum.add(water.out[node]);
                }
            }
        }
        let faces = halo.reproducible_sum(&sums);
        let [drains, inflows] = pores.drainage.report(&found.p, halo);
        let held = drains.iter().chain(&inflows).map(|report| report.held).collect();
        let mut crossed = CrossedVolumes {
            drains: drains.iter().map(|report| report.through).collect(),
            faces,
            inflows: inflows.iter().map(|report| report.through).collect(),
            removed: 0.0,
        };
        let mut left = water.left;
        let last = pores.differences.last;
        if let Some(flowed) = before {
            crossed.add(last, &flowed.crossed);
            left += last * flowed.left;
        }
        let measure = water.measure(pores.round_off);
        let torn = pores.drainage.torn.clone();
        let faces = at_faces(problem, pores, flow);
        Some(Self {
            stored: 0.0,
            crossed,
            held,
            torn,
            faces,
            left,
            measure,
            unknowns: pores.unknowns,
        })
    }
}

/// Returns the ground at the drained faces before the step. One reduction if there are any.
fn at_faces<K, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PorePressureField<D>,
    flow: &Flow<D>,
) -> Vec<FaceReport> {
    if flow.faces.is_empty() {
        return Vec::new();
    }
    let counts = flow.faces.iter().flat_map(|face| at_face(problem, pores, flow, face));
    let sums: Vec<Exact> = counts.collect();
    let totals = problem.halo.reproducible_sum(&sums);
    let reports = totals.chunks_exact(3).map(|counts| FaceReport {
        near: counts[0] as usize,
        off: counts[1] as usize,
        held: counts[2] as usize,
    });
    reports.collect()
}

/// Returns the numbers of a [`FaceReport`] on this rank.
fn at_face<K, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PorePressureField<D>,
    flow: &Flow<D>,
    face: &DrainedFace,
) -> [Exact; 3] {
    let Problem { points, halo, .. } = *problem;
    let grid = &problem.model.grid;
    let axis = &grid.axes()[face.axis];
    let last = if face.upper { axis.cells() } else { 1 };
    let edge = axis.breakpoint(last) - axis.breakpoint(last - 1);
    let depth = |x: f64| if face.upper { axis.length() - x } else { x };
    let mut near = Exact::ZERO;
    let mut off = Exact::ZERO;
    for p in (0..points.len()).filter(|&p| flow.permeability(points.material[p], 1.0).is_some()) {
        let x = points.x[p][face.axis];
        let before = depth(x - points.u[p][face.axis]);
        if before < NEAR * edge {
            near.add(1.0);
            off.add(f64::from(u8::from(depth(x) - before > OFF * edge)));
        }
    }
    let owned = halo.owned();
    let nodes = face_functions(grid, face.axis, face.upper).into_iter();
    let held = nodes.filter(|&node| owned.contains(node) && pores.seen[node]);
    [near, off, held.map(|_| 1.0).collect()]
}

/// Stores the nodal excess pressures `p` (Pa) and the mass of absorbed water in the points, which have moved. Returns
/// the volume of that water over all ranks (m3). One reduction.
pub fn save<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    pores: &PorePressureField<D>,
    trial: &DeformationIncrement<K, D>,
    p: &[f64],
    points: &mut Points<D>,
    halo: &dyn Halo,
) -> f64 {
    let Some(water) = &model.water else { return 0.0 };
    let states = scalars::scalars(&pores.shape, p, |p, pressure, gradient| {
        let wet = pores.wet[p].as_ref()?;
        let dilation = points.dilation_of(p); // the points have it from the trial
        let excess = ExcessPressure {
            value: pressure,
            gradient,
        };
        let state = FlowState::at(model, points, p, wet, &trial.dF(p), dilation, excess)?;
        Some((pressure, state))
    });
    let density = water.density(model);
    let holds = water.flow.as_ref().is_some_and(|flow| flow.retains());
    let mut pressures = vec![0.0; states.len()];
    let mut gradients = vec![Vector::zeros(); states.len()];
    let mut goes_on = is_smooth(model).then(|| (vec![0.0; states.len()], gradients.clone()));
    let mut stored = Vec::with_capacity(states.len());
    for (p, (state, wet)) in states.iter().zip(&pores.wet).enumerate() {
        let Some(((pressure, state), wet)) = state.as_ref().zip(wet.as_ref()) else {
            continue;
        };
        // With retention the whole pressure is the state: the excess pressure refers to the hydrostatic pressure at the
        // new position.
        let moved = if holds {
            wet.ambient - water.still_pressure(&points.x[p], pores.end)
        } else {
            0.0
        };
        pressures[p] = *pressure + moved;
        gradients[p] = state.gradient + water.still_gradient(&points.x[p], pores.end);
        let taken = wet.volume * (state.content - wet.content);
        if let Some((contents, changes)) = &mut goes_on {
            // In the first step there is no previous gradient.
            let before = points.pressure_gradient.as_ref().map_or(wet.before, |before| before[p]);
            (contents[p], changes[p]) = (state.content - wet.content, gradients[p] - before);
        }
        // Massless points stay massless.
        if points.mass[p] > 0.0 {
            points.mass[p] += density * taken;
        }
        stored.push(taken);
    }
    (points.pore_pressure, points.pressure_gradient) = (Some(pressures), Some(gradients));
    (points.content_change, points.gradient_change) = goes_on.unzip();
    halo.reproducible_sum(&[stored.into_iter().collect()])[0]
}
