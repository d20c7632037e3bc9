//! Tests that invalid tables [grid] are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row("lower = [0.0, \"0 m\"]", "lower = [0.0]", "grid.lower", "a list of two"),
    row(
        "lower = [0.0, \"0 m\"]",
        "lower = [0.0, 0.0, 0.0]",
        "grid.lower",
        "found a list of 3",
    ),
    row("lower = [0.0, \"0 m\"]", "lower = 0.0", "grid.lower", "a list of two"),
    row(
        "lower = [0.0, \"0 m\"]",
        "lower = [0.0, \"0 s\"]",
        "grid.lower",
        "expected a length (m, cm, mm, um, nm, km), found `s`, a unit of time",
    ),
    row(
        "degree = \"quadratic\"",
        "degree = \"quartic\"",
        "grid.degree",
        "expected one of",
    ),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row("cell  = [0.5, \"50 cm\"]", "cell  = 0", "grid.cell", "(cell > 0"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = -0.0", "grid.cell", "(cell > 0"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 1e-9", "grid.cell", "E0204"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = [0.5, 1e-9]", "grid.cell", "E0204"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 4e-6", "grid.cell", "cells and"),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "cell  = [0.5, 0.1, 0.1]",
        "grid.cell",
        "found a list of 3",
    ),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row(
        "cell  = [0.5, \"50 cm\"]",
        "cell = 0.5\nknots.x = [0, 1]",
        "grid.knots",
        "E0016",
    )
    .down(1),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 2, 1, 4]\nknots.y = [0, 3]",
        "grid.knots.x",
        "E0208",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1, 2, 1, 4]\nknots.y = [0, 3]",
        "grid.knots.x",
        "E0208",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1, 1, 1, 4]\nknots.y = [0, 3]",
        "grid.knots.x",
        "1 is given 3 times in [grid.knots], but is allowed at most 2",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1, 4]\nknots.y = [0, 0, 3]",
        "grid.knots.y",
        "0 is given 2 times in [grid.knots], but is allowed at most 1",
    )
    .down(1),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.y = [0, 3]\nknots.x = [0]",
        "grid.knots.x",
        "fewer than two",
    )
    .down(1),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1e-51, 4]\nknots.y = [0, 3]",
        "grid.knots",
        "shortest cell along x is 1e-51",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 4]\nknots.y = [-1e9, 3, 3.00000001]",
        "grid.knots",
        "shortest cell along y is 0e0",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 4]\nknots.y = [0, nan]",
        "grid.knots.y",
        "E0010",
    )
    .down(1),
    row(
        "upper = [4.0, 3.0]\ncell  = [0.5, \"50 cm\"]",
        "upper = [5.0, 3.0]\nknots.x = [0, 4]\nknots.y = [0, 3]",
        "grid.upper",
        "E0210: grid.upper: the grid has a corner at x = 5 m, but",
    ),
    row("lower = [0.0, \"0 m\"]\n", "", "grid.lower", "E0211").up(1),
    row("upper = [4.0, 3.0]", "upper = [4.0, 0.0]", "grid.upper", "E0203"),
    row("cell  = [0.5, \"50 cm\"]", "cell = [0.5, 0.7]", "grid.cell", "E0212"),
];
