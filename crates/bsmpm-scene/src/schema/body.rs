//! Schema of bodies and their shapes.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Key, Kind, Range, Table, key, one_of};
use crate::words::{Axis, Word};

pub(super) static BODY: Table = Table {
    header: "[[body]]",
    doc: "A body of soil, which is filled with material points.",
    keys: &[
        key("material", Name, Required, "Name of the body's material.").example(r#""clay""#),
        key(
            "name",
            Name,
            Optional,
            "Name of the body in stages, histories and results.",
        )
        .example(r#""lift_1""#),
        BOX_KEY,
        POLYGON_KEY,
        CIRCLE_KEY,
        EXTRUDE_KEY,
        SPHERE_KEY,
        REVOLVE_KEY,
        TERRAIN_KEY,
        SURFACE_KEY,
        key(
            "subtract",
            Tables(&SUBTRACT),
            Optional,
            "Shapes that are removed from the body.",
        )
        .example("[{ box = { lower = [2.0, 2.0], upper = [4.0, 4.0] } }]"),
        key(
            "points_per_cell",
            Count(1, 100),
            Required,
            "Number of material points along each axis of a cell. Without this key `accuracy` or `purpose` chooses the \
             number.",
        )
        .example("3")
        .or_preset(),
        key(
            "velocity",
            Vector(In::Velocity, Range::ANY),
            Optional,
            "Velocity at the start. Without this key the body is at rest.",
        )
        .symbol("v")
        .example("[1.0, 0.0]"),
        key(
            "spin",
            Kind::Table(&SPIN),
            Optional,
            "Rigid-body rotation at the start, added to `velocity`.",
        )
        .example("{ rate = 1.0, about = [0.0, 0.0] }"),
    ],
    exclusive: &[one_of(SHAPES, true)],
};

const SHAPES: &[&str] = &[
    "box", "polygon", "circle", "extrude", "sphere", "revolve", "terrain", "surface",
];

pub(super) const POLYGON: Kind = Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY)]);

static SPIN: Table = Table {
    header: "spin = { rate, about, axis }",
    doc: "Rigid-body rotation at the start. A material point at x has the velocity `velocity` + rate × (x - about).",
    keys: &[
        key(
            "rate",
            Quantity(In::Number, Range::ANY),
            Required,
            "Angular velocity in rad/s, positive counter-clockwise.",
        )
        .symbol("ω")
        .example("1.0"),
        key(
            "about",
            Vector(In::Length, Range::ANY),
            Required,
            "Centre of the rotation.",
        )
        .example("[0.0, 0.0]"),
        key(
            "axis",
            Vector(In::Number, Range::ANY),
            Optional,
            "Axis of the rotation in 3-D. The rotation is right-handed about it. Default: the vertical axis.",
        )
        .example("[0.0, 0.0, 1.0]"),
    ],
    exclusive: &[],
};

