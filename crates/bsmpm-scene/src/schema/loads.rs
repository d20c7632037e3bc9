//! The tables of what acts on the bodies besides gravity, and of what varies with depth.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, body, key, one_of};
use crate::words::{Axis, Base, Components, Failure, Settled, Side, Start, Support, Word};
use std::ops::Bound::Included;

const PLACE: Kind = Pair(In::Length, Range::ANY);
pub(super) const DISPLACEMENT: Kind = Vector(In::Length, Range::ANY);
pub(super) const VELOCITY: Kind = Vector(In::Velocity, Range::ANY);
pub(super) const PATH: Kind = Course(In::Length);
pub(super) const RECTANGLE: Kind = Kind::Table(&body::BOX);
pub(super) const AMPLITUDE: Kind = Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Number, Range::ANY)]);
/// Of a load whose direction may change.
const FORCES: &str = "rows [t, x, y] instead (3-D: also z), as they are at the times t, increasing; linear between, from \
                      0 at time 0, constant after the last; time 0 is that of the stage that applies it";
pub(super) const RAMP: Kind = Quantity(In::Time, Range::NOT_NEGATIVE);
/// That strength is divided by.
pub(super) const FACTOR: Range = Range::of(Included(0.1), Included(100.0));
/// Horizontal over vertical stress: from nothing to far beyond passive pressure.
pub(super) const COEFFICIENT: Range = Range::of(Included(0.0), Included(100.0));

/// What a face of the grid is.
pub(super) const SUPPORT: Kind = ChoiceOr(Support::WORDS, &CONTACT);

static CONTACT: Table = Table {
    header: "FACE = { friction_coefficient, separates }",
    doc: "A face in frictional contact (Coulomb) with the material, which may separate from it",
    keys: &[
        key(
            "friction_coefficient",
            Quantity(In::Number, Range::of(Included(0.0), Included(2.0))),
            Required,
            "tangent of the angle of friction between face and material; [strength_reduction] divides it, too",
        )
        .renamed_from(&["friction"]),
        key(
            "separates",
            Flag,
            Default("true"),
            "whether the material may separate from the face; false: the normal component stays fixed, and there is no friction \
             under tension",
        )
        .renamed_from(&["lifts"]),
    ],
    exclusive: &[],
};

pub(super) static FOOTING: Table = Table {
    header: "[footing]",
    doc: "A rigid strip, in 3-D a plate, that moves on a given way and holds the material at its base (section 3.3)",
    keys: &[
        key("from", PLACE, Optional, "one end of its base at the start"),
        key("to", PLACE, Optional, "the other end"),
        key("rectangle", RECTANGLE, Optional, "in 3-D, instead: a box whose corners are alike along one axis"),
        key("disc", Kind::Table(&DISC), Optional, "in 3-D, instead: a disc, the part of it inside the grid"),
        key("displacement", DISPLACEMENT, Optional, "reached at the end, linear in time"),
        key("velocity", VELOCITY, Optional, "constant; quasi-static: m per unit of pseudo-time, numbers"),
        key(
            "path",
            PATH,
            Optional,
            "rows [t, ux, uy], t increasing; linear between, 0 at time 0, constant after the last",
        ),
        key(
            "interface",
            ChoiceOr(Base::WORDS, &FRICTIONAL),
            Default("\"smooth\""),
            "\"smooth\" fixes the normal component, \"rough\" all components; or a table: frictional contact",
        )
        .renamed_from(&["base"]),
        key("name", Name, Optional, "what stages and histories call it; \"footing\" unless given"),
    ],
    exclusive: &[
        one_of(&["from", "rectangle", "disc"], true),
        one_of(&["to", "rectangle", "disc"], true),
        one_of(&["displacement", "velocity", "path"], true),
    ],
};

pub(super) static DISC: Table = Table {
    header: "disc = { centre, radius, normal }",
    doc: "A flat disc",
    keys: &[
        key("centre", Vector(In::Length, Range::ANY), Required, "its centre").renamed_from(&["center"]),
        key("radius", Quantity(In::Length, Range::POSITIVE), Required, "its radius"),
        key("normal", Choice(Axis::WORDS), Default("\"z\""), "the axis that is normal to it"),
    ],
    exclusive: &[],
};

