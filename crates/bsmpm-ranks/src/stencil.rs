//! The stiffness matrix of a rank, stored as a stencil per node: each node couples with the (2q+1)^D nodes around it
//! (degree q, D axes), with F-bar averages also with more distant ones.

mod entries;
mod places;

pub use entries::{Coordinates, Numbering};

use bsmpm::grid::{Contributions, Grid};
use bsmpm::nodal::Nodal;
use bsmpm::parallel::OwnedNodes;
use places::Places;

/// Row of a node that has no stencil.
const NONE: usize = usize::MAX;

/// Stencils of all nodes of a window with C unknowns each: C x C blocks that couple a node with each node of its
/// stencil.
#[derive(Clone, Debug)]
pub struct Stencil<const D: usize, const C: usize> {
    places: Places<D>,
    slot: Vec<usize>,    // position of patch node b in the stencil of patch node a
    offsets: Vec<usize>, // of a patch's nodes
    rows: Vec<usize>,    // of every node, or NONE
    values: Vec<f64>,    // index order: row, position, row and column of the block
    columns: Option<StencilColumns>,
}

/// Sums by columns of cells, see [`Stencil::by_columns`].
#[derive(Clone, Debug)]
struct StencilColumns {
    none: Contributions,
    sums: Contributions,
    diagonal: Vec<f64>,
    owned: OwnedNodes,
}

impl<const D: usize, const C: usize> Stencil<D, C> {
    /// Creates stencils over a window, for no nodes yet: see [`Stencil::keep`].
    pub fn new(grid: &Grid<D>) -> Self {
        Self::of_patches(grid, grid.order() + 1, grid.offsets())
    }

    /// Creates stencils of the functions of degree q - 1, which use the numbers of the nodes. A patch has q^D of them.
    pub fn lowered(grid: &Grid<D>) -> Self {
        Self::of_patches(grid, grid.order(), grid.lowered_offsets())
    }

    /// Creates stencils for patches that have `width` nodes along an axis, at `offsets` from the first.
    fn of_patches(grid: &Grid<D>, width: usize, offsets: Vec<usize>) -> Self {
        let places = Places::new(grid);
        let patch = offsets.len();
        let numbers: Vec<usize> = (0..patch)
            .map(|k| places.number(std::array::from_fn(|axis| k / width.pow((D - 1 - axis) as u32) % width)))
            .collect();
        let slot = (0..patch * patch)
            .map(|pair| places.of(numbers[pair / patch], numbers[pair % patch]))
            .collect();
        let rows = vec![NONE; grid.nodes()];
        let values = Vec::new();
        Self {
            places,
            slot,
            offsets,
            rows,
            values,
            columns: None,
        }
    }

    /// Creates zero stencils for the nodes for which `kept` returns true. Other nodes use no memory, and contributions
    /// to them are ignored. Sums by columns keep all nodes.
    pub fn keep(&mut self, kept: impl Fn(usize) -> bool) {
        let mut count = 0;
        let all = self.columns.is_some();
        for (node, row) in self.rows.iter_mut().enumerate() {
            *row = NONE;
            if all || kept(node) {
                *row = count;
                count += 1;
            }
        }
        self.values.clear();
        self.values.resize(count * self.width(), 0.0);
        self.values.shrink_to(2 * self.values.len());
    }

    /// Returns zero stencils whose sums do not depend on the partition: the columns of cells are added to a row in
    /// their order, on whichever rank they are. An entry is passed to PETSc once, by the owner of the lowest node of
    /// the box around its two nodes, because this rank's window contains both. Needs q + 1 times the memory.
    pub fn by_columns(self, grid: &Grid<D>, owned: OwnedNodes) -> Self {
        let stencil = self;
        let none = Contributions::none(grid, stencil.width(), Vec::new());
        let sums = none.clone();
        let diagonal = vec![0.0; grid.nodes() * C];
        let columns = StencilColumns {
            none,
            sums,
            diagonal,
            owned,
        };
        let mut stencil = Self {
            columns: Some(columns),
            ..stencil
        };
        stencil.keep(|_| true);
        stencil
    }

