//! Messages about shapes that cannot become bodies, and about files that describe shapes.

use crate::rounding::brief;
use bsmpm_shapes::{HeightsError, MOST_COLUMNS, MOST_EDGES, RasterError, ShapeError, StlError, SurfaceError};

/// Returns the message about a shape that is too thin or too costly.
pub(crate) fn of_shape(error: &ShapeError) -> String {
    match error {
        ShapeError::TooManyEdges { edges } => format!(
            "E0036: the shape, together with its cut-outs, has {edges} edges, but at most {MOST_EDGES} are possible. \
             Use fewer corners."
        ),
        ShapeError::TooManyCutCells { edges, cells } => format!(
            "E0036: the {edges} edges of the shape cut about {cells} cells. Generating its material points would take \
             too long. Use fewer corners or larger cells."
        ),
        ShapeError::TooManyColumns { columns } => format!(
            "E0036: the shape is {columns} cells wide, but at most {MOST_COLUMNS} cells are possible. Use larger cells."
        ),
        ShapeError::TooManyCells => "E0036: the shape covers so many cells that generating its material points would \
                                     take too long. Use larger cells."
            .into(),
        ShapeError::TooThin => "E0037: the shape is too thin for the size of the cells, so its volume cannot be \
                                calculated. Use smaller cells, or make the shape thicker."
            .into(),
    }
}

/// Returns the message about heights of a terrain.
pub(crate) fn of_raster(error: &RasterError) -> String {
    match error {
        RasterError::TooFew => {
            "E0032: the heights of a terrain need at least two points along x and two along y. Add rows.".into()
        }
        RasterError::Irregular {
            rows,
            spacing,
            count: [x, y],
        } => format!(
            "E0032: the {rows} rows do not form a regular grid of points. Spacings of {} m along x and {} m along y \
             need {x} x {y} rows. Interpolate the heights to a regular grid.",
            brief(spacing[0]),
            brief(spacing[1])
        ),
        RasterError::OffGrid { at: [x, y] } => format!(
            "E0032: the point x = {x} m, y = {y} m is not on the regular grid of the other points. Correct this row, \
             or interpolate all heights to a regular grid of points."
        ),
        RasterError::Repeated { at: [x, y] } => format!(
            "E0032: the point x = {x} m, y = {y} m is given twice. Correct this row, or interpolate all heights to a \
             regular grid of points."
        ),
        RasterError::DifferentPoints => {
            "E0032: `base` and `top` give heights at different points. Interpolate both to \
                                         the same regular grid of points."
                .into()
        }
        RasterError::TopBelowBase { at: [x, y], top, base } => format!(
            "E0033: at x = {x} m, y = {y} m the top ({top} m) is below the base ({base} m). Correct the heights."
        ),
        RasterError::NoVolume => {
            "E0033: `top` and `base` have the same heights everywhere, so the body has no volume. \
                                  Correct the heights."
                .into()
        }
    }
}

/// Returns the message about a surface of triangles.
pub(crate) fn of_surface(error: &SurfaceError) -> String {
    match error {
        SurfaceError::NoTriangle => {
            "E0034: no triangle of the surface has three different corners, so the surface has \
                                     no area. Correct the triangles or their file."
                .into()
        }
        SurfaceError::Open { edges, first } => format!(
            "E0034: the surface is not closed at {edges} edges, first at the edge from {:?} to {:?} m. Weld vertices, \
             fill holes and make normals consistent with a mesh tool.",
            first[0], first[1]
        ),
        SurfaceError::NoVolume => "E0034: the surface encloses no volume. Export a closed surface.".into(),
        SurfaceError::SelfIntersection { at: [x, y, z] } => format!(
            "E0035: the surface intersects itself, or has normals that point inwards, near [{x:.6}, {y:.6}, {z:.6}] m. \
             Repair the surface with a mesh tool."
        ),
    }
}

/// Returns the message about the contents of an STL file.
pub(crate) fn of_stl(error: &StlError) -> String {
    match error {
        StlError::ShortHeader { bytes, needed } => format!(
            "E0031: the binary STL file has {bytes} bytes, but its header needs {needed}, so the file is incomplete. \
             Export the file again."
        ),
        StlError::WrongLength {
            bytes,
            triangles,
            needed,
        } => format!(
            "E0031: the binary STL file has {bytes} bytes, but its {triangles} triangles need {needed}, so the file is \
             incomplete. Export the file again."
        ),
        StlError::NotFinite { triangle } => format!(
            "E0031: a corner of triangle {triangle} of the STL file has a coordinate that is not a finite number. \
             Export the file again."
        ),
        StlError::Vertex { line } => format!(
            "E0031: the vertex in line {line} of the STL file does not have three numbers. Export the file again."
        ),
        StlError::Facet { line } => format!(
            "E0031: the facet that ends in line {line} of the STL file does not have three vertices. Export the file \
             again."
        ),
        StlError::Incomplete => {
            "E0031: the STL file has no triangle, or its last triangle is incomplete. Export the file again.".into()
        }
    }
}

/// Returns the message about the contents of an ASCII grid.
pub(crate) fn of_heights(error: &HeightsError) -> String {
    match error {
        HeightsError::HeaderNumber { key } => {
            format!("E0030: `{key}` in the header of the ASCII grid has no number. Correct the header.")
        }
        HeightsError::HeaderKey { key } => {
            format!("E0030: the header of the ASCII grid has no `{key}`. Add a line with `{key}` and its value.")
        }
        HeightsError::HeaderRange => "E0030: in the header of the ASCII grid, ncols and nrows must be whole numbers \
                                      above 1, and cellsize must be above 0. Correct the header."
            .into(),
        HeightsError::Count { found, expected } => format!(
            "E0030: the ASCII grid has {found} heights, but ncols times nrows is {expected}. Export the grid again."
        ),
        HeightsError::NotANumber { word, row, column } => format!(
            "E0030: `{word}` in row {row}, column {column} of the ASCII grid is not a number. Correct the height."
        ),
        HeightsError::NoData { row, column } => format!(
            "E0030: row {row}, column {column} of the ASCII grid has no data. Fill in a height, or cut the grid to the \
             part that has data."
        ),
    }
}
