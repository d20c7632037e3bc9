//! Validates grid cells. Moves free faces of the grid outward, so that the grid has whole cells.

use crate::case::Support;
use crate::estimate::{self, MOST_UNKNOWNS};
use crate::grid::{GridSpec, Line};
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::{Draft, GridTable, KnotsTable};
use crate::unit::Dimension;
use crate::words::Order;
use bsmpm_shapes::GridAxis;

/// Parts of a cell by which a length may miss a whole number of cells.
const WHOLE: f64 = 1e-9;
const NAMES: [&str; 3] = ["x", "y", "z"];

/// The grid, once the supports of its faces are known.
pub(super) fn read(draft: &Draft, boundary: Option<[[Support; 2]; 3]>, report: &mut Report<'_>) -> Option<GridSpec> {
    let grid = draft.grid.value()?;
    // The rest is checked without it, too.
    let order = grid.degree.get().unwrap_or(Order::Quadratic).degree();
    let dims = draft.geometry.get()?.dims();
    corners(grid, dims, report)?;
    let (axes, lines) = if grid.knots.is_given() {
        graded(grid, order, dims, report)?
    } else {
        (uniform(grid, boundary?, dims, report)?, <[Vec<Line>; 3]>::default())
    };
    let spec = GridSpec { axes, order, lines };
    let cells = estimate::cells(&spec);
    let unknowns = dims as u128 * estimate::nodes(&spec);
    if cells > MOST_UNKNOWNS || unknowns > MOST_UNKNOWNS {
        let message = format!(
            "E0204: the grid has {cells} cells and {unknowns} unknowns (at most {MOST_UNKNOWNS} of each). Use larger \
             cells."
        );
        report.error(grid.cell.origin(), grid.cell.path(), message);
        return None;
    }
    bounded(&spec, grid, report)?;
    warn_of_rounding(&spec, report);
    Some(spec)
}

/// An error for corners in the wrong order, whatever the cells are.
fn corners(grid: &GridTable, dims: usize, report: &mut Report<'_>) -> Option<()> {
    let Some((lower, upper)) = grid.lower.vector().zip(grid.upper.vector()) else {
        return Some(());
    };
    let wrong: Vec<&str> = (0..dims)
        .filter(|&axis| upper[axis] <= lower[axis])
        .map(|axis| NAMES[axis])
        .collect();
    if wrong.is_empty() {
        return Some(());
    }
    let message = format!(
        "E0203: the upper corner {:?} m is not above the lower corner {:?} m along {}. Exchange or correct the corners.",
        &upper[..dims],
        &lower[..dims],
        wrong.join(" and ")
    );
    grid.upper.error(message, report);
    None
}

/// An error for breakpoints that are next to one when counted from the first.
fn bounded(spec: &GridSpec, grid: &GridTable, report: &mut Report<'_>) -> Option<()> {
    let least = Dimension::Length.least();
    for (axis, name) in spec.axes.iter().zip(NAMES) {
        let cell = axis.shortest();
        if cell < least {
            let key: &KeyPlace = if grid.knots.is_given() { &grid.knots } else { &grid.cell };
            let message = format!(
                "E0205: the shortest cell along {name} is {cell:e} m long, but must be at least {least:e} m. Correct \
                 `grid.cell`, or the ends of the cells in [grid.knots]."
            );
            key.error(message, report);
            return None;
        }
    }
    Some(())
}

/// Breakpoints as written; equal ones are copies of one.
fn graded(
    grid: &GridTable,
    order: usize,
    dims: usize,
    report: &mut Report<'_>,
) -> Option<(Vec<GridAxis>, [Vec<Line>; 3])> {
    let knots = grid.knots.value()?;
    if knots.z.is_given() != (dims == 3) {
        let message = match dims {
            3 => "E0206: a 3-D grid needs the ends of its cells along z in [grid.knots], too. Add knots.z.",
            _ => "E0207: a 2-D grid has no z axis. Delete knots.z, or use geometry = \"3d\".",
        };
        knots.z.error(message, report);
        return None;
    }
    let read: Vec<_> = (0..dims)
        .map(|number| graded_axis(grid, knots, order, number, report))
        .collect();
    let (axes, found): (Vec<GridAxis>, Vec<Vec<Line>>) =
        read.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
    let mut lines = <[Vec<Line>; 3]>::default();
    lines.iter_mut().zip(found).for_each(|(own, found)| *own = found);
    Some((axes, lines))
}

