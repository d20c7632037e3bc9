//! Schema of frames, checkpoints, histories, profiles and checks.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, body, key, loads, one_of};
use crate::words::{Format, FrameField, LimitedIndicator, Measurement, ProfileQuantity, Side, Word};
use std::ops::Bound::{Excluded, Included};

pub(super) static OUTPUT: Table = Table {
    header: "[output]",
    doc: "Frames for ParaView and the residuals of the iterations.",
    keys: &[
        key("every", Quantity(In::Time, Range::POSITIVE), Optional, "Time between frames. Steps end at these times.")
            .example(r#""0.1 s""#),
        key(
            "every_steps",
            Count(1, 1_000_000_000),
            Optional,
            "Number of accepted steps between frames, instead of every.",
        )
        .example("10"),
        key("times", List(In::Time, Range::POSITIVE), Optional, "Further times of frames. Steps end at these times.")
            .example("[0.25, 0.5]"),
        key("format", Choice(Format::WORDS), Default("\"vtu\""), "Format of the frames.").example(r#""vtu""#),
        key("residuals", Flag, Default("false"), "Whether residuals.csv has a row for every iteration."),
        key(
            "projected_pressure",
            Flag,
            Default("false"),
            "Whether frames also have the pressure, projected onto splines of the next lower degree.",
        ),
        key("fields", Choices(FrameField::WORDS), Optional, "Further fields in the frames.")
            .example(r#"["q", "yielding"]"#),
        key(
            "accept",
            Choices(LimitedIndicator::WORDS),
            Optional,
            "Indicators that may exceed their limits. If any other indicator exceeds its limit, the run ends with \
             exit code 82.",
        )
        .example(r#"["background-work"]"#),
        key(
            "checkpoint",
            Kind::Table(&CHECKPOINT),
            Optional,
            "When restart files are written, in addition to every early stop.",
        ),
    ],
    exclusive: &[one_of(&["every", "every_steps"], false)],
};

static CHECKPOINT: Table = Table {
    header: "checkpoint = { wall, every_steps, keep }",
    doc: "Restart files. With this table one is also written at the end of the run.",
    keys: &[
        key(
            "wall",
            Quantity(In::Duration, Range::POSITIVE),
            Default("\"15 min\""),
            "Wall-clock time between two restart files. It applies without this table too.",
        )
        .example(r#""15 min""#),
        key(
            "every_steps",
            Count(1, 1_000_000_000),
            Optional,
            "Number of accepted steps between two restart files, in addition to wall.",
        )
        .example("100"),
        key("keep", Count(1, 1000), Default("2"), "Number of restart files that are kept, the newest ones.")
            .example("2"),
    ],
    exclusive: &[],
};

pub(super) static HISTORY: Table = Table {
    header: "[[history]]",
    doc: "One column of history.csv, or several.",
    keys: &[
        key("quantity", Choice(Measurement::WORDS), Required, "Quantity that is recorded at every step.")
            .example(r#""max-displacement""#),
        key("name", Name, Optional, "Name of the column. Without this key it is the name of the quantity.")
            .example(r#""crest""#),
        key("scale", Quantity(In::Number, Range::ANY), Default("1.0"), "Factor of the recorded values.")
            .example("-1.0"),
        key(
            "percentile",
            Quantity(In::Number, PERCENT),
            Optional,
            "For runout: the percentage of the material points. Without this key it is 100.",
        )
        .example("99.0"),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "For reaction, contact, gap, slip-rate and friction-power: the face of the grid. For water-outflow: the \
             face of a drain.",
        )
        .example(r#""left""#),
        key(
            "drain",
            Name,
            Optional,
            "For water-outflow: name of the drain. Without this key it is the sum of all drains less all inflows.",
        )
        .example(r#""river_bed""#),
        key(
            "rigid",
            Name,
            Optional,
            "For rigid-force and the other quantities of rigid bodies: name of the rigid body.",
        )
        .example(r#""pipe""#),
        key(
            "of",
            Name,
            Optional,
            "For moment and work: name of a [[prescribed]] displacement or of the [footing]. For reaction, contact, \
             gap, slip-rate and friction-power it may replace face.",
        )
        .example(r#""footing""#),
        key(
            "at_x",
            Quantity(In::Length, Range::ANY),
            Optional,
            "For height: only material points within half a cell of this x count.",
        )
        .example(r#""5 m""#),
        key(
            "at",
            Vector(In::Length, Range::ANY),
            Optional,
            "Place at the start. For displacement it is the place itself. For velocity, stress, pore-pressure, \
             excess-pressure, porosity and flux it is the nearest material point.",
        )
        .example("[2.0, 6.0]"),
        key(
            "material",
            Name,
            Optional,
            "Restricts a quantity of all material points to those of a material. This is possible for mass, \
             momentum, centre-of-mass, angular-momentum, kinetic-energy, mean-stress, mean-displacement, \
             mean-velocity, plastic-strain, pore-pressures, pressure-noise, runout, height, max-displacement and \
             heave.",
        )
        .example(r#""clay""#),
        key(
            "body",
            Name,
            Optional,
            "Restricts the same quantities to the material points of a body, instead of material.",
        )
        .example(r#""lift_1""#),
        key("from", Pair(In::Length, Range::ANY), Optional, "For section-forces: beginning of the section.")
            .example("[2.0, 0.0]"),
        key("to", Pair(In::Length, Range::ANY), Optional, "For section-forces: end of the section.")
            .example("[2.0, 4.0]"),
        key(
            "rectangle",
            loads::RECTANGLE,
            Optional,
            "For section-forces in 3-D: a rectangle, given as a box without thickness along one axis.",
        )
        .example("{ lower = [2.0, 0.0, 0.0], upper = [2.0, 1.0, 4.0] }"),
        key("disc", Kind::Table(&loads::DISC), Optional, "For section-forces in 3-D: a disc.")
            .example("{ centre = [0.0, 0.0, 2.0], radius = 1.0 }"),
        key(
            "fixed",
            Flag,
            Optional,
            "For section-forces: whether the section stays in its place. Without this key it moves with the material \
             that is at its ends at the start, in 3-D at the ends of its centre lines.",
        ),
        key(
            "surface",
            Flag,
            Optional,
            "For velocity, stress and the quantities of pore water: with true the value is that of the place `at`, \
             also at a surface, from a plane through the values of the neighbouring material points. Without this key \
             it is the value of the nearest material point, which may be up to half a cell away. If cells differ in \
             size and the place is inside the material, it is the value of the place.",
        ),
        key(
            "box",
            Kind::Table(&body::BOX),
            Optional,
            "Restricts the same quantities to the material points that are in this box at the time, of the material \
             or body if one is given. The box does not move. To follow soil, define it as a body and give its name. \
             If no point is in the box, sums and means are 0 and places are the lower corner of the grid. A check of \
             a mean or a place then fails.",
        )
        .example("{ lower = [0.0, 0.0], upper = [2.0, 2.0] }"),
    ],
    exclusive: &[
        one_of(&["material", "body"], false),
        one_of(&["drain", "face"], false),
        one_of(&["rectangle", "disc"], false),
    ],
};

pub(super) static PROFILE: Table = Table {
    header: "[[profile]]",
    doc: "Fields at places along a line. The file `profile_NAME.csv` has a row for every time and every place inside \
          the material.",
    keys: &[
        key("name", Name, Required, "Name of the profile and of its file.").example(r#""centre_line""#),
        key("from", Vector(In::Length, Range::ANY), Required, "Beginning of the line.").example("[2.0, 0.0]"),
        key("to", Vector(In::Length, Range::ANY), Required, "End of the line.").example("[2.0, 6.0]"),
        key(
            "count",
            Count(1, 1000),
            Required,
            "Number of equally spaced places, including both ends. With 1 it is the middle.",
        )
        .example("25"),
        key("quantities", Choices(ProfileQuantity::WORDS), Required, "Quantities at each place.")
            .example(r#"["stress"]"#),
        key(
            "times",
            List(In::Time, Range::POSITIVE),
            Optional,
            "Times of the rows. Steps end at these times. Without this key they are the start, every frame of \
             [output], and the end.",
        )
        .example("[0.5, 1.0]"),
        key(
            "fixed",
            Flag,
            Default("false"),
            "Whether the places stay where they are. With false they move with the material that is there at the \
             start.",
        ),
    ],
    exclusive: &[],
};

const PERCENT: Range = Range::of(Excluded(0.0), Included(100.0));

pub(super) static CHECK: Table = Table {
    header: "[[check]]",
    doc: "A bound of a history column at a time. If it is not met, the run ends with an exit code of its own.",
    keys: &[
        key("quantity", Name, Required, "Name of a column of the history.").example(r#""max-displacement""#),
        key(
            "at",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "Time of the check. A step ends there. Without this key it is the end of the run.",
        )
        .example("1.0"),
        key("min", Measure, Optional, "Lower bound.").example("0.01"),
        key("max", Measure, Optional, "Upper bound.").example("0.02"),
    ],
    exclusive: &[],
};
