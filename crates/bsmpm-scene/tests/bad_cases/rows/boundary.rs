//! Tests that invalid tables [boundary] are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row(
        "bottom = \"fixed\"",
        "bottom = \"friction\"",
        "boundary.bottom",
        "expected one of",
    ),
    row("bottom = \"fixed\"", "bottom = 0.3", "boundary.bottom", "expected"),
    row(
        "bottom = \"fixed\"",
        "bottom = { separates = false }",
        "boundary.bottom.friction_coefficient",
        "missing",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = -0.3 }",
        "boundary.bottom.friction_coefficient",
        "0 <= friction_coefficient <= 2",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = 2.1 }",
        "boundary.bottom.friction_coefficient",
        "0 <= friction_coefficient <= 2",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = \"20 deg\" }",
        "boundary.bottom.friction_coefficient",
        "",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = 0.3, lifts = 1 }",
        "boundary.bottom.separates",
        "true or false",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = 0.3, type = \"fixed\" }",
        "boundary.bottom.type",
        "E0011",
    ),
    row(
        "top    = \"fixed\"",
        "upper = \"free\"",
        "boundary.upper",
        "Known keys: left, right, bottom, top",
    ),
];

/// Faces that let waves out, in the case with all keys, which has stages, shakes and starts without stress.
pub const ABSORBING: &[Row] = &[
    row(
        "left   = \"roller\"",
        "left = \"absorbing\"",
        "stage.0.at",
        "E0627 .. [shaking] begin later",
    )
    .down(101),
    row("left   = \"roller\"", "left = \"absorbing\"", "boundary.left", "E0674"),
    row(
        "left   = \"roller\"",
        "left = \"free-field\"",
        "stage.1.at",
        "E0627 .. rigid bodies",
    )
    .down(105),
    row("left   = \"roller\"", "left = \"free-field\"", "boundary.left", "E0246"),
    row("left   = \"roller\"", "left = \"free-field\"", "boundary.left", "E0248"),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free-field\"",
        "boundary.bottom",
        "E0244",
    ),
    row(
        "quantity = \"heave\"",
        "quantity = \"outflow\"",
        "history.5.quantity",
        "E0646",
    ),
];
