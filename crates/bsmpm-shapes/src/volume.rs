//! The region of a 3-D body: a cuboid, an extruded outline or another shape.

use crate::axis::{GridAxis, corner, reached};
use crate::cells::{CellPlace, Lattice, place};
use crate::edge::Edge;
use crate::error::ShapeError;
use crate::extent::{AxisExtent, left_of_box};
use crate::lattice::{self, LINES};
use crate::measure;
use crate::outline::{MOST_WORK, Outline};
use crate::solid::{SolidShape, less, plane};
use std::ops::Range;

/// A shape in 3-D with cut-outs, and the material points in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    origin: [f64; 3], // m  the grid's lower corner, from which shapes are measured
    whole: SolidShape,
    cut: Vec<SolidShape>,
    bounds: [[f64; 3]; 2], // m  lower and upper corner of the cuboid around it
    filling: FillPattern,
    volume: f64, // m³
    tally: SlabTally,
}

/// How it is filled with points.
#[derive(Clone, Debug, PartialEq)]
enum FillPattern {
    /// A lattice in the part of every cell that a cuboid covers.
    Box,
    /// The points of an outline in the plane beside an axis, a lattice in the part of every cell along it: the volumes
    /// are exact.
    Prism {
        outline: Box<Outline>,
        plane: Vec<GridAxis>,
        along: usize,
        ends: [f64; 2],
    },
    /// By vertical lines; of cells that are cut the volumes are multiplied by the factor, by which the body's is exact.
    Lattice { scale: f64 },
}

/// Points and cells of a volume, counted once.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SlabTally {
    /// cells that hold points, per axis
    pub(crate) occupied: [Range<usize>; 3],
    /// of the first slab of cells along axis 0 in `occupied` and all later ones: number of the body's points before it;
    /// and of all
    pub(crate) before: Vec<u64>,
    /// cells that hold points
    pub(crate) cells: u64,
    /// m³  what cells have where one point stands for all as no lattice point is inside
    pub(crate) alone: f64,
}

impl Volume {
    /// Returns a shape with others cut out of it (m from the lower corner of the grid with three `axes`), with `n`
    /// points along each axis of a cell.
    ///
    /// # Errors
    /// If the points would take too long to make, or the shape is too thin for the cells.
    pub fn new(whole: SolidShape, cut: Vec<SolidShape>, axes: &[GridAxis], n: usize) -> Result<Self, ShapeError> {
        let origin = [0, 1, 2].map(|axis| axes[axis].lower());
        let bounds = bounds_of_difference(&whole, &cut);
        let filling = FillPattern::of(&whole, &cut, bounds, axes, n)?;
        let volume = whole.volume();
        let mut made = Self {
            origin,
            whole,
            cut,
            bounds,
            filling,
            volume,
            tally: SlabTally::default(),
        };
        made.count(axes, n);
        let unseen = made.tally.cells == 0 && made.volume > 0.0;
        // A factor below zero: cells that seem whole hold more than the body.
        if matches!(made.filling, FillPattern::Lattice { .. }) && (unseen || made.scale() <= 0.0) {
            return Err(ShapeError::TooThin);
        }
        Ok(made)
    }

