//! The text of a case file: read with a bound, decoded with reasons, and its lines and columns.

mod rows;
mod stl;

use crate::error::{Error, Place};
use bsmpm_messages::{code_of, without_code};
use std::io::{self, Read};
use std::path::Path;

/// Largest case file, in bytes; a larger one is refused before it is parsed.
pub const MAX_BYTES: usize = 1 << 24;

/// Characters of a line that an excerpt shows at most.
const EXCERPT: usize = 100;

/// Bytes of the case file at `path`, at most [`MAX_BYTES`] + 1 of them (what is larger [`crate::Case::from_bytes`]
/// refuses); the rows of files that it names are in their places.
///
/// # Errors
/// Those of opening and reading; [`io::ErrorKind::InvalidInput`] for a directory, pipe or device, which is not opened;
/// [`io::ErrorKind::InvalidData`] if a file with rows does not hold them, or too many.
pub fn load(path: &Path) -> io::Result<Vec<u8>> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    let Some(text) = std::str::from_utf8(&bytes).ok().filter(|text| bytes.len() <= MAX_BYTES && text.contains("file"))
    else {
        return Ok(bytes);
    };
    let whole = rows::inlined(text, path.parent().unwrap_or(Path::new(""))).map(String::into_bytes)?;
    if whole.len() > MAX_BYTES {
        let message =
            format!("with the rows of its files it has more than {MAX_BYTES} bytes, the limit of a case; thin them");
        return Err(io::Error::new(io::ErrorKind::InvalidData, message));
    }
    Ok(whole)
}

/// Text of a case file: UTF-8 without its byte order mark. One error if it is too large, UTF-16, binary or no UTF-8.
pub(crate) fn decode<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, Vec<Error>> {
    let whole = |message: String| {
        vec![Error {
            file: name.to_owned(),
            place: Place::File,
            key: String::new(),
            code: code_of(&message).map(str::to_owned),
            message: without_code(&message).to_owned(),
            removed: None,
            excerpt: None,
        }]
    };
    if bytes.len() > MAX_BYTES {
        return Err(whole(format!("the file is larger than {MAX_BYTES} bytes, the limit of a case file")));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(whole("the file is UTF-16; save it as UTF-8".to_owned()));
    }
    let line = |at: usize| 1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count();
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        let message = format!("line {} holds a NUL byte: the file is binary or UTF-16; a case is UTF-8 text", line(at));
        return Err(whole(message));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let message = format!("line {} is no UTF-8; a case is UTF-8 text", line(error.valid_up_to()));
        whole(message)
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
        let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1);
        Self { name, text, starts: std::iter::once(0).chain(breaks).collect() }
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
        let shown = self.text[start..].chars().take_while(|c| !matches!(c, '\n' | '\r')).skip(skipped).take(EXCERPT);
        let shown = shown.map(|c| if c.is_control() { ' ' } else { c }).collect();
        (Place::Line { line, column: column + 1 }, (shown, column - skipped))
    }
}
