//! Integrates the volume of a 3-D body along vertical lines.

use crate::solid::{Section, SolidShape};

/// Part of the volume around by which that of a piece may change as it is halved.
const ROUGH: f64 = 1e-5;

/// How often a piece is halved at most.
const HALVINGS: u32 = 8;

/// Pieces in which a surface is looked at first, beside those between its corners: its walls may be inclined.
const PARTS: usize = 8;

/// The same where it has more corners than that.
const MOST_PARTS: usize = 256;

/// Volume of what is inside `bounds` (lower and upper corner of a cuboid), m³; `covered`: its length along the vertical
/// line at a place. The lines' places are chosen by the `shapes` that it is made of.
pub(super) fn volume(shapes: &[&SolidShape], bounds: [[f64; 3]; 2], covered: impl Fn([f64; 2]) -> f64) -> f64 {
    let [lower, upper] = bounds;
    let sides = [0, 1].map(|axis| [lower[axis], upper[axis]]);
    let size = [0, 1, 2].map(|axis| upper[axis] - lower[axis]);
    let allowed = ROUGH * size[1] * size[2];
    let breaks = shapes.iter().flat_map(|shape| along(shape)).collect();
    in_pieces(
        &|x| {
            let breaks = shapes.iter().flat_map(|shape| across(shape, x)).collect();
            in_pieces(&|y| covered([x, y]), sides[1], breaks, 0.1 * allowed)
        },
        sides[0],
        breaks,
        allowed * size[0],
    )
}

/// Places along axis 0 at which what a shape covers of a plane may begin, end or change at once.
fn along(shape: &SolidShape) -> Vec<f64> {
    let [lower, upper] = shape.bounds();
    match shape {
        SolidShape::Prism {
            outline, along: 1 | 2, ..
        } => corners(outline, 0),
        SolidShape::Revolved { outline, about } => corners(outline, 0)
            .into_iter()
            .flat_map(|r| [about[0] - r, about[0] + r])
            .collect(),
        SolidShape::Terrain(raster) => raster.posts(0),
        SolidShape::Surface(surface) => of_corners(surface.corners(0).collect(), [lower[0], upper[0]]),
        _ => vec![lower[0], upper[0]],
    }
}

/// The same along axis 1, of the line at a place of axis 0.
fn across(shape: &SolidShape, x: f64) -> Vec<f64> {
    let [lower, upper] = shape.bounds();
    match shape {
        SolidShape::Prism { outline, along: 0, .. } => corners(outline, 0),
        SolidShape::Prism { outline, along: 2, .. } => outline.at(x).concat(),
        SolidShape::Sphere { center, radius } => chord([center[0], center[1]], *radius, x).to_vec(),
        SolidShape::Revolved { outline, about } => corners(outline, 0)
            .into_iter()
            .flat_map(|r| chord(*about, r, x))
            .collect(),
        SolidShape::Terrain(raster) => raster.posts(1),
        SolidShape::Surface(surface) => of_corners(surface.corners(1).collect(), [lower[1], upper[1]]),
        _ => vec![lower[1], upper[1]],
    }
}

fn corners(outline: &Section, axis: usize) -> Vec<f64> {
    outline
        .edges
        .iter()
        .flat_map(|edge| [edge.a[axis], edge.b[axis]])
        .collect()
}

fn of_corners(mut corners: Vec<f64>, [lower, upper]: [f64; 2]) -> Vec<f64> {
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    let many = corners.len() > MOST_PARTS;
    let parts = if many { MOST_PARTS } else { PARTS };
    let even = (0..=parts).map(|part| lower + (upper - lower) * part as f64 / parts as f64);
    even.chain(if many { Vec::new() } else { corners }).collect()
}

/// A function's integral between the breaks.
fn in_pieces(f: &dyn Fn(f64) -> f64, sides: [f64; 2], mut breaks: Vec<f64>, allowed: f64) -> f64 {
    breaks.extend(sides);
    breaks.retain(|at| sides[0] <= *at && *at <= sides[1]);
    breaks.sort_by(f64::total_cmp);
    breaks
        .windows(2)
        .filter(|piece| piece[0] < piece[1])
        .map(|piece| integral(f, [piece[0], piece[1]], allowed))
        .sum()
}

/// Ends of the chord of a circle along axis 1, at a place of axis 0, m; both in the middle where there is none.
fn chord(center: [f64; 2], radius: f64, x: f64) -> [f64; 2] {
    let half = ((radius - (x - center[0])) * (radius + (x - center[0])))
        .max(0.0)
        .sqrt();
    [center[1] - half, center[1] + half]
}

/// A function's integral by Simpson's rule, in halves until they are the whole but for what is allowed. Its ends are
/// seen just inside: one jump anywhere lies between two places.
fn integral(f: &dyn Fn(f64) -> f64, [lower, upper]: [f64; 2], allowed: f64) -> f64 {
    let inside = 1e-9 * (upper - lower);
    let at = |x: f64| (x, f(x.clamp(lower + inside, upper - inside)));
    let simpson = |[a, b, c]: [(f64, f64); 3]| (c.0 - a.0) / 6.0 * (a.1 + 4.0 * b.1 + c.1);
    let mut done = 0.0;
    let mut open = vec![([at(lower), at(0.5 * (lower + upper)), at(upper)], allowed, HALVINGS)];
    while let Some(([a, b, c], allowed, halvings)) = open.pop() {
        let halves = [[a, at(0.5 * (a.0 + b.0)), b], [b, at(0.5 * (b.0 + c.0)), c]];
        let sum = halves.map(simpson).iter().sum::<f64>();
        if halvings == 0 || (sum - simpson([a, b, c])).abs() <= allowed {
            done += sum;
        } else {
            open.extend(halves.map(|half| (half, 0.5 * allowed, halvings - 1)));
        }
    }
    done
}
