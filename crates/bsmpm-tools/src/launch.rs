//! Runs of bsmpm-par as other commands start them: made now, or left as they are where nothing has changed since.

use std::env;
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::UNIX_EPOCH;

use bsmpm_io::atomic;
use bsmpm_io::lock::{Lock, Unseen};
use bsmpm_io::manifest::{MANIFEST, Manifest};

use crate::Error;

pub(crate) mod command;
mod stop;

pub(crate) use stop::Stop;

use bsmpm_io::exit::{CHECK, CHECKPOINT, DIRECTORY, DONE, LEFT, MEMORY, NO_CONVERGENCE, STALLED, STOPPED};

/// Not begun: too little memory, restarts that come to nothing, a directory or a checkpoint that cannot be used.
const REFUSED: [u8; 4] = [MEMORY, STALLED, DIRECTORY, CHECKPOINT];

/// What keeps runs side by side from taking each other's cores: no threads in BLAS, no ranks bound to the same cores.
/// Variables that are set already stay as they are.
const SIDE_BY_SIDE: [(&str, &str); 5] = [
    ("OMP_NUM_THREADS", "1"),
    ("OPENBLAS_NUM_THREADS", "1"),
    ("OMPI_MCA_hwloc_base_binding_policy", "none"),
    ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
    ("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"),
];

/// The words that start the solver, which its arguments follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolverProgram<'a> {
    /// The launcher, if any, and at the end bsmpm-par.
    pub command: &'a [String],
    /// Whether runs may be made at the same time.
    pub side_by_side: bool,
}

/// A run that is wanted.
pub(crate) struct LaunchTask<'a> {
    /// Those of bsmpm-par.
    pub arguments: &'a [String],
    /// The directory that they name as the output.
    pub directory: &'a Path,
    /// Everything that the run is made from, as it stands now; none where a part cannot be told, and the run is made.
    pub origin: Option<&'a str>,
    /// Make it even if it is there.
    pub force: bool,
}

/// How a run ended.
pub(crate) struct Ending {
    /// That of bsmpm-par; the launcher's where there is no manifest.
    pub code: u8,
    pub manifest: Option<Manifest>,
    /// Why it ended early, or its last word.
    pub reason: String,
}

impl SolverProgram<'_> {
    /// Whether a solver that is named by its path is there: to be seen before former runs are deleted for new ones.
    pub fn check(&self) -> Result<(), Error> {
        match self.command.last() {
            Some(solver) if solver.contains('/') && !Path::new(solver).is_file() => {
                Err(Error::Launch { program: solver.clone(), source: ErrorKind::NotFound.into() })
            }
            _ => Ok(()),
        }
    }

    /// Which program it is: its size and when it changed last.
    pub fn stamp(&self) -> Option<String> {
        let solver = fs::metadata(found(self.command.last()?)?).ok()?;
        let changed = solver.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos();
        Some(format!("solver: {} bytes, changed at {changed}", solver.len()))
    }

    /// Makes the run unless it has ended there, made from what would be taken now, and `is_same` agrees; its exit code, none
    /// if it was there.
    pub fn perform(&self, task: &LaunchTask, is_same: impl Fn(&Manifest) -> bool) -> Result<Option<u8>, Error> {
        if task.is_there(is_same) {
            return Ok(None);
        }
        self.make(task, &Stop::default()).map(Some)
    }

    /// Makes the run, whatever is there; its exit code. `stop` may end it early.
    pub fn make(&self, task: &LaunchTask, stop: &Stop) -> Result<u8, Error> {
        // What an older run left must not pass for this one's, should it die before it writes.
        if task.directory.join(MANIFEST).exists() {
            // Unless it goes on.
            let _lock = Lock::take(task.directory, Unseen::Respect)?;
            let file = |source| Error::File(bsmpm_io::Error::file("delete", task.directory)(source));
            fs::remove_dir_all(task.directory).map_err(file)?;
        }
        if let Some(parent) = task.directory.parent() {
            make(parent)?;
        }
        atomic::replace(&beside(task.directory, "origin"), |file| {
            file.write_all(task.origin.unwrap_or_default().as_bytes())
        })?;
        self.start(task.arguments, &beside(task.directory, "log"), stop)
    }

    /// Goes on with the run if it was stopped or killed and is made from what would be taken now, else makes it; its exit code.
    /// The arguments leave to this what becomes of what is there.
    pub fn advance(&self, task: &LaunchTask) -> Result<u8, Error> {
        let (goes_on, stop) = (task.is_broken_off(), Stop::default());
        let how = if goes_on { &["--restart", "auto"][..] } else { &["--force"] };
        let arguments: Vec<String> =
            task.arguments.iter().cloned().chain(how.iter().map(|&word| word.into())).collect();
        if goes_on {
            return self.start(&arguments, &beside(task.directory, "log"), &stop);
        }
        self.make(&LaunchTask { arguments: &arguments, ..*task }, &stop)
    }

    fn start(&self, arguments: &[String], log: &Path, stop: &Stop) -> Result<u8, Error> {
        let file = |source| Error::File(bsmpm_io::Error::file("write", log)(source));
        let out = File::create(log).map_err(file)?;
        let both = out.try_clone().map_err(file)?;
        let (program, first) = self
            .command
            .split_first()
            .ok_or_else(|| Error::Usage { reason: "the command that starts the solver is missing".to_owned() })?;
        let mut command = Command::new(program);
        if self.side_by_side {
            command.envs(SIDE_BY_SIDE.into_iter().filter(|(name, _)| env::var_os(name).is_none()));
        }
        let command = command.args(first).args(arguments).stdin(Stdio::null()).stdout(out).stderr(both);
        let status = stop.status(command).map_err(|source| Error::Launch { program: program.clone(), source })?;
        Ok(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(u8::MAX))
    }
}

