//! Outlines of rigid bodies: distance and normal for a position; area, centroid and moments of inertia.

use super::terrain::Terrain;
use crate::tensor::Vector;
use std::f64::consts::PI;

/// Distance, as a fraction of an outline's size, within which a position counts as on the outline; its normal is then
/// that of the edge.
const ON: f64 = 1e-12;

/// Number of points along an edge or a circle at which overlap with other bodies is checked.
const PLACES: usize = 32;

/// Outline of a body, relative to the reference point (m).
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// Corners, counter-clockwise.
    Polygon(Vec<Vector<2>>),
    /// Radius about the reference point; in 3-D a sphere.
    Circle(f64),
    /// 3-D: half edges of a cuboid about the reference point.
    Box([f64; 3]),
    /// 3-D: body of revolution about the vertical axis through the reference point. The polygon has the distance from
    /// the axis and the height; a part that reaches the axis continues as its mirror image.
    Revolved(Vec<Vector<2>>),
    /// 3-D: the space below a raster of heights, from the grid's lower corner.
    Terrain(Box<Terrain>),
}

/// Distance and normal of an outline at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<const D: usize = 2> {
    /// Distance from the outline (m), negative inside.
    pub distance: f64,
    /// Unit normal of the outline, out of the body.
    pub normal: Vector<D>,
}

/// Area integrals of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// Area (m2).
    pub area: f64,
    /// Centroid (m).
    pub centroid: Vector<2>,
    /// Polar second moment of area about the centroid (m4).
    pub polar: f64,
}

impl Outline {
    /// Returns the distance and the normal at the position `x` (m from the reference point).
    pub fn nearest<const D: usize>(&self, x: &Vector<D>) -> Nearest<D> {
        match self {
            Self::Circle(radius) => {
                let up = Vector::from_fn(|k, _| if k + 1 == D { 1.0 } else { 0.0 });
                let normal = x.try_normalize(ON * radius).unwrap_or(up);
                Nearest {
                    distance: x.norm() - radius,
                    normal,
                }
            }
            Self::Polygon(corners) => {
                let Nearest { distance, normal } = nearest_of(corners, &Vector::<2>::new(x[0], x[1]));
                Nearest {
                    distance,
                    normal: Vector::from_fn(|k, _| if k < 2 { normal[k] } else { 0.0 }),
                }
            }
            Self::Box(half) => nearest_of_box(half, x),
            Self::Revolved(corners) => {
                let r = x[0].hypot(x[1]);
                let Nearest { distance, normal } = nearest_of(corners, &Vector::<2>::new(r, x[D - 1]));
                let out = if r > 0.0 { [x[0] / r, x[1] / r] } else { [1.0, 0.0] };
                Nearest {
                    distance,
                    normal: Vector::from_fn(|k, _| if k + 1 == D { normal[1] } else { normal[0] * out[k] }),
                }
            }
            Self::Terrain(terrain) => {
                let (distance, normal) = terrain.nearest(x);
                Nearest { distance, normal }
            }
        }
    }

    /// Returns the largest distance of the outline from the reference point (m).
    pub fn radius(&self) -> f64 {
        match self {
            Self::Circle(radius) => *radius,
            Self::Polygon(corners) | Self::Revolved(corners) => corners.iter().map(Vector::norm).fold(0.0, f64::max),
            Self::Box(half) => Vector::<3>::from(*half).norm(),
            Self::Terrain(_) => f64::INFINITY,
        }
    }

    /// Returns points along the outline, including its corners, in 2-D; none in 3-D.
    pub fn places<const D: usize>(&self) -> Vec<Vector<D>> {
        let places: Vec<Vector<2>> = match self {
            _ if D != 2 => Vec::new(),
            Self::Box(_) | Self::Revolved(_) | Self::Terrain(_) => Vec::new(),
            Self::Circle(radius) => {
                let directions = (0..PLACES).map(|k| (k as f64 / PLACES as f64 * 2.0 * PI).sin_cos());
                directions
                    .map(|(sin, cos)| Vector::<2>::new(cos, sin) * *radius)
                    .collect()
            }
            Self::Polygon(corners) => {
                let places = edges(corners).flat_map(|(a, b)| {
                    let from = *a;
                    let way = b - a;
                    (0..PLACES).map(move |k| from + way * (k as f64 / PLACES as f64))
                });
                places.collect()
            }
        };
        places
            .into_iter()
            .map(|place| Vector::from_fn(|k, _| place[k]))
            .collect()
    }

