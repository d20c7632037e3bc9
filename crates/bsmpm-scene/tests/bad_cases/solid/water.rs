//! Tests that invalid drains, inflows and water tables of 3-D cases are refused.

use crate::{Row, row};

const FLOWS: &str = "density = 2000\nporosity = 0.4\ndrainage = \"coupled\"\npermeability = [1e-6, 1e-7, 1e-6]\n\
    [water]\nlevel = 1.0\n[[drain]]\nsurface = true\n";

const PERMEABLE: &str = "density = 2000\nporosity = 0.4\ndrainage = \"coupled\"\npermeability = [1e-6, 1e-7]\n";

/// Changes of `wet_solid.toml`.
pub const WET: &[Row] = &[
    row(
        "upper = [2.0, 3.0, 1.5] }\nseepage",
        "upper = [2.5, 3.0, 1.5] }\nseepage",
        "drain.0.rectangle",
        "E0234",
    ),
    row(
        "disc     = { centre = [1.0",
        "disc = { centre = [3.5",
        "drain.1.disc",
        "E0401",
    ),
    row(
        "upper = [1.0, 3.0, 1.5] }\nrate",
        "upper = [3.0, 3.0, 1.5] }\nrate",
        "inflow.0.rectangle",
        "E0401",
    ),
    row(
        "disc = { centre = [1.5, 1.0, 1.5], radius = 0.4 }",
        "from = [0, 0]\nto = [1, 0]",
        "inflow.1.from",
        "E0225",
    ),
    row(
        "rectangle = { lower = [2.0, 0.0, 0.0], upper = [2.0, 3.0, 1.5] }",
        "surface = true",
        "drain.0.surface",
        "E0225",
    ),
];

/// Changes of `solid.toml`.
pub const WATER: &[Row] = &[
    row(
        "[gravity]",
        "[water]\nlevel = 0.0\n[gravity]",
        "water.level",
        "E0524 .. z = 0 m",
    )
    .down(1),
    row(
        "[gravity]",
        "[[inflow]]\nfrom = [0, 0]\nto = [1, 1]\nrate = 1e-6\n[gravity]",
        "inflow.0.from",
        "E0225",
    )
    .down(1),
    row("density = 2000", FLOWS, "drain.0.surface", "E0225").down(7),
    row("density = 2000", PERMEABLE, "material.soil.permeability", "expected").down(3),
];
