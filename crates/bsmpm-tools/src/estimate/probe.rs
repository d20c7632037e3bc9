//! Makes trial runs in a temporary folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use bsmpm_io::checkpoint::FOLDER;
use bsmpm_io::steps::STEPS;
use bsmpm_io::table;
use bsmpm_scene::Case;
use tempfile::TempDir;

use super::coarse::{self, FACTORS};
use super::growth::{self, GrowthLevel};
use super::sizes::{self, Bytes};
use super::stored::{self, StoredEstimate};
use super::work::Effort;
use crate::Error;
use crate::launch::{LaunchTask, Outcome, RunState, SolverProgram};
use crate::slurm::clock;

/// Part of the time for probes that the first steps may take, and part of the case's steps.
const FIRST: [f64; 2] = [0.25, 0.2];
/// Steps that are made at least, if the case has them.
const LEAST: f64 = 3.0;
/// s  of processor time below which its account, in hundredths, is too coarse to be trusted.
const TRUSTED: f64 = 0.1;
/// How many times longer a form takes than the one with cells twice as large: four times the cells, and more
/// iterations.
const FINER: f64 = 6.0;
/// Part of the case's time that a form must reach to count.
const REACHED: f64 = 0.5;
/// Factor within which the time is expected, by the number of coarse forms.
const BANDS: [f64; 3] = [3.0, 1.75, 1.5];
/// Part of the iterations' work beyond which Newton's method makes it doubtful, as other cells may need it in most
/// steps or in none; and the factor then.
const NEWTON: [f64; 2] = [0.1, 4.0];

/// Part of the time left for probes that the whole case may take at most to be run, and bytes of its frames at most.
const WHOLE: (f64, u64) = (0.25, 1_000_000_000);
/// Factor within which the time of a case that was run whole is expected again.
const SURE: f64 = 1.25;

/// What is to be probed.
pub(super) struct ProbePlan<'a> {
    pub case: &'a Case,
    /// of the case's first steps
    pub ranks: usize,
    /// the solver
    pub command: &'a [String],
    /// whether the case may be run whole
    pub may_be_whole: bool,
}

/// A step.
#[derive(Clone, Copy)]
struct ProbeRow {
    /// s or pseudo-time  at its end
    time: f64,
    active_nodes: f64,
    work: Effort,
}

/// What a run left.
struct ProbeRun {
    outcome: Outcome,
    rows: Vec<ProbeRow>,
    directory: PathBuf,
}

impl ProbeRun {
    fn cpu(&self) -> f64 {
        self.outcome.cost.cpu_seconds
    }

    /// s  by the clock of phases that have timers
    fn clock(&self, phases: &[&str]) -> f64 {
        let timers = self.outcome.manifest.iter().flat_map(|manifest| &manifest.timers);
        timers
            .filter(|(phase, _)| phases.contains(&phase.as_str()))
            .map(|(_, seconds)| seconds)
            .sum()
    }

    fn work(&self) -> Effort {
        self.rows
            .iter()
            .map(|row| row.work)
            .fold(Effort::default(), |sum, work| sum.with(&work))
    }

    /// Bytes of the largest file in one of its folders.
    fn bytes(&self, folder: &str) -> Option<u64> {
        let files = fs::read_dir(self.directory.join(folder)).ok()?;
        files.filter_map(|file| Some(file.ok()?.metadata().ok()?.len())).max()
    }
}

