//! Reports the grid convergence of each quantity.

use bsmpm_io::table::Columns;
use serde::Serialize;

use super::grids::Grids;
use super::{TimeStep, VerifyArguments};
use crate::Error;
use crate::grid_convergence::{ConvergenceType, Index};
use crate::launch::{Outcome, RunCost};
use crate::record::short;
use crate::report::{Quoted, ReportTable, or_dash, some, word};
use crate::sweep::QuantityPart;

/// Orders below it converge too slowly for the next term of the series to be small.
const SLOWEST: f64 = 0.5;
/// How near to one the ratio of the indices must be.
const NEAR: f64 = 0.1;

/// A quantity at a time.
#[derive(Clone, Debug, Serialize)]
pub(super) struct VerifyRow {
    pub quantity: String,
    pub unit: String,
    /// s or pseudo-time; none for the end
    pub time: Option<f64>,
    /// On the finest grid first.
    pub values: [f64; 3],
    #[serde(flatten)]
    pub index: Index,
    /// What the figures are worth.
    pub verdict: String,
}

/// All of it.
#[derive(Debug, Serialize)]
pub(super) struct VerifyReport {
    pub case: String,
    pub title: String,
    /// m  the finest first
    pub cells: [f64; 3],
    pub points_per_cell: Vec<usize>,
    pub time_step: &'static str,
    /// s or pseudo-time, of each grid
    pub steps: [f64; 3],
    pub rows: Vec<VerifyRow>,
    pub costs: Vec<RunCost>,
    pub directories: Vec<String>,
}

impl VerifyReport {
    /// # Errors
    /// [`Error::Usage`] for a time that a run has no row about, or for a case that records nothing.
    pub fn of(arguments: &VerifyArguments, grids: &Grids, outcomes: &[Outcome]) -> Result<Self, Error> {
        let histories: Vec<&Columns> = outcomes.iter().filter_map(|outcome| outcome.history.as_ref()).collect();
        let [fine, middle, coarse] = histories[..] else {
            let reason =
                "E0863: the case records nothing that could be compared between grids. Add a [[history]].".to_owned();
            return Err(Error::Usage { reason });
        };
        let mut rows = Vec::new();
        for time in arguments.at.iter().copied().map(Some).chain([None]) {
            for heading in fine
                .headings
                .iter()
                .filter(|heading| !["step", "time"].contains(&&*heading.name))
            {
                let part = QuantityPart {
                    column: heading.name.clone(),
                    at: time,
                };
                let mut values = [0.0; 3];
                for (value, history) in values.iter_mut().zip([fine, middle, coarse]) {
                    *value = part.value(history).map_err(|reason| Error::Usage { reason })?;
                }
                let index = Index::of(grids.sizes, values);
                let verdict = verdict(&index, grids.own.grid.order);
                rows.push(VerifyRow {
                    quantity: heading.name.clone(),
                    unit: heading.unit.clone(),
                    time,
                    values,
                    index,
                    verdict,
                });
            }
        }
        let directories = outcomes.iter().filter_map(|outcome| outcome.directory.as_ref());
        Ok(Self {
            case: arguments.case.display().to_string(),
            title: grids.own.title.clone(),
            cells: grids.sizes,
            points_per_cell: grids.own.bodies.iter().map(|body| body.points_per_cell).collect(),
            time_step: if arguments.time_step == TimeStep::Kept {
                "kept"
            } else {
                "refined"
            },
            steps: [0, 1, 2].map(|index| grids.orders[index].case.analysis.dt),
            rows,
            costs: outcomes.iter().map(|outcome| outcome.cost).collect(),
            directories: directories.map(|directory| directory.display().to_string()).collect(),
        })
    }

