//! Reads the results of a run for pictures.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use bsmpm_io::directory::HISTORY;
use bsmpm_io::frame::Frame;
use bsmpm_io::frames::{Entry, read_collection};
use bsmpm_io::manifest::Manifest;
use bsmpm_io::steps::STEPS;
use bsmpm_io::table::{self, Columns, TableColumn};
use bsmpm_io::vtu;
use bsmpm_scene::words::{Support, Word};
use bsmpm_scene::{Regime, Sketch, SketchedHistory};

use crate::Error;
use crate::picture::axes::Label;

/// s
const DAY: f64 = 86_400.0;
const YEAR: f64 = 365.25 * DAY;

/// The files of a run; those that are not there yet are none.
pub(crate) struct RunRecord {
    pub directory: PathBuf,
    pub manifest: Manifest,
    pub case: Sketch,
    /// the axis across the section that pictures of a solid show
    pub across: usize,
    entries: Vec<Entry>,
    pub history: Option<Columns>,
    pub steps: Option<Columns>,
}

impl RunRecord {
    pub fn read(directory: &Path) -> Result<Self, Error> {
        let manifest = present(Manifest::read(directory))?;
        let manifest = manifest.ok_or_else(|| Error::no_run(directory))?;
        Ok(Self {
            directory: directory.to_owned(),
            case: Sketch::of(&manifest.case.text),
            across: 1,
            manifest,
            entries: present(read_collection(directory))?.unwrap_or_default(),
            history: present(table::read(&directory.join(HISTORY)))?,
            steps: present(table::read(&directory.join(STEPS)))?,
        })
    }

    /// Whether it is in three dimensions, and pictures show a section. Runs of earlier versions say `solid`.
    pub fn is_solid(&self) -> bool {
        ["3d", "solid"].contains(&self.manifest.case.geometry.as_str())
    }

    /// The axes that pictures show: the one to the right and the one upwards.
    pub fn plane(&self) -> [usize; 2] {
        match self.across {
            _ if !self.is_solid() => [0, 1],
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        }
    }

    /// What they are called, with their unit.
    pub fn axes(&self) -> [Label<'static>; 2] {
        let names = if self.manifest.case.geometry == "axisymmetric" {
            ["r", "y", "z"]
        } else {
            ["x", "y", "z"]
        };
        self.plane().map(|axis| Label::of(names[axis], "m"))
    }

    /// Whether inertia acts: as the case says, else by the unit of time, which a quasi-static analysis does not have.
    pub fn regime(&self) -> Regime {
        let mut tables = [&self.history, &self.steps].into_iter().flatten();
        self.case
            .regime
            .unwrap_or_else(|| match tables.find_map(|table| table.unit("time")) {
                Some("-") => Regime::QuasiStatic,
                _ => Regime::Dynamic,
            })
    }

