//! Thickness and sharpest corner of a rigid body.

use crate::validate::site::normal;
use bsmpm::interactions::rigid::Outline;
use bsmpm::tensor::Vector;

/// The least extent of corners across any edge, m.
pub(super) fn thickness(corners: &[[f64; 2]]) -> f64 {
    let mut thickness = f64::INFINITY;
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let normal = normal(*from, *to);
        let reaches = corners
            .iter()
            .map(|corner| normal[0] * corner[0] + normal[1] * corner[1]);
        let least = reaches.clone().fold(f64::INFINITY, f64::min);
        let most = reaches.fold(f64::NEG_INFINITY, f64::max);
        thickness = thickness.min(most - least);
    }
    thickness
}

/// The corner with the smallest angle inside, rad; of one at the x of an axis twice of it.
pub(super) fn sharpest(outline: &Outline, axis: Option<f64>) -> Option<([f64; 2], f64)> {
    let Outline::Polygon(corners) = outline else {
        return None;
    };
    let angles = corners.iter().enumerate().map(|(k, at)| {
        let angle = angle_inside(corners, k);
        let is_half = axis.is_some_and(|axis| (at[0] - axis).abs() < 1e-9 * outline.radius());
        ([at[0], at[1]], if is_half { 2.0 * angle } else { angle })
    });
    angles.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Angle inside a polygon at the corner with a number, rad.
fn angle_inside(corners: &[Vector<2>], k: usize) -> f64 {
    let count = corners.len();
    let before = corners[(k + count - 1) % count] - corners[k];
    let after = corners[(k + 1) % count] - corners[k];
    let angle = after.perp(&before).atan2(after.dot(&before));
    if angle < 0.0 {
        angle + std::f64::consts::TAU
    } else {
        angle
    }
}
