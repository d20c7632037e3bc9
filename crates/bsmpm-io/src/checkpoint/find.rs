//! Finds a checkpoint whose bytes agree with its record.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use rustix::fs::OFlags;

use super::record::CheckpointRecord;
use super::{file, steps};
use crate::Error;

/// Bytes of a record's file beyond which it is none of ours.
const RECORD_LIMIT: u64 = 1 << 20;

/// A checkpoint whose file is what its record says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundCheckpoint {
    /// The file of the arrays.
    pub path: PathBuf,
    /// Its record.
    pub record: CheckpointRecord,
}

/// The newest good checkpoint of a folder, and what is wrong with newer ones; a folder that is not there holds none.
///
/// # Errors
/// [`Error::File`] when the folder cannot be read.
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

/// The checkpoint of that name, by its file or its record.
///
/// # Errors
/// [`Error::Checkpoint`] when either is missing, damaged, or none of ours.
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

/// Opens a plain file, and does not wait where it is a pipe.
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
