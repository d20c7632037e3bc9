//! Points to compare with, from the literature or another program.

use std::fs;
use std::path::Path;

use bsmpm_io::table;

use crate::Error;

/// Reads the first two columns of a CSV file with a line of names; what stands in further columns does not matter, nor do
/// lines that begin with `#`. The name is that of the file.
pub(super) fn read(path: &Path) -> Result<(String, Vec<(f64, f64)>), Error> {
    let text = fs::read_to_string(path).map_err(|source| Error::NoReference { path: path.to_owned(), source })?;
    let bad = |reason| Error::BadReference { path: path.to_owned(), reason };
    let is_comment = |line: &&str| line.trim_start().starts_with('#');
    let pairs = text.lines().map(|line| if is_comment(&line) { String::new() } else { first_two(line) });
    let table = table::parse(&pairs.collect::<Vec<_>>().join("\n")).map_err(bad)?;
    let [x, y] = &table.values[..] else {
        return Err(bad("it needs two columns x,y with their names above".to_owned()));
    };
    let places: Vec<_> = x.iter().copied().zip(y.iter().copied()).collect();
    if places.is_empty() {
        return Err(bad("it holds a line of names, but no points".to_owned()));
    }
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().replace('_', " "));
    Ok((stem.unwrap_or_default(), places))
}

/// The first two cells of a line.
fn first_two(line: &str) -> String {
    line.split(',').take(2).collect::<Vec<_>>().join(",")
}
