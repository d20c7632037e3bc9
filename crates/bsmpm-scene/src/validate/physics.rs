//! Checks supports and doubtful combinations in the whole case.

use super::place;
use super::rigid;
use super::site::{normal_of, places};
use super::strip::{moves, with_body};
use crate::case::{ActiveLoads, Base, Body, Case, Geometry, Initial, Site, Support};
use crate::constants::NEARLY_INCOMPRESSIBLE;
use crate::observables::{HistorySubject, Observable};
use crate::record::{CaseTable, KeyPlace};
use crate::report::Report;
use crate::schema::{Draft, SupportTable};
use crate::words::{AnalysisType, Side, Word};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::dynamics::newmark::Newmark;
use bsmpm::field::pore_water::flow::Given;
use bsmpm::material::{LayeredMaterial, Material};
use bsmpm::model::Regime;
use bsmpm::model::WallVelocity;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

/// Components of a normal below which it does not hold them.
pub(super) const ALONG: f64 = 1e-9;
/// Cosine of the slope up to which a strip lies on the ground beneath it; steeper it holds the ground beside it.
const LEVEL: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Errors and warnings about a case that is valid in its parts.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if case.analysis.regime == Regime::QuasiStatic {
        held(case, draft, report);
    }
    absorbed(case, draft, report);
    shaken(case, report);
    thrown_back(case, report);
    too_soon(case, draft, report);
    stressed(case, draft, report);
    timed(case, draft, report);
    warn_of_materials(case, report);
    if case.stabilisation == Stabilisation::None && !draft.stabilisation.is_given() {
        warn_of_locking(case, report);
    }
}

/// Times that lie so near to the start that no step ends there.
fn too_soon(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let least = 1e-6 * case.analysis.dt;
    if let (Some(time), Some(output)) = (case.output.times.first(), draft.output.value())
        && *time <= least
    {
        output.times.error(too_close_to_start(*time, least), report);
    }
    for (check, record) in case.checks.iter().zip(draft.check.items()) {
        if check.at <= least {
            record.at.error(too_close_to_start(check.at, least), report);
        }
    }
}

/// Says that a time is below the `least` one at which a step ends.
fn too_close_to_start(time: f64, least: f64) -> String {
    format!(
        "E0664: the time t = {time:e} is too close to the start (t = 0), so no step ends there. Use a time above \
         {least:e}."
    )
}

/// Material that has no state without stress begins with one, and the weight above it gives that.
fn stressed(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for (number, (name, written)) in draft.material.items().iter().enumerate() {
        let named = &case.materials[number];
        let is_made = case.bodies.iter().any(|body| body.material == number);
        if named.material.is_linear() || !is_made {
            continue;
        }
        if !matches!(case.initial, Some(Initial::AtRest(_))) {
            let message = "E0318: the stiffness of this model depends on the stress, so the case needs initial \
                 stresses. Add [initial] with `k0`. Do not give initial.gravity, which starts from zero stress.";
            written.model.error(message, report);
        } else if named.density.is_none() {
            let message = format!(
                "E0310: material.{name} has no weight, so its initial stress and its stiffness would be zero. Add \
                 `unit_weight` or `density`."
            );
            written.location().error(message, report);
        }
    }
}

/// Plastic strain of a step above which its logarithm is found to 1e-9 (`tests/material/softening.rs` of `bsmpm`).
const DIGITS: f64 = 5e-14;

