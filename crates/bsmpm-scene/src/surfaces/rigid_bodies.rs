//! Converts rigid bodies of a case to types of `bsmpm`.

use super::course;
use crate::{ActiveLoads, Case, Geometry, Rigid, RigidShape};
use bsmpm::interactions::rigid::Outline;
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::schedule::between;
use bsmpm::tensor::Vector;

/// Rigid bodies in the order of the file, once the stages until the time `t` have begun.
pub fn rigid<const D: usize>(case: &Case, t: f64) -> Vec<RigidBody<D>> {
    let divided = case.divided_at(t);
    let mut bodies = Vec::new();
    for (number, rigid) in case.rigid.iter().enumerate() {
        let since = case.acts_since(ActiveLoads::Rigid(number), t);
        let begun = since.filter(|since| *since > 0.0 && rigid.force != [0.0; 3]);
        let later = begun.map(|since| Rigid {
            amplitude: course(rigid.ramp, &rigid.amplitude, since),
            ..rigid.clone()
        });
        bodies.push(RigidBody {
            acts: since.is_some(),
            friction: rigid.friction / divided,
            ..rigid_body(later.as_ref().unwrap_or(rigid), case.grid.lower(), case.geometry)
        });
    }
    bodies
}

/// An outline about a reference point, both in m.
pub(crate) fn outline(shape: &RigidShape, about: [f64; 2]) -> Outline {
    match shape {
        RigidShape::Polygon(corners) => Outline::Polygon(
            corners
                .iter()
                .map(|corner| Vector::from(*corner) - Vector::from(about))
                .collect(),
        ),
        RigidShape::Circle { radius, .. } => Outline::Circle(*radius),
        RigidShape::InSpace(solid) => solid.outline(),
    }
}

/// A rigid body as the physics wants it, of a grid with this lower corner.
pub(crate) fn rigid_body<const D: usize>(rigid: &Rigid, lower: [f64; 3], geometry: Geometry) -> RigidBody<D> {
    let mut times: Vec<f64> = rigid
        .path
        .rows
        .iter()
        .map(|row| row.0)
        .chain(rigid.rotation.iter().map(|row| row.0))
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let reference = match &rigid.shape {
        RigidShape::InSpace(solid) => solid.reference(),
        RigidShape::Polygon(_) | RigidShape::Circle { .. } => [rigid.about[0], rigid.about[1], 0.0],
    };
    let outline = match outline(&rigid.shape, rigid.about) {
        Outline::Terrain(mut terrain) => {
            (0..2).for_each(|axis| terrain.lower[axis] -= lower[axis]);
            terrain.heights.iter_mut().for_each(|height| *height -= lower[2]);
            Outline::Terrain(terrain)
        }
        outline => outline,
    };
    let center = match outline {
        Outline::Terrain(_) => Vector::zeros(),
        _ => Vector::from_fn(|axis, _| reference[axis] - lower[axis]),
    };
    let force = Vector::<3>::from(rigid.force) / geometry.whole();
    let load = match (rigid.force == [0.0; 3], rigid.amplitude.is_empty()) {
        (true, _) => Vec::new(),
        (_, true) => vec![(rigid.ramp, force)],
        (_, false) => rigid
            .amplitude
            .iter()
            .map(|(t, share)| (*t, force.component_mul(share)))
            .collect(),
    };
    RigidBody {
        acts: true,
        outline,
        center,
        friction: rigid.friction,
        free: rigid.free,
        path: times.into_iter().map(|t| (t, motion::<D>(rigid, t))).collect(),
        mass: Vector::<3>::new(rigid.mass[0], rigid.mass[0], rigid.mass[1]) / geometry.whole(),
        load,
        velocity: Vector::from(rigid.velocity),
    }
}
/// Displacement of a rigid body at the time `t`, m; in a plane its last component is the angle.
fn motion<const D: usize>(rigid: &Rigid, t: f64) -> Vector<3> {
    let rows = rigid.path.rows.iter().map(|(t, moved)| (*t, Vector::from(*moved)));
    let rows: Vec<(f64, Vector<3>)> = rows.collect();
    let last = rows.last().map_or_else(Vector::zeros, |(_, moved)| *moved);
    let moved = between(&rows, Vector::zeros(), t).unwrap_or(last);
    let turned = rigid.rotation.last().map_or(0.0, |(_, angle)| *angle);
    let turned = between(&rigid.rotation, 0.0, t).unwrap_or(turned);
    Vector::<3>::new(moved[0], moved[1], if D == 2 { turned } else { moved[2] })
}
