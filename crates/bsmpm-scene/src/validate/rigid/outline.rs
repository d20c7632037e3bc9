//! Thickness and sharpest corner of a rigid body.

use crate::validate::site::normal;
use bsmpm::boundary::rigid::Outline;

/// The least extent of corners across any edge, m.
pub(super) fn thickness(corners: &[[f64; 2]]) -> f64 {
    let across = |k: usize| {
        let normal = normal(corners[k], corners[(k + 1) % corners.len()]);
        let reach = |corner: &[f64; 2]| normal[0] * corner[0] + normal[1] * corner[1];
        let (least, most) = corners
            .iter()
            .map(reach)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        most - least
    };
    (0..corners.len()).map(across).fold(f64::INFINITY, f64::min)
}

/// The corner with the smallest angle inside, rad; of one at the x of an axis twice of it.
pub(super) fn sharpest(outline: &Outline, axis: Option<f64>) -> Option<([f64; 2], f64)> {
    let Outline::Polygon(corners) = outline else {
        return None;
    };
    let of = |k: usize| {
        let (at, count) = (corners[k], corners.len());
        let (before, after) = (corners[(k + count - 1) % count] - at, corners[(k + 1) % count] - at);
        let angle = after.perp(&before).atan2(after.dot(&before));
        let angle = if angle < 0.0 {
            angle + std::f64::consts::TAU
        } else {
            angle
        };
        let is_half = axis.is_some_and(|axis| (at[0] - axis).abs() < 1e-9 * outline.radius());
        ([at[0], at[1]], if is_half { 2.0 * angle } else { angle })
    };
    (0..corners.len()).map(of).min_by(|a, b| a.1.total_cmp(&b.1))
}
