//! Command-line options of commands that make a batch.

use std::path::{Path, PathBuf};
use std::time::Duration;

use bsmpm_io::disk;
use clap::Args;

use super::{Batch, Limits, memory};
use crate::launch::{self, SolverProgram, command};
use crate::{Error, case};

/// How the runs are made, and where they are written.
#[derive(Clone, Debug, Args)]
pub struct Options {
    /// Number of runs at the same time [default: the cores, divided by the ranks]
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
    /// Number of MPI ranks of each run, started by mpirun
    #[arg(long, value_name = "R", default_value_t = 1, value_parser = ranks, conflicts_with = "command")]
    pub ranks: usize,
    /// Memory that simultaneous runs may use together by their estimates, e.g. 16GiB [default: the free memory]
    #[arg(long, value_name = "SIZE", value_parser = disk::size)]
    pub max_memory: Option<u64>,
    /// Stop each run after this wall time; the same command continues it later
    #[arg(long, value_name = "HH:MM:SS", value_parser = wall)]
    pub max_wall: Option<Duration>,
    /// Override one key of the case in all runs, as for bsmpm-par; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Output directory [default: name of the case with an ending for the command, in the working directory]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Repeat runs that are complete already
    #[arg(long)]
    pub force: bool,
    /// Command that starts the solver, with a launcher if there is one [default: bsmpm-par next to this program or in
    /// PATH]
    #[arg(last = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}

impl Options {
    /// The words that start a run.
    pub(crate) fn words(&self) -> Vec<String> {
        command::words(&self.command, self.ranks)
    }

    /// Where everything about the case at `path` is written; `kind` ends the name that is chosen without `--output`.
    pub(crate) fn directory(&self, path: &Path, kind: &str) -> PathBuf {
        self.output.clone().unwrap_or_else(|| case::directory(path, kind))
    }

    /// Runs of the case at `path` by `command`, its [`words`](Self::words), below `output`, which is made.
    ///
    /// # Errors
    /// Those of the command line, of a solver that is not there, of the directory.
    pub(crate) fn batch<'a>(
        &self,
        command: &'a [String],
        path: &'a Path,
        output: &'a Path,
    ) -> Result<Batch<'a>, Error> {
        let limits = Limits {
            jobs: command::jobs(self.jobs, command)?,
            memory: memory(self.max_memory),
        };
        let solver = SolverProgram {
            command,
            side_by_side: true,
        };
        solver.check()?;
        launch::make(output)?;
        Ok(Batch {
            solver,
            path,
            output,
            limits,
            max_wall: self.max_wall,
            force: self.force,
        })
    }
}

fn ranks(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|ranks| (1..=100_000).contains(ranks))
        .ok_or_else(|| "expected a number from 1 to 100000".to_owned())
}

/// HH:MM:SS
fn wall(text: &str) -> Result<Duration, String> {
    let parts: Option<Vec<u64>> = text
        .split(':')
        .map(|part| part.parse().ok().filter(|part| *part < 100_000))
        .collect();
    match parts.as_deref() {
        Some(&[hours, minutes, seconds]) if minutes < 60 && seconds < 60 && hours + minutes + seconds > 0 => {
            Ok(Duration::from_secs(3600 * hours + 60 * minutes + seconds))
        }
        _ => Err("expected a duration HH:MM:SS".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_and_times_are_read() {
        assert_eq!(
            (wall("01:02:03"), wall("0:0:5")),
            (Ok(Duration::from_secs(3723)), Ok(Duration::from_secs(5)))
        );
        assert!(
            ["", "5", "0:0:0", "0:60:0", "a:b:c", "1:2:3:4"]
                .iter()
                .all(|text| wall(text).is_err())
        );
        assert!(ranks("0").is_err() && ranks("4") == Ok(4));
    }
}
