//! Validates rigid bodies.

mod beyond;
mod motion;
mod outline;
mod overlap;
mod solid;

use self::motion::{moves_as_given, of_free_motions};
use self::outline::{sharpest, thickness};
use self::overlap::{inside, joined, overlap, together};
use super::site::{AroundStrip, normal};
use super::strip;
use super::{MOST_SHOWN_FRICTION, course, load, place, shape};
use crate::case::{ActiveLoads, Case, Initial, MotionPath, Rigid, RigidShape, Support};
use crate::record::{CaseTable, Field};
use crate::report::Report;
use crate::schema::{Draft, RigidTable};
use crate::surfaces;
use crate::words::{Geometry, RigidMotion, Word};
use bsmpm::interactions::rigid::{Outline, Sizes};
use bsmpm::model::Regime;
use bsmpm::tensor::Vector;

/// Cells that a rigid body should be thick, so that it parts what is on its two sides.
const THICK: f64 = 2.0;
/// Parts of a cell by which a rigid body may overlap a body at the start.
const OVERLAP: f64 = 0.05;
/// Parts of a cell that a rigid body may move in a step: material is looked for a cell around it.
const ADVANCE: f64 = 0.5;

/// All rigid bodies in the order of the file, without those that have an error; their friction divided by the `factor`
/// of the strength.
pub(super) fn read_all(
    draft: &Draft,
    around: AroundStrip<'_>,
    regime: Option<Regime>,
    factor: Option<f64>,
    report: &mut Report<'_>,
) -> Vec<Rigid> {
    let mut found: Vec<Rigid> = Vec::new();
    let geometry = draft.geometry.get().unwrap_or(Geometry::PlaneStrain);
    for record in draft.rigid.items() {
        let Some(rigid) = read(record, geometry, around, regime, factor, report) else {
            continue;
        };
        if found.iter().any(|other| other.name == rigid.name) {
            let message = format!(
                "E0421: another rigid body is also called `{}`, so histories cannot tell which one is meant. \
                         Give each rigid body its own `name`.",
                rigid.name
            );
            record.name.error(message, report);
        }
        found.push(rigid);
    }
    found
}