    /// Returns the lower and upper corner of a cuboid around the shape (m), in the coordinates of the breakpoints.
    /// Cut-outs reduce it only if they are cuboids that cut off a whole side.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
            .map(|corner| [0, 1, 2].map(|axis| corner[axis] + self.origin[axis]))
    }

    /// Returns the volume (m³), which is the sum of the volumes of its points.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Returns whether the shape is a cuboid without cut-outs.
    pub fn is_box(&self) -> bool {
        self.filling == FillPattern::Box
    }

    /// Returns the factor by which the volumes of points in cells at the surface were multiplied to make the sum exact.
    /// Far from 1 the shape is too thin for the vertical lines that sample it.
    pub fn scale(&self) -> f64 {
        if let FillPattern::Lattice { scale } = self.filling {
            scale
        } else {
            1.0
        }
    }

    /// Returns the material points in the cells `columns` along axis 0, each with its number within the shape, with the
    /// `axes` and `n` of [`Self::new`]. Numbers do not depend on `columns`.
    pub fn places<'a>(
        &'a self,
        axes: &'a [GridAxis],
        n: usize,
        columns: Range<usize>,
    ) -> impl Iterator<Item = (u64, CellPlace<3>)> + 'a {
        let occupied = &self.tally.occupied[0];
        let columns = occupied.start.max(columns.start)..occupied.end.min(columns.end);
        columns.flat_map(move |i| {
            let first = self.tally.before[i - occupied.start];
            (first..).zip(self.slab(axes, n, i))
        })
    }

    pub(crate) fn tally(&self) -> &SlabTally {
        &self.tally
    }

    /// Length of the part of the vertical ray above a position (m) inside the shape (m).
    pub(crate) fn above(&self, at: [f64; 3]) -> f64 {
        let at = self.local(at);
        self.vertical([at[0], at[1]])
            .into_iter()
            .map(|[lower, upper]| (upper - lower.max(at[2])).max(0.0))
            .sum()
    }

    /// Returns whether a position (m), in the coordinates of the breakpoints, is inside the shape.
    pub fn contains(&self, at: [f64; 3]) -> bool {
        let at = self.local(at);
        self.vertical([at[0], at[1]])
            .iter()
            .any(|[lower, upper]| *lower < at[2] && at[2] < *upper)
    }

    fn local(&self, at: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| at[axis] - self.origin[axis])
    }

    /// What it covers of a vertical line, from the grid's lower corner.
    fn vertical(&self, at: [f64; 2]) -> Vec<[f64; 2]> {
        self.cut
            .iter()
            .fold(self.whole.vertical(at), |left, cut| less(left, &cut.vertical(at)))
    }

    /// Points of slab `i` of the cells along axis 0.
    pub(crate) fn slab(&self, axes: &[GridAxis], n: usize, i: usize) -> Vec<CellPlace<3>> {
        match &self.filling {
            FillPattern::Box => self.slab_of_box(axes, n, i),
            FillPattern::Prism {
                outline,
                plane,
                along,
                ends,
            } => {
                let extent = AxisExtent::between(&axes[*along], *ends);
                prism_slab(outline, plane, *along, &extent, n, i)
            }
            FillPattern::Lattice { scale } => {
                let cells = self.lattice_slab(axes, n, i).into_iter();
                let places = cells.flat_map(|(_, cell)| {
                    let by = if cell.whole { 1.0 } else { *scale };
                    cell.places.into_iter().map(move |at| CellPlace {
                        area: by * at.area,
                        ..at
                    })
                });
                places.collect()
            }
        }
    }

    fn slab_of_box(&self, axes: &[GridAxis], n: usize, i: usize) -> Vec<CellPlace<3>> {
        let [lower, upper] = self.bounds;
        let extents = [0, 1, 2].map(|axis| AxisExtent::between(&axes[axis], [lower[axis], upper[axis]]));
        if !extents[0].cells.contains(&i) {
            return Vec::new();
        }
        let mut places = Vec::new();
        let [of_x, of_y, of_z] = &extents;
        for j in of_y.cells.clone() {
            for k in of_z.cells.clone() {
                let parts = [of_x.part(i), of_y.part(j), of_z.part(k)];
                let area = parts.iter().map(|part| part[1] - part[0]).product::<f64>() / n.pow(3) as f64;
                places.extend((0..n.pow(3)).map(|point| {
                    let numbers = [point / (n * n), point / n % n, point % n];
                    let x = [0, 1, 2].map(|axis| place(parts[axis], numbers[axis], n));
                    CellPlace { x, area }
                }));
            }
        }
        places
    }

    /// Cells of slab `i`, each with its number along axis 1.
    fn lattice_slab(&self, axes: &[GridAxis], n: usize, i: usize) -> Vec<(usize, lattice::LatticeCell)> {
        let [lower, upper] = self.bounds;
        let ends = self.ends();
        let lines = lattice::Lines {
            covers: &|at| self.vertical(at),
            ends: &ends,
        };
        let cells = reached(&axes[1], [lower[1], upper[1]]).flat_map(|j| {
            let column = lattice::column(&lines, [sides(&axes[0], i), sides(&axes[1], j)], &axes[2], n);
            column.into_iter().map(move |cell| (j, cell))
        });
        cells.collect()
    }

    fn count(&mut self, axes: &[GridAxis], n: usize) {
        let [lower, upper] = self.bounds;
        let extent = |axis: usize| AxisExtent::between(&axes[axis], [lower[axis], upper[axis]]).cells;
        match &self.filling {
            FillPattern::Box => {
                let occupied = [0, 1, 2].map(extent);
                let in_slab = (occupied[1].len() * occupied[2].len()) as u64;
                let before = (0..=occupied[0].len() as u64)
                    .map(|slab| slab * in_slab * n.pow(3) as u64)
                    .collect();
                self.tally = SlabTally {
                    before,
                    cells: occupied[0].len() as u64 * in_slab,
                    occupied,
                    alone: 0.0,
                };
            }
            FillPattern::Prism {
                outline, along, ends, ..
            } => {
                self.tally = prism_tally(outline, *along, extent(*along), ends[1] - ends[0], n);
                self.volume = outline.area() * (ends[1] - ends[0]);
            }
            FillPattern::Lattice { .. } => self.count_lattice(axes, n),
        }
    }

    /// Counts, and scales the cells that are cut where the volume is known.
    fn count_lattice(&mut self, axes: &[GridAxis], n: usize) {
        let [lower, upper] = self.bounds;
        let mut tally = SlabTally::default();
        let mut total = 0_u64;
        let mut sums = [0.0; 2];
        for i in reached(&axes[0], [lower[0], upper[0]]) {
            let cells = self.lattice_slab(axes, n, i);
            if cells.is_empty() {
                continue;
            }
            if tally.before.is_empty() {
                tally.occupied = [i..i, cells[0].0..cells[0].0, cells[0].1.row..cells[0].1.row];
            }
            tally
                .before
                .extend(std::iter::repeat_n(total, i + 1 - tally.occupied[0].end));
            tally.occupied[0].end = i + 1;
            tally.cells += cells.len() as u64;
            for (j, cell) in &cells {
                total += cell.places.len() as u64;
                let sum = cell.places.iter().map(|place| place.area).sum::<f64>();
                sums[usize::from(cell.whole)] += sum;
                tally.alone += if cell.alone { sum } else { 0.0 };
                for (axis, number) in [(1, *j), (2, cell.row)] {
                    let range = &mut tally.occupied[axis];
                    *range = range.start.min(number)..range.end.max(number + 1);
                }
            }
        }
        tally.before.push(total);
        self.tally = tally;
        let [partly, wholly] = sums;
        if !self.cut.is_empty() {
            let shapes: Vec<&SolidShape> = std::iter::once(&self.whole).chain(&self.cut).collect();
            self.volume = measure::volume(&shapes, self.bounds, |at| {
                self.vertical(at).iter().map(|[from, to]| to - from).sum()
            });
        }
        if partly > 0.0 {
            let scale = (self.volume - wholly) / partly;
            self.filling = FillPattern::Lattice { scale };
            self.tally.alone *= scale;
        } else if wholly > 0.0 {
            self.volume = wholly;
        }
    }

    /// Places along axes 0 and 1, ascending, at which one of its shapes begins or ends.
    fn ends(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|axis| {
            let shapes = std::iter::once(&self.whole).chain(&self.cut);
            let mut ends: Vec<f64> = shapes
                .flat_map(|shape| shape.bounds().map(|corner| corner[axis]))
                .collect();
            ends.sort_by(f64::total_cmp);
            ends.dedup();
            ends
        })
    }
}

