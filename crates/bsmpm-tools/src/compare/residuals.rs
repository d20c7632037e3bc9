//! Draws how one step converges in several runs (as figure 4 of Xie et al., 2023).

use std::fmt::Write;
use std::path::Path;

use bsmpm_io::residuals::{self, Iterate, RESIDUALS, ResidualMethod};

use super::{CompareArguments, ComparedFiles, runs};
use crate::Error;
use crate::picture::axes::{BELOW, ChartAxes, LEFT, Label, NUMBER, title};
use crate::picture::canvas::{Canvas, TextAlign, width};
use crate::picture::colour::{self, INK};
use crate::picture::legend::{self, LegendEntry, Mark};
use crate::picture::ticks::{Scale, ValueRange, range};
use crate::record::{RunRecord, present};

const SHEET: (f64, f64) = (1600.0, 1250.0);
const ABOVE: f64 = 115.0;
const BETWEEN: f64 = 40.0;
const LINE: f64 = 3.5;
/// What stands right of a tolerance.
const TOLERANCE: &str = "tolerance";
/// How far the axes go beyond the first and last iteration, as a share of their number: a disc's radius and a little
/// more.
const BESIDE: f64 = 0.02;
/// What is left of a force of which an order is reported.
const LEAST: f64 = 0.9;
/// The fewest iterations that are shown.
const FEWEST: f64 = 3.0;

/// A measure of equilibrium: its name and its place in an iteration.
struct Measure {
    name: &'static str,
    of: fn(&Iterate) -> f64,
}

const MEASURES: [Measure; 2] = [
    Measure {
        name: "Energy measure",
        of: |iterate| iterate.energy,
    },
    Measure {
        name: "Force measure",
        of: |iterate| iterate.force,
    },
];

/// The step of one run.
struct ResidualCourse {
    label: String,
    iterates: Vec<Iterate>,
    /// Of both measures, if the case reports them.
    tolerances: Option<[f64; 2]>,
}

/// Draws the picture and sets the table, as far as they are wanted.
pub(super) fn run(arguments: &CompareArguments, step: u64) -> Result<ComparedFiles, Error> {
    let records = runs::records(arguments)?;
    let labels = runs::labels(arguments, &records);
    let mut courses = Vec::new();
    let mut moments = Vec::new();
    for (label, record) in labels.into_iter().zip(&records) {
        let course = ResidualCourse::read(label, record, step)?;
        moments.push(record.moment(course.iterates[0].time));
        courses.push(course);
    }
    let below = if moments.iter().all(|moment| *moment == moments[0]) {
        format!("Step {step}, {}", moments[0])
    } else {
        format!("Step {step}")
    };
    let picture = arguments.picture();
    if let Some(path) = &picture {
        draw(&courses, &runs::title(arguments, &records), &below, path)?;
    }
    Ok(ComparedFiles {
        picture,
        table: arguments.table.then(|| text(&courses, &below)),
        notes: Vec::new(),
    })
}

impl ResidualCourse {
    fn read(label: String, record: &RunRecord, step: u64) -> Result<Self, Error> {
        let directory = record.directory.display();
        let Some(all) = present(residuals::read(&record.directory.join(RESIDUALS)))? else {
            let reason = format!(
                "E0806: {directory} has no residuals.csv. Set `output.residuals = true`, and run the case again."
            );
            return Err(Error::Missing { reason });
        };
        let last = all.last().map_or(0, |iterate| iterate.step);
        let iterates: Vec<Iterate> = all.into_iter().filter(|iterate| iterate.step == step).collect();
        if iterates.is_empty() {
            let reason = format!(
                "E0806: residuals.csv of {directory} has no step {step}; its last step is {last}. Give another step."
            );
            return Err(Error::Missing { reason });
        }
        let case = bsmpm_scene::Case::from_text("case", &record.manifest.case.text, &[]).ok();
        let tolerances = case.map(|case| [case.solver.tolerance, case.solver.force_tolerance]);
        Ok(Self {
            label,
            iterates,
            tolerances,
        })
    }

    /// Places on a logarithmic axis, where what is not positive breaks the line.
    fn places(&self, measure: &Measure) -> Vec<[f64; 2]> {
        let places = self.iterates.iter().map(|iterate| {
            let value = (measure.of)(iterate);
            [iterate.iteration as f64, if value > 0.0 { value } else { f64::NAN }]
        });
        places.collect()
    }
}

