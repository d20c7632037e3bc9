//! What the work of a rank is measured by: counts, never a clock, so that a run repeats.
//!
//! Two fits to runs of many sizes on one rank (`scripts/scaling`) say that a node of the window costs .95 and 1.07 of
//! what a point does in an evaluation, everything included. A point that yields cost 4 % more in an earlier fit, and an
//! occupied cell nothing that its points did not, so neither counts.

use crate::slab::Slabs;
use bsmpm::grid::Grid;
use bsmpm::points::Points;

/// Work of a node of the window in an evaluation, in that of a point.
const NODE: f64 = 1.0;
/// Work of a new cut on every rank, in evaluations. Measured with 3,200 points on two ranks: 1.0 ms for moving points
/// and nodal values, and in the 57 % of steps that would have kept it, 3.7 ms for the linear solver's new pattern; an
/// evaluation takes .53 ms.
const PRICE: f64 = 6.0;

/// Points of this rank in every column of cells of the grid's room.
pub fn points_by_column<const D: usize>(grid: &Grid<D>, points: &Points<D>) -> Vec<f64> {
    let room = &grid.room()[0];
    let mut counts = vec![0.0; room.len()];
    for column in points.x.iter().filter_map(|x| grid.axes()[0].cell_of(x[0])).filter(|column| room.contains(column)) {
        counts[column - room.start] += 1.0;
    }
    counts
}

/// The cut of the grid's room into about equal loads, with so many points of all ranks in every column; `None` with
/// more ranks than columns.
pub fn cut<const D: usize>(grid: &Grid<D>, points: &[f64], ranks: usize) -> Option<Slabs> {
    let slabs = Slabs::cut(&by_column(points, grid.layer_nodes()), ranks)?;
    Some(slabs.starting_at(grid.room()[0].start).reaching(grid.beyond()))
}

/// Work of every column with so many points, and with the nodes of one layer.
pub fn by_column(points: &[f64], layer_nodes: usize) -> Vec<f64> {
    points.iter().map(|count| count + NODE * layer_nodes as f64).collect()
}

/// Work of a rank with so many points, and nodes in its window.
pub fn of_rank(points: usize, nodes: usize) -> f64 {
    points as f64 + NODE * nodes as f64
}

/// Work of every rank under a cut of columns with so many points, for splines of order `q`.
pub fn of_slabs(points: &[f64], slabs: &Slabs, (layer_nodes, q): (usize, usize)) -> Vec<f64> {
    let (nodes, first) = (|rank: usize| slabs.layers(rank, q).len() * layer_nodes, slabs.bounds()[0]);
    let held = |rank: usize| {
        let columns = slabs.columns(rank);
        points[columns.start - first..columns.end - first].iter().sum::<f64>() as usize
    };
    (0..slabs.ranks()).map(|rank| of_rank(held(rank), nodes(rank))).collect()
}

/// Largest load over the mean.
pub fn imbalance(loads: &[f64]) -> f64 {
    let sum: f64 = loads.iter().sum();
    let most = loads.iter().copied().fold(0.0, f64::max);
    if sum > 0.0 { most * loads.len() as f64 / sum } else { 1.0 }
}

/// Whether a cut under which the largest load is `best` instead of `now` gains more in so many evaluations than it
/// costs.
pub fn pays(now: f64, best: f64, evaluations: u64) -> bool {
    (now - best) * evaluations as f64 > PRICE * best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imbalance_is_the_largest_load_over_the_mean() {
        assert_eq!(imbalance(&[1.0, 3.0]), 1.5);
        assert_eq!(imbalance(&[0.0, 0.0]), 1.0);
    }

    #[test]
    fn the_loads_of_slabs_are_those_of_the_ranks_that_hold_them() {
        let counts = [36.0, 0.0, 12.0, 8.0];
        let slabs = Slabs::new(vec![0, 1, 4], 2, 0..4).unwrap();
        assert_eq!(of_slabs(&counts, &slabs, (5, 2)), [of_rank(36, 15), of_rank(20, 25)]);
        assert_eq!(of_slabs(&counts, &slabs.clone().starting_at(3), (5, 2)), [of_rank(36, 15), of_rank(20, 25)]);
        // Each window has the ghost layers besides its columns.
        let columns = by_column(&counts, 5);
        assert_eq!(columns[0] + of_rank(0, 10), of_rank(36, 15));
    }

    #[test]
    fn a_cut_pays_the_sooner_the_more_is_evaluated() {
        assert!(!pays(106.0, 100.0, 100) && pays(106.1, 100.0, 100));
        assert!(!pays(106.1, 100.0, 10) && pays(161.0, 100.0, 10));
        assert!(!pays(0.0, 0.0, 1000));
    }
}
