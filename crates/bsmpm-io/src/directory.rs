//! The output directory of a run. If a new run replaces an old one, only files that the old `run.json` lists are
//! deleted.

use std::fs::{self, Metadata};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::Error;
use crate::frames::COLLECTION;
use crate::lock::{Lock, Unseen};
use crate::manifest::{MANIFEST, Manifest};
use crate::relative::is_plain_relative;
use crate::residuals::RESIDUALS;
use crate::steps::STEPS;

/// The file of the histories.
pub const HISTORY: &str = "history.csv";
/// Files of a run that stand in the directory itself.
const FILES: [&str; 6] = [MANIFEST, HISTORY, STEPS, RESIDUALS, COLLECTION, "frames.vtkhdf"];
/// Folders of a run.
const FOLDERS: [&str; 2] = ["frames", "checkpoint"];
/// How the names of all files end that a run writes; others are never deleted, whoever names them.
const ENDINGS: [&str; 7] = ["csv", "pvd", "vtu", "vtkhdf", "png", "h5", "json"];

/// What becomes of a run that is there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExistingRunPolicy {
    /// The directory is refused.
    Refuse,
    /// The files that its `run.json` names are deleted (`--force`).
    Delete,
}

/// An output directory that belongs to the run which claimed it.
#[derive(Debug)]
pub struct OutputDirectory {
    path: PathBuf,
    lock: Option<Lock>, // until this is dropped
    idle: bool,         // made for a run that has not begun
}

impl OutputDirectory {
    /// Makes the directory if need be, and holds it against other runs as long as this lives: of several programs that
    /// try at once, one succeeds.
    ///
    /// # Errors
    /// [`Error::Locked`] by a run that goes on, see [`Lock::take`]. [`Error::NotDirectory`], [`Error::Directory`] if
    /// the path is a file or cannot be made or written to, or if a link stands where one of the run's folders belongs.
    pub fn hold(path: &Path, unseen: Unseen) -> Result<Self, Error> {
        let idle = match fs::metadata(path) {
            Ok(found) if !found.is_dir() => return Err(Error::NotDirectory { path: path.to_owned() }),
            Ok(_) => false,
            Err(_) => fs::create_dir_all(path)
                .map(|()| true)
                .map_err(Error::directory("create", path))?,
        };
        let lock = Some(Lock::take(path, unseen)?);
        // A link there would lead what is written out of the directory.
        if let Some(folder) = FOLDERS
            .iter()
            .map(|folder| path.join(folder))
            .find(|folder| is_no_folder(folder))
        {
            return Err(Error::NotDirectory { path: folder });
        }
        Ok(Self {
            path: path.to_owned(),
            lock,
            idle,
        })
    }

    /// Puts the first manifest of a new run there.
    ///
    /// # Errors
    /// [`Error::Occupied`] by another run; with [`ExistingRunPolicy::Delete`] only if there is a file of a run that no
    /// `run.json` names. [`Error::UnsafeOutput`] if the older `run.json` names what no run of ours wrote: nothing is
    /// deleted then. [`Error::Directory`] if it cannot be written to.
    pub fn claim(mut self, existing: ExistingRunPolicy, first: &Manifest) -> Result<Self, Error> {
        let path = &self.path;
        let held = run_files(path).map_err(Error::directory("read", path))?;
        match (held.first(), existing) {
            (None, _) => {}
            (Some(found), ExistingRunPolicy::Refuse) => {
                let advice = "Continue that run with `--restart auto`, replace it with `--force`, or choose another directory with `-o`";
                return Err(occupied(path, found, advice));
            }
            (Some(_), ExistingRunPolicy::Delete) => delete_run(path, &held)?,
        }
        first.write(path).map_err(|error| match error {
            Error::File { source, .. } => Error::directory("write to", path)(source),
            other => other,
        })?;
        self.idle = false;
        Ok(self)
    }

    /// The run that is there, if any.
    ///
    /// # Errors
    /// Those of [`Manifest::read`].
    pub fn run(&self) -> Result<Option<Manifest>, Error> {
        if exists(&self.path.join(MANIFEST)) {
            Manifest::read(&self.path).map(Some)
        } else {
            Ok(None)
        }
    }

