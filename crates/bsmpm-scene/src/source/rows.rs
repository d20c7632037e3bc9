//! Rows of numbers from text files beside the case: `{ file = "record.csv", along = "x" }` in the place of a list.

use super::{MAX_BYTES, stl};
use crate::words::{Geometry, Word};
use bsmpm_messages::{code_of, without_code};
use std::io::{self, Error, ErrorKind, Read};
use std::ops::Range;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// A table in the place of rows, as it is written.
struct FileReference<'a> {
    span: Range<usize>,
    file: &'a str,
    along: Option<&'a str>,
}

/// The text of a case with the rows of all files that it names in their places, so that the case is whole by itself
/// from then on. Files are looked for beside the case, in `folder`.
///
/// # Errors
/// Those of reading; [`ErrorKind::InvalidData`] where a file does not hold rows of numbers.
pub(super) fn inlined(text: &str, folder: &Path) -> io::Result<String> {
    let (table, _) = DeTable::parse_recoverable(text);
    let geometry = table.get_ref().get("geometry").and_then(|value| value.get_ref().as_str());
    let axes = if geometry == Some(Geometry::Solid.word()) { ["x", "y", "z"].as_slice() } else { &["x", "y"] };
    let mut references = Vec::new();
    for value in table.get_ref().values() {
        collect(value, text, &mut references);
    }
    references.sort_by_key(|reference: &FileReference<'_>| reference.span.start);
    let (mut whole, mut from) = (String::with_capacity(text.len()), 0);
    for FileReference { span, file, along } in references {
        let in_file = |error: Error| Error::new(error.kind(), of_file(file, &error.to_string()));
        whole.push_str(&text[from..span.start]);
        let bytes = read(&folder.join(file)).map_err(in_file)?;
        let found = if stl::is_binary(&bytes) {
            stl::triangles(&bytes)
        } else if file.to_ascii_lowercase().ends_with(".stl") && bytes.contains(&0) {
            Err(stl::broken(&bytes))
        } else {
            text_rows(bytes, (along, axes))
        };
        whole.push_str(&found.map_err(in_file)?);
        from = span.end;
    }
    whole.push_str(&text[from..]);
    Ok(whole)
}

/// A message with the file that it concerns behind its code.
fn of_file(file: &str, message: &str) -> String {
    match code_of(message) {
        Some(code) => format!("{code}: {file}: {}", without_code(message)),
        None => format!("{file}: {message}"),
    }
}

/// The axis that a file names, if it does, and those that the geometry has.
type AxisNames<'a> = (Option<&'a str>, &'a [&'a str]);

/// Rows of whatever text holds them.
fn text_rows(bytes: Vec<u8>, along: AxisNames<'_>) -> io::Result<String> {
    let text = String::from_utf8(bytes).map_err(|_| Error::new(ErrorKind::InvalidData, "no UTF-8 text"))?;
    let begins = |word: &str| text.trim_start().get(..word.len()).is_some_and(|of| of.eq_ignore_ascii_case(word));
    if begins("PEER") || text.lines().take(4).any(|line| line.trim_start().to_ascii_uppercase().starts_with("NPTS")) {
        return Err(Error::new(ErrorKind::InvalidData, PEER));
    }
    match (begins("ncols"), begins("solid")) {
        (true, _) => grid(&text),
        (_, true) => stl::facets(&text),
        _ => rows(&text, along),
    }
}

/// Of a record as the databases of ground motions write it.
const PEER: &str = "E0049: this is a record in PEER's format (.AT2), which is not read. Write a text file with the columns \
                    `t [s], a [g]`, one row per sample: t is the number of the row times DT.";

/// The bytes of a file that is not longer than a case may be.
fn read(path: &Path) -> io::Result<Vec<u8>> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(Error::new(ErrorKind::InvalidInput, "not a regular file"));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > MAX_BYTES {
        let message = format!("more than {MAX_BYTES} bytes, the limit of a whole case; thin the rows to the steps");
        return Err(Error::new(ErrorKind::InvalidData, message));
    }
    Ok(bytes)
}

/// Inline tables with a `file`, and nothing else but perhaps `along`.
fn collect<'a>(value: &'a toml::Spanned<DeValue<'_>>, text: &str, references: &mut Vec<FileReference<'a>>) {
    match value.get_ref() {
        DeValue::Array(items) => items.iter().for_each(|item| collect(item, text, references)),
        DeValue::Table(table) => {
            let word = |key: &str| table.get(key).and_then(|value| value.get_ref().as_str());
            let is_known = table.keys().all(|key| ["file", "along"].contains(&&**key.get_ref()));
            match word("file") {
                Some(file) if is_known && text[value.span()].starts_with('{') => {
                    references.push(FileReference { span: value.span(), file, along: word("along") });
                }
                _ => table.values().for_each(|value| collect(value, text, references)),
            }
        }
        _ => {}
    }
}

