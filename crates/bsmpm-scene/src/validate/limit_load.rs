//! Validates a limit load analysis. Multiplies stiffness and divides displacements by a factor, theory-manual equation
//! (T9.8), to keep strains small.

mod sought;

use self::sought::sought;
use super::site;
use crate::case::{Case, Footing, LimitLoad, MotionPath, PrescribedMotion, Rigid, Site, SoughtLoad};
use crate::grid::GridSpec;
use crate::report::Report;
use crate::schema::{AnalysisTable, Draft};
use crate::words::{AnalysisType, Purpose, Side, Support, Word};
use bsmpm::material::LayeredMaterial;
use bsmpm::stabilisation::Stabilisation;

/// Part of the smallest cell by which anything moves in the whole run. N_gamma for a friction angle of 25 degrees and
/// 16 cells is 7.840 with 2e-3 and 7.833 with 5e-4, in 2540 and 1119 iterations; at 1 to 4 % of a cell loads grow by 10
/// to 30 %.
const FARTHEST: f64 = 5e-4;
/// Largest force tolerance: with 1e-3 loads are 2 to 7 % too high.
const FORCE_TOLERANCE: f64 = 1e-4;
/// Points along an axis of a cell with which plastic flow that changes volume does not lock.
const POINTS: usize = 2;
/// Part of the friction angle below which the dilation angle makes the limit load depend on the path.
const ASSOCIATED: f64 = 0.5;
/// rad  Dilation angle from which averages of volumetric strain were shown to be wrong in soil without cohesion.
const DILATES: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// Cohesion over the stress by the weight of as much soil as the footing is wide, up to which it counts as small.
const SMALL_COHESION: f64 = 0.05;

/// Everything that a case moves, or may move.
pub(super) struct MovedBodies<'a> {
    pub(super) footing: Option<&'a mut Footing>,
    pub(super) prescribed: &'a mut [PrescribedMotion],
    pub(super) rigid: &'a mut [Rigid],
}

impl MovedBodies<'_> {
    fn paths(&mut self) -> impl Iterator<Item = &mut MotionPath> {
        let footing = self.footing.iter_mut().map(|footing| &mut footing.path);
        let prescribed = self.prescribed.iter_mut().map(|prescribed| &mut prescribed.path);
        footing
            .chain(prescribed)
            .chain(self.rigid.iter_mut().map(|rigid| &mut rigid.path))
    }
}

/// Whether the case seeks a limit load.
pub(super) fn is_sought(draft: &Draft) -> bool {
    draft.analysis.value().and_then(|analysis| analysis.purpose.get()) == Some(Purpose::LimitLoad)
}

/// Divides the prescribed displacements of a case that seeks a limit load; returns the factor, by which Young's moduli
/// are to be multiplied. 1 for other cases.
pub(super) fn shrink(
    draft: &Draft,
    grid: Option<&GridSpec>,
    mut moved: MovedBodies<'_>,
    report: &mut Report<'_>,
) -> f64 {
    // What could not be read does not move.
    let Some(analysis) = draft.analysis.value().filter(|_| is_sought(draft) && !report.failed()) else {
        return 1.0;
    };
    let farthest = moved.paths().map(|path| path.farthest()).fold(0.0, f64::max);
    if farthest == 0.0 {
        let message = "E0442: a limit load needs a prescribed displacement, and the case has none. Give [footing], \
                       [[prescribed]] or [[rigid]] a displacement, or find a factor of safety with `bsmpm fos`.";
        analysis.purpose.error(message, report);
        return 1.0;
    }
    let Some(grid) = grid else { return 1.0 };
    let needed = farthest / (FARTHEST * grid.shortest());
    let factor: f64 = format!("{:.2e}", needed.max(1.0)).parse().unwrap_or(needed);
    for row in moved.paths().flat_map(|path| &mut path.rows) {
        row.1 = row.1.map(|along| along / factor);
    }
    let reason = format!(
        "displacements stay below {FARTHEST:e} of the smallest cell: Young's moduli are multiplied and prescribed displacements \
         divided by {factor}. Multiply computed displacements by it"
    );
    report.note("analysis.purpose", "limit-load", reason);
    factor
}

/// What is known of a case before its loads are.
pub(super) struct Preparation {
    /// By which Young's moduli were multiplied.
    pub(super) stiffness: f64,
    /// Names of what ends inside a cell.
    pub(super) inside_cells: Vec<String>,
}

