//! Validates the positions, lines, boxes and faces that histories refer to.

use crate::case::Face;
use crate::grid::GridSpec;
use crate::record::{CaseTable, Field, vector};
use crate::report::Report;
use crate::schema::{BoxTable, Draft, HistoryTable};
use crate::validate::{place, site};
use crate::words::{Geometry, Side};

/// Lines of a section, and whether it is a disc: in a plane itself, of a solid the middle lines of a plate.
pub(super) fn section(
    draft: &Draft,
    record: &HistoryTable,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Option<(Vec<[[f64; 3]; 2]>, bool)> {
    if draft.geometry.get()? != Geometry::Solid {
        return Some((vec![ends(&record.from, &record.to, grid, report)?], false));
    }
    let Some(key) = record.plate() else {
        let message = "E0644: a section in 3-D needs a plane area. Add `rectangle` or `disc`.";
        record.location().error(message, report);
        return None;
    };
    let plate = site::plate(key, grid?, report)?;
    Some((plate.lines().into(), plate.round))
}

/// Ends of a line that has a length.
pub(in crate::validate) fn ends<T: AsRef<[f64]>>(
    from: &Field<T>,
    to: &Field<T>,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Option<[[f64; 3]; 2]> {
    let given = to.value()?.as_ref();
    let ends = [from.value()?.as_ref(), given].map(vector);
    if ends[0] == ends[1] {
        let message =
            format!("E0651: the line begins and ends at {given:?}, so its length is 0. Correct `from` or `to`.");
        to.error(message, report);
        return None;
    }
    for (key, end) in [from, to].into_iter().zip(ends) {
        if let Some(beyond) = grid.and_then(|grid| place::is_beyond(grid, end)) {
            key.error(beyond, report);
        }
    }
    Some(ends)
}

/// The face of a history.
pub(super) fn face(key: &Field<Side>, draft: &Draft, report: &mut Report<'_>) -> Option<Face> {
    let side = key.get()?;
    let geometry = draft.geometry.get()?;
    let face = Face::of(side, geometry);
    if face.is_none() {
        let message = format!(
            "E0653: the grid of a {geometry} case has no side \"{side}\". Use one of: \"left\", \
            \"right\", \"bottom\", \"top\"."
        );
        key.error(message, report);
    }
    face
}

/// The x of a height, if it has one; the outer option is `None` after an error.
pub(super) fn at_x(key: &Field<f64>, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<Option<f64>> {
    let x = key.if_given()?;
    if let Some(beyond) = grid.zip(x).and_then(|(grid, x)| place::beyond(grid, [x])) {
        key.error(beyond, report);
    }
    Some(x)
}

/// A box that has something in common with the grid.
pub(super) fn within(record: &BoxTable, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<[[f64; 3]; 2]> {
    let [lower, upper] = record.corners()?;
    if let Some(grid) = grid {
        let axes = grid.dims();
        let low = &lower[..axes];
        let high = &upper[..axes];
        if (0..axes).any(|axis| lower[axis] >= upper[axis]) {
            let message = format!(
                "E0651: the box is empty, because along each axis `upper` = {high:?} must be larger than `lower` = \
                 {low:?}. Correct `upper` or `lower`."
            );
            record.upper.error(message, report);
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
            record.location().error(message, report);
        }
    }
    Some([lower, upper])
}

/// A place in the grid.
pub(super) fn at(key: &Field<Vec<f64>>, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<[f64; 3]> {
    let at = key.vector()?;
    if let Some(beyond) = grid.and_then(|grid| place::is_beyond(grid, at)) {
        key.error(beyond, report);
    }
    Some(at)
}
