//! The case of all faults, and its uninterrupted runs.

use crate::support::driver::Depth;
use crate::support::results::{manifest, steps};
use crate::support::{Job, Running, Scratch, entries, example, processes, shipped};
use bsmpm_io::manifest::{Manifest, Status};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::rc::Rc;
use std::time::Duration;

/// Steps between the checkpoints of the case.
pub const INTERVAL: u64 = 5;
/// s  Far more than a run of the case takes, on cores that it shares.
const HANGS: u64 = 120;
/// Where trials write.
pub const RUN: &str = "run";

/// The list of a run's frames.
const LIST: &str = "frames.pvd";

/// What all rows share.
pub struct Ground {
    pub depth: Depth,
    text: String,
    wholes: RefCell<BTreeMap<usize, Rc<Whole>>>,
}

/// An uninterrupted run.
pub struct Whole {
    pub scratch: Scratch,
    pub results: Results,
    /// by the clock, launching included
    pub seconds: f64,
    /// accepted
    pub steps: u64,
}

/// What a run left, by name: a file's bytes, or the arrays of its last checkpoint.
pub type Results = BTreeMap<String, Vec<u8>>;

impl Ground {
    /// In the short run the case ends after 30 of its 60 steps, a few after the one that is cut.
    pub fn new(depth: Depth) -> Self {
        let text = std::fs::read_to_string(shipped("faults/mini_footing.toml")).unwrap();
        let part = ["end  = \"0.3 s\"", "end  = \"0.15 s\""];
        assert!(text.contains(part[0]), "the end of the case");
        let text = if depth == Depth::Short {
            text.replace(part[0], part[1])
        } else {
            text
        };
        Self {
            depth,
            text,
            wholes: RefCell::default(),
        }
    }

    /// The uninterrupted run on so many ranks.
    pub fn whole(&self, ranks: usize) -> Rc<Whole> {
        if let Some(whole) = self.wholes.borrow().get(&ranks) {
            return Rc::clone(whole);
        }
        let trial = self.trial(ranks);
        let seconds = trial.start(&[], &[]).end().expect(0).elapsed.as_secs_f64();
        let results = results(&trial.directory());
        let steps = manifest(&trial.directory()).summary.steps;
        let whole = Rc::new(Whole {
            scratch: trial.scratch,
            results,
            seconds,
            steps,
        });
        self.wholes.borrow_mut().insert(ranks, Rc::clone(&whole));
        whole
    }

    /// A new run on so many ranks.
    pub fn trial(&self, ranks: usize) -> Trial {
        Trial {
            scratch: Scratch::with_case(&self.text),
            ranks,
        }
    }

    /// The text of the case.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// A run that has stopped after so many steps, with a checkpoint of them and the one of the steps before.
    pub fn stopped(&self, ranks: usize, steps: u64) -> Trial {
        let trial = self.trial(ranks);
        trial.start(&["--max-steps", &steps.to_string()], &[]).end().expect(75);
        trial
    }
}

/// A run in a directory of its own.
pub struct Trial {
    pub scratch: Scratch,
    pub ranks: usize,
}

impl Trial {
    pub fn directory(&self) -> PathBuf {
        self.scratch.path(RUN)
    }

    /// The folder of its checkpoints, or a file in it.
    pub fn checkpoint(&self, name: &str) -> PathBuf {
        self.directory().join("checkpoint").join(name)
    }

    /// What starts it, or lets it go on.
    pub fn job(&self, further: &[&str]) -> Job {
        let arguments = [&["case.toml", "-q", "-o", RUN, "--restart", "auto"], further].concat();
        self.scratch.job(Some(self.ranks), &arguments).within(HANGS)
    }

    /// Starts it, or lets it go on.
    pub fn start(&self, further: &[&str], variables: &[(&str, &str)]) -> Running {
        variables
            .iter()
            .fold(self.job(further), |job, (name, value)| job.variable(name, value))
            .start()
    }

    /// Starts it, and waits until it has made so many steps and a share of the next one's time.
    pub fn under_way(&self, steps: u64, share: f64, variables: &[(&str, &str)]) -> Running {
        let mut running = self.start(&[], variables);
        let begun = || self.directory().join("run.json").exists();
        running.until("its steps", || if steps == 0 { begun() } else { self.made() >= steps });
        std::thread::sleep(Duration::from_secs_f64(0.15 * share));
        running
    }

    /// Steps that it has reported so far.
    pub fn made(&self) -> u64 {
        let text = std::fs::read_to_string(self.directory().join("steps.csv")).unwrap_or_default();
        text.lines().count().saturating_sub(2) as u64
    }

    /// Where it went on the last time.
    pub fn resumed_from(&self) -> u64 {
        manifest(&self.directory())
            .restarts
            .last()
            .map_or(0, |restart| restart.step)
    }

