//! Numbers that both the checks of a case and its presets use.

/// Acceleration by which a unit weight is divided to give a density, whatever the gravity of the case is (m/s2).
pub(crate) const STANDARD_GRAVITY: f64 = 9.81;
/// Poisson's ratio above which elastic material counts as locking without F-bar.
pub(crate) const NEARLY_INCOMPRESSIBLE: f64 = 0.45;
