//! Extended B-splines: chooses the full cell to which a spline of nearly empty cells is tied, and its weights,
//! theory-manual equation (T2.11). Used by [`step::extension`](crate::step::extension).

use super::{Grid, KnotVector};

/// Which splines of nearly empty cells are tied to those of full cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExtendedSplines {
    /// None: all functions with material in their support are unknowns.
    #[default]
    Off,
    /// Outer functions: the displacement is extrapolated linearly from the nearest full cell (its home).
    Linear,
}

/// Largest distance, in cells along an axis, between an outer function's support and its home.
pub const REACH: usize = 3;

/// Resolution of the squared distance (in cells) by which equally near cells are ordered. Without it, round-off would
/// decide.
const RESOLUTION: f64 = 1e-6;

/// Distance between a cell and a function, compared field by field; the smallest is the nearest. The number of the cell
/// decides between equal distances.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Nearness {
    /// 1 if a C0 line (a repeated breakpoint) lies between the support and the cell, else 0.
    pub beyond_line: f64,
    /// Squared distance in cells between the support and the cell.
    pub apart: f64,
    /// Squared distance between the function's Greville abscissa and the centre of the cell, in edges of the cell,
    /// divided by the resolution and rounded.
    pub off_centre: f64,
    /// Number of the cell in the whole grid.
    pub cell: f64,
}

/// Rules for the home cells of outer functions: C0 lines and faces of the grid.
#[derive(Clone, Debug)]
pub struct Homes<const D: usize> {
    sides: [Vec<usize>; D],     // per cell along the axis: number of C0 lines before it
    kept_faces: [[bool; 2]; D], // lower and upper: functions on the face have homes only at it
}

impl<const D: usize> Homes<D> {
    /// Creates the rules for `grid`. Functions on a face in `kept_faces` (lower and upper of each axis) have homes only
    /// in the cells at that face.
    pub fn of(grid: &Grid<D>, kept_faces: [[bool; 2]; D]) -> Self {
        Self {
            sides: grid.axes().each_ref().map(sides),
            kept_faces,
        }
    }

    /// Returns the distance between a function and a cell (both global, along each axis). Returns `None` if the cell
    /// cannot be the function's home: too far away, without length, or not at a face that the function must keep to.
    pub fn nearness(&self, grid: &Grid<D>, function: &[usize; D], cell: &[usize; D]) -> Option<Nearness> {
        let mut is_on_side = true;
        let mut apart = 0;
        let mut off_centre = 0.0;
        let mut number = 0;
        for axis in 0..D {
            let knots = &grid.axes()[axis];
            let j = function[axis];
            let l = cell[axis];
            let steps = if j < l {
                l - j
            } else {
                j.saturating_sub(l + knots.order())
            };
            if steps > REACH || !knots.has_length(l) || !self.keeps_to_faces(knots, axis, j, l) {
                return None;
            }
            is_on_side &= self.is_on_side(knots, axis, j, l);
            apart += steps * steps;
            let lower = knots.breakpoint(l);
            let upper = knots.breakpoint(l + 1);
            off_centre += ((knots.greville(j) - 0.5 * (lower + upper)) / (upper - lower)).powi(2);
            number = number * knots.cells() + l;
        }
        let off_centre = (off_centre / RESOLUTION).round();
        let beyond_line = f64::from(u8::from(!is_on_side));
        Some(Nearness {
            beyond_line,
            apart: apart as f64,
            off_centre,
            cell: number as f64,
        })
    }

    /// Returns whether no C0 line lies between the support of function `j` and cell `l`.
    fn is_on_side(&self, knots: &KnotVector, axis: usize, j: usize, l: usize) -> bool {
        let support = j.saturating_sub(knots.order())..(j + 1).min(knots.cells());
        let mut with_length = support.filter(|&cell| knots.has_length(cell));
        let Some(first) = with_length.next() else { return false };
        let last = with_length.next_back().unwrap_or(first);
        let sides = &self.sides[axis];
        (sides[first]..=sides[last]).contains(&sides[l])
    }

    fn keeps_to_faces(&self, knots: &KnotVector, axis: usize, j: usize, l: usize) -> bool {
        let [lower, upper] = self.kept_faces[axis];
        let leaves_lower = lower && j == 0 && l != 0;
        let leaves_upper = upper && j + 1 == knots.functions() && l + 1 != knots.cells();
        !leaves_lower && !leaves_upper
    }
}

/// Returns for each cell of an axis the number of C0 lines before it. A C0 line is a breakpoint of multiplicity q; q -
/// 1 cells of zero length lie between its copies. Linear splines are C0 everywhere, so no lines are counted.
fn sides(knots: &KnotVector) -> Vec<usize> {
    let mut lines = 0;
    let mut without_length = 0;
    let mut sides = Vec::with_capacity(knots.cells());
    for cell in 0..knots.cells() {
        if knots.has_length(cell) {
            without_length = 0;
        } else {
            without_length += 1;
            lines += usize::from(without_length + 1 == knots.order());
        }
        sides.push(lines);
    }
    sides
}

/// Returns e_ij along one axis: the weights by which function `j` depends on the q + 1 functions of cell `home`.
pub fn weights(knots: &KnotVector, j: usize, home: usize) -> Vec<f64> {
    let functions = home..=home + knots.order();
    if functions.contains(&j) {
        return functions.map(|i| f64::from(u8::from(i == j))).collect();
    }
    match knots.order() {
        1 => tangent::<2>(knots, j, home),
        2 => tangent::<3>(knots, j, home),
        _ => tangent::<4>(knots, j, home),
    }
}

