//! Errors of commands, with their exit codes.

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
    #[error("E0844: the file `{}` with reference values cannot be used: {reason}. Correct this file.", path.display())]
    BadReference {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A picture could not be drawn.
    #[error(
        "E0845: the picture {} cannot be drawn: {reason}. This is a defect of the program. Report this message.",
        path.display()
    )]
    Drawing {
        /// The picture.
        path: PathBuf,
        /// What the library said.
        reason: String,
    },
    /// Rows of a validation have failed.
    #[error(
        "E0808: {failed} row(s) of the validation failed. Look for the reasons in table.md of the output \
        directory."
    )]
    NotValid {
        /// How many.
        failed: usize,
    },
    /// The case has errors, each of which has its code.
    #[error("{}\n{}: {} error(s); nothing was run", errors.join("\n"), path.display(), errors.len())]
    BadCase {
        /// The file.
        path: PathBuf,
        /// Each with its place.
        errors: Vec<String>,
    },
    /// The case has no factor of safety, or none that could be trusted; each reason has its code.
    #[error("{}\n{}: no factor of safety; nothing was run", reasons.join("\nerror "), path.display())]
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
        "E0826: only friction supports rigid body `{name}`. It slips in the trial run with the {value} {trial}. The \
         soil does not fail. Remove this direction from `free`, or use a [[traction]]."
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
    #[error(
        "E0854: on at least one grid a load has not reached its limit, so no limit load was found. Follow the \
        warnings below the table."
    )]
    NoLimitLoad,
    /// Tests of one point that a material cannot follow.
    #[error("E0853: {} element test(s) could not be completed:\n  {}", failed.len(), failed.join("\n  "))]
    Element {
        /// Each with its reason.
        failed: Vec<String>,
    },
    /// No run of several came to its end.
    #[error("E0834: no run was completed, so there are no results. Look for the reasons in the table {}.", table.display())]
    NoResult {
        /// The table of them.
        table: PathBuf,
    },
    /// A run that is needed ended for a reason of its own.
    #[error(
        "E0802: a run of this command failed with exit code {code} ({what}), so the result cannot be computed: \
         {reason}"
    )]
    Run {
        /// Which one.
        what: String,
        /// Its exit code.
        code: u8,
        /// Its last word.
        reason: String,
    },
    /// The solver could not be started.
    #[error("E0801: the solver `{program}` cannot be started: {source}. Give the path of `bsmpm-par` after `--`.")]
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
        let reason = format!(
            "E0842: {} is not the output directory of a run: it has no run.json. Give a directory that bsmpm-par \
             wrote.",
            directory.display()
        );
        Self::Missing { reason }
    }

    /// Those of a case, or of reference points, that cannot be read.
    pub(crate) fn unread(what: &str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Missing {
            reason: format!(
                "E0001: the {what} {} cannot be read: {source}. Check the path.",
                path.display()
            ),
        }
    }

    /// That of a case with errors.
    pub(crate) fn bad_case(path: &Path, errors: &[bsmpm_scene::Error]) -> Self {
        Self::BadCase {
            path: path.to_owned(),
            errors: errors.iter().map(|error| format!("{error:#}")).collect(),
        }
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
