//! The text of a case file: decodes it, and finds lines and columns.

mod rows;

use crate::error::{Error, Place};
use std::io::{self, Read};
use std::path::Path;

/// Largest case file, in bytes; a larger one is refused before it is parsed.
pub const MAX_BYTES: usize = 1 << 24;

/// The same in MiB, for messages.
const LIMIT: usize = MAX_BYTES >> 20;

/// Characters of a line that an excerpt shows at most.
const EXCERPT: usize = 100;

/// Bytes of the case file at `path`, at most [`MAX_BYTES`] + 1 of them (what is larger [`crate::Case::from_bytes`]
/// refuses); the rows of files that it names are in their places.
///
/// # Errors
/// Those of opening and reading; [`io::ErrorKind::InvalidInput`] for a directory, pipe or device, which is not opened;
/// [`io::ErrorKind::InvalidData`] if a file with rows does not hold them, or too many.
pub fn load(path: &Path) -> io::Result<Vec<u8>> {
    let bytes = bounded(path)?;
    let Some(text) = std::str::from_utf8(&bytes)
        .ok()
        .filter(|text| bytes.len() <= MAX_BYTES && text.contains("file"))
    else {
        return Ok(bytes);
    };
    let whole = rows::inlined(text, path.parent().unwrap_or(Path::new(""))).map(String::into_bytes)?;
    if whole.len() > MAX_BYTES {
        let message = format!(
            "E0004: the case file and its data files together are larger than {LIMIT} MiB, the limit. Reduce the \
             number of rows in the data files."
        );
        return Err(invalid(message));
    }
    Ok(whole)
}

/// Bytes of a regular file, at most [`MAX_BYTES`] + 1 of them.
fn bounded(path: &Path) -> io::Result<Vec<u8>> {
    if !std::fs::metadata(path).map_err(unread)?.is_file() {
        let message = "E0001: the file cannot be read: it is a directory, pipe or device. Give the name of a file.";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(unread)?;
    file.take(MAX_BYTES as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(unread)?;
    Ok(bytes)
}

/// The error of a file that cannot be read.
fn unread(error: io::Error) -> io::Error {
    let message = format!("E0001: the file cannot be read: {error}. Check its path.");
    io::Error::new(error.kind(), message)
}

/// The error of a file that does not hold what it should.
fn invalid(message: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message.into())
}

/// Text of a case file: UTF-8 without its byte order mark. One error if it is too large, UTF-16, binary or no UTF-8.
pub(crate) fn decode<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, Vec<Error>> {
    let whole = |message: &str| vec![Error::of_file(name, message)];
    if bytes.len() > MAX_BYTES {
        let message = format!(
            "E0004: the file is larger than {LIMIT} MiB, the limit for a case file. Check the name of the file."
        );
        return Err(whole(&message));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(whole("E0002: the file is UTF-16 text. Save it as UTF-8."));
    }
    let line = |at: usize| 1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count();
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        let message = format!(
            "E0002: the file is not plain text: line {} has a zero byte, as in a binary or UTF-16 file. Check the \
             name of the file, or save the file as UTF-8 text.",
            line(at)
        );
        return Err(whole(&message));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        whole(&format!(
            "E0002: line {} has characters that are not UTF-8 text. Save the file as UTF-8.",
            line(error.valid_up_to())
        ))
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// A case's text with its name, to turn byte offsets into lines and columns.
#[derive(Debug)]
pub(crate) struct Source<'a> {
    pub(crate) name: &'a str,
    pub(crate) text: &'a str,
    starts: Vec<usize>, // byte offset of every line
}

impl<'a> Source<'a> {
    pub(crate) fn new(name: &'a str, text: &'a str) -> Self {
        let breaks = text
            .bytes()
            .enumerate()
            .filter(|(_, byte)| *byte == b'\n')
            .map(|(at, _)| at + 1);
        Self {
            name,
            text,
            starts: std::iter::once(0).chain(breaks).collect(),
        }
    }

    /// Line of a byte offset, counted from 1.
    pub(crate) fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    /// Place of a byte offset, and the line's text around it with the characters before the place.
    pub(crate) fn locate(&self, offset: usize) -> (Place, (String, usize)) {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line(offset);
        let start = self.starts[line - 1];
        let column = self.text[start..offset].chars().count();
        let skipped = column.saturating_sub(EXCERPT / 2);
        let shown = self.text[start..]
            .chars()
            .take_while(|c| !matches!(c, '\n' | '\r'))
            .skip(skipped)
            .take(EXCERPT);
        let shown = shown.map(|c| if c.is_control() { ' ' } else { c }).collect();
        (
            Place::Line {
                line,
                column: column + 1,
            },
            (shown, column - skipped),
        )
    }
}
