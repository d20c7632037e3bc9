//! Reads frames that [`crate::vtu`] wrote.

use std::fs;
use std::path::Path;

use crate::Error;
use crate::frame::{Field, FieldValues, Frame};
use crate::xml::{Tag, tags};

/// Reads a frame that this program wrote.
///
/// # Errors
/// [`Error::File`] for an error of the system; [`Error::Format`] if the file is incomplete or was not written by this
/// program.
pub fn read(path: &Path) -> Result<Frame, Error> {
    let bytes = fs::read(path).map_err(Error::file("read", path))?;
    parse(&bytes).map_err(|reason| Error::format(path, reason))
}

fn parse(bytes: &[u8]) -> Result<Frame, String> {
    let (head, data) = split(bytes)?;
    let mut frame = Frame {
        step: 0,
        time: 0.0,
        position: Vec::new(),
        fields: Vec::new(),
    };
    let mut section = "";
    let mut points = 0_usize;
    for tag in tags(head) {
        match tag.name {
            "VTKFile" if tag.attribute("header_type") != Some("UInt64") => {
                return Err("its header_type is not UInt64".to_owned());
            }
            "Piece" => points = number(&tag, "NumberOfPoints")?,
            "FieldData" | "PointData" | "Points" | "Cells" => section = tag.name,
            "DataArray" => match section {
                "FieldData" => moment(&tag, &mut frame)?,
                "PointData" => frame.fields.push(field(&tag, data, points)?),
                "Points" => frame.position = places(&tag, data, points)?,
                _ => {}
            },
            _ => {}
        }
    }
    if frame.position.len() == points {
        Ok(frame)
    } else {
        Err("it holds no places of points".to_owned())
    }
}

/// Returns the XML before, and the bytes after, the underscore at the start of the appended data.
fn split(bytes: &[u8]) -> Result<(&str, &[u8]), String> {
    let mark = b"<AppendedData encoding=\"raw\">";
    let at = bytes
        .windows(mark.len())
        .position(|window| window == mark)
        .ok_or("it has no raw appended data")?;
    let rest = &bytes[at + mark.len()..];
    let begin = rest
        .iter()
        .position(|&byte| byte == b'_')
        .ok_or("its appended data do not begin")?;
    let head = std::str::from_utf8(&bytes[..at]).map_err(|error| error.to_string())?;
    Ok((head, &rest[begin + 1..]))
}

fn moment(tag: &Tag, frame: &mut Frame) -> Result<(), String> {
    let text = tag.text.trim();
    match tag.attribute("Name") {
        Some("TimeValue") => frame.time = text.parse().map_err(|_| format!("its time is \"{text}\""))?,
        Some("Step") => frame.step = text.parse().map_err(|_| format!("its step is \"{text}\""))?,
        _ => {}
    }
    Ok(())
}

fn places(tag: &Tag, data: &[u8], points: usize) -> Result<Vec<[f64; 3]>, String> {
    match field(tag, data, points)? {
        Field {
            components: 3,
            values: FieldValues::F64(values),
            ..
        } => Ok(values.as_chunks().0.to_vec()),
        _ => Err("its points are no triples of Float64".to_owned()),
    }
}

fn field(tag: &Tag, data: &[u8], points: usize) -> Result<Field, String> {
    let name = tag.attribute("Name").ok_or("a field has no name")?.to_owned();
    let components: usize = number(tag, "NumberOfComponents")?;
    let raw =
        block(data, number(tag, "offset")?).ok_or_else(|| format!("{name} reaches beyond the end of the file"))?;
    let values = match tag.attribute("type") {
        Some("Float64") => FieldValues::F64(
            raw.as_chunks()
                .0
                .iter()
                .map(|&bytes| f64::from_le_bytes(bytes))
                .collect(),
        ),
        Some("UInt64") => FieldValues::U64(
            raw.as_chunks()
                .0
                .iter()
                .map(|&bytes| u64::from_le_bytes(bytes))
                .collect(),
        ),
        Some("UInt16") => FieldValues::U16(
            raw.as_chunks()
                .0
                .iter()
                .map(|&bytes| u16::from_le_bytes(bytes))
                .collect(),
        ),
        other => return Err(format!("{name} is of type {}", other.unwrap_or("unknown"))),
    };
    if components == 0 || points.checked_mul(components) != Some(values.len()) {
        return Err(format!("{name} has {} numbers for {points} points", values.len()));
    }
    Ok(Field {
        name,
        components,
        values,
    })
}

/// Returns the bytes at `offset`, after their count (a 64-bit integer).
fn block(data: &[u8], offset: usize) -> Option<&[u8]> {
    let (length, rest) = data.get(offset..)?.split_first_chunk()?;
    rest.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)
}

fn number(tag: &Tag, key: &str) -> Result<usize, String> {
    let text = tag
        .attribute(key)
        .ok_or_else(|| format!("a {} lacks {key}", tag.name))?;
    text.parse().map_err(|_| format!("{key} is \"{text}\""))
}
