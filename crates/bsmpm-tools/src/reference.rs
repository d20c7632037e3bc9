//! Reads reference curves from the literature, a laboratory or another program.

use std::fs;
use std::path::Path;

use bsmpm_io::table::{self, Columns};

use crate::Error;

/// A table of reference points; it must have a column `time` or be a function of one of the histories.
pub(crate) fn columns(path: &Path) -> Result<Columns, Error> {
    let text = fs::read_to_string(path).map_err(Error::unread("reference", path))?;
    parsed(path, &text, "it needs the columns time,x,y, or time and a history")
}

/// The first two columns of a CSV file with a line of names; what stands in further columns does not matter, nor do
/// lines that begin with `#`. The name is that of the file.
pub(crate) fn places(path: &Path) -> Result<(String, Vec<[f64; 2]>), Error> {
    let text = fs::read_to_string(path).map_err(Error::unread("reference", path))?;
    let mut pairs = Vec::new();
    for line in text.lines() {
        pairs.push(match line.trim_start().starts_with('#') {
            true => String::new(),
            false => first_two(line),
        });
    }
    let pairs = pairs.join("\n");
    let table = parsed(path, &pairs, "it needs two columns x,y below a line with their names")?;
    let rows = table.values[0].iter().zip(&table.values[1]);
    let places: Vec<[f64; 2]> = rows.map(|(&x, &y)| [x, y]).collect();
    if places.is_empty() {
        let reason = "it has a line of names, but no points".to_owned();
        return Err(Error::BadReference {
            path: path.to_owned(),
            reason,
        });
    }
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().replace('_', " "));
    Ok((stem.unwrap_or_default(), places))
}

/// The table in a text, with two columns at least.
fn parsed(path: &Path, text: &str, needed: &str) -> Result<Columns, Error> {
    let table = table::parse(text).and_then(|table| match table.headings.len() >= 2 {
        true => Ok(table),
        false => Err(needed.to_owned()),
    });
    table.map_err(|reason| Error::BadReference {
        path: path.to_owned(),
        reason,
    })
}

/// The first two cells of a line.
fn first_two(line: &str) -> String {
    line.split(',').take(2).collect::<Vec<_>>().join(",")
}
