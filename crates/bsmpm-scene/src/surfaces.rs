//! Converts footings, rigid bodies, loads and drains of a case to types of `bsmpm`.

mod drains;
mod footing;
mod rigid_bodies;
mod strips;
pub(crate) mod transition;

pub use drains::{DrainPlace, drain_places, flow, name_of_drain, name_of_drained_face};
pub use footing::FootingMonitor;
pub use rigid_bodies::rigid;
pub(crate) use rigid_bodies::{outline, rigid_body};
pub(crate) use strips::neighbours;
pub use strips::{penalty, strips};

use crate::case::{Traction, Triangle, keeps_direction};
use crate::grid::vector;
use crate::{ActiveLoads, Case, Face, LoadedLine, Plate, Push, Shares, Site};
use bsmpm::boundary::{SurfacePoint, surface};
use bsmpm::grid::Grid;
use bsmpm::interactions::load::Load;
use bsmpm::interactions::strip::StripReport;
use bsmpm::kinematics::Kinematics;
use bsmpm::tensor::Vector;

/// The strip that holds a face of the grid, if any.
pub fn strip_of_face(case: &Case, face: Face) -> Option<usize> {
    let found = case
        .prescribed
        .iter()
        .position(|prescribed| prescribed.site == Site::Face(face))?;
    Some(found + usize::from(case.footing.is_some()))
}

/// What the case calls a strip.
pub fn name_of_strip(case: &Case, strip: usize) -> String {
    match strip.checked_sub(usize::from(case.footing.is_some())) {
        None => "footing".into(),
        Some(number) => format!("prescribed.{number}"),
    }
}

/// Tractions, then point loads, once the stages until the time `t` have begun; of those whose direction changes the
/// part along the first axis, and behind all others (`Case::turning_loads`) those along the other axes.
pub fn loads<K: Kinematics<D>, const D: usize>(case: &Case, grid: &Grid<D>, t: f64) -> Vec<Load<D>> {
    let tractions = case.tractions.iter();
    let tractions = tractions.map(|traction| (traction_load::<K, D>(case, grid, traction), &traction.amplitude));
    let forces = case.point_loads.iter().map(|load| {
        let at = vector::<D, _>(load.at) - vector(case.grid.lower());
        let point = SurfacePoint::at(at, 1.0 / case.geometry.whole());
        (Load::dead(vec![point], vector(load.force), load.ramp), &load.amplitude)
    });
    let mut all = Vec::new();
    let mut further = Vec::new();
    for (number, (load, shares)) in tractions.chain(forces).enumerate() {
        let acting = match case.acts_since(ActiveLoads::Load(number), t) {
            None => vec![(0.0, Vector::zeros())],
            Some(since) if since > 0.0 => course(load.ramp, shares, since),
            Some(_) => shares.clone(),
        };
        let (first, others) = steady(load, &acting, keeps_direction(shares));
        all.push(first);
        further.extend(others);
    }
    all.append(&mut further);
    all
}

/// A traction at the points of its line, without its amplitude.
fn traction_load<K: Kinematics<D>, const D: usize>(case: &Case, grid: &Grid<D>, traction: &Traction) -> Load<D> {
    let (points, left) = on_line::<K, D>(case, grid, &traction.line);
    let base = case.grid.lower()[D - 1];
    let heights = points.iter().map(|point| point.x[D - 1] + base);
    let (values, follows) = match traction.push {
        Push::Stress(stress) => {
            let pushed = heights.map(|height| vector(stress.map(|along| along.at(height))));
            (pushed.collect(), false)
        }
        Push::Pressure { profile, side } => {
            let pressed = heights
                .zip(left)
                .map(|(height, left)| left * (side * profile.at(height)));
            (pressed.collect(), true)
        }
    };
    Load {
        points,
        traction: values,
        follows,
        ramp: traction.ramp,
        amplitude: Vec::new(),
    }
}

/// A load as one of a steady direction, and those of the axes behind the first if its direction changes.
fn steady<const D: usize>(load: Load<D>, shares: &Shares, keeps_direction: bool) -> (Load<D>, Vec<Load<D>>) {
    if keeps_direction {
        let amplitude = shares_along(shares, 0);
        return (Load { amplitude, ..load }, Vec::new());
    }
    let parts = (0..D).map(|axis| Load {
        traction: load.traction.iter().map(|of| unit::<D>(axis) * of[axis]).collect(),
        amplitude: shares_along(shares, axis),
        ..load.clone()
    });
    let mut parts: Vec<Load<D>> = parts.collect();
    let first = parts.remove(0);
    (first, parts)
}

/// Shares along an axis, with their times, s.
fn shares_along(shares: &Shares, axis: usize) -> Vec<(f64, f64)> {
    shares.iter().map(|(t, share)| (*t, share[axis])).collect()
}

