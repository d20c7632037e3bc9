//! Splines on pairs of cells (for `subgrid-f-bar`), as sums of splines on single cells, by knot insertion (Cohen, Lyche
//! and Riesenfeld, 1980).

use super::KnotVector;
use std::ops::Range;

/// Axis whose neighbouring cells are paired. Pairs are formed from the lower end of each stretch without a repeated
/// breakpoint. A last odd cell stays single, as do cells of zero length.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CellPairs {
    degree: usize,
    of_cell: Vec<usize>,        // first function on pairs that is non-zero in a cell
    shares: Vec<f64>,           // per cell: r, a row for each function on pairs, a column for each on cells
    support: Vec<Range<usize>>, // cells of every function on pairs
    long: Vec<usize>,           // number of these cells that have a length
    slots: Vec<usize>,          // number of the node under which a function is stored
    of_slot: Vec<Option<usize>>,
}

impl CellPairs {
    pub fn of(axis: &KnotVector) -> Self {
        let degree = axis.order() - 1;
        let cells = axis.cells();
        let pairs = pairs(axis);
        let count = pairs.len() + degree;
        let last = pairs.len() - 1;
        let support: Vec<_> = (0..count)
            .map(|k| pairs[k.saturating_sub(degree)].start..pairs[k.min(last)].end)
            .collect();
        // A function is stored at the last cell of the last pair of its support. Functions past the last pair take the
        // remaining nodes.
        let slots: Vec<usize> = (0..count)
            .map(|k| pairs[k.min(last)].end - 1 + k.saturating_sub(last))
            .collect();
        let mut of_slot = vec![None; axis.functions()];
        slots.iter().enumerate().for_each(|(k, &slot)| of_slot[slot] = Some(k));
        let of_cell: Vec<usize> = pairs
            .iter()
            .enumerate()
            .flat_map(|(first, pair)| pair.clone().map(move |_| first))
            .collect();
        let knots = Knots::of(axis, &pairs);
        let shares = (0..cells)
            .flat_map(|cell| (0..=degree).map(move |a| (cell, a)))
            .flat_map(|(cell, a)| (0..=degree).map(move |b| (cell, a, b)))
            .map(|(cell, a, b)| knots.share(of_cell[cell] + a, cell + b, degree))
            .collect();
        let long = support
            .iter()
            .map(|cells| cells.clone().filter(|&cell| axis.has_length(cell)).count())
            .collect();
        Self {
            degree,
            of_cell,
            shares,
            support,
            long,
            slots,
            of_slot,
        }
    }

    /// Returns the number of function `a` of a cell.
    pub fn function(&self, cell: usize, a: usize) -> usize {
        self.of_cell[cell] + a
    }

    /// Returns r of function `a` on pairs and function `b` on cells, both counted within a cell.
    pub fn share(&self, cell: usize, a: usize, b: usize) -> f64 {
        self.shares[(cell * (self.degree + 1) + a) * (self.degree + 1) + b]
    }

    /// Returns the cells of a function's support.
    pub fn support(&self, function: usize) -> Range<usize> {
        self.support[function].clone()
    }

    /// Returns the number of cells with a length in a function's support.
    pub fn cells_of(&self, function: usize) -> usize {
        self.long[function]
    }

    /// Returns the number of the node under which a function is stored. For the functions of cell c it is between c and
    /// c + 2q - 1.
    pub fn slot(&self, function: usize) -> usize {
        self.slots[function]
    }

    /// Returns the function that is stored under the number of a node.
    pub fn at_slot(&self, slot: usize) -> Option<usize> {
        self.of_slot[slot]
    }
}

fn pairs(axis: &KnotVector) -> Vec<Range<usize>> {
    let mut pairs = Vec::new();
    let mut cell = 0;
    while cell < axis.cells() {
        let paired = cell + 1 < axis.cells() && axis.has_length(cell) && axis.has_length(cell + 1);
        let end = cell + 1 + usize::from(paired);
        pairs.push(cell..end);
        cell = end;
    }
    pairs
}

/// Knot vectors of degree q - 1 on cells and on pairs (m).
struct Knots {
    cells: Vec<f64>,
    pairs: Vec<f64>,
}

impl Knots {
    fn of(axis: &KnotVector, pairs: &[Range<usize>]) -> Self {
        let degree = axis.order() - 1;
        let cells = (0..axis.cells() + 2 * degree + 1).map(|i| axis.knot(i + 1)).collect();
        let mut knots = vec![0.0; degree];
        knots.extend(pairs.iter().map(|pair| axis.breakpoint(pair.start)));
        knots.extend(std::iter::repeat_n(axis.length(), degree + 1));
        Self { cells, pairs: knots }
    }

    /// Returns r_kj for splines of the given degree by the Oslo algorithm: B_k on pairs = sum_j r_kj b_j on cells.
    fn share(&self, k: usize, j: usize, degree: usize) -> f64 {
        let t = &self.cells;
        let T = &self.pairs;
        if degree == 0 {
            return f64::from(u8::from(T[k] <= t[j] && t[j] < T[k + 1]));
        }
        let rising = if T[k + degree] > T[k] {
            (t[j + degree] - T[k]) / (T[k + degree] - T[k]) * self.share(k, j, degree - 1)
        } else {
            0.0
        };
        let falling = if T[k + degree + 1] > T[k + 1] {
            (T[k + degree + 1] - t[j + degree]) / (T[k + degree + 1] - T[k + 1]) * self.share(k + 1, j, degree - 1)
        } else {
            0.0
        };
        rising + falling
    }
}