pub(super) static PRESCRIBED: Table = Table {
    header: "[[prescribed]]",
    doc: "Motion of a face of the grid, or of a segment, in 3-D of a plate, which holds the material at it",
    keys: &[
        key("face", Choice(Side::WORDS), Optional, "the face; free in [boundary]"),
        key("from", PLACE, Optional, "one end of a segment at the start"),
        key("to", PLACE, Optional, "the other end"),
        key("rectangle", RECTANGLE, Optional, "in 3-D: a box whose corners are alike along one axis"),
        key("disc", Kind::Table(&DISC), Optional, "in 3-D: a disc, the part of it inside the grid"),
        key("displacement", DISPLACEMENT, Optional, "reached at the end, linear in time"),
        key("velocity", VELOCITY, Optional, "constant; quasi-static: m per unit of pseudo-time, numbers"),
        key(
            "path",
            PATH,
            Optional,
            "rows [t, ux, uy], t increasing; linear between, 0 at time 0, constant after the last",
        ),
        key(
            "components",
            ChoiceOr(Components::WORDS, &FRICTIONAL),
            Default("\"all\""),
            "which components are prescribed; or a table, of a segment: frictional contact",
        ),
        key("name", Name, Optional, "what stages and histories call it"),
    ],
    exclusive: &[
        one_of(&["face", "from", "rectangle", "disc"], true),
        one_of(&["face", "to", "rectangle", "disc"], true),
        one_of(&["displacement", "velocity", "path"], true),
    ],
};

static FRICTIONAL: Table = Table {
    header: "STRIP = { friction_coefficient, separates }",
    doc: "A strip in frictional contact (Coulomb) with the material on one side of it, which may separate from it",
    keys: &[
        key(
            "friction_coefficient",
            Quantity(In::Number, Range::of(Included(0.0), Included(2.0))),
            Required,
            "tangent of the angle of friction between strip and material; [strength_reduction] divides it, too",
        )
        .renamed_from(&["friction"]),
        key(
            "separates",
            Flag,
            Default("true"),
            "whether the material may separate from the strip; false: the normal component stays fixed, and there is no friction \
             under tension",
        )
        .renamed_from(&["lifts"]),
    ],
    exclusive: &[],
};

