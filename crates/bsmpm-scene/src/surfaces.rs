//! Converts footings, rigid bodies, loads and drains of a case to types of `bsmpm`.

mod strips;
pub(crate) mod transition;

pub(crate) use strips::neighbours;
pub use strips::{penalty, strips};

use crate::case::{Traction, Triangle, keeps_direction};
use crate::grid::vector;
use crate::{ActiveLoads, Case, DrainSite, Face, Geometry, LoadedLine, Plate, Push, Rigid, RigidShape, Shares, Site};
use bsmpm::boundary::{Load, Path, RigidBody, StripReport, SurfacePoint, surface};
use bsmpm::field::pore_water::flow::{Course, Drain, DrainedFace, Given, Inflow, Permeability, Soil};
use bsmpm::grid::Grid;
use bsmpm::interactions::rigid::Outline;
use bsmpm::kinematics::{Axisymmetric, Kinematics};
use bsmpm::schedule::between;
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

/// Where the physics has a drain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrainPlace {
    /// Number among the drained faces of the grid.
    Face(usize),
    /// Number among the drained surfaces of bodies.
    Surface(usize),
}

/// Where every drain of a case is, in the order of the file.
pub fn drain_places(case: &Case) -> Vec<DrainPlace> {
    let mut faces = 0..;
    let mut surfaces = 0..;
    let drains = case.flow.iter().flat_map(|flow| &flow.drains);
    let places = drains.filter_map(|drain| match drain.site {
        DrainSite::Face(_) => faces.next().map(DrainPlace::Face),
        DrainSite::Lines(_) | DrainSite::Circle { .. } | DrainSite::Plate(_) => {
            surfaces.next().map(DrainPlace::Surface)
        }
    });
    places.collect()
}

/// What the case calls a drained surface or, behind those, an inflow, by the numbers that the physics has.
pub fn name_of_drain(case: &Case, surface: usize) -> String {
    let places = drain_places(case);
    match places.iter().position(|place| *place == DrainPlace::Surface(surface)) {
        Some(number) => format!("drain.{number}"),
        None => {
            let drains = places
                .iter()
                .filter(|place| matches!(place, DrainPlace::Surface(_)))
                .count();
            format!("inflow.{}", surface - drains)
        }
    }
}

/// What the case calls a drained face of the grid, by the number that the physics has.
pub fn name_of_drained_face(case: &Case, face: usize) -> String {
    let number = drain_places(case)
        .iter()
        .position(|place| *place == DrainPlace::Face(face));
    format!("drain.{}", number.unwrap_or_default())
}

/// What flow is to the soils and to surfaces once the stages until the time `t` have begun, if water flows.
pub fn flow<K: Kinematics<D>, const D: usize>(
    case: &Case,
    grid: &Grid<D>,
    t: f64,
) -> Option<bsmpm::field::pore_water::flow::Flow<D>> {
    let flow = case.flow.as_ref()?;
    let base = case.grid.lower()[D - 1];
    let mut drains = Vec::new();
    let mut faces = Vec::new();
    for (number, drain) in flow.drains.iter().enumerate() {
        let given = given_above(&drain.given, base);
        let acts = case.acts_since(ActiveLoads::Drain(number), t).is_some();
        if let DrainSite::Face(Face { axis, upper }) = drain.site {
            faces.push(DrainedFace {
                axis,
                upper,
                given,
                acts,
            });
            continue;
        }
        let lines = drain.site.lines().into_iter();
        let parts = lines.map(|line| on_line::<K, D>(case, grid, &line));
        let (points, normals) = parts
            .flat_map(|(points, normals)| points.into_iter().zip(normals))
            .unzip();
        drains.push(Drain {
            points,
            normals,
            given,
            acts,
        });
    }
    let mut inflows = Vec::new();
    for (number, inflow) in flow.inflows.iter().enumerate() {
        let line = match inflow.site {
            Site::Segment { from, to } => Some(LoadedLine::Segment { from, to }),
            Site::Plate(plate) => Some(LoadedLine::Plate(plate)),
            Site::Face(_) => None,
        };
        let (points, normals) = line.map(|line| on_line::<K, D>(case, grid, &line)).unwrap_or_default();
        inflows.push(Inflow {
            points,
            normals,
            rate: inflow.rate.clone(),
            runs_off: inflow.runs_off,
            acts: case.acts_since(ActiveLoads::Inflow(number), t).is_some(),
        });
    }
    Some(bsmpm::field::pore_water::flow::Flow {
        bulk: flow.bulk,
        soils: flow.soils.iter().map(|soil| soil.as_ref().map(of_ground)).collect(),
        drains,
        faces,
        inflows,
        suction: flow.suction,
        motion: case.water_at(t),
    })
}

