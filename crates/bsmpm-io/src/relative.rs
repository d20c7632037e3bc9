//! Checks that file names stay within the output directory.

use std::path::{Component, Path};

/// Returns whether a path is relative and stays within its folder.
pub(crate) fn is_plain_relative(name: &str) -> bool {
    let mut parts = Path::new(name).components().peekable();
    parts.peek().is_some() && parts.all(|part| matches!(part, Component::Normal(_)))
}
