//! Data of messages about a case: errors, and values that the program chose itself.

use crate::words::RemovedWord;
use bsmpm_messages::{code_of, without_code};
use std::fmt;

/// Where a value or key was written. Orders as a report lists: the file from its start, then overrides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Origin {
    /// nowhere: the file as a whole, or a default
    Nowhere,
    /// byte offset in the text
    Text(usize),
    /// number of the override
    Override(usize),
}

/// Something that the program chose by itself, for the manifest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Path of the key.
    pub key: String,
    /// The value chosen.
    pub value: String,
    /// Why.
    pub reason: String,
}

/// Where an error stands.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// In the file, both counted from 1; the column counts characters.
    Line {
        /// Line.
        line: usize,
        /// Column.
        column: usize,
    },
    /// In the override given as `--set KEY=VALUE`.
    Override(String),
    /// The file as a whole.
    File,
}

/// One error of a case file.
///
/// `{}` writes one line, `FILE:LINE:COLUMN: error CODE: KEY: MESSAGE`; `{:#}` adds the line of the file with a mark
/// under the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The case file as it was named.
    pub file: String,
    /// Where in it.
    pub place: Place,
    /// Path of the key, as `--set` takes it (`body.0.box.upper`); empty where no key is concerned.
    pub key: String,
    /// The code of the cause, which `bsmpm explain` explains, such as `E0001`.
    pub code: Option<String>,
    /// What was found and what is allowed, without the code.
    pub message: String,
    /// The word that was found, if earlier versions had it and this one does not.
    pub removed: Option<&'static RemovedWord>,
    /// The line of the file, shortened around the place, and the characters before the mark.
    pub(crate) excerpt: Option<(String, usize)>,
}

impl Error {
    /// An error of a file as a whole. `message` begins with its code.
    pub(crate) fn of_file(file: &str, message: &str) -> Self {
        Self {
            file: file.to_owned(),
            place: Place::File,
            key: String::new(),
            code: code_of(message).map(str::to_owned),
            message: without_code(message).to_owned(),
            removed: None,
            excerpt: None,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.place {
            Place::Line { line, column } => write!(f, "{}:{line}:{column}: ", self.file)?,
            Place::Override(text) => write!(f, "--set {text}: ")?,
            Place::File => write!(f, "{}: ", self.file)?,
        }
        match &self.code {
            Some(code) => write!(f, "error {code}: ")?,
            None => f.write_str("error: ")?,
        }
        if !self.key.is_empty() {
            write!(f, "{}: ", self.key)?;
        }
        f.write_str(&self.message)?;
        if let (true, Some((text, before)), Place::Line { line, .. }) = (f.alternate(), &self.excerpt, &self.place) {
            let gutter = line.to_string().len();
            write!(f, "\n  {line} | {text}\n  {:gutter$} | {:before$}^", "", "")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}
