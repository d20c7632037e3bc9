//! An error on which all ranks have agreed.

use bsmpm_io::exit::CHECKPOINT;
use mpi::collective::{CommunicatorCollectives, Root};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::fmt::{Display, Formatter};
use std::path::Path;

/// Why something was not done, the same on every rank.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The exit code that it means.
    pub code: u8,
    /// The file and the reason.
    pub reason: String,
}

impl Display for Refusal {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        out.write_str(&self.reason)
    }
}

impl From<bsmpm_io::Error> for Refusal {
    fn from(error: bsmpm_io::Error) -> Self {
        Self {
            code: error.exit_code(),
            reason: error.to_string(),
        }
    }
}

impl Refusal {
    /// That of a checkpoint that is not one of this case, or damaged.
    pub(crate) fn unusable(path: &Path, reason: &str) -> Self {
        let path = path.display();
        let reason = format!(
            "E0720: checkpoint `{path}` cannot be used: {reason}. The run was not continued. Name another checkpoint \
             with `--restart FILE`, or start again with `--force`."
        );
        Self::new(CHECKPOINT, reason)
    }

    pub(crate) fn new(code: u8, reason: impl Into<String>) -> Self {
        Self {
            code,
            reason: reason.into(),
        }
    }
}

/// The outcome of this rank where all are good, else the refusal of the first rank that has one. Collective.
pub(crate) fn agree<T>(world: &SimpleCommunicator, mine: Result<T, Refusal>) -> Result<T, Refusal> {
    let own = mine.as_ref().err().map_or(0, |refusal| refusal.code.max(1));
    let mut codes = vec![0_u8; world.size().unsigned_abs() as usize];
    world.all_gather_into(&own, &mut codes[..]);
    let Some(first) = codes.iter().position(|&code| code > 0) else {
        return mine;
    };
    let text = mine.err().map_or_else(Vec::new, |refusal| refusal.reason.into_bytes());
    let reason = broadcast(world, first, text);
    Err(Refusal::new(codes[first], String::from_utf8_lossy(&reason)))
}

/// The bytes of one rank on all. Collective.
pub(crate) fn broadcast(world: &SimpleCommunicator, from: usize, mut bytes: Vec<u8>) -> Vec<u8> {
    let root = world.process_at_rank(from as i32);
    let mut size = bytes.len() as u64;
    root.broadcast_into(&mut size);
    bytes.resize(size as usize, 0);
    // The address of an empty Vec<u8> is 1, which Open MPI reads as MPI_IN_PLACE.
    if size > 0 {
        root.broadcast_into(&mut bytes[..]);
    }
    bytes
}
