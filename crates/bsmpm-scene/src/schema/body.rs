//! Schema of bodies and their shapes.

use super::Presence::Optional;
use super::{Dimension as In, Key, Kind, Range, key};
use crate::record::{CaseTable, Field, KeyPlace, ListRow};
use crate::words::Axis;

table! {
    /// A body of soil, which is filled with material points.
    struct BodyTable = "[[body]]" {
        /// Name of the body's material.
        material: Name, Required, example(r#""clay""#);
        /// Name of the body in stages, histories and results.
        name: Name, Optional, example(r#""lift_1""#);
        r#box: Shared(BOX_KEY, Table(BoxTable));
        polygon: Shared(POLYGON_KEY, Rows);
        circle: Shared(CIRCLE_KEY, Table(CircleTable));
        extrude: Shared(EXTRUDE_KEY, Table(ExtrudeTable));
        sphere: Shared(SPHERE_KEY, Table(SphereTable));
        revolve: Shared(REVOLVE_KEY, Table(RevolveTable));
        terrain: Shared(TERRAIN_KEY, Table(TerrainTable));
        surface: Shared(SURFACE_KEY, Table(SurfaceTable));
        /// Shapes that are removed from the body.
        subtract: Tables(SubtractTable), Optional, example("[{ box = { lower = [2.0, 2.0], upper = [4.0, 4.0] } }]");
        /// Number of material points along each axis of a cell. Without this key `accuracy` or `purpose` chooses the
        /// number.
        points_per_cell: Count(1, 100), Required, example("3"), or_preset();
        /// Velocity at the start. Without this key the body is at rest.
        velocity: Vector(In::Velocity, Range::ANY), Optional, symbol("v"), example("[1.0, 0.0]");
        /// Rigid-body rotation at the start, added to `velocity`.
        spin: Table(SpinTable), Optional, example("{ rate = 1.0, about = [0.0, 0.0] }");
    }
    one_of required [r#box, polygon, circle, extrude, sphere, revolve, terrain, surface];
}

table! {
    /// Rigid-body rotation at the start. A material point at x has the velocity `velocity` + rate × (x - about).
    struct SpinTable = "spin = { rate, about, axis }" {
        /// Angular velocity in rad/s, positive counter-clockwise.
        rate: Quantity(In::Number, Range::ANY), Required, symbol("ω"), example("1.0");
        /// Centre of the rotation.
        about: Vector(In::Length, Range::ANY), Required, example("[0.0, 0.0]");
        /// Axis of the rotation in 3-D. The rotation is right-handed about it. Default: the vertical axis.
        axis: Vector(In::Number, Range::ANY), Optional, example("[0.0, 0.0, 1.0]");
    }
}

table! {
    /// A circle.
    struct CircleTable = "circle = { centre, radius }" {
        /// Centre of the circle.
        centre: Pair(In::Length, Range::ANY), Required, example("[2.0, 2.0]"), renamed_from(&["center"]);
        /// Radius of the circle.
        radius: Quantity(In::Length, Range::POSITIVE), Required, example(r#""1 m""#);
    }
}

table! {
    /// A shape that is removed from a body. The shape may extend beyond the body.
    struct SubtractTable = "subtract = [{ ... }, ...]" {
        r#box: Shared(BOX_KEY, Table(BoxTable));
        polygon: Shared(POLYGON_KEY, Rows);
        circle: Shared(CIRCLE_KEY, Table(CircleTable));
        extrude: Shared(EXTRUDE_KEY, Table(ExtrudeTable));
        sphere: Shared(SPHERE_KEY, Table(SphereTable));
        revolve: Shared(REVOLVE_KEY, Table(RevolveTable));
        terrain: Shared(TERRAIN_KEY, Table(TerrainTable));
        surface: Shared(SURFACE_KEY, Table(SurfaceTable));
    }
    one_of required [r#box, polygon, circle, extrude, sphere, revolve, terrain, surface];
}

table! {
    /// Ground between a terrain surface and a base. The surface is a regular raster of heights with bilinear
    /// interpolation.
    struct TerrainTable = "terrain = { top, base, level }" {
        /// Heights of the terrain: rows [x, y, z] in any order. A file may also be an ESRI ASCII grid, whose values are
        /// heights at the centres of its cells.
        top: Rows(HEIGHTS), Required, example(r#"{ file = "terrain.asc" }"#);
        /// Heights of the base at the same x and y as `top`. The base must not be above the terrain.
        base: Rows(HEIGHTS), Optional, example(r#"{ file = "bedrock.asc" }"#);
        /// Alternative to `base`: height of a horizontal base.
        level: Quantity(In::Length, Range::ANY), Optional, example("0.0");
    }
    one_of required [base, level];
}

table! {
    /// A surface of triangles. The surface of a body must be closed, and closed surfaces inside it are cavities. The
    /// surface of a traction may be open, but must be in one piece.
    struct SurfaceTable = "surface = { triangles, scale }" {
        /// A row for each triangle: the nine coordinates of its three corners. A file may also be STL.
        triangles: Rows(&[(In::Length, Range::ANY); 9]), Required, example(r#"{ file = "body.stl" }"#);
        /// Factor that multiplies all coordinates, for instance 0.001 for millimetres.
        scale: Quantity(In::Number, Range::POSITIVE), Default("1.0"), example("0.001");
    }
}

table! {
    /// A 2-D outline that is extended along one axis. The coordinates of the outline are those of the other two axes,
    /// in the order x, y, z. A circle gives a cylinder.
    struct ExtrudeTable = "extrude = { polygon, circle, along, from, to }" {
        polygon: Shared(POLYGON_KEY, Rows);
        circle: Shared(CIRCLE_KEY, Table(CircleTable));
        /// Axis along which the outline is extended.
        along: Choice(Axis), Required, example(r#""z""#);
        /// Coordinate at which the shape begins.
        from: Quantity(In::Length, Range::ANY), Required, example("0.0");
        /// Coordinate at which the shape ends.
        to: Quantity(In::Length, Range::ANY), Required, example(r#""2 m""#);
    }
    one_of required [polygon, circle];
}

table! {
    /// A sphere.
    struct SphereTable = "sphere = { centre, radius }" {
        /// Centre of the sphere.
        centre: Vector(In::Length, Range::ANY), Required, example("[0.0, 0.0, 1.0]"), renamed_from(&["center"]);
        /// Radius of the sphere.
        radius: Quantity(In::Length, Range::POSITIVE), Required, example(r#""1 m""#);
    }
}

table! {
    /// An outline that is rotated about a vertical axis. The coordinates of the outline are [radius, z].
    struct RevolveTable = "revolve = { polygon, circle, about }" {
        /// Corners of a polygon as [radius, z], clockwise or counter-clockwise.
        polygon: Rows(POLYGON), Optional,
            example("[[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]]");
        /// Alternative to `polygon`: a circle, which gives a torus.
        circle: Table(CircleTable), Optional, example(r#"{ centre = [2.0, 2.0], radius = "1 m" }"#);
        /// Coordinates x and y of the vertical axis.
        about: Pair(In::Length, Range::ANY), Required, example("[0.0, 0.0]");
    }
    one_of required [polygon, circle];
}

table! {
    /// A rectangle, in 3-D a cuboid, with edges parallel to the axes. Edges need not be grid lines.
    struct BoxTable = "box = { lower, upper }" {
        /// Corner with the smallest coordinates.
        lower: Vector(In::Length, Range::ANY), Required, example("[0.0, 0.0]");
        /// Corner with the largest coordinates.
        upper: Vector(In::Length, Range::ANY), Required, example("[10.0, 4.0]");
    }
}

/// Columns of a polygon: two coordinates.
pub(super) const POLYGON: &[(In, Range)] = &[(In::Length, Range::ANY); 2];
/// Columns of a raster of heights: x, y and z.
pub(super) const HEIGHTS: &[(In, Range)] = &[(In::Length, Range::ANY); 3];

table! {
    /// Rigid ground below a terrain surface. The surface is a regular raster of heights with bilinear interpolation,
    /// and is horizontal beyond the raster.
    struct GroundTable = "terrain = { top }" {
        /// Heights of the terrain: rows [x, y, z] in any order. A file may also be an ESRI ASCII grid.
        top: Rows(HEIGHTS), Required, example(r#"{ file = "terrain.asc" }"#);
    }
}

/// The key that gives a shape. Without any it is the last one, which is then absent.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ShapeKey<'a> {
    Sphere(&'a Field<SphereTable>),
    Extrude(&'a Field<ExtrudeTable>),
    Revolve(&'a Field<RevolveTable>),
    Terrain(&'a Field<TerrainTable>),
    Ground(&'a Field<GroundTable>),
    Surface(&'a Field<SurfaceTable>),
    Polygon(&'a Field<Vec<ListRow>>),
    Circle(&'a Field<CircleTable>),
    Box(&'a Field<BoxTable>),
}

impl<'a> ShapeKey<'a> {
    /// m  corners of a polygon or a box, or of the square around a circle
    pub(crate) fn corners(self) -> Option<Vec<[f64; 2]>> {
        let [lower, upper] = match self {
            Self::Box(key) => {
                let shape = key.value()?;
                [shape.lower.pair()?, shape.upper.pair()?]
            }
            Self::Circle(key) => {
                let (center, radius) = key.value()?.circle()?;
                [-radius, radius].map(|reach| center.map(|x| x + reach))
            }
            Self::Polygon(key) => {
                let corners = key.pairs()?;
                return (!corners.is_empty()).then_some(corners);
            }
            _ => return None,
        };
        Some(vec![lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]])
    }

    /// Where the key is written.
    pub(crate) fn place(self) -> &'a KeyPlace {
        match self {
            Self::Sphere(key) => key,
            Self::Extrude(key) => key,
            Self::Revolve(key) => key,
            Self::Terrain(key) => key,
            Self::Ground(key) => key,
            Self::Surface(key) => key,
            Self::Polygon(key) => key,
            Self::Circle(key) => key,
            Self::Box(key) => key,
        }
    }
}

/// Shape of a table with the keys of all shapes.
macro_rules! any_shape {
    ($Table:ident) => {
        impl $Table {
            /// The keys that exist in 3-D only.
            pub(crate) fn solid_shapes(&self) -> [&KeyPlace; 5] {
                [&self.extrude, &self.sphere, &self.revolve, &self.terrain, &self.surface]
            }

            /// The key that gives the shape.
            pub(crate) fn shape(&self) -> ShapeKey<'_> {
                first_given!(self, ShapeKey:
                    Sphere(sphere), Extrude(extrude), Revolve(revolve), Terrain(terrain), Surface(surface),
                    Polygon(polygon), Circle(circle), Box(r#box))
            }
        }
    };
}

any_shape!(BodyTable);
any_shape!(SubtractTable);

impl BoxTable {
    /// m  lower and upper corner
    pub(crate) fn corners(&self) -> Option<[[f64; 3]; 2]> {
        Some([self.lower.vector()?, self.upper.vector()?])
    }
}

impl CircleTable {
    /// m  centre and radius
    pub(crate) fn circle(&self) -> Option<([f64; 2], f64)> {
        Some((self.centre.get()?, self.radius.get()?))
    }
}

impl SphereTable {
    /// m  centre and radius
    pub(crate) fn sphere(&self) -> Option<([f64; 3], f64)> {
        Some((self.centre.vector()?, self.radius.get()?))
    }
}

impl ExtrudeTable {
    /// The key that gives the outline.
    pub(crate) fn outline(&self) -> ShapeKey<'_> {
        first_given!(self, ShapeKey: Polygon(polygon), Circle(circle))
    }
}

impl RevolveTable {
    /// The key that gives the outline.
    pub(crate) fn outline(&self) -> ShapeKey<'_> {
        first_given!(self, ShapeKey: Polygon(polygon), Circle(circle))
    }
}

// Keys that several tables have.
const BOX_KEY: Key = key(
    "box",
    Kind::Table(BoxTable::TABLE),
    Optional,
    "A rectangle, in 3-D a cuboid.",
)
.example("{ lower = [0.0, 0.0], upper = [10.0, 4.0] }");
const POLYGON_KEY: Key = key(
    "polygon",
    Kind::Rows(POLYGON),
    Optional,
    "Corners of a polygon, clockwise or counter-clockwise.",
)
.example("[[0.0, 0.0], [20.0, 0.0], [0.0, 10.0]]");
pub(super) const CIRCLE_KEY: Key = key(
    "circle",
    Kind::Table(CircleTable::TABLE),
    Optional,
    "A circle. Parts outside the grid are ignored.",
)
.example(r#"{ centre = [2.0, 2.0], radius = "1 m" }"#);
const EXTRUDE_KEY: Key = key(
    "extrude",
    Kind::Table(ExtrudeTable::TABLE),
    Optional,
    "An outline that is extended along an axis, for instance a cylinder. Only in 3-D.",
)
.example(r#"{ circle = { centre = [0.0, 0.0], radius = 1.0 }, along = "z", from = 0.0, to = 2.0 }"#);
const SPHERE_KEY: Key = key(
    "sphere",
    Kind::Table(SphereTable::TABLE),
    Optional,
    "A sphere. Only in 3-D.",
)
.example(r#"{ centre = [0.0, 0.0, 1.0], radius = "1 m" }"#);
const REVOLVE_KEY: Key = key(
    "revolve",
    Kind::Table(RevolveTable::TABLE),
    Optional,
    "An outline that is rotated about a vertical axis. Only in 3-D.",
)
.example("{ polygon = [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]], about = [0.0, 0.0] }");
const TERRAIN_KEY: Key = key(
    "terrain",
    Kind::Table(TerrainTable::TABLE),
    Optional,
    "The ground below a terrain surface. Only in 3-D.",
)
.example(r#"{ top = { file = "terrain.asc" }, level = 0.0 }"#);
const SURFACE_KEY: Key = key(
    "surface",
    Kind::Table(SurfaceTable::TABLE),
    Optional,
    "The space inside a closed surface of triangles. Only in 3-D.",
)
.example(r#"{ triangles = { file = "body.stl" } }"#);
