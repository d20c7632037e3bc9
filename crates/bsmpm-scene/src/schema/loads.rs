//! Schema of footings, prescribed displacements, loads, strength reduction and initial stress.

use super::Presence::{Default, Optional, Required};
use super::body::{self, BoxTable, CircleTable, SphereTable, SurfaceTable};
use super::{Dimension as In, Key, Kind, Range, key};
use crate::record::{CaseTable, Field, KeyPlace, ListRow, OrTable};
use crate::words::{Axis, Base, Components, Failure, Settled, Side, Start, Support};
use bsmpm::material::Profile;
use std::ops::Bound::Included;

/// Columns of an amplitude: time and factor.
pub(super) const AMPLITUDE: &[(In, Range)] = &[(In::Time, Range::NOT_NEGATIVE), (In::Number, Range::ANY)];
const PRESSURES: &[(In, Range)] = &[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)];
/// Coefficients of friction.
pub(super) const FRICTION: Range = Range::of(Included(0.0), Included(2.0));
/// That strength is divided by.
pub(super) const FACTOR: Range = Range::of(Included(0.1), Included(100.0));
/// Horizontal over vertical stress: from nothing to far beyond passive pressure.
pub(super) const COEFFICIENT: Range = Range::of(Included(0.0), Included(100.0));

table! {
    /// Contact with Coulomb friction between the soil and a face of the grid.
    struct ContactTable = "left = { friction_coefficient, separates }" {
        friction_coefficient: Shared(FRICTION_KEY, Quantity);
        /// With true, the soil may separate from the face. With false the normal displacement is zero, and under
        /// tension there is no friction.
        separates: Flag, Default("true"), renamed_from(&["lifts"]);
    }
}

/// The support of a face of the grid, or the contact at it.
pub(crate) type SupportField = Field<OrTable<Support, ContactTable>>;

/// A table with the supports of the faces of the grid.
pub(crate) trait SupportTable {
    /// The key of a face.
    fn face(&self, side: Side) -> &SupportField;
}