/// Estimates from probes that end at about the deadline; `guess` is what they are planned by.
///
/// # Errors
/// [`Error::Run`] if the case's own first steps fail; [`Error::Launch`]; those of the folder.
pub(super) fn estimate(
    plan: &ProbePlan,
    guess: &StoredEstimate,
    deadline: Instant,
    report: &mut dyn FnMut(&str),
) -> Result<StoredEstimate, Error> {
    let folder = tempfile::Builder::new().prefix("bsmpm-estimate-").tempdir();
    let folder = folder.map_err(bsmpm_io::Error::file("make", &std::env::temp_dir()))?;
    let probes = Probes { plan, folder, deadline };
    let start = probes.of_case("start", 0.0)?;
    let wanted = FIRST[0] * probes.left() * guess.work.steps / (guess.unit * guess.work.units());
    let most = (FIRST[1] * guess.work.steps).max(LEAST);
    let first = probes.of_case("first", wanted.min(most).max(1.0).floor())?;
    let measured = measured(guess, &start, &first);
    let made = first.work();
    report(&format!(
        "first steps: {} with {} evaluations on {} rank(s), {:.2} CPU s besides {:.2} of the start",
        made.steps,
        made.evaluations,
        plan.ranks,
        (first.cpu() - start.cpu()).max(0.0),
        start.cpu()
    ));
    let until = first.rows.last().map_or(0.0, |row| row.time);
    let levels = probes.levels(guess, until, report)?;
    let (work, basis) = match growth::extrapolate(&levels, plan.case.analysis.regime, made.iterations()) {
        Some(work) => (
            work,
            format!(
                "first steps of the case, and {} coarse form(s) over all its time",
                levels.len()
            ),
        ),
        None if made.steps > 0.0 => (
            made.times(guess.work.steps / made.steps),
            "first steps of the case alone: later ones may take more".to_owned(),
        ),
        None => (
            guess.work,
            "the start of the case alone: no step ended in time".to_owned(),
        ),
    };
    let spread = levels.last().map_or(1.0, |level| {
        stored::spread(plan.case, plan.ranks, measured.unknowns, level.spread)
    });
    let unit = measured.unit * spread;
    let newton = levels
        .iter()
        .map(|level| level.work.newton_part())
        .fold(made.newton_part(), f64::max);
    let band = if newton > NEWTON[0] {
        NEWTON[1]
    } else {
        BANDS[levels.len().min(BANDS.len() - 1)]
    };
    let found = StoredEstimate {
        work,
        unit,
        basis,
        band,
        ..measured
    };
    let whole = probes.whole(&found, report)?;
    Ok(whole.unwrap_or(found))
}

/// What the case's own start and first steps tell of what a unit of work, a frame and the files cost.
fn measured(guess: &StoredEstimate, start: &ProbeRun, first: &ProbeRun) -> StoredEstimate {
    let frame = guess.frame.min(start.clock(&["frames"]));
    let taken = first.cpu() - start.cpu() - frame;
    let units = first.work().units();
    let clock = first.clock(&["step", "migration", "histories"]);
    let unit = match units > 0.0 {
        true if taken >= TRUSTED => taken / units,
        // No more than what passed by the clock.
        true if clock > 0.0 => guess.unit.min(clock / units),
        _ => guess.unit,
    };
    let bytes = Bytes {
        frame: start.bytes("frames").unwrap_or(guess.bytes.frame),
        checkpoint: start.bytes(FOLDER).unwrap_or(guess.bytes.checkpoint),
        ..guess.bytes
    };
    let unknowns = first
        .outcome
        .manifest
        .as_ref()
        .and_then(|manifest| manifest.sizes.get("unknowns").copied());
    StoredEstimate {
        unit,
        start: start.cpu(),
        frame,
        bytes,
        unknowns,
        ..guess.clone()
    }
}

struct Probes<'a> {
    plan: &'a ProbePlan<'a>,
    folder: TempDir,
    deadline: Instant,
}

