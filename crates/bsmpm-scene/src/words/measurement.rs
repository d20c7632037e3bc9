//! Accepted words for history quantities, with units, columns and examples.

use super::Word;

choice! {
    /// What a history records, without what it needs besides, which [`Quantity`](crate::Quantity) has.
    pub enum Measurement {
        /// The coordinate x that `percentile` per cent of the material points do not exceed, also in 3-D. The initial
        /// length of the body is not subtracted. For the run-out of a flow use `percentile = 99`, because single
        /// material points and a thin tip run ahead.
        Runout = "runout",
        /// Position x of the front. In the lowest row of cells with material, the last cell before the front is at
        /// least half full. With a thin tip the position does not converge on finer grids; use `runout` with
        /// `percentile = 99`.
        Front = "front",
        /// The largest y of all material points, or of those within half a cell of `at_x`. 0 without material points.
        Height = "height",
        /// The largest displacement of all material points.
        MaxDisplacement = "max-displacement",
        /// Mass.
        Mass = "mass",
        /// Momentum.
        Momentum = "momentum",
        /// Centre of mass. If there is no material: the lower corner of the grid.
        CentreOfMass = "centre-of-mass",
        /// Angular momentum about the origin, positive counter-clockwise.
        AngularMomentum = "angular-momentum",
        /// Kinetic energy.
        KineticEnergy = "kinetic-energy",
        /// Mean Cauchy stress, positive in tension, weighted with the present volumes of the material points.
        MeanStress = "mean-stress",
        /// Mean displacement, weighted with the present volumes of the material points.
        MeanDisplacement = "mean-displacement",
        /// Mean velocity, weighted with the present volumes of the material points.
        MeanVelocity = "mean-velocity",
        /// Accumulated plastic strain, the sum of sqrt(2/3) times the norm of the deviatoric plastic strain increments.
        PlasticStrain = "plastic-strain",
        /// Forces of the effective stress on a section: the line from `from` to `to`, in 3-D a `rectangle` or `disc`.
        /// Parts outside the body do not count. The forces act on the material to the left of the line, in 3-D on the
        /// material before the section (on the side of the negative normal axis). The axes t1 and t2 follow the normal
        /// axis in the cyclic order x, y, z, and rotate with the section.
        SectionForces = "section-forces",
        /// Mass that has left the grid through faces with outflow since the start.
        Outflow = "outflow",
        /// Force of a supported face, footing or prescribed displacement on the soil. At a common edge of two supported
        /// faces each force component belongs to the face that is normal to this component. At a common edge of a fixed
        /// face and a footing or prescribed displacement the force belongs to the face. In water the force is that of
        /// the effective stress and the excess pore pressure.
        Reaction = "reaction",
        /// Moment of the reaction force of a footing or prescribed displacement about its centre, positive counter-
        /// clockwise.
        Moment = "moment",
        /// Work of a footing or prescribed displacement on the soil since the start, computed with the mean force of
        /// every step.
        Work = "work",
        /// Displacement of the material that is initially at `at`, extrapolated from the nearest material point.
        Displacement = "displacement",
        /// Velocity of the material point that is initially nearest to `at`; with `surface`, velocity at `at`.
        Velocity = "velocity",
        /// Cauchy stress, positive in tension, of the material point that is initially nearest to `at`; with `surface`,
        /// stress at `at`.
        Stress = "stress",
        /// Pore pressure, positive in compression, at the material point that is initially nearest to `at`.
        PorePressure = "pore-pressure",
        /// Pore pressures, positive in compression, of all material points, or those of a material or body.
        PorePressures = "pore-pressures",
        /// Excess pore pressure (pore pressure minus hydrostatic pressure of the present water level) at the material
        /// point that is initially nearest to `at`.
        ExcessPressure = "excess-pressure",
        /// Porosity at the material point that is initially nearest to `at`, with pore-water flow.
        Porosity = "porosity",
        /// Darcy velocity (volume of water per area and time, relative to the soil) at the material point that is
        /// initially nearest to `at`. At the surface of strongly deformed ground the values of adjacent cells can
        /// differ by a third or more. `water-outflow` does not have this error.
        Flux = "flux",
        /// Volume of water that has left the ground through a drain since the start. Without `drain` it is the volume
        /// through all drains minus the volume of all inflows.
        WaterOutflow = "water-outflow",
        /// Relative error of the water balance: the change of the water volume in the ground since the start plus the
        /// volume that has left the ground, divided by the larger of these volumes. It is 0 if no water is created or
        /// lost.
        WaterBalance = "water-balance",
        /// Oscillation of the vertical stress between neighbouring material points: its root mean square, divided by
        /// the mean of |sigma_yy|.
        StressNoise = "stress-noise",
        /// Oscillation of the pressure between neighbouring material points: its root mean square.
        PressureNoise = "pressure-noise",
        /// The largest upward displacement of all material points.
        Heave = "heave",
        /// Mean normal pressure at the base of the footing.
        FootingPressure = "footing-pressure",
        /// Force of the soil on the footing, positive against the motion of the footing.
        FootingForce = "footing-force",
        /// Downward displacement of the footing.
        Penetration = "penetration",
        /// Largest slip of the material along the footing in the step, divided by the displacement of the footing in
        /// the step.
        Slip = "slip",
        /// Contact of a face, footing or segment: fraction of its nodes near material at which the contact is closed,
        /// and fraction of its normal force at which material slides.
        Contact = "contact",
        /// Smallest and largest distance of the material from the nodes of a face, footing or segment in contact. Only
        /// nodes with material in their cells count. Without such nodes, and before the first step, the values are 0.
        Gap = "gap",
        /// Sliding velocity of the material along a face, footing or segment in contact: mean of the step, weighted
        /// with the normal force.
        SlipRate = "slip-rate",
        /// Power that friction dissipates at a face, footing or segment in contact: mean of the step.
        FrictionPower = "friction-power",
        /// Force of the soil on a rigid body.
        RigidForce = "rigid-force",
        /// Moment of the soil on a rigid body about its reference point, positive counter-clockwise.
        RigidMoment = "rigid-moment",
        /// Displacement of the reference point of a rigid body.
        RigidDisplacement = "rigid-displacement",
        /// Rotation of a rigid body, positive counter-clockwise.
        RigidRotation = "rigid-rotation",
        /// Velocity of the reference point of a rigid body.
        RigidVelocity = "rigid-velocity",
        /// Accumulated sliding distance of the soil along the outline of a rigid body. The slip of each step is a mean,
        /// weighted with the normal force.
        RigidSlip = "rigid-slip",
        /// Smallest distance of the soil from a rigid body. It is 0 in contact, and before the first step.
        RigidGap = "rigid-gap",
        /// Work of a rigid body on the soil since the start, including friction. It is computed with the mean force of
        /// every step, in dynamic analyses with the force at the end of the step.
        RigidWork = "rigid-work",
        /// Energy balance since the start: external = change of kinetic + change of elastic + plastic + numerical +
        /// closure.
        Energy = "energy",
    }
}

