//! Warns of rigid bodies that reach the faces of the grid.

use super::{OVERLAP, Outline, surfaces};
use crate::case::{Case, Face, Geometry, Rigid, RigidShape, Support};
use crate::report::Report;
use crate::schema::RigidTable;

/// Cells from a face within which a body touches it.
const TOUCHING: f64 = 0.1;

/// Warns of a body that no material can come to, and of half of one on half of the ground.
pub(super) fn check(case: &Case, rigid: &Rigid, record: &RigidTable, report: &mut Report<'_>) {
    let key = record.shape().place().path();
    if stays_outside(case, rigid) {
        report.warn(format!(
            "W0417: {key}: the rigid body lies outside the grid and never enters it, so it has no effect. Move the \
             rigid body, or enlarge the grid."
        ));
    } else if let Some((face, distance)) = touched(case, rigid) {
        report.warn(format!(
            "W0418: {key}: the rigid body, {distance:.3} m from boundary `{}`, moves out of the grid, because \
             boundaries stop soil, but not rigid bodies. Enlarge the grid on this side.",
            face.side(case.geometry)
        ));
    } else if rigid.free.contains(&true)
        && let Some(face) = cut(case, rigid)
    {
        report.warn(format!(
            "W0419: {key}: the symmetry plane `{}` cuts this free body, so its whole mass and force load the \
             modelled half of the soil. Give half the mass and force, and set free = [\"{}\"].",
            face.side(case.geometry),
            ["y", "x"][face.axis]
        ));
    }
}

/// Whether its reference point never comes as near to the grid as the body reaches, on its way and along what is free.
fn stays_outside(case: &Case, rigid: &Rigid) -> bool {
    let (reference, outline) = match &rigid.shape {
        RigidShape::InSpace(solid) => (solid.reference(), solid.outline()),
        RigidShape::Polygon(_) | RigidShape::Circle { .. } => (
            [rigid.about[0], rigid.about[1], 0.0],
            surfaces::outline(&rigid.shape, rigid.about),
        ),
    };
    if matches!(outline, Outline::Terrain(_)) {
        return false;
    }
    let lower = case.grid.lower();
    let upper = case.grid.upper();
    let reach = outline.radius();
    let rows: Vec<[f64; 3]> = std::iter::once([0.0; 3])
        .chain(rigid.path.rows.iter().map(|row| row.1))
        .collect();
    for (from, to) in rows.iter().zip(rows.iter().skip(1).chain(rows.last())) {
        let misses = (0..case.grid.dims()).any(|axis| {
            let is_free = case.grid.dims() == 2 && rigid.free[axis];
            let from = reference[axis] + from[axis];
            let to = reference[axis] + to[axis];
            !is_free && (from.max(to) + reach <= lower[axis] || from.min(to) - reach >= upper[axis])
        });
        if !misses {
            return false;
        }
    }
    true
}

/// The first roller that a body in the plane lies on both sides of; the axis of a body of revolution is none.
fn cut(case: &Case, rigid: &Rigid) -> Option<Face> {
    let slack = OVERLAP * case.grid.shortest();
    for face in (0..2).flat_map(|axis| [false, true].map(|upper| Face { axis, upper })) {
        let bound = if face.upper {
            case.grid.upper()
        } else {
            case.grid.lower()
        };
        let [least, most] = extent(rigid, face.axis);
        let is_axis = case.geometry == Geometry::Axisymmetric && face.axis == 0;
        let rolls = case.boundary[face.axis][usize::from(face.upper)] == Support::Roller;
        if rolls && !is_axis && least < bound[face.axis] - slack && most > bound[face.axis] + slack {
            return Some(face);
        }
    }
    None
}

/// The first face within a tenth of a cell of which a body in the plane lies, and to which a free motion goes by what
/// moves it at the start: its velocity, else its force and its weight; and the distance to it, m.
fn touched(case: &Case, rigid: &Rigid) -> Option<(Face, f64)> {
    if matches!(rigid.shape, RigidShape::InSpace(_)) {
        return None;
    }
    let faces = (0..2)
        .filter(|&axis| rigid.free[axis])
        .flat_map(|axis| [false, true].map(|upper| Face { axis, upper }));
    for face in faces {
        let Face { axis, upper } = face;
        let [least, most] = extent(rigid, axis);
        let (distance, sign) = match upper {
            true => (case.grid.upper()[axis] - most, 1.0),
            false => (least - case.grid.lower()[axis], -1.0),
        };
        let along = &case.grid.axes[axis];
        let cell = along.cell(if upper { along.cells() - 1 } else { 0 });
        let weight = case
            .gravity
            .as_ref()
            .map_or(0.0, |gravity| rigid.mass[0] * gravity.acceleration[axis]);
        let drive = if rigid.velocity[axis] != 0.0 {
            rigid.velocity[axis]
        } else {
            rigid.force[axis] + weight
        };
        let slack = OVERLAP * case.grid.shortest();
        if (-slack..TOUCHING * cell).contains(&distance) && sign * drive > 0.0 {
            return Some((face, distance.max(0.0)));
        }
    }
    None
}

/// m  from where to where a body in the plane reaches at the start.
fn extent(rigid: &Rigid, axis: usize) -> [f64; 2] {
    match &rigid.shape {
        RigidShape::Circle { center, radius } => [center[axis] - radius, center[axis] + radius],
        RigidShape::Polygon(corners) => {
            let along = corners.iter().map(|corner| corner[axis]);
            [
                along.clone().fold(f64::INFINITY, f64::min),
                along.fold(f64::NEG_INFINITY, f64::max),
            ]
        }
        RigidShape::InSpace(_) => [0.0; 2],
    }
}
