//! Runs of a sweep: the case with each setting.

use std::path::Path;

use toml::{Table, Value};

use super::axes::{SweepAxis, SweepSetting};
use crate::Error;
use crate::batch::RunOrder;

/// A run that is wanted.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Of each axis, as it is written.
    pub values: Vec<String>,
    /// What the baseline sets besides.
    pub besides: Vec<String>,
    /// The keys of the axes, the last parts of which stand in its name.
    keys: Vec<String>,
    /// What it is made from; all errors of a case that is none.
    pub order: Result<RunOrder, Vec<String>>,
    pub is_baseline: bool,
}

/// A case that is swept.
pub(super) struct Study<'a> {
    pub path: &'a Path,
    pub bytes: &'a [u8],
    /// overrides of all runs
    pub set: &'a [String],
    pub axes: &'a [SweepAxis],
}

impl Study<'_> {
    /// The runs of the settings, each case once; with the baseline, which the overrides `baseline` make of the case.
    ///
    /// # Errors
    /// [`Error::BadCase`] where the case itself, or its baseline, has errors.
    pub fn points(&self, settings: &[SweepSetting], baseline: &[String]) -> Result<Vec<Point>, Error> {
        let own = self.order(&[]).map_err(|errors| self.bad(errors))?;
        let document: Table = toml::from_str(&own.case.text).unwrap_or_default();
        let mut points: Vec<Point> = Vec::new();
        for setting in settings {
            let mut sets = Vec::new();
            let mut values = Vec::new();
            for (SweepAxis { key, .. }, value) in self.axes.iter().zip(setting) {
                sets.extend(value.as_ref().map(|value| format!("{key}={value}")));
                values.push(value.clone().unwrap_or_else(|| written(&document, key)));
            }
            self.add(&mut points, self.point(values, &sets, Vec::new()));
        }
        let (of_axis, besides): (Vec<String>, Vec<String>) = baseline
            .iter()
            .cloned()
            .partition(|set| self.axes.iter().any(|axis| key(set) == axis.key));
        let mut values = Vec::new();
        for axis in self.axes {
            let given = of_axis.iter().rev().find(|set| key(set) == axis.key);
            values.push(match given.and_then(|set| set.split_once('=')) {
                Some((_, value)) => value.trim().to_owned(),
                None => written(&document, &axis.key),
            });
        }
        let point = self.point(values, baseline, besides);
        if let Err(errors) = &point.order {
            return Err(self.bad(errors.clone()));
        }
        let index = self.add(&mut points, point);
        points[index].is_baseline = true;
        Ok(points)
    }

    fn point(&self, values: Vec<String>, sets: &[String], besides: Vec<String>) -> Point {
        let keys = self.axes.iter().map(|axis| axis.key.clone()).collect();
        Point {
            values,
            besides,
            keys,
            order: self.order(sets),
            is_baseline: false,
        }
    }

    /// The place of a point, which is added unless its case is there.
    fn add(&self, points: &mut Vec<Point>, point: Point) -> usize {
        let same = points.iter().position(|other| match (&other.order, &point.order) {
            (Ok(other), Ok(order)) => {
                bsmpm_scene::differences(&other.case.text, &order.case.text).is_ok_and(|found| found.is_empty())
            }
            _ => false,
        });
        same.unwrap_or_else(|| {
            points.push(point);
            points.len() - 1
        })
    }

    fn order(&self, sets: &[String]) -> Result<RunOrder, Vec<String>> {
        RunOrder::read(self.path, self.bytes, [self.set, sets].concat(), sets.len())
    }

    fn bad(&self, errors: Vec<String>) -> Error {
        Error::BadCase {
            path: self.path.to_owned(),
            errors,
        }
    }
}

impl Point {
    /// The settings in a few words.
    pub fn name(&self) -> String {
        let of_axes = self.keys.iter().zip(&self.values).map(|(key, value)| {
            let value = value.trim_matches('"');
            format!("{} {value}", short(key, &self.keys))
        });
        of_axes
            .chain(self.besides.iter().cloned())
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// m  the size of its cells.
    pub fn cell(&self) -> Option<f64> {
        self.order.as_ref().ok().map(RunOrder::cell)
    }

    /// By which runs are called finer: smaller cells, then a higher order, more points, more steps, tighter tolerances.
    pub fn fineness(&self) -> [f64; 6] {
        let Ok(order) = &self.order else {
            return [f64::NEG_INFINITY; 6];
        };
        let case = &order.case;
        [
            -order.cell(),
            case.grid.order as f64,
            case.points() as f64,
            bsmpm_scene::model::nominal_steps(case) as f64,
            -case.solver.tolerance,
            -case.solver.force_tolerance,
        ]
    }

    /// Whether another run differs in the size of the cells at most.
    pub fn differs_in_cells_only(&self, other: &Self) -> bool {
        let [Ok(one), Ok(other)] = [&self.order, &other.order] else {
            return false;
        };
        bsmpm_scene::differences(&one.case.text, &other.case.text)
            .is_ok_and(|found| found.iter().all(|difference| difference.key == "grid.cell"))
    }
}

/// The key of an override.
fn key(set: &str) -> &str {
    set.split_once('=').map_or(set, |(key, _)| key).trim()
}

/// The last part of a key that distinguishes it from the others.
pub(super) fn short<'a>(key: &'a str, keys: &[String]) -> &'a str {
    let last = key.rsplit('.').next().unwrap_or(key);
    let others = keys
        .iter()
        .filter(|other| *other != key && other.rsplit('.').next() == Some(last));
    if others.count() == 0 { last } else { key }
}

