//! Reference values for the errors of a sweep.

use std::path::{Path, PathBuf};

use bsmpm_io::directory::HISTORY;
use bsmpm_io::manifest::{Manifest, Status};
use bsmpm_io::table;
use serde::Serialize;

use super::axes::split;
use super::quantity::SweepQuantity;
use super::study::Point;
use crate::Error;
use crate::grid_convergence::{ConvergenceType, Index};

/// What was asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Reference {
    Baseline,
    Finest,
    Extrapolated,
    Run(PathBuf),
    /// for all parts of all quantities, in their order
    Numbers(Vec<f64>),
}

/// What it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct FoundReference {
    /// In words.
    pub what: String,
    /// For each quantity those of its parts; none where there are none.
    pub values: Vec<Option<Vec<f64>>>,
    /// The run of the sweep that it is; its own error is zero and says nothing.
    pub run: Option<usize>,
    /// What the reader should know of it.
    pub notes: Vec<String>,
}

/// Values of a run of the sweep: for each quantity those of its parts.
pub(super) type ReferenceValues = Vec<Option<Vec<f64>>>;

impl Reference {
    /// `baseline`, `finest`, `extrapolated`, a number for each part, or the directory of a run.
    pub fn parse(text: &str) -> Self {
        let numbers: Option<Vec<f64>> = split(text).iter().map(|part| part.parse().ok()).collect();
        match (text, numbers) {
            ("baseline", _) => Self::Baseline,
            ("finest", _) => Self::Finest,
            ("extrapolated", _) => Self::Extrapolated,
            (_, Some(numbers)) => Self::Numbers(numbers),
            _ => Self::Run(PathBuf::from(text)),
        }
    }

    /// What can be seen to be wrong before anything runs.
    pub fn check(&self, quantities: &[SweepQuantity]) -> Result<(), Error> {
        let parts: usize = quantities.iter().map(|quantity| quantity.parts.len()).sum();
        match self {
            Self::Baseline | Self::Finest | Self::Extrapolated => Ok(()),
            Self::Numbers(numbers) if numbers.len() == parts && numbers.iter().all(|number| number.is_finite()) => {
                Ok(())
            }
            Self::Numbers(numbers) => Err(Error::Usage {
                reason: format!(
                    "E0840: --reference has {} number(s) for {parts} quantities. Give one finite number for each \
                     quantity.",
                    numbers.len()
                ),
            }),
            Self::Run(directory) => elsewhere(directory, quantities).map(|_| ()),
        }
    }

    /// The reference among runs of which those without values did not finish.
    ///
    /// # Errors
    /// Those of a run elsewhere that does not have the quantities.
    pub fn find(
        &self,
        quantities: &[SweepQuantity],
        points: &[Point],
        values: &[Option<ReferenceValues>],
    ) -> Result<FoundReference, Error> {
        match self {
            Self::Baseline => Ok(baseline(quantities, points, values)),
            Self::Finest => Ok(finest(quantities, points, values)),
            Self::Extrapolated => Ok(extrapolated(quantities, points, values)),
            Self::Run(directory) => {
                let values = elsewhere(directory, quantities)?.into_iter().map(Some).collect();
                Ok(FoundReference {
                    what: format!("the run in {}", directory.display()),
                    values,
                    run: None,
                    notes: Vec::new(),
                })
            }
            Self::Numbers(numbers) => {
                let mut numbers = numbers.iter().copied();
                let values = quantities
                    .iter()
                    .map(|quantity| Some(numbers.by_ref().take(quantity.parts.len()).collect()));
                Ok(FoundReference {
                    what: "the numbers given".to_owned(),
                    values: values.collect(),
                    run: None,
                    notes: Vec::new(),
                })
            }
        }
    }
}

/// The quantities of a run that is not of the sweep.
fn elsewhere(directory: &Path, quantities: &[SweepQuantity]) -> Result<Vec<Vec<f64>>, Error> {
    let manifest = Manifest::read(directory).map_err(|error| refused(directory, &error.to_string()))?;
    if manifest.status == Status::Running || manifest.status == Status::Stopped {
        return Err(refused(directory, "the run is not completed"));
    }
    let history = table::read(&directory.join(HISTORY))?;
    let values = quantities.iter().map(|quantity| quantity.values(&history));
    values
        .collect::<Result<_, _>>()
        .map_err(|reason| refused(directory, &reason))
}

