//! Reads the case file of a command.

use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use bsmpm_messages::{headed, with_context};
use bsmpm_scene::Case;

use crate::Error;

/// The bytes of a case file.
pub(crate) fn load(path: &Path) -> Result<Vec<u8>, Error> {
    let name = path.display().to_string();
    bsmpm_scene::load(path).map_err(|error| match error.kind() {
        ErrorKind::InvalidData => {
            let message = format!("{name}: {}", headed(&error.to_string(), "error"));
            Error::BadCase {
                path: path.to_owned(),
                errors: vec![message],
            }
        }
        _ => Error::Missing {
            reason: with_context(&error.to_string(), &name),
        },
    })
}

/// The case that overrides `KEY=VALUE` make of the bytes of its file.
pub(crate) fn parsed(path: &Path, bytes: &[u8], set: &[String]) -> Result<Case, Error> {
    let case =
        Case::from_bytes(&path.display().to_string(), bytes, set).map_err(|errors| Error::bad_case(path, &errors))?;
    note_renamings(&case);
    Ok(case)
}

/// Notes on standard error which earlier names a case has; each only once, however often the case is read.
fn note_renamings(case: &Case) {
    static NOTED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let mut noted = NOTED.lock().unwrap_or_else(PoisonError::into_inner);
    for renaming in &case.renamings {
        if noted.insert(renaming.clone()) {
            eprintln!("bsmpm: note: {renaming}");
        }
    }
}

/// The same for the tests of one material point alone.
pub(crate) fn parsed_for_element_tests(path: &Path, bytes: &[u8], set: &[String]) -> Result<Case, Error> {
    Case::of_element_tests(&path.display().to_string(), bytes, set).map_err(|errors| Error::bad_case(path, &errors))
}

/// Where what is made of a case is written unless its user says where: its stem with an ending, in the working
/// directory.
pub(crate) fn directory(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(ending);
    PathBuf::from(name)
}
