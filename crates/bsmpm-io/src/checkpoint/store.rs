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

/// How the names of files begin that are not complete.
const TEMPORARY: &str = ".tmp-";

/// Where a crash may strike while a checkpoint is written, in this order.
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
    /// It is on the disk.
    Synced,
    /// So is its record, still under a temporary name.
    Recorded,
    /// The file has its name, the record not yet.
    Named,
    /// Both have their names: from here on the checkpoint counts.
    Committed,
    /// The folder is on the disk; older checkpoints are about to be removed.
    Kept,
}

impl Phase {
    /// All of them, in order.
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

/// What a record says beside the size and hash of the file.
#[derive(Clone, Debug)]
pub struct Facts {
    /// The version of the program.
    pub version: String,
    /// BLAKE3 of the case's text, in hexadecimal.
    pub case: String,
    /// Ranks that write.
    pub ranks: u32,
    /// Steps that were made.
    pub step: u64,
    /// s or pseudo-time  that was reached.
    pub time: f64,
}

/// The folder of a run's checkpoints, for the one process that writes there.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    keep: usize,
}

/// A checkpoint that is being written. What there is of it goes when this is dropped before it was committed.
#[derive(Debug)]
pub struct PendingCheckpoint {
    step: u64,
    path: PathBuf,
    record: PathBuf,
}

impl Store {
    /// Makes the folder in an output directory if need be, and removes what crashed writers left there. The newest
    /// `keep` checkpoints will be kept, one at least.
    ///
    /// # Errors
    /// [`Error::File`] when the system refuses.
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

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The good checkpoint of a step, if there is one of this case and as many ranks already; another one of that step
    /// is taken out of the way.
    ///
    /// # Errors
    /// [`Error::File`] when the system refuses.
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

    /// Begins the checkpoint of a step: an empty file at [`PendingCheckpoint::path`], on a disk that has room for so
    /// many bytes.
    ///
    /// # Errors
    /// [`Error::Space`] where it has not; [`Error::File`] when the system refuses otherwise. Nothing is left then.
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

    /// Makes a complete and closed file a checkpoint, and removes those beyond the newest few. `at` is called for every
    /// phase from [`Phase::Closed`] on.
    ///
    /// # Errors
    /// [`Error::File`] when the system refuses: the checkpoints of before are all there.
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
        // The checkpoint is good: what could not be removed now is removed after the next one.
        let _ = self.purge(pending.step);
        Ok(found)
    }

    /// The steps of the files that end so.
    fn list(&self, ending: &str) -> Result<Vec<u64>, Error> {
        steps(&self.folder, ending).map_err(Error::file("read", &self.folder))
    }

    /// Keeps the checkpoint of `newest` and those before it, as many as wanted. Records go first: one without its file
    /// would be a damaged checkpoint, a file without its record is none.
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

/// Removes what is named like a checkpoint of a later step than this one, good or not: records first.
///
/// # Errors
/// [`Error::File`] when the system refuses.
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
    /// The file that is to be filled.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Takes room on the disk for a file of so many bytes: writers that find none may crash, or wait for each other.
    ///
    /// # Errors
    /// [`Error::Space`] where there is none; [`Error::File`] when the system refuses otherwise.
    pub fn reserve(&self, needed: u64) -> Result<(), Error> {
        // Beyond the limit the system would not refuse but end the process.
        if let Some(limit) = getrlimit(Resource::Fsize).current.filter(|&limit| limit < needed) {
            return Err(self.lacks(needed, format!("the system limits files to {limit} bytes")));
        }
        let file = File::options()
            .write(true)
            .open(&self.path)
            .map_err(Error::file("open", &self.path))?;
        match fallocate(&file, FallocateFlags::empty(), 0, needed) {
            // Not every file system can promise room.
            Ok(()) | Err(Errno::OPNOTSUPP | Errno::NOSYS) => Ok(()),
            Err(Errno::NOSPC | Errno::DQUOT | Errno::FBIG) => Err(self.lacks(needed, free(&self.path))),
            Err(error) => Err(Error::file("write", &self.path)(error.into())),
        }
    }

    /// The error of a disk on which less is `available` than is needed.
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
        // What was committed has other names by now.
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

/// Whether there was a file to be removed.
fn remove(path: &Path) -> Result<bool, Error> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        removed => removed.map(|()| true).map_err(Error::file("remove", path)),
    }
}
