//! Stores the Cholesky factor in groups of four columns, which makes triangular solutions faster (memory bandwidth
//! limits them).

/// Number of columns that are stored and processed together.
const GROUP: usize = 4;

/// Number format of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits.
    Single,
    /// 64 bits.
    Double,
}

/// Factorised columns of fronts, front by front.
#[derive(Debug)]
pub enum Factor {
    /// Single precision.
    Single(Vec<f32>),
    /// Double precision.
    Double(Vec<f64>),
}

/// Memory for the columns of consecutive fronts.
#[derive(Debug)]
pub enum Room<'a> {
    /// Single precision.
    Single(&'a mut [f32]),
    /// Double precision.
    Double(&'a mut [f64]),
}

impl Default for Factor {
    fn default() -> Self {
        Self::Single(Vec::new())
    }
}

impl Factor {
    /// Returns memory for `entries` numbers, which replace the present ones. It is reused if the precision is the same.
    pub fn restart(&mut self, precision: Precision, entries: usize) -> Room<'_> {
        match (precision, &mut *self) {
            (Precision::Single, Self::Double(_)) => *self = Self::Single(Vec::new()),
            (Precision::Double, Self::Single(_)) => *self = Self::Double(Vec::new()),
            _ => {}
        }
        match self {
            Self::Single(numbers) => Room::Single(resized(numbers, entries)),
            Self::Double(numbers) => Room::Double(resized(numbers, entries)),
        }
    }

    /// Forward substitution with `columns` of a front of order `rows`, which begin at index `start`: solves for the
    /// first entries of `x` and subtracts their contribution from the others.
    pub fn forward(&self, start: usize, rows: usize, columns: usize, x: &mut [f64]) {
        let range = start..start + entries(rows, columns);
        match self {
            Self::Single(numbers) => forward(&numbers[range], rows, columns, x),
            Self::Double(numbers) => forward(&numbers[range], rows, columns, x),
        }
    }

    /// Back substitution with the transpose of these columns: solves for the first entries of `x`; the others are
    /// known.
    pub fn backward(&self, start: usize, rows: usize, columns: usize, x: &mut [f64]) {
        let range = start..start + entries(rows, columns);
        match self {
            Self::Single(numbers) => backward(&numbers[range], rows, columns, x),
            Self::Double(numbers) => backward(&numbers[range], rows, columns, x),
        }
    }
}

impl<'a> Room<'a> {
    /// Splits off the first `entries` numbers.
    pub fn split_at(self, entries: usize) -> (Self, Self) {
        match self {
            Self::Single(numbers) => {
                let (first, rest) = numbers.split_at_mut(entries);
                (Self::Single(first), Self::Single(rest))
            }
            Self::Double(numbers) => {
                let (first, rest) = numbers.split_at_mut(entries);
                (Self::Double(first), Self::Double(rest))
            }
        }
    }

    /// Stores the factorised `columns` of a front, `rows` long, from index `start` on.
    pub fn keep(&mut self, start: usize, columns: &[f64], rows: usize) {
        match self {
            Self::Single(numbers) => keep(columns, rows, &mut numbers[start..]),
            Self::Double(numbers) => keep(columns, rows, &mut numbers[start..]),
        }
    }
}

/// Returns `entries` numbers with unspecified values.
fn resized<T: Scalar>(numbers: &mut Vec<T>, entries: usize) -> &mut [T] {
    if numbers.len() < entries {
        numbers.clear();
        numbers.reserve_exact(entries);
        numbers.resize(entries, T::of(0.0));
    }
    &mut numbers[..entries]
}

/// Returns the count of stored numbers of `columns` of a front of order `rows`. A group that begins in column s stores
/// rows s to `rows` of each of its columns.
pub fn entries(rows: usize, columns: usize) -> usize {
    (0..columns)
        .step_by(GROUP)
        .map(|start| (rows - start) * GROUP.min(columns - start))
        .sum()
}

/// Number of a factor.
trait Scalar: Copy {
    fn of(value: f64) -> Self;
    fn double(self) -> f64;
}

impl Scalar for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self)
    }
}

impl Scalar for f64 {
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn double(self) -> f64 {
        self
    }
}

/// Stores groups of columns one after the other, each row by row from its first diagonal entry on. Entries above the
/// diagonal are stored but not read.
fn keep<T: Scalar>(columns: &[f64], rows: usize, numbers: &mut [T]) {
    let mut numbers = numbers.iter_mut();
    for (group, columns) in columns.chunks(GROUP * rows.max(1)).enumerate() {
        for row in GROUP * group..rows {
            let values = columns[row..].iter().step_by(rows);
            values
                .zip(&mut numbers)
                .for_each(|(&value, number)| *number = T::of(value));
        }
    }
}

/// Calls `$solve` with the number of columns of a group as a constant.
macro_rules! with_columns {
    ($columns:expr, $solve:ident($($argument:expr),*)) => {
        match $columns {
            1 => $solve::<1, _>($($argument),*),
            2 => $solve::<2, _>($($argument),*),
            3 => $solve::<3, _>($($argument),*),
            _ => $solve::<GROUP, _>($($argument),*),
        }
    };
}

fn forward<T: Scalar>(mut l: &[T], rows: usize, columns: usize, x: &mut [f64]) {
    for start in (0..columns).step_by(GROUP) {
        let width = GROUP.min(columns - start);
        let (group, rest) = l.split_at((rows - start) * width);
        l = rest;
        with_columns!(width, forward_group(group, &mut x[start..]));
    }
}

fn backward<T: Scalar>(mut l: &[T], rows: usize, columns: usize, x: &mut [f64]) {
    for start in (0..columns).step_by(GROUP).rev() {
        let width = GROUP.min(columns - start);
        let (rest, group) = l.split_at(l.len() - (rows - start) * width);
        l = rest;
        with_columns!(width, backward_group(group, &mut x[start..]));
    }
}

fn forward_group<const W: usize, T: Scalar>(l: &[T], x: &mut [f64]) {
    let (diagonal, below) = l.as_chunks::<W>().0.split_at(W);
    let (own, others) = x.split_at_mut(W);
    for c in 0..W {
        (0..c).for_each(|k| own[c] -= diagonal[c][k].double() * own[k]);
        own[c] /= diagonal[c][c].double();
    }
    let solved: [f64; W] = std::array::from_fn(|c| own[c]);
    for (x, l) in others.iter_mut().zip(below) {
        *x -= (0..W).map(|c| l[c].double() * solved[c]).sum::<f64>();
    }
}

fn backward_group<const W: usize, T: Scalar>(l: &[T], x: &mut [f64]) {
    let (diagonal, below) = l.as_chunks::<W>().0.split_at(W);
    let (own, others) = x.split_at_mut(W);
    // Two sums per column let the processor overlap two rows.
    let mut sums = [[0.0; W]; 2];
    let (pairs, last) = below.as_chunks::<2>();
    let (x_pairs, x_last) = others.as_chunks::<2>();
    for (l, x) in pairs.iter().zip(x_pairs) {
        (0..W).for_each(|c| sums[0][c] += l[0][c].double() * x[0]);
        (0..W).for_each(|c| sums[1][c] += l[1][c].double() * x[1]);
    }
    for (l, x) in last.iter().zip(x_last) {
        (0..W).for_each(|c| sums[0][c] += l[c].double() * x);
    }
    for c in (0..W).rev() {
        let inner: f64 = (c + 1..W).map(|row| diagonal[row][c].double() * own[row]).sum();
        own[c] = (own[c] - (sums[0][c] + sums[1][c]) - inner) / diagonal[c][c].double();
    }
}
