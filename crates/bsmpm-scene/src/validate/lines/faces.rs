//! Places C0 planes (repeated breakpoints) between bodies of different stiffness or density in 3-D.

use super::ends::replaced;
use super::{BESIDE, FoundLine, ROUNDING, UNLIKE, differ, doubt, grid_line, interface_of};
use crate::case::{Body, Case};

/// Rays along an axis: so many a cell across each of the others, at most so many.
const RAYS_A_CELL: f64 = 2.0;
const MOST_RAYS: usize = 40;
/// Parts of the shortest cell by which a plane must go on sideways.
const SIDEWAYS: f64 = 0.25;

/// A place where two bodies meet, as a ray along an axis passes from one into the other.
struct MeetingPlace {
    axis: usize,
    at: [f64; 3],
    /// whether they meet on a plane across the axis there
    flat: bool,
}

/// Where bodies of a solid of unlike stiffness or density meet; such that may do so elsewhere are doubted.
pub(super) fn interfaces(case: &Case, found: &mut FoundLine) {
    for (i, a) in case.bodies.iter().enumerate() {
        for (j, b) in case.bodies[..i].iter().enumerate() {
            let Some(ratios) = differ(case, a.material, b.material, None).filter(|_| are_together(case, i, j)) else {
                continue;
            };
            let Some(within) = shared(case, [a, b]) else { continue };
            let meetings = meetings(case, [a, b], within);
            if meetings.is_empty() && ratios[0].max(ratios[1]) >= UNLIKE {
                let [a, b] = [a, b].map(|body| &case.materials[body.material].name);
                let doubt = format!(
                    "W0223: bodies of material.{a} and material.{b} are less than a cell apart, but have no common \
                     plane. Stresses there may be wrong. Let the bodies share a plane, and put a grid line on this \
                     plane."
                );
                found.doubts.entry(format!("{a} {b} apart")).or_insert(doubt);
            }
            meetings.iter().for_each(|meeting| note(case, [a, b], meeting, found));
        }
    }
}

/// Whether two bodies are there together at some time.
fn are_together(case: &Case, one: usize, other: usize) -> bool {
    let mut times = std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at));
    times.any(|t| case.is_there(one, t) && case.is_there(other, t))
}

/// Takes the plane of the grid that the bodies meet on, or doubts what they do inside cells.
fn note(case: &Case, bodies: [&Body; 2], meeting: &MeetingPlace, found: &mut FoundLine) {
    let MeetingPlace { axis, at, flat } = *meeting;
    let height = at[2] - case.grid.lower()[2];
    let Some(ratios) = differ(case, bodies[0].material, bodies[1].material, Some(height)) else {
        return;
    };
    let [a, b] = bodies.map(|body| &case.materials[body.material]);
    let line = grid_line(case, axis, at[axis] - case.grid.axes[axis].lower()).filter(|_| flat);
    if let Some(line) = line {
        found.lines.entry((axis, line)).or_insert_with(|| interface_of(a, b));
    }
    if let Some(doubt) = doubt([a, b], line.is_some(), case.stabilisation.averages(), &at, ratios) {
        found
            .doubts
            .entry(format!("{} {} {}", a.name, b.name, line.is_some()))
            .or_insert(doubt);
    }
}

/// m  lower and upper corner of the box in which two bodies may meet.
fn shared(case: &Case, bodies: [&Body; 2]) -> Option<[[f64; 3]; 2]> {
    let beyond = 0.5 * case.grid.shortest();
    let [a, b] = bodies.map(|body| body.region.corners());
    let lower: [f64; 3] = std::array::from_fn(|axis| a[0][axis].max(b[0][axis]) - beyond);
    let upper: [f64; 3] = std::array::from_fn(|axis| a[1][axis].min(b[1][axis]) + beyond);
    (0..3).all(|axis| lower[axis] < upper[axis]).then_some([lower, upper])
}