    /// Returns the volume per radian (m3) of the part beyond x = `axis` (m from the reference point), rotated about
    /// that axis: half of the section of a body of revolution.
    pub fn swept(&self, axis: f64) -> f64 {
        match self {
            Self::Circle(radius) => {
                swept_by_circle(*radius, axis, *radius) - swept_by_circle(*radius, axis, axis.clamp(-radius, *radius))
            }
            Self::Polygon(corners) => edges(corners).map(|(a, b)| moment_beyond(axis, a, b)).sum(),
            Self::Box(_) | Self::Revolved(_) | Self::Terrain(_) => 0.0,
        }
    }

    /// Returns area, centroid and polar moment of a 2-D outline; zero for 3-D outlines, which need no mass integrals.
    pub fn sizes(&self) -> Sizes {
        match self {
            Self::Circle(radius) => Sizes {
                area: PI * radius.powi(2),
                centroid: Vector::zeros(),
                polar: 0.5 * PI * radius.powi(4),
            },
            Self::Polygon(corners) => {
                let mut area = 0.0;
                let mut first = Vector::<2>::zeros();
                let mut second = 0.0;
                for (a, b) in edges(corners) {
                    let cross = a.perp(b);
                    area += 0.5 * cross;
                    first += (a + b) * (cross / 6.0);
                    second += cross * (a.dot(a) + a.dot(b) + b.dot(b)) / 12.0;
                }
                let centroid = first / area;
                Sizes {
                    area,
                    centroid,
                    polar: second - area * centroid.norm_squared(),
                }
            }
            Self::Box(_) | Self::Revolved(_) | Self::Terrain(_) => Sizes {
                area: 0.0,
                centroid: Vector::zeros(),
                polar: 0.0,
            },
        }
    }
}

/// Returns the antiderivative at x = `s` of the volume per radian of a circle rotated about x = `axis` (m3).
fn swept_by_circle(radius: f64, axis: f64, s: f64) -> f64 {
    let half = (radius.powi(2) - s.powi(2)).max(0.0).sqrt();
    -axis * (s * half + radius.powi(2) * (s / radius).asin()) - 2.0 / 3.0 * half.powi(3)
}

/// Returns the contribution of an edge to the integral of x - `axis` over the part of a polygon beyond x = `axis` (m3).
fn moment_beyond(axis: f64, a: &Vector<2>, b: &Vector<2>) -> f64 {
    let [a, b] = [a, b].map(|x| Vector::<2>::new(x[0] - axis, x[1]));
    let cut = a + (b - a) * (a[0] / (a[0] - b[0]));
    match (a[0] > 0.0, b[0] > 0.0) {
        (true, true) => moment_about_y(&a, &b),
        (true, false) => moment_about_y(&a, &cut),
        (false, true) => moment_about_y(&cut, &b),
        (false, false) => 0.0,
    }
}

/// Returns the distance and the normal of a cuboid at `x`.
fn nearest_of_box<const D: usize>(half: &[f64; 3], x: &Vector<D>) -> Nearest<D> {
    let beyond = Vector::<D>::from_fn(|k, _| x[k].abs() - half[k]);
    let outside = beyond.map(|part| part.max(0.0));
    let sign = x.map(|part| if part < 0.0 { -1.0 } else { 1.0 });
    if let Some(normal) = outside.try_normalize(0.0) {
        return Nearest {
            distance: outside.norm(),
            normal: sign.component_mul(&normal),
        };
    }
    let face = beyond.imax();
    Nearest {
        distance: beyond[face],
        normal: Vector::from_fn(|k, _| if k == face { sign[k] } else { 0.0 }),
    }
}

/// Returns the edges of a closed polygon, from corner to corner.
fn edges(corners: &[Vector<2>]) -> impl Iterator<Item = (&Vector<2>, &Vector<2>)> {
    corners.iter().zip(corners.iter().cycle().skip(1))
}

/// Returns the contribution of an edge to the integral of x over a polygon (m3); 0 for edges along x = 0.
fn moment_about_y(a: &Vector<2>, b: &Vector<2>) -> f64 {
    (b[1] - a[1]) * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) / 6.0
}

