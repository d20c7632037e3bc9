//! Contributions of material points to nodes, stored by column of cells (cells with the same index along x). They are
//! added in a fixed order, so nodal sums are bitwise identical on any number of ranks and threads.

use super::Grid;
use crate::exact::Exact;
use crate::grid::ColumnExtent;

/// Contributions of this rank's columns of cells to the nodes, `width` numbers per node.
#[derive(Clone, Debug)]
pub struct Contributions {
    columns: Vec<usize>, // of the window, ascending, only those that contribute
    sums: Vec<f64>,      // index order: column, layer counted from it, node of the layer, number
    layers: usize,       // that a column contributes to: q + 1 and the additional ones
    layer: usize,        // numbers of a layer
    width: usize,
    nodes: usize,
}

impl Contributions {
    /// Creates zero contributions of `columns` (ascending) of the window.
    pub fn none<const D: usize>(grid: &Grid<D>, width: usize, columns: Vec<usize>) -> Self {
        Self::zeros(grid.column_extent(), width, columns)
    }

    pub(super) fn zeros(extent: ColumnExtent, width: usize, columns: Vec<usize>) -> Self {
        let ColumnExtent {
            layers,
            layer_nodes,
            nodes,
        } = extent;
        let layer = layer_nodes * width;
        Self {
            sums: vec![0.0; columns.len() * layers * layer],
            columns,
            layers,
            layer,
            width,
            nodes,
        }
    }

    /// Returns the count of numbers per node.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the count of numbers of one column.
    pub(super) fn column_size(&self) -> usize {
        self.layers * self.layer
    }

    /// Iterates over the sums of each column.
    pub(super) fn columns_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        let size = self.column_size();
        self.sums.chunks_exact_mut(size)
    }

    /// Returns the numbers from a cell's first node to the end of its column. Index them by the grid's offsets times
    /// the width. A column that has not contributed so far is inserted with zeros.
    pub fn patch(&mut self, first_node: usize) -> &mut [f64] {
        let column = first_node * self.width / self.layer;
        let size = self.column_size();
        let place = self.columns.binary_search(&column).unwrap_or_else(|place| {
            self.columns.insert(place, column);
            self.sums
                .splice(place * size..place * size, std::iter::repeat_n(0.0, size));
            place
        });
        let within = first_node * self.width - column * self.layer;
        &mut self.sums[place * size + within..(place + 1) * size]
    }

    /// Returns the contribution of a column of the window to a layer of nodes; `None` if there is none.
    pub fn of(&self, column: usize, layer: usize) -> Option<&[f64]> {
        let place = self.columns.binary_search(&column).ok()?;
        let at = (place * self.layers + layer.checked_sub(column)?) * self.layer;
        (layer - column < self.layers).then(|| &self.sums[at..at + self.layer])
    }

    /// Adds the contributions of this rank's columns to the nodal array of the window.
    pub fn add_to(&self, nodal: &mut [f64]) {
        for (&column, sums) in self
            .columns
            .iter()
            .zip(self.sums.chunks_exact(self.column_size().max(1)))
        {
            // A column may extend past the window's last layer if it couples with others; `zip` ends there.
            nodal[column * self.layer..]
                .iter_mut()
                .zip(sums)
                .for_each(|(total, sum)| *total += sum);
        }
    }

    /// Returns for each entry of the nodal array the largest value over the columns, or zero if none is positive.
    pub(super) fn highest(&self) -> Vec<f64> {
        let mut nodal = self.nodal();
        for (&column, sums) in self
            .columns
            .iter()
            .zip(self.sums.chunks_exact(self.column_size().max(1)))
        {
            nodal[column * self.layer..]
                .iter_mut()
                .zip(sums)
                .for_each(|(most, value)| *most = most.max(*value));
        }
        nodal
    }

    /// Returns the product with a nodal array of the window: the work of contributed forces on a displacement (J).
    pub fn dot(&self, nodal: &[f64]) -> Exact {
        self.columns
            .iter()
            .zip(self.sums.chunks_exact(self.column_size().max(1)))
            .map(|(&column, sums)| {
                let values = &nodal[column * self.layer..];
                values.iter().zip(sums).map(|(value, sum)| value * sum).sum::<f64>()
            })
            .collect()
    }

    /// Returns a nodal array of zeros for the window.
    pub fn nodal(&self) -> Vec<f64> {
        vec![0.0; self.nodes * self.width]
    }

    /// Returns the nodal array if no other rank contributes.
    pub fn alone(&self) -> Vec<f64> {
        let mut nodal = self.nodal();
        self.add_to(&mut nodal);
        nodal
    }
}
