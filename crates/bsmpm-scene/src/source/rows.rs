//! Reads rows of numbers from files that a case names: `{ file = "record.csv" }`.

use super::{LIMIT, MAX_BYTES, bounded, invalid};
use crate::shape_error;
use crate::words::{Geometry, Word};
use bsmpm_messages::with_context;
use bsmpm_shapes::{StlError, heights, stl};
use std::io::{self, Error};
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
/// Those of reading; [`io::ErrorKind::InvalidData`] where a file does not hold rows of numbers.
pub(super) fn inlined(text: &str, folder: &Path) -> io::Result<String> {
    let (table, _) = DeTable::parse_recoverable(text);
    let geometry = table
        .get_ref()
        .get("geometry")
        .and_then(|value| value.get_ref().as_str());
    let axes = if geometry == Some(Geometry::Solid.word()) {
        ["x", "y", "z"].as_slice()
    } else {
        &["x", "y"]
    };
    let mut references = Vec::new();
    for value in table.get_ref().values() {
        collect(value, text, &mut references);
    }
    references.sort_by_key(|reference: &FileReference<'_>| reference.span.start);
    let mut whole = String::with_capacity(text.len());
    let mut from = 0;
    for FileReference { span, file, along } in references {
        let in_file = |error: Error| Error::new(error.kind(), with_context(&error.to_string(), file));
        whole.push_str(&text[from..span.start]);
        let bytes = read(&folder.join(file)).map_err(in_file)?;
        let found = rows_of(file, bytes, along, axes);
        whole.push_str(&found.map_err(in_file)?);
        from = span.end;
    }
    whole.push_str(&text[from..]);
    Ok(whole)
}

/// Rows of a file, whose format follows from its name and its bytes: `along` the axis that the case names for it, of
/// the `axes` of the geometry.
fn rows_of(file: &str, bytes: Vec<u8>, along: Option<&str>, axes: &[&str]) -> io::Result<String> {
    let name = file.to_ascii_lowercase();
    if name.ends_with(".at2") {
        Err(invalid(PEER))
    } else if stl::is_binary(&bytes) {
        triangles(stl::binary(&bytes))
    } else if name.ends_with(".stl") && bytes.contains(&0) {
        Err(invalid(shape_error::of_stl(&stl::broken(&bytes))))
    } else {
        text_rows(bytes, along, axes)
    }
}

/// Rows of whatever text holds them.
fn text_rows(bytes: Vec<u8>, along: Option<&str>, axes: &[&str]) -> io::Result<String> {
    let text = String::from_utf8(bytes);
    let text = text.map_err(|_| invalid("E0002: the file is not UTF-8 text. Save it as UTF-8."))?;
    if begins(&text, "PEER")
        || text
            .lines()
            .take(4)
            .any(|line| line.trim_start().to_ascii_uppercase().starts_with("NPTS"))
    {
        return Err(invalid(PEER));
    }
    if begins(&text, "ncols") {
        grid(&text)
    } else if begins(&text, "solid") {
        triangles(stl::text(&text))
    } else {
        rows(&text, along, axes)
    }
}

/// Whether a text begins with a word, in capital or small letters.
fn begins(text: &str, word: &str) -> bool {
    let beginning = text.trim_start().get(..word.len());
    beginning.is_some_and(|beginning| beginning.eq_ignore_ascii_case(word))
}

/// Of a record as the databases of ground motions write it.
const PEER: &str = "E0049: the program does not read ground motions in PEER's format (.AT2). Write a text file with \
                    the heading `t [s], a [g]` and a row for each value: the time (steps of DT) and the \
                    acceleration.";

/// The bytes of a file that is not longer than a case may be.
fn read(path: &Path) -> io::Result<Vec<u8>> {
    let bytes = bounded(path)?;
    if bytes.len() > MAX_BYTES {
        let message = format!("E0004: the data file is larger than {LIMIT} MiB, the limit. Reduce the number of rows.");
        return Err(invalid(message));
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
                    references.push(FileReference {
                        span: value.span(),
                        file,
                        along: word("along"),
                    });
                }
                _ => table.values().for_each(|value| collect(value, text, references)),
            }
        }
        _ => {}
    }
}

