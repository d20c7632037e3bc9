//! Surfaces of 3-D shapes, to find openings.

use super::plane::PlaneShape;
use super::{SurfaceKind, SurfacePoint};
use crate::schema::{ExtrudeTable, RevolveTable, ShapeKey};
use crate::words::Axis;
use bsmpm::tensor::Vector;
use bsmpm_shapes::plane;

/// Directions around the vertical in which revolved outlines are looked at.
const AZIMUTHS: usize = 8;
/// Circles of latitude on which a sphere is looked at.
const LATITUDES: usize = 9;
/// Triangles of a surface that are looked at, at most.
const MOST_TRIANGLES: usize = 256;

/// Pieces of the surface of a shape within a cuboid (m); of terrain none, which is no hole.
pub(crate) fn surface_points(key: ShapeKey<'_>, bounds: [[f64; 3]; 2]) -> Option<Vec<SurfacePoint>> {
    match key {
        ShapeKey::Box(key) => Some(cuboid(key.value()?.corners()?, bounds)),
        ShapeKey::Sphere(key) => {
            let (center, radius) = key.value()?.sphere()?;
            Some(sphere(center.into(), radius))
        }
        ShapeKey::Extrude(key) => extruded(key.value()?, bounds),
        ShapeKey::Revolve(key) => revolved(key.value()?, bounds),
        ShapeKey::Surface(key) => {
            let shape = key.value()?;
            let scale = shape.scale.get()?;
            let rows = shape.triangles.value()?;
            let every = rows.len().div_ceil(MOST_TRIANGLES).max(1);
            let triangles = rows
                .iter()
                .step_by(every)
                .map(|row| [0, 1, 2].map(|k| Vector::from([0, 1, 2].map(|axis| scale * row.numbers[3 * k + axis]))));
            let points = triangles.enumerate();
            Some(points.filter_map(|(edge, corners)| triangle(corners, edge)).collect())
        }
        _ => Some(Vec::new()),
    }
}

fn triangle([a, b, c]: [Vector<3>; 3], edge: usize) -> Option<SurfacePoint> {
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    Some(SurfacePoint {
        at: (a + b + c) / 3.0,
        normal,
        half: Vector::zeros(),
        edge,
        kind: SurfaceKind::Smooth,
    })
}

/// Middles of the faces of a cuboid, as far as they lie within another one, m.
fn cuboid(corners: [[f64; 3]; 2], bounds: [[f64; 3]; 2]) -> Vec<SurfacePoint> {
    let lower = Vector::<3>::from_fn(|axis, _| corners[0][axis].max(bounds[0][axis]));
    let upper = Vector::<3>::from_fn(|axis, _| corners[1][axis].min(bounds[1][axis]));
    let mut points = Vec::with_capacity(6);
    for edge in 0..6 {
        let axis = edge / 2;
        let mut at = 0.5 * (lower + upper);
        at[axis] = corners[edge % 2][axis];
        let normal = Vector::<3>::from_fn(|component, _| f64::from(u8::from(component == axis)));
        let mut half = 0.5 * (upper - lower);
        half[axis] = 0.0;
        points.push(SurfacePoint {
            at,
            normal,
            half,
            edge,
            kind: SurfaceKind::Flat,
        });
    }
    points
}

/// Places of a sphere on circles of latitude.
fn sphere(center: Vector<3>, radius: f64) -> Vec<SurfacePoint> {
    let mut points = Vec::new();
    for latitude in 0..LATITUDES {
        let up = std::f64::consts::PI * ((latitude as f64 + 0.5) / LATITUDES as f64 - 0.5);
        for azimuth in 0..AZIMUTHS {
            let (sin, cos) = (azimuth as f64 * std::f64::consts::TAU / AZIMUTHS as f64).sin_cos();
            let normal = Vector::from([up.cos() * cos, up.cos() * sin, up.sin()]);
            let edge = points.len();
            let half = Vector::zeros();
            points.push(SurfacePoint {
                at: center + normal * radius,
                normal,
                half,
                edge,
                kind: SurfaceKind::Round,
            });
        }
    }
    points
}

/// Sides of an outline at the middle of its length within a cuboid (m), and its ends.
fn extruded(shape: &ExtrudeTable, bounds: [[f64; 3]; 2]) -> Option<Vec<SurfacePoint>> {
    let outline = PlaneShape::of(shape.outline())?;
    let along = [Axis::X, Axis::Y, Axis::Z]
        .iter()
        .position(|axis| Some(*axis) == shape.along.get())?;
    let from = shape.from.get()?;
    let to = shape.to.get()?;
    let [across, up] = plane(along);
    let axis = Vector::from_fn(|component, _| f64::from(u8::from(component == along)));
    let first = from.max(bounds[0][along]);
    let last = to.min(bounds[1][along]);
    let middle = axis * (0.5 * (first + last));
    let length = axis * (0.5 * (last - first));
    let mut points = outline.surface(bounds.map(|corner| [corner[across], corner[up]]));
    for point in &mut points {
        point.at = placed(point.at, across, up) + middle;
        point.normal = placed(point.normal, across, up);
        point.half = placed(point.half, across, up) + length;
    }
    let count = outline.corners.len();
    let sum = outline
        .corners
        .iter()
        .fold([0.0; 2], |sum, corner| [sum[0] + corner[0], sum[1] + corner[1]]);
    let center = Vector::from([sum[0] / count as f64, sum[1] / count as f64, 0.0]);
    let center = placed(center, across, up);
    for (end, edge) in [(from, count), (to, count + 1)] {
        points.push(SurfacePoint {
            at: center + axis * end,
            normal: axis,
            half: Vector::zeros(),
            edge,
            kind: SurfaceKind::Flat,
        });
    }
    Some(points)
}

/// The vector of a plane in space, with its components along two of the axes.
fn placed(flat: Vector<3>, across: usize, up: usize) -> Vector<3> {
    let mut at = Vector::zeros();
    at[across] = flat[0];
    at[up] = flat[1];
    at
}

/// Sides of an outline of radius and height in some directions around the vertical, between the heights of a cuboid
/// (m).
fn revolved(shape: &RevolveTable, bounds: [[f64; 3]; 2]) -> Option<Vec<SurfacePoint>> {
    let outline = PlaneShape::of(shape.outline())?;
    let [x, y] = shape.about.get()?;
    let sides = outline.surface([[0.0, bounds[0][2]], [f64::MAX, bounds[1][2]]]);
    let mut points = Vec::new();
    for azimuth in 0..AZIMUTHS {
        let (sin, cos) = (azimuth as f64 * std::f64::consts::TAU / AZIMUTHS as f64).sin_cos();
        for side in &sides {
            let [at, normal, half] =
                [side.at, side.normal, side.half].map(|flat| Vector::from([flat[0] * cos, flat[0] * sin, flat[1]]));
            points.push(SurfacePoint {
                at: at + Vector::from([x, y, 0.0]),
                normal,
                half,
                edge: azimuth * outline.corners.len() + side.edge,
                kind: side.kind,
            });
        }
    }
    Some(points)
}
