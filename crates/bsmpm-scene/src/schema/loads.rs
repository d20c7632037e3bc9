//! Schema of footings, prescribed displacements, loads, strength reduction and initial stress.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Key, Kind, Range, Table, body, key, one_of};
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

/// What a face of the grid is.
pub(super) const SUPPORT: Kind = ChoiceOr(Support::WORDS, &CONTACT);

static CONTACT: Table = Table {
    header: "left = { friction_coefficient, separates }",
    doc: "Frictional contact (Coulomb) of the material with a face of the grid. The material may separate from it.",
    keys: &[
        FRICTION_KEY,
        key(
            "separates",
            Flag,
            Default("true"),
            "Whether the material may separate. With false the normal displacement stays zero, and under tension \
             there is no friction.",
        )
        .renamed_from(&["lifts"]),
    ],
    exclusive: &[],
};

pub(super) static FOOTING: Table = Table {
    header: "[footing]",
    doc: "A rigid footing, in 3-D a rigid plate, with a prescribed displacement. The material at its base moves with \
          it.",
    keys: &[
        key("from", PLACE, Optional, "One end of its base, at the start.").example("[0.0, 10.0]"),
        key("to", PLACE, Optional, "The other end of its base.").example("[2.0, 10.0]"),
        RECTANGLE_KEY,
        DISC_KEY,
        DISPLACEMENT_KEY,
        VELOCITY_KEY,
        PATH_KEY,
        key(
            "interface",
            ChoiceOr(Base::WORDS, &FRICTIONAL),
            Default("\"smooth\""),
            "Interface with the soil: \"smooth\" prescribes the normal displacement only, \"rough\" all components. \
             A table makes it a frictional contact.",
        )
        .example(r#""rough""#)
        .renamed_from(&["base"]),
        key(
            "name",
            Name,
            Optional,
            "Name by which stages and histories refer to it. Without this key it is \"footing\".",
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
        key("centre", Vector(In::Length, Range::ANY), Required, "Its centre.")
            .example("[0.0, 0.0, 2.0]")
            .renamed_from(&["center"]),
        key("radius", Quantity(In::Length, Range::POSITIVE), Required, "Its radius.").example(r#""1 m""#),
        key("normal", Choice(Axis::WORDS), Default("\"z\""), "The axis normal to the disc.").example(r#""z""#),
    ],
    exclusive: &[],
};

pub(super) static PRESCRIBED: Table = Table {
    header: "[[prescribed]]",
    doc: "A prescribed displacement of a face of the grid or of a segment, in 3-D of a plate. The material at it \
          moves with it.",
    keys: &[
        key("face", Choice(Side::WORDS), Optional, "The face of the grid, which must be free in [boundary].")
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
            "Components that are prescribed. For a segment, a table makes it a frictional contact.",
        )
        .example(r#""normal""#),
        key("name", Name, Optional, "Name by which stages and histories refer to it.").example(r#""wall""#),
    ],
    exclusive: &[
        one_of(&["face", "from", "rectangle", "disc"], true),
        one_of(&["face", "to", "rectangle", "disc"], true),
        one_of(&["displacement", "velocity", "path"], true),
    ],
};

static FRICTIONAL: Table = Table {
    header: "interface = { friction_coefficient, separates }",
    doc: "Frictional contact (Coulomb) of a footing or a prescribed segment with the material on one side of it. The \
          material may separate from it.",
    keys: &[
        FRICTION_KEY,
        key(
            "separates",
            Flag,
            Default("true"),
            "Whether the material may separate. With false the normal displacement stays prescribed, and under \
             tension there is no friction.",
        )
        .renamed_from(&["lifts"]),
    ],
    exclusive: &[],
};

pub(super) static TRACTION: Table = Table {
    header: "[[traction]]",
    doc: "A stress on a segment of a body's surface or on a circle, in 3-D on a rectangle, a disc, a sphere or \
          triangles. It moves with the surface.",
    keys: &[
        FROM_KEY,
        TO_KEY,
        CIRCLE_KEY,
        RECTANGLE_KEY,
        DISC_KEY,
        key("sphere", Kind::Table(&body::SPHERE), Optional, "A sphere in 3-D. Only its part inside the grid counts.")
            .example(r#"{ centre = [0.0, 0.0, 4.0], radius = "1 m" }"#),
        key("surface", Kind::Table(&body::SURFACE), Optional, "A surface of triangles at bodies, in 3-D.")
            .example(r#"{ triangles = { file = "surface.stl" } }"#),
        key(
            "stress",
            PairProfile(In::Stress, Range::ANY, &STRESSES_PROFILE),
            Optional,
            "Force per area of the undeformed surface along the axes. It keeps its direction (dead load).",
        )
        .example(r#"[0.0, "-50 kPa"]"#),
        key(
            "pressure",
            Profile(In::Stress, Range::ANY, &STRESS_PROFILE),
            Optional,
            "Pressure normal to the deformed surface, against the body on one side of it (follower load), instead of \
             stress.",
        )
        .example(r#""50 kPa""#),
        key(
            "stress_path",
            Course(In::Stress),
            Optional,
            "Rows [t, x, y], in 3-D [t, x, y, z], of the stress, instead of stress, with t increasing. The stress is \
             interpolated linearly. It is zero at time 0, unless a row gives another value, and constant after the \
             last row. Time 0 is the beginning of the stage that activates the load.",
        )
        .example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-50 kPa"]]"#),
        key(
            "pressure_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)]),
            Optional,
            "Rows [t, pressure], instead of pressure, with t increasing. The pressure is interpolated linearly. It \
             is zero at time 0, unless a row gives another value, and constant after the last row. Time 0 is the \
             beginning of the stage that activates the load.",
        )
        .example(r#"[[0.0, 0.0], [1.0, "50 kPa"]]"#),
        RAMP_KEY,
        AMPLITUDE_KEY,
        key("name", Name, Optional, "Name by which stages refer to it.").example(r#""surcharge""#),
    ],
    exclusive: &[
        one_of(&["from", "circle", "rectangle", "disc", "sphere", "surface"], true),
        one_of(&["to", "circle", "rectangle", "disc", "sphere", "surface"], true),
        one_of(&["stress", "pressure", "stress_path", "pressure_path"], true),
        one_of(&["ramp", "amplitude", "stress_path", "pressure_path"], false),
    ],
};

pub(super) static SHAKING: Table = Table {
    header: "[shaking]",
    doc: "Acceleration of the ground in a dynamic analysis. The case is described in the moving frame of the ground: \
          supports are at rest, and displacements and velocities are relative to the ground.",
    keys: &[key(
        "acceleration",
        Course(In::Acceleration),
        Required,
        "Rows [t, ax, ay], in 3-D [t, ax, ay, az], with t increasing. The acceleration is interpolated linearly. \
             It is zero at time 0, unless a row gives another value, and zero after the last row.",
    )
    .symbol("a")
    .example("[[0.0, 0.0, 0.0], [0.5, 2.0, 0.0], [1.0, 0.0, 0.0]]")],
    exclusive: &[],
};

pub(super) static POINT_LOAD: Table = Table {
    header: "[[point_load]]",
    doc: "A force at a point of a body. It moves with the point.",
    keys: &[
        key("at", Vector(In::Length, Range::ANY), Required, "Place of the point at the start.").example("[2.0, 6.0]"),
        key(
            "force",
            Vector(In::LineForce, Range::ANY),
            Optional,
            "Force along the axes, in N per metre of thickness. In axisymmetry it is the force on the whole ring, \
             and in 3-D the force itself, both in N.",
        )
        .symbol("F")
        .example(r#"[0.0, "-10 kN/m"]"#),
        key(
            "force_path",
            Course(In::LineForce),
            Optional,
            "Rows [t, x, y], in 3-D [t, x, y, z], of the force, instead of force, with t increasing. The force is \
             interpolated linearly. It is zero at time 0, unless a row gives another value, and constant after the \
             last row. Time 0 is the beginning of the stage that activates the load.",
        )
        .example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-10 kN/m"]]"#),
        RAMP_KEY,
        AMPLITUDE_KEY,
        key("name", Name, Optional, "Name by which stages refer to it.").example(r#""crane""#),
    ],
    exclusive: &[one_of(&["force", "force_path"], true), one_of(&["ramp", "amplitude", "force_path"], false)],
};

pub(super) static REDUCTION: Table = Table {
    header: "[strength_reduction]",
    doc: "Division of the strength of all materials by a factor F: the cohesion is c/F, the friction angle \
          atan(tan(φ)/F), and the dilation angle at most the new friction angle.",
    keys: &[
        key("factor", Quantity(In::Number, FACTOR), Required, "The factor F.").symbol("F").example("1.3"),
        key("elastic", Flag, Default("false"), "With true, all materials are elastic, without a strength."),
        key(
            "stiffness",
            Quantity(In::Number, Range::POSITIVE),
            Default("1.0"),
            "Factor of Young's modulus of all materials.",
        )
        .example("10.0"),
        key(
            "unloaded",
            Flag,
            Default("false"),
            "With true, the run starts without stress: [initial] is ignored, and loads that would act at once grow \
             over the run.",
        ),
        key(
            "stage",
            Text(64),
            Optional,
            "Name of a stage. The strength is reduced at its end, from the state that is reached there. \"start\" is \
             the state before the first stage, \"end\" that at the end of the run. Later stages do not begin. With \
             unloaded = true, the bodies and loads of that time act from the start. Pore water does not flow during \
             the reduction, see `drainage`.",
        )
        .example(r#""end""#),
        key(
            "drainage",
            Choice(Failure::WORDS),
            Optional,
            "Drainage during the failure, if a material has pore-water flow. Without this key it is \"drained\", or \
             \"undrained\" if no soil is permeable.",
        )
        .example(r#""drained""#),
        key(
            "steps",
            Count(0, 1000),
            Default("10"),
            "Number of equal steps, of the nominal length, over which the strength is reduced after the end of the \
             stage. With 0 the run ends there.",
        )
        .example("10"),
    ],
    exclusive: &[],
};

pub(super) static INITIAL: Table = Table {
    header: "[initial]",
    doc: "Stress at the start, under full gravity. Displacements count from this state.",
    keys: &[
        key(
            "k0",
            Quantity(In::Number, COEFFICIENT),
            Optional,
            "K0 procedure: the vertical stress is the weight of the material above, and the horizontal stress is k0 \
             times the vertical one. It applies to materials that do not give their k0.",
        )
        .symbol("K0")
        .example("0.5"),
        key("gravity", Choice(Start::WORDS), Optional, "Elastic equilibrium under the loads at time 0, instead of k0.")
            .example(r#""elastic""#),
        key(
            "equilibrium",
            Choice(Settled::WORDS),
            Optional,
            "Equilibrium to which this stress is brought under the loads at time 0, before the first step. Without \
             this key the stress stays as it is.",
        )
        .example(r#""plastic""#),
    ],
    exclusive: &[one_of(&["k0", "gravity"], false)],
};

pub(super) static STRESS_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of a stress",
    doc: "A stress that grows linearly with depth: value + per_metre (at_y - y), also above at_y. In 3-D the height \
          is z. A material point keeps the value of its place at the start.",
    keys: &[
        key("value", Quantity(In::Stress, Range::ANY), Required, "Value at the height at_y.").example(r#""20 kPa""#),
        key("at_y", Quantity(In::Length, Range::ANY), Required, "The height, in 3-D z.").example(r#""10 m""#),
        key("per_metre", Gradient(In::Stress), Required, "Growth per metre of depth.").example(r#""2 kPa/m""#),
    ],
    exclusive: &[],
};

static STRESSES_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of stresses",
    doc: "Stresses along the axes that grow linearly with depth: value + per_metre (at_y - y), also above at_y. The \
          height, in 3-D z, is that at the start.",
    keys: &[
        key("value", Vector(In::Stress, Range::ANY), Required, "Values at the height at_y, along the axes.")
            .example(r#"["10 kPa", 0.0]"#),
        key("at_y", Quantity(In::Length, Range::ANY), Required, "The height, in 3-D z.").example(r#""10 m""#),
        key("per_metre", GradientVector(In::Stress), Required, "Growth per metre of depth, along the axes.")
            .example(r#"["5 kPa/m", 0.0]"#),
    ],
    exclusive: &[],
};

pub(super) static ANGLE_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of an angle",
    doc: "An angle that grows linearly with depth: value + per_metre (at_y - y), also above at_y. In 3-D the height \
          is z. A material point keeps the value of its place at the start.",
    keys: &[
        key("value", Quantity(In::Angle, Range::ANY), Required, "Value at the height at_y.").example("30.0"),
        key("at_y", Quantity(In::Length, Range::ANY), Required, "The height, in 3-D z.").example(r#""10 m""#),
        key("per_metre", Gradient(In::Angle), Required, "Growth per metre of depth.").example("0.5"),
    ],
    exclusive: &[],
};

// Keys that several tables have.
const FRICTION_KEY: Key = key(
    "friction_coefficient",
    Quantity(In::Number, Range::of(Included(0.0), Included(2.0))),
    Required,
    "Friction coefficient, the tangent of the friction angle of the interface. [strength_reduction] divides \
             it too.",
)
.symbol("μ")
.example("0.3")
.renamed_from(&["friction"]);
pub(super) const RECTANGLE_KEY: Key =
    key("rectangle", RECTANGLE, Optional, "A rectangle in 3-D, given as a box without thickness along one axis.")
        .example("{ lower = [0.0, 0.0, 6.0], upper = [1.0, 1.0, 6.0] }");
pub(super) const DISC_KEY: Key =
    key("disc", Kind::Table(&DISC), Optional, "A disc in 3-D. Only its part inside the grid counts.")
        .example("{ centre = [0.0, 0.0, 6.0], radius = 1.0 }");
pub(super) const DISPLACEMENT_KEY: Key =
    key("displacement", DISPLACEMENT, Optional, "Displacement at the end of the run. It grows linearly with time.")
        .symbol("u")
        .example("[0.0, -0.2]");
pub(super) const VELOCITY_KEY: Key = key(
    "velocity",
    VELOCITY,
    Optional,
    "Constant velocity. In a quasi-static analysis it is a number: metres per unit of pseudo-time.",
)
.symbol("v")
.example("[0.0, -0.01]");
pub(super) const PATH_KEY: Key = key(
    "path",
    PATH,
    Optional,
    "Rows [t, ux, uy], in 3-D [t, ux, uy, uz], with t increasing. The displacement is interpolated linearly, \
             starts from zero at time 0 and is constant after the last row.",
)
.example("[[0.0, 0.0, 0.0], [1.0, 0.0, -0.2]]");
pub(super) const FROM_KEY: Key =
    key("from", PLACE, Optional, "One end of the segment, at the start.").example("[0.0, 2.0]");
pub(super) const TO_KEY: Key = key("to", PLACE, Optional, "The other end of the segment.").example("[0.0, 4.0]");
pub(super) const CIRCLE_KEY: Key =
    key("circle", Kind::Table(&body::CIRCLE), Optional, "A circle. Only its part inside the grid counts.")
        .example(r#"{ centre = [2.0, 2.0], radius = "1 m" }"#);
const RAMP_KEY: Key =
    key("ramp", RAMP, Default("0.0"), "Time over which the load grows to its full value. With 0 it acts at once.")
        .example("1.0");
const AMPLITUDE_KEY: Key = key(
    "amplitude",
    AMPLITUDE,
    Optional,
    "Rows [t, factor] of the load, instead of ramp, with t increasing. The factor is interpolated linearly. \
             It is zero at time 0, unless a row gives another value, and constant after the last row. Time 0 is the \
             beginning of the stage that activates the load.",
)
.example("[[0.0, 0.0], [1.0, 1.0]]");