/// Points of a line, with unit normals to the left of a segment, towards the middle of a circle, along a plate's axis,
/// where triangles are seen to turn counter-clockwise from.
fn on_line<K: Kinematics<D>, const D: usize>(
    case: &Case,
    grid: &Grid<D>,
    line: &LoadedLine,
) -> (Vec<SurfacePoint<D>>, Vec<Vector<D>>) {
    let across = case.bodies.iter().map(|body| body.points_per_cell).max().unwrap_or(1);
    let place = |at: [f64; 2]| vector(case.grid.local(at));
    match line {
        &LoadedLine::Segment { from, to } => {
            let from = place(from);
            let to = place(to);
            let points = surface::along::<K, D>(grid, &from, &to, across);
            points.into_iter().map(|point| (point, normal(&from, &to))).unzip()
        }
        &LoadedLine::Circle { center, radius } => {
            around::<K, D>(grid, &place(center), radius, across).into_iter().unzip()
        }
        LoadedLine::Plate(plate) => {
            let points = on_plate::<K, D>(case, grid, plate, across);
            points.into_iter().map(|point| (point, unit(plate.normal()))).unzip()
        }
        LoadedLine::Triangles(triangles) => {
            let base = vector::<D, _>(case.grid.lower());
            let points = triangles.iter().map(|triangle| {
                let corners = triangle.map(|at| vector::<D, _>(at) - base);
                (SurfacePoint::of_triangle(corners), vector(normal_of(triangle)))
            });
            points.unzip()
        }
    }
}

/// m²  area of a triangle, a vector along the normal from which its corners turn counter-clockwise
pub(crate) fn area_of([a, b, c]: &Triangle) -> Vector<3> {
    let [along, across] = [b, c].map(|end| Vector::<3>::from(*end) - Vector::from(*a));
    along.cross(&across) * 0.5
}

/// Unit normal of a triangle, from which its corners turn counter-clockwise; 0 of one without area.
pub(crate) fn normal_of(triangle: &Triangle) -> [f64; 3] {
    area_of(triangle).try_normalize(0.0).unwrap_or_default().into()
}

/// The course of a load that begins at the time `since`, where nothing of it acts yet.
fn course(ramp: f64, amplitude: &Shares, since: f64) -> Shares {
    let ramp = [(ramp, Vector::from_element(1.0))];
    let rows = if amplitude.is_empty() { &ramp[..] } else { amplitude };
    std::iter::once((since, Vector::zeros()))
        .chain(rows.iter().map(|(t, share)| (since + t, *share)))
        .collect()
}

/// Points of a circle inside the grid with unit vectors towards its centre, `count` and more in a cell.
fn around<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    center: &Vector<D>,
    radius: f64,
    count: usize,
) -> Vec<(SurfacePoint<D>, Vector<D>)> {
    let length = std::f64::consts::TAU * radius;
    // In fours, so that a circle has the grid's symmetries.
    let pieces = 4 * (length / grid.smallest_edge() * count as f64 / 4.0).ceil() as usize;
    let mut points = Vec::new();
    for k in 0..pieces {
        // At the first end, in the middle and at the second end of the piece.
        let outward: [Vector<D>; 3] = [0.0, 0.5, 1.0].map(|part| {
            let (sin, cos) = ((k as f64 + part) * std::f64::consts::TAU / pieces as f64).sin_cos();
            vector([cos, sin])
        });
        let [a, x, b] = outward.map(|outward| center + outward * radius);
        let area = length / pieces as f64 * K::weight(&x);
        let corners = [a, a, b, b];
        if grid.locate(&x).is_some() {
            points.push((SurfacePoint { x, area, corners }, -outward[1]));
        }
    }
    points
}

/// Points of a plate, `count` along each axis of a cell.
fn on_plate<K: Kinematics<D>, const D: usize>(
    case: &Case,
    grid: &Grid<D>,
    plate: &Plate,
    count: usize,
) -> Vec<SurfacePoint<D>> {
    let base = vector::<D, _>(case.grid.lower());
    let [lower, upper, middle] = [plate.lower, plate.upper, plate.middle()].map(|at| vector::<D, _>(at) - base);
    if !plate.round {
        return surface::over::<K, D>(grid, &lower, &upper, count);
    }
    // Of a disc the part inside the grid.
    let lengths = Vector::from_fn(|axis, _| case.grid.axes[axis].length());
    let [lower, upper] = [lower, upper].map(|at| at.zip_map(&lengths, |x, length| x.clamp(0.0, length)));
    surface::within::<K, D>(grid, &lower, &upper, &middle, plate.radius(), count)
}

fn unit<const D: usize>(along: usize) -> Vector<D> {
    Vector::from_fn(|axis, _| f64::from(u8::from(axis == along)))
}

/// Unit normal of a segment.
fn normal<const D: usize>(from: &Vector<D>, to: &Vector<D>) -> Vector<D> {
    let along = (to - from).normalize();
    vector([-along[1], along[0]])
}

/// Largest slip of a step over its motion; 0 where nothing moved.
pub fn relative_slip(report: &StripReport) -> f64 {
    if report.motion > 0.0 {
        report.slip / report.motion
    } else {
        0.0
    }
}