/// What the case looks for, with columns of its history for each load; refuses what has no limit load, and warns of
/// what makes it wrong.
pub(super) fn complete(case: &mut Case, draft: &Draft, prepared: Preparation, report: &mut Report<'_>) {
    warn_of_averages(case, report);
    let Some(analysis) = draft.analysis.value().filter(|_| is_sought(draft)) else {
        return;
    };
    refuse(case, analysis, report);
    refuse_motions(case, analysis, &prepared.inside_cells, report);
    if case.solver.force_tolerance > FORCE_TOLERANCE {
        let message = format!(
            "E0451: `force_tolerance` is above {FORCE_TOLERANCE:e}, so limit loads would be several per cent too \
             high. Delete `force_tolerance`."
        );
        draft
            .solver
            .value()
            .into_iter()
            .for_each(|solver| solver.force_tolerance.error(&message, report));
    }
    warn_of_settings(case, report);
    let loads = sought(case);
    let small_cohesions = small_cohesions(case, &loads, report);
    let averages = case.stabilisation.averages();
    let stiffness = prepared.stiffness;
    case.limit_load = Some(LimitLoad {
        stiffness,
        loads,
        small_cohesions,
        averages,
    });
}

/// Refuses ground whose load depends on how far it is strained, and motions without a direction.
fn refuse(case: &Case, analysis: &AnalysisTable, report: &mut Report<'_>) {
    if case.analysis.kind != AnalysisType::QuasiStatic {
        let message = format!(
            "E0443: a limit load needs a quasi-static analysis, but the type of this analysis is \"{}\". Use \
             analysis.type = \"quasi-static\".",
            case.analysis.kind
        );
        analysis.purpose.error(message, report);
    }
    if case.flow.is_some() {
        let message = "E0444: purpose = \"limit-load\" raises Young's moduli, so the pore pressures of soil with \
             pore-water flow would be wrong. Delete `purpose`, or delete `drainage` of all materials.";
        analysis.purpose.error(message, report);
    }
    let is_divided = case.stages.iter().any(|stage| stage.strength_reduction.is_some());
    if case.strength_reduction.is_some() || is_divided {
        let message = "E0445: a limit load and strength reduction cannot be combined, because both change the \
                       stiffness. Delete analysis.purpose, or the strength reduction.";
        analysis.purpose.error(message, report);
    }
    if let Some(named) = case.materials.iter().find(|named| follows_strain(&named.material)) {
        let message = format!(
            "E0446: the strength or stiffness of material `{}` changes with strain, so it has no unique limit load. \
             Use a model with constant parameters, or delete `purpose` (then no limit load is computed).",
            named.name
        );
        analysis.purpose.error(message, report);
    }
}

/// Whether the strength or stiffness of a material changes with strain.
fn follows_strain(material: &LayeredMaterial) -> bool {
    material.softens() || material.hardens() || !material.is_linear()
}

/// Refuses motions along which no limit load is found.
fn refuse_motions(case: &Case, analysis: &AnalysisTable, inside_cells: &[String], report: &mut Report<'_>) {
    if let Some(rigid) = case
        .rigid
        .iter()
        .find(|rigid| !rigid.rotation.is_empty() || rigid.free.contains(&true))
    {
        let message = format!(
            "E0447: rigid body `{}` rotates or moves freely, but a limit load needs a prescribed translation. Delete \
             `rotation` and `free` of this rigid body.",
            rigid.name
        );
        analysis.purpose.error(message, report);
    }
    if let Some(name) = inside_cells.first() {
        let message = format!(
            "E0448: an end of `{name}` lies inside a cell, so limit loads cannot be extrapolated to finer grids. Put \
             a grid line at this end with grid.cell or [grid.knots]."
        );
        analysis.purpose.error(message, report);
    }
    let strips = case.footing.iter().map(|of| (of.site, &of.path));
    let strips = strips.chain(case.prescribed.iter().map(|of| (of.site, &of.path)));
    let rigid = case.rigid.iter().map(|rigid| &rigid.path);
    let mut paths = strips.clone().map(|(_, path)| path).chain(rigid);
    if paths.any(|path| path.moves() && !goes_on(path, case.analysis.end)) {
        let message = "E0449: a prescribed displacement starts late, stops or turns back, but a limit load needs \
                       one that grows from time 0 to analysis.end. Correct its path.";
        analysis.purpose.error(message, report);
    }
    if let Some(side) = strips
        .filter(|(_, path)| path.moves())
        .find_map(|(site, path)| opposed(case, site, path))
    {
        let message = format!(
            "E0450: boundary `{side}` restrains the soil where a displacement is prescribed. The boundary would carry \
             the whole load, and the recorded load would be zero. Use boundary.{side} = \"free\"."
        );
        analysis.purpose.error(message, report);
    }
}

/// Whether a path leads farther from the start all the time until the end of the run.
fn goes_on(path: &MotionPath, end: f64) -> bool {
    let times = path.rows.iter().map(|(t, _)| *t).filter(|t| *t < end).chain([end]);
    let moved = times.map(|t| path.at(t).iter().fold(0.0, |length: f64, along| length.hypot(*along)));
    let distances: Vec<f64> = std::iter::once(0.0).chain(moved).collect();
    distances.windows(2).all(|pair| pair[1] > pair[0])
}

