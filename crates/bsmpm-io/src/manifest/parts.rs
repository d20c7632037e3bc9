//! Parts of the manifest.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::Error;

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It goes on, or was killed.
    Running,
    /// It came to the end of the case.
    Finished,
    /// It was asked to stop before the end.
    Stopped,
    /// It could not go on, or a check failed.
    Failed,
}

/// What was solved.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestCase {
    /// The case file's name, without folders.
    pub file: String,
    /// The case's title.
    pub title: String,
    /// `plane-strain`, `axisymmetric` or `solid`.
    pub geometry: String,
    /// The text that took effect, overrides included.
    pub text: String,
    /// BLAKE3 of `text`, in hexadecimal.
    pub blake3: String,
}

impl ManifestCase {
    /// A case with the hash of its text.
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

/// The box of the grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GridExtent {
    /// m  its lowest corner.
    pub lower: Vec<f64>,
    /// m  its highest corner.
    pub upper: Vec<f64>,
    /// m  the largest size of a cell along each axis.
    pub cell: Vec<f64>,
}

impl GridExtent {
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        [&self.lower, &self.upper, &self.cell].into_iter().flatten().copied()
    }
}

/// A quantity that the program chose by itself.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestChoice {
    /// The key of the case file.
    pub key: String,
    /// What it became.
    pub value: String,
    /// Why.
    pub reason: String,
}

/// The load under which the ground fails at something that is moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestLimitLoad {
    /// What is moved.
    pub name: String,
    /// Columns of `history.csv` that it is the sum of, with the weights of each.
    pub columns: Vec<(String, f64)>,
    /// Unit of the columns.
    pub unit: String,
    /// At the end of the run.
    pub value: f64,
    /// (value - value at three quarters of the displacement) / value.
    pub change: f64,
    /// Whether the value is a limit: positive, and with a change of at most 1 %.
    pub is_reached: bool,
    /// Cells across what is moved; none where it has no width of its own.
    pub cells: Option<f64>,
    /// Part of what is moved that is modelled: one half or one quarter at planes of symmetry.
    pub modelled: f64,
    /// Young's moduli were multiplied, and prescribed displacements divided, by this factor.
    pub stiffness: f64,
}

impl ManifestLimitLoad {
    /// Which part of the whole a force is of, in words; nothing of a pressure, or of the whole.
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

/// How the state at the start was balanced.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestInitial {
    /// |out-of-balance force| / largest force
    pub unbalance: f64,
    /// Points whose stress lies outside the yield surface.
    pub yielding: u64,
    /// What leading it to equilibrium took, if the case wants that.
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
    /// Steps that were cut.
    pub cutbacks: u64,
    /// Evaluations of the out-of-balance force.
    pub residual_evaluations: u64,
    /// Products with the complete derivative, in Newton's method.
    #[serde(default)]
    pub products: u64,
    /// Factorisations.
    #[serde(default)]
    pub factorisations: u64,
    /// Steps in which Newton's method found equilibrium.
    #[serde(default)]
    pub newton_steps: u64,
    /// Steps whose forces alone decided: they balanced ten times better than asked, where no method led on and the
    /// energy measure did not hold.
    #[serde(default)]
    pub settled_steps: u64,
    /// m  the farthest that a point moved in a step; none before the first one.
    #[serde(default)]
    pub largest_advance: Option<f64>,
    /// The deepest that a material point was in a rigid body after a step, in cells; none without rigid bodies.
    #[serde(default)]
    pub deepest_penetration: Option<f64>,
    /// Largest slip of any rigid strip in a step, over its motion in that step; none without strips that move.
    #[serde(default)]
    pub largest_slip: Option<f64>,
    /// m  largest slip of any rigid strip in all steps together, also of strips that do not move; none without strips.
    #[serde(default)]
    pub largest_accumulated_slip: Option<f64>,
    /// Largest force measure of a state that was accepted by both measures, over its tolerance; none while there is no
    /// such state.
    #[serde(default)]
    pub largest_force_measure: Option<f64>,
    /// The same of the energy measure.
    #[serde(default)]
    pub largest_energy_measure: Option<f64>,
    /// The same of the measure of the water, where some flows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_water_measure: Option<f64>,
    /// N  largest force of a face's support on the body; none without supports.
    #[serde(default)]
    pub largest_reaction: Option<f64>,
    /// N  largest force with which a face's support has pulled the body towards itself; none without supports.
    #[serde(default)]
    pub largest_pull: Option<f64>,
    /// m  the farthest front of the body; none where it is not recorded.
    #[serde(default)]
    pub farthest_front: Option<f64>,
    /// m  the farthest that the front went back behind the farthest one before; none where it is not recorded.
    #[serde(default)]
    pub largest_front_setback: Option<f64>,
    /// J  work done on the soft background in all steps; none without one.
    #[serde(default)]
    pub background_work: Option<f64>,
    /// J  magnitudes of the works of the internal forces at all nodes, the background's among them, added over the
    /// steps; none without a background.
    #[serde(default)]
    pub internal_work: Option<f64>,
    /// Largest force of the soft background on a node over the RMS force of the nodes, added over the steps without
    /// prescribed motion; none without a background or such steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background_forces: Option<f64>,
    /// Part of the work that the soft background took in the last step; none without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last_background: Option<BackgroundShares>,
    /// m  the farthest that a point moved in a step, added over the steps; none where stiffness is not judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub advances: Option<f64>,
    /// m  the same since the last stage began.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage_advances: Option<f64>,
    /// Second-order work of elastic ground over the actual one, largest of the steps that are judged; none without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_stiffness_loss: Option<f64>,
    /// s or pseudo-time  end of the first step in which that was beyond its usual range; none while there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed_at: Option<f64>,
    /// J  kinetic energy that points within a cell of a fixed face have beyond that of their motion, added over the
    /// steps; none in statics, and without such a face.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beside_fixed: Option<f64>,
    /// J  kinetic energy of all points, added over the same steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinetic: Option<f64>,
    /// Passes of smoothing of the elastic state, each counted by the mean share of the points that it had; none
    /// without.
    #[serde(default)]
    pub smoothing_passes: Option<f64>,
    /// s  of processor time, all ranks together.
    pub cpu_seconds: f64,
    /// bytes  the largest resident memory of each rank.
    pub peak_memory: Vec<u64>,
}

