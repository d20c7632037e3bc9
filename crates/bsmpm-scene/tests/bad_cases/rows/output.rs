//! Tests that invalid tables [output] are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row(
        "residuals = true",
        "residuals = \"all\"",
        "output.residuals",
        "expected true or false",
    ),
    row(
        "format = \"vtu\"",
        "checkpoint = { keep = 0 }",
        "output.checkpoint.keep",
        "1 <= keep <= 1000",
    ),
    row(
        "format = \"vtu\"",
        "checkpoint = { wall = \"15 m\" }",
        "output.checkpoint.wall",
        "a wall-clock time",
    ),
    row(
        "format = \"vtu\"",
        "checkpoint = { wall = 0 }",
        "output.checkpoint.wall",
        "wall > 0",
    ),
    row(
        "format = \"vtu\"",
        "checkpoint = 500",
        "output.checkpoint",
        "a table, checkpoint = {",
    ),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row("every  = \"0.1 s\"", "every  = 0", "output.every", "(every > 0"),
    row(
        "every  = \"0.1 s\"",
        "every_steps = 0",
        "output.every_steps",
        "1 <= every_steps",
    ),
    row("every  = \"0.1 s\"", "every  = 1e-10", "output.every", "E0662"),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row(
        "format = \"vtu\"",
        "every_steps = 5",
        "output.every_steps",
        "`every` and `every_steps` are both given",
    ),
    row("times  = [\"0.25 s\", 0.75]", "times = [2]", "output.times", "E0663"),
    row("times  = [\"0.25 s\", 0.75]", "times = [-2]", "output.times", "E0010"),
];

/// What is reserved and not done yet.
pub const LATER: &[(&str, &str, &str)] = &[("format = \"vtu\"", "format = \"vtkhdf\"", "output.format")];