/// What is given at a drain, with heads (m) above the grid's lower corner, whose height is `base`, m.
fn given_above(given: &Given, base: f64) -> Given {
    match given {
        Given::Head(Course(rows)) => Given::Head(Course(rows.iter().map(|(t, head)| (*t, head - base)).collect())),
        other => other.clone(),
    }
}

/// A soil in the dimension of the geometry.
fn of_ground<const D: usize>(soil: &Soil<3>) -> Soil<D> {
    let permeability = soil.permeability.as_ref().map(|permeability| Permeability {
        along: vector(permeability.along.into()),
        law: permeability.law,
    });
    Soil {
        porosity: soil.porosity,
        permeability,
        retention: soil.retention.clone(),
    }
}

/// Rigid bodies in the order of the file, once the stages until the time `t` have begun.
pub fn rigid<const D: usize>(case: &Case, t: f64) -> Vec<RigidBody<D>> {
    let divided = case.divided_at(t);
    let mut bodies = Vec::new();
    for (number, rigid) in case.rigid.iter().enumerate() {
        let since = case.acts_since(ActiveLoads::Rigid(number), t);
        let begun = since.filter(|since| *since > 0.0 && rigid.force != [0.0; 3]);
        let later = begun.map(|since| Rigid {
            amplitude: course(rigid.ramp, &rigid.amplitude, since),
            ..rigid.clone()
        });
        bodies.push(RigidBody {
            acts: since.is_some(),
            friction: rigid.friction / divided,
            ..rigid_body(later.as_ref().unwrap_or(rigid), case.grid.lower(), case.geometry)
        });
    }
    bodies
}

/// An outline about a reference point, both in m.
pub(crate) fn outline(shape: &RigidShape, about: [f64; 2]) -> Outline {
    match shape {
        RigidShape::Polygon(corners) => Outline::Polygon(
            corners
                .iter()
                .map(|corner| Vector::from(*corner) - Vector::from(about))
                .collect(),
        ),
        RigidShape::Circle { radius, .. } => Outline::Circle(*radius),
        RigidShape::InSpace(solid) => solid.outline(),
    }
}

/// A rigid body as the physics wants it, of a grid with this lower corner.
pub(crate) fn rigid_body<const D: usize>(rigid: &Rigid, lower: [f64; 3], geometry: Geometry) -> RigidBody<D> {
    let mut times: Vec<f64> = rigid
        .path
        .rows
        .iter()
        .map(|row| row.0)
        .chain(rigid.rotation.iter().map(|row| row.0))
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let reference = match &rigid.shape {
        RigidShape::InSpace(solid) => solid.reference(),
        RigidShape::Polygon(_) | RigidShape::Circle { .. } => [rigid.about[0], rigid.about[1], 0.0],
    };
    let outline = match outline(&rigid.shape, rigid.about) {
        Outline::Terrain(mut terrain) => {
            (0..2).for_each(|axis| terrain.lower[axis] -= lower[axis]);
            terrain.heights.iter_mut().for_each(|height| *height -= lower[2]);
            Outline::Terrain(terrain)
        }
        outline => outline,
    };
    let center = match outline {
        Outline::Terrain(_) => Vector::zeros(),
        _ => Vector::from_fn(|axis, _| reference[axis] - lower[axis]),
    };
    let force = Vector::<3>::from(rigid.force) / geometry.whole();
    let load = match (rigid.force == [0.0; 3], rigid.amplitude.is_empty()) {
        (true, _) => Vec::new(),
        (_, true) => vec![(rigid.ramp, force)],
        (_, false) => rigid
            .amplitude
            .iter()
            .map(|(t, share)| (*t, force.component_mul(share)))
            .collect(),
    };
    RigidBody {
        acts: true,
        outline,
        center,
        friction: rigid.friction,
        free: rigid.free,
        path: times.into_iter().map(|t| (t, motion::<D>(rigid, t))).collect(),
        mass: Vector::<3>::new(rigid.mass[0], rigid.mass[0], rigid.mass[1]) / geometry.whole(),
        load,
        velocity: Vector::from(rigid.velocity),
    }
}

