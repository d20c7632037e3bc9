//! Estimates the load of a rank, for load balance: its number of points and nodes, theory-manual equation (T12.1).

use crate::slab::Slabs;
use bsmpm::grid::Grid;
use bsmpm::points::Points;
use bsmpm::tensor::Vector;

/// Cost of a node of the window in an evaluation, relative to that of a point.
const NODE: f64 = 1.0;
/// Cost of a new partition on every rank, in evaluations. Measured with 3,200 points on two ranks: 1.0 ms for moving
/// points and nodal values, and 3.7 ms for the linear solver's new pattern in the 57 % of steps that would have kept
/// the old one. An evaluation takes 0.53 ms.
const PRICE: f64 = 6.0;

/// Returns the number of this rank's points in every column of cells of the active domain.
pub fn points_by_column<const D: usize>(grid: &Grid<D>, points: &Points<D>) -> Vec<f64> {
    let room = &grid.room()[0];
    let mut counts = vec![0.0; room.len()];
    for column in points
        .x
        .iter()
        .filter_map(|x| grid.axes()[0].cell_of(x[0]))
        .filter(|column| room.contains(column))
    {
        counts[column - room.start] += 1.0;
    }
    counts
}

/// Returns the number of this rank's points in every row of cells of every slab, slab by slab. Points outside the
/// active domain do not count.
pub fn points_by_row<const D: usize>(grid: &Grid<D>, slabs: &Slabs, points: &Points<D>) -> Vec<f64> {
    let mut rows = Rows::none(grid, slabs);
    points.x.iter().for_each(|x| rows.count(x));
    rows.counts
}

/// Counter of points by row of cells of every slab.
pub struct Rows<'a, const D: usize> {
    grid: &'a Grid<D>,
    slabs: &'a Slabs,
    /// Counts, slab by slab.
    pub counts: Vec<f64>,
}

impl<'a, const D: usize> Rows<'a, D> {
    /// Starts with zero counts.
    pub fn none(grid: &'a Grid<D>, slabs: &'a Slabs) -> Self {
        Self {
            grid,
            slabs,
            counts: vec![0.0; slabs.slabs() * grid.room()[1].len()],
        }
    }

    /// Counts a point at position `x` (m, from the grid's lower corner).
    pub fn count(&mut self, x: &Vector<D>) {
        let Some(cell) = self.grid.locate(x) else { return };
        let [columns, rows] = [0, 1].map(|axis| &self.grid.room()[axis]);
        if columns.contains(&cell[0]) && rows.contains(&cell[1]) {
            let slab = self.slabs.place(self.slabs.owner(&cell)).0;
            self.counts[slab * rows.len() + cell[1] - rows.start] += 1.0;
        }
    }
}

/// Partitions the active domain into slabs of about equal loads, given the number of points of all ranks in every
/// column; `None` if there are more slabs than columns.
pub fn cut<const D: usize>(grid: &Grid<D>, points: &[f64], slabs: usize) -> Option<Slabs> {
    let layer_nodes = (1..D).map(|axis| grid.room()[axis].len() + grid.order()).product();
    let slabs = Slabs::cut(&by_column(points, layer_nodes), slabs)?;
    Some(slabs.starting_at(grid.room()[0].start).reaching(grid.beyond()))
}

/// Divides each slab into `parts` of about equal loads, given the number of points of all ranks in the rows of every
/// slab; `None` if there are more parts than rows.
pub fn parted<const D: usize>(grid: &Grid<D>, slabs: Slabs, points: &[f64], parts: usize) -> Option<Slabs> {
    let rows = &grid.room()[1];
    let across: usize = (2..D).map(|axis| grid.room()[axis].len() + grid.order()).product();
    let mut bounds = Vec::new();
    for (slab, points) in points.chunks_exact(rows.len()).enumerate() {
        let loads = by_column(points, slabs.layers(slab, grid.order()).len() * across);
        let cut = Slabs::cut(&loads, parts)?;
        bounds.push(cut.starting_at(rows.start).bounds().to_vec());
    }
    slabs.parted(bounds, rows)
}

/// Returns the load of every column from its number of points and the nodes of one layer.
pub fn by_column(points: &[f64], layer_nodes: usize) -> Vec<f64> {
    points.iter().map(|count| count + NODE * layer_nodes as f64).collect()
}

/// Returns the load of a rank from its number of points and the nodes in its window.
pub fn of_rank(points: usize, nodes: usize) -> f64 {
    points as f64 + NODE * nodes as f64
}

/// Returns the load of every rank for slabs without parts, given the number of points in every column, for splines of
/// degree `q`.
pub fn of_slabs(points: &[f64], slabs: &Slabs, layer_nodes: usize, q: usize) -> Vec<f64> {
    let first = slabs.bounds()[0];
    let mut loads = Vec::with_capacity(slabs.ranks());
    for rank in 0..slabs.ranks() {
        let columns = slabs.columns(rank);
        let held = points[columns.start - first..columns.end - first].iter().sum::<f64>();
        loads.push(of_rank(held as usize, slabs.layers(rank, q).len() * layer_nodes));
    }
    loads
}

