//! Validates shapes in 3-D.

use super::super::place;
use super::{BeyondSymmetry, BodyShape};
use crate::case::Support;
use crate::grid::GridSpec;
use crate::record::{Field, ListRow};
use crate::report::Report;
use crate::schema::{BodyTable, BoxTable, ExtrudeTable, RevolveTable, ShapeKey, SurfaceTable, TerrainTable};
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
    body: &BodyTable,
    grid: Option<&GridSpec>,
    points_per_cell: Option<usize>,
    boundary: Option<[[Support; 2]; 3]>,
    report: &mut Report<'_>,
) -> Option<Region> {
    let whole = read(body.shape(), report);
    let cuts = body.subtract.items().iter();
    let cut: Option<Vec<SolidShape>> = cuts.map(|cut| read(cut.shape(), report)).collect();
    let mut whole = whole?;
    let mut cut = cut?;
    let grid = grid?;
    let key = body.shape().place();
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
        key.error(reach(&whole).unwrap_or_else(|| outside.into()), report);
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
                    key.path(),
                    volume.scale()
                ));
            }
            Some(Region::Solid(Box::new(volume)))
        }
        Err(error) => {
            key.error(shape_error::of_shape(&error), report);
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

/// A shape in the case's coordinates.
fn read(key: ShapeKey<'_>, report: &mut Report<'_>) -> Option<SolidShape> {
    match key {
        ShapeKey::Sphere(key) => {
            let (center, radius) = key.value()?.sphere()?;
            Some(SolidShape::Sphere { center, radius })
        }
        ShapeKey::Extrude(key) => extruded(key.value()?, report),
        ShapeKey::Revolve(key) => revolved(key.value()?, report),
        ShapeKey::Terrain(key) => terrain(key.value()?, report),
        ShapeKey::Surface(key) => enclosed(key.value()?, report),
        ShapeKey::Box(key) => Some(SolidShape::Box {
            corners: cuboid(key, report)?,
        }),
        ShapeKey::Ground(_) => None,
        ShapeKey::Polygon(_) | ShapeKey::Circle(_) => {
            let message = "E0225: a plane outline has no volume, and the case is 3-D. Give the outline a length with \
                           extrude = { ... }.";
            key.place().error(message, report);
            None
        }
    }
}

/// A prism: an outline along an axis.
fn extruded(shape: &ExtrudeTable, report: &mut Report<'_>) -> Option<SolidShape> {
    let outline = section(shape.outline(), report)?;
    let along = shape.along.get()?;
    let from = shape.from.get()?;
    let to = shape.to.get()?;
    if from >= to {
        let message = format!(
            "E0203: to = {to} m is not above from = {from} m, so the body has no length. Exchange or correct \
             `from` and `to`."
        );
        shape.to.error(message, report);
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
fn revolved(shape: &RevolveTable, report: &mut Report<'_>) -> Option<SolidShape> {
    let outline = section(shape.outline(), report)?;
    if outline.bounds[0][0] < 0.0 {
        let message = format!(
            "E0224: the outline crosses the axis of revolution: its smallest radius is {} m. Correct the outline \
             so that all radii are at least 0.",
            outline.bounds[0][0]
        );
        shape.outline().place().error(message, report);
        return None;
    }
    Some(SolidShape::Revolved {
        outline,
        about: shape.about.get()?,
    })
}

/// What a surface of triangles encloses.
fn enclosed(shape: &SurfaceTable, report: &mut Report<'_>) -> Option<SolidShape> {
    let scale = shape.scale.get()?;
    let rows = shape.triangles.value()?;
    let scaled = rows.iter().map(|row| std::array::from_fn(|k| scale * row.numbers[k]));
    match Surface::new(scaled) {
        Ok(surface) => {
            if is_turned(rows) {
                report.warn(format!(
                    "W0215: {}: the normals of all triangles point inwards. The enclosed volume is taken as the \
                     body. If the triangles describe a hole, use `subtract`; otherwise reverse the normals.",
                    shape.triangles.path()
                ));
            }
            Some(SolidShape::Surface(Box::new(surface)))
        }
        Err(error) => {
            shape.triangles.error(shape_error::of_surface(&error), report);
            None
        }
    }
}

/// Lower and upper corner of a box.
pub(in super::super) fn cuboid(key: &Field<BoxTable>, report: &mut Report<'_>) -> Option<[[f64; 3]; 2]> {
    let [lower, upper] = key.value()?.corners()?;
    if (0..3).any(|axis| lower[axis] >= upper[axis]) {
        key.value()?.upper.error(super::empty_box(&lower, &upper), report);
        return None;
    }
    Some([lower, upper])
}

/// Heights that a key of terrain gives, on a level.
pub(in super::super) fn raster(key: &Field<Vec<ListRow>>, level: f64) -> Option<Result<Raster, RasterError>> {
    let rows = key.value()?.iter();
    let heights: Vec<[f64; 3]> = rows
        .map(|row| [row.numbers[0], row.numbers[1], row.numbers[2]])
        .collect();
    Some(Raster::new(&heights, level))
}

/// Heights on others, or on a level.
fn terrain(shape: &TerrainTable, report: &mut Report<'_>) -> Option<SolidShape> {
    let TerrainTable { top, base, .. } = shape;
    let level = shape.level.if_given()?.unwrap_or(f64::NEG_INFINITY);
    let lower = if base.is_given() {
        Some(raster(base, f64::NEG_INFINITY)?)
    } else {
        None
    };
    let whole = match (raster(top, level)?, lower) {
        (Err(error), _) => Err((top, error)),
        (_, Some(Err(error))) => Err((base, error)),
        (Ok(upper), Some(Ok(lower))) => upper.on(lower).map_err(|error| (base, error)),
        (Ok(upper), None) => Ok(upper),
    };
    match whole {
        Ok(raster) => Some(SolidShape::Terrain(Box::new(raster))),
        Err((key, error)) => {
            key.error(shape_error::of_raster(&error), report);
            None
        }
    }
}

/// The outline of an extruded or revolved shape.
fn section(key: ShapeKey<'_>, report: &mut Report<'_>) -> Option<Section> {
    match super::read(key, report)? {
        BodyShape::Polygon(corners) => Some(Section::polygon(&corners)),
        BodyShape::Circle { center, radius } => Some(Section::circle(center, radius)),
        BodyShape::Box { .. } => None,
    }
}
