//! Checks whether positions in a case lie in the grid and in a body.

use crate::case::{Body, Face, Geometry};
use crate::grid::GridSpec;
use crate::record::Field;
use crate::report::Report;
use crate::words::Side;
use std::fmt;

/// Parts of a cell by which a place may lie beyond the grid: rounding.
pub(super) const ROUNDING: f64 = 1e-9;
/// Places along a line at which bodies are looked for.
const SAMPLES: usize = 101;
/// Places along either edge of a rectangle in space at which bodies are looked for.
const RASTER: usize = 21;
/// Places of a circle at which bodies are looked for.
const RING: usize = 180;
/// Directions in which a body is looked for around a place.
const DIRECTIONS: usize = 16;
/// Parts of half the spacing of its points at which a body is looked for: a body may be thinner than that.
const DISTANCES: [f64; 3] = [0.02, 0.5, 1.0];

/// A coordinate outside the grid. `{}` writes a part of a sentence; as a text it is a whole message.
pub(super) struct Outside {
    axis: &'static str,
    at: f64,       // m
    bound: f64,    // m
    is_past: bool, // beyond the upper end of the grid
}

impl fmt::Display for Outside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            axis,
            at,
            bound,
            is_past,
        } = self;
        let verb = if *is_past { "ends" } else { "starts" };
        write!(
            f,
            "{axis} = {at} m is outside the grid, which {verb} at {axis} = {bound} m"
        )
    }
}

impl From<Outside> for String {
    fn from(outside: Outside) -> Self {
        format!("E0201: {outside}. Correct the coordinate, or enlarge the grid.")
    }
}

/// The coordinate of a place that lies outside the grid, if there is one.
pub(super) fn beyond<const D: usize>(grid: &GridSpec, at: [f64; D]) -> Option<Outside> {
    let lower = grid.lower();
    let upper = grid.upper();
    for axis in 0..D {
        let spacing = f64::EPSILON * lower[axis].abs().max(upper[axis].abs());
        let slack = ROUNDING * grid.axes[axis].shortest() + 4.0 * spacing;
        let is_past = at[axis] > upper[axis] + slack;
        let bound = if is_past { upper[axis] } else { lower[axis] };
        if is_past || at[axis] < lower[axis] - slack {
            return Some(Outside {
                axis: ["x", "y", "z"][axis],
                at: at[axis],
                bound,
                is_past,
            });
        }
    }
    None
}

/// As [`beyond`], of a place that in a plane has nothing along its normal.
pub(super) fn is_beyond(grid: &GridSpec, at: [f64; 3]) -> Option<Outside> {
    if grid.dims() == 2 {
        beyond(grid, [at[0], at[1]])
    } else {
        beyond(grid, at)
    }
}

/// A place of a plane.
pub(super) fn flat([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, 0.0]
}

/// Places in the middles of equal pieces of a line.
pub(super) fn along([from, to]: [[f64; 2]; 2]) -> impl Iterator<Item = [f64; 2]> {
    (0..SAMPLES).map(move |k| {
        let part = (k as f64 + 0.5) / SAMPLES as f64;
        [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]))
    })
}

/// Places on a circle.
pub(super) fn ring(center: [f64; 2], radius: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..RING).map(move |k| {
        let (sin, cos) = ((k as f64 + 0.5) * std::f64::consts::TAU / RING as f64).sin_cos();
        [center[0] + radius * cos, center[1] + radius * sin]
    })
}

/// Whether some body is within half the spacing of its points of a place: the splines would carry a force over more
/// than a cell of empty room.
pub(super) fn at_body(bodies: &[Body], grid: &GridSpec, at: [f64; 2]) -> bool {
    let shortest = grid.shortest();
    for body in bodies {
        let half = 0.5 * shortest / body.points_per_cell as f64;
        let [lower, upper] = body.bounds();
        let is_near = (0..2).all(|axis| at[axis] >= lower[axis] - half && at[axis] <= upper[axis] + half);
        let mut distances = DISTANCES.iter().map(|part| part * half);
        if is_near && distances.any(|distance| (0..DIRECTIONS).any(|k| body.region.contains(around(at, k, distance)))) {
            return true;
        }
    }
    false
}

