//! The tables of bodies and their shapes.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, key, one_of};
use crate::words::{Axis, Word};

pub(super) static BODY: Table = Table {
    header: "[[body]]",
    doc: "A body made of material points",
    keys: &[
        key("material", Name, Required, "name of its material"),
        key("name", Name, Optional, "what stages and histories call it"),
        key("box", Kind::Table(&BOX), Optional, "a rectangle, in 3-D a cuboid"),
        key("polygon", POLYGON, Optional, "corners of a polygon, in either direction; its points are those inside"),
        key("circle", Kind::Table(&CIRCLE), Optional, "a circle; its points are those inside"),
        key("extrude", Kind::Table(&EXTRUDE), Optional, "in 3-D: an outline along an axis, e.g. a cylinder"),
        key("sphere", Kind::Table(&SPHERE), Optional, "in 3-D: a sphere"),
        key("revolve", Kind::Table(&REVOLVE), Optional, "in 3-D: an outline about a vertical"),
        key("terrain", Kind::Table(&TERRAIN), Optional, "in 3-D: what lies under a raster of heights"),
        key("surface", Kind::Table(&SURFACE), Optional, "in 3-D: what a closed surface of triangles encloses"),
        key("subtract", Tables(&SUBTRACT), Optional, "shapes that are cut out"),
        key("points_per_cell", Count(1, 100), Required, "points along each axis of a cell"),
        key("velocity", Vector(In::Velocity, Range::ANY), Optional, "at the start; absent: at rest"),
        key("spin", Kind::Table(&SPIN), Optional, "rotation as if rigid at the start, besides velocity"),
    ],
    exclusive: &[one_of(SHAPES, true)],
};

const SHAPES: &[&str] = &["box", "polygon", "circle", "extrude", "sphere", "revolve", "terrain", "surface"];

pub(super) const POLYGON: Kind = Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY)]);

static SPIN: Table = Table {
    header: "spin = { rate, about, axis }",
    doc: "Rotation at the start: v = velocity + rate x (x - about)",
    keys: &[
        key("rate", Quantity(In::Number, Range::ANY), Required, "rad/s, counter-clockwise"),
        key("about", Vector(In::Length, Range::ANY), Required, "a place that it leaves at rest"),
        key(
            "axis",
            Vector(In::Number, Range::ANY),
            Optional,
            "in 3-D: towards where it is seen to turn so; up unless given",
        ),
    ],
    exclusive: &[],
};

pub(super) static CIRCLE: Table = Table {
    header: "circle = { centre, radius }",
    doc: "A circle",
    keys: &[
        key("centre", Pair(In::Length, Range::ANY), Required, "its centre").renamed_from(&["center"]),
        key("radius", Quantity(In::Length, Range::POSITIVE), Required, "its radius"),
    ],
    exclusive: &[],
};

static SUBTRACT: Table = Table {
    header: "subtract = [{ ... }, ...]",
    doc: "A shape that is cut out of a body; it may reach beyond the body",
    keys: &[
        key("box", Kind::Table(&BOX), Optional, "a rectangle"),
        key("polygon", POLYGON, Optional, "corners of a polygon, in either direction"),
        key("circle", Kind::Table(&CIRCLE), Optional, "a circle"),
        key("extrude", Kind::Table(&EXTRUDE), Optional, "in 3-D: an outline along an axis"),
        key("sphere", Kind::Table(&SPHERE), Optional, "in 3-D: a sphere"),
        key("revolve", Kind::Table(&REVOLVE), Optional, "in 3-D: an outline about a vertical"),
        key("terrain", Kind::Table(&TERRAIN), Optional, "in 3-D: what lies under a raster of heights"),
        key("surface", Kind::Table(&SURFACE), Optional, "in 3-D: what a closed surface of triangles encloses"),
    ],
    exclusive: &[one_of(SHAPES, true)],
};

static TERRAIN: Table = Table {
    header: "terrain = { top, base, level }",
    doc: "What lies under the posts of a regular raster of heights, bilinear between them, and above a base",
    keys: &[
        key("top", HEIGHTS, Required, "rows [x, y, z] in any order; a file may also be an ASCII grid, by its centres"),
        key("base", HEIGHTS, Optional, "the same for the lower side, at the same posts; nowhere above the top"),
        key("level", Quantity(In::Length, Range::ANY), Optional, "height of a level base instead"),
    ],
    exclusive: &[one_of(&["base", "level"], true)],
};

pub(super) const HEIGHTS: Kind = Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY), (In::Length, Range::ANY)]);

pub(super) static SURFACE: Table = Table {
    header: "surface = { triangles, scale }",
    doc: "Of a body what a closed surface of triangles encloses (shells may lie inside one another, turned the other \
          way); of a traction the surface, which may be open, in one piece",
    keys: &[
        key("triangles", TRIANGLES, Required, "rows [x, y, z] of three corners each; a file may also be STL"),
        key(
            "scale",
            Quantity(In::Number, Range::POSITIVE),
            Default("1.0"),
            "factor of all places; 0.001 of millimetres",
        ),
    ],
    exclusive: &[],
};

const TRIANGLES: Kind = Rows(&[(In::Length, Range::ANY); 9]);

static EXTRUDE: Table = Table {
    header: "extrude = { polygon, circle, along, from, to }",
    doc: "An outline in the plane of the other two axes, in their order, between two places of an axis; a circle makes a \
          cylinder",
    keys: &[
        key("polygon", POLYGON, Optional, "corners of a polygon, in either direction"),
        key("circle", Kind::Table(&CIRCLE), Optional, "a circle"),
        key("along", Choice(Axis::WORDS), Required, "the axis"),
        key("from", Quantity(In::Length, Range::ANY), Required, "where it begins"),
        key("to", Quantity(In::Length, Range::ANY), Required, "where it ends"),
    ],
    exclusive: &[one_of(&["polygon", "circle"], true)],
};

pub(super) static SPHERE: Table = Table {
    header: "sphere = { centre, radius }",
    doc: "A sphere",
    keys: &[
        key("centre", Vector(In::Length, Range::ANY), Required, "its centre").renamed_from(&["center"]),
        key("radius", Quantity(In::Length, Range::POSITIVE), Required, "its radius"),
    ],
    exclusive: &[],
};

pub(super) static REVOLVE: Table = Table {
    header: "revolve = { polygon, circle, about }",
    doc: "An outline of the radius and z, turned about a vertical",
    keys: &[
        key("polygon", POLYGON, Optional, "corners of a polygon, [radius, z], in either direction"),
        key("circle", Kind::Table(&CIRCLE), Optional, "a circle, which makes a ring"),
        key("about", Pair(In::Length, Range::ANY), Required, "x and y of the vertical"),
    ],
    exclusive: &[one_of(&["polygon", "circle"], true)],
};

pub(super) static BOX: Table = Table {
    header: "box = { lower, upper }",
    doc: "A rectangle, in 3-D a cuboid, along the axes; it may cut cells",
    keys: &[
        key("lower", Vector(In::Length, Range::ANY), Required, "lower corner"),
        key("upper", Vector(In::Length, Range::ANY), Required, "upper corner"),
    ],
    exclusive: &[],
};
