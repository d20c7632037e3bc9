//! Tests that invalid quasi-static cases are refused.

use crate::{Row, row};

/// Quasi-static cases (I13, I16, I18).
pub const QUASI_STATIC: &[Row] = &[
    row("end   = 1.0", "end = \"1 s\"", "analysis.end", "E0023"),
    row("every = 0.5", "every = \"1 s\"", "output.every", "E0023"),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free\"",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"roller\"",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "left = \"roller\"",
        "boundary",
        "no support restrains the bodies along y",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "top = \"fixed\"",
        "boundary",
        "no support restrains the bodies along x and y",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"contact\"",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free\"\n[[rigid]]\nname = \"smooth\"\npolygon = [[0, -1], [2, -1], [2, 0], [0, 0]]",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free\"\n[[rigid]]\nname = \"free\"\npolygon = [[0, -1], [2, -1], [2, 0], [0, \
         0]]\nfriction_coefficient = 0.5\n\
         free = [\"y\"]\nforce = [0, 1]",
        "boundary",
        "no support restrains the bodies along x and y",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"absorbing\"",
        "boundary.bottom",
        "E0671",
    ),
    row(
        "bottom = \"fixed\"",
        "left = \"free-field\"",
        "boundary.left",
        "so the free field does not move",
    ),
    row("bottom = \"fixed\"", "left = \"free-field\"", "boundary.left", "E0671"),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nvelocity = [1, 0]",
        "body.0.velocity",
        "E0218",
    )
    .down(1),
    row(
        "[output]",
        "[[history]]\nquantity = \"momentum\"\n[output]",
        "history.0.quantity",
        "E0645",
    )
    .down(1),
    row(
        "steps = 4",
        "steps = 4\nspectral_radius = 0.8",
        "analysis.spectral_radius",
        "needs inertia",
    )
    .down(1),
    row(
        "steps = 4",
        "steps = 4\nmass = \"consistent\"",
        "analysis.mass",
        "E0218",
    )
    .down(1),
    row(
        "steps = 4",
        "steps = 4\nnewmark_gamma = 0.6",
        "analysis.newmark_gamma",
        "needs inertia",
    )
    .down(1),
    row("steps = 4", "steps = 4.5", "analysis.steps", "whole number"),
    row(
        "model   = \"elastic\"",
        "model = \"sensitive-clay\"\ncohesion = 1e4\nsensitivity = 2\nsoftening_strain = 20\n\
         rate_parameter = 0.1\nreference_rate = 1e-4",
        "material.soil.rate_parameter",
        "E0319",
    )
    .down(4),
    row(
        "model   = \"elastic\"",
        "model = \"mu-i\"\nmu_s = 0.38\nmu_2 = 0.6\ninertial_number = 0.3\ngrain_diameter = 1e-3\ngrain_density = 2500",
        "material.soil.model",
        "E0319",
    ),
    row(
        "box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }\npoints_per_cell = 3",
        "box = 5\npoints_per_cell = 3",
        "body.0.box",
        "expected a table",
    ),
    row("[[body]]", "[body]", "body", "expected a list of tables, [[body]]"),
];
