//! Schema of stages.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::loads::SUPPORT;
use super::{Dimension as In, Kind, Range, Table, key, loads};

pub(super) static STAGE: Table = Table {
    header: "[[stage]]",
    doc: "A change at a given time, between two steps. Bodies are removed (excavation) or added (fill), loads and \
          supports are activated or deactivated, supports of the faces of the grid change, and materials follow \
          another law or lose strength.",
    keys: &[
        key("name", Text(64), Optional, "Name in the log and in results.").example(r#""excavation""#),
        key("at", Quantity(In::Time, Range::POSITIVE), Required, "Time at which the stage begins. A step ends there.")
            .example("1.0"),
        key("remove", Names, Optional, "Names of the bodies that are removed.").example(r#"["pit_1"]"#),
        key(
            "add",
            Names,
            Optional,
            "Names of the bodies that are added. They come with their given shape, without stress and, in flowing \
             water, without excess pore pressure. Before the stage they are absent.",
        )
        .example(r#"["lift_1"]"#),
        key(
            "activate",
            Names,
            Optional,
            "Names of loads, footings, prescribed displacements, rigid bodies, drains and inflows that act from this \
             stage on. They have no effect before.",
        )
        .example(r#"["surcharge"]"#)
        .renamed_from(&["apply"]),
        key(
            "deactivate",
            Names,
            Optional,
            "Names of loads, footings, prescribed displacements, rigid bodies, drains and inflows that act until \
             this stage.",
        )
        .example(r#"["strut"]"#)
        .renamed_from(&["release"]),
        key(
            "boundary",
            Kind::Table(&FACES),
            Optional,
            "Supports of faces of the grid from this stage on. Other faces stay as they are.",
        ),
        key("materials", Tables(&EXCHANGE), Optional, "Laws that bodies follow from this stage on."),
        key(
            "strength_reduction",
            Quantity(In::Number, loads::FACTOR),
            Optional,
            "Factor by which the strength of all materials is divided from this stage on, as by the factor of \
             [strength_reduction]. It replaces that factor.",
        )
        .symbol("F")
        .example("1.3"),
        key(
            "reset_displacements",
            Flag,
            Default("false"),
            "With true, all reported displacements count from this stage, also those of the footing and of rigid \
             bodies.",
        ),
    ],
    exclusive: &[],
};

static FACES: Table = Table {
    header: "boundary = { left, right, front, back, bottom, top }",
    doc: "Supports as in [boundary], for instance a gate that opens or a wall that is installed.",
    keys: &[
        key("left", SUPPORT, Optional, "Support at the face with the lowest x.").example(r#""free""#),
        key("right", SUPPORT, Optional, "Support at the face with the highest x.").example(r#""free""#),
        key("front", SUPPORT, Optional, "Support at the face with the lowest y, in 3-D.").example(r#""free""#),
        key("back", SUPPORT, Optional, "Support at the face with the highest y, in 3-D.").example(r#""free""#),
        key("bottom", SUPPORT, Optional, "Support at the face with the lowest y, in 3-D z.").example(r#""roller""#),
        key("top", SUPPORT, Optional, "Support at the face with the highest y, in 3-D z.").example(r#""free""#),
    ],
    exclusive: &[],
};

static EXCHANGE: Table = Table {
    header: "materials = [{ from, to }, ...]",
    doc: "Bodies of one material follow the law of another one from this stage on. They keep their stress and mass.",
    keys: &[
        key("from", Name, Required, "Name of the material of the bodies.").example(r#""clay""#),
        key(
            "to",
            Name,
            Required,
            "Name of the material whose law they follow. The name of `from` gives them back their first law.",
        )
        .example(r#""treated_clay""#),
    ],
    exclusive: &[],
};
