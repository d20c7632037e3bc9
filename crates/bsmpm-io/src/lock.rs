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

/// The file's name.
pub const LOCK: &str = ".lock";
/// Held for the moment in which a lock changes hands.
const TAKEOVER: &str = ".lock.takeover";
/// How often, and after which pauses, a file is looked at again that another program is about to write or to remove.
const LOOKS: (u32, Duration) = (50, Duration::from_millis(40));

/// What becomes of a lock whose holder cannot be looked at: it is on another host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unseen {
    /// It is believed to live.
    Respect,
    /// The lock is taken over (`--break-lock`).
    Break,
}

/// A directory that is held; it is let go when this is dropped.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    own: Holder,
    note: Option<String>,
}

/// Locks of this process: a panic or an abort drops nothing.
static HELD: Mutex<Vec<(PathBuf, Holder)>> = Mutex::new(Vec::new());

/// A lock file as it was found; without a holder where its text is none of ours.
#[derive(PartialEq)]
struct FoundLock {
    holder: Option<Holder>,
    owner: u32,
}

impl Lock {
    /// Holds `directory`, which must exist. Of several programs that try at once, one succeeds.
    ///
    /// # Errors
    /// [`Error::Locked`] by a run that lives, or that cannot be looked at; [`Error::Directory`] if the system refuses.
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

    /// Whose lock was taken over, and why, if it was there.
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

/// Lets go all directories of this process, for those that end without dropping anything. May be called from a panic.
pub fn abandon() {
    let held = match HELD.try_lock() {
        Ok(mut held) => std::mem::take(&mut *held),
        Err(TryLockError::Poisoned(poisoned)) => std::mem::take(&mut *poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => return,
    };
    held.iter().for_each(|(path, own)| remove(path, own));
}

/// Removes a lock unless another has taken it over. What cannot be removed is found stale by the next run.
fn remove(path: &Path, own: &Holder) {
    if FoundLock::read(path).is_ok_and(|found| found.is_some_and(|found| found.holder.as_ref() == Some(own))) {
        let _ = fs::remove_file(path);
    }
}

/// Creates a lock file that names its holder; false if there is one.
fn create(path: &Path, own: &Holder) -> io::Result<bool> {
    let mut file = match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Ok(false),
        file => file?,
    };
    file.write_all(own.text().as_bytes()).map(|()| true).inspect_err(|_| {
        // It is ours, and without a name it would only block the directory.
        let _ = fs::remove_file(path);
    })
}

/// Puts `own` in the place of the dead holder that was found; false if the lock is no longer as it was.
fn take_over(directory: &Path, own: &Holder, found: &FoundLock, unseen: Unseen) -> Result<bool, Error> {
    let path = directory.join(LOCK);
    let guard = directory.join(TAKEOVER);
    let mut looks = LOOKS.0;
    while !create(&guard, own).map_err(Error::directory("lock", directory))? {
        // Another takes it over just now, which is a matter of milliseconds; or it was killed in them.
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
    /// The lock at `path`, if there is one.
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

    /// The same, after the moment that its creator needs to write its name.
    fn whole(path: &Path) -> io::Result<Option<Self>> {
        for _ in 0..LOOKS.0 {
            match Self::read(path)? {
                Some(Self { holder: None, .. }) => sleep(LOOKS.1),
                found => return Ok(found),
            }
        }
        Self::read(path)
    }

    /// What is to be reported when `own` takes this lock over; an error if its holder lives or may live.
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
