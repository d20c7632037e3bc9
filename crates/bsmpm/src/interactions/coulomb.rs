//! Coulomb's friction law, contact statuses and contact forces, theory-manual equations (T7.1), (T7.2).

use crate::tensor::Vector;

/// Contact law of a face or strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Friction coefficient mu (-).
    pub friction: f64,
    /// Whether the material can separate. If not, the normal component is fixed in both directions, and there is no
    /// friction in tension.
    pub lifts: bool,
}

/// Contact status of a node on a face or a point of a strip in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status<const D: usize> {
    /// Separated: no force.
    Open,
    /// In contact, without tangential motion.
    Stick,
    /// In contact, sliding. On a face, friction on the body acts against this unit vector; on a strip, along it. Zero
    /// without friction.
    Slip(Vector<D>),
}

/// Returns the part of a vector normal to a unit vector.
pub(super) fn transverse<const D: usize>(vector: &Vector<D>, unit: &Vector<D>) -> Vector<D> {
    vector - unit * vector.dot(unit)
}

/// Returns `part / whole`; 0 if `whole` is 0.
pub(super) fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// Contact results of a face or strip for one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactReport {
    /// Index of the support or of the strip.
    pub support: usize,
    /// Number of nodes of the face, or points of the strip, with material in range.
    pub nodes: usize,
    /// Share of them that is in contact (-).
    pub closed: f64,
    /// Share of the normal force at sliding nodes (-); 0 without force.
    pub sliding: f64,
    /// Mean slip of the step, weighted with the normal force (m).
    pub slip: f64,
    /// Energy dissipated by friction in the step (J).
    pub dissipated: f64,
    /// Least and largest gap at the end of the step (m); 0 without material.
    pub gap: [f64; 2],
}
