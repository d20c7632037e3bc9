//! `failure.json`: why a run could not continue.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::manifest::Worst;
use crate::{Error, atomic};

/// The file's name.
pub const FAILURE: &str = "failure.json";

/// What is known of the step that failed. Numbers that are not finite are absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailureReport {
    /// The step that failed.
    pub step: u64,
    /// s or pseudo-time  of the last converged state, which is saved.
    pub time: f64,
    /// s or pseudo-time  length of the last attempt.
    pub dt: f64,
    /// Why every attempt failed, first one first.
    pub attempts: Vec<String>,
    /// Both measures of every iteration of the last attempt.
    pub history: Vec<FailureMeasures>,
    /// What both had to fall below; none where nothing was iterated.
    #[serde(default)]
    pub tolerances: Option<FailureMeasures>,
    /// The worst nodes or points of all ranks, worst first.
    pub worst: Vec<Worst>,
    /// The name of the rigid body that nothing holds, where that is the cause.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loose: Option<String>,
    /// What may help.
    pub advice: Vec<String>,
}

/// How far an iteration was from equilibrium, or how far it may be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailureMeasures {
    /// The energy measure.
    pub energy: Option<f64>,
    /// The force measure.
    pub force: Option<f64>,
}

impl FailureMeasures {
    /// Of numbers that may not be finite.
    pub fn new(energy: f64, force: f64) -> Self {
        Self {
            energy: Some(energy).filter(|energy| energy.is_finite()),
            force: Some(force).filter(|force| force.is_finite()),
        }
    }
}

impl FailureReport {
    /// Writes the file into `directory`, replacing an older one in one go.
    ///
    /// # Errors
    /// [`Error::NotFinite`] before anything is written; [`Error::File`] when the system refuses.
    pub fn write(&self, directory: &Path) -> Result<(), Error> {
        let path = directory.join(FAILURE);
        let places = self
            .worst
            .iter()
            .flat_map(|worst| worst.position.iter().copied().chain(worst.force));
        if let Some(value) = places.chain([self.time, self.dt]).find(|number| !number.is_finite()) {
            return Err(Error::NotFinite {
                path,
                item: "failure".into(),
                value,
            });
        }
        atomic::replace(&path, |file| {
            serde_json::to_writer_pretty(file, self).map_err(Into::into)
        })
    }
}
