//! Active part of the grid: a box of cells around the material points. Nodes outside this box are not
//! stored.

use super::{Grid, KnotVector};
use crate::tensor::Vector;
use std::ops::Range;

/// Divisor of the points' extent that gives the reserve of the active domain on either side.
const SLACK: usize = 8;

impl<const D: usize> Grid<D> {
    /// Returns the box of cells (global ranges along each axis) that contains the points; `None` without points or if
    /// one is outside the grid.
    pub fn occupied(&self, x: &[Vector<D>]) -> Option<[Range<usize>; D]> {
        let mut found = std::array::from_fn(|_| 0..0);
        for (axis, range) in found.iter_mut().enumerate() {
            let along = x.iter().map(|x| x[axis]);
            let (least, most) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            *range = self.axes()[axis].cell_of(least)?..self.axes()[axis].cell_of(most)? + 1;
        }
        Some(found)
    }

    /// Returns whether the active domain contains all cells that points in the cells `occupied` couple with.
    pub fn has_room(&self, occupied: &[Range<usize>; D]) -> bool {
        let couples = coupled(self.order(), self.beyond());
        (0..D).all(|axis| {
            let needed = wider(&occupied[axis], couples, self.axes()[axis].cells());
            self.room()[axis].start <= needed.start && needed.end <= self.room()[axis].end
        })
    }

    /// Returns the same grid with an active domain for points in the cells `occupied`. It has at least `least` cells
    /// along the first two axes, if the grid does.
    pub fn with_room(&self, occupied: &[Range<usize>; D], least: [usize; 2]) -> Self {
        let cells = self.axes().each_ref().map(KnotVector::cells);
        self.within(around(occupied, cells, self.order(), self.beyond(), least))
    }

    /// Returns the same grid with at least `least` cells along the first two axes in its active domain, if the grid has
    /// them.
    pub fn with_columns(&self, least: [usize; 2]) -> Self {
        let mut room = self.room().clone();
        for (axis, wanted) in least.into_iter().enumerate() {
            room[axis] = at_least(wanted, &room[axis], self.axes()[axis].cells());
        }
        self.within(room)
    }
}

/// Returns the active domain for points in the cells `occupied` of a grid with `cells` cells along each axis, for
/// splines of degree `order` and `beyond` additional coupled layers. It has at least `least` cells along the first two
/// axes, but never more than the grid.
pub fn around<const D: usize>(
    occupied: &[Range<usize>; D],
    cells: [usize; D],
    order: usize,
    beyond: usize,
    least: [usize; 2],
) -> [Range<usize>; D] {
    let mut room: [Range<usize>; D] = std::array::from_fn(|axis| {
        let slack = (occupied[axis].len() / SLACK).max(order);
        wider(&occupied[axis], coupled(order, beyond) + slack, cells[axis])
    });
    for (axis, wanted) in least.into_iter().enumerate() {
        room[axis] = at_least(wanted, &room[axis], cells[axis]);
    }
    room
}

/// Extends a range to `wanted` cells, as far as the axis has them.
fn at_least(wanted: usize, range: &Range<usize>, cells: usize) -> Range<usize> {
    let end = (range.end + wanted.saturating_sub(range.len())).min(cells);
    range.start.min(end.saturating_sub(wanted))..end
}

/// Returns the number of cells by which the active domain must extend beyond the points. Surfaces use material whose
/// functions are non-zero in their cell, up to q cells away; some sums couple `beyond` further layers.
fn coupled(order: usize, beyond: usize) -> usize {
    order + beyond
}

fn wider(range: &Range<usize>, by: usize, cells: usize) -> Range<usize> {
    range.start.saturating_sub(by)..(range.end + by).min(cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_room_is_as_wide_as_what_is_coupled_and_a_part_of_the_extent() {
        assert_eq!(around(&[100..164, 3..5], [1000, 1000], 2, 1, [1; 2]), [89..175, 0..10]);
        assert_eq!(around(&[1..9, 0..20], [12, 20], 3, 0, [1; 2]), [0..12, 0..20]);
    }

    /// A plane grid of 40 x 20 cells.
    fn plane(beyond: usize) -> Grid<2> {
        let axis = |cells| KnotVector::uniform(1.0, cells, 2).unwrap();
        Grid::new([axis(40), axis(20)]).unwrap().reaching(beyond)
    }

    #[test]
    fn the_room_ends_where_points_couple_with_what_lies_outside() {
        let grid = plane(1).within([10..30, 5..20]);
        assert!(grid.has_room(&[13..27, 8..18])); // the upper end is the grid's
        for beyond in [[12..27, 8..18], [13..28, 8..18], [13..27, 7..18]] {
            assert!(!grid.has_room(&beyond), "{beyond:?}");
        }
        let made = grid.with_room(&[12..28, 7..18], [1; 2]);
        assert!(made.has_room(&[12..28, 7..18]) && made.room() != grid.room());
    }

    #[test]
    fn nodes_and_cells_of_a_room_are_those_of_the_grid() {
        let whole = plane(0);
        let part = whole.within([10..30, 5..12]).window(14..20);
        for node in 0..part.nodes() {
            let at = part.node_at(node);
            assert_eq!(
                (part.node_index(&at), part.number_of(node)),
                (Some(node), whole.node_index(&at).unwrap())
            );
        }
        assert!((0..part.cells()).all(|cell| part.cell_index(&part.cell_at(cell)) == cell));
        let held = (0..whole.nodes())
            .filter(|&node| part.node_index(&whole.node_at(node)).is_some())
            .count();
        assert_eq!((held, part.nodes()), (8 * 9, 8 * 9));
        let held = (0..whole.cells())
            .filter(|&cell| part.holds(&whole.cell_at(cell)))
            .count();
        assert_eq!((held, part.cells()), (6 * 7, 6 * 7));
    }

    #[test]
    fn there_is_a_column_for_every_rank_if_the_grid_has_one() {
        let columns = |from: usize, to: usize, wanted: usize| {
            let [columns, rows] = around(&[from..to, 3..4], [100, 8], 1, 0, [wanted, 1]);
            assert_eq!(rows, 1..6);
            columns
        };
        assert_eq!(columns(50, 51, 30), 48..78);
        assert_eq!(columns(97, 99, 30), 70..100);
        assert_eq!(columns(97, 99, 200), 0..100);
    }
}
