//! Tests that invalid tables [element], tests of one material point, are refused.

use crate::{Row, row};

/// Tests of one material point.
pub const ELEMENT: &[Row] = &[
    row(
        "material = \"sand\"\npressure",
        "material = \"snad\"\npressure",
        "element.consolidated.material",
        "E0612",
    ),
    row(
        "material = \"sand\"\npressure",
        "pressure",
        "element.consolidated.material",
        "E0693",
    )
    .up(1),
    row("height = \"2 m\"\n", "", "element.mixed.height", "E0692").up(2),
    row(
        "{ test = \"isotropic\", pressure = \"100 kPa\", steps = 10 }",
        "{ test = \"isotropic\", shear = 0.1 }",
        "element.consolidated.stage.0.shear",
        "E0694",
    ),
    row(
        "{ test = \"isotropic\", pressure = \"100 kPa\", steps = 10 }",
        "{ test = \"isotropic\" }",
        "element.consolidated.stage.0",
        "E0694",
    ),
    row(
        "{ test = \"isotropic\", pressure",
        "{ test = \"isotropic\", undrained = true, pressure",
        "element.consolidated.stage.0.undrained",
        "E0695",
    ),
    row(
        "duration = \"1 h\" },",
        "duration = \"1 h\" },\n    { test = \"oedometer\", compression = 0.1 },",
        "element.consolidated.stage.2",
        "E0691",
    )
    .down(1),
    row("strain_yy = -0.01\n", "", "element.mixed.stage.0", "E0694").up(3),
    row(
        "strain_yy = -0.01\n",
        "strain_yy = -0.01\nstress_yy = 0\n",
        "element.mixed.stage.0.stress_yy",
        "`strain_yy` and `stress_yy` are both given",
    )
    .down(1),
];
