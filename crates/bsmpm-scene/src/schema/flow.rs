//! Schema of drains and inflows.

use super::Kind::{self, *};
use super::Presence::Optional;
use super::{Dimension as In, Range, Table, key, loads, one_of};
use crate::words::{Side, Word};

const PLACE: Kind = Pair(In::Length, Range::ANY);

pub(super) static DRAIN: Table = Table {
    header: "[[drain]]",
    doc: "A surface through which water flows freely, at the hydrostatic pressure or at a given pore pressure. A drain \
          at the surface of a body moves with the material. Surfaces without a drain or inflow are impermeable.",
    keys: &[
        key("name", Name, Optional, "Name of the drain in histories and stages.").example(r#""river_bed""#),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "A face of the grid to which bodies extend. The drain does not move with the ground. If the ground moves \
             away from the face, give the surface of the body instead.",
        )
        .example(r#""bottom""#),
        key(
            "from",
            PLACE,
            Optional,
            "One end of a segment on the surface of a body, at the start.",
        )
        .example("[0.0, 6.0]"),
        loads::TO_KEY,
        loads::CIRCLE_KEY,
        loads::RECTANGLE_KEY,
        loads::DISC_KEY,
        key(
            "surface",
            Flag,
            Optional,
            "With true, the drain is the whole surface of the permeable bodies, except at faces of the grid that \
             support them. The surface is that at the start, or when a stage activates the drain.",
        ),
        key(
            "head",
            Quantity(In::Length, Range::ANY),
            Optional,
            "Hydraulic head: height to which water would rise in a standpipe.",
        )
        .example(r#""4 m""#),
        key(
            "head_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]),
            Optional,
            "Alternative to `head`: time-dependent head, in rows [t, head] with increasing t. The head is linear \
             between the rows, and constant before and after them.",
        )
        .example(r#"[[0.0, 4.0], ["1 d", 2.0]]"#),
        key(
            "pressure",
            Quantity(In::Stress, Range::ANY),
            Optional,
            "Alternative to `head`: pore pressure at the drain.",
        )
        .example(r#""0 kPa""#),
        key(
            "pressure_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)]),
            Optional,
            "Alternative to `head`: time-dependent pore pressure, in rows [t, pressure] with increasing t. The \
             pressure is linear between the rows, and constant before and after them.",
        )
        .example(r#"[[0.0, "20 kPa"], ["1 d", 0.0]]"#),
        key(
            "seepage",
            Flag,
            Optional,
            "With true, the drain is a seepage face: above the water table the pore pressure is zero, and water can \
             only flow out.",
        ),
    ],
    exclusive: &[
        one_of(&["face", "from", "circle", "surface", "rectangle", "disc"], true),
        one_of(&["face", "to", "circle", "surface", "rectangle", "disc"], true),
        one_of(&["head", "head_path", "pressure", "pressure_path", "seepage"], false),
    ],
};

pub(super) static INFLOW: Table = Table {
    header: "[[inflow]]",
    doc: "A surface through which water enters the ground at a given rate. An inflow at the surface of a body moves \
          with the material.",
    keys: &[
        key(
            "name",
            Name,
            Optional,
            "Name of the inflow in the log, results and stages.",
        )
        .example(r#""rain""#),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "A face of the grid. Water enters only between the ends of the permeable bodies at this face.",
        )
        .example(r#""top""#),
        loads::FROM_KEY,
        loads::TO_KEY,
        loads::RECTANGLE_KEY,
        loads::DISC_KEY,
        key(
            "rate",
            Quantity(In::Seepage, Range::ANY),
            Optional,
            "Volume of water per area and time, positive into the ground.",
        )
        .symbol("q")
        .example(r#""5 mm/h""#),
        key(
            "rate_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Seepage, Range::ANY)]),
            Optional,
            "Alternative to `rate`: time-dependent rate, in rows [t, rate] with increasing t. The rate is linear \
             between the rows, and constant before and after them.",
        )
        .example(r#"[[0.0, "5 mm/h"], ["6 h", 0.0]]"#),
        key(
            "runoff",
            Flag,
            super::Presence::Default("false"),
            "With true, water enters only as long as the pore pressure at the surface is not positive, as with rain. \
             The rest runs off.",
        )
        .renamed_from(&["runs_off"]),
    ],
    exclusive: &[
        one_of(&["face", "from", "rectangle", "disc"], true),
        one_of(&["face", "to", "rectangle", "disc"], true),
        one_of(&["rate", "rate_path"], true),
    ],
};
