//! Tests that invalid tables [[body]] are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row(
        "points_per_cell = 3",
        "points-per-cell = 3",
        "body.0.points-per-cell",
        "did you mean `points_per_cell`?",
    ),
    row("\"-1 m/s\"", "\"-1 m/s2\"", "body.2.velocity", "expected a velocity"),
    row(
        "material = \"sand\"",
        "material = 5",
        "body.0.material",
        "expected a name",
    ),
    row(
        "material = \"sand\"",
        "material = \"sa nd\"",
        "body.0.material",
        "expected a name",
    ),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row(
        "points_per_cell = 3",
        "points_per_cell = 0",
        "body.0.points_per_cell",
        "1 <= points_per_cell <= 100",
    ),
    row(
        "points_per_cell = 3",
        "points_per_cell = 101",
        "body.0.points_per_cell",
        "1 <= points_per_cell <= 100",
    ),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row(
        "material = \"sand\"",
        "material = \"snad\"",
        "body.0.material",
        "E0220: body.0.material: [material.snad] is not defined. Did you mean `sand`?",
    ),
    row(
        "upper = [4.0, 1.0] }",
        "upper = [4.0, 0.0] }",
        "body.0.box.upper",
        "E0203",
    ),
    row(
        "upper = [4.0, 1.0] }",
        "upper = [4.1, 1.0] }",
        "body.0.box.upper",
        "outside the grid, which ends at x = 4 m",
    ),
    row(
        "lower = [1.0, 2.0]",
        "lower = [-1.0, 2.0]",
        "body.2.box.lower",
        "outside the grid, which starts at x = 0",
    ),
    row(
        "upper = [4.0, 1.0] }",
        "upper = [4.0, 1e-10] }",
        "body.0.box.upper",
        "E0219",
    ),
    row(
        "box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }\n",
        "",
        "body.0",
        "none of the keys box",
    )
    .up(2),
];