/// The face on which a segment or plate lies and which holds the component along which it moves.
fn opposed(case: &Case, site: Site, path: &MotionPath) -> Option<&'static str> {
    if matches!(site, Site::Face(_)) {
        return None; // refused where it is read
    }
    let corners = site::corners(site, &case.grid);
    let lower = case.grid.lower();
    let upper = case.grid.upper();
    for (axis, sides) in Side::of(case.geometry).iter().enumerate() {
        let moves = path.rows.iter().any(|(_, moved)| moved[axis] != 0.0);
        for (end, side) in sides.iter().enumerate() {
            let at = [lower, upper][end][axis];
            let lies = corners.iter().all(|corner| corner[axis] == at);
            if lies && moves && matches!(case.boundary[axis][end], Support::Roller | Support::Fixed) {
                return Some(side.word());
            }
        }
    }
    None
}

/// Warns of points, and of flow rules, with which limit loads were shown to be off.
fn warn_of_settings(case: &Case, report: &mut Report<'_>) {
    let dilates = case.materials.iter().any(|named| named.material.dilation() > 0.0);
    let most = case
        .bodies
        .iter()
        .map(|body| body.points_per_cell)
        .max()
        .unwrap_or(POINTS);
    if dilates && most > POINTS {
        report.warn(format!(
            "W0423: body.points_per_cell: with {most} points along each axis of a cell, volumetric locking makes \
             limit loads of dilating soil up to 20 % too high. Use points_per_cell = {POINTS}."
        ));
    }
    if case.grid.order != 2 {
        report.warn(
            "W0424: grid.degree: limit loads are verified with quadratic splines only, so the error of the \
             extrapolated load is unknown. Use grid.degree = \"quadratic\".",
        );
    }
    let far_off = case.materials.iter().find(|named| {
        let friction = friction(&named.material);
        let dilation = named.material.dilation();
        friction > 0.0 && dilation < ASSOCIATED * friction
    });
    if let Some(named) = far_off {
        report.warn(format!(
            "W0425: material.{}: with a dilation angle below half the friction angle, limit loads vary by some per \
             cent with the grid. Compare the upper bound (dilation_angle = friction_angle).",
            named.name
        ));
    }
}

/// rad  friction angle, if the law has one
fn friction(material: &LayeredMaterial) -> f64 {
    let names = material.parameter_names().iter().map(|parameter| parameter.name);
    names
        .zip(material.parameters())
        .find(|(name, _)| *name == "friction_angle")
        .map_or(0.0, |(_, angle)| angle)
}

/// Warns of averaged volumetric strains in soil that dilates and has next to no cohesion under what is moved.
fn warn_of_averages(case: &Case, report: &mut Report<'_>) {
    let is_pushed = case.analysis.kind == AnalysisType::QuasiStatic && case.has_prescribed_motion();
    if !is_pushed || case.stabilisation != Stabilisation::ConsistentFBar {
        return;
    }
    let gravity = case
        .gravity
        .as_ref()
        .map_or(0.0, |gravity| gravity.acceleration[case.grid.dims() - 1].abs());
    let cell = case.grid.shortest();
    let loose = case.materials.iter().find(|named| {
        let weight = named.density.unwrap_or(0.0) * gravity * cell;
        named.material.dilation() > DILATES && cohesion(&named.material).is_some_and(|cohesion| cohesion < weight)
    });
    if let Some(named) = loose {
        report.warn(format!(
            "W0426: stabilisation.method: limit loads on material `{}`, which dilates and has little cohesion, are up \
             to 42 % wrong with this method. Use method = \"none\" with points_per_cell = 2.",
            named.name
        ));
    }
}

/// Pa  cohesion, if the law has one
fn cohesion(material: &LayeredMaterial) -> Option<f64> {
    let names = material.parameter_names().iter().map(|parameter| parameter.name);
    names
        .zip(material.parameters())
        .find(|(name, _)| *name == "cohesion")
        .map(|(_, cohesion)| cohesion)
}

/// Names the materials whose cohesion is small against the weight of as much soil as the narrowest strip is wide, and
/// warns of them.
fn small_cohesions(case: &Case, loads: &[SoughtLoad], report: &mut Report<'_>) -> Vec<String> {
    let width = loads
        .iter()
        .filter_map(|load| load.width)
        .map(|width| width.length)
        .reduce(f64::min);
    let Some(gravity) = &case.gravity else {
        return Vec::new();
    };
    let Some(width) = width else { return Vec::new() };
    let g = gravity.acceleration[case.grid.dims() - 1].abs();
    let mut small = Vec::new();
    for named in case.materials.iter().filter(|named| friction(&named.material) > 0.0) {
        let share = cohesion(&named.material)
            .zip(named.density)
            .map(|(cohesion, density)| cohesion / (density * g * width));
        let Some(share) = share.filter(|share| (0.0..SMALL_COHESION).contains(share) && *share > 0.0) else {
            continue;
        };
        report.warn(format!(
            "W0427: material.{}: the cohesion is small, c / (gamma B) = {share:.1e} (B: width of the load), but \
             raises the limit load. If the soil has no cohesion, set cohesion = 0.",
            named.name
        ));
        small.push(named.name.clone());
    }
    small
}
