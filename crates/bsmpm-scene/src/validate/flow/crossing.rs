//! Checks that drains and inflows do not contradict each other, and that the ground can absorb the inflow.

use super::is_permeable;
use crate::case::{ActiveLoads, Case, Drain, DrainSite, Face, Flow, LoadedLine, Plate, Site};
use crate::record::{CaseTable, Location};
use crate::report::{Report, listed};
use crate::schema::Draft;
use crate::validate::side::side;
use crate::validate::site::normal_of;
use crate::validate::{place, site};
use bsmpm::field::pore_water::flow::Given;

/// Parts of a cell by which surfaces may be apart and still be one, and by which they overlap at least to be reported.
const APART: f64 = 0.05;
const OVERLAP: f64 = 0.25;

/// Parts along each axis of a face of the grid in which it is looked for ground.
const PARTS_OF_FACE: usize = 64;

/// A surface that water crosses, with what is given there: a pressure, or else a rate.
struct CrossedSurface<'a> {
    location: &'a Location,
    called: String,
    what: ActiveLoads,
    parts: Vec<SurfacePart>,
    given: Option<&'a Given>,
}

/// A piece of a surface.
#[derive(Clone, Copy)]
enum SurfacePart {
    Line([[f64; 2]; 2]),
    Circle([f64; 2], f64),
    Plate(Plate),
}

/// Refuses surfaces that contradict each other, and warns of inflows that the ground cannot take, and of ground that
/// nothing leaves.
pub(super) fn check(case: &Case, flow: &Flow, draft: &Draft, report: &mut Report<'_>) {
    let crossings = all(case, flow, draft);
    for (number, one) in crossings.iter().enumerate() {
        for other in &crossings[..number] {
            if let Some(message) = contradiction(one, other).filter(|_| meet(case, one, other)) {
                one.location.error(message, report);
            }
        }
    }
    lifted(case, flow, report);
    closed(case, flow, report);
}

/// Ground of the start that its water cannot leave: permeable bodies that touch each other, with no drain on any. Those
/// whose rectangles touch are taken to.
fn closed(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let mut left: Vec<usize> = (0..case.bodies.len())
        .filter(|&body| is_permeable(&flow.soils, case.bodies[body].material) && case.is_there(body, 0.0))
        .collect();
    let near = 0.5 * case.grid.shortest();
    while !left.is_empty() {
        let mut joined = vec![left.remove(0)];
        let mut next = 0;
        while let Some(&one) = joined.get(next) {
            joined.extend(left.extract_if(.., |other| touch(case, one, *other, near)));
            next += 1;
        }
        let mut drained = flow.drains.iter().flat_map(|drain| places(drain, case));
        if !drained.any(|at| is_beside(case, &at, |body| joined.contains(&body))) {
            let all: Vec<String> = joined.iter().map(|body| format!("body.{body}")).collect();
            report.warn(format!(
                "W0530: no drain lies at {}, so no water leaves this soil and its excess pore pressure remains. Add a \
                 [[drain]] at its surface, or set `drainage = \"undrained\"`.",
                listed(&all)
            ));
        }
    }
}

/// Whether the boxes around two bodies are nowhere farther apart than `near`, m.
fn touch(case: &Case, one: usize, other: usize, near: f64) -> bool {
    let [a, b] = [one, other].map(|body| case.bodies[body].region.corners());
    (0..case.grid.dims()).all(|axis| a[0][axis] <= b[1][axis] + near && b[0][axis] <= a[1][axis] + near)
}

fn all<'a>(case: &Case, flow: &'a Flow, draft: &'a Draft) -> Vec<CrossedSurface<'a>> {
    let drains = flow.drains.iter().zip(draft.drain.items()).enumerate();
    let drains = drains.map(|(number, (drain, record))| CrossedSurface {
        location: record.location(),
        called: drain.name.clone().unwrap_or_else(|| format!("drain.{number}")),
        what: ActiveLoads::Drain(number),
        parts: parts(&drain.site, case),
        given: Some(&drain.given),
    });
    let inflows = flow.inflows.iter().zip(draft.inflow.items()).enumerate();
    let inflows = inflows.map(|(number, (inflow, record))| CrossedSurface {
        location: record.location(),
        called: format!("inflow.{number}"),
        what: ActiveLoads::Inflow(number),
        parts: match inflow.site {
            Site::Segment { from, to } => vec![SurfacePart::Line([from, to])],
            Site::Plate(plate) => vec![SurfacePart::Plate(plate)],
            Site::Face(_) => Vec::new(),
        },
        given: None,
    });
    drains.chain(inflows).collect()
}

