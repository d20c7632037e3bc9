//! The stiffness of one window as node stencils, and its entries as PETSc wants them: plain data, without MPI or PETSc.
//!
//! A node couples with the (2q+1)^D nodes around it, and with those a layer further where the window reaches beyond its cells.
//! Blocks of patches are summed into that fixed stencil, so that every
//! rank hands each of its coordinates over once; rows of ghost nodes are completed by their owner, in whatever order, or by
//! columns of cells in the order of these.

use bsmpm::grid::{Contributions, Grid, KnotVector};
use std::ops::Range;

/// Stencils of all nodes of a window: D x D blocks of a node with each node of its stencil.
#[derive(Clone, Debug)]
pub struct Stencil<const D: usize> {
    places: Places<D>,
    reach: Vec<isize>,    // offset in local nodes of every stencil place, ascending
    slot: Vec<usize>,     // stencil place of patch node b as seen from patch node a
    offsets: Vec<usize>,  // of a patch's nodes
    values: Vec<f64>,     // node, place, row, column
    valid: Vec<Vec<u16>>, // per node the places that lie in the grid
    columns: Option<Columns>,
}

/// Sums by columns of cells, whose rows one rank completes: see [`Stencil::by_columns`].
#[derive(Clone, Debug)]
struct Columns {
    none: Contributions,
    sums: Contributions,
    diagonal: Vec<f64>,
    owned: Range<usize>, // nodes of this rank
}

/// The places of a stencil: a box of nodes.
#[derive(Clone, Debug)]
struct Places<const D: usize> {
    functions: [usize; D],   // nodes along each axis
    half: isize,             // of the box: q, and the layers beyond
    within: Vec<[isize; D]>, // of every place
}

/// Global number of every nodal component of a window, `None` where it is no unknown.
pub type Numbering = Vec<Option<usize>>;

/// Global row and column of every entry, each pair once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// global row of every entry
    pub rows: Vec<usize>,
    /// global column of every entry
    pub columns: Vec<usize>,
}

impl<const D: usize> Places<D> {
    fn new(grid: &Grid<D>) -> Self {
        let q = grid.order() as isize;
        let half = q + grid.beyond() as isize;
        let side = 2 * half + 1;
        let along = |number: isize, axis: usize| number / side.pow((D - 1 - axis) as u32) % side - half;
        let within =
            (0..side.pow(D as u32)).map(|number| std::array::from_fn(|axis| along(number, axis))).collect();
        let functions = grid.axes().each_ref().map(KnotVector::functions);
        Self { functions, half, within }
    }

    /// Number of a node in a box as wide along every axis as the grid's; differences of two are those of their places.
    fn number(&self, at: [usize; D]) -> usize {
        let side = 2 * self.half as usize + 1;
        at.into_iter().fold(0, |number, step| number * side + step)
    }

    /// The node along each axis, from the window's first layer, of a local index.
    fn node(&self, mut index: usize) -> [usize; D] {
        let mut node = [0; D];
        for axis in (1..D).rev() {
            node[axis] = index % self.functions[axis];
            index /= self.functions[axis];
        }
        node[0] = index;
        node
    }

    /// The place of node number `b` as seen from node number `a`.
    fn of(&self, a: usize, b: usize) -> usize {
        b + self.number([self.half as usize; D]) - a
    }
}

impl<const D: usize> Stencil<D> {
    /// Zero stencils over a window.
    pub fn new(grid: &Grid<D>) -> Self {
        let places = Places::new(grid);
        let flat =
            |step: &[isize; D]| (1..D).fold(step[0], |sum, axis| sum * places.functions[axis] as isize + step[axis]);
        let reach: Vec<isize> = places.within.iter().map(flat).collect();
        let (width, patch) = (grid.order() + 1, grid.cell_nodes());
        let at = |k: usize| std::array::from_fn(|axis| k / width.pow((D - 1 - axis) as u32) % width);
        let number = |k: usize| places.number(at(k));
        let slot = (0..patch * patch).map(|pair| places.of(number(pair / patch), number(pair % patch))).collect();
        let layers = grid.layers();
        let inside = |node: &[usize; D], step: &[isize; D]| {
            (0..D).all(|axis| {
                let range = if axis == 0 { layers.clone() } else { 0..places.functions[axis] };
                node[axis].checked_add_signed(step[axis]).is_some_and(|other| range.contains(&other))
            })
        };
        let valid = (0..grid.nodes())
            .map(|node| {
                let node = grid.node_at(node);
                let steps = places.within.iter().enumerate();
                steps.filter(|(_, step)| inside(&node, step)).map(|(place, _)| place as u16).collect()
            })
            .collect();
        let values = vec![0.0; grid.nodes() * reach.len() * D * D];
        Self { places, reach, slot, offsets: grid.offsets(), values, valid, columns: None }
    }

