//! What is not shown to be right together with water that flows, and what is doubtful with it.

use crate::case::{Acting, Body, Case, Drain, DrainSite, Flow, Initial, Stage, Support};
use crate::grid::GridAxis;
use crate::record::Record;
use crate::report::Report;
use crate::schema::LawName;
use crate::validate::flow::crossing::{is_beside, places};
use crate::validate::side::side;
use crate::words::{AnalysisType, Side, Word};
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::Regime;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::water::backward::LONGEST;
use bsmpm::water::flow::{Course, Given, Motion, Soil};

/// Points along each axis of a cell with cubic splines: with fewer the pressure oscillates at surfaces that cut cells.
const POINTS_OF_CUBIC: usize = 4;
/// Cells of water that a step may let into the ground where a drain lies above the water table.
const FILM: f64 = 0.1;
/// Growth per step above which steps are warned of: their own error is first order in them.
const MOST_GROWTH: f64 = 1.25;

/// Cells over the suction at which air enters from which on that is warned of.
const NARROW: f64 = 50.0;

/// Part of the softest soil's oedometric stiffness from which on a load is large, and the background that it asks for.
const LARGE: f64 = 0.1;
/// Young's moduli.
const ENOUGH: f64 = 1e-2;

/// What a factor of safety leaves out.
pub const HELD_WATER: &str = "pore pressures stay as they are at that time; those that shearing makes where it is too \
    fast to drain are not in it, and of soft clay the factor is too high by them: hold it against that of drainage = \
    \"undrained\" (bsmpm fos --undrained)";

/// Load over stiffness up to which ground one cell across was shown to be right; under .5 runs ended early.
const SHOWN_NARROW: f64 = 0.2;

/// What the whole case says of a flow: refusals of what is not shown to be right with it.
pub(in crate::validate) fn check(case: &Case, root: &Record, report: &mut Report<'_>) {
    let consolidates = case.analysis.kind == AnalysisType::Consolidation;
    let Some(flow) = &case.flow else {
        let of_flow = case.output.fields.iter().find(|field| field.is_of_flow());
        if let (Some(field), Some(output)) = (of_flow, root.record("output")) {
            output.error("fields", format!("no water flows: there is no \"{field}\""), report);
        }
        if let Some(analysis) = root.record("analysis").filter(|_| consolidates) {
            let message = "no water flows: give a material drainage = \"coupled\" (or \"undrained\"), or take \
                           \"quasi-static\"";
            analysis.error("type", message, report);
        }
        return;
    };
    let flows = matches!(case.analysis.kind, AnalysisType::Consolidation | AnalysisType::Dynamic);
    if let Some(analysis) = root.record("analysis").filter(|_| !flows) {
        let message = "water flows in real time, with balances of its own: take \"consolidation\" or \"dynamic\"";
        analysis.error("type", message, report);
    }
    discretised(case, root, report);
    of_soils(case, flow, root, report);
    acting(case, root, report);
    divided(flow, root, report);
    timed(case, root, report);
    weighed(case, report);
    ponds(case, flow, report);
    weightless(case, flow, report);
    pressed(case, flow, report);
    super::leaks::check(case, flow, report);
    super::crossing::check(case, flow, root, report);
    narrow(case, flow, report);
    hanging(case, flow, report);
}

/// Retention by which pores empty within so small a part of a cell that iterations come to no end.
fn narrow(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let cell = case.grid.shortest();
    for (named, soil) in case.materials.iter().zip(&flow.soils) {
        let retention = soil.as_ref().and_then(|soil| soil.retention.as_ref());
        let Some(entry) = retention.map(|of| of.curve.entry()).filter(|entry| NARROW * *entry < cell) else { continue };
        report.warn(format!(
            "material.{}.retention: air enters at a suction of {entry:e} m, {:.0} times less than a cell: pores are full or \
             empty, and iterations follow that badly (a column that drained took 14 times as many at 1/50, and ended early at \
             1/100 and below, its steps cut to 1/1024); a curve that begins at a tenth of a cell empties it as well",
            named.name,
            cell / entry
        ));
    }
}