impl LaunchTask<'_> {
    /// Whether the run has ended there, made from what would be taken now, and `is_same` agrees; never if it is to be made
    /// again.
    pub fn is_there(&self, is_same: impl Fn(&Manifest) -> bool) -> bool {
        self.before().is_some_and(|manifest| {
            let is_whole = manifest.exit_code.is_some_and(|code| [DONE, CHECK, NO_CONVERGENCE, LEFT].contains(&code));
            is_whole && is_same(&manifest)
        })
    }

    /// Whether the run was stopped, or killed, before its end.
    fn is_broken_off(&self) -> bool {
        self.before().is_some_and(|manifest| manifest.exit_code.is_none_or(|code| code == STOPPED))
    }

    /// What is there from before, if it counts and was made from what would be taken now.
    fn before(&self) -> Option<Manifest> {
        let manifest = Manifest::read(self.directory).ok().filter(|_| !self.force)?;
        let origin = fs::read_to_string(beside(self.directory, "origin")).ok()?;
        (self.origin == Some(&*origin)).then_some(manifest)
    }
}

impl Ending {
    /// That of the run in a directory; `code` is what its process ended with, if it was made now.
    pub fn of(directory: &Path, code: Option<u8>) -> Self {
        let manifest = Manifest::read(directory).ok();
        // A launcher may hide the program's own exit code, which is in the manifest; but not where the run was refused and the
        // manifest is that of before.
        let refused = code.filter(|code| REFUSED.contains(code));
        let own = refused.or(manifest.as_ref().and_then(|manifest| manifest.exit_code));
        let failure = manifest.as_ref().and_then(|manifest| manifest.failure.as_ref());
        let reason = failure.map_or_else(|| last_line(directory), |failure| failure.reason.clone());
        Self { code: own.or(code).unwrap_or(u8::MAX), manifest, reason }
    }
}

/// A file of a run beside its directory, `NAME.out`. The name may have dots itself, those of numbers; the directory's
/// ending takes the place of one.
pub(crate) fn beside(directory: &Path, ending: &str) -> PathBuf {
    directory.with_extension(ending)
}

/// A directory, with those above it.
pub(crate) fn make(directory: &Path) -> Result<(), Error> {
    fs::create_dir_all(directory).map_err(|source| Error::File(bsmpm_io::Error::file("make", directory)(source)))
}

/// The file of a program: as it is named, or in the folders of PATH.
fn found(program: &str) -> Option<PathBuf> {
    if program.contains('/') {
        return Some(PathBuf::from(program));
    }
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join(program)).find(|file| file.is_file())
}

fn last_line(directory: &Path) -> String {
    let text = fs::read_to_string(beside(directory, "log")).unwrap_or_default();
    text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it left no word").to_owned()
}