pub(super) static CIRCLE: Table = Table {
    header: "circle = { centre, radius }",
    doc: "A circle.",
    keys: &[
        key(
            "centre",
            Pair(In::Length, Range::ANY),
            Required,
            "Centre of the circle.",
        )
        .example("[2.0, 2.0]")
        .renamed_from(&["center"]),
        key(
            "radius",
            Quantity(In::Length, Range::POSITIVE),
            Required,
            "Radius of the circle.",
        )
        .example(r#""1 m""#),
    ],
    exclusive: &[],
};

static SUBTRACT: Table = Table {
    header: "subtract = [{ ... }, ...]",
    doc: "A shape that is removed from a body. The shape may extend beyond the body.",
    keys: &[
        BOX_KEY,
        POLYGON_KEY,
        CIRCLE_KEY,
        EXTRUDE_KEY,
        SPHERE_KEY,
        REVOLVE_KEY,
        TERRAIN_KEY,
        SURFACE_KEY,
    ],
    exclusive: &[one_of(SHAPES, true)],
};

static TERRAIN: Table = Table {
    header: "terrain = { top, base, level }",
    doc: "Ground between a terrain surface and a base. The surface is a regular raster of heights with bilinear \
          interpolation.",
    keys: &[
        key(
            "top",
            HEIGHTS,
            Required,
            "Heights of the terrain: rows [x, y, z] in any order. A file may also be an ESRI ASCII grid, whose values \
             are heights at the centres of its cells.",
        )
        .example(r#"{ file = "terrain.asc" }"#),
        key(
            "base",
            HEIGHTS,
            Optional,
            "Heights of the base at the same x and y as `top`. The base must not be above the terrain.",
        )
        .example(r#"{ file = "bedrock.asc" }"#),
        key(
            "level",
            Quantity(In::Length, Range::ANY),
            Optional,
            "Alternative to `base`: height of a horizontal base.",
        )
        .example("0.0"),
    ],
    exclusive: &[one_of(&["base", "level"], true)],
};

pub(super) const HEIGHTS: Kind = Rows(&[
    (In::Length, Range::ANY),
    (In::Length, Range::ANY),
    (In::Length, Range::ANY),
]);

pub(super) static SURFACE: Table = Table {
    header: "surface = { triangles, scale }",
    doc: "A surface of triangles. The surface of a body must be closed, and closed surfaces inside it are cavities. \
          The surface of a traction may be open, but must be in one piece.",
    keys: &[
        key(
            "triangles",
            TRIANGLES,
            Required,
            "A row for each triangle: the nine coordinates of its three corners. A file may also be STL.",
        )
        .example(r#"{ file = "body.stl" }"#),
        key(
            "scale",
            Quantity(In::Number, Range::POSITIVE),
            Default("1.0"),
            "Factor that multiplies all coordinates, for instance 0.001 for millimetres.",
        )
        .example("0.001"),
    ],
    exclusive: &[],
};

const TRIANGLES: Kind = Rows(&[(In::Length, Range::ANY); 9]);

static EXTRUDE: Table = Table {
    header: "extrude = { polygon, circle, along, from, to }",
    doc: "A 2-D outline that is extended along one axis. The coordinates of the outline are those of the other two \
          axes, in the order x, y, z. A circle gives a cylinder.",
    keys: &[
        POLYGON_KEY,
        CIRCLE_KEY,
        key(
            "along",
            Choice(Axis::WORDS),
            Required,
            "Axis along which the outline is extended.",
        )
        .example(r#""z""#),
        key(
            "from",
            Quantity(In::Length, Range::ANY),
            Required,
            "Coordinate at which the shape begins.",
        )
        .example("0.0"),
        key(
            "to",
            Quantity(In::Length, Range::ANY),
            Required,
            "Coordinate at which the shape ends.",
        )
        .example(r#""2 m""#),
    ],
    exclusive: &[one_of(&["polygon", "circle"], true)],
};

pub(super) static SPHERE: Table = Table {
    header: "sphere = { centre, radius }",
    doc: "A sphere.",
    keys: &[
        key(
            "centre",
            Vector(In::Length, Range::ANY),
            Required,
            "Centre of the sphere.",
        )
        .example("[0.0, 0.0, 1.0]")
        .renamed_from(&["center"]),
        key(
            "radius",
            Quantity(In::Length, Range::POSITIVE),
            Required,
            "Radius of the sphere.",
        )
        .example(r#""1 m""#),
    ],
    exclusive: &[],
};

pub(super) static REVOLVE: Table = Table {
    header: "revolve = { polygon, circle, about }",
    doc: "An outline that is rotated about a vertical axis. The coordinates of the outline are [radius, z].",
    keys: &[
        key(
            "polygon",
            POLYGON,
            Optional,
            "Corners of a polygon as [radius, z], clockwise or counter-clockwise.",
        )
        .example("[[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]]"),
        key(
            "circle",
            Kind::Table(&CIRCLE),
            Optional,
            "Alternative to `polygon`: a circle, which gives a torus.",
        )
        .example(r#"{ centre = [2.0, 2.0], radius = "1 m" }"#),
        key(
            "about",
            Pair(In::Length, Range::ANY),
            Required,
            "Coordinates x and y of the vertical axis.",
        )
        .example("[0.0, 0.0]"),
    ],
    exclusive: &[one_of(&["polygon", "circle"], true)],
};

pub(super) static BOX: Table = Table {
    header: "box = { lower, upper }",
    doc: "A rectangle, in 3-D a cuboid, with edges parallel to the axes. Edges need not be grid lines.",
    keys: &[
        key(
            "lower",
            Vector(In::Length, Range::ANY),
            Required,
            "Corner with the smallest coordinates.",
        )
        .example("[0.0, 0.0]"),
        key(
            "upper",
            Vector(In::Length, Range::ANY),
            Required,
            "Corner with the largest coordinates.",
        )
        .example("[10.0, 4.0]"),
    ],
    exclusive: &[],
};

// Keys that several tables have.
const BOX_KEY: Key = key("box", Kind::Table(&BOX), Optional, "A rectangle, in 3-D a cuboid.")
    .example("{ lower = [0.0, 0.0], upper = [10.0, 4.0] }");
const POLYGON_KEY: Key = key(
    "polygon",
    POLYGON,
    Optional,
    "Corners of a polygon, clockwise or counter-clockwise.",
)
.example("[[0.0, 0.0], [20.0, 0.0], [0.0, 10.0]]");
pub(super) const CIRCLE_KEY: Key = key(
    "circle",
    Kind::Table(&CIRCLE),
    Optional,
    "A circle. Parts outside the grid are ignored.",
)
.example(r#"{ centre = [2.0, 2.0], radius = "1 m" }"#);
const EXTRUDE_KEY: Key = key(
    "extrude",
    Kind::Table(&EXTRUDE),
    Optional,
    "An outline that is extended along an axis, for instance a cylinder. Only in 3-D.",
)
.example(r#"{ circle = { centre = [0.0, 0.0], radius = 1.0 }, along = "z", from = 0.0, to = 2.0 }"#);
const SPHERE_KEY: Key = key("sphere", Kind::Table(&SPHERE), Optional, "A sphere. Only in 3-D.")
    .example(r#"{ centre = [0.0, 0.0, 1.0], radius = "1 m" }"#);
const REVOLVE_KEY: Key = key(
    "revolve",
    Kind::Table(&REVOLVE),
    Optional,
    "An outline that is rotated about a vertical axis. Only in 3-D.",
)
.example("{ polygon = [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]], about = [0.0, 0.0] }");
const TERRAIN_KEY: Key = key(
    "terrain",
    Kind::Table(&TERRAIN),
    Optional,
    "The ground below a terrain surface. Only in 3-D.",
)
.example(r#"{ top = { file = "terrain.asc" }, level = 0.0 }"#);
const SURFACE_KEY: Key = key(
    "surface",
    Kind::Table(&SURFACE),
    Optional,
    "The space inside a closed surface of triangles. Only in 3-D.",
)
.example(r#"{ triangles = { file = "body.stl" } }"#);
