//! Errors of reading and writing.

use thiserror::Error;

/// The outcome of a call.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a file was not written or not read.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum Error {
    /// HDF5 refused; its own words, innermost first.
    #[error("HDF5 cannot {action}: {reason}")]
    Library {
        /// What was tried.
        action: String,
        /// What HDF5 said.
        reason: String,
    },
    /// Writing failed on this rank while the others may still wait for it within HDF5, and HDF5 may crash when it
    /// closes the file: the job must be ended at once, without a normal exit. The only error that is not agreed on.
    #[error("HDF5 failed while it wrote {name}: {reason}")]
    Torn {
        /// The array.
        name: String,
        /// What HDF5 said.
        reason: String,
    },
    /// The file holds what this library never writes.
    #[error("{item} {reason}")]
    Foreign {
        /// The array or the part of the file.
        item: String,
        /// What is strange about it.
        reason: String,
    },
    /// Only other ranks failed.
    #[error("another rank failed")]
    OtherRank,
}

impl Error {
    /// What is strange about a part of the file.
    pub(crate) fn foreign(item: impl Into<String>, reason: &str) -> Self {
        Self::Foreign {
            item: item.into(),
            reason: reason.to_owned(),
        }
    }

    /// What is strange about the array `name`.
    pub(crate) fn foreign_array(name: &str, reason: &str) -> Self {
        Self::foreign(format!("the array {name}"), reason)
    }
}