/// Rows as TOML: numbers, with the units of a header if there is one. Cells stand between commas, semicolons or blanks;
/// `#` starts a comment. Rows of two, a time and a number `along` an axis, get zeros along the others.
fn rows(text: &str, (along, axes): AxisNames<'_>) -> io::Result<String> {
    let bad = |message: String| Error::new(ErrorKind::InvalidData, message);
    if let Some(other) = along.filter(|along| !axes.contains(along)) {
        return Err(bad(format!("along = \"{other}\"; allowed: \"{}\"", axes.join("\", \""))));
    }
    if let Some(heading) = hidden(text) {
        return Err(bad(format!("`{heading}` looks like a heading with units behind a `#`; take the # away")));
    }
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let lines = lines.map(|(number, line)| (number + 1, line.split('#').next().unwrap_or_default().trim()));
    let (mut units, mut width, mut whole) = (Vec::new(), None, String::from("["));
    for (number, line) in lines.filter(|(_, line)| !line.is_empty()) {
        let cells = cells(line);
        if width.is_none() && units.is_empty() && cells.iter().all(|cell| cell.parse::<f64>().is_err()) {
            units = cells.iter().map(|cell| unit(cell).map(str::to_owned)).collect();
            continue;
        }
        let expected = *width.get_or_insert(if units.is_empty() { cells.len() } else { units.len() });
        if cells.len() != expected {
            return Err(bad(format!("line {number} has {} cells, not {expected}", cells.len())));
        }
        if along.is_some() && expected != 2 {
            return Err(bad(format!("along needs two columns, a time and a number; line {number} has {expected}")));
        }
        let mut row = Vec::with_capacity(cells.len() + 1);
        for (column, cell) in cells.iter().enumerate() {
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            let value = value.ok_or_else(|| bad(format!("line {number}: `{cell}` is no number")))?;
            row.push(match units.get(column) {
                Some(Some(unit)) => format!("\"{value:?} {unit}\""),
                _ => format!("{value:?}"),
            });
        }
        if let (Some(along), Some(number)) = (along, row.get(1).cloned()) {
            row.truncate(1);
            row.extend(axes.iter().map(|axis| if *axis == along { number.clone() } else { "0.0".to_owned() }));
        }
        whole.push_str(&format!("[{}],", row.join(",")));
    }
    if width.is_none() {
        return Err(bad("no row of numbers".to_owned()));
    }
    whole.push(']');
    Ok(whole)
}

/// Rows [x, y, z] as TOML of an ASCII grid: a header of ncols, nrows, xllcorner or xllcenter, the same along y,
/// cellsize and perhaps nodata_value, then heights row by row from the north. Posts are the middles of the cells.
fn grid(text: &str) -> io::Result<String> {
    let bad = |message: String| Error::new(ErrorKind::InvalidData, message);
    let mut words = text.split_whitespace().peekable();
    let mut header = std::collections::BTreeMap::new();
    while let Some(key) = words.next_if(|word| word.parse::<f64>().is_err()) {
        let value = words.next().and_then(|word| word.parse::<f64>().ok()).filter(|value| value.is_finite());
        header.insert(key.to_ascii_lowercase(), value.ok_or_else(|| bad(format!("{key}: no number in the header")))?);
    }
    let given = |key: &str| header.get(key).copied();
    let needed = |key: &str| given(key).ok_or_else(|| bad(format!("the header has no {key}")));
    let (columns, lines, cell) = (needed("ncols")?, needed("nrows")?, needed("cellsize")?);
    let first = |axis: &str| match given(&format!("{axis}llcenter")) {
        Some(center) => Ok(center),
        None => needed(&format!("{axis}llcorner")).map(|corner| corner + 0.5 * cell),
    };
    let (x, y) = (first("x")?, first("y")?);
    let heights: Vec<&str> = words.collect();
    if columns < 2.0 || lines < 2.0 || columns.fract() + lines.fract() != 0.0 || cell <= 0.0 {
        return Err(bad("ncols and nrows are whole numbers above 1, and cellsize is above 0".to_owned()));
    }
    if heights.len() as f64 != columns * lines {
        return Err(bad(format!("{} heights, not ncols x nrows = {}", heights.len(), columns * lines)));
    }
    let mut whole = String::from("[");
    for (number, height) in heights.iter().enumerate() {
        let (row, column) = (number / columns as usize, number % columns as usize);
        let value = height.parse::<f64>().ok().filter(|value| value.is_finite());
        let value =
            value.ok_or_else(|| bad(format!("row {}, column {}: `{height}` is no number", row + 1, column + 1)))?;
        if given("nodata_value") == Some(value) {
            return Err(bad(format!("row {}, column {}: no data: fill it, or cut the grid", row + 1, column + 1)));
        }
        let at = [x + column as f64 * cell, y + (lines - 1.0 - row as f64) * cell];
        whole.push_str(&format!("[{:?},{:?},{value:?}],", at[0], at[1]));
    }
    whole.push(']');
    Ok(whole)
}

