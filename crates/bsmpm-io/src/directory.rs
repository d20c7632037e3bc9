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

/// File of the histories.
pub const HISTORY: &str = "history.csv";
/// Files of a run in the directory itself.
const FILES: [&str; 6] = [MANIFEST, HISTORY, STEPS, RESIDUALS, COLLECTION, "frames.vtkhdf"];
/// Folders of a run.
const FOLDERS: [&str; 2] = ["frames", "checkpoint"];
/// Extensions of all files that a run writes. Other files are never deleted, even if they are listed.
const ENDINGS: [&str; 7] = ["csv", "pvd", "vtu", "vtkhdf", "png", "h5", "json"];

/// What to do if the directory contains a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExistingRunPolicy {
    /// Refuse the directory.
    Refuse,
    /// Delete the files listed in its `run.json` (`--force`).
    Delete,
}

/// Output directory, locked by this run.
#[derive(Debug)]
pub struct OutputDirectory {
    path: PathBuf,
    lock: Option<Lock>, // until this is dropped
    idle: bool,         // created for a run that has not begun
}

impl OutputDirectory {
    /// Creates the directory if necessary, and locks it against other runs as long as this value exists. If several
    /// programs try at once, one succeeds.
    ///
    /// # Errors
    /// [`Error::Locked`] if another run is using it, see [`Lock::take`]. [`Error::NotDirectory`] or
    /// [`Error::Directory`] if the path is a file or cannot be created or written to, or if one of the run's folders is
    /// a link.
    pub fn hold(path: &Path, unseen: Unseen) -> Result<Self, Error> {
        let idle = match fs::metadata(path) {
            Ok(found) if !found.is_dir() => return Err(Error::NotDirectory { path: path.to_owned() }),
            Ok(_) => false,
            Err(_) => fs::create_dir_all(path)
                .map(|()| true)
                .map_err(Error::directory("create", path))?,
        };
        let lock = Some(Lock::take(path, unseen)?);
        // Files written through a link would be outside the directory.
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

    /// Writes the first manifest of a new run.
    ///
    /// # Errors
    /// [`Error::Occupied`] if there is another run; with [`ExistingRunPolicy::Delete`] only if there is a file of a run
    /// that no `run.json` lists. [`Error::UnsafeOutput`] if the older `run.json` lists a file that this program did not
    /// write: nothing is deleted then. [`Error::Directory`] if the directory cannot be written to.
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

    /// Returns the manifest of the run in the directory, if any.
    ///
    /// # Errors
    /// The errors of [`Manifest::read`].
    pub fn run(&self) -> Result<Option<Manifest>, Error> {
        if exists(&self.path.join(MANIFEST)) {
            Manifest::read(&self.path).map(Some)
        } else {
            Ok(None)
        }
    }

    /// Continues the run in the directory with `manifest`. Files that the old `run.json` lists and `manifest` does not
    /// are deleted.
    ///
    /// # Errors
    /// The errors of [`OutputDirectory::claim`].
    pub fn go_on(mut self, manifest: &Manifest) -> Result<Self, Error> {
        let mut dropped = self.run()?.map_or_else(Vec::new, |run| run.outputs);
        dropped.retain(|old| manifest.outputs.iter().all(|output| output.path != old.path));
        let doomed = doomed(&self.path, dropped.iter().map(|output| &*output.path))?;
        // If this is interrupted, the older manifest still lists the remaining files.
        delete(&doomed)?;
        manifest.write(&self.path)?;
        self.idle = false;
        Ok(self)
    }

    /// Returns a warning if a lock was taken over: whose lock, and why.
    pub fn note(&self) -> Option<&str> {
        self.lock.as_ref()?.note()
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for OutputDirectory {
    fn drop(&mut self) {
        self.lock = None;
        if self.idle {
            // Succeeds only if the directory is empty.
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

/// Returns the files of a run in a directory, relative to it.
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

/// Returns whether the path exists, even as a broken link.
fn exists(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Returns whether the path exists and is not a folder; a link to a folder is not one.
fn is_no_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| !found.is_dir())
}

/// Deletes the outputs that the directory's `run.json` lists, then `run.json`. All are checked before the first is
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
    // The manifest is deleted last: if this is interrupted, it still lists the remaining files.
    doomed.push(directory.join(MANIFEST));
    delete(&doomed)
}

/// Returns the listed outputs that exist, if all of them may be deleted.
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

/// Returns whether an output listed in a `run.json` exists, or the reason why it must not be deleted.
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