fn read(
    record: &RigidTable,
    geometry: Geometry,
    around: AroundStrip<'_>,
    regime: Option<Regime>,
    factor: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Rigid> {
    if geometry == Geometry::Solid {
        let rigid = solid::read(record, around, factor, report)?;
        fine_enough(record, &rigid, geometry, around, report);
        return Some(rigid);
    }
    let shape = shape::rigid(record.shape(), report);
    let free = free(&record.free, report);
    let path = way(record, around.end, report);
    let rotation = rotation(record, report);
    let force = record.force.if_given().map(|force| force.map_or([0.0; 3], place::flat));
    let force = load::force(
        force,
        &record.force_path,
        &record.ramp,
        &record.amplitude,
        around,
        report,
    );
    let name = record.name.text()?.to_owned();
    let shape = shape?;
    let free = free?;
    let path = path?;
    let rotation = rotation?;
    let ([fx, fy, _], (ramp, amplitude)) = force?;
    let sizes = surfaces::outline(&shape, [0.0; 2]).sizes();
    let centroid = match &shape {
        RigidShape::Polygon(_) => [sizes.centroid[0], sizes.centroid[1]],
        RigidShape::Circle { center, .. } => *center,
        RigidShape::InSpace(_) => return None,
    };
    let about = record.about.if_given()?.unwrap_or(centroid);
    let volume = match geometry {
        Geometry::Axisymmetric => geometry.whole() * surfaces::outline(&shape, centroid).swept(-centroid[0]),
        Geometry::PlaneStrain | Geometry::Solid => sizes.area,
    };
    let mass = mass(record, volume, &sizes)?;
    let moment = record.moment.if_given()?.unwrap_or(0.0);
    let [vx, vy] = record.start_velocity.if_given()?.unwrap_or_default();
    let spin = record.start_spin.if_given()?.unwrap_or(0.0);
    let rigid = Rigid {
        name,
        shape,
        about,
        friction: friction(record, factor, report)?,
        path,
        rotation,
        free,
        mass,
        force: [fx, fy, moment],
        ramp,
        amplitude,
        velocity: [vx, vy, spin],
    };
    moves_as_given(record, &rigid, report);
    of_free_motions(record, &rigid, regime, report);
    fine_enough(record, &rigid, geometry, around, report);
    Some(rigid)
}

/// Which motions follow from forces; `None` after an error.
fn free(key: &Field<Vec<String>>, report: &mut Report<'_>) -> Option<[bool; 3]> {
    let mut free = [false; 3];
    for name in key.list()? {
        let Some(motion) = RigidMotion::of(name) else {
            let allowed: Vec<String> = RigidMotion::WORDS.words().map(|word| format!("\"{word}\"")).collect();
            let message = format!(
                "E0422: `{name}` is not a motion of a rigid body. Use one or more of: {}.",
                allowed.join(", ")
            );
            key.error(message, report);
            return None;
        };
        free[motion as usize] = true;
    }
    Some(free)
}

/// The way of its reference point; of a body that has none an empty one.
fn way(record: &RigidTable, end: Option<f64>, report: &mut Report<'_>) -> Option<MotionPath> {
    if record.motion().place().is_given() {
        strip::path(record.motion(), end, report)
    } else {
        Some(MotionPath { rows: Vec::new() })
    }
}

/// Its rotation, rad.
fn rotation(record: &RigidTable, report: &mut Report<'_>) -> Option<Vec<(f64, f64)>> {
    if !record.rotation.is_given() {
        return Some(Vec::new());
    }
    let rows: Vec<(f64, f64)> = course::increasing(&record.rotation, report)?
        .map(|row| (row[0], row[1].to_radians()))
        .collect();
    if rows[0].0 == 0.0 && rows[0].1 != 0.0 {
        let message = format!(
            "E0403: the rotation at t = 0 is {} degrees, but a path must begin with zero. Set this rotation to zero, \
             or give the row a later time.",
            rows[0].1.to_degrees()
        );
        record.rotation.error(message, report);
        return None;
    }
    Some(rows)
}

/// Mass of a shape of this `volume`, and its second moment; 0 without mass.
fn mass(record: &RigidTable, volume: f64, sizes: &Sizes) -> Option<[f64; 2]> {
    let mass = match (record.mass.is_given(), record.density.is_given()) {
        (true, _) => record.mass.get()?,
        (_, true) => record.density.get()? * volume,
        _ => 0.0,
    };
    let inertia = record.inertia.if_given()?.unwrap_or(mass * sizes.polar / sizes.area);
    Some([mass, inertia])
}

fn friction(record: &RigidTable, factor: Option<f64>, report: &mut Report<'_>) -> Option<f64> {
    let given = record.friction_coefficient.get()?;
    let friction = factor.map_or(given, |factor| given / factor);
    if friction != given {
        let reason = format!("divided by strength_reduction.factor = {}", factor.unwrap_or(1.0));
        report.note(record.friction_coefficient.path(), format!("{friction}"), reason);
    }
    if friction > MOST_SHOWN_FRICTION {
        report.warn(format!(
            "W0204: {}: {friction} is above the largest verified friction coefficient, {MOST_SHOWN_FRICTION}, so \
             steps may not converge. Use at most {MOST_SHOWN_FRICTION}.",
            record.friction_coefficient.path()
        ));
    }
    Some(friction)
}

/// Cells and steps resolve it.
fn fine_enough(
    record: &RigidTable,
    rigid: &Rigid,
    geometry: Geometry,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) {
    let Some(grid) = around.grid else { return };
    let Some(dt) = around.dt else { return };
    let cell = grid.shortest();
    let Solidity {
        outline,
        thickness,
        corner: about,
    } = Solidity::of(rigid);
    let radius = outline.radius();
    let turns = geometry != Geometry::Solid;
    let path = match turns {
        true => surfaces::rigid_body::<2>(rigid, [0.0; 3], geometry).path,
        false => surfaces::rigid_body::<3>(rigid, [0.0; 3], geometry).path,
    };
    let before = std::iter::once((0.0, Vector::zeros())).chain(path.iter().copied());
    let mut most: f64 = 0.0;
    for (from, row) in before.zip(&path).filter(|(from, row)| row.0 > from.0) {
        let moved = (row.1 - from.1) * ((dt / (row.0 - from.0)).min(1.0));
        most = most.max(match turns {
            true => moved[0].hypot(moved[1]) + moved[2].abs() * radius,
            false => moved.norm(),
        });
    }
    if most > ADVANCE * cell {
        report.warn(format!(
            "W0411: {}: the rigid body moves up to {:.2} cells in a step (limit {ADVANCE}), so it may pass through \
             soil without pushing it. Increase analysis.steps, or reduce analysis.dt.",
            record.path.path(),
            most / cell
        ));
    }
    // On the axis of a body of revolution half of a corner is given.
    let axis = (geometry == Geometry::Axisymmetric).then_some(-about[0]);
    if let Some((corner, angle)) = sharpest(&outline, axis).filter(|(_, angle)| 2.0 * (0.5 * angle).sin() < 1.0) {
        report.warn(format!(
            "W0412: {}: the corner at [{}, {}] m has {:.0} degrees (limit 60), so it acts as if it were rounded over \
             a cell. Use smaller cells, or a blunter corner.",
            record.shape().place().path(),
            corner[0] + about[0],
            corner[1] + about[1],
            angle.to_degrees()
        ));
    }
    if thickness < THICK * cell {
        report.warn(format!(
            "W0413: {}: the rigid body is {:.1} cells thick (limit {THICK}), so soil on one side sticks to soil on \
             the other. If there is soil on both sides, use cells of at most {:.3e} m.",
            record.shape().place().path(),
            thickness / cell,
            thickness / THICK
        ));
    }
}

/// What of a rigid body the cells and steps must resolve.
struct Solidity {
    outline: Outline, // about the reference point; of a body of revolution its section
    thickness: f64,   // m
    corner: [f64; 2], // m  the reference point
}

impl Solidity {
    fn of(rigid: &Rigid) -> Self {
        let thickness = match &rigid.shape {
            RigidShape::Circle { radius, .. } => 2.0 * radius,
            RigidShape::Polygon(corners) => thickness(corners),
            RigidShape::InSpace(solid) => return solid::solidity(solid),
        };
        Self {
            outline: surfaces::outline(&rigid.shape, rigid.about),
            thickness,
            corner: rigid.about,
        }
    }
}

/// Whether a body has left its place before a time on the way that it is given.
pub(super) fn has_moved(rigid: &Rigid, t: f64) -> bool {
    let times = rigid.rotation.iter().map(|row| row.0);
    let is_turned = rigid.rotation.iter().map(|row| row.1 != 0.0);
    strip::path_begins_before(&rigid.path, t) || strip::begins_before(times, is_turned, t)
}

/// What the rest of the case says to rigid bodies.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for (number, (rigid, record)) in case.rigid.iter().zip(draft.rigid.items()).enumerate() {
        if rigid.velocity != [0.0; 3] && case.acts_since(ActiveLoads::Rigid(number), 0.0).is_none() {
            let key = match record.start_velocity.is_given() {
                true => &*record.start_velocity,
                false => &record.start_spin,
            };
            let message = "E0430: an initial velocity applies at t = 0, but a stage adds this rigid body later. \
                 Delete this key, and let `force` or gravity move the body.";
            key.error(message, report);
        }
        if case.settles || case.initial == Some(Initial::Elastic) {
            report.warn(format!(
                "W0414: {}: the equilibrium of [initial] is found without rigid bodies, so soil that these bodies \
                 support moves at the start. Give only `k0` in [initial], or replace [initial] by gravity.ramp.",
                record.location().path
            ));
        }
        let absorbs = case.is_ever(Support::Absorbing) || case.is_ever(Support::FreeField);
        if absorbs && case.gravity.is_some() {
            report.warn(format!(
                "W0415: {}: absorbing boundaries carry no permanent load, so the ground sinks steadily under the \
                 weight of this rigid body. Set one boundary to \"fixed\".",
                record.location().path
            ));
        }
        beyond::check(case, rigid, record, report);
        if let RigidShape::InSpace(solid) = &rigid.shape {
            solid::check(case, number, rigid, solid, record, report);
            joined(case, number, rigid, record, report);
        } else if let Some((at, body)) = overlap(case, rigid, |body| together(case, number, body).is_some()) {
            let message = inside(case, number, body, &format!("{:.4}, {:.4}", at[0], at[1]));
            record.shape().place().error(message, report);
        } else {
            joined(case, number, rigid, record, report);
        }
    }
}