/// The value of a key as a case has it; `default` where it does not say.
fn written(document: &Table, key: &str) -> String {
    match inner(document, key) {
        Some(value) => value.to_string().trim_matches('"').to_owned(),
        None => "default".to_owned(),
    }
}

/// The value of a key in a document, if it has one.
fn inner<'a>(document: &'a Table, key: &str) -> Option<&'a Value> {
    let mut parts = key.split('.').map(str::trim);
    let mut value = document.get(parts.next()?)?;
    for part in parts {
        value = match value {
            Value::Table(table) if part == "*" => table.values().next()?,
            Value::Table(table) => table.get(part)?,
            Value::Array(list) if part == "*" => list.first()?,
            Value::Array(list) => list.get(part.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(value)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::axes::settings;
    use super::*;

    pub(in super::super) const COLUMN: &str = include_str!("../../../../cases/short/column_collapse.toml");

    /// The runs of an exemplary sweep.
    pub(in super::super) fn points(vary: &[&str], one_at_a_time: bool, baseline: &[&str]) -> Result<Vec<Point>, Error> {
        let axes: Vec<SweepAxis> = vary.iter().map(|text| SweepAxis::parse(text).unwrap()).collect();
        let baseline: Vec<String> = baseline.iter().map(|&set| set.to_owned()).collect();
        let study = Study {
            path: Path::new("case.toml"),
            bytes: COLUMN.as_bytes(),
            set: &[],
            axes: &axes,
        };
        study.points(&settings(&axes, one_at_a_time).unwrap(), &baseline)
    }

    #[test]
    fn the_baseline_is_one_of_the_runs_or_one_more() {
        let names = |points: &[Point]| points.iter().map(Point::name).collect::<Vec<_>>();
        let there = points(&["grid.cell=20 mm,0.01,5 mm", "body.*.points_per_cell=2,3"], false, &[]).unwrap();
        assert_eq!(
            (there.len(), there.iter().position(|point| point.is_baseline)),
            (6, Some(2))
        );
        assert_eq!(there[2].name(), "cell 0.01, points_per_cell 2");
        // 0.55 m is no whole number of cells of 20 mm before a wall.
        assert!(there[0].order.is_err() && there[2].order.is_ok());
        let besides = points(&["grid.cell=5 mm"], false, &[]).unwrap();
        assert_eq!(names(&besides), ["cell 5 mm", "cell 10 mm"]);
        let other = points(&["grid.cell=5 mm"], false, &["grid.cell=5 mm", "grid.degree=cubic"]).unwrap();
        assert_eq!(names(&other), ["cell 5 mm", "cell 5 mm, grid.degree=cubic"]);
        assert!(points(&["grid.cell=5 mm"], false, &["grid.cell=20 mm"]).is_err());
    }

    #[test]
    fn the_case_s_own_values_are_reported_and_are_one_run() {
        let points = points(&["grid.cell=10 mm,5 mm", "solver.tolerance=1e-8,1e-6"], true, &[]).unwrap();
        let names: Vec<String> = points.iter().map(Point::name).collect();
        assert_eq!(
            names,
            [
                "cell 10 mm, tolerance default",
                "cell 5 mm, tolerance default",
                "cell 10 mm, tolerance 1e-6"
            ]
        );
    }

    #[test]
    fn smaller_cells_are_finer_than_more_points() {
        let points = points(&["grid.cell=10 mm,5 mm", "body.0.points_per_cell=2,4"], false, &[]).unwrap();
        let finest = points
            .iter()
            .max_by(|a, b| a.fineness().partial_cmp(&b.fineness()).unwrap())
            .unwrap();
        assert_eq!(finest.name(), "cell 5 mm, points_per_cell 4");
        assert!(points[0].differs_in_cells_only(&points[2]) && !points[0].differs_in_cells_only(&points[3]));
    }

    #[test]
    fn steps_that_grow_less_are_finer() {
        let case = include_str!("../../../../cases/validation/mandel.toml");
        let axes = [SweepAxis::parse("analysis.growth=1.2,1.02,1.1").unwrap()];
        let study = Study {
            path: Path::new("case.toml"),
            bytes: case.as_bytes(),
            set: &[],
            axes: &axes,
        };
        let points = study.points(&settings(&axes, false).unwrap(), &[]).unwrap();
        let finest = points
            .iter()
            .max_by(|a, b| a.fineness().partial_cmp(&b.fineness()).unwrap())
            .unwrap();
        assert!(finest.name().ends_with("1.02"), "{}", finest.name());
    }
}
