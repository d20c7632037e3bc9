//! Checkpoints: an HDF5 file with the state of a run, and a record ([`CheckpointRecord`]), which makes the checkpoint
//! valid.

mod find;
mod record;
mod store;

pub use find::{FoundCheckpoint, named, newest};
pub use record::{ArrayNumber, CheckpointRecord, RecordedArray, SCHEMA};
pub use store::{Facts, PendingCheckpoint, Phase, Store, forget_beyond};

use std::path::{Path, PathBuf};

/// Folder of the checkpoints in an output directory.
pub const FOLDER: &str = "checkpoint";

/// Returns the files of the checkpoint of a step, relative to the output directory.
pub fn names(step: u64) -> [String; 2] {
    [".h5", ".json"].map(|ending| format!("{FOLDER}/{}{ending}", stem(step)))
}

/// Returns the number of checkpoints in an output directory, valid or not.
pub fn count(directory: &Path) -> usize {
    steps(&directory.join(FOLDER), ".json").map_or(0, |steps| steps.len())
}

/// Returns the name of a checkpoint without extension.
fn stem(step: u64) -> String {
    format!("step_{step:09}")
}

/// Returns the step in the name of a checkpoint file with this extension.
fn step_of(name: &str, ending: &str) -> Option<u64> {
    let step = name.strip_prefix("step_")?.strip_suffix(ending)?.parse().ok()?;
    (name == format!("{}{ending}", stem(step))).then_some(step)
}

/// Returns the steps of all checkpoint files with this extension in a folder, the newest first.
fn steps(folder: &Path, ending: &str) -> std::io::Result<Vec<u64>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        found.extend(entry?.file_name().to_str().and_then(|name| step_of(name, ending)));
    }
    found.sort_unstable_by(|a, b| b.cmp(a));
    Ok(found)
}

fn file(folder: &Path, step: u64, ending: &str) -> PathBuf {
    folder.join(format!("{}{ending}", stem(step)))
}
