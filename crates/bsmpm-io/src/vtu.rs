//! Writes a frame as a VTK unstructured grid.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use crate::Error;
use crate::atomic::{self, FilledFile};
use crate::frame::{FieldValues, Frame, Parts};

pub use crate::vtu_read::read;

/// Names of the components of a symmetric tensor, in the order in which they are stored.
const SYMMETRIC: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
const VTK_VERTEX: u8 = 1;
/// Bytes of the length before an array.
const LENGTH: u64 = size_of::<u64>() as u64;

/// Writes `frame` to the file `path`, replacing it atomically.
///
/// # Errors
/// The errors of [`Frame::check`]; [`Error::File`] for an error of the system. An older file is then unchanged.
pub fn write(path: &Path, frame: &Frame) -> Result<(), Error> {
    frame.check(path)?;
    let mut left = Some(frame.clone());
    write_parts(
        path,
        Parts {
            head: frame.without_points(),
            points: frame.position.len(),
            names: &[],
            next: &mut || left.take(),
        },
    )
}

/// Writes a frame whose points are supplied in parts to the file `path`, replacing it atomically. The bytes do not
/// depend on the parts.
///
/// # Errors
/// The errors of [`write()`]; [`Error::Length`] if the number of points differs from the announced one.
pub fn write_parts(path: &Path, parts: Parts<'_>) -> Result<(), Error> {
    filled(path, parts)?.give_name()?;
    atomic::sync_folder(path).map_err(Error::file("write", path))
}

/// Writes such a frame under a temporary name.
pub(crate) fn filled(path: &Path, parts: Parts<'_>) -> Result<FilledFile, Error> {
    parts.head.check(path)?;
    let mut refused = None;
    let filled = FilledFile::new(path, |file| fill(file, path, parts, &mut refused));
    refused.map_or(filled, Err)
}

fn fill(
    file: &mut (impl Write + Seek),
    path: &Path,
    Parts {
        head,
        points,
        names,
        next,
    }: Parts<'_>,
    refused: &mut Option<Error>,
) -> io::Result<()> {
    let names: Vec<String> = names.iter().map(|(name, list)| name_array(name, list)).collect();
    let places = write_head(file, &head, &names, points)?;
    file.write_all(b"  <AppendedData encoding=\"raw\">\n_")?;
    let start = file.stream_position()?;
    let mut given = 0;
    while let Some(part) = next() {
        part.check(path).map_err(|error| refuse(refused, error))?;
        if part.without_points() != head {
            return Err(io::Error::other("a part of another frame"));
        }
        let count = part.position.len();
        if given + count <= points {
            for (data, place) in arrays(&part, given).zip(&places) {
                file.seek(SeekFrom::Start(start + place + (given * data.point_bytes()) as u64))?;
                data.write(file)?;
            }
        }
        given += count;
    }
    if given != points {
        let error = Error::Length {
            path: path.to_owned(),
            item: "a frame".to_owned(),
            expected: points,
            found: given,
        };
        return Err(refuse(refused, error));
    }
    let mut end = 0;
    for (data, place) in arrays(&head, 0).zip(&places) {
        let bytes = (points * data.point_bytes()) as u64;
        file.seek(SeekFrom::Start(start + place - LENGTH))?;
        file.write_all(&bytes.to_le_bytes())?;
        end = start + place + bytes;
    }
    file.seek(SeekFrom::Start(end))?;
    file.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
}

/// Stores an error for the caller of [`fill`], which itself can only return system errors.
fn refuse(refused: &mut Option<Error>, error: Error) -> io::Error {
    *refused = Some(error);
    io::Error::other("refused")
}

/// Returns the bytes per point of frames with the fields of `frame`, without a header of a few kilobytes.
pub fn point_bytes(frame: &Frame) -> u64 {
    arrays(frame, 0).map(|data| data.point_bytes() as u64).sum()
}

/// Writes the header with the arrays `names`. Returns the position of each array's numbers (after its length), counted
/// from the first byte of the arrays.
fn write_head(file: &mut impl Write, head: &Frame, names: &[String], points: usize) -> io::Result<Vec<u64>> {
    let data: Vec<Data<'_>> = arrays(head, 0).collect();
    let mut places = Vec::new();
    let mut place = LENGTH;
    for data in &data {
        places.push(place);
        place += LENGTH + (points * data.point_bytes()) as u64;
    }
    writeln!(file, "<?xml version=\"1.0\"?>")?;
    let order = "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
    writeln!(
        file,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" {order}>\n  <UnstructuredGrid>"
    )?;
    write_moment(file, head, names)?;
    writeln!(
        file,
        "    <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{points}\">\n      <PointData>"
    )?;
    for (index, field) in head.fields.iter().enumerate() {
        write_array(file, &field.name, &data[index], places[index])?;
    }
    let count = head.fields.len();
    writeln!(file, "      </PointData>\n      <Points>")?;
    write_array(file, "Points", &data[count], places[count])?;
    writeln!(file, "      </Points>\n      <Cells>")?;
    for (name, index) in ["connectivity", "offsets", "types"].into_iter().zip(count + 1..) {
        write_array(file, name, &data[index], places[index])?;
    }
    writeln!(file, "      </Cells>\n    </Piece>\n  </UnstructuredGrid>")?;
    Ok(places)
}