fn parts(site: &DrainSite, case: &Case) -> Vec<SurfacePart> {
    match site {
        DrainSite::Lines(lines) => lines.iter().map(|line| SurfacePart::Line(*line)).collect(),
        DrainSite::Circle { center, radius } => vec![SurfacePart::Circle(*center, *radius)],
        DrainSite::Plate(plate) => vec![SurfacePart::Plate(*plate)],
        DrainSite::Face(Face { axis, upper }) => {
            let [lower, upper] = [case.grid.lower(), case.grid.upper()].map(|mut corner| {
                corner[*axis] = if *upper { case.grid.upper() } else { case.grid.lower() }[*axis];
                corner
            });
            match case.grid.dims() {
                2 => vec![SurfacePart::Line([lower, upper].map(|[x, y, _]| [x, y]))],
                _ => vec![SurfacePart::Plate(Plate {
                    lower,
                    upper,
                    round: false,
                })],
            }
        }
    }
}

/// What two that lie on one part of a surface say against each other. Rates add up; what a seepage face lets out may
/// have rained on it.
fn contradiction(one: &CrossedSurface<'_>, other: &CrossedSurface<'_>) -> Option<String> {
    let name = &other.called;
    match (one.given, other.given) {
        (Some(a), Some(b)) if a != b => Some(format!(
            "E0530: this drain overlaps drain `{name}`, which prescribes another pressure at the same time. Separate \
             the two drains, or deactivate one of them in a stage."
        )),
        (None, Some(given)) if *given != Given::Seepage => Some(format!(
            "E0531: this inflow overlaps drain `{name}`, so its water would leave the soil at once. Separate the \
             inflow and the drain, or give the drain `seepage = true`."
        )),
        _ => None,
    }
}

/// Whether two overlap while both act.
fn meet(case: &Case, one: &CrossedSurface<'_>, other: &CrossedSurface<'_>) -> bool {
    let mut times = std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at));
    let cell = case.grid.shortest();
    times.any(|t| {
        [one.what, other.what]
            .into_iter()
            .all(|what| case.acts_since(what, t).is_some())
    }) && one
        .parts
        .iter()
        .any(|a| other.parts.iter().any(|b| overlap(case, *a, *b, cell)))
}

fn overlap(case: &Case, a: SurfacePart, b: SurfacePart, cell: f64) -> bool {
    match (a, b) {
        (SurfacePart::Line(a), SurfacePart::Line(b)) => shared(a, b, APART * cell) > OVERLAP * cell,
        (SurfacePart::Circle(a, r), SurfacePart::Circle(b, s)) => {
            (a[0] - b[0]).hypot(a[1] - b[1]).max((r - s).abs()) < APART * cell
        }
        (SurfacePart::Plate(a), SurfacePart::Plate(b)) => {
            let axis = a.normal();
            let is_one = axis == b.normal() && (a.lower[axis] - b.lower[axis]).abs() < APART * cell;
            is_one && (reaches_into(a, b, case) || reaches_into(b, a, case))
        }
        _ => false,
    }
}

/// Whether the middle of a piece of one plate is inside another, which has the same normal.
fn reaches_into(one: Plate, other: Plate, case: &Case) -> bool {
    let normal = one.normal();
    let mut places = site::places(Site::Plate(one), &case.grid).into_iter();
    places.any(|at| {
        let mut axes = (0..3).filter(|&axis| axis != normal);
        axes.all(|axis| other.lower[axis] < at[axis] && at[axis] < other.upper[axis]) && other.covers(at)
    })
}

