//! The matrix as it is written: unknown keys are errors.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use clap::ValueEnum;
use serde::Deserialize;

use crate::Error;
use crate::plot::FieldName;

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
pub(super) struct Matrix {
    pub study: Vec<Study>,
}

/// A case with its variations, and what is taken from them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Study {
    pub title: String,
    /// relative to the matrix
    pub case: String,
    /// overrides of all its runs
    #[serde(default)]
    pub set: Vec<String>,
    #[serde(default)]
    pub depth: Depth,
    #[serde(default)]
    pub run: Vec<Run>,
    #[serde(default)]
    pub row: Vec<Row>,
    #[serde(default)]
    pub figure: Vec<Figure>,
    #[serde(default)]
    pub plot: Vec<Plot>,
}

/// One variation.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Run {
    pub name: String,
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
pub(super) struct Row {
    pub quantity: String,
    #[serde(default)]
    pub source: String,
    pub depth: Option<Depth>,
    pub reference: Option<f64>,
    /// relative to the reference
    pub tolerance: Option<f64>,
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// why it is known to fail: it is told as a failure, but is none of the program's being worse than it was
    pub known: Option<String>,
    pub run: Option<String>,
    pub column: Option<String>,
    /// time; the last row of the history unless given
    pub at: Option<f64>,
    #[serde(default)]
    pub operation: Operation,
    #[serde(default = "one")]
    pub scale: f64,
    pub order: Option<Order>,
    pub extrapolated: Option<Order>,
    pub kink: Option<Kink>,
}

/// What is taken of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Operation {
    #[default]
    Last,
    Max,
    Min,
}

/// The same quantity on several grids.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Order {
    /// coarse to fine
    pub runs: Vec<String>,
    pub sizes: Vec<f64>,
    pub column: String,
    pub at: Option<f64>,
    pub exact: Option<f64>,
}

/// A load-displacement curve whose bend is a failure load.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Kink {
    pub run: String,
    pub x: String,
    pub y: String,
    #[serde(default = "one")]
    pub scale: f64,
}

/// Curves of several runs in one picture.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Figure {
    pub file: String,
    #[serde(default)]
    pub x: String,
    pub y: String,
    #[serde(default = "one")]
    pub x_scale: f64,
    pub x_label: String,
    pub y_label: String,
    #[serde(default)]
    pub runs: Vec<String>,
    /// runs of which each gives its last row, by the name of their curve
    #[serde(default)]
    pub curves: BTreeMap<String, Vec<String>>,
    /// x of the runs of every curve
    #[serde(default)]
    pub x_values: Vec<f64>,
    #[serde(default)]
    pub lines: Vec<(f64, String)>,
    /// relative to the matrix
    pub reference: Option<String>,
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

impl Matrix {
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(|source| Error::NoReference { path: path.to_owned(), source })?;
        let bad = |reason: String| Error::BadReference { path: path.to_owned(), reason };
        let matrix: Self = toml::from_str(&text).map_err(|error| bad(error.to_string()))?;
        matrix.study.iter().try_for_each(Study::check).map_err(bad)?;
        Ok(matrix)
    }
}

impl Study {
    /// Every run that is named is there, and every row says what it takes.
    fn check(&self) -> Result<(), String> {
        let about = |row: &str, what: &str| format!("study \"{}\", \"{row}\": {what}", self.title);
        let known = |name: &str| self.run.iter().any(|run| run.name == name);
        for row in &self.row {
            if let Some(name) = row.runs().into_iter().find(|name| !known(name)) {
                return Err(about(&row.quantity, &format!("there is no run \"{name}\"")));
            }
            let ways = [row.column.is_some(), row.order.is_some(), row.extrapolated.is_some(), row.kink.is_some()];
            if ways.iter().filter(|way| **way).count() != 1 || row.column.is_some() != row.run.is_some() {
                return Err(about(&row.quantity, "one of run with column, order, extrapolated, kink is needed"));
            }
            if row.tolerance.is_some() && row.reference.is_none() {
                return Err(about(&row.quantity, "a tolerance needs a reference"));
            }
            if let Some(order) = row
                .order
                .as_ref()
                .or(row.extrapolated.as_ref())
                .filter(|order| order.runs.len() != order.sizes.len() || order.runs.len() < 3)
            {
                return Err(about(&row.quantity, &format!("{} runs need as many sizes, at least 3", order.runs.len())));
            }
        }
        let figures = self.figure.iter().flat_map(|figure| figure.runs.iter().chain(figure.curves.values().flatten()));
        match figures.chain(self.plot.iter().map(|plot| &plot.run)).find(|name| !known(name)) {
            Some(name) => Err(about("figure", &format!("there is no run \"{name}\""))),
            None => Ok(()),
        }
    }
}

impl Row {
    /// The runs that it takes its number from.
    pub fn runs(&self) -> Vec<&str> {
        let orders = self.order.iter().chain(&self.extrapolated).flat_map(|order| &order.runs);
        let single = self.run.iter().chain(self.kink.iter().map(|kink| &kink.run));
        single.chain(orders).map(String::as_str).collect()
    }

    /// Whether it can pass and fail.
    pub fn is_judged(&self) -> bool {
        self.tolerance.is_some() || self.min.is_some() || self.max.is_some()
    }

    /// Whether a number is within the bounds.
    pub fn holds(&self, ours: f64) -> bool {
        let near = |tolerance: f64| self.reference.is_some_and(|at| (ours - at).abs() <= tolerance * at.abs());
        ours.is_finite()
            && self.tolerance.is_none_or(near)
            && self.min.is_none_or(|min| ours >= min)
            && self.max.is_none_or(|max| ours <= max)
    }

    /// The bounds in words.
    pub fn wanted(&self) -> String {
        let tolerance = self.tolerance.map(|tolerance| format!("{} %", 100.0 * tolerance));
        let bounds = match (self.min, self.max) {
            (None, None) => None,
            (Some(min), None) => Some(format!(">= {min}")),
            (None, Some(max)) => Some(format!("<= {max}")),
            (Some(min), Some(max)) => Some(format!("{min} to {max}")),
        };
        tolerance.into_iter().chain(bounds).collect::<Vec<_>>().join(", ")
    }
}

impl Plot {
    pub fn field(&self) -> Result<FieldName, Error> {
        FieldName::from_str(&self.field, true)
            .map_err(|_| Error::Usage { reason: format!("there is no field \"{}\" to plot", self.field) })
    }
}
