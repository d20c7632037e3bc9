//! `bsmpm slurm`: writes a job script that requeues an unfinished run.

use std::ffi::OsStr;
use std::fs::File;
use std::io::Write;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bsmpm_io::exit::{CASE, STOPPED};
use bsmpm_messages::without_code;
use bsmpm_scene::Case;
use clap::Args;

use crate::{Error, case};

/// Seconds before the end of the job at which Slurm signals the ranks to stop, where the job is long enough.
const NOTICE: u64 = 300;
/// Shortest job: a start, a step and a checkpoint must fit.
const SHORTEST: u64 = 120;
/// Longest name of a job.
const LONGEST_NAME: usize = 64;

/// What job is wanted.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The script asks Slurm for a USR1 five minutes before the end and stops by itself five minutes earlier (--max-wall), in jobs
under twenty minutes a quarter and half of the time before the end. A run that stopped with a good checkpoint (code 75) is
queued again and goes on from there; every other end is the job's own, with the run's exit code. What a site needs besides
(account, partition, modules) is given to sbatch, or added to the script.

Exit codes: 0 written; 2 command line; 65 the case has errors; 66 no such case; 74 the script could not be written.

Examples:
  bsmpm slurm case.toml -n 64 -t 24:00:00 | sbatch -A project -p standard
  bsmpm slurm case.toml -n 64 -t 2-00:00:00 -o run1 --script job.sh -- srun --mpi=pmix bsmpm-par")]
pub struct SlurmArguments {
    /// The case file
    pub case: PathBuf,
    /// Ranks
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub ranks: u32,
    /// Time limit of the job, HH:MM:SS or D-HH:MM:SS
    #[arg(short, long, value_name = "TIME", value_parser = limit)]
    pub time: Duration,
    /// Where the run is written [default: the case's stem with .out]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Name of the job [default: the case's stem]; other characters than letters, digits, . _ - become _
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// Override one key of the case, as for bsmpm-par; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Write the script into a new file [default: to stdout]
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// The solver, with the launcher before it: words that bsmpm-par's arguments follow [default: srun bsmpm-par]
    #[arg(last = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}

/// Writes the script, or returns it where it is for stdout; `report` gets what is doubtful.
///
/// # Errors
/// [`Error::Missing`] and [`Error::BadCase`] before anything is written; those of the script's file.
pub fn run(arguments: &SlurmArguments, mut report: impl FnMut(&str)) -> Result<Option<Vec<u8>>, Error> {
    let path = &arguments.case;
    let case = case::parsed(path, &case::load(path)?, &arguments.set)?;
    case.warnings_on(arguments.ranks as usize)
        .iter()
        .for_each(|warning| report(warning));
    if let Some(doubt) = doubt(&case, arguments.ranks.into()) {
        report(&doubt);
    }
    let script = arguments.script();
    let Some(file) = &arguments.script else {
        return Ok(Some(script));
    };
    let written = File::create_new(file).and_then(|mut file| file.write_all(&script));
    written.map_err(bsmpm_io::Error::file("write", file))?;
    Ok(None)
}

/// Warns of more ranks than the grid can be divided among, or than make the run faster.
fn doubt(case: &Case, ranks: u64) -> Option<String> {
    let count = ranks as usize;
    let useful = case.estimate(count).useful_ranks;
    if case.parts(count, [1; 2]).is_none() {
        let reason = case.too_many(count);
        return Some(format!(
            "W0855: the job would end at once with exit code {CASE}. Reason: {}",
            without_code(&reason)
        ));
    }
    (ranks > useful).then(|| {
        format!(
            "W0856: the run is not faster on {ranks} ranks than on about {useful}, because ranks wait for each other. Use --ranks \
             {useful}."
        )
    })
}

impl SlurmArguments {
    fn script(&self) -> Vec<u8> {
        let seconds = self.time.as_secs();
        let notice = NOTICE.min(seconds / 4);
        let ranks = self.ranks;
        let name = self.job_name();
        let mut script = format!(
            "#!/bin/bash\n\
             #SBATCH --job-name={name}\n\
             #SBATCH --ntasks={ranks}\n\
             #SBATCH --time={}\n\
             #SBATCH --requeue\n\
             #SBATCH --open-mode=append\n\
             #SBATCH --signal=USR1@{notice}\n\n\
             export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1\n",
            clock(seconds)
        )
        .into_bytes();
        for (number, word) in self.words(&clock(seconds - 2 * notice)).iter().enumerate() {
            script.extend_from_slice(if number == 0 { b"" } else { b" " });
            script.extend(quoted(word));
        }
        script.extend_from_slice(
            format!(
                "\nrc=$?\n\
              # {STOPPED}: stopped in time, with a good checkpoint. Every other end is the job's own.\n\
              if [ \"$rc\" -eq {STOPPED} ]; then\n    \
                  scontrol requeue \"$SLURM_JOB_ID\" && exit 0\n\
              fi\n\
              exit \"$rc\"\n"
            )
            .as_bytes(),
        );
        script
    }

