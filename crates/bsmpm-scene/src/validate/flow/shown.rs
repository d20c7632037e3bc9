//! Refuses options that are not verified for cases with pore-water flow.

mod stages;

use super::is_permeable;
use super::water_table::{hanging, ponds, weighed, weightless};
use crate::case::{Case, Flow, Initial, Support};
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::{Draft, LawName, SupportTable};
use crate::validate::flow::crossing::{is_beside, places};
use crate::words::{AnalysisType, Side, Word};
use bsmpm::field::pore_water::flow::Motion;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::Regime;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;

/// Points along each axis of a cell with cubic splines: with fewer the pressure oscillates at surfaces that cut cells.
const POINTS_OF_CUBIC: usize = 4;
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
            record.points_per_cell.error(message, report);
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
        let Some(law) = record.model.get() else {
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
            record
                .model
                .error(not_available(&format!("the model \"{law}\""), instead), report);
        }
    }
    for (_, record) in draft.material.items() {
        if record.separation.get() == Some(bsmpm::material::Separation::Closing) {
            record
                .separation
                .error(not_available("separation = \"gap\"", "Remove `separation`."), report);
        }
    }
}

/// Message of what cannot be combined with flowing water, with an instruction what to do instead.
fn not_available(what: &str, instead: &str) -> String {
    format!("E0540: {what} is not available if a material has drainage = \"coupled\" or \"undrained\". {instead}")
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
        rigid.location().error(message, report);
    }
    refuse_supports(case, draft, report);
    let have_contact = case
        .footing
        .iter()
        .map(|of| of.contact.is_some())
        .chain(case.prescribed.iter().map(|of| of.contact.is_some()));
    for (_, strip) in have_contact.zip(draft.strips()).filter(|(has_contact, _)| *has_contact) {
        let message = not_available(
            "frictional contact of a footing",
            "Use interface = \"rough\" or \"smooth\" ([footing]), or components = \"all\" ([[prescribed]]).",
        );
        strip.location.error(message, report);
    }
    draft
        .stage
        .items()
        .iter()
        .enumerate()
        .for_each(|(number, stage)| stages::of_stage(case, number, stage, report));
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
