//! `bsmpm fos`: the factor of safety of a case by strength reduction. The case is read in `subject`, factors are chosen in
//! `search`, trials are made in `trial` and judged in `curve`, results are set in `report` and drawn in `picture`.
//!
//! Loading soil is path dependent, so every trial carries its load from zero: a state of another strength is no state
//! on the way. What could be saved that way is taken from trials that run at the same time instead: `guess` tells which ones
//! the search may ask for next, `jobs` runs them. They shorten the search and change nothing else in it.

use std::env;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::thread;
use std::time::Instant;

use bsmpm_io::atomic;
use clap::Args;

use crate::Error;
use crate::launch::{self, Solver};

mod curve;
mod guess;
mod jobs;
mod picture;
mod report;
mod search;
mod subject;
mod trial;

use report::Report;
use search::{ELASTIC, GREATEST, Plan};
use subject::Subject;
use trial::{Trial, Trials};

const JSON: &str = "fos.json";
const CSV: &str = "fos.csv";
/// Narrower bands would show the rounding of displacements.
const NARROWEST: f64 = 1e-4;

/// What to search, and how.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Every trial is the case with [strength_reduction] factor = F, loaded from zero. Its largest displacement tells: the factor
of safety is where the branch after failure (5 to 20 times the elastic displacement), continued back, meets the branch
before it; coarsely, where the elastic displacement has doubled. Both are printed as bands [last stable, first failed]. A
trial without equilibrium counts as failed. The elastic displacement is that of the factor 0.1.

DIR gets fos.json, fos.csv, fos.png (displacement against factor), fos_plastic-strain.png and fos_displacement.png (the first
failed trial), and trials/. Trials that are there and were made from the same case by the same solver are kept.

The factors follow from the trials alone, as if each were made after the other. With --jobs above 1 those that may be asked
for next are begun in advance; they count only if they are asked for, so the result is the same for any N. One that cannot
be asked for any more gets TERM, which COMMAND must pass on, as mpirun and srun do; trials/ may hold more than the table.

Exit codes: 0 found, or stable up to TO (it says so); 2 command line; 65 the case has errors or no factor of safety; 66 no
such case; 80 no stable state was found; that of a trial that broke, as 70, 71, 73, 74.

Examples:
  bsmpm fos cases/slope_stability.toml
  bsmpm fos case.toml --width 0.01 --set grid.cell=\"0.5 m\" -o fine -- mpirun -n 4 bsmpm-par")]
pub struct Arguments {
    /// The case file: quasi-static, with a plastic material and a load
    pub case: PathBuf,
    /// The least factor
    #[arg(long, value_name = "FACTOR", default_value_t = 0.5)]
    pub from: f64,
    /// The greatest factor
    #[arg(long, value_name = "FACTOR", default_value_t = 3.0)]
    pub to: f64,
    /// The width of the bands
    #[arg(long, value_name = "WIDTH", default_value_t = 0.02)]
    pub width: f64,
    /// Trials at the same time; the result is the same for any N [default: the cores, divided by the launcher's ranks]
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
    /// Override one key of the case, as for bsmpm-par; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Where everything is written [default: the case's stem with .fos, in the working directory]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Repeat trials that are there already
    #[arg(long)]
    pub force: bool,
    /// The solver, with the launcher before it: words that bsmpm-par's arguments follow [default: the bsmpm-par beside this
    /// program, or that of PATH, on one rank]
    #[arg(last = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}

/// Searches; `told` gets a line for every trial as soon as it is there. Returns the table and the written pictures.
///
/// # Errors
/// Those of the command line and the case before anything runs; [`Error::NoStableState`]; [`Error::Trial`] for a trial that
/// broke; the errors of files.
pub fn run(arguments: &Arguments, mut told: impl FnMut(&str)) -> Result<(String, Vec<PathBuf>), Error> {
    let start = Instant::now();
    let command = if arguments.command.is_empty() { vec![own_solver()] } else { arguments.command.clone() };
    let (plan, jobs) = (arguments.plan()?, arguments.jobs(&command)?);
    // Whatever the number of jobs: threads in BLAS would sum in another order.
    let solver = Solver { command: &command, side_by_side: true };
    let subject = Subject::read(&arguments.case, &arguments.set, plan.from)?;
    solver.check()?;
    let output = arguments.directory();
    launch::make(&output)?;
    // Results of an older search must not pass for this one's, should it not come to its end.
    let older = [JSON, CSV].iter().chain(&picture::NAMES).map(|name| output.join(name)).filter(|path| path.exists());
    for path in older {
        fs::remove_file(&path).map_err(|source| Error::File(bsmpm_io::Error::file("delete", &path)(source)))?;
    }
    let trials = Trials { solver, subject: &subject, output: &output, force: arguments.force };
    let (curve, made) = jobs::find(plan, jobs, &trials, |trial| told(&line(trial)))?;
    let mut report = Report::of(&subject, plan, &command, &curve, made);
    report.jobs = jobs;
    report.seconds = start.elapsed().as_secs_f64();
    atomic::replace(&output.join(CSV), |file| file.write_all(report.csv().as_bytes()))?;
    atomic::replace(&output.join(JSON), |file| {
        serde_json::to_writer_pretty(&mut *file, &report)?;
        file.write_all(b"\n")
    })?;
    let pictures = picture::draw(&report, &subject, &output)?;
    Ok((report.text(), pictures.iter().map(|name| output.join(name)).collect()))
}

impl Arguments {
    fn plan(&self) -> Result<Plan, Error> {
        let usage = |reason: String| Err(Error::Usage { reason });
        let Self { from, to, width, .. } = *self;
        // Written so that what is no number is refused, too.
        if !(ELASTIC < from && from < to && to <= GREATEST) {
            return usage(format!("--from {from} --to {to}: allowed is {ELASTIC} < FROM < TO <= {GREATEST}"));
        }
        if !(NARROWEST <= width && width <= to - from) {
            return usage(format!("--width {width}: allowed is {NARROWEST} <= WIDTH <= TO - FROM"));
        }
        Ok(Plan { from, to, width })
    }