/// Returns the distance and the normal of a polygon at `x`; a count of edges crossed by a horizontal ray decides
/// whether `x` is inside.
fn nearest_of(corners: &[Vector<2>], x: &Vector<2>) -> Nearest {
    let mut least = f64::INFINITY;
    let mut foot = Vector::zeros();
    let mut edge = Vector::<2>::x();
    let mut inside = false;
    let mut size = 0.0_f64;
    for (a, b) in edges(corners) {
        let along = b - a;
        let from = x - a;
        size = size.max(along.amax());
        let share = (from.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let on = a + along * share;
        let square = (x - on).norm_squared();
        if square < least {
            (least, foot, edge) = (square, on, along);
        }
        if (a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + along[0] * (x[1] - a[1]) / along[1] {
            inside = !inside;
        }
    }
    let side = if inside { -1.0 } else { 1.0 };
    let off = (x - foot) * side;
    // The corners are counter-clockwise, so the body is on the left of its edges.
    let normal = off
        .try_normalize(ON * size)
        .unwrap_or_else(|| Vector::<2>::new(edge[1], -edge[0]).normalize());
    Nearest {
        distance: side * least.sqrt(),
        normal,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Outline {
        Outline::Polygon(
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]
                .map(Vector::from)
                .to_vec(),
        )
    }

    #[test]
    fn distance_and_normal_are_those_of_the_nearest_edge_or_corner() {
        let of = |x: [f64; 2]| square().nearest(&Vector::from(x));
        assert_eq!(
            of([1.0, 1.5]),
            Nearest {
                distance: 0.5,
                normal: Vector::<2>::new(0.0, 1.0)
            }
        );
        assert_eq!(
            of([1.0, 0.75]),
            Nearest {
                distance: -0.25,
                normal: Vector::<2>::new(0.0, 1.0)
            }
        );
        assert_eq!(
            of([0.5, 0.0]),
            Nearest {
                distance: 0.0,
                normal: Vector::<2>::new(0.0, -1.0)
            }
        );
        let corner = of([2.3, 1.4]);
        assert!((corner.distance - 0.5).abs() < 1e-15 && (corner.normal - Vector::<2>::new(0.6, 0.8)).norm() < 1e-15);
        let circle = Outline::Circle(2.0).nearest(&Vector::<2>::new(0.0, -3.0));
        assert_eq!(
            circle,
            Nearest {
                distance: 1.0,
                normal: Vector::<2>::new(0.0, -1.0)
            }
        );
    }

    #[test]
    fn a_notch_is_outside() {
        let corners = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        let notched = Outline::Polygon(corners.map(Vector::from).to_vec());
        assert_eq!(notched.nearest(&Vector::<2>::new(1.5, 1.5)).distance, 0.5);
        assert_eq!(notched.nearest(&Vector::<2>::new(0.5, 1.5)).distance, -0.5);
    }

    #[test]
    fn sizes_are_those_of_the_shape_wherever_it_is() {
        let Outline::Polygon(corners) = square() else { panic!() };
        let moved = Outline::Polygon(corners.iter().map(|x| x + Vector::<2>::new(-3.0, 7.0)).collect());
        let sizes = moved.sizes();
        assert!((sizes.area - 2.0).abs() < 1e-13 && (sizes.centroid - Vector::<2>::new(-2.0, 7.5)).norm() < 1e-13);
        assert!((sizes.polar - 2.0 * (4.0 + 1.0) / 12.0).abs() < 1e-11);
    }

    #[test]
    fn what_is_swept_is_the_part_beyond_the_axis() {
        // A cylinder, a tube, a sphere, a torus, and a square that the axis cuts in two.
        assert!((square().swept(0.0) - 2.0).abs() < 1e-15 && (square().swept(-1.0) - 4.0).abs() < 1e-15);
        assert!((square().swept(1.0) - 0.5).abs() < 1e-15 && square().swept(3.0) == 0.0);
        assert!((Outline::Circle(2.0).swept(0.0) - 16.0 / 3.0).abs() < 1e-14);
        assert!((Outline::Circle(2.0).swept(-3.0) - 12.0 * PI).abs() < 1e-13);
        let cone = Outline::Polygon([[0.0, -3.0], [1.0, 0.0], [-1.0, 0.0]].map(Vector::from).to_vec());
        assert!((cone.swept(0.0) - 0.5).abs() < 1e-15);
    }
}
