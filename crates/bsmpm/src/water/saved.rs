//! Updates pore pressure and mass of the material points after convergence, theory-manual equation (T8.12).

use crate::exact::Exact;
use crate::grid::transfer::scalars;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::solve::found::StepSolution;
use crate::step::problem::Problem;
use crate::step::trial::DeformationIncrement;
use crate::tensor::Vector;
use crate::water::backward::is_smooth;
use crate::water::crossed::CumulativeFlux;
use crate::water::flow::{DrainedFace, Flow};
use crate::water::nodes::{PoreField, face_functions};
use crate::water::residual::{ExcessPressure, FlowState};

/// Part of a cell by which ground is off a drained face when it is reported: a column that had settled by 0.1 of a
/// cell was 1 % short of its settlement, by 0.3 of a cell 4 %, and by one it settled no more.
const OFF: f64 = 0.2;
/// Cells from the face within which ground is at it: no row of points of a cell, (k + 1/2)/n, is just there.
const NEAR: f64 = 0.6;

/// The ground at a drained face of the grid, which does not go with it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceReport {
    /// points that lay within 0.6 of a cell of the face at the start
    pub near: usize,
    /// those of them that have moved off it by more than a fifth of a cell
    pub off: usize,
    /// functions of the pressure on the face that see ground
    pub held: usize,
}

/// What the water of an accepted step did, over all ranks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaterReport {
    /// m3  that the points took in: what they hold now less what they held before
    pub stored: f64,
    /// m3  that crossed the surface of the ground, of second order with what goes on of the step before
    pub crossed: CumulativeFlux,
    /// points of every drain with material near, then of every inflow
    pub held: Vec<usize>,
    /// cells between points of every drain, then of every inflow, that were neighbours on the surface at the start: the
    /// most
    pub torn: Vec<f64>,
    /// the ground at every drained face of the grid
    pub faces: Vec<FaceReport>,
    /// m3  sum of what is left out of balance: stored + out of the ground - this is round-off
    pub left: f64,
    /// measure that the step was accepted by: |R| over the largest of what is stored, flows and leaves
    pub measure: f64,
    /// unknown pressures
    pub unknowns: usize,
}

impl WaterReport {
    /// Of what was found, before the points have taken it; `None` where no water flows. Two reductions,
    /// with drained faces three.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
    ) -> Option<Self> {
        let Problem { model, nodes, halo, .. } = *problem;
        let pores = nodes.pores.as_ref()?;
        let water = found.water.as_ref()?;
        let flow = model.water.as_ref()?.flow.as_ref()?;
        let owned = halo.owned();
        let mut counted = vec![false; water.out.len()];
        let mut sums = vec![Exact::ZERO; flow.faces.len()];
        // The face that is named last decides a pressure of two.
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
        let mut crossed = CumulativeFlux {
            drains: drains.iter().map(|report| report.through).collect(),
            faces,
            inflows: inflows.iter().map(|report| report.through).collect(),
            removed: 0.0,
        };
        let mut left = water.left;
        let last = pores.differences.last;
        if let Some(flowed) = &problem.points.surface.flowed {
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

/// The ground at the drained faces, before the step. One reduction, if there are some.
fn at_faces<K, const D: usize>(problem: &Problem<'_, K, D>, pores: &PoreField<D>, flow: &Flow<D>) -> Vec<FaceReport> {
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

/// The numbers of a [`FaceReport`], on this rank.
fn at_face<K, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PoreField<D>,
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

/// Saves nodal excess pressures `p`, Pa, into the points, which have moved, and the mass of the water that they took
/// in; m3 of it, over all ranks.
pub fn save<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    pores: &PoreField<D>,
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
        // What the whole pressure is now is what counts where it empties pores: the excess is over the place it came
        // to.
        let moved = if holds {
            wet.ambient - water.still_pressure(&points.x[p], pores.end)
        } else {
            0.0
        };
        pressures[p] = *pressure + moved;
        gradients[p] = state.gradient + water.still_gradient(&points.x[p], pores.end);
        let taken = wet.volume * (state.content - wet.content);
        if let Some((contents, changes)) = &mut goes_on {
            // In the first step nothing goes on.
            let before = points.pressure_gradient.as_ref().map_or(wet.before, |before| before[p]);
            (contents[p], changes[p]) = (state.content - wet.content, gradients[p] - before);
        }
        // What is weightless stays so.
        if points.mass[p] > 0.0 {
            points.mass[p] += density * taken;
        }
        stored.push(taken);
    }
    (points.pore_pressure, points.pressure_gradient) = (Some(pressures), Some(gradients));
    (points.content_change, points.gradient_change) = goes_on.unzip();
    halo.reproducible_sum(&[stored.into_iter().collect()])[0]
}
