//! Reads the validation matrix, a TOML file of studies. Unknown keys are errors; the module `check` finds
//! contradictions.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::expand::expand;
use super::table::DifferenceScale;
use crate::Error;
use crate::report::number;

/// When something is run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Depth {
    /// Always.
    Short,
    /// Unless only the short part is wanted.
    #[default]
    Full,
}

/// All studies.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ValidationMatrix {
    pub study: Vec<MatrixStudy>,
}

/// A case with its variations, and what is taken from them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MatrixStudy {
    pub title: String,
    /// heading of the table under which it stands
    #[serde(default = "other")]
    pub theme: String,
    /// relative to the matrix
    pub case: String,
    /// overrides of all its runs
    #[serde(default)]
    pub set: Vec<String>,
    #[serde(default)]
    pub depth: Depth,
    #[serde(default)]
    pub run: Vec<MatrixRun>,
    #[serde(default)]
    pub row: Vec<MatrixRow>,
    #[serde(default)]
    pub figure: Vec<Figure>,
    #[serde(default)]
    pub plot: Vec<Plot>,
}

/// One variation.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MatrixRun {
    pub name: String,
    /// relative to the matrix; the study's unless given
    pub case: Option<String>,
    #[serde(default)]
    pub set: Vec<String>,
    pub depth: Option<Depth>,
    /// no convergence, or material that leaves the grid, is a result and no failure
    #[serde(default)]
    pub may_stop: bool,
}

/// A number to be judged, or printed where it has neither tolerance nor bounds.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MatrixRow {
    pub quantity: String,
    #[serde(default)]
    pub source: String,
    /// that of its runs unless given
    pub depth: Option<Depth>,
    pub reference: Option<f64>,
    /// relative to the reference
    pub tolerance: Option<f64>,
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// a failure that is reported, and is none of the validation's
    pub known: Option<KnownFailure>,
    pub run: Option<String>,
    pub column: Option<String>,
    /// time; the last row of the history unless given
    pub at: Option<f64>,
    /// the place, or the window, by another column
    #[serde(rename = "where")]
    pub place: Option<MatrixPlace>,
    #[serde(default)]
    pub operation: Operation,
    /// the run from which a deviation is
    pub against: Option<String>,
    /// multiplies what is taken of the column
    pub scale: Option<f64>,
    pub order: Option<MeasuredOrder>,
    pub extrapolated: Option<MeasuredOrder>,
    /// of the run, in place of a column
    pub kink: Option<MatrixKink>,
}

/// Why a row is known to fail, and the band in which its number lies as long as nothing else has changed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KnownFailure {
    pub why: String,
    pub min: f64,
    pub max: f64,
}

/// What is taken of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Operation {
    /// of a run that came to its end
    #[default]
    Last,
    /// the last row of a run wherever it ended: how far it came
    Reach,
    Max,
    Min,
    /// the largest less the smallest, over the mean: of a plateau it is small
    Spread,
    /// weighted by the column of the window: an integral over it, divided by its length
    Mean,
    /// from another run: the largest difference over a window, of a whole curve, relative to the other's value at the
    /// same value of the window's column
    Deviation,
}

/// Where a column first reaches a value; or the part of the history from one value to another, whole where one is
/// missing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MatrixPlace {
    #[serde(default = "time")]
    pub column: String,
    pub value: Option<f64>,
    pub from: Option<f64>,
    pub to: Option<f64>,
}

/// The same quantity on several grids.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeasuredOrder {
    /// coarse to fine
    pub runs: Vec<String>,
    pub sizes: Vec<f64>,
    /// or the kink of each
    pub column: Option<String>,
    pub kink: Option<MatrixKink>,
    pub at: Option<f64>,
    pub exact: Option<f64>,
}

/// A load-displacement curve whose bend is a failure load.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MatrixKink {
    pub x: String,
    pub y: String,
    /// x up to which it is straight: the elastic displacement is measured there
    pub elastic: f64,
    #[serde(default = "one")]
    pub scale: f64,
}

/// Curves of several runs in one picture.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Figure {
    pub file: String,
    #[serde(default = "time")]
    pub x: String,
    pub y: String,
    #[serde(default = "one")]
    pub x_scale: f64,
    #[serde(default = "one")]
    pub y_scale: f64,
    /// the columns and their units unless given
    pub x_label: Option<String>,
    pub y_label: Option<String>,
    #[serde(default)]
    pub runs: Vec<String>,
    /// runs of which each gives its last row, by the name of their curve
    #[serde(default)]
    pub curves: BTreeMap<String, Vec<String>>,
    /// the same for curves whose runs are named alike
    pub alike: Option<Alike>,
    /// x of the runs of every curve
    #[serde(default)]
    pub x_values: Vec<f64>,
    #[serde(default)]
    pub lines: Vec<(f64, String)>,
    /// relative to the matrix
    pub reference: Option<String>,
}