/// A rate needs real time, which a quasi-static analysis does not have.
fn timed(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let named = case.materials.iter().zip(draft.material.items()).enumerate();
    for (_, (named, (_, written))) in named.filter(|(number, _)| case.is_followed(*number)) {
        let kind = case.analysis.kind;
        let is_of_clay = written.rate_parameter.is_given();
        let is_timed = kind == AnalysisType::Dynamic || kind == AnalysisType::InTime && is_of_clay;
        if !is_timed && named.material.with_time_step(1.0).is_some() {
            let message = match (kind, is_of_clay) {
                (AnalysisType::Consolidation, true) => {
                    "E0319: a rate-dependent strength is not available in a consolidation analysis. Remove \
                     `rate_parameter` and `reference_rate`."
                }
                (_, true) => {
                    "E0319: a rate-dependent strength needs real time, which a quasi-static analysis does not have. \
                     Use type = \"quasi-static-rate\" or \"dynamic\", or remove `rate_parameter` and \
                     `reference_rate`."
                }
                (_, false) => {
                    "E0319: the strength of this model depends on the strain rate, which needs a dynamic analysis. \
                     Use analysis.type = \"dynamic\"."
                }
            };
            let key: &KeyPlace = match is_of_clay {
                true => &written.rate_parameter,
                false => &written.model,
            };
            key.error(message, report);
        }
        let slowest = written
            .reference_rate
            .get()
            .filter(|_| is_of_clay)
            .map(|rate| rate * case.analysis.dt);
        if let Some(strain) = slowest.filter(|strain| *strain < DIGITS) {
            report.warn(format!(
                "W0312: {}: the strain of one step at this rate is {strain:.1e} (at least {DIGITS:e}), so the \
                 strength is inaccurate. Increase `reference_rate`, and give the cohesion measured at the new rate.",
                written.reference_rate.path()
            ));
        }
    }
}

/// A quasi-static body that nothing holds against a translation has no equilibrium: the stiffness is singular.
fn held(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let free: Vec<&str> = (0..case.grid.dims())
        .filter(|&axis| !holds(case, axis))
        .map(|axis| ["x", "y", "z"][axis])
        .collect();
    if free.is_empty() {
        return;
    }
    let reached: Vec<String> = (0..case.grid.dims())
        .flat_map(|axis| [(axis, false), (axis, true)])
        .filter(|&(axis, upper)| reached(case, axis, upper))
        .map(|(axis, upper)| Side::of(case.geometry)[axis][usize::from(upper)].to_string())
        .collect();
    let remedy = match reached.iter().find(|name| *name == "bottom").or(reached.first()) {
        Some(name) => {
            format!(
                "In [boundary], set {name} = \"fixed\" (the bodies reach: {}).",
                reached.join(", ")
            )
        }
        None => "Extend a body to a boundary of the grid, and set that boundary to \"fixed\".".to_owned(),
    };
    let message = format!(
        "E0270: no support restrains the bodies along {}, so a quasi-static analysis has no solution. {remedy}",
        free.join(" and ")
    );
    report.error(draft.boundary.origin(), "boundary", message);
}

/// Faces that absorb hold nothing but what `[initial]` has found there; beside ground that shakes they would hold back.
fn absorbed(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let Some(boundary) = draft.boundary.value() else {
        return;
    };
    for (axis, upper) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        if !matches!(case.boundary[axis][upper], Support::Absorbing | Support::FreeField) {
            continue;
        }
        let face = boundary.face(Side::ALL[axis][upper]);
        let mut refuse = |message: &str| face.error(message, report);
        if case.analysis.regime == Regime::QuasiStatic {
            refuse(
                "E0671: an absorbing boundary reacts to velocities, but a quasi-static analysis has none, so the \
                 boundary would support nothing. Use \"fixed\" or \"roller\".",
            );
        }
        if case.gravity.is_some() && case.initial.is_none() {
            refuse(
                "E0672: without initial stresses an absorbing boundary carries no weight, so the ground would sink \
                 through the boundary. Add [initial].",
            );
        }
        if case.boundary[1 - axis].contains(&Support::Contact) {
            refuse(
                "E0673: this absorbing boundary shares a corner with a boundary in contact, and the corner would be \
                 constrained twice. Make the boundary in contact \"fixed\" or \"absorbing\".",
            );
        }
        let absorbs = case.boundary[axis][upper] == Support::Absorbing;
        if absorbs && axis == 0 && case.shaking.iter().any(|(_, ground)| *ground != [0.0; 3]) {
            refuse(
                "E0674: in an earthquake the ground moves horizontally, and an absorbing side would resist this \
                 motion. Use \"free-field\".",
            );
        }
    }
}

/// Bodies that do not go along with the ground drift away in its frame.
fn shaken(case: &Case, report: &mut Report<'_>) {
    for (component, name) in ["x", "y", "z"].into_iter().enumerate() {
        if case.shaking.iter().any(|(_, ground)| ground[component] != 0.0) && !holds(case, component) {
            report.warn(format!(
                "W0670: shaking: the base moves along {name}, but no boundary supports the ground along {name}, so \
                 the ground does not follow the base. Make a side \"fixed\", usually the bottom."
            ));
        }
    }
}

