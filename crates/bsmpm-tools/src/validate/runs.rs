//! The runs of a study: started one after another, or taken as they are where nothing has changed since.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::SystemTime;

use bsmpm_io::directory::HISTORY;
use bsmpm_io::manifest::{MANIFEST, Manifest};
use bsmpm_io::table::{self, Columns};

use super::matrix::{Run, Study};
use crate::Error;

/// Exit codes of bsmpm-par: done, a check of the case failed, no convergence, material left the grid.
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
    pub cost: Cost,
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
        let case = self.base.join(&study.case);
        let mut arguments = vec![case.display().to_string()];
        for set in study.set.iter().chain(&run.set) {
            arguments.extend(["--set".to_owned(), set.clone()]);
        }
        arguments.extend(["--quiet", "--force", "--output"].map(str::to_owned));
        arguments.push(directory.display().to_string());
        let log = directory.with_extension("log");
        let mut code = None;
        if self.force || !self.is_there(&directory, &case, &arguments) {
            // What an older run left must not pass for this one's, should it die before it writes.
            if directory.join(MANIFEST).exists() {
                fs::remove_dir_all(&directory)
                    .map_err(|source| Error::File(bsmpm_io::Error::file("delete", &directory)(source)))?;
            }
            code = Some(self.make(&arguments, &log)?);
        }
        Ok(read(directory, &log, code, run.may_stop))
    }

    /// Whether the same run has ended, after its case and the solver were last changed.
    fn is_there(&self, directory: &Path, case: &Path, arguments: &[String]) -> bool {
        let Ok(manifest) = Manifest::read(directory) else { return false };
        let changed = |path: &Path| fs::metadata(path).and_then(|data| data.modified()).unwrap_or(SystemTime::now());
        let made = changed(&directory.join(MANIFEST));
        let solver = self.command.last().map_or(SystemTime::now(), |solver| changed(Path::new(solver)));
        manifest.exit_code.is_some() && manifest.argv.ends_with(arguments) && made > solver && made > changed(case)
    }

    fn make(&self, arguments: &[String], log: &Path) -> Result<u8, Error> {
        if let Some(parent) = log.parent() {
            super::make(parent)?;
        }
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
    Outcome { directory, history, failure, stopped, cost }
}

fn last_line(log: &Path) -> String {
    let text = fs::read_to_string(log).unwrap_or_default();
    text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it left no word").to_owned()
}

/// A title as the name of a directory.
fn slug(title: &str) -> String {
    let letters =
        title.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '-' });
    let joined: String = letters.collect();
    joined.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}
