//! Starts `bsmpm-par`, or reuses a complete run of the same input.

use std::env;
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::UNIX_EPOCH;

use bsmpm_io::atomic;
use bsmpm_io::exit::{CHECK, DONE, INDICATOR, LEFT, NO_CONVERGENCE, STOPPED};
use bsmpm_io::lock::{Lock, Unseen};
use bsmpm_io::manifest::{MANIFEST, Manifest};

use crate::Error;

pub(crate) mod command;
mod outcome;
mod stop;

pub(crate) use outcome::{Outcome, RunCost, RunState};
pub(crate) use stop::Stop;

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
    /// The case file.
    pub case: &'a Path,
    /// Overrides, `KEY=VALUE`.
    pub set: &'a [String],
    /// Further arguments of bsmpm-par.
    pub further: Vec<String>,
    pub directory: PathBuf,
    /// Everything that the run is made from, as it stands now; none where a part cannot be determined, and the run is
    /// made.
    pub origin: Option<String>,
    /// The checkpoint of another run that it goes on from, if any.
    pub from: Option<PathBuf>,
    /// Make it even if it is there.
    pub force: bool,
    /// Go on with it if it was stopped or killed.
    pub resume: bool,
}

impl SolverProgram<'_> {
    /// Whether a solver that is named by its path is there: to be seen before former runs are deleted for new ones.
    pub fn check(&self) -> Result<(), Error> {
        match self.command.last() {
            Some(solver) if solver.contains('/') && !Path::new(solver).is_file() => Err(Error::Launch {
                program: solver.clone(),
                source: ErrorKind::NotFound.into(),
            }),
            _ => Ok(()),
        }
    }

    /// Which program it is: its size and when it changed last.
    pub fn stamp(&self) -> Option<String> {
        let solver = fs::metadata(found(self.command.last()?)?).ok()?;
        let changed = solver.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos();
        Some(format!("solver: {} bytes, changed at {changed}", solver.len()))
    }

    /// The outcome of a run: as it is there if it has ended, made from what would be taken now, and `is_same` agrees;
    /// else it is made now, or gone on with.
    ///
    /// # Errors
    /// Those of a solver that does not start, and of files. A run that fails is an outcome.
    pub fn outcome(&self, task: &LaunchTask, is_same: impl Fn(&Manifest) -> bool) -> Result<Outcome, Error> {
        if task.is_there(is_same) {
            Ok(task.left(None))
        } else {
            self.make(task, &Stop::default())
        }
    }

    /// The outcome of a run that is made, or gone on with, whatever is there; `stop` may end it early.
    pub fn make(&self, task: &LaunchTask, stop: &Stop) -> Result<Outcome, Error> {
        let log = beside(&task.directory, "log");
        if task.resume && task.is_broken_off() {
            return self
                .start(&task.arguments(&["--restart", "auto"]), &log, stop)
                .map(|code| task.left(Some(code)));
        }
        // What an older run left must not pass for this one's, should it die before it writes.
        if task.directory.join(MANIFEST).exists() {
            // Unless it goes on.
            let _lock = Lock::take(&task.directory, Unseen::Respect)?;
            fs::remove_dir_all(&task.directory).map_err(bsmpm_io::Error::file("delete", &task.directory))?;
        }
        if let Some(parent) = task.directory.parent() {
            make(parent)?;
        }
        let origin = task.origin.as_deref().unwrap_or_default();
        atomic::replace(&beside(&task.directory, "origin"), |file| {
            file.write_all(origin.as_bytes())
        })?;
        let from = task.from.as_ref().map(|path| path.display().to_string());
        let how = from.as_ref().map_or(vec!["--force"], |path| vec!["--restart", path]);
        self.start(&task.arguments(&how), &log, stop)
            .map(|code| task.left(Some(code)))
    }

    fn start(&self, arguments: &[String], log: &Path, stop: &Stop) -> Result<u8, Error> {
        let out = File::create(log).map_err(bsmpm_io::Error::file("write", log))?;
        let both = out.try_clone().map_err(bsmpm_io::Error::file("write", log))?;
        let (program, first) = self.command.split_first().ok_or_else(|| Error::Launch {
            program: String::new(),
            source: ErrorKind::NotFound.into(),
        })?;
        let mut command = Command::new(program);
        if self.side_by_side {
            command.envs(SIDE_BY_SIDE.into_iter().filter(|(name, _)| env::var_os(name).is_none()));
        }
        let command = command
            .args(first)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(out)
            .stderr(both);
        let status = stop.status(command).map_err(|source| Error::Launch {
            program: program.clone(),
            source,
        })?;
        Ok(status
            .code()
            .and_then(|code| u8::try_from(code).ok())
            .unwrap_or(u8::MAX))
    }
}

impl LaunchTask<'_> {
    /// Those of bsmpm-par; `how` says what becomes of what is there.
    pub fn arguments(&self, how: &[&str]) -> Vec<String> {
        let set = self.set.iter().flat_map(|set| ["--set", set]);
        let words = set
            .chain(["--quiet"])
            .chain(self.further.iter().map(String::as_str))
            .chain(how.iter().copied());
        let words = [self.case.display().to_string()]
            .into_iter()
            .chain(words.map(str::to_owned));
        words
            .chain(["--output".to_owned(), self.directory.display().to_string()])
            .collect()
    }

    /// What its directory holds; `code` is what its process ended with, if it was made now.
    pub fn left(&self, code: Option<u8>) -> Outcome {
        Outcome::read(&self.directory, code)
    }

    /// Whether the run has ended there, made from what would be taken now, and `is_same` agrees; never if it is to be
    /// made again.
    pub fn is_there(&self, is_same: impl Fn(&Manifest) -> bool) -> bool {
        self.before().is_some_and(|manifest| {
            let is_whole = manifest
                .exit_code
                .is_some_and(|code| [DONE, CHECK, INDICATOR, NO_CONVERGENCE, LEFT].contains(&code));
            is_whole && is_same(&manifest)
        })
    }

    /// Whether the run was stopped, or killed, before its end.
    fn is_broken_off(&self) -> bool {
        self.before()
            .is_some_and(|manifest| manifest.exit_code.is_none_or(|code| code == STOPPED))
    }

    /// What is there from before, if it counts and was made from what would be taken now.
    fn before(&self) -> Option<Manifest> {
        let manifest = Manifest::read(&self.directory).ok().filter(|_| !self.force)?;
        let origin = fs::read_to_string(beside(&self.directory, "origin")).ok()?;
        (self.origin.as_ref() == Some(&origin)).then_some(manifest)
    }
}

/// A file of a run beside its directory, `NAME.out`. The name may have dots itself, those of numbers; the directory's
/// ending takes the place of one.
pub(crate) fn beside(directory: &Path, ending: &str) -> PathBuf {
    directory.with_extension(ending)
}

/// A directory, with those above it.
pub(crate) fn make(directory: &Path) -> Result<(), Error> {
    Ok(fs::create_dir_all(directory).map_err(bsmpm_io::Error::file("make", directory))?)
}

/// The file of a program: as it is named, or in the folders of PATH.
fn found(program: &str) -> Option<PathBuf> {
    if program.contains('/') {
        return Some(PathBuf::from(program));
    }
    env::split_paths(&env::var_os("PATH")?)
        .map(|folder| folder.join(program))
        .find(|file| file.is_file())
}
