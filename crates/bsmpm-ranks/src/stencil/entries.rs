//! Numbers the entries of a rank's stencils for a matrix over all ranks.

use super::{NONE, Stencil};
use bsmpm::nodal::Nodal;

/// Global number of every nodal component of a window; `None` if it is not an unknown.
pub type Numbering = Vec<Option<usize>>;

/// Global row and column of every matrix entry, each pair once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// Global row of every entry.
    pub rows: Vec<usize>,
    /// Global column of every entry.
    pub columns: Vec<usize>,
}

impl<const D: usize, const C: usize> Stencil<D, C> {
    /// Returns the coordinates of all entries between `free` components that have a number. Other components with a
    /// number have a diagonal entry only.
    pub fn coordinates(&self, numbers: &Numbering, free: &[bool]) -> Coordinates {
        let mut coordinates = Coordinates::default();
        self.walk(numbers, free, |row, column, _| {
            coordinates.rows.push(row);
            coordinates.columns.push(column);
        });
        coordinates
    }

    /// Returns the same as compressed rows, if all `count` rows belong to this rank: where each row begins, and the
    /// columns of the entries.
    pub fn rows_of(&self, count: usize, numbers: &Numbering, free: &[bool]) -> (Vec<usize>, Vec<usize>) {
        let mut starts = vec![0; count + 1];
        let mut columns = Vec::new();
        self.walk(numbers, free, |row, column, _| {
            columns.push(column);
            starts[row + 1] = columns.len();
        });
        (starts, columns)
    }

    /// Returns the values of the entries in the order of [`Stencil::coordinates`].
    pub fn entries(&self, numbers: &Numbering, free: &[bool]) -> Vec<f64> {
        let mut values = Vec::new();
        self.walk(numbers, free, |_, _, at| values.push(self.values[at]));
        values
    }

    /// Visits every entry with its global row and column and its position in `values`.
    fn walk(&self, numbers: &Numbering, free: &[bool], mut visit: impl FnMut(usize, usize, usize)) {
        for (component, row) in numbers.iter().enumerate() {
            let Some(row) = row else { continue };
            let (node, i) = Nodal::<C>::split(component);
            if self.rows[node] == NONE {
                continue;
            }
            for (place, other) in self.places.around(node) {
                let columns = self.columns.as_ref();
                if columns.is_some_and(|columns| !columns.owned.contains(self.places.lowest(node, other))) {
                    continue;
                }
                let at = self.rows[node] * self.width() + (place * C + i) * C;
                for j in 0..C {
                    let coupled =
                        Nodal::<C>::at(other, j) == component || free[component] && free[Nodal::<C>::at(other, j)];
                    if let Some(column) = numbers[Nodal::<C>::at(other, j)].filter(|_| coupled) {
                        visit(*row, column, at + j);
                    }
                }
            }
        }
    }
}
