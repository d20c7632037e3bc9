//! The section of a solid that pictures show: its points near the upright plane halfway from the front to the back.

use bsmpm_io::frame::{FieldValues, Frame};

use crate::picture::splat;
use crate::picture::ticks::range;
use crate::record::{RunRecord, short};

/// The axis across the section.
const ACROSS: usize = 1;

/// The frames as sections, with places (x, z), and the y of the section; those of a plane as they are.
///
/// The section is in the middle of the grid, or if no point is near in that of the first frame's points, and has the
/// points that are nearer to it than half a cell.
pub(super) fn of(record: &RunRecord, frames: Vec<Frame>) -> (Vec<Frame>, Option<f64>) {
    if !record.is_solid() {
        return (frames, None);
    }
    let ends = frames.first().and_then(|frame| range(frame.position.iter().map(|point| point[ACROSS])));
    let Some((low, high)) = ends else { return (frames, None) };
    let of_grid = record.manifest.grid.as_ref().and_then(|grid| {
        let ends = [&grid.lower, &grid.upper, &grid.cell].map(|of| of.get(ACROSS).copied());
        Some((0.5 * (ends[0]? + ends[1]?), 0.5 * ends[2]?))
    });
    let (middle, reach) = of_grid.unwrap_or((0.5 * (low + high), 0.5 * (high - low)));
    let is_near = |point: &[f64; 3]| (point[ACROSS] - middle).abs() <= reach;
    let middle =
        if frames.iter().all(|frame| frame.position.iter().any(is_near)) { middle } else { 0.5 * (low + high) };
    (frames.iter().map(|frame| section(frame, middle, reach)).collect(), Some(middle))
}

/// m  how far the material of a solid goes on above its highest points: half of the usual share of one of the vertical,
/// by the cells' proportions (where a body is cut its points are small, but not their distances). Of a plane 0: its
/// surface is the line of its highest points.
pub(super) fn above(record: &RunRecord, frame: &Frame) -> f64 {
    let cell = record.manifest.grid.as_ref().map_or(&[][..], |grid| &grid.cell);
    match cell {
        &[x, y, z] if record.is_solid() => {
            let usual = splat::median(&splat::sizes(frame, &record.manifest.case.geometry));
            0.5 * usual * z / (x * y * z).cbrt()
        }
        _ => 0.0,
    }
}

/// What a title says of a section.
pub(super) fn named(section: Option<f64>) -> String {
    section.map_or_else(String::new, |y| format!(", section at y = {} m", short(y)))
}

fn section(frame: &Frame, middle: f64, reach: f64) -> Frame {
    let near = |point: &[f64; 3]| (point[ACROSS] - middle).abs() <= reach;
    let kept: Vec<usize> = (0..frame.position.len()).filter(|&p| near(&frame.position[p])).collect();
    let mut section = frame.without_points();
    section.position = kept.iter().map(|&p| frame.position[p]).map(|[x, y, z]| [x, z, y]).collect();
    for (field, whole) in section.fields.iter_mut().zip(&frame.fields) {
        field.values = match &whole.values {
            FieldValues::F64(values) => FieldValues::F64(taken(values, &kept, whole.components)),
            FieldValues::U64(values) => FieldValues::U64(taken(values, &kept, whole.components)),
            FieldValues::U16(values) => FieldValues::U16(taken(values, &kept, whole.components)),
        };
    }
    section
}

fn taken<T: Copy>(values: &[T], kept: &[usize], components: usize) -> Vec<T> {
    kept.iter().flat_map(|&p| &values[p * components..(p + 1) * components]).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bsmpm_io::frame::Field;

    #[test]
    fn a_section_is_named_by_its_place() {
        assert_eq!((named(Some(2.0)).as_str(), named(None).as_str()), (", section at y = 2 m", ""));
    }

    #[test]
    fn a_section_has_the_points_near_it_with_all_that_is_theirs() {
        let position = vec![[1.0, 0.1, 5.0], [2.0, 0.6, 6.0], [3.0, 1.4, 7.0]];
        let ids = Field { name: "id".into(), components: 1, values: FieldValues::U64(vec![4, 5, 6]) };
        let fields = vec![ids, Field::real("v", 3, (0..9).map(f64::from).collect())];
        let found = section(&Frame { step: 1, time: 2.0, position, fields }, 0.75, 0.25);
        assert_eq!((found.position, found.time), (vec![[2.0, 6.0, 0.6]], 2.0));
        assert_eq!(found.fields[0].values, FieldValues::U64(vec![5]));
        assert_eq!(found.fields[1].values, FieldValues::F64(vec![3.0, 4.0, 5.0]));
    }
}