/// A comment before the first row that has a unit, where no plain heading has any: its units would be lost.
fn hidden(text: &str) -> Option<&str> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().map(str::trim).filter(|line| !line.is_empty());
    let before = lines.by_ref().take_while(|line| line.starts_with('#'));
    let comment =
        before.filter(|line| cells(line).len() > 1 && cells(line).into_iter().all(|cell| unit(cell).is_some()));
    comment.last()
}

fn cells(line: &str) -> Vec<&str> {
    let separator = [';', ',', '\t'].into_iter().find(|separator| line.contains(*separator));
    match separator {
        Some(separator) => line.split(separator).map(|cell| cell.trim().trim_matches('"')).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// The unit in a heading such as `ax [m/s2]` or `t (s)`.
fn unit(heading: &str) -> Option<&str> {
    let heading = heading.strip_suffix([']', ')'])?;
    let (_, unit) = heading.rsplit_once(['[', '('])?;
    Some(unit.trim()).filter(|unit| !["", "-", "1"].contains(unit) && !unit.contains('"'))
}

#[cfg(test)]
mod tests {
    use super::{grid, rows};

    const PLANE: &[&str] = &["x", "y"];

    #[test]
    fn ascii_grids_are_rows_of_the_middles_of_their_cells() {
        let header = "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n";
        let parsed = grid(&format!("{header}1 2\n3 4\n")).unwrap();
        assert_eq!(parsed, "[[11.0,3.0,1.0],[13.0,3.0,2.0],[11.0,1.0,3.0],[13.0,1.0,4.0],]");
        let message = |text: &str| grid(text).unwrap_err().to_string();
        assert_eq!(message(&format!("{header}1 2\n3 -9999\n")), "row 2, column 2: no data: fill it, or cut the grid");
        assert_eq!(message(&format!("{header}1 2\n3\n")), "3 heights, not ncols x nrows = 4");
        assert_eq!(message("ncols 2\nnrows 2\n1 2\n3 4"), "the header has no cellsize");
        assert_eq!(message("ncols x\n"), "ncols: no number in the header");
        assert_eq!(message(&format!("{header}1 2\n3 nan\n")), "row 2, column 2: `nan` is no number");
    }

    #[test]
    fn units_comments_and_separators_are_read() {
        let plain = "[[0.0,1.5],[0.1,-2.0],]";
        for text in ["0 1.5\n0.1 -2\n", "# a record\n0,1.5\n\n.1, -2.0 # end\n", "\u{feff}0;1.5\r\n1e-1;-2\r\n"] {
            assert_eq!(rows(text, (None, PLANE)).unwrap(), plain);
        }
        let parsed = rows("t [s], a (cm/s2)\n0.02, 3\n", (Some("x"), PLANE)).unwrap();
        assert_eq!(parsed, "[[\"0.02 s\",\"3.0 cm/s2\",0.0],]");
        assert_eq!(rows("t a\n1 2", (Some("y"), PLANE)).unwrap(), "[[1.0,0.0,2.0],]");
        assert_eq!(rows("1 2", (Some("y"), &["x", "y", "z"])).unwrap(), "[[1.0,0.0,2.0,0.0],]");
    }

    #[test]
    fn what_is_no_row_of_numbers_is_refused_with_its_line() {
        let message = |text: &str, along| rows(text, (along, PLANE)).unwrap_err().to_string();
        assert_eq!(message("0,1\n2,x", None), "line 2: `x` is no number");
        assert_eq!(message("0,1\n2", None), "line 2 has 1 cells, not 2");
        assert_eq!(message("t, ax\n", None), "no row of numbers");
        assert_eq!(message("0,nan", None), "line 1: `nan` is no number");
        assert_eq!(message("0,1,2", Some("x")), "along needs two columns, a time and a number; line 1 has 3");
        let hidden = "`# t [s], a [g]` looks like a heading with units behind a `#`; take the # away";
        assert_eq!(message("# t [s], a [g]\n0,1", Some("x")), hidden);
        assert_eq!(message("0,1", Some("z")), "along = \"z\"; allowed: \"x\", \"y\"");
    }
}
