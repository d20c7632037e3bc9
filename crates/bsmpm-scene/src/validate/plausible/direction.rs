//! Warns of gravity that does not point down.

use super::length;
use crate::case::{Case, Support};
use crate::report::Report;
use crate::validate::physics::reached;

/// Part of gravity below which its vertical part is rounding.
const LEVEL: f64 = 1e-6;

/// Warns of gravity that points upwards, or along a horizontal axis.
pub(super) fn gravity(case: &Case, report: &mut Report<'_>) {
    let Some(gravity) = &case.gravity else { return };
    let acceleration = gravity.acceleration;
    let dims = case.grid.dims();
    let vertical = acceleration[dims - 1];
    let size = length(acceleration);
    if size == 0.0 || vertical < -LEVEL * size || rests(case, acceleration) {
        return;
    }
    let points = if vertical > LEVEL * size { "upwards" } else { "sideways" };
    let name = ["x", "y", "z"][dims - 1];
    let down = if dims == 3 { "[0, 0, -9.81]" } else { "[0, -9.81]" };
    report.warn(format!(
        "W0104: gravity.acceleration: gravity of {:?} m/s2 points {points}, away from the supports ({name} is \
         positive upwards). Write acceleration = {down}, or support the side that gravity points to.",
        &acceleration[..dims]
    ));
}

/// Whether the case says that gravity along an axis is meant: material rests on the side that it points to, and across
/// it no side is supported in another way than the one opposite.
fn rests(case: &Case, acceleration: [f64; 3]) -> bool {
    let dims = case.grid.dims();
    let main = (0..dims)
        .max_by(|a, b| acceleration[*a].abs().total_cmp(&acceleration[*b].abs()))
        .unwrap_or(dims - 1);
    let side = usize::from(acceleration[main] > 0.0);
    let supports = case.boundary[main];
    let is_supported = !matches!(supports[side], Support::Free | Support::Outflow);
    let other = supports[1 - side];
    let is_lying = main == dims - 1 || case.boundary[dims - 1][0] == case.boundary[dims - 1][1];
    let is_open = matches!(other, Support::Free | Support::Outflow) || !reached(case, main, side == 0);
    is_supported && reached(case, main, side == 1) && is_open && is_lying
}