/// Rows as TOML: numbers, with the units of a header if there is one. Cells stand between commas, semicolons or blanks;
/// `#` starts a comment. Rows of two, a time and a number `along` an axis, get zeros along the others.
fn rows(text: &str, along: Option<&str>, axes: &[&str]) -> io::Result<String> {
    if let Some(other) = along.filter(|along| !axes.contains(along)) {
        let axes = axes.join("\", \"");
        return Err(invalid(format!(
            "E0028: along = \"{other}\" is not an axis of this case. Use one of \"{axes}\"."
        )));
    }
    if let Some(heading) = hidden(text) {
        return Err(invalid(format!(
            "E0029: the units in `{heading}` are not read, because `#` makes the line a comment. Delete the `#`."
        )));
    }
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let lines = lines.map(|(number, line)| (number + 1, line.split('#').next().unwrap_or_default().trim()));
    let mut units = Vec::new();
    let mut width = None;
    let mut whole = String::from("[");
    for (number, line) in lines.filter(|(_, line)| !line.is_empty()) {
        let cells = cells(line);
        if width.is_none() && units.is_empty() && cells.iter().all(|cell| cell.parse::<f64>().is_err()) {
            units = cells.iter().map(|cell| unit(cell).map(str::to_owned)).collect();
            continue;
        }
        let expected = *width.get_or_insert(if units.is_empty() { cells.len() } else { units.len() });
        if cells.len() != expected {
            let found = cells.len();
            return Err(invalid(format!(
                "E0028: the number of columns in line {number} is {found}, but in the first line it is {expected}. \
                 Give all lines the same number of columns."
            )));
        }
        if along.is_some() && expected != 2 {
            return Err(invalid(format!(
                "E0028: with `along` each row has two columns, a time and a value, but line {number} has {expected} \
                 columns. Delete `along`, or reduce the columns to two."
            )));
        }
        let mut row = values(number, &cells, &units)?;
        if let Some(along) = along
            && let Some(value) = row.get(1).cloned()
        {
            row.truncate(1);
            for axis in axes {
                row.push(if *axis == along {
                    value.clone()
                } else {
                    "0.0".to_owned()
                });
            }
        }
        whole.push_str(&format!("[{}],", row.join(",")));
    }
    if width.is_none() {
        return Err(invalid(
            "E0028: the data file has no row of numbers. Check the name of the file.",
        ));
    }
    whole.push(']');
    Ok(whole)
}

/// Values of the line with a number as TOML, with the units of their columns.
fn values(number: usize, cells: &[&str], units: &[Option<String>]) -> io::Result<Vec<String>> {
    let mut values = Vec::with_capacity(cells.len() + 1);
    for (column, cell) in cells.iter().enumerate() {
        let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
        let Some(value) = value else {
            return Err(invalid(format!(
                "E0028: `{cell}` in line {number} of the data file is not a number. Correct the line."
            )));
        };
        values.push(match units.get(column) {
            Some(Some(unit)) => format!("\"{value:?} {unit}\""),
            _ => format!("{value:?}"),
        });
    }
    Ok(values)
}

/// Rows of numbers as TOML, each number with the digits that its precision needs.
fn toml<T: std::fmt::Debug, const N: usize>(rows: impl IntoIterator<Item = [T; N]>) -> String {
    let mut whole = String::from("[");
    for row in rows {
        let numbers = row.map(|number| format!("{number:?}"));
        whole.push_str(&format!("[{}],", numbers.join(",")));
    }
    whole.push(']');
    whole
}

/// Rows [x, y, z] as TOML of an ASCII grid.
fn grid(text: &str) -> io::Result<String> {
    let points = heights::ascii_grid(text).map_err(|error| invalid(shape_error::of_heights(&error)))?;
    Ok(toml(points))
}

