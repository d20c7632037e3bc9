//! Writes error and cost of each setting of a sweep as text, CSV and JSON.

use bsmpm_scene::History;
use serde::Serialize;

use super::front::{CostError, cheapest, front};
use super::quantity::SweepQuantity;
use super::reference::{FoundReference, ReferenceValues};
use super::study::Point;
use crate::launch::{Outcome, RunCost, RunState};
use crate::report::{Quoted, ReportTable, mebibytes, some, word};

/// A run with what it is worth.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SweepRow {
    /// The settings in words.
    pub name: String,
    /// Those of the axes.
    pub settings: Vec<String>,
    /// Overrides of the case.
    pub set: Vec<String>,
    pub state: RunState,
    pub code: Option<u8>,
    pub reason: String,
    /// For each quantity its parts.
    pub values: Vec<Option<Vec<f64>>>,
    /// For each quantity, relative.
    pub errors: Vec<Option<f64>>,
    /// For each quantity.
    pub on_front: Vec<bool>,
    pub is_baseline: bool,
    pub is_reference: bool,
    pub kept: bool,
    #[serde(flatten)]
    pub cost: RunCost,
    pub directory: Option<String>,
}

/// The cheapest run that is good enough.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Cheapest {
    /// The quantity; none for all of them together.
    pub quantity: Option<String>,
    pub run: Option<usize>,
    /// Its cost over that of the baseline.
    pub ratio: Option<f64>,
}

/// All of it.
#[derive(Debug, Serialize)]
pub(super) struct SweepReport {
    pub case: String,
    pub title: String,
    pub command: Vec<String>,
    pub axes: Vec<String>,
    pub quantities: Vec<String>,
    pub reference: FoundReference,
    /// The error that is good enough.
    pub within: f64,
    pub runs: Vec<SweepRow>,
    /// By quantity, and where there are several at last by all.
    pub cheapest: Vec<Cheapest>,
    #[serde(skip)]
    pub heads: Vec<String>,
    /// The quantities in words.
    #[serde(skip)]
    pub subjects: Vec<String>,
}

/// What a report is made of.
pub(super) struct ReportParts<'a> {
    pub case: String,
    pub title: String,
    pub command: &'a [String],
    pub axes: Vec<String>,
    pub quantities: &'a [SweepQuantity],
    pub histories: &'a [History],
    pub points: &'a [Point],
    pub outcomes: &'a [Outcome],
    pub within: f64,
}

impl SweepReport {
    pub fn of(parts: ReportParts, values: &[Option<ReferenceValues>], reference: FoundReference) -> Self {
        let ReportParts {
            quantities,
            points,
            outcomes,
            within,
            ..
        } = parts;
        let mut runs: Vec<SweepRow> = Vec::new();
        for (index, point) in points.iter().enumerate() {
            let row = row(point, &outcomes[index], values[index].as_ref(), quantities, &reference);
            runs.push(SweepRow {
                is_reference: reference.run == Some(index),
                ..row
            });
        }
        let mut best = Vec::new();
        for (index, quantity) in quantities.iter().enumerate() {
            let places: Vec<_> = runs.iter().map(|row| row.place(&[index])).collect();
            // That the reference has no error says nothing of what it is worth.
            let others: Vec<_> = places
                .iter()
                .zip(&runs)
                .map(|(place, row)| place.filter(|_| !row.is_reference))
                .collect();
            front(&others)
                .into_iter()
                .zip(&mut runs)
                .for_each(|(is_best, row)| row.on_front.push(is_best));
            best.push((Some(quantity.name.clone()), cheapest(&places, within)));
        }
        if quantities.len() > 1 {
            let all: Vec<usize> = (0..quantities.len()).collect();
            let places: Vec<_> = runs.iter().map(|row| row.place(&all)).collect();
            best.push((None, cheapest(&places, within)));
        }
        let baseline = runs.iter().find(|row| row.is_baseline && row.state == RunState::Done);
        let baseline = baseline.map(|row| row.cost.cpu_seconds).filter(|cost| *cost > 0.0);
        let cheapest = best.into_iter().map(|(quantity, run)| Cheapest {
            quantity,
            run,
            ratio: run.and_then(|run| Some(runs[run].cost.cpu_seconds / baseline?)),
        });
        let cheapest = cheapest.collect();
        Self {
            case: parts.case,
            title: parts.title,
            command: parts.command.to_vec(),
            heads: parts
                .axes
                .iter()
                .map(|key| super::study::short(key, &parts.axes).to_owned())
                .collect(),
            axes: parts.axes,
            quantities: quantities.iter().map(|quantity| quantity.name.clone()).collect(),
            subjects: quantities
                .iter()
                .map(|quantity| quantity.subject(parts.histories))
                .collect(),
            reference,
            within,
            runs,
            cheapest,
        }
    }