/// Where rays along the axes pass from one of two bodies into the other within a box.
fn meetings(case: &Case, bodies: [&Body; 2], [lower, upper]: [[f64; 3]; 2]) -> Vec<MeetingPlace> {
    let shortest = case.grid.shortest();
    let lengths: [f64; 3] = std::array::from_fn(|axis| upper[axis] - lower[axis]);
    let mut all = Vec::new();
    for axis in 0..3 {
        let others = [(axis + 1) % 3, (axis + 2) % 3];
        let rays = others.map(|axis| ((RAYS_A_CELL * lengths[axis] / shortest).ceil() as usize).clamp(2, MOST_RAYS));
        let steps = ((4.0 * lengths[axis] / shortest).ceil() as usize).max(2);
        for ray in 0..rays[0] * rays[1] {
            let mut at = [0.0; 3];
            at[others[0]] = middle_of_part(lower[others[0]], lengths[others[0]], ray / rays[1], rays[0]);
            at[others[1]] = middle_of_part(lower[others[1]], lengths[others[1]], ray % rays[1], rays[1]);
            let ends: Vec<f64> = (0..steps)
                .map(|k| middle_of_part(lower[axis], lengths[axis], k, steps))
                .collect();
            let found = ends.windows(2).filter_map(|pair| {
                let ends = [pair[0], pair[1]];
                pass(ends, shortest, |x| body_at(bodies, replaced(at, axis, x)))
            });
            all.extend(found.filter_map(|x| meeting(bodies, axis, replaced(at, axis, x), shortest)));
        }
    }
    all
}

/// The middle of the k-th of equal parts of a length from `lower` on, m.
fn middle_of_part(lower: f64, length: f64, k: usize, parts: usize) -> f64 {
    lower + (k as f64 + 0.5) / parts as f64 * length
}

/// Which of two bodies is at a place, if one is.
fn body_at(bodies: [&Body; 2], at: [f64; 3]) -> Option<usize> {
    bodies.iter().position(|body| body.region.contains_in_space(at))
}

/// Which bodies are on both sides of a place along an axis.
fn sides(bodies: [&Body; 2], axis: usize, at: [f64; 3], shortest: f64) -> [Option<usize>; 2] {
    [-1.0, 1.0].map(|side| {
        let mut at = at;
        at[axis] += side * 2.0 * BESIDE * shortest;
        body_at(bodies, at)
    })
}

/// The meeting at a place: on a plane if both bodies are on their sides of it beside the place, too; none where it is
/// not known as one of them ends there.
fn meeting(bodies: [&Body; 2], axis: usize, at: [f64; 3], shortest: f64) -> Option<MeetingPlace> {
    let own = sides(bodies, axis, at, shortest);
    let mut flat = true;
    for across in [(axis + 1) % 3, (axis + 2) % 3] {
        let beside = [-1.0, 1.0].map(|way| {
            let mut beside = at;
            beside[across] += way * SIDEWAYS * shortest;
            sides(bodies, axis, beside, shortest)
        });
        if beside.contains(&own) {
            continue; // on one side at least: the other may be around a corner
        }
        if beside.as_flattened().contains(&None) {
            return None;
        }
        flat = false;
    }
    Some(MeetingPlace { axis, at, flat })
}

/// Where a ray that is in one body at the first of two places and in another at the second passes from one to the
/// other, if nothing lies between them.
fn pass([from, to]: [f64; 2], shortest: f64, inside: impl Fn(f64) -> Option<usize>) -> Option<f64> {
    let first = inside(from)?;
    let second = inside(to)?;
    if first == second {
        return None;
    }
    let mut before = from;
    let mut after = to;
    while after - before > 0.1 * ROUNDING * shortest {
        let middle = 0.5 * (before + after);
        if middle <= before || middle >= after {
            break;
        }
        if inside(middle) == Some(first) {
            before = middle
        } else {
            after = middle
        }
    }
    (inside(after + BESIDE * shortest) == Some(second)).then_some(0.5 * (before + after))
}
