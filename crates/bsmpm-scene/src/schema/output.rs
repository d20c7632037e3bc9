//! What a run leaves: frames, restart files, histories and checks.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, body, key, loads, one_of};
use crate::words::{Format, FrameField, LimitedIndicator, Measurement, ProfileQuantity, Side, Word};
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
        key("fields", Choices(FrameField::WORDS), Optional, "what frames show besides what they always do"),
        key(
            "accept",
            Choices(LimitedIndicator::WORDS),
            Optional,
            "indicators that may be beyond their limits; without their names here the run ends with exit code 82 then",
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
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "of reaction, contact, gap, slip-rate, friction-power: the face; of water-outflow: a drained one",
        ),
        key("drain", Name, Optional, "of water-outflow: name of the drain; all drains less all inflows unless given"),
        key("rigid", Name, Optional, "of rigid-force and the like: name of the rigid body"),
        key(
            "of",
            Name,
            Optional,
            "of moment and work, and instead of face: the name of a [[prescribed]] motion or of the [footing], \"footing\" \
             unless it has one",
        ),
        key(
            "at_x",
            Quantity(In::Length, Range::ANY),
            Optional,
            "of height: of the points within half a cell of this x",
        ),
        key(
            "at",
            Vector(In::Length, Range::ANY),
            Optional,
            "of displacement: the place at the start; of velocity, stress, pore-pressure, excess-pressure, porosity and \
             flux: the point nearest to it then",
        ),
        key(
            "material",
            Name,
            Optional,
            "of quantities of all points: those of a material, of mass, momentum, centre-of-mass, angular-momentum, \
             kinetic-energy, mean-stress, mean-displacement, mean-velocity, plastic-strain, pore-pressures, pressure-noise, \
             runout, height, max-displacement and heave",
        ),
        key("body", Name, Optional, "of the same quantities: the points of a body by its name, instead of material"),
        key("from", Pair(In::Length, Range::ANY), Optional, "of section-forces: where the line begins"),
        key("to", Pair(In::Length, Range::ANY), Optional, "of section-forces: where it ends"),
        key(
            "rectangle",
            loads::RECTANGLE,
            Optional,
            "of section-forces, in 3-D instead: a box whose corners are alike along one axis",
        ),
        key("disc", Kind::Table(&loads::DISC), Optional, "of section-forces, in 3-D instead: a disc"),
        key(
            "fixed",
            Flag,
            Optional,
            "of section-forces: whether the section stays where it is in space; it goes with the material that is at its ends \
             (in 3-D at the ends of its middle lines) at the start unless given",
        ),
        key(
            "surface",
            Flag,
            Optional,
            "of velocity, stress and what the water of a place has: of the place itself, by the plane through the points \
             around it, also where these are on one side; unless given of the nearest point, \
             or where cells differ in length of the place inside of material",
        ),
        key(
            "box",
            Kind::Table(&body::BOX),
            Optional,
            "of the same quantities: the points that are in it at that time, of those of the material or body if one is given; it \
             stays where it is in space: for soil that a box has at the start give that a body of its own. With no point in it sums \
             and means are 0, and places the grid's lower corner; a check of a mean or place then fails, and a run in which none ever \
             is in it ends with a warning",
        ),
    ],
    exclusive: &[
        one_of(&["material", "body"], false),
        one_of(&["drain", "face"], false),
        one_of(&["rectangle", "disc"], false),
    ],
};

pub(super) static PROFILE: Table = Table {
    header: "[[profile]]",
    doc: "Fields at places along a line, a file `profile_NAME.csv` with a row for every time and place in material",
    keys: &[
        key("name", Name, Required, "what its file is called after"),
        key("from", Vector(In::Length, Range::ANY), Required, "where the line begins"),
        key("to", Vector(In::Length, Range::ANY), Required, "where it ends"),
        key("count", Count(1, 1000), Required, "places, equally spaced, the ends among them; one: the middle"),
        key("quantities", Choices(ProfileQuantity::WORDS), Required, "what is reported of each place"),
        key(
            "times",
            List(In::Time, Range::POSITIVE),
            Optional,
            "when, hit exactly; unless given at the start, with every frame that [output] wants, and at the end",
        ),
        key(
            "fixed",
            Flag,
            Default("false"),
            "whether the places stay where they are in space; else they belong to the material that is there at the start",
        ),
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
