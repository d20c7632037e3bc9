//! Tests that invalid grids, boundaries and gravity of 3-D cases are refused.

use crate::{Row, row};

/// Changes of `solid.toml`.
pub const GRID: &[Row] = &[
    row(
        "lower = [0.0, 0.0, 0.0]",
        "lower = [0.0, 0.0]",
        "grid.lower",
        "three in 3-D",
    ),
    row(
        "cell  = [0.5, 1.0, 0.5]",
        "cell  = [0.5, 1.0]",
        "grid.cell",
        "three in 3-D",
    ),
    row(
        "upper = [4.0, 3.0, 3.0]",
        "upper = [4.0, 3.0, -1.0]",
        "grid.upper",
        "m along z. Exchange",
    ),
    row(
        "[0.0, 0.0, -9.81]",
        "[0.0, -9.81]",
        "gravity.acceleration",
        "three in 3-D",
    ),
    row(
        "left   = \"roller\"",
        "left   = \"absorbing\"",
        "boundary.left",
        "E0226",
    ),
    row(
        "back   = \"roller\"\nbottom = \"fixed\"",
        "back   = { friction_coefficient = 0.3 }\nbottom = { friction_coefficient = 0.3 }",
        "boundary.bottom",
        "share an edge",
    )
    .down(1),
    row(
        "\"consistent-f-bar\"",
        "\"subgrid-f-bar\"",
        "stabilisation.method",
        "E0226",
    ),
    row(
        "[0.5, 0.0, 1.0, 0.0]",
        "[0.5, 0.0, 1.0]",
        "shaking.acceleration",
        "found a list of 3",
    ),
    row(
        "[0.0, 0.0, -9.81]",
        "[0.0, -1.0, -9.81]\n[water]\nlevel = 1.0",
        "gravity.acceleration",
        "E0523",
    ),
    row(
        "geometry = \"3d\"",
        "geometry = \"3d\"\naccuracy = \"draft\"",
        "accuracy",
        "E0226",
    )
    .down(1),
    row(
        "cell  = [0.5, 1.0, 0.5]",
        "knots = { x = [0, 2, 4], y = [0, 3] }",
        "grid.knots.z",
        "E0206",
    ),
];