/// Loads that take much of the height of the soil that they consolidate: its surface leaves the cells behind, and may
/// go sideways.
fn pressed(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let consolidates = |number: usize| flow.soils[number].as_ref().is_some_and(|soil| soil.permeability.is_some());
    let soils = case.bodies.iter().map(|body| body.material).filter(|number| consolidates(*number));
    let stiffness = |number: usize| case.materials[number].material.elastic().oedometric();
    let softest = soils.map(stiffness).fold(f64::INFINITY, f64::min);
    let load = case.tractions.iter().map(|traction| traction.largest()).fold(0.0, f64::max) / softest;
    let is_loose = case.solver.extended_splines == ExtendedSplines::Off;
    let soft = case.solver.background < 0.5 * ENOUGH && case.analysis.regime == Regime::QuasiStatic;
    if is_loose && soft && load >= LARGE {
        report.warn(format!(
            "solver.background: {:e}: a load of {load:.2} of the soil's stiffness takes much of its height, and the points at \
             its surface may drift apart there: settlements off by 10 %, or an early end; shown to be right with {ENOUGH:e}",
            case.solver.background
        ));
    }
    let averages = case.stabilisation != Stabilisation::None;
    if averages && load > SHOWN_NARROW && case.grid.axes.iter().take(case.grid.dims() - 1).any(|axis| axis.cells() == 1)
    {
        report.warn(format!(
            "grid: one cell across under a load of {load:.2} of the soil's stiffness: averaged dilations leave such ground a \
             way to go sideways, and the run may end early; give it two cells (or [stabilisation] method = \"none\")"
        ));
    }
}

/// Splines, points, averages and iterations that carry the pressure.
fn discretised(case: &Case, root: &Record, report: &mut Report<'_>) {
    if let Some(grid) = root.record("grid").filter(|_| case.grid.order == 1) {
        let message = "\"linear\" splines leave the pore pressure no gradient: take \"quadratic\"";
        grid.error("degree", message, report);
    }
    let few = |body: &Body| body.points_per_cell < POINTS_OF_CUBIC;
    for (body, record) in case.bodies.iter().zip(root.records("body")) {
        if case.grid.order == 3 && few(body) {
            let message = format!(
                "{} with cubic splines: the pore pressure oscillates where a surface cuts cells; allowed: at least {POINTS_OF_CUBIC}",
                body.points_per_cell
            );
            record.error("points_per_cell", message, report);
        }
    }
    let shown = matches!(case.stabilisation, Stabilisation::None | Stabilisation::ConsistentFBar);
    if let Some(record) = root.record("stabilisation").filter(|_| !shown) {
        let message = format!(
            "\"{}\" is not shown to be right with water that flows: take \"consistent-f-bar\"",
            case.stabilisation.word()
        );
        record.error("method", message, report);
    }
    let Some(solver) = root.record("solver") else { return };
    if case.solver.nonlinear == crate::Nonlinear::Broyden {
        let message = "\"broyden\" knows no pressures of water that flows: take \"auto\"";
        solver.error("nonlinear", message, report);
    }
    if case.solver.quadrature == Quadrature::Fitted {
        solver.error(
            "quadrature",
            "\"fitted\" is not shown to be right with water that flows: take \"points\"",
            report,
        );
    }
}

/// Laws of effective stress, and soils side by side.
fn of_soils(case: &Case, flow: &Flow, root: &Record, report: &mut Report<'_>) {
    let made = |number: usize| case.bodies.iter().any(|body| body.material == number);
    let named = root.named("material").iter().enumerate().filter(|(number, _)| made(*number));
    for (number, (name, record)) in named {
        let Some(law) = record.word::<LawName>("model") else { continue };
        if flow.soils[number].is_none() && !drains_where_they_meet(case, flow, number) {
            report.warn(format!(
                "material.{name}: drainage = \"hydrostatic\" beside soil in which water flows: nothing crosses from that soil into it \
                 but through a [[drain]] where they meet, and there is none"
            ));
        }
        let why = match law {
            LawName::SensitiveClay => "is a law of clay without drainage, of total stress",
            LawName::MuI => "is a law of dry grains that flow",
            LawName::CamClay => {
                "has a stiffness that follows the effective pressure, which the pressures' system does not"
            }
            LawName::Hencky | LawName::MohrCoulomb | LawName::Tresca => continue,
            LawName::DruckerPrager | LawName::VonMises | LawName::Softening => continue,
        };
        record.error("model", format!("\"{law}\" {why}: it is not shown to be right with water that flows"), report);
    }
    for (_, record) in root.named("material") {
        if record.word::<bsmpm::material::Separation>("separation") == Some(bsmpm::material::Separation::Closing) {
            record.error("separation", "gaps that close are not shown to be right with water that flows", report);
        }
    }
}

fn not_shown(what: &str) -> String {
    format!("{what} not shown to be right with water that flows")
}

