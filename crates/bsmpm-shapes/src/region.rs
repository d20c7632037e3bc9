//! The region that a body fills, and the cells and material points in it.

use crate::axis::{GridAxis, corner};
use crate::cells::{CellPlace, Lattice, of_cell};
use crate::edge::Edge;
use crate::extent::AxisExtent;
use crate::outline::Outline;
use crate::polygon::rectangle;
use crate::volume::Volume;
use std::ops::Range;

/// The region that a body fills. Its corners, and the positions that its functions take, are in the coordinates of the
/// grid's breakpoints; a function says so where it uses the distance from the lower corner of the grid instead.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// A rectangle along the axes.
    Box {
        /// Lower corner (m).
        lower: [f64; 2],
        /// Upper corner (m).
        upper: [f64; 2],
    },
    /// Another plane shape, or one with cut-outs.
    Outline(Outline),
    /// A shape in 3-D.
    Solid(Box<Volume>),
}

impl Region {
    /// Returns the lower and upper corner of a rectangle around the region (m); for a shape in 3-D the first two
    /// components. Cut-outs reduce the rectangle only if they are boxes that cut off a whole side.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Box { lower, upper } => [*lower, *upper],
            Self::Outline(outline) => outline.bounds(),
            Self::Solid(volume) => volume.bounds().map(|[x, y, _]| [x, y]),
        }
    }

    /// Returns the same with three components; the third is 0 for a plane shape.
    pub fn corners(&self) -> [[f64; 3]; 2] {
        match self {
            Self::Solid(volume) => volume.bounds(),
            _ => self.bounds().map(|[x, y]| [x, y, 0.0]),
        }
    }

    /// Returns the area (m²), for a shape in 3-D the volume (m³).
    pub fn area(&self) -> f64 {
        match self {
            Self::Box { lower, upper } => (upper[0] - lower[0]) * (upper[1] - lower[1]),
            Self::Outline(outline) => outline.area(),
            Self::Solid(volume) => volume.volume(),
        }
    }

    /// Returns the fraction of the region in cells with a single material point, because the region covers no lattice
    /// point of the cell.
    pub fn alone(&self) -> f64 {
        match self {
            Self::Box { .. } => 0.0,
            Self::Outline(outline) => outline.tally().alone / outline.area(),
            Self::Solid(volume) => volume.tally().alone / volume.volume(),
        }
    }

    /// Returns the length of the part of the vertical ray above a position (m) inside the region (m). The left side
    /// belongs to the region and the right side does not, so that a ray between two bodies counts once.
    pub fn above(&self, at: [f64; 3]) -> f64 {
        if let Self::Solid(volume) = self {
            return volume.above(at);
        }
        let pieces = self.vertical(at[0]).into_iter();
        pieces.map(|[lower, upper]| (upper - lower.max(at[1])).max(0.0)).sum()
    }

    /// Returns whether a position (m) is inside a 3-D region; false for a plane region.
    pub fn contains_in_space(&self, at: [f64; 3]) -> bool {
        matches!(self, Self::Solid(volume) if volume.contains(at))
    }

    /// Returns whether a position (m) is inside a plane region; false for a 3-D region.
    pub fn contains(&self, at: [f64; 2]) -> bool {
        self.vertical(at[0])
            .iter()
            .any(|[lower, upper]| *lower < at[1] && at[1] < *upper)
    }

    /// Intervals of the vertical line at `x` (m) inside a plane region, upwards.
    fn vertical(&self, x: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Box { lower, upper } if lower[0] <= x && x < upper[0] => vec![[lower[1], upper[1]]],
            Self::Box { .. } => Vec::new(),
            Self::Outline(outline) => outline.vertical(x),
            Self::Solid(_) => Vec::new(), // a plane has one vertical line at x, space has many
        }
    }

    /// Returns the edges of a plane region (m from the lower corner of the grid) and the number of its shapes; none for
    /// a 3-D region. Shape 0 is filled and the others are cut out of it.
    pub fn edges(&self, axes: &[GridAxis]) -> (Vec<Edge>, usize) {
        match self {
            Self::Box { lower, upper } => (rectangle(*lower, *upper, corner(axes), 0), 1),
            Self::Outline(outline) => (outline.edges().to_vec(), outline.shapes()),
            Self::Solid(_) => (Vec::new(), 0),
        }
    }

    /// Cells along both axes that the region reaches into, if it is a box.
    fn extents<'a>(&self, axes: &'a [GridAxis]) -> Option<[AxisExtent<'a>; 2]> {
        let Self::Box { lower, upper } = self else {
            return None;
        };
        Some([0, 1].map(|axis| AxisExtent::new(&axes[axis], lower[axis], upper[axis])))
    }

    /// Returns for each axis the range from the first to the last cell that holds material points.
    pub fn occupied(&self, axes: &[GridAxis]) -> Vec<Range<usize>> {
        match self {
            Self::Outline(outline) => outline.tally().occupied.to_vec(),
            Self::Solid(volume) => volume.tally().occupied.to_vec(),
            Self::Box { .. } => self
                .extents(axes)
                .into_iter()
                .flatten()
                .map(|extent| extent.cells)
                .collect(),
        }
    }

    /// Returns the number of cells that hold material points.
    pub fn cells(&self, axes: &[GridAxis]) -> u128 {
        match self {
            Self::Outline(outline) => outline.tally().cells.into(),
            Self::Solid(volume) => volume.tally().cells.into(),
            Self::Box { .. } => self.occupied(axes).iter().map(|cells| cells.len() as u128).product(),
        }
    }

    /// Returns the number of material points, with `n` along each axis of a cell.
    pub fn points(&self, axes: &[GridAxis], n: usize) -> u128 {
        match self {
            Self::Outline(outline) => outline.tally().before.last().copied().unwrap_or(0).into(),
            Self::Solid(volume) => volume.tally().before.last().copied().unwrap_or(0).into(),
            Self::Box { .. } => self.cells(axes) * (n as u128).pow(2),
        }
    }

    /// Returns the number of material points in each column of cells along axis 0 from the first to the last that holds
    /// any, with `n` along each axis of a cell.
    pub fn points_by_column(&self, axes: &[GridAxis], n: usize) -> Vec<u64> {
        let before = match self {
            Self::Box { .. } => {
                let occupied = self.occupied(axes);
                let in_column = (occupied[1].len() * n * n) as u64;
                return vec![in_column; occupied[0].len()];
            }
            Self::Outline(outline) => &outline.tally().before,
            Self::Solid(volume) => &volume.tally().before,
        };
        before.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    /// Returns the material points of a plane region in the cells `columns` along axis 0, each with its number within
    /// the region. Numbers count cell by cell and point by point, axis 0 slowest; they do not depend on `columns`. A
    /// 3-D region gives none; see [`Volume::places`].
    pub fn places<'a>(
        &'a self,
        axes: &'a [GridAxis],
        lattice: Lattice,
        columns: Range<usize>,
    ) -> impl Iterator<Item = (u64, CellPlace)> + 'a {
        let extents = self.extents(axes).into_iter();
        let box_columns = columns.clone();
        let of_box = extents.flat_map(move |extents| places_of_box(extents, lattice, box_columns.clone()));
        let outline = match self {
            Self::Outline(outline) => Some(outline),
            _ => None,
        };
        let of_outline = outline
            .into_iter()
            .flat_map(move |outline| outline.places(axes, lattice, columns.clone()));
        of_box.chain(of_outline)
    }
}

/// The material points of a box in some columns of cells, each with its number.
fn places_of_box(
    [across, up]: [AxisExtent<'_>; 2],
    lattice: Lattice,
    columns: Range<usize>,
) -> impl Iterator<Item = (u64, CellPlace)> {
    let in_cell = (lattice.n * lattice.n) as u64;
    let cells = across.cells.start.max(columns.start)..across.cells.end.min(columns.end);
    cells.flat_map(move |i| {
        let x = across.part(i);
        let row = (i - across.cells.start) * up.cells.len();
        let up = up.clone();
        up.cells.clone().flat_map(move |j| {
            let cell = (row + (j - up.cells.start)) as u64;
            (cell * in_cell..).zip(of_cell(lattice, [x, up.part(j)]))
        })
    })
}
