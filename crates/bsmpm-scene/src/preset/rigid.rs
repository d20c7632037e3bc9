//! Computes the region that a moving rigid body passes through. A preset (key `accuracy`) chooses fine cells there.

use crate::schema::{RigidTable, ShapeKey};
use bsmpm_shapes::polygon;

/// Part of a body's shorter side by which a place lies beyond its edge.
const BEYOND: f64 = 1e-6;
/// rad  A corner is no farther from its place than after half a turn, by a chord of twice the radius.
const MOST: f64 = 2.0;

/// A rigid body on a way, or one that stays.
pub(super) struct RigidExtent {
    /// m  ends of the edge of its rectangle across its way, of one that stays of a longer one
    pub ends: [[f64; 2]; 2],
    /// m  ends of the edges that soil lies at, at the start or on its way
    pub corners: Vec<[f64; 2]>,
    /// m  corners of a polygon's sides on those edges
    pub lines: Vec<[f64; 2]>,
    /// m  between edges that soil lies at on either side; without end if there are none
    pub thickness: f64,
    /// m  how far a corner turns about the reference point, at most
    pub swing: f64,
}

/// A polygon, or the square around a circle, m.
struct Outline {
    /// of a polygon
    corners: Vec<[f64; 2]>,
    /// of the rectangle around it
    bounds: [[f64; 2]; 2],
}

/// An edge of a rectangle: the axis that it lies across, and whether it is the upper one.
type Edge = (usize, bool);

impl Outline {
    fn of(rigid: &RigidTable) -> Option<Self> {
        let corners = match rigid.shape() {
            shape @ (ShapeKey::Polygon(_) | ShapeKey::Circle(_)) => shape.corners()?,
            _ => return None,
        };
        let bounds = polygon::bounds(&corners);
        let is_round = matches!(rigid.shape(), ShapeKey::Circle(_));
        let corners = if is_round { Vec::new() } else { corners };
        Some(Self { corners, bounds })
    }

    fn size(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.bounds[1][axis] - self.bounds[0][axis])
    }

    fn edge(&self, (axis, upper): Edge) -> [[f64; 2]; 2] {
        let at = self.bounds[usize::from(upper)][axis];
        self.bounds
            .map(|end| if axis == 0 { [at, end[1]] } else { [end[0], at] })
    }

    /// Whether one of the rectangles lies at an edge when it has gone a way.
    fn meets(&self, (axis, upper): Edge, way: &[f64; 2], bodies: &[[[f64; 2]; 2]]) -> bool {
        let [from, to] = self.edge((axis, upper));
        let [width, height] = self.size();
        let beyond = BEYOND * width.min(height);
        let at = from[axis] + way[axis] + if upper { beyond } else { -beyond };
        let [from, to] = [from, to].map(|end| end[1 - axis] + way[1 - axis]);
        bodies
            .iter()
            .any(|[low, high]| (low[axis]..high[axis]).contains(&at) && from < high[1 - axis] && to > low[1 - axis])
    }
}

/// m  from the reference point to the corner that is farthest from it
pub(super) fn radius(rigid: &RigidTable) -> Option<f64> {
    let Outline {
        corners,
        bounds: [lower, upper],
    } = Outline::of(rigid)?;
    let about = rigid
        .about
        .get()
        .unwrap_or([0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis])));
    let all = corners.iter().chain([&lower, &upper]);
    Some(
        all.map(|at| (at[0] - about[0]).hypot(at[1] - about[1]))
            .fold(0.0, f64::max),
    )
}

impl RigidExtent {
    /// Of a body that is not free, which goes by `ways` (m), beside soil in these rectangles; `None` where it meets
    /// none.
    pub fn of(rigid: &RigidTable, ways: &[[f64; 2]], bodies: &[[[f64; 2]; 2]]) -> Option<Self> {
        let outline = Outline::of(rigid)?;
        let size = outline.size();
        let edges = [0, 1].into_iter().flat_map(|axis| [(axis, false), (axis, true)]);
        let met: Vec<Edge> = edges
            .filter(|edge| ways.iter().any(|way| outline.meets(*edge, way, bodies)))
            .collect();
        let far = ways.iter().fold([0.0_f64; 2], |far, way| {
            [0, 1].map(|axis| far[axis].max(way[axis].abs()))
        });
        let across = usize::from(if far == [0.0; 2] {
            size[0] < size[1]
        } else {
            far[0] > far[1]
        });
        let first = met
            .iter()
            .find(|(axis, _)| *axis == 1 - across)
            .copied()
            .unwrap_or((1 - across, false));
        let between = [0, 1].into_iter().filter(|axis| {
            let mut edges = [(*axis, false), (*axis, true)].into_iter();
            edges.all(|edge| outline.meets(edge, &[0.0; 2], bodies))
        });
        let thickness = between.map(|axis| size[axis]).fold(f64::INFINITY, f64::min);
        let is_on = |(axis, up): &Edge, corner: &[f64; 2]| corner[*axis] == outline.bounds[usize::from(*up)][*axis];
        let sides = outline.corners.iter().zip(outline.corners.iter().cycle().skip(1));
        let lines = sides.filter(|(a, b)| met.iter().any(|edge| is_on(edge, a) && is_on(edge, b)));
        let angles = rigid.rotation.items().iter().map(|row| row.numbers[1].abs());
        (!met.is_empty()).then_some(Self {
            ends: outline.edge(first),
            corners: met.iter().flat_map(|edge| outline.edge(*edge)).collect(),
            lines: lines.flat_map(|(a, b)| [*a, *b]).collect(),
            thickness,
            swing: angles.fold(0.0, f64::max).min(MOST) * radius(rigid)?,
        })
    }
}
