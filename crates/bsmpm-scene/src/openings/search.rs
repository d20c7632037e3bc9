//! Searches all bodies of a case for openings.

use super::plane::{PlaneBody, PlaneShape};
use super::solid::surface_points;
use super::{MirrorPlane, OpeningGeometry, Surroundings};
use crate::case::{Case, RigidShape};
use crate::record::Field;
use crate::schema::{BodyTable, Draft, StageTable};
use crate::words::Support;

/// Parts of the grid's size by which a body may miss a face that it reaches.
const ROUNDING: f64 = 1e-9;

/// Part of the shorter side of a body up to which the walls of its outline form a notch; farther apart they form a
/// valley.
const NOTCH: f64 = 0.5;

/// Faces of a grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridFaces {
    /// m  lower and upper corner
    pub corners: [[f64; 3]; 2],
    /// Per axis the lower and the upper one.
    pub supports: [[Support; 2]; 3],
    /// Number of axes.
    pub dims: usize,
}

impl GridFaces {
    /// Faces with rollers that a body within bounds (m) reaches: it is mirrored in them.
    pub(crate) fn planes(&self, bounds: [[f64; 3]; 2]) -> Vec<MirrorPlane> {
        let mut planes = Vec::new();
        for axis in 0..self.dims {
            let [lower, upper] = self.corners.map(|corner| corner[axis]);
            let slack = ROUNDING * (upper - lower);
            let reaches = [bounds[0][axis] <= lower + slack, bounds[1][axis] >= upper - slack];
            for (is_upper, at) in [(false, lower), (true, upper)] {
                let side = usize::from(is_upper);
                if reaches[side] && self.supports[axis][side] == Support::Roller {
                    planes.push(MirrorPlane { axis, is_upper, at });
                }
            }
        }
        planes
    }
}

/// An opening of a body.
#[derive(Clone, Debug)]
pub(crate) struct BodyOpening {
    /// Number of the body.
    pub body: usize,
    /// The shape that is cut out, by its number; `None`: the outline of the body itself.
    pub cut: Option<usize>,
    pub opening: OpeningGeometry,
}

/// Those of the bodies of a plane.
pub(crate) fn in_plane(draft: &Draft, faces: &GridFaces) -> Vec<BodyOpening> {
    let bodies: Vec<Option<PlaneBody>> = draft.body.items().iter().map(PlaneBody::of).collect();
    let rigid: Vec<PlaneShape> = draft
        .rigid
        .items()
        .iter()
        .filter_map(|rigid| PlaneShape::of(rigid.shape()))
        .collect();
    let mut found: Vec<BodyOpening> = Vec::new();
    for there in phases(draft) {
        for (number, body) in bodies.iter().enumerate().filter(|(number, _)| there[*number]) {
            let Some(body) = body else { continue };
            let bounds = body.bounds().map(|[x, y]| [x, y, 0.0]);
            let others: Vec<&PlaneBody> = (0..bodies.len())
                .filter(|&other| other != number && there[other])
                .filter_map(|other| bodies[other].as_ref())
                .collect();
            let surroundings = Surroundings {
                is_body: &|[x, y, _]| body.contains([x, y]),
                is_other: &|[x, y, _]| {
                    others.iter().any(|other| other.contains([x, y]))
                        || rigid.iter().any(|shape| shape.contains([x, y]))
                },
                planes: &faces.planes(bounds),
                bounds,
            };
            let side = (bounds[1][0] - bounds[0][0]).min(bounds[1][1] - bounds[0][1]);
            for (shape, outline) in body.shapes().enumerate() {
                add(&mut found, number, shape, || {
                    let opening = surroundings.opening(&outline.surface(body.bounds()))?;
                    (shape > 0 || opening.width <= NOTCH * side).then_some(opening)
                });
            }
        }
    }
    found
}

/// Those of the bodies of a case in space: of what is cut out of them.
pub(crate) fn in_space(case: &Case, draft: &Draft, faces: &GridFaces) -> Vec<BodyOpening> {
    let boxes: Vec<[[f64; 3]; 2]> = case
        .rigid
        .iter()
        .filter_map(|rigid| solid_corners(&rigid.shape))
        .collect();
    let mut found: Vec<BodyOpening> = Vec::new();
    for there in phases(draft) {
        for (number, record) in draft
            .body
            .items()
            .iter()
            .enumerate()
            .filter(|(number, _)| there[*number])
        {
            let region = &case.bodies[number].region;
            let others: Vec<usize> = (0..case.bodies.len())
                .filter(|&other| other != number && there[other])
                .collect();
            let surroundings = Surroundings {
                is_body: &|at| region.contains_in_space(at),
                is_other: &|at| {
                    others
                        .iter()
                        .any(|&other| case.bodies[other].region.contains_in_space(at))
                        || boxes.iter().any(|corners| is_in(corners, at))
                },
                planes: &faces.planes(region.corners()),
                bounds: region.corners(),
            };
            for (cut, shape) in record.subtract.items().iter().enumerate() {
                let points = surface_points(shape.shape(), region.corners()).unwrap_or_default();
                add(&mut found, number, cut + 1, || surroundings.opening(&points));
            }
        }
    }
    found
}

/// m  lower and upper corner of a rigid body in space
fn solid_corners(shape: &RigidShape) -> Option<[[f64; 3]; 2]> {
    match shape {
        RigidShape::InSpace(solid) => Some(solid.corners()),
        RigidShape::Polygon(_) | RigidShape::Circle { .. } => None,
    }
}

/// Adds the opening of a shape of a body (0: the outline), unless it is known from an earlier phase.
fn add(found: &mut Vec<BodyOpening>, body: usize, shape: usize, search: impl Fn() -> Option<OpeningGeometry>) {
    let cut = shape.checked_sub(1);
    if found.iter().any(|known| known.body == body && known.cut == cut) {
        return;
    }
    found.extend(search().map(|opening| BodyOpening { body, cut, opening }));
}

/// Whether a place lies between the lower and the upper corner of a cuboid.
fn is_in([lower, upper]: &[[f64; 3]; 2], at: [f64; 3]) -> bool {
    (0..3).all(|axis| lower[axis] <= at[axis] && at[axis] <= upper[axis])
}

/// Which bodies are there at the start and after each stage, each state once.
pub(crate) fn phases(draft: &Draft) -> Vec<Vec<bool>> {
    let bodies = draft.body.items();
    let time = |stage: &StageTable| stage.at.get().unwrap_or(0.0);
    let mut stages: Vec<&StageTable> = draft.stage.items().iter().collect();
    stages.sort_by(|a, b| time(a).total_cmp(&time(b)));
    let mut there: Vec<bool> = bodies
        .iter()
        .map(|body| !stages.iter().any(|stage| names(&stage.add, body)))
        .collect();
    let mut phases = vec![there.clone()];
    for stage in &stages {
        for (there, body) in there.iter_mut().zip(bodies) {
            *there = (*there || names(&stage.add, body)) && !names(&stage.remove, body);
        }
        if !phases.contains(&there) {
            phases.push(there.clone());
        }
    }
    phases
}

/// Whether a key of a stage names a body.
fn names(key: &Field<Vec<String>>, body: &BodyTable) -> bool {
    let name = body.name.text();
    key.items().iter().any(|listed| Some(listed.as_str()) == name)
}
