//! What a run left, as the pictures need it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use bsmpm_io::directory::HISTORY;
use bsmpm_io::frame::Frame;
use bsmpm_io::frames::{Entry, read_collection};
use bsmpm_io::manifest::Manifest;
use bsmpm_io::steps::STEPS;
use bsmpm_io::table::{self, Columns};
use bsmpm_io::vtu;

use crate::Error;

/// The files of a run; those that are not there yet are none.
pub(super) struct Record {
    pub directory: PathBuf,
    pub manifest: Manifest,
    entries: Vec<Entry>,
    pub history: Option<Columns>,
    pub steps: Option<Columns>,
}

impl Record {
    pub fn read(directory: &Path) -> Result<Self, Error> {
        let manifest = present(Manifest::read(directory))?;
        let manifest = manifest.ok_or_else(|| Error::NoRun { directory: directory.to_owned() })?;
        Ok(Self {
            directory: directory.to_owned(),
            manifest,
            entries: present(read_collection(directory))?.unwrap_or_default(),
            history: present(table::read(&directory.join(HISTORY)))?,
            steps: present(table::read(&directory.join(STEPS)))?,
        })
    }

    /// Whether time has a unit: it has none in a quasi-static analysis.
    fn time_has_unit(&self) -> bool {
        let tables = [&self.history, &self.steps];
        tables.into_iter().flatten().find_map(|table| table.unit("time")) != Some("-")
    }

    /// The axis label of time.
    pub fn time_label(&self) -> (&'static str, &'static str) {
        if self.time_has_unit() { ("Time", "s") } else { ("Pseudo-time", "-") }
    }

    /// A moment in words, for titles and legends.
    pub fn moment(&self, time: f64) -> String {
        let unit = if self.time_has_unit() { " s" } else { "" };
        format!("t = {}{unit}", short(time))
    }

    /// The frames nearest to the wanted times; without such, those of the case, or three that are evenly spread.
    pub fn frames(&self, wanted: &[f64]) -> Result<Vec<Frame>, Error> {
        let last = self.entries.len().saturating_sub(1);
        let mut chosen: Vec<usize> = wanted.iter().filter_map(|&time| self.nearest(time)).collect();
        if wanted.is_empty() {
            let case = self.manifest.picture_times.iter();
            chosen = case.filter_map(|&time| self.nearest(time).filter(|&index| self.is_at(index, time))).collect();
        }
        if chosen.is_empty() && !self.entries.is_empty() {
            chosen = vec![last.div_ceil(3), (2 * last).div_ceil(3), last];
        }
        chosen.sort_unstable();
        chosen.dedup();
        chosen.iter().map(|&index| Ok(vtu::read(&self.directory.join(&self.entries[index].file))?)).collect()
    }

    fn nearest(&self, time: f64) -> Option<usize> {
        let distance = |index: &usize| (self.entries[*index].time - time).abs();
        (0..self.entries.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// The case's times are hit exactly, but for rounding; one that a run has not reached has no frame.
    fn is_at(&self, index: usize, time: f64) -> bool {
        (self.entries[index].time - time).abs() <= 1e-6 * time.abs()
    }
}

/// A file that is not there is none; other trouble with it is an error.
fn present<T>(read: Result<T, bsmpm_io::Error>) -> Result<Option<T>, Error> {
    match read {
        Ok(found) => Ok(Some(found)),
        Err(bsmpm_io::Error::File { source, .. })
            if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&source.kind()) =>
        {
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

/// A time to six digits, without the noise that sums of steps leave at the end.
pub(super) fn short(time: f64) -> f64 {
    format!("{time:.5e}").parse().unwrap_or(time)
}
