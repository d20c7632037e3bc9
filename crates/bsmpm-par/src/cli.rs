//! The command line of `bsmpm-par`.

use crate::launch::complain;
use bsmpm_io::disk::size;
use bsmpm_io::exit::USAGE;
use clap::{ArgAction, Parser, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;

/// Beginnings of the PETSc options that may follow `--`: methods, preconditioners and their reports, no files.
const PETSC_OPTIONS: [&str; 9] = [
    "-ksp_",
    "-pc_",
    "-mg_",
    "-sub_",
    "-redundant_",
    "-newton_",
    "-mat_mumps_",
    "-mat_superlu_dist_",
    "-mat_cholmod_",
];

/// Parts of names that do none the less: code of other languages is loaded, a server started, factors put into files.
const PETSC_REFUSED: [&str; 5] = ["python", "matlab", "saws", "_ooc", "mumps_icntl_22"];

/// How a run is logged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LogFormat {
    /// Lines for people.
    Text,
    /// One JSON object a line.
    Json,
}

/// How a run shows its progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressForm {
    /// A line on a terminal, lines elsewhere; none with -q, -v or a log of JSON.
    Auto,
    /// One line that is overwritten.
    Line,
    /// A line after 10 s and then every 2 minutes.
    Log,
    /// None.
    Off,
}

/// What a run goes on from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Restart {
    /// The newest good checkpoint, if there is one.
    Auto,
    /// This checkpoint and no other.
    From(PathBuf),
}

impl From<&str> for Restart {
    fn from(text: &str) -> Self {
        if text == "auto" {
            Self::Auto
        } else {
            Self::From(text.into())
        }
    }
}

/// Form of the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FrameFormat {
    /// One .vtu file a frame, and a .pvd file with their times.
    Vtu,
    /// One file; not available yet.
    Vtkhdf,
}

/// Implicit B-spline material point method: runs a case on one or more MPI ranks.
#[derive(Clone, Debug, Parser)]
#[command(name = "bsmpm-par", version)]
pub struct Arguments {
    /// The case file (TOML).
    pub case: PathBuf,
    /// Directory of the results [default: the name of the case with .out, in the working directory]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Change one key of the case, e.g. --set grid.cell="5 mm"; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Check the case and print its size; run nothing
    #[arg(long)]
    pub check: bool,
    /// Replace an earlier run in the output directory: delete the files that its run.json lists
    #[arg(long, conflicts_with = "restart")]
    pub force: bool,
    /// Take over the lock of the output directory from a run that may have ended, e.g. on another host
    #[arg(long)]
    pub break_lock: bool,
    /// Continue a run: from its newest intact checkpoint, or from the start if there is none (auto); or from this
    /// checkpoint
    #[arg(long, value_name = "auto|FILE")]
    pub restart: Option<Restart>,
    /// Stop after step N of the run (exit 75; 0 if the end was reached)
    #[arg(long, value_name = "N")]
    pub max_steps: Option<u64>,
    /// Stop with a checkpoint before this wall time has passed (exit 75)
    #[arg(long, value_name = "HH:MM:SS", value_parser = wall)]
    pub max_wall: Option<Duration>,
    /// File format of the frames
    #[arg(long, value_name = "FORMAT", default_value = "vtu")]
    pub frames: FrameFormat,
    /// Threads of each rank
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// Do not run a case that needs more memory than this on all ranks, e.g. 16GiB (exit 71) [default: the memory of
    /// the host of the first rank]
    #[arg(long, value_name = "SIZE", value_parser = size)]
    pub max_memory: Option<u64>,
    /// Do not start a run whose frames and checkpoints may not fit on the disk (exit 74), instead of a warning
    #[arg(long)]
    pub strict_space: bool,
    /// Print only warnings, errors and why a run ends early
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print a line for every step (-v), and every rejected attempt at a step (-vv)
    #[arg(short, long, action = ArgAction::Count)]
    pub verbose: u8,
    /// Show the progress: on a terminal by one line that is overwritten, elsewhere by a line every 2 minutes
    #[arg(long, value_name = "FORM", default_value = "auto")]
    pub progress: ProgressForm,
    /// Form of the log: text, or one JSON object a line with every event
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    pub log_format: LogFormat,
    /// Options for PETSc, after `--`, e.g. -- -ksp_type cg -pc_type gamg
    #[arg(last = true, value_name = "PETSC OPTIONS")]
    pub petsc: Vec<String>,
}

