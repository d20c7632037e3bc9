//! Tests that invalid tables [analysis] and [gravity] are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row("\"10 ms\"", "\"10 mm\"", "analysis.dt", "expected a time"),
    row(
        "-9.81]",
        "\"-1 gee\"]",
        "gravity.acceleration",
        "is not known. Known units: m/s2",
    ),
    row("acceleration = [0.0, -9.81]\n", "", "gravity.acceleration", "missing").up(1),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row("end  = \"1 s\"", "end  = -1", "analysis.end", "(end > 0"),
    row("end  = \"1 s\"", "end  = 0", "analysis.end", "(end > 0"),
    row("\"10 ms\"", "0", "analysis.dt", "(dt > 0"),
    row("\"10 ms\"", "\"2 s\"", "analysis.dt", "E0256"),
    row("\"10 ms\"", "1e-12", "analysis.dt", "E0257"),
    row("dt   = \"10 ms\"", "steps = 0", "analysis.steps", "(1 <= steps"),
    row(
        "dt   = \"10 ms\"",
        "steps = 1000000000000",
        "analysis.steps",
        "(1 <= steps <= 1000000000",
    ),
    row(
        "dt   = \"10 ms\"",
        "steps = -1",
        "analysis.steps",
        "-1 is outside the allowed range",
    ),
    row(
        "dt   = ",
        "spectral_radius = 1.1\ndt   = ",
        "analysis.spectral_radius",
        "0 <= spectral_radius <= 1",
    ),
    row(
        "dt   = ",
        "spectral_radius = -0.1\ndt   = ",
        "analysis.spectral_radius",
        "-0.1 is outside the allowed range",
    ),
    row(
        "dt   = ",
        "mass = \"consistant\"\ndt   = ",
        "analysis.mass",
        "consistent",
    ),
    row(
        "dt   = ",
        "newmark_gamma = 0.4\ndt   = ",
        "analysis.newmark_gamma",
        "0.5 <= newmark_gamma <= 1): below 0.5",
    ),
    row(
        "-9.81]",
        "1e308]",
        "gravity.acceleration",
        "largest allowed value of an acceleration is",
    ),
    row("-9.81]", "nan]", "gravity.acceleration", "E0010"),
    row("ramp = \"0 s\"", "ramp = -1", "gravity.ramp", "(ramp >= 0"),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row("dt   = \"10 ms\"", "dt = 0.01\nsteps = 5", "analysis.steps", "E0016").down(1),
    row(
        "dt   = ",
        "spectral_radius = 1\nnewmark_gamma = 0.5\ndt   = ",
        "analysis.newmark_gamma",
        "E0016",
    )
    .down(1),
    row("dt   = \"10 ms\"\n", "", "analysis", "none of the keys dt, steps").up(3),
    row("end  = \"1 s\"\n", "", "analysis.end", "E0255").up(2),
];
