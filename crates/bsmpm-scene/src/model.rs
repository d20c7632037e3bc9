//! Converts a case to the input of the crate `bsmpm`: model, material points and step sequence.

use crate::observables::Observable;
use crate::seed::seed_bodies;
use crate::words::AnalysisType;
use crate::{ActiveLoads, Case, Every, Face, GridAxis, NamedMaterial, Regime, Shares, Stage, surfaces};
use bsmpm::boundary::{Boundary, Support};
use bsmpm::error::GridError;
use bsmpm::field::pore_water::Water;
use bsmpm::field::pore_water::ambient::Ambient;
use bsmpm::field::pore_water::flow::{Course, Flow};
use bsmpm::grid::{Grid, KnotVector};
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::rigid::{self, ParticleDomains, RigidBody, RigidState};
use bsmpm::kinematics::Kinematics;
use bsmpm::material::state_width;
use bsmpm::method::Criteria;
use bsmpm::method::Nonlinear;
use bsmpm::method::QuasiNewton;
use bsmpm::model::{AverageWeight, Gravity, Model, Shaking};
use bsmpm::points::{Points, Seed};
use bsmpm::schedule::{Growth, Schedule};
use bsmpm::stabilisation::Groups;
use bsmpm::step::adjoint::is_dilatant;
use bsmpm::tensor::{Symmetric, Vector};
use std::marker::PhantomData;

pub use crate::grid::vector;

/// The model of a case over its whole grid, at the start.
pub fn model<K: Kinematics<D>, const D: usize>(case: &Case) -> Result<Model<K, D>, GridError> {
    model_at(case, 0.0)
}

/// What a step must fulfil.
pub fn criteria(case: &Case) -> Criteria {
    let solver = &case.solver;
    Criteria {
        energy: solver.tolerance,
        force: solver.force_tolerance,
        max_iterations: solver.max_iterations,
    }
}

/// The same once the stages until the time `t` have begun.
pub fn model_at<K: Kinematics<D>, const D: usize>(case: &Case, t: f64) -> Result<Model<K, D>, GridError> {
    let coefficient = case.solver.background;
    let artificial_stiffness = (coefficient > 0.0).then_some(ArtificialStiffness { coefficient });
    let grid = grid(case)?;
    let materials = case.materials_at(t);
    let flow = surfaces::flow::<K, D>(case, &grid, t);
    Ok(Model {
        materials: materials.iter().map(|named| named.material.clone()).collect(),
        regime: case.analysis.regime,
        newmark: case.analysis.newmark,
        mass: case.analysis.mass,
        wall_velocity: case.analysis.wall_velocity,
        weighting: weighting(case),
        gravity: case.gravity.as_ref().map(|gravity| Gravity {
            acceleration: vector(gravity.acceleration),
            ramp: gravity.ramp,
            starts_vertical: case.initial.is_some(),
        }),
        shaking: (!case.shaking.is_empty()).then(|| Shaking {
            rows: case.shaking.iter().map(|&(t, ground)| (t, vector(ground))).collect(),
        }),
        boundary: boundary::<K, D>(case, &grid, t),
        grid,
        stabilisation: case.stabilisation,
        groups: groups_of(case, &materials),
        quadrature: case.solver.quadrature,
        extended_splines: case.solver.extended_splines,
        artificial_stiffness,
        criteria: criteria(case),
        damping: damping(&materials),
        nonlinear: match case.solver.nonlinear {
            crate::Nonlinear::Auto => Nonlinear::Auto,
            crate::Nonlinear::Broyden => Nonlinear::QuasiNewton(QuasiNewton::Broyden),
            crate::Nonlinear::Newton => Nonlinear::Newton,
        },
        water: water(case, flow),
        balances_energy: case
            .histories
            .iter()
            .any(|history| history.quantity.observable == Observable::Energy),
        kinematics: PhantomData,
    })
}

/// Still water, and water that flows; of the latter alone the pore pressure is all excess. One that points carry asks
/// for no unit weight.
fn water<const D: usize>(case: &Case, flow: Option<Flow<D>>) -> Option<Water<D>> {
    let still = case.water.as_ref();
    let unit_weight = still
        .map(|still| still.unit_weight)
        .or(case.flow.as_ref().map(|flow| flow.unit_weight));
    let unit_weight = unit_weight.or(case.carries_pressure().then_some(0.0))?;
    Some(Water {
        unit_weight,
        ambient: still.map_or(Ambient::None, |still| still.from(&case.grid)),
        flow,
    })
}

/// s  of every material; empty where none is damped.
fn damping(materials: &[NamedMaterial]) -> Vec<f64> {
    let times: Vec<f64> = materials.iter().map(|named| named.retardation).collect();
    if times.iter().all(|time| *time == 0.0) {
        Vec::new()
    } else {
        times
    }
}

