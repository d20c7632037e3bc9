//! Finds where bodies overlap a rigid body or are added next to it.

use super::OVERLAP;
use crate::case::{ActiveLoads, Body, Case, Rigid, RigidShape, Stage};
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::RigidTable;
use crate::surfaces;
use crate::validate::place;
use crate::validate::site::normal;
use bsmpm::interactions::rigid::Outline;
use bsmpm::tensor::Vector;

/// The stage with which a body and a rigid one are there together first; `Some(None)`: from the start on.
pub(super) fn together(case: &Case, rigid: usize, body: usize) -> Option<Option<&Stage>> {
    let mut times = std::iter::once((0.0, None)).chain(case.stages.iter().map(|stage| (stage.at, Some(stage))));
    let first =
        times.find(|(t, _)| case.is_there(body, *t) && case.acts_since(ActiveLoads::Rigid(rigid), *t).is_some());
    first.map(|(_, stage)| stage)
}

/// What is said where a body is in a rigid one when they are there together first.
pub(super) fn inside(case: &Case, rigid: usize, body: usize, at: &str) -> String {
    let stage = together(case, rigid, body).flatten();
    let (when, or) = match stage {
        None => ("at the start".to_owned(), String::new()),
        Some(stage) if stage.add.contains(&body) => (
            format!("when a stage adds body.{body} at t = {}", stage.at),
            String::new(),
        ),
        Some(stage) => (
            format!("when a stage adds the rigid body at t = {}", stage.at),
            format!(", or remove body.{body} in this stage"),
        ),
    };
    format!(
        "E0431: body.{body} overlaps this rigid body at [{at}] m by more than {OVERLAP} cells {when}. Subtract the \
         shape of the rigid body from body.{body}{or}."
    )
}

/// What stages place at a rigid body, or where one is that they apply, may lie nearer than it reaches.
pub(super) fn joined(case: &Case, number: usize, rigid: &Rigid, record: &RigidTable, report: &mut Report<'_>) {
    let reach = surfaces::outline(&rigid.shape, rigid.about).radius() + longest(case);
    let moves = rigid.free.contains(&true) || !rigid.path.rows.is_empty() || !rigid.rotation.is_empty();
    for (body, of) in case.bodies.iter().enumerate() {
        let Some(stage) = together(case, number, body).flatten() else {
            continue;
        };
        let [lower, upper] = of.bounds();
        let is_near = (0..2).all(|k| lower[k] < rigid.about[k] + reach && upper[k] > rigid.about[k] - reach);
        let is_added = stage.add.contains(&body);
        if !(is_near || moves && is_added) {
            continue;
        }
        let added = if is_added {
            format!("body.{body} next to this rigid body")
        } else {
            format!("this rigid body next to body.{body}")
        };
        report.warn(format!(
            "W0416: {}: a stage adds {added}. Material points closer than half their spacing to the rigid body are pushed \
             away in one step, and strained. Leave a gap of half a spacing of material points.",
            record.location().path
        ));
        return;
    }
}

/// m  longest edge of all cells.
fn longest(case: &Case) -> f64 {
    let mut longest: f64 = 0.0;
    for knots in &case.grid.axes[..2] {
        let edges = (0..knots.cells()).map(|cell| knots.breakpoint(cell + 1) - knots.breakpoint(cell));
        longest = edges.fold(longest, f64::max);
    }
    longest
}

/// A place of a body among those that are `there` that is inside a rigid one as it is at the start, if there is one.
pub(super) fn overlap(case: &Case, rigid: &Rigid, there: impl Fn(usize) -> bool) -> Option<([f64; 2], usize)> {
    let inset = OVERLAP * case.grid.shortest();
    let outline = surfaces::outline(&rigid.shape, rigid.about);
    let bodies = case.bodies.iter().enumerate();
    let bodies: Vec<(usize, &Body)> = bodies.filter(|(number, _)| there(*number)).collect();
    for at in places_inside(rigid, inset) {
        if !is_inside(&outline, rigid.about, at, inset) {
            continue;
        }
        if let Some((number, _)) = bodies.iter().find(|(_, body)| body.region.contains(at)) {
            return Some((at, *number));
        }
    }
    // A small body may lie in it whole.
    for (number, body) in bodies {
        let [lower, upper] = body.bounds();
        let middle = [0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis]));
        if is_inside(&outline, rigid.about, middle, inset) && body.region.contains(middle) {
            return Some((middle, number));
        }
    }
    None
}

/// Places along a rigid body in the plane, at a distance (m) from its surface; corners may be nearer.
fn places_inside(rigid: &Rigid, inset: f64) -> Vec<[f64; 2]> {
    match &rigid.shape {
        RigidShape::Circle { center, radius } => place::ring(*center, (radius - inset).max(0.0)).collect(),
        RigidShape::Polygon(corners) => {
            let edges = corners.iter().zip(corners.iter().cycle().skip(1));
            let places = edges.flat_map(|(from, to)| {
                let normal = normal(*from, *to); // to the left, inside
                place::along([*from, *to]).map(move |at| [at[0] + inset * normal[0], at[1] + inset * normal[1]])
            });
            places.collect()
        }
        RigidShape::InSpace(_) => Vec::new(),
    }
}

/// Whether a place is deeper than half of `inset` (m) in an outline about a reference point.
fn is_inside(outline: &Outline, about: [f64; 2], at: [f64; 2], inset: f64) -> bool {
    let seen = Vector::<2>::new(at[0] - about[0], at[1] - about[1]);
    outline.nearest(&seen).distance < -0.5 * inset
}