impl Arguments {
    /// Reads the process's arguments. Every rank does; only one of them should `print`. `Err` holds the exit code.
    pub fn read(print: bool) -> Result<Self, u8> {
        let arguments = Self::try_parse().map_err(|error| {
            if print {
                // Nothing is left to do where even the terminal is gone.
                let _ = error.print();
            }
            u8::try_from(error.exit_code()).unwrap_or(USAGE)
        })?;
        arguments.admissible().map_err(|reason| {
            if print {
                complain(&reason);
            }
            USAGE
        })?;
        Ok(arguments)
    }

    fn admissible(&self) -> Result<(), String> {
        if self.frames == FrameFormat::Vtkhdf {
            return Err("E0703: `--frames vtkhdf` is not available. Nothing was run. Use `--frames vtu`.".into());
        }
        petsc_options(&self.petsc)
    }

    /// Where the run is written.
    pub fn directory(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| {
            let mut name = self.case.file_stem().unwrap_or_default().to_owned();
            name.push(".out");
            PathBuf::from(name)
        })
    }

    /// The command that continues this run on so many ranks, as a shell reads it.
    pub fn continuing(&self, ranks: usize) -> String {
        let launcher = match std::env::var(COMMAND) {
            Ok(command) => command,
            Err(_) if ranks > 1 => format!("mpirun -n {ranks} bsmpm-par"),
            Err(_) => "bsmpm-par".into(),
        };
        let mut words = vec![launcher, quoted(&self.case.to_string_lossy())];
        words.extend(self.set.iter().map(|set| format!("--set {}", quoted(set))));
        words.extend(
            self.output
                .iter()
                .map(|directory| format!("-o {}", quoted(&directory.to_string_lossy()))),
        );
        words.extend((self.threads > 1).then(|| format!("--threads {}", self.threads)));
        words.push("--restart auto".into());
        if !self.petsc.is_empty() {
            words.push("--".into());
            words.extend(self.petsc.iter().map(|option| quoted(option)));
        }
        words.join(" ")
    }
}

