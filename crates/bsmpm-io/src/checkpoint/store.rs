//! Writes the checkpoints of a run. After a crash at any time, one valid checkpoint remains.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process;

use rustix::fs::{FallocateFlags, fallocate};
use rustix::io::Errno;
use rustix::process::{Resource, getrlimit};

use super::find::{FoundCheckpoint, named};
use super::record::{CheckpointRecord, RecordedArray, SCHEMA};
use super::{FOLDER, file, stem, steps};
use crate::{Error, disk};

/// Start of the names of incomplete files.
const TEMPORARY: &str = ".tmp-";

/// Phases of writing a checkpoint, in order; a crash may occur in each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The file is open and empty.
    Opened,
    /// Some arrays are written.
    Midway,
    /// All arrays are written.
    Written,
    /// The file is closed.
    Closed,
    /// The file is on the disk.
    Synced,
    /// The record is on the disk, under a temporary name.
    Recorded,
    /// The file has its final name, the record does not.
    Named,
    /// Both have their final names: from here on the checkpoint is valid.
    Committed,
    /// The folder is on the disk; older checkpoints are about to be removed.
    Kept,
}

impl Phase {
    /// All phases in order.
    pub const ALL: [Self; 9] = [
        Self::Opened,
        Self::Midway,
        Self::Written,
        Self::Closed,
        Self::Synced,
        Self::Recorded,
        Self::Named,
        Self::Committed,
        Self::Kept,
    ];
}

/// Contents of a record other than size and hash of the file.
#[derive(Clone, Debug)]
pub struct Facts {
    /// Version of the program.
    pub version: String,
    /// BLAKE3 hash of the case's text, in hexadecimal.
    pub case: String,
    /// Number of ranks that write.
    pub ranks: u32,
    /// Number of steps so far.
    pub step: u64,
    /// Time (s or pseudo-time).
    pub time: f64,
}

/// Folder of a run's checkpoints, for the one process that writes there.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    keep: usize,
}

/// Checkpoint that is being written. Its files are removed if it is dropped before it is committed.
#[derive(Debug)]
pub struct PendingCheckpoint {
    step: u64,
    path: PathBuf,
    record: PathBuf,
}

impl Store {
    /// Creates the folder in an output directory if necessary, and removes incomplete files of crashed runs. The newest
    /// `keep` checkpoints will be kept, at least one.
    ///
    /// # Errors
    /// [`Error::File`] for an error of the system.
    pub fn open(directory: &Path, keep: usize) -> Result<Self, Error> {
        let folder = directory.join(FOLDER);
        fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
        for entry in fs::read_dir(&folder).map_err(Error::file("read", &folder))? {
            let entry = entry.map_err(Error::file("read", &folder))?;
            if entry.file_name().to_string_lossy().starts_with(TEMPORARY) {
                fs::remove_file(entry.path()).map_err(Error::file("remove", &entry.path()))?;
            }
        }
        sync(&folder)?;
        sync(directory)?;
        Ok(Self {
            folder,
            keep: keep.max(1),
        })
    }

    /// Returns the path of the folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the valid checkpoint of a step, if there already is one of this case and number of ranks. The record of
    /// any other checkpoint of that step is removed.
    ///
    /// # Errors
    /// [`Error::File`] for an error of the system.
    pub fn existing(&self, facts: &Facts) -> Result<Option<FoundCheckpoint>, Error> {
        let step = facts.step;
        let found = named(&file(&self.folder, step, ".h5"))
            .ok()
            .filter(|found| found.record.case == facts.case && found.record.ranks == facts.ranks);
        if found.is_none() && remove(&file(&self.folder, step, ".json"))? {
            sync(&self.folder)?;
        }
        Ok(found)
    }

    /// Begins the checkpoint of a step: creates an empty file at [`PendingCheckpoint::path`] and reserves `bytes` bytes
    /// for it.
    ///
    /// # Errors
    /// [`Error::Space`] if the disk has less space; [`Error::File`] for another error of the system. Nothing is left
    /// then.
    pub fn begin(&self, step: u64, bytes: u64) -> Result<PendingCheckpoint, Error> {
        let name = format!("{TEMPORARY}{}-{}", process::id(), stem(step));
        let pending = PendingCheckpoint {
            step,
            path: self.folder.join(format!("{name}.h5")),
            record: self.folder.join(format!("{name}.json")),
        };
        File::create(&pending.path).map_err(Error::file("create", &pending.path))?;
        pending.reserve(bytes)?;
        Ok(pending)
    }

    /// Makes a complete and closed file a valid checkpoint, and removes older ones beyond the number to keep. `at` is
    /// called for every phase from [`Phase::Closed`] on.
    ///
    /// # Errors
    /// [`Error::File`] for an error of the system: all earlier checkpoints are then kept.
    pub fn commit(
        &self,
        pending: PendingCheckpoint,
        facts: &Facts,
        arrays: Vec<RecordedArray>,
        at: &dyn Fn(Phase),
    ) -> Result<FoundCheckpoint, Error> {
        at(Phase::Closed);
        let (bytes, blake3) = sync_and_hash(&pending.path).map_err(Error::file("write", &pending.path))?;
        at(Phase::Synced);
        let record = record(facts, arrays, bytes, blake3);
        write_record(&pending.record, &record).map_err(Error::file("write", &pending.record))?;
        at(Phase::Recorded);
        let found = FoundCheckpoint {
            path: file(&self.folder, pending.step, ".h5"),
            record,
        };
        fs::rename(&pending.path, &found.path).map_err(Error::file("write", &found.path))?;
        at(Phase::Named);
        let named = file(&self.folder, pending.step, ".json");
        fs::rename(&pending.record, &named).map_err(Error::file("write", &named))?;
        at(Phase::Committed);
        sync(&self.folder)?;
        at(Phase::Kept);
        // The checkpoint is valid; files that cannot be removed now are removed after the next one.
        let _ = self.purge(pending.step);
        Ok(found)
    }

