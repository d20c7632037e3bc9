//! After a failed step, finds the largest out-of-balance forces, and suggests remedies.

use bsmpm::control::Failure;
use bsmpm::error::{Advice, StepError};
use bsmpm::material::LayeredMaterial;
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_io::failure::{FailureMeasures, FailureReport};
use bsmpm_io::manifest::Worst;
use bsmpm_messages::{code_of, without_code};
use bsmpm_scene::{Body, Case, GridSpec, Initial, Rigid};
use mpi::topology::{Communicator, SimpleCommunicator};
use mpi::traits::CommunicatorCollectives;

/// Places reported of one failure.
const MOST_PLACES: usize = 10;

/// The report of `failure` in step `step` of a case, from all ranks. Collective.
pub(super) fn of(world: &SimpleCommunicator, failure: &Failure, step: u64, case: &Case) -> FailureReport {
    let last = failure.attempts.last();
    // The last attempt may have ended before it iterated; all ranks have the same kinds of errors.
    let mut latest = failure.attempts.iter().rev();
    let iterated = latest.find(|error| matches!(error, StepError::NotConverged { .. }));
    let (history, tolerances) = match iterated {
        Some(StepError::NotConverged { history, criteria, .. }) => (
            history
                .iter()
                .map(|m| FailureMeasures::new(m.energy, m.force))
                .collect(),
            Some(FailureMeasures::new(criteria.energy, criteria.force)),
        ),
        _ => (Vec::new(), None),
    };
    FailureReport {
        step,
        time: failure.t,
        dt: failure.dt,
        attempts: failure.attempts.iter().map(ToString::to_string).collect(),
        history,
        tolerances,
        worst: last.map_or_else(Vec::new, |error| worst(world, places_of(error, iterated), &case.grid)),
        loose: last
            .and_then(|error| loose_body(error, case))
            .map(|body| body.name.clone()),
        advice: last.map_or_else(Vec::new, |error| [implausible(case), advice(error, case)].concat()),
    }
}

/// The rigid body that nothing holds, if that is the error.
fn loose_body<'a>(error: &StepError, case: &'a Case) -> Option<&'a Rigid> {
    let StepError::Loose { body } = error else { return None };
    case.rigid.get(*body)
}

/// The error whose places are reported: the last one, or where that names none the last that iterated.
fn places_of<'a>(last: &'a StepError, iterated: Option<&'a StepError>) -> &'a StepError {
    if matches!(last, StepError::Solve(_)) {
        iterated.unwrap_or(last)
    } else {
        last
    }
}

/// Order among the places, number, force or 0, x, y and z.
type NodePlace = [f64; 6];

/// The nodes whose forces are the least balanced, or the points that the ranks name, of all ranks.
fn worst(world: &SimpleCommunicator, error: &StepError, grid: &GridSpec) -> Vec<Worst> {
    let lower = grid.lower();
    let dims = grid.dims();
    let kind = if error.worst_nodes().is_some() { "node" } else { "point" };
    let mut own: Vec<NodePlace> = match error.worst_nodes() {
        Some(nodes) => nodes
            .iter()
            .map(|node| {
                let [x, y, z] = in_case(lower, &node.x);
                [-node.force, node.number as f64, node.force, x, y, z]
            })
            .collect(),
        None => error
            .point()
            .map(|(id, x)| {
                let [x, y, z] = in_case(lower, x);
                [id as f64, id as f64, 0.0, x, y, z]
            })
            .into_iter()
            .collect(),
    };
    own.resize(MOST_PLACES, [f64::INFINITY; 6]);
    let own: Vec<f64> = own.into_iter().flatten().collect();
    let mut all = vec![0.0_f64; own.len() * world.size().unsigned_abs() as usize];
    world.all_gather_into(&own[..], &mut all[..]);
    let mut places: Vec<&[f64]> = all
        .chunks_exact(6)
        .filter(|place| place.iter().all(|n| n.is_finite()))
        .collect();
    places.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let worst = places.iter().take(MOST_PLACES).map(|place| Worst {
        kind: kind.into(),
        id: place[1] as u64,
        position: place[3..3 + dims].to_vec(),
        force: (kind == "node").then_some(place[2]),
    });
    worst.collect()
}

/// The place `x` (m, from the grid's lower corner) in the coordinates of the case.
fn in_case(lower: [f64; 3], x: &[f64]) -> [f64; 3] {
    std::array::from_fn(|axis| lower[axis] + x.get(axis).copied().unwrap_or(0.0))
}