/// The error of a run that is no reference.
fn refused(directory: &Path, reason: &str) -> Error {
    let reason = format!(
        "E0840: the reference {} cannot be used: {reason}. Give the directory of a completed run.",
        directory.display()
    );
    Error::Usage { reason }
}

/// The finest run that has finished.
fn best(points: &[Point], values: &[Option<ReferenceValues>]) -> Option<usize> {
    let there = (0..points.len()).filter(|&index| values[index].is_some());
    there.max_by(|&a, &b| {
        points[a]
            .fineness()
            .partial_cmp(&points[b].fineness())
            .unwrap_or(std::cmp::Ordering::Equal)
    })
}

fn baseline(quantities: &[SweepQuantity], points: &[Point], values: &[Option<ReferenceValues>]) -> FoundReference {
    let index = points.iter().position(|point| point.is_baseline);
    of_run(index, "the baseline", quantities, points, values)
}

fn finest(quantities: &[SweepQuantity], points: &[Point], values: &[Option<ReferenceValues>]) -> FoundReference {
    of_run(
        best(points, values),
        "the finest completed run",
        quantities,
        points,
        values,
    )
}

/// A run of the sweep as the reference, if it has finished.
fn of_run(
    index: Option<usize>,
    what: &str,
    quantities: &[SweepQuantity],
    points: &[Point],
    values: &[Option<ReferenceValues>],
) -> FoundReference {
    let Some((index, values)) = index.and_then(|index| Some((index, values[index].clone()?))) else {
        let what = format!("none: {what} is missing");
        return FoundReference {
            what,
            values: vec![None; quantities.len()],
            run: None,
            notes: Vec::new(),
        };
    };
    FoundReference {
        what: format!("{what}: {}", points[index].name()),
        values,
        run: Some(index),
        notes: Vec::new(),
    }
}

/// From the three smallest cells of the runs that differ from the finest one in them alone.
fn extrapolated(quantities: &[SweepQuantity], points: &[Point], values: &[Option<ReferenceValues>]) -> FoundReference {
    let mut found = finest(quantities, points, values);
    let Some(run) = found.run else { return found };
    let mut series: Vec<(f64, &ReferenceValues)> = Vec::new();
    for (point, values) in points.iter().zip(values) {
        if point.differs_in_cells_only(&points[run]) {
            series.extend(point.cell().zip(values.as_ref()));
        }
    }
    series.sort_by(|a, b| a.0.total_cmp(&b.0));
    series.dedup_by(|a, b| a.0 == b.0);
    let [first, second, third, ..] = series[..] else {
        let sizes = series.len();
        found.notes.push(format!(
            "no extrapolation, because it needs runs with three cell sizes that are equal otherwise, and there are {sizes}; errors \
             refer to the finest run"
        ));
        return found;
    };
    let h = [first.0, second.0, third.0];
    found.what = format!("extrapolated from cells of {} m, {} m and {} m", h[0], h[1], h[2]);
    let finest = found.run.take();
    for (index, quantity) in quantities.iter().enumerate() {
        let mut limits = Vec::new();
        for part in 0..quantity.parts.len() {
            let f = [first, second, third].map(|(_, values)| match &values[index] {
                Some(values) => values[part],
                None => f64::NAN,
            });
            let limit = limit(h, f);
            found
                .notes
                .push(format!("{}: {}", quantity.parts[part].words(), limit.1));
            limits.push(limit.0);
            if limit.0 == f[0] {
                found.run = finest; // its own value is the reference: it has no error to be judged by
            }
        }
        found.values[index] = Some(limits);
    }
    found
}