    /// The run that is the cheapest by all quantities.
    pub fn best(&self) -> Option<&SweepRow> {
        self.cheapest
            .last()
            .and_then(|cheapest| cheapest.run)
            .map(|run| &self.runs[run])
    }

    /// Whether any run has come to its end.
    pub fn has_result(&self) -> bool {
        self.runs.iter().any(|row| row.state == RunState::Done)
    }

    /// For the screen.
    pub fn text(&self) -> String {
        let mut text = format!("{}\nreference: {}\n", self.title, self.reference.what);
        self.reference
            .notes
            .iter()
            .for_each(|note| text += &format!("  {note}\n"));
        text += &format!("\n{}\n", self.table());
        for Cheapest { quantity, run, ratio } in &self.cheapest {
            let percent = 100.0 * self.within;
            let of = quantity
                .as_deref()
                .map_or("all quantities".to_owned(), |name| format!("the {name}"));
            text += &match run.map(|run| &self.runs[run]) {
                None => format!("no setting is within {percent} % of {of}\n"),
                Some(row) => {
                    let ratio = ratio.map_or_else(String::new, |ratio| format!(", {ratio:.3} of the baseline's"));
                    let only = if row.is_reference {
                        " (the reference itself)"
                    } else {
                        ""
                    };
                    let cost = row.cost.cpu_seconds;
                    format!(
                        "cheapest within {percent} % of {of}: {}{only}; {cost:.2} CPU s{ratio}\n",
                        row.name
                    )
                }
            };
        }
        let cpu: f64 = self.runs.iter().map(|row| row.cost.cpu_seconds).sum();
        let kept = self.runs.iter().filter(|row| row.kept).count();
        text + &format!(
            "{} runs, {kept} of them kept from before, {cpu:.1} CPU s\n",
            self.runs.len()
        )
    }

    fn table(&self) -> String {
        self.columns().text("") + "*: on the front of cost and error, to which no other run is cheaper and better\n"
    }

    /// The table for a page.
    pub fn markdown(&self) -> String {
        self.columns().markdown()
    }

