//! Checks the rules between keys of a case, and makes the valid [`Case`](crate::Case).

mod approach;
mod axisymmetric;
mod body;
mod course;
mod domain;
mod element;
mod flow;
mod free_field;
mod gap;
mod grid;
mod history;
mod initial;
mod lasting;
mod leaving;
mod limit_load;
mod lines;
mod load;
mod material;
mod meeting;
mod opening;
mod output;
mod physics;
mod place;
mod plausible;
mod profile;
mod ratio;
mod reduction;
mod rigid;
mod section;
mod shape;
mod sheet;
mod side;
mod site;
mod solid;
mod solver;
mod stage;
mod strip;
mod touching;
mod uplift;
mod water;
mod waves;

pub use flow::HELD_WATER;

use crate::case::{Analysis, Case, Gravity, Support};
use crate::constants::STANDARD_GRAVITY;
use crate::record::{CaseTable, Field, OrTable};
use crate::report::Report;
use crate::schema::{AnalysisTable, Draft, SupportTable};
use crate::words::{AnalysisType, Geometry, Side};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::dynamics::newmark::Newmark;
use bsmpm::interactions::coulomb::Contact;
use bsmpm::model::Regime;
use bsmpm::model::WallVelocity;
use bsmpm::stabilisation::Stabilisation;
use domain::{Domain, Loads, Structures};

/// Coefficient of friction up to which faces and strips in contact were verified.
const MOST_SHOWN_FRICTION: f64 = 1.0;
/// Steps of a run at most.
const MOST_STEPS: f64 = 1e9;
/// Of a key that belongs to dynamics, in an analysis of another type.
const NO_INERTIA: &str = "E0218: this key needs inertia, which only a dynamic analysis has. Delete the key, or use \
                          analysis.type = \"dynamic\".";
/// Relative difference from it that the rounded components of an inclined gravity may have.
const NEARLY_STANDARD: f64 = 1e-6;
pub(crate) use site::normal_of as normal_of_site;

/// Longest edge over the shortest one of cells that count as squares of one size.
pub(crate) const SQUARE: f64 = 1.01;

/// What a case is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CaseUse {
    /// A run.
    Run,
    /// Tests of one material point.
    ElementTests,
}

/// The case that `record` describes; `text` is what was read. `None` after an error.
pub(crate) fn case(draft: &Draft, text: String, case_use: CaseUse, report: &mut Report<'_>) -> Option<Case> {
    solid::refuse(draft, report);
    let (mut case, stiffness) = read(draft, text, report)?;
    if report.failed() {
        return None;
    }
    if case_use == CaseUse::ElementTests {
        return Some(case);
    }
    check(&mut case, draft, stiffness, report);
    Some(Case {
        renamings: report.take_renamings(),
        warnings: report.take_warnings(),
        notes: std::mem::take(&mut report.notes),
        ..case
    })
}

/// The case as its tables describe it, and by which Young's moduli were multiplied.
fn read(draft: &Draft, text: String, report: &mut Report<'_>) -> Option<(Case, f64)> {
    let domain = Domain::read(draft, report);
    let grid = domain.grid.as_ref();
    let regime = domain.regime;
    let end = domain.end();
    let gravity = gravity(draft, regime, end, report);
    let water = water::read(draft, grid, gravity.as_ref(), regime, end, report);
    let times = domain.analysis.as_ref().map(|analysis| (analysis.end, analysis.dt));
    let shaking = load::shaking(draft, regime, times, report);
    let mut structures = Structures::read(draft, &domain, report);
    let materials = domain.materials(draft, structures.stiffness, report);
    let made = materials.as_deref();
    let flow = flow::read(draft, made, domain.around(), domain.stages.as_deref(), report);
    let loads = Loads::read(draft, &domain, made, gravity, &mut structures.rigid, report);
    let stabilisation = stabilisation(draft);
    let solver = solver::read(draft, regime, grid, made, report);
    let output = output::read(draft, end, report);
    let histories = history::read_all(draft, regime, grid, domain.bodies_of(made), report);
    let profiles = profile::read_all(draft, regime, grid, end, report);
    let checks = history::checks(draft, &histories, end, report);
    let elements = element::read_all(draft, made, grid, report);
    let case = Case {
        title: draft.title.value().cloned().unwrap_or_default(),
        geometry: draft.geometry.get()?,
        analysis: domain.analysis?,
        grid: domain.grid?,
        materials: materials?,
        bodies: domain.bodies?,
        stages: domain.stages?,
        gravity: loads.gravity,
        water,
        flow: flow?,
        shaking,
        boundary: domain.boundary?,
        contacts: domain.contacts?,
        footing: structures.footing,
        prescribed: structures.prescribed,
        rigid: structures.rigid,
        tractions: loads.tractions,
        point_loads: loads.point_loads,
        strength_reduction: domain.factor,
        settles: loads.initial.is_some() && initial::settles(draft),
        initial: loads.initial,
        stabilisation: stabilisation?,
        solver: solver?,
        output: output?,
        histories,
        profiles,
        limit_load: None,
        opening: None,
        checks,
        elements,
        warnings: Vec::new(),
        renamings: Vec::new(),
        notes: Vec::new(),
        text,
    };
    Some((case, structures.stiffness))
}

