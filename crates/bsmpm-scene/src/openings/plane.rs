//! Outlines of 2-D bodies, to find openings.

use super::{SurfaceKind, SurfacePoint};
use crate::schema::{BodyTable, ShapeKey};
use bsmpm::tensor::Vector;
use bsmpm_shapes::polygon;

/// Sides of the regular polygon that stands for a circle: their middles lie on it, and their ends 0.1 % outside.
const SIDES: usize = 64;
/// Pieces of every side of a shape with few sides: a part of a side may bound the body.
const PIECES: usize = 4;
/// Sides up to which they are taken in pieces.
const FEW: usize = 16;
/// Sides that are looked at, times all sides, at most: of more of them every second, third and so on is taken.
const MOST_WORK: usize = 1 << 16;

/// A polygon, or one that stands for a circle.
#[derive(Clone, Debug)]
pub(crate) struct PlaneShape {
    /// m
    pub corners: Vec<[f64; 2]>,
    /// Whether the corners are corners.
    pub is_round: bool,
}

/// A body in a plane.
#[derive(Clone, Debug)]
pub(crate) struct PlaneBody {
    pub whole: PlaneShape,
    pub cuts: Vec<PlaneShape>,
}

impl PlaneShape {
    pub(crate) fn of(key: ShapeKey<'_>) -> Option<Self> {
        match key {
            ShapeKey::Box(key) => {
                let shape = key.value()?;
                let [x, y] = shape.lower.pair()?;
                let [to_x, to_y] = shape.upper.pair()?;
                Some(Self {
                    corners: vec![[x, y], [to_x, y], [to_x, to_y], [x, to_y]],
                    is_round: false,
                })
            }
            ShapeKey::Circle(key) => {
                let ([x, y], radius) = key.value()?.circle()?;
                let angle = std::f64::consts::TAU / SIDES as f64;
                let radius = radius / (0.5 * angle).cos();
                let corners = (0..SIDES).map(|k| {
                    let (sin, cos) = (k as f64 * angle).sin_cos();
                    [x + radius * cos, y + radius * sin]
                });
                Some(Self {
                    corners: corners.collect(),
                    is_round: true,
                })
            }
            ShapeKey::Polygon(key) => {
                let corners = key.pairs()?;
                (corners.len() >= 3).then_some(Self {
                    corners,
                    is_round: false,
                })
            }
            _ => None,
        }
    }

    /// Returns whether a position is inside: a ray to the right crosses its sides an odd number of times. This loop is
    /// most of the cost of the search for openings.
    pub(crate) fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let Some(mut from) = self.corners.last() else {
            return false;
        };
        let mut is_inside = false;
        for to in &self.corners {
            let is_level = (from[1] > y) != (to[1] > y);
            is_inside ^= is_level && x < from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]);
            from = to;
        }
        is_inside
    }

    fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let closing = self.corners.last().zip(self.corners.first());
        let open = self.corners.windows(2).map(|side| [side[0], side[1]]);
        open.chain(closing.map(|(a, b)| [*a, *b]))
    }

    /// m  its corners, each with the shorter one of its sides
    pub(crate) fn vertices(&self) -> Vec<([f64; 2], f64)> {
        let lengths = self.sides().map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1]));
        let lengths: Vec<f64> = lengths.collect();
        let before = lengths.iter().cycle().skip(lengths.len() - 1);
        let shorter = lengths.iter().zip(before).map(|(after, before)| after.min(*before));
        self.corners.iter().copied().zip(shorter).collect()
    }

    /// Pieces of its sides within a rectangle (m).
    pub(crate) fn surface(&self, bounds: [[f64; 2]; 2]) -> Vec<SurfacePoint> {
        let count = self.corners.len();
        let pieces = if count <= FEW { PIECES } else { 1 };
        let kind = match self.is_round {
            true => SurfaceKind::Round,
            false if count > FEW => SurfaceKind::Smooth,
            false => SurfaceKind::Flat,
        };
        let every = (count * count).div_ceil(MOST_WORK);
        let mut points = Vec::new();
        for (edge, side) in self.sides().enumerate().step_by(every) {
            let Some([a, b]) = clipped(side, bounds) else { continue };
            let along = Vector::from([b[0] - a[0], b[1] - a[1], 0.0]);
            let Some(normal) = Vector::from([-along[1], along[0], 0.0]).try_normalize(0.0) else {
                continue;
            };
            for piece in 0..pieces {
                let at = Vector::from([a[0], a[1], 0.0]) + along * ((piece as f64 + 0.5) / pieces as f64);
                points.push(SurfacePoint {
                    at,
                    normal,
                    half: along * (0.5 / pieces as f64),
                    edge,
                    kind,
                });
            }
        }
        points
    }
}

/// The part of a segment within a rectangle, m (Liang and Barsky 1984).
fn clipped([a, b]: [[f64; 2]; 2], [lower, upper]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let mut from = 0.0_f64;
    let mut to = 1.0_f64;
    for axis in 0..2 {
        let along = b[axis] - a[axis];
        if along == 0.0 && !(lower[axis]..=upper[axis]).contains(&a[axis]) {
            return None;
        }
        if along != 0.0 {
            let parts = [(lower[axis] - a[axis]) / along, (upper[axis] - a[axis]) / along];
            from = from.max(parts[0].min(parts[1]));
            to = to.min(parts[0].max(parts[1]));
        }
    }
    (from < to).then(|| [from, to].map(|part| [0, 1].map(|axis| a[axis] + part * (b[axis] - a[axis]))))
}

impl PlaneBody {
    pub(crate) fn of(body: &BodyTable) -> Option<Self> {
        let cuts = body.subtract.items().iter();
        let cuts: Option<Vec<PlaneShape>> = cuts.map(|cut| PlaneShape::of(cut.shape())).collect();
        Some(Self {
            whole: PlaneShape::of(body.shape())?,
            cuts: cuts?,
        })
    }

    pub(crate) fn contains(&self, at: [f64; 2]) -> bool {
        self.whole.contains(at) && !self.cuts.iter().any(|cut| cut.contains(at))
    }

    /// m  lower and upper corner of the rectangle around the whole shape
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        polygon::bounds(&self.whole.corners)
    }

    /// Its shapes: the outline, and what is cut out of it.
    pub(crate) fn shapes(&self) -> impl Iterator<Item = &PlaneShape> {
        std::iter::once(&self.whole).chain(&self.cuts)
    }
}