/// Different tolerances of a measure, which all runs share as a rule.
fn tolerances(courses: &[ResidualCourse], measure: usize) -> Vec<f64> {
    let mut all: Vec<f64> = courses
        .iter()
        .filter_map(|course| Some(course.tolerances?[measure]))
        .collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

fn draw(courses: &[ResidualCourse], above: &str, below: &str, path: &Path) -> Result<(), Error> {
    let entries = courses.iter().enumerate().map(|(index, course)| LegendEntry {
        name: course.label.clone(),
        colour: colour::line(index, courses.len()),
        mark: Mark::Both,
    });
    let entries: Vec<LegendEntry> = entries.collect();
    let legend: Vec<&LegendEntry> = entries.iter().collect();
    let room = SHEET.0 - 80.0;
    let mut canvas = Canvas::new(SHEET.0, SHEET.1);
    title(&mut canvas, SHEET.0, above, below);
    legend::draw(&mut canvas, &legend, 40.0, ABOVE, room);
    let top = ABOVE + legend::height(&legend, room) + 20.0;
    let bottom = SHEET.1 - BELOW;
    let half = (bottom - top - BETWEEN) / 2.0;
    draw_measure(&mut canvas, courses, &entries, 0, top, top + half);
    draw_measure(&mut canvas, courses, &entries, 1, bottom - half, bottom);
    canvas.save(path)
}

/// The axes of one measure, between two heights of the sheet; the last ones bear the numbers of the iterations.
fn draw_measure(
    canvas: &mut Canvas,
    courses: &[ResidualCourse],
    entries: &[LegendEntry],
    index: usize,
    top: f64,
    bottom: f64,
) {
    let measure = &MEASURES[index];
    let levels = tolerances(courses, index);
    let places: Vec<Vec<[f64; 2]>> = courses.iter().map(|course| course.places(measure)).collect();
    let most = (places.iter().map(Vec::len).max().unwrap_or(0) as f64).max(FEWEST);
    let axes = ChartAxes {
        left: LEFT,
        top,
        right: SHEET.0 - width(TOLERANCE, NUMBER) - 40.0,
        bottom,
        x: ValueRange::of(1.0 - BESIDE * most, most + BESIDE * most),
        y: decades(
            places
                .iter()
                .flatten()
                .map(|place| place[1])
                .chain(levels.iter().copied()),
        ),
        scales: [Scale::Whole, Scale::Logarithmic],
    };
    axes.rules(canvas);
    for level in levels {
        let at = axes.level(canvas, level);
        canvas.text(TOLERANCE, [axes.right + 14.0, at], NUMBER, TextAlign::Left, INK);
    }
    for (places, entry) in places.iter().zip(entries) {
        for run in places.split(|place| place[1].is_nan()) {
            let places: Vec<_> = run.iter().map(|&place| axes.place(place)).collect();
            entry.mark.draw(canvas, &places, LINE, entry.colour);
        }
    }
    let across = (index + 1 == MEASURES.len()).then_some(Label::of("Iteration", "-"));
    axes.draw(canvas, across, Label::of(measure.name, "-"));
}

/// Whole powers of ten about positive numbers, with room for discs at the ends.
fn decades(values: impl IntoIterator<Item = f64>) -> ValueRange {
    let range = range(values).unwrap_or(ValueRange::of(0.1, 1.0));
    let low = range.low.log10().floor();
    let high = range.high.log10().ceil();
    let room = 0.04 * (high - low).max(1.0);
    ValueRange::of(10_f64.powf(low - room), 10_f64.powf(high + room))
}

/// A block of rows for every run: both measures, and the order of convergence.
fn text(courses: &[ResidualCourse], below: &str) -> String {
    let mut text = format!("{below}\n");
    for ResidualCourse { label, iterates, .. } in courses {
        let _ = writeln!(text, "{label}\niteration       method     energy      force  order");
        for (index, iterate) in iterates.iter().enumerate() {
            let Iterate {
                iteration,
                energy,
                force,
                ..
            } = iterate;
            let order = order(&iterates[..=index]).map_or_else(|| "-".to_owned(), |order| format!("{order:.2}"));
            let method = iterate.method.map_or("-", ResidualMethod::word);
            let energy = if energy.is_nan() {
                "-".to_owned()
            } else {
                format!("{energy:.2e}")
            };
            let _ = writeln!(
                text,
                "{iteration:>9}  {method:>11}  {energy:>9}  {force:>9.2e}  {order:>5}"
            );
        }
    }
    text
}

/// The order at which the force measure f fell last: ln(f_k / f_k-1) / ln(f_k-1 / f_k-2), 2 for quadratic convergence.
/// None where it has not fallen by [`LEAST`] twice: what is left then is noise.
fn order(iterates: &[Iterate]) -> Option<f64> {
    let [.., before, last, now] = iterates else { return None };
    let first = (last.force / before.force).ln();
    let second = (now.force / last.force).ln();
    (first.max(second) < LEAST.ln() && second.is_finite()).then_some(second / first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn falling(forces: &[f64]) -> Vec<Iterate> {
        let row = |(&force, iteration)| Iterate {
            step: 1,
            time: 1.0,
            iteration,
            method: Some(ResidualMethod::Newton),
            energy: force * force,
            force,
            water: f64::NAN,
        };
        forces.iter().zip(1..).map(row).collect()
    }

    #[test]
    fn the_order_is_two_where_the_force_falls_with_its_square() {
        let order = |forces: &[f64]| order(&falling(forces));
        assert!((order(&[1e-1, 1e-2, 1e-4]).unwrap() - 2.0).abs() < 1e-12);
        assert!((order(&[7.0, 1e-1, 1e-2, 1e-3]).unwrap() - 1.0).abs() < 1e-12);
        for none in [
            &[1e-1, 1e-2][..],
            &[1e-2, 1e-1, 1e-3],
            &[1e-1, 1e-2, 1e-1],
            &[1e-1, 0.099, 1e-3],
            &[1e-1, 1e-2, 0.0],
        ] {
            assert_eq!(order(none), None, "{none:?}");
        }
    }

    #[test]
    fn axes_hold_whole_decades_and_a_little_more() {
        let ValueRange { low, high } = decades([3e-7, 0.4, f64::NAN]);
        assert!(
            (3e-8..1e-7).contains(&low) && (1.0..3.0).contains(&high),
            "{low} {high}"
        );
        assert!(decades([]).low < decades([]).high);
        assert!(decades([1.0]).low < 1.0);
    }
}