    /// Completes sums by columns. `total` must return the sums over all ranks.
    pub fn complete(&mut self, total: impl FnOnce(&Contributions) -> Vec<f64>) {
        let Some(columns) = &self.columns else { return };
        self.values = total(&columns.sums);
        let diagonal = columns.diagonal.clone();
        for (at, value) in diagonal.into_iter().enumerate() {
            let (node, component) = Nodal::<C>::split(at);
            self.diagonal(node, component)
                .into_iter()
                .for_each(|entry| *entry += value);
        }
    }

    /// Sets all blocks to zero.
    pub fn clear(&mut self) {
        match &mut self.columns {
            Some(columns) => {
                columns.sums = columns.none.clone();
                columns.diagonal.fill(0.0);
            }
            None => self.values.fill(0.0),
        }
    }

    fn diagonal(&mut self, node: usize, component: usize) -> Option<&mut f64> {
        let row = self.rows[node];
        let at = (self.places.count() / 2 * C + component) * C + component;
        (row != NONE)
            .then(|| row * self.width() + at)
            .map(|at| &mut self.values[at])
    }

    fn width(&self) -> usize {
        self.places.count() * C * C
    }

    /// Adds the dense block of the patch whose first node is `first`.
    pub fn add(&mut self, first: usize, block: &[f64]) {
        let offsets = std::mem::take(&mut self.offsets);
        let slot = std::mem::take(&mut self.slot);
        self.add_blocks(first, &offsets, &slot, block);
        (self.offsets, self.slot) = (offsets, slot);
    }

    /// Adds the dense block of `nodes`, the lowest first.
    pub fn add_among(&mut self, nodes: &[usize], block: &[f64]) {
        let numbers: Vec<usize> = nodes.iter().map(|&node| self.places.number_of(node)).collect();
        let mut slot = Vec::with_capacity(block.len() / (C * C));
        for a in &numbers {
            slot.extend(numbers.iter().map(|b| self.places.of(*a, *b)));
        }
        let offsets: Vec<usize> = nodes.iter().map(|node| node - nodes[0]).collect();
        self.add_blocks(nodes[0], &offsets, &slot, block);
    }

    /// Adds the dense block of the nodes at `offsets` from `first`; `slot` has their positions in each other's
    /// stencils.
    fn add_blocks(&mut self, first: usize, offsets: &[usize], slot: &[usize], block: &[f64]) {
        let width = self.width();
        let count = offsets.len();
        for (a, offset) in offsets.iter().enumerate() {
            let values = match &mut self.columns {
                Some(columns) => &mut columns.sums.patch(first)[offset * width..(offset + 1) * width],
                None if self.rows[first + offset] == NONE => continue,
                None => &mut self.values[self.rows[first + offset] * width..][..width],
            };
            for (b, place) in slot[a * count..(a + 1) * count].iter().enumerate() {
                for i in 0..C {
                    let row = &block[(a * C + i) * count * C + b * C..][..C];
                    let at = (place * C + i) * C;
                    values[at..at + C]
                        .iter_mut()
                        .zip(row)
                        .for_each(|(value, entry)| *value += entry);
                }
            }
        }
    }

    /// Adds to the diagonal entry of a component of `node`.
    pub fn add_diagonal(&mut self, node: usize, component: usize, value: f64) {
        match &mut self.columns {
            Some(columns) => columns.diagonal[Nodal::<C>::at(node, component)] += value,
            None => self
                .diagonal(node, component)
                .into_iter()
                .for_each(|entry| *entry += value),
        }
    }

    /// Returns the largest diagonal entry of this window's blocks.
    pub fn largest_diagonal(&self) -> f64 {
        let middle = self.places.count() / 2;
        let rows = self.values.chunks_exact(self.width());
        rows.flat_map(|row| (0..C).map(|i| row[(middle * C + i) * C + i]))
            .fold(0.0, f64::max)
    }

