//! The case on three grids.

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
    /// m  the size of the cells: the root of the area of one, of a solid the cube root of its volume
    pub sizes: [f64; 3],
    pub own: Case,
}

impl Grids {
    /// # Errors
    /// [`Error::Usage`] for ratios that show nothing, and for those that cells of several sizes cannot be divided by;
    /// [`Error::BadCase`] for grids that the case cannot have, with all of their errors.
    pub fn of(arguments: &VerifyArguments, bytes: &[u8]) -> Result<Self, Error> {
        let path = &arguments.case;
        let own = case::parsed(path, bytes, &arguments.options.set)?;
        let mut orders = Vec::new();
        let mut errors = Vec::new();
        for grid in arguments.grids(&own)? {
            let mut set = arguments.options.set.clone();
            let named = grid.len();
            set.extend(grid);
            match RunOrder::read(path, bytes, set.clone(), named) {
                Ok(order) => orders.push(arguments.timed(order, bytes, set, &own)?),
                Err(found) => errors.extend(found),
            }
        }
        if !errors.is_empty() {
            errors.push(
                "note: cells of each of the three sizes must fill the grid. Choose others with --refine-only, --ratio or --cells."
                    .into(),
            );
            return Err(Error::BadCase {
                path: path.clone(),
                errors,
            });
        }
        orders.sort_by(|a, b| a.cell().total_cmp(&b.cell()));
        let sizes = [orders[0].cell(), orders[1].cell(), orders[2].cell()];
        let ratios = [sizes[1] / sizes[0], sizes[2] / sizes[1]];
        if ratios.iter().any(|ratio| !(LEAST..=MOST).contains(ratio)) {
            let reason = format!(
                "E0858: the cell sizes {sizes:?} m are too similar or too different. Each must be {LEAST} to {MOST} \
                 times the next smaller one. Change --cells or --ratio."
            );
            return Err(Error::Usage { reason });
        }
        Ok(Self { orders, sizes, own })
    }
}

impl VerifyArguments {
    /// The settings that make each grid.
    fn grids(&self, own: &Case) -> Result<Vec<Vec<String>>, Error> {
        let usage = |reason: String| Err(Error::Usage { reason });
        if let Some(cells) = &self.cells {
            let cells = split(cells);
            let count = cells.len();
            return if count == 3 {
                Ok(cells.iter().map(|cell| vec![format!("grid.cell={cell}")]).collect())
            } else {
                usage(format!(
                    "E0859: --cells gives {count} sizes, but three are needed. Give three sizes, such as 0.4,0.2,0.1."
                ))
            };
        }
        let [x, y] = &own.grid.axes[..] else {
            return usage(
                "E0860: in 3-D the cell sizes are not chosen by a ratio, because the number of cells grows with its \
                 third power. Give the three sizes with --cells, such as 0.4,0.3,0.2."
                    .to_owned(),
            );
        };
        let graded = is_graded(own);
        if !(LEAST..=MOST).contains(&self.ratio) {
            return usage(format!(
                "E0861: --ratio {} is out of range. Use a ratio from {LEAST} to {MOST}.",
                self.ratio
            ));
        }
        if graded && self.ratio.fract() != 0.0 {
            return usage(format!(
                "E0862: --ratio must be a whole number, because the grid has cells of several sizes. The value is {}. \
                 Use a whole number, or give sizes of equal cells with --cells.",
                self.ratio
            ));
        }
        let parts = self.ratio as usize;
        if graded {
            return Ok([1, parts, parts * parts].map(|parts| divided(own, parts)).to_vec());
        }
        let coarsest = if self.refine_only { 1.0 } else { self.ratio };
        let factors = [coarsest, coarsest / self.ratio, coarsest / self.ratio / self.ratio];
        let settings = factors.map(|factor| {
            let [wide, high] = [factor * x.cell(0), factor * y.cell(0)];
            vec![format!("grid.cell=[{wide:?}, {high:?}]")]
        });
        Ok(settings.to_vec())
    }