/// What a stage changes.
fn of_stage(case: &Case, (number, record): (usize, &Record), report: &mut Report<'_>) {
    if record.gives("remove") && case.analysis.regime != Regime::QuasiStatic {
        record.error("remove", not_shown("bodies that are removed while all moves are"), report);
    } else if case.stages.get(number).is_some_and(|stage| !stage.remove.is_empty() && !drains_what_is_bare(case, stage))
    {
        report.warn(format!(
            "stage.{number}.remove: what is laid bare lets no water through, as the ground's surface without a drain; a [[drain]] \
             along it drains it, from the start of the run on, or as the stage applies it"
        ));
    }
    case.stages.get(number).into_iter().for_each(|stage| goes(case, (number, stage), report));
    if record.gives("add") && case.analysis.regime != Regime::QuasiStatic {
        record.error("add", not_shown("bodies that are placed while all moves are"), report);
    } else if let Some(stage) = case.stages.get(number) {
        placed(case, (number, stage), report);
    }
    let changes =
        [("boundary", "faces that change are"), ("strength_reduction", "strength that changes while water flows is")];
    for (key, what) in changes.into_iter().filter(|(key, _)| record.gives(key)) {
        record.error(key, not_shown(what), report);
    }
    if record.gives("materials") {
        let instead = "what is applied faster than \"coupled\" soil drains, it carries as without drainage; laws of \
                       total stress can be exchanged in a \"quasi-static\" analysis";
        record.error("materials", format!("{}: {instead}", not_shown("laws that are exchanged are")), report);
    }
}

/// What a stage places, and what that covers.
fn placed(case: &Case, (number, stage): (usize, &Stage), report: &mut Report<'_>) {
    let Some(flow) = &case.flow else { return };
    let soil = |body: &usize| flow.soils[case.bodies[*body].material].as_ref();
    let acts = |drain: usize, t: f64| case.acts_since(Acting::Drain(drain), t).is_some();
    for body in stage.add.iter().filter(|body| soil(body).is_some_and(|soil| soil.permeability.is_some())) {
        let drains = |(drain, of): (usize, &Drain)| {
            acts(drain, stage.at) && places(of, case).iter().any(|at| is_beside(case, at, |other| other == *body))
        };
        if !flow.drains.iter().enumerate().any(drains) {
            report.warn(format!(
                "stage.{number}.add: there is no drain on body.{body}: its surface lets no water through; a [[drain]] along it \
                 drains it, which the stage applies"
            ));
        }
    }
    let covers = |at: &[f64; 3]| {
        let comes = |body: usize| stage.add.contains(&body) && soil(&body).is_some();
        let was = |body: usize| case.is_there(body, case.just_before(stage.at));
        is_beside(case, at, comes) && is_beside(case, at, was)
    };
    for (drain, of) in flow.drains.iter().enumerate() {
        let stays = [case.just_before(stage.at), stage.at].into_iter().all(|t| acts(drain, t));
        if stays && places(of, case).iter().any(covers) {
            report.warn(format!(
                "stage.{number}.add: drain.{drain} goes on draining under what is placed, as a blanket does: where there is \
                 none, let the stage release it and apply others"
            ));
        }
    }
}

/// Warns of drains whose ground goes with what a stage removes.
fn goes(case: &Case, (number, stage): (usize, &Stage), report: &mut Report<'_>) {
    let before = case.just_before(stage.at);
    for (drain, of) in case.flow.iter().flat_map(|flow| flow.drains.iter().enumerate()) {
        let acts = [before, stage.at].into_iter().all(|t| case.acts_since(Acting::Drain(drain), t).is_some());
        let is_gone = |at: &[f64; 3]| {
            let beside = |t: f64| is_beside(case, at, |body| case.is_there(body, t));
            beside(before) && !beside(stage.at)
        };
        if acts && matches!(of.site, DrainSite::Lines(_) | DrainSite::Plate(_)) && places(of, case).iter().all(is_gone)
        {
            report.warn(format!(
                "stage.{number}.remove: drain.{drain} is on the surface of what is removed, and goes with it; what it leaves \
                 drains by another [[drain]] along it, which the stage applies"
            ));
        }
    }
}

/// Whether a drain lies between what a stage removes and what stays.
fn drains_what_is_bare(case: &Case, stage: &Stage) -> bool {
    let is_gone = |number: usize| stage.remove.contains(&number);
    let beside = |at: &[f64; 3], gone: bool| is_beside(case, at, |number| is_gone(number) == gone);
    let between = |drain: &Drain| places(drain, case).iter().all(|at| beside(at, true) && beside(at, false));
    case.flow.iter().flat_map(|flow| &flow.drains).any(between)
}