    /// For the screen.
    pub fn text(&self) -> String {
        let [h1, h2, h3] = self.cells.map(short);
        let digits = |value: Option<f64>, digits: usize| or_dash(value.map(|value| format!("{value:.digits$}")));
        let mut table = ReportTable::of(&self.rows);
        table
            .column("quantity", |row| &row.quantity)
            .right("time", VerifyRow::time)
            .right("coarse", |row| short(row.values[2]))
            .right("middle", |row| short(row.values[1]))
            .right("fine", |row| short(row.values[0]))
            .right("order", |row| digits(row.index.order, 2))
            .right("extrapolated", |row| or_dash(row.index.extrapolated.map(short)))
            .right("GCI %", |row| digits(row.index.fine.map(|band| 100.0 * band), 3))
            .right("GCI ratio", |row| digits(row.index.ratio, 3))
            .column("verdict", |row| &row.verdict);
        let cpu: f64 = self.costs.iter().map(|cost| cost.cpu_seconds).sum();
        let steps = self.steps.map(short).map(|step| step.to_string()).join(", ");
        let why = match self.time_step {
            "kept" => "the step's error is the same in all and in none of the figures",
            _ => "orders are those of the grid's and the step's error together",
        };
        format!(
            "{}\ncells of {h3}, {h2} and {h1} m, points per cell kept; steps {} ({steps}, the finest grid first): {why}\n\n\
             {}\nGCI: 1.25 |change| / |value| / (r^order - 1), the band about the value on the fine grid.\n{cpu:.1} CPU s\n",
            self.title,
            self.time_step,
            table.text("")
        )
    }

    /// A row a quantity and time.
    pub fn csv(&self) -> String {
        let mut table = ReportTable::of(&self.rows);
        table
            .column("quantity", |row| &row.quantity)
            .column("unit", |row| &row.unit)
            .column("time", VerifyRow::time);
        for (heading, cell) in ["h_fine", "h_middle", "h_coarse"].into_iter().zip(self.cells) {
            table.column(heading, |_| cell);
        }
        for (index, heading) in ["fine", "middle", "coarse"].into_iter().enumerate() {
            table.column(heading, |row| row.values[index]);
        }
        table
            .column("course", |row| word(row.index.course))
            .column("order", |row| some(row.index.order))
            .column("extrapolated", |row| some(row.index.extrapolated))
            .column("gci_fine", |row| some(row.index.fine))
            .column("gci_coarse", |row| some(row.index.coarse))
            .column("gci_ratio", |row| some(row.index.ratio))
            .column("verdict", |row| &row.verdict)
            .csv(Quoted::Needed)
    }
}

impl VerifyRow {
    fn time(&self) -> String {
        self.time.map_or_else(|| "end".to_owned(), |time| time.to_string())
    }
}

/// What the figures are worth, for splines of a degree: the highest order of any quantity is twice that of the space.
fn verdict(index: &Index, degree: usize) -> String {
    let highest = 2.0 * (degree + 1) as f64;
    let off = index.ratio.is_some_and(|ratio| (ratio - 1.0).abs() > NEAR);
    match (index.course, index.order) {
        (ConvergenceType::Unchanged, _) => "does not depend on the grid".to_owned(),
        (ConvergenceType::Diverging, _) => "DIVERGES: differences grow on finer grids, so there is no band".to_owned(),
        (ConvergenceType::OscillatoryDiverging, _) => "OSCILLATES AND DIVERGES: no band".to_owned(),
        (ConvergenceType::Oscillatory, _) => {
            "oscillates: the band is a guess, and there is no extrapolated value".to_owned()
        }
        (ConvergenceType::Monotone, Some(order)) if order < SLOWEST => {
            format!("not asymptotic: order {order:.2} is below {SLOWEST}; the extrapolated value may be far off")
        }
        (ConvergenceType::Monotone, Some(order)) if order > highest => {
            format!(
                "not asymptotic: order {order:.2} is above any that the method has ({highest}); the band is too narrow"
            )
        }
        (ConvergenceType::Monotone, Some(_)) if off => {
            "not asymptotic: the bands of both pairs of grids do not agree (GCI ratio)".to_owned()
        }
        (ConvergenceType::Monotone, Some(_)) => "converges".to_owned(),
        (ConvergenceType::Monotone, None) => "no order: the differences are too irregular for a band".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_course_has_its_words() {
        let h = [1.0, 2.0, 4.0];
        for (values, words) in [
            ([1.01, 1.02, 1.04], "converges"),
            ([1.0, 1.0, 1.0], "does not depend"),
            ([1.0, 1.1, 1.15], "DIVERGES"),
            ([1.0, 1.1, 1.05], "OSCILLATES AND"),
            ([1.0, 1.1, 0.9], "oscillates"),
            ([1.1, 1.2, 1.31], "below 0.5"),
            ([1.0, 1.0001, 1.1], "above any"),
            ([1.0, 2.0, 6.0], "GCI ratio"),
        ] {
            let verdict = verdict(&Index::of(h, values), 2);
            assert!(verdict.contains(words), "{values:?}: {verdict}");
        }
    }
}