/// Crossings of a body by a wave in a step up to which no energy was made at a face in contact: none at 1.3, some at
/// 2.6.
const MOST_CROSSINGS: f64 = 2.0;

/// What meets a face in contact stops at the face's nodes first; in a step in which waves cross the whole body
/// Newmark's formula throws the rest of it back with energy that it did not have.
fn thrown_back(case: &Case, report: &mut Report<'_>) {
    let meets = case.is_ever(Support::Contact);
    let dynamic = case.analysis.regime == Regime::Dynamic;
    let times = case
        .bodies
        .iter()
        .filter_map(|body| Some((crossing_time(case, body)?, &case.materials[body.material].name)));
    let shortest = times.min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((time, name)) = shortest.filter(|(time, _)| meets && dynamic && MOST_CROSSINGS * *time < case.analysis.dt)
    else {
        return;
    };
    if case.analysis.newmark == Newmark::of_gamma(1.0) {
        return;
    }
    report.warn(format!(
        "W0671: analysis.dt: in a step of {:.3e} s a wave crosses the body of material {name} more than \
         {MOST_CROSSINGS} times (once in {time:.3e} s), so impacts create energy. Use dt = {:.1e} s or less.",
        case.analysis.dt,
        MOST_CROSSINGS * time
    ));
}

/// Time in which a wave crosses a body where it is thinnest, s; `None` without density.
fn crossing_time(case: &Case, body: &Body) -> Option<f64> {
    let named = &case.materials[body.material];
    let [lower, upper] = body.region.corners();
    let dims = case.grid.dims();
    let thickness = (0..dims)
        .map(|axis| upper[axis] - lower[axis])
        .fold(f64::INFINITY, f64::min);
    let vertical = dims - 1;
    let heights = [lower, upper].map(|corner| named.material.young_at(corner[vertical] - case.grid.lower()[vertical]));
    let poisson = named.material.elastic().poisson;
    let stiffness = heights[0].max(heights[1]) * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    Some(thickness * (named.density? / stiffness).sqrt())
}

/// Whether a face, a strip or a prescribed motion holds a component of a body.
fn holds(case: &Case, component: usize) -> bool {
    holds_at_rest(case, component, None) || (0..2).any(|axis| absorbs(case, axis, false) || absorbs(case, axis, true))
}

/// Whether a face that a body reaches absorbs its waves.
fn absorbs(case: &Case, axis: usize, upper: bool) -> bool {
    let support = case.boundary[axis][usize::from(upper)];
    matches!(support, Support::Absorbing | Support::FreeField) && reached(case, axis, upper)
}

/// Finds what lies on the ground at the start: the footing, and what material comes off, have no part in an equilibrium
/// without motion, in which the ground would hang from them. What else is prescribed may be what a body hangs from.
pub(super) fn rest(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    let Some(down) = case.gravity.as_ref().map(|gravity| Vector::from(gravity.acceleration)) else {
        return;
    };
    let bodies: Vec<&Body> = case.bodies_at_start().collect();
    let footing = case
        .footing
        .as_ref()
        .is_some_and(|footing| lies_on_ground(case, footing.site, down, &bodies));
    let prescribed: Vec<bool> = case
        .prescribed
        .iter()
        .map(|of| lies_on_ground(case, of.site, down, &bodies))
        .collect();
    // What else would not stand it holds at the start, too.
    let stands = (0..case.grid.dims()).all(|axis| holds_at_rest(case, axis, Some(ActiveLoads::Strip(0))));
    case.footing.iter_mut().for_each(|of| of.rests = footing && stands);
    let is_sought = case.settles || case.initial == Some(Initial::Elastic);
    if footing && !stands && is_sought {
        report.warn(
            "W0672: footing: in the initial equilibrium the footing carries the ground in tension, because nothing \
             else supports the ground. Fix a side, or activate the footing in a [[stage]].",
        );
    }
    for (number, (record, lies)) in draft.prescribed.items().iter().zip(prescribed).enumerate() {
        let lifts = case.prescribed[number].contact.is_some_and(|contact| contact.law.lifts);
        case.prescribed[number].rests = lies && lifts;
        let strip = ActiveLoads::Strip(number + usize::from(case.footing.is_some()));
        if lies && !lifts && is_sought && case.acts_since(strip, 0.0).is_some() {
            report.warn(format!(
                "W0672: {}: in the initial equilibrium this prescribed motion carries a part of the ground in \
                 tension, so the initial stresses are wrong. Activate the motion in a [[stage]], or use [footing].",
                record.location().path
            ));
        }
    }
}

