//! What can go wrong in a command, with the exit code that it means.

use bsmpm_io::exit;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a command could not be carried out.
#[derive(Debug, Error)]
pub enum Error {
    /// The directory is not there or holds no run.
    #[error("{} is not the directory of a run: it holds no run.json", directory.display())]
    NoRun {
        /// The directory.
        directory: PathBuf,
    },
    /// The run has left nothing yet that could be drawn.
    #[error("the run in {} has left no frame, no history and no step yet", directory.display())]
    Empty {
        /// The directory.
        directory: PathBuf,
    },
    /// The run has left no row of its histories yet.
    #[error("the run in {} has left no row of history.csv yet", directory.display())]
    NoRow {
        /// The directory.
        directory: PathBuf,
    },
    /// The histories do not hold the column that is wanted.
    #[error("history.csv of {} has no column \"{column}\"; it has {known}", directory.display())]
    NoColumn {
        /// The directory.
        directory: PathBuf,
        /// What was wanted.
        column: String,
        /// The columns that there are.
        known: String,
    },
    /// The iterations of the step that is wanted were not kept.
    #[error("{} holds {reason}", directory.display())]
    NoResiduals {
        /// The directory.
        directory: PathBuf,
        /// What is missing.
        reason: String,
    },
    /// Options do not fit each other or the runs.
    #[error("{reason}")]
    Usage {
        /// What does not fit.
        reason: String,
    },
    /// The frames do not hold the quantity that is wanted.
    #[error("the frames of {} have no field \"{field}\"", directory.display())]
    NoField {
        /// The directory.
        directory: PathBuf,
        /// The field's name in the frames.
        field: &'static str,
    },
    /// A file of reference points is not there.
    #[error("cannot read the reference {}: {source}", path.display())]
    NoReference {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file of reference points cannot be understood.
    #[error("the reference {}: {reason}", path.display())]
    BadReference {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A picture could not be drawn.
    #[error("cannot draw {}: {reason}", path.display())]
    Drawing {
        /// The picture.
        path: PathBuf,
        /// What the library said.
        reason: String,
    },
    /// Rows of a validation have failed.
    #[error("{failed} row(s) of the validation failed")]
    NotValid {
        /// How many.
        failed: usize,
    },
    /// The case file is not there or cannot be read.
    #[error("cannot read the case {}: {source}", path.display())]
    NoCase {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The case has errors.
    #[error("{}\n{}: {} error(s); nothing was run", errors.join("\n"), path.display(), errors.len())]
    BadCase {
        /// The file.
        path: PathBuf,
        /// Each with its place.
        errors: Vec<String>,
    },
    /// The case has no factor of safety, or none that could be trusted.
    #[error("{} has no factor of safety:\n  {}\nnothing was run", path.display(), reasons.join("\n  "))]
    NoFactor {
        /// The file.
        path: PathBuf,
        /// All of them.
        reasons: Vec<String>,
    },
    /// No trial of a search found a stable state.
    #[error("{reason}")]
    NoStableState {
        /// What was found, and what to try.
        reason: String,
    },
    /// No run of several came to its end.
    #[error("no run came to its end; {} says why", table.display())]
    NoResult {
        /// The table of them.
        table: PathBuf,
    },
    /// A run that is needed did not come to its end.
    #[error("the run with {what} ended with exit code {code}: {reason}")]
    Run {
        /// Which one.
        what: String,
        /// Its exit code.
        code: u8,
        /// Its last word.
        reason: String,
    },
    /// A trial of a search ended for a reason that has nothing to do with equilibrium.
    #[error("the trial of the factor {factor} ended with exit code {code}: {reason} (whole in {})", log.display())]
    Trial {
        /// Its factor.
        factor: f64,
        /// Its exit code.
        code: u8,
        /// Its last word.
        reason: String,
        /// All its words.
        log: PathBuf,
    },
    /// A probe of an estimate ended for a reason that no estimate can be made from.
    #[error("the first steps of the case ended with exit code {code}: {reason}")]
    Probe {
        /// The exit code.
        code: u8,
        /// Its last word.
        reason: String,
    },
    /// The solver could not be started.
    #[error("cannot start {program}: {source}")]
    Launch {
        /// The first word of the command.
        program: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file of the run could not be read or a picture not be written.
    #[error(transparent)]
    File(#[from] bsmpm_io::Error),
}

impl Error {
    /// That of a case with errors.
    pub(crate) fn bad_case(path: &Path, errors: &[bsmpm_scene::Error]) -> Self {
        Self::BadCase { path: path.to_owned(), errors: errors.iter().map(|error| format!("{error:#}")).collect() }
    }

    /// The [exit code](bsmpm_io::exit) of `bsmpm`: that of a trial or probe that broke is the solver's.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage { .. } => exit::USAGE,
            Self::NoRun { .. }
            | Self::Empty { .. }
            | Self::NoRow { .. }
            | Self::NoColumn { .. }
            | Self::NoResiduals { .. }
            | Self::NoField { .. }
            | Self::NoReference { .. }
            | Self::NoCase { .. } => exit::MISSING,
            Self::BadReference { .. } | Self::BadCase { .. } | Self::NoFactor { .. } => exit::CASE,
            Self::NoStableState { .. } | Self::NoResult { .. } => exit::NO_CONVERGENCE,
            Self::Trial { code, .. } | Self::Run { code, .. } | Self::Probe { code, .. } => *code,
            Self::NotValid { .. } => exit::CHECK,
            Self::Launch { .. } => exit::WRITE,
            Self::Drawing { .. } => exit::BUG,
            Self::File(error) => error.exit_code(),
        }
    }
}
