//! Schema of frames, checkpoints, histories, profiles and checks.

use super::body::BoxTable;
use super::loads::DiscTable;
use super::site::PlateKey;
use super::{Dimension as In, Range};
use crate::observables::{FrameField, Observable, ProfileQuantity};
use crate::record::KeyPlace;
use crate::words::{Format, LimitedIndicator, Side};
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

table! {
    /// A quantity that history.csv records at every step.
    struct HistoryTable = "[[history]]" {
        /// Quantity that is recorded at every step.
        quantity: Choice(Observable), Required, example(r#""max-displacement""#);
        /// Name of the column. Default: the name of the quantity.
        name: Name, Optional, example(r#""crest""#);
        /// Factor that multiplies the recorded values.
        scale: Quantity(In::Number, Range::ANY), Default("1.0"), example("-1.0");
        /// For runout: percentage of the material points whose x is at most the result. Default: 100.
        percentile: Quantity(In::Number, PERCENT), Optional, example("99.0");
        /// For reaction, contact, gap, slip-rate, friction-power and mobilised-friction: the face of the grid. For
        /// water-outflow: the face that is the drain.
        face: Choice(Side), Optional, example(r#""left""#);
        /// For water-outflow: name of the drain. Default: all drains minus all inflows.
        drain: Name, Optional, example(r#""river_bed""#);
        /// For the quantities whose name begins with rigid: name of the rigid body.
        rigid: Name, Optional, example(r#""pipe""#);
        /// For moment and work: name of a [[prescribed]] displacement or of the [footing]. For reaction, contact, gap,
        /// slip-rate, friction-power and mobilised-friction: alternative to `face`.
        of: Name, Optional, example(r#""footing""#);
        /// For height: only material points within half a cell of this x are considered.
        at_x: Quantity(In::Length, Range::ANY), Optional, example(r#""5 m""#);
        /// Position at the start. A displacement is that of exactly this position. Velocity, stress, pore-pressure,
        /// excess-pressure, porosity and flux are those of the nearest material point.
        at: Vector(In::Length, Range::ANY), Optional, example("[2.0, 6.0]");
        /// Name of a material: only its material points are considered. Possible for mass, momentum, centre-of-mass,
        /// angular-momentum, kinetic-energy, mean-stress, mean-displacement, mean-velocity, plastic-strain,
        /// pore-pressures, pressure-noise, runout, height, max-displacement and heave.
        material: Name, Optional, example(r#""clay""#);
        /// Alternative to `material`: name of a body. Only its material points are considered.
        body: Name, Optional, example(r#""lift_1""#);
        /// For section-forces: beginning of the section line.
        from: Pair(In::Length, Range::ANY), Optional, example("[2.0, 0.0]");
        /// For section-forces: end of the section line.
        to: Pair(In::Length, Range::ANY), Optional, example("[2.0, 4.0]");
        /// For section-forces in 3-D: a rectangular section. Both corners have the same coordinate along one axis.
        rectangle: Table(BoxTable), Optional, example("{ lower = [2.0, 0.0, 0.0], upper = [2.0, 1.0, 4.0] }");
        /// For section-forces in 3-D: a circular section.
        disc: Table(DiscTable), Optional, example("{ centre = [0.0, 0.0, 2.0], radius = 1.0 }");
        /// For section-forces: with true, the section does not move. Without this key its ends (in 3-D the ends of its
        /// centre lines) move with the material that is there at the start.
        fixed: Flag, Optional;
        /// For velocity, stress and quantities of pore water: with true, the value at the position `at` is computed
        /// from a plane through the values of the neighbouring material points, also at a surface. Without this key the
        /// value is that of the nearest material point, up to half a cell away. If cells differ in size and the
        /// position is inside the material, the value is always that of the position.
        surface: Flag, Optional;
        /// Only material points that are in this box at the time of output are considered. The box does not move. It
        /// can be combined with `material` or `body`. To follow soil, define the soil as a body and give `body`. If no
        /// material point is in the box, sums and means are 0, positions are the lower corner of the grid, and a check
        /// of a mean or position fails.
        r#box: Table(BoxTable), Optional, example("{ lower = [0.0, 0.0], upper = [2.0, 2.0] }");
    }
    one_of optional [material, body];
    one_of optional [drain, face];
    one_of optional [rectangle, disc];
}

table! {
    /// Values at positions along a line. The file `profile_NAME.csv` has a row for every output time and every position
    /// inside the material.
    struct ProfileTable = "[[profile]]" {
        /// Name of the profile and of its file.
        name: Name, Required, example(r#""centre_line""#);
        /// Beginning of the line.
        from: Vector(In::Length, Range::ANY), Required, example("[2.0, 0.0]");
        /// End of the line.
        to: Vector(In::Length, Range::ANY), Required, example("[2.0, 6.0]");
        /// Number of equally spaced positions, including both ends. With 1 the position is the middle.
        count: Count(1, 1000), Required, example("25");
        /// Quantities that are written for each position.
        quantities: Choices(ProfileQuantity), Required, example(r#"["stress"]"#);
        /// Output times. A step ends at each of them. Default: the start, the frames of [output], and the end.
        times: List(In::Time, Range::POSITIVE), Optional, example("[0.5, 1.0]");
        /// With true, the positions do not move. With false they move with the material that is there at the start.
        fixed: Flag, Default("false");
    }
}

const PERCENT: Range = Range::of(Excluded(0.0), Included(100.0));

table! {
    /// Bounds of a column of history.csv at a given time. If the value is outside, the run ends with exit code 77.
    struct CheckTable = "[[check]]" {
        /// Name of a column of history.csv.
        quantity: Name, Required, example(r#""max-displacement""#);
        /// Time of the check. A step ends at this time. Default: the end of the run.
        at: Quantity(In::Time, Range::POSITIVE), Optional, example("1.0");
        /// Lower bound.
        min: Measure, Optional, example("0.01");
        /// Upper bound.
        max: Measure, Optional, example("0.02");
    }
}

impl HistoryTable {
    /// The keys that belong to some quantities only.
    pub(crate) fn subject_keys(&self) -> [&KeyPlace; 16] {
        [
            &self.percentile,
            &self.face,
            &self.at,
            &self.at_x,
            &self.r#box,
            &self.material,
            &self.body,
            &self.from,
            &self.to,
            &self.fixed,
            &self.surface,
            &self.rigid,
            &self.of,
            &self.drain,
            &self.rectangle,
            &self.disc,
        ]
    }

    /// The key of a section in space.
    pub(crate) fn plate(&self) -> Option<PlateKey<'_>> {
        if self.disc.is_given() {
            return Some(PlateKey::Disc(&self.disc));
        }
        let rectangle = &self.rectangle;
        rectangle.is_given().then_some(PlateKey::Rectangle(rectangle))
    }
}
