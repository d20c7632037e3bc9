//! Schema of stages.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::loads::SUPPORT;
use super::{Dimension as In, Kind, Range, Table, key, loads};

pub(super) static STAGE: Table = Table {
    header: "[[stage]]",
    doc: "A change at a given time, between two steps. A stage can remove bodies (excavation), add bodies (fill), \
          activate or deactivate loads and prescribed motions, change supports at faces of the grid, and change the \
          law or the strength of materials.",
    keys: &[
        key(
            "name",
            Text(64),
            Optional,
            "Name of the stage in the log and in results.",
        )
        .example(r#""excavation""#),
        key(
            "at",
            Quantity(In::Time, Range::POSITIVE),
            Required,
            "Time at which the stage begins. A step ends at this time.",
        )
        .example("1.0"),
        key("remove", Names, Optional, "Names of the bodies that the stage removes.").example(r#"["pit_1"]"#),
        key(
            "add",
            Names,
            Optional,
            "Names of the bodies that the stage adds. Before the stage they are absent. An added body has its given \
             shape, no stress and, with flowing water, no excess pore pressure.",
        )
        .example(r#"["lift_1"]"#),
        key(
            "activate",
            Names,
            Optional,
            "Names of loads, footings, prescribed displacements, rigid bodies, drains and inflows that have no effect \
             before this stage, and act from then on.",
        )
        .example(r#"["surcharge"]"#)
        .renamed_from(&["apply"]),
        key(
            "deactivate",
            Names,
            Optional,
            "Names of loads, footings, prescribed displacements, rigid bodies, drains and inflows that cease to act at \
             this stage.",
        )
        .example(r#"["strut"]"#)
        .renamed_from(&["release"]),
        key(
            "boundary",
            Kind::Table(&FACES),
            Optional,
            "New supports at faces of the grid. The other faces keep their supports.",
        )
        .example(r#"{ left = "free" }"#),
        key(
            "materials",
            Tables(&EXCHANGE),
            Optional,
            "Changes of the laws that bodies follow.",
        )
        .example(r#"[{ from = "clay", to = "stiff_clay" }]"#),
        key(
            "strength_reduction",
            Quantity(In::Number, loads::FACTOR),
            Optional,
            "Factor by which the strength of all materials is divided from this stage on. It replaces the factor of \
             [strength_reduction].",
        )
        .symbol("F")
        .example("1.3"),
        key(
            "reset_displacements",
            Flag,
            Default("false"),
            "With true, this stage resets all reported displacements to zero, also those of the footing and of rigid \
             bodies.",
        ),
    ],
    exclusive: &[],
};

static FACES: Table = Table {
    header: "boundary = { left, right, front, back, bottom, top }",
    doc: "New supports, with the words of [boundary]. Examples are a gate that opens and a wall that is installed.",
    keys: &[
        key("left", SUPPORT, Optional, "Support at the face with the lowest x.").example(r#""free""#),
        key("right", SUPPORT, Optional, "Support at the face with the highest x.").example(r#""free""#),
        key(
            "front",
            SUPPORT,
            Optional,
            "Support at the face with the lowest y. Only in 3-D.",
        )
        .example(r#""free""#),
        key(
            "back",
            SUPPORT,
            Optional,
            "Support at the face with the highest y. Only in 3-D.",
        )
        .example(r#""free""#),
        key(
            "bottom",
            SUPPORT,
            Optional,
            "Support at the face with the lowest y (in 3-D: the lowest z).",
        )
        .example(r#""roller""#),
        key(
            "top",
            SUPPORT,
            Optional,
            "Support at the face with the highest y (in 3-D: the highest z).",
        )
        .example(r#""free""#),
    ],
    exclusive: &[],
};

static EXCHANGE: Table = Table {
    header: "materials = [{ from, to }, ...]",
    doc: "From this stage on, all bodies of one material follow the law of another material. Their stress and mass do \
          not change.",
    keys: &[
        key(
            "from",
            Name,
            Required,
            "Name of the material that the bodies have in [[body]].",
        )
        .example(r#""clay""#),
        key(
            "to",
            Name,
            Required,
            "Name of the material whose law the bodies follow. The name given in `from` restores their first law.",
        )
        .example(r#""treated_clay""#),
    ],
    exclusive: &[],
};
