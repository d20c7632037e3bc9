//! The tables of bodies and their shapes.

use super::Kind::*;
use super::Presence::{Optional, Required};
use super::{Dimension as In, Kind, Range, Table, key, one_of};

pub(super) static BODY: Table = Table {
    header: "[[body]]",
    doc: "A body made of material points",
    keys: &[
        key("material", Name, Required, "name of its material"),
        key("name", Name, Optional, "what stages and histories call it"),
        key("box", Kind::Table(&BOX), Optional, "a rectangle"),
        key("polygon", POLYGON, Optional, "corners of a polygon, in either direction; its points are those inside"),
        key("circle", Kind::Table(&CIRCLE), Optional, "a circle; its points are those inside"),
        key("subtract", Tables(&SUBTRACT), Optional, "boxes, polygons and circles that are cut out"),
        key("points_per_cell", Count(1, 100), Required, "points along each axis of a cell"),
        key("velocity", Pair(In::Velocity, Range::ANY), Optional, "at the start; absent: at rest"),
        key("spin", Kind::Table(&SPIN), Optional, "rotation as if rigid at the start, besides velocity"),
    ],
    exclusive: &[one_of(&["box", "polygon", "circle"], true)],
};

pub(super) const POLYGON: Kind = Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY)]);

static SPIN: Table = Table {
    header: "spin = { rate, about }",
    doc: "Rotation at the start: v = velocity + rate x (x - about)",
    keys: &[
        key("rate", Quantity(In::Number, Range::ANY), Required, "rad/s, counter-clockwise"),
        key("about", Pair(In::Length, Range::ANY), Required, "the place that it leaves at rest"),
    ],
    exclusive: &[],
};

pub(super) static CIRCLE: Table = Table {
    header: "circle = { center, radius }",
    doc: "A circle",
    keys: &[
        key("center", Pair(In::Length, Range::ANY), Required, "its centre"),
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
    ],
    exclusive: &[one_of(&["box", "polygon", "circle"], true)],
};

pub(super) static BOX: Table = Table {
    header: "box = { lower, upper }",
    doc: "A rectangle along the axes; it may cut cells",
    keys: &[
        key("lower", Pair(In::Length, Range::ANY), Required, "lower corner"),
        key("upper", Pair(In::Length, Range::ANY), Required, "upper corner"),
    ],
    exclusive: &[],
};
