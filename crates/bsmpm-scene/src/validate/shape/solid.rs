//! Validates shapes in 3-D.

use super::super::place;
use super::{BeyondSymmetry, BodyShape};
use crate::case::Support;
use crate::grid::GridSpec;
use crate::record::{ListRow, Record};
use crate::report::Report;
use crate::shape_error;
use crate::words::{Axis, Geometry};
use bsmpm_shapes::{
    Raster, RasterError, Region, Section, SolidShape, Surface, Volume, bounds_of_difference, left_of_box,
};

/// Factor of the volumes in cells that are cut, less 1, above which there is a warning. At 2 or 3 points along an axis
/// walls of a fifth of a cell have 0.04 at most, of a hundredth 0.5 to 0.9; spheres of any size 0.06.
const SCALED: f64 = 0.1;

/// What a body of a solid fills.
pub(super) fn region(
    body: &Record,
    grid: Option<&GridSpec>,
    points_per_cell: Option<usize>,
    boundary: Option<[[Support; 2]; 3]>,
    report: &mut Report<'_>,
) -> Option<Region> {
    let whole = read(body, report);
    let cut: Option<Vec<SolidShape>> = body
        .records("subtract")
        .iter()
        .map(|record| read(record, report))
        .collect();
    let mut whole = whole?;
    let mut cut = cut?;
    let grid = grid?;
    let key = key(body);
    if body.gives("subtract") && cut.len() != body.records("subtract").len() {
        return None;
    }
    let beyond = BeyondSymmetry::of(whole.bounds(), bounds_of_difference(&whole, &cut), boundary?, grid);
    if !beyond.boxes.is_empty() {
        match &mut whole {
            SolidShape::Box { corners } => *corners = left_of_box(*corners, &beyond.boxes),
            _ => cut.extend(beyond.boxes.iter().map(|&corners| SolidShape::Box { corners })),
        }
        beyond.note(body, Geometry::Solid, report);
    }
    let outside = bounds_of_difference(&whole, &cut)
        .into_iter()
        .find_map(|corner| place::beyond(grid, corner));
    if let Some(outside) = outside {
        body.error(key, reach(&whole).unwrap_or_else(|| outside.into()), report);
        return None;
    }
    let shift = grid.lower().map(|by| -by);
    let cut = cut.into_iter().map(|shape| shape.moved(shift)).collect();
    match Volume::new(whole.moved(shift), cut, &grid.axes, points_per_cell?) {
        Ok(volume) => {
            if (volume.scale() - 1.0).abs() > SCALED {
                report.warn(format!(
                    "W0214: {}: the body is too thin for the cells, so its volume in surface cells was scaled by \
                     {:.2}. Stresses there are inaccurate. Use cells of at most five times the thickness.",
                    body.path_of(key),
                    volume.scale()
                ));
            }
            Some(Region::Solid(Box::new(volume)))
        }
        Err(error) => {
            body.error(key, shape_error::of_shape(&error), report);
            None
        }
    }
}

/// Of a surface beyond the grid how far it reaches: files of it often have another unit.
fn reach(shape: &SolidShape) -> Option<String> {
    let SolidShape::Surface(surface) = shape else {
        return None;
    };
    let [[x, y, z], [to_x, to_y, to_z]] = surface.bounds();
    Some(format!(
        "E0202: the surface reaches from [{x:.3}, {y:.3}, {z:.3}] to [{to_x:.3}, {to_y:.3}, {to_z:.3}] m, beyond the \
         grid. If its file is in mm, set scale = 0.001; otherwise enlarge the grid."
    ))
}

/// Whether triangles turn clockwise seen from outside, all in all: the tetrahedra between them and a corner have a
/// negative volume.
fn is_turned(rows: &[ListRow]) -> bool {
    let Some(first) = rows.first() else { return false };
    let six_times = rows.iter().map(|row| {
        let [a, b, c] = [0, 3, 6].map(|k| [0, 1, 2].map(|axis| row.numbers[k + axis] - first.numbers[axis]));
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    });
    six_times.sum::<f64>() < 0.0
}

/// The key that gives a body's or a cut's shape.
pub(in super::super) fn key(record: &Record) -> &'static str {
    let keys = [
        "extrude", "sphere", "revolve", "terrain", "surface", "polygon", "circle",
    ];
    keys.into_iter().find(|key| record.gives(key)).unwrap_or("box")
}

/// A shape in the case's coordinates.
fn read(record: &Record, report: &mut Report<'_>) -> Option<SolidShape> {
    if let Some(sphere) = record.record("sphere").filter(|_| record.gives("sphere")) {
        return Some(SolidShape::Sphere {
            center: sphere.vector("centre")?,
            radius: sphere.number("radius")?,
        });
    }
    if let Some(shape) = record.record("extrude").filter(|_| record.gives("extrude")) {
        return extruded(shape, report);
    }
    if let Some(shape) = record.record("revolve").filter(|_| record.gives("revolve")) {
        return revolved(shape, report);
    }
    if let Some(shape) = record.record("terrain").filter(|_| record.gives("terrain")) {
        return terrain(shape, report);
    }
    if let Some(shape) = record.record("surface").filter(|_| record.gives("surface")) {
        return enclosed(shape, report);
    }
    if let Some(key) = ["polygon", "circle"].into_iter().find(|key| record.gives(key)) {
        record.error(
            key,
            "E0225: a plane outline has no volume, and the case is 3-D. Give the outline a length with extrude = { \
             ... }.",
            report,
        );
        return None;
    }
    Some(SolidShape::Box {
        corners: cuboid(record, report)?,
    })
}