    /// The order with the step that it gets.
    fn timed(&self, order: RunOrder, bytes: &[u8], mut set: Vec<String>, own: &Case) -> Result<RunOrder, Error> {
        let step = match self.time_step {
            // Steps that a preset chooses would follow the cells.
            TimeStep::Kept if order.case.analysis.dt == own.analysis.dt => return Ok(order),
            TimeStep::Kept => own.analysis.dt,
            TimeStep::Refined => own.analysis.dt * order.cell() / RunOrder::cell_of(own),
        };
        set.push(format!("analysis.dt={step:?}"));
        if let (TimeStep::Refined, Some((growth, longest))) = (self.time_step, own.analysis.growth) {
            let finer = order.cell() / RunOrder::cell_of(own);
            set.push(format!("analysis.growth={:?}", 1.0 + finer * (growth - 1.0)));
            if longest < f64::INFINITY {
                set.push(format!("analysis.dt_max={:?}", finer * longest));
            }
        }
        RunOrder::read(&self.case, bytes, set, 2).map_err(|errors| Error::BadCase {
            path: self.case.clone(),
            errors,
        })
    }
}

/// The settings of the case's own grid with each cell divided into so many parts along each axis, and the points of a
/// cell as they are.
pub(crate) fn divided(own: &Case, parts: usize) -> Vec<String> {
    let names = ["x", "y", "z"].into_iter().zip(0..own.grid.axes.len());
    let knots = names.map(|(name, axis)| format!("{name} = {:?}", divided_knots(own, axis, parts)));
    let knots = format!("grid.knots={{ {} }}", knots.collect::<Vec<_>>().join(", "));
    std::iter::once(knots).chain(points(own)).collect()
}

/// The settings that keep the points of every body's cells.
fn points(own: &Case) -> impl Iterator<Item = String> {
    let bodies = own.bodies.iter().enumerate();
    bodies.map(|(number, body)| format!("body.{number}.points_per_cell={}", body.points_per_cell))
}

/// m  the breakpoints along an axis, in the case's coordinates, between which each cell is divided into equal parts
fn divided_knots(own: &Case, axis: usize, parts: usize) -> Vec<f64> {
    let cells = &own.grid.axes[axis];
    let mut knots = Vec::new();
    for number in 0..=cells.cells() * parts {
        let cell = number / parts;
        let knot = match number % parts {
            0 => breakpoint(cells, cell),
            part => {
                let along = part as f64 / parts as f64;
                breakpoint(cells, cell) * (1.0 - along) + breakpoint(cells, cell + 1) * along
            }
        };
        let mut lines = own.grid.lines[axis].iter();
        let line = lines.find(|line| line.breakpoint * parts == number);
        knots.extend(std::iter::repeat_n(knot, line.map_or(1, |line| line.multiplicity)));
    }
    knots
}

/// Breakpoint (m) along an axis, in the case's coordinates.
fn breakpoint(cells: &GridAxis, number: usize) -> f64 {
    match cells {
        GridAxis::Uniform { lower, .. } => lower + cells.breakpoint(number),
        GridAxis::Graded(breakpoints) => breakpoints[number],
    }
}

/// The settings of cells of one size, divided into so many parts along each axis.
pub(crate) fn divided_equally(own: &Case, parts: usize) -> Vec<String> {
    let edges: Vec<f64> = own.grid.axes.iter().map(|axis| axis.cell(0) / parts as f64).collect();
    std::iter::once(format!("grid.cell={edges:?}"))
        .chain(points(own))
        .collect()
}