/// Components of a vector.
const VECTOR: &[(&str, &str)] = &[("-x", "along x"), ("-y", "along y")];
const STRESS: &[(&str, &str)] = &[
    ("-xx", "normal to x"),
    ("-yy", "normal to y"),
    ("-zz", "out of the plane"),
    ("-xy", "shear"),
];
const VECTOR_IN_SPACE: &[(&str, &str)] = &[VECTOR[0], VECTOR[1], ("-z", "along z")];
const STRESS_IN_SPACE: &[(&str, &str)] = &[
    STRESS[0],
    STRESS[1],
    ("-zz", "normal to z"),
    ("-xy", "shear"),
    ("-yz", "shear"),
    ("-xz", "shear"),
];
const SECTION: &[(&str, &str)] = &[
    ("-n", "normal force, positive in tension"),
    (
        "-q",
        "shear force along the line, on the material to the left of the line",
    ),
    (
        "-m",
        "bending moment about the centre of the line (N m/m), positive if the side of `to` is in tension",
    ),
];
const SECTION_IN_SPACE: &[(&str, &str)] = &[
    SECTION[0],
    ("-q1", "shear force along t1, on the material before the section"),
    ("-q2", "shear force along t2, on the material before the section"),
    (
        "-t",
        "torsional moment (N m) about the normal through the centre, on the material before the section",
    ),
    (
        "-m1",
        "bending moment about the centre (N m), positive if the side of positive t1 is in tension",
    ),
    (
        "-m2",
        "bending moment about the centre (N m), positive if the side of positive t2 is in tension",
    ),
];
const RANGE: &[(&str, &str)] = &[
    ("-mean", "mean, weighted with the present volumes"),
    ("-least", "least value"),
    ("-largest", "largest value"),
];
const STRAIN: &[(&str, &str)] = &[
    ("-mean", "mean, weighted with the present volumes"),
    ("-largest", "largest value"),
];
const NOISE: &[(&str, &str)] = &[
    ("-average", "deviation from a local average over the grid"),
    (
        "-plane",
        "deviation from a plane through the neighbouring material points",
    ),
];
const CONTACT: &[(&str, &str)] = &[
    ("-closed", "fraction of the nodes that are closed"),
    ("-sliding", "fraction of the normal force that slides"),
];
const GAP: &[(&str, &str)] = &[("-least", "least value"), ("-largest", "largest value")];
const ENERGY: &[(&str, &str)] = &[
    ("-kinetic", "kinetic energy of the material points"),
    (
        "-elastic",
        "elastic energy of the material points, of compressed water and of suction",
    ),
    ("-plastic", "dissipation by plastic flow, damping and seepage"),
    (
        "-external",
        "work of gravity, loads and prescribed displacements, minus dissipation by friction at faces and by absorbing boundaries",
    ),
    (
        "-numerical",
        "numerical dissipation, the sum of transfer, integration, smoothing, background and penalty",
    ),
    (
        "-transfer",
        "dissipation by the transfer between material points and nodes",
    ),
    (
        "-integration",
        "dissipation by the integration in time and along the strain path",
    ),
    ("-smoothing", "dissipation by the averaging of elastic strains"),
    (
        "-background",
        "dissipation by the artificial stiffness `solver.background`",
    ),
    (
        "-penalty",
        "dissipation by the penalty method at footings and prescribed displacements",
    ),
    (
        "-closure",
        "residual of the balance: work of the out-of-balance forces, and round-off",
    ),
];

