//! Quadrature defect of a cell: the total volume of its material points divided by the cell volume, minus one.

use crate::exact::Exact;
use crate::grid::occupied::OccupiedCells;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;

/// Statistics of `sum_p V_p / V_cell - 1` over the interior cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defect {
    /// Number of interior cells.
    pub cells: u64,
    /// Mean number of points in an interior cell.
    pub points: f64,
    /// Root mean square.
    pub rms: f64,
    /// Largest magnitude.
    pub largest: f64,
}

/// Returns the defect of the current volumes V_p = J_p V0_p over the interior cells, those whose neighbours in the grid
/// (up to 3^D - 1) all contain points; `None` if there is none. The points must be sorted by cell; the result is then
/// bitwise identical on any number of ranks.
pub fn defect<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Option<Defect> {
    let grid = &model.grid;
    let mut held = vec![0.0; grid.cells()];
    let mut counts = vec![0_u32; grid.cells()];
    for p in 0..points.len() {
        if let Some(cell) = grid.locate(&points.x[p]) {
            held[grid.cell_index(&cell)] += points.volume[p] * points.F.at(p).determinant();
            counts[grid.cell_index(&cell)] += 1;
        }
    }
    let filled = held.iter().enumerate().filter(|(_, volume)| **volume > 0.0);
    let occupied = OccupiedCells::of(grid, filled.map(|(index, _)| index), halo);
    let mut squares = Exact::ZERO;
    let mut largest = [0.0_f64];
    let mut numbers = [0.0; 2];
    for (index, volume) in held.iter().enumerate() {
        let cell = grid.cell_at(index);
        if *volume > 0.0 && occupied.surround(&cell, &[[true; 2]; D]) {
            let defect = volume / grid.cell_volume::<K>(&cell) - 1.0;
            squares.add(defect * defect);
            largest[0] = largest[0].max(defect.abs());
            numbers = [numbers[0] + 1.0, numbers[1] + f64::from(counts[index])];
        }
    }
    halo.all_reduce_sum(&mut numbers);
    halo.all_reduce_max(&mut largest);
    let squares = halo.reproducible_sum(&[squares])[0];
    let [cells, held] = numbers;
    (cells > 0.0).then(|| Defect {
        cells: cells as u64,
        points: held / cells,
        rms: (squares / cells).sqrt(),
        largest: largest[0],
    })
}

/// Returns for each material the fraction of its volume that it has lost (negative if it has grown; 0 without points),
/// averaged over its points with their reference volumes. The larger the change, the less accurate is the integration
/// with the points' volumes. The result is bitwise identical on any number of ranks.
pub fn compression<const D: usize>(points: &Points<D>, materials: usize, halo: &dyn Halo) -> Vec<f64> {
    let mut volumes = vec![Exact::ZERO; 2 * materials];
    for p in 0..points.len() {
        let at = 2 * usize::from(points.material[p]);
        volumes[at].add(points.volume[p]);
        volumes[at + 1].add(points.volume[p] * points.F.at(p).determinant());
    }
    let volumes = halo.reproducible_sum(&volumes);
    let pairs = volumes.chunks_exact(2);
    pairs
        .map(|pair| if pair[0] > 0.0 { 1.0 - pair[1] / pair[0] } else { 0.0 })
        .collect()
}
