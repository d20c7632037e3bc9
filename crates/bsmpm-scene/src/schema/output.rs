//! Schema of frames, checkpoints, histories, profiles and checks.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, body, key, loads, one_of};
use crate::observables::{FrameField, Observable, ProfileQuantity};
use crate::words::{Format, LimitedIndicator, Side, Word};
use std::ops::Bound::{Excluded, Included};

table! {
    /// Frames for ParaView, residuals of the iterations, and restart files.
    struct OutputTable = "[output]" {
        /// Time between two frames. A step ends at each frame.
        every: Quantity(In::Time, Range::POSITIVE), Optional, example(r#""0.1 s""#);
        /// Alternative to `every`: number of accepted steps between two frames.
        every_steps: Count(1, 1_000_000_000), Optional, example("10");
        /// Additional times of frames. A step ends at each of these times.
        times: List(In::Time, Range::POSITIVE), Optional, example("[0.25, 0.5]");
        /// Format of the frames.
        format: Choice(Format), Default("\"vtu\""), example(r#""vtu""#);
        /// With true, the run writes residuals.csv with a row for every iteration.
        residuals: Flag, Default("false");
        /// With true, frames also contain the pressure projected onto B-splines of the next lower degree.
        projected_pressure: Flag, Default("false");
        /// Additional fields in the frames.
        fields: Choices(FrameField), Optional, example(r#"["q", "yielding"]"#);
        /// Indicators that may exceed their limits. If any other indicator exceeds its limit, the run ends with exit
        /// code 82.
        accept: Choices(LimitedIndicator), Optional, example(r#"["background-work"]"#);
        /// Times at which the run writes restart files. A run that stops early always writes one.
        checkpoint: Table(CheckpointTable), Optional, example(r#"{ wall = "10 min", keep = 3 }"#);
    }
    one_of optional [every, every_steps];
}

table! {
    /// Restart files. A case with this table also writes a restart file at the end of the run.
    struct CheckpointTable = "checkpoint = { wall, every_steps, keep }" {
        /// Wall-clock time between two restart files. The default also applies without this table.
        wall: Quantity(In::Duration, Range::POSITIVE), Default("\"15 min\""), example(r#""15 min""#);
        /// Number of accepted steps between two restart files. `wall` remains active.
        every_steps: Count(1, 1_000_000_000), Optional, example("100");
        /// Number of restart files that are kept. Older restart files are deleted.
        keep: Count(1, 1000), Default("2"), example("2");
    }
}

pub(super) static HISTORY: Table = Table {
    header: "[[history]]",
    doc: "A quantity that history.csv records at every step.",
    keys: &[
        key(
            "quantity",
            Choice(Observable::WORDS),
            Required,
            "Quantity that is recorded at every step.",
        )
        .example(r#""max-displacement""#),
        key(
            "name",
            Name,
            Optional,
            "Name of the column. Default: the name of the quantity.",
        )
        .example(r#""crest""#),
        key(
            "scale",
            Quantity(In::Number, Range::ANY),
            Default("1.0"),
            "Factor that multiplies the recorded values.",
        )
        .example("-1.0"),
        key(
            "percentile",
            Quantity(In::Number, PERCENT),
            Optional,
            "For runout: percentage of the material points whose x is at most the result. Default: 100.",
        )
        .example("99.0"),
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "For reaction, contact, gap, slip-rate, friction-power and mobilised-friction: the face of the grid. For \
             water-outflow: the face that is the drain.",
        )
        .example(r#""left""#),
        key(
            "drain",
            Name,
            Optional,
            "For water-outflow: name of the drain. Default: all drains minus all inflows.",
        )
        .example(r#""river_bed""#),
        key(
            "rigid",
            Name,
            Optional,
            "For the quantities whose name begins with rigid: name of the rigid body.",
        )
        .example(r#""pipe""#),
        key(
            "of",
            Name,
            Optional,
            "For moment and work: name of a [[prescribed]] displacement or of the [footing]. For reaction, contact, \
             gap, slip-rate, friction-power and mobilised-friction: alternative to `face`.",
        )
        .example(r#""footing""#),
        key(
            "at_x",
            Quantity(In::Length, Range::ANY),
            Optional,
            "For height: only material points within half a cell of this x are considered.",
        )
        .example(r#""5 m""#),
        key(
            "at",
            Vector(In::Length, Range::ANY),
            Optional,
            "Position at the start. A displacement is that of exactly this position. Velocity, stress, pore-pressure, \
             excess-pressure, porosity and flux are those of the nearest material point.",
        )
        .example("[2.0, 6.0]"),
        key(
            "material",
            Name,
            Optional,
            "Name of a material: only its material points are considered. Possible for mass, momentum, centre-of-mass, \
             angular-momentum, kinetic-energy, mean-stress, mean-displacement, mean-velocity, plastic-strain, \
             pore-pressures, pressure-noise, runout, height, max-displacement and heave.",
        )
        .example(r#""clay""#),
        key(
            "body",
            Name,
            Optional,
            "Alternative to `material`: name of a body. Only its material points are considered.",
        )
        .example(r#""lift_1""#),
        key(
            "from",
            Pair(In::Length, Range::ANY),
            Optional,
            "For section-forces: beginning of the section line.",
        )
        .example("[2.0, 0.0]"),
        key(
            "to",
            Pair(In::Length, Range::ANY),
            Optional,
            "For section-forces: end of the section line.",
        )
        .example("[2.0, 4.0]"),
        key(
            "rectangle",
            loads::RECTANGLE,
            Optional,
            "For section-forces in 3-D: a rectangular section. Both corners have the same coordinate along one axis.",
        )
        .example("{ lower = [2.0, 0.0, 0.0], upper = [2.0, 1.0, 4.0] }"),
        key(
            "disc",
            Kind::Table(&loads::DISC),
            Optional,
            "For section-forces in 3-D: a circular section.",
        )
        .example("{ centre = [0.0, 0.0, 2.0], radius = 1.0 }"),
        key(
            "fixed",
            Flag,
            Optional,
            "For section-forces: with true, the section does not move. Without this key its ends (in 3-D the ends of \
             its centre lines) move with the material that is there at the start.",
        ),
        key(
            "surface",
            Flag,
            Optional,
            "For velocity, stress and quantities of pore water: with true, the value at the position `at` is computed \
             from a plane through the values of the neighbouring material points, also at a surface. Without this key \
             the value is that of the nearest material point, up to half a cell away. If cells differ in size and the \
             position is inside the material, the value is always that of the position.",
        ),
        key(
            "box",
            Kind::Table(&body::BOX),
            Optional,
            "Only material points that are in this box at the time of output are considered. The box does not move. It \
             can be combined with `material` or `body`. To follow soil, define the soil as a body and give `body`. If \
             no material point is in the box, sums and means are 0, positions are the lower corner of the grid, and a \
             check of a mean or position fails.",
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
    doc: "Values at positions along a line. The file `profile_NAME.csv` has a row for every output time and every \
          position inside the material.",
    keys: &[
        key("name", Name, Required, "Name of the profile and of its file.").example(r#""centre_line""#),
        key(
            "from",
            Vector(In::Length, Range::ANY),
            Required,
            "Beginning of the line.",
        )
        .example("[2.0, 0.0]"),
        key("to", Vector(In::Length, Range::ANY), Required, "End of the line.").example("[2.0, 6.0]"),
        key(
            "count",
            Count(1, 1000),
            Required,
            "Number of equally spaced positions, including both ends. With 1 the position is the middle.",
        )
        .example("25"),
        key(
            "quantities",
            Choices(ProfileQuantity::WORDS),
            Required,
            "Quantities that are written for each position.",
        )
        .example(r#"["stress"]"#),
        key(
            "times",
            List(In::Time, Range::POSITIVE),
            Optional,
            "Output times. A step ends at each of them. Default: the start, the frames of [output], and the end.",
        )
        .example("[0.5, 1.0]"),
        key(
            "fixed",
            Flag,
            Default("false"),
            "With true, the positions do not move. With false they move with the material that is there at the start.",
        ),
    ],
    exclusive: &[],
};

const PERCENT: Range = Range::of(Excluded(0.0), Included(100.0));

pub(super) static CHECK: Table = Table {
    header: "[[check]]",
    doc: "Bounds of a column of history.csv at a given time. If the value is outside, the run ends with exit code 77.",
    keys: &[
        key("quantity", Name, Required, "Name of a column of history.csv.").example(r#""max-displacement""#),
        key(
            "at",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "Time of the check. A step ends at this time. Default: the end of the run.",
        )
        .example("1.0"),
        key("min", Measure, Optional, "Lower bound.").example("0.01"),
        key("max", Measure, Optional, "Upper bound.").example("0.02"),
    ],
    exclusive: &[],
};
