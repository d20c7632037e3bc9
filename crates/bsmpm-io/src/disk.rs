//! Free disk space, and sizes as text.

use std::io;
use std::path::Path;

use rustix::fs::statvfs;

/// Returns the bytes that this user may still write in `folder`; quotas are ignored.
///
/// # Errors
/// The error of the system.
pub fn free(folder: &Path) -> io::Result<u64> {
    let found = statvfs(folder)?;
    Ok(found.f_bavail.saturating_mul(found.f_frsize))
}

/// Returns a number of bytes from text such as `800MB` or `16GiB`.
///
/// # Errors
/// A text if `text` is not a size.
pub fn size(text: &str) -> Result<u64, String> {
    bytes(text).ok_or_else(|| format!("{text} is no size; expected e.g. 800MB, 16GiB"))
}

/// Returns the number of bytes that `text` states; `None` if it is not a size.
fn bytes(text: &str) -> Option<u64> {
    let split = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let number: f64 = text[..split].trim().parse().ok()?;
    let factor = match text[split..].trim() {
        "" | "B" => 1.0,
        "kB" => 1e3,
        "MB" => 1e6,
        "GB" => 1e9,
        "KiB" => 1024.0,
        "MiB" => 1024.0 * 1024.0,
        "GiB" => 1024.0 * 1024.0 * 1024.0,
        _ => return None,
    };
    let bytes = number * factor;
    (1.0..1e18).contains(&bytes).then_some(bytes as u64)
}