/// Returns the weights of function `j`: each of the W functions of cell `home`, extrapolated linearly to the Greville
/// abscissa of `j`.
fn tangent<const W: usize>(knots: &KnotVector, j: usize, home: usize) -> Vec<f64> {
    let abscissa = knots.greville(j);
    let nearest = abscissa.clamp(knots.breakpoint(home), knots.breakpoint(home + 1));
    let (N, dN) = knots.basis::<W>(nearest, home);
    N.iter().zip(dN).map(|(N, dN)| N + dN * (abscissa - nearest)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graded(order: usize) -> KnotVector {
        KnotVector::graded(&[0.0, 1.0, 1.5, 1.9, 2.5, 4.0, 5.0, 6.5, 7.0], order).unwrap()
    }

    #[test]
    fn weights_keep_linear_fields_on_open_graded_knots_of_every_order() {
        for order in 1..=3 {
            let knots = graded(order);
            for (j, home) in (0..knots.functions()).flat_map(|j| (0..knots.cells()).map(move |home| (j, home))) {
                let weights = weights(&knots, j, home);
                let sum: f64 = weights.iter().sum();
                let place: f64 = weights
                    .iter()
                    .enumerate()
                    .map(|(a, w)| w * knots.greville(home + a))
                    .sum();
                let size: f64 = weights.iter().map(|w| w.abs()).sum();
                assert!((sum - 1.0).abs() <= 1e-14 * size, "{order} {j} {home}: {sum}");
                assert!(
                    (place - knots.greville(j)).abs() <= 1e-13 * size,
                    "{order} {j} {home}: {place}"
                );
            }
        }
    }

    #[test]
    fn on_uniform_knots_a_quadratic_function_goes_on_from_the_two_nearest_ones() {
        let knots = KnotVector::uniform(0.5, 12, 2).unwrap();
        for steps in 1..=REACH {
            let far = steps as f64;
            let close = |found: Vec<f64>, expected: [f64; 3]| {
                found
                    .iter()
                    .zip(expected)
                    .for_each(|(found, expected)| assert!((found - expected).abs() < 1e-13));
            };
            close(weights(&knots, 5 + 2 + steps, 5), [0.0, -far, 1.0 + far]);
            close(weights(&knots, 5 - steps, 5), [1.0 + far, -far, 0.0]);
        }
    }

    #[test]
    fn homes_beyond_a_c0_line_come_last_but_for_the_function_on_it() {
        // Cells 0 1 2 | 4 5 6, the line at 3 with a cell without length, number 3, between its copies.
        let knots = KnotVector::graded(&[0.0, 1.0, 2.0, 3.0, 3.0, 4.0, 5.0, 6.0], 2).unwrap();
        assert_eq!(sides(&knots), [0, 0, 0, 1, 1, 1, 1]);
        let grid = Grid::new([knots.clone(), knots.clone()]).unwrap();
        let homes = Homes::of(&grid, [[false; 2]; 2]);
        let is_beyond = |j: usize, l: usize| homes.nearness(&grid, &[j, 3], &[l, 2]).unwrap().beyond_line == 1.0;
        // Function 3 ends at the line, function 4 is on it, function 5 begins there.
        assert_eq!([2, 4].map(|l| is_beyond(3, l)), [false, true]);
        assert_eq!([2, 4].map(|l| is_beyond(4, l)), [false, false]);
        assert_eq!([2, 4].map(|l| is_beyond(5, l)), [true, false]);
        let [own_side, other_side] = [0, 4].map(|l| homes.nearness(&grid, &[3, 3], &[l, 2]).unwrap());
        assert!(own_side < other_side, "though the other one is nearer");
        assert!(
            homes.nearness(&grid, &[4, 3], &[3, 2]).is_none(),
            "a cell without length"
        );
        let linear = KnotVector::uniform(1.0, 4, 1).unwrap();
        assert_eq!(sides(&linear), [0; 4]);
    }

    #[test]
    fn homes_are_near_and_keep_to_faces_where_they_must() {
        let knots = KnotVector::uniform(1.0, 9, 2).unwrap();
        let grid = Grid::new([knots.clone(), knots]).unwrap();
        let anywhere = Homes::of(&grid, [[false; 2]; 2]);
        let at_faces = Homes::of(&grid, [[true, false], [false, true]]);
        assert!(anywhere.nearness(&grid, &[0, 4], &[3, 4]).is_some());
        assert!(anywhere.nearness(&grid, &[0, 4], &[4, 4]).is_none(), "four cells away");
        assert!(
            at_faces.nearness(&grid, &[0, 4], &[1, 4]).is_none(),
            "off the lower face of axis 0"
        );
        assert!(at_faces.nearness(&grid, &[0, 10], &[0, 8]).is_some());
        assert!(
            at_faces.nearness(&grid, &[0, 10], &[0, 7]).is_none(),
            "off the upper face of axis 1"
        );
        let [near, far] = [[4, 5], [3, 5]].map(|cell| anywhere.nearness(&grid, &[7, 5], &cell).unwrap());
        assert!(near < far);
    }
}