/// Checks the rules between the parts of a case, and completes those that depend on others.
fn check(case: &mut Case, draft: &Draft, stiffness: f64, report: &mut Report<'_>) {
    waves::choose_mass(case, draft, report);
    side::of_pressures(case, draft, report);
    body::warn_of_overlap(case, report);
    gap::check(case, report);
    approach::check(case, report);
    plausible::check(case, draft, report);
    solver::of_case(case, draft, report);
    physics::walls(case, draft, report);
    solver::warn_of_background(case, report);
    solid::check(case, draft, report);
    rigid::check(case, draft, report);
    stage::check(case, draft, report);
    initial::sudden(case, report);
    physics::rest(case, draft, report);
    strip::beside_fixed(case, report);
    section::warn_of_neighbours(case, draft, report);
    let inside_cells = lines::place(case, draft, report);
    solver::fit_weights(case, draft, report);
    limit_load::complete(
        case,
        draft,
        limit_load::Preparation {
            stiffness,
            inside_cells,
        },
        report,
    );
    meeting::check(case, draft, report);
    opening::check(case, draft, report);
    touching::check(case, draft, report);
    material::band::check(case, draft, report);
    physics::check(case, draft, report);
    lasting::check(case, draft, report);
    leaving::check(case, draft, report);
    reduction::at_stage(case, draft, report);
    free_field::check(case, draft, report);
    water::check(case, draft, report);
    ratio::check(case, draft, report);
    flow::check(case, draft, report);
    axisymmetric::check(case, draft, report);
    waves::check(case, draft, report);
}

fn analysis(draft: &Draft, kind: Option<AnalysisType>, report: &mut Report<'_>) -> Option<Analysis> {
    let analysis = draft.analysis.value()?;
    let kind = kind?;
    let regime = kind.regime();
    let end = match (analysis.end.is_given(), kind) {
        (true, _) => analysis.end.get()?,
        (false, AnalysisType::QuasiStatic) => {
            report.note(
                "analysis.end",
                "1.0",
                "default: a quasi-static analysis runs from pseudo-time 0 to 1",
            );
            1.0
        }
        (false, AnalysisType::Dynamic | AnalysisType::InTime | AnalysisType::Consolidation) => {
            let message = format!("E0255: a {kind} analysis needs the time at which it ends. Add `end` to [analysis].");
            report.error(analysis.location().origin, analysis.end.path(), message);
            return None;
        }
    };
    let dt = match analysis.steps.get() {
        Some(steps) => end / steps as f64,
        None => analysis.dt.get()?,
    };
    if dt > end {
        let message = format!(
            "E0256: the first step, dt = {dt}, is longer than the whole analysis, end = {end}. Reduce `dt`, or give \
             `steps` in place of `dt`."
        );
        analysis.dt.error(message, report);
        return None;
    }
    let growth = growth(analysis, kind, dt, report)?;
    if end / dt > MOST_STEPS {
        let message = format!(
            "E0257: dt = {dt} needs {:.3e} steps until the end of the analysis (at most {MOST_STEPS:e}). Increase \
             `dt`.",
            end / dt
        );
        analysis.dt.error(message, report);
        return None;
    }
    Some(Analysis {
        kind,
        regime,
        end,
        dt,
        growth,
        newmark: newmark(analysis, regime, report)?,
        mass: mass(analysis, regime, report),
        wall_velocity: wall_velocity(analysis, regime, report),
    })
}