/// Curves with a run for each of the figure's `x_values`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Alike {
    pub curves: Vec<String>,
    /// name of a run, with {curve} and {x} in it
    pub run: String,
}

/// Pictures of the body of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plot {
    pub run: String,
    pub field: String,
    #[serde(default)]
    pub times: Vec<f64>,
    pub range: Option<(f64, f64)>,
}

fn one() -> f64 {
    1.0
}

fn time() -> String {
    "time".to_owned()
}

fn other() -> String {
    "Other problems".to_owned()
}

impl ValidationMatrix {
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(Error::unread("reference", path))?;
        Self::parse(&text).map_err(|reason| Error::BadReference {
            path: path.to_owned(),
            reason,
        })
    }

    /// The matrix in a text, expanded and checked.
    fn parse(text: &str) -> Result<Self, String> {
        let mut written: toml::Table = toml::from_str(text).map_err(|error| error.to_string())?;
        expand(&mut written)?;
        let mut matrix: Self = written.try_into().map_err(|error: toml::de::Error| error.to_string())?;
        matrix
            .study
            .iter_mut()
            .flat_map(|study| &mut study.figure)
            .for_each(Figure::name_runs);
        matrix.check()?;
        Ok(matrix)
    }
}

impl Figure {
    /// What it shows: the vertical over the horizontal axis.
    pub fn axes(&self) -> String {
        let x = self.x_label.as_ref().unwrap_or(&self.x);
        let y = self.y_label.as_ref().unwrap_or(&self.y);
        format!("{y} against {x}")
    }

    /// Names the runs of curves that are named alike.
    fn name_runs(&mut self) {
        let Some(alike) = self.alike.take() else { return };
        for curve in alike.curves {
            let run = alike.run.replace("{curve}", &curve);
            let runs = self.x_values.iter().map(|x| run.replace("{x}", &format!("{x:?}")));
            self.curves.insert(curve, runs.collect());
        }
    }
}

impl MatrixStudy {
    /// When a run is made.
    pub fn depth_of(&self, run: &MatrixRun) -> Depth {
        run.depth.unwrap_or(self.depth)
    }
}

impl MatrixRow {
    /// The runs that it takes its number from.
    pub fn runs(&self) -> Vec<&str> {
        let orders = self
            .order
            .iter()
            .chain(&self.extrapolated)
            .flat_map(|order| &order.runs);
        self.run
            .iter()
            .chain(&self.against)
            .chain(orders)
            .map(String::as_str)
            .collect()
    }

    /// The run that its cells and seconds are of: of several grids the finest.
    pub fn last_run(&self) -> Option<&str> {
        let of_grids = self
            .order
            .iter()
            .chain(&self.extrapolated)
            .flat_map(|order| &order.runs);
        of_grids.last().or(self.run.as_ref()).map(String::as_str)
    }

    /// What the difference from the published value is given in: as its tolerance.
    pub fn difference_scale(&self) -> DifferenceScale {
        let has_bounds = self.min.is_some() || self.max.is_some();
        match self.tolerance {
            None if has_bounds => DifferenceScale::None,
            _ => DifferenceScale::Published,
        }
    }

    /// Half of the width of bounds that are symmetric about the published value.
    fn half_width(&self) -> Option<f64> {
        let (published, (min, max)) = self.reference.zip(self.min.zip(self.max))?;
        let half = (max - min) / 2.0;
        (self.tolerance.is_none() && (published - (min + half)).abs() <= 1e-3 * half).then_some(half)
    }

    /// Whether it can pass and fail.
    pub fn is_judged(&self) -> bool {
        self.tolerance.is_some() || self.min.is_some() || self.max.is_some()
    }

    /// Whether a number is within the bounds.
    pub fn holds(&self, ours: f64) -> bool {
        let is_near = match (self.tolerance, self.reference) {
            (Some(tolerance), Some(at)) => (ours - at).abs() <= tolerance * at.abs(),
            (Some(_), None) => false,
            (None, _) => true,
        };
        ours.is_finite() && is_near && self.min.is_none_or(|min| ours >= min) && self.max.is_none_or(|max| ours <= max)
    }

    /// The bounds in words.
    pub fn wanted(&self) -> String {
        if let Some(half) = self.half_width() {
            return format!("± {}", number(half));
        }
        let tolerance = self
            .tolerance
            .map(|tolerance| format!("{} %", number(100.0 * tolerance)));
        let bounds = match (self.min, self.max) {
            (None, None) => None,
            (Some(min), None) => Some(format!("at least {min}")),
            (None, Some(max)) => Some(format!("at most {max}")),
            (Some(min), Some(max)) => Some(format!("{min} to {max}")),
        };
        tolerance.into_iter().chain(bounds).collect::<Vec<_>>().join(", ")
    }
}
