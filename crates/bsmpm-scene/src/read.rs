//! Reads a case: parsing, overrides, presets, validation.

use crate::case::Case;
use crate::error::{Error, Origin};
use crate::report::Report;
use crate::schema::{Draft, ROOT};
use crate::source::{Source, decode};
use crate::validate::CaseUse;
use crate::{document, earlier, overrides, preset, slips, validate};

impl Case {
    /// The case in `text`, the content of the file `name`, with overrides `KEY=VALUE` merged in their order.
    ///
    /// # Errors
    /// All errors of the file and the overrides at once; if the text is no TOML, the syntax errors only.
    pub fn from_text(name: &str, text: &str, overrides: &[String]) -> Result<Self, Vec<Error>> {
        Self::from_bytes(name, text.as_bytes(), overrides)
    }

    /// [`Case::from_text`] for bytes as they stand in the file, see [`crate::load`].
    ///
    /// # Errors
    /// As [`Case::from_text`]; also if the bytes are too many, binary, UTF-16 or no UTF-8.
    pub fn from_bytes(name: &str, bytes: &[u8], overrides: &[String]) -> Result<Self, Vec<Error>> {
        Self::read(name, bytes, overrides, CaseUse::Run)
    }

    /// [`Case::from_bytes`] for the tests of one material point alone, which use the materials of the case and the
    /// cells for a softening strain: no rule of the run as a whole is checked, and the case cannot be run.
    ///
    /// # Errors
    /// As [`Case::from_bytes`].
    pub fn of_element_tests(name: &str, bytes: &[u8], overrides: &[String]) -> Result<Self, Vec<Error>> {
        Self::read(name, bytes, overrides, CaseUse::ElementTests)
    }

    fn read(name: &str, bytes: &[u8], overrides: &[String], case_use: CaseUse) -> Result<Self, Vec<Error>> {
        let text = decode(name, bytes)?;
        let source = Source::new(name, text);
        let mut report = Report::new(&source, overrides);
        let mut document = document::parse(&source, &mut report);
        if report.failed() {
            return Err(report.into_errors());
        }
        earlier::replace(&mut document, &mut report);
        overrides::apply(&mut document, overrides, &mut report);
        earlier::replace(&mut document, &mut report);
        if document.entries.is_empty() && !report.failed() {
            report.error(
                Origin::Nowhere,
                "",
                "E0003: the file is empty or has only comments. Check the name of the file.",
            );
            return Err(report.into_errors());
        }
        slips::mend(ROOT, &mut document, &mut report);
        let filled = preset::fill(&mut document, &source, overrides, &mut report);
        let draft = Draft::read(&document, &mut report);
        let as_written = overrides.is_empty() && !filled && !report.has_renamings();
        let effective = if as_written {
            text.to_owned()
        } else {
            document.to_toml()
        };
        match validate::case(&draft, effective, case_use, &mut report) {
            Some(case) if !report.failed() => Ok(case),
            _ => Err(report.into_errors()),
        }
    }
}