/// Whether a strip lies level on one of the bodies, seen along gravity (m/s2), and not beneath them.
fn lies_on_ground(case: &Case, site: Site, gravity: Vector<3>, bodies: &[&Body]) -> bool {
    let along = Vector::<3>::from(normal_of(site)).dot(&gravity) / gravity.norm();
    let side = along.signum();
    along.abs() > LEVEL
        && place::beside(&case.grid, |off| with_body(site, side * off, &case.grid, bodies))
            .is_some_and(|[below, above]| 2 * below >= above.max(1))
}

/// Whether something other than `except` holds a component of a body for as long as that takes.
pub(super) fn holds_at_rest(case: &Case, component: usize, except: Option<ActiveLoads>) -> bool {
    // All around an axis no body goes along the radius as a whole.
    if case.geometry == Geometry::Axisymmetric && component == 0 {
        return true;
    }
    let mut faces = (0..case.grid.dims()).flat_map(|axis| [(axis, false), (axis, true)]);
    faces.any(|(axis, upper)| face_holds(case, axis, upper, component) && reached(case, axis, upper))
        || held_by_strip(case, component, except)
        || rigid::hold(case, component, except)
}

/// Whether a face holds a component of a body at it for as long as that takes.
fn face_holds(case: &Case, axis: usize, upper: bool, component: usize) -> bool {
    match case.boundary[axis][usize::from(upper)] {
        Support::Fixed => true,
        Support::Roller => axis == component,
        Support::Contact => {
            let has_friction = case.contacts[axis][usize::from(upper)].is_some_and(|contact| contact.friction > 0.0);
            axis == component || has_friction
        }
        Support::Absorbing | Support::FreeField | Support::Free | Support::Outflow => false,
    }
}

/// Whether the footing or a prescribed motion other than `except` holds a component of a body.
fn held_by_strip(case: &Case, component: usize, except: Option<ActiveLoads>) -> bool {
    let footing = case.footing.iter().map(|footing| (footing.base, footing.site));
    let all = footing.chain(
        case.prescribed
            .iter()
            .map(|prescribed| (prescribed.base, prescribed.site)),
    );
    all.enumerate().any(|(number, (base, site))| {
        Some(ActiveLoads::Strip(number)) != except && strip_holds(case, base, site, component)
    })
}

/// Whether a strip holds a component of a body at it.
fn strip_holds(case: &Case, base: Base, site: Site, component: usize) -> bool {
    let holds = base == Base::Rough || normal_of(site)[component].abs() > ALONG;
    holds
        && match site {
            Site::Face(face) => reached(case, face.axis, face.upper),
            Site::Segment { .. } | Site::Plate(_) => places(site, &case.grid)
                .into_iter()
                .any(|at| place::is_at(&case.bodies, &case.grid, at)),
        }
}

/// Chooses the velocities near fixed faces of material that flows, where they are not given, and recommends a measure
/// of its run-out. With the points' own velocities and lumped mass the front runs out a third too far.
pub(super) fn walls(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    let mut named = case.materials.iter().enumerate();
    let flows = named.any(|(number, named)| {
        matches!(named.material, LayeredMaterial::Uniform(Material::MuI(_))) && case.is_followed(number)
    });
    if !flows || case.analysis.regime != Regime::Dynamic || !case.boundary.as_flattened().contains(&Support::Fixed) {
        return;
    }
    let mut quantities = case.histories.iter().map(|history| &history.quantity);
    let records_percentile =
        quantities.any(|of| matches!(of.subject, HistorySubject::Percentile { percentile, .. } if percentile < 100.0));
    let mut observables = case.histories.iter().map(|history| history.quantity.observable);
    let records_front = observables.any(|observable| observable == Observable::Front);
    if records_front && !records_percentile {
        let reason = "a front thinner than a cell runs ahead by 10 to 20 % of the run-out; quantity = \"runout\" with \
                      percentile = 99 is more accurate";
        report.note(draft.history.path(), Observable::Front.word(), reason);
    }
    let given = draft
        .analysis
        .value()
        .is_some_and(|analysis| analysis.wall_velocity.is_given());
    if given || case.analysis.mass != MassMatrix::Lumped {
        return;
    }
    case.analysis.wall_velocity = WallVelocity::Relaxed;
    let reason = "granular flow along a fixed boundary: velocities near it follow the motion of the grid";
    report.note("analysis.wall_velocity", WallVelocity::Relaxed.word(), reason);
}

