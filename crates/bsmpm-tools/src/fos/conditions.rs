//! Collects the numerical conditions of a factor of safety, and how much the trials must be stiffened.

use bsmpm_scene::words::{Geometry, Word};
use bsmpm_scene::{Case, NamedMaterial, Rigid, RigidShape, Traction};
use serde::Serialize;

use super::refusal::{acting, followed};

/// Strain by which a load may change the geometry: (weight of the body's height + traction)/E. Beyond, the branch after
/// failure, up to 20 times the elastic displacement, is flattened by the body's settling, and with it the factor.
const SMALL: f64 = 2e-3;
/// Stiffening by less is none.
const UNCHANGED: f64 = 1.01;

/// What belongs to a factor of safety.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Conditions {
    /// m  the largest size of a cell along each axis
    pub cell: Vec<f64>,
    /// of the B-splines
    pub order: usize,
    /// along each axis, of every body
    pub points_per_cell: Vec<usize>,
    pub stabilisation: String,
    /// of the artificial stiffness, over Young's modulus
    pub background: f64,
    /// of the energy
    pub tolerance: f64,
    /// of the forces
    pub force_tolerance: f64,
    /// nominal load steps
    pub steps: u64,
    /// Pa  of every material, where it depends on the height the largest
    pub young: Vec<f64>,
    /// by which the trials multiply all of them
    pub stiffness: f64,
}

impl Conditions {
    pub fn of(case: &Case, until: Option<f64>) -> Self {
        let materials = case.materials_at(acting(case, until));
        let mut points_per_cell: Vec<usize> = case.bodies.iter().map(|body| body.points_per_cell).collect();
        points_per_cell.dedup();
        Self {
            cell: case.grid.axes.iter().map(bsmpm_scene::GridAxis::longest).collect(),
            order: case.grid.order,
            points_per_cell,
            stabilisation: case.stabilisation.word().to_owned(),
            background: case.solver.background,
            tolerance: case.solver.tolerance,
            force_tolerance: case.solver.force_tolerance,
            steps: (case.analysis.end / case.analysis.dt).round() as u64,
            young: followed(case, until)
                .iter()
                .map(|named| named.material.elastic().young)
                .collect(),
            stiffness: stiffness(case, &materials),
        }
    }

    /// Cells and points in words.
    pub fn mesh(&self) -> String {
        let mut sizes: Vec<String> = self.cell.iter().map(|size| format!("{} m", shown(*size))).collect();
        sizes.dedup();
        let cell = format!("h = {}", sizes.join(" x "));
        let points = self.points_per_cell.iter();
        let points: Vec<String> = points
            .map(|points| vec![points.to_string(); self.cell.len()].join(" x "))
            .collect();
        format!("{cell}, {} points a cell, order {}", points.join(" and "), self.order)
    }

    /// Everything in words.
    pub fn lines(&self) -> [String; 2] {
        let young: Vec<String> = self.young.iter().map(|young| shown(young * 1e-6)).collect();
        [
            format!(
                "{}; {}; background {:e} E",
                self.mesh(),
                self.stabilisation,
                self.background
            ),
            format!(
                "{} load steps; tolerances {:e} (energy), {:e} (forces); E = {} MPa{}",
                self.steps,
                self.tolerance,
                self.force_tolerance,
                young.join(", "),
                if self.stiffness == 1.0 {
                    String::new()
                } else {
                    format!(", times {}", self.stiffness)
                }
            ),
        ]
    }
}

/// What Young's moduli must be multiplied with so that the load strains no body by more than [`SMALL`], to three
/// digits.
fn stiffness(case: &Case, materials: &[NamedMaterial]) -> f64 {
    // What consolidates does so by its own stiffness, and what softens or has been compressed fails by it.
    let mut followed = (0..case.materials.len()).filter(|number| case.is_followed(*number));
    if case.flow.is_some() || followed.any(|number| case.materials[number].material.softens()) {
        return 1.0;
    }
    let up = case.grid.dims() - 1;
    let heights = case
        .bodies
        .iter()
        .map(|body| body.region.corners().map(|corner| corner[up]));
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [c, d]| {
        [a.min(c), b.max(d)]
    });
    let base = case.grid.lower()[up];
    let mut softest = f64::INFINITY;
    for body in &case.bodies {
        let material = &materials[body.material].material;
        for corner in body.region.corners() {
            softest = softest.min(material.at(corner[up] - base).elastic().young);
        }
    }
    let densities = case.bodies.iter().filter_map(|body| {
        let named = &case.materials[body.material];
        named.saturated.or(named.density)
    });
    let gravity = case.gravity.as_ref().map_or(0.0, |gravity| {
        gravity.acceleration.iter().fold(0.0, |length: f64, g| length.hypot(*g))
    });
    let weight = densities.fold(0.0, f64::max) * gravity * (high - low);
    let tractions = case.tractions.iter().map(Traction::largest);
    let driven = case.rigid.iter().map(|rigid| pressure(rigid, case.geometry, gravity));
    let needed = (weight + tractions.chain(driven).fold(0.0, f64::max)) / softest / SMALL;
    if needed < UNCHANGED {
        1.0
    } else {
        format!("{needed:.2e}").parse().unwrap_or(needed)
    }
}

/// Pa  what drives a rigid body, over its width.
fn pressure(rigid: &Rigid, geometry: Geometry, gravity: f64) -> f64 {
    let is_round = geometry == Geometry::Axisymmetric;
    let half = match &rigid.shape {
        RigidShape::Circle { radius, .. } => *radius,
        RigidShape::Polygon(corners) => {
            let [right, left] = [1.0, -1.0].map(|side| {
                let places = corners.iter().map(|corner| side * corner[0]);
                places.fold(f64::NEG_INFINITY, f64::max)
            });
            if is_round { right } else { 0.5 * (right + left) }
        }
        // Nothing moves freely in space.
        RigidShape::InSpace(_) => return 0.0,
    };
    let area = if is_round {
        std::f64::consts::PI * half * half
    } else {
        2.0 * half
    };
    (rigid.force[0].hypot(rigid.force[1]) + rigid.mass[0] * gravity) / area
}

/// A number without the noise that divisions leave at its end.
fn shown(number: f64) -> String {
    crate::record::short(number).to_string()
}