/// m  of one line that lie on another, to so much aside
fn shared(a: [[f64; 2]; 2], b: [[f64; 2]; 2], aside: f64) -> f64 {
    let along = [a[1][0] - a[0][0], a[1][1] - a[0][1]];
    let length = along[0].hypot(along[1]);
    let [e, n] = [
        [along[0] / length, along[1] / length],
        [-along[1] / length, along[0] / length],
    ];
    // The ends of `b` along `a` and aside of it, from the start of `a`.
    let ends = b.map(|end| {
        let off = [end[0] - a[0][0], end[1] - a[0][1]];
        [e, n].map(|axis| off[0] * axis[0] + off[1] * axis[1])
    });
    if ends.iter().any(|end| end[1].abs() > aside) {
        return 0.0;
    }
    let [p, q] = ends.map(|end| end[0].clamp(0.0, length));
    (p - q).abs()
}

/// Warns of more rain than the ground lets through where nothing runs off.
fn lifted(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    for (number, inflow) in flow.inflows.iter().enumerate().filter(|(_, inflow)| !inflow.runs_off) {
        let line = match inflow.site {
            Site::Segment { from, to } => LoadedLine::Segment { from, to },
            Site::Plate(plate) => LoadedLine::Plate(plate),
            Site::Face(_) => continue,
        };
        if side(&line, &case.grid, case.bodies.iter()).is_none() {
            continue; // a well inside the ground
        }
        let least = least_across(case, flow, inflow.site);
        let rate = inflow.rate.0.iter().map(|row| row.1).fold(0.0, f64::max);
        if let Some((least, material)) = least.filter(|(least, _)| rate > *least) {
            report.warn(format!(
                "W0531: inflow.{number}: {rate:e} m/s exceeds the permeability of `{}` ({least:e} m/s), so the \
                 surface pressure may lift the soil. For rain set `runoff = true`, otherwise reduce the rate.",
                case.materials[material].name
            ));
        }
    }
}

/// The least permeability (m/s) along the normal of a site in the bodies at it, and the number of its material.
fn least_across(case: &Case, flow: &Flow, site: Site) -> Option<(f64, usize)> {
    let normal = normal_of(site);
    let places = site::places(site, &case.grid);
    let under = case.bodies.iter().filter(|body| {
        let body = std::slice::from_ref(*body);
        places.iter().any(|at| place::is_at(body, &case.grid, *at))
    });
    let across = under.filter_map(|body| {
        let permeability = flow.soils[body.material].as_ref()?.permeability.as_ref()?;
        let parts = (0..3).map(|axis| normal[axis].powi(2) * permeability.along[axis]);
        Some((parts.sum::<f64>(), body.material))
    });
    across.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether a body that is `wanted`, by its number, is at a place.
pub(super) fn is_beside(case: &Case, at: &[f64; 3], wanted: impl Fn(usize) -> bool) -> bool {
    let mut bodies = case.bodies.iter().enumerate().filter(|(number, _)| wanted(*number));
    bodies.any(|(_, body)| place::is_at(std::slice::from_ref(body), &case.grid, *at))
}

/// m  where a drain is, in the case's coordinates
pub(super) fn places(drain: &Drain, case: &Case) -> Vec<[f64; 3]> {
    match &drain.site {
        DrainSite::Lines(lines) => lines.iter().flatten().map(|[x, y]| [*x, *y, 0.0]).collect(),
        DrainSite::Circle { center, radius } => place::ring(*center, *radius).map(|[x, y]| [x, y, 0.0]).collect(),
        DrainSite::Plate(plate) => site::places(Site::Plate(*plate), &case.grid),
        DrainSite::Face(face) => places_at_face(*face, case),
    }
}

/// m  where bodies are in the middles of equal pieces of a face of the grid
fn places_at_face(face: Face, case: &Case) -> Vec<[f64; 3]> {
    let ends = [case.grid.lower(), case.grid.upper()];
    let across: Vec<usize> = (0..case.grid.dims()).filter(|axis| *axis != face.axis).collect();
    let mut places = Vec::new();
    for number in 0..PARTS_OF_FACE.pow(across.len() as u32) {
        let mut at = ends[usize::from(face.upper)];
        for (which, &axis) in across.iter().enumerate() {
            let k = number / PARTS_OF_FACE.pow(which as u32) % PARTS_OF_FACE;
            at[axis] = ends[0][axis] + (ends[1][axis] - ends[0][axis]) * (k as f64 + 0.5) / PARTS_OF_FACE as f64;
        }
        if place::is_at(&case.bodies, &case.grid, at) {
            places.push(at);
        }
    }
    places
}
