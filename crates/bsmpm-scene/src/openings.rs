//! Finds openings (holes and notches) of bodies, for presets and for the indicator `cells-across-opening`.
//!
//! A ray starts at the surface of a body, along the outward normal. If it meets an opposite wall of the same body,
//! there is an opening.

mod plane;
mod search;
mod solid;

pub(crate) use plane::{PlaneBody, PlaneShape};
pub(crate) use search::{BodyOpening, GridFaces, in_plane, in_space, phases};

use bsmpm::tensor::Vector;

/// Parts of a body's size by which a place lies off its surface.
const OFF: f64 = 1e-6;
/// Equal steps of a ray over the size of the shape.
const STEPS: usize = 128;
/// Halvings of the step in which a ray meets a wall.
const HALVINGS: usize = 20;
/// Cosine between a ray and the normal of the wall that it meets, from which on the wall faces back.
const FACES: f64 = 0.55;
/// rad  Inclinations to the normal of a curved surface.
const INCLINATIONS: [f64; 3] = [0.13, 0.26, 0.52];
/// Part of a width around the place that a ray meets in which the wall is looked at.
const AROUND: f64 = 0.02;

/// A piece of the surface of a shape.
#[derive(Clone, Debug)]
pub(crate) struct SurfacePoint {
    /// m  its middle
    pub at: Vector<3>,
    /// Unit normal, to either side.
    pub normal: Vector<3>,
    /// m  from the middle to its ends
    pub half: Vector<3>,
    /// Number of the edge or face of the shape that it is a piece of.
    pub edge: usize,
    pub kind: SurfaceKind,
}

/// How the surface of a shape is curved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SurfaceKind {
    /// Of few sides: the narrowest pair of walls counts.
    Flat,
    /// Of many sides, which may stand for a curve.
    Smooth,
    /// A circle, cylinder or sphere: the widest place counts.
    Round,
}

/// A plane of symmetry.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MirrorPlane {
    /// axis that it is normal to
    pub axis: usize,
    /// whether the body lies below it
    pub is_upper: bool,
    /// m  its place
    pub at: f64,
}

/// An opening of a body: the narrowest pair of its walls.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OpeningGeometry {
    /// m
    pub width: f64,
    /// m  lower and upper corner of the box around its walls
    pub bounds: [[f64; 3]; 2],
    /// Of every wall the widest place.
    pub walls: Vec<OpeningWall>,
}

/// A wall of an opening.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OpeningWall {
    /// m  a place on it
    pub at: Vector<3>,
    /// Unit normal into the opening.
    pub normal: Vector<3>,
    /// m  to the opposite wall
    pub width: f64,
}

/// A half-line.
struct Ray {
    /// m
    start: Vector<3>,
    /// Unit vector.
    direction: Vector<3>,
}

impl Ray {
    /// m  the place so far along it
    fn at(&self, distance: f64) -> Vector<3> {
        self.start + self.direction * distance
    }

    /// Whether it is outside a box (m) at a distance (m), and does not come back.
    fn has_left(&self, [lower, upper]: [[f64; 3]; 2], distance: f64) -> bool {
        let at = self.at(distance);
        (0..3).any(|axis| match self.direction[axis] {
            forwards if forwards > 0.0 => at[axis] > upper[axis],
            backwards if backwards < 0.0 => at[axis] < lower[axis],
            _ => false,
        })
    }
}

/// A body and what is around it.
pub(crate) struct Surroundings<'a> {
    /// whether the body is at a place
    pub is_body: &'a dyn Fn([f64; 3]) -> bool,
    /// whether another body or a rigid body is
    pub is_other: &'a dyn Fn([f64; 3]) -> bool,
    /// in which the body is mirrored
    pub planes: &'a [MirrorPlane],
    /// m  lower and upper corner of the box around the body
    pub bounds: [[f64; 3]; 2],
}

