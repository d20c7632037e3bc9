//! `failure.json`: why a run could not continue.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::manifest::Worst;
use crate::{Error, atomic};

/// Name of the file.
pub const FAILURE: &str = "failure.json";

/// Data of the failed step. Numbers that are not finite are absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailureReport {
    /// Number of the failed step.
    pub step: u64,
    /// Time of the last converged state, which is saved (s or pseudo-time).
    pub time: f64,
    /// Length of the last attempt (s or pseudo-time).
    pub dt: f64,
    /// Reason why each attempt failed, the first one first.
    pub attempts: Vec<String>,
    /// Convergence measures of every iteration of the last attempt.
    pub history: Vec<FailureMeasures>,
    /// Tolerances of the two measures; none if no iteration was made.
    #[serde(default)]
    pub tolerances: Option<FailureMeasures>,
    /// Nodes or points with the largest residuals over all ranks, the largest first.
    pub worst: Vec<Worst>,
    /// Name of the rigid body that is not restrained, if that is the cause.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loose: Option<String>,
    /// Possible remedies.
    pub advice: Vec<String>,
}

/// Convergence measures of an iteration, or their tolerances.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailureMeasures {
    /// Energy measure.
    pub energy: Option<f64>,
    /// Force measure.
    pub force: Option<f64>,
}

impl FailureMeasures {
    /// Creates the measures; those that are not finite are absent.
    pub fn new(energy: f64, force: f64) -> Self {
        Self {
            energy: Some(energy).filter(|energy| energy.is_finite()),
            force: Some(force).filter(|force| force.is_finite()),
        }
    }
}

impl FailureReport {
    /// Writes the file to `directory`, replacing an older one atomically.
    ///
    /// # Errors
    /// [`Error::NotFinite`] before anything is written; [`Error::File`] for an error of the system.
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
