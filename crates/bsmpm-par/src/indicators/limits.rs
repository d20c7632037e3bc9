//! Limits of indicators. A run with an indicator beyond its limit ends with exit code 82.

use bsmpm::model::Regime;
use bsmpm::quadrature::Quadrature;
use bsmpm_scene::Case;
use bsmpm_scene::words::{LimitedIndicator, Word};

/// The limits of an indicator by its name; none where no measurement gives them.
pub(super) fn of(name: &str, case: &Case) -> Option<[f64; 2]> {
    let most = match LimitedIndicator::of(name)? {
        LimitedIndicator::BackgroundWork => 0.1,
        // The energy of a quasi-static analysis may nearly vanish where loads are taken away.
        LimitedIndicator::EnergyLoss if case.analysis.regime == Regime::QuasiStatic => return None,
        LimitedIndicator::EnergyLoss => return Some([-0.4, 0.4]),
        LimitedIndicator::ForceNoise => 0.1,
        LimitedIndicator::InterfaceShift if case.solver.quadrature == Quadrature::Fitted => 0.5,
        LimitedIndicator::InterfaceShift => 0.1,
        LimitedIndicator::PermeabilityShift => 0.2,
        LimitedIndicator::RigidPenetration => 0.2,
        LimitedIndicator::StepAdvance => 1.0,
        LimitedIndicator::WallVelocity => return Some([-0.5, 0.5]),
        LimitedIndicator::WaterBalance => 0.1,
    };
    Some([0.0, most])
}

/// Whether the case accepts values beyond them.
pub(super) fn are_accepted(name: &str, case: &Case) -> bool {
    LimitedIndicator::of(name).is_some_and(|indicator| case.output.accept.contains(&indicator))
}
