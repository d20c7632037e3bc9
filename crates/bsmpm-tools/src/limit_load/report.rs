//! Reports limit loads on all grids, and their extrapolation.

use bsmpm_io::manifest::ManifestLimitLoad;
use bsmpm_messages::headed;
use serde::Serialize;

use crate::Error;
use crate::batch::RunOrder;
use crate::launch::{Outcome, RunCost};
use crate::report::{Quoted, ReportTable, number, or_dash};

/// Part of what the finest grid is off within which the extrapolated load lies, for loads that fall as cells shrink: up
/// to 0.26 in verified cases.
const BAND: f64 = 0.5;
/// The same of loads that rise, as that on a smooth wall, whose error is of higher order.
const BAND_FROM_BELOW: f64 = 1.0;

/// A load on a grid.
#[derive(Clone, Debug, Serialize)]
pub(super) struct GridLoad {
    /// What is moved.
    pub name: String,
    /// m  the shortest edge of a cell
    pub cell: f64,
    /// Across the width of what is moved; none where it has none of its own.
    pub cells: Option<f64>,
    pub load: f64,
    pub unit: String,
    /// Column of `history.csv`, if the load is one.
    pub column: Option<String>,
    /// Change over the last quarter of the displacement, over the load.
    pub change: f64,
    pub is_reached: bool,
    /// Which part of the whole a force is of, in words.
    pub part: String,
    #[serde(flatten)]
    pub cost: RunCost,
}

/// A load on an infinitely fine grid.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ExtrapolatedLoad {
    pub name: String,
    /// Column of `history.csv`, if the load is one.
    pub column: Option<String>,
    pub load: f64,
    pub unit: String,
    /// The load lies within so much of the extrapolated one.
    pub band: f64,
    /// Which part of the whole a force is of, in words.
    pub part: String,
    /// That of the finest grid over the extrapolated one, less one; positive: too high.
    pub finest: f64,
    /// Of convergence, from three grids.
    pub order: Option<f64>,
    /// Part of the load on the coarsest grid that small cohesions carry, if there are any.
    pub of_cohesion: Option<f64>,
}

/// All of it.
#[derive(Debug, Serialize)]
pub(super) struct LimitLoadReport {
    pub title: String,
    /// -  by which Young's moduli are multiplied, and prescribed displacements divided, on the coarsest grid
    pub stiffness: f64,
    pub stabilisation: String,
    pub points_per_cell: Vec<usize>,
    pub steps: u64,
    pub loads: Vec<ExtrapolatedLoad>,
    pub grids: Vec<GridLoad>,
    /// What is doubtful about the case, on any of the grids.
    pub warnings: Vec<String>,
}

