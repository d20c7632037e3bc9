//! The runs of a study: started one after another, or taken as they are where nothing has changed since.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::UNIX_EPOCH;

use bsmpm_io::directory::HISTORY;
use bsmpm_io::manifest::{MANIFEST, Manifest};
use bsmpm_io::table::{self, Columns};

use super::matrix::{Run, Study};
use crate::Error;

/// Exit codes of bsmpm-par: done, a check of the case failed, no convergence, material left the grid. Runs that ended with
/// another one are made again.
const DONE: u8 = 0;
const CHECK: u8 = 77;
const STOPS: [u8; 2] = [80, 81];

/// How runs are started.
pub(super) struct Launcher<'a> {
    pub command: &'a [String],
    /// what the matrix names is relative to
    pub base: &'a Path,
    pub output: &'a Path,
    pub force: bool,
}

/// What a run left.
pub(super) struct Outcome {
    pub directory: PathBuf,
    pub history: Option<Columns>,
    /// why it is no result
    pub failure: Option<String>,
    /// why it is one although it did not come to its end
    pub stopped: Option<String>,
    /// its exit code
    pub code: u8,
    pub cost: Cost,
}

impl Outcome {
    /// Whether its history holds anything.
    pub fn has_rows(&self) -> bool {
        self.history.as_ref().is_some_and(|history| history.values.iter().any(|values| !values.is_empty()))
    }
}

/// What runs took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cost {
    pub steps: u64,
    pub cuts: u64,
    pub iterations: u64,
    pub seconds: f64,
}

impl Cost {
    pub fn of(outcomes: &[&Outcome]) -> Self {
        outcomes.iter().fold(Self::default(), |sum, Outcome { cost, .. }| Self {
            steps: sum.steps + cost.steps,
            cuts: sum.cuts + cost.cuts,
            iterations: sum.iterations + cost.iterations,
            seconds: sum.seconds + cost.seconds,
        })
    }
}

impl Launcher<'_> {
    /// The outcome of a run, made now unless it is there.
    pub fn outcome(&self, study: &Study, run: &Run) -> Result<Outcome, Error> {
        let directory = self.output.join("runs").join(slug(&study.title)).join(format!("{}.out", run.name));
        let case = self.base.join(run.case.as_ref().unwrap_or(&study.case));
        let mut arguments = vec![case.display().to_string()];
        for set in study.set.iter().chain(&run.set) {
            arguments.extend(["--set".to_owned(), set.clone()]);
        }
        arguments.extend(["--quiet", "--force", "--output"].map(str::to_owned));
        arguments.push(directory.display().to_string());
        // The name of a run may have dots itself, those of numbers; the directory's ending takes the place of one.
        let (log, origin) = (directory.with_extension("log"), directory.with_extension("origin"));
        let made_from = self.origin(&case, &arguments);
        let mut code = None;
        if self.force || !is_there(&directory, &arguments, &origin, made_from.as_deref()) {
            // What an older run left must not pass for this one's, should it die before it writes.
            if directory.join(MANIFEST).exists() {
                fs::remove_dir_all(&directory)
                    .map_err(|source| Error::File(bsmpm_io::Error::file("delete", &directory)(source)))?;
            }
            if let Some(parent) = origin.parent() {
                super::make(parent)?;
            }
            super::write(&origin, made_from.as_deref().unwrap_or_default())?;
            code = Some(self.make(&arguments, &log)?);
        }
        Ok(read(directory, &log, code, run.may_stop))
    }

    /// Everything that a run is made from, as it stands now: the solver, its arguments, the text of the case. None where a
    /// part cannot be told, as of a solver that is not named by its path.
    fn origin(&self, case: &Path, arguments: &[String]) -> Option<String> {
        let text = fs::read_to_string(case).ok()?;
        let solver = fs::metadata(self.command.last()?).ok()?;
        let changed = solver.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos();
        let command = [self.command, arguments].concat().join(" ");
        Some(format!("{command}\nsolver: {} bytes, changed at {changed}\n\n{text}", solver.len()))
    }

    fn make(&self, arguments: &[String], log: &Path) -> Result<u8, Error> {
        let file = |source| Error::File(bsmpm_io::Error::file("write", log)(source));
        let out = File::create(log).map_err(file)?;
        let both = out.try_clone().map_err(file)?;
        let (program, first) = self
            .command
            .split_first()
            .ok_or_else(|| Error::Usage { reason: "the command that starts the solver is missing".to_owned() })?;
        let status = Command::new(program)
            .args(first)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(out)
            .stderr(both)
            .status()
            .map_err(|source| Error::Launch { program: program.clone(), source })?;
        Ok(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(u8::MAX))
    }
}

/// Whether the same run has ended there, made from what would be taken now.
fn is_there(directory: &Path, arguments: &[String], origin: &Path, made_from: Option<&str>) -> bool {
    let Ok(manifest) = Manifest::read(directory) else { return false };
    let is_whole = manifest.exit_code.is_some_and(|code| [DONE, CHECK].contains(&code) || STOPS.contains(&code));
    let is_same = made_from.is_some() && fs::read_to_string(origin).ok().as_deref() == made_from;
    is_whole && is_same && manifest.argv.ends_with(arguments)
}

/// What stands in a run's directory; a launcher may hide the program's own exit code, which is in the manifest.
fn read(directory: PathBuf, log: &Path, code: Option<u8>, may_stop: bool) -> Outcome {
    let manifest = Manifest::read(&directory).ok();
    let own = manifest.as_ref().and_then(|manifest| manifest.exit_code);
    let code = own.or(code).unwrap_or(u8::MAX);
    let history = table::read(&directory.join(HISTORY)).ok();
    let time = history.as_ref().and_then(|history| history.get("time")?.last().copied()).unwrap_or(0.0);
    let why = manifest.as_ref().and_then(|manifest| manifest.failure.as_ref()).map(|failure| failure.reason.clone());
    let why = why.unwrap_or_else(|| last_line(log));
    let (mut failure, mut stopped) = (None, None);
    match code {
        DONE | CHECK => {}
        code if may_stop && STOPS.contains(&code) => stopped = Some(format!("stopped at t = {time:.4}: {why}")),
        code => failure = Some(format!("exit code {code} at t = {time:.4}: {why}")),
    }
    let cost = manifest.map_or_else(Cost::default, |manifest| Cost {
        steps: manifest.summary.steps,
        cuts: manifest.summary.cutbacks,
        iterations: manifest.summary.iterations,
        seconds: manifest.timers.get("wall").copied().unwrap_or(0.0),
    });
    Outcome { directory, history, failure, stopped, code, cost }
}

/// The exit codes of runs, once if they are all the same.
pub(super) fn codes(outcomes: &[&Outcome]) -> String {
    let mut codes: Vec<String> = outcomes.iter().map(|outcome| outcome.code.to_string()).collect();
    if codes.iter().all(|code| *code == codes[0]) {
        codes.truncate(1);
    }
    codes.join(", ")
}

fn last_line(log: &Path) -> String {
    let text = fs::read_to_string(log).unwrap_or_default();
    text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it left no word").to_owned()
}

/// A title as the name of a directory.
pub(super) fn slug(title: &str) -> String {
    let letters =
        title.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '-' });
    let joined: String = letters.collect();
    joined.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}
