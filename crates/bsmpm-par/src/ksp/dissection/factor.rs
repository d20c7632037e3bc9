//! Factorised columns as they are kept, and the triangular solves with them.
//!
//! A solution reads every number twice and does little else, so that memory decides how long it takes: four columns at a time are
//! kept from their first diagonal entry on, in single precision where that is enough. Products and sums are of double
//! precision, so that a solution is a linear function of the right-hand side, that of a stiffness near by.

/// Columns that are kept, and worked on, together.
const GROUP: usize = 4;

/// What a number of a factor is kept in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits
    #[default]
    Single,
    /// 64 bits
    Double,
}

/// Factorised columns of fronts, one after another.
#[derive(Debug)]
pub enum Factor {
    /// of single precision
    Single(Vec<f32>),
    /// of double precision
    Double(Vec<f64>),
}

impl Default for Factor {
    fn default() -> Self {
        Self::Single(Vec::new())
    }
}

impl Factor {
    /// Forgets its columns, and makes room for `entries` numbers; their memory is kept if the precision is.
    pub fn restart(&mut self, precision: Precision, entries: usize) {
        match (precision, &mut *self) {
            (Precision::Single, Self::Single(numbers)) => numbers.clear(),
            (Precision::Double, Self::Double(numbers)) => numbers.clear(),
            (Precision::Single, _) => *self = Self::Single(Vec::new()),
            (Precision::Double, _) => *self = Self::Double(Vec::new()),
        }
        match self {
            Self::Single(numbers) => numbers.reserve_exact(entries),
            Self::Double(numbers) => numbers.reserve_exact(entries),
        }
    }

    /// Adds the factorised `columns` of a front, `rows` long.
    pub fn keep(&mut self, columns: &[f64], rows: usize) {
        match self {
            Self::Single(numbers) => keep(columns, rows, numbers),
            Self::Double(numbers) => keep(columns, rows, numbers),
        }
    }

    /// Solves with `columns` of a front of order `rows`, which begin at the number `start`, for the first entries of `x`, and
    /// takes their part from the others.
    pub fn forward(&self, start: usize, (rows, columns): (usize, usize), x: &mut [f64]) {
        let range = start..start + entries(rows, columns);
        match self {
            Self::Single(numbers) => forward(&numbers[range], (rows, columns), x),
            Self::Double(numbers) => forward(&numbers[range], (rows, columns), x),
        }
    }

    /// Solves with the transpose of these columns for the first entries of `x`; the others are known.
    pub fn backward(&self, start: usize, (rows, columns): (usize, usize), x: &mut [f64]) {
        let range = start..start + entries(rows, columns);
        match self {
            Self::Single(numbers) => backward(&numbers[range], (rows, columns), x),
            Self::Double(numbers) => backward(&numbers[range], (rows, columns), x),
        }
    }
}

/// Numbers that are kept of `columns` of a front of order `rows`.
pub fn entries(rows: usize, columns: usize) -> usize {
    (0..columns).step_by(GROUP).map(|start| (rows - start) * GROUP.min(columns - start)).sum()
}

/// A number of a factor.
trait Number: Copy {
    fn of(value: f64) -> Self;
    fn double(self) -> f64;
}

impl Number for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self)
    }
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn double(self) -> f64 {
        self
    }
}

fn keep<T: Number>(columns: &[f64], rows: usize, numbers: &mut Vec<T>) {
    for (column, values) in columns.chunks_exact(rows.max(1)).enumerate() {
        numbers.extend(values[column - column % GROUP..].iter().map(|&value| T::of(value)));
    }
}

/// The groups of the columns `l` of a front of order `rows`: their first column, and the group.
fn groups<T>(mut l: &[T], (rows, columns): (usize, usize)) -> impl Iterator<Item = (usize, &[T])> {
    (0..columns).step_by(GROUP).map(move |start| {
        let (group, rest) = l.split_at((rows - start) * GROUP.min(columns - start));
        l = rest;
        (start, group)
    })
}

fn forward<T: Number>(l: &[T], (rows, columns): (usize, usize), x: &mut [f64]) {
    for (start, group) in groups(l, (rows, columns)) {
        let (rows, x) = (rows - start, &mut x[start..]);
        let width = group.len() / rows;
        let (solved, rest) = x.split_at_mut(width);
        for (c, column) in group.chunks_exact(rows).enumerate() {
            solved[c] /= column[c].double();
            (c + 1..width).for_each(|row| solved[row] -= solved[c] * column[row].double());
        }
        if let (&[a, b, c, d], Some(columns)) = (&*solved, four(group, rows)) {
            let [p, q, r, s] = columns;
            for (value, ((p, q), (r, s))) in rest.iter_mut().zip(p.iter().zip(q).zip(r.iter().zip(s))) {
                *value -= (a * p.double() + b * q.double()) + (c * r.double() + d * s.double());
            }
        } else {
            for (by, column) in solved.iter().zip(group.chunks_exact(rows)) {
                rest.iter_mut().zip(&column[width..]).for_each(|(value, l)| *value -= by * l.double());
            }
        }
    }
}

fn backward<T: Number>(l: &[T], (rows, columns): (usize, usize), x: &mut [f64]) {
    let mut end = l.len();
    for start in (0..columns).step_by(GROUP).rev() {
        let (rows, width) = (rows - start, GROUP.min(columns - start));
        let group = &l[end - rows * width..end];
        end -= rows * width;
        let (unsolved, below) = x[start..].split_at_mut(width);
        let mut taken = [0.0; GROUP];
        if let Some(columns) = four(group, rows) {
            taken = four_products(columns, below);
        } else {
            for (taken, column) in taken.iter_mut().zip(group.chunks_exact(rows)) {
                *taken = column[width..].iter().zip(&*below).map(|(l, x)| l.double() * x).sum();
            }
        }
        for c in (0..width).rev() {
            let column = &group[c * rows..][..width];
            let inner: f64 = (c + 1..width).map(|row| column[row].double() * unsolved[row]).sum();
            unsolved[c] = (unsolved[c] - taken[c] - inner) / column[c].double();
        }
    }
}

/// The columns of a whole group below its diagonal block.
fn four<T>(group: &[T], rows: usize) -> Option<[&[T]; GROUP]> {
    (group.len() == GROUP * rows).then(|| std::array::from_fn(|c| &group[c * rows + GROUP..(c + 1) * rows]))
}

/// Scalar products of four columns with `x`, in four interleaved sums each.
fn four_products<T: Number>(columns: [&[T]; GROUP], x: &[f64]) -> [f64; GROUP] {
    let mut sums = [[0.0; 4]; GROUP];
    let [a, b, c, d] = columns.map(|column| column.chunks_exact(4));
    let whole = x.chunks_exact(4);
    let (from, tail) = (x.len() - whole.remainder().len(), whole.remainder());
    for (x, ((a, b), (c, d))) in whole.zip(a.zip(b).zip(c.zip(d))) {
        for (sums, values) in sums.iter_mut().zip([a, b, c, d]) {
            (0..4).for_each(|lane| sums[lane] += values[lane].double() * x[lane]);
        }
    }
    std::array::from_fn(|k| {
        let rest: f64 = columns[k][from..].iter().zip(tail).map(|(l, x)| l.double() * x).sum();
        (sums[k][0] + sums[k][1]) + (sums[k][2] + sums[k][3]) + rest
    })
}
