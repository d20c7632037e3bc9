//! What a history records: its words, definitions, units and columns.

choice! {
    /// What a history records, without what it needs besides, which [`Quantity`](crate::Quantity) has.
    pub enum Measurement {
        /// The x that `percentile` per cent of the points do not exceed; 100: of the farthest point. In the grid's
        /// coordinates: the initial length is not taken off. For the run-out of a flow use `percentile = 99`: single
        /// points and a tip thinner than a cell run ahead.
        Runout = "runout",
        /// The farthest x of the lowest occupied row of cells such that the points from it back by the length of its
        /// cell fill half of a cell; a few loose points run ahead of it. It does not converge where the tip is thinner
        /// on finer grids: for run-outs use `runout` with `percentile = 99`.
        Front = "front",
        /// The largest y of any point, or of those within half a cell of `at_x`; 0 where there are none.
        Height = "height",
        /// The largest displacement of any point.
        MaxDisplacement = "max-displacement",
        /// Mass, per metre of thickness.
        Mass = "mass",
        /// Momentum (kg m/s), per metre of thickness.
        Momentum = "momentum",
        /// Where the mass is in the mean; the grid's lower corner without any.
        CentreOfMass = "centre-of-mass",
        /// Angular momentum about the origin of the case's coordinates (kg m2/s), counter-clockwise, per metre of
        /// thickness.
        AngularMomentum = "angular-momentum",
        /// Kinetic energy, per metre of thickness.
        KineticEnergy = "kinetic-energy",
        /// Mean Cauchy stress, positive in tension, weighted with the points' present volumes.
        MeanStress = "mean-stress",
        /// Mean displacement, weighted with the points' present volumes.
        MeanDisplacement = "mean-displacement",
        /// Mean velocity, weighted with the points' present volumes.
        MeanVelocity = "mean-velocity",
        /// Accumulated plastic strain, the sum of sqrt(2/3) |dev| of its increments.
        PlasticStrain = "plastic-strain",
        /// What the stress transmits across the line from `from` to `to`, per metre of thickness: of the material on
        /// its right on that on its left: the effective stress, without what water presses with. What of the line is
        /// out of the body counts for nothing. Of a solid across a
        /// `rectangle` or a `disc`, of the material that its normal axis points to on that before; t1 and t2 are the
        /// axes that follow the normal one (y and z of x, z and x of y, x and y of z), and turn with the section.
        SectionForces = "section-forces",
        /// Mass that has left the grid through faces with outflow since the start, per metre of thickness.
        Outflow = "outflow",
        /// Force of a face's supports, or of a strip or what else moves, on the body, per metre of thickness. At
        /// an edge that two faces hold, a force counts for the face that it is normal to; where a strip or what moves
        /// meets a face that is fixed, what the nodes of the edge hold counts for that face (a fixed bottom has 4 % of
        /// the thrust on a wall of 16 cells, of 8 cells 8 %; a roller has none). In water it is that of the grains and
        /// of the excess pressure, without what still water presses with.
        Reaction = "reaction",
        /// Moment of the force of a strip or what else moves about its middle, counter-clockwise, per metre of
        /// thickness.
        Moment = "moment",
        /// Work of a strip or what else moves on the body since the start, per metre of thickness: by the mean force of
        /// every step.
        Work = "work",
        /// Displacement of the material that is at `at` at the start, by the motion about the point nearest to it.
        Displacement = "displacement",
        /// Velocity of the point nearest to `at` at the start; with `surface` of the place itself.
        Velocity = "velocity",
        /// Cauchy stress of the point nearest to `at` at the start, positive in tension; with `surface` of the place
        /// itself.
        Stress = "stress",
        /// Pressure of the water in the pores of the point nearest to `at` at the start, positive in compression.
        PorePressure = "pore-pressure",
        /// Pore pressure of all points, or of those of a material or body, positive in compression.
        PorePressures = "pore-pressures",
        /// Pore pressure above that of the still water, of the point nearest to `at` at the start, where water flows.
        ExcessPressure = "excess-pressure",
        /// Share of pores in the volume of the point nearest to `at` at the start, where water flows.
        Porosity = "porosity",
        /// Volume of water that flows through the soil per area and time (Darcy), relative to the grains, of the point
        /// nearest to `at` at the start. In cells at the surface of ground that has deformed much it jumps from cell
        /// to cell, by a third and more: what drains let through does not.
        Flux = "flux",
        /// Volume of water that has left the ground through a drain since the start, per metre of thickness; all drains
        /// less all inflows unless one is named.
        WaterOutflow = "water-outflow",
        /// What the ground has gained of water since the start and what has left it: their sum over the larger of what
        /// crossed its surface and what its points took in and gave off. 0 where no water is lost.
        WaterBalance = "water-balance",
        /// Oscillation of sigma_yy over all points from point to point: a root mean square, over the mean of
        /// |sigma_yy|.
        StressNoise = "stress-noise",
        /// Oscillation of the pressure from point to point: a root mean square over the points.
        PressureNoise = "pressure-noise",
        /// The largest upward displacement of any point.
        Heave = "heave",
        /// Mean normal pressure on the footing's base.
        FootingPressure = "footing-pressure",
        /// Force of the soil on the footing against its motion, per metre of thickness.
        FootingForce = "footing-force",
        /// Displacement of the footing, downwards.
        Penetration = "penetration",
        /// The largest distance that the material has slipped from the footing in the step, over the footing's
        /// motion in it.
        Slip = "slip",
        /// Of a face in contact, the part of its nodes near material that is on it, and the part of its normal force
        /// where material slides.
        Contact = "contact",
        /// The least and the largest distance of the material from a face in contact, over the nodes of the face whose
        /// cells have some; 0 without any, and before the first step.
        Gap = "gap",
        /// How fast material slides along a face in contact: the step's mean, weighted with the normal force.
        SlipRate = "slip-rate",
        /// What friction at a face in contact dissipates, per unit of time and metre of thickness: the step's mean.
        FrictionPower = "friction-power",
        /// Force of the soil on a rigid body, per metre of thickness.
        RigidForce = "rigid-force",
        /// Moment of that force about the body's reference point (N m), counter-clockwise, per metre of thickness.
        RigidMoment = "rigid-moment",
        /// Displacement of a rigid body's reference point.
        RigidDisplacement = "rigid-displacement",
        /// Rotation of a rigid body, counter-clockwise.
        RigidRotation = "rigid-rotation",
        /// Velocity of a rigid body's reference point.
        RigidVelocity = "rigid-velocity",
        /// Way that soil has gone along a rigid body's outline where it touches it: the sum of every step's mean,
        /// weighted with the normal force.
        RigidSlip = "rigid-slip",
        /// The least distance of soil from a rigid body; 0 where it is touched, and before the first step.
        RigidGap = "rigid-gap",
        /// Work of a rigid body on the soil since the start, friction among it, per metre of thickness: by the mean
        /// force of every step, in dynamics by that at its end.
        RigidWork = "rigid-work",
        /// Where the energy of the points is, and where it went since the start, per metre of thickness: external =
        /// change of kinetic + change of elastic + plastic + numerical + closure.
        Energy = "energy",
    }
}