/// What the soft background takes in a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BackgroundShares {
    /// Work done on it over the magnitudes of the works of all internal forces, or over their mean of the steps so far
    /// where that is larger.
    pub work: f64,
}

/// What the ranks sent each other in one way, over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Communication {
    /// Exchanges or reductions that every rank took part in.
    pub calls: u64,
    /// Messages to another rank, of all ranks; a reduction counts none.
    pub messages: u64,
    /// Bytes of them; of reductions, those of the numbers that every rank puts in.
    pub bytes: u64,
    /// Messages of the rank that sent the most.
    pub most_messages: u64,
    /// Bytes of the rank that sent the most.
    pub most_bytes: u64,
}

/// What solved a kind of linear systems, and how its solves ended.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolverNames {
    /// KSPType of PETSc, of the program that ran last.
    pub ksp: String,
    /// PCType of PETSc; of a shell its name, too, as in `shell (dissection)`.
    pub pc: String,
    /// Solves by the name of their KSPConvergedReason, over the run; `ERROR` of those that came to none.
    pub reasons: BTreeMap<String, u64>,
}

/// How evenly the work lay on the ranks, over the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBalance {
    /// Steps that are counted.
    pub steps: u64,
    /// Mean over them of the largest load over the mean load.
    pub mean: f64,
    /// The largest of them.
    pub largest: f64,
    /// How often the grid was cut again.
    pub cuts: u64,
}

impl EnergyBalance {
    /// Counts one step more.
    pub fn enter(&mut self, imbalance: f64, is_cut_again: bool) {
        self.steps += 1;
        self.mean += (imbalance - self.mean) / self.steps as f64;
        self.largest = self.largest.max(imbalance);
        self.cuts += u64::from(is_cut_again);
    }
}

/// One `[[check]]` of the case and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestCheck {
    /// What was looked at.
    pub quantity: String,
    /// s or pseudo-time  when; none for the end.
    pub at: Option<f64>,
    /// What it was; none if the run did not get there.
    pub value: Option<f64>,
    /// The least that passes.
    pub min: Option<f64>,
    /// The most that passes.
    pub max: Option<f64>,
    /// Whether it passed.
    pub passed: bool,
}

/// A file that the run wrote.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestOutput {
    /// Its place relative to the output directory, with `/` between its parts.
    pub path: String,
    /// Its size, once it is complete.
    pub bytes: Option<u64>,
    /// Its BLAKE3 in hexadecimal, once it is complete.
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

/// The way to equilibrium before the first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestSettling {
    /// Equilibria that were found on it; none where the stress was in equilibrium already.
    pub rounds: usize,
    /// Evaluations of the forces.
    pub evaluations: usize,
}

/// What a stage has changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestStage {
    /// What the case calls it.
    pub name: Option<String>,
    /// Steps that were made before.
    pub step: u64,
    /// s (quasi-static: pseudo-time)  when it began.
    pub time: f64,
    /// Points that it took away.
    pub removed: u64,
    /// Points that it placed.
    pub added: u64,
    /// Names of loads and supports that act from there on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub applied: Vec<String>,
    /// Those that no longer do.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub released: Vec<String>,
    /// Faces of the grid that changed, and what they are from there on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<String>,
    /// Materials whose bodies follow the law of another one, in words.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exchanged: Vec<String>,
    /// What the strength that the case gives is divided by from there on, if that changed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength_reduction: Option<f64>,
    /// Whether displacements count from there.
    pub reset: bool,
}

/// Material that has left the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestOutflow {
    /// Points.
    pub points: u64,
    /// kg/m
    pub mass: f64,
}

/// Where and how a run went on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestRestart {
    /// The checkpoint's file.
    pub checkpoint: String,
    /// Steps that were made before.
    pub step: u64,
    /// Processes that wrote it.
    pub ranks_before: u32,
    /// Processes that went on.
    pub ranks: u32,
    /// When, RFC 3339 in UTC.
    pub start: String,
    /// Keys of the case that had changed, with both values.
    pub changed: Vec<String>,
}

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestFailure {
    /// The step that failed.
    pub step: u64,
    /// s or pseudo-time  at its start.
    pub time: f64,
    /// What happened, in words.
    pub reason: String,
    /// The energy measure of each iteration of the last attempt; none where it was not finite.
    pub residuals: Vec<Option<f64>>,
    /// Where it was worst.
    pub worst: Option<Worst>,
    /// The name of the rigid body that nothing holds, where that is the cause.
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

/// The point or node that was worst in a failed step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// `point` or `node`.
    pub kind: String,
    /// Its number.
    pub id: u64,
    /// m  where it was.
    pub position: Vec<f64>,
    /// N  out of balance there, of a node.
    #[serde(default)]
    pub force: Option<f64>,
}