/// The place at a distance (m) from another in a direction, given by its number.
fn around(at: [f64; 2], k: usize, distance: f64) -> [f64; 2] {
    let (sin, cos) = (k as f64 * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
    [at[0] + distance * cos, at[1] + distance * sin]
}

/// Places in the middles of equal pieces of a rectangle in space.
pub(super) fn over([lower, upper]: [[f64; 3]; 2]) -> impl Iterator<Item = [f64; 3]> {
    let pieces = [0, 1, 2].map(|axis| if lower[axis] == upper[axis] { 1 } else { RASTER });
    let [along_x, along_y, along_z] = pieces;
    (0..along_x * along_y * along_z).map(move |n| {
        let k = [n / along_z / along_y, n / along_z % along_y, n % along_z];
        std::array::from_fn(|axis| {
            lower[axis] + (upper[axis] - lower[axis]) * (k[axis] as f64 + 0.5) / pieces[axis] as f64
        })
    })
}

/// As [`at_body`] of a solid.
pub(super) fn at_volume(bodies: &[Body], grid: &GridSpec, at: [f64; 3]) -> bool {
    let shortest = grid.shortest();
    for body in bodies {
        let half = 0.5 * shortest / body.points_per_cell as f64;
        let [lower, upper] = body.region.corners();
        let is_near = (0..3).all(|axis| at[axis] >= lower[axis] - half && at[axis] <= upper[axis] + half);
        let mut distances = DISTANCES.iter().map(|part| part * half);
        if is_near && distances.any(|distance| (0..27).any(|n| body.region.contains_in_space(of_cube(at, n, distance))))
        {
            return true;
        }
    }
    false
}

/// A place of the 27 (corners and middles) of a cube about another one, given by its number and half the edge (m).
fn of_cube(at: [f64; 3], n: usize, half_edge: f64) -> [f64; 3] {
    let k = [n / 9, n / 3 % 3, n % 3];
    std::array::from_fn(|axis| at[axis] + (k[axis] as f64 - 1.0) * half_edge)
}

/// Parts of the shortest cell beside a surface at which bodies are looked for, until one is there: nearer where they
/// are thin, then as far as half a spacing of points.
const BESIDE: [f64; 4] = [0.25, 0.025, 0.0025, 0.51];

/// Places along a surface's normal and against it at which bodies are, as near to it as there are any.
pub(super) fn beside(grid: &GridSpec, count: impl Fn(f64) -> usize) -> Option<[usize; 2]> {
    let mut counts = BESIDE
        .iter()
        .map(|part| [1.0, -1.0].map(|side| count(side * part * grid.shortest())));
    counts.find(|counts| *counts != [0; 2])
}

/// On which side of a surface bodies lie: 1 along its normal, -1 against it; `None` on both, or on none. `count` has
/// the places so many metres along its normal at which there are any.
pub(super) fn side_of_bodies(grid: &GridSpec, count: impl Fn(f64) -> usize) -> Option<f64> {
    let [along, against] = beside(grid, count)?;
    let is_one = along.abs_diff(against) * 2 >= along.max(against);
    is_one.then_some(if along > against { 1.0 } else { -1.0 })
}

/// Whether some body is within half the spacing of its points of a place.
pub(super) fn is_at(bodies: &[Body], grid: &GridSpec, at: [f64; 3]) -> bool {
    if grid.dims() == 2 {
        at_body(bodies, grid, [at[0], at[1]])
    } else {
        at_volume(bodies, grid, at)
    }
}

/// Whether a body is at a place.
pub(super) fn is_in(body: &Body, grid: &GridSpec, at: [f64; 3]) -> bool {
    if grid.dims() == 2 {
        body.region.contains([at[0], at[1]])
    } else {
        body.region.contains_in_space(at)
    }
}

/// The face of the grid that a key names.
pub(super) fn face(key: &Field<Side>, grid: &GridSpec, report: &mut Report<'_>) -> Option<Face> {
    let side = key.get()?;
    let face = Face::of(
        side,
        if grid.dims() == 3 {
            Geometry::Solid
        } else {
            Geometry::PlaneStrain
        },
    );
    if face.is_none() {
        let message =
            format!("E0207: a 2-D grid has no face \"{side}\". Use left, right, bottom or top, or geometry = \"3d\".");
        key.error(message, report);
    }
    face
}
