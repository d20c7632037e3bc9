//! Accepted words for fields of frames and profiles.

choice! {
    /// An indicator that ends a run with an exit code of its own where it is beyond its limit, unless the case accepts
    /// it.
    pub enum LimitedIndicator {
        /// Work of the artificial stiffness.
        BackgroundWork = "background-work",
        /// Energy that the numerical method dissipates.
        EnergyLoss = "energy-loss",
        /// Scatter in the history of a force.
        ForceNoise = "force-noise",
        /// Distance of a material interface from its grid line.
        InterfaceShift = "interface-shift",
        /// Distance of an interface between soils of different permeability from its grid line.
        PermeabilityShift = "permeability-shift",
        /// Penetration of material into a rigid body.
        RigidPenetration = "rigid-penetration",
        /// Displacement of a material point in one dynamic step.
        StepAdvance = "step-advance",
        /// Spurious velocity of material points next to fixed faces.
        WallVelocity = "wall-velocity",
        /// Error of the water balance.
        WaterBalance = "water-balance",
    }
}

choice! {
    /// A field that frames have on request.
    pub enum FrameField {
        /// Deviatoric stress sqrt(3/2 s:s) in Pa.
        Q = "q",
        /// Principal Cauchy stresses in Pa, in descending order, positive in tension.
        PrincipalStresses = "principal-stresses",
        /// Mobilised strength 1/F: the stress reaches the yield surface if the strength is divided by F. It is 1 at
        /// yield, and 0 for a law without strength.
        MobilisedStrength = "mobilised-strength",
        /// Deviatoric logarithmic strain since the start, sqrt(2/3 e:e).
        DeviatoricStrain = "deviatoric-strain",
        /// 1 if the stress is on the yield surface (within 1e-4 of the strength), otherwise 0.
        Yielding = "yielding",
        /// Present density in kg/m3.
        Density = "density",
        /// Pore pressure in Pa, positive in compression.
        PorePressure = "pore-pressure",
        /// Excess pore pressure in Pa: pore pressure minus hydrostatic pressure of the present water level.
        ExcessPressure = "excess-pressure",
        /// Darcy velocity in m/s: volume of water per area and time, relative to the soil.
        Flux = "flux",
        /// Present porosity, where water flows.
        Porosity = "porosity",
        /// Degree of saturation, where water flows.
        Saturation = "saturation",
        /// Total stress in Pa: effective stress minus pore pressure, positive in tension.
        TotalStress = "total-stress",
        /// Number of the body in the order of the case. run.json and the frame contain the names.
        Body = "body",
    }
}

impl FrameField {
    /// Whether it is of water that flows.
    pub fn is_of_flow(self) -> bool {
        matches!(
            self,
            Self::ExcessPressure | Self::Flux | Self::Porosity | Self::Saturation
        )
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
        /// Displacement in m.
        Displacement = "displacement",
        /// Velocity in m/s, in dynamic analyses.
        Velocity = "velocity",
        /// Cauchy stress in Pa, positive in tension.
        Stress = "stress",
        /// Mean stress in Pa, positive in compression.
        P = "p",
        /// Deviatoric stress sqrt(3/2 s:s) in Pa.
        Q = "q",
        /// Accumulated plastic strain, the sum of sqrt(2/3) times the norm of the deviatoric plastic strain increments.
        PlasticStrain = "plastic-strain",
        /// Pore pressure in Pa, positive in compression.
        PorePressure = "pore-pressure",
        /// Excess pore pressure in Pa: pore pressure minus hydrostatic pressure of the present water level.
        ExcessPressure = "excess-pressure",
    }
}

impl ProfileQuantity {
    /// Names and unit of its columns along so many axes.
    pub fn columns_in(self, dims: usize) -> (&'static [&'static str], &'static str) {
        match self {
            Self::Displacement => (&["displacement-x", "displacement-y", "displacement-z"][..dims], "m"),
            Self::Velocity => (&["velocity-x", "velocity-y", "velocity-z"][..dims], "m/s"),
            Self::Stress if dims == 3 => (
                &[
                    "stress-xx",
                    "stress-yy",
                    "stress-zz",
                    "stress-xy",
                    "stress-yz",
                    "stress-xz",
                ],
                "Pa",
            ),
            Self::Stress => (&["stress-xx", "stress-yy", "stress-zz", "stress-xy"], "Pa"),
            Self::P => (&["p"], "Pa"),
            Self::Q => (&["q"], "Pa"),
            Self::PlasticStrain => (&["plastic-strain"], "-"),
            Self::PorePressure => (&["pore-pressure"], "Pa"),
            Self::ExcessPressure => (&["excess-pressure"], "Pa"),
        }
    }
}