    fn jobs(&self, command: &[String]) -> Result<usize, Error> {
        if self.jobs == Some(0) {
            return Err(Error::Usage { reason: "--jobs 0: at least one trial runs at a time".to_owned() });
        }
        let cores = thread::available_parallelism().map_or(1, usize::from);
        Ok(self.jobs.unwrap_or_else(|| (cores / ranks(command)).max(1)))
    }

    fn directory(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| {
            let mut name = self.case.file_stem().unwrap_or_default().to_owned();
            name.push(".fos");
            PathBuf::from(name)
        })
    }
}

/// The solver beside this program; where there is none, that of PATH.
pub(crate) fn own_solver() -> String {
    let name = "bsmpm-par";
    let beside = env::current_exe().ok().and_then(|program| Some(program.parent()?.join(name)));
    beside.filter(|solver| solver.is_file()).map_or_else(|| name.to_owned(), |solver| solver.display().to_string())
}

/// The ranks that a launcher is asked for: the number after -n, -np, -c or --ntasks; one where it does not say.
pub(crate) fn ranks(command: &[String]) -> usize {
    let launcher = &command[..command.len().saturating_sub(1)];
    let options = ["-n", "-np", "-c", "--np", "--ntasks"];
    let after = launcher.windows(2).find(|pair| options.contains(&&*pair[0])).map(|pair| &*pair[1]);
    let joined = || launcher.iter().find_map(|word| word.strip_prefix("--ntasks=").or(word.strip_prefix("-n")));
    after.or_else(joined).and_then(|number| number.parse().ok()).filter(|&ranks| ranks > 0).unwrap_or(1)
}

fn line(trial: &Trial) -> String {
    let kept = if trial.kept { ", kept" } else { "" };
    let early = trial.end.early().map(|(load, reason)| format!(", ended at {load:.3} of the load: {reason}"));
    format!(
        "factor {}: displacement {:.4e} after {} iterations, {:.1} s{kept}{}",
        trial.factor,
        trial.displacement,
        trial.iterations,
        trial.seconds,
        early.unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use super::ranks;

    #[test]
    fn the_launcher_s_ranks_are_read() {
        let of = |command: &str| ranks(&command.split(' ').map(str::to_owned).collect::<Vec<_>>());
        assert_eq!((of("bsmpm-par"), of("mpirun -n 2 bsmpm-par"), of("mpirun -np 4 ./bsmpm-par")), (1, 2, 4));
        assert_eq!((of("srun --ntasks=8 bsmpm-par"), of("srun -n3 bsmpm-par"), of("srun bsmpm-par")), (8, 3, 1));
        assert_eq!((of("mpirun -n 0 bsmpm-par"), of("mpirun -n x bsmpm-par")), (1, 1));
    }
}
