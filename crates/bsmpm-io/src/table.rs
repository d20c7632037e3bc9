//! CSV tables with one row per step of a run. The second line of a table contains the units.

use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::{Error, atomic};

/// Heading of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableColumn {
    /// Name of the quantity.
    pub name: String,
    /// Unit, `-` for a pure number.
    pub unit: String,
}

impl TableColumn {
    /// Creates a column `name` in `unit`; an empty unit is written as `-`.
    pub fn new(name: &str, unit: &str) -> Self {
        let unit = if unit.is_empty() { "-" } else { unit };
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
        }
    }
}

/// Entry of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// Count.
    Int(u64),
    /// Quantity, in the unit of its column.
    Float(f64),
    /// One of the words allowed in its column.
    Word(&'static str),
    /// No entry.
    Empty,
}

/// State of a table at a checkpoint: the contents that it must have for a run to continue from there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TableMark {
    /// Size of the file in bytes.
    pub bytes: u64,
    /// BLAKE3 hash of these bytes, in hexadecimal.
    pub blake3: String,
}

/// Table that grows row by row.
#[derive(Debug)]
pub struct CsvTable {
    path: PathBuf,
    file: File,
    columns: Vec<TableColumn>,
    hasher: Box<blake3::Hasher>, // of all bytes in the file
}

impl CsvTable {
    /// Creates a file with its two heading lines.
    ///
    /// # Errors
    /// [`Error::Name`] for an empty or repeated name, or one with a comma, quote, `#` or line break; [`Error::File`] if
    /// the file exists or cannot be created.
    pub fn create(path: &Path, columns: &[TableColumn]) -> Result<Self, Error> {
        check_headings(path, columns)?;
        let file = File::create_new(path).map_err(Error::file("create", path))?;
        atomic::sync_folder(path).map_err(Error::file("create", path))?;
        let path = path.to_owned();
        let columns = columns.to_vec();
        let mut table = Self {
            path,
            file,
            hasher: Box::default(),
            columns,
        };
        let heading = heading(&table.columns);
        table.append(&heading)?;
        Ok(table)
    }

    /// Checks whether a run can continue a file from `mark`. The file is not changed.
    ///
    /// # Errors
    /// [`Error::Format`] if the file is shorter, or its first bytes or its columns differ; [`Error::File`] for an error
    /// of the system.
    pub fn verify(path: &Path, columns: &[TableColumn], mark: &TableMark) -> Result<(), Error> {
        Self::reach(path, columns, mark).map(|_| ())
    }

    /// Continues a file from `mark`; later rows are deleted.
    ///
    /// # Errors
    /// The errors of [`CsvTable::verify`]; the file is then unchanged.
    pub fn resume(path: &Path, columns: &[TableColumn], mark: &TableMark) -> Result<Self, Error> {
        let table = Self::reach(path, columns, mark)?;
        table.file.set_len(mark.bytes).map_err(Error::file("write", path))?;
        Ok(table)
    }

    /// Opens the table at the mark, regardless of later rows.
    fn reach(path: &Path, columns: &[TableColumn], mark: &TableMark) -> Result<Self, Error> {
        check_headings(path, columns)?;
        let mut file = File::options()
            .read(true)
            .write(true)
            .open(path)
            .map_err(Error::file("open", path))?;
        let mut hasher = Box::<blake3::Hasher>::default();
        let begun = heading(columns);
        let mut first = vec![0; begun.len()];
        let headed = file.read_exact(&mut first).is_ok() && first == begun.as_bytes();
        let hashed = file.rewind().and_then(|()| {
            hasher.update_reader((&mut file).take(mark.bytes))?;
            file.seek(SeekFrom::Start(mark.bytes))
        });
        hashed.map_err(Error::file("read", path))?;
        if !headed || hasher.count() != mark.bytes || hasher.finalize().to_hex().as_str() != mark.blake3 {
            let reason = format!("its first {} bytes are not those that the run had written", mark.bytes);
            return Err(Error::format(path, reason));
        }
        Ok(Self {
            path: path.to_owned(),
            file,
            columns: columns.to_vec(),
            hasher,
        })
    }

    /// Returns the present state of the table, after writing all of it to the disk.
    ///
    /// # Errors
    /// [`Error::File`] for an error of the system.
    pub fn mark(&self) -> Result<TableMark, Error> {
        self.file.sync_all().map_err(Error::file("write", &self.path))?;
        Ok(TableMark {
            bytes: self.hasher.count(),
            blake3: self.hasher.finalize().to_hex().to_string(),
        })
    }

    fn append(&mut self, text: &str) -> Result<(), Error> {
        self.hasher.update(text.as_bytes());
        self.file
            .write_all(text.as_bytes())
            .map_err(Error::file("write", &self.path))
    }

    /// Appends a row. Floats have the shortest form that reads back to the same bits. The row is written in one call.
    ///
    /// # Errors
    /// [`Error::Length`] for a row of another length and [`Error::NotFinite`] for a number that is not finite: the file
    /// is then unchanged. [`Error::File`] for an error of the system.
    pub fn row(&mut self, cells: &[Cell]) -> Result<(), Error> {
        if cells.len() != self.columns.len() {
            let expected = self.columns.len();
            let found = cells.len();
            return Err(Error::Length {
                path: self.path.clone(),
                item: "a row".to_owned(),
                expected,
                found,
            });
        }
        let mut line = String::new();
        for (column, cell) in self.columns.iter().zip(cells) {
            let separator = if line.is_empty() { "" } else { "," };
            line += separator;
            line += &self.text(column, *cell, cells[0])?;
        }
        line.push('\n');
        self.append(&line)
    }

