//! Tests that values read from the files of a run are bitwise identical to those that were written.

mod checkpoint;
mod directory;
mod frames;
mod manifest;
mod residuals;
mod table;

use std::path::Path;

/// The names of everything below a directory, sorted.
fn listing(directory: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.file_type().unwrap().is_dir() {
            names.extend(listing(&entry.path()).iter().map(|inner| format!("{name}/{inner}")));
        } else {
            names.push(name);
        }
    }
    names.sort();
    names
}
