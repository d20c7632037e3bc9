//! Invalid cases with hydrostatic water or `ru`.

use super::{Row, row};

const LEVEL: &str = "level = 0.75";
const SATURATED: &str = "saturated_unit_weight = \"20 kN/m3\"";
const GRAVITY: &str = "[gravity]\nacceleration = [0.0, -9.81]\n";

/// The level, the line, weights, and what water needs.
pub const WATER: &[Row] = &[
    row(LEVEL, "", "water", "E0521").up(1),
    row(LEVEL, "level = 0.75\nline = [[0, 1]]", "water.line", "E0016").down(1),
    row(LEVEL, "level = \"10 kPa\"", "water.level", "expected a length"),
    row(LEVEL, "level = 0.0", "water.level", "E0524 .. y = 0 m"),
    row(
        LEVEL,
        "level_path = [[0.5, 1.0], [0.5, 2.0]]",
        "water.level_path",
        "E0402 .. t = 0.5",
    ),
    row(
        LEVEL,
        "line_path = [[0, 0, 1], [0, 0, 2]]",
        "water.line_path",
        "E0525 .. x = 0 m",
    ),
    row(
        LEVEL,
        "line_path = [[0, 0, 1], [1, 1, 2]]",
        "water.line_path",
        "E0525 .. t = 1 s .. x = 1 m",
    ),
    row(
        LEVEL,
        "line_path = [[1, 0, 1], [1, 2, 1], [0.5, 0, 1]]",
        "water.line_path",
        "E0525 .. t = 0.5 s .. 1 s",
    ),
    row(
        LEVEL,
        "line_path = [[0, 0, 1], [0, 2, 1], [1, 0, 1]]",
        "water.line_path",
        "E0525 .. fewer points",
    ),
    row(LEVEL, "level_path = []", "water.level_path", "at least one row"),
    row(
        LEVEL,
        "line = [[1.0, 1.0], [0.5, 2.0]]",
        "water.line",
        "E0402 .. x = 0.5",
    ),
    row(LEVEL, "line = [[0.0, -1.0], [0.5, -2.0]]", "water.line", "E0524"),
    row(
        LEVEL,
        "level = 0.75\nunit_weight = 0",
        "water.unit_weight",
        "(unit_weight > 0",
    )
    .down(1),
    row(LEVEL, "level = 0.75\nru = 0.3", "water.ru", "E0011").down(1),
    row(GRAVITY, "", "water", "E0522").down(1),
    row("-9.81]", "9.81]", "gravity.acceleration", "E0523"),
    row(
        SATURATED,
        "saturated_unit_weight = \"18 kN/m3\"",
        SATURATED_KEY,
        "E0309",
    ),
    row(
        "unit_weight = \"19 kN/m3\"\nsaturated_unit_weight = \"20 kN/m3\"",
        "unit_weight = \"8 kN/m3\"\nsaturated_unit_weight = \"9 kN/m3\"",
        SATURATED_KEY,
        "E0528 .. 9.81 kN/m3",
    )
    .down(1),
    row("unit_weight = \"19 kN/m3\"\n", "", SATURATED_KEY, "E0310"),
    row("[water]\nlevel = 0.75\n", "", SATURATED_KEY, "E0520").up(16),
    row("at       = [1.0, 0.5]", "", "history.0.at", "E0644").up(2),
];
/// Pressure that points carry, beside other water.
pub const RATIO_AND_WATER: &[Row] = &[
    row(SATURATED, "saturated_unit_weight = \"20 kN/m3\"\nru = 0.3", RU, "E0320").down(1),
    row(
        SATURATED,
        "saturated_unit_weight = \"20 kN/m3\"\nru = 1.0",
        RU,
        "(0 < ru < 1",
    )
    .down(1),
    row(
        "[water]\nlevel = 0.75\n",
        "[water]\nlevel = 0.75\nru = 0.3\n",
        "water.ru",
        "E0011",
    )
    .down(2),
];

/// Pressure that points carry, beside what it is not right with.
pub const RATIO: &[Row] = &[
    row(WEIGHT, WET_WEIGHT, RU, "E0321 .. Add [gravity]").down(1),
    row("poisson = 0.3\n", ADDED_GRAVITY, RU, "E0321 .. vertical gravity").down(2),
    row("poisson = 0.3\n", ADDED_STAGE, RU, "E0322").down(2),
];
const RU: &str = "material.soil.ru";
const WEIGHT: &str = "poisson = 0.3\n";
const WET_WEIGHT: &str = "poisson = 0.3\nru = 0.3\nunit_weight = \"19 kN/m3\"\n";
const ADDED_GRAVITY: &str =
    "poisson = 0.3\nunit_weight = \"19 kN/m3\"\nru = 0.3\n[gravity]\nacceleration = [0.0, 9.81]\n";
const ADDED_STAGE: &str = "poisson = 0.3\nunit_weight = \"19 kN/m3\"\nru = 0.3\n\
    [gravity]\nacceleration = [0.0, -9.81]\n[[stage]]\nat = 0.5\nremove = [\"upper\"]\n\
    [[body]]\nname = \"upper\"\nmaterial = \"soil\"\n\
    box = { lower = [0.0, 1.0], upper = [1.0, 2.0] }\npoints_per_cell = 3\n";
const SATURATED_KEY: &str = "material.soil.saturated_unit_weight";

/// Ground that shakes.
pub const SHAKEN: &[Row] = &[row(
    "[shaking]\n",
    "[water]\nlevel = 1.0\n[shaking]\n",
    "water",
    "E0526",
)];