/// The grid of a case.
pub(crate) fn grid<const D: usize>(case: &Case) -> Result<Grid<D>, GridError> {
    let order = case.grid.order;
    let axes = (0..D).map(|axis| match &case.grid.axes[axis] {
        GridAxis::Uniform { cell, cells, .. } if case.grid.lines[axis].is_empty() => {
            KnotVector::uniform(*cell, *cells, order)
        }
        _ => KnotVector::graded(&case.grid.repeated(axis), order),
    });
    let axes = axes.collect::<Result<Vec<_>, _>>()?;
    let axes = std::array::from_fn(|axis| axes[axis].clone());
    Ok(Grid::new(axes)?.reaching(case.beyond()))
}

fn boundary<K: Kinematics<D>, const D: usize>(case: &Case, grid: &Grid<D>, t: f64) -> Boundary<D> {
    Boundary {
        supports: supports(case, t),
        outlets: outlets(case, t),
        strips: surfaces::strips::<K, D>(case, grid, penalty(case), t),
        resting: case
            .footing
            .iter()
            .map(|of| of.rests)
            .chain(case.prescribed.iter().map(|of| of.rests))
            .collect(),
        rigid: surfaces::rigid(case, t),
        loads: surfaces::loads::<K, D>(case, grid, t),
        reach: reach(case),
    }
}

/// Parts of a cell that the points of every material reach to each side at the start, at most.
fn reach(case: &Case) -> Vec<f64> {
    let mut reach = vec![0.0_f64; case.materials.len()];
    for body in &case.bodies {
        reach[body.material] = reach[body.material].max(0.5 / body.points_per_cell as f64);
    }
    reach
}

fn supports<const D: usize>(case: &Case, t: f64) -> Vec<Support<D>> {
    case.faces_at(t).into_iter().filter_map(support).collect()
}

/// The support of a face, if it has one.
fn support<const D: usize>(of: crate::FaceSupport) -> Option<Support<D>> {
    let Face { axis, upper } = of.face;
    match (of.support, of.contact) {
        (_, Some(contact)) => Some(Support::contact(axis, upper, contact)),
        (crate::Support::Fixed, _) => Some(Support::fixed(axis, upper)),
        (crate::Support::Roller, _) => Some(Support::roller(axis, upper)),
        (crate::Support::Absorbing, _) => Some(Support::absorbing(axis, upper)),
        (crate::Support::FreeField, _) => Some(Support::free_field(axis, upper)),
        (crate::Support::Free | crate::Support::Outflow | crate::Support::Contact, None) => None,
    }
}

/// Faces that let material out: the axis, and whether it is the upper one.
fn outlets(case: &Case, t: f64) -> Vec<(usize, bool)> {
    case.faces_at(t)
        .iter()
        .filter(|of| of.support == crate::Support::Outflow)
        .map(|of| (of.face.axis, of.face.upper))
        .collect()
}

/// Of every support once the stages until the time `t` have begun, the axis that its face is normal to and the sign of
/// the force along it with which it pushes the body; 0 where it may pull, too.
pub fn faces(case: &Case, t: f64) -> Vec<(usize, f64)> {
    if case.grid.dims() == 3 {
        pushes::<3>(case, t)
    } else {
        pushes::<2>(case, t)
    }
}

fn pushes<const D: usize>(case: &Case, t: f64) -> Vec<(usize, f64)> {
    let supports = supports::<D>(case, t).into_iter();
    let pushes = supports.map(|support| match (support.absorbs, support.upper) {
        (true, _) => (support.axis, 0.0),
        (false, true) => (support.axis, -1.0),
        (false, false) => (support.axis, 1.0),
    });
    pushes.collect()
}

/// N/m, of a solid N  reaction of a face below which it does nothing: a strain of 1e-9 of the softest material over the
/// shortest cell.
pub fn least_reaction(case: &Case) -> f64 {
    let softest = case
        .materials
        .iter()
        .map(|named| named.material.elastic().young)
        .fold(f64::INFINITY, f64::min);
    let shortest = case
        .grid
        .axes
        .iter()
        .map(GridAxis::shortest)
        .fold(f64::INFINITY, f64::min);
    1e-9 * softest * (1..case.grid.dims()).map(|_| shortest).product::<f64>()
}

/// Penalty of the rigid strips, Pa/m.
pub fn penalty(case: &Case) -> f64 {
    let stiffest = case
        .materials
        .iter()
        .map(|named| named.material.elastic().young)
        .fold(0.0, f64::max);
    surfaces::penalty(
        stiffest,
        case.grid
            .axes
            .iter()
            .map(GridAxis::shortest)
            .fold(f64::INFINITY, f64::min),
    )
}