/// The environment variable by which a script names the command that started the run.
const COMMAND: &str = "BSMPM_COMMAND";

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
    let is_plain = word
        .chars()
        .all(|letter| letter.is_ascii_alphanumeric() || "-_./=:,+@%".contains(letter));
    if !word.is_empty() && is_plain {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Refuses what could write files, attach debuggers or read more options.
fn petsc_options(options: &[String]) -> Result<(), String> {
    for option in options {
        let is_name = option.starts_with('-') && option.parse::<f64>().is_err();
        let begins = option == "-log_view" || PETSC_OPTIONS.iter().any(|beginning| option.starts_with(beginning));
        let allowed = begins && !PETSC_REFUSED.iter().any(|part| option.contains(part));
        if is_name && !allowed {
            return Err(format!(
                "E0704: the PETSc option {option} is not allowed. Nothing was run. Use options that begin with {} or -log_view.",
                PETSC_OPTIONS.join(", ")
            ));
        }
        if !is_name && PETSC_REFUSED.contains(&option.as_str()) {
            return Err(format!(
                "E0705: the value {option} of a PETSc option would load other code or write files. \
                Nothing was run. Remove this PETSc option."
            ));
        }
        if !is_name && option.contains([':', '/']) {
            return Err(format!(
                "E0706: the value {option} of a PETSc option names a file, which is not allowed. \
                Nothing was run. Remove this value."
            ));
        }
    }
    // The value would be a viewer, and some of those write files of their own choice of name: binary, hdf5, vtk, ...
    let viewer = options.windows(2).find(|pair| {
        let views = ["view", "monitor", "reason"].iter().any(|part| pair[0].contains(part));
        views && !pair[1].starts_with('-')
    });
    viewer.map_or(Ok(()), |pair| {
        let name = &pair[0];
        let value = &pair[1];
        Err(format!(
            "E0707: the PETSc option {name} has the value {value}, which PETSc would take as a file or \
            format. Nothing was run. Remove the value."
        ))
    })
}

fn wall(text: &str) -> Result<Duration, String> {
    let parts: Option<Vec<u64>> = text.split(':').map(|part| part.parse().ok()).collect();
    match parts.as_deref() {
        Some(&[hours, minutes, seconds]) if minutes < 60 && seconds < 60 && hours < 1_000_000 => {
            Ok(Duration::from_secs(hours * 3600 + minutes * 60 + seconds))
        }
        _ => Err(format!("{text} is not a time of the form HH:MM:SS")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bsmpm_io::exit::{MEMORY, STOPPED, WRITE};
    use clap::CommandFactory;

    #[test]
    fn the_help_names_the_codes_of_the_list() {
        let command = Arguments::command();
        let codes = [
            ("max_steps", STOPPED),
            ("max_wall", STOPPED),
            ("max_memory", MEMORY),
            ("strict_space", WRITE),
        ];
        for (option, code) in codes {
            let option = command
                .get_arguments()
                .find(|argument| argument.get_id() == option)
                .expect("an option");
            let help = option.get_help().expect("a help text").to_string();
            assert!(help.contains(&format!("(exit {code}")), "{help}");
        }
    }

    #[test]
    fn petsc_options_that_write_or_read_files_are_refused() {
        let refused =
            |options: &[&str]| petsc_options(&options.iter().map(|&o| o.to_owned()).collect::<Vec<_>>()).is_err();
        assert!(!refused(&[
            "-ksp_type",
            "cg",
            "-pc_type",
            "gamg",
            "-log_view",
            "-ksp_rtol",
            "1e-12"
        ]));
        assert!(refused(&["-log_view", ":pwned"]));
        assert!(refused(&["-log_view", "pwned"]));
        assert!(refused(&["-options_file", "x"]) && refused(&["-dll_append", "x"]) && refused(&["-dll_prepend", "x"]));
        assert!(refused(&["-pc_type", "python"]) && refused(&["-ksp_python_type", "x.y"]));
        assert!(refused(&["-mat_mumps_icntl_22", "1"]) && refused(&["-redundant_mat_mumps_ooc_tmpdir", "x"]));
        assert!(!refused(&["-mat_mumps_icntl_14", "200"]) && !refused(&["-ksp_max_it", "-1"]));
        assert!(refused(&["-ksp_monitor", "ascii:pwned"]));
        assert!(refused(&["-ksp_view_mat", "binary"]));
        assert!(refused(&["-on_error_attach_debugger"]));
    }

    #[test]
    fn the_command_that_continues_a_run_is_quoted_for_a_shell() {
        let given =
            "bsmpm-par it's.toml --force -q --set grid.cell=5_mm --max-steps 3 -o out --threads 2 -- -ksp_type cg";
        let given = given
            .split(' ')
            .map(|word| word.replace('_', " ").replace("ksp type", "ksp_type"));
        let arguments = Arguments::parse_from(given);
        let expected =
            "bsmpm-par 'it'\\''s.toml' --set 'grid.cell=5 mm' -o out --threads 2 --restart auto -- -ksp_type cg";
        assert_eq!(arguments.continuing(1), expected);
        assert!(arguments.continuing(3).starts_with("mpirun -n 3 bsmpm-par "));
    }

    #[test]
    fn sizes_and_times_are_read_with_their_units() {
        assert_eq!(size("16GiB"), Ok(16 << 30));
        assert!(size("many").is_err() && size("-1").is_err());
        assert_eq!(wall("01:02:03"), Ok(Duration::from_secs(3723)));
        assert!(wall("90").is_err() && wall("00:99:00").is_err());
    }
}
