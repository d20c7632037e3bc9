//! The table of rigid bodies.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, body, key, loads, one_of};
use std::ops::Bound::Included;

const ROTATION: Kind = Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Angle, Range::ANY)]);

static GROUND: Table = Table {
    header: "terrain = { top }",
    doc: "What lies under the posts of a regular raster of heights, bilinear between them and level beyond",
    keys: &[key("top", body::HEIGHTS, Required, "rows [x, y, z] in any order; a file may also be an ASCII grid")],
    exclusive: &[],
};

pub(super) static RIGID: Table = Table {
    header: "[[rigid]]",
    doc: "A rigid body in frictional contact with the soil, without tension, with a prescribed motion or moved by forces",
    keys: &[
        key("name", Name, Required, "what histories call it"),
        key("polygon", body::POLYGON, Optional, "its corners at the start, in either direction"),
        key("circle", Kind::Table(&body::CIRCLE), Optional, "a circle instead"),
        key("box", Kind::Table(&body::BOX), Optional, "in 3-D: a cuboid"),
        key("sphere", Kind::Table(&body::SPHERE), Optional, "in 3-D: a sphere"),
        key("revolve", Kind::Table(&body::REVOLVE), Optional, "in 3-D: a polygon about a vertical, e.g. a cone"),
        key("terrain", Kind::Table(&GROUND), Optional, "in 3-D: what lies under a raster of heights"),
        key(
            "friction_coefficient",
            Quantity(In::Number, Range::of(Included(0.0), Included(2.0))),
            Default("0.0"),
            "tangent of the angle of friction between it and the soil; [strength_reduction] divides it, too",
        )
        .renamed_from(&["friction"]),
        key("displacement", loads::DISPLACEMENT, Optional, "reached at the end, linear in time"),
        key("velocity", loads::VELOCITY, Optional, "constant; quasi-static: m per unit of pseudo-time, numbers"),
        key(
            "path",
            loads::PATH,
            Optional,
            "rows [t, ux, uy], t increasing; linear between, 0 at time 0, constant after the last",
        ),
        key(
            "rotation",
            ROTATION,
            Optional,
            "rows [t, angle], counter-clockwise; linear between, 0 at time 0, constant after the last",
        ),
        key(
            "about",
            Pair(In::Length, Range::ANY),
            Optional,
            "its reference point at the start, about which it rotates and moments count; the centroid unless given",
        ),
        key(
            "free",
            Names,
            Optional,
            "motions that follow from forces: x, y, rotation; the others are on the way given. Faces of the grid hold material, \
             and no rigid bodies: only soil and forces stop one. On a plane of symmetry give half of mass, inertia, forces",
        ),
        key(
            "mass",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "kg per metre of thickness, spread evenly over its area; axisymmetric: kg of the whole body",
        ),
        key("density", Quantity(In::Density, Range::POSITIVE), Optional, "instead of mass"),
        key(
            "inertia",
            Quantity(In::Number, Range::POSITIVE),
            Optional,
            "kg m2 per metre about its centroid; that of mass spread evenly unless given",
        ),
        key(
            "force",
            Pair(In::LineForce, Range::ANY),
            Optional,
            "on it, besides gravity, along x and y; axisymmetric: N on the whole body",
        ),
        key(
            "force_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::LineForce, Range::ANY), (In::LineForce, Range::ANY)]),
            Optional,
            "rows [t, x, y] of the force instead, t increasing; linear between, from 0 at time 0, constant after the last",
        ),
        key("moment", Quantity(In::Number, Range::ANY), Optional, "N m per metre on it, counter-clockwise"),
        key("ramp", loads::RAMP, Default("0.0"), "time over which force and moment grow; 0: at once"),
        key(
            "amplitude",
            loads::AMPLITUDE,
            Optional,
            "instead of ramp: rows [t, share that acts], t increasing; linear between, from 0 at time 0, constant after the \
             last",
        ),
        key("start_velocity", Pair(In::Velocity, Range::ANY), Optional, "at the start, of motions that are free"),
        key("start_spin", Quantity(In::Number, Range::ANY), Optional, "rad/s at the start, if its rotation is free"),
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