    /// The column `name` of `history.csv`.
    pub fn column(&self, name: &str) -> Option<Recorded<'_>> {
        self.all_columns().find(|column| column.name == name)
    }

    /// The columns of `history.csv` that record a quantity, found by the case's `[[history]]` tables, or without such
    /// by name.
    pub fn columns(&self, quantity: &str) -> Vec<Recorded<'_>> {
        self.all_columns()
            .filter(|column| match self.history_of(column.name) {
                Some(history) => history.quantity.word() == quantity,
                None => self.case.histories.is_empty() && bears(column.name, quantity),
            })
            .collect()
    }

    fn all_columns(&self) -> impl Iterator<Item = Recorded<'_>> {
        let columns = self
            .history
            .iter()
            .flat_map(|table| table.headings.iter().zip(&table.values));
        columns.map(|(TableColumn { name, unit }, values)| {
            let scale = self.history_of(name).map_or(1.0, |history| history.scale);
            Recorded {
                name,
                unit,
                scale,
                values,
            }
        })
    }

    /// The case's table that a column comes from: of several names that it begins with, the longest.
    fn history_of(&self, column: &str) -> Option<&SketchedHistory> {
        let of_column = self
            .case
            .histories
            .iter()
            .filter(|history| bears(column, &history.name));
        of_column.max_by_key(|history| history.name.len())
    }

    /// Whether time is a pseudo-time without unit.
    fn is_timeless(&self) -> bool {
        self.case
            .is_timeless
            .unwrap_or_else(|| self.regime() == Regime::QuasiStatic)
    }

    /// The axis label of time.
    pub fn time_label(&self) -> Label<'static> {
        if self.is_timeless() {
            Label::of("Pseudo-time", "-")
        } else {
            Label::of("Time", "s")
        }
    }

    /// A moment in words, for titles and legends.
    pub fn moment(&self, time: f64) -> String {
        if self.is_timeless() {
            return format!("pseudo-time {}", short(time));
        }
        // From two of them on, in the units in which consolidation is spoken of.
        let units = [("years", YEAR), ("d", DAY)];
        let (unit, length) = units
            .into_iter()
            .find(|(_, length)| time >= 2.0 * length)
            .unwrap_or(("s", 1.0));
        format!("t = {} {unit}", short(time / length))
    }

    /// Whether the grid's lower and upper faces along the axes of pictures hold the body.
    pub fn walls(&self) -> [[bool; 2]; 2] {
        let Some(axes) = self.case.boundary else {
            return Default::default();
        };
        self.plane().map(|axis| axes[axis].map(|face| face != Support::Free))
    }

    /// m  The whole width of the footing, of which a half model that begins or ends at a plane of symmetry has only the
    /// half.
    pub fn footing_width(&self) -> Option<f64> {
        let [from, to] = self.case.footing?;
        let grid = self.manifest.grid.as_ref()?;
        let left = from[0].min(to[0]);
        let right = from[0].max(to[0]);
        let width = right - left;
        let is_plane = self.case.boundary?[0].map(|face| face == Support::Roller);
        let at_left = is_plane[0] && (left - grid.lower.first()?).abs() <= 1e-6 * width;
        let at_right = is_plane[1] && (right - grid.upper.first()?).abs() <= 1e-6 * width;
        (width > 0.0).then_some(if at_left == at_right { width } else { 2.0 * width })
    }

    /// The frames nearest to the wanted times; without such, those of the case, or three that are evenly spread.
    pub fn frames(&self, wanted: &[f64]) -> Result<Vec<Frame>, Error> {
        let last = self.entries.len().saturating_sub(1);
        let mut chosen: Vec<usize> = wanted.iter().filter_map(|&time| self.nearest(time)).collect();
        if wanted.is_empty() {
            let case = self.manifest.picture_times.iter();
            chosen = case
                .filter_map(|&time| self.nearest(time).filter(|&index| self.is_at(index, time)))
                .collect();
        }
        if chosen.is_empty() && !self.entries.is_empty() {
            chosen = vec![last.div_ceil(3), (2 * last).div_ceil(3), last];
        }
        chosen.sort_unstable();
        chosen.dedup();
        chosen
            .iter()
            .map(|&index| Ok(vtu::read(&self.directory.join(&self.entries[index].file))?))
            .collect()
    }

    fn nearest(&self, time: f64) -> Option<usize> {
        let distances = self.entries.iter().map(|entry| (entry.time - time).abs());
        let nearest = distances.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b));
        nearest.map(|(index, _)| index)
    }

    /// The case's times are hit exactly, but for rounding; one that a run has not reached has no frame.
    fn is_at(&self, index: usize, time: f64) -> bool {
        (self.entries[index].time - time).abs() <= 1e-6 * time.abs()
    }
}

/// Whether a column of `history.csv` is called as a history is, or as one of its components, `name-...`.
fn bears(column: &str, name: &str) -> bool {
    column
        .strip_prefix(name)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
}

/// A column of `history.csv` that records a quantity of the case.
#[derive(Clone, Copy)]
pub(crate) struct Recorded<'a> {
    pub name: &'a str,
    pub unit: &'a str,
    /// The factor that multiplies it.
    pub scale: f64,
    pub values: &'a [f64],
}

