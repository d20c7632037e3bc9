//! Validates the positions, lines, boxes and faces that histories refer to.

use crate::case::Face;
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::schema::Draft;
use crate::validate::{place, site};
use crate::words::{Geometry, Side};

/// Lines of a section, and whether it is a disc: in a plane itself, of a solid the middle lines of a plate.
pub(super) fn section(
    draft: &Draft,
    record: &Record,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Option<(Vec<[[f64; 3]; 2]>, bool)> {
    if draft.geometry.get()? != Geometry::Solid {
        return Some((vec![ends(record, grid, report)?], false));
    }
    if !record.gives("rectangle") && !record.gives("disc") {
        let message = "E0644: a section in 3-D needs a plane area. Add `rectangle` or `disc`.";
        report.error(record.origin, &record.path, message);
        return None;
    }
    let plate = site::plate(record, grid?, report)?;
    Some((plate.lines().into(), plate.round))
}

/// Ends of a line that has a length.
pub(in crate::validate) fn ends(
    record: &Record,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Option<[[f64; 3]; 2]> {
    let [from, to] = [record.vector("from"), record.vector("to")];
    let ends = [from?, to?];
    if ends[0] == ends[1] {
        let message = format!(
            "E0651: the line begins and ends at {:?}, so its length is 0. Correct `from` or `to`.",
            record.numbers("to")?
        );
        record.error("to", message, report);
        return None;
    }
    for (key, end) in ["from", "to"].into_iter().zip(ends) {
        if let Some(beyond) = grid.and_then(|grid| place::is_beyond(grid, end)) {
            record.error(key, beyond, report);
        }
    }
    Some(ends)
}

/// The face of a history.
pub(super) fn face(record: &Record, draft: &Draft, report: &mut Report<'_>) -> Option<Face> {
    let side = record.word::<Side>("face")?;
    let geometry = draft.geometry.get()?;
    let face = Face::of(side, geometry);
    if face.is_none() {
        let message = format!(
            "E0653: the grid of a {geometry} case has no side \"{side}\". Use one of: \"left\", \
            \"right\", \"bottom\", \"top\"."
        );
        record.error("face", message, report);
    }
    face
}

/// Whether a place follows the surface of the ground; `None` after an error.
pub(super) fn at_surface(record: &Record) -> Option<bool> {
    if record.gives("surface") {
        record.flag("surface")
    } else {
        Some(false)
    }
}

/// The x of a height, if it has one; the outer option is `None` after an error.
pub(super) fn at_x(record: &Record, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<Option<f64>> {
    if !record.gives("at_x") {
        return Some(None);
    }
    let x = record.number("at_x")?;
    if let Some(beyond) = grid.and_then(|grid| place::beyond(grid, [x])) {
        record.error("at_x", beyond, report);
    }
    Some(Some(x))
}

/// A box that has something in common with the grid.
pub(super) fn within(record: &Record, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<[[f64; 3]; 2]> {
    let lower = record.vector("lower")?;
    let upper = record.vector("upper")?;
    if let Some(grid) = grid {
        let axes = grid.dims();
        let low = &lower[..axes];
        let high = &upper[..axes];
        if (0..axes).any(|axis| lower[axis] >= upper[axis]) {
            let message = format!(
                "E0651: the box is empty, because along each axis `upper` = {high:?} must be larger than `lower` = \
                 {low:?}. Correct `upper` or `lower`."
            );
            record.error("upper", message, report);
        }
        let start = grid.lower();
        let end = grid.upper();
        if (0..axes).any(|axis| upper[axis] <= start[axis] || lower[axis] >= end[axis]) {
            let message = format!(
                "E0650: the box lies outside the grid, which extends from {:?} m to {:?} m. Move the box into the \
                 grid.",
                &start[..axes],
                &end[..axes]
            );
            report.error(record.origin, &record.path, message);
        }
    }
    Some([lower, upper])
}

/// A place in the grid.
pub(super) fn at(record: &Record, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<[f64; 3]> {
    let at = record.vector("at")?;
    if let Some(beyond) = grid.and_then(|grid| place::is_beyond(grid, at)) {
        record.error("at", beyond, report);
    }
    Some(at)
}