impl FillPattern {
    fn of(
        whole: &SolidShape,
        cut: &[SolidShape],
        bounds: [[f64; 3]; 2],
        axes: &[GridAxis],
        n: usize,
    ) -> Result<Self, ShapeError> {
        if cut.is_empty() && matches!(whole, SolidShape::Box { .. }) {
            return Ok(Self::Box);
        }
        let prism = (0..3).find_map(|along| Some((along, through(whole, cut, along)?, whole.along(along)?.0)));
        if let Some((along, (edges, _), section)) = prism {
            let [across, up] = plane(along);
            let plane = vec![axes[across].clone(), axes[up].clone()];
            let lower = corner(&plane);
            let ends = bounds.map(|corner| corner[along]);
            let bounds = bounds.map(|corner| [corner[across] + lower[0], corner[up] + lower[1]]);
            let outline = Outline::new(edges, 1 + cut.len(), bounds, section.area, &plane, Lattice::even(n))?;
            return Ok(Self::Prism {
                outline: Box::new(outline),
                plane,
                along,
                ends,
            });
        }
        let [lower, upper] = bounds;
        let columns = (0..2).map(|axis| reached(&axes[axis], [lower[axis], upper[axis]]).len() as u128);
        let lines = columns.product::<u128>() * (n * n * (1 + LINES * LINES)) as u128;
        let rows = reached(&axes[2], [lower[2], upper[2]]).len() * n;
        if lines * (edges(whole) + cut.iter().map(edges).sum::<usize>() + rows) as u128 > MOST_WORK {
            return Err(ShapeError::TooManyCells);
        }
        Ok(Self::Lattice { scale: 1.0 })
    }
}

