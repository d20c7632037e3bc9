//! Run-out front, theory-manual equation (T10.8).

use crate::grid::Grid;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;

/// Fraction of a cell's volume that the points behind the front must fill.
const FULL: f64 = 0.5;

/// Points of the lowest row in one cell: coordinate along axis 0 (m) and volume (m^D).
type CellPoints = Vec<[f64; 2]>;

/// Returns the run-out front along axis 0 (m): the farthest point of the lowest occupied row of cells such that the
/// points from it back by the length of its cell, in this cell and the one before, fill half of a cell. A few loose
/// points may be ahead of it. Rows count along the last axis. Returns 0 if no cell is half full.
pub fn front<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, points: &Points<D>, halo: &dyn Halo) -> f64 {
    let grid = &model.grid;
    let row = lowest_row(grid, points, halo);
    let strands: usize = grid.axes()[1..D - 1].iter().map(|axis| axis.cells()).product();
    let columns = grid.axes()[0].cells();
    let mut held: Vec<CellPoints> = vec![CellPoints::new(); columns * strands];
    let near = [row, row + 1].map(|line| grid.axes()[D - 1].breakpoint(line));
    for p in (0..points.len()).filter(|&p| (near[0]..=near[1]).contains(&points.x[p][D - 1])) {
        if let Some(cell) = grid.locate(&points.x[p]).filter(|cell| cell[D - 1] == row) {
            let strand = (1..D - 1).fold(0, |strand, axis| strand * grid.axes()[axis].cells() + cell[axis]);
            let volume = points.volume[p] * points.F.at(p).determinant();
            held[cell[0] * strands + strand].push([points.x[p][0], volume]);
        }
    }
    // Only one rank has points in a cell.
    let own = held.iter().flat_map(|points| {
        let volume = points.iter().map(|[_, volume]| volume).sum::<f64>();
        [points.len() as f64, volume]
    });
    let mut sums: Vec<f64> = own.collect();
    halo.all_reduce_sum(&mut sums);
    let mut front = 0.0_f64;
    for at in (0..held.len()).rev() {
        if front > 0.0 && (at + 1).is_multiple_of(strands) {
            break;
        }
        // Skips cells of zero length between the copies of a breakpoint.
        let before = (0..at / strands)
            .rev()
            .find(|&column| grid.axes()[0].has_length(column));
        let before = before.map(|column| column * strands + at % strands);
        let cells = [before, Some(at)].map(|cell| cell.filter(|&cell| sums[2 * cell] > 0.0));
        let cell = std::array::from_fn(|axis| match axis {
            0 => at / strands,
            _ if axis == D - 1 => row,
            _ => {
                grid.axes()[axis + 1..D - 1]
                    .iter()
                    .fold(at % strands, |at, axis| at / axis.cells())
                    % grid.axes()[axis].cells()
            }
        });
        let (_, size) = grid.cell_box(&cell);
        let wanted = FULL * grid.cell_volume::<K>(&cell);
        let most: f64 = cells.iter().flatten().map(|cell| sums[2 * cell + 1]).sum();
        if cells[1].is_some() && most >= wanted * (1.0 - f64::EPSILON.sqrt()) {
            let all = of_all_ranks(&held, &sums, &cells, halo);
            let first = grid.axes()[0].breakpoint(cell[0]);
            front = front.max(
                end_of_full(&all, size[0], wanted)
                    .filter(|&x| x >= first)
                    .unwrap_or(0.0),
            );
        }
    }
    front
}

fn lowest_row<const D: usize>(grid: &Grid<D>, points: &Points<D>, halo: &dyn Halo) -> usize {
    let mut lowest = [points.x.iter().map(|x| -x[D - 1]).fold(f64::NEG_INFINITY, f64::max)];
    halo.all_reduce_max(&mut lowest);
    grid.axes()[D - 1].cell_of(-lowest[0]).unwrap_or(0)
}

/// Returns the points of some cells in ascending order on every rank. One reduction over all ranks.
fn of_all_ranks(held: &[CellPoints], sums: &[f64], cells: &[Option<usize>], halo: &dyn Halo) -> CellPoints {
    let mut numbers = Vec::new();
    for &cell in cells.iter().flatten() {
        let from = numbers.len();
        numbers.resize(from + 2 * sums[2 * cell] as usize, 0.0);
        numbers[from..]
            .iter_mut()
            .zip(held[cell].as_flattened())
            .for_each(|(slot, number)| *slot = *number);
    }
    halo.all_reduce_sum(&mut numbers);
    let mut all: CellPoints = numbers.chunks_exact(2).map(|point| [point[0], point[1]]).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    all
}

/// Returns the farthest of the ordered `points` such that the points from it back by `length` (m) have the volume
/// `wanted`.
fn end_of_full(points: &CellPoints, length: f64, wanted: f64) -> Option<f64> {
    let full = (0..points.len()).rev().find(|&end| {
        let x = points[end][0];
        let window = points[..=end].iter().filter(|[at, _]| *at > x - length);
        window.map(|[_, volume]| volume).sum::<f64>() >= wanted
    });
    full.map(|end| points[end][0])
}
