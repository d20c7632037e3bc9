//! Tests that invalid footings, loads and stages of 3-D cases are refused.

use crate::{Row, row};

const LOADED: &str = "rectangle = { lower = [0.5, 1.0, 1.0], upper = [1.5, 2.0, 1.0] }";

const PLATE: &str = "rectangle    = { lower = [0.5, 2.0, 1.0], upper = [1.5, 3.0, 1.0] }";

const FORCE: &str = "force = [\"1 N\", 0.0, 0.0]";

/// Changes of `solid.toml`.
pub const LOADS: &[Row] = &[
    row(
        "deactivate  = [\"plate\"]",
        "remove = [\"block\"]",
        "footing.rectangle",
        "E0626",
    )
    .up(37),
    row(
        "back = \"contact\" }",
        "back = \"absorbing\" }",
        "stage.0.boundary.back",
        "E0614",
    ),
    row(
        "front = \"roller\"",
        "front = { friction_coefficient = 1 }, bottom = { friction_coefficient = 1 }",
        "stage.0.boundary.bottom",
        "an edge",
    ),
    row(
        "at    = [0.5, 0.0, 0.5]",
        "at    = [0.5, 0.5]",
        "point_load.0.at",
        "three in 3-D",
    ),
    row(
        "at    = [0.5, 0.0, 0.5]",
        "at    = [3.9, 0.1, 1.9]",
        "point_load.0.at",
        "E0401",
    ),
    row(
        FORCE,
        "force = \"-10 N\"",
        "point_load.0.force",
        "found \"-10 N\". Give three components in 3-D",
    ),
    row(
        FORCE,
        "force = [0.0, \"-10 N/m\"]",
        "point_load.0.force",
        "three components in 3-D, [x, y, z], in N",
    ),
    row(
        FORCE,
        "force = [0.0, 0.0, \"-10 kPa\"]",
        "point_load.0.force",
        "expected a force (N, kN, MN)",
    ),
    row(PLATE, "from = [0, 1]\nto = [1, 1]", "footing.from", "E0225"),
    row(
        PLATE,
        "rectangle = { lower = [0.5, 2, 1], upper = [1.5, 3, 1.2] }",
        "footing.rectangle",
        "E0234",
    ),
    row(
        PLATE,
        "rectangle = { lower = [0.6, 2, 1], upper = [0.9, 3, 1] }",
        "footing.rectangle",
        "shorter than a cell (0.5 m)",
    ),
    row(
        PLATE,
        "rectangle = { lower = [0.5, 2, 2.8], upper = [1.5, 3, 2.8] }",
        "footing.rectangle",
        "E0401",
    ),
    row(
        PLATE,
        "disc = { centre = [1.0, 2.5, 1.0], radius = 0 }",
        "footing.disc.radius",
        "radius > 0",
    ),
    row(
        PLATE,
        "disc = { centre = [9.0, 2.5, 1.0], radius = 0.5 }",
        "footing.disc",
        "no part of the disc is inside the grid",
    ),
    row(
        "displacement = [0.0, 0.0, -0.01]",
        "displacement = [0.0, -0.01]",
        "footing.displacement",
        "three in 3-D",
    ),
    row(
        "displacement = [0.0, 0.0, -0.01]",
        "displacement = [0.1, 0.0, 0.0]",
        "footing.displacement",
        "E0416",
    ),
    row(
        "displacement = [0.0, 0.0, -0.01]",
        "displacement = [0, 0, -1.5]",
        "footing.displacement",
        "E0419",
    ),
    row(
        "[0.5, 0.0, 0.0, -0.01]",
        "[0.5, 0.0, -0.01]",
        "prescribed.0.path",
        "(three in 3-D)",
    ),
    row(
        "normal = \"z\"",
        "normal = \"up\"",
        "prescribed.0.disc.normal",
        "expected one of",
    ),
    row(
        LOADED,
        "rectangle = { lower = [0.5, 1.0, 0.5], upper = [1.5, 2.0, 1.0] }",
        "traction.0.rectangle",
        "E0234",
    ),
    row(
        LOADED,
        "rectangle = { lower = [0.5, 1.0, 1.0], upper = [1.5, 3.5, 1.0] }",
        "traction.0.rectangle",
        "ends at y",
    ),
    row(
        LOADED,
        "rectangle = { lower = [0.5, 1.0, 2.0], upper = [1.5, 2.0, 2.0] }",
        "traction.0.rectangle",
        "no body",
    ),
    row(LOADED, "from = [0, 1]\nto = [1, 1]", "traction.0.from", "E0225"),
    row(
        "centre = [3, 1.5",
        "centre = [9, 1.5",
        "traction.2.sphere",
        "no part of the sphere is inside the grid",
    ),
    row(
        "2.0], radius = 0.5 }\nstress",
        "2.0], radius = 1.5 }\nstress",
        "traction.2.sphere",
        "E0401",
    ),
    row(
        "2.0], radius = 0.5 }\nstress",
        "2.0], radius = 51 }\nstress",
        "traction.2.sphere",
        "loaded points",
    ),
    row(
        "2.0], radius = 0.5 }\nstress = [0, 0, \"1 kPa\"]",
        "2.0], radius = 0.5 }\npressure = \"1 kPa\"",
        "traction.2.pressure",
        "lies on both sides",
    )
    .down(1),
    row("[[7.0, 3, 4", "[[9.0, 3, 4", "traction.3.surface", "ends at x"),
    row(
        "[[7.0, 3, 4, 5, 5, 4, 5, 3, 6]",
        "[[7.0, 3, 4, 5, 3, 6, 5, 5, 4]",
        "traction.3.surface",
        "normals on opposite sides",
    ),
    row(
        "[[7.0, 3, 4, 5, 5, 4,",
        "[[7.0, 3, 4, 5.001, 5, 4,",
        "traction.3.surface",
        "consists of 2 separate pieces",
    ),
    row(
        "[[7.0, 3, 4, 5, 5, 4, 5, 3, 6], [5, 3, 4, 5,",
        "[[5.0, 5, 4, 5,",
        "traction.3.surface.triangles",
        "area",
    ),
    row(
        "stress = [0.0, \"1 kPa\", \"-2 kPa\"]",
        "stress = [0.0, \"-2 kPa\"]",
        "traction.0.stress",
        "three in 3-D",
    ),
    row(
        "stress = [0.0, \"1 kPa\", \"-2 kPa\"]",
        "stress = { value = [0, 0, 1], at_y = 1.0, per_metre = [0, 1] }",
        "traction.0.stress.per_metre",
        "three in 3-D",
    ),
];
