//! What runs took on the machine of reference: where nothing may be run, and to plan the probes with.
//!
//! Fitted to the processor seconds of the shipped short cases and of the column at the paper's resolution, one rank
//! each.

use bsmpm_scene::{Case, Regime};

use super::sizes::{self, Bytes};
use super::work::Effort;

/// s  of a unit of work, for each point and for each unknown.
const POINT: f64 = 0.134e-6;
const UNKNOWN: f64 = 0.25e-6;
/// Evaluations of a step: elastic; dynamic; quasi-static and plastic, between those of slopes (9 to 20) and footings
/// (38).
const EVALUATIONS: [f64; 3] = [4.0, 16.0, 25.0];
/// Where water flows: how much more iterations a step takes by turns on both systems, and how much dearer each is.
const FLOWING: [f64; 2] = [1.5, 1.25];
/// s  that a run takes before its first step.
const START: f64 = 0.08;
/// s  of a frame, and of each of its points.
const FRAME: [f64; 2] = [2e-3, 0.7e-6];
/// Factor either way within which such an estimate lies: what iterations take differs that much between scenes.
const BAND: f64 = 4.0;

/// What an estimate is made from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredEstimate {
    /// of the whole run
    pub work: Effort,
    /// s  of a unit of work, all ranks together
    pub unit: f64,
    /// s  before the first step
    pub start: f64,
    /// s  of a frame
    pub frame: f64,
    /// what is written
    pub bytes: Bytes,
    /// nodal components that the case's own steps solved for, if any was made
    pub unknowns: Option<u64>,
    /// factor either way within which the time is expected
    pub band: f64,
    /// in words
    pub basis: String,
}

impl StoredEstimate {
    /// Processor seconds of the run, all ranks together, with so many frames.
    pub fn seconds(&self, frames: u64) -> f64 {
        self.start + self.unit * self.work.units() + self.frame * frames.saturating_sub(1) as f64
    }
}

/// An estimate from what runs took elsewhere; `speed` is this machine's time over that of the other one.
pub(super) fn guess(case: &Case, speed: f64) -> StoredEstimate {
    let plastic = case.materials.iter().any(|named| named.material.yields());
    let kind = match (plastic, case.analysis.regime) {
        (false, _) => 0,
        (true, Regime::Dynamic) => 1,
        (true, Regime::QuasiStatic) => 2,
    };
    let (sizes, steps) = (case.estimate(), sizes::steps(case));
    let points = case.points() as f64;
    let [more, dearer] = if case.flow.is_some() { FLOWING } else { [1.0; 2] };
    StoredEstimate {
        work: Effort { steps, evaluations: more * EVALUATIONS[kind] * steps, ..Effort::default() },
        unit: speed * dearer * (POINT * points + UNKNOWN * sizes.active as f64),
        start: speed * START,
        frame: speed * (FRAME[0] + FRAME[1] * points),
        bytes: Bytes::of(case),
        unknowns: None,
        band: BAND,
        basis: "what runs of other cases took elsewhere, scaled by the speed of this machine: too little where steps need Newton's \
                method"
            .to_owned(),
    }
}

/// How much dearer a unit of work becomes where the body spreads to so many times the nodes: that of the points does
/// not.
pub(super) fn spread(case: &Case, unknowns: Option<u64>, nodes: f64) -> f64 {
    let unknowns = unknowns.unwrap_or(case.estimate().active) as f64;
    let unit = |unknowns: f64| POINT * case.points() as f64 + UNKNOWN * unknowns;
    unit(nodes * unknowns) / unit(unknowns)
}
