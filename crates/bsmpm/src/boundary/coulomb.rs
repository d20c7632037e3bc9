//! Coulomb's friction law, contact statuses and contact forces, theory-manual equations (T7.1), (T7.2).

use crate::tensor::Vector;

/// What a face or strip does to the material at it, instead of holding it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// -  coefficient of friction mu
    pub friction: f64,
    /// whether material comes off it; else its normal component is held both ways, and there is no friction where it
    /// pulls
    pub lifts: bool,
}

/// What a node of such a face, or a point of such a strip, does in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status<const D: usize> {
    /// Off the face: no force.
    Open,
    /// On the face, and held along it.
    Stick,
    /// On the face, and free along it but for the friction against this unit vector; zero without friction.
    Slip(Vector<D>),
}

/// The part of a vector beside a unit vector.
pub(super) fn transverse<const D: usize>(vector: &Vector<D>, unit: &Vector<D>) -> Vector<D> {
    vector - unit * vector.dot(unit)
}

/// Returns a part of a whole, 0 of nothing.
pub(super) fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// What a face or strip with contact did in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactReport {
    /// number of the support, or of the strip
    pub support: usize,
    /// nodes of the face, or points of the strip, that see material
    pub nodes: usize,
    /// -  part of them that is on the face
    pub closed: f64,
    /// -  part of the normal force that is on nodes that slip; 0 without force
    pub sliding: f64,
    /// m  mean of the slip of the step, by normal force
    pub slip: f64,
    /// J  dissipated by friction in the step
    pub dissipated: f64,
    /// m  least and largest distance of the material at the end of the step; 0 without material
    pub gap: [f64; 2],
}
