//! Partly factorises a front (a dense matrix of the multifrontal method): eliminates the first columns, and updates the
//! remaining ones. Only the lower triangle is used. All processors with fused multiply-add (FMA) give bitwise identical
//! results.

use nalgebra::{Dyn, MatrixView, MatrixViewMut};

/// Number of columns that are factorised together: few enough for the level-2 cache, many enough for a matrix product.
const WIDTH: usize = 32;

/// Computes L for the columns `a` of a symmetric matrix, `rows` long, in place. Returns `false` if a pivot is not
/// positive and finite.
pub fn factorise(a: &mut [f64], rows: usize) -> bool {
    let columns = a.len().checked_div(rows).unwrap_or(0);
    (0..columns).step_by(WIDTH).all(|start| {
        let width = WIDTH.min(columns - start);
        let (done, rest) = a.split_at_mut(start * rows);
        let block = &mut rest[..width * rows];
        subtract_product(done, rows, start, start, &mut block[start..], rows, width);
        factorise_block(block, rows, start)
    })
}

/// Subtracts the contribution of the factorised columns `l` from the matrix `target` of order rows - columns.
pub fn subtract_from_rest(l: &[f64], rows: usize, target: &mut [f64]) {
    let columns = l.len().checked_div(rows).unwrap_or(0);
    let order = rows - columns;
    for start in (0..order).step_by(2 * WIDTH) {
        let width = (2 * WIDTH).min(order - start);
        let block = &mut target[start * order + start..];
        subtract_product(l, rows, columns, columns + start, block, order, width);
    }
}

/// Computes C -= L_below L_at^T: L_below are the rows of the columns `l` from `first` on, L_at their first `width`
/// rows.
fn subtract_product(l: &[f64], rows: usize, columns: usize, first: usize, c: &mut [f64], stride: usize, width: usize) {
    if columns == 0 || first == rows {
        return;
    }
    let below = Dyn(rows - first);
    let factor = MatrixView::from_slice_with_strides_generic(&l[first..], below, Dyn(columns), Dyn(1), Dyn(rows));
    let turned = MatrixView::from_slice_with_strides_generic(&l[first..], Dyn(columns), Dyn(width), Dyn(rows), Dyn(1));
    let mut c = MatrixViewMut::from_slice_with_strides_generic(c, below, Dyn(width), Dyn(1), Dyn(stride));
    c.gemm(-1.0, &factor, &turned, 1.0);
}

/// Factorises the columns from `start` on, from which all earlier ones have been subtracted.
fn factorise_block(block: &mut [f64], rows: usize, start: usize) -> bool {
    (0..block.len() / rows).all(|c| {
        let (done, column) = block.split_at_mut(c * rows);
        let first = start + c;
        let column = &mut column[first..rows];
        for group in done.chunks(4 * rows) {
            subtract_columns(group, rows, first, column);
        }
        let pivot = column[0];
        let good = pivot > 0.0 && pivot.is_finite();
        let scale = 1.0 / pivot.sqrt();
        column.iter_mut().for_each(|value| *value *= scale);
        good
    })
}

/// Subtracts up to four columns, each times its own entry in the row `first`, from `target`, which begins at that row.
fn subtract_columns(columns: &[f64], rows: usize, first: usize, target: &mut [f64]) {
    if columns.len() == 4 * rows {
        let by = [0, 1, 2, 3].map(|column| columns[column * rows + first]);
        subtract_four(columns, rows, first, by, target);
    } else {
        for values in columns.chunks_exact(rows) {
            let factor = values[first];
            target
                .iter_mut()
                .zip(&values[first..])
                .for_each(|(value, l)| *value -= factor * l);
        }
    }
}

/// Subtracts the rows from `first` on of four columns, times four factors, from `target`.
fn subtract_four(columns: &[f64], rows: usize, first: usize, by: [f64; 4], target: &mut [f64]) {
    let [a, b, c, d] = [0, 1, 2, 3].map(|column| &columns[column * rows + first..(column + 1) * rows]);
    let pairs = a.iter().zip(b).zip(c.iter().zip(d));
    for (value, ((a, b), (c, d))) in target.iter_mut().zip(pairs) {
        *value -= (by[0] * a + by[1] * b) + (by[2] * c + by[3] * d);
    }
}