/// A prism: an outline along an axis.
fn extruded(shape: &Record, report: &mut Report<'_>) -> Option<SolidShape> {
    let outline = section(shape, report)?;
    let along = shape.word::<Axis>("along")?;
    let from = shape.number("from")?;
    let to = shape.number("to")?;
    if from >= to {
        let message = format!(
            "E0203: to = {to} m is not above from = {from} m, so the body has no length. Exchange or correct \
             `from` and `to`."
        );
        shape.error("to", message, report);
        return None;
    }
    let along = [Axis::X, Axis::Y, Axis::Z].iter().position(|axis| *axis == along)?;
    Some(SolidShape::Prism {
        outline,
        along,
        ends: [from, to],
    })
}

/// An outline about a vertical axis.
fn revolved(shape: &Record, report: &mut Report<'_>) -> Option<SolidShape> {
    let outline = section(shape, report)?;
    if outline.bounds[0][0] < 0.0 {
        let message = format!(
            "E0224: the outline crosses the axis of revolution: its smallest radius is {} m. Correct the outline \
             so that all radii are at least 0.",
            outline.bounds[0][0]
        );
        let key = if shape.gives("circle") { "circle" } else { "polygon" };
        shape.error(key, message, report);
        return None;
    }
    Some(SolidShape::Revolved {
        outline,
        about: shape.pair("about")?,
    })
}

/// What a surface of triangles encloses.
fn enclosed(shape: &Record, report: &mut Report<'_>) -> Option<SolidShape> {
    let scale = shape.number("scale")?;
    let rows = shape.rows("triangles")?;
    let scaled = rows.iter().map(|row| std::array::from_fn(|k| scale * row.numbers[k]));
    match Surface::new(scaled) {
        Ok(surface) => {
            if is_turned(rows) {
                report.warn(format!(
                    "W0215: {}: the normals of all triangles point inwards. The enclosed volume is taken as the \
                     body. If the triangles describe a hole, use `subtract`; otherwise reverse the normals.",
                    shape.path_of("triangles")
                ));
            }
            Some(SolidShape::Surface(Box::new(surface)))
        }
        Err(error) => {
            shape.error("triangles", shape_error::of_surface(&error), report);
            None
        }
    }
}

/// Lower and upper corner of a record's box.
pub(in super::super) fn cuboid(record: &Record, report: &mut Report<'_>) -> Option<[[f64; 3]; 2]> {
    let shape = record.record("box")?;
    let lower = shape.vector("lower")?;
    let upper = shape.vector("upper")?;
    if (0..3).any(|axis| lower[axis] >= upper[axis]) {
        shape.error("upper", super::empty_box(&lower, &upper), report);
        return None;
    }
    Some([lower, upper])
}

/// Heights that a key of terrain gives, on a level.
pub(in super::super) fn raster(shape: &Record, key: &str, level: f64) -> Option<Result<Raster, RasterError>> {
    let rows = shape.rows(key)?.iter();
    let heights: Vec<[f64; 3]> = rows
        .map(|row| [row.numbers[0], row.numbers[1], row.numbers[2]])
        .collect();
    Some(Raster::new(&heights, level))
}

/// Heights on others, or on a level.
fn terrain(shape: &Record, report: &mut Report<'_>) -> Option<SolidShape> {
    let level = if shape.gives("level") {
        shape.number("level")?
    } else {
        f64::NEG_INFINITY
    };
    let base = if shape.gives("base") {
        Some(raster(shape, "base", f64::NEG_INFINITY)?)
    } else {
        None
    };
    let top = raster(shape, "top", level)?;
    let whole = match (top, base) {
        (Err(error), _) => Err(("top", error)),
        (_, Some(Err(error))) => Err(("base", error)),
        (Ok(top), Some(Ok(base))) => top.on(base).map_err(|error| ("base", error)),
        (Ok(top), None) => Ok(top),
    };
    match whole {
        Ok(raster) => Some(SolidShape::Terrain(Box::new(raster))),
        Err((key, error)) => {
            shape.error(key, shape_error::of_raster(&error), report);
            None
        }
    }
}

/// The outline of an extruded or revolved shape.
fn section(record: &Record, report: &mut Report<'_>) -> Option<Section> {
    match super::read(record, report)? {
        BodyShape::Polygon(corners) => Some(Section::polygon(&corners)),
        BodyShape::Circle { center, radius } => Some(Section::circle(center, radius)),
        BodyShape::Box { .. } => None,
    }
}
