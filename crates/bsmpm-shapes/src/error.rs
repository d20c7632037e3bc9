//! What makes a shape, or the data of a shape, unusable.

use thiserror::Error;

/// The reason why a body cannot be made of a shape.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ShapeError {
    /// The outline with its cut-outs has more edges than [`MOST_EDGES`](crate::MOST_EDGES).
    #[error("the shape has {edges} edges, more than the limit")]
    TooManyEdges {
        /// Number of edges.
        edges: usize,
    },
    /// The edges cut so many cells that the material points would take too long to make.
    #[error("the {edges} edges of the shape cut about {cells} cells, which takes too long")]
    TooManyCutCells {
        /// Number of edges.
        edges: usize,
        /// Estimate of the number of cells that they cut.
        cells: u128,
    },
    /// The shape is wider than [`MOST_COLUMNS`](crate::MOST_COLUMNS) cells.
    #[error("the shape is {columns} cells wide, more than the limit")]
    TooManyColumns {
        /// Number of cells along the first axis.
        columns: usize,
    },
    /// The 3-D shape covers so many cells that the material points would take too long to make.
    #[error("the shape covers so many cells that its material points take too long to make")]
    TooManyCells,
    /// The 3-D shape is too thin for its cells.
    #[error("the shape is too thin for the cells, so its volume cannot be calculated")]
    TooThin,
}

/// What is wrong with the heights of a [`Raster`](crate::Raster). Lengths and coordinates are in m.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RasterError {
    /// Heights have fewer than two points along an axis.
    #[error("the heights need at least two points along each axis")]
    TooFew,
    /// Heights do not form a regular grid of points.
    #[error("{rows} heights do not form a regular grid of {} x {} points", .count[0], .count[1])]
    Irregular {
        /// Number of heights.
        rows: usize,
        /// Smallest distance between points along x and y.
        spacing: [f64; 2],
        /// Number of points along x and y that these distances need.
        count: [usize; 2],
    },
    /// A height is between the points of the regular grid of the others.
    #[error("the height at {at:?} is not on the regular grid of the others")]
    OffGrid {
        /// Its x and y.
        at: [f64; 2],
    },
    /// Two heights have the same x and y.
    #[error("the height at {at:?} is given twice")]
    Repeated {
        /// Their x and y.
        at: [f64; 2],
    },
    /// The heights of the top and the base are at different points.
    #[error("the heights of the top and of the base are at different points")]
    DifferentPoints,
    /// The top is below the base at a point.
    #[error("at {at:?} the top ({top}) is below the base ({base})")]
    TopBelowBase {
        /// Its x and y.
        at: [f64; 2],
        /// Height of the top.
        top: f64,
        /// Height of the base.
        base: f64,
    },
    /// Top and base are the same.
    #[error("the top and the base are the same, so the volume is zero")]
    NoVolume,
}

/// What is wrong with the triangles of a [`Surface`](crate::Surface). Lengths and coordinates are in m.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SurfaceError {
    /// No triangle has three different corners.
    #[error("no triangle has three different corners")]
    NoTriangle,
    /// Triangles do not bound a volume.
    #[error("the surface is not closed at {edges} edges, first from {:?} to {:?}", .first[0], .first[1])]
    Open {
        /// Number of edges at which the surface is open.
        edges: usize,
        /// Ends of the first of them.
        first: [[f64; 3]; 2],
    },
    /// The volume inside the triangles is zero.
    #[error("the surface encloses no volume")]
    NoVolume,
    /// The triangles intersect, or some of them are oriented inwards.
    #[error("the surface intersects itself, or has normals that point inwards, near {at:?}")]
    SelfIntersection {
        /// Position near the intersection.
        at: [f64; 3],
    },
}

/// What is wrong with the contents of an STL file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StlError {
    /// A binary file is shorter than its header.
    #[error("the file has {bytes} bytes, but its header needs {needed}")]
    ShortHeader {
        /// Length of the file.
        bytes: usize,
        /// Length of a header.
        needed: usize,
    },
    /// The length of a binary file does not match its number of triangles.
    #[error("the file has {bytes} bytes, but its {triangles} triangles need {needed}")]
    WrongLength {
        /// Length of the file.
        bytes: usize,
        /// Number of triangles in the header.
        triangles: u32,
        /// Length of a file of so many triangles.
        needed: u64,
    },
    /// A coordinate of a triangle is not a finite number.
    #[error("a corner of triangle {triangle} has a coordinate that is not a finite number")]
    NotFinite {
        /// Number of the triangle, from 1.
        triangle: usize,
    },
    /// A vertex of a text file does not have three finite numbers.
    #[error("the vertex in line {line} does not have three numbers")]
    Vertex {
        /// Number of the line, from 1.
        line: usize,
    },
    /// A facet of a text file does not have three vertices.
    #[error("the facet that ends in line {line} does not have three vertices")]
    Facet {
        /// Number of the line, from 1.
        line: usize,
    },
    /// A text file has no triangle, or ends within one.
    #[error("there is no triangle, or the last one is incomplete")]
    Incomplete,
}

/// What is wrong with the contents of an ASCII grid of heights.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum HeightsError {
    /// A key of the header has no finite number.
    #[error("`{key}` in the header has no number")]
    HeaderNumber {
        /// The key.
        key: String,
    },
    /// The header lacks a key.
    #[error("the header has no `{key}`")]
    HeaderKey {
        /// The key.
        key: String,
    },
    /// The numbers of columns and rows are not integers above 1, or the cell size is not positive.
    #[error("ncols and nrows must be integers above 1, and cellsize must be above 0")]
    HeaderRange,
    /// There are more or fewer heights than the header says.
    #[error("there are {found} heights, but ncols times nrows is {expected}")]
    Count {
        /// Number of heights.
        found: usize,
        /// Number of heights according to the header.
        expected: f64,
    },
    /// A height is not a finite number.
    #[error("`{word}` in row {row}, column {column} is not a number")]
    NotANumber {
        /// The text in its place.
        word: String,
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
    /// A height is the value that marks missing data.
    #[error("row {row}, column {column} has no data")]
    NoData {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
}