/// Breakpoints of one axis, and those of them that are repeated; `None` after an error.
fn graded_axis(
    grid: &GridTable,
    knots: &KnotsTable,
    order: usize,
    number: usize,
    report: &mut Report<'_>,
) -> Option<(GridAxis, Vec<Line>)> {
    let name = NAMES[number];
    let knots = [&knots.x, &knots.y, &knots.z][number];
    let copies: Vec<&[f64]> = knots.value()?.chunk_by(|a, b| a == b).collect();
    let breakpoints: Vec<f64> = copies.iter().map(|copies| copies[0]).collect();
    if breakpoints.len() < 2 || breakpoints.windows(2).any(|pair| pair[1] <= pair[0]) {
        let message = "E0208: the ends of the cells in [grid.knots] are not in increasing order, or fewer than \
             two of them differ. Sort the numbers, and add missing ones.";
        knots.error(message, report);
        return None;
    }
    for (i, copies_of_one) in copies.iter().enumerate() {
        let most = if i == 0 || i == copies.len() - 1 { 1 } else { order };
        if copies_of_one.len() > most {
            let message = format!(
                "E0209: the cell end {} is given {} times in [grid.knots], but is allowed at most {} times. Delete \
                 some of the repetitions.",
                breakpoints[i],
                copies_of_one.len(),
                most
            );
            knots.error(message, report);
            return None;
        }
    }
    let repeated = copies.iter().enumerate().filter(|(_, copies)| copies.len() > 1);
    let lines = repeated
        .map(|(breakpoint, copies)| Line {
            breakpoint,
            multiplicity: copies.len(),
        })
        .collect();
    let ends = [breakpoints[0], breakpoints[breakpoints.len() - 1]];
    for (key, end) in [&grid.lower, &grid.upper].into_iter().zip(ends) {
        if let Some(corner) = key.vector().filter(|corner| corner[number] != end) {
            let message = format!(
                "E0210: the grid has a corner at {name} = {} m, but the first or last value in [grid.knots] is \
                 {name} = {end} m. Delete `{}`, or make both equal.",
                corner[number],
                key.name()
            );
            key.error(message, report);
        }
    }
    Some((GridAxis::Graded(breakpoints), lines))
}

fn uniform(
    grid: &GridTable,
    boundary: [[Support; 2]; 3],
    dims: usize,
    report: &mut Report<'_>,
) -> Option<Vec<GridAxis>> {
    for corner in [&grid.lower, &grid.upper] {
        if !corner.is_given() {
            let message = "E0211: this corner of the grid is missing: a grid with `cell` needs both `lower` and \
                           `upper`. Add the corner, or give `knots` in place of `cell`.";
            corner.error(message, report);
        }
    }
    let lower = grid.lower.vector()?;
    let upper = grid.upper.vector()?;
    let cell = match grid.cell.value()?[..] {
        [all] => [all; 3],
        [x, y] => [x, y, y],
        [x, y, z] => [x, y, z],
        _ => return None,
    };
    let read: Vec<Option<GridAxis>> = (0..dims)
        .map(|number| {
            let supports = boundary[number];
            let faces = Faces { grid, number, supports };
            faces.cells(lower[number], upper[number], cell[number], report)
        })
        .collect();
    read.into_iter().collect()
}

/// The two faces of an axis.
struct Faces<'a> {
    grid: &'a GridTable,
    number: usize,
    supports: [Support; 2],
}

impl Faces<'_> {
    fn cells(&self, lower: f64, upper: f64, cell: f64, report: &mut Report<'_>) -> Option<GridAxis> {
        let exact = (upper - lower) / cell;
        let name = NAMES[self.number];
        if exact > MOST_UNKNOWNS as f64 {
            let message = format!(
                "E0204: the grid has {exact:.3e} cells along {name} (at most {MOST_UNKNOWNS}). Use larger cells."
            );
            self.grid.cell.error(message, report);
            return None;
        }
        let rounding = 4.0 * f64::EPSILON * lower.abs().max(upper.abs()) / cell;
        if exact >= 0.5 && (exact - exact.round()).abs() <= (WHOLE + rounding).min(0.01) {
            return Some(GridAxis::Uniform {
                lower,
                cell,
                cells: exact.round() as usize,
            });
        }
        let cells = exact.ceil();
        let length = cells * cell;
        let reason =
            format!("{exact} cells along {name} are not a whole number: the free face moves outward to a whole cell");
        match self.supports {
            [_, Support::Free] => {
                report.note(
                    format!("{}.{}", self.grid.upper.path(), self.number),
                    format!("{}", lower + length),
                    reason,
                );
                Some(GridAxis::Uniform {
                    lower,
                    cell,
                    cells: cells as usize,
                })
            }
            [Support::Free, _] => {
                let lower = upper - length;
                report.note(
                    format!("{}.{}", self.grid.lower.path(), self.number),
                    format!("{lower}"),
                    reason,
                );
                Some(GridAxis::Uniform {
                    lower,
                    cell,
                    cells: cells as usize,
                })
            }
            _ => {
                let message = format!(
                    "E0212: the grid has {exact:.3} cells along {name}, but needs a whole number. It can grow at a \
                     \"free\" face only, and no face along {name} is \"free\". Use for example cell = {}.",
                    (upper - lower) / exact.round().max(1.0)
                );
                self.grid.cell.error(message, report);
                None
            }
        }
    }
}

/// Far from the origin the coordinates of the file resolve a cell too coarsely.
fn warn_of_rounding(spec: &GridSpec, report: &mut Report<'_>) {
    for (axis, name) in spec.axes.iter().zip(NAMES) {
        let far = axis.lower().abs().max((axis.lower() + axis.length()).abs());
        let spacing = far * f64::EPSILON;
        if spacing > 1e-6 * axis.shortest() {
            report.warn(format!(
                "W0208: grid: coordinates of {far:e} m along {name} have rounding errors of {spacing:.1e} m, more \
                 than 1e-6 of a cell. Corners and grid lines may not coincide. Move all coordinates closer to 0."
            ));
        }
    }
}
