//! Warns of bodies that leave the grid through a free face.

use super::physics;
use crate::case::{Body, Case, Face, Geometry, RigidShape, RigidSolid, Support};
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::Draft;
use bsmpm::model::Regime;
use bsmpm_shapes::Region;

/// Times between start and end at which the place of a body is tried.
const SAMPLES: usize = 100;

/// Motion of a body at the start, as that of a rigid body to which nothing happens.
struct FreeMotion<'a> {
    body: &'a Body,
    /// m/s2  of gravity
    acceleration: [f64; 3],
    /// m  outermost points, in the case's coordinates: half of their spacing inside of the corners
    points: Vec<[f64; 3]>,
}

/// When and how far a body goes beyond a face.
#[derive(Clone, Copy)]
struct Exit {
    time: f64,      // s
    overshoot: f64, // m  the farthest
}

/// Warns of bodies in dynamic analysis that lie within a cell of a free face, are held by nothing along its normal, and
/// leave the grid there before the end of the run unless something stops them.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if case.analysis.regime != Regime::Dynamic {
        return;
    }
    let faces = (0..case.grid.dims()).flat_map(|axis| [false, true].map(|upper| Face { axis, upper }));
    let open: Vec<Face> = faces.filter(|face| is_open(case, *face)).collect();
    for (body, record) in case.bodies.iter().zip(draft.body.items()) {
        let motion = FreeMotion::of(case, body);
        for &face in &open {
            let Face { axis, upper } = face;
            let along = &case.grid.axes[axis];
            let cell = along.cell(if upper { along.cells() - 1 } else { 0 });
            let distance = -motion.overhang(case, face);
            if distance >= cell {
                continue;
            }
            let Some(exit) = motion.exit(case, face) else { continue };
            let side = face.side(case.geometry);
            report.warn(format!(
                "W0230: {}: the body moves out of the grid through the free face {side} at about t = {:.3} s, so the \
                 run would stop then. Enlarge the grid at this face by {:.3} m, or support the face.",
                record.location().path,
                exit.time,
                exit.overshoot
            ));
        }
    }
}

/// Whether a body can leave through a face: it is free, nothing holds along its normal, and no terrain lies above it.
fn is_open(case: &Case, face: Face) -> bool {
    let is_axis = case.geometry == Geometry::Axisymmetric && face.axis == 0;
    let is_free = case.boundary[face.axis][usize::from(face.upper)] == Support::Free;
    !is_axis && is_free && !has_terrain_above(case, face) && !physics::holds_at_rest(case, face.axis, None)
}

/// Whether a face is the bottom of the grid and the case has rigid terrain, which lies above it: the terrain is level
/// beyond its raster, so that every body comes to rest on it.
fn has_terrain_above(case: &Case, face: Face) -> bool {
    let is_bottom = face.axis == case.grid.dims() - 1 && !face.upper;
    let mut shapes = case.rigid.iter().map(|rigid| &rigid.shape);
    is_bottom && shapes.any(|shape| matches!(shape, RigidShape::InSpace(RigidSolid::Terrain(_))))
}

impl<'a> FreeMotion<'a> {
    fn of(case: &Case, body: &'a Body) -> Self {
        let acceleration = case.gravity.as_ref().map_or([0.0; 3], |gravity| gravity.acceleration);
        let lower = case.grid.lower();
        let bounds = body.region.corners();
        let corners: Vec<[f64; 3]> = match &body.region {
            // Of a solid the bounds move without turning.
            Region::Solid(_) => bounds.to_vec(),
            region => {
                let (edges, _) = region.edges(&case.grid.axes);
                let ends = edges
                    .iter()
                    .filter(|edge| edge.shape == 0)
                    .flat_map(|edge| [edge.a, edge.b]);
                ends.map(|[x, y]| [x + lower[0], y + lower[1], 0.0]).collect()
            }
        };
        let inset = 0.5 * case.grid.shortest() / body.points_per_cell as f64;
        let points = corners.into_iter().map(|at| {
            std::array::from_fn(|axis| {
                let middle = 0.5 * (bounds[0][axis] + bounds[1][axis]);
                at[axis] - (at[axis] - middle).clamp(-inset, inset)
            })
        });
        Self {
            body,
            acceleration,
            points: points.collect(),
        }
    }

    /// Distance, m, by which the body is beyond a face at the start; negative inside.
    fn overhang(&self, case: &Case, face: Face) -> f64 {
        let bound = self.body.region.corners()[usize::from(face.upper)][face.axis];
        outward(case, face, bound)
    }

    /// Farthest distance, m, by which a point is beyond a face at a time.
    fn beyond(&self, case: &Case, face: Face, t: f64) -> f64 {
        let axis = face.axis;
        let velocity = self.body.velocity.map_or(0.0, |velocity| velocity[axis]);
        let path = velocity * t + 0.5 * self.acceleration[axis] * t * t;
        let spin = self.body.spin.filter(|_| case.grid.dims() == 2);
        let reach = self
            .points
            .iter()
            .map(|at| outward(case, face, turned(*at, spin, t)[axis] + path));
        reach.fold(f64::NEG_INFINITY, f64::max)
    }

    /// When a point is beyond the face, and how far the farthest comes, if that is before the end.
    fn exit(&self, case: &Case, face: Face) -> Option<Exit> {
        let times: Vec<f64> = (1..=SAMPLES)
            .map(|k| case.analysis.end * k as f64 / SAMPLES as f64)
            .collect();
        let beyond: Vec<f64> = times.iter().map(|t| self.beyond(case, face, *t)).collect();
        let first = beyond.iter().position(|beyond| *beyond > 0.0)?;
        Some(Exit {
            time: times[first],
            overshoot: beyond.into_iter().fold(0.0, f64::max),
        })
    }
}

/// A place after the time `t` with a spin in the plane: its angular velocity (rad/s), and the place that it is about.
fn turned(at: [f64; 3], spin: Option<[[f64; 3]; 2]>, t: f64) -> [f64; 3] {
    let Some([rate, about]) = spin else { return at };
    let arm = [at[0] - about[0], at[1] - about[1]];
    let (sin, cos) = (rate[2] * t).sin_cos();
    [
        about[0] + cos * arm[0] - sin * arm[1],
        about[1] + sin * arm[0] + cos * arm[1],
        at[2],
    ]
}

/// Distance, m, by which a place along the normal of a face is beyond it.
fn outward(case: &Case, face: Face, at: f64) -> f64 {
    if face.upper {
        at - case.grid.upper()[face.axis]
    } else {
        case.grid.lower()[face.axis] - at
    }
}
