//! Warns of cohesionless slopes steeper than the friction angle.

use crate::case::{Body, Case, Geometry};
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::Draft;
use bsmpm::model::Regime;

/// Degrees  Excess of a slope over the friction angle from which on it is reported.
const EXCESS: f64 = 0.5;
/// Part of an edge's length by which a place is off the edge.
const OFF: f64 = 1e-3;

/// Warns of the first body at the start that has such a slope, where equilibrium is sought and no water acts.
pub(super) fn bodies(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let is_plane = case.geometry == Geometry::PlaneStrain;
    let is_at_rest = case.analysis.regime == Regime::QuasiStatic && case.gravity.is_some();
    if !is_plane || !is_at_rest || case.flow.is_some() {
        return;
    }
    let materials = draft.material.items();
    for (body, record) in case.bodies.iter().zip(draft.body.items()) {
        let (name, material) = &materials[body.material];
        let Some(friction) = material
            .friction_angle
            .plain()
            .filter(|_| material.cohesion.plain() == Some(0.0))
        else {
            continue;
        };
        let steepest = slopes(case, body).into_iter().fold(0.0, f64::max);
        if steepest > friction + EXCESS {
            report.warn(format!(
                "W0111: {}: the slope of {steepest:.1} degrees is steeper than the friction angle of material.{name} \
                 ({friction:.1}), so it fails without cohesion. Flatten the slope, or increase `cohesion`.",
                record.location().path
            ));
            return;
        }
    }
}

/// Degrees  Inclinations of the parts of a body's upper surface that no other body covers.
fn slopes(case: &Case, body: &Body) -> Vec<f64> {
    let lower = case.grid.lower();
    let mut slopes = Vec::new();
    for edge in body.region.edges(&case.grid.axes).0 {
        let [across, up] = [edge.b[0] - edge.a[0], edge.b[1] - edge.a[1]];
        let middle = [lower[0] + edge.a[0] + across / 2.0, lower[1] + edge.a[1] + up / 2.0];
        let off = OFF * across.hypot(up);
        let is_surface = body.region.contains([middle[0], middle[1] - off]);
        let above = [middle[0], middle[1] + off];
        if is_surface && !case.bodies.iter().any(|body| body.region.contains(above)) {
            slopes.push(up.abs().atan2(across.abs()).to_degrees());
        }
    }
    slopes
}
