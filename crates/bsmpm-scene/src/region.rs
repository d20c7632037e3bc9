//! The region that a body fills at the start of a run. In two dimensions straight edges and arcs bound this region.

mod cells;
mod edge;
mod extent;
mod lattice;
mod measure;
mod raster;
mod simple;
mod skin;
mod solid;
mod surface;
mod sweep;
mod volume;

pub(crate) use cells::{CellPlace, Lattice, RegionPart, of_cell};
pub(crate) use edge::Edge;
pub(crate) use extent::AxisExtent;
pub(crate) use raster::Raster;
pub(crate) use simple::{PolygonFault, area, bounds, fault};
pub(crate) use skin::skin;
pub(crate) use solid::{Section, SolidShape, plane};
pub(crate) use surface::{Surface, edges_of};
pub(crate) use sweep::{Window, solid, sweep};

pub(crate) use volume::{bounds as solid_bounds, left as left_of_box};

pub use volume::Volume;

use crate::Geometry;
use crate::grid::{GridAxis, GridSpec};
use cells::column;
use std::ops::Range;
use sweep::intervals;

/// Edges of one body at most.
pub(crate) const MOST_EDGES: usize = 10_000;
/// Columns of cells that a body other than a box spans at most: its points are counted by column.
const MOST_COLUMNS: usize = 2_000_000;
/// Edges, times the cells that they cut, times the points along a cell: what a body's points may cost before they are
/// refused, some ten seconds.
const MOST_WORK: u128 = 4_000_000_000;

/// What a body fills.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// A rectangle along the axes.
    Box {
        /// m  lower corner, in the case's coordinates
        lower: [f64; 2],
        /// m  upper corner
        upper: [f64; 2],
    },
    /// Another shape, or a shape with something cut out.
    Outline(Outline),
    /// A shape in space.
    Solid(Box<Volume>),
}

/// A shape of straight edges and arcs, less others.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    origin: [f64; 2], // m  the grid's lower corner, from which edges are measured
    edges: Vec<Edge>, // those of shape 0, which is filled, and of the others, which are cut out
    shapes: usize,
    geometry: Geometry,    // places its points
    bounds: [[f64; 2]; 2], // m  in the case's coordinates
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

impl Region {
    /// Lower and upper corner of the smallest rectangle around it, m, in the case's coordinates; around the whole
    /// shape where something is cut out, but for boxes that cut off a side. Of a shape in space the first two
    /// components.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Box { lower, upper } => [*lower, *upper],
            Self::Outline(outline) => outline.bounds,
            Self::Solid(volume) => volume.bounds().map(|[x, y, _]| [x, y]),
        }
    }

    /// The same with all components; 0 along an axis that there is not.
    pub fn corners(&self) -> [[f64; 3]; 2] {
        match self {
            Self::Solid(volume) => volume.bounds(),
            _ => self.bounds().map(|[x, y]| [x, y, 0.0]),
        }
    }

    /// Area, m²; of a shape in space its volume, m³.
    pub fn area(&self) -> f64 {
        match self {
            Self::Box { lower, upper } => (upper[0] - lower[0]) * (upper[1] - lower[1]),
            Self::Outline(outline) => outline.area,
            Self::Solid(volume) => volume.volume(),
        }
    }

    /// The part of it that lies in cells where one point stands for all as no lattice point is inside.
    pub(crate) fn alone(&self) -> f64 {
        match self {
            Self::Box { .. } => 0.0,
            Self::Outline(outline) => outline.tally.alone / outline.area,
            Self::Solid(volume) => volume.tally().alone / volume.volume(),
        }
    }

    /// Length of the vertical ray above `at` (m, in the case's coordinates) inside it, m. A left side belongs to it, a
    /// right one does not, so that a ray between two bodies counts once.
    pub(crate) fn above(&self, at: [f64; 3]) -> f64 {
        if let Self::Solid(volume) = self {
            return volume.above(at);
        }
        let pieces = self.vertical(at[0]).into_iter();
        pieces.map(|[lower, upper]| (upper - lower.max(at[1])).max(0.0)).sum()
    }

    /// Whether a place of a solid lies inside, m in the case's coordinates.
    pub(crate) fn contains_in_space(&self, at: [f64; 3]) -> bool {
        matches!(self, Self::Solid(volume) if volume.contains(at))
    }

    /// Whether a place lies inside, m in the case's coordinates.
    pub(crate) fn contains(&self, at: [f64; 2]) -> bool {
        self.vertical(at[0])
            .iter()
            .any(|[lower, upper]| *lower < at[1] && at[1] < *upper)
    }

    /// What it covers of the vertical line at `x`, in the case's coordinates, upwards.
    fn vertical(&self, x: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Box { lower, upper } if lower[0] <= x && x < upper[0] => vec![[lower[1], upper[1]]],
            Self::Box { .. } => Vec::new(),
            Self::Outline(outline) => {
                let found = intervals(&outline.edges, outline.shapes, x - outline.origin[0]);
                found
                    .into_iter()
                    .map(|ends| ends.map(|y| y + outline.origin[1]))
                    .collect()
            }
            Self::Solid(_) => Vec::new(), // in space there is more than one
        }
    }

    /// Its edges from the grid's lower corner.
    pub(crate) fn edges(&self, grid: &GridSpec) -> (Vec<Edge>, usize) {
        match self {
            Self::Box { lower, upper } => (rectangle(*lower, *upper, grid.corner(), 0), 1),
            Self::Outline(outline) => (outline.edges.clone(), outline.shapes),
            Self::Solid(_) => (Vec::new(), 0), // no edge of a plane is one of its
        }
    }
}

