//! Parts of the manifest.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::Error;

/// State of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The run is running, or was killed.
    Running,
    /// The end of the case was reached.
    Finished,
    /// The run was stopped on request before the end.
    Stopped,
    /// The run could not continue, or a check failed.
    Failed,
}

/// Case that was computed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestCase {
    /// Name of the case file, without folders.
    pub file: String,
    /// Title of the case.
    pub title: String,
    /// `plane-strain`, `axisymmetric` or `solid`.
    pub geometry: String,
    /// Text of the case, with overrides applied.
    pub text: String,
    /// BLAKE3 hash of `text`, in hexadecimal.
    pub blake3: String,
}

impl ManifestCase {
    /// Creates the entry with the hash of the text.
    pub fn new(file: &str, title: &str, geometry: &str, text: String) -> Self {
        let blake3 = blake3::hash(text.as_bytes()).to_hex().to_string();
        Self {
            file: file.to_owned(),
            title: title.to_owned(),
            geometry: geometry.to_owned(),
            text,
            blake3,
        }
    }
}

/// Extent of the grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GridExtent {
    /// Lower corner (m).
    pub lower: Vec<f64>,
    /// Upper corner (m).
    pub upper: Vec<f64>,
    /// Largest size of a cell along each axis (m).
    pub cell: Vec<f64>,
}

impl GridExtent {
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        [&self.lower, &self.upper, &self.cell].into_iter().flatten().copied()
    }
}

/// Value that the program chose.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestChoice {
    /// Key of the case file.
    pub key: String,
    /// Chosen value.
    pub value: String,
    /// Reason.
    pub reason: String,
}

/// Limit load: the load at which the ground fails under a moved footing or body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestLimitLoad {
    /// Name of the moved footing or body.
    pub name: String,
    /// Columns of `history.csv` whose sum is the load, with their weights.
    pub columns: Vec<(String, f64)>,
    /// Unit of the columns.
    pub unit: String,
    /// Value at the end of the run.
    pub value: f64,
    /// (value - value at three quarters of the displacement) / value.
    pub change: f64,
    /// Whether the value is a limit: positive, and with a change of at most 1 %.
    pub is_reached: bool,
    /// Number of cells across the moved object; none if it has no width of its own.
    pub cells: Option<f64>,
    /// Fraction of the moved object that is modelled: 1/2 or 1/4 at planes of symmetry.
    pub modelled: f64,
    /// Factor by which Young's moduli were multiplied and prescribed displacements divided.
    pub stiffness: f64,
}

impl ManifestLimitLoad {
    /// Returns a text with the modelled fraction of a force; empty for a pressure or the whole.
    pub fn part(&self) -> String {
        let is_force = !self.unit.ends_with("Pa");
        match is_force && self.modelled < 1.0 {
            true => format!(
                " (the modelled {} of it)",
                if self.modelled < 0.5 { "quarter" } else { "half" }
            ),
            false => String::new(),
        }
    }
}

/// Equilibrium of the initial state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestInitial {
    /// |out-of-balance force| / largest force (-).
    pub unbalance: f64,
    /// Number of points whose stress is outside the yield surface.
    pub yielding: u64,
    /// Effort of the iteration to equilibrium, if the case requests it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settling: Option<ManifestSettling>,
}

