//! The table of stages.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Range, Table, key};

pub(super) static STAGE: Table = Table {
    header: "[[stage]]",
    doc: "What changes at a time, between two steps: bodies are removed (excavation) and placed (lifts of an embankment)",
    keys: &[
        key("name", Text(64), Optional, "what it is called where it is told of"),
        key("at", Quantity(In::Time, Range::POSITIVE), Required, "when it begins; a step ends there"),
        key("remove", Names, Optional, "names of the bodies that are taken away"),
        key(
            "add",
            Names,
            Optional,
            "names of the bodies that are placed, where and as they are given, without stress; they are absent before",
        ),
        key("reset_displacements", Flag, Default("false"), "whether displacements that are told count from here"),
    ],
    exclusive: &[],
};