/// By which steps grow, and to which length, if they do; the outer option is `None` after an error.
fn growth(
    analysis: &AnalysisTable,
    kind: AnalysisType,
    dt: f64,
    report: &mut Report<'_>,
) -> Option<Option<(f64, f64)>> {
    let mut keys = [&analysis.growth, &analysis.dt_max].into_iter();
    if let Some(key) = keys.find(|key| key.is_given()) {
        if kind != AnalysisType::Consolidation {
            let message = format!(
                "E0258: the time steps of a {kind} analysis cannot become longer during the analysis. Delete this \
                 key, or use type = \"consolidation\"."
            );
            key.error(message, report);
            return None;
        }
        if analysis.steps.is_given() {
            key.error(
                "E0259: `steps` divides the analysis into equal steps, but this key is for steps that become longer. \
                 Delete this key, or give `dt` (the first step) in place of `steps`.",
                report,
            );
            return None;
        }
    }
    let most = analysis.dt_max.if_given()?.unwrap_or(f64::INFINITY);
    if most < dt {
        analysis.dt_max.error(
            format!("E0260: dt_max = {most} is less than dt = {dt}. Increase dt_max."),
            report,
        );
        return None;
    }
    let factor = analysis.growth.if_given()?.unwrap_or(1.0);
    Some((factor > 1.0 && most > dt).then_some((factor, most)))
}

/// Numerical damping, of which only a dynamic analysis can have any.
fn newmark(analysis: &AnalysisTable, regime: Regime, report: &mut Report<'_>) -> Option<Newmark> {
    let mut keys = [&analysis.spectral_radius, &analysis.newmark_gamma].into_iter();
    let Some(key) = keys.find(|key| key.is_given()) else {
        return Some(Newmark::default());
    };
    if regime == Regime::QuasiStatic {
        key.error(NO_INERTIA, report);
    }
    if analysis.spectral_radius.is_given() {
        return analysis.spectral_radius.get().map(Newmark::of_spectral_radius);
    }
    analysis.newmark_gamma.get().map(Newmark::of_gamma)
}

/// The mass matrix, of which only a dynamic analysis has any.
fn mass(analysis: &AnalysisTable, regime: Regime, report: &mut Report<'_>) -> MassMatrix {
    if regime == Regime::QuasiStatic && analysis.mass.is_given() {
        analysis.mass.error(NO_INERTIA, report);
    }
    analysis.mass.get().unwrap_or_default()
}

/// The velocities near fixed faces, as given, of which only a dynamic analysis has any; see [`physics::walls`].
fn wall_velocity(analysis: &AnalysisTable, regime: Regime, report: &mut Report<'_>) -> WallVelocity {
    if regime == Regime::QuasiStatic && analysis.wall_velocity.is_given() {
        analysis.wall_velocity.error(NO_INERTIA, report);
    }
    analysis.wall_velocity.get().unwrap_or_default()
}

/// Supports of the grid's faces; none after an error.
pub(crate) fn boundary(draft: &Draft) -> Option<[[Support; 2]; 3]> {
    let boundary = draft.boundary.value()?;
    let mut supports = [[Support::Free; 2]; 3];
    for (own, sides) in supports
        .iter_mut()
        .zip(Side::of(draft.geometry.get().unwrap_or(Geometry::PlaneStrain)))
    {
        *own = [support(boundary, sides[0])?, support(boundary, sides[1])?];
    }
    Some(supports)
}

fn support(boundary: &dyn SupportTable, side: Side) -> Option<Support> {
    let face = boundary.face(side);
    match face.value() {
        Some(OrTable::Table(_)) => Some(Support::Contact),
        Some(OrTable::Value(support)) => Some(*support),
        None if matches!(side, Side::Front | Side::Back) && !face.is_given() => Some(Support::Free),
        None => None,
    }
}

