//! Words of what is solved and of what is kept of it.

use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;

choice! {
    /// Kind of the geometry.
    pub enum Geometry {
        /// Plane strain, 1 m thick.
        PlaneStrain = "plane-strain",
        /// Rotational symmetry about the axis x = 0, without torsion: x is the radius, y is along the axis, zz in the
        /// direction around it; forces, masses and energies in histories are of the whole circle.
        Axisymmetric = "axisymmetric",
        /// Three dimensions: z is the vertical.
        Solid = "3d",
    } misnomers [
        "2d": "Use \"plane-strain\" or \"axisymmetric\"",
        "2D": "Use \"plane-strain\" or \"axisymmetric\"",
        "plane-stress": "Plane stress is not available. Use \"plane-strain\""
    ] earlier ["solid": "3d"]
}

impl Geometry {
    /// Number of axes; the last one is the vertical.
    pub fn dims(self) -> usize {
        if self == Self::Solid { 3 } else { 2 }
    }

    /// What the physics' extensive numbers, of a metre of thickness or of a radian, are multiplied with to be of what
    /// tables tell.
    pub fn whole(self) -> f64 {
        match self {
            Self::PlaneStrain | Self::Solid => 1.0,
            Self::Axisymmetric => std::f64::consts::TAU,
        }
    }

    /// By what factor `n` points of a part of a cell, m from the grid's lower corner along axis 0, are farther from its
    /// middle than the middles of equal shares.
    pub(crate) fn spread(self, part: [f64; 2], n: usize) -> f64 {
        match self {
            Self::PlaneStrain => PlaneStrain::spread(0, part, n),
            Self::Axisymmetric => Axisymmetric::spread(0, part, n),
            Self::Solid => Solid::spread(0, part, n),
        }
    }

    /// What a number in this unit, of a metre of thickness in plane strain, is in; `None` if it is the same in all.
    pub fn unit(self, in_plane: &str) -> Option<&'static str> {
        let whole = match in_plane {
            "kg/m" => "kg",
            "kg/s" => "kg m/s",
            "N/m" => "N",
            "N m/m" => "N m",
            "J/m" => "J",
            "W/m" => "W",
            "m3/m" => "m3",
            _ => return None,
        };
        (self != Self::PlaneStrain).then_some(whole)
    }

    /// Unit of a point's volume in frames.
    pub fn volume_unit(self) -> &'static str {
        match self {
            Self::PlaneStrain => "m2",
            Self::Solid => "m3",
            Self::Axisymmetric => "m3/rad",
        }
    }
}

choice! {
    /// Kind of the analysis.
    pub enum AnalysisType {
        /// Inertia acts.
        Dynamic = "dynamic",
        /// No inertia; time is a pseudo-time.
        QuasiStatic = "quasi-static",
        /// No inertia; in real time, which a strength by the rate needs.
        InTime = "quasi-static-rate",
        /// No inertia; water flows in real time.
        Consolidation = "consolidation",
    } earlier ["quasi-static-in-time": "quasi-static-rate"]
}

impl AnalysisType {
    /// Whether inertia acts.
    pub fn regime(self) -> Regime {
        match self {
            Self::Dynamic => Regime::Dynamic,
            Self::QuasiStatic | Self::InTime | Self::Consolidation => Regime::QuasiStatic,
        }
    }

    /// Whether its time is a pseudo-time without unit.
    pub fn is_timeless(self) -> bool {
        self == Self::QuasiStatic
    }
}

choice! {
    /// What a soil's pore water does.
    pub enum Drainage {
        /// Its pressure is that of the still water.
        Given = "hydrostatic",
        /// It flows, and its excess pressure is an unknown.
        Coupled = "coupled",
        /// It stays where it is, and its excess pressure is an unknown.
        Undrained = "undrained",
    } misnomers [
        "drained": "Soil without excess pore pressure is \"hydrostatic\", soil that consolidates is \"coupled\""
    ] earlier ["given": "hydrostatic"]
}

choice! {
    /// How fast the ground fails, beside how fast its water flows.
    pub enum Failure {
        /// So slowly that it drains: every point keeps its pore pressure.
        Drained = "drained",
        /// At once: the water stays where it is, and its pressure follows the strain.
        Undrained = "undrained",
    }
}

choice! {
    /// What a case looks for, which chooses settings that it leaves out.
    pub enum Purpose {
        /// The load at which the ground fails under prescribed motion, as in the theory of plasticity.
        LimitLoad = "limit-load",
    }
}

choice! {
    /// What a case leaves out of its discretisation is filled in as coarse or as fine; coarsest first.
    pub enum Accuracy {
        /// To look at.
        Draft = "draft",
        /// As fine as the paper's.
        Standard = "standard",
        /// To compare others with.
        Reference = "reference",
    }
}