/// What bodies have at the start in the columns of one slab, by the numbers of the physics' grid.
pub fn seeds<K: Kinematics<D>, const D: usize>(
    case: &Case,
    columns: std::ops::Range<usize>,
) -> impl Iterator<Item = Seed<D>> + '_ {
    seed_bodies::<K, D>(case, case.grid.cells_in(0, &columns), |body| case.is_there(body, 0.0))
}

/// The points of the columns of one slab at the start, of those places in it that are `wanted`.
pub fn points<K: Kinematics<D>, const D: usize>(
    case: &Case,
    columns: std::ops::Range<usize>,
    wanted: impl Fn(&Vector<D>) -> bool,
) -> Points<D> {
    let seeds = seeds::<K, D>(case, columns).filter(|seed| wanted(&seed.x));
    let points = Points::from_seeds(seeds, case.analysis.regime == Regime::Dynamic);
    let mut points = points.with_state(state_width(case.materials.iter().map(|named| &named.material)));
    if case.carries_pressure() {
        let carried = points.material.iter().zip(&points.x);
        points.carried_pressure = Some(
            carried
                .map(|(&material, x)| carried_pressure(case, material, x))
                .collect(),
        );
    }
    points.extent = extents::<K, D>(case, &points);
    points
}

/// How much of its reach every point has beside the rigid bodies, where there are any.
fn extents<K: Kinematics<D>, const D: usize>(case: &Case, points: &Points<D>) -> Option<Vec<f64>> {
    let bodies = surfaces::rigid(case, 0.0);
    let grid = grid(case).ok().filter(|_| !bodies.is_empty())?;
    let states: Vec<RigidState> = bodies.iter().map(RigidBody::at_rest).collect();
    let reaching = ParticleDomains {
        grid: &grid,
        points,
        reach: &reach(case),
        weight: K::weight,
    };
    Some(rigid::extents(&bodies, &states, &reaching, |x| is_soil(case, x)))
}

/// Whether a place (m, from the grid's lower corner) lies in a body at the start.
fn is_soil<const D: usize>(case: &Case, x: &Vector<D>) -> bool {
    let at = placed_at(case.grid.lower(), x);
    case.bodies.iter().enumerate().any(|(number, body)| {
        case.is_there(number, 0.0)
            && match D {
                3 => body.region.contains_in_space(at),
                _ => body.region.contains([at[0], at[1]]),
            }
    })
}

/// Pa  pore pressure that a point carries, at `x` (m, from the grid's lower corner) at the start.
fn carried_pressure<const D: usize>(case: &Case, material: u16, x: &Vector<D>) -> f64 {
    let ratio = case.materials[usize::from(material)].ratio;
    let lower = case.grid.lower();
    if ratio > 0.0 {
        ratio * case.overburden(placed_at(lower, x))
    } else {
        0.0
    }
}

/// The points that a stage places in the columns of one slab.
pub fn placed<'a, K: Kinematics<D>, const D: usize>(
    case: &'a Case,
    stage: &'a Stage,
    columns: std::ops::Range<usize>,
) -> impl Iterator<Item = Seed<D>> + 'a {
    seed_bodies::<K, D>(case, case.grid.cells_in(0, &columns), |body| stage.add.contains(&body))
}

/// Stress of ground at rest, Pa, at `x` (m, from the grid's lower corner); `k0` by material.
pub fn at_rest<const D: usize>(case: &Case, k0: &[f64], material: u16, x: &Vector<D>) -> Symmetric {
    let at = placed_at(case.grid.lower(), x);
    let vertical = -case.overburden(at) * (1.0 - case.materials[usize::from(material)].ratio);
    let vertical = vertical - case.suction_at(material, at);
    let horizontal = k0[usize::from(material)] * vertical;
    let mut stress = Symmetric([horizontal, horizontal, horizontal, 0.0, 0.0, 0.0]);
    stress.0[D - 1] = vertical;
    stress
}

/// A place in the case's coordinates.
fn placed_at<const D: usize>(lower: [f64; 3], x: &Vector<D>) -> [f64; 3] {
    std::array::from_fn(|axis| lower[axis] + x.get(axis).copied().unwrap_or(0.0))
}

/// Steps and the times that they must hit: frames, pictures, profiles, checks and stages, and where water flows those
/// at which something given turns.
pub fn schedule(case: &Case) -> Schedule {
    let checks = case.checks.iter().map(|check| check.at);
    let stages = case.stages.iter().map(|stage| stage.at);
    let profiles = case.profiles.iter().flat_map(|profile| profile.times.iter().copied());
    let times = frame_times(case)
        .into_iter()
        .chain(checks)
        .chain(stages)
        .chain(profiles)
        .chain(turns(case));
    let schedule = Schedule::new(case.analysis.dt, case.analysis.end, times);
    let Some((factor, most)) = case.analysis.growth else {
        return schedule;
    };
    schedule.growing(Growth {
        factor,
        most,
        restarts: case.stages.iter().map(|stage| stage.at).collect(),
    })
}

