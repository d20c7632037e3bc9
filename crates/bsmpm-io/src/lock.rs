//! The file `.lock`, which reserves an output directory for one process. The lock of a process that no longer exists is
//! replaced.

mod holder;

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, TryLockError};
use std::thread::sleep;
use std::time::Duration;

use crate::{Error, atomic};
use holder::{Fate, Holder};

/// Name of the file.
pub const LOCK: &str = ".lock";
/// File that exists while a lock is taken over.
const TAKEOVER: &str = ".lock.takeover";
/// Number of attempts, and pause between them, to read a file that another program is about to write or remove.
const LOOKS: (u32, Duration) = (50, Duration::from_millis(40));

/// Policy for a lock whose process cannot be examined, because it is on another host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unseen {
    /// Assume that the process exists.
    Respect,
    /// Take over the lock (`--break-lock`).
    Break,
}

/// Lock of a directory, released when dropped.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    own: Holder,
    note: Option<String>,
}

/// Locks of this process, because a panic or an abort does not drop values.
static HELD: Mutex<Vec<(PathBuf, Holder)>> = Mutex::new(Vec::new());

/// Lock file as it was read. The holder is absent if the text was not written by this program.
#[derive(PartialEq)]
struct FoundLock {
    holder: Option<Holder>,
    owner: u32,
}

impl Lock {
    /// Locks `directory`, which must exist. If several programs try at once, one succeeds.
    ///
    /// # Errors
    /// [`Error::Locked`] if the process of another lock exists or cannot be examined; [`Error::Directory`] for an error
    /// of the system.
    pub fn take(directory: &Path, unseen: Unseen) -> Result<Self, Error> {
        let path = directory.join(LOCK);
        let own = Holder::this_process();
        for _ in 0..LOOKS.0 {
            if create(&path, &own).map_err(Error::directory("lock", directory))? {
                return Ok(Self::held(path, own, None));
            }
            let Some(found) = FoundLock::whole(&path).map_err(Error::directory("lock", directory))? else {
                continue;
            };
            let note = found.yields(directory, &own, unseen)?;
            if take_over(directory, &own, &found, unseen)? {
                return Ok(Self::held(path, own, Some(note)));
            }
        }
        Err(locked(directory, "runs that come and go", "try again"))
    }

    fn held(path: PathBuf, own: Holder, note: Option<String>) -> Self {
        if let Ok(mut held) = HELD.lock() {
            held.push((path.clone(), own.clone()));
        }
        Self { path, own, note }
    }

    /// Returns a warning if a lock was taken over: whose lock, and why.
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if let Ok(mut held) = HELD.lock() {
            held.retain(|(path, _)| *path != self.path);
        }
        remove(&self.path, &self.own);
    }
}

/// Releases all locks of this process; for exits that drop nothing. May be called from a panic.
pub fn abandon() {
    let held = match HELD.try_lock() {
        Ok(mut held) => std::mem::take(&mut *held),
        Err(TryLockError::Poisoned(poisoned)) => std::mem::take(&mut *poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => return,
    };
    held.iter().for_each(|(path, own)| remove(path, own));
}

/// Removes a lock unless another process has taken it over. The next run treats a lock that cannot be removed as stale.
fn remove(path: &Path, own: &Holder) {
    if FoundLock::read(path).is_ok_and(|found| found.is_some_and(|found| found.holder.as_ref() == Some(own))) {
        let _ = fs::remove_file(path);
    }
}

/// Creates a lock file with its holder; false if there is one.
fn create(path: &Path, own: &Holder) -> io::Result<bool> {
    let mut file = match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Ok(false),
        file => file?,
    };
    file.write_all(own.text().as_bytes()).map(|()| true).inspect_err(|_| {
        // This process created the file; without a holder it would only block the directory.
        let _ = fs::remove_file(path);
    })
}

/// Replaces the lock of a process that no longer exists; false if the lock has changed in the meantime.
fn take_over(directory: &Path, own: &Holder, found: &FoundLock, unseen: Unseen) -> Result<bool, Error> {
    let path = directory.join(LOCK);
    let guard = directory.join(TAKEOVER);
    let mut looks = LOOKS.0;
    while !create(&guard, own).map_err(Error::directory("lock", directory))? {
        // Another process takes over the lock now, which takes milliseconds, or was killed while doing so.
        looks -= 1;
        match (looks, unseen) {
            (0, Unseen::Respect) => {
                let advice = "Wait until that run ends. If it has ended already, use `--break-lock`";
                return Err(locked(directory, "another run that is about to take it over", advice));
            }
            (0, Unseen::Break) => {
                looks = LOOKS.0;
                let _ = fs::remove_file(&guard);
            }
            _ => sleep(LOOKS.1),
        }
    }
    let replaced = match FoundLock::read(&path) {
        Ok(now) if now.as_ref() == Some(found) => {
            atomic::replace(&path, |file| file.write_all(own.text().as_bytes())).map(|()| true)
        }
        Ok(_) => Ok(false),
        Err(source) => Err(Error::directory("lock", directory)(source)),
    };
    remove(&guard, own);
    replaced
}

impl FoundLock {
    /// Reads the lock at `path`, if there is one.
    fn read(path: &Path) -> io::Result<Option<Self>> {
        let mut file = match File::open(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            file => file?,
        };
        let owner = file.metadata()?.uid();
        Ok(Some(Self {
            holder: Holder::read(&mut file)?,
            owner,
        }))
    }

    /// Reads the lock at `path`, waiting until its creator has written its holder.
    fn whole(path: &Path) -> io::Result<Option<Self>> {
        for _ in 0..LOOKS.0 {
            match Self::read(path)? {
                Some(Self { holder: None, .. }) => sleep(LOOKS.1),
                found => return Ok(found),
            }
        }
        Self::read(path)
    }

    /// Returns the warning to be issued when `own` takes over this lock.
    ///
    /// # Errors
    /// [`Error::Locked`] if the process of the lock exists or may exist.
    fn yields(&self, directory: &Path, own: &Holder, unseen: Unseen) -> Result<String, Error> {
        let unknown = "an unknown run".to_owned();
        let name = self.holder.as_ref().map_or(unknown, Holder::to_string);
        let why = match self
            .holder
            .as_ref()
            .map_or(Fate::Unseen, |holder| holder.fate(own, self.owner))
        {
            Fate::Alive => {
                return Err(locked(
                    directory,
                    &name,
                    "Wait until that run ends, or choose another directory with `-o`",
                ));
            }
            Fate::Gone(why) => why,
            Fate::Unseen if unseen == Unseen::Break => "by --break-lock",
            Fate::Unseen => {
                let advice = "Wait until that run ends. If it has ended already, use `--break-lock`";
                return Err(locked(directory, &name, advice));
            }
        };
        Ok(format!(
            "W0737: the output directory was locked by {name}, and this run took over the lock ({why}). Two runs at \
             once would destroy the files. Make sure that the other run has ended."
        ))
    }
}

fn locked(directory: &Path, holder: &str, advice: &'static str) -> Error {
    Error::Locked {
        path: directory.to_owned(),
        holder: holder.to_owned(),
        advice,
    }
}
