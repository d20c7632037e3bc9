//! Contributions of material points to nodes, stored by column of cells (cells with the same index along x). They are
//! added in a fixed order, so nodal sums are bitwise identical on any number of ranks and threads.

use super::Grid;
use crate::exact::Exact;
use crate::grid::ColumnExtent;

/// Contributions of the columns of this rank, `width` numbers a node; see the module.
#[derive(Clone, Debug)]
pub struct Contributions {
    columns: Vec<usize>, // of the window, ascending, that contribute at all
    sums: Vec<f64>,      // column, layer from it on, node of the layer, number
    layers: usize,       // that a column reaches, q + 1 and those beyond
    layer: usize,        // numbers of a layer
    width: usize,
    nodes: usize,
}

impl Contributions {
    /// None, by the `columns` (ascending) of a window.
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

    /// Numbers a node.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Numbers of one column.
    pub(super) fn column_size(&self) -> usize {
        self.layers * self.layer
    }

    /// The sums of all columns, one after the other.
    pub(super) fn columns_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        let size = self.column_size();
        self.sums.chunks_exact_mut(size)
    }

    /// The numbers of a cell's nodes and those behind them, to be indexed by the grid's offsets times the width; a
    /// column that has not contributed before begins with zeros.
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

    /// What a column of the window contributes to a layer of its nodes; `None` if nothing.
    pub fn of(&self, column: usize, layer: usize) -> Option<&[f64]> {
        let place = self.columns.binary_search(&column).ok()?;
        let at = (place * self.layers + layer.checked_sub(column)?) * self.layer;
        (layer - column < self.layers).then(|| &self.sums[at..at + self.layer])
    }

    /// Adds what the columns of this rank contribute to the nodal array of the window.
    pub fn add_to(&self, nodal: &mut [f64]) {
        for (&column, sums) in self
            .columns
            .iter()
            .zip(self.sums.chunks_exact(self.column_size().max(1)))
        {
            // Past the window's last layer there is nothing: only columns that couple with others reach so far.
            nodal[column * self.layer..]
                .iter_mut()
                .zip(sums)
                .for_each(|(total, sum)| *total += sum);
        }
    }

    /// Largest number that a column has for each of the nodal array, zero where none is larger.
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

    /// Product with a nodal array of the window: what forces that contribute work on a displacement.
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

    /// Zeros for the nodes of the window.
    pub fn nodal(&self) -> Vec<f64> {
        vec![0.0; self.nodes * self.width]
    }

    /// The nodal array where no other rank contributes.
    pub fn alone(&self) -> Vec<f64> {
        let mut nodal = self.nodal();
        self.add_to(&mut nodal);
        nodal
    }
}
