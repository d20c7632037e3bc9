//! Tests that invalid bodies, materials and rigid bodies of 3-D cases are refused.

use crate::{Row, row};

const BOX: &str = "box = { lower = [0.0, 0.0, 0.0], upper = [2.0, 3.0, 1.0] }";

const BALL: &str = "sphere = { centre = [3.5, 0.5, 2.0], radius = 0.25 }";

const BASE: &str = "base = [[2, 0, 1], [3, 0, 1], [2, 3, 1], [3, 3, 1]]";

/// Changes of `solid.toml`.
pub const BODIES: &[Row] = &[
    row(
        "velocity = [0.0, 0.0, -1.0]",
        "velocity = [0.0, -1.0]",
        "body.0.velocity",
        "three in 3-D",
    ),
    row(
        BOX,
        "box = { lower = [0.0, 0.0, 1.0], upper = [2.0, 3.0, 1.0] }",
        "body.0.box.upper",
        "is not above the lower corner",
    ),
    row(
        BOX,
        "box = { lower = [0.0, 0.0, 0.0], upper = [2.0, 3.0, 4.0] }",
        "body.0.box",
        "ends at z = 3",
    ),
    row(BOX, "polygon = [[0, 0], [1, 0], [0, 1]]", "body.0.polygon", "E0225"),
    row("radius = 0.7", "radius = 1.7", "body.1.extrude", "outside the grid"),
    row("to = 1.0 }\n", "to = 0.0 }\n", "body.1.extrude.to", "is not above from"),
    row(
        "along = \"z\"",
        "along = \"r\"",
        "body.1.extrude.along",
        "expected one of",
    ),
    row(
        "radius = 0.5 }\npoints",
        "radius = 1.5 }\npoints",
        "body.2.sphere",
        "outside the grid",
    ),
    row(
        "[[0.0, 1.0]",
        "[[-0.5, 1.0]",
        "body.3.revolve.polygon",
        "smallest radius is -0.5 m",
    ),
    row(
        "revolve = { polygon = [[0.0, 1.0], [0.8, 1.0], [0.0, 2.0]], about = [1.0, 1.5] }\n\
         subtract = [{ revolve = { circle = { centre = [0.4, 1.2], radius = 0.1 }, about = [1.0, 1.5] } }]\n",
        "revolve = { polygon = [[0.8, 1], [0.800000001, 1], [0.800000001, 2], [0.8, 2]], about = [1.0, 1.5] }\n",
        "body.3.revolve",
        "E0037",
    ),
    row(
        "level = 2.5",
        "level = 2.8",
        "body.4.terrain.top",
        "at x = 2 m, y = 0 m the top (2.75 m) is below the base (2.8 m)",
    ),
    row(
        "level = 2.5",
        "base = [[2, 0, 1]]",
        "body.4.terrain.base",
        "two points along x",
    ),
    row(
        "level = 2.5",
        BASE,
        "body.4.terrain.base",
        "heights at different points",
    ),
    row(
        "[4.0, 3.0, 2.75]]",
        "[3.5, 3.0, 2.75]]",
        "body.4.terrain.top",
        "do not form a regular grid of points",
    ),
    row(
        "[4.0, 3.0, 2.75]]",
        "[4.0, 3.0, 3.75]]",
        "body.4.terrain",
        "ends at z = 3",
    ),
    row(
        "  [5, 3, 4, 5, 5, 4, 7, 3, 4],",
        "  ",
        "body.5.surface.triangles",
        "not closed at 3 edges",
    )
    .up(1),
    row(
        "[5, 3, 4, 5, 5, 4, 7, 3, 4]",
        "[5, 3, 4, 5, 5, 4]",
        "body.5.surface.triangles",
        "a list of 6",
    ),
    row(
        "5, 3, 6, 5, 5, 4],\n], scale = 0.5",
        "5, 3, 6, 5, 5, 4],\n], scale = 0.7",
        "body.5.surface",
        "E0202",
    )
    .up(1),
    row(
        "5, 3, 6, 5, 5, 4],\n], scale = 0.5",
        "5, 3, 6, 5, 5, 4],\n], scale = 500",
        "body.5.surface",
        "reaches from [2500.000, 1500.000, 2000.000] to [3500.000, 2500.000, 3000.000] m",
    )
    .up(1),
    row(
        "[gravity]",
        "[[rigid]]\nname = \"a\"\ncircle = { centre = [3, 2], radius = 0.5 }\n[gravity]",
        "rigid.3.circle",
        "E0432 .. `sphere`",
    )
    .down(2),
    row(
        BALL,
        "sphere = { centre = [1.0, 1.5, 0.6], radius = 0.4 }",
        "rigid.0.sphere",
        "E0431 .. body.0",
    ),
    row(
        BALL,
        "sphere = { centre = [1.0, 1.5, 0.6], radius = 0.05 }",
        "rigid.0.sphere",
        "E0431 .. body.0",
    ),
    row(
        BALL,
        "sphere = { centre = [1.0, 1.5], radius = 0.4 }",
        "rigid.0.sphere.centre",
        "three in 3-D",
    ),
    row(
        BALL,
        "box = { lower = [0, 0, 3], upper = [1, 1, 3] }",
        "rigid.0.box.upper",
        "E0203",
    ),
    row(
        BALL,
        "terrain = { top = [[0, 0, 1], [1, 0, 1]] }",
        "rigid.0.terrain.top",
        "two points along x",
    ),
    row(
        BALL,
        "revolve = { circle = { centre = [1, 1], radius = 0.5 }, about = [0, 0] }",
        "rigid.0.revolve.circle",
        "E0432 .. `polygon`",
    ),
    row(
        BALL,
        "revolve = { polygon = [[-0.1, 3], [1, 3], [0, 4]], about = [0, 0] }",
        "rigid.0.revolve.polygon",
        "E0434",
    ),
    row(
        "density = 2000",
        "density = 2000\nru = 1.2",
        "material.soil.ru",
        "(0 < ru < 1",
    )
    .down(1),
    row(
        "velocity = [0.0, 0.0, -1.0]",
        "spin = { rate = 1, about = [0, 0] }",
        "body.0.spin.about",
        "three in 3-D",
    ),
    row(
        "axis = [0.0, 1.0, 1.0]",
        "axis = [0, 0, 0]",
        "body.2.spin.axis",
        "has no direction",
    ),
];
