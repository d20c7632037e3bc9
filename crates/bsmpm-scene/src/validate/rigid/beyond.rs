//! Rigid bodies and the faces of the grid, which hold material and not them.

use super::{OVERLAP, Outline, surfaces};
use crate::case::{Case, Face, Geometry, Rigid, RigidShape, Support};
use crate::record::Record;
use crate::report::Report;
use crate::validate::shape;

/// Warns of a body that no material can come to, and of half of one on half of the ground.
pub(super) fn check(case: &Case, rigid: &Rigid, record: &Record, report: &mut Report<'_>) {
    let key = record.path_of(shape::key(record));
    if stays_outside(case, rigid) {
        report.warn(format!("{key}: it lies outside of the grid and does not come into it: it does nothing"));
    } else if rigid.free.contains(&true)
        && let Some(face) = cut(case, rigid)
    {
        report.warn(format!(
            "{key}: it lies on both sides of {}, a plane of symmetry if the ground goes on alike there: its mass, force and \
             inertia are those of the whole body, and bear on this side alone; give half of them, and `free` only along \
             that face",
            face.side(case.geometry)
        ));
    }
}

/// Whether its reference point never comes as near to the grid as the body reaches, on its way and along what is free.
fn stays_outside(case: &Case, rigid: &Rigid) -> bool {
    let (reference, outline) = match &rigid.shape {
        RigidShape::InSpace(solid) => (solid.reference(), solid.outline()),
        RigidShape::Polygon(_) | RigidShape::Circle { .. } => {
            ([rigid.about[0], rigid.about[1], 0.0], surfaces::outline(&rigid.shape, rigid.about))
        }
    };
    if matches!(outline, Outline::Terrain(_)) {
        return false;
    }
    let (lower, upper, reach) = (case.grid.lower(), case.grid.upper(), outline.radius());
    let rows: Vec<[f64; 3]> = std::iter::once([0.0; 3]).chain(rigid.path.rows.iter().map(|row| row.1)).collect();
    let misses = |axis: usize, from: f64, to: f64| {
        let is_free = case.grid.dims() == 2 && rigid.free[axis];
        let (from, to) = (reference[axis] + from, reference[axis] + to);
        !is_free && (from.max(to) + reach <= lower[axis] || from.min(to) - reach >= upper[axis])
    };
    let pieces = rows.iter().zip(rows.iter().skip(1).chain(rows.last()));
    let mut pieces = pieces.map(|(from, to)| (0..case.grid.dims()).any(|axis| misses(axis, from[axis], to[axis])));
    pieces.all(|misses| misses)
}

/// The first roller that a body in the plane lies on both sides of; the axis of a body of revolution is none.
fn cut(case: &Case, rigid: &Rigid) -> Option<Face> {
    let slack = OVERLAP * case.grid.shortest();
    let mut faces = (0..2).flat_map(|axis| [false, true].map(|upper| Face { axis, upper }));
    faces.find(|face| {
        let bound = if face.upper { case.grid.upper() } else { case.grid.lower() };
        let [least, most] = extent(rigid, face.axis);
        let is_axis = case.geometry == Geometry::Axisymmetric && face.axis == 0;
        let rolls = case.boundary[face.axis][usize::from(face.upper)] == Support::Roller;
        rolls && !is_axis && least < bound[face.axis] - slack && most > bound[face.axis] + slack
    })
}

/// m  from where to where a body in the plane reaches at the start.
fn extent(rigid: &Rigid, axis: usize) -> [f64; 2] {
    match &rigid.shape {
        RigidShape::Circle { center, radius } => [center[axis] - radius, center[axis] + radius],
        RigidShape::Polygon(corners) => {
            let along = || corners.iter().map(|corner| corner[axis]);
            [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
        }
        RigidShape::InSpace(_) => [0.0; 2],
    }
}