choice! {
    /// Order of the B-splines.
    pub enum Order {
        /// Continuous functions.
        Linear = "linear",
        /// Continuous slopes.
        Quadratic = "quadratic",
        /// Continuous curvatures.
        Cubic = "cubic",
    }
}

impl Order {
    /// As a number.
    pub fn degree(self) -> usize {
        match self {
            Self::Linear => 1,
            Self::Quadratic => 2,
            Self::Cubic => 3,
        }
    }
}

choice! {
    /// Which grid lines are those across which strains may jump.
    pub enum C0Lines {
        /// Those where they do.
        Automatic = "automatic",
        /// Only breakpoints that the grid repeats.
        None = "none",
    }
}

choice! {
    /// Support of one face of the grid.
    pub enum Support {
        /// All components held.
        Fixed = "fixed",
        /// The normal component held.
        Roller = "roller",
        /// Smooth, and material comes off it: pushes and does not pull; with friction it is a table.
        Contact = "contact",
        /// Lets waves out (dynamic): nothing held but the state of `[initial]`.
        Absorbing = "absorbing",
        /// A side beside ground that shakes (dynamic): a column of soil moves there as the free field and drives it,
        /// what differs leaves.
        FreeField = "free-field",
        /// Nothing held; material that leaves the grid there is counted and forgotten.
        Outflow = "outflow",
        /// Nothing held.
        Free = "free",
    }
}

choice! {
    /// A face of the grid, and the key of its support.
    pub enum Side {
        /// At the lowest x.
        Left = "left",
        /// At the highest x.
        Right = "right",
        /// At the lowest y, of a solid z.
        Bottom = "bottom",
        /// At the highest y, of a solid z.
        Top = "top",
        /// At the lowest y of a solid.
        Front = "front",
        /// At the highest y of a solid.
        Back = "back",
    }
}

impl Side {
    /// Per axis of a plane the lower and the upper one.
    pub const ALL: [[Self; 2]; 2] = [[Self::Left, Self::Right], [Self::Bottom, Self::Top]];
    /// Per axis of a solid.
    pub const OF_SOLID: [[Self; 2]; 3] = [Self::ALL[0], [Self::Front, Self::Back], Self::ALL[1]];

    /// Per axis of a geometry the lower and the upper one.
    pub fn of(geometry: Geometry) -> &'static [[Self; 2]] {
        if geometry == Geometry::Solid { &Self::OF_SOLID } else { &Self::ALL }
    }
}

choice! {
    /// An axis of a solid.
    pub enum Axis {
        /// Across.
        X = "x",
        /// Backwards.
        Y = "y",
        /// Upwards.
        Z = "z",
    }
}

choice! {
    /// What a rigid strip holds of the material at it.
    pub enum Base {
        /// The component normal to it.
        Smooth = "smooth",
        /// All components.
        Rough = "rough",
    }
}

choice! {
    /// What a prescribed motion holds of the material at it.
    pub enum Components {
        /// All components.
        All = "all",
        /// The component normal to it.
        Normal = "normal",
    }
}

impl Components {
    /// The same of a strip.
    pub fn base(self) -> Base {
        match self {
            Self::All => Base::Rough,
            Self::Normal => Base::Smooth,
        }
    }
}

choice! {
    /// A motion of a rigid body.
    pub enum RigidMotion {
        /// Along x.
        X = "x",
        /// Along y.
        Y = "y",
        /// About its reference point.
        Rotation = "rotation",
    }
}

choice! {
    /// How the stress at the start is found, other than by k0.
    pub enum Start {
        /// Elastic equilibrium under the loads at time 0.
        Elastic = "elastic",
    }
}

choice! {
    /// How the stress at the start is brought into equilibrium.
    pub enum Settled {
        /// With the materials' own laws: on or within their yield surfaces, and nothing moves.
        Plastic = "plastic",
    }
}

choice! {
    /// What is held in a test of one point.
    pub enum Path {
        /// The total stress along x and z, while y is driven.
        Triaxial = "triaxial",
        /// The total stress along x and the strain along z, while y is driven.
        Biaxial = "biaxial",
        /// The strain along x and z, while y is driven.
        Oedometer = "oedometer",
        /// Nothing: all sides are driven alike.
        Isotropic = "isotropic",
        /// The total stress along y and the strain along x and z, while y moves along x.
        SimpleShear = "simple-shear",
        /// What its components say.
        Mixed = "mixed",
    }
}

choice! {
    /// Format of frames.
    pub enum Format {
        /// One `.vtu` per frame and a `.pvd`.
        Vtu = "vtu",
    } later ["vtkhdf"]
}
