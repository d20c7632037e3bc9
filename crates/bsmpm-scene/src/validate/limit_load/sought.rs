//! Finds the loads that a limit load analysis seeks, with their columns in the history and their widths.

use crate::case::{Case, History, LoadWidth, MotionPath, Quantity, Rigid, RigidShape, Site, SoughtLoad};
use crate::observables::{HistorySubject, Observable};
use crate::surfaces::name_of_strip;
use crate::validate::place::flat;
use crate::validate::site;
use crate::words::{Geometry, Support};

/// Component of a unit vector from which on a motion counts as normal to a footing.
const ALONG_NORMAL: f64 = 1.0 - 1e-6;

/// The loads of everything that is moved; adds histories for those that the case does not record.
pub(super) fn sought(case: &mut Case) -> Vec<SoughtLoad> {
    let strips = case.footing.iter().map(|of| (of.site, of.path.clone()));
    let strips = strips.chain(case.prescribed.iter().map(|of| (of.site, of.path.clone())));
    let strips: Vec<_> = strips.enumerate().filter(|(_, (_, path))| path.moves()).collect();
    let mut loads = Vec::new();
    for (number, (site, path)) in strips {
        let name = name_of_strip(case, number);
        let moved = MovedObject {
            name,
            path,
            width: width_of_strip(case, site),
        };
        if case.footing.is_some() && number == 0 {
            loads.push(of_footing(case, moved));
            continue;
        }
        let quantity = Quantity::new(Observable::Reaction, HistorySubject::Strip(number));
        loads.push(recorded(case, quantity, along(&moved.path, 1.0), moved));
    }
    for body in 0..case.rigid.len() {
        let rigid = &case.rigid[body];
        if !rigid.path.moves() {
            continue;
        }
        let name = rigid.name.clone();
        let path = rigid.path.clone();
        let moved = MovedObject {
            name,
            path,
            width: width_of(case, rigid),
        };
        // The soil pushes it against its motion.
        let quantity = Quantity::new(Observable::RigidForce, HistorySubject::Rigid(body));
        loads.push(recorded(case, quantity, along(&moved.path, -1.0), moved));
    }
    loads
}

/// What is moved.
struct MovedObject {
    name: String,
    path: MotionPath,
    width: Option<LoadWidth>,
}

/// The footing's load: the case's own column of its pressure or force, or one more of the pressure; of a footing that
/// does not move along its normal the force along its motion.
fn of_footing(case: &mut Case, moved: MovedObject) -> SoughtLoad {
    let normal = case
        .footing
        .as_ref()
        .map_or([0.0; 3], |footing| site::normal_of(footing.site));
    let direction = along(&moved.path, 1.0);
    let part: f64 = direction.iter().zip(normal).map(|(along, normal)| along * normal).sum();
    if part.abs() < ALONG_NORMAL {
        let quantity = Quantity::new(Observable::Reaction, HistorySubject::Strip(0));
        return recorded(case, quantity, direction, moved);
    }
    let own = case.histories.iter().find(|history| {
        matches!(
            history.quantity.observable,
            Observable::FootingPressure | Observable::FootingForce
        )
    });
    match own {
        Some(own) => of_history(&own.clone(), &[1.0], moved),
        None => {
            let pressure = Quantity::new(Observable::FootingPressure, HistorySubject::Case);
            recorded(case, pressure, vec![1.0], moved)
        }
    }
}

/// Records a force, one component of it times each of the weights.
fn recorded(case: &mut Case, quantity: Quantity, weights: Vec<f64>, moved: MovedObject) -> SoughtLoad {
    if let Some(own) = case
        .histories
        .iter()
        .find(|history| history.quantity == quantity && history.scale == 1.0)
    {
        return of_history(&own.clone(), &weights, moved);
    }
    let mut name = format!("{}-load", moved.name);
    while has_columns(case, &name) {
        name.push_str("-of-all");
    }
    let history = History {
        quantity,
        name,
        scale: 1.0,
        geometry: case.geometry,
        lasts: false,
    };
    let load = of_history(&history, &weights, moved);
    case.histories.push(history);
    load
}

/// Whether a history of the case has columns of a name.
fn has_columns(case: &Case, name: &str) -> bool {
    let beginning = format!("{name}-");
    case.histories
        .iter()
        .any(|history| history.name == *name || history.name.starts_with(&beginning))
}

