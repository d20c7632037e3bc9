//! `[analysis] purpose = "limit-load"`: the ground becomes stiff, and prescribed displacements small, in the same
//! proportion. The geometry then stays as drawn, as in the theory of plasticity, and the load at failure does not
//! depend on the stiffness (measured: 1.4 % for ten times the stiffness of the shipped rule; finite strain in the cell
//! at a footing's edge, 10 to 30 %).

use super::site;
use crate::case::{
    Case, Footing, History, LimitLoad, MotionPath, NamedMaterial, Prescribed, Quantity, Rigid, RigidShape, Site,
    SoughtLoad,
};
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::surfaces::name_of_strip;
use crate::words::{AnalysisType, Measurement, Purpose, Support};
use bsmpm::material::Material;
use bsmpm::stabilisation::Stabilisation;

/// Part of the smallest cell by which anything moves in the whole run. Finite strain in the cell at a footing's edge
/// makes the load grow on: N_gamma for a friction angle of 25 degrees, 16 cells, is 20.8 % above the exact value with
/// 2e-3, and 19.8 % with 1e-3.
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
/// The key and its table.
const KEY: &str = "purpose";

/// Everything that a case moves, or may move.
pub(super) struct MovedBodies<'a> {
    pub(super) footing: Option<&'a mut Footing>,
    pub(super) prescribed: &'a mut [Prescribed],
    pub(super) rigid: &'a mut [Rigid],
}

impl MovedBodies<'_> {
    fn paths(&mut self) -> impl Iterator<Item = &mut MotionPath> {
        let footing = self.footing.iter_mut().map(|footing| &mut footing.path);
        let prescribed = self.prescribed.iter_mut().map(|prescribed| &mut prescribed.path);
        footing.chain(prescribed).chain(self.rigid.iter_mut().map(|rigid| &mut rigid.path))
    }
}

/// Whether the case seeks a limit load.
pub(super) fn is_sought(root: &Record) -> bool {
    root.record("analysis").and_then(|analysis| analysis.word("purpose")) == Some(Purpose::LimitLoad)
}

/// Divides the prescribed displacements of a case that seeks a limit load; returns the factor, by which Young's moduli
/// are to be multiplied. 1 for other cases.
pub(super) fn shrink(
    root: &Record,
    grid: Option<&GridSpec>,
    mut moved: MovedBodies<'_>,
    report: &mut Report<'_>,
) -> f64 {
    let Some(analysis) = root.record("analysis").filter(|_| is_sought(root)) else { return 1.0 };
    let farthest = moved.paths().map(|path| path.farthest()).fold(0.0, f64::max);
    if farthest == 0.0 {
        let message = "nothing moves: give [footing], [[prescribed]] or [[rigid]] a displacement. For the factor of safety \
                       of ground under dead load use `bsmpm fos`";
        analysis.error(KEY, message, report);
        return 1.0;
    }
    let Some(grid) = grid else { return 1.0 };
    let needed = farthest / (FARTHEST * grid.shortest());
    let factor: f64 = format!("{:.2e}", needed.max(1.0)).parse().unwrap_or(needed);
    for row in moved.paths().flat_map(|path| &mut path.rows) {
        row.1 = row.1.map(|along| along / factor);
    }
    let reason = format!(
        "displacements up to {FARTHEST:e} of the smallest cell: Young's moduli x {factor}, prescribed displacements / {factor}; \
         multiply displacements by it"
    );
    report.note("analysis.purpose", "limit-load", reason);
    factor
}