/// Totals of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Accepted steps.
    pub steps: u64,
    /// Nonlinear iterations.
    pub iterations: u64,
    /// Iterations of the linear solver.
    pub linear_iterations: u64,
    /// Step size reductions.
    pub cutbacks: u64,
    /// Evaluations of the out-of-balance force.
    pub residual_evaluations: u64,
    /// Products with the complete derivative (Jacobian) in Newton's method.
    #[serde(default)]
    pub products: u64,
    /// Factorisations.
    #[serde(default)]
    pub factorisations: u64,
    /// Steps in which Newton's method converged.
    #[serde(default)]
    pub newton_steps: u64,
    /// Steps accepted by their forces alone: these were balanced ten times better than required, but no method made
    /// further progress, and the energy criterion was not satisfied.
    #[serde(default)]
    pub settled_steps: u64,
    /// Largest displacement of a point in a step (m); none before the first step.
    #[serde(default)]
    pub largest_advance: Option<f64>,
    /// Largest penetration of a material point into a rigid body after a step, in cells; none without rigid bodies.
    #[serde(default)]
    pub deepest_penetration: Option<f64>,
    /// Largest slip of a rigid footing in a step divided by its displacement; none without moving footings.
    #[serde(default)]
    pub largest_slip: Option<f64>,
    /// Largest accumulated slip of a rigid footing, moving or not (m); none without footings.
    #[serde(default)]
    pub largest_accumulated_slip: Option<f64>,
    /// Largest ratio of the force measure to its tolerance in the states accepted by both measures; none without such a
    /// state.
    #[serde(default)]
    pub largest_force_measure: Option<f64>,
    /// The same ratio for the energy measure.
    #[serde(default)]
    pub largest_energy_measure: Option<f64>,
    /// The same ratio for the measure of the pore water, with transient seepage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_water_measure: Option<f64>,
    /// Largest reaction of a boundary on the body (N); none without supports.
    #[serde(default)]
    pub largest_reaction: Option<f64>,
    /// Largest tensile reaction of a boundary on the body (N); none without supports.
    #[serde(default)]
    pub largest_pull: Option<f64>,
    /// Farthest run-out front (m); none if it is not recorded.
    #[serde(default)]
    pub farthest_front: Option<f64>,
    /// Largest distance by which the front moved back behind its farthest position so far (m); none if it is not
    /// recorded.
    #[serde(default)]
    pub largest_front_setback: Option<f64>,
    /// Work done on the artificial stiffness (`solver.background`) in all steps (J); none without one.
    #[serde(default)]
    pub background_work: Option<f64>,
    /// Absolute works of the internal forces at all nodes, including the artificial stiffness, added over the steps
    /// (J); none without an artificial stiffness.
    #[serde(default)]
    pub internal_work: Option<f64>,
    /// Largest force of the artificial stiffness on a node divided by the RMS force of the nodes, added over the steps
    /// without prescribed motion; none without an artificial stiffness or such steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background_forces: Option<f64>,
    /// Share of the artificial stiffness in the work of the last step; none without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last_background: Option<BackgroundShares>,
    /// Largest displacement of a point in a step, added over the steps (m); none if the stiffness is not judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub advances: Option<f64>,
    /// The same sum since the start of the last stage (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage_advances: Option<f64>,
    /// Largest ratio of the second-order work of elastic ground to the actual one, over the judged steps; none without
    /// such steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_stiffness_loss: Option<f64>,
    /// End of the first step in which this ratio was beyond its usual range (s or pseudo-time); none if there was no
    /// such step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed_at: Option<f64>,
    /// Kinetic energy, in excess of that of their displacement, of points within a cell of a fixed boundary, added over
    /// the steps (J); none in statics and without such a boundary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beside_fixed: Option<f64>,
    /// Kinetic energy of all points, added over the same steps (J).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinetic: Option<f64>,
    /// Number of smoothing passes of the elastic state, each weighted with its mean fraction of the points; none
    /// without smoothing.
    #[serde(default)]
    pub smoothing_passes: Option<f64>,
    /// Processor time of all ranks together (s).
    pub cpu_seconds: f64,
    /// Largest resident memory of each rank (bytes).
    pub peak_memory: Vec<u64>,
}

/// Share of the artificial stiffness in a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BackgroundShares {
    /// Work done on the artificial stiffness, divided by the absolute works of all internal forces, or by their mean
    /// over the steps so far if that is larger.
    pub work: f64,
}

/// Traffic of one kind between the ranks over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Communication {
    /// Exchanges or reductions in which every rank took part.
    pub calls: u64,
    /// Messages to other ranks, in total over all ranks; a reduction counts none.
    pub messages: u64,
    /// Bytes of these messages; for reductions, of the numbers that each rank contributes.
    pub bytes: u64,
    /// Messages of the rank that sent the most.
    pub most_messages: u64,
    /// Bytes of the rank that sent the most.
    pub most_bytes: u64,
}

/// Solver of one kind of linear system, and the outcomes of its solves.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolverNames {
    /// KSPType of PETSc, in the last program run.
    pub ksp: String,
    /// PCType of PETSc; for a shell with its name, as in `shell (dissection)`.
    pub pc: String,
    /// Number of solves by KSPConvergedReason over the run; `ERROR` for solves without a result.
    pub reasons: BTreeMap<String, u64>,
}

/// Load balance of the ranks over the steps (not a balance of energy).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBalance {
    /// Number of counted steps.
    pub steps: u64,
    /// Mean over these steps of the largest load divided by the mean load.
    pub mean: f64,
    /// Largest such ratio.
    pub largest: f64,
    /// Number of new partitions of the grid.
    pub cuts: u64,
}

impl EnergyBalance {
    /// Counts one more step.
    pub fn enter(&mut self, imbalance: f64, is_cut_again: bool) {
        self.steps += 1;
        self.mean += (imbalance - self.mean) / self.steps as f64;
        self.largest = self.largest.max(imbalance);
        self.cuts += u64::from(is_cut_again);
    }
}

