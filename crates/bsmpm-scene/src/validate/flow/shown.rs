//! Refuses options that are not verified for cases with pore-water flow.

use super::is_permeable;
use crate::case::{ActiveLoads, Case, DrainSite, Flow, Initial, Stage, Support, Water};
use crate::record::{CaseTable, KeyPlace};
use crate::report::Report;
use crate::schema::{Draft, LawName, StageTable, SupportTable};
use crate::validate::flow::crossing::{is_beside, places};
use crate::validate::side::side;
use crate::words::{AnalysisType, Side, Word};
use bsmpm::field::pore_water::flow::{Course, Given, Motion};
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::Regime;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_shapes::GridAxis;

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
pub const HELD_WATER: &str = "W0548: the strength reduction keeps pore pressures constant, so for a sudden failure of \
     soft clay the factor of safety may be too high. Compare it with the factor from `bsmpm fos --undrained`.";

/// Load over stiffness up to which ground one cell across was shown to be right; under 0.5 runs ended early.
const SHOWN_NARROW: f64 = 0.2;

/// What the whole case says of a flow: refusals of what is not shown to be right with it.
pub(in crate::validate) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let consolidates = case.analysis.kind == AnalysisType::Consolidation;
    let Some(flow) = &case.flow else {
        let of_flow = case.output.fields.iter().find(|field| field.is_of_flow());
        if let (Some(field), Some(output)) = (of_flow, draft.output.value()) {
            let message = format!(
                "E0501: no material has pore-water flow, so the field \"{field}\" does not exist. Remove the field, \
                 or give a material `drainage = \"coupled\"`, `porosity` and `permeability`."
            );
            output.fields.error(message, report);
        }
        if let Some(analysis) = draft.analysis.value().filter(|_| consolidates) {
            let message = "E0501: no material has pore-water flow, so nothing consolidates. Give a material \
                           `drainage = \"coupled\"`, `porosity` and `permeability`, or use analysis.type = \
                           \"quasi-static\".";
            analysis.r#type.error(message, report);
        }
        return;
    };
    let flows = matches!(case.analysis.kind, AnalysisType::Consolidation | AnalysisType::Dynamic);
    if let Some(analysis) = draft.analysis.value().filter(|_| !flows) {
        let message = format!(
            "E0502: type = \"{}\" does not compute excess pore pressures, but a material has drainage = \"coupled\" \
             or \"undrained\". Use \"consolidation\" or \"dynamic\", or change `drainage`.",
            case.analysis.kind.word()
        );
        analysis.r#type.error(message, report);
    }
    discretised(case, draft, report);
    of_soils(case, flow, draft, report);
    acting(case, draft, report);
    divided(flow, draft, report);
    timed(case, draft, report);
    weighed(case, report);
    ponds(case, flow, report);
    weightless(case, flow, report);
    pressed(case, flow, report);
    super::leaks::check(case, flow, report);
    super::crossing::check(case, flow, draft, report);
    narrow(case, flow, report);
    hanging(case, flow, report);
}

/// Retention by which pores empty within so small a part of a cell that iterations come to no end.
fn narrow(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let cell = case.grid.shortest();
    for (named, soil) in case.materials.iter().zip(&flow.soils) {
        let retention = soil.as_ref().and_then(|soil| soil.retention.as_ref());
        let Some(entry) = retention
            .map(|of| of.curve.entry())
            .filter(|entry| NARROW * *entry < cell)
        else {
            continue;
        };
        report.warn(format!(
            "W0540: material.{}.retention: the air-entry suction head, {entry:.2e} m, is 1/{:.0} of a cell (limit \
             1/{NARROW}), so steps may fail. Use smaller cells, or an air-entry head near 0.1 cells.",
            named.name,
            cell / entry
        ));
    }
}

