//! Test helper: runs the program in a scratch directory, and reads its results.

#![allow(dead_code)] // every test program takes its part of this

pub mod bounds;
pub mod cases;
pub mod circles;
pub mod conic;
pub mod driver;
pub mod footings;
pub mod limit_analysis;
pub mod processes;
pub mod results;
pub mod slips;

pub use processes::{Ears, Output, Running};

use bsmpm_trials::executable;
use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The program under test.
pub fn program() -> &'static str {
    executable("bsmpm-par").to_str().expect("a path in UTF-8")
}

/// After this long a run counts as hanging.
const PATIENCE: Duration = Duration::from_secs(120);

/// A shipped case.
pub fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name)
}

/// An example of the crates under test.
pub fn example(name: &str) -> PathBuf {
    executable(name).to_owned()
}

/// A directory in which runs are started; it goes with everything in it.
pub struct Scratch(tempfile::TempDir);

impl Scratch {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// With the text of a case in `case.toml`.
    pub fn with_case(text: &str) -> Self {
        let scratch = Self::new();
        scratch.write("case.toml", text);
        scratch
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Names of everything that is directly in it, sorted.
    pub fn entries(&self) -> Vec<String> {
        entries(self.0.path())
    }

    /// A run of the program on `ranks` ranks with this directory as the working directory.
    pub fn mpirun(&self, ranks: usize, arguments: &[&str]) -> Output {
        self.job(Some(ranks), arguments).run()
    }

    /// The case on so many ranks in one run, to `whole{ranks}`, and in parts that end after so many steps, to
    /// `part{ranks}`: their histories are the same to the bit.
    #[track_caller]
    pub fn goes_on(&self, ranks: usize, stops: &[&str]) {
        let [whole, part] = ["whole", "part"].map(|name| format!("{name}{ranks}"));
        self.mpirun(ranks, &["case.toml", "-q", "-o", &whole]).expect(0);
        let on = ["case.toml", "-q", "-o", &part, "--restart", "auto"];
        for stop in stops {
            self.mpirun(ranks, &[&on[..], &["--max-steps", stop]].concat())
                .expect(75);
        }
        self.mpirun(ranks, &on).expect(0);
        let text = |name: &str| std::fs::read_to_string(self.path(name).join("history.csv")).unwrap();
        assert!(text(&whole) == text(&part), "{ranks} ranks");
    }

    /// A run without a launcher.
    pub fn direct(&self, arguments: &[&str]) -> Output {
        self.job(None, arguments).run()
    }

    /// A run to which more is to be said.
    pub fn job(&self, ranks: Option<usize>, arguments: &[&str]) -> Job {
        let arguments = arguments.iter().map(|&argument| argument.to_owned().into()).collect();
        Job {
            directory: self.0.path().to_owned(),
            ranks,
            arguments,
            variables: Vec::new(),
            patience: PATIENCE,
            ears: Ears::Open,
            limit: None,
        }
    }
}

/// Names of everything that is directly in a directory, sorted.
pub fn entries(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// A run before it is started.
pub struct Job {
    directory: PathBuf,
    ranks: Option<usize>,
    arguments: Vec<OsString>,
    variables: Vec<(String, String)>,
    patience: Duration,
    ears: Ears,
    limit: Option<String>,
}

impl Job {
    /// With a limit that the shell sets in every rank, e.g. `-v 600000`.
    pub fn limited(mut self, limit: &str) -> Self {
        self.limit = Some(limit.to_owned());
        self
    }

    /// With an environment variable.
    pub fn variable(mut self, name: &str, value: &str) -> Self {
        self.variables.push((name.to_owned(), value.to_owned()));
        self
    }

    /// With another time after which it counts as hanging.
    pub fn within(mut self, seconds: u64) -> Self {
        self.patience = Duration::from_secs(seconds);
        self
    }

    /// With one more argument, which need not be UTF-8.
    pub fn argument(mut self, argument: &[u8]) -> Self {
        self.arguments.push(OsString::from_vec(argument.to_owned()));
        self
    }

    /// With streams that take nothing: every write to them fails.
    pub fn unheard(mut self) -> Self {
        self.ears = Ears::Full;
        self
    }

    /// With streams whose reader has gone away.
    pub fn abandoned(mut self) -> Self {
        self.ears = Ears::Gone;
        self
    }

    /// Runs to the end. Panics if that does not come, or if a process of the run outlives it.
    pub fn run(self) -> Output {
        self.start().end()
    }

    /// Starts it when all others that were started so have ended.
    pub fn start(self) -> Running {
        let ears = self.ears;
        let patience = self.patience;
        let variables = self.variables.clone();
        processes::start(self.command(), &variables, ears, patience)
    }

    /// Starts it at once, beside a run that goes on.
    pub fn start_beside(self) -> Running {
        let ears = self.ears;
        let patience = self.patience;
        let variables = self.variables.clone();
        processes::start_beside(self.command(), &variables, ears, patience)
    }

    fn command(self) -> Command {
        let shell = self.limit.map(|limit| format!("ulimit {limit} && exec \"$0\" \"$@\""));
        let words = shell
            .iter()
            .flat_map(|line| ["sh", "-c", line])
            .chain([program()])
            .collect::<Vec<_>>();
        let mut command = match self.ranks {
            None => Command::new(words[0]),
            Some(ranks) => {
                let mut launcher = Command::new("mpirun");
                launcher.args(["-q", "--oversubscribe", "-n", &ranks.to_string(), words[0]]);
                launcher
            }
        };
        command
            .args(&words[1..])
            .args(self.arguments)
            .current_dir(self.directory);
        command
    }
}
