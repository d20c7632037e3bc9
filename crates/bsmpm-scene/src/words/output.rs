//! Words of what frames and profiles show of the points.

choice! {
    /// An indicator that ends a run with an exit code of its own where it is beyond its limit, unless the case accepts
    /// it.
    pub enum LimitedIndicator {
        /// Work done on the soft background.
        BackgroundWork = "background-work",
        /// Energy that the algorithm lost.
        EnergyLoss = "energy-loss",
        /// Noise of a history of a force.
        ForceNoise = "force-noise",
        /// Distance by which an interface has left its grid line.
        InterfaceShift = "interface-shift",
        /// The same for soils of different permeability.
        PermeabilityShift = "permeability-shift",
        /// Depth of material in a rigid body.
        RigidPenetration = "rigid-penetration",
        /// Distance that a point moved in a step of dynamics.
        StepAdvance = "step-advance",
        /// Velocity of points next to fixed faces.
        WallVelocity = "wall-velocity",
        /// Water that was lost.
        WaterBalance = "water-balance",
    }
}

choice! {
    /// A field that frames have on request.
    pub enum FrameField {
        /// Deviatoric stress (Pa), sqrt(3/2 s:s).
        Q = "q",
        /// Principal Cauchy stresses (Pa), descending, positive in tension.
        PrincipalStresses = "principal-stresses",
        /// 1/F, F the factor by which the strength may be divided until the stress is on the yield surface; 1 at
        /// yield, 0 of a law without strength.
        MobilisedStrength = "mobilised-strength",
        /// Deviatoric part of the logarithmic strain since the start, sqrt(2/3 e:e).
        DeviatoricStrain = "deviatoric-strain",
        /// 1 where the stress is on the yield surface, to 1e-4 of the strength, or beyond; 0 elsewhere.
        Yielding = "yielding",
        /// Present density (kg/m3).
        Density = "density",
        /// Pressure of the water in the pores (Pa), positive in compression.
        PorePressure = "pore-pressure",
        /// Pore pressure above that of the still water (Pa), where water flows.
        ExcessPressure = "excess-pressure",
        /// Volume of water that flows through the soil per area and time (m/s), relative to the grains.
        Flux = "flux",
        /// Share of pores in the volume, where water flows.
        Porosity = "porosity",
        /// Share of the pores that water fills, where water flows.
        Saturation = "saturation",
        /// Effective stress less the pore pressure (Pa), positive in tension.
        TotalStress = "total-stress",
        /// Number of the body, in the order of the file; run.json and the frame have the names.
        Body = "body",
    }
}

impl FrameField {
    /// Whether it is of water that flows.
    pub fn is_of_flow(self) -> bool {
        matches!(self, Self::ExcessPressure | Self::Flux | Self::Porosity | Self::Saturation)
    }

    /// Its name in frames.
    pub fn field(self) -> &'static str {
        match self {
            Self::Q => "q",
            Self::PrincipalStresses => "principal_stresses",
            Self::MobilisedStrength => "mobilised_strength",
            Self::DeviatoricStrain => "deviatoric_strain",
            Self::Yielding => "yielding",
            Self::Density => "density",
            Self::PorePressure => "pore_pressure",
            Self::ExcessPressure => "excess_pressure",
            Self::Flux => "flux",
            Self::Porosity => "porosity",
            Self::Saturation => "saturation",
            Self::TotalStress => "total_stress",
            Self::Body => "body",
        }
    }

    /// Unit of its numbers.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Q | Self::PrincipalStresses | Self::PorePressure => "Pa",
            Self::ExcessPressure | Self::TotalStress => "Pa",
            Self::Flux => "m/s",
            Self::Porosity | Self::Saturation => "-",
            Self::MobilisedStrength | Self::DeviatoricStrain | Self::Yielding | Self::Body => "-",
            Self::Density => "kg/m3",
        }
    }
}

choice! {
    /// What a profile reports at its places.
    pub enum ProfileQuantity {
        /// Displacement (m).
        Displacement = "displacement",
        /// Velocity (m/s); dynamic.
        Velocity = "velocity",
        /// Cauchy stress (Pa), positive in tension.
        Stress = "stress",
        /// Mean stress (Pa), positive in compression.
        P = "p",
        /// Deviatoric stress (Pa), sqrt(3/2 s:s).
        Q = "q",
        /// Accumulated plastic strain, the sum of sqrt(2/3) |dev| of its increments.
        PlasticStrain = "plastic-strain",
        /// Pressure of the water in the pores (Pa), positive in compression.
        PorePressure = "pore-pressure",
        /// Pore pressure above that of the still water (Pa), where water flows.
        ExcessPressure = "excess-pressure",
    }
}

impl ProfileQuantity {
    /// Names and unit of its columns along so many axes.
    pub fn columns_in(self, dims: usize) -> (&'static [&'static str], &'static str) {
        match self {
            Self::Displacement => (&["displacement-x", "displacement-y", "displacement-z"][..dims], "m"),
            Self::Velocity => (&["velocity-x", "velocity-y", "velocity-z"][..dims], "m/s"),
            Self::Stress if dims == 3 => {
                (&["stress-xx", "stress-yy", "stress-zz", "stress-xy", "stress-yz", "stress-xz"], "Pa")
            }
            Self::Stress => (&["stress-xx", "stress-yy", "stress-zz", "stress-xy"], "Pa"),
            Self::P => (&["p"], "Pa"),
            Self::Q => (&["q"], "Pa"),
            Self::PlasticStrain => (&["plastic-strain"], "-"),
            Self::PorePressure => (&["pore-pressure"], "Pa"),
            Self::ExcessPressure => (&["excess-pressure"], "Pa"),
        }
    }
}