impl Probes<'_> {
    /// s  until the deadline
    fn left(&self) -> f64 {
        self.deadline.saturating_duration_since(Instant::now()).as_secs_f64()
    }

    /// So many steps of the case itself.
    fn of_case(&self, name: &str, steps: f64) -> Result<ProbeRun, Error> {
        let most = format!("{steps:.0}");
        let run = self.run(name, &self.plan.case.text, &["--max-steps", &most], self.plan.ranks)?;
        match run.outcome.state {
            RunState::Done | RunState::Stopped if run.outcome.manifest.is_some() => Ok(run),
            _ => Err(run.outcome.error("the first steps of the case".to_owned())),
        }
    }

    /// Coarse forms, the finest one last; `until` is how far the case's first steps came.
    fn levels(
        &self,
        guess: &StoredEstimate,
        until: f64,
        report: &mut dyn FnMut(&str),
    ) -> Result<Vec<GrowthLevel>, Error> {
        let mut levels = Vec::new();
        let mut taken = None;
        for factor in FACTORS {
            let expected = taken.map_or(guess.unit * guess.work.units() / (factor * factor) as f64, |s: f64| {
                FINER * s
            });
            if expected > self.left() {
                break;
            }
            let Some(text) = coarse::text(self.plan.case, factor) else {
                continue;
            };
            let begin = Instant::now();
            let run = self.run(&format!("cells{factor}"), &text, &[], 1)?;
            taken = Some(begin.elapsed().as_secs_f64());
            let level = level(factor, &run, until, self.plan.case.analysis.end);
            report(&match &level {
                Some(level) => format!(
                    "cells {factor} times as large: {:.0} evaluations in {:.0} steps, {:.2} CPU s",
                    level.work.evaluations,
                    level.work.steps,
                    run.cpu()
                ),
                None => format!(
                    "cells {factor} times as large: not used, because this run ended early ({})",
                    run.outcome.reason
                ),
            });
            levels.extend(level);
        }
        Ok(levels)
    }

    /// What the whole case takes, if that is expected to be little.
    fn whole(&self, expected: &StoredEstimate, report: &mut dyn FnMut(&str)) -> Result<Option<StoredEstimate>, Error> {
        let case = self.plan.case;
        let frames = sizes::frames(case, expected.work.steps);
        let (part, bytes) = WHOLE;
        let is_little = self.plan.may_be_whole
            && expected.seconds(frames) * expected.band <= part * self.left()
            && frames.saturating_mul(expected.bytes.frame) <= bytes;
        if !is_little {
            return Ok(None);
        }
        let run = self.run("whole", &case.text, &[], self.plan.ranks)?;
        let work = run.work();
        let taken = run.cpu() - expected.start - expected.frame * frames.saturating_sub(1) as f64;
        if run.outcome.state != RunState::Done || work.units() <= 0.0 {
            report(&format!(
                "the whole case: not used, because this run ended early ({})",
                run.outcome.reason
            ));
            return Ok(None);
        }
        report(&format!(
            "the whole case: {} evaluations in {} steps, {:.2} CPU s",
            work.evaluations,
            work.steps,
            run.cpu()
        ));
        let basis = "the whole case, which takes no longer than probes may".to_owned();
        Ok(Some(StoredEstimate {
            work,
            unit: taken.max(0.0) / work.units(),
            band: SURE,
            basis,
            ..expected.clone()
        }))
    }

    /// A run on so many ranks, to the deadline at most.
    fn run(&self, name: &str, text: &str, further: &[&str], ranks: usize) -> Result<ProbeRun, Error> {
        let folder = self.folder.path();
        let case = folder.join(format!("{name}.toml"));
        let directory = folder.join(format!("{name}.out"));
        fs::write(&case, text).map_err(bsmpm_io::Error::file("write", &case))?;
        // A start takes a second or two of what may be the whole time.
        let wall = clock(self.left().ceil().max(2.0) as u64);
        let further = further
            .iter()
            .copied()
            .chain(["--max-wall", &wall])
            .map(str::to_owned)
            .collect();
        let command = if ranks == 1 {
            self.plan.command.to_vec()
        } else {
            on_ranks(ranks, self.plan.command)
        };
        let solver = SolverProgram {
            command: &command,
            side_by_side: true,
        };
        solver.check()?;
        let task = LaunchTask {
            case: &case,
            set: &[],
            further,
            directory: directory.clone(),
            origin: None,
            from: None,
            force: true,
            resume: false,
        };
        let outcome = solver.outcome(&task, |_| false)?;
        Ok(ProbeRun {
            outcome,
            rows: rows(&directory),
            directory,
        })
    }
}

fn on_ranks(ranks: usize, command: &[String]) -> Vec<String> {
    let launcher = ["mpirun".to_owned(), "-n".to_owned(), ranks.to_string()];
    [&launcher[..], command].concat()
}

/// The steps of a run; none where it left no table.
fn rows(directory: &Path) -> Vec<ProbeRow> {
    let Ok(columns) = table::read(&directory.join(STEPS)) else {
        return Vec::new();
    };
    let names = [
        "time",
        "active_nodes",
        "evaluations",
        "products",
        "factorisations",
        "cutbacks",
    ];
    let columns = names.map(|name| columns.get(name).unwrap_or_default());
    let length = columns.iter().map(|column| column.len()).min().unwrap_or(0);
    let mut rows = Vec::new();
    for k in 0..length {
        let [time, active_nodes, evaluations, products, factorisations, cutbacks] = columns.map(|column| column[k]);
        let work = Effort {
            steps: 1.0,
            evaluations,
            products,
            newton: (factorisations - 1.0 - cutbacks).max(0.0),
        };
        rows.push(ProbeRow {
            time,
            active_nodes,
            work,
        });
    }
    rows
}

/// What a coarse form reports, if it came far enough; the work of what it did not reach is taken as even.
fn level(factor: usize, run: &ProbeRun, until: f64, end: f64) -> Option<GrowthLevel> {
    let reached = run.rows.last()?.time / end;
    let first = run.rows.partition_point(|row| row.time <= until * (1.0 + 1e-9));
    let early = run.rows[..first].iter().map(|row| row.work.iterations()).sum();
    let all = mean_nodes(&run.rows);
    let before = mean_nodes(&run.rows[..first.max(1)]);
    let spread = if before > 0.0 { all / before } else { 1.0 };
    (reached >= REACHED).then(|| GrowthLevel {
        factor,
        work: run.work().times(1.0 / reached),
        early,
        spread,
    })
}

/// The mean number of active nodes.
fn mean_nodes(rows: &[ProbeRow]) -> f64 {
    rows.iter().map(|row| row.active_nodes).sum::<f64>() / rows.len() as f64
}