/// What the case looks for, with columns of its history for each load; refuses what has no limit load, and warns of
/// what makes it wrong.
pub(super) fn complete(case: &mut Case, root: &Record, stiffness: f64, report: &mut Report<'_>) {
    warn_of_averages(case, report);
    let Some(analysis) = root.record("analysis").filter(|_| is_sought(root)) else { return };
    refuse(case, analysis, report);
    if case.solver.force_tolerance > FORCE_TOLERANCE {
        let message = format!("limit loads are wrong with more than {FORCE_TOLERANCE:e}. Delete it");
        root.record("solver").into_iter().for_each(|solver| solver.error("force_tolerance", &message, report));
    }
    warn_of_settings(case, report);
    let loads = sought(case);
    let small_cohesions = small_cohesions(case, &loads, report);
    let averages = case.stabilisation.averages();
    case.limit_load = Some(LimitLoad { stiffness, loads, small_cohesions, averages });
}

/// Refuses ground whose load depends on how far it is strained, and motions without a direction.
fn refuse(case: &Case, analysis: &Record, report: &mut Report<'_>) {
    if case.analysis.kind != AnalysisType::QuasiStatic {
        let message = format!("a limit load needs type = \"quasi-static\", and this is {}", case.analysis.kind);
        analysis.error(KEY, message, report);
    }
    if case.flow.is_some() {
        let message = "not available where water flows: its pressure depends on the stiffness. Delete it";
        analysis.error(KEY, message, report);
    }
    if case.strength_reduction.is_some() {
        analysis.error(KEY, "[strength_reduction] chooses a stiffness, too. Delete one of them", report);
    }
    let follows_strain = |material: &Material| material.softens() || material.hardens() || !material.is_linear();
    if let Some(named) = case.materials.iter().find(|named| follows_strain(&named.material)) {
        let message = format!(
            "the strength or stiffness of material.{} depends on its strain, so that its largest load depends on the \
             displacement. Delete it",
            named.name
        );
        analysis.error(KEY, message, report);
    }
    if let Some(rigid) = case.rigid.iter().find(|rigid| !rigid.rotation.is_empty() || rigid.free.contains(&true)) {
        let message = format!(
            "rigid `{}` rotates or is free; a limit load is sought along a prescribed path. Delete `rotation` and `free`",
            rigid.name
        );
        analysis.error(KEY, message, report);
    }
}

/// Warns of points, and of flow rules, with which limit loads were shown to be off.
fn warn_of_settings(case: &Case, report: &mut Report<'_>) {
    let dilates = case.materials.iter().any(|named| named.material.dilation() > 0.0);
    let most = case.bodies.iter().map(|body| body.points_per_cell).max().unwrap_or(POINTS);
    if dilates && most > POINTS {
        report.warn(format!(
            "points_per_cell: {most} lock soil that dilates; limit loads are up to 20 % higher than with {POINTS}. Use \
             points_per_cell = {POINTS}."
        ));
    }
    let is_far_off = |named: &&NamedMaterial| {
        let (friction, dilation) = (friction(&named.material), named.material.dilation());
        friction > 0.0 && dilation < ASSOCIATED * friction
    };
    if let Some(named) = case.materials.iter().find(is_far_off) {
        report.warn(format!(
            "material.{}: its dilation angle is less than half of its friction angle. Such soil has no unique limit load: it \
             varies by some per cent with steps and cells. Compare with dilation = friction, which is an upper bound.",
            named.name
        ));
    }
}

/// rad  friction angle, if the law has one
fn friction(material: &Material) -> f64 {
    let names = material.parameter_names().iter().map(|parameter| parameter.name);
    names.zip(material.parameters()).find(|(name, _)| *name == "friction").map_or(0.0, |(_, angle)| angle)
}