pub(super) static TRACTION: Table = Table {
    header: "[[traction]]",
    doc: "A load on a segment of a body's surface, on a circle, or in 3-D on a rectangle, disc, sphere or triangles, \
          which it follows",
    keys: &[
        key("from", PLACE, Optional, "one end of the segment at the start"),
        key("to", PLACE, Optional, "the other end"),
        key("circle", Kind::Table(&body::CIRCLE), Optional, "a circle instead: the part of it inside the grid"),
        key("rectangle", RECTANGLE, Optional, "in 3-D, instead: a box whose corners are alike along one axis"),
        key("disc", Kind::Table(&DISC), Optional, "in 3-D, instead: a disc, the part of it inside the grid"),
        key(
            "sphere",
            Kind::Table(&body::SPHERE),
            Optional,
            "in 3-D, instead: a sphere, the part of it inside the grid",
        ),
        key("surface", Kind::Table(&body::SURFACE), Optional, "in 3-D, instead: a surface of triangles at bodies"),
        key(
            "stress",
            PairProfile(In::Stress, Range::ANY, &STRESSES_PROFILE),
            Optional,
            "force per area of the start, along the axes, or by depth",
        ),
        key(
            "pressure",
            Profile(In::Stress, Range::ANY, &STRESS_PROFILE),
            Optional,
            "instead of stress: normal to the surface as it turns and stretches, against the body that lies on one side",
        ),
        key("stress_path", Course(In::Stress), Optional, FORCES),
        key(
            "pressure_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)]),
            Optional,
            "rows [t, p] of a pressure instead, t increasing; linear between, from 0 at time 0, constant after the last; time 0 \
             is that of the stage that applies it",
        ),
        key("ramp", RAMP, Default("0.0"), "time over which it grows; 0: at once"),
        key(
            "amplitude",
            AMPLITUDE,
            Optional,
            "instead of ramp: rows [t, share that acts], t increasing; linear \
            between, from 0 at time 0, constant after the last; time 0 is that of the stage that applies it",
        ),
        key("name", Name, Optional, "what stages call it"),
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
    doc: "Acceleration of the ground, in whose frame the case is (dynamic): supports rest, displacements and velocities \
          are those relative to the ground",
    keys: &[key(
        "acceleration",
        Course(In::Acceleration),
        Required,
        "rows [t, ax, ay], in 3-D [t, ax, ay, az], t increasing; linear between, from 0 at time 0, and 0 after the last",
    )],
    exclusive: &[],
};

pub(super) static POINT_LOAD: Table = Table {
    header: "[[point_load]]",
    doc: "A force at a point of a body, which it follows",
    keys: &[
        key("at", Vector(In::Length, Range::ANY), Required, "where at the start"),
        key(
            "force",
            Vector(In::LineForce, Range::ANY),
            Optional,
            "along the axes, per metre of thickness; in axisymmetry of the whole ring, and in 3-D, in N",
        ),
        key("force_path", Course(In::LineForce), Optional, FORCES),
        key("ramp", RAMP, Default("0.0"), "time over which it grows; 0: at once"),
        key(
            "amplitude",
            AMPLITUDE,
            Optional,
            "instead of ramp: rows [t, share that acts], t increasing; linear \
            between, from 0 at time 0, constant after the last; time 0 is that of the stage that applies it",
        ),
        key("name", Name, Optional, "what stages call it"),
    ],
    exclusive: &[one_of(&["force", "force_path"], true), one_of(&["ramp", "amplitude", "force_path"], false)],
};

pub(super) static REDUCTION: Table = Table {
    header: "[strength_reduction]",
    doc: "Strength of all materials divided by a factor: c/F, atan(tan(phi)/F), psi at most the new phi (section 3.2)",
    keys: &[
        key("factor", Quantity(In::Number, FACTOR), Required, "the factor F"),
        key("elastic", Flag, Default("false"), "strength without bound instead: every material by its elastic law"),
        key(
            "stiffness",
            Quantity(In::Number, Range::POSITIVE),
            Default("1.0"),
            "Young's moduli times this, of all materials",
        ),
        key(
            "unloaded",
            Flag,
            Default("false"),
            "start without stress: [initial] is left out, and loads that act at once grow over the run",
        ),
        key(
            "stage",
            Text(64),
            Optional,
            "reduce at the end of the stage of that name, in the state that it leaves; \"start\": of what is before \
             the first stage; \"end\": of the run. Later stages do not begin; with unloaded = true: what is there \
             then, from the start on. Water that flows rests: see `drainage`",
        ),
        key(
            "drainage",
            Choice(Failure::WORDS),
            Optional,
            "how the ground fails that water has flowed through until the end of that stage; absent: \"drained\", or \
             \"undrained\" if it can flow through none of the soils",
        ),
        key(
            "steps",
            Count(0, 1000),
            Default("10"),
            "equal parts of the reduction that follow the end of the stage, a nominal step each; 0: the run ends there",
        ),
    ],
    exclusive: &[],
};

pub(super) static INITIAL: Table = Table {
    header: "[initial]",
    doc: "Stress at the start, under the full gravity; displacements count from there",
    keys: &[
        key(
            "k0",
            Quantity(In::Number, COEFFICIENT),
            Optional,
            "weight of what lies above as vertical stress, k0 times it as horizontal; of materials without their own k0",
        ),
        key("gravity", Choice(Start::WORDS), Optional, "elastic equilibrium under the loads at time 0 instead"),
        key(
            "equilibrium",
            Choice(Settled::WORDS),
            Optional,
            "what that stress is led to under the loads at time 0, before the first step; absent: it stays as it is",
        ),
    ],
    exclusive: &[one_of(&["k0", "gravity"], false)],
};

pub(super) static STRESS_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of a stress",
    doc: "value + per_metre (at_y - y): linear everywhere, above at_y too; a point keeps what it has at the start; in \
          3-D the height is z",
    keys: &[
        key("value", Quantity(In::Stress, Range::ANY), Required, "at the height at_y"),
        key("at_y", Quantity(In::Length, Range::ANY), Required, "the height; in 3-D z"),
        key("per_metre", Gradient(In::Stress), Required, "growth per metre of depth"),
    ],
    exclusive: &[],
};

static STRESSES_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of stresses",
    doc: "value + per_metre (at_y - y) along the axes: linear everywhere, above at_y too, by the height at the start; in \
          3-D the height is z",
    keys: &[
        key("value", Vector(In::Stress, Range::ANY), Required, "along the axes, at the height at_y"),
        key("at_y", Quantity(In::Length, Range::ANY), Required, "the height; in 3-D z"),
        key("per_metre", GradientVector(In::Stress), Required, "growth per metre of depth, along the axes"),
    ],
    exclusive: &[],
};

pub(super) static ANGLE_PROFILE: Table = Table {
    header: "{ value, at_y, per_metre } of an angle",
    doc: "value + per_metre (at_y - y): linear everywhere, above at_y too; a point keeps what it has at the start; in \
          3-D the height is z",
    keys: &[
        key("value", Quantity(In::Angle, Range::ANY), Required, "at the height at_y"),
        key("at_y", Quantity(In::Length, Range::ANY), Required, "the height; in 3-D z"),
        key("per_metre", Gradient(In::Angle), Required, "growth per metre of depth"),
    ],
    exclusive: &[],
};
