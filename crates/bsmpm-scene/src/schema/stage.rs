//! The table of stages.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::loads::SUPPORT;
use super::{Dimension as In, Kind, Range, Table, key, loads};

pub(super) static STAGE: Table = Table {
    header: "[[stage]]",
    doc: "What changes at a time, between two steps: bodies are removed (excavation) and placed (lifts of an embankment), \
          loads and supports act from there or no longer, faces of the grid change, and materials follow another law or lose strength",
    keys: &[
        key("name", Text(64), Optional, "its name in the log and in results"),
        key("at", Quantity(In::Time, Range::POSITIVE), Required, "when it begins; a step ends there"),
        key("remove", Names, Optional, "names of the bodies that are taken away"),
        key(
            "add",
            Names,
            Optional,
            "names of the bodies that are placed, where and as they are given, without stress, and where water flows without \
             excess pressure; they are absent before",
        ),
        key(
            "activate",
            Names,
            Optional,
            "names of loads, supports, rigid bodies, drains and inflows that act from there on; they do nothing before",
        )
        .renamed_from(&["apply"]),
        key(
            "deactivate",
            Names,
            Optional,
            "names of loads, supports, rigid bodies, drains and inflows that act until there",
        )
        .renamed_from(&["release"]),
        key("boundary", Kind::Table(&FACES), Optional, "what faces of the grid do from there on; the others go on"),
        key("materials", Tables(&EXCHANGE), Optional, "laws that bodies follow from there on"),
        key(
            "strength_reduction",
            Quantity(In::Number, loads::FACTOR),
            Optional,
            "strength of all materials divided by this from there on, as by [strength_reduction] factor, and in its place",
        ),
        key(
            "reset_displacements",
            Flag,
            Default("false"),
            "whether displacements that are reported count from here, those of the footing and of rigid bodies, too",
        ),
    ],
    exclusive: &[],
};

static FACES: Table = Table {
    header: "boundary = { left, right, front, back, bottom, top }",
    doc: "Supports as in [boundary]: a gate that opens, a wall that is put up",
    keys: &[
        key("left", SUPPORT, Optional, "face at the lowest x"),
        key("right", SUPPORT, Optional, "face at the highest x"),
        key("front", SUPPORT, Optional, "in 3-D, face at the lowest y"),
        key("back", SUPPORT, Optional, "in 3-D, face at the highest y"),
        key("bottom", SUPPORT, Optional, "face at the lowest y, in 3-D z"),
        key("top", SUPPORT, Optional, "face at the highest y, in 3-D z"),
    ],
    exclusive: &[],
};

static EXCHANGE: Table = Table {
    header: "materials = [{ from, to }, ...]",
    doc: "Bodies of one material follow the law of another from there on; they keep their stress and their mass",
    keys: &[
        key("from", Name, Required, "name of the bodies' material"),
        key("to", Name, Required, "name of the material whose law they follow; that of `from` again: their own"),
    ],
    exclusive: &[],
};