    /// Iterates over a component's row: the first component of every node that it couples with, and the entries there;
    /// nothing for a node without a stencil.
    pub fn row(&self, component: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let (node, i) = Nodal::<C>::split(component);
        let row = self.rows[node];
        let places = (row != NONE).then(|| self.places.around(node)).into_iter().flatten();
        places.map(move |(place, other)| {
            let at = row * self.width() + (place * C + i) * C;
            (other * C, &self.values[at..at + C])
        })
    }

    /// Iterates over the nodes that a node couples with, and the blocks; nothing for a node without a stencil.
    pub fn blocks(&self, node: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let row = self.rows[node];
        let places = (row != NONE).then(|| self.places.around(node)).into_iter().flatten();
        places.map(move |(place, other)| (other, &self.values[row * self.width() + place * C * C..][..C * C]))
    }

    /// Adds `weight` times a block to the block that couples a node with another one. A block for a node outside the
    /// stencil must be zero and is ignored.
    pub fn add_block(&mut self, node: usize, other: usize, weight: f64, block: &[f64]) {
        let row = self.rows[node];
        let width = self.width();
        if let (true, Some(place)) = (row != NONE, self.places.between(node, other)) {
            let values = &mut self.values[row * width + place * C * C..][..C * C];
            values
                .iter_mut()
                .zip(block)
                .for_each(|(value, entry)| *value += weight * entry);
        }
    }

    /// Returns the diagonal entry of a component; 0 for a node without a stencil.
    pub fn on_diagonal(&self, component: usize) -> f64 {
        let (node, i) = Nodal::<C>::split(component);
        let at = (self.places.count() / 2 * C + i) * C + i;
        if self.rows[node] == NONE {
            0.0
        } else {
            self.values[self.rows[node] * self.width() + at]
        }
    }

