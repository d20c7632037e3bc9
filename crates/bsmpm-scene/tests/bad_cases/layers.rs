//! Tests that invalid layers and strength reductions are refused.

use super::{Row, row};

/// Parameters by height, and strength reduction.
pub const LAYERS: &[Row] = &[
    row(
        "\"0.5 deg/m\"",
        "\"0.5 deg\"",
        "material.till.friction_angle.per_metre",
        "must be a unit per metre, because the value is a change with height. Use one of deg/m, rad/m",
    ),
    row(
        "\"2 MPa/m\"",
        "\"2 kN/m3\"",
        "material.till.young.per_metre",
        "must be a unit per metre, because the value is a change with height. Use one of Pa/m",
    ),
    row(
        "\"2 MPa/m\"",
        "\"2 s/m\"",
        "material.till.young.per_metre",
        "found `s`, a unit of time",
    ),
    row(
        "\"2 MPa/m\"",
        "true",
        "material.till.young.per_metre",
        "a number (Pa/m) or a string with a unit (Pa/m, kPa/m",
    ),
    row(
        "\"2 MPa/m\"",
        "\"2e30 MPa/m\"",
        "material.till.young.per_metre",
        "E0010",
    ),
    row(
        "at_y = 3, per_metre = 500",
        "per_metre = 500",
        "material.till.cohesion.at_y",
        "missing",
    ),
    row(
        "at_y = 3, per_metre",
        "y = 3, per_metre",
        "material.till.cohesion.y",
        "`y` is not a known key of",
    ),
    row(
        "per_metre = \"2 MPa/m\"",
        "per_metre = \"-7 MPa/m\"",
        "material.till.young",
        "E0303",
    ),
    row(
        "value = \"1 kPa\", at_y = 3",
        "value = 0, at_y = 2",
        "material.till.cohesion",
        "E0303 .. y = 2.5 m .. -250",
    ),
    row(
        "value = 30, at_y",
        "value = 89.5, at_y",
        "material.till.friction_angle",
        "E0303 .. y = 1.5 m .. 90.25",
    ),
    row(
        "value = 30, at_y",
        "value = -0.4, at_y",
        "material.till.friction_angle",
        "is -0.15",
    ),
    row(
        "dilation_angle    = 0\n",
        "dilation_angle = 31\n",
        "material.till.dilation_angle",
        "E0308",
    ),
    row(
        "poisson     = 0.2",
        "poisson = { value = 0.2, at_y = 0, per_metre = 0 }",
        "material.block.poisson",
        "found a table",
    ),
    row(
        "factor = 1.25",
        "factor = 0",
        "strength_reduction.factor",
        "(0.1 <= factor <= 100",
    ),
    row("factor = 1.25", "factor = 101", "strength_reduction.factor", "E0010"),
    row(
        "factor = 1.25",
        "factors = 1.25",
        "strength_reduction.factors",
        "did you mean `factor`?",
    ),
    row("factor = 1.25", "", "strength_reduction.factor", "missing").up(1),
];