impl Surroundings<'_> {
    /// The opening that the surface of a shape bounds, if there is one.
    pub(crate) fn opening(&self, points: &[SurfacePoint]) -> Option<OpeningGeometry> {
        let size = (Vector::from(self.bounds[1]) - Vector::from(self.bounds[0])).norm();
        let mut walls: Vec<(usize, OpeningWall)> = Vec::new();
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for point in points {
            let Some(wall) = self.wall(point, size) else { continue };
            for end in [point.at - point.half, point.at + point.half] {
                for axis in 0..3 {
                    let within = end[axis].clamp(self.bounds[0][axis], self.bounds[1][axis]);
                    bounds[0][axis] = bounds[0][axis].min(within);
                    bounds[1][axis] = bounds[1][axis].max(within);
                }
            }
            match walls.iter_mut().find(|(edge, _)| *edge == point.edge) {
                Some((_, known)) if known.width >= wall.width => {}
                Some((_, known)) => *known = wall,
                None => walls.push((point.edge, wall)),
            }
        }
        let mut walls: Vec<OpeningWall> = walls.into_iter().map(|(_, wall)| wall).collect();
        let widths = walls.iter().map(|wall| wall.width);
        let width = match points.first()?.kind {
            SurfaceKind::Round => widths.reduce(f64::max)?,
            SurfaceKind::Flat | SurfaceKind::Smooth => widths.reduce(f64::min)?,
        };
        if points[0].kind == SurfaceKind::Round {
            walls.iter_mut().for_each(|wall| wall.width = width);
        }
        Some(OpeningGeometry { width, bounds, walls })
    }

    /// The wall at a piece of surface of a body of a size (m), if an opening begins there.
    fn wall(&self, point: &SurfacePoint, size: f64) -> Option<OpeningWall> {
        let off = OFF * size;
        let reach = 2.0 * size;
        let mut normals = [point.normal, -point.normal].into_iter();
        let normal = normals
            .find(|normal| self.is_material(point.at - normal * off) && !self.is_material(point.at + normal * off))?;
        let start = point.at + normal * off;
        let mut directions = self.directions(&normal, point.kind).into_iter();
        let width = directions.find_map(|direction| self.across(&Ray { start, direction }, reach))?;
        Some(OpeningWall {
            at: point.at,
            normal,
            width,
        })
    }

    /// Unit vectors along which a wall is looked for, the normal first.
    fn directions(&self, normal: &Vector<3>, kind: SurfaceKind) -> Vec<Vector<3>> {
        let mut directions = vec![*normal];
        if kind == SurfaceKind::Flat {
            return directions;
        }
        let is_flat = self.bounds[1][2] == self.bounds[0][2];
        let axes = if is_flat {
            vec![Vector::z()]
        } else {
            vec![Vector::x(), Vector::y(), Vector::z()]
        };
        let tangents: Vec<Vector<3>> = axes
            .iter()
            .filter_map(|axis| normal.cross(axis).try_normalize(1e-6))
            .collect();
        for inclination in INCLINATIONS {
            let (sin, cos) = inclination.sin_cos();
            for tangent in &tangents {
                directions.extend([normal * cos + tangent * sin, normal * cos - tangent * sin]);
            }
        }
        directions
    }

    /// m  along a ray to the wall that faces back, if it comes to one within its reach (m)
    fn across(&self, ray: &Ray, reach: f64) -> Option<f64> {
        let bounds = self.bounds_of_images();
        let step = reach / STEPS as f64;
        let mut open = 0.0;
        for k in 1..=STEPS {
            let next = k as f64 * step;
            if ray.has_left(bounds, next) || (self.is_other)(self.folded(ray.at(open))) {
                return None;
            }
            if self.is_material(ray.at(next)) {
                let width = self.met(ray, [open, next]);
                let faces = self.inwards(ray.at(width), AROUND * width).dot(&ray.direction) >= FACES;
                return faces.then_some(width);
            }
            open = next;
        }
        None
    }

    /// m  lower and upper corner of the box around the body and its mirror images
    fn bounds_of_images(&self) -> [[f64; 3]; 2] {
        let [mut lower, mut upper] = self.bounds;
        // The inverse of `folded`.
        for plane in self.planes.iter().rev() {
            let axis = plane.axis;
            if plane.is_upper {
                upper[axis] = 2.0 * plane.at - lower[axis];
            } else {
                lower[axis] = 2.0 * plane.at - upper[axis];
            }
        }
        [lower, upper]
    }

    /// How far along a ray the body begins, m, between an open place and one in the body.
    fn met(&self, ray: &Ray, [mut open, mut closed]: [f64; 2]) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (open + closed);
            if self.is_material(ray.at(middle)) {
                closed = middle
            } else {
                open = middle
            }
        }
        closed
    }

    /// Unit vector from a place on the surface into the body, by the directions in which the body is; zero if it is in
    /// none.
    fn inwards(&self, at: Vector<3>, radius: f64) -> Vector<3> {
        let is_flat = self.bounds[1][2] == self.bounds[0][2];
        let mut sum = Vector::zeros();
        for n in 0..27_i32 {
            let direction = Vector::from([n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1].map(f64::from));
            let is_along = is_flat && direction[2] != 0.0;
            if let Some(direction) = direction.try_normalize(0.0).filter(|_| !is_along)
                && self.is_material(at + direction * radius)
            {
                sum += direction;
            }
        }
        sum.try_normalize(0.0).unwrap_or_else(Vector::zeros)
    }

    fn is_material(&self, at: Vector<3>) -> bool {
        (self.is_body)(self.folded(at))
    }

    /// A place on this side of all planes of symmetry.
    fn folded(&self, at: Vector<3>) -> [f64; 3] {
        folded(self.planes, at.into())
    }
}

/// A place on this side of planes of symmetry.
pub(crate) fn folded(planes: &[MirrorPlane], mut at: [f64; 3]) -> [f64; 3] {
    for plane in planes {
        let beyond = at[plane.axis] - plane.at;
        if beyond != 0.0 && (beyond > 0.0) == plane.is_upper {
            at[plane.axis] = plane.at - beyond;
        }
    }
    at
}
