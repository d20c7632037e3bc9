//! Tests that invalid initial stresses, and histories of what the case does not have, are refused.

use super::{Row, row};

/// Stress at the start, and the histories of the footing and of the pressure.
pub const INITIAL: &[Row] = &[
    row("k0 = 0.5", "k0 = -0.5", "initial.k0", "0 <= k0 <= 100"),
    row(
        "k0 = 0.5",
        "k0 = 0.5\ngravity = \"elastic\"",
        "initial.gravity",
        "E0016",
    )
    .down(1),
    row(
        "k0 = 0.5",
        "gravity = \"plastic\"",
        "initial.gravity",
        "expected one of \"elastic\"",
    ),
    row(
        "k0 = 0.5",
        "k0 = 0.5\nequilibrium = \"elastic\"",
        "initial.equilibrium",
        "expected one of \"plastic\"",
    )
    .down(1),
    row("k0          = 0.6", "k0 = 0.6\nocr = 2", "material.till.ocr", "E0412").down(1),
    row("k0          = 0.6", "ocr = 0.5", "material.till.ocr", "ocr >= 1"),
    row("k0          = 0.6", "ocr = 2", "material.till.ocr", "E0410"),
    row("k0 = 0.5", "", "initial", "E0413 .. `sand`").up(1),
    row(
        "k0 = 0.5",
        "gravity = \"elastic\"",
        "material.till.k0",
        "E0405 .. initial.gravity",
    )
    .up(37),
    row("[initial]\nk0 = 0.5\n", "", "material.till.k0", "E0405 .. no [initial]").up(36),
    row("ramp = \"0 s\"", "ramp = \"0.1 s\"", "gravity.ramp", "E0409"),
    row("-9.81]", "9.81]", "gravity.acceleration", "E0406"),
    row(
        "acceleration = [0.0",
        "acceleration = [0.1",
        "gravity.acceleration",
        "E0406",
    ),
    row(
        "[gravity]\nacceleration = [0.0, -9.81]\nramp = \"0 s\"\n",
        "",
        "initial",
        "E0407",
    )
    .down(4),
    row(
        "upper = [\"2 m\", 1.0]",
        "upper = [\"-2 m\", 1.0]",
        "history.4.box.upper",
        "the box is empty",
    ),
    row(
        "lower = [0.0, 0.0], upper = [\"2 m\"",
        "lower = [9.0, 0.0], upper = [\"12 m\"",
        "history.4.box",
        "outside the grid",
    ),
    row(
        "quantity = \"pressure-noise\"",
        "quantity = \"front\"\nname = \"h\"",
        "history.4.box",
        "E0642",
    )
    .down(2),
    row(
        "quantity = \"footing-pressure\"",
        "quantity = \"footing-presure\"",
        "history.3.quantity",
        "did you mean `footing-pressure`?",
    ),
    row("max      = \"0 kPa\"", "max = \"0 kN/m\"", "check.1.max", "E0665"),
];