/// Whether a body reaches into the cells along a face, and so has nodes on it.
pub(super) fn reached(case: &Case, axis: usize, upper: bool) -> bool {
    let count = case.grid.axes[axis].cells();
    case.bodies.iter().any(|body| {
        let cells = &body.occupied(&case.grid)[axis];
        if upper { cells.end == count } else { cells.start == 0 }
    })
}

fn warn_of_materials(case: &Case, report: &mut Report<'_>) {
    for (_, material) in case
        .materials
        .iter()
        .enumerate()
        .filter(|(number, _)| !case.is_followed(*number))
    {
        report.warn(format!(
            "W0313: material.{}: no body consists of this material. Assign the material to a body, or remove the \
             material.",
            material.name
        ));
    }
    let weighs = case
        .bodies
        .iter()
        .any(|body| case.materials[body.material].density.is_some());
    if case.gravity.is_some() && !weighs && case.rigid.iter().all(|rigid| rigid.mass == [0.0; 2]) {
        report.warn(
            "W0314: gravity: no body has mass, so gravity has no effect. Add `unit_weight` to the materials, or \
             remove [gravity].",
        );
    }
    let dynamic = case.analysis.regime == Regime::Dynamic;
    if dynamic && case.analysis.mass == MassMatrix::Lumped && case.rotates_at_start() {
        report.warn(
            "W0673: analysis.mass: bodies rotate at the start, and the lumped mass matrix slows the rotation. Use \
             mass = \"consistent\".",
        );
    }
    if case.analysis.regime == Regime::QuasiStatic && !loaded(case) {
        report.warn(
            "W0674: the case has no load (gravity, force, pressure or prescribed motion), so all results will be 0. \
             Add a load, for example the table [gravity] with acceleration = [0, -9.81] (in 3-D [0, 0, -9.81]).",
        );
    }
}

fn loaded(case: &Case) -> bool {
    let mut flows = case.flow.iter();
    let mut drains = case.flow.iter().flat_map(|flow| &flow.drains);
    case.gravity.is_some()
        || !case.shaking.is_empty()
        || case
            .rigid
            .iter()
            .any(|rigid| !rigid.path.rows.is_empty() || rigid.free.contains(&true))
        || case.footing.iter().any(|footing| moves(&footing.path))
        || case.prescribed.iter().any(|prescribed| moves(&prescribed.path))
        || case.tractions.iter().any(|traction| traction.largest() > 0.0)
        || case.point_loads.iter().any(|load| load.force != [0.0; 3])
        || flows.any(|flow| !flow.inflows.is_empty())
        || drains.any(|drain| !matches!(drain.given, Given::StillWater | Given::Seepage))
}

fn warn_of_locking(case: &Case, report: &mut Report<'_>) {
    for body in &case.bodies {
        let named = &case.materials[body.material];
        let poisson = named.material.elastic().poisson;
        let reason = match named.material.yields() {
            true => "yields".to_owned(),
            false if poisson > NEARLY_INCOMPRESSIBLE => {
                format!("has poisson = {poisson}, above {NEARLY_INCOMPRESSIBLE}")
            }
            false => continue,
        };
        report.warn(format!(
            "W0315: stabilisation: material.{} {reason}, so without stabilisation it is too stiff (locking) and its \
             stress oscillates. Set stabilisation.method = \"consistent-f-bar\".",
            named.name
        ));
        return;
    }
}
