//! Columns shared by threads. Nothing here is generic in the work: with a copy for every pass, most of what is compiled
//! of a program would be the machinery of threads.

use crate::grid::contributions::Contributions;
use crate::grid::shape::Shape;
use rayon::prelude::*;
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

/// Room for what every column leaves.
pub(super) fn unfilled<T>(columns: usize) -> Vec<Mutex<Vec<T>>> {
    (0..columns).map(|_| Mutex::default()).collect()
}

/// All that the columns have left, in their order.
pub(super) fn joined<T>(parts: Vec<Mutex<Vec<T>>>) -> Vec<T> {
    let parts: Vec<Vec<T>> = parts.into_iter().map(|part| part.into_inner().expect("no thread panicked")).collect();
    let mut out = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    parts.into_iter().for_each(|mut part| out.append(&mut part));
    out
}

/// Threads share the columns, by their index.
pub(super) fn share(columns: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..columns).into_par_iter().for_each(work);
}