/// Writes time and step as text, which is exact and readable. ParaView expects the name `TimeValue`.
fn write_moment(file: &mut impl Write, frame: &Frame, names: &[String]) -> io::Result<()> {
    let Frame { step, time, .. } = frame;
    let one = "NumberOfTuples=\"1\" format=\"ascii\"";
    writeln!(file, "    <FieldData>")?;
    writeln!(
        file,
        "      <DataArray type=\"Float64\" Name=\"TimeValue\" {one}>{time:?}</DataArray>"
    )?;
    writeln!(
        file,
        "      <DataArray type=\"UInt64\" Name=\"Step\" {one}>{step}</DataArray>"
    )?;
    for array in names {
        writeln!(file, "      {array}")?;
    }
    writeln!(file, "    </FieldData>")
}

/// Returns the array of a list of names in VTK's form: the codes of the characters, each name ended by 0.
fn name_array(name: &str, list: &[String]) -> String {
    let codes = list
        .iter()
        .flat_map(|name| name.bytes().chain([0]))
        .map(|code| code.to_string());
    let codes = codes.collect::<Vec<_>>().join(" ");
    let count = list.len();
    let array = format!("Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"{count}\" format=\"ascii\"");
    format!("<{array}>{codes}</Array>")
}

/// Writes the heading of an array, whose numbers begin at `place` (after their length).
fn write_array(file: &mut impl Write, name: &str, data: &Data<'_>, place: u64) -> io::Result<()> {
    let kind = data.kind();
    let components = data.components;
    let offset = place - LENGTH;
    write!(
        file,
        "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\""
    )?;
    if components == SYMMETRIC.len() {
        for (index, label) in SYMMETRIC.iter().enumerate() {
            write!(file, " ComponentName{index}=\"{label}\"")?;
        }
    }
    writeln!(file, " format=\"appended\" offset=\"{offset}\"/>")
}

/// Iterates over the arrays in the order of the file: fields, positions, then the three that make each point a cell.
/// `first` is the number of the first cell.
fn arrays(frame: &Frame, first: usize) -> impl Iterator<Item = Data<'_>> {
    let points = frame.position.len();
    let fields = frame.fields.iter().map(|field| Data {
        components: field.components,
        numbers: (&field.values).into(),
    });
    let place = Numbers::F64(frame.position.as_flattened());
    let first = first as i64;
    let cells = [
        Numbers::Count { first, points },
        Numbers::Count {
            first: first + 1,
            points,
        },
        Numbers::Vertices { points },
    ];
    let cells = cells.map(|numbers| Data { components: 1, numbers });
    fields
        .chain([Data {
            components: 3,
            numbers: place,
        }])
        .chain(cells)
}

/// Array of the file.
struct Data<'a> {
    components: usize,
    numbers: Numbers<'a>,
}

enum Numbers<'a> {
    F64(&'a [f64]),
    U64(&'a [u64]),
    U16(&'a [u16]),
    /// `first, first + 1, ...`
    Count {
        first: i64,
        points: usize,
    },
    Vertices {
        points: usize,
    },
}

impl<'a> From<&'a FieldValues> for Numbers<'a> {
    fn from(values: &'a FieldValues) -> Self {
        match values {
            FieldValues::F64(values) => Self::F64(values),
            FieldValues::U64(values) => Self::U64(values),
            FieldValues::U16(values) => Self::U16(values),
        }
    }
}

impl Data<'_> {
    fn kind(&self) -> &'static str {
        match self.numbers {
            Numbers::F64(_) => "Float64",
            Numbers::U64(_) => "UInt64",
            Numbers::U16(_) => "UInt16",
            Numbers::Count { .. } => "Int64",
            Numbers::Vertices { .. } => "UInt8",
        }
    }

    /// Returns the bytes per point.
    fn point_bytes(&self) -> usize {
        let number = match self.numbers {
            Numbers::F64(_) | Numbers::U64(_) | Numbers::Count { .. } => 8,
            Numbers::U16(_) => 2,
            Numbers::Vertices { .. } => 1,
        };
        self.components * number
    }

    fn write(&self, file: &mut impl Write) -> io::Result<()> {
        match self.numbers {
            Numbers::F64(values) => values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
            Numbers::U64(values) => values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
            Numbers::U16(values) => values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
            Numbers::Count { first, points } => {
                (first..first + points as i64).try_for_each(|value| file.write_all(&value.to_le_bytes()))
            }
            Numbers::Vertices { points } => (0..points).try_for_each(|_| file.write_all(&[VTK_VERTEX])),
        }
    }
}