table! {
    /// A rigid footing with a prescribed motion. Its base is a segment, in 3-D a plate.
    struct FootingTable = "[footing]" {
        /// One end of the base at the start.
        from: Pair(In::Length, Range::ANY), Optional, example("[0.0, 10.0]");
        /// The other end of the base.
        to: Pair(In::Length, Range::ANY), Optional, example("[2.0, 10.0]");
        rectangle: Shared(RECTANGLE_KEY, Table(BoxTable));
        disc: Shared(DISC_KEY, Table(DiscTable));
        displacement: Shared(DISPLACEMENT_KEY, Vector);
        velocity: Shared(VELOCITY_KEY, Vector);
        path: Shared(PATH_KEY, Course);
        /// Interface of the base and the soil. A table defines a frictional contact.
        interface: ChoiceOr(Base, FrictionalTable), Default("\"smooth\""),
            example(r#""rough""#),
            renamed_from(&["base"]);
        /// Name of the footing in stages and histories. Default: "footing".
        name: Name, Optional, example(r#""footing""#);
    }
    one_of required [from, rectangle, disc];
    one_of required [to, rectangle, disc];
    one_of required [displacement, velocity, path];
}

table! {
    /// A flat disc.
    struct DiscTable = "disc = { centre, radius, normal }" {
        /// Centre of the disc.
        centre: Vector(In::Length, Range::ANY), Required, example("[0.0, 0.0, 2.0]"), renamed_from(&["center"]);
        /// Radius of the disc.
        radius: Quantity(In::Length, Range::POSITIVE), Required, example(r#""1 m""#);
        /// The axis normal to the disc.
        normal: Choice(Axis), Default("\"z\""), example(r#""z""#);
    }
}

table! {
    /// A prescribed motion of the soil at a face of the grid or at a segment, in 3-D at a plate.
    struct PrescribedTable = "[[prescribed]]" {
        /// The face of the grid that moves. It must be free in [boundary].
        face: Choice(Side), Optional, example(r#""left""#);
        from: Shared(FROM_KEY, Pair);
        to: Shared(TO_KEY, Pair);
        rectangle: Shared(RECTANGLE_KEY, Table(BoxTable));
        disc: Shared(DISC_KEY, Table(DiscTable));
        displacement: Shared(DISPLACEMENT_KEY, Vector);
        velocity: Shared(VELOCITY_KEY, Vector);
        path: Shared(PATH_KEY, Course);
        /// Displacement components that are prescribed. A table defines a frictional contact of a segment.
        components: ChoiceOr(Components, FrictionalTable), Default("\"all\""), example(r#""normal""#);
        /// Name of the motion in stages and histories.
        name: Name, Optional, example(r#""wall""#);
    }
    one_of required [face, from, rectangle, disc];
    one_of required [face, to, rectangle, disc];
    one_of required [displacement, velocity, path];
}

table! {
    /// Contact with Coulomb friction between a footing or prescribed segment and the soil on one side of it.
    struct FrictionalTable = "interface = { friction_coefficient, separates }" {
        friction_coefficient: Shared(FRICTION_KEY, Quantity);
        /// With true, the soil may separate. With false the normal displacement stays prescribed, and under tension
        /// there is no friction.
        separates: Flag, Default("true"), renamed_from(&["lifts"]);
    }
}

table! {
    /// A load per area of a surface. In 2-D the surface is a segment or a circle; in 3-D a rectangle, a disc, a sphere
    /// or triangles. The load moves with the soil.
    struct TractionTable = "[[traction]]" {
        from: Shared(FROM_KEY, Pair);
        to: Shared(TO_KEY, Pair);
        circle: Shared(body::CIRCLE_KEY, Table(CircleTable));
        rectangle: Shared(RECTANGLE_KEY, Table(BoxTable));
        disc: Shared(DISC_KEY, Table(DiscTable));
        /// A sphere. Only in 3-D. Parts outside the grid are ignored.
        sphere: Table(SphereTable), Optional, example(r#"{ centre = [0.0, 0.0, 4.0], radius = "1 m" }"#);
        /// Triangles on the surface of bodies. Only in 3-D.
        surface: Table(SurfaceTable), Optional, example(r#"{ triangles = { file = "surface.stl" } }"#);
        /// Dead load: force per undeformed area, in components along the axes. Its direction is constant.
        stress: PairProfile(In::Stress, Range::ANY, StressesProfileTable), Optional, example(r#"[0.0, "-50 kPa"]"#);
        /// Alternative to `stress`: pressure that presses on the body. It stays normal to the deformed surface
        /// (follower load).
        pressure: Profile(In::Stress, Range::ANY, StressProfileTable), Optional, example(r#""50 kPa""#);
        /// Alternative to `stress`: time-dependent load, in rows [t, x, y], in 3-D [t, x, y, z], with increasing t. The
        /// stress is linear between the rows, and constant after the last row. It is zero at t = 0, unless a row gives
        /// another value. Time counts from the activation of the load.
        stress_path: Course(In::Stress), Optional, example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-50 kPa"]]"#);
        /// Alternative to `pressure`: time-dependent pressure, in rows [t, pressure] with increasing t. The pressure is
        /// linear between the rows, and constant after the last row. It is zero at t = 0, unless a row gives another
        /// value. Time counts from the activation of the load.
        pressure_path: Rows(PRESSURES), Optional,
            example(r#"[[0.0, 0.0], [1.0, "50 kPa"]]"#);
        ramp: Shared(RAMP_KEY, Quantity);
        amplitude: Shared(AMPLITUDE_KEY, Rows);
        /// Name of the load in stages.
        name: Name, Optional, example(r#""surcharge""#);
    }
    one_of required [from, circle, rectangle, disc, sphere, surface];
    one_of required [to, circle, rectangle, disc, sphere, surface];
    one_of required [stress, pressure, stress_path, pressure_path];
    one_of optional [ramp, amplitude, stress_path, pressure_path];
}

table! {
    /// Acceleration of the ground in a dynamic analysis. The frame of reference moves with the ground: supports are
    /// at rest, and displacements and velocities are relative to the ground.
    struct ShakingTable = "[shaking]" {
        /// Rows [t, ax, ay], in 3-D [t, ax, ay, az], with increasing t. The acceleration is linear between the rows,
        /// and zero after the last row. It is zero at t = 0, unless a row gives another value.
        acceleration: Course(In::Acceleration), Required,
            symbol("a"),
            example("[[0.0, 0.0, 0.0], [0.5, 2.0, 0.0], [1.0, 0.0, 0.0]]");
    }
}

table! {
    /// A force at a point of a body. The force moves with the point.
    struct PointLoadTable = "[[point_load]]" {
        /// Position of the point at the start.
        at: Vector(In::Length, Range::ANY), Required, example("[2.0, 6.0]");
        /// Force along the axes: in plane strain N per metre of thickness, in axisymmetry N on the whole ring, in 3-D
        /// N.
        force: Vector(In::LineForce, Range::ANY), Optional, symbol("F"), example(r#"[0.0, "-10 kN/m"]"#);
        /// Alternative to `force`: time-dependent force, in rows [t, x, y], in 3-D [t, x, y, z], with increasing t. The
        /// force is linear between the rows, and constant after the last row. It is zero at t = 0, unless a row gives
        /// another value. Time counts from the activation of the load.
        force_path: Course(In::LineForce), Optional, example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-10 kN/m"]]"#);
        ramp: Shared(RAMP_KEY, Quantity);
        amplitude: Shared(AMPLITUDE_KEY, Rows);
        /// Name of the load in stages.
        name: Name, Optional, example(r#""crane""#);
    }
    one_of required [force, force_path];
    one_of optional [ramp, amplitude, force_path];
}

table! {
    /// Division of the strength of all materials by a factor F. The cohesion becomes c/F, the friction angle
    /// atan(tan(φ)/F), and the dilation angle is limited to this friction angle.
    struct ReductionTable = "[strength_reduction]" {
        /// Factor by which the strength is divided.
        factor: Quantity(In::Number, FACTOR), Required, symbol("F"), example("1.3");
        /// With true, all materials are elastic and cannot yield.
        elastic: Flag, Default("false");
        /// Factor that multiplies Young's modulus of all materials.
        stiffness: Quantity(In::Number, Range::POSITIVE), Default("1.0"), example("10.0");
        /// With true, the run starts without stress and ignores [initial]. Loads without a ramp then grow over the
        /// whole run.
        unloaded: Flag, Default("false");
        /// Name of a stage. The strength is reduced at the end of this stage, from the state that is reached there.
        /// "start" is the state before the first stage, "end" the state at the end of the run. Later stages do not
        /// begin. With unloaded = true, the bodies and loads of that time act from the start. Pore water does not
        /// flow during the reduction; see `drainage`.
        stage: Text(64), Optional, example(r#""end""#);
        /// Behaviour of the pore water during the reduction, if a material has pore-water flow. Default: "drained",
        /// or "undrained" if no soil is permeable.
        drainage: Choice(Failure), Optional, example(r#""drained""#);
        /// Number of steps of the nominal size in which the strength is reduced after the end of the stage. With 0
        /// the run ends there, with full strength.
        steps: Count(0, 1000), Default("10"), example("10");
    }
}

table! {
    /// Initial stress under full gravity. Displacements are measured from this state.
    struct InitialTable = "[initial]" {
        /// K0 procedure: the vertical stress is the weight of the material above, and the horizontal stress is k0
        /// times the vertical one. A `k0` of a material takes precedence.
        k0: Quantity(In::Number, COEFFICIENT), Optional, symbol("K0"), example("0.5");
        /// Alternative to `k0`: stress of an elastic equilibrium under the loads at time 0.
        gravity: Choice(Start), Optional, example(r#""elastic""#);
        /// With this key the initial stress is brought into equilibrium with the loads at time 0, before the first
        /// step. Without this key the stress is not changed.
        equilibrium: Choice(Settled), Optional, example(r#""plastic""#);
    }
    one_of optional [k0, gravity];
}

table! {
    /// A stress that varies linearly with the height y, in 3-D z: value + per_metre (at_y - y), above and below at_y. A
    /// material point keeps the value of its initial height.
    struct StressProfileTable = "{ value, at_y, per_metre } of a stress" {
        /// Value at the height at_y.
        value: Quantity(In::Stress, Range::ANY), Required, example(r#""20 kPa""#);
        /// Height of `value`: y, in 3-D z.
        at_y: Quantity(In::Length, Range::ANY), Required, example(r#""10 m""#);
        /// Increase per metre of depth.
        per_metre: Gradient(In::Stress), Required, example(r#""2 kPa/m""#);
    }
}

table! {
    /// Stress components that vary linearly with the height y, in 3-D z: value + per_metre (at_y - y), above and below
    /// at_y. The height is that at the start.
    struct StressesProfileTable = "{ value, at_y, per_metre } of stresses" {
        /// Components along the axes at the height at_y.
        value: Vector(In::Stress, Range::ANY), Required, example(r#"["10 kPa", 0.0]"#);
        /// Height of `value`: y, in 3-D z.
        at_y: Quantity(In::Length, Range::ANY), Required, example(r#""10 m""#);
        /// Increase of each component per metre of depth.
        per_metre: GradientVector(In::Stress), Required, example(r#"["5 kPa/m", 0.0]"#);
    }
}

table! {
    /// An angle that varies linearly with the height y, in 3-D z: value + per_metre (at_y - y), above and below at_y. A
    /// material point keeps the value of its initial height.
    struct AngleProfileTable = "{ value, at_y, per_metre } of an angle" {
        /// Value at the height at_y.
        value: Quantity(In::Angle, Range::ANY), Required, example("30.0");
        /// Height of `value`: y, in 3-D z.
        at_y: Quantity(In::Length, Range::ANY), Required, example(r#""10 m""#);
        /// Increase per metre of depth.
        per_metre: Gradient(In::Angle), Required, example("0.5");
    }
}

impl TractionTable {
    /// The keys of what follows time.
    pub(crate) fn courses(&self) -> [&Field<Vec<ListRow>>; 3] {
        [&self.amplitude, &self.stress_path, &self.pressure_path]
    }

    /// The key of the load.
    pub(crate) fn load(&self) -> &KeyPlace {
        let keys: [&KeyPlace; 3] = [&self.pressure, &self.stress_path, &self.pressure_path];
        keys.into_iter().find(|key| key.is_given()).unwrap_or(&self.stress)
    }
}

impl PointLoadTable {
    /// The key of the load.
    pub(crate) fn load(&self) -> &KeyPlace {
        match self.force_path.is_given() {
            true => &self.force_path,
            false => &self.force,
        }
    }
}

/// A table that says how a number varies with depth.
pub(crate) trait DepthTable {
    /// The key of the number at a height.
    fn value(&self) -> &Field<f64>;

    /// The number by depth; `None` after an error.
    fn profile(&self) -> Option<Profile>;
}

/// The profile of a table with the keys `value`, `at_y` and `per_metre`.
macro_rules! depth_table {
    ($Table:ident) => {
        impl DepthTable for $Table {
            fn value(&self) -> &Field<f64> {
                &self.value
            }

            fn profile(&self) -> Option<Profile> {
                Some(Profile {
                    value: self.value.get()?,
                    at: self.at_y.get()?,
                    per_metre: self.per_metre.get()?,
                })
            }
        }
    };
}

depth_table!(StressProfileTable);
depth_table!(AngleProfileTable);

impl<T: DepthTable> Field<OrTable<f64, T>> {
    /// The number by depth; `None` without the key, or after an error.
    pub(crate) fn profile(&self) -> Option<Profile> {
        match self.value()? {
            OrTable::Value(value) => Some(Profile::constant(*value)),
            OrTable::Table(table) => table.profile(),
        }
    }
}

// Keys that several tables have.
const FRICTION_KEY: Key = key(
    "friction_coefficient",
    Kind::Quantity(In::Number, FRICTION),
    Required,
    "Friction coefficient, the tangent of the friction angle δ of the interface (wall friction): 0.364 for 20 degrees. \
     [strength_reduction] also reduces it.",
)
.symbol("μ")
.example("0.3")
.renamed_from(&["friction"]);
pub(super) const RECTANGLE_KEY: Key = key(
    "rectangle",
    Kind::Table(BoxTable::TABLE),
    Optional,
    "A rectangle. Only in 3-D. Both corners have the same coordinate along one axis.",
)
.example("{ lower = [0.0, 0.0, 6.0], upper = [1.0, 1.0, 6.0] }");
pub(super) const DISC_KEY: Key = key(
    "disc",
    Kind::Table(DiscTable::TABLE),
    Optional,
    "A disc. Only in 3-D. Parts outside the grid are ignored.",
)
.example("{ centre = [0.0, 0.0, 6.0], radius = 1.0 }");
pub(super) const DISPLACEMENT_KEY: Key = key(
    "displacement",
    Kind::Vector(In::Length, Range::ANY),
    Optional,
    "Prescribed displacement at the end of the run. It grows linearly with time.",
)
.symbol("u")
.example("[0.0, -0.2]");
pub(super) const VELOCITY_KEY: Key = key(
    "velocity",
    Kind::Vector(In::Velocity, Range::ANY),
    Optional,
    "Prescribed constant velocity. In a quasi-static analysis give numbers, in metres per unit of pseudo-time.",
)
.symbol("v")
.example("[0.0, -0.01]");
pub(super) const PATH_KEY: Key = key(
    "path",
    Kind::Course(In::Length),
    Optional,
    "Prescribed displacement, in rows [t, ux, uy], in 3-D [t, ux, uy, uz], with increasing t. It is zero at t = 0, \
     linear between the rows, and constant after the last row.",
)
.example("[[0.0, 0.0, 0.0], [1.0, 0.0, -0.2]]");
pub(super) const FROM_KEY: Key = key(
    "from",
    Kind::Pair(In::Length, Range::ANY),
    Optional,
    "One end of the segment at the start.",
)
.example("[0.0, 2.0]");
pub(super) const TO_KEY: Key = key(
    "to",
    Kind::Pair(In::Length, Range::ANY),
    Optional,
    "The other end of the segment.",
)
.example("[0.0, 4.0]");
const RAMP_KEY: Key = key(
    "ramp",
    Kind::Quantity(In::Time, Range::NOT_NEGATIVE),
    Default("0.0"),
    "Time in which the load grows from zero to its full value. With 0 the full load acts at once.",
)
.example("1.0");
const AMPLITUDE_KEY: Key = key(
    "amplitude",
    Kind::Rows(AMPLITUDE),
    Optional,
    "Alternative to `ramp`: factor that multiplies the load, in rows [t, factor] with increasing t. The factor is \
     linear between the rows, and constant after the last row. It is zero at t = 0, unless a row gives another value. \
     Time counts from the activation of the load.",
)
.example("[[0.0, 0.0], [1.0, 1.0]]");