    /// Makes the run that is there go on as `manifest` says: what its `run.json` names and the manifest does not goes.
    ///
    /// # Errors
    /// As [`OutputDirectory::claim`].
    pub fn go_on(mut self, manifest: &Manifest) -> Result<Self, Error> {
        let mut dropped = self.run()?.map_or_else(Vec::new, |run| run.outputs);
        dropped.retain(|old| manifest.outputs.iter().all(|output| output.path != old.path));
        let doomed = doomed(&self.path, dropped.iter().map(|output| &*output.path))?;
        // What is left half deleted is still named by the older manifest.
        delete(&doomed)?;
        manifest.write(&self.path)?;
        self.idle = false;
        Ok(self)
    }

    /// Whose lock was taken over, and why, if there was one.
    pub fn note(&self) -> Option<&str> {
        self.lock.as_ref()?.note()
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for OutputDirectory {
    fn drop(&mut self) {
        self.lock = None;
        if self.idle {
            // Only if nobody else has put anything there.
            let _ = fs::remove_dir(&self.path);
        }
    }
}

fn occupied(path: &Path, found: &str, advice: &'static str) -> Error {
    Error::Occupied {
        path: path.to_owned(),
        found: found.to_owned(),
        advice,
    }
}

/// The files of a run that a directory holds, relative to it.
fn run_files(directory: &Path) -> io::Result<Vec<String>> {
    let mut found: Vec<String> = FILES
        .iter()
        .filter(|file| exists(&directory.join(file)))
        .map(|&f| f.into())
        .collect();
    for folder in FOLDERS {
        let entries = match fs::read_dir(directory.join(folder)) {
            Err(error) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind()) => continue,
            entries => entries?,
        };
        for entry in entries {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if !name.starts_with('.') && has_our_ending(&name) {
                found.push(format!("{folder}/{name}"));
            }
        }
    }
    found.sort_by_key(|file| file != MANIFEST);
    Ok(found)
}

/// Whether there is anything of that name, be it a link that leads nowhere.
fn exists(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Whether something stands there that is no folder itself, be it a link to one.
fn is_no_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| !found.is_dir())
}

/// Deletes the outputs that the directory's `run.json` names, then itself. All are looked at before the first is
/// deleted.
fn delete_run(directory: &Path, held: &[String]) -> Result<(), Error> {
    if held[0] != MANIFEST {
        return Err(occupied(
            directory,
            &held[0],
            "No run.json lists this file. Delete the file, or choose another directory with `-o`",
        ));
    }
    let manifest = Manifest::read(directory)?;
    let mut doomed = doomed(directory, manifest.outputs.iter().map(|output| &*output.path))?;
    let named: Vec<&String> = manifest.outputs.iter().map(|output| &output.path).collect();
    if let Some(other) = held.iter().find(|file| *file != MANIFEST && !named.contains(file)) {
        return Err(occupied(
            directory,
            other,
            "Delete this file, which run.json does not list, or choose another directory with `-o`",
        ));
    }
    // The manifest goes last: whatever interrupts this, it still names what is left.
    doomed.push(directory.join(MANIFEST));
    delete(&doomed)
}

/// Those of the named outputs that are there, if all of them may be deleted.
fn doomed<'a>(directory: &Path, names: impl Iterator<Item = &'a str>) -> Result<Vec<PathBuf>, Error> {
    let mut doomed = Vec::new();
    for name in names {
        let is_there = inspect(directory, name).map_err(|reason| Error::UnsafeOutput {
            path: directory.to_owned(),
            name: name.to_owned(),
            reason,
        })?;
        if is_there {
            doomed.push(directory.join(name));
        }
    }
    Ok(doomed)
}

fn delete(doomed: &[PathBuf]) -> Result<(), Error> {
    for path in doomed {
        fs::remove_file(path).map_err(Error::directory("empty", path))?;
    }
    Ok(())
}

/// Whether an output that a `run.json` names is there to be deleted, or why it must not be.
fn inspect(directory: &Path, name: &str) -> Result<bool, &'static str> {
    if !is_plain_relative(name) {
        return Err("is not a path within this directory");
    }
    if !has_our_ending(name) {
        return Err("is not a file of a run");
    }
    let mut path = directory.to_owned();
    let mut last: Option<Metadata> = None;
    for part in Path::new(name).components() {
        path.push(part);
        match fs::symlink_metadata(&path) {
            Ok(found) if found.is_symlink() => return Err("is reached through a symbolic link"),
            Ok(found) => last = Some(found),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            Err(_) => return Err("cannot be examined"),
        }
    }
    match last {
        Some(found) if found.is_file() => Ok(true),
        _ => Err("is not a file"),
    }
}

fn has_our_ending(name: &str) -> bool {
    Path::new(name)
        .extension()
        .is_some_and(|ending| ENDINGS.iter().any(|&ours| ending == ours))
}
