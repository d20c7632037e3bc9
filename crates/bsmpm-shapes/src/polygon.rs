//! Polygons: their area, their edges, and what makes them unusable.

use crate::edge::Edge;

/// What is wrong with a polygon; corners are given by their numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PolygonFault {
    /// It has fewer than three corners.
    TooFew,
    /// A corner and the next one are at the same position.
    Repeated(usize, usize),
    /// All corners are on one line.
    Flat,
    /// Two edges, given by their first corners, cross or touch.
    Crossing(usize, usize),
}

/// Returns the first fault of a polygon; `None` if it is simple, that is, has an area and edges that do not cross.
pub fn fault(corners: &[[f64; 2]]) -> Option<PolygonFault> {
    let n = corners.len();
    if n < 3 {
        return Some(PolygonFault::TooFew);
    }
    if let Some(k) = (0..n).find(|&k| corners[k] == corners[(k + 1) % n]) {
        return Some(PolygonFault::Repeated(k, (k + 1) % n));
    }
    let [lower, upper] = bounds(corners);
    let thinnest = 1e-12 * (upper[0] - lower[0]).hypot(upper[1] - lower[1]);
    let p = corners[0];
    let q = *corners
        .iter()
        .max_by(|a, b| far(corners[0], a).total_cmp(&far(corners[0], b)))?;
    if corners.iter().all(|r| turn(p, q, *r).abs() <= thinnest * far(p, &q)) {
        return Some(PolygonFault::Flat);
    }
    let mut pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs
        .find(|(i, j)| cross(corners, *i, *j))
        .map(|(i, j)| PolygonFault::Crossing(i, j))
}

/// Whether two sides of a polygon, by the numbers of their first corners, have more in common than a corner.
fn cross(corners: &[[f64; 2]], i: usize, j: usize) -> bool {
    let [after_i, after_j] = [i, j].map(|k| (k + 1) % corners.len());
    let [p, q] = [corners[i], corners[after_i]];
    let [r, s] = [corners[j], corners[after_j]];
    match (after_i == j, after_j == i) {
        (true, _) => turns_back(p, q, s),
        (_, true) => turns_back(r, s, q),
        _ => meet([p, q], [r, s]),
    }
}

/// Returns the lower and upper corner of the rectangle around positions.
pub fn bounds(corners: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for corner in corners {
        for axis in 0..2 {
            bounds[0][axis] = bounds[0][axis].min(corner[axis]);
            bounds[1][axis] = bounds[1][axis].max(corner[axis]);
        }
    }
    bounds
}

/// Returns the area of a polygon, positive for both orientations:
/// `½ |Σ (x_k - x_0)(y_(k+1) - y_0) - (x_(k+1) - x_0)(y_k - y_0)|`.
pub fn area(corners: &[[f64; 2]]) -> f64 {
    let twice: f64 = corners.windows(2).map(|pair| turn(corners[0], pair[0], pair[1])).sum();
    0.5 * twice.abs()
}

/// Returns the edges of a rectangle, as those of shape `shape` (m from `origin`).
pub fn rectangle(lower: [f64; 2], upper: [f64; 2], origin: [f64; 2], shape: usize) -> Vec<Edge> {
    edges(
        &[lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]],
        origin,
        shape,
    )
}

/// Returns the edges of a polygon, as those of shape `shape` (m from `origin`).
pub fn edges(corners: &[[f64; 2]], origin: [f64; 2], shape: usize) -> Vec<Edge> {
    let places = corners
        .iter()
        .map(|corner| [0, 1].map(|axis| corner[axis] - origin[axis]));
    let next = places.clone().cycle().skip(1);
    places.zip(next).map(|(a, b)| Edge::line(a, b, shape)).collect()
}

fn far(p: [f64; 2], q: &[f64; 2]) -> f64 {
    (q[0] - p[0]).hypot(q[1] - p[1])
}

/// Twice the area of a triangle, positive if it turns to the left.
fn turn(p: [f64; 2], q: [f64; 2], r: [f64; 2]) -> f64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1])
}

/// Whether the way from p to q goes back on itself to r.
fn turns_back(p: [f64; 2], q: [f64; 2], r: [f64; 2]) -> bool {
    let back = (q[0] - p[0]) * (r[0] - q[0]) + (q[1] - p[1]) * (r[1] - q[1]);
    turn(p, q, r) == 0.0 && back < 0.0
}

/// Whether two segments have a place in common.
fn meet([p, q]: [[f64; 2]; 2], [r, s]: [[f64; 2]; 2]) -> bool {
    let are_apart =
        (0..2).any(|axis| p[axis].max(q[axis]) < r[axis].min(s[axis]) || r[axis].max(s[axis]) < p[axis].min(q[axis]));
    let aside = |a: f64, b: f64| (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0);
    !are_apart && !aside(turn(p, q, r), turn(p, q, s)) && !aside(turn(r, s, p), turn(r, s, q))
}