/// Whether a drain lies between bodies of a material and others through which water flows.
fn drains_where_they_meet(case: &Case, flow: &Flow, material: usize) -> bool {
    let of = |number: usize| case.bodies[number].material;
    let flows = |number: usize| flow.soils[of(number)].as_ref().is_some_and(|soil| soil.permeability.is_some());
    let between = |at: &[f64; 3]| is_beside(case, at, |number| of(number) == material) && is_beside(case, at, flows);
    flow.drains.iter().any(|drain| places(drain, case).iter().any(between))
}

/// What acts on the bodies.
fn acting(case: &Case, root: &Record, report: &mut Report<'_>) {
    if let Some(rigid) = root.records("rigid").first() {
        report.error(rigid.origin, &rigid.path, not_shown("rigid bodies are"));
    }
    for (side, support) in Side::of(case.geometry).iter().flatten().zip(case.boundary.into_iter().flatten()) {
        let side = side.word();
        if let Some(boundary) = root.record("boundary") {
            match support {
                Support::Fixed | Support::Roller | Support::Free => {}
                Support::Contact => boundary.error(side, not_shown("faces in contact are"), report),
                Support::Absorbing | Support::FreeField | Support::Outflow => {
                    boundary.error(side, not_shown(&format!("\"{support}\" is")), report);
                }
            }
        }
    }
    let rubs =
        case.footing.iter().map(|of| of.contact.is_some()).chain(case.prescribed.iter().map(|of| of.contact.is_some()));
    let strips = root.records("footing").iter().chain(root.records("prescribed"));
    for (_, record) in rubs.zip(strips).filter(|(rubs, _)| *rubs) {
        report.error(record.origin, &record.path, not_shown("strips that rub and let go are"));
    }
    root.records("stage").iter().enumerate().for_each(|stage| of_stage(case, stage, report));
    if let Some(record) = root.record("gravity").filter(|record| record.number("ramp").is_some_and(|ramp| ramp > 0.0)) {
        record.error("ramp", not_shown("gravity that grows is"), report);
    }
    if case.settles || case.initial == Some(Initial::Elastic) {
        for load in case.sudden_loads() {
            report.warn(format!(
                "{load}: acts in full from time 0, and the stress at the start bears it without excess pressure: nothing \
                 consolidates under it; give it a ramp"
            ));
        }
    }
    if let Some(shaking) = root.record("shaking") {
        report.error(shaking.origin, &shaking.path, not_shown("ground that shakes is"));
    }
}

/// Strength that is divided.
fn divided(flow: &Flow, root: &Record, report: &mut Report<'_>) {
    let Some(reduction) = root.record("strength_reduction") else { return };
    let unloaded = reduction.flag("unloaded") == Some(true);
    if reduction.gives("stage") && flow.at_rest == Motion::Held && !unloaded {
        report.warn(format!("strength_reduction.stage: {HELD_WATER}"));
    } else if !reduction.gives("stage") {
        let message = "strength that is reduced from the start on is not shown to be right with water that flows: give \
                       stage = \"end\" (bsmpm fos --stage end), of the pore pressures of that time, which then stay";
        report.error(reduction.origin, &reduction.path, message);
    }
}

/// How steps follow each other.
fn timed(case: &Case, root: &Record, report: &mut Report<'_>) {
    if let Some((growth, _)) = case.analysis.growth.filter(|(growth, _)| *growth > MOST_GROWTH) {
        report.warn(format!(
            "analysis.growth: {growth}: the error of a step grows with its length, what consolidates goes beyond its end (by .1, 1.2 % \
             with 1.25, 1.5), and steps longer than {LONGEST} times the one before are of first order; shown to be right up to \
             {MOST_GROWTH}"
        ));
    }
    let alike = case.analysis.growth.is_none() && root.record("analysis").is_some_and(|record| record.gives("dt_max"));
    if alike {
        report.warn("analysis.dt_max: without growth steps are alike; it does nothing");
    }
}

/// Water that begins without the pressure of its own weight.
fn weighed(case: &Case, report: &mut Report<'_>) {
    if case.gravity.is_some() && case.water.is_none() {
        report.warn(
            "water: there is none that is still, and the pore pressure at the start is zero everywhere: what the water weighs \
             has to build up in time; give [water] level",
        );
    }
}