/// Components of a vector.
const VECTOR: &[(&str, &str)] = &[("-x", "along x"), ("-y", "along y")];
const STRESS: &[(&str, &str)] =
    &[("-xx", "normal to x"), ("-yy", "normal to y"), ("-zz", "out of the plane"), ("-xy", "shear")];
const VECTOR_IN_SPACE: &[(&str, &str)] = &[VECTOR[0], VECTOR[1], ("-z", "along z")];
const STRESS_IN_SPACE: &[(&str, &str)] =
    &[STRESS[0], STRESS[1], ("-zz", "normal to z"), ("-xy", "shear"), ("-yz", "shear"), ("-xz", "shear")];
const SECTION: &[(&str, &str)] = &[
    ("-n", "normal force, positive in tension"),
    ("-q", "shear force: on what is on the left of the line, along it"),
    ("-m", "moment about the line's middle (N m/m), positive where the side of `to` is in tension"),
];
const SECTION_IN_SPACE: &[(&str, &str)] = &[
    SECTION[0],
    ("-q1", "shear force: on what is before the section, along t1"),
    ("-q2", "shear force: on what is before the section, along t2"),
    ("-t", "torsion (N m): moment about the normal through the section's middle, on what is before it"),
    ("-m1", "moment about the section's middle (N m), positive where the side that t1 points to is in tension"),
    ("-m2", "moment about the section's middle (N m), positive where the side that t2 points to is in tension"),
];
const RANGE: &[(&str, &str)] =
    &[("-mean", "their mean, weighted with present volumes"), ("-least", "the least"), ("-largest", "the largest")];
const STRAIN: &[(&str, &str)] =
    &[("-mean", "the mean, weighted with present volumes"), ("-largest", "of the point that has most")];
const NOISE: &[(&str, &str)] =
    &[("-average", "about the average over the grid"), ("-plane", "about the plane through the points around")];
const CONTACT: &[(&str, &str)] = &[("-closed", "part of the nodes"), ("-sliding", "part of the normal force")];
const GAP: &[(&str, &str)] = &[("-least", "the least"), ("-largest", "the largest")];
const ENERGY: &[(&str, &str)] = &[
    ("-kinetic", "kinetic energy of the points"),
    ("-elastic", "elastic energy of the points, and what compressed water and pores that suction has emptied hold"),
    ("-plastic", "dissipated by plastic flow, damping and seepage"),
    ("-external", "work of gravity, loads and what moves, less what friction at faces and faces that absorb take"),
    ("-numerical", "loss of the algorithm: the sum of the next five"),
    ("-transfer", "lost between points and nodes"),
    ("-integration", "lost by integration in time and along the strain"),
    ("-smoothing", "lost by the smoothing of the elastic strain"),
    ("-background", "lost to the soft background"),
    ("-penalty", "lost between strips and material"),
    ("-closure", "what is left over: the work of what is out of balance, and round-off"),
];

impl Measurement {
    /// Whether there must be a footing.
    pub fn is_of_footing(self) -> bool {
        matches!(self, Self::FootingPressure | Self::FootingForce | Self::Penetration | Self::Slip)
    }

    /// Whether it is of water that flows.
    pub fn is_of_flow(self) -> bool {
        use Measurement::*;
        matches!(self, ExcessPressure | Porosity | Flux | WaterOutflow | WaterBalance)
    }

    /// Whether it is of a rigid body.
    pub fn is_of_rigid_body(self) -> bool {
        use Measurement::*;
        matches!(self, RigidForce | RigidMoment | RigidDisplacement | RigidRotation | RigidVelocity)
            || matches!(self, RigidSlip | RigidGap | RigidWork)
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
        if self == Self::SectionForces && column >= dims { "N m/m" } else { self.unit() }
    }

    /// Whether it is of the points of a material, a body or a box, if one is given.
    pub fn is_of_part(self) -> bool {
        use Measurement::*;
        let of_mass = matches!(self, Mass | Momentum | CentreOfMass | AngularMomentum | KineticEnergy | MeanStress);
        let of_motion = matches!(self, MeanDisplacement | MeanVelocity | MaxDisplacement | Heave);
        of_mass || of_motion || matches!(self, PlasticStrain | PorePressures | PressureNoise | Runout | Height)
    }
}
