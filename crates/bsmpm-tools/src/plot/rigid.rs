//! Draws outlines of rigid bodies.

use bsmpm::interactions::rigid::Outline;
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::tensor::Vector;
use bsmpm_io::frame::Frame;
use bsmpm_scene::observables::Observable;
use bsmpm_scene::{Case, HistorySubject, Quantity, surfaces};
use std::f64::consts::TAU;

use crate::picture::axes::ChartAxes;
use crate::picture::canvas::Canvas;
use crate::picture::colour::Rgb;
use crate::picture::ticks::ValueRange;
use crate::record::RunRecord;

const RIGID: Rgb = [60, 60, 60];
/// Pieces of an edge, and edges of a circle: those that leave the picture are left out.
const PIECES: usize = 60;

/// Draws all outlines within the `region` of the picture.
pub(super) fn draw(
    canvas: &mut Canvas,
    axes: &ChartAxes,
    region: [ValueRange; 2],
    record: &RunRecord,
    case: &Case,
    frame: &Frame,
) {
    if record.is_solid() {
        return;
    }
    let lower = case.grid.lower();
    let bodies = surfaces::rigid::<2>(case, case.just_before(frame.time));
    for (number, body) in bodies.iter().enumerate().filter(|(_, body)| body.acts) {
        let Some(moved) = moved(record, case, number, body, frame) else {
            continue;
        };
        let (sin, cos) = moved[2].sin_cos();
        let mut line: Vec<[f64; 2]> = Vec::new();
        for x in places(&body.outline) {
            let turned = [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]];
            line.push([0, 1].map(|axis| lower[axis] + body.center[axis] + moved[axis] + turned[axis]));
        }
        let parts = line.split(|[x, y]| !(region[0].contains(*x) && region[1].contains(*y)));
        for part in parts.filter(|part| part.len() > 1) {
            canvas.line(part.iter().map(|at| axes.place(*at)), 2.0, RIGID);
        }
    }
}

/// m, m and rad  of a body since the start, if it is known.
fn moved(record: &RunRecord, case: &Case, number: usize, body: &RigidBody, frame: &Frame) -> Option<Vector<3>> {
    let mut moved = body.on_path(frame.time);
    if !body.is_free() {
        return Some(moved);
    }
    let steps = record.column("step")?.values;
    let row = steps.iter().position(|&step| step == frame.step as f64)?;
    for (axis, end) in ["-x", "-y", ""].into_iter().enumerate() {
        if !body.free[axis] {
            continue;
        }
        let what = match axis {
            2 => Observable::RigidRotation,
            _ => Observable::RigidDisplacement,
        };
        let wanted = Quantity::new(what, HistorySubject::Rigid(number));
        let history = case.histories.iter().find(|history| history.quantity == wanted)?;
        let values = record.column(&format!("{}{end}", history.name))?.values;
        moved[axis] = values.get(row)? / history.scale;
    }
    if body.free[2] {
        moved[2] = moved[2].to_radians();
    }
    Some(moved)
}

/// Places along a closed outline, m from the reference point.
fn places(outline: &Outline) -> Vec<Vector<2>> {
    match outline {
        Outline::Circle(radius) => {
            let circle = (0..=PIECES).map(|k| {
                let (sin, cos) = (k as f64 * TAU / PIECES as f64).sin_cos();
                Vector::<2>::new(radius * cos, radius * sin)
            });
            // The radius that is drawn shows how it has turned.
            circle.chain([Vector::<2>::zeros()]).collect()
        }
        Outline::Box(_) | Outline::Revolved(_) | Outline::Terrain(_) => Vec::new(),
        Outline::Polygon(corners) => {
            let mut places = Vec::new();
            for (&a, &b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                places.extend((0..=PIECES).map(|k| a + (b - a) * (k as f64 / PIECES as f64)));
            }
            places
        }
    }
}