/// Returns the lower and upper corner of a cuboid around a shape with cut-outs. Only cuboids that cut off a whole side
/// reduce it, as planes of symmetry cut off three quarters of a cylinder.
pub fn bounds_of_difference(whole: &SolidShape, cut: &[SolidShape]) -> [[f64; 3]; 2] {
    let boxes = cut.iter().filter_map(|shape| match shape {
        SolidShape::Box { corners } => Some(*corners),
        _ => None,
    });
    left_of_box(whole.bounds(), &boxes.collect::<Vec<_>>())
}

/// Edges that a vertical line is held against.
fn edges(shape: &SolidShape) -> usize {
    match shape {
        SolidShape::Prism { outline, .. } | SolidShape::Revolved { outline, .. } => outline.edges.len(),
        SolidShape::Box { .. } | SolidShape::Sphere { .. } | SolidShape::Terrain(_) => 1,
        SolidShape::Surface(surface) => surface.in_bin(),
    }
}

/// The edges and ends of a prism along an axis from which only prisms are cut that go through it.
fn through(whole: &SolidShape, cut: &[SolidShape], along: usize) -> Option<(Vec<Edge>, [f64; 2])> {
    let (section, ends) = whole.along(along)?;
    let mut edges = section.edges;
    for (number, shape) in cut.iter().enumerate() {
        let (section, of_cut) = shape.along(along)?;
        if of_cut[0] > ends[0] || of_cut[1] < ends[1] {
            return None;
        }
        edges.extend(section.edges.into_iter().map(|edge| edge.of(1 + number)));
    }
    Some((edges, ends))
}

/// Points of slab `i` along axis 0 of a prism.
fn prism_slab(
    outline: &Outline,
    plane: &[GridAxis],
    along: usize,
    extent: &AxisExtent<'_>,
    n: usize,
    i: usize,
) -> Vec<CellPlace<3>> {
    let (columns, cells) = if along == 0 {
        let cells = if extent.cells.contains(&i) { i..i + 1 } else { 0..0 };
        (outline.tally().occupied[0].clone(), cells)
    } else {
        (i..i + 1, extent.cells.clone())
    };
    let mut places = Vec::new();
    for column in columns {
        let section: Vec<CellPlace> = outline.points_of_column(plane, Lattice::even(n), column).collect();
        for cell in cells.clone() {
            let part = extent.part(cell);
            let thickness = (part[1] - part[0]) / n as f64;
            for k in 0..n {
                let at = place(part, k, n);
                places.extend(section.iter().map(|of| CellPlace {
                    x: beside(along, at, of.x),
                    area: thickness * of.area,
                }));
            }
        }
    }
    places
}

/// Lower and upper side of a cell along an axis, m from the grid's lower corner.
fn sides(axis: &GridAxis, cell: usize) -> [f64; 2] {
    [axis.breakpoint(cell), axis.breakpoint(cell + 1)]
}

/// A place by that along an axis and those beside it.
fn beside(along: usize, at: f64, others: [f64; 2]) -> [f64; 3] {
    let mut place = [at; 3];
    let [across, up] = plane(along);
    (place[across], place[up]) = (others[0], others[1]);
    place
}

fn prism_tally(outline: &Outline, along: usize, cells: Range<usize>, length: f64, n: usize) -> SlabTally {
    let of_plane = outline.tally();
    let in_plane = of_plane.before.last().copied().unwrap_or(0);
    let thick = (cells.len() * n) as u64;
    let [across, up] = plane(along);
    let mut occupied = [0..0, 0..0, 0..0];
    (occupied[across], occupied[up]) = (of_plane.occupied[0].clone(), of_plane.occupied[1].clone());
    occupied[along] = cells.clone();
    let before = if along == 0 {
        (0..=cells.len() as u64)
            .map(|slab| slab * n as u64 * in_plane)
            .collect()
    } else {
        of_plane.before.iter().map(|before| before * thick).collect()
    };
    SlabTally {
        occupied,
        before,
        cells: of_plane.cells * cells.len() as u64,
        alone: of_plane.alone * length,
    }
}

#[cfg(test)]
mod tests;
