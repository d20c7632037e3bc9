//! Columns of cells as threads share them.

use crate::grid::contributions::Contributions;
use crate::grid::shape::{PatchColumn, Shape};
use std::sync::Mutex;

/// Contributions of no point yet, `width` numbers a node and level.
pub(super) fn nothing<const D: usize>(shape: &Shape<D>, width: usize) -> Contributions {
    let columns = shape.columns().iter().map(|column| column.column).collect();
    Contributions::zeros(shape.extent(), width * shape.levels(), columns)
}

/// The sums of every column, for a thread of its own.
pub(super) fn apart(contributions: &mut Contributions) -> Vec<Mutex<&mut [f64]>> {
    contributions.columns_mut().map(Mutex::new).collect()
}

/// The places of every column's points, for a thread of its own.
pub(super) fn places<'a, const D: usize, T>(shape: &Shape<D>, out: &'a mut [T]) -> Vec<Mutex<&'a mut [T]>> {
    let mut rest = out;
    let of_column = |column: &PatchColumn| {
        let (places, others) = std::mem::take(&mut rest).split_at_mut(column.points.len());
        rest = others;
        Mutex::new(places)
    };
    shape.columns().iter().map(of_column).collect()
}
