//! B-splines of degree q in one dimension, theory-manual equations (T2.1) to (T2.3), on an open knot vector. All q + 1
//! functions of a cell are stored, because on a knot a function can vanish while its derivative does not.
//!
//! A breakpoint of multiplicity m is followed by m - 1 cells of zero length. Therefore function `a` of cell `c` has the
//! number `c + a`.

use crate::error::GridError;

/// Largest supported degree.
pub const MAX_ORDER: usize = 3;
/// Shortest cell and longest axis (m): volumes, and products of derivatives, stay within the range of f64.
const SHORTEST: f64 = 1e-100;
const LONGEST: f64 = 1e100;

/// Open knot vector: breakpoints from 0 to the length of the axis. The end knots occur q + 1 times (Eq. 3), the others
/// up to q times.
#[derive(Clone, Debug, PartialEq)]
pub struct KnotVector {
    order: usize,
    knots: Vec<f64>,           // m, with repeated end knots
    inverse_cell: Option<f64>, // 1/m, of uniform breakpoints
}

impl KnotVector {
    /// Creates `cells` equal cells of length `cell` (m) for splines of degree `order`. Fails if the degree is not
    /// supported, if there is no cell, or if the length is invalid.
    pub fn uniform(cell: f64, cells: usize, order: usize) -> Result<Self, GridError> {
        let breakpoints: Vec<f64> = (0..=cells).map(|i| i as f64 * cell).collect();
        let mut axis = Self::graded(&breakpoints, order)?;
        axis.inverse_cell = Some(1.0 / cell);
        Ok(axis)
    }

    /// Creates cells between `breakpoints` (m), which must not decrease; an inner breakpoint may occur up to q times.
    /// Positions count from the first. Fails as [`KnotVector::uniform`] does, and if a distance is shorter than 1e-100
    /// m.
    pub fn graded(breakpoints: &[f64], order: usize) -> Result<Self, GridError> {
        if !(1..=MAX_ORDER).contains(&order) {
            return Err(GridError::Order(order));
        }
        let &[from, .., last] = breakpoints else {
            return Err(GridError::Breakpoints);
        };
        let length = last - from;
        let mut knots = vec![0.0; order];
        knots.extend(breakpoints.iter().map(|x| x - from));
        let increasing = knots[order..]
            .windows(2)
            .all(|pair| pair[1] - pair[0] >= SHORTEST || pair[1] == pair[0]);
        if !increasing || length.is_nan() || length > LONGEST {
            return Err(GridError::Breakpoints);
        }
        knots.extend(std::iter::repeat_n(length, order));
        // One copy more than q, or a repeated end, would make the splines discontinuous.
        if (1..knots.len() - order - 1).any(|i| knots[i] == knots[i + order]) {
            return Err(GridError::Breakpoints);
        }
        Ok(Self {
            order,
            knots,
            inverse_cell: None,
        })
    }

    /// Returns the polynomial degree q.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Returns knot `i` of n + q + 1 (m).
    pub fn knot(&self, i: usize) -> f64 {
        self.knots[i]
    }

    /// Returns the number of cells, including those of zero length between the copies of a breakpoint.
    pub fn cells(&self) -> usize {
        self.knots.len() - 1 - 2 * self.order
    }

    /// Returns the number n of functions: cells + q.
    pub fn functions(&self) -> usize {
        self.cells() + self.order
    }

    /// Returns whether a cell has a length. A cell without length lies between two copies of a breakpoint and contains
    /// no points.
    pub fn has_length(&self, cell: usize) -> bool {
        self.breakpoint(cell) < self.breakpoint(cell + 1)
    }

    /// Returns breakpoint `i`, from 0 to the number of cells (m).
    pub fn breakpoint(&self, i: usize) -> f64 {
        self.knots[i + self.order]
    }