/// Loads that take much of the height of the soil that they consolidate: its surface leaves the cells behind, and may
/// go sideways.
fn pressed(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let soils = case.bodies.iter().map(|body| body.material);
    let softest = soils
        .filter(|&number| is_permeable(&flow.soils, number))
        .map(|number| case.materials[number].material.elastic().oedometric())
        .fold(f64::INFINITY, f64::min);
    let load = case
        .tractions
        .iter()
        .map(|traction| traction.largest())
        .fold(0.0, f64::max)
        / softest;
    let is_loose = case.solver.extended_splines == ExtendedSplines::Off;
    let soft = case.solver.background < 0.5 * ENOUGH && case.analysis.regime == Regime::QuasiStatic;
    if is_loose && soft && load >= LARGE {
        report.warn(format!(
            "W0541: solver.background: {:e} is too small for a load of {load:.2} times the oedometric stiffness, so \
             settlements may be 10 % wrong. Set `solver.background = {ENOUGH}`.",
            case.solver.background
        ));
    }
    let averages = case.stabilisation != Stabilisation::None;
    if averages
        && load > SHOWN_NARROW
        && case
            .grid
            .axes
            .iter()
            .take(case.grid.dims() - 1)
            .any(|axis| axis.cells() == 1)
    {
        report.warn(format!(
            "W0542: grid: the soil is one cell wide and may move sideways, because the load is {load:.2} times its \
             oedometric stiffness. Use two cells across the soil, or `stabilisation.method = \"none\"`."
        ));
    }
}

/// Splines, points, averages and iterations that carry the pressure.
fn discretised(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if let Some(grid) = draft.grid.value().filter(|_| case.grid.order == 1) {
        let message = "E0541: with \"linear\" splines the gradient of the pore pressure, which drives the flow, is \
                       too inaccurate. Use \"quadratic\".";
        grid.degree.error(message, report);
    }
    for (body, record) in case.bodies.iter().zip(draft.body.items()) {
        if case.grid.order == 3 && body.points_per_cell < POINTS_OF_CUBIC {
            let message = format!(
                "E0542: {} material points along each axis of a cell are too few for cubic splines, so the pore \
                 pressure would oscillate. Use at least {POINTS_OF_CUBIC}, or grid.degree = \"quadratic\".",
                body.points_per_cell
            );
            record.error("points_per_cell", message, report);
        }
    }
    let shown = matches!(case.stabilisation, Stabilisation::None | Stabilisation::ConsistentFBar);
    if let Some(record) = draft.stabilisation.value().filter(|_| !shown) {
        let method = format!("method = \"{}\"", case.stabilisation.word());
        record
            .method
            .error(not_available(&method, "Use \"consistent-f-bar\"."), report);
    }
    let Some(solver) = draft.solver.value() else { return };
    if case.solver.nonlinear == crate::Nonlinear::Broyden {
        solver
            .nonlinear
            .error(not_available("nonlinear = \"broyden\"", "Use \"auto\"."), report);
    }
    if case.solver.quadrature == Quadrature::Fitted {
        solver
            .quadrature
            .error(not_available("quadrature = \"fitted\"", "Use \"points\"."), report);
    }
}

/// Laws of effective stress, and soils side by side.
fn of_soils(case: &Case, flow: &Flow, draft: &Draft, report: &mut Report<'_>) {
    let named = draft
        .material
        .items()
        .iter()
        .enumerate()
        .filter(|(number, _)| case.bodies.iter().any(|body| body.material == *number));
    for (number, (name, record)) in named {
        let Some(law) = record.word::<LawName>("model") else {
            continue;
        };
        if flow.soils[number].is_none() && !drains_where_they_meet(case, flow, number) {
            report.warn(format!(
                "W0543: material.{name}: this \"hydrostatic\" soil touches soil with pore-water flow, but no water \
                 passes between the two. Add a [[drain]] at the interface, or set `drainage = \"coupled\"`."
            ));
        }
        let is_excluded = matches!(law, LawName::SensitiveClay | LawName::MuI | LawName::CamClay);
        if is_excluded {
            let instead = "Use another model for this soil, for example \"mohr-coulomb\".";
            record.error("model", not_available(&format!("the model \"{law}\""), instead), report);
        }
    }
    for (_, record) in draft.material.items() {
        if record.word::<bsmpm::material::Separation>("separation") == Some(bsmpm::material::Separation::Closing) {
            record.error(
                "separation",
                not_available("separation = \"gap\"", "Remove `separation`."),
                report,
            );
        }
    }
}

