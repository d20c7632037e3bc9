//! One frame as a VTK unstructured grid: a vertex cell per point, raw appended binary, little endian, file version 1.0
//! (every ParaView since 4 opens it). [`read`] reads back what [`write()`] wrote, not every `.vtu` of the world.

use std::io::{self, Write};
use std::path::Path;

use crate::Error;
use crate::atomic;
use crate::frame::{Field, Frame, Values};

pub use crate::vtu_read::read;

/// Names of the components of a symmetric tensor, in the order in which they are stored.
const SYMMETRIC: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
const VTK_VERTEX: u8 = 1;

/// Writes `frame` to the file `path`, replacing it in one go.
///
/// # Errors
/// Those of [`Frame::check`], before anything is written; [`Error::File`] when the system refuses.
pub fn write(path: &Path, frame: &Frame) -> Result<(), Error> {
    frame.check(path)?;
    atomic::replace(path, |file| {
        let mut offset = 0;
        write_head(file, frame, &mut offset)?;
        file.write_all(b"  <AppendedData encoding=\"raw\">\n_")?;
        for data in arrays(frame) {
            data.write(file)?;
        }
        file.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
    })
}

/// Bytes that each point of frames with these fields takes; a head of some kilobytes comes with them.
pub fn point_bytes(fields: &[Field]) -> u64 {
    let number = |values: &Values| match values {
        Values::F64(_) | Values::U64(_) => 8,
        Values::U16(_) => 2,
    };
    let numbers: usize = fields.iter().map(|field| field.components * number(&field.values)).sum();
    let [place, cell] = [3 * size_of::<f64>(), 2 * size_of::<i64>() + size_of::<u8>()];
    (numbers + place + cell) as u64
}

fn write_head(file: &mut impl Write, frame: &Frame, offset: &mut usize) -> io::Result<()> {
    let points = frame.position.len();
    let mut data = arrays(frame);
    let mut array = |file: &mut dyn Write, name: &str, components: usize| {
        let data = data.next().ok_or_else(|| io::Error::other("more arrays announced than written"))?;
        write_array(file, name, components, data.kind(), *offset)?;
        *offset += size_of::<u64>() + data.bytes();
        io::Result::Ok(())
    };
    writeln!(file, "<?xml version=\"1.0\"?>")?;
    let order = "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
    writeln!(file, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" {order}>\n  <UnstructuredGrid>")?;
    write_moment(file, frame)?;
    writeln!(file, "    <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{points}\">\n      <PointData>")?;
    for Field { name, components, .. } in &frame.fields {
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

/// Time and step as text: exact, and legible without a program. `TimeValue` is the name that ParaView looks for.
fn write_moment(file: &mut impl Write, frame: &Frame) -> io::Result<()> {
    let Frame { step, time, .. } = frame;
    let one = "NumberOfTuples=\"1\" format=\"ascii\"";
    writeln!(file, "    <FieldData>")?;
    writeln!(file, "      <DataArray type=\"Float64\" Name=\"TimeValue\" {one}>{time:?}</DataArray>")?;
    writeln!(file, "      <DataArray type=\"UInt64\" Name=\"Step\" {one}>{step}</DataArray>")?;
    writeln!(file, "    </FieldData>")
}

fn write_array(file: &mut dyn Write, name: &str, components: usize, kind: &str, offset: usize) -> io::Result<()> {
    write!(file, "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"")?;
    if components == SYMMETRIC.len() {
        for (index, label) in SYMMETRIC.iter().enumerate() {
            write!(file, " ComponentName{index}=\"{label}\"")?;
        }
    }
    writeln!(file, " format=\"appended\" offset=\"{offset}\"/>")
}

/// The arrays in the order of the file: fields, places, then the three that make each point a cell.
fn arrays(frame: &Frame) -> impl Iterator<Item = Data<'_>> {
    let points = frame.position.len();
    let fields = frame.fields.iter().map(|field| match &field.values {
        Values::F64(values) => Data::F64(values),
        Values::U64(values) => Data::U64(values),
        Values::U16(values) => Data::U16(values),
    });
    let cells = [Data::Count { first: 0, points }, Data::Count { first: 1, points }, Data::Vertices { points }];
    fields.chain([Data::F64(frame.position.as_flattened())]).chain(cells)
}

enum Data<'a> {
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

impl Data<'_> {
    fn kind(&self) -> &'static str {
        match self {
            Self::F64(_) => "Float64",
            Self::U64(_) => "UInt64",
            Self::U16(_) => "UInt16",
            Self::Count { .. } => "Int64",
            Self::Vertices { .. } => "UInt8",
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::F64(values) => size_of_val(*values),
            Self::U64(values) => size_of_val(*values),
            Self::U16(values) => size_of_val(*values),
            Self::Count { points, .. } => points * size_of::<i64>(),
            Self::Vertices { points } => *points,
        }
    }

    fn write(&self, file: &mut impl Write) -> io::Result<()> {
        file.write_all(&(self.bytes() as u64).to_le_bytes())?;
        match self {
            Self::F64(values) => values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
            Self::U64(values) => values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
            Self::U16(values) => values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
            Self::Count { first, points } => {
                (*first..first + *points as i64).try_for_each(|value| file.write_all(&value.to_le_bytes()))
            }
            Self::Vertices { points } => (0..*points).try_for_each(|_| file.write_all(&[VTK_VERTEX])),
        }
    }
}
