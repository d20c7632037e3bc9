//! Schema of footings, prescribed displacements, loads, strength reduction and initial stress.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Key, Kind, Range, Table, body, key, one_of};
use crate::record::{Field, OrTable};
use crate::words::{Axis, Base, Components, Failure, Settled, Side, Start, Support, Word};
use std::ops::Bound::Included;

const PLACE: Kind = Pair(In::Length, Range::ANY);
pub(super) const DISPLACEMENT: Kind = Vector(In::Length, Range::ANY);
pub(super) const VELOCITY: Kind = Vector(In::Velocity, Range::ANY);
pub(super) const PATH: Kind = Course(In::Length);
pub(super) const RECTANGLE: Kind = Kind::Table(&body::BOX);
pub(super) const AMPLITUDE: Kind = Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Number, Range::ANY)]);
/// Of a load whose direction may change.
pub(super) const RAMP: Kind = Quantity(In::Time, Range::NOT_NEGATIVE);
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

pub(super) static FOOTING: Table = Table {
    header: "[footing]",
    doc: "A rigid footing with a prescribed motion. Its base is a segment, in 3-D a plate.",
    keys: &[
        key("from", PLACE, Optional, "One end of the base at the start.").example("[0.0, 10.0]"),
        key("to", PLACE, Optional, "The other end of the base.").example("[2.0, 10.0]"),
        RECTANGLE_KEY,
        DISC_KEY,
        DISPLACEMENT_KEY,
        VELOCITY_KEY,
        PATH_KEY,
        key(
            "interface",
            ChoiceOr(Base::WORDS, &FRICTIONAL),
            Default("\"smooth\""),
            "Interface of the base and the soil. A table defines a frictional contact.",
        )
        .example(r#""rough""#)
        .renamed_from(&["base"]),
        key(
            "name",
            Name,
            Optional,
            "Name of the footing in stages and histories. Default: \"footing\".",
        )
        .example(r#""footing""#),
    ],
    exclusive: &[
        one_of(&["from", "rectangle", "disc"], true),
        one_of(&["to", "rectangle", "disc"], true),
        one_of(&["displacement", "velocity", "path"], true),
    ],
};

pub(super) static DISC: Table = Table {
    header: "disc = { centre, radius, normal }",
    doc: "A flat disc.",
    keys: &[
        key(
            "centre",
            Vector(In::Length, Range::ANY),
            Required,
            "Centre of the disc.",
        )
        .example("[0.0, 0.0, 2.0]")
        .renamed_from(&["center"]),
        key(
            "radius",
            Quantity(In::Length, Range::POSITIVE),
            Required,
            "Radius of the disc.",
        )
        .example(r#""1 m""#),
        key(
            "normal",
            Choice(Axis::WORDS),
            Default("\"z\""),
            "The axis normal to the disc.",
        )
        .example(r#""z""#),
    ],
    exclusive: &[],
};

pub(super) static PRESCRIBED: Table = Table {
    header: "[[prescribed]]",
    doc: "A prescribed motion of the soil at a face of the grid or at a segment, in 3-D at a plate.",
    keys: &[
        key(
            "face",
            Choice(Side::WORDS),
            Optional,
            "The face of the grid that moves. It must be free in [boundary].",
        )
        .example(r#""left""#),
        FROM_KEY,
        TO_KEY,
        RECTANGLE_KEY,
        DISC_KEY,
        DISPLACEMENT_KEY,
        VELOCITY_KEY,
        PATH_KEY,
        key(
            "components",
            ChoiceOr(Components::WORDS, &FRICTIONAL),
            Default("\"all\""),
            "Displacement components that are prescribed. A table defines a frictional contact of a segment.",
        )
        .example(r#""normal""#),
        key("name", Name, Optional, "Name of the motion in stages and histories.").example(r#""wall""#),
    ],
    exclusive: &[
        one_of(&["face", "from", "rectangle", "disc"], true),
        one_of(&["face", "to", "rectangle", "disc"], true),
        one_of(&["displacement", "velocity", "path"], true),
    ],
};

static FRICTIONAL: Table = Table {
    header: "interface = { friction_coefficient, separates }",
    doc: "Contact with Coulomb friction between a footing or prescribed segment and the soil on one side of it.",
    keys: &[
        FRICTION_KEY,
        key(
            "separates",
            Flag,
            Default("true"),
            "With true, the soil may separate. With false the normal displacement stays prescribed, and under tension \
             there is no friction.",
        )
        .renamed_from(&["lifts"]),
    ],
    exclusive: &[],
};

pub(super) static TRACTION: Table = Table {
    header: "[[traction]]",
    doc: "A load per area of a surface. In 2-D the surface is a segment or a circle; in 3-D a rectangle, a disc, a \
          sphere or triangles. The load moves with the soil.",
    keys: &[
        FROM_KEY,
        TO_KEY,
        CIRCLE_KEY,
        RECTANGLE_KEY,
        DISC_KEY,
        key(
            "sphere",
            Kind::Table(&body::SPHERE),
            Optional,
            "A sphere. Only in 3-D. Parts outside the grid are ignored.",
        )
        .example(r#"{ centre = [0.0, 0.0, 4.0], radius = "1 m" }"#),
        key(
            "surface",
            Kind::Table(&body::SURFACE),
            Optional,
            "Triangles on the surface of bodies. Only in 3-D.",
        )
        .example(r#"{ triangles = { file = "surface.stl" } }"#),
        key(
            "stress",
            PairProfile(In::Stress, Range::ANY, &STRESSES_PROFILE),
            Optional,
            "Dead load: force per undeformed area, in components along the axes. Its direction is constant.",
        )
        .example(r#"[0.0, "-50 kPa"]"#),
        key(
            "pressure",
            Profile(In::Stress, Range::ANY, &STRESS_PROFILE),
            Optional,
            "Alternative to `stress`: pressure that presses on the body. It stays normal to the deformed surface \
             (follower load).",
        )
        .example(r#""50 kPa""#),
        key(
            "stress_path",
            Course(In::Stress),
            Optional,
            "Alternative to `stress`: time-dependent load, in rows [t, x, y], in 3-D [t, x, y, z], with increasing t. \
             The stress is linear between the rows, and constant after the last row. It is zero at t = 0, unless a row \
             gives another value. Time counts from the activation of the load.",
        )
        .example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-50 kPa"]]"#),
        key(
            "pressure_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)]),
            Optional,
            "Alternative to `pressure`: time-dependent pressure, in rows [t, pressure] with increasing t. The pressure \
             is linear between the rows, and constant after the last row. It is zero at t = 0, unless a row gives \
             another value. Time counts from the activation of the load.",
        )
        .example(r#"[[0.0, 0.0], [1.0, "50 kPa"]]"#),
        RAMP_KEY,
        AMPLITUDE_KEY,
        key("name", Name, Optional, "Name of the load in stages.").example(r#""surcharge""#),
    ],
    exclusive: &[
        one_of(&["from", "circle", "rectangle", "disc", "sphere", "surface"], true),
        one_of(&["to", "circle", "rectangle", "disc", "sphere", "surface"], true),
        one_of(&["stress", "pressure", "stress_path", "pressure_path"], true),
        one_of(&["ramp", "amplitude", "stress_path", "pressure_path"], false),
    ],
};

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

pub(super) static POINT_LOAD: Table = Table {
    header: "[[point_load]]",
    doc: "A force at a point of a body. The force moves with the point.",
    keys: &[
        key(
            "at",
            Vector(In::Length, Range::ANY),
            Required,
            "Position of the point at the start.",
        )
        .example("[2.0, 6.0]"),
        key(
            "force",
            Vector(In::LineForce, Range::ANY),
            Optional,
            "Force along the axes: in plane strain N per metre of thickness, in axisymmetry N on the whole ring, in \
             3-D N.",
        )
        .symbol("F")
        .example(r#"[0.0, "-10 kN/m"]"#),
        key(
            "force_path",
            Course(In::LineForce),
            Optional,
            "Alternative to `force`: time-dependent force, in rows [t, x, y], in 3-D [t, x, y, z], with increasing t. \
             The force is linear between the rows, and constant after the last row. It is zero at t = 0, unless a row \
             gives another value. Time counts from the activation of the load.",
        )
        .example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-10 kN/m"]]"#),
        RAMP_KEY,
        AMPLITUDE_KEY,
        key("name", Name, Optional, "Name of the load in stages.").example(r#""crane""#),
    ],
    exclusive: &[
        one_of(&["force", "force_path"], true),
        one_of(&["ramp", "amplitude", "force_path"], false),
    ],
};

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

pub(super) static STRESS_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of a stress",
    doc: "A stress that varies linearly with the height y, in 3-D z: value + per_metre (at_y - y), above and below \
          at_y. A material point keeps the value of its initial height.",
    keys: &[
        key(
            "value",
            Quantity(In::Stress, Range::ANY),
            Required,
            "Value at the height at_y.",
        )
        .example(r#""20 kPa""#),
        key(
            "at_y",
            Quantity(In::Length, Range::ANY),
            Required,
            "Height of `value`: y, in 3-D z.",
        )
        .example(r#""10 m""#),
        key(
            "per_metre",
            Gradient(In::Stress),
            Required,
            "Increase per metre of depth.",
        )
        .example(r#""2 kPa/m""#),
    ],
    exclusive: &[],
};

static STRESSES_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of stresses",
    doc: "Stress components that vary linearly with the height y, in 3-D z: value + per_metre (at_y - y), above and \
          below at_y. The height is that at the start.",
    keys: &[
        key(
            "value",
            Vector(In::Stress, Range::ANY),
            Required,
            "Components along the axes at the height at_y.",
        )
        .example(r#"["10 kPa", 0.0]"#),
        key(
            "at_y",
            Quantity(In::Length, Range::ANY),
            Required,
            "Height of `value`: y, in 3-D z.",
        )
        .example(r#""10 m""#),
        key(
            "per_metre",
            GradientVector(In::Stress),
            Required,
            "Increase of each component per metre of depth.",
        )
        .example(r#"["5 kPa/m", 0.0]"#),
    ],
    exclusive: &[],
};

pub(super) static ANGLE_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of an angle",
    doc: "An angle that varies linearly with the height y, in 3-D z: value + per_metre (at_y - y), above and below \
          at_y. A material point keeps the value of its initial height.",
    keys: &[
        key(
            "value",
            Quantity(In::Angle, Range::ANY),
            Required,
            "Value at the height at_y.",
        )
        .example("30.0"),
        key(
            "at_y",
            Quantity(In::Length, Range::ANY),
            Required,
            "Height of `value`: y, in 3-D z.",
        )
        .example(r#""10 m""#),
        key(
            "per_metre",
            Gradient(In::Angle),
            Required,
            "Increase per metre of depth.",
        )
        .example("0.5"),
    ],
    exclusive: &[],
};

// Keys that several tables have.
const FRICTION_KEY: Key = key(
    "friction_coefficient",
    Quantity(In::Number, Range::of(Included(0.0), Included(2.0))),
    Required,
    "Friction coefficient, the tangent of the friction angle δ of the interface (wall friction): 0.364 for 20 degrees. \
     [strength_reduction] also reduces it.",
)
.symbol("μ")
.example("0.3")
.renamed_from(&["friction"]);
pub(super) const RECTANGLE_KEY: Key = key(
    "rectangle",
    RECTANGLE,
    Optional,
    "A rectangle. Only in 3-D. Both corners have the same coordinate along one axis.",
)
.example("{ lower = [0.0, 0.0, 6.0], upper = [1.0, 1.0, 6.0] }");
pub(super) const DISC_KEY: Key = key(
    "disc",
    Kind::Table(&DISC),
    Optional,
    "A disc. Only in 3-D. Parts outside the grid are ignored.",
)
.example("{ centre = [0.0, 0.0, 6.0], radius = 1.0 }");
pub(super) const DISPLACEMENT_KEY: Key = key(
    "displacement",
    DISPLACEMENT,
    Optional,
    "Prescribed displacement at the end of the run. It grows linearly with time.",
)
.symbol("u")
.example("[0.0, -0.2]");
pub(super) const VELOCITY_KEY: Key = key(
    "velocity",
    VELOCITY,
    Optional,
    "Prescribed constant velocity. In a quasi-static analysis give numbers, in metres per unit of pseudo-time.",
)
.symbol("v")
.example("[0.0, -0.01]");
pub(super) const PATH_KEY: Key = key(
    "path",
    PATH,
    Optional,
    "Prescribed displacement, in rows [t, ux, uy], in 3-D [t, ux, uy, uz], with increasing t. It is zero at t = 0, \
     linear between the rows, and constant after the last row.",
)
.example("[[0.0, 0.0, 0.0], [1.0, 0.0, -0.2]]");
pub(super) const FROM_KEY: Key =
    key("from", PLACE, Optional, "One end of the segment at the start.").example("[0.0, 2.0]");
pub(super) const TO_KEY: Key = key("to", PLACE, Optional, "The other end of the segment.").example("[0.0, 4.0]");
pub(super) const CIRCLE_KEY: Key = key(
    "circle",
    Kind::Table(&body::CIRCLE),
    Optional,
    "A circle. Parts outside the grid are ignored.",
)
.example(r#"{ centre = [2.0, 2.0], radius = "1 m" }"#);
const RAMP_KEY: Key = key(
    "ramp",
    RAMP,
    Default("0.0"),
    "Time in which the load grows from zero to its full value. With 0 the full load acts at once.",
)
.example("1.0");
const AMPLITUDE_KEY: Key = key(
    "amplitude",
    AMPLITUDE,
    Optional,
    "Alternative to `ramp`: factor that multiplies the load, in rows [t, factor] with increasing t. The factor is \
     linear between the rows, and constant after the last row. It is zero at t = 0, unless a row gives another value. \
     Time counts from the activation of the load.",
)
.example("[[0.0, 0.0], [1.0, 1.0]]");