    /// The table for a reader.
    fn columns(&self) -> ReportTable<'_, SweepRow> {
        let mut table = ReportTable::of(&self.runs);
        for (axis, head) in self.heads.iter().enumerate() {
            table.column(head, |row| &row.settings[axis]);
        }
        for (index, name) in self.quantities.iter().enumerate() {
            table
                .right(name, |row| {
                    let values = row.values[index].iter().flatten();
                    values.map(|v| format!("{v:.5}")).collect::<Vec<_>>().join(" ")
                })
                .right("error", |row| {
                    let mark = if row.on_front[index] { " *" } else { "" };
                    some(row.errors[index].map(|error| format!("{:.3} %{mark}", 100.0 * error)))
                });
        }
        table
            .right("CPU s", |row| format!("{:.2}", row.cost.cpu_seconds))
            .right("s", |row| format!("{:.2}", row.cost.wall_seconds))
            // That of a search of a factor is not known.
            .right("MiB", |row| {
                let memory = Some(row.cost.peak_memory).filter(|memory| *memory > 0);
                some(memory.map(|memory| format!("{:.0}", mebibytes(memory))))
            })
            .right("iterations", |row| row.cost.iterations)
            .column("state", SweepRow::remark);
        table
    }

    /// A row a run.
    pub fn csv(&self) -> String {
        let mut table = ReportTable::of(&self.runs);
        for (axis, key) in self.axes.iter().enumerate() {
            table.column(key, |row| &row.settings[axis]);
        }
        table
            .column("state", |row| word(row.state))
            .column("code", |row| some(row.code));
        for (index, quantity) in self.quantities.iter().enumerate() {
            let parts = self.reference_parts(index);
            for part in 0..parts {
                let heading = if parts > 1 {
                    format!("{quantity} [{part}]")
                } else {
                    quantity.clone()
                };
                table.column(heading, |row| {
                    some(row.values[index].as_ref().and_then(|values| values.get(part)))
                });
            }
            table
                .column(format!("error {quantity}"), |row| some(row.errors[index]))
                .column(format!("on_front {quantity}"), |row| row.on_front[index]);
        }
        table
            .column("cpu_seconds", |row| row.cost.cpu_seconds)
            .column("wall_seconds", |row| row.cost.wall_seconds)
            .column("peak_memory_bytes", |row| row.cost.peak_memory)
            .column("steps", |row| row.cost.steps)
            .column("iterations", |row| row.cost.iterations)
            .column("cuts", |row| row.cost.cuts)
            .column("baseline", |row| row.is_baseline)
            .column("reference", |row| row.is_reference)
            .column("directory", |row| some(row.directory.as_ref()))
            .column("reason", |row| &row.reason)
            .csv(Quoted::Needed)
    }

    /// The number of parts of a quantity.
    fn reference_parts(&self, quantity: usize) -> usize {
        self.quantities[quantity].split(',').count()
    }
}

impl SweepRow {
    /// Cost and the largest error of some quantities; none without them.
    pub fn place(&self, quantities: &[usize]) -> Option<CostError> {
        let errors: Option<Vec<f64>> = quantities.iter().map(|&index| self.errors[index]).collect();
        Some(CostError {
            cost: self.cost.cpu_seconds,
            error: errors?.into_iter().fold(0.0, f64::max),
        })
    }

    fn remark(&self) -> String {
        let code = self
            .code
            .filter(|_| self.state != RunState::Done)
            .map_or_else(String::new, |code| format!(" ({code})"));
        let marks = [
            (self.is_baseline, "baseline"),
            (self.is_reference, "reference"),
            (self.kept, "kept"),
        ];
        let marks = marks
            .iter()
            .filter(|(is, _)| *is)
            .map(|(_, mark)| format!(", {mark}"))
            .collect::<String>();
        let reason = if self.reason.is_empty() {
            String::new()
        } else {
            format!(": {}", self.reason)
        };
        format!("{}{code}{marks}{reason}", word(self.state))
    }
}