    /// Zero stencils whose sums do not depend on the cut: the columns of cells add to a row in their order, whichever rank
    /// has them. An entry is handed over once, by the owner of the lower one of its two nodes, whose window holds both. `owned`
    /// nodes of the window are this rank's. Takes q + 1 times the memory.
    pub fn by_columns(grid: &Grid<D>, owned: Range<usize>) -> Self {
        let stencil = Self::new(grid);
        let none = Contributions::none(grid, stencil.width(), Vec::new());
        let (sums, diagonal) = (none.clone(), vec![0.0; grid.nodes() * D]);
        let columns = Columns { none, sums, diagonal, owned };
        Self { columns: Some(columns), ..stencil }
    }

    /// Completes sums by columns, by what `total` makes of those of all ranks.
    pub fn complete(&mut self, total: impl FnOnce(&Contributions) -> Vec<f64>) {
        let Some(columns) = &self.columns else { return };
        self.values = total(&columns.sums);
        let diagonal = columns.diagonal.clone();
        for (at, value) in diagonal.into_iter().enumerate() {
            *self.diagonal(at / D, at % D) += value;
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

    /// The values from node `first` on, in which a cell or a face that begins there is summed.
    fn values_from(&mut self, first: usize) -> &mut [f64] {
        let width = self.width();
        match &mut self.columns {
            Some(columns) => columns.sums.patch(first),
            None => &mut self.values[first * width..],
        }
    }

    fn diagonal(&mut self, node: usize, component: usize) -> &mut f64 {
        let middle = self.reach.len() / 2;
        let at = node * self.width() + (middle * D + component) * D + component;
        &mut self.values[at]
    }

    fn width(&self) -> usize {
        self.reach.len() * D * D
    }

    /// Adds the dense block of the patch whose first node is `first`.
    pub fn add(&mut self, first: usize, block: &[f64]) {
        let (patch, width) = (self.offsets.len(), self.width());
        let (offsets, slot) = (std::mem::take(&mut self.offsets), std::mem::take(&mut self.slot));
        let values = self.values_from(first);
        for a in 0..patch {
            let node = offsets[a] * width;
            for b in 0..patch {
                let at = node + slot[a * patch + b] * D * D;
                for i in 0..D {
                    let row = &block[(a * D + i) * patch * D + b * D..][..D];
                    for (value, entry) in values[at + i * D..][..D].iter_mut().zip(row) {
                        *value += entry;
                    }
                }
            }
        }
        (self.offsets, self.slot) = (offsets, slot);
    }

    /// Adds the dense block of `nodes`, the lowest first.
    pub fn add_among(&mut self, nodes: &[usize], block: &[f64]) {
        let (width, first, order) = (self.width(), nodes[0], nodes.len() * D);
        let numbers: Vec<usize> = nodes.iter().map(|&node| self.places.number(self.places.node(node))).collect();
        let pairs = numbers.iter().flat_map(|a| numbers.iter().map(|b| self.places.of(*a, *b) * D * D));
        let places: Vec<usize> = pairs.collect();
        let values = self.values_from(first);
        for (a, node) in nodes.iter().enumerate() {
            for (b, place) in places[a * nodes.len()..][..nodes.len()].iter().enumerate() {
                let at = (node - first) * width + place;
                for i in 0..D {
                    let row = &block[(a * D + i) * order + b * D..][..D];
                    values[at + i * D..][..D].iter_mut().zip(row).for_each(|(value, entry)| *value += entry);
                }
            }
        }
    }

    /// Adds to the diagonal entry of a component of `node`.
    pub fn add_diagonal(&mut self, node: usize, component: usize, value: f64) {
        match &mut self.columns {
            Some(columns) => columns.diagonal[node * D + component] += value,
            None => *self.diagonal(node, component) += value,
        }
    }

    /// Largest entry on the diagonal of this window's blocks.
    pub fn largest_diagonal(&self) -> f64 {
        let (middle, width) = (self.reach.len() / 2, self.width());
        let entry = |component: usize| {
            let (node, i) = (component / D, component % D);
            self.values[node * width + (middle * D + i) * D + i]
        };
        (0..self.valid.len() * D).map(entry).fold(0.0, f64::max)
    }

    /// A component's row: the first component of every node that it couples with, and the entries there.
    pub fn row(&self, component: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let (node, i) = (component / D, component % D);
        self.valid[node].iter().map(move |&place| {
            let other = node.wrapping_add_signed(self.reach[usize::from(place)]);
            let at = node * self.width() + (usize::from(place) * D + i) * D;
            (other * D, &self.values[at..at + D])
        })
    }

    /// y = A x of the components marked `free`, as far as this window's blocks go; `x` is zero at the others.
    pub fn multiply(&self, free: &[bool], x: &[f64], y: &mut [f64]) {
        for (component, y) in y.iter_mut().enumerate() {
            *y = 0.0;
            if free[component] {
                for (other, values) in self.row(component) {
                    *y += values.iter().zip(&x[other..other + D]).map(|(a, x)| a * x).sum::<f64>();
                }
            }
        }
    }

    /// Coordinates of all entries between `free` components that have a number; others with a number are on the diagonal
    /// only.
    pub fn coordinates(&self, numbers: &Numbering, free: &[bool]) -> Coordinates {
        let mut coordinates = Coordinates::default();
        self.walk(numbers, free, |row, column, _| {
            coordinates.rows.push(row);
            coordinates.columns.push(column);
        });
        coordinates
    }

    /// Values of the entries in the order of [`Stencil::coordinates`].
    pub fn entries(&self, numbers: &Numbering, free: &[bool]) -> Vec<f64> {
        let mut values = Vec::new();
        self.walk(numbers, free, |_, _, at| values.push(self.values[at]));
        values
    }

    /// Visits every entry with its global row and column and its place in `values`.
    fn walk(&self, numbers: &Numbering, free: &[bool], mut visit: impl FnMut(usize, usize, usize)) {
        let handed = |a: usize, b: usize| self.columns.as_ref().is_none_or(|columns| columns.owned.contains(&a.min(b)));
        for (component, row) in numbers.iter().enumerate() {
            let Some(row) = row else { continue };
            let (node, i) = (component / D, component % D);
            for &place in &self.valid[node] {
                let other = node.wrapping_add_signed(self.reach[usize::from(place)]);
                if !handed(node, other) {
                    continue;
                }
                let at = node * self.width() + (usize::from(place) * D + i) * D;
                for j in 0..D {
                    let coupled = other * D + j == component || free[component] && free[other * D + j];
                    if let Some(column) = numbers[other * D + j].filter(|_| coupled) {
                        visit(*row, column, at + j);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid<2> {
        Grid::new([KnotVector::uniform(1.0, 4, 2).unwrap(), KnotVector::uniform(1.0, 3, 2).unwrap()]).unwrap()
    }

    /// Dense sum of the same blocks, the plain way.
    #[test]
    fn entries_hold_the_sum_of_the_patch_blocks() {
        let grid = grid();
        let size = grid.nodes() * 2;
        let (mut stencil, mut dense) = (Stencil::new(&grid), vec![0.0; size * size]);
        for cell in 0..grid.cells() {
            let first = grid.first_node(&grid.cell_at(cell));
            let block: Vec<f64> = (0..18 * 18).map(|entry| ((entry * 7 + cell * 13) % 31) as f64).collect();
            stencil.add(first, &block);
            let component = |k: usize| (first + grid.offsets()[k / 2]) * 2 + k % 2;
            for (entry, value) in block.iter().enumerate() {
                dense[component(entry / 18) * size + component(entry % 18)] += value;
            }
        }
        let (numbers, free): (Numbering, _) = ((0..size).map(Some).collect(), vec![true; size]);
        let (places, values) = (stencil.coordinates(&numbers, &free), stencil.entries(&numbers, &free));
        let mut found = vec![0.0; size * size];
        for ((row, column), value) in places.rows.iter().zip(&places.columns).zip(values) {
            assert_eq!(std::mem::replace(&mut found[row * size + column], value), 0.0, "each pair stands once");
        }
        assert_eq!(found, dense);
        let x: Vec<f64> = (0..size).map(|component| ((component * 5) % 13) as f64).collect();
        let mut y = vec![f64::NAN; size];
        stencil.multiply(&free, &x, &mut y);
        let row = |row: usize| x.iter().zip(&dense[row * size..]).map(|(x, a)| a * x).sum::<f64>();
        assert_eq!(y, (0..size).map(row).collect::<Vec<_>>(), "whole numbers are exact");
    }

    /// Faces between cells, with every node of the two cells that a face of the ghost penalty has.
    #[test]
    fn entries_hold_the_sum_of_the_blocks_of_faces() {
        let grid = grid().reaching(1);
        let size = grid.nodes() * 2;
        let (mut stencil, mut dense) = (Stencil::new(&grid), vec![0.0; size * size]);
        for (cell, across) in [([0, 0], 3), ([2, 1], 3), ([1, 1], 4)] {
            let first = grid.first_node(&cell);
            let nodes: Vec<usize> = (0..12).map(|k| first + k / across * 5 + k % across).collect();
            let block: Vec<f64> = (0..24 * 24).map(|entry| ((entry * 7 + cell[0] * 13) % 31) as f64).collect();
            stencil.add_among(&nodes, &block);
            let component = |k: usize| nodes[k / 2] * 2 + k % 2;
            for (entry, value) in block.iter().enumerate() {
                dense[component(entry / 24) * size + component(entry % 24)] += value;
            }
        }
        let (numbers, free): (Numbering, _) = ((0..size).map(Some).collect(), vec![true; size]);
        let (places, values) = (stencil.coordinates(&numbers, &free), stencil.entries(&numbers, &free));
        let mut found = vec![0.0; size * size];
        for ((row, column), value) in places.rows.iter().zip(&places.columns).zip(values) {
            found[row * size + column] += value;
        }
        assert_eq!(found, dense);
    }

    /// Two windows of a grid, each with its cells, give the rows of the whole to the bit.
    #[test]
    fn sums_by_columns_do_not_depend_on_the_cut() {
        let (grid, cut) = (grid(), 2);
        let stencil = |columns: Range<usize>| {
            let window = grid.window(columns.clone());
            let mut stencil = Stencil::by_columns(&window, 0..window.nodes());
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
                    sum.iter_mut().zip(found.unwrap_or(&[])).for_each(|(sum, value)| *sum += value);
                }
            }
            assert_eq!(sum, whole.values[number * layer..(number + 1) * layer], "layer {number}");
        }
    }

    #[test]
    fn components_without_a_number_have_neither_row_nor_column() {
        let grid = grid();
        let stencil = Stencil::new(&grid);
        let numbers: Numbering =
            (0..grid.nodes() * 2).map(|component| (component % 2 == 0).then_some(component / 2)).collect();
        let free: Vec<bool> = numbers.iter().map(Option::is_some).collect();
        let places = stencil.coordinates(&numbers, &free);
        assert_eq!(places.rows.len(), stencil.entries(&numbers, &free).len());
        assert!(places.rows.iter().chain(&places.columns).all(|&number| number < grid.nodes()));
    }

    #[test]
    fn held_components_with_a_number_stand_on_the_diagonal_only() {
        let grid = grid();
        let stencil = Stencil::new(&grid);
        let numbers: Numbering = (0..grid.nodes() * 2).map(Some).collect();
        let free: Vec<bool> = (0..grid.nodes() * 2).map(|component| component % 3 > 0).collect();
        let places = stencil.coordinates(&numbers, &free);
        let pairs: Vec<_> = places.rows.iter().zip(&places.columns).collect();
        let held = pairs.iter().filter(|(row, column)| !free[**row] || !free[**column]);
        assert!(held.clone().all(|(row, column)| row == column));
        assert_eq!(held.count(), free.iter().filter(|&&free| !free).count());
    }
}