    /// The command line of the run.
    fn words(&self, wall: &str) -> Vec<Vec<u8>> {
        let own = ["srun".to_owned(), "bsmpm-par".to_owned()];
        let command = if self.command.is_empty() {
            &own[..]
        } else {
            &self.command
        };
        let output = self
            .output
            .clone()
            .unwrap_or_else(|| case::directory(&self.case, ".out"));
        let mut words: Vec<Vec<u8>> = command.iter().map(|word| word.as_bytes().to_vec()).collect();
        words.push(file(&self.case));
        words.extend([b"-o".to_vec(), file(&output), b"--restart".to_vec(), b"auto".to_vec()]);
        words.extend([b"--max-wall".to_vec(), wall.as_bytes().to_vec()]);
        words.extend(self.set.iter().map(|set| format!("--set={set}").into_bytes()));
        words
    }

    /// A name that neither Slurm nor its log file's name can take for something else.
    fn job_name(&self) -> String {
        let given = self
            .name
            .as_deref()
            .map(OsStr::new)
            .or(self.case.file_stem())
            .unwrap_or_default();
        let given = given.to_string_lossy();
        let plain = given.replace(
            |c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-')),
            "_",
        );
        let name: String = plain.chars().take(LONGEST_NAME).collect();
        let name = name.trim_start_matches(['-', '.']);
        if name.is_empty() {
            "bsmpm".to_owned()
        } else {
            name.to_owned()
        }
    }
}

/// A path that is no option.
fn file(path: &Path) -> Vec<u8> {
    let bytes = path.as_os_str().as_bytes();
    if bytes.starts_with(b"-") {
        [b"./", bytes].concat()
    } else {
        bytes.to_vec()
    }
}

/// A word as the shell reads it back, byte for byte.
fn quoted(word: &[u8]) -> Vec<u8> {
    let mut bytes = word.iter();
    let is_plain = bytes.all(|byte| byte.is_ascii_alphanumeric() || b"_-./:+,@%".contains(byte));
    if !word.is_empty() && is_plain {
        return word.to_vec();
    }
    let inner = word
        .iter()
        .flat_map(|byte| if *byte == b'\'' { b"'\\''".to_vec() } else { vec![*byte] });
    std::iter::once(b'\'')
        .chain(inner)
        .chain(std::iter::once(b'\''))
        .collect()
}

/// HH:MM:SS
pub(crate) fn clock(seconds: u64) -> String {
    format!("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

/// HH:MM:SS or D-HH:MM:SS.
fn limit(text: &str) -> Result<Duration, String> {
    let Some(seconds) = seconds(text) else {
        return Err(format!("`{text}` is not a time limit. Use HH:MM:SS or D-HH:MM:SS"));
    };
    if seconds < SHORTEST {
        return Err(format!(
            "{text} is too short for a start, a step and a checkpoint. Use at least {}",
            clock(SHORTEST)
        ));
    }
    Ok(Duration::from_secs(seconds))
}

/// Returns the seconds of HH:MM:SS or D-HH:MM:SS.
fn seconds(text: &str) -> Option<u64> {
    let (days, rest) = text.split_once('-').unwrap_or(("0", text));
    let [hours, minutes, seconds] = rest.split(':').collect::<Vec<_>>()[..] else {
        return None;
    };
    let hours = 24 * number(days, 365)? + number(hours, 9999)?;
    Some(hours * 3600 + number(minutes, 59)? * 60 + number(seconds, 59)?)
}

/// Reads a number of at most five digits that is not above `most`.
fn number(part: &str, most: u64) -> Option<u64> {
    let is_number = part.len() <= 5 && part.bytes().all(|byte| byte.is_ascii_digit());
    let number = part.parse().ok()?;
    (is_number && number <= most).then_some(number)
}
