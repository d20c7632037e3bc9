//! Selects the material points of a 3-D run near a section plane.

use bsmpm_io::frame::{FieldValues, Frame};

use crate::Error;
use crate::picture::splat;
use crate::picture::ticks::range;
use crate::record::{RunRecord, short};

const AXES: [&str; 3] = ["x", "y", "z"];

/// A plane across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// the axis that is normal to it
    pub axis: usize,
    /// m  its place along the axis
    pub at: f64,
}

impl Section {
    /// As a command line has it, `y=0.5`.
    pub(super) fn read(text: &str) -> Result<Self, String> {
        let read = text.split_once('=').and_then(|(axis, at)| {
            let axis = AXES.iter().position(|name| *name == axis.trim())?;
            Some(Self {
                axis,
                at: at.trim().parse().ok().filter(|at: &f64| at.is_finite())?,
            })
        });
        read.ok_or_else(|| "an axis and a place along it in m, e.g. y=0.5".to_owned())
    }
}

/// The frames as sections, with their places in the plane first, and the section; those of a plane as they are.
///
/// The section is the wanted one, else in the middle of the grid along y, or if no point is near in that of the first
/// frame's points, and has the points that are nearer to it than half a cell. Fails where none is near the wanted one.
pub(super) fn of(
    record: &RunRecord,
    frames: Vec<Frame>,
    wanted: Option<Section>,
) -> Result<(Vec<Frame>, Option<Section>), Error> {
    if !record.is_solid() {
        let reason =
            "E0848: the run is two-dimensional, and --section applies to 3-D only. Remove --section.".to_owned();
        return if wanted.is_some() {
            Err(Error::Missing { reason })
        } else {
            Ok((frames, None))
        };
    }
    let across = record.across;
    let ends = frames
        .first()
        .and_then(|frame| range(frame.position.iter().map(|point| point[across])));
    let Some(ends) = ends else {
        return Ok((frames, None));
    };
    let middle = 0.5 * (ends.low + ends.high);
    let of_grid = record.manifest.grid.as_ref().and_then(|grid| {
        let ends = [&grid.lower, &grid.upper, &grid.cell].map(|of| of.get(across).copied());
        Some((0.5 * (ends[0]? + ends[1]?), 0.5 * ends[2]?))
    });
    let (grid_middle, reach) = of_grid.unwrap_or((middle, 0.5 * ends.length()));
    let at = wanted.map_or(grid_middle, |wanted| wanted.at);
    let is_near = frames.iter().all(|frame| {
        let mut points = frame.position.iter();
        points.any(|point| (point[across] - at).abs() <= reach)
    });
    let at = match is_near {
        true => at,
        false if wanted.is_some() => {
            let reason = format!(
                "E0848: no material point is within {} m of the section {} = {} m. Choose a section through the soil.",
                short(reach),
                AXES[across],
                short(at)
            );
            return Err(Error::Missing { reason });
        }
        false => middle,
    };
    let found = Section { axis: across, at };
    Ok((
        frames
            .iter()
            .map(|frame| section(frame, found, record.plane(), reach))
            .collect(),
        Some(found),
    ))
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
pub(super) fn named(section: Option<Section>) -> String {
    section.map_or_else(String::new, |of| {
        format!(", section at {} = {} m", AXES[of.axis], short(of.at))
    })
}

fn section(frame: &Frame, of: Section, plane: [usize; 2], reach: f64) -> Frame {
    let kept: Vec<usize> = (0..frame.position.len())
        .filter(|&p| (frame.position[p][of.axis] - of.at).abs() <= reach)
        .collect();
    let mut section = frame.without_points();
    section.position = kept
        .iter()
        .map(|&p| frame.position[p])
        .map(|x| [x[plane[0]], x[plane[1]], x[of.axis]])
        .collect();
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
    kept.iter()
        .flat_map(|&p| &values[p * components..(p + 1) * components])
        .copied()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bsmpm_io::frame::Field;

    #[test]
    fn a_section_is_named_by_its_place() {
        let read = Section::read("x = -2").unwrap();
        assert_eq!(
            (named(Some(read)).as_str(), named(None).as_str()),
            (", section at x = -2 m", "")
        );
        assert!(
            ["w=1", "x", "x=", "x=inf"]
                .iter()
                .all(|text| Section::read(text).is_err())
        );
    }

    #[test]
    fn a_section_has_the_points_near_it_with_all_that_is_theirs() {
        let position = vec![[1.0, 0.1, 5.0], [2.0, 0.6, 6.0], [3.0, 1.4, 7.0]];
        let ids = Field {
            name: "id".into(),
            components: 1,
            values: FieldValues::U64(vec![4, 5, 6]),
        };
        let fields = vec![ids, Field::real("v", 3, (0..9).map(f64::from).collect())];
        let whole = Frame {
            step: 1,
            time: 2.0,
            position,
            fields,
        };
        let level = section(&whole, Section { axis: 2, at: 6.6 }, [0, 1], 0.5);
        assert_eq!(level.position, vec![[3.0, 1.4, 7.0]]);
        let found = section(&whole, Section { axis: 1, at: 0.75 }, [0, 2], 0.25);
        assert_eq!((found.position, found.time), (vec![[2.0, 6.0, 0.6]], 2.0));
        assert_eq!(found.fields[0].values, FieldValues::U64(vec![5]));
        assert_eq!(found.fields[1].values, FieldValues::F64(vec![3.0, 4.0, 5.0]));
    }
}