/// Returns the load of every rank for slabs with parts, given the number of points in the rows of every slab.
pub fn of_parts<const D: usize>(points: &[f64], slabs: &Slabs, grid: &Grid<D>) -> Vec<f64> {
    let rows = &grid.room()[1];
    let q = grid.order();
    let across: usize = (2..D).map(|axis| grid.room()[axis].len() + q).product();
    let mut loads = Vec::with_capacity(slabs.ranks());
    for rank in 0..slabs.ranks() {
        let slab = slabs.place(rank).0;
        let cells = &slabs.cells(rank, grid.room())[1];
        let of_slab = &points[slab * rows.len()..(slab + 1) * rows.len()];
        let held = of_slab[cells.start - rows.start..cells.end - rows.start]
            .iter()
            .sum::<f64>();
        let [layers, along] = slabs.nodes(rank, q, rows);
        loads.push(of_rank(held as usize, layers.len() * along.len() * across));
    }
    loads
}

/// Returns the largest load divided by the mean.
pub fn imbalance(loads: &[f64]) -> f64 {
    let sum: f64 = loads.iter().sum();
    let most = loads.iter().copied().fold(0.0, f64::max);
    if sum > 0.0 {
        most * loads.len() as f64 / sum
    } else {
        1.0
    }
}

/// Returns whether a partition that changes the largest load from `now` to `best` saves more in the given number of
/// evaluations than it costs.
pub fn pays(now: f64, best: f64, evaluations: u64) -> bool {
    (now - best) * evaluations as f64 > PRICE * best
}

#[cfg(test)]
mod tests {
    use super::*;
    use bsmpm::grid::KnotVector;

    #[test]
    fn imbalance_is_the_largest_load_over_the_mean() {
        assert_eq!(imbalance(&[1.0, 3.0]), 1.5);
        assert_eq!(imbalance(&[0.0, 0.0]), 1.0);
    }

    #[test]
    fn the_loads_of_slabs_are_those_of_the_ranks_that_hold_them() {
        let counts = [36.0, 0.0, 12.0, 8.0];
        let slabs = Slabs::new(vec![0, 1, 4], 2, 0..4).unwrap();
        assert_eq!(of_slabs(&counts, &slabs, 5, 2), [of_rank(36, 15), of_rank(20, 25)]);
        assert_eq!(
            of_slabs(&counts, &slabs.clone().starting_at(3), 5, 2),
            [of_rank(36, 15), of_rank(20, 25)]
        );
        // Each window has the ghost layers besides its columns.
        let columns = by_column(&counts, 5);
        assert_eq!(columns[0] + of_rank(0, 10), of_rank(36, 15));
    }

    #[test]
    fn parts_follow_the_points_of_their_slab_and_have_the_loads_of_their_ranks() {
        let axis = |cells| KnotVector::uniform(1.0, cells, 2).unwrap();
        let grid = Grid::new([axis(6), axis(5), axis(3)])
            .unwrap()
            .within([1..5, 0..5, 0..3]);
        let slabs = || cut(&grid, &[9.0, 9.0, 9.0, 9.0], 2).unwrap();
        let places = [[1.5, 0.5], [2.5, 0.5], [3.5, 4.5], [4.5, 3.5], [5.5, 4.5], [0.5, 0.5]];
        let x = places.map(|[x, y]| Vector::from([x, y, 1.5]));
        let (slabs, of) = (slabs(), slabs());
        let mut rows = Rows::none(&grid, &of);
        x.iter().for_each(|x| rows.count(x)); // the last two lie outside the room
        assert_eq!(rows.counts, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
        let counts: Vec<f64> = rows.counts.iter().map(|count| 200.0 * count).collect();
        let slabs = parted(&grid, slabs, &counts, 2).unwrap();
        assert_eq!(slabs.parts(), [vec![0, 1, 5], vec![0, 4, 5]]);
        let nodes = [3, 6, 6, 3]
            .into_iter()
            .zip([4, 4, 4, 4])
            .map(|(rows, layers)| rows * layers * 5);
        let loads: Vec<f64> = [400, 0, 200, 200]
            .into_iter()
            .zip(nodes)
            .map(|(p, n)| of_rank(p, n))
            .collect();
        assert_eq!(of_parts(&counts, &slabs, &grid), loads);
        assert!(parted(&grid, of, &counts, 6).is_none());
    }

    #[test]
    fn a_cut_pays_the_sooner_the_more_is_evaluated() {
        assert!(!pays(106.0, 100.0, 100) && pays(106.1, 100.0, 100));
        assert!(!pays(106.1, 100.0, 10) && pays(161.0, 100.0, 10));
        assert!(!pays(0.0, 0.0, 1000));
    }
}
