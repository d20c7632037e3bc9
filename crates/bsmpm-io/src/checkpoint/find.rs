//! Finds a checkpoint whose bytes agree with its record.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use rustix::fs::OFlags;

use super::record::CheckpointRecord;
use super::{file, steps};
use crate::Error;

/// Largest size of a record's file (bytes).
const RECORD_LIMIT: u64 = 1 << 20;

/// Checkpoint whose file agrees with its record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundCheckpoint {
    /// File of the arrays.
    pub path: PathBuf,
    /// Record of the checkpoint.
    pub record: CheckpointRecord,
}

/// Returns the newest valid checkpoint of a folder, and the errors of newer invalid ones. A missing folder has no
/// checkpoints.
///
/// # Errors
/// [`Error::File`] if the folder cannot be read.
pub fn newest(folder: &Path) -> Result<(Option<FoundCheckpoint>, Vec<Error>), Error> {
    let mut damaged = Vec::new();
    let steps = match steps(folder, ".json") {
        Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
        steps => steps.map_err(Error::file("read", folder))?,
    };
    for step in steps {
        match named(&file(folder, step, ".h5")) {
            Ok(found) => return Ok((Some(found), damaged)),
            Err(error) => damaged.push(error),
        }
    }
    Ok((None, damaged))
}

/// Returns the checkpoint with the given name, of its file or of its record.
///
/// # Errors
/// [`Error::Checkpoint`] if either file is missing, damaged, or was not written by this program.
pub fn named(path: &Path) -> Result<FoundCheckpoint, Error> {
    let arrays = path.with_extension("h5");
    let record = path.with_extension("json");
    let mut bytes = Vec::new();
    let (source, size) = open(&record)?;
    if size > RECORD_LIMIT {
        return Err(Error::checkpoint(
            &record,
            format!("its {size} bytes are not the record of a checkpoint"),
        ));
    }
    source
        .take(RECORD_LIMIT)
        .read_to_end(&mut bytes)
        .map_err(|error| unreadable(&record, &error))?;
    let record = CheckpointRecord::parse(&record, &bytes)?;
    verify(&arrays, &record)?;
    Ok(FoundCheckpoint { path: arrays, record })
}

fn verify(path: &Path, record: &CheckpointRecord) -> Result<(), Error> {
    let (source, size) = open(path)?;
    if size != record.bytes {
        return Err(Error::checkpoint(
            path,
            format!("it has {size} bytes instead of {}", record.bytes),
        ));
    }
    let mut hasher = blake3::Hasher::new();
    hasher
        .update_reader(source.take(size))
        .map_err(|error| unreadable(path, &error))?;
    let found = hasher.finalize().to_hex();
    if found.as_str() != record.blake3 {
        return Err(Error::checkpoint(
            path,
            "it is damaged (its checksum is not that of its record)",
        ));
    }
    Ok(())
}

/// Opens a regular file, without waiting if the path is a pipe.
fn open(path: &Path) -> Result<(File, u64), Error> {
    let flags = OFlags::NONBLOCK.bits() as i32;
    let opened = OpenOptions::new().read(true).custom_flags(flags).open(path);
    let (file, found) = opened
        .and_then(|file| file.metadata().map(|found| (file, found)))
        .map_err(|error| unreadable(path, &error))?;
    if found.is_file() {
        Ok((file, found.len()))
    } else {
        Err(Error::checkpoint(path, "it is not a plain file"))
    }
}

fn unreadable(path: &Path, error: &std::io::Error) -> Error {
    Error::checkpoint(path, error.to_string())
}
