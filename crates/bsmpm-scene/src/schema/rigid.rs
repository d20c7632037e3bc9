//! Schema of rigid bodies.

use super::body::{self, BoxTable, CircleTable, GroundTable, RevolveTable, ShapeKey, SphereTable};
use super::loads;
use super::site::MotionKey;
use super::{Dimension as In, Range};

table! {
    /// A rigid body in frictional contact with the soil. The contact carries no tension. The motion is prescribed or
    /// follows from forces; otherwise the body is at rest. The body may extend beyond the grid. At a plane or axis of
    /// symmetry draw the whole body or half of it.
    struct RigidTable = "[[rigid]]" {
        /// Name of the rigid body in stages and histories.
        name: Name, Required, example(r#""pipe""#);
        /// Corners of a polygon at the start, clockwise or counter-clockwise.
        polygon: Rows(body::POLYGON), Optional,
            example("[[0.0, 4.0], [1.0, 4.0], [0.5, 3.0]]");
        circle: Shared(body::CIRCLE_KEY, Table(CircleTable));
        /// A cuboid. Only in 3-D.
        r#box: Table(BoxTable), Optional, example("{ lower = [0.0, 0.0, 4.0], upper = [1.0, 1.0, 5.0] }");
        /// A sphere. Only in 3-D.
        sphere: Table(SphereTable), Optional, example(r#"{ centre = [0.0, 0.0, 4.0], radius = "0.5 m" }"#);
        /// A polygon that is rotated about a vertical axis, for instance a cone. Only in 3-D.
        revolve: Table(RevolveTable), Optional,
            example("{ polygon = [[0.0, 3.0], [1.0, 5.0], [0.0, 5.0]], about = [0.0, 0.0] }");
        /// Rigid ground below a terrain surface. Only in 3-D.
        terrain: Table(GroundTable), Optional, example(r#"{ top = { file = "terrain.asc" } }"#);
        /// Friction coefficient, the tangent of the friction angle δ of the interface (wall friction): 0.364 for 20
        /// degrees. [strength_reduction] also reduces it.
        friction_coefficient: Quantity(In::Number, loads::FRICTION), Default("0.0"),
            symbol("μ"),
            example("0.3"),
            renamed_from(&["friction"]);
        displacement: Shared(loads::DISPLACEMENT_KEY, Vector);
        velocity: Shared(loads::VELOCITY_KEY, Vector);
        path: Shared(loads::PATH_KEY, Course);
        /// Prescribed rotation, in rows [t, angle], positive counter-clockwise. It is zero at t = 0, linear between the
        /// rows, and constant after the last row.
        rotation: Rows(ROTATION), Optional,
            example("[[0.0, 0.0], [1.0, 10.0]]");
        /// Position of the reference point at the start. The body rotates about this point, and moments refer to it.
        /// Default: the centroid.
        about: Pair(In::Length, Range::ANY), Optional, example("[0.5, 4.0]");
        /// Motions that follow from forces: any of "x", "y" and "rotation". The other motions are prescribed. Faces of
        /// the grid do not stop rigid bodies. For a body on a plane of symmetry give half of its mass, inertia and
        /// forces.
        free: Names, Optional, example(r#"["y"]"#);
        /// Mass, distributed evenly over the area: in plane strain kg per metre of thickness, in axisymmetry kg of the
        /// whole body.
        mass: Quantity(In::Number, Range::POSITIVE), Optional, symbol("m"), example("500.0");
        /// Alternative to `mass`: density.
        density: Quantity(In::Density, Range::POSITIVE), Optional, symbol("ρ"), example("2400.0");
        /// Moment of inertia about the centroid in kg m2 per metre of thickness. Default: that of an even distribution
        /// of the mass.
        inertia: Quantity(In::Number, Range::POSITIVE), Optional, symbol("I"), example("40.0");
        /// Force on the body in addition to gravity. In axisymmetry: force on the whole body in N.
        force: Pair(In::LineForce, Range::ANY), Optional, example(r#"[0.0, "-10 kN/m"]"#);
        /// Alternative to `force`: time-dependent force, in rows [t, x, y] with increasing t. The force is linear
        /// between the rows, and constant after the last row. It is zero at t = 0, unless a row gives another value.
        force_path: Rows(FORCES), Optional,
            example(r#"[[0.0, 0.0, 0.0], [1.0, 0.0, "-10 kN/m"]]"#);
        /// Moment on the body in N m per metre of thickness, positive counter-clockwise.
        moment: Quantity(In::Number, Range::ANY), Optional, example("100.0");
        /// Time in which `force` and `moment` grow from zero to their full values. With 0 they act at once.
        ramp: Quantity(In::Time, Range::NOT_NEGATIVE), Default("0.0"), example("1.0");
        /// Alternative to `ramp`: factor that multiplies `force` and `moment`, in rows [t, factor] with increasing t.
        /// The factor is linear between the rows, and constant after the last row. It is zero at t = 0, unless a row
        /// gives another value.
        amplitude: Rows(loads::AMPLITUDE), Optional,
            example("[[0.0, 0.0], [1.0, 1.0]]");
        /// Velocity of the free motions at the start.
        start_velocity: Pair(In::Velocity, Range::ANY), Optional, example("[0.0, -1.0]");
        /// Angular velocity in rad/s at the start, if the rotation is free.
        start_spin: Quantity(In::Number, Range::ANY), Optional, example("1.0");
    }
    one_of required [polygon, circle, r#box, sphere, revolve, terrain];
    one_of optional [displacement, velocity, path];
    one_of optional [mass, density];
    one_of optional [force, force_path];
    one_of optional [ramp, amplitude, force_path];
    one_of optional [moment, force_path];
}

const ROTATION: &[(In, Range)] = &[(In::Time, Range::NOT_NEGATIVE), (In::Angle, Range::ANY)];
const FORCES: &[(In, Range)] = &[
    (In::Time, Range::NOT_NEGATIVE),
    (In::LineForce, Range::ANY),
    (In::LineForce, Range::ANY),
];

impl RigidTable {
    /// The key that gives the shape.
    pub(crate) fn shape(&self) -> ShapeKey<'_> {
        first_given!(self, ShapeKey:
            Polygon(polygon), Circle(circle), Sphere(sphere), Revolve(revolve), Ground(terrain), Box(r#box))
    }

    /// The key that gives the translation.
    pub(crate) fn motion(&self) -> MotionKey<'_> {
        first_given!(self, MotionKey: Displacement(displacement), Velocity(velocity), Path(path))
    }
}
