//! Draws curves of several runs in one picture, with `bsmpm compare`.

use std::collections::BTreeMap;
use std::path::Path;

use super::matrix::Figure;
use super::runs::MatrixOutcome;
use crate::Error;
use crate::compare::{self, ChartLevel};

/// Draws a figure of the runs that left something; false if none did.
pub(super) fn draw(
    figure: &Figure,
    title: &str,
    outcomes: &BTreeMap<String, MatrixOutcome>,
    base: &Path,
    output: &Path,
) -> Result<bool, Error> {
    let left = |name: &String| outcomes.get(name).filter(|outcome| outcome.run.has_rows());
    let mut directories = Vec::new();
    let mut labels = Vec::new();
    let mut x_values = Vec::new();
    for name in &figure.runs {
        if let Some(outcome) = left(name) {
            directories.extend(outcome.run.directory.clone());
            labels.push(name.clone());
        }
    }
    for (label, names) in &figure.curves {
        for (name, x) in names.iter().zip(&figure.x_values) {
            // The last row of a run that stopped is no point of this curve.
            if let Some(outcome) = left(name).filter(|outcome| outcome.stopped.is_none()) {
                directories.extend(outcome.run.directory.clone());
                labels.push(label.clone());
                x_values.push(*x);
            }
        }
    }
    if directories.is_empty() {
        return Ok(false);
    }
    let lines = figure.lines.iter().map(|(value, text)| ChartLevel {
        value: *value,
        text: text.clone(),
    });
    compare::run(&compare::CompareArguments {
        directories,
        x: figure.x.clone(),
        y: Some(figure.y.clone()),
        residuals: None,
        x_scale: figure.x_scale,
        y_scale: figure.y_scale,
        x_label: figure.x_label.clone(),
        y_label: figure.y_label.clone(),
        title: Some(title.to_owned()),
        labels,
        lines: lines.collect(),
        references: figure.reference.iter().map(|file| base.join(file)).collect(),
        last: !figure.curves.is_empty(),
        x_values,
        output: Some(output.join(&figure.file)),
        table: false,
        at: Vec::new(),
    })
    .map(|_| true)
}
