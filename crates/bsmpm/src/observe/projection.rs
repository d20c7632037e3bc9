//! Projected pressure for output (Telikicherla and Moutsanidis, 2022). Pressure modes that cause no nodal force are
//! removed.

use super::noise::pressure;
use crate::error::StepError;
use crate::grid::{Shape, transfer};
use crate::model::Model;
use crate::parallel::{Halo, agreed};
use crate::points::Points;

/// Returns the projected pressure of every point (Pa, positive in compression): sum_h A_hp (sum_r A_hr V_r p_r / sum_r
/// A_hr V_r), with A the splines of degree q - 1 and V the current volumes of the points. Groups of materials that
/// averages do not mix are projected separately. The points must be sorted by cell.
pub fn projected_pressure<K, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Result<Vec<f64>, StepError> {
    let shape = agreed(halo, Shape::at(&model.grid, points), StepError::OtherRank)?.lowered(&model.grid, points);
    let grouped = model.grouped(points);
    let moments = transfer::to_nodes_grouped(&shape, grouped, |p| {
        let volume = points.volume[p] * points.F.at(p).determinant();
        [volume, volume * pressure(points, p)]
    });
    let mut nodal = halo.assemble_ghosts(&moments);
    for sums in nodal.chunks_exact_mut(2) {
        sums[1] = if sums[0] > 0.0 { sums[1] / sums[0] } else { 0.0 };
    }
    Ok(transfer::to_points_grouped(
        &shape,
        grouped,
        &nodal,
        |_, [_, mean]: [f64; 2]| mean,
    ))
}
