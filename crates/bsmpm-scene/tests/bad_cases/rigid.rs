//! Invalid rigid bodies.

use super::{Row, row};

const POLYGON: &str = "polygon  = [[1.9, 1.35], [2.45, \"135 cm\"], [2.45, 1.9], [1.9, 1.9]]";
const FREE: &str = "free    = [\"x\", \"y\", \"rotation\"]";
const PATH: &str = "path     = [[\"0.5 s\", -0.1, 0.0], [1.0, 0.0, \"5 cm\"]]";
const WEIGHED: &str = "free    = [\"x\", \"y\", \"rotation\"]\ndensity = \"0.5 t/m3\"";
const INERTIA: &str = "inertia = 10.0\n";

/// Shapes, motions and what acts on rigid bodies.
pub const RIGID: &[Row] = &[
    row(
        "name    = \"pipe\"",
        "name    = \"plough\"",
        "rigid.1.name",
        "E0421 .. `plough`",
    ),
    row(
        POLYGON,
        "polygon = [[2.1, 1.4], [2.4, 1.8]]",
        "rigid.0.polygon",
        "2 corners",
    ),
    row(
        POLYGON,
        "polygon = [[2.1, 1.4], [2.9, 1.4], [2.9, 1.8], [2.1, 1.8]]",
        "rigid.0.polygon",
        "E0431 .. body.3 .. Subtract",
    ),
    row(
        POLYGON,
        "polygon = [[0, 0.5], [4, 0.5], [4, 3], [0, 3]]",
        "rigid.0.polygon",
        "E0431",
    ),
    row(
        POLYGON,
        "circle = { centre = [0.5, 2.0], radius = 0.6 }",
        "rigid.0.circle",
        "E0431",
    ),
    row(
        "friction_coefficient = 0.4",
        "friction_coefficient = 2.1",
        "rigid.0.friction_coefficient",
        "E0010",
    ),
    row(
        PATH,
        "path = [[0.5, -0.1, 0.0], [0.5, 0.0, 0.0]]",
        "rigid.0.path",
        "E0402",
    ),
    row(
        "rotation = [[\"0.5 s\", \"10 deg\"], [1.0, 0.0]]",
        "rotation = [[0.0, 1.0]]",
        "rigid.0.rotation",
        "E0403 .. 1 degrees",
    ),
    row(
        FREE,
        "free = [\"x\", \"z\"]",
        "rigid.1.free",
        "E0422 .. \"x\", \"y\", \"rotation\"",
    ),
    row(FREE, "free = [\"x\", \"y\"]", "rigid.1.moment", "E0424 .. the rotation").down(4),
    row(
        FREE,
        "free = [\"y\", \"rotation\"]",
        "rigid.1.start_velocity",
        "E0424 .. motion along x",
    )
    .down(6),
    row(
        FREE,
        "free = [\"x\", \"rotation\"]",
        "rigid.1.force",
        "E0424 .. motion along y",
    )
    .down(3),
    row(
        FREE,
        "free = [\"x\", \"y\", \"rotation\"]\npath = [[1.0, 0.0, 0.1]]",
        "rigid.1.path",
        "E0423 .. motion along y",
    )
    .down(1),
    row(
        FREE,
        "free = [\"x\", \"y\", \"rotation\"]\nabout = [3.6, 2.5]",
        "rigid.1.about",
        "E0425",
    )
    .down(1),
    row(
        FREE,
        "free = [\"x\", \"y\", \"rotation\"]\nrotation = [[1.0, 1.0]]",
        "rigid.1.rotation",
        "E0423 .. rotation",
    )
    .down(1),
    row(
        FREE,
        "free = [\"x\", \"y\", \"rotation\"]\nrotation = [[1.0, 1.0]]",
        "rigid.1.rotation",
        "E0423",
    )
    .down(1),
    row(WEIGHED, FREE, "rigid.1.free", "E0427"),
    row(INERTIA, "inertia = 0\n", "rigid.1.inertia", "(inertia > 0"),
    row(
        "friction_coefficient = 0.4\n",
        "friction_coefficient = 0.4\nmass = 5\n",
        "rigid.0.mass",
        "E0426",
    )
    .down(1),
    row("rigid    = \"pipe\"", "rigid    = \"pip\"", "history.10.rigid", "E0612"),
    row(
        "[[history]]\nquantity = \"rigid-force\"\nrigid    = \"pipe\"",
        "[[history]]\nquantity = \"rigid-force\"",
        "history.10.rigid",
        "E0644",
    ),
    row(
        "quantity = \"heave\"",
        "quantity = \"heave\"\nrigid = \"pipe\"",
        "history.5.rigid",
        "E0642",
    )
    .down(1),
];