/// Warns of averaged volumetric strains in soil that dilates and has next to no cohesion under what is moved.
fn warn_of_averages(case: &Case, report: &mut Report<'_>) {
    let is_pushed = case.analysis.kind == AnalysisType::QuasiStatic && case.has_prescribed_motion();
    if !is_pushed || case.stabilisation != Stabilisation::ConsistentFBar {
        return;
    }
    let gravity = case.gravity.as_ref().map_or(0.0, |gravity| gravity.acceleration[case.grid.dims() - 1].abs());
    let cell = case.grid.shortest();
    let is_loose = |named: &&NamedMaterial| {
        let weight = named.density.unwrap_or(0.0) * gravity * cell;
        named.material.dilation() > DILATES && cohesion(&named.material).is_some_and(|cohesion| cohesion < weight)
    };
    if let Some(named) = case.materials.iter().find(is_loose) {
        report.warn(format!(
            "stabilisation.method: \"consistent-f-bar\" is wrong for material.{}, which dilates and has next to no cohesion: the \
             bearing capacity of a smooth strip was 32 % too low. Use \"none\" with points_per_cell = 2, or analysis.purpose = \
             \"limit-load\".",
            named.name
        ));
    }
}

/// Pa  cohesion, if the law has one
fn cohesion(material: &Material) -> Option<f64> {
    let names = material.parameter_names().iter().map(|parameter| parameter.name);
    names.zip(material.parameters()).find(|(name, _)| *name == "cohesion").map(|(_, cohesion)| cohesion)
}

/// Names the materials whose cohesion is small against the weight of as much soil as the narrowest strip is wide, and
/// warns of them.
fn small_cohesions(case: &Case, loads: &[SoughtLoad], report: &mut Report<'_>) -> Vec<String> {
    let width = loads.iter().filter_map(|load| load.width).reduce(f64::min);
    let (Some(gravity), Some(width)) = (&case.gravity, width) else { return Vec::new() };
    let g = gravity.acceleration[case.grid.dims() - 1].abs();
    let share = |named: &NamedMaterial| Some(cohesion(&named.material)? / (named.density? * g * width));
    let mut small = Vec::new();
    for named in case.materials.iter().filter(|named| friction(&named.material) > 0.0) {
        let Some(share) = share(named).filter(|share| (0.0..SMALL_COHESION).contains(share) && *share > 0.0) else {
            continue;
        };
        report.warn(format!(
            "material.{}: its cohesion is {share:.1e} of the weight per area of soil as deep as the load is wide. Small as it is, \
             it carries a part of the load: 1.2e-2 raised that of a strip on sand by 14 %. `bsmpm limit-load` tells its part.",
            named.name
        ));
        small.push(named.name.clone());
    }
    small
}

/// The loads of everything that is moved; adds histories for those that the case does not record.
fn sought(case: &mut Case) -> Vec<SoughtLoad> {
    let strips = case.footing.iter().map(|of| (of.site, of.path.clone()));
    let strips = strips.chain(case.prescribed.iter().map(|of| (of.site, of.path.clone())));
    let strips: Vec<_> = strips.enumerate().filter(|(_, (_, path))| path.moves()).collect();
    let mut loads = Vec::new();
    for (number, (site, path)) in strips {
        let name = name_of_strip(case, number);
        let moved = Moved { name, path, width: width_of_strip(case, site) };
        if case.footing.is_some() && number == 0 {
            loads.push(of_footing(case, moved));
            continue;
        }
        let quantity = Quantity::Strip { number, measured: Measurement::Reaction };
        loads.push(recorded(case, quantity, along(&moved.path, 1.0), moved));
    }
    for body in 0..case.rigid.len() {
        let rigid = &case.rigid[body];
        if !rigid.path.moves() {
            continue;
        }
        let name = rigid.name.clone();
        let path = rigid.path.clone();
        let moved = Moved { name, path, width: width_of(rigid) };
        // The soil pushes it against its motion.
        let quantity = Quantity::Rigid { what: Measurement::RigidForce, body };
        loads.push(recorded(case, quantity, along(&moved.path, -1.0), moved));
    }
    loads
}

/// What is moved.
struct Moved {
    name: String,
    path: MotionPath,
    width: Option<f64>, // m
}

/// The footing's load: the case's own column of its pressure or force, or one more of the pressure.
fn of_footing(case: &mut Case, moved: Moved) -> SoughtLoad {
    let is_own = |history: &&History| matches!(history.quantity, Quantity::FootingPressure | Quantity::FootingForce);
    match case.histories.iter().find(is_own) {
        Some(own) => of_history(&own.clone(), &[1.0], moved),
        None => recorded(case, Quantity::FootingPressure, vec![1.0], moved),
    }
}

