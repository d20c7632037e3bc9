//! Tests that invalid histories and profiles of 3-D cases are refused.

use crate::{Row, row};

const SECTION: &str = "rectangle = { lower = [0.0, 0.0, 0.5], upper = [1.5, 3.0, 0.5] }";

/// Changes of `solid.toml`.
pub const HISTORIES: &[Row] = &[
    row(
        "at = [1.0, 1.5, 1.0]",
        "at = [1.0, 1.5]",
        "history.0.at",
        "three in 3-D",
    ),
    row(
        "at = [1.0, 1.5, 1.0]",
        "at = [1.0, 3.5, 1.0]",
        "history.0.at",
        "is outside the grid",
    ),
    row(
        "lower = [0.0, 0.5, 0.0]",
        "lower = [0.0, 0.5]",
        "history.6.box.lower",
        "three in 3-D",
    ),
    row(
        "lower = [0.0, 0.5, 0.0]",
        "lower = [0.0, 1.5, 0.0]",
        "history.6.box.upper",
        "the box is empty",
    ),
    row(
        "lower = [0.0, 0.5, 0.0], upper = [2.0",
        "lower = [5.0, 0.5, 0.0], upper = [6.0",
        "history.6.box",
        "outside the grid",
    ),
    row(
        "from  = [1.0, 1.5, 1.0]",
        "from  = [1.0, 1.5]",
        "profile.0.from",
        "three in 3-D",
    ),
    row(
        "rectangle = { lower = [0.0, 0.0, 0.5]",
        "# { lower = [0.0, 0.0, 0.5]",
        "history.4",
        "E0644",
    )
    .up(2),
    row(SECTION, "from = [0, 1]\nto = [1, 1]", "history.4.from", "E0642"),
    row(
        SECTION,
        "rectangle = { lower = [0, 0, 0.5], upper = [1, 3, 0.6] }",
        "history.4.rectangle",
        "E0234",
    ),
    row(
        SECTION,
        "rectangle = { lower = [0, 0, 0.5], upper = [1, 4, 0.5] }",
        "history.4.rectangle",
        "ends at y = 3",
    ),
    row(
        "disc     = { centre = [3.0",
        "rectangle = { lower = [0, 0, 0], upper = [1, 1, 0] }\ndisc = { centre = [3.0",
        "history.5.disc",
        "rectangle",
    )
    .down(1),
    row(
        "disc     = { centre = [3.0",
        "disc = { centre = [9.0",
        "history.5.disc",
        "no part of the disc is inside the grid",
    ),
    row(
        "from  = [1.0, 1.5, 1.0]",
        "from  = [1.0, 1.5, 3.5]",
        "profile.0.from",
        "which ends at z = 3",
    ),
    row(
        "from  = [1.0, 1.5, 1.0]",
        "from  = [1.0, 1.5, 0.0]",
        "profile.0.to",
        "E0651",
    )
    .down(1),
    row(
        "at = [1.0, 1.5, 1.0]",
        "at = [1.0, 1.5, 1.0]\nat_x = 1.0",
        "history.0.at_x",
        "E0642",
    )
    .down(1),
    row(
        "quantity = \"reaction\"\nface = \"back\"",
        "quantity = \"front\"",
        "history.1.quantity",
        "not available in 3-D",
    ),
    row(
        "quantity = \"contact\"",
        "quantity = \"moment\"",
        "history.2.quantity",
        "not available in 3-D",
    ),
];