    /// Returns the length of the axis (m).
    pub fn length(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// Returns the Greville abscissa of function `i`, the mean of its inner knots (m).
    pub fn greville(&self, i: usize) -> f64 {
        self.knots[i + 1..=i + self.order].iter().sum::<f64>() / self.order as f64
    }

    /// Returns the Greville abscissa of function `i` of the splines of degree q - 1 on the same cells (m), for q > 1.
    pub fn lowered_greville(&self, i: usize) -> f64 {
        self.knots[i + 2..=i + self.order].iter().sum::<f64>() / (self.order - 1) as f64
    }

    /// Returns the integral of function `i` of the splines of degree q - 1 on the same cells (the length of its support
    /// divided by q), and its centroid (the mean of its knots), both in m. Function `a` of cell `c` has the number `c +
    /// a` (Curry and Schoenberg, 1966, J. Anal. Math. 17, 71-107).
    pub fn lowered_integral(&self, i: usize) -> (f64, f64) {
        let knots = &self.knots[i + 1..=i + self.order + 1];
        let length = (knots[self.order] - knots[0]) / self.order as f64;
        (length, knots.iter().sum::<f64>() / knots.len() as f64)
    }

    /// Returns the length of the shortest cell that has a length (m).
    pub fn smallest_cell(&self) -> f64 {
        let lengths = (0..self.cells()).map(|i| self.breakpoint(i + 1) - self.breakpoint(i));
        lengths.filter(|length| *length > 0.0).fold(f64::INFINITY, f64::min)
    }

    /// Returns the cell with a length that contains `x` (m); `None` outside the axis. The last cell is closed, so that
    /// x = length has shape functions.
    #[inline]
    pub fn cell_of(&self, x: f64) -> Option<usize> {
        if !(0.0..=self.length()).contains(&x) {
            return None;
        }
        let last = self.cells() - 1;
        let guess = match self.inverse_cell {
            Some(inverse) => (x * inverse) as usize,
            None => self.knots[self.order..=self.order + last].partition_point(|&knot| knot <= x) - 1,
        };
        let mut cell = guess.min(last);
        // A rounded quotient may be one cell off at a breakpoint; the half-open spans of Eq. 4 decide.
        if x < self.breakpoint(cell) {
            cell -= 1;
        } else if cell < last && x >= self.breakpoint(cell + 1) {
            cell += 1;
        }
        Some(cell)
    }

    /// Computes the W functions of `cell` at `x` (m) and their derivatives (Eqs 4-6). Function `a` has the number `cell
    /// + a`. N is dimensionless, dN/dx is in 1/m.
    ///
    /// The degree W - 1 is q or less. The open splines of a lower degree have the same knots, with fewer copies of the
    /// ends. The Cox-de Boor recursion runs only over the functions of this span.
    #[inline]
    pub fn basis<const W: usize>(&self, x: f64, cell: usize) -> ([f64; W], [f64; W]) {
        debug_assert!((1..=self.order + 1).contains(&W));
        let span = cell + self.order;
        let q = W - 1;
        let knots = &self.knots[span + 1 - q..=span + q];
        let mut N = [0.0; W];
        let mut lower = [0.0; W];
        N[0] = 1.0;
        // With t the knots of the axis and s the span (t_s <= x <= t_(s+1)), knots[i] = t_(s+1-q+i). Before the step to
        // degree d, the support of N[r] is from t_(s+1-d+r) to t_(s+1+r): from knots[q-d+r] to knots[q+r].
        for degree in 1..=q {
            if degree == q {
                lower = N;
            }
            let mut saved = 0.0;
            for r in 0..degree {
                let left = knots[q - degree + r];
                let right = knots[q + r];
                let ratio = N[r] / (right - left);
                N[r] = saved + (right - x) * ratio;
                saved = (x - left) * ratio;
            }
            N[degree] = saved;
        }
        let mut dN = [0.0; W];
        for r in 0..q {
            let slope = q as f64 * lower[r] / (knots[q + r] - knots[r]);
            dN[r] -= slope;
            dN[r + 1] += slope;
        }
        (N, dN)
    }
}