/// Rows of the corners of a triangle as TOML.
fn triangles<T: std::fmt::Debug + Copy>(found: Result<Vec<[[T; 3]; 3]>, StlError>) -> io::Result<String> {
    let triangles = found.map_err(|error| invalid(shape_error::of_stl(&error)))?;
    Ok(toml(triangles.into_iter().map(|[a, b, c]| {
        [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]]
    })))
}

/// A comment before the first row that has a unit, where no plain heading has any: its units would be lost.
fn hidden(text: &str) -> Option<&str> {
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty());
    let before = lines.by_ref().take_while(|line| line.starts_with('#'));
    let comment =
        before.filter(|line| cells(line).len() > 1 && cells(line).into_iter().all(|cell| unit(cell).is_some()));
    comment.last()
}

fn cells(line: &str) -> Vec<&str> {
    let separator = [';', ',', '\t'].into_iter().find(|separator| line.contains(*separator));
    match separator {
        Some(separator) => line
            .split(separator)
            .map(|cell| cell.trim().trim_matches('"'))
            .collect(),
        None => line.split_whitespace().collect(),
    }
}

/// The unit in a heading such as `ax [m/s2]`, `t (s)`, or `t / s` of ISO 80000.
fn unit(heading: &str) -> Option<&str> {
    let bracketed = heading
        .strip_suffix([']', ')'])
        .and_then(|heading| heading.rsplit_once(['[', '(']));
    let (_, unit) = bracketed.or_else(|| heading.rsplit_once(" / "))?;
    Some(unit.trim()).filter(|unit| !["", "-", "1"].contains(unit) && !unit.contains('"'))
}

#[cfg(test)]
mod tests {
    use super::{grid, rows, rows_of, stl, triangles};

    const PLANE: &[&str] = &["x", "y"];

    #[test]
    fn ascii_grids_are_rows_of_the_middles_of_their_cells() {
        let header = "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n";
        let parsed = grid(&format!("{header}1 2\n3 4\n")).unwrap();
        assert_eq!(parsed, "[[11.0,3.0,1.0],[13.0,3.0,2.0],[11.0,1.0,3.0],[13.0,1.0,4.0],]");
        let message = |text: &str| grid(text).unwrap_err().to_string();
        assert_eq!(
            message(&format!("{header}1 2\n3 -9999\n")),
            "E0030: row 2, column 2 of the ASCII grid has no data. Fill in a height, or cut the grid to the part that \
             has data."
        );
        assert_eq!(
            message(&format!("{header}1 2\n3\n")),
            "E0030: the ASCII grid has 3 heights, but ncols times nrows is 4. Export the grid again."
        );
        assert_eq!(
            message("ncols 2\nnrows 2\n1 2\n3 4"),
            "E0030: the header of the ASCII grid has no `cellsize`. Add a line with `cellsize` and its value."
        );
        assert_eq!(
            message("ncols x\n"),
            "E0030: `ncols` in the header of the ASCII grid has no number. Correct the header."
        );
        assert_eq!(
            message(&format!("{header}1 2\n3 nan\n")),
            "E0030: `nan` in row 2, column 2 of the ASCII grid is not a number. Correct the height."
        );
    }

