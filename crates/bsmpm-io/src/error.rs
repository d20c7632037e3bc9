//! Errors of files, with their exit codes.

use crate::exit;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Reason why a file of a run was not written or read.
#[derive(Debug, Error)]
pub enum Error {
    /// A quantity of a point is infinite or not a number; nothing was written.
    #[error(
        "E0760: `{}` was not written: component {component} of `{field}` of material point {point} is {value}. The state of the run \
         is invalid. Continue from an earlier checkpoint with smaller steps.",
        path.display()
    )]
    PointNotFinite {
        /// The file that was to be written.
        path: PathBuf,
        /// Name of the quantity; `position` for the positions of the points.
        field: String,
        /// The component, counted from 0.
        component: usize,
        /// The point's `id` if the frame has this field, else its index.
        point: u64,
        /// The number found.
        value: f64,
    },
    /// A number of a table or of the manifest is infinite or not a number; nothing was written.
    #[error(
        "E0761: `{}` was not written: {item} is {value}. The state of the run is invalid. Continue from an earlier checkpoint with \
         smaller steps.",
        path.display()
    )]
    NotFinite {
        /// The file that was to be written.
        path: PathBuf,
        /// The column and step, or the key.
        item: String,
        /// The number found.
        value: f64,
    },
    /// A field or a row has a different length from that of the frame or table.
    #[error(
        "E0762: `{}` was not written: {item} has {found} values, and {expected} are needed. This is a defect of the program. Report it.",
        path.display()
    )]
    Length {
        /// The file that was to be written.
        path: PathBuf,
        /// The field or row.
        item: String,
        /// Number of values needed.
        expected: usize,
        /// Number of values given.
        found: usize,
    },
    /// A name of a field or column is not allowed by the file format, or occurs twice.
    #[error(
        "E0763: `{}` was not written: the name \"{name}\" {reason}. The file format does not allow this name. Rename \
         the history, profile or material.",
        path.display()
    )]
    Name {
        /// The file that was to be written.
        path: PathBuf,
        /// The name.
        name: String,
        /// Reason why the name is not allowed.
        reason: &'static str,
    },
    /// The operating system refused to read or write a file.
    #[error(
        "E0764: the operating system cannot {action} `{}` ({}). The program stops. {}.",
        path.display(),
        cause(source),
        against(source)
    )]
    File {
        /// Action that failed: `read`, `write`, ...
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A file is damaged, or was not written by this program.
    #[error(
        "E0765: `{}` is damaged, or was not written by this program: {reason}. The file is not read. Run the case \
         again.",
        path.display()
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// Description of the defect.
        reason: String,
    },
    /// A checkpoint is damaged, or this program cannot continue from it.
    #[error(
        "E0720: checkpoint `{}` cannot be used: {reason}. The run was not continued. Name another checkpoint with \
         `--restart FILE`, or start again with `--force`.",
        path.display()
    )]
    Checkpoint {
        /// The file that was read.
        path: PathBuf,
        /// Description of the defect.
        reason: String,
    },
    /// The disk has not enough space for a file; nothing was written.
    #[error(
        "E0766: `{}` was not written: the file needs {needed} bytes, but {available}. Free space on the disk, and \
         continue with `--restart auto`.",
        path.display()
    )]
    Space {
        /// The file that was to be written.
        path: PathBuf,
        /// Bytes that it needs.
        needed: u64,
        /// Available space, in words.
        available: String,
    },
    /// The output directory cannot be created, opened or written to.
    #[error(
        "E0767: the operating system cannot {action} the output directory `{}` ({}). Nothing was run. Choose another \
         directory with `-o`.",
        path.display(),
        cause(source)
    )]
    Directory {
        /// Action that failed.
        action: &'static str,
        /// The directory.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// The path of the output directory is not a directory.
    #[error(
        "E0768: `{}` is not a directory. Results cannot be written there. Choose another path with `-o`.",
        path.display()
    )]
    NotDirectory {
        /// The path.
        path: PathBuf,
    },
    /// The output directory already contains a run.
    #[error(
        "E0769: output directory `{}` contains `{found}` of an earlier run. Nothing was run. {advice}.",
        path.display()
    )]
    Occupied {
        /// The directory.
        path: PathBuf,
        /// The first file of a run that was found.
        found: String,
        /// Remedy.
        advice: &'static str,
    },
    /// Another run has locked the output directory, and its process exists or cannot be examined.
    #[error(
        "E0770: output directory `{}` is in use by {holder}. Nothing was run. {advice}.",
        path.display()
    )]
    Locked {
        /// The directory.
        path: PathBuf,
        /// Process, host, job and time.
        holder: String,
        /// Remedy.
        advice: &'static str,
    },
    /// A `run.json` lists an output that this program would not have written there; nothing was deleted.
    #[error(
        "E0771: run.json in `{}` lists the output \"{name}\", which {reason}. `--force` deletes the listed files, but \
         deleted nothing because of this entry. Delete the old files yourself.",
        path.display()
    )]
    UnsafeOutput {
        /// The directory.
        path: PathBuf,
        /// The output's name.
        name: String,
        /// Reason why the entry is not trusted.
        reason: &'static str,
    },
}

impl Error {
    /// Returns the [exit code](crate::exit) of a program that ends with this error.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Directory { .. }
            | Self::NotDirectory { .. }
            | Self::Occupied { .. }
            | Self::Locked { .. }
            | Self::UnsafeOutput { .. } => exit::DIRECTORY,
            Self::PointNotFinite { .. } | Self::NotFinite { .. } => exit::LEFT,
            Self::Length { .. } | Self::Name { .. } => exit::BUG,
            Self::File { .. } | Self::Format { .. } | Self::Space { .. } => exit::WRITE,
            Self::Checkpoint { .. } => exit::CHECKPOINT,
        }
    }

    /// Returns the code of the cause, such as `E0764`: the first word of the message.
    pub fn code(&self) -> String {
        let text = self.to_string();
        text.split(':').next().unwrap_or_default().to_owned()
    }

    /// Converts a system error of `action` on the file `path`; for `map_err`.
    pub fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::File {
            action,
            path: path.to_owned(),
            source,
        }
    }

    /// Converts a system error of `action` on the output directory `path`; for `map_err`.
    pub(crate) fn directory(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Directory {
            action,
            path: path.to_owned(),
            source,
        }
    }

    pub(crate) fn checkpoint(path: &Path, reason: impl Into<String>) -> Self {
        Self::Checkpoint {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }

    pub(crate) fn format(path: &Path, reason: impl Into<String>) -> Self {
        Self::Format {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }
}

/// Returns the text of a system error.
fn cause(source: &io::Error) -> String {
    match source.kind() {
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        io::ErrorKind::NotADirectory => "a part of the path is a file, not a directory".to_owned(),
        _ => {
            let text = source.to_string();
            text.split(" (os error").next().unwrap_or(&text).to_owned()
        }
    }
}

/// Returns the remedy for a system error.
fn against(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::StorageFull => "Free space on the disk, and continue with `--restart auto`",
        _ => "Check the path, its permissions and the disk",
    }
}
