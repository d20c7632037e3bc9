//! Checks a validation matrix for contradictions before any run starts.

use std::path::Path;

use clap::ValueEnum;

use super::matrix::{
    Depth, Figure, KnownFailure, MatrixKink, MatrixPlace, MatrixRow, MatrixStudy, MeasuredOrder, Operation,
    ValidationMatrix,
};
use super::runs::slug;
use crate::plot::FieldName;

impl ValidationMatrix {
    /// `Err` says what does not fit, and where.
    pub fn check(&self) -> Result<(), String> {
        self.study.iter().try_for_each(|study| {
            study
                .check()
                .map_err(|(part, reason)| format!("study \"{}\", {part}: {reason}", study.title))
        })?;
        // Runs and pictures of several studies share directories.
        let titles = self.study.iter().map(|study| slug(&study.title));
        let files = self
            .study
            .iter()
            .flat_map(|study| &study.figure)
            .map(|figure| figure.file.clone());
        let plots = self.study.iter().flat_map(|study| &study.plot);
        let plots = plots.map(|plot| format!("{} of {}", plot.field, plot.run));
        distinct("studies' titles", titles)?;
        distinct("figures", files)?;
        distinct("plots", plots)
    }
}

fn distinct(what: &str, names: impl Iterator<Item = String>) -> Result<(), String> {
    let names: Vec<String> = names.collect();
    let again = names
        .iter()
        .enumerate()
        .find(|(index, name)| names[..*index].contains(name));
    again.map_or(Ok(()), |(_, name)| Err(format!("two {what} are the same: {name}")))
}

/// The part of a study, and what does not fit.
type Misfit = (String, String);

impl MatrixStudy {
    fn check(&self) -> Result<(), Misfit> {
        let in_runs = |reason| ("runs".to_owned(), reason);
        distinct("names", self.run.iter().map(|run| run.name.clone())).map_err(in_runs)?;
        if let Some(run) = self.run.iter().find(|run| !is_file_name(&run.name)) {
            return Err(in_runs(format!("\"{}\" is no name of a directory", run.name)));
        }
        for row in &self.row {
            self.check_row(row)
                .map_err(|reason| (format!("\"{}\"", row.quantity), reason))?;
        }
        for figure in &self.figure {
            let about = |reason| (format!("figure \"{}\"", figure.file), reason);
            self.are_known(figure.runs.iter().chain(figure.curves.values().flatten()))
                .map_err(about)?;
            figure.check().map_err(about)?;
        }
        for plot in &self.plot {
            let about = |reason| (format!("plot of \"{}\"", plot.run), reason);
            self.are_known([&plot.run]).map_err(about)?;
            if FieldName::from_str(&plot.field, true).is_err() {
                return Err(about(format!("there is no field \"{}\"", plot.field)));
            }
            if plot
                .range
                .is_some_and(|(lower, upper)| lower.partial_cmp(&upper) != Some(std::cmp::Ordering::Less))
            {
                return Err(about("the range begins above its end".to_owned()));
            }
        }
        Ok(())
    }

    fn are_known<'a>(&self, names: impl IntoIterator<Item = &'a String>) -> Result<(), String> {
        let unknown = names
            .into_iter()
            .find(|name| !self.run.iter().any(|run| run.name == **name));
        unknown.map_or(Ok(()), |name| Err(format!("there is no run \"{name}\"")))
    }

    fn check_row(&self, row: &MatrixRow) -> Result<(), String> {
        let names: Vec<String> = row.runs().into_iter().map(str::to_owned).collect();
        self.are_known(&names)?;
        let full = self.run.iter().filter(|run| self.depth_of(run) == Depth::Full);
        let full = names.iter().find(|name| full.clone().any(|run| run.name == **name));
        if let Some(name) = full.filter(|_| row.depth == Some(Depth::Short)) {
            return Err(format!("it is short, its run \"{name}\" is full"));
        }
        let ways = [
            row.column.is_some(),
            row.order.is_some(),
            row.extrapolated.is_some(),
            row.kink.is_some(),
        ];
        let is_single = row.column.is_some() || row.kink.is_some();
        if ways.iter().filter(|way| **way).count() != 1 || is_single != row.run.is_some() {
            return Err("one of run with column, run with kink, order, extrapolated is needed".into());
        }
        row.check_bounds()?;
        row.check_place()?;
        if row.order.as_ref().is_some_and(|order| order.exact.is_none()) {
            return Err("an order needs `exact`".into());
        }
        row.kink.iter().try_for_each(MatrixKink::check)?;
        row.order
            .iter()
            .chain(&row.extrapolated)
            .try_for_each(MeasuredOrder::check)
    }
}