impl LimitLoadReport {
    /// Of runs from the coarsest grid to the finest, and one without small cohesions on the coarsest.
    ///
    /// # Errors
    /// [`Error::Missing`] for a run whose record has no limit load.
    pub fn of(orders: &[RunOrder], outcomes: &[Outcome], without_cohesion: Option<&Outcome>) -> Result<Self, Error> {
        let mut grids = Vec::new();
        for (order, outcome) in orders.iter().zip(outcomes) {
            let found = loads(outcome);
            if found.is_empty() {
                let reason = format!(
                    "E0855: the saved record of run `{0}` is from an earlier version and lacks the limit load. Delete \
                     the directory `runs/{0}.out`, and repeat this command.",
                    order.name
                );
                return Err(Error::Missing { reason });
            }
            grids.extend(found.iter().map(|load| GridLoad::of(load, order, outcome)));
        }
        let own = &orders[0].case;
        let names = loads(&outcomes[0]).iter().map(|load| &load.name);
        let mut extrapolated = Vec::new();
        for name in names {
            if grids.iter().all(|grid| grid.name != *name || grid.is_reached) {
                let without_cohesion = without_cohesion.and_then(|outcome| value(outcome, name));
                extrapolated.push(ExtrapolatedLoad::of(name, &grids, without_cohesion));
            }
        }
        let mut warnings: Vec<String> = Vec::new();
        for warning in orders.iter().flat_map(|order| &order.case.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        Ok(Self {
            title: if own.title.is_empty() {
                "Limit load".to_owned()
            } else {
                own.title.clone()
            },
            stiffness: own.limit_load.as_ref().map_or(1.0, |sought| sought.stiffness),
            stabilisation: bsmpm_scene::words::Word::word(own.stabilisation).to_owned(),
            points_per_cell: own.bodies.iter().map(|body| body.points_per_cell).collect(),
            steps: (own.analysis.end / own.analysis.dt).round() as u64,
            loads: extrapolated,
            grids,
            warnings,
        })
    }

    /// Whether every load has reached its limit on every grid.
    pub fn is_reached(&self) -> bool {
        self.grids.iter().all(|grid| grid.is_reached)
    }

    /// For the screen.
    pub fn text(&self) -> String {
        let mut table = ReportTable::of(&self.grids);
        table
            .column("load of", |row| &row.name)
            .column("column", |row| or_dash(row.column.as_ref()))
            .right("cell m", |row| number(row.cell))
            .right("cells across", |row| or_dash(row.cells.map(number)))
            .right("load", |row| number(row.load))
            .column("unit", |row| &row.unit)
            .right("change %", |row| format!("{:+.2}", 100.0 * row.change))
            .right("steps", |row| row.cost.steps)
            .right("iterations", |row| row.cost.iterations)
            .right("cuts", |row| row.cost.cuts)
            .right("CPU s", |row| format!("{:.1}", row.cost.cpu_seconds));
        let found: String = self.loads.iter().map(ExtrapolatedLoad::text).collect();
        let unfinished: String = self
            .grids
            .iter()
            .filter(|grid| !grid.is_reached)
            .map(GridLoad::doubt)
            .collect();
        let warnings: String = self
            .warnings
            .iter()
            .map(|warning| headed(warning, "warning") + "\n")
            .collect();
        format!(
            "{warnings}{}\n{} points along each axis of a cell; stabilisation {}; {} steps; Young's moduli x {} on the first grid\n\n\
             {}\n{found}{unfinished}",
            self.title,
            self.points_per_cell[0],
            self.stabilisation,
            self.steps,
            number(self.stiffness),
            table.text("")
        )
    }

    /// A row for every load on every grid.
    pub fn csv(&self) -> String {
        let mut table = ReportTable::of(&self.grids);
        table
            .column("name", |row| &row.name)
            .column("cell", |row| row.cell)
            .column("cells", |row| crate::report::some(row.cells))
            .column("load", |row| row.load)
            .column("unit", |row| &row.unit)
            .column("change", |row| row.change)
            .column("steps", |row| row.cost.steps)
            .column("iterations", |row| row.cost.iterations)
            .column("cuts", |row| row.cost.cuts)
            .column("cpu_seconds", |row| row.cost.cpu_seconds)
            .csv(Quoted::Needed)
    }
}

/// The limit loads of a run.
fn loads(outcome: &Outcome) -> &[ManifestLimitLoad] {
    outcome.manifest.as_ref().map_or(&[], |manifest| &manifest.limit_loads)
}

/// The load of a name.
fn value(outcome: &Outcome, name: &str) -> Option<f64> {
    loads(outcome)
        .iter()
        .find(|load| load.name == *name)
        .map(|load| load.value)
}

impl GridLoad {
    fn of(load: &ManifestLimitLoad, order: &RunOrder, outcome: &Outcome) -> Self {
        Self {
            name: load.name.clone(),
            cell: order.case.grid.shortest(),
            cells: load.cells,
            load: load.value,
            unit: load.unit.clone(),
            column: load
                .columns
                .first()
                .filter(|_| load.columns.len() == 1)
                .map(|(name, _)| name.clone()),
            change: load.change,
            is_reached: load.is_reached,
            part: load.part(),
            cost: outcome.cost,
        }
    }

    /// A line where the limit was not reached.
    fn doubt(&self) -> String {
        let Self { name, load, change, .. } = self;
        let cell = number(self.cell);
        let changed = 100.0 * change;
        let warning = match (*load <= 0.0, *change > 0.0) {
            (true, _) => format!(
                "W0726: on cells of {cell} m the soil does not resist `{name}`, so there is no limit load. Check that \
                 `{name}` touches the soil and moves towards it."
            ),
            (_, true) => format!(
                "W0851: on cells of {cell} m the load on `{name}` still rises by {changed:.1} % over the last quarter \
                 of the displacement (limit: 1 %). Increase the prescribed displacement."
            ),
            _ => format!(
                "W0852: on cells of {cell} m the load on `{name}` falls by {:.1} % over the last quarter of the \
                 displacement (limit: 1 %), because the steps are too large. Increase `analysis.steps`.",
                -changed
            ),
        };
        headed(&warning, "warning") + "\n"
    }
}

impl ExtrapolatedLoad {
    /// From the loads of a name on grids from the coarsest to the finest, each with cells half as large as the one
    /// before; `without_cohesion` is that on the coarsest without small cohesions.
    fn of(name: &str, grids: &[GridLoad], without_cohesion: Option<f64>) -> Self {
        let own: Vec<&GridLoad> = grids.iter().filter(|grid| grid.name == *name).collect();
        let loads: Vec<f64> = own.iter().map(|grid| grid.load).collect();
        let extrapolation = Extrapolation::of(&loads);
        Self {
            name: name.to_owned(),
            column: own[0].column.clone(),
            load: extrapolation.load,
            unit: own[0].unit.clone(),
            band: extrapolation.band,
            part: own[0].part.clone(),
            finest: loads[loads.len() - 1] / extrapolation.load - 1.0,
            order: extrapolation.order,
            of_cohesion: without_cohesion.map(|without| 1.0 - without / loads[0]),
        }
    }