/// A `[[check]]` of the case and its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestCheck {
    /// Checked quantity.
    pub quantity: String,
    /// Time of the check (s or pseudo-time); none for the end.
    pub at: Option<f64>,
    /// Value; none if the run did not reach that time.
    pub value: Option<f64>,
    /// Smallest value that passes.
    pub min: Option<f64>,
    /// Largest value that passes.
    pub max: Option<f64>,
    /// Whether the check passed.
    pub passed: bool,
}

/// File that the run wrote.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestOutput {
    /// Path relative to the output directory, with `/` as separator.
    pub path: String,
    /// Size in bytes, once it is complete.
    pub bytes: Option<u64>,
    /// BLAKE3 hash in hexadecimal, once it is complete.
    pub blake3: Option<String>,
}

impl ManifestOutput {
    pub(super) fn seal(&mut self, directory: &Path) -> Result<(), Error> {
        let size = fs::metadata(directory.join(&self.path)).ok().map(|found| found.len());
        if self.blake3.is_some() && size.is_some() && size == self.bytes {
            return Ok(());
        }
        self.complete(directory)
    }

    pub(crate) fn complete(&mut self, directory: &Path) -> Result<(), Error> {
        let path = directory.join(&self.path);
        let mut hasher = blake3::Hasher::new();
        let hashed = File::open(&path).and_then(|file| hasher.update_reader(file).map(|hashed| hashed.count()));
        (self.bytes, self.blake3) = match hashed {
            Ok(bytes) => (Some(bytes), Some(hasher.finalize().to_hex().to_string())),
            Err(error) if error.kind() == ErrorKind::NotFound => (None, None),
            Err(error) => return Err(Error::file("read", &path)(error)),
        };
        Ok(())
    }
}

/// Effort of the iteration to equilibrium before the first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestSettling {
    /// Number of equilibria that were computed; 0 if the stress was in equilibrium already.
    pub rounds: usize,
    /// Number of evaluations of the forces.
    pub evaluations: usize,
}

/// Changes of a stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestStage {
    /// Name in the case.
    pub name: Option<String>,
    /// Number of steps before the stage.
    pub step: u64,
    /// Start of the stage (s; quasi-static: pseudo-time).
    pub time: f64,
    /// Number of removed points.
    pub removed: u64,
    /// Number of added points.
    pub added: u64,
    /// Names of loads and supports that act from this stage on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub applied: Vec<String>,
    /// Names of loads and supports that no longer act.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub released: Vec<String>,
    /// Boundaries of the grid that changed, with their new type.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<String>,
    /// Materials whose bodies change to the law of another material, in words.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exchanged: Vec<String>,
    /// New divisor of the strength given in the case, if it changed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength_reduction: Option<f64>,
    /// Whether displacements are set to zero at the start of the stage.
    pub reset: bool,
}

/// Material that has left the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestOutflow {
    /// Number of points.
    pub points: u64,
    /// Mass (kg/m).
    pub mass: f64,
}

/// Restart of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestRestart {
    /// File of the checkpoint.
    pub checkpoint: String,
    /// Number of steps before the restart.
    pub step: u64,
    /// Number of processes that wrote the checkpoint.
    pub ranks_before: u32,
    /// Number of processes after the restart.
    pub ranks: u32,
    /// Time of the restart, RFC 3339 in UTC.
    pub start: String,
    /// Keys of the case that had changed, with both values.
    pub changed: Vec<String>,
}

/// Reason why a run ended early.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestFailure {
    /// Number of the failed step.
    pub step: u64,
    /// Start of the failed step (s or pseudo-time).
    pub time: f64,
    /// Reason, in words.
    pub reason: String,
    /// Energy measure of each iteration of the last attempt; none if it was not finite.
    pub residuals: Vec<Option<f64>>,
    /// Point or node with the largest residual.
    pub worst: Option<Worst>,
    /// Name of the rigid body that is not restrained, if that is the cause.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loose: Option<String>,
}

impl ManifestFailure {
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        let place = self
            .worst
            .iter()
            .flat_map(|worst| worst.position.iter().copied().chain(worst.force));
        self.residuals.iter().copied().flatten().chain(place).chain([self.time])
    }
}

/// Point or node with the largest residual in a failed step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// `point` or `node`.
    pub kind: String,
    /// Number of the point or node.
    pub id: u64,
    /// Position (m).
    pub position: Vec<f64>,
    /// Out-of-balance force of a node (N).
    #[serde(default)]
    pub force: Option<f64>,
}