impl<'a> Recorded<'a> {
    /// The label of an axis: `stress-noise` becomes `Stress noise`; a name of the case's own for what it has scaled is
    /// read as a formula, `E_delta_over_gamma_H2` as `E δ/(γ H²)`.
    pub fn label(&self) -> String {
        if self.shown_unit() != self.unit {
            return formula(self.name);
        }
        let name = self.name.replace(['-', '_'], " ");
        let mut letters = name.chars();
        letters
            .next()
            .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }

    /// The unit of an axis: a scaled column has one of the case's own, which is not known.
    pub fn shown_unit(&self) -> &'a str {
        if self.unit.starts_with("scaled ") {
            "-"
        } else {
            self.unit
        }
    }
}

/// A name as a formula: factors between `_`, a fraction with `_over_`, Greek letters by their names.
fn formula(name: &str) -> String {
    match name.split_once("_over_") {
        Some((above, below)) if below.contains('_') => format!("{}/({})", product(above), product(below)),
        Some((above, below)) => format!("{}/{}", product(above), product(below)),
        None => product(name),
    }
}

/// The factors of a formula.
fn product(text: &str) -> String {
    text.split('_').map(factor).collect::<Vec<_>>().join(" ")
}

/// A factor of a formula.
fn factor(text: &str) -> String {
    match text {
        "gamma" => "γ".to_owned(),
        "delta" => "δ".to_owned(),
        "sigma" => "σ".to_owned(),
        _ => match text.strip_suffix('2') {
            Some(base) => format!("{base}²"),
            None => text.to_owned(),
        },
    }
}

/// A file that is not there is none; other trouble with it is an error.
pub(crate) fn present<T>(read: Result<T, bsmpm_io::Error>) -> Result<Option<T>, Error> {
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
pub(crate) fn short(time: f64) -> f64 {
    format!("{time:.5e}").parse().unwrap_or(time)
}

#[cfg(test)]
mod tests {
    use bsmpm_io::manifest::{GridExtent, ManifestCase};

    use super::*;

    const HALF: &str =
        "boundary = { left = 'roller', right = 'roller' }\nfooting = { from = [0, 10.0], to = ['1 m', 10.0] }";

    fn record(text: &str) -> RunRecord {
        let mut manifest = Manifest::begin("0.1.0", Vec::new(), ManifestCase::new("", "", "", text.to_owned()));
        manifest.grid = Some(GridExtent {
            lower: vec![0.0; 2],
            upper: vec![5.0, 11.0],
            cell: vec![0.1; 2],
        });
        let directory = PathBuf::new();
        let entries = Vec::new();
        RunRecord {
            directory,
            manifest,
            case: Sketch::of(text),
            across: 1,
            entries,
            history: None,
            steps: None,
        }
    }

    #[test]
    fn half_a_footing_is_doubled() {
        let width = |text: &str| record(text).footing_width();
        assert_eq!(width(HALF), Some(2.0));
        assert_eq!(width(&HALF.replace("roller", "free")), Some(1.0));
        assert_eq!(width(&HALF.replace("[0, 10.0]", "['0.5 m', 10.0]")), Some(0.5));
        assert_eq!(width(&HALF.replace("[0, 10.0]", "'far'")), None);
    }

    #[test]
    fn walls_are_faces_that_hold() {
        assert_eq!(record(HALF).walls(), [[true, true], [false, false]]);
        assert_eq!(record("").walls(), [[false; 2]; 2]);
    }

    #[test]
    fn columns_bear_the_names_of_their_histories() {
        assert!(bears("displacement-x", "displacement") && !bears("displacements", "displacement"));
    }

    #[test]
    fn names_are_read_as_formulas() {
        assert_eq!(formula("p_over_c"), "p/c");
        assert_eq!(formula("E_delta_over_gamma_H2"), "E δ/(γ H²)");
        assert_eq!(formula("tip-x"), "tip-x");
    }
}