/// Records a force, one component of it times each of the weights.
fn recorded(case: &mut Case, quantity: Quantity, weights: Vec<f64>, moved: Moved) -> SoughtLoad {
    if let Some(own) = case.histories.iter().find(|history| history.quantity == quantity && history.scale == 1.0) {
        return of_history(&own.clone(), &weights, moved);
    }
    let columns = |name: &str| -> bool {
        let beginning = format!("{name}-");
        case.histories.iter().any(|history| history.name == *name || history.name.starts_with(&beginning))
    };
    let mut name = format!("{}-load", moved.name);
    while columns(&name) {
        name.push_str("-of-all");
    }
    let history = History { quantity, name, scale: 1.0, geometry: case.geometry, lasts: false };
    let load = of_history(&history, &weights, moved);
    case.histories.push(history);
    load
}

fn of_history(history: &History, weights: &[f64], moved: Moved) -> SoughtLoad {
    let columns = history.columns();
    let unit = columns[0].unit.clone();
    let columns = columns.into_iter().map(|column| column.name).zip(weights.iter().copied());
    let columns = columns.filter(|(_, weight)| *weight != 0.0).collect();
    SoughtLoad { name: moved.name, columns, unit, path: moved.path, width: moved.width }
}

/// Unit vector from the start to the farthest place of a path, times a sign.
fn along(path: &MotionPath, sign: f64) -> Vec<f64> {
    let size = |along: &[f64; 3]| along[0].hypot(along[1]).hypot(along[2]);
    let places = path.rows.iter().map(|(_, moved)| *moved);
    let farthest = places.reduce(|a, b| if size(&b) > size(&a) { b } else { a }).unwrap_or_default();
    farthest.iter().map(|component| sign * component / size(&farthest)).collect()
}

/// m  Width of a strip, twice what is there where one of its ends lies on a roller, which is its middle; of a plate the
/// shorter side.
fn width_of_strip(case: &Case, site: Site) -> Option<f64> {
    let [from, to] = match site {
        Site::Face(_) => return None,
        Site::Segment { .. } | Site::Plate(_) => site::corners(site, &case.grid),
    };
    let widths = (0..case.grid.dims()).filter(|axis| from[*axis] != to[*axis]).map(|axis| {
        let ends = [from[axis].min(to[axis]), from[axis].max(to[axis])];
        let faces = [case.grid.lower()[axis], case.grid.upper()[axis]];
        let is_cut = |side: &usize| case.boundary[axis][*side] == Support::Roller && ends[*side] == faces[*side];
        let is_half = (0..2).filter(is_cut).count() == 1;
        (ends[1] - ends[0]) * if is_half { 2.0 } else { 1.0 }
    });
    widths.reduce(f64::min)
}

/// m  Width of a rigid body across its way: of the sides of the box around it the shortest that it does not move along.
fn width_of(rigid: &Rigid) -> Option<f64> {
    let flat = |[lower, upper]: [[f64; 2]; 2]| vec![upper[0] - lower[0], upper[1] - lower[1]];
    let sides = match &rigid.shape {
        RigidShape::Circle { radius, .. } => vec![2.0 * radius; 2],
        RigidShape::Polygon(corners) => flat(crate::region::bounds(corners)),
        RigidShape::InSpace(solid) => {
            let [lower, upper] = solid.corners();
            (0..3).map(|axis| upper[axis] - lower[axis]).collect()
        }
    };
    let way = along(&rigid.path, 1.0).into_iter().map(f64::abs);
    let main = way.clone().fold(0.0, f64::max);
    let across = sides.into_iter().zip(way).filter(|(_, part)| *part < main).map(|(side, _)| side);
    across.reduce(f64::min).filter(|width| width.is_finite())
}
