//! Validates rigid bodies in 3-D.

use super::super::shape::{cuboid, raster};
use super::super::site::AroundStrip;
use super::overlap::{inside, together};
use super::{OVERLAP, Solidity, friction, way};
use crate::case::{Case, Rigid, RigidShape, RigidSolid};
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::{RevolveTable, RigidTable, ShapeKey};
use crate::shape_error;
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::interactions::rigid::{Outline, Terrain};
use bsmpm::tensor::Vector;

/// Places along an edge of what two boxes share at which a body is looked for.
const PLACES: usize = 24;

/// A rigid body; `None` after an error.
pub(super) fn read(
    record: &RigidTable,
    around: AroundStrip<'_>,
    factor: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Rigid> {
    if let ShapeKey::Polygon(_) | ShapeKey::Circle(_) = record.shape() {
        let message = "E0432: this shape is not available for rigid bodies in 3-D. Use `box`, `sphere`, `revolve` or \
                       `terrain`.";
        record.shape().place().error(message, report);
        return None;
    }
    let in_a_plane: [&KeyPlace; 13] = [
        &record.rotation,
        &record.about,
        &record.free,
        &record.mass,
        &record.density,
        &record.inertia,
        &record.force,
        &record.force_path,
        &record.moment,
        &record.ramp,
        &record.amplitude,
        &record.start_velocity,
        &record.start_spin,
    ];
    if let Some(key) = in_a_plane.into_iter().find(|key| key.is_given()) {
        let message = "E0433: this key is not available in 3-D, where rigid bodies can only translate along a \
                       prescribed path. Use `displacement`, `velocity` or `path`.";
        key.error(message, report);
        return None;
    }
    let shape = shape(record.shape(), report);
    let path = way(record, around.end, report);
    let rigid = Rigid {
        name: record.name.text()?.to_owned(),
        shape: RigidShape::InSpace(shape?),
        about: [0.0; 2],
        friction: friction(record, factor, report)?,
        path: path?,
        rotation: Vec::new(),
        free: [false; 3],
        mass: [0.0; 2],
        force: [0.0; 3],
        ramp: 0.0,
        amplitude: Vec::new(),
        velocity: [0.0; 3],
    };
    Some(rigid)
}

fn shape(key: ShapeKey<'_>, report: &mut Report<'_>) -> Option<RigidSolid> {
    match key {
        ShapeKey::Sphere(key) => {
            let (center, radius) = key.value()?.sphere()?;
            Some(RigidSolid::Sphere { center, radius })
        }
        ShapeKey::Revolve(key) => revolved(key.value()?, report),
        ShapeKey::Ground(key) => {
            let top = &key.value()?.top;
            match raster(top, f64::NEG_INFINITY)? {
                Ok(raster) => Some(RigidSolid::Terrain(Terrain {
                    lower: raster.lower(),
                    spacing: raster.spacing(),
                    count: raster.count(),
                    heights: raster.top().to_vec(),
                })),
                Err(error) => {
                    top.error(shape_error::of_raster(&error), report);
                    None
                }
            }
        }
        ShapeKey::Box(key) => {
            let [lower, upper] = cuboid(key, report)?;
            Some(RigidSolid::Box { lower, upper })
        }
        _ => None,
    }
}

/// A polygon about a vertical, with its mirror image where it reaches that.
fn revolved(shape: &RevolveTable, report: &mut Report<'_>) -> Option<RigidSolid> {
    let RigidShape::Polygon(mut corners) = super::shape::rigid(shape.outline(), report)? else {
        shape.circle.error(
            "E0432: `revolve` needs a polygon, but this shape is a circle. Use `polygon`, or replace `revolve` by \
             `sphere`.",
            report,
        );
        return None;
    };
    if let Some(corner) = corners.iter().find(|corner| corner[0] < 0.0) {
        let message = format!(
            "E0434: a corner of the polygon has the radius {} m, but a distance from the axis cannot be negative. \
             Move the polygon to radii of 0 or more.",
            corner[0]
        );
        shape.polygon.error(message, report);
        return None;
    }
    let count = corners.len();
    let on_axis = (0..count).find(|k| corners[*k][0] == 0.0 && corners[(k + 1) % count][0] == 0.0);
    if let Some(last) = on_axis {
        corners.rotate_left((last + 1) % count);
        let mirrored: Vec<[f64; 2]> = corners[1..count - 1].iter().rev().map(|[r, z]| [-r, *z]).collect();
        corners.extend(mirrored);
    }
    Some(RigidSolid::Revolved {
        about: shape.about.get()?,
        corners,
    })
}

/// What of a rigid body in space the cells and steps must resolve.
pub(super) fn solidity(solid: &RigidSolid) -> Solidity {
    let outline = match solid.outline() {
        Outline::Revolved(corners) => Outline::Polygon(corners),
        outline => outline,
    };
    let thickness = match solid {
        RigidSolid::Box { lower, upper } => (0..3).map(|k| upper[k] - lower[k]).fold(f64::INFINITY, f64::min),
        RigidSolid::Sphere { radius, .. } => 2.0 * radius,
        RigidSolid::Revolved { corners, .. } => super::thickness(corners),
        RigidSolid::Terrain(_) => f64::INFINITY,
    };
    Solidity {
        outline,
        thickness,
        corner: [solid.reference()[0], solid.reference()[2]],
    }
}

/// No body is in it when that comes, and its outline lies within the heights that are given.
pub(super) fn check(
    case: &Case,
    place: usize,
    rigid: &Rigid,
    solid: &RigidSolid,
    record: &RigidTable,
    report: &mut Report<'_>,
) {
    let cell = case.grid.shortest();
    let key = record.shape().place();
    let body = crate::surfaces::rigid_body::<3>(rigid, [0.0; 3], case.geometry);
    for (number, of) in case.bodies.iter().enumerate() {
        let Some(stage) = together(case, place, number) else {
            continue;
        };
        let moved = body.on_path(stage.map_or(0.0, |stage| stage.at));
        let mut places = places(solid, &moved, of.region.corners(), cell).into_iter();
        let found = places.find(|at| of.region.contains_in_space(*at) && depth(&body, &moved, *at) > OVERLAP * cell);
        if let Some([x, y, z]) = found {
            let message = inside(case, place, number, &format!("{x:.4}, {y:.4}, {z:.4}"));
            key.error(message, report);
        }
    }
    let RigidSolid::Terrain(terrain) = solid else { return };
    let ends_inside = (0..2).any(|axis| {
        let lower = case.grid.axes[axis].lower();
        let upper = case.grid.axes[axis].lower() + case.grid.axes[axis].length();
        let far = terrain.lower[axis] + (terrain.count[axis] - 1) as f64 * terrain.spacing[axis];
        terrain.lower[axis] > lower + 0.5 * cell || far < upper - 0.5 * cell
    });
    if ends_inside {
        report.warn(format!(
            "W0420: {}: the terrain heights end inside the grid, and the terrain continues horizontally from there. \
             Give heights up to the edges of the grid.",
            key.path()
        ));
    }
}

/// How deep a place is in a rigid body that has moved, m.
fn depth(body: &RigidBody<3>, moved: &Vector<3>, at: [f64; 3]) -> f64 {
    let seen = body.pose(moved).seen(&Vector::from(at));
    -body.outline.nearest(&seen).distance
}

/// Places at which a body between two corners is looked for in a rigid one that has moved: all over what their boxes
/// share, and below the posts of terrain, whose ridges may be narrower than that.
fn places(solid: &RigidSolid, moved: &Vector<3>, of: [[f64; 3]; 2], cell: f64) -> Vec<[f64; 3]> {
    let own = solid.corners();
    let lower: [f64; 3] = std::array::from_fn(|axis| of[0][axis].max(own[0][axis] + moved[axis]));
    let edges: [f64; 3] = std::array::from_fn(|axis| of[1][axis].min(own[1][axis] + moved[axis]) - lower[axis]);
    let count = if edges.iter().all(|edge| *edge > 0.0) {
        PLACES.pow(3)
    } else {
        0
    };
    let places = (0..count).map(|n| {
        let k = [n / PLACES / PLACES, n / PLACES % PLACES, n % PLACES];
        std::array::from_fn(|axis| lower[axis] + (k[axis] as f64 + 0.5) / PLACES as f64 * edges[axis])
    });
    let mut places: Vec<[f64; 3]> = places.collect();
    if let RigidSolid::Terrain(terrain) = solid {
        places.extend(terrain.heights.iter().enumerate().map(|(n, height)| {
            let post = [n % terrain.count[0], n / terrain.count[0]];
            let [x, y] =
                [0, 1].map(|axis| terrain.lower[axis] + post[axis] as f64 * terrain.spacing[axis] + moved[axis]);
            [x, y, height + moved[2] - 2.0 * OVERLAP * cell]
        }));
    }
    places
}