fn of_history(history: &History, weights: &[f64], moved: MovedObject) -> SoughtLoad {
    let columns = history.columns();
    let unit = columns[0].unit.clone();
    let columns = columns
        .into_iter()
        .map(|column| column.name)
        .zip(weights.iter().copied());
    let columns = columns.filter(|(_, weight)| *weight != 0.0).collect();
    SoughtLoad {
        name: moved.name,
        columns,
        unit,
        path: moved.path,
        width: moved.width,
    }
}

/// Unit vector from the start to the farthest place of a path, times a sign.
fn along(path: &MotionPath, sign: f64) -> Vec<f64> {
    let places = path.rows.iter().map(|(_, moved)| *moved);
    let farthest = places
        .reduce(|a, b| if length(b) > length(a) { b } else { a })
        .unwrap_or_default();
    farthest
        .iter()
        .map(|component| sign * component / length(farthest))
        .collect()
}

/// Length of a vector.
fn length(along: [f64; 3]) -> f64 {
    along[0].hypot(along[1]).hypot(along[2])
}

/// Width of a strip; of a plate that of its shorter side.
fn width_of_strip(case: &Case, site: Site) -> Option<LoadWidth> {
    let [from, to] = match site {
        Site::Face(_) => return None,
        Site::Segment { .. } | Site::Plate(_) => site::corners(site, &case.grid),
    };
    let sides = (0..case.grid.dims()).filter(|axis| from[*axis] != to[*axis]);
    narrowest(sides.map(|axis| side(case, axis, from[axis].min(to[axis]), from[axis].max(to[axis]))))
}

/// Width of the box around a rigid body, across its direction of motion.
fn width_of(case: &Case, rigid: &Rigid) -> Option<LoadWidth> {
    let [lower, upper] = match &rigid.shape {
        RigidShape::Circle { center, radius } => [-radius, *radius].map(|by| flat(center.map(|at| at + by))),
        RigidShape::Polygon(corners) => bsmpm_shapes::polygon::bounds(corners).map(flat),
        RigidShape::InSpace(solid) => solid.corners(),
    };
    let direction: Vec<f64> = along(&rigid.path, 1.0).into_iter().map(f64::abs).collect();
    let main = direction.iter().copied().fold(0.0, f64::max);
    let across = (0..case.grid.dims()).filter(|axis| direction[*axis] < main);
    narrowest(across.map(|axis| side(case, axis, lower[axis], upper[axis])))
}

/// The shortest of several sides, with the part of all of them that is modelled.
fn narrowest(sides: impl Iterator<Item = LoadWidth>) -> Option<LoadWidth> {
    let sides: Vec<LoadWidth> = sides.collect();
    let modelled = sides.iter().map(|side| side.modelled).product();
    let shortest = sides.into_iter().min_by(|a, b| a.length.total_cmp(&b.length));
    shortest
        .filter(|side| side.length.is_finite())
        .map(|side| LoadWidth { modelled, ..side })
}

/// A side along an axis, given by its ends (m). Where one of them lies on a roller or beyond it, that is a plane of
/// symmetry, and the whole is twice what lies inside.
fn side(case: &Case, axis: usize, lower: f64, upper: f64) -> LoadWidth {
    let cells = &case.grid.axes[axis];
    let faces = [case.grid.lower()[axis], case.grid.upper()[axis]];
    let rolls = case.boundary[axis].map(|support| support == Support::Roller);
    let is_axis = case.geometry == Geometry::Axisymmetric && axis == 0;
    let is_cut = [
        (rolls[0] || is_axis) && lower <= faces[0],
        rolls[1] && upper >= faces[1],
    ];
    let first = lower.max(faces[0]);
    let last = upper.min(faces[1]);
    let parts = (0..cells.cells()).map(|i| {
        let [from, to] = [i, i + 1].map(|i| cells.lower() + cells.breakpoint(i));
        (to.min(last) - from.max(first)).max(0.0) / (to - from)
    });
    let count: f64 = parts.sum();
    let whole = if is_cut[0] != is_cut[1] { 2.0 } else { 1.0 };
    LoadWidth {
        length: whole * (last - first),
        cells: whole * count,
        modelled: 1.0 / whole,
    }
}
