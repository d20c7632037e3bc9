//! Tests that invalid tables [solver] and [stabilisation] are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row(
        "reproducible     = true",
        "reproducible = \"yes\"",
        "solver.reproducible",
        "expected true or false",
    ),
    row(
        "reproducible     = true",
        "reproducible = 1",
        "solver.reproducible",
        "found 1",
    ),
    row(
        "max_iterations   = 200",
        "max_iterations = 200.0",
        "solver.max_iterations",
        "whole number from 1 to",
    ),
    row("method = \"f-bar\"", "", "stabilisation.method", "missing").up(1),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row(
        "tolerance        = 1e-8",
        "tolerance = 0",
        "solver.tolerance",
        "0 < tolerance < 1",
    ),
    row(
        "force_tolerance  = 1e-4",
        "force_tolerance = 1.5",
        "solver.force_tolerance",
        "0 < force_tolerance < 1",
    ),
    row(
        "background       = 0.0",
        "background = -0.1",
        "solver.background",
        "0 <= background <= 1",
    ),
    row("\"points\"", "\"gauss\"", "solver.quadrature", "fitted"),
    row(
        "max_iterations   = 200",
        "max_iterations = 0",
        "solver.max_iterations",
        "1 <= max_iterations",
    ),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row(
        "linear           = \"direct\"",
        "linear           = \"multigird\"",
        "solver.linear",
        "did you mean `multigrid`?",
    ),
    row(
        "linear           = \"direct\"",
        "linear           = { ksp = \"cg\" }",
        "solver.linear",
        "E0018",
    ),
];