/// Message of what cannot be combined with flowing water, with an instruction what to do instead.
fn not_available(what: &str, instead: &str) -> String {
    format!("E0540: {what} is not available if a material has drainage = \"coupled\" or \"undrained\". {instead}")
}

/// What a stage changes.
fn of_stage(case: &Case, number: usize, record: &StageTable, report: &mut Report<'_>) {
    if record.remove.is_given() && case.analysis.regime != Regime::QuasiStatic {
        let message = not_available(
            "removal of bodies in a dynamic analysis",
            "Use analysis.type = \"consolidation\".",
        );
        record.remove.error(message, report);
    } else if case
        .stages
        .get(number)
        .is_some_and(|stage| !stage.remove.is_empty() && !drains_what_is_bare(case, stage))
    {
        report.warn(format!(
            "W0544: stage.{number}.remove: the surface exposed by the excavation has no drain, so it is impermeable. \
             Add a [[drain]] along this surface, and list the drain in `activate` of this stage."
        ));
    }
    case.stages
        .get(number)
        .into_iter()
        .for_each(|stage| goes(case, number, stage, report));
    if record.add.is_given() && case.analysis.regime != Regime::QuasiStatic {
        let message = not_available(
            "placement of bodies in a dynamic analysis",
            "Use analysis.type = \"consolidation\".",
        );
        record.add.error(message, report);
    } else if let Some(stage) = case.stages.get(number) {
        placed(case, number, stage, report);
    }
    let changes: [(&KeyPlace, &str, &str); 3] = [
        (
            &record.boundary,
            "a change of the boundary",
            "Remove `boundary` of this stage, and give one boundary for all stages in [boundary].",
        ),
        (
            &record.strength_reduction,
            "a strength reduction in a stage",
            "Remove it, and find the factor of safety with `bsmpm fos --stage end`.",
        ),
        (
            &record.materials,
            "a change of material",
            "Remove `materials`: fast loading of \"coupled\" soil is undrained anyway.",
        ),
    ];
    for (key, what, instead) in changes.into_iter().filter(|(key, ..)| key.is_given()) {
        key.error(not_available(what, instead), report);
    }
}

/// What a stage places, and what that covers.
fn placed(case: &Case, number: usize, stage: &Stage, report: &mut Report<'_>) {
    let Some(flow) = &case.flow else { return };
    for &body in &stage.add {
        if !is_permeable(&flow.soils, case.bodies[body].material) {
            continue;
        }
        let is_drained = flow.drains.iter().enumerate().any(|(drain, of)| {
            acts_at(case, drain, stage.at)
                && places(of, case)
                    .iter()
                    .any(|at| is_beside(case, at, |other| other == body))
        });
        if !is_drained {
            report.warn(format!(
                "W0544: stage.{number}.add: the added body.{body} has no drain, so its surface is impermeable. Add a \
                 [[drain]] along this surface, and list the drain in `activate` of this stage."
            ));
        }
    }
    for (drain, of) in flow.drains.iter().enumerate() {
        let stays = acts_at(case, drain, case.just_before(stage.at)) && acts_at(case, drain, stage.at);
        if stays && places(of, case).iter().any(|at| is_covered(case, flow, stage, at)) {
            report.warn(format!(
                "W0545: stage.{number}.add: drain.{drain} keeps draining below the added soil, like a drainage \
                 blanket. If there is no blanket, list the drain in `deactivate` of this stage."
            ));
        }
    }
}

/// Whether a drain acts at a time.
fn acts_at(case: &Case, drain: usize, t: f64) -> bool {
    case.acts_since(ActiveLoads::Drain(drain), t).is_some()
}

