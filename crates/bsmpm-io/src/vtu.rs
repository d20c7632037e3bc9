//! Writes a frame as a VTK unstructured grid.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use crate::Error;
use crate::atomic::{self, Filled};
use crate::frame::{Field, FieldValues, Frame, Parts};

pub use crate::vtu_read::read;

/// Names of the components of a symmetric tensor, in the order in which they are stored.
const SYMMETRIC: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
const VTK_VERTEX: u8 = 1;
/// Bytes of the length that goes before an array.
const LENGTH: u64 = size_of::<u64>() as u64;

/// Writes `frame` to the file `path`, replacing it in one go.
///
/// # Errors
/// Those of [`Frame::check`]; [`Error::File`] when the system refuses. An older file then stays as it was.
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

/// Writes a frame to the file `path` as its points come, replacing it in one go: the same bytes, whatever the parts.
///
/// # Errors
/// As [`write()`]; [`Error::Length`] if not so many points come as were announced.
pub fn write_parts(path: &Path, parts: Parts<'_>) -> Result<(), Error> {
    filled(path, parts)?.give_name()?;
    atomic::sync_folder(path).map_err(Error::file("write", path))
}

/// The same under a temporary name.
pub(crate) fn filled(path: &Path, parts: Parts<'_>) -> Result<Filled, Error> {
    parts.head.check(path)?;
    let mut refused = None;
    let filled = Filled::new(path, |file| fill(file, path, parts, &mut refused));
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
    let mut places = Vec::new(); // of every array in the file, behind its length
    write_head(file, (&head, names), points, &mut places)?;
    file.write_all(b"  <AppendedData encoding=\"raw\">\n_")?;
    let start = file.stream_position()?;
    let mut given = 0;
    let mut wrong = |error: Error| {
        *refused = Some(error);
        io::Error::other("refused")
    };
    while let Some(part) = next() {
        part.check(path).map_err(&mut wrong)?;
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
        let item = "a frame".to_owned();
        return Err(wrong(Error::Length {
            path: path.to_owned(),
            item,
            expected: points,
            found: given,
        }));
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

/// Bytes that each point of frames with the fields of `frame` takes; a head of some kilobytes comes with them.
pub fn point_bytes(frame: &Frame) -> u64 {
    arrays(frame, 0).map(|data| data.point_bytes() as u64).sum()
}

/// The text, and where the numbers of each array begin from where their bytes do.
fn write_head(
    file: &mut impl Write,
    (head, names): (&Frame, &[(String, Vec<String>)]),
    points: usize,
    places: &mut Vec<u64>,
) -> io::Result<()> {
    let mut data = arrays(head, 0);
    let mut offset = 0;
    let mut array = |file: &mut dyn Write, name: &str, components: usize| {
        let data = data
            .next()
            .ok_or_else(|| io::Error::other("more arrays announced than written"))?;
        write_array(file, name, components, data.kind(), offset)?;
        places.push(offset as u64 + LENGTH);
        offset += LENGTH as usize + points * data.point_bytes();
        io::Result::Ok(())
    };
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
    for Field { name, components, .. } in &head.fields {
        array(file, name, *components)?;
    }
    writeln!(file, "      </PointData>\n      <Points>")?;
    array(file, "Points", 3)?;
    writeln!(file, "      </Points>\n      <Cells>")?;
    for name in ["connectivity", "offsets", "types"] {
        array(file, name, 1)?;
    }
    writeln!(file, "      </Cells>\n    </Piece>\n  </UnstructuredGrid>")
}

/// Time and step as text: exact, and legible without a program. `TimeValue` is the name that ParaView looks for. Names
/// are lists of characters by their codes, each ended by 0, as VTK has them.
fn write_moment(file: &mut impl Write, frame: &Frame, names: &[(String, Vec<String>)]) -> io::Result<()> {
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
    for (name, list) in names {
        let codes = list
            .iter()
            .flat_map(|name| name.bytes().chain([0]))
            .map(|code| code.to_string());
        let (codes, count) = (codes.collect::<Vec<_>>().join(" "), list.len());
        let array = format!("Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"{count}\" format=\"ascii\"");
        writeln!(file, "      <{array}>{codes}</Array>")?;
    }
    writeln!(file, "    </FieldData>")
}

fn write_array(file: &mut dyn Write, name: &str, components: usize, kind: &str, offset: usize) -> io::Result<()> {
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

/// The arrays in the order of the file: fields, places, then the three that make each point a cell, the first one's
/// number being `first`.
fn arrays(frame: &Frame, first: usize) -> impl Iterator<Item = Data<'_>> {
    let points = frame.position.len();
    let fields = frame.fields.iter().map(|field| Data {
        components: field.components,
        numbers: (&field.values).into(),
    });
    let place = Numbers::F64(frame.position.as_flattened());
    let count = |first: usize| Numbers::Count {
        first: first as i64,
        points,
    };
    let cells = [count(first), count(first + 1), Numbers::Vertices { points }];
    let cells = cells.map(|numbers| Data { components: 1, numbers });
    fields
        .chain([Data {
            components: 3,
            numbers: place,
        }])
        .chain(cells)
}

/// One array of the file.
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

    /// Bytes of a point.
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