    /// Computes y = A x for the components marked `free`, with this window's blocks only; `x` must be zero at the
    /// others.
    pub fn multiply(&self, free: &[bool], x: &[f64], y: &mut [f64]) {
        let nodes = self
            .rows
            .iter()
            .zip(y.chunks_exact_mut(C).zip(free.chunks_exact(C)))
            .enumerate();
        for (node, (&row, (y, free))) in nodes {
            let mut image = [0.0; C];
            if row != NONE {
                let values = &self.values[row * self.width()..][..self.width()];
                for (place, other) in self.places.around(node) {
                    let block = &values[place * C * C..][..C * C];
                    let x = &x[Nodal::<C>::of(other)];
                    for i in 0..C {
                        image[i] += (0..C).map(|j| block[i * C + j] * x[j]).sum::<f64>();
                    }
                }
            }
            (0..C).for_each(|i| y[i] = if free[i] { image[i] } else { 0.0 });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bsmpm::grid::KnotVector;
    use std::ops::Range;

    fn grid() -> Grid<2> {
        Grid::new([
            KnotVector::uniform(1.0, 4, 2).unwrap(),
            KnotVector::uniform(1.0, 3, 2).unwrap(),
        ])
        .unwrap()
    }

    /// Stencils of all nodes.
    fn all(grid: &Grid<2>) -> Stencil<2, 2> {
        let mut stencil = Stencil::new(grid);
        stencil.keep(|_| true);
        stencil
    }

    /// Dense sum of the same blocks, the plain way.
    #[test]
    fn entries_hold_the_sum_of_the_patch_blocks() {
        let grid = grid();
        let size = grid.nodes() * 2;
        let mut stencil = all(&grid);
        let mut dense = vec![0.0; size * size];
        for cell in 0..grid.cells() {
            let first = grid.first_node(&grid.cell_at(cell));
            let block: Vec<f64> = (0..18 * 18)
                .map(|entry| ((entry * 7 + cell * 13) % 31) as f64)
                .collect();
            stencil.add(first, &block);
            let component = |k: usize| (first + grid.offsets()[k / 2]) * 2 + k % 2;
            for (entry, value) in block.iter().enumerate() {
                dense[component(entry / 18) * size + component(entry % 18)] += value;
            }
        }
        let numbers: Numbering = (0..size).map(Some).collect();
        let free = vec![true; size];
        let places = stencil.coordinates(&numbers, &free);
        let values = stencil.entries(&numbers, &free);
        let mut found = vec![0.0; size * size];
        for ((row, column), value) in places.rows.iter().zip(&places.columns).zip(values) {
            assert_eq!(
                std::mem::replace(&mut found[row * size + column], value),
                0.0,
                "each pair stands once"
            );
        }
        assert_eq!(found, dense);
        let x: Vec<f64> = (0..size).map(|component| ((component * 5) % 13) as f64).collect();
        let mut y = vec![f64::NAN; size];
        stencil.multiply(&free, &x, &mut y);
        let row = |row: usize| x.iter().zip(&dense[row * size..]).map(|(x, a)| a * x).sum::<f64>();
        assert_eq!(y, (0..size).map(row).collect::<Vec<_>>(), "whole numbers are exact");
    }

    /// Among all nodes of two neighbouring cells, as blocks that couple cells have them.
    #[test]
    fn entries_hold_the_sum_of_blocks_of_neighbouring_cells() {
        let grid = grid().reaching(1);
        let size = grid.nodes() * 2;
        let mut stencil = all(&grid);
        let mut dense = vec![0.0; size * size];
        for (cell, across) in [([0, 0], 3), ([2, 1], 3), ([1, 1], 4)] {
            let first = grid.first_node(&cell);
            let nodes: Vec<usize> = (0..12).map(|k| first + k / across * 5 + k % across).collect();
            let block: Vec<f64> = (0..24 * 24)
                .map(|entry| ((entry * 7 + cell[0] * 13) % 31) as f64)
                .collect();
            stencil.add_among(&nodes, &block);
            let component = |k: usize| nodes[k / 2] * 2 + k % 2;
            for (entry, value) in block.iter().enumerate() {
                dense[component(entry / 24) * size + component(entry % 24)] += value;
            }
        }
        let numbers: Numbering = (0..size).map(Some).collect();
        let free = vec![true; size];
        let places = stencil.coordinates(&numbers, &free);
        let values = stencil.entries(&numbers, &free);
        let mut found = vec![0.0; size * size];
        for ((row, column), value) in places.rows.iter().zip(&places.columns).zip(values) {
            found[row * size + column] += value;
        }
        assert_eq!(found, dense);
    }

    /// Two windows of a grid, each with its cells, give the rows of the whole to the bit.
    #[test]
    fn sums_by_columns_do_not_depend_on_the_cut() {
        let grid = grid();
        let cut = 2;
        let stencil = |columns: Range<usize>| {
            let window = grid.window(columns.clone());
            let mut stencil = Stencil::<2, 2>::new(&window).by_columns(&window, OwnedNodes::first(window.nodes()));
            for cell in 0..window.cells() {
                let cell = window.cell_at(cell);
                let value = |entry: usize| 1.0 / (entry + 7 * cell[0] + 3 * cell[1] + 1) as f64;
                let block: Vec<f64> = (0..18 * 18).map(value).collect();
                stencil.add(window.first_node(&cell), &block);
            }
            stencil
        };
        let mut whole = stencil(0..4);
        whole.complete(Contributions::alone);
        let parts = [stencil(0..cut), stencil(cut..4)];
        let layer = grid.layer_nodes() * whole.width();
        for number in 0..grid.layers().len() {
            let mut sum = vec![0.0; layer];
            for (first, part) in [0, cut].into_iter().zip(&parts) {
                let sums = &part.columns.as_ref().expect("by columns").sums;
                for column in 0..4 - first {
                    let found = (number >= first).then(|| sums.of(column, number - first)).flatten();
                    sum.iter_mut()
                        .zip(found.unwrap_or(&[]))
                        .for_each(|(sum, value)| *sum += value);
                }
            }
            assert_eq!(
                sum,
                whole.values[number * layer..(number + 1) * layer],
                "layer {number}"
            );
        }
    }

    /// However the grid is cut into boxes, every coordinate of the whole is handed over by one of them.
    #[test]
    fn every_entry_is_handed_over_once() {
        let grid = grid();
        let handed = |cells: [Range<usize>; 2], owned: [usize; 2]| {
            let window = grid.window_of(cells);
            let owned = OwnedNodes::new(owned[0], window.layer_nodes(), owned[1]);
            let stencil = Stencil::<2, 1>::new(&window).by_columns(&window, owned);
            let numbers: Numbering = (0..window.nodes()).map(|node| Some(window.number_of(node))).collect();
            let Coordinates { rows, columns } = stencil.coordinates(&numbers, &vec![true; window.nodes()]);
            rows.into_iter().zip(columns).collect::<Vec<_>>()
        };
        let mut whole = handed([0..4, 0..3], [6, 5]);
        let mut parts = handed([0..3, 0..2], [3, 2]);
        parts.extend(handed([0..3, 2..3], [3, 3]));
        parts.extend(handed([3..4, 0..1], [3, 1]));
        parts.extend(handed([3..4, 1..3], [3, 4]));
        whole.sort_unstable();
        parts.sort_unstable();
        assert_eq!(whole, parts);
    }

    #[test]
    fn components_without_a_number_have_neither_row_nor_column() {
        let grid = grid();
        let stencil = all(&grid);
        let numbers: Numbering = (0..grid.nodes() * 2)
            .map(|component| (component % 2 == 0).then_some(component / 2))
            .collect();
        let free: Vec<bool> = numbers.iter().map(Option::is_some).collect();
        let places = stencil.coordinates(&numbers, &free);
        assert_eq!(places.rows.len(), stencil.entries(&numbers, &free).len());
        assert!(
            places
                .rows
                .iter()
                .chain(&places.columns)
                .all(|&number| number < grid.nodes())
        );
    }

    #[test]
    fn nodes_that_are_not_kept_take_no_memory_and_change_no_row() {
        let grid = grid();
        let add = |stencil: &mut Stencil<2, 2>| {
            for cell in 0..grid.cells() {
                let block: Vec<f64> = (0..18 * 18)
                    .map(|entry| ((entry * 7 + cell * 13) % 31) as f64)
                    .collect();
                stencil.add(grid.first_node(&grid.cell_at(cell)), &block);
            }
        };
        let mut whole = all(&grid);
        let kept = |node: usize| !node.is_multiple_of(3);
        let mut some = whole.clone();
        some.keep(kept);
        add(&mut whole);
        add(&mut some);
        for component in 0..2 * grid.nodes() {
            let expected: Vec<_> = if kept(component / 2) {
                whole.row(component).collect()
            } else {
                Vec::new()
            };
            assert_eq!(some.row(component).collect::<Vec<_>>(), expected);
        }
        assert_eq!(
            some.values.len() * grid.nodes(),
            whole.values.len() * (0..grid.nodes()).filter(|&n| kept(n)).count()
        );
    }

    #[test]
    fn held_components_with_a_number_stand_on_the_diagonal_only() {
        let grid = grid();
        let stencil = all(&grid);
        let numbers: Numbering = (0..grid.nodes() * 2).map(Some).collect();
        let free: Vec<bool> = (0..grid.nodes() * 2).map(|component| component % 3 > 0).collect();
        let places = stencil.coordinates(&numbers, &free);
        let pairs: Vec<_> = places.rows.iter().zip(&places.columns).collect();
        let held = pairs.iter().filter(|(row, column)| !free[**row] || !free[**column]);
        assert!(held.clone().all(|(row, column)| row == column));
        assert_eq!(held.count(), free.iter().filter(|&&free| !free).count());
    }
}