/// What faces in contact do; none after an error.
fn contacts(draft: &Draft, factor: Option<f64>, report: &mut Report<'_>) -> Option<[[Option<Contact>; 2]; 3]> {
    let boundary = draft.boundary.value()?;
    let mut contacts = [[None; 2]; 3];
    for (own, sides) in contacts
        .iter_mut()
        .zip(Side::of(draft.geometry.get().unwrap_or(Geometry::PlaneStrain)))
    {
        *own = [
            contact(boundary, sides[0], factor, report)?,
            contact(boundary, sides[1], factor, report)?,
        ];
    }
    Some(contacts)
}

/// What a face does if it is in contact, its friction divided by the `factor` of the strength; none after an error.
fn contact(
    boundary: &dyn SupportTable,
    side: Side,
    factor: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Option<Contact>> {
    let Some(face) = boundary.face(side).table() else {
        let smooth = Contact {
            friction: 0.0,
            lifts: true,
        };
        return Some((support(boundary, side)? == Support::Contact).then_some(smooth));
    };
    Some(Some(law(&face.friction_coefficient, &face.separates, factor, report)?))
}

/// Friction, divided by the `factor` of the strength, and whether material comes off; none after an error.
fn law(
    coefficient: &Field<f64>,
    separates: &Field<bool>,
    factor: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Contact> {
    let given = coefficient.get()?;
    let lifts = separates.get()?;
    let friction = factor.map_or(given, |factor| given / factor);
    if friction != given {
        let reason = format!("divided by strength_reduction.factor = {}", factor.unwrap_or(1.0));
        report.note(coefficient.path(), format!("{friction}"), reason);
    }
    if friction > MOST_SHOWN_FRICTION {
        report.warn(format!(
            "W0204: {}: a friction coefficient of {friction} is above {MOST_SHOWN_FRICTION}, the largest value that \
             was verified. Steps may not converge. Use a smaller coefficient, or the support \"fixed\".",
            coefficient.path()
        ));
    }
    Some(Contact { friction, lifts })
}

fn gravity(draft: &Draft, regime: Option<Regime>, end: Option<f64>, report: &mut Report<'_>) -> Option<Gravity> {
    let table = draft.gravity.value()?;
    let gravity = Gravity {
        acceleration: table.acceleration.vector()?,
        ramp: table.ramp.get()?,
    };
    let Gravity { acceleration, ramp } = gravity;
    let dims = draft.geometry.get()?.dims();
    let is_pseudo_static =
        regime == Some(Regime::QuasiStatic) && !gravity.is_straight(dims) && acceleration[dims - 1] < 0.0;
    if is_pseudo_static {
        let coefficients = acceleration[..dims - 1]
            .iter()
            .map(|part| format!("{:.4}", -part / acceleration[dims - 1]));
        let written = coefficients.collect::<Vec<_>>().join(", ");
        report.note(
            "gravity.acceleration",
            format!("horizontal part of {written} times the vertical one"),
            "pseudo-static analysis: pore pressures and initial stresses follow from the vertical part alone",
        );
    }
    // The horizontal part of a pseudo-static load is no weight.
    let size = if is_pseudo_static {
        -acceleration[dims - 1]
    } else {
        acceleration[0].hypot(acceleration[1]).hypot(acceleration[2])
    };
    let off = (size / STANDARD_GRAVITY - 1.0).abs();
    if off <= 0.01 && off > NEARLY_STANDARD {
        report.warn(format!(
            "W0205: gravity.acceleration: gravity is {size} m/s2, but unit weights are converted to densities with \
             {STANDARD_GRAVITY} m/s2, so all weights are off by {:.2} %. Use {STANDARD_GRAVITY} m/s2.",
            1e2 * off
        ));
    }
    if size == 0.0 {
        report.warn(
            "W0206: gravity.acceleration: gravity is zero, so the soil has no weight. Correct the acceleration, or \
             delete [gravity].",
        );
    }
    if end.is_some_and(|end| ramp > end) {
        report.warn(format!(
            "W0207: gravity.ramp: the ramp of {ramp} is longer than the analysis, so gravity is never fully applied. \
             Reduce gravity.ramp, or increase analysis.end."
        ));
    }
    Some(gravity)
}

/// The method of stabilisation; none after an error.
pub(crate) fn stabilisation(draft: &Draft) -> Option<Stabilisation> {
    if !draft.stabilisation.is_given() {
        return Some(Stabilisation::None);
    }
    draft.stabilisation.value()?.method.get()
}