/// Whether the cells are of several sizes along an axis.
pub(crate) fn is_graded(own: &Case) -> bool {
    own.grid.axes.iter().any(|axis| matches!(axis, GridAxis::Graded(_)))
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
        assert!(
            steps.iter().all(|dt| *dt == steps[0]) && grids.sizes[0] != grids.sizes[1],
            "{steps:?}"
        );
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
        found
            .iter()
            .zip(expected)
            .all(|(found, expected)| (found / expected - 1.0).abs() < 1e-12)
    }

    #[test]
    fn grids_are_nested_and_the_step_is_as_asked() {
        let found = grids(&["--refine-only"]).unwrap();
        assert!(near(found.sizes, [2.5e-3, 5e-3, 1e-2]));
        assert!(
            found
                .orders
                .iter()
                .all(|order| order.case.analysis.dt == found.own.analysis.dt)
        );
        assert!(
            found
                .orders
                .iter()
                .all(|order| order.case.bodies[0].points_per_cell == 2)
        );
        let found = grids(&["--refine-only", "--time-step", "refined"]).unwrap();
        let steps = [0, 1, 2].map(|index| found.orders[index].case.analysis.dt);
        assert!(near(steps, [1.25e-4, 2.5e-4, 5e-4]), "{steps:?}");
        let found = grids(&["--cells", "5 mm,10 mm,\"6.25 mm\""]).unwrap();
        assert!(near(found.sizes, [5e-3, 6.25e-3, 1e-2]));
    }

    #[test]
    fn grids_that_the_case_cannot_have_are_reported() {
        // 0.55 m is no whole number of cells of 20 mm.
        let error = grids(&[]).err().unwrap().to_string();
        assert!(error.contains("--refine-only"), "{error}");
        for options in [
            &["--ratio", "1"][..],
            &["--ratio", "11"],
            &["--cells", "5mm,10mm"],
            &["--cells", "5mm,5mm,10mm"],
        ] {
            assert_eq!(grids(options).err().unwrap().exit_code(), 2, "{options:?}");
        }
    }

    /// Cells of several sizes, by hand or by a preset, keep their proportions, repeated breakpoints and points.
    #[test]
    fn graded_cells_are_divided() {
        let knots = [
            "--set",
            "grid.knots.x=[0.0, 0.3, 0.3, 0.55]",
            "--set",
            "grid.knots.y=[0.0, 0.05, 0.1025]",
        ];
        let found = grids(&knots).unwrap();
        assert!(
            near(
                found.sizes,
                [0.25, 0.5, 1.0].map(|part| part * (0.3_f64 * 0.0525).sqrt())
            ),
            "{:?}",
            found.sizes
        );
        let cells: Vec<usize> = found
            .orders
            .iter()
            .map(|order| order.case.grid.axes[0].cells())
            .collect();
        assert_eq!(cells, [8, 4, 2]);
        assert!(found.orders.iter().all(|order| order.case.grid.lines[0].len() == 1));
        assert!(
            found
                .orders
                .iter()
                .all(|order| order.case.bodies[0].points_per_cell == 2)
        );
        let knots_moved = [
            "--set",
            "grid.knots.x=[-0.1, 0.3, 0.55]",
            "--set",
            "grid.knots.y=[-0.2, 0.05, 0.1025]",
        ];
        let found = grids(&[&["--set", "grid.lower=[-0.1, -0.2]"][..], &knots_moved].concat()).unwrap();
        assert!(
            found
                .orders
                .iter()
                .all(|order| order.case.grid.lower() == [-0.1, -0.2, 0.0])
        );
        assert_eq!(found.orders[2].case.grid, found.own.grid);
        assert_eq!(
            grids(&[&knots[..], &["--ratio", "1.5"]].concat())
                .err()
                .unwrap()
                .exit_code(),
            2
        );
        let line = Line::parse_from(["verify-case", "case.toml"]);
        let footing = include_str!("../../../../cases/presets/strip_footing.toml");
        let found = Grids::of(&line.arguments, footing.as_bytes()).unwrap();
        let points: Vec<usize> = found
            .orders
            .iter()
            .map(|order| order.case.bodies[0].points_per_cell)
            .collect();
        assert_eq!(points, [found.own.bodies[0].points_per_cell; 3]);
        assert!(
            found.orders[2].case.points() == found.own.points(),
            "the coarsest is the case's own"
        );
    }
}
