//! The table of water in the ground.

use super::Kind::*;
use super::Presence::{Default, Optional};
use super::{Dimension as In, Range, Table, key, one_of};
use crate::words::{Drainage, Word};

pub(super) static WATER: Table = Table {
    header: "[water]",
    doc: "Still water in and above the ground. Stresses are effective ones; the water lifts, seeps and presses on wet \
          surfaces by itself. Below the level, or the line, ground is wet; above there is no pore pressure",
    keys: &[
        key(
            "level",
            Quantity(In::Length, Range::ANY),
            Optional,
            "height of the water table, in the ground or above it",
        ),
        key(
            "level_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]),
            Optional,
            "rows [t, y] instead, t increasing; linear between, constant before the first and after the last",
        ),
        key(
            "line",
            Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY)]),
            Optional,
            "rows [x, y] of a phreatic line instead, x increasing; linear between, level beyond. The pressure is that of the \
             depth straight below it",
        ),
        key(
            "line_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY), (In::Length, Range::ANY)]),
            Optional,
            "rows [t, x, y] instead: lines of the same places x at times t, which does not fall; linear between them, \
             constant before the first and after the last",
        ),
        key("unit_weight", Quantity(In::UnitWeight, Range::POSITIVE), Default("\"9.81 kN/m3\""), "of the water"),
        key(
            "bulk",
            Quantity(In::Stress, Range::POSITIVE),
            Optional,
            "bulk modulus of the water; absent: incompressible",
        ),
        key(
            "suction",
            Quantity(In::Stress, Range::NOT_NEGATIVE),
            Optional,
            "largest suction above the level at the start, where materials have a retention; as the level makes it unless \
             given",
        ),
        key(
            "drainage",
            Choice(Drainage::WORDS),
            Optional,
            "what the pore water of materials without their own drainage does; hydrostatic unless given",
        ),
    ],
    exclusive: &[one_of(&["level", "level_path", "line", "line_path"], false)],
};