/// Times at which the load with a number turns (s) in each span in which it acts: those of its rows, or else the end
/// of its ramp.
fn load_turns(case: &Case, load: usize, ramp: f64, shares: &Shares) -> Vec<f64> {
    let rows: Vec<f64> = shares.iter().map(|row| row.0).collect();
    let rows = if rows.is_empty() { vec![ramp] } else { rows };
    let times = std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at));
    let begins = times.filter_map(|t| case.acts_since(ActiveLoads::Load(load), t));
    begins
        .flat_map(|begin| rows.iter().map(move |row| begin + row))
        .collect()
}

/// Times at which loads, strips, levels, heads and pressures that are given turn, where water flows, beside which there
/// are no rigid bodies: what lies between the ends of a step would not be seen. A rate has its mean over a step.
fn turns(case: &Case) -> Vec<f64> {
    let Some(flow) = case
        .flow
        .as_ref()
        .filter(|_| case.analysis.kind == AnalysisType::Consolidation)
    else {
        return Vec::new();
    };
    let tractions = case.tractions.iter().map(|load| (load.ramp, &load.amplitude));
    let loads = tractions.chain(case.point_loads.iter().map(|load| (load.ramp, &load.amplitude)));
    let loads = loads.enumerate();
    let loads = loads.flat_map(|(load, (ramp, shares))| load_turns(case, load, ramp, shares));
    let strips = case
        .footing
        .iter()
        .map(|of| &of.path)
        .chain(case.prescribed.iter().map(|of| &of.path));
    let given = flow
        .drains
        .iter()
        .filter_map(|drain| drain.given.course())
        .flat_map(Course::times);
    let levels = case
        .water
        .iter()
        .flat_map(|water| water.table.levels())
        .flatten()
        .map(|row| row.0);
    let moved = strips.flat_map(|path| path.rows.iter().map(|row| row.0));
    loads.chain(moved).chain(given).chain(levels).collect()
}

/// Nominal number of steps.
pub fn nominal_steps(case: &Case) -> u64 {
    if case.analysis.growth.is_some() || case.analysis.kind == AnalysisType::Consolidation {
        let schedule = schedule(case);
        return std::iter::successors(schedule.next(0.0), |&t| schedule.next(t)).count() as u64;
    }
    (case.analysis.end / case.analysis.dt - 1e-6).ceil() as u64
}

/// Relative error of a quotient of two times.
const ROUND_OFF: f64 = 1e-12;

/// Times at which a frame is wanted, apart from the start, the end and every so many steps.
pub fn frame_times(case: &Case) -> Vec<f64> {
    let mut times = case.output.times.clone();
    if let Some(Every::Time(every)) = case.output.every {
        // Neither their number nor the last of them may be lost to rounding: 1.2 / 0.1 is less than 12, 12 x 0.1 more
        // than 1.2.
        let count = (case.analysis.end / every * (1.0 + ROUND_OFF)).floor() as u64;
        times.extend((1..=count).map(|k| (k as f64 * every).min(case.analysis.end)));
    }
    times
}

/// Materials of one stiffness: what an average over the grid may mix. One that depends on the height or the stress is
/// alike to itself; under consistent and sub-grid F-bar one that dilates is not alike to one that does not, as their
/// forces are formed in other ways.
pub fn groups(case: &Case) -> Groups {
    groups_of(case, &case.materials)
}

fn groups_of(case: &Case, materials: &[NamedMaterial]) -> Groups {
    let kinds = materials.iter().map(|named| {
        let alone = named.material.is_graded() || !named.material.is_linear();
        let graded = alone.then(|| named.name.clone());
        let adjoint = case.stabilisation.lowers() && is_dilatant(&named.material);
        (named.material.elastic().clone(), graded, adjoint)
    });
    Groups::of_alike(&kinds.collect::<Vec<_>>())
}

/// What averages are weighted with: mass, or volume where materials differ in density or some have none.
pub fn weighting(case: &Case) -> AverageWeight {
    let mut materials = case.bodies.iter().map(|body| &case.materials[body.material]);
    let mut densities = materials.clone().map(|named| named.density);
    let is_wet = case.water.is_some();
    if is_wet && materials.any(|named| named.saturated.is_some_and(|wet| Some(wet) != named.density)) {
        return AverageWeight::Volume;
    }
    match densities.next() {
        Some(Some(first)) if densities.all(|density| density == Some(first)) => AverageWeight::Mass,
        _ => AverageWeight::Volume,
    }
}