    #[test]
    fn triangles_are_rows_of_three_corners() {
        let text = "solid a\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\nvertex 50.125 0 0\n vertex 0 1e-1 0\n\
                    endloop\nendfacet\nendsolid a\n";
        let row = "[[0.0,0.0,0.0,50.125,0.0,0.0,0.0,0.1,0.0],]";
        assert_eq!(triangles(stl::text(text)).unwrap(), row);
        assert_eq!(
            triangles(Ok(vec![[[0.0_f32; 3], [50.125, 0.0, 0.0], [0.0, 0.1, 0.0]]])).unwrap(),
            row
        );
        let refuses = |name: &str, bytes: Vec<u8>, says: &str| {
            let message = rows_of(name, bytes, None, &["x", "y", "z"]).unwrap_err().to_string();
            assert!(message.starts_with("E0031: ") && message.contains(says), "{message}");
        };
        refuses(
            "a.stl",
            text.replace("vertex 0 0 0", "vertex 0 x 0").into(),
            "the vertex in line 4 ",
        );
        refuses(
            "a.stl",
            text.replace("vertex 0 0 0", "").into(),
            "the facet that ends in line 8 ",
        );
        let incomplete = text.replace("endfacet\n", "");
        refuses("a.stl", incomplete.into(), "its last triangle is incomplete");
        let mut bytes = vec![b' '; 80];
        refuses(
            "a.stl",
            [&bytes[..], &[0; 3]].concat(),
            "has 83 bytes, but its header needs 84",
        );
        bytes.extend(1_u32.to_le_bytes());
        refuses("a.stl", bytes.clone(), "has 84 bytes, but its 1 triangles need 134");
        bytes.extend([f32::NAN.to_le_bytes(); 12].concat());
        bytes.extend([0, 0]);
        refuses("a.stl", bytes, "a corner of triangle 1 ");
    }

    #[test]
    fn units_comments_and_separators_are_read() {
        let plain = "[[0.0,1.5],[0.1,-2.0],]";
        for text in [
            "0 1.5\n0.1 -2\n",
            "# a record\n0,1.5\n\n.1, -2.0 # end\n",
            "\u{feff}0;1.5\r\n1e-1;-2\r\n",
        ] {
            assert_eq!(rows(text, None, PLANE).unwrap(), plain);
        }
        let parsed = rows("t [s], a (cm/s2)\n0.02, 3\n", Some("x"), PLANE).unwrap();
        assert_eq!(parsed, "[[\"0.02 s\",\"3.0 cm/s2\",0.0],]");
        assert_eq!(
            rows("t / s, a / g\n0.02, 3\n", Some("x"), PLANE).unwrap(),
            "[[\"0.02 s\",\"3.0 g\",0.0],]"
        );
        assert_eq!(rows("t a\n1 2", Some("y"), PLANE).unwrap(), "[[1.0,0.0,2.0],]");
        assert_eq!(
            rows("1 2", Some("y"), &["x", "y", "z"]).unwrap(),
            "[[1.0,0.0,2.0,0.0],]"
        );
    }

    #[test]
    fn a_peer_record_is_refused_with_what_to_do() {
        let record = b"PEER\nKOBE\nACCELERATION\nNPTS= 2, DT= .01 SEC\n 1.0E-3 2.0E-3\n".to_vec();
        let message = rows_of("kobe.AT2", record, None, PLANE).unwrap_err().to_string();
        assert!(
            message.starts_with("E0049: ") && message.contains("t [s], a [g]"),
            "{message}"
        );
    }

    #[test]
    fn what_is_no_row_of_numbers_is_refused_with_its_line() {
        let message = |text: &str, along| rows(text, along, PLANE).unwrap_err().to_string();
        assert_eq!(
            message("0,1\n2,x", None),
            "E0028: `x` in line 2 of the data file is not a number. Correct the line."
        );
        assert_eq!(
            message("0,1\n2", None),
            "E0028: the number of columns in line 2 is 1, but in the first line it is 2. Give all lines the same \
             number of columns."
        );
        assert_eq!(
            message("t, ax\n", None),
            "E0028: the data file has no row of numbers. Check the name of the file."
        );
        assert_eq!(
            message("0,nan", None),
            "E0028: `nan` in line 1 of the data file is not a number. Correct the line."
        );
        assert!(message("0,1,2", Some("x")).contains("two columns, a time and a value, but line 1 has 3"));
        let hidden =
            "E0029: the units in `# t [s], a [g]` are not read, because `#` makes the line a comment. Delete the `#`.";
        assert_eq!(message("# t [s], a [g]\n0,1", Some("x")), hidden);
        assert_eq!(
            message("0,1", Some("z")),
            "E0028: along = \"z\" is not an axis of this case. Use one of \"x\", \"y\"."
        );
    }
}