/// The remedies of an error in this case, found by the name of its advice.
fn advice(error: &StepError, case: &Case) -> Vec<String> {
    match error.meaning().advice {
        Advice::Iteration => against_no_convergence(error, case),
        Advice::CreatedEnergy => against_created_energy(case.stabilisation),
        Advice::LooseBody => loose_body(error, case).map(against_motion).into_iter().collect(),
        Advice::OverlappingBodies => against_overlap(error, case),
        other => fixed_advice(other, case)
            .iter()
            .map(|line| (*line).to_owned())
            .collect(),
    }
}

/// What keeps two rigid bodies from overlapping, if that is the error.
fn against_overlap(error: &StepError, case: &Case) -> Vec<String> {
    let StepError::Overlapping { bodies } = error else {
        return Vec::new();
    };
    let [one, other] = bodies.map(|number| case.rigid[number].name.as_str());
    vec![format!(
        "Keep `{one}` and `{other}` apart by other paths, or make them one body: rigid bodies do not contact each other."
    )]
}

/// Advice that names nothing of the case; none for an error that has advice of its own.
fn fixed_advice(advice: Advice, case: &Case) -> &'static [&'static str] {
    match advice {
        Advice::ClosedPores => &[
            "The skeleton is compressed into its grains. Increase `porosity` or the stiffness of the soil.",
            "Set `permeability_law = \"kozeny-carman\"`, and use shorter steps.",
        ],
        Advice::Instability => &[
            "The pressure is several times the shear modulus of nearly incompressible material. Increase `body.points_per_cell`.",
            "If the body itself buckles, use a dynamic analysis.",
        ],
        Advice::UnsettledContact => &[
            "Increase `analysis.steps`, or reduce `analysis.dt`, so that the contact changes less in a step.",
            "Reduce the friction coefficient in [boundary]: from about 1 on there may be no solution, or several.",
        ],
        Advice::InitialEquilibrium => &[
            "Set `body.points_per_cell = 3`, or blunt the body where it ends in a tip.",
            "The body may not stand at all. Use `gravity.ramp` without [initial], so that it yields as it is loaded.",
            "Increase `solver.force_tolerance`.",
        ],
        Advice::InvertedMaterial => &[
            "Increase `analysis.steps` (or reduce `analysis.dt`), or increase `solver.background`.",
            "Look at the material points named: loose points at a free surface are the usual ones.",
        ],
        Advice::LeavingMaterial => &[
            "Use a larger grid, or a support at that boundary.",
            "If material is to leave, set \"outflow\" in [boundary]. Footings, segments and loads stay.",
        ],
        Advice::EmptyGrid => &[
            "Reduce `analysis.end` to before this time, as there is nothing left to compute.",
            "Use a larger grid, if the material is to be followed farther.",
        ],
        Advice::LostLoad => &["Look at the last frame, and place the load where the material is."],
        Advice::ImpermeableDrain => &["Give that material a `permeability`, or move the drain or inflow."],
        Advice::SingularSystem if starts_at_rest(case) && case.solver.background == 0.0 => &[
            "Set `solver.background = 1e-4`: without inertia nothing supports nearly empty cells.",
            "Set `solver.linear = \"direct\"`.",
        ],
        Advice::SingularSystem | Advice::LinearSolver => &[
            "Check that every body is supported, or increase `solver.background`.",
            "Set `solver.linear = \"direct\"`, and append `-- -pc_type redundant` to the command line: MUMPS then solves the equations.",
        ],
        Advice::ShorterSteps => &["Increase `analysis.steps`, or reduce `analysis.dt`."],
        Advice::Iteration | Advice::CreatedEnergy | Advice::LooseBody | Advice::OverlappingBodies | Advice::None => &[],
    }
}

/// What keeps the discretisation from creating energy.
fn against_created_energy(stabilisation: Stabilisation) -> Vec<String> {
    [
        match stabilisation {
            Stabilisation::None => "Reduce `analysis.dt`.",
            Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => "Set `stabilisation.method = \"none\"`.",
            Stabilisation::FBar | Stabilisation::ModifiedFBar => {
                "Set `stabilisation.method = \"consistent-f-bar\"`."
            }
        },
        "If bodies separate from a boundary, use shorter steps, or `analysis.newmark_gamma = 1`.",
        "Reduce the dilation angle, or add friction. The frames and [[history]] quantity = \"energy\" show where it begins.",
        "The saved state is wrong, too: do not continue from it.",
    ]
    .map(str::to_owned)
    .to_vec()
}

/// Whether equilibrium is sought before the first step.
fn starts_at_rest(case: &Case) -> bool {
    case.settles || case.initial == Some(Initial::Elastic)
}