/// Whether a rigid body other than `except` that rests or is moved holds a component of a body that lies at it from the
/// start on.
pub(super) fn hold(case: &Case, component: usize, except: Option<ActiveLoads>) -> bool {
    case.rigid.iter().enumerate().any(|(number, rigid)| {
        let acting = ActiveLoads::Rigid(number);
        let may_hold = !rigid.free.contains(&true) && Some(acting) != except;
        may_hold && case.acts_since(acting, 0.0).is_some() && holds(case, rigid, component)
    })
}

/// Whether a rigid body that rests holds a component of a body that lies at it.
fn holds(case: &Case, rigid: &Rigid, component: usize) -> bool {
    let out = OVERLAP * case.grid.shortest();
    let has_friction = rigid.friction > 0.0;
    match &rigid.shape {
        RigidShape::Circle { center, radius } => {
            has_friction && place::ring(*center, radius + out).any(|at| is_body_at(case, at))
        }
        RigidShape::Polygon(corners) => corners.iter().zip(corners.iter().cycle().skip(1)).any(|(from, to)| {
            let normal = normal(*from, *to); // to the left, inside
            let pushes = has_friction || normal[component].abs() > OVERLAP;
            let places = place::along([*from, *to]);
            let mut beside = places.map(|at| [at[0] - out * normal[0], at[1] - out * normal[1]]);
            pushes && beside.any(|at| is_body_at(case, at))
        }),
        RigidShape::InSpace(_) => false,
    }
}

/// Whether some body of a plane is at a place.
fn is_body_at(case: &Case, at: [f64; 2]) -> bool {
    case.bodies.iter().any(|body| body.region.contains(at))
}
