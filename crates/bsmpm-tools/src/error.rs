//! What can go wrong in a command, with the exit code that it means.

use bsmpm_io::exit;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a command could not be carried out.
#[derive(Debug, Error)]
pub enum Error {
    /// What is needed is not there: a case, a run, something that it should have left, a file of reference points.
    #[error("{reason}")]
    Missing {
        /// What is missing, and where.
        reason: String,
    },
    /// Options do not fit each other or the runs.
    #[error("{reason}")]
    Usage {
        /// What does not fit.
        reason: String,
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
    /// A trial of a search failed because a rigid body slipped, which says nothing of the ground.
    #[error(
        "rigid body \"{name}\" slips in the trial of the {value} {trial}, and nothing else holds it: this is no failure of the \
         ground. Take that motion out of its `free`, increase its friction, or replace it by a [[traction]]"
    )]
    LooseBody {
        /// What trials differ by.
        value: &'static str,
        /// That of the trial.
        trial: f64,
        /// Of the body.
        name: String,
    },
    /// A load has reached no limit.
    #[error("E0854: a load has not reached its limit on every grid. Follow the warnings below the table.")]
    NoLimitLoad,
    /// Tests of one point that a material cannot follow.
    #[error("E0853: {} element test(s) could not be completed:\n  {}", failed.len(), failed.join("\n  "))]
    Element {
        /// Each with its reason.
        failed: Vec<String>,
    },
    /// No run of several came to its end.
    #[error("no run came to its end; {} says why", table.display())]
    NoResult {
        /// The table of them.
        table: PathBuf,
    },
    /// A run that is needed ended for a reason of its own.
    #[error("{what} ended with exit code {code}: {reason}")]
    Run {
        /// Which one.
        what: String,
        /// Its exit code.
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
    /// That of a directory that holds no run.
    pub(crate) fn no_run(directory: &Path) -> Self {
        Self::Missing { reason: format!("{} is not the directory of a run: it holds no run.json", directory.display()) }
    }

    /// Those of a case, or of reference points, that cannot be read.
    pub(crate) fn unread(what: &str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Missing { reason: format!("cannot read the {what} {}: {source}", path.display()) }
    }

    /// That of a case with errors.
    pub(crate) fn bad_case(path: &Path, errors: &[bsmpm_scene::Error]) -> Self {
        Self::BadCase { path: path.to_owned(), errors: errors.iter().map(|error| format!("{error:#}")).collect() }
    }

    /// The [exit code](bsmpm_io::exit) of `bsmpm`: that of a trial or probe that broke is the solver's.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage { .. } => exit::USAGE,
            Self::Missing { .. } => exit::MISSING,
            Self::BadReference { .. } | Self::BadCase { .. } | Self::NoFactor { .. } => exit::CASE,
            Self::NoStableState { .. }
            | Self::LooseBody { .. }
            | Self::NoResult { .. }
            | Self::Element { .. }
            | Self::NoLimitLoad => exit::NO_CONVERGENCE,
            Self::Run { code, .. } => *code,
            Self::NotValid { .. } => exit::CHECK,
            Self::Launch { .. } => exit::WRITE,
            Self::Drawing { .. } => exit::BUG,
            Self::File(error) => error.exit_code(),
        }
    }
}
