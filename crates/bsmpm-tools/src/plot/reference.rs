//! Points from the literature or a laboratory that are drawn over the run's own.

use std::fs;
use std::path::Path;

use bsmpm_io::table::{self, Columns};

use crate::Error;

/// Reads a table of reference points; it must have a column `time` or be a function of one of the histories.
pub(super) fn read(path: &Path) -> Result<Columns, Error> {
    let text = fs::read_to_string(path).map_err(|source| Error::NoReference { path: path.to_owned(), source })?;
    let table = table::parse(&text).map_err(|reason| Error::BadReference { path: path.to_owned(), reason })?;
    if table.headings.len() < 2 {
        let reason = "it needs columns time,x,y or time and a history".to_owned();
        return Err(Error::BadReference { path: path.to_owned(), reason });
    }
    Ok(table)
}