/// What the case was warned of as probably not meant: it may well be why a step fails.
fn implausible(case: &Case) -> Vec<String> {
    let slips = case.warnings.iter().filter_map(|warning| {
        let code = code_of(warning).filter(|code| code.starts_with("W01"))?;
        let key = without_code(warning).split(": ").next().unwrap_or_default();
        Some(format!("First check warning {code} ({key})."))
    });
    slips.collect()
}

fn body_without_cohesion(case: &Case) -> Option<&Body> {
    let mut bodies = case.bodies.iter();
    bodies.find(|body| cohesion(&case.materials[body.material].material) == Some(0.0))
}

/// What helps where soil without cohesion has a free surface that its weight alone brings to failure.
fn against_local_failure(case: &Case) -> Option<String> {
    let body = body_without_cohesion(case)?;
    let is_at_rest = case.analysis.regime == Regime::QuasiStatic && !case.has_prescribed_motion();
    (is_at_rest && case.gravity.is_some()).then(|| {
        format!(
            "material.{} has no cohesion: a free surface as steep as its friction angle, and the toe of a slope, fail under \
             their own weight. Give it a small cohesion, such as \"0.1 kPa\", or make the slope flatter.",
            case.materials[body.material].name
        )
    })
}

/// What helps where something is pushed into soil without cohesion. A footing on sand with a friction angle of 40 and a
/// dilation angle of 10 degrees ended with 80 whatever the background, with four times as many steps, and with a
/// cohesion of 0.1 and 1 kPa; with the purpose it found its limit load.
fn against_no_cohesion(case: &Case) -> Option<String> {
    let body = body_without_cohesion(case)?;
    if case.analysis.regime != Regime::QuasiStatic || !case.has_prescribed_motion() {
        return None;
    }
    let name = &case.materials[body.material].name;
    match case.limit_load {
        None => Some(format!(
            "`material.{name}` has no cohesion, and so no strength at the free surface. Set `analysis.purpose = \"limit-load\"`."
        )),
        Some(_) if case.solver.background == 0.0 => Some(format!(
            "`material.{name}` has no cohesion, and so no strength at the free surface. Remove `solver.background`."
        )),
        Some(_) => None,
    }
}

/// What keeps a rigid body in place that is free to move.
fn against_motion(rigid: &Rigid) -> String {
    let name = &rigid.name;
    match rigid.friction > 0.0 {
        true => format!(
            "`{name}` slides or falls: its friction is exhausted, or it does not touch the soil. Increase its \
             `friction_coefficient`, or reduce its force."
        ),
        false => format!(
            "`{name}` slides or falls: it has no friction, or does not touch the soil. Set its `friction_coefficient`, or remove the \
             direction from `free`."
        ),
    }
}

/// Pa  Cohesion of a law that has one.
fn cohesion(material: &LayeredMaterial) -> Option<f64> {
    let material = material.at(0.0);
    let number = material
        .parameter_names()
        .iter()
        .position(|variable| variable.name == "cohesion")?;
    material.parameters().get(number).copied()
}

/// What to try where both measures did not fall below their tolerances, if that is the error.
fn against_no_convergence(error: &StepError, case: &Case) -> Vec<String> {
    let StepError::NotConverged {
        iterations,
        force,
        material,
        criteria,
        ..
    } = error
    else {
        return Vec::new();
    };
    let mut lines: Vec<String> = against_no_cohesion(case)
        .into_iter()
        .chain(against_local_failure(case))
        .collect();
    if case.rigid.iter().any(|body| body.friction > 0.0) {
        // What stops is what the state became in steps too coarse, not how far the step goes.
        lines.push("Use several times as many steps from the start, as a rough rigid body needs short steps.".into());
    }
    if *iterations >= criteria.max_iterations {
        lines.push(format!(
            "Increase `solver.max_iterations` (now {}), if the residuals still fell.",
            criteria.max_iterations
        ));
    }
    if *force < criteria.force {
        lines.push(format!(
            "The forces balance, but much of the soil yields. Increase `analysis.steps`, or `solver.tolerance` (now {:e}).",
            criteria.energy
        ));
    }
    // The force measure is that of this material.
    if let (true, Some(number)) = (*force >= criteria.force, *material) {
        let name = &case.materials[number].name;
        lines.push(format!(
            "Look at the body of `material.{name}`: its forces do not balance."
        ));
    }
    lines.extend(
        [
            "The load may exceed the strength. Look at the last frame, and run `bsmpm fos`.",
            "Look at the worst nodes. Next to nearly empty cells a larger `solver.background` helps.",
            "Increase `analysis.steps`, or set `stabilisation.method`, if the soil is nearly incompressible or yields.",
        ]
        .map(str::to_owned),
    );
    lines
}