/// The limit of three values, or the finest one where they show none; and in words which.
fn limit(h: [f64; 3], f: [f64; 3]) -> (f64, String) {
    let index = Index::of(h, f);
    match (index.extrapolated, index.order, index.course) {
        (Some(limit), Some(order), _) => (limit, format!("order {order:.2}, limit {limit:.6}")),
        (_, _, ConvergenceType::Unchanged) => (f[0], format!("the two finest agree: {}", f[0])),
        (_, _, course) => {
            let word = match course {
                ConvergenceType::Oscillatory => "oscillate",
                ConvergenceType::OscillatoryDiverging => "oscillate and diverge",
                _ => "do not converge",
            };
            (
                f[0],
                format!("{}, {}, {} {word}; the reference is the finest value", f[2], f[1], f[0]),
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::study::tests::points;
    use super::*;

    #[test]
    fn references_are_read() {
        assert_eq!(Reference::parse("baseline"), Reference::Baseline);
        assert_eq!(Reference::parse("finest"), Reference::Finest);
        assert_eq!(Reference::parse("extrapolated"), Reference::Extrapolated);
        assert_eq!(Reference::parse("0.45, 1e-3"), Reference::Numbers(vec![0.45, 1e-3]));
        assert_eq!(Reference::parse("run.out"), Reference::Run("run.out".into()));
        let quantity = [SweepQuantity::parse("a,b").unwrap()];
        assert!(Reference::Numbers(vec![1.0, 2.0]).check(&quantity).is_ok());
        assert!(Reference::Numbers(vec![1.0]).check(&quantity).is_err());
        assert!(Reference::Numbers(vec![1.0, f64::NAN]).check(&quantity).is_err());
        assert!(Reference::Run("nowhere".into()).check(&quantity).is_err());
    }

    #[test]
    fn a_limit_is_taken_only_where_there_is_one() {
        let (value, words) = limit([1.0, 2.0, 4.0], [1.1, 1.2, 1.4]);
        assert!((value - 1.0).abs() < 1e-12 && words.contains("order 1.00"), "{words}");
        let (value, words) = limit([1.0, 2.0, 4.0], [1.4, 1.2, 1.1]);
        assert!(value == 1.4 && words.contains("do not converge"), "{words}");
        let (value, words) = limit([1.0, 2.0, 4.0], [1.1, 1.0, 1.4]);
        assert!(value == 1.1 && words.contains("oscillate"), "{words}");
    }

    #[test]
    fn the_finest_run_that_finished_is_the_reference_or_what_its_cells_tend_to() {
        let vary = ["grid.cell=10 mm,5 mm,2.5 mm", "body.0.points_per_cell=2,3"];
        let points = points(&vary, false, &[]).unwrap();
        let quantity = [SweepQuantity::parse("a").unwrap()];
        // 5 + 1e3 h of three points a cell; what fewer points give is of no matter, and the finest run of all failed.
        let value = |a: f64| Some(vec![Some(vec![a])]);
        let values = [value(1.0), value(15.0), value(2.0), value(10.0), value(3.0), value(7.5)];
        let found = |reference: &Reference, values: &[Option<ReferenceValues>]| {
            reference.find(&quantity, &points, values).unwrap()
        };
        assert_eq!(found(&Reference::Finest, &values).run, Some(5));
        let own = points.iter().position(|point| point.is_baseline);
        assert!(own == Some(0) && found(&Reference::Baseline, &values).run == own);
        let limit = found(&Reference::Extrapolated, &values);
        assert!(
            (limit.values[0].as_ref().unwrap()[0] - 5.0).abs() < 1e-9 && limit.run.is_none(),
            "{limit:?}"
        );
        let mut fewer = values.clone();
        fewer[5] = None;
        let limit = found(&Reference::Extrapolated, &fewer);
        assert_eq!(
            (limit.run, limit.values[0].clone()),
            (Some(4), Some(vec![3.0])),
            "{limit:?}"
        );
        fewer[0] = None;
        let none = found(&Reference::Baseline, &fewer);
        assert!(
            none.run.is_none() && none.what == "none: the baseline is missing",
            "{none:?}"
        );
        let limit = found(&Reference::Extrapolated, &fewer);
        assert!(
            limit.run == Some(4) && limit.notes[0].contains("three cell sizes"),
            "{limit:?}"
        );
        let nothing = found(&Reference::Finest, &vec![None; 6]);
        assert!(nothing.run.is_none() && nothing.values == [None]);
    }
}
