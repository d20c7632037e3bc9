//! Tests that invalid frictional footings are refused.

use super::{Row, row};

/// Strips that rub and let go, and histories of strips by name, in a quasi-static case.
pub const RUBBING: &[Row] = &[
    row(
        "interface = { friction_coefficient = 0.5, separates = true }",
        "base = {}",
        "footing.interface.friction_coefficient",
        "missing",
    ),
    row(
        "interface = { friction_coefficient = 0.5,",
        "interface = { friction_coefficient = -0.5,",
        "footing.interface.friction_coefficient",
        "E0010",
    ),
    row(
        "interface = { friction_coefficient = 0.5,",
        "interface = { friction_coefficient = 3,",
        "footing.interface.friction_coefficient",
        "E0010",
    ),
    row(
        "separates = true",
        "separates = 1",
        "footing.interface.separates",
        "expected true or false",
    ),
    row(
        "separates = true",
        "separate = true",
        "footing.interface.separate",
        "did you mean `separates`?",
    ),
    row(
        "from = [0.0, 1.0]\nto = [1.0, 1.0]",
        "from = [0.0, 0.5]\nto = [1.0, 0.5]",
        "footing.interface",
        "E0404",
    )
    .down(3),
    row(
        "components = { friction_coefficient = 0.5 }\nfrom = [1.0, 1.0]\nto = [2.0, 1.0]",
        "components = { friction_coefficient = 0.5 }\nface = \"right\"",
        "prescribed.0.components",
        "E0418",
    ),
    row(
        "of = \"footing\"",
        "of = \"foting\"",
        "history.0.of",
        "did you mean `footing`?",
    ),
    row("of = \"footing\"", "", "history.0.of", "E0644").up(2),
    row(
        "of = \"footing\"",
        "of = \"footing\"\nface = \"left\"",
        "history.0.face",
        "E0642",
    )
    .down(1),
    row("quantity = \"work\"", "quantity = \"heave\"", "history.0.of", "E0642").down(1),
    row(
        "components = { friction_coefficient = 0.5 }",
        "components = \"all\"",
        "history.1.of",
        "E0646",
    )
    .down(12),
];
