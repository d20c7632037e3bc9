//! Accepted words for the indicators that can end a run.

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
