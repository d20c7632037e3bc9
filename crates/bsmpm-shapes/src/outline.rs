//! A region of the plane with straight edges and arcs, and other shapes cut out of it.

use crate::axis::{GridAxis, corner, reached};
use crate::cells::{self, CellPlace, Lattice, RegionPart, of_cell};
use crate::edge::Edge;
use crate::error::ShapeError;
use crate::sweep::intervals;
use std::ops::Range;

/// Largest number of edges of one body.
pub const MOST_EDGES: usize = 10_000;
/// Largest number of columns of cells that a body other than a box spans: its points are counted by column.
pub const MOST_COLUMNS: usize = 2_000_000;
/// Limit of the cost of making the material points of a body, about ten seconds: edges, times the cells that they cut,
/// times the points along a cell.
pub(crate) const MOST_WORK: u128 = 4_000_000_000;

/// A shape of straight edges and arcs with cut-outs.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    origin: [f64; 2], // m  the grid's lower corner, from which edges are measured
    edges: Vec<Edge>, // those of shape 0, which is filled, and of the others, which are cut out
    shapes: usize,
    bounds: [[f64; 2]; 2], // m  in the coordinates of the grid's breakpoints
    area: f64,
    tally: CellTally,
}

/// Points and cells of an outline, counted once.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CellTally {
    /// cells that hold points, per axis
    pub(crate) occupied: [Range<usize>; 2],
    /// of the first column in `occupied` and all later ones: number of the body's points before it; and of all
    pub(crate) before: Vec<u64>,
    /// cells that hold points
    pub(crate) cells: u64,
    /// m²  what cells have where one point stands for all as no lattice point is inside
    pub(crate) alone: f64,
}

impl Outline {
    /// Returns an outline with the points of a lattice in the cells of a grid.
    ///
    /// `edges` are those of shape 0, which is filled, and of shapes 1 to `shapes` - 1, which are cut out (m from the
    /// lower corner of the grid). `bounds` are the lower and upper corner of a rectangle around the outline (m), in
    /// the coordinates of the breakpoints. `area` is that of shape 0 (m²).
    ///
    /// # Errors
    /// If the outline has too many edges, or its points would take too long to make.
    pub fn new(
        edges: Vec<Edge>,
        shapes: usize,
        bounds: [[f64; 2]; 2],
        area: f64,
        axes: &[GridAxis],
        lattice: Lattice,
    ) -> Result<Self, ShapeError> {
        affordable(&edges, axes, lattice.n)?;
        let origin = corner(axes);
        let mut outline = Self {
            origin,
            edges,
            shapes,
            bounds,
            area,
            tally: CellTally::default(),
        };
        let columns = outline.columns(axes).len();
        if columns > MOST_COLUMNS {
            return Err(ShapeError::TooManyColumns { columns });
        }
        outline.count(axes, lattice);
        Ok(outline)
    }

    /// Returns the area (m²).
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Lower and upper corner of the rectangle around it (m).
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        self.bounds
    }

    /// Its edges, and those of its cut-outs.
    pub(crate) fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Number of shapes: itself and its cut-outs.
    pub(crate) fn shapes(&self) -> usize {
        self.shapes
    }

    /// Intervals of the vertical line at `x` (m) inside, upwards.
    pub(crate) fn vertical(&self, x: f64) -> Vec<[f64; 2]> {
        let found = intervals(&self.edges, self.shapes, x - self.origin[0]);
        found.into_iter().map(|ends| ends.map(|y| y + self.origin[1])).collect()
    }

    /// Counts points and cells column by column; where something is cut out, the area is that of all cells' parts.
    fn count(&mut self, axes: &[GridAxis], lattice: Lattice) {
        let mut tally = CellTally::default();
        let mut total = 0_u64;
        let mut area = 0.0;
        for i in self.columns(axes) {
            let column = self.column(axes, lattice, i);
            area += column.area;
            let Some(rows) = column.rows() else { continue };
            if tally.before.is_empty() {
                tally.occupied = [i..i, rows.clone()];
            }
            let [columns, all_rows] = &mut tally.occupied;
            *all_rows = all_rows.start.min(rows.start)..all_rows.end.max(rows.end);
            tally.before.extend(std::iter::repeat_n(total, i + 1 - columns.end));
            columns.end = i + 1;
            tally.cells += column.parts.iter().map(|part| part.rows().len() as u64).sum::<u64>();
            tally.alone += column.alone;
            total = column
                .parts
                .iter()
                .fold(total, |sum, part| sum.saturating_add(part.points(lattice.n)));
        }
        tally.before.push(total);
        if self.shapes > 1 {
            self.area = area;
        }
        self.tally = tally;
    }

    /// Columns of cells that it may reach into.
    fn columns(&self, axes: &[GridAxis]) -> Range<usize> {
        reached(&axes[0], self.bounds.map(|corner| corner[0] - self.origin[0]))
    }

    pub(crate) fn tally(&self) -> &CellTally {
        &self.tally
    }

    /// The part of a column of cells.
    fn column(&self, axes: &[GridAxis], lattice: Lattice, i: usize) -> cells::CellColumn {
        cells::column(&self.edges, self.shapes, axes, lattice, i)
    }

    /// The points of a column of cells, from the lowest cell upwards.
    pub(crate) fn points_of_column(
        &self,
        axes: &[GridAxis],
        lattice: Lattice,
        i: usize,
    ) -> impl Iterator<Item = CellPlace> {
        let x = [axes[0].breakpoint(i), axes[0].breakpoint(i + 1)];
        let parts = self.column(axes, lattice, i).parts.into_iter();
        parts.flat_map(move |part| {
            let (whole, cut) = match part {
                RegionPart::Whole(rows) => (rows, Vec::new()),
                RegionPart::Cut(_, places) => (0..0, places),
            };
            let of_whole = whole.flat_map(move |j| {
                let y = [axes[1].breakpoint(j), axes[1].breakpoint(j + 1)];
                of_cell(lattice, [x, y])
            });
            of_whole.chain(cut)
        })
    }

    /// The points in the cells `columns` along axis 0, each with its number.
    pub(crate) fn places<'a>(
        &'a self,
        axes: &'a [GridAxis],
        lattice: Lattice,
        columns: Range<usize>,
    ) -> impl Iterator<Item = (u64, CellPlace)> + 'a {
        let occupied = &self.tally.occupied[0];
        let columns = occupied.start.max(columns.start)..occupied.end.min(columns.end);
        columns.flat_map(move |i| {
            let first = self.tally.before[i - occupied.start];
            (first..).zip(self.points_of_column(axes, lattice, i))
        })
    }
}

fn affordable(edges: &[Edge], axes: &[GridAxis], points_per_cell: usize) -> Result<(), ShapeError> {
    if edges.len() > MOST_EDGES {
        return Err(ShapeError::TooManyEdges { edges: edges.len() });
    }
    let cut = edges.iter().map(|edge| {
        let [x, y] = [[edge.a[0], edge.b[0]], edge.heights()];
        (reached(&axes[0], x).len() + reached(&axes[1], y).len()) as u128
    });
    let cells: u128 = cut.sum();
    if cells * edges.len() as u128 * points_per_cell as u128 > MOST_WORK {
        return Err(ShapeError::TooManyCutCells {
            edges: edges.len(),
            cells,
        });
    }
    Ok(())
}