/// Whether a body is at a place at a time.
fn is_ground(case: &Case, at: &[f64; 3], t: f64) -> bool {
    is_beside(case, at, |body| case.is_there(body, t))
}

/// Whether a stage adds soil with pore water at a place of ground.
fn is_covered(case: &Case, flow: &Flow, stage: &Stage, at: &[f64; 3]) -> bool {
    is_beside(case, at, |body| {
        stage.add.contains(&body) && flow.soils[case.bodies[body].material].is_some()
    }) && is_ground(case, at, case.just_before(stage.at))
}

/// Warns of drains whose ground goes with what a stage removes.
fn goes(case: &Case, number: usize, stage: &Stage, report: &mut Report<'_>) {
    let before = case.just_before(stage.at);
    for (drain, of) in case.flow.iter().flat_map(|flow| flow.drains.iter().enumerate()) {
        let acts = acts_at(case, drain, before) && acts_at(case, drain, stage.at);
        if acts
            && matches!(of.site, DrainSite::Lines(_) | DrainSite::Plate(_))
            && places(of, case)
                .iter()
                .all(|at| is_ground(case, at, before) && !is_ground(case, at, stage.at))
        {
            report.warn(format!(
                "W0546: stage.{number}.remove: drain.{drain} is removed with its soil, so the new surface is \
                 impermeable. Add a [[drain]] along the new surface, and list it in `activate` of this stage."
            ));
        }
    }
}

/// Whether a drain lies between what a stage removes and what stays.
fn drains_what_is_bare(case: &Case, stage: &Stage) -> bool {
    let mut drains = case.flow.iter().flat_map(|flow| &flow.drains);
    drains.any(|drain| {
        places(drain, case).iter().all(|at| {
            is_beside(case, at, |number| stage.remove.contains(&number))
                && is_beside(case, at, |number| !stage.remove.contains(&number))
        })
    })
}

/// Whether a drain lies between bodies of a material and others through which water flows.
fn drains_where_they_meet(case: &Case, flow: &Flow, material: usize) -> bool {
    let mut places = flow.drains.iter().flat_map(|drain| places(drain, case));
    places.any(|at| {
        is_beside(case, &at, |number| case.bodies[number].material == material)
            && is_beside(case, &at, |number| {
                is_permeable(&flow.soils, case.bodies[number].material)
            })
    })
}

/// What acts on the bodies.
fn acting(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if let Some(rigid) = draft.rigid.items().first() {
        let message = not_available("a rigid body", "Use a [footing] or a [[prescribed]] displacement.");
        report.error(rigid.origin, &rigid.path, message);
    }
    refuse_supports(case, draft, report);
    let have_contact = case
        .footing
        .iter()
        .map(|of| of.contact.is_some())
        .chain(case.prescribed.iter().map(|of| of.contact.is_some()));
    let strips = draft.footing.value().into_iter().chain(draft.prescribed.items());
    for (_, record) in have_contact.zip(strips).filter(|(has_contact, _)| *has_contact) {
        let message = not_available(
            "frictional contact of a footing",
            "Use interface = \"rough\" or \"smooth\" ([footing]), or components = \"all\" ([[prescribed]]).",
        );
        report.error(record.origin, &record.path, message);
    }
    draft
        .stage
        .items()
        .iter()
        .enumerate()
        .for_each(|(number, stage)| of_stage(case, number, stage, report));
    if let Some(gravity) = draft
        .gravity
        .value()
        .filter(|gravity| gravity.ramp.get().is_some_and(|ramp| ramp > 0.0))
    {
        let message = not_available("gravity that increases over a ramp", "Remove `ramp`.");
        gravity.ramp.error(message, report);
    }
    if case.settles || case.initial == Some(Initial::Elastic) {
        for load in case.sudden_loads() {
            report.warn(format!(
                "W0547: {load}: this load acts in full from t = 0 and is part of the initial stress, so the soil \
                 does not consolidate under it. Give the load a `ramp`."
            ));
        }
    }
    if let Some(shaking) = draft.shaking.value() {
        let message = not_available(
            "[shaking]",
            "Remove it, or use drainage = \"hydrostatic\" with undrained strengths.",
        );
        shaking.location().error(message, report);
    }
}

