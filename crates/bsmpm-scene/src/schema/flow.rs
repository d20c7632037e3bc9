//! Schema of drains and inflows.

use super::Kind::{self, *};
use super::Presence::Optional;
use super::{Dimension as In, Range, Table, key, loads, one_of};
use crate::words::{Side, Word};

const PLACE: Kind = Pair(In::Length, Range::ANY);

pub(super) static DRAIN: Table = Table {
    header: "[[drain]]",
    doc: "A surface through which water flows freely at a given pressure, which is that of the hydrostatic water \
          unless the drain gives another. A drain at the surface of a body moves with the material. All other \
          surfaces are impermeable.",
    keys: &[
        key("name", Name, Optional, "Name by which histories and stages refer to the drain.").example(r#""river_bed""#),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "A face of the grid to which bodies extend. It does not move with the ground. If the ground moves away \
             from the face, name the surface of the body instead.",
        )
        .example(r#""bottom""#),
        key("from", PLACE, Optional, "One end of a segment of a body's surface, at the start.").example("[0.0, 6.0]"),
        loads::TO_KEY,
        loads::CIRCLE_KEY,
        loads::RECTANGLE_KEY,
        loads::DISC_KEY,
        key(
            "surface",
            Flag,
            Optional,
            "With true, the drain is the whole surface of the permeable bodies, except where a face of the grid \
             supports them. It is their surface at the start, or when a stage activates the drain.",
        ),
        key(
            "head",
            Quantity(In::Length, Range::ANY),
            Optional,
            "Hydraulic head, the height to which the water would rise in a standpipe.",
        )
        .example(r#""4 m""#),
        key(
            "head_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]),
            Optional,
            "Rows [t, head], instead of head, with t increasing. The head is interpolated linearly, and is constant \
             before the first row and after the last.",
        )
        .example(r#"[[0.0, 4.0], ["1 d", 2.0]]"#),
        key("pressure", Quantity(In::Stress, Range::ANY), Optional, "Pore pressure at the drain, instead of head.")
            .example(r#""0 kPa""#),
        key(
            "pressure_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)]),
            Optional,
            "Rows [t, pressure], instead of pressure, with t increasing. The pressure is interpolated linearly, and \
             is constant before the first row and after the last.",
        )
        .example(r#"[[0.0, "20 kPa"], ["1 d", 0.0]]"#),
        key(
            "seepage",
            Flag,
            Optional,
            "With true, the drain is a seepage face: above the hydrostatic water the pore pressure is zero, and \
             water flows out only.",
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
    doc: "Water that is put into the ground through a segment of a body's surface, in 3-D through a rectangle or a \
          disc. It moves with the surface.",
    keys: &[
        key("name", Name, Optional, "Name by which the log, results and stages refer to the inflow.")
            .example(r#""rain""#),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "A face of the grid. Only the part counts that lies between the ends of the permeable bodies there.",
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
            "Rows [t, rate], instead of rate, with t increasing. The rate is interpolated linearly, and is constant \
             before the first row and after the last.",
        )
        .example(r#"[[0.0, "5 mm/h"], ["6 h", 0.0]]"#),
        key(
            "runoff",
            Flag,
            super::Presence::Default("false"),
            "With true, only as much water enters as the ground takes without pressure at its surface, as with rain. \
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
