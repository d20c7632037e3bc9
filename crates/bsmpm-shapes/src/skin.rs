//! Finds the surface of a 2-D body: edges that no other body covers.

use crate::axis::{GridAxis, corner};
use crate::edge::Edge;
use crate::region::Region;

/// Parts of a cell within which a place is on an edge, and beside an edge that a body is looked for.
const BESIDE: f64 = 1e-6;
/// Pieces of a half circle as long as a cell, at least so many of the whole.
const PIECES: usize = 32;

/// Straight pieces of the surface of `of` beside which none of `all` lies, m from the grid's lower corner; arcs as
/// chords of part of a cell. Where a corner of a body touches another's edge a piece ends.
pub fn skin(of: &Region, all: &[&Region], axes: &[GridAxis]) -> Vec<[[f64; 2]; 2]> {
    let cell = axes.iter().map(GridAxis::shortest).fold(f64::INFINITY, f64::min);
    let off = BESIDE * cell;
    let lower = corner(axes);
    let corners: Vec<[f64; 2]> = all
        .iter()
        .flat_map(|region| region.edges(axes).0)
        .flat_map(|edge| [edge.a, edge.b])
        .collect();
    let edges = of.edges(axes).0;
    let pieces = edges.iter().flat_map(|edge| pieces(edge, &corners, cell, off));
    pieces.filter(|piece| is_bare(piece, all, lower, off)).collect()
}

/// Whether a piece is longer than `off`, m, and so far beside its middle a region lies on one side only; `lower` is the
/// grid's lower corner, m.
fn is_bare([p, q]: &[[f64; 2]; 2], all: &[&Region], lower: [f64; 2], off: f64) -> bool {
    let along = [q[0] - p[0], q[1] - p[1]];
    let length = along[0].hypot(along[1]);
    let middle = [0, 1].map(|axis| 0.5 * (p[axis] + q[axis]));
    let beside = [1.0, -1.0].map(|side| {
        let x = middle[0] - side * off * along[1] / length;
        let y = middle[1] + side * off * along[0] / length;
        [lower[0] + x, lower[1] + y]
    });
    length > off && {
        let [left, right] = beside.map(|at| all.iter().any(|region| region.contains(at)));
        left != right
    }
}

/// An edge in straight pieces between the corners that lie on it.
fn pieces(edge: &Edge, corners: &[[f64; 2]], cell: f64, off: f64) -> Vec<[[f64; 2]; 2]> {
    let places = if edge.is_straight() {
        let along = [edge.b[0] - edge.a[0], edge.b[1] - edge.a[1]];
        let square = along[0].powi(2) + along[1].powi(2);
        let mut parts: Vec<f64> = corners
            .iter()
            .filter(|at| edge.distance(**at) < off)
            .map(|at| ((at[0] - edge.a[0]) * along[0] + (at[1] - edge.a[1]) * along[1]) / square)
            .collect();
        parts.extend([0.0, 1.0]);
        parts.sort_by(f64::total_cmp);
        parts.dedup_by(|b, a| (*b - *a) * square.sqrt() < off);
        parts
            .iter()
            .map(|part| [0, 1].map(|axis| edge.a[axis] + part.clamp(0.0, 1.0) * along[axis]))
            .collect()
    } else {
        arc(edge, cell)
    };
    places.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Places on half a circle, from end to end, a part of a cell apart.
fn arc(edge: &Edge, cell: f64) -> Vec<[f64; 2]> {
    let center = 0.5 * (edge.a[0] + edge.b[0]);
    let radius = 0.5 * (edge.b[0] - edge.a[0]);
    let count = PIECES.max((4.0 * std::f64::consts::PI * radius / cell).ceil() as usize);
    let places = (0..=count).map(|k| {
        let x = center - radius * (std::f64::consts::PI * k as f64 / count as f64).cos();
        [x, edge.y(x)]
    });
    places.collect()
}