/// Refuses supports of the grid's faces other than a roller, a fixed or a free face.
fn refuse_supports(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for (side, support) in Side::of(case.geometry)
        .iter()
        .flatten()
        .zip(case.boundary.into_iter().flatten())
    {
        if let Some(boundary) = draft.boundary.value() {
            match support {
                Support::Fixed | Support::Roller | Support::Free => {}
                Support::Contact | Support::Absorbing | Support::FreeField | Support::Outflow => {
                    let message = not_available(
                        &format!("the boundary condition \"{support}\""),
                        "Use \"roller\" or \"fixed\".",
                    );
                    boundary.face(*side).error(message, report);
                }
            }
        }
    }
}

/// Strength that is divided.
fn divided(flow: &Flow, draft: &Draft, report: &mut Report<'_>) {
    let Some(reduction) = draft.strength_reduction.value() else {
        return;
    };
    let unloaded = reduction.unloaded.get() == Some(true);
    if reduction.stage.is_given() && flow.at_rest == Motion::Held && !unloaded {
        report.warn(HELD_WATER);
    } else if !reduction.stage.is_given() {
        let message = "E0543: a strength reduction from the start would mix consolidation and failure. Set `stage = \
             \"end\"` (`bsmpm fos --stage end`), which reduces the strength after the consolidation.";
        reduction.location().error(message, report);
    }
}

/// How steps follow each other.
fn timed(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if let Some((growth, _)) = case.analysis.growth.filter(|(growth, _)| *growth > MOST_GROWTH) {
        report.warn(format!(
            "W0549: analysis.growth: steps that grow by a factor of {growth} (limit {MOST_GROWTH}) become inaccurate, \
             and settlements exceed their final value. Set `growth` to {MOST_GROWTH} or less."
        ));
    }
    let alike = case.analysis.growth.is_none()
        && draft
            .analysis
            .value()
            .is_some_and(|analysis| analysis.dt_max.is_given());
    if alike {
        report.warn(
            "W0550: analysis.dt_max: `dt_max` has no effect without `growth`, because all steps are equal. Add \
             `growth`, or remove `dt_max`.",
        );
    }
}

/// Water that begins without the pressure of its own weight.
fn weighed(case: &Case, report: &mut Report<'_>) {
    if case.gravity.is_some() && case.water.is_none() {
        report.warn(
            "W0551: water: the case has gravity but no water table, so pore pressures are zero at the start, and the \
             hydrostatic pressure builds up in time like an excess pressure. Give `water.level`.",
        );
    }
}

/// Drains above the water table, which let water in without end where the ground would take it.
fn ponds(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let Some(water) = &case.water else { return };
    let times: Vec<f64> = water.table.levels().into_iter().flatten().map(|row| row.0).collect();
    let cell = case
        .grid
        .axes
        .iter()
        .map(GridAxis::shortest)
        .fold(f64::INFINITY, f64::min);
    // Without a table all of the ground is above it: what is let in sinks, if it has weight.
    let none = if case.gravity.is_some() {
        f64::NEG_INFINITY
    } else {
        f64::INFINITY
    };
    let up = case.grid.dims() - 1;
    let permeable = flow
        .soils
        .iter()
        .flatten()
        .filter_map(|soil| soil.permeability.as_ref());
    let most = permeable.map(|k| k.along.max()).fold(0.0, f64::max);
    let end = case.analysis.end;
    let dt = case
        .analysis
        .growth
        .map_or(case.analysis.dt, |(_, longest)| longest.min(end));
    // What has suction loses it in however many steps.
    let (time, period) = if flow.retains() {
        (end, "during the analysis")
    } else {
        (dt, "in one step")
    };
    let height = most * time / cell;
    for (number, drain) in flow
        .drains
        .iter()
        .enumerate()
        .filter(|(_, drain)| drain.given == Given::StillWater)
    {
        let is_dry = height > FILM
            && places(drain, case)
                .iter()
                .any(|at| at[up] > lowest_table(water, &times, at[0], none) + 0.5 * cell);
        if is_dry {
            report.warn(format!(
                "W0552: drain.{number}: above the water table soil suction draws water from this drain, a layer up to \
                 {height:.1} cells high {period}. Set `seepage = true`, or for a pond give its `head`."
            ));
        }
    }
}

