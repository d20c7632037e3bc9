//! Draws outlines of rigid bodies.

use bsmpm::boundary::RigidBody;
use bsmpm::boundary::rigid::Outline;
use bsmpm::tensor::Vector;
use bsmpm_io::frame::Frame;
use bsmpm_scene::words::Measurement;
use bsmpm_scene::{Case, Quantity, surfaces};
use std::f64::consts::TAU;

use crate::picture::axes::ChartAxes;
use crate::picture::canvas::Canvas;
use crate::picture::colour::Rgb;
use crate::record::RunRecord;

const RIGID: Rgb = [60, 60, 60];
/// Pieces of an edge, and edges of a circle: those that leave the picture are left out.
const PIECES: usize = 60;

/// Draws all outlines within the `region` of the picture.
pub(super) fn draw(
    canvas: &mut Canvas,
    (axes, region): (&ChartAxes, [(f64, f64); 2]),
    (record, case): (&RunRecord, &Case),
    frame: &Frame,
) {
    if record.is_solid() {
        return;
    }
    let there = |(_, body): &(usize, &RigidBody)| body.acts;
    for (number, body) in surfaces::rigid::<2>(case, case.just_before(frame.time))
        .iter()
        .enumerate()
        .filter(there)
    {
        let Some(moved) = moved((record, case), (number, body), frame) else {
            continue;
        };
        let lower = case.grid.lower();
        let place = |x: &Vector<2>| {
            let (sin, cos) = moved[2].sin_cos();
            let turned = [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]];
            (
                lower[0] + body.center[0] + moved[0] + turned[0],
                lower[1] + body.center[1] + moved[1] + turned[1],
            )
        };
        let seen =
            |&(x, y): &(f64, f64)| (region[0].0..=region[0].1).contains(&x) && (region[1].0..=region[1].1).contains(&y);
        let line: Vec<(f64, f64)> = places(&body.outline).iter().map(place).collect();
        for part in line.split(|at| !seen(at)).filter(|part| part.len() > 1) {
            canvas.line(part.iter().map(|at| axes.place(*at)), 2.0, RIGID);
        }
    }
}

/// m, m and rad  of a body since the start, if it is known.
fn moved((record, case): (&RunRecord, &Case), (number, body): (usize, &RigidBody), frame: &Frame) -> Option<Vector<3>> {
    let on_path = body.on_path(frame.time);
    if !body.is_free() {
        return Some(on_path);
    }
    let steps = record.column("step")?.values;
    let row = steps.iter().position(|&step| step == frame.step as f64)?;
    let recorded = |what: Measurement, end: &str| {
        let wanted = Quantity::Rigid { what, body: number };
        let history = case.histories.iter().find(|history| history.quantity == wanted)?;
        Some(record.column(&format!("{}{end}", history.name))?.values.get(row)? / history.scale)
    };
    let either = |k: usize, what, end| {
        if body.free[k] {
            recorded(what, end)
        } else {
            Some(on_path[k])
        }
    };
    let rotation = match body.free[2] {
        true => recorded(Measurement::RigidRotation, "")?.to_radians(),
        false => on_path[2],
    };
    let along = |k, end| either(k, Measurement::RigidDisplacement, end);
    Some(Vector::<3>::new(along(0, "-x")?, along(1, "-y")?, rotation))
}

/// Places along a closed outline, m from the reference point.
fn places(outline: &Outline) -> Vec<Vector<2>> {
    match outline {
        Outline::Circle(radius) => {
            let at = |k: usize| (k as f64 * TAU / PIECES as f64).sin_cos();
            let turn = |k: usize| Vector::<2>::new(radius * at(k).1, radius * at(k).0);
            // The radius that is drawn shows how it has turned.
            (0..=PIECES).map(turn).chain([Vector::<2>::zeros()]).collect()
        }
        Outline::Box(_) | Outline::Revolved(_) | Outline::Terrain(_) => Vec::new(),
        Outline::Polygon(corners) => {
            let edges = corners.iter().zip(corners.iter().cycle().skip(1));
            let pieces = |(a, b): (&Vector<2>, &Vector<2>)| {
                let (a, b) = (*a, *b);
                (0..=PIECES).map(move |k| a + (b - a) * (k as f64 / PIECES as f64))
            };
            edges.flat_map(pieces).collect()
        }
    }
}