/// Drains above the water table, which let water in without end where the ground would take it.
fn ponds(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let Some(water) = &case.water else { return };
    let times: Vec<f64> = water.table.levels().into_iter().flatten().map(|row| row.0).collect();
    let cell = case.grid.axes.iter().map(GridAxis::shortest).fold(f64::INFINITY, f64::min);
    // Without a table all of the ground is above it: what is let in sinks, if it has weight.
    let none = if case.gravity.is_some() { f64::NEG_INFINITY } else { f64::INFINITY };
    let dry = |at: &[f64; 3]| {
        let table = |t: f64| water.table.table(at[0], t).map_or(none, |(height, _)| height);
        at[case.grid.dims() - 1] > times.iter().map(|t| table(*t)).fold(f64::INFINITY, f64::min) + 0.5 * cell
    };
    let permeability = |soil: &Soil<3>| soil.permeability.as_ref().map_or(0.0, |k| k.along.max());
    let most = flow.soils.iter().flatten().map(permeability).fold(0.0, f64::max);
    let end = case.analysis.end;
    let dt = case.analysis.growth.map_or(case.analysis.dt, |(_, longest)| longest.min(end));
    // What has suction loses it in however many steps.
    let (time, told) = if flow.retains() { (end, "the run") } else { (dt, "a step") };
    let way = most * time / cell;
    for (number, drain) in flow.drains.iter().enumerate().filter(|(_, drain)| drain.given == Given::StillWater) {
        if way > FILM && places(drain, case).iter().any(dry) {
            report.warn(format!(
                "drain.{number}: above the water table it holds the pressure of the air, and the ground there is fed as by \
                 a pond, by up to {way:.1} cells of water in {told}: give seepage = true (and soils a retention), or \
                 head where a pond stands"
            ));
        }
    }
}

/// Ground above the water table whose pores stay full all the same: the water in them hangs on its skeleton.
fn hanging(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let Some(water) = case.water.as_ref().filter(|_| case.grid.dims() == 2) else { return };
    let (lower, cell) = (case.grid.lower(), case.grid.shortest());
    let times: Vec<f64> = water.table.levels().into_iter().flatten().map(|row| row.0).collect();
    for (number, named) in case.materials.iter().enumerate() {
        let keeps = |soil: &Soil<3>| soil.permeability.is_some() && soil.retention.is_none();
        if !flow.soils[number].as_ref().is_some_and(keeps) {
            continue;
        }
        let made = case.bodies.iter().filter(|body| body.material == number);
        let corners = made.flat_map(|body| body.region.edges(&case.grid).0).flat_map(|edge| [edge.a, edge.b]);
        let above = corners.flat_map(|[x, y]| {
            let heights = times.iter().filter_map(move |t| water.table.table(lower[0] + x, *t));
            heights.map(move |(height, _)| lower[1] + y - height)
        });
        let most = above.fold(0.0, f64::max);
        if most > cell {
            report.warn(format!(
                "material.{}: up to {most:.2} m of it are above the water table, its pores stay full, and suction of up to \
                 {:.0} kPa, as of water that hangs there, holds it together without limit: a slope of it had a factor of safety \
                 11 % above that under the table alone; give it a retention, or drainage = \"hydrostatic\" where it is dry",
                named.name,
                1e-3 * most * water.unit_weight
            ));
        }
    }
}

/// Heads above a body's surface, where water would stand on it and press; but for what still water presses.
fn weightless(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let (up, cell) =
        (case.grid.dims() - 1, case.grid.axes.iter().map(GridAxis::shortest).fold(f64::INFINITY, f64::min));
    let still = |x: f64| {
        let water = case.water.iter().flat_map(|water| {
            water.table.levels().into_iter().flatten().filter_map(move |row| water.table.table(x, row.0))
        });
        water.map(|(height, _)| height).fold(f64::NEG_INFINITY, f64::max)
    };
    for (number, drain) in flow.drains.iter().enumerate() {
        let Given::Head(Course(rows)) = &drain.given else { continue };
        let lines = drain.site.lines();
        if !lines.iter().any(|line| side(line, &case.grid, case.bodies.iter()).is_some()) {
            continue; // a face of the grid, or a well inside the ground
        }
        let highest = rows.iter().map(|row| row.1).fold(f64::NEG_INFINITY, f64::max);
        let above = |at: &[f64; 3]| highest - at[up].max(still(at[0]));
        let most = places(drain, case).iter().map(above).fold(0.0, f64::max);
        if most > 0.5 * cell {
            report.warn(format!(
                "drain.{number}: the head is up to {most:.3} m above the surface, and the water above it does not press on the \
                 ground: where it stands there give [water] a level (level_path, line, line_path) up to it, and leave \
                 head out; head is that of a pipe or well"
            ));
        }
    }
}
