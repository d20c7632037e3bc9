//! Finds the side of a loaded surface on which the bodies lie, for the direction of pressures.

use super::place::{along, beside, ring, side_of_bodies};
use super::sheet::middle;
use super::site::places;
use crate::case::{ActiveLoads, Body, Case, LoadedLine, Push, Site};
use crate::grid::GridSpec;
use crate::report::Report;
use crate::schema::Draft;
use crate::surfaces::normal_of;

/// One in so many pieces of a curved surface may have a body on the wrong side: in a corner, or over its edge.
const ASTRAY: usize = 20;

/// On which side of a line bodies lie: 1 to the left of a segment, towards the middle of a circle, in the sense of a
/// plate's axis, where triangles are seen to turn counter-clockwise from, else -1; `None` of both, or none.
pub(super) fn side<'a>(line: &LoadedLine, grid: &GridSpec, bodies: impl Iterator<Item = &'a Body>) -> Option<f64> {
    let bodies: Vec<&Body> = bodies.collect();
    let LoadedLine::Triangles(all) = line else {
        return side_of_bodies(grid, |off| count_at_bodies(line, grid, &bodies, off));
    };
    let [along, against] = beside(grid, |off| count_at_bodies(line, grid, &bodies, off))?;
    let is_one = ASTRAY * along.min(against) <= all.len();
    is_one.then_some(if along > against { 1.0 } else { -1.0 })
}

/// Number of the places along a line that lie in bodies once they are moved along its normal, by `off` m.
fn count_at_bodies(line: &LoadedLine, grid: &GridSpec, bodies: &[&Body], off: f64) -> usize {
    match line {
        &LoadedLine::Segment { from, to } => {
            let x = to[0] - from[0];
            let y = to[1] - from[1];
            let shift = [-y / x.hypot(y) * off, x / x.hypot(y) * off];
            let places = along([from, to]).map(|at| [at[0] + shift[0], at[1] + shift[1]]);
            places.filter(|at| is_in_plane(bodies, *at)).count()
        }
        &LoadedLine::Circle { center, radius } => {
            let places = ring(center, radius - off);
            places.filter(|at| is_in_plane(bodies, *at)).count()
        }
        LoadedLine::Plate(plate) => {
            let places = places(Site::Plate(*plate), grid).into_iter().map(|mut at| {
                at[plate.normal()] += off;
                at
            });
            places.filter(|at| is_in_space(bodies, *at)).count()
        }
        LoadedLine::Triangles(all) => {
            let places = all.iter().map(|triangle| {
                let at = middle(triangle);
                let normal = normal_of(triangle);
                [0, 1, 2].map(|axis| at[axis] + off * normal[axis])
            });
            places.filter(|at| is_in_space(bodies, *at)).count()
        }
    }
}

/// Whether a place of a plane lies in one of the bodies.
fn is_in_plane(bodies: &[&Body], at: [f64; 2]) -> bool {
    bodies.iter().any(|body| body.region.contains(at))
}

/// Whether a place lies in one of the bodies of a solid.
fn is_in_space(bodies: &[&Body], at: [f64; 3]) -> bool {
    bodies.iter().any(|body| body.region.contains_in_space(at))
}

/// Finds on which side of every pressure bodies lie: the same of all that are there at any time at which it acts.
pub(super) fn of_pressures(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    for (number, record) in draft.traction.items().iter().enumerate() {
        let traction = &case.tractions[number];
        let Push::Pressure { profile, .. } = traction.push else {
            continue;
        };
        let times = std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at));
        let acting = times.filter(|t| case.acts_since(ActiveLoads::Load(number), *t).is_some());
        let sides = acting.map(|t| {
            let bodies = case.bodies.iter().enumerate();
            let there = bodies.filter(|(body, _)| case.is_there(*body, t));
            (t, side(&traction.line, &case.grid, there.map(|(_, body)| body)))
        });
        let sides: Vec<(f64, Option<f64>)> = sides.collect();
        let first = sides.first().and_then(|(_, side)| *side);
        if let Some((t, _)) = sides.iter().find(|(_, side)| side.is_none() || *side != first) {
            let message = format!(
                "E0252: at t = {t} soil lies on both sides of the loaded surface, or on neither side. A pressure acts \
                 towards the soil, so its direction is not defined. Move the load to a free surface."
            );
            record.load().error(message, report);
        }
        case.tractions[number].push = Push::Pressure {
            profile,
            side: first.unwrap_or_default(),
        };
    }
}