/// Displacement of a rigid body at the time `t`, m; in a plane its last component is the angle.
fn motion<const D: usize>(rigid: &Rigid, t: f64) -> Vector<3> {
    let rows = rigid.path.rows.iter().map(|(t, moved)| (*t, Vector::from(*moved)));
    let rows: Vec<(f64, Vector<3>)> = rows.collect();
    let last = rows.last().map_or_else(Vector::zeros, |(_, moved)| *moved);
    let moved = between(&rows, Vector::zeros(), t).unwrap_or(last);
    let turned = rigid.rotation.last().map_or(0.0, |(_, angle)| *angle);
    let turned = between(&rigid.rotation, 0.0, t).unwrap_or(turned);
    Vector::<3>::new(moved[0], moved[1], if D == 2 { turned } else { moved[2] })
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

/// What the footing's histories need.
#[derive(Clone, Debug)]
pub struct FootingMonitor {
    path: Path<3>,
    area: f64,           // m per metre of thickness, or m2 per radian, or m2
    pressing: Vector<3>, // unit normal of the base, towards the material
    moving: Vector<3>,   // unit direction of the whole motion
    height: usize,       // the vertical axis
}

impl FootingMonitor {
    /// The gauge of the case's footing, if there is one.
    pub fn of(case: &Case) -> Option<Self> {
        let footing = case.footing.as_ref()?;
        let rows = footing
            .path
            .rows
            .iter()
            .map(|(time, moved)| (*time, Vector::from(*moved)))
            .collect();
        let height = case.grid.dims() - 1;
        let path = Path { rows };
        let down = -unit::<3>(height);
        let whole = path.at(case.analysis.end);
        let moving = whole.try_normalize(0.0).unwrap_or(down);
        let (normal, area) = match footing.site {
            Site::Segment { from, to } => {
                let [from, to]: [Vector<3>; 2] = [from, to].map(|at| vector(case.grid.local(at)));
                let weight = match case.geometry {
                    Geometry::PlaneStrain | Geometry::Solid => 1.0,
                    Geometry::Axisymmetric => Axisymmetric::weight(&((from + to) * 0.5).fixed_rows::<2>(0).into()),
                };
                (normal(&from, &to), (to - from).norm() * weight)
            }
            Site::Plate(plate) => (unit(plate.normal()), plate.area([case.grid.lower(), case.grid.upper()])),
            Site::Face(_) => return None,
        };
        // A base that only slides along itself presses downwards.
        let side = if normal.dot(&moving).abs() > 1e-9 {
            normal.dot(&moving)
        } else {
            normal.dot(&down)
        };
        Some(Self {
            area,
            pressing: normal * side.signum(),
            moving,
            path,
            height,
        })
    }

    /// Mean normal pressure on the base, Pa, compression positive.
    pub fn pressure(&self, report: &StripReport) -> f64 {
        padded(&report.force).dot(&self.pressing) / self.area
    }

    /// Force of the soil against the motion, N per metre of thickness or per radian; of a solid N.
    pub fn force(&self, report: &StripReport) -> f64 {
        padded(&report.force).dot(&self.moving)
    }

    /// Downward motion until time `t`, m.
    pub fn penetration(&self, t: f64) -> f64 {
        -self.path.at(t)[self.height]
    }
}

/// A vector of a plane or of a solid.
fn padded(of: &[f64]) -> Vector<3> {
    Vector::from_fn(|axis, _| of.get(axis).copied().unwrap_or(0.0))
}

/// Largest slip of a step over its motion; 0 where nothing moved.
pub fn relative_slip(report: &StripReport) -> f64 {
    if report.motion > 0.0 {
        report.slip / report.motion
    } else {
        0.0
    }
}