fn row(
    point: &Point,
    outcome: &Outcome,
    values: Option<&ReferenceValues>,
    quantities: &[SweepQuantity],
    found: &FoundReference,
) -> SweepRow {
    let none = vec![None; quantities.len()];
    let values = values.unwrap_or(&none).clone();
    let errors = quantities.iter().zip(values.iter().zip(&found.values));
    let errors = errors.map(|(quantity, (values, reference))| quantity.error(values.as_ref()?, reference.as_ref()?));
    SweepRow {
        name: point.name(),
        settings: point.values.clone(),
        set: point
            .order
            .as_ref()
            .map_or_else(|_| Vec::new(), |order| order.set.clone()),
        state: outcome.state,
        code: outcome.code,
        reason: outcome.reason.lines().next().unwrap_or_default().to_owned(),
        errors: errors.collect(),
        values,
        on_front: Vec::new(),
        is_baseline: point.is_baseline,
        is_reference: false,
        kept: outcome.kept,
        cost: outcome.cost,
        directory: outcome
            .directory
            .as_ref()
            .map(|directory| directory.display().to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::reference::Reference;
    use super::super::study::tests::points;
    use super::*;

    /// A sweep over two sizes of cells and two numbers of points, of which one run failed.
    fn report(within: f64) -> SweepReport {
        let points = points(&["grid.cell=10 mm,5 mm", "body.*.points_per_cell=2,3"], false, &[]).unwrap();
        let quantities = ["a", "b,c@0.5"].map(|text| SweepQuantity::parse(text).unwrap());
        let value = |a: f64| Some(vec![Some(vec![a]), Some(vec![2.0 * a, 3.0])]);
        let values = [value(1.1), None, value(1.03), value(1.0)];
        let outcome = |(cpu_seconds, value): (f64, &Option<ReferenceValues>)| {
            let state = if value.is_some() {
                RunState::Done
            } else {
                RunState::NoConvergence
            };
            let reason = if value.is_some() {
                String::new()
            } else {
                "no, it said".to_owned()
            };
            Outcome {
                cost: RunCost {
                    cpu_seconds,
                    ..RunCost::default()
                },
                ..Outcome::never(state, reason)
            }
        };
        let outcomes: Vec<Outcome> = [4.0, 5.0, 16.0, 32.0].into_iter().zip(&values).map(outcome).collect();
        let found = Reference::Finest.find(&quantities, &points, &values).unwrap();
        let parts = ReportParts {
            case: "case.toml".into(),
            title: "A case".into(),
            command: &[],
            axes: vec!["grid.cell".into(), "body.*.points_per_cell".into()],
            quantities: &quantities,
            histories: &[],
            points: &points,
            outcomes: &outcomes,
            within,
        };
        SweepReport::of(parts, &values, found)
    }

    #[test]
    fn the_cheapest_good_run_is_reported_with_its_cost() {
        let report = report(0.05);
        assert!(report.runs[3].is_reference && report.runs[0].is_baseline);
        let on_front: Vec<bool> = report.runs.iter().map(|row| row.on_front[0]).collect();
        assert_eq!(on_front, [true, false, true, false]);
        assert_eq!(
            report.cheapest.iter().map(|best| best.run).collect::<Vec<_>>(),
            [Some(2); 3]
        );
        assert_eq!(report.cheapest[2].ratio, Some(4.0));
        let text = report.text();
        assert!(
            text.contains("within 5 % of all quantities: cell 5 mm, points_per_cell 2; 16.00 CPU s, 4.000 of"),
            "{text}"
        );
        assert!(text.contains("no-convergence: no, it said"), "{text}");
        assert!(self::report(0.001).text().contains("(the reference itself)"));
    }

    #[test]
    fn the_table_for_a_page_marks_the_front_and_the_reference() {
        let page = report(0.05).markdown();
        let lines: Vec<&str> = page.lines().collect();
        assert!(
            lines[0].starts_with("| cell | points_per_cell | a | error | b,c@0.5 | error | CPU s |"),
            "{page}"
        );
        assert!(
            lines[2].contains("| 10.000 % * |") && lines[5].contains("reference"),
            "{page}"
        );
        assert_eq!(lines.len(), 6);
    }

    #[test]
    fn a_row_of_the_table_for_programs_is_a_run() {
        let csv = report(0.05).csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert!(
            lines[0].starts_with("grid.cell,body.*.points_per_cell,state,code,a,error a,on_front a,\"b,c@0.5 [0]\"")
        );
        assert!(lines[3].starts_with("5 mm,2,done,,1.03,0.03"), "{csv}");
        assert!(
            lines[2].ends_with(",false,false,,\"no, it said\"")
                && lines[2].contains("no-convergence,,,,false,,,,false")
        );
        assert_eq!(lines.len(), 5);
    }
}