    fn text(&self) -> String {
        let Self {
            name,
            load,
            unit,
            band,
            part,
            ..
        } = self;
        let column = self
            .column
            .as_ref()
            .map_or_else(String::new, |column| format!(", {column}"));
        let side = if self.finest > 0.0 {
            "too high (the unsafe side)"
        } else {
            "too low"
        };
        let off = 100.0 * self.finest.abs();
        let order = self
            .order
            .map_or_else(String::new, |order| format!("; observed order {order:.2}"));
        let of_cohesion = self.of_cohesion.map_or_else(String::new, |part| {
            format!(
                "The small cohesion carries at least {:.1} % of the load (measured on the coarsest grid). Use cohesion = 0 if it was \
                 given for stability only.\n",
                100.0 * part
            )
        });
        format!(
            "Limit load of {name}{column}{part}: {} +- {} {unit}, extrapolated from the two finest grids{order}.\nOn the finest grid it is \
             estimated to be {off:.1} % {side}.\n{of_cohesion}",
            rounded(*load, 4),
            rounded(*band, 2)
        )
    }
}

/// A value with so many significant digits.
fn rounded(value: f64, digits: usize) -> String {
    let decimals = digits - 1;
    number(format!("{value:.decimals$e}").parse().unwrap_or(value))
}

/// What loads on grids say of an infinitely fine one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extrapolation {
    load: f64,
    band: f64,
    order: Option<f64>,
}

impl Extrapolation {
    /// Of two or more loads, whose error is in proportion to the size of the cells, halved from each to the next.
    fn of(loads: &[f64]) -> Self {
        let richardson: Vec<f64> = loads.windows(2).map(|pair| 2.0 * pair[1] - pair[0]).collect();
        let last = richardson.len() - 1;
        let load = richardson[last];
        let share = if loads[last + 1] < load { BAND_FROM_BELOW } else { BAND };
        let off = share * (loads[last + 1] - load).abs();
        let moved = last
            .checked_sub(1)
            .map_or(0.0, |before| (load - richardson[before]).abs());
        let order = loads.len().checked_sub(3).map(|first| {
            let [coarse, middle, fine] = [loads[first], loads[first + 1], loads[first + 2]];
            ((coarse - middle) / (middle - fine)).log2()
        });
        Self {
            load,
            band: off.max(moved),
            order: order.filter(|order| order.is_finite()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_in_proportion_to_the_cells_are_taken_off() {
        let of = |h: f64| 10.0 + 3.0 * h;
        let found = Extrapolation::of(&[of(1.0), of(0.5), of(0.25)]);
        assert!(
            (found.load - 10.0).abs() < 1e-12 && (found.order.unwrap() - 1.0).abs() < 1e-12,
            "{found:?}"
        );
        assert!(
            (found.band - 0.5 * 0.75).abs() < 1e-12,
            "half of what the finest grid is off: {found:?}"
        );
    }

    /// N_gamma of a rough strip, friction angle 30 degrees: 14.754 (Martin, 2005), with 8, 16 and 32 cells.
    #[test]
    fn the_band_contains_the_exact_bearing_capacity() {
        let two = Extrapolation::of(&[19.609, 17.050]);
        let three = Extrapolation::of(&[19.609, 17.050, 15.926]);
        assert!(
            (two.load - 14.754).abs() < two.band && (three.load - 14.754).abs() < three.band,
            "{two:?} {three:?}"
        );
        assert!(
            two.order.is_none() && (three.order.unwrap() - 1.19).abs() < 0.01,
            "{three:?}"
        );
    }
}
