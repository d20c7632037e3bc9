//! Data of histories and their checks.

use crate::observables::{HistorySubject, Observable, PointSelection};
use crate::words::Geometry;

/// A quantity that is recorded every step.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// What is recorded.
    pub quantity: Quantity,
    /// Name of the column, or beginning of the columns' names.
    pub name: String,
    /// -  multiplies
    pub scale: f64,
    /// Kind of the geometry: what extensive numbers are of.
    pub geometry: Geometry,
    /// Whether its place is at a body that no stage places or removes: the point that it follows is one of those.
    pub lasts: bool,
}

/// What a history records, and of what.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// What is recorded.
    pub observable: Observable,
    /// What it is of.
    pub subject: HistorySubject,
}

impl Quantity {
    /// An observable of a subject.
    pub fn new(observable: Observable, subject: HistorySubject) -> Self {
        Self { observable, subject }
    }

    /// The points that it counts.
    pub fn counted(&self) -> PointSelection {
        match self.subject {
            HistorySubject::Part(of) | HistorySubject::Percentile { of, .. } | HistorySubject::Near { of, .. } => of,
            _ => PointSelection::default(),
        }
    }
}

/// One column of the history file.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Unit of its numbers; `scaled UNIT` where a scale multiplies.
    pub unit: String,
}

impl History {
    /// What the physics' numbers are multiplied with.
    pub fn factor(&self) -> f64 {
        let observable = self.quantity.observable;
        let whole = self
            .geometry
            .unit(observable.unit())
            .map_or(1.0, |_| self.geometry.whole());
        self.scale * whole
    }

    /// Its columns in the history file.
    pub fn columns(&self) -> Vec<Column> {
        let columns = self.quantity.observable.columns_in(self.geometry.dims());
        let columns = columns.iter().enumerate().map(|(number, (suffix, _))| Column {
            name: format!("{}{suffix}", self.name),
            unit: self.unit_of(number),
        });
        columns.collect()
    }

    /// Unit of the column with a number.
    fn unit_of(&self, number: usize) -> String {
        let in_plane = self.quantity.observable.unit_of(number, self.geometry.dims());
        let unit = self.geometry.unit(in_plane).unwrap_or(in_plane);
        if self.scale == 1.0 {
            unit.to_owned()
        } else {
            format!("scaled {unit}")
        }
    }
}

/// Bounds of a history column at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Name of the column.
    pub quantity: String,
    /// s (quasi-static: pseudo-time)  within (0, end]; hit exactly
    pub at: f64,
    /// Least value, in the column's unit.
    pub min: Option<f64>,
    /// Largest value, in the column's unit.
    pub max: Option<f64>,
}
