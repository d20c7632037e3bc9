//! C0 lines of a solid: planes of the grid on which bodies of unlike stiffness or density meet.

use super::{BESIDE, FoundLine, ROUNDING, differ, doubt, grid_line, told_to_meet};
use crate::case::{Body, Case};

/// Lines along each of two axes of a box along which both bodies are looked for.
const RAYS: usize = 9;

/// A place where two bodies meet, as a ray along an axis passes from one into the other.
struct Meeting {
    axis: usize,
    at: [f64; 3],
}

/// Where bodies of a solid of unlike stiffness or density meet.
pub(super) fn interfaces(case: &Case, found: &mut FoundLine) {
    for (number, a) in case.bodies.iter().enumerate() {
        for b in &case.bodies[..number] {
            if differ(case, (a.material, b.material), None).is_some() {
                meetings(case, [a, b]).into_iter().for_each(|meeting| note(case, [a, b], &meeting, found));
            }
        }
    }
}

/// Takes the plane of the grid that the bodies meet on, or doubts what they do inside cells.
fn note(case: &Case, bodies: [&Body; 2], meeting: &Meeting, found: &mut FoundLine) {
    let Meeting { axis, at } = *meeting;
    let height = at[2] - case.grid.lower()[2];
    let Some(ratios) = differ(case, (bodies[0].material, bodies[1].material), Some(height)) else { return };
    let [a, b] = bodies.map(|body| &case.materials[body.material]);
    let line = grid_line(case, axis, at[axis] - case.grid.axes[axis].lower());
    if let Some(line) = line {
        found.lines.entry((axis, line)).or_insert_with(|| told_to_meet(a, b));
    }
    if let Some(doubt) = doubt([a, b], (line.is_some(), case.stabilisation.averages()), (&at, ratios)) {
        found.doubts.entry(format!("{} {} {}", a.name, b.name, line.is_some())).or_insert(doubt);
    }
}

/// Where rays along the axes pass from one of two bodies into the other, in the box that both reach.
fn meetings(case: &Case, bodies: [&Body; 2]) -> Vec<Meeting> {
    let shortest = case.grid.shortest();
    let [a, b] = bodies.map(|body| body.region.corners());
    let lower: [f64; 3] = std::array::from_fn(|axis| a[0][axis].max(b[0][axis]) - 0.5 * shortest);
    let upper: [f64; 3] = std::array::from_fn(|axis| a[1][axis].min(b[1][axis]) + 0.5 * shortest);
    if (0..3).any(|axis| lower[axis] >= upper[axis]) {
        return Vec::new();
    }
    let part =
        |axis: usize, k: usize, of: usize| lower[axis] + (k as f64 + 0.5) / of as f64 * (upper[axis] - lower[axis]);
    let mut all = Vec::new();
    for axis in 0..3 {
        let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
        let steps = ((4.0 * (upper[axis] - lower[axis]) / shortest).ceil() as usize).max(2);
        for ray in 0..RAYS * RAYS {
            let mut at = [0.0; 3];
            (at[one], at[other]) = (part(one, ray / RAYS, RAYS), part(other, ray % RAYS, RAYS));
            let place = |x: f64| {
                let mut at = at;
                at[axis] = x;
                at
            };
            let inside = |x: f64| bodies.iter().position(|body| body.region.contains_in_space(place(x)));
            let ends: Vec<f64> = (0..steps).map(|k| part(axis, k, steps)).collect();
            for pair in ends.windows(2) {
                let found = pass([pair[0], pair[1]], shortest, inside);
                all.extend(found.map(|x| Meeting { axis, at: place(x) }));
            }
        }
    }
    all
}

/// Where a ray that is in one body at the first of two places and in another at the second passes from one to the
/// other, if nothing lies between them.
fn pass([from, to]: [f64; 2], shortest: f64, inside: impl Fn(f64) -> Option<usize>) -> Option<f64> {
    let (first, second) = (inside(from)?, inside(to)?);
    if first == second {
        return None;
    }
    let (mut before, mut after) = (from, to);
    while after - before > 0.1 * ROUNDING * shortest {
        let middle = 0.5 * (before + after);
        if middle <= before || middle >= after {
            break;
        }
        if inside(middle) == Some(first) { before = middle } else { after = middle }
    }
    (inside(after + BESIDE * shortest) == Some(second)).then_some(0.5 * (before + after))
}