/// m  lowest water table at x over some times, `none` when there is none
fn lowest_table(water: &Water, times: &[f64], x: f64, none: f64) -> f64 {
    let heights = times.iter().map(|t| water.table.table(x, *t));
    heights
        .map(|table| table.map_or(none, |(height, _)| height))
        .fold(f64::INFINITY, f64::min)
}

/// Ground above the water table whose pores stay full all the same: the water in them hangs on its skeleton.
fn hanging(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let Some(water) = case.water.as_ref().filter(|_| case.grid.dims() == 2) else {
        return;
    };
    let lower = case.grid.lower();
    let cell = case.grid.shortest();
    let times: Vec<f64> = water.table.levels().into_iter().flatten().map(|row| row.0).collect();
    for (number, named) in case.materials.iter().enumerate() {
        let is_full = flow.soils[number]
            .as_ref()
            .is_some_and(|soil| soil.permeability.is_some() && soil.retention.is_none());
        if !is_full {
            continue;
        }
        let made = case.bodies.iter().filter(|body| body.material == number);
        let corners = made
            .flat_map(|body| body.region.edges(&case.grid.axes).0)
            .flat_map(|edge| [edge.a, edge.b]);
        let above = corners.flat_map(|[x, y]| {
            let heights = times.iter().filter_map(move |t| water.table.table(lower[0] + x, *t));
            heights.map(move |(height, _)| lower[1] + y - height)
        });
        let most = above.fold(0.0, f64::max);
        if most > cell {
            report.warn(format!(
                "W0553: material.{}: the soil stays saturated to {most:.2} m above the water table, and suction (to \
                 {:.0} kPa) strengthens it. Add `retention`. If that soil is dry, set drainage = \"hydrostatic\".",
                named.name,
                1e-3 * most * water.unit_weight
            ));
        }
    }
}

/// Heads above a body's surface, where water would stand on it and press; but for what still water presses.
fn weightless(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let up = case.grid.dims() - 1;
    let cell = case
        .grid
        .axes
        .iter()
        .map(GridAxis::shortest)
        .fold(f64::INFINITY, f64::min);
    for (number, drain) in flow.drains.iter().enumerate() {
        let Given::Head(Course(rows)) = &drain.given else {
            continue;
        };
        let lines = drain.site.lines();
        if !lines
            .iter()
            .any(|line| side(line, &case.grid, case.bodies.iter()).is_some())
        {
            continue; // a face of the grid, or a well inside the ground
        }
        let highest = rows.iter().map(|row| row.1).fold(f64::NEG_INFINITY, f64::max);
        let above = places(drain, case)
            .into_iter()
            .map(|at| highest - at[up].max(still_water(case, at[0])));
        let most = above.fold(0.0, f64::max);
        if most > 0.5 * cell {
            report.warn(format!(
                "W0554: drain.{number}: the head is up to {most:.3} m above the surface of the soil, but no water \
                 presses on the surface. For a pond or reservoir give `water.level` instead of `head`."
            ));
        }
    }
}

/// m  the highest level of the still water at x
fn still_water(case: &Case, x: f64) -> f64 {
    let tables = case.water.iter().map(|water| &water.table);
    let heights = tables.flat_map(|table| {
        let rows = table.levels().into_iter().flatten();
        rows.filter_map(move |row| table.table(x, row.0))
    });
    heights.map(|(height, _)| height).fold(f64::NEG_INFINITY, f64::max)
}