    /// Asserts that its manifest has a warning once; `-q` keeps them from the log.
    #[track_caller]
    pub fn has_warned(&self, words: &str) {
        let warnings = manifest(&self.directory()).warnings;
        assert_eq!(
            warnings.iter().filter(|warning| warning.contains(words)).count(),
            1,
            "{words:?}: {warnings:?}"
        );
    }

    /// Lets it go on to its end, at once.
    pub fn finish(&self) {
        self.start(&[], &[]).end().expect(0);
        self.is_clean();
    }

    /// Lets it go on to its end, which is the uninterrupted run's to the bit; the steps that it had to make again.
    pub fn becomes(&self, whole: &Whole) -> u64 {
        let made = self.made();
        // It may have been over before it was struck, or not have begun.
        let is_over = Manifest::read(&self.directory()).is_ok_and(|run| run.status == Status::Finished);
        self.finish();
        same(&results(&self.directory()), &whole.results);
        if is_over {
            0
        } else {
            made.saturating_sub(self.resumed_from())
        }
    }

    /// Asserts that nothing is left that a run which goes on should have taken away.
    pub fn is_clean(&self) {
        let there = entries(&self.directory());
        assert!(!there.iter().any(|name| name.contains("lock")), "{there:?}");
        let folder = self.checkpoint("");
        let there = if folder.exists() { entries(&folder) } else { Vec::new() };
        assert!(!there.iter().any(|name| name.starts_with('.')), "{there:?}");
    }

    /// Another run that is the same so far.
    pub fn copy(&self) -> Self {
        let copy = Self {
            scratch: Scratch::new(),
            ranks: self.ranks,
        };
        std::fs::copy(self.scratch.path("case.toml"), copy.scratch.path("case.toml")).unwrap();
        copy_all(&self.directory(), &copy.directory());
        copy
    }
}

fn copy_all(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for name in entries(from) {
        let from = from.join(&name);
        let to = to.join(&name);
        if from.is_dir() {
            copy_all(&from, &to);
        } else {
            std::fs::copy(from, to).unwrap();
        }
    }
}

/// Everything that must be the same: histories, steps but for the seconds and messages that they took (who goes on
/// numbers the unknowns again), frames, the state at the end.
pub fn results(directory: &Path) -> Results {
    let read = |name: &str| (name.to_owned(), std::fs::read(directory.join(name)).unwrap());
    let mut results: Results = ["history.csv", LIST].map(read).into();
    let frames = entries(&directory.join("frames"));
    results.extend(frames.iter().map(|name| read(&format!("frames/{name}"))));
    let steps = steps(directory);
    let cost = ["wall", "messages", "bytes"];
    let columns = steps.headings.iter().zip(&steps.values);
    let free: Vec<_> = columns
        .filter(|(column, _)| !cost.contains(&column.name.as_str()))
        .collect();
    results.insert("steps.csv but for its cost".into(), format!("{free:?}").into_bytes());
    if let Some(checkpoint) = manifest(directory).checkpoint {
        results.insert("checkpoint".into(), arrays(&directory.join(checkpoint)).into_bytes());
    }
    results
}

/// Asserts that two runs left the same. A run that stopped has a frame of that state besides, and keeps it.
#[track_caller]
pub fn same(found: &Results, expected: &Results) {
    let beside: Vec<&String> = found.keys().filter(|name| !expected.contains_key(*name)).collect();
    assert!(
        beside.iter().all(|name| name.starts_with("frames/")),
        "beside: {beside:?}"
    );
    for (name, bytes) in expected.iter().filter(|(name, _)| *name != LIST || beside.is_empty()) {
        let there = found.get(name).unwrap_or_else(|| panic!("{name} is not there"));
        assert!(there == bytes, "{name} differs from the uninterrupted run's");
    }
    let listed = String::from_utf8_lossy(&found[LIST]);
    let frames = found.keys().filter(|name| name.starts_with("frames/"));
    frames.for_each(|name| assert_eq!(listed.matches(name.as_str()).count(), 1, "{name} in {LIST}"));
}

/// The same, where fewer frames were asked for.
#[track_caller]
pub fn same_but_for_frames(found: &Results, expected: &Results) {
    let mut fewer = expected.clone();
    fewer.retain(|name, _| name == "checkpoint" || found.contains_key(name));
    fewer.insert(LIST.to_owned(), found[LIST].clone());
    let last = expected.keys().rfind(|name| name.ends_with(".vtu")).expect("a frame");
    assert!(fewer.contains_key(last), "the last frame");
    same(found, &fewer);
}

/// What a checkpoint holds, as a text.
fn arrays(file: &Path) -> String {
    let mut command = Command::new(example("arrays"));
    command.arg(file);
    processes::start_beside(command, &[], crate::support::Ears::Open, Duration::from_secs(HANGS))
        .end()
        .expect(0)
        .stdout
}

/// Numbers between 0 and 1 that fill the interval evenly, others for each `salt`.
pub fn spread(index: usize, salt: usize) -> f64 {
    (0.5 + index as f64 * 0.618_033_988_75 + salt as f64 * 0.414_213_562_37).fract()
}
