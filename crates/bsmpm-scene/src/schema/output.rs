//! What a run leaves: frames, restart files, histories and checks.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, body, key, one_of};
use crate::words::{Format, Measurement, Side, Word};
use std::ops::Bound::{Excluded, Included};

pub(super) static OUTPUT: Table = Table {
    header: "[output]",
    doc: "Frames for ParaView, and the residuals of every iteration",
    keys: &[
        key("every", Quantity(In::Time, Range::POSITIVE), Optional, "time between frames, hit exactly"),
        key("every_steps", Count(1, 1_000_000_000), Optional, "accepted steps between frames, instead of every"),
        key("times", List(In::Time, Range::POSITIVE), Optional, "further times of frames, hit exactly"),
        key("format", Choice(Format::WORDS), Default("\"vtu\""), "format of the frames"),
        key("residuals", Flag, Default("false"), "whether residuals.csv has a row for every iteration"),
        key(
            "projected_pressure",
            Flag,
            Default("false"),
            "whether frames have the pressure projected onto splines of the order below, too",
        ),
        key(
            "checkpoint",
            Kind::Table(&CHECKPOINT),
            Optional,
            "when restart files are written, besides at every early stop",
        ),
    ],
    exclusive: &[one_of(&["every", "every_steps"], false)],
};

static CHECKPOINT: Table = Table {
    header: "checkpoint = { wall, every_steps, keep }",
    doc: "Restart files; given, one is written at the end of the run too",
    keys: &[
        key(
            "wall",
            Quantity(In::Duration, Range::POSITIVE),
            Default("\"15 min\""),
            "time by the clock between two, which also holds without this table",
        ),
        key("every_steps", Count(1, 1_000_000_000), Optional, "accepted steps between two, besides"),
        key("keep", Count(1, 1000), Default("2"), "how many are kept, the newest ones"),
    ],
    exclusive: &[],
};

pub(super) static HISTORY: Table = Table {
    header: "[[history]]",
    doc: "One column of history.csv, or several",
    keys: &[
        key("quantity", Choice(Measurement::WORDS), Required, "what is recorded every step"),
        key("name", Name, Optional, "name of the column; the quantity's unless given"),
        key("scale", Quantity(In::Number, Range::ANY), Default("1.0"), "multiplies"),
        key("percentile", Quantity(In::Number, PERCENT), Optional, "of runout: share of the points; 100 unless given"),
        key("face", Choice(Side::WORDS), Optional, "of reaction: the face"),
        key("rigid", Name, Optional, "of rigid-force and the like: name of the rigid body"),
        key(
            "at_x",
            Quantity(In::Length, Range::ANY),
            Optional,
            "of height: of the points within half a cell of this x",
        ),
        key(
            "at",
            Pair(In::Length, Range::ANY),
            Optional,
            "of displacement: the place at the start; of velocity and stress: the point nearest to it then",
        ),
        key(
            "material",
            Name,
            Optional,
            "of mass, momentum, centre-of-mass and angular-momentum: the points of a material; all unless given",
        ),
        key("box", Kind::Table(&body::BOX), Optional, "of pressure-noise: the points inside; all unless given"),
    ],
    exclusive: &[],
};

const PERCENT: Range = Range::of(Excluded(0.0), Included(100.0));

pub(super) static CHECK: Table = Table {
    header: "[[check]]",
    doc: "Bounds of a history column, verified at the end",
    keys: &[
        key("quantity", Name, Required, "a column of the history"),
        key("at", Quantity(In::Time, Range::POSITIVE), Optional, "time, hit exactly; the end unless given"),
        key("min", Measure, Optional, "least value"),
        key("max", Measure, Optional, "largest value"),
    ],
    exclusive: &[],
};