impl Measurement {
    /// An item of the list `history` that records it, as written in a case file.
    pub fn example(self) -> String {
        let quantity = format!("quantity = \"{}\"", self.word());
        let keys = self.example_keys().iter().map(|key| (*key).to_owned());
        let keys: Vec<String> = std::iter::once(quantity).chain(keys).collect();
        format!("{{ {} }}", keys.join(", "))
    }

    /// The keys besides `quantity` in the example.
    pub(crate) fn example_keys(self) -> &'static [&'static str] {
        match self {
            Self::Runout => &["percentile = 99.0"],
            Self::Height => &["at_x = 2.0"],
            Self::Mass | Self::Momentum | Self::CentreOfMass => &[r#"body = "fill""#],
            Self::AngularMomentum | Self::KineticEnergy | Self::MeanVelocity => &[r#"body = "fill""#],
            Self::MeanStress | Self::PressureNoise => &["box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }"],
            Self::MeanDisplacement | Self::PlasticStrain => &[r#"material = "sand""#],
            Self::PorePressures => &[r#"material = "clay""#],
            Self::SectionForces => &["from = [1.0, 0.0]", "to = [1.0, 1.25]"],
            Self::Reaction => &[r#"face = "bottom""#],
            Self::Displacement | Self::PorePressure | Self::ExcessPressure => &["at = [2.0, 0.5]"],
            Self::Porosity | Self::Flux => &["at = [2.0, 0.5]"],
            Self::Velocity | Self::Stress => &["at = [2.0, 1.0]", "surface = true"],
            Self::Moment | Self::Work => &[r#"of = "footing""#],
            Self::Contact | Self::Gap | Self::SlipRate | Self::FrictionPower => &[r#"of = "footing""#],
            Self::WaterOutflow => &[r#"drain = "base""#],
            Self::RigidForce | Self::RigidMoment | Self::RigidDisplacement => &[r#"rigid = "pipe""#],
            Self::RigidRotation | Self::RigidVelocity => &[r#"rigid = "pipe""#],
            Self::RigidSlip | Self::RigidGap | Self::RigidWork => &[r#"rigid = "pipe""#],
            Self::Front | Self::MaxDisplacement | Self::Outflow | Self::WaterBalance | Self::StressNoise => &[],
            Self::Heave | Self::FootingPressure | Self::FootingForce | Self::Penetration | Self::Slip => &[],
            Self::Energy => &[],
        }
    }

    /// Whether there must be a footing.
    pub fn is_of_footing(self) -> bool {
        matches!(
            self,
            Self::FootingPressure | Self::FootingForce | Self::Penetration | Self::Slip
        )
    }

    /// Whether it is of water that flows.
    pub fn is_of_flow(self) -> bool {
        use Measurement::*;
        matches!(self, ExcessPressure | Porosity | Flux | WaterOutflow | WaterBalance)
    }

    /// Whether it is of a rigid body.
    pub fn is_of_rigid_body(self) -> bool {
        use Measurement::*;
        matches!(
            self,
            RigidForce | RigidMoment | RigidDisplacement | RigidRotation | RigidVelocity
        ) || matches!(self, RigidSlip | RigidGap | RigidWork)
    }

    /// Whether it can be of a strip.
    pub fn is_of_strip(self) -> bool {
        self.is_of_contact() || matches!(self, Self::Reaction | Self::Moment | Self::Work)
    }

    /// Whether its face must be in contact.
    pub fn is_of_contact(self) -> bool {
        matches!(self, Self::Contact | Self::Gap | Self::SlipRate | Self::FrictionPower)
    }

    /// What the names of its columns get appended, in the order of the numbers, and what each is; nothing is appended
    /// to the one column of a scalar.
    pub fn columns(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::RigidForce | Self::RigidDisplacement | Self::RigidVelocity => VECTOR,
            Self::RigidMoment | Self::RigidRotation | Self::RigidSlip => &[("", "")],
            Self::RigidGap | Self::RigidWork => &[("", "")],
            Self::Momentum | Self::CentreOfMass | Self::Reaction | Self::Displacement | Self::Velocity | Self::Flux => {
                VECTOR
            }
            Self::MeanDisplacement | Self::MeanVelocity => VECTOR,
            Self::PlasticStrain => STRAIN,
            Self::Stress | Self::MeanStress => STRESS,
            Self::SectionForces => SECTION,
            Self::PorePressures => RANGE,
            Self::StressNoise | Self::PressureNoise => NOISE,
            Self::Energy => ENERGY,
            Self::Contact => CONTACT,
            Self::Gap => GAP,
            Self::SlipRate | Self::FrictionPower | Self::AngularMomentum | Self::KineticEnergy => &[("", "")],
            Self::Moment | Self::Work => &[("", "")],
            Self::Runout | Self::Front | Self::Height | Self::MaxDisplacement | Self::Heave => &[("", "")],
            Self::Mass | Self::Outflow | Self::FootingPressure | Self::FootingForce => &[("", "")],
            Self::Penetration | Self::Slip | Self::PorePressure | Self::ExcessPressure | Self::Porosity => &[("", "")],
            Self::WaterOutflow | Self::WaterBalance => &[("", "")],
        }
    }

    /// The same along so many axes.
    pub fn columns_in(self, dims: usize) -> &'static [(&'static str, &'static str)] {
        match (dims, self) {
            (3, Self::Stress | Self::MeanStress) => STRESS_IN_SPACE,
            (3, Self::SectionForces) => SECTION_IN_SPACE,
            (3, Self::AngularMomentum) => VECTOR_IN_SPACE,
            (3, of) if of.columns() == VECTOR => VECTOR_IN_SPACE,
            (_, of) => of.columns(),
        }
    }

    /// Unit of its numbers.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Runout | Self::Front | Self::Height | Self::Heave | Self::Penetration => "m",
            Self::MaxDisplacement | Self::Displacement | Self::Gap | Self::CentreOfMass | Self::MeanDisplacement => "m",
            Self::RigidDisplacement | Self::RigidSlip | Self::RigidGap => "m",
            Self::RigidRotation => "deg",
            Self::RigidMoment => "N",
            Self::Mass | Self::Outflow => "kg/m",
            Self::Momentum => "kg/s",
            Self::AngularMomentum => "kg m/s",
            Self::Reaction | Self::FootingForce | Self::SectionForces | Self::RigidForce => "N/m",
            Self::Velocity | Self::SlipRate | Self::RigidVelocity | Self::Flux | Self::MeanVelocity => "m/s",
            Self::FrictionPower => "W/m",
            Self::Stress | Self::MeanStress | Self::PressureNoise | Self::FootingPressure => "Pa",
            Self::PorePressure | Self::PorePressures | Self::ExcessPressure => "Pa",
            Self::PlasticStrain
            | Self::StressNoise
            | Self::Slip
            | Self::Contact
            | Self::Porosity
            | Self::WaterBalance => "-",
            Self::WaterOutflow => "m3/m",
            Self::Moment => "N",
            Self::Energy | Self::KineticEnergy | Self::Work | Self::RigidWork => "J/m",
        }
    }

    /// Unit of the numbers of a column, of those along so many axes.
    pub fn unit_of(self, column: usize, dims: usize) -> &'static str {
        // Forces along the axes are first, then the moments.
        if self == Self::SectionForces && column >= dims {
            "N m/m"
        } else {
            self.unit()
        }
    }

    /// Whether it is of the points of a material, a body or a box, if one is given.
    pub fn is_of_part(self) -> bool {
        use Measurement::*;
        let of_mass = matches!(
            self,
            Mass | Momentum | CentreOfMass | AngularMomentum | KineticEnergy | MeanStress
        );
        let of_motion = matches!(self, MeanDisplacement | MeanVelocity | MaxDisplacement | Heave);
        of_mass || of_motion || matches!(self, PlasticStrain | PorePressures | PressureNoise | Runout | Height)
    }
}
