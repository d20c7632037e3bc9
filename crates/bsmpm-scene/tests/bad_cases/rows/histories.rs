//! Tests that invalid histories, checks, profiles and fields of frames are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row(
        "percentile = 99.9",
        "precentile = 99.9",
        "history.0.precentile",
        "did you mean `percentile`?",
    ),
    row("\"4 m\"", "\"4 s\"", "check.0.max", "E0665"),
    row("\"0 kPa\"", "\"0 m\"", "check.1.max", "E0665"),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row(
        "percentile = 99.9",
        "percentile = 100.1",
        "history.0.percentile",
        "0 < percentile <= 100",
    ),
    row("scale    = 1e-3", "scale    = inf", "history.1.scale", "E0010"),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row("percentile = 99.9", "face = \"left\"", "history.0.face", "E0642"),
    row(
        "face     = \"bottom\"",
        "face = \"botom\"",
        "history.1.face",
        "did you mean `bottom`?",
    ),
    row("face     = \"bottom\"\n", "", "history.1.face", "E0644").up(2),
    row(
        "at       = [2.0, \"0.5 m\"]",
        "at = [5, 0]",
        "history.2.at",
        "outside the grid",
    ),
    row("percentile = 99.9", "name = \"floor-x\"", "history.1.name", "E0610").down(5),
    row("percentile = 99.9", "name = \"time\"", "history.0.name", "E0610"),
    row(
        "quantity = \"runout\"\nat",
        "quantity = \"runuot\"\nat",
        "check.0.quantity",
        "did you mean `runout`?",
    ),
    row(
        "quantity = \"stress-yy\"",
        "quantity = \"stress\"",
        "check.1.quantity",
        "E0660",
    ),
    row("at       = \"0.5 s\"", "at = 2", "check.0.at", "E0663"),
    row("min      = 3.0", "min = 5.0", "check.0.min", "E0661"),
    row("max      = \"0 kPa\"", "", "check.1", "E0661").up(2),
    row(
        "quantity = \"heave\"",
        "quantity = \"mass\"\nmaterial = \"sandy\"",
        "history.5.material",
        "E0612",
    )
    .down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"front\"\nmaterial = \"sand\"",
        "history.5.material",
        "E0642",
    )
    .down(1),
    row("quantity = \"heave\"", "quantity = \"gap\"", "history.5.face", "E0644").up(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"contact\"\nface = \"bottom\"",
        "history.5.face",
        "E0646",
    )
    .down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"heave\"\nface = \"left\"",
        "history.5.face",
        "E0642",
    )
    .down(1),
];

/// Parts of histories, lines, surfaces, profiles and fields of frames.
pub const REPORTED: &[Row] = &[
    row(
        "body     = \"fill\"",
        "body = \"fil\"",
        "history.7.body",
        "did you mean `fill`?",
    ),
    row(
        "body     = \"fill\"",
        "material = \"sand\"\nbody = \"fill\"",
        "history.7.body",
        "E0016",
    )
    .down(1),
    row(
        "quantity = \"kinetic-energy\"",
        "quantity = \"energy\"",
        "history.7.body",
        "E0642",
    )
    .down(1),
    row("to       = [\"1 m\", 1.25]\n", "", "history.8.to", "E0644").up(3),
    row("to       = [\"1 m\", 1.25]", "to = [1.0, 0.0]", "history.8.to", "E0651"),
    row(
        "to       = [\"1 m\", 1.25]",
        "disc = { centre = [1, 1], radius = 1 }",
        "history.8.disc",
        "E0642",
    ),
    row(
        "to       = [\"1 m\", 1.25]",
        "to = [1.0, 9.0]",
        "history.8.to",
        "outside the grid",
    ),
    row(
        "quantity = \"heave\"",
        "quantity = \"heave\"\nsurface = true",
        "history.5.surface",
        "E0642",
    )
    .down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"displacement\"\nat = [1, 1]\nfixed = true",
        "history.5.fixed",
        "E0642",
    )
    .down(2),
    row("count = 11", "count = 0", "profile.0.count", "1 <= count <= 1000"),
    row(
        "to    = [2.0, 0.0]",
        "to = [2.0, -1.0]",
        "profile.0.to",
        "outside the grid",
    ),
    row("to    = [2.0, 0.0]", "to = [2.0, 1.25]", "profile.0.to", "E0651"),
    row(
        "times = [\"0.5 s\", 1.0]",
        "times = [0.5, 2.0]",
        "profile.0.times",
        "E0663",
    ),
    row("times = [\"0.5 s\", 1.0]", "times = []", "profile.0.times", "E0652"),
    row(
        "quantities = [\"displacement\", ",
        "quantities = [\"disp\", ",
        "profile.0.quantities",
        "expected a list of words",
    ),
    row(
        "quantities = [\"displacement\", ",
        "quantities = [\"q\", ",
        "profile.0.quantities",
        "the list has \"q\" twice",
    ),
    row(
        "fixed = false",
        "[[profile]]\nname = \"Depth\"\nfrom = [0, 0]\nto = [1, 1]\ncount = 2\nquantities = [\"p\"]",
        "profile.1.name",
        "E0610",
    )
    .down(1),
    row(
        "fields = [\"q\", ",
        "fields = [\"p\", ",
        "output.fields",
        "expected a list of words",
    ),
    row(
        "fields = [\"q\", ",
        "fields = [\"density\", ",
        "output.fields",
        "the list has \"density\" twice",
    ),
];

/// Profiles in a quasi-static case.
pub const REPORTED_QUASI_STATIC: &[Row] = &[row(
    "[output]",
    "[[profile]]\nname = \"a\"\nfrom = [0, 0]\nto = [1, 1]\ncount = 2\nquantities = [\"velocity\"]\n[output]",
    "profile.0.quantities",
    "E0645",
)
.down(5)];
