//! Accepted words for geometry, analysis, boundaries and initial state.

use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm_shapes::Lattice;

choice! {
    /// Kind of the geometry.
    pub enum Geometry {
        /// Plane strain. Forces, masses and energies are per metre of thickness.
        PlaneStrain = "plane-strain",
        /// Axisymmetry about the axis x = 0, without torsion. x is the radius, y the axial coordinate, and zz the
        /// circumferential component. Forces, masses and energies in histories are those of the whole circle.
        Axisymmetric = "axisymmetric",
        /// Three dimensions. The axis z is vertical.
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

    /// Returns the lattice of `n` material points along each axis of a cell.
    pub(crate) fn lattice(self, n: usize) -> Lattice {
        let spread = match self {
            Self::PlaneStrain => |part, n| PlaneStrain::spread(0, part, n),
            Self::Axisymmetric => |part, n| Axisymmetric::spread(0, part, n),
            Self::Solid => |part, n| Solid::spread(0, part, n),
        };
        Lattice { n, spread }
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
        /// With inertia.
        Dynamic = "dynamic",
        /// Without inertia, in pseudo-time.
        QuasiStatic = "quasi-static",
        /// Without inertia, in real time. For a strength that depends on the strain rate.
        InTime = "quasi-static-rate",
        /// Without inertia, in real time. Pore water flows.
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
        /// The pore pressure is that of the water table. The soil has no excess pore pressure.
        Given = "hydrostatic",
        /// Pore water flows. The excess pore pressure is an unknown of the analysis.
        Coupled = "coupled",
        /// Water does not flow relative to the soil. The excess pore pressure follows from the change of volume.
        Undrained = "undrained",
    } misnomers [
        "drained": "Soil without excess pore pressure is \"hydrostatic\", soil that consolidates is \"coupled\""
    ] earlier ["given": "hydrostatic"]
}

choice! {
    /// How fast the ground fails, beside how fast its water flows.
    pub enum Failure {
        /// Slow failure: the pore pressure of each material point is constant.
        Drained = "drained",
        /// Fast failure: pore water does not flow, and the pore pressure changes with the strain.
        Undrained = "undrained",
    }
}

choice! {
    /// What a case looks for, which chooses settings that it leaves out.
    pub enum Purpose {
        /// Computes the load at which the ground fails under a prescribed displacement.
        LimitLoad = "limit-load",
    }
}

choice! {
    /// What a case leaves out of its discretisation is filled in as coarse or as fine; coarsest first.
    pub enum Accuracy {
        /// Coarse, for a first look.
        Draft = "draft",
        /// About as fine as the grids of Xie et al. (2023).
        Standard = "standard",
        /// Fine, as a reference for other runs.
        Reference = "reference",
    }
}

choice! {
    /// Order of the B-splines.
    pub enum Order {
        /// Continuous functions.
        Linear = "linear",
        /// Functions with continuous first derivatives.
        Quadratic = "quadratic",
        /// Functions with continuous second derivatives.
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
        /// Lines where the program expects jumps of the strains.
        Automatic = "automatic",
        /// Only lines that `knots` repeats.
        None = "none",
    }
}

choice! {
    /// Support of one face of the grid.
    pub enum Support {
        /// All displacement components are zero.
        Fixed = "fixed",
        /// The normal displacement is zero.
        Roller = "roller",
        /// A smooth wall that carries pressure but no tension: material can separate from the wall. A table adds
        /// friction.
        Contact = "contact",
        /// A viscous boundary that absorbs waves, in dynamic analyses. The boundary carries the stress of `[initial]`.
        Absorbing = "absorbing",
        /// A lateral boundary of shaken ground, in dynamic analyses. The free-field motion of a soil column drives the
        /// boundary. Dashpots absorb all other waves.
        FreeField = "free-field",
        /// No support. Material that leaves the grid there is counted and removed.
        Outflow = "outflow",
        /// No support.
        Free = "free",
    }
}

choice! {
    /// A face of the grid, and the key of its support.
    pub enum Side {
        /// Face with the lowest x.
        Left = "left",
        /// Face with the highest x.
        Right = "right",
        /// Face with the lowest y (in 3-D: the lowest z).
        Bottom = "bottom",
        /// Face with the highest y (in 3-D: the highest z).
        Top = "top",
        /// Face with the lowest y. Only in 3-D.
        Front = "front",
        /// Face with the highest y. Only in 3-D.
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
        if geometry == Geometry::Solid {
            &Self::OF_SOLID
        } else {
            &Self::ALL
        }
    }
}

choice! {
    /// An axis of a solid.
    pub enum Axis {
        /// The axis x.
        X = "x",
        /// The axis y.
        Y = "y",
        /// The axis z, which is vertical.
        Z = "z",
    }
}

choice! {
    /// What a rigid strip holds of the material at it.
    pub enum Base {
        /// The normal displacement is prescribed.
        Smooth = "smooth",
        /// All displacement components are prescribed.
        Rough = "rough",
    }
}

choice! {
    /// What a prescribed motion holds of the material at it.
    pub enum Components {
        /// All displacement components are prescribed.
        All = "all",
        /// The normal displacement is prescribed.
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
        /// Displacement along x.
        X = "x",
        /// Displacement along y.
        Y = "y",
        /// Rotation about the reference point.
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
        /// Equilibrium with the laws of the materials: no stress is outside the yield surface. Displacements stay zero.
        Plastic = "plastic",
    }
}

choice! {
    /// What is held in a test of one point.
    pub enum Path {
        /// The total stresses along x and z are constant. The strain or stress along y is prescribed.
        Triaxial = "triaxial",
        /// The total stress along x and the strain along z are constant. The strain or stress along y is prescribed.
        Biaxial = "biaxial",
        /// The strains along x and z are zero. The strain or stress along y is prescribed.
        Oedometer = "oedometer",
        /// The same strain or stress is prescribed in all directions.
        Isotropic = "isotropic",
        /// The total stress along y is constant, and the strains along x and z are zero. The shear strain or stress is
        /// prescribed.
        SimpleShear = "simple-shear",
        /// Each component is prescribed as a strain or as a stress.
        Mixed = "mixed",
    }
}

choice! {
    /// Format of frames.
    pub enum Format {
        /// One `.vtu` file per frame, and a `.pvd` file of all frames.
        Vtu = "vtu",
    } later ["vtkhdf"]
}
