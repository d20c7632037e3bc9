//! Joins keys to paths such as `body.0.box.upper`.

/// Path of a key of the table at `path`, which is empty for the file itself.
pub(crate) fn join(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_owned()
    } else {
        format!("{path}.{key}")
    }
}