/// A name in a directory, that leads nowhere else.
fn is_file_name(name: &str) -> bool {
    !name.starts_with('.') && Path::new(name).file_name().is_some_and(|last| last == name)
}

impl MatrixRow {
    fn check_bounds(&self) -> Result<(), String> {
        let numbers = [self.reference, self.tolerance, self.min, self.max, self.scale, self.at];
        if numbers.into_iter().flatten().any(|number| !number.is_finite()) {
            return Err("its numbers are not all finite".into());
        }
        match (self.tolerance, self.reference) {
            (Some(tolerance), _) if tolerance < 0.0 => return Err("its tolerance is negative".into()),
            (Some(_), None | Some(0.0)) => {
                return Err("a tolerance needs a reference other than 0, to which it is relative".into());
            }
            _ => {}
        }
        match (self.min, self.max, &self.known) {
            (Some(min), Some(max), _) if min > max => Err("its min is above its max".into()),
            (.., Some(_)) if !self.is_judged() => Err("it is known to fail, and cannot".into()),
            (.., Some(KnownFailure { min, max, .. })) if !(min <= max && min.is_finite() && max.is_finite()) => {
                Err("known needs a band: min and max, finite and in this order".into())
            }
            _ => Ok(()),
        }
    }

    /// Nothing is said about the place that would not be heeded.
    fn check_place(&self) -> Result<(), String> {
        let is_last = self.operation == Operation::Last;
        let says_where = self.at.is_some() || self.place.is_some() || self.scale.is_some() || !is_last;
        if self.column.is_none() && says_where {
            return Err("at, where, operation and scale belong to a row with a column".into());
        }
        if self.against.is_some() != (self.operation == Operation::Deviation) {
            return Err("a deviation is against a run, and nothing else is".into());
        }
        match (&self.place, self.at) {
            (place, at) if self.operation == Operation::Reach && (place.is_some() || at.is_some()) => {
                Err("reach is the last row: neither at nor where".into())
            }
            (Some(_), Some(_)) => Err("at and where exclude each other".into()),
            (None, Some(_)) if !is_last => Err("at is one row: max, min and mean take a window, with where".into()),
            (
                Some(MatrixPlace {
                    value: Some(_),
                    from: None,
                    to: None,
                    ..
                }),
                _,
            ) if !is_last => {
                Err("where has a value, which is one row: max, min and mean take a window, from and to".into())
            }
            (
                Some(MatrixPlace {
                    value: Some(_),
                    from,
                    to,
                    ..
                }),
                _,
            ) if from.is_some() || to.is_some() => Err("where has a value or a window, not both".into()),
            (Some(MatrixPlace { value: None, .. }), _) if is_last => {
                Err("where needs a value, or a window an operation: max, min, mean".into())
            }
            _ => Ok(()),
        }
    }
}

impl MeasuredOrder {
    fn check(&self) -> Result<(), String> {
        if self.runs.len() != self.sizes.len() || self.runs.len() < 2 {
            return Err(format!("{} runs need as many sizes, at least 2", self.runs.len()));
        }
        if self.column.is_some() == self.kink.is_some() || (self.kink.is_some() && self.at.is_some()) {
            return Err("one of column, at a time if at is given, and kink is needed".into());
        }
        self.kink.iter().try_for_each(MatrixKink::check)?;
        let shrink = self.sizes.windows(2).all(|pair| pair[1] < pair[0]) && self.sizes.iter().all(|size| *size > 0.0);
        if shrink {
            Ok(())
        } else {
            Err("the sizes go from coarse to fine and are positive".into())
        }
    }
}

impl MatrixKink {
    fn check(&self) -> Result<(), String> {
        let is_sound = self.elastic.is_finite() && self.elastic != 0.0 && self.scale.is_finite();
        if is_sound {
            Ok(())
        } else {
            Err("a kink's `elastic` and `scale` are finite, the first one is not 0".into())
        }
    }
}

impl Figure {
    fn check(&self) -> Result<(), String> {
        if !is_file_name(&self.file) || !self.file.ends_with(".png") {
            return Err("its file is a name that ends with .png".into());
        }
        if self.runs.is_empty() == self.curves.is_empty() {
            return Err("one of runs, curves is needed".into());
        }
        match self.curves.iter().find(|(_, runs)| runs.len() != self.x_values.len()) {
            Some((name, runs)) => Err(format!(
                "\"{name}\" has {} runs, x_values has {} numbers",
                runs.len(),
                self.x_values.len()
            )),
            None if self.curves.is_empty() && !self.x_values.is_empty() => Err("x_values belongs to curves".into()),
            None => Ok(()),
        }
    }
}
