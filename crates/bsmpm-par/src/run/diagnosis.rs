//! What is told of a step that failed: where it was worst on all ranks, and what may help.

use bsmpm::control::Failure;
use bsmpm::error::{SolveError, StepError};
use bsmpm::material::Material;
use bsmpm::method::Criteria;
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_io::failure::{FailureMeasures, FailureReport};
use bsmpm_io::manifest::Worst;
use bsmpm_messages::code_of;
use bsmpm_scene::{Body, Case, GridSpec, Initial};
use mpi::topology::{Communicator, SimpleCommunicator};
use mpi::traits::CommunicatorCollectives;

/// Places told of one failure.
const MOST_PLACES: usize = 10;

/// The report of `failure` in step `step` of a case, from all ranks. Collective.
pub(super) fn of(world: &SimpleCommunicator, failure: &Failure, step: u64, case: &Case) -> FailureReport {
    let last = failure.attempts.last();
    // The last attempt may have ended before it iterated; all ranks have the same kinds of errors.
    let iterated = |error: &&StepError| matches!(error, StepError::NotConverged { .. });
    let iterated = failure.attempts.iter().rev().find(iterated);
    let (history, tolerances) = match iterated {
        Some(StepError::NotConverged { history, criteria, .. }) => (
            history.iter().map(|m| FailureMeasures::new(m.energy, m.force)).collect(),
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
        loose: last.and_then(|error| loose(error, case)),
        advice: last.map_or_else(Vec::new, |error| [implausible(case), advice(error, case)].concat()),
    }
}

/// The name of the rigid body that nothing holds, if that is the error.
fn loose(error: &StepError, case: &Case) -> Option<String> {
    let StepError::Loose { body } = error else { return None };
    case.rigid.get(*body).map(|rigid| rigid.name.clone())
}

/// The error whose places are told: the last one, or where that names none the last that iterated.
fn places_of<'a>(last: &'a StepError, iterated: Option<&'a StepError>) -> &'a StepError {
    if matches!(last, StepError::Solve(_)) { iterated.unwrap_or(last) } else { last }
}

/// Order among the places, number, force or 0, x, y and z.
type NodePlace = [f64; 6];

/// The nodes whose forces are the least balanced, or the points that the ranks name, of all ranks.
fn worst(world: &SimpleCommunicator, error: &StepError, grid: &GridSpec) -> Vec<Worst> {
    let (lower, dims) = (grid.lower(), grid.dims());
    let kind =
        if matches!(error, StepError::NotConverged { .. } | StepError::Unbalanced { .. }) { "node" } else { "point" };
    let at = |x: &[f64]| -> [f64; 3] { std::array::from_fn(|axis| lower[axis] + x.get(axis).copied().unwrap_or(0.0)) };
    let mut own: Vec<NodePlace> = match error {
        StepError::NotConverged { worst, .. } | StepError::Unbalanced { worst, .. } => worst
            .iter()
            .map(|node| {
                let [x, y, z] = at(&node.x);
                [-node.force, node.number as f64, node.force, x, y, z]
            })
            .collect(),
        other => other
            .point()
            .map(|(id, x)| {
                let [x, y, z] = at(x);
                [id as f64, id as f64, 0.0, x, y, z]
            })
            .into_iter()
            .collect(),
    };
    own.resize(MOST_PLACES, [f64::INFINITY; 6]);
    let own: Vec<f64> = own.into_iter().flatten().collect();
    let mut all = vec![0.0_f64; own.len() * world.size().unsigned_abs() as usize];
    world.all_gather_into(&own[..], &mut all[..]);
    let mut places: Vec<&[f64]> = all.chunks_exact(6).filter(|place| place.iter().all(|n| n.is_finite())).collect();
    places.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let told = |place: &&[f64]| Worst {
        kind: kind.into(),
        id: place[1] as u64,
        position: place[3..3 + dims].to_vec(),
        force: (kind == "node").then_some(place[2]),
    };
    places.iter().take(MOST_PLACES).map(told).collect()
}

fn advice(error: &StepError, case: &Case) -> Vec<String> {
    let lines: &[&str] = match error {
        StepError::NotConverged { iterations, energy, force, material, criteria, .. } => {
            let name = material.map(|number| case.materials[number].name.as_str());
            return not_converged(*iterations, (*energy, *force), name, criteria, case);
        }
        StepError::Closed { .. } => &[
            "a larger porosity of the soil, or a stiffer one: its grains keep their volume, and the skeleton is pressed into them",
            "a permeability that follows the porosity (permeability_law = \"kozeny-carman\"), and shorter steps",
        ],
        StepError::Unstable { .. } => &[
            "nearly incompressible material under a pressure of several times its shear modulus: more points_per_cell",
            "where the body itself buckles, a dynamic analysis follows it",
        ],
        StepError::EnergyMade { .. } => &[
            match case.stabilisation {
                Stabilisation::None => "a smaller [analysis] dt",
                Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => {
                    "stabilisation.method = \"none\": where material flows without strength or dilates, every F-bar \
                     method makes some energy"
                }
                Stabilisation::FBar | Stabilisation::FBarZhao | Stabilisation::ModifiedFBar => {
                    "another [stabilisation]: f-bar, modified-f-bar and f-bar-zhao make energy where material flows \
                     without strength or dilates, consistent-f-bar less, none none"
                }
            },
            "where bodies meet a face in contact: shorter steps, or [analysis] newmark_gamma = 1",
            "a smaller dilation, or some friction; see where it begins: [[history]] quantity = \"energy\", and the frames",
            "the state that is saved is wrong, too: do not go on from it",
        ],
        StepError::Unsettled { .. } => &[
            "more steps ([analysis] steps or dt), so that less changes at the face in each",
            "a smaller friction of the face in [boundary]: from about 1 on there may be no state, or several, that agree with it",
        ],
        StepError::Unbalanced { .. } => &[
            "points_per_cell = 3 or more, or a face of half a cell, where the body ends in a point at the place named: two \
             points there cannot hold what a cell with next to no material carries",
            "where much of the body yields it may not stand at all: gravity with a ramp and no [initial] lets it yield as it \
             is loaded",
            "a larger [solver] force_tolerance",
        ],
        StepError::Loose { body } => {
            let rigid = &case.rigid[*body];
            let cause = match rigid.friction > 0.0 {
                true => format!(
                    "its friction (friction_coefficient = {}) is fully mobilised, or it does not touch the soil",
                    rigid.friction
                ),
                false => "it has no friction, or does not touch the soil".to_owned(),
            };
            return vec![format!(
                "rigid `{}` slides or falls: {cause}. Reduce its force, increase friction_coefficient, leave that motion out of \
                 `free`, or make the analysis dynamic",
                rigid.name
            )];
        }
        StepError::Overlapping { bodies } => {
            let [one, other] = bodies.map(|number| case.rigid[number].name.as_str());
            return vec![format!(
                "keep rigid `{one}` and rigid `{other}` apart, as rigid bodies do not touch each other: change their paths, \
                 end the analysis before they meet, or make them one polygon"
            )];
        }
        StepError::Inverted { .. } => &[
            "material turned inside out: more steps ([analysis] steps or dt), or a larger [solver] background",
            "look at the points named: loose points at a free surface are the usual ones",
        ],
        StepError::Left { .. } | StepError::Outside { .. } => &[
            "a larger grid, or a support at the face where points left; steps down to 1/1024 threw them out as well",
            "where material shall leave: [boundary] \"outflow\" there; what a strip or load is at stays",
        ],
        StepError::Emptied { .. } => &[
            "an [analysis] end before this time: nothing is left to compute, and the saved state is the last one with material",
            "a larger grid, if it was to be followed farther",
        ],
        StepError::Unloaded { .. } => {
            &["a load or strip has no material any more: look where it was in the last frame"]
        }
        StepError::Undrained { .. } => &[
            "drains and inflows belong where the soil at the surface has a permeability: in a part of it that has none \
             nothing flows",
        ],
        StepError::Solve(SolveError::Failed(_)) if starts_at_rest(case) && case.solver.background == 0.0 => &[
            "[solver] background = 1e-4: in the state at rest no inertia holds nearly empty cells, and an iteration does not \
             come to an end with them",
            "[solver] linear = \"direct\"",
        ],
        StepError::Solve(SolveError::Failed(_) | SolveError::NotFinite | SolveError::Residual(_)) => &[
            "is every body held? In a quasi-static analysis nothing else stops a rigid motion",
            "another factorisation: [solver] linear = { factor = \"mumps\" }, and a larger [solver] background",
        ],
        StepError::Material { .. } | StepError::OtherRank => &["more steps ([analysis] steps or dt)"],
        StepError::Interrupted => &[],
    };
    lines.iter().map(|line| (*line).to_owned()).collect()
}

/// Whether equilibrium is sought before the first step.
fn starts_at_rest(case: &Case) -> bool {
    case.settles || case.initial == Some(Initial::Elastic)
}

/// What the case was warned of as probably not meant: it may well be why a step fails.
fn implausible(case: &Case) -> Vec<String> {
    let is_slip = |warning: &&String| code_of(warning).is_some_and(|code| code.starts_with("W01"));
    case.warnings.iter().filter(is_slip).map(|warning| format!("heed the warning at the start, {warning}")).collect()
}

/// What helps where soil without cohesion has a free surface that its weight alone brings to failure.
fn against_local_failure(case: &Case) -> Option<String> {
    let is_without = |body: &&Body| cohesion(&case.materials[body.material].material) == Some(0.0);
    let body = case.bodies.iter().find(is_without)?;
    let is_at_rest = case.analysis.regime == Regime::QuasiStatic && !case.has_prescribed_motion();
    (is_at_rest && case.gravity.is_some()).then(|| {
        format!(
            "material.{} has no cohesion: a free surface as steep as its friction angle, and the toe of a slope, fail under \
             their own weight. Give it a small cohesion, such as \"0.1 kPa\", or make the slope flatter",
            case.materials[body.material].name
        )
    })
}

/// What helps where something is pushed into soil without cohesion. A footing on sand with a friction angle of 40 and a
/// dilation angle of 10 degrees ended with 80 whatever the background, with four times as many steps, and with a
/// cohesion of 0.1 and 1 kPa; with the purpose it found its limit load.
fn against_no_cohesion(case: &Case) -> Option<String> {
    let is_without = |body: &&Body| cohesion(&case.materials[body.material].material) == Some(0.0);
    let body = case.bodies.iter().find(is_without)?;
    if case.analysis.regime != Regime::QuasiStatic || !case.has_prescribed_motion() {
        return None;
    }
    let cause = format!(
        "material.{} has no cohesion, so that at the edge of what moves, next to the free surface, it has no strength",
        case.materials[body.material].name
    );
    match case.limit_load {
        None => Some(format!("analysis.purpose = \"limit-load\", where the limit load is sought: {cause}")),
        Some(_) if case.solver.background == 0.0 => Some(format!("leave solver.background to the purpose: {cause}")),
        Some(_) => None,
    }
}

/// Pa  Cohesion of a law that has one.
fn cohesion(material: &Material) -> Option<f64> {
    let material = material.at(0.0);
    let number = material.parameter_names().iter().position(|variable| variable.name == "cohesion")?;
    material.parameters().get(number).copied()
}

/// What to try where both measures did not fall below their tolerances; `material`: the one that the force measure is
/// of.
fn not_converged(
    iterations: usize,
    (energy, force): (f64, f64),
    material: Option<&str>,
    criteria: &Criteria,
    case: &Case,
) -> Vec<String> {
    let mut lines: Vec<String> = against_no_cohesion(case).into_iter().chain(against_local_failure(case)).collect();
    if case.rigid.iter().any(|body| body.friction > 0.0) {
        // What stops is what the state became in steps too coarse, not how far the step goes (`boundary/rigid.md`).
        lines.push(
            "several times as many steps from the start: a rough rigid body in soil that yields may stop where with shorter \
             steps it goes on"
                .into(),
        );
    }
    if iterations >= criteria.max_iterations {
        lines.push(format!(
            "a larger [solver] max_iterations than {}, if the measures still fell",
            criteria.max_iterations
        ));
    }
    if force < criteria.force {
        lines.push(format!(
            "more steps, or a [solver] tolerance above the {:e} of now: forces balance within force_tolerance = {:e}, but each \
             direction still works (energy measure {energy:.1e}), as where the body yields as a whole",
            criteria.energy, criteria.force
        ));
    }
    if let (true, Some(name)) = (force >= criteria.force, material) {
        lines.push(format!(
            "look at the body of \"{name}\": its forces alone do not balance within [solver] force_tolerance = {:e}",
            criteria.force
        ));
    }
    lines.extend(
        [
            "the load may be more than the body can carry: look at the displacements of the last frame, and at `bsmpm fos`",
            "look at the worst nodes: next to nearly empty cells a larger [solver] background helps",
            "more steps ([analysis] steps or dt), or a [stabilisation] where poisson is above .45 or the soil yields",
        ]
        .map(str::to_owned),
    );
    lines
}