    /// Returns the steps of the checkpoint files with this extension.
    fn list(&self, ending: &str) -> Result<Vec<u64>, Error> {
        steps(&self.folder, ending).map_err(Error::file("read", &self.folder))
    }

    /// Keeps the checkpoint of `newest` and those before it, as many as configured. Records are removed first: a record
    /// without its file would be a damaged checkpoint, a file without a record is not a checkpoint.
    fn purge(&self, newest: u64) -> Result<(), Error> {
        let older = self.list(".json")?.into_iter().filter(|&step| step <= newest);
        let Some(last) = older.take(self.keep).last() else {
            return Ok(());
        };
        for ending in [".json", ".h5"] {
            for step in self.list(ending)?.into_iter().filter(|&step| step < last) {
                remove(&file(&self.folder, step, ending))?;
            }
            sync(&self.folder)?;
        }
        Ok(())
    }
}

/// Removes all checkpoint files of later steps than `step`, valid or not, records first.
///
/// # Errors
/// [`Error::File`] for an error of the system.
pub fn forget_beyond(directory: &Path, step: u64) -> Result<(), Error> {
    let folder = directory.join(FOLDER);
    for ending in [".json", ".h5"] {
        let there = steps(&folder, ending).map_err(Error::file("read", &folder))?;
        for later in there.into_iter().filter(|&later| later > step) {
            remove(&file(&folder, later, ending))?;
        }
        sync(&folder)?;
    }
    Ok(())
}

impl PendingCheckpoint {
    /// Returns the path of the file to be written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Reserves `needed` bytes on the disk for the file. Otherwise writers on a full disk may crash, or wait for each
    /// other.
    ///
    /// # Errors
    /// [`Error::Space`] if the disk has less space; [`Error::File`] for another error of the system.
    pub fn reserve(&self, needed: u64) -> Result<(), Error> {
        // Beyond this limit the system would end the process instead of returning an error.
        if let Some(limit) = getrlimit(Resource::Fsize).current.filter(|&limit| limit < needed) {
            return Err(self.lacks(needed, format!("the system limits files to {limit} bytes")));
        }
        let file = File::options()
            .write(true)
            .open(&self.path)
            .map_err(Error::file("open", &self.path))?;
        match fallocate(&file, FallocateFlags::empty(), 0, needed) {
            // Not every file system can reserve space.
            Ok(()) | Err(Errno::OPNOTSUPP | Errno::NOSYS) => Ok(()),
            Err(Errno::NOSPC | Errno::DQUOT | Errno::FBIG) => Err(self.lacks(needed, free(&self.path))),
            Err(error) => Err(Error::file("write", &self.path)(error.into())),
        }
    }

    /// Returns the error for a disk with less space than needed.
    fn lacks(&self, needed: u64, available: String) -> Error {
        Error::Space {
            path: self.path.clone(),
            needed,
            available,
        }
    }
}

impl Drop for PendingCheckpoint {
    fn drop(&mut self) {
        // A committed checkpoint has other names.
        let _ = fs::remove_file(&self.path);
        let _ = fs::remove_file(&self.record);
    }
}

fn free(path: &Path) -> String {
    let folder = path.parent().unwrap_or(path);
    disk::free(folder).map_or_else(
        |_| "the disk has less".into(),
        |bytes| format!("the disk has {bytes} bytes left"),
    )
}

fn record(facts: &Facts, arrays: Vec<RecordedArray>, bytes: u64, blake3: String) -> CheckpointRecord {
    let Facts {
        version,
        case,
        ranks,
        step,
        time,
    } = facts.clone();
    CheckpointRecord {
        schema: SCHEMA,
        version,
        step,
        time_bits: time.to_bits(),
        case,
        ranks,
        bytes,
        blake3,
        arrays,
    }
}

fn sync_and_hash(path: &Path) -> io::Result<(u64, String)> {
    let file = File::open(path)?;
    file.sync_all()?;
    let mut hasher = blake3::Hasher::new();
    let bytes = hasher.update_reader(file)?.count();
    Ok((bytes, hasher.finalize().to_hex().to_string()))
}

fn write_record(path: &Path, record: &CheckpointRecord) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(record.text()?.as_bytes())?;
    file.sync_all()
}

fn sync(folder: &Path) -> Result<(), Error> {
    File::open(folder)
        .and_then(|folder| folder.sync_all())
        .map_err(Error::file("write", folder))
}

/// Removes a file; returns whether it existed.
fn remove(path: &Path) -> Result<bool, Error> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        removed => removed.map(|()| true).map_err(Error::file("remove", path)),
    }
}
