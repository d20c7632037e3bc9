//! Three grids of one case, each made of the same body.

use bsmpm_scene::{Case, GridAxis};

use super::{TimeStep, VerifyArguments};
use crate::batch::RunOrder;
use crate::sweep::split;
use crate::{Error, case};

/// Ratios below this make differences that drown in everything else (Celik et al. want 1.3).
const LEAST: f64 = 1.1;
/// Larger ones leave the coarsest grid nothing to resolve.
const MOST: f64 = 10.0;

/// The case on each of them, the finest first.
pub(super) struct Grids {
    pub orders: Vec<RunOrder>,
    /// m  the size of the cells: the root of the area of one
    pub sizes: [f64; 3],
    pub own: Case,
}

impl Grids {
    /// # Errors
    /// [`Error::Usage`] for a case without `grid.cell` and for ratios that show nothing; [`Error::BadCase`] for grids
    /// that the case cannot have, with all of their errors.
    pub fn of(arguments: &VerifyArguments, bytes: &[u8]) -> Result<Self, Error> {
        let path = &arguments.case;
        let own = case::parsed(path, bytes, &arguments.options.set)?;
        let cell = cell(&own)?;
        let cells = arguments.cells(cell)?;
        let (mut orders, mut errors) = (Vec::new(), Vec::new());
        for value in &cells {
            let mut set = arguments.options.set.clone();
            set.push(format!("grid.cell={value}"));
            match RunOrder::read(path, bytes, set.clone(), 1) {
                Ok(order) => orders.push(arguments.timed(order, (bytes, set), &own, cell)?),
                Err(found) => errors.extend(found),
            }
        }
        if !errors.is_empty() {
            errors.push(
                "note: a grid of other cells must fill the same box; --refine-only, --ratio or --cells choose others"
                    .into(),
            );
            return Err(Error::BadCase { path: path.clone(), errors });
        }
        orders.sort_by(|a, b| a.cell().total_cmp(&b.cell()));
        let sizes = [orders[0].cell(), orders[1].cell(), orders[2].cell()];
        let ratios = [sizes[1] / sizes[0], sizes[2] / sizes[1]];
        if ratios.iter().any(|ratio| !(LEAST..=MOST).contains(ratio)) {
            let reason = format!("cells of {sizes:?} m: each must be {LEAST} to {MOST} times the next finer one");
            return Err(Error::Usage { reason });
        }
        Ok(Self { orders, sizes, own })
    }
}

impl VerifyArguments {
    /// The value of `grid.cell` on each grid.
    fn cells(&self, cell: [f64; 2]) -> Result<Vec<String>, Error> {
        let usage = |reason: String| Err(Error::Usage { reason });
        if let Some(cells) = &self.cells {
            let cells = split(cells);
            let count = cells.len();
            return if count == 3 { Ok(cells) } else { usage(format!("--cells: three are needed, found {count}")) };
        }
        if !(LEAST..=MOST).contains(&self.ratio) {
            return usage(format!("--ratio {}: allowed is {LEAST} to {MOST}", self.ratio));
        }
        let coarsest = if self.refine_only { 1.0 } else { self.ratio };
        let factors = [coarsest, coarsest / self.ratio, coarsest / self.ratio / self.ratio];
        Ok(factors.map(|factor| format!("[{:?}, {:?}]", factor * cell[0], factor * cell[1])).to_vec())
    }

    /// The order with the step that it gets.
    fn timed(
        &self,
        order: RunOrder,
        (bytes, mut set): (&[u8], Vec<String>),
        own: &Case,
        cell: [f64; 2],
    ) -> Result<RunOrder, Error> {
        let step = match self.time_step {
            // Steps that a preset chooses would follow the cells.
            TimeStep::Kept if order.case.analysis.dt == own.analysis.dt => return Ok(order),
            TimeStep::Kept => own.analysis.dt,
            TimeStep::Refined => own.analysis.dt * order.cell() / (cell[0] * cell[1]).sqrt(),
        };
        set.push(format!("analysis.dt={step:?}"));
        RunOrder::read(&self.case, bytes, set, 2).map_err(|errors| Error::BadCase { path: self.case.clone(), errors })
    }
}

/// m  the edges of the case's cells.
fn cell(case: &Case) -> Result<[f64; 2], Error> {
    let [x, y] = &case.grid.axes;
    if [x, y].iter().any(|axis| matches!(axis, GridAxis::Graded(_))) {
        let reason = "the grid has explicit knots, by hand or by a preset: there is no one size of cells to refine; \
                      give it grid.cell with --set";
        return Err(Error::Usage { reason: reason.to_owned() });
    }
    Ok([x.cell(0), y.cell(0)])
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    const COLUMN: &str = include_str!("../../../../cases/short/column_collapse.toml");
    const PRESET: &str = include_str!("../../../../cases/presets/column_collapse.toml");

    #[test]
    fn the_step_of_a_preset_is_kept_too() {
        let line = Line::parse_from(["verify-case", "case.toml"]);
        let grids = Grids::of(&line.arguments, PRESET.as_bytes()).unwrap();
        let steps: Vec<f64> = grids.orders.iter().map(|order| order.case.analysis.dt).collect();
        assert!(steps.iter().all(|dt| *dt == steps[0]) && grids.sizes[0] != grids.sizes[1], "{steps:?}");
    }

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: VerifyArguments,
    }

    fn grids(options: &[&str]) -> Result<Grids, Error> {
        let line = Line::parse_from([&["verify-case", "case.toml"], options].concat());
        Grids::of(&line.arguments, COLUMN.as_bytes())
    }

    fn near(found: [f64; 3], expected: [f64; 3]) -> bool {
        found.iter().zip(expected).all(|(found, expected)| (found / expected - 1.0).abs() < 1e-12)
    }

    #[test]
    fn grids_are_nested_and_the_step_is_as_asked() {
        let found = grids(&["--refine-only"]).unwrap();
        assert!(near(found.sizes, [2.5e-3, 5e-3, 1e-2]));
        assert!(found.orders.iter().all(|order| order.case.analysis.dt == found.own.analysis.dt));
        assert!(found.orders.iter().all(|order| order.case.bodies[0].points_per_cell == 2));
        let found = grids(&["--refine-only", "--time-step", "refined"]).unwrap();
        let steps = [0, 1, 2].map(|index| found.orders[index].case.analysis.dt);
        assert!(near(steps, [1.25e-4, 2.5e-4, 5e-4]), "{steps:?}");
        let found = grids(&["--cells", "5 mm,10 mm,\"6.25 mm\""]).unwrap();
        assert!(near(found.sizes, [5e-3, 6.25e-3, 1e-2]));
    }

    #[test]
    fn grids_that_the_case_cannot_have_are_told() {
        // 0.55 m is no whole number of cells of 20 mm.
        let error = grids(&[]).err().unwrap().to_string();
        assert!(error.contains("--refine-only"), "{error}");
        for options in
            [&["--ratio", "1"][..], &["--ratio", "11"], &["--cells", "5mm,10mm"], &["--cells", "5mm,5mm,10mm"]]
        {
            assert_eq!(grids(options).err().unwrap().exit_code(), 2, "{options:?}");
        }
        let knots = ["--set", "grid.knots.x=[0.0, 0.3, 0.55]", "--set", "grid.knots.y=[0.0, 0.05, 0.1025]"];
        assert_eq!(grids(&knots).err().unwrap().exit_code(), 2);
    }
}