impl Outline {
    /// The shape within `bounds` (m, in the case's coordinates) and of `area` (m²), less what is cut out; `edges` from
    /// the grid's lower corner. Says in words what makes it too costly.
    pub(crate) fn new(
        edges: Vec<Edge>,
        shapes: usize,
        bounds: [[f64; 2]; 2],
        area: f64,
        grid: &GridSpec,
        geometry: Geometry,
        points_per_cell: usize,
    ) -> Result<Self, String> {
        affordable(&edges, grid, points_per_cell)?;
        let origin = grid.corner();
        let mut outline = Self {
            origin,
            edges,
            shapes,
            geometry,
            bounds,
            area,
            tally: CellTally::default(),
        };
        let columns = outline.columns(grid).len();
        if columns > MOST_COLUMNS {
            return Err(format!(
                "E0036: the shape is {columns} cells wide, but at most {MOST_COLUMNS} cells are possible. Use larger \
                 cells."
            ));
        }
        outline.count(grid, points_per_cell);
        Ok(outline)
    }

    /// Counts points and cells column by column; where something is cut out, the area is that of all cells' parts.
    fn count(&mut self, grid: &GridSpec, points_per_cell: usize) {
        let mut tally = CellTally::default();
        let mut total = 0_u64;
        let mut area = 0.0;
        for i in self.columns(grid) {
            let column = self.column(grid, points_per_cell, i);
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
                .fold(total, |sum, part| sum.saturating_add(part.points(points_per_cell)));
        }
        tally.before.push(total);
        if self.shapes > 1 {
            self.area = area;
        }
        self.tally = tally;
    }

    /// Columns of cells that it may reach into.
    fn columns(&self, grid: &GridSpec) -> Range<usize> {
        reached(&grid.axes[0], self.bounds.map(|corner| corner[0] - self.origin[0]))
    }

    pub(crate) fn tally(&self) -> &CellTally {
        &self.tally
    }

    /// The part of a column of cells.
    pub(crate) fn column(&self, grid: &GridSpec, points_per_cell: usize, i: usize) -> cells::CellColumn {
        column(&self.edges, self.shapes, grid, self.lattice(points_per_cell), i)
    }

    /// Its points in a cell.
    pub(crate) fn lattice(&self, points_per_cell: usize) -> Lattice {
        Lattice {
            n: points_per_cell,
            geometry: self.geometry,
        }
    }
}

/// The edges of a rectangle, from `origin`.
pub(crate) fn rectangle(lower: [f64; 2], upper: [f64; 2], origin: [f64; 2], shape: usize) -> Vec<Edge> {
    polygon(
        &[lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]],
        origin,
        shape,
    )
}

/// The edges of a polygon, from `origin`.
pub(crate) fn polygon(corners: &[[f64; 2]], origin: [f64; 2], shape: usize) -> Vec<Edge> {
    let places = corners
        .iter()
        .map(|corner| [0, 1].map(|axis| corner[axis] - origin[axis]));
    let next = places.clone().cycle().skip(1);
    places.zip(next).map(|(a, b)| Edge::line(a, b, shape)).collect()
}

/// Cells along an axis that an interval (m from the first) touches, those at whose ends it ends too.
fn reached(axis: &GridAxis, [lower, upper]: [f64; 2]) -> Range<usize> {
    let start = axis.first_cell(|i| axis.breakpoint(i + 1) >= lower);
    start..axis.first_cell(|i| axis.breakpoint(i) > upper).max(start)
}

fn affordable(edges: &[Edge], grid: &GridSpec, points_per_cell: usize) -> Result<(), String> {
    if edges.len() > MOST_EDGES {
        return Err(format!(
            "E0036: the shape, together with its cut-outs, has {} edges, but at most {MOST_EDGES} are possible. Use \
             fewer corners.",
            edges.len()
        ));
    }
    let cut = edges.iter().map(|edge| {
        let [x, y] = [[edge.a[0], edge.b[0]], edge.heights()];
        (reached(&grid.axes[0], x).len() + reached(&grid.axes[1], y).len()) as u128
    });
    let cells: u128 = cut.sum();
    if cells * edges.len() as u128 * points_per_cell as u128 > MOST_WORK {
        return Err(format!(
            "E0036: the {} edges of the shape cut about {cells} cells. Generating its material points would take too \
             long. Use fewer corners or larger cells.",
            edges.len()
        ));
    }
    Ok(())
}
