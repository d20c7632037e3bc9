//! Schema of rigid bodies.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, body, key, loads, one_of};
use std::ops::Bound::Included;

const ROTATION: Kind = Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Angle, Range::ANY)]);

static GROUND: Table = Table {
    header: "terrain = { top }",
    doc: "Rigid ground below a terrain surface. The surface is a regular raster of heights with bilinear \
          interpolation, and is horizontal beyond the raster.",
    keys: &[key(
        "top",
        body::HEIGHTS,
        Required,
        "Heights of the terrain: rows [x, y, z] in any order. A file may also be an ESRI ASCII grid.",
    )
    .example(r#"{ file = "terrain.asc" }"#)],
    exclusive: &[],
};

pub(super) static RIGID: Table = Table {
    header: "[[rigid]]",
    doc: "A rigid body in frictional contact with the soil. The contact carries no tension. The motion is prescribed \
          or follows from forces; otherwise the body is at rest. The body may extend beyond the grid. At a plane or \
          axis of symmetry draw the whole body or half of it.",
    keys: &[
        key(
            "name",
            Name,
            Required,
            "Name of the rigid body in stages and histories.",
        )
        .example(r#""pipe""#),
        key(
            "polygon",
            body::POLYGON,
            Optional,
            "Corners of a polygon at the start, clockwise or counter-clockwise.",
        )
        .example("[[0.0, 4.0], [1.0, 4.0], [0.5, 3.0]]"),
        body::CIRCLE_KEY,
        key("box", Kind::Table(&body::BOX), Optional, "A cuboid. Only in 3-D.")
            .example("{ lower = [0.0, 0.0, 4.0], upper = [1.0, 1.0, 5.0] }"),
        key("sphere", Kind::Table(&body::SPHERE), Optional, "A sphere. Only in 3-D.")
            .example(r#"{ centre = [0.0, 0.0, 4.0], radius = "0.5 m" }"#),
        key(
            "revolve",
            Kind::Table(&body::REVOLVE),
            Optional,
            "A polygon that is rotated about a vertical axis, for instance a cone. Only in 3-D.",
        )
        .example("{ polygon = [[0.0, 3.0], [1.0, 5.0], [0.0, 5.0]], about = [0.0, 0.0] }"),
        key(
            "terrain",
            Kind::Table(&GROUND),
            Optional,
            "Rigid ground below a terrain surface. Only in 3-D.",
        )
        .example(r#"{ top = { file = "terrain.asc" } }"#),
        key(
            "friction_coefficient",
            Quantity(In::Number, Range::of(Included(0.0), Included(2.0))),
            Default("0.0"),
            "Friction coefficient, the tangent of the friction angle δ of the interface (wall friction): 0.364 for 20 \
             degrees. [strength_reduction] also reduces it.",
        )
        .symbol("μ")
        .example("0.3")
        .renamed_from(&["friction"]),
        loads::DISPLACEMENT_KEY,
        loads::VELOCITY_KEY,
        loads::PATH_KEY,
        key(
            "rotation",
            ROTATION,
            Optional,
            "Prescribed rotation, in rows [t, angle], positive counter-clockwise. It is zero at t = 0, linear between \
             the rows, and constant after the last row.",
        )
        .example("[[0.0, 0.0], [1.0, 10.0]]"),
        key(
            "about",
            Pair(In::Length, Range::ANY),
            Optional,
            "Position of the reference point at the start. The body rotates about this point, and moments refer to it. \
             Default: the centroid.",
        )
        .example("[0.5, 4.0]"),
        key(
            "free",
            Names,
            Optional,
            "Motions that follow from forces: any of \"x\", \"y\" and \"rotation\". The other motions are prescribed. \
             Faces of the grid do not stop rigid bodies. For a body on a plane of symmetry give half of its mass, \
             inertia and forces.",
        )
        .example(r#"["y"]"#),
        key(
            "mass",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Mass, distributed evenly over the area: in plane strain kg per metre of thickness, in axisymmetry kg of \
             the whole body.",
        )
        .symbol("m")
        .example("500.0"),
        key(
            "density",
            Quantity(In::Density, Range::POSITIVE),
            Optional,
            "Alternative to `mass`: density.",
        )
        .symbol("ρ")
        .example("2400.0"),
        key(
            "inertia",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "Moment of inertia about the centroid in kg m2 per metre of thickness. Default: that of an even \
             distribution of the mass.",
        )
        .symbol("I")
        .example("40.0"),
        key(
            "force",
            Pair(In::LineForce, Range::ANY),
            Optional,
            "Force on the body in addition to gravity. In axisymmetry: force on the whole body in N.",
        )
        .example(r#"[0.0, "-10 kN/m"]"#),
        key(
            "force_path",
            Rows(&[
                (In::Time, Range::NOT_NEGATIVE),
                (In::LineForce, Range::ANY),
                (In::LineForce, Range::ANY),
            ]),
            Optional,
            "Alternative to `force`: time-dependent force, in rows [t, x, y] with increasing t. The force is linear \
             between the rows, and constant after the last row. It is zero at t = 0, unless a row gives another value.",
        )
        .example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-10 kN/m"]]"#),
        key(
            "moment",
            Quantity(In::Number, Range::ANY),
            Optional,
            "Moment on the body in N m per metre of thickness, positive counter-clockwise.",
        )
        .example("100.0"),
        key(
            "ramp",
            loads::RAMP,
            Default("0.0"),
            "Time in which `force` and `moment` grow from zero to their full values. With 0 they act at once.",
        )
        .example("1.0"),
        key(
            "amplitude",
            loads::AMPLITUDE,
            Optional,
            "Alternative to `ramp`: factor that multiplies `force` and `moment`, in rows [t, factor] with increasing \
             t. The factor is linear between the rows, and constant after the last row. It is zero at t = 0, unless a \
             row gives another value.",
        )
        .example("[[0.0, 0.0], [1.0, 1.0]]"),
        key(
            "start_velocity",
            Pair(In::Velocity, Range::ANY),
            Optional,
            "Velocity of the free motions at the start.",
        )
        .example("[0.0, -1.0]"),
        key(
            "start_spin",
            Quantity(In::Number, Range::ANY),
            Optional,
            "Angular velocity in rad/s at the start, if the rotation is free.",
        )
        .example("1.0"),
    ],
    exclusive: &[
        one_of(&["polygon", "circle", "box", "sphere", "revolve", "terrain"], true),
        one_of(&["displacement", "velocity", "path"], false),
        one_of(&["mass", "density"], false),
        one_of(&["force", "force_path"], false),
        one_of(&["ramp", "amplitude", "force_path"], false),
        one_of(&["moment", "force_path"], false),
    ],
};
