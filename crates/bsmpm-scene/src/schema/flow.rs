//! The tables of where water flows in and out.

use super::Kind::{self, *};
use super::Presence::Optional;
use super::{Dimension as In, Range, Table, body, key, loads, one_of};
use crate::words::{Side, Word};

const PLACE: Kind = Pair(In::Length, Range::ANY);

pub(super) static DRAIN: Table = Table {
    header: "[[drain]]",
    doc: "A surface through which water flows freely, at a pressure that is given: that of the still water unless it \
          says another. A body's surface goes with the material; what is not named lets no water through",
    keys: &[
        key("name", Name, Optional, "what histories and stages call it"),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "a face of the grid, at which bodies lie, which does not go with the ground: where that settles from it, or \
             goes away, name the body's surface; in 3-D this, a rectangle or a disc",
        ),
        key("from", PLACE, Optional, "one end of a segment of a body's surface at the start"),
        key("to", PLACE, Optional, "the other end"),
        key("circle", Kind::Table(&body::CIRCLE), Optional, "a circle instead: the part of it inside the grid"),
        key("rectangle", loads::RECTANGLE, Optional, "in 3-D: a box whose corners are alike along one axis"),
        key("disc", Kind::Table(&loads::DISC), Optional, "in 3-D: a disc, the part of it inside the grid"),
        key(
            "surface",
            Flag,
            Optional,
            "true: all that is surface of bodies of permeable soil at the start, or as a stage applies it, but for what \
             lies at faces of the grid that hold it",
        ),
        key("head", Quantity(In::Length, Range::ANY), Optional, "height to which the water there would rise"),
        key(
            "head_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]),
            Optional,
            "rows [t, y] instead, t increasing; linear between, constant before the first and after the last",
        ),
        key("pressure", Quantity(In::Stress, Range::ANY), Optional, "pore pressure there instead"),
        key(
            "pressure_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)]),
            Optional,
            "rows [t, p] instead, t increasing; linear between, constant before the first and after the last",
        ),
        key(
            "seepage",
            Flag,
            Optional,
            "true: a seepage face instead: above still water no pressure, and water only comes out",
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
    doc: "Water that is put in through a segment of a body's surface (3-D: a rectangle or disc), with which it goes",
    keys: &[
        key("name", Name, Optional, "its name in the log, in results and in stages"),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "a face of the grid: what of it lies between the ends of the permeable bodies there",
        ),
        key("from", PLACE, Optional, "one end of the segment at the start"),
        key("to", PLACE, Optional, "the other end"),
        key("rectangle", loads::RECTANGLE, Optional, "in 3-D, instead: a box whose corners are alike along one axis"),
        key("disc", Kind::Table(&loads::DISC), Optional, "in 3-D, instead: a disc, the part of it inside the grid"),
        key("rate", Quantity(In::Seepage, Range::ANY), Optional, "volume of water per area and time, into the ground"),
        key(
            "rate_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Seepage, Range::ANY)]),
            Optional,
            "rows [t, rate] instead, t increasing; linear between, constant before the first and after the last",
        ),
        key(
            "runoff",
            Flag,
            super::Presence::Default("false"),
            "true: no more goes in than without pressure at the surface: rain",
        )
        .renamed_from(&["runs_off"]),
    ],
    exclusive: &[
        one_of(&["face", "from", "rectangle", "disc"], true),
        one_of(&["face", "to", "rectangle", "disc"], true),
        one_of(&["rate", "rate_path"], true),
    ],
};