    fn text(&self, column: &TableColumn, cell: Cell, first: Cell) -> Result<String, Error> {
        match cell {
            Cell::Int(value) => Ok(value.to_string()),
            Cell::Word(word) => Ok(word.to_owned()),
            Cell::Empty => Ok(String::new()),
            Cell::Float(value) if value.is_finite() => Ok(format!("{value:?}")),
            Cell::Float(value) => {
                let of_step = if let Cell::Int(step) = first {
                    format!(" in step {step}")
                } else {
                    String::new()
                };
                let item = format!("{}{of_step}", column.name);
                Err(Error::NotFinite {
                    path: self.path.clone(),
                    item,
                    value,
                })
            }
        }
    }
}

/// Returns the two heading lines.
fn heading(columns: &[TableColumn]) -> String {
    let names: Vec<&str> = columns.iter().map(|column| &*column.name).collect();
    let units: Vec<&str> = columns.iter().map(|column| &*column.unit).collect();
    format!("{}\n# {}\n", names.join(","), units.join(","))
}

/// Returns whether a name or unit is not allowed in the heading lines.
fn is_bad_heading(text: &str) -> bool {
    text.trim() != text || text.is_empty() || text.contains([',', '"', '#', '\n', '\r'])
}

fn check_headings(path: &Path, columns: &[TableColumn]) -> Result<(), Error> {
    for (index, TableColumn { name, unit }) in columns.iter().enumerate() {
        let reason = if is_bad_heading(name) || is_bad_heading(unit) {
            "(or its unit) is empty, or contains a comma, a quote, a # or a space at an end"
        } else if columns[..index].iter().any(|other| other.name == *name) {
            "is used for two columns"
        } else {
            continue;
        };
        return Err(Error::Name {
            path: path.to_owned(),
            name: name.clone(),
            reason,
        });
    }
    Ok(())
}

/// Table that was read; counts are floats, too.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Headings; the units are empty if the file has none.
    pub headings: Vec<TableColumn>,
    /// Numbers of each column, all of the same length.
    pub values: Vec<Vec<f64>>,
}

impl Columns {
    /// Returns the numbers of the column `name`.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let index = self.headings.iter().position(|column| column.name == name)?;
        Some(&self.values[index])
    }

    /// Returns the unit of the column `name`.
    pub fn unit(&self, name: &str) -> Option<&str> {
        self.headings
            .iter()
            .find(|column| column.name == name)
            .map(|column| column.unit.as_str())
    }
}

/// Reads a table of numbers, of this program or of others, with a line of names. Lines that begin with `#` are
/// comments; one directly after the names has the units. An unfinished last line, which is being written, is ignored.
///
/// # Errors
/// [`Error::File`] for an error of the system; [`Error::Format`] with the line that is not a row of finite numbers.
pub fn read(path: &Path) -> Result<Columns, Error> {
    parse(&whole_lines(path)?).map_err(|reason| Error::format(path, reason))
}

/// Returns the text of a file up to its last line break.
pub(crate) fn whole_lines(path: &Path) -> Result<String, Error> {
    let mut text = fs::read_to_string(path).map_err(Error::file("read", path))?;
    text.truncate(text.rfind('\n').unwrap_or(0));
    Ok(text)
}

/// Reads a table from complete text, as [`read`] does.
///
/// # Errors
/// A text with the line that is not a row of finite numbers.
pub fn parse(text: &str) -> Result<Columns, String> {
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
        .peekable();
    while lines.next_if(|(_, line)| line.starts_with('#')).is_some() {}
    let (_, names) = lines.next().ok_or("it has no line of names")?;
    let mut headings: Vec<_> = names
        .split(',')
        .map(|name| TableColumn {
            name: name.trim().to_owned(),
            unit: String::new(),
        })
        .collect();
    if let Some(units) = lines.peek().and_then(|(_, line)| line.strip_prefix('#')) {
        let units: Vec<_> = units.split(',').collect();
        if units.len() == headings.len() {
            headings
                .iter_mut()
                .zip(units)
                .for_each(|(heading, unit)| unit.trim().clone_into(&mut heading.unit));
        }
    }
    let mut values = vec![Vec::new(); headings.len()];
    for (index, line) in lines.filter(|(_, line)| !line.starts_with('#')) {
        let cells = line
            .split(',')
            .map(|cell| cell.trim().parse::<f64>().ok().filter(|value| value.is_finite()));
        let row: Option<Vec<_>> = cells.collect();
        let row = row.filter(|row| row.len() == values.len());
        let row = row.ok_or_else(|| format!("line {}: {} finite numbers are needed", index + 1, values.len()))?;
        values
            .iter_mut()
            .zip(row)
            .for_each(|(column, value)| column.push(value));
    }
    Ok(Columns { headings, values })
}
