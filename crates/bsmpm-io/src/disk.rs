//! What the file system of a directory has left.

use std::io;
use std::path::Path;

use rustix::fs::statvfs;

/// Bytes that a program of this user may still write there; quotas are not seen.
///
/// # Errors
/// Those of the system.
pub fn free(folder: &Path) -> io::Result<u64> {
    let found = statvfs(folder)?;
    Ok(found.f_bavail.saturating_mul(found.f_frsize))
}
