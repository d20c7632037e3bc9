//! Tests that `accuracy` chooses cells, points and steps.

mod cells;
mod choices;
mod errors;
mod waves;

use bsmpm_scene::{Case, Error};

const COLUMN: &str = include_str!("../../../../cases/presets/column_collapse.toml");
const SLOPE: &str = include_str!("../../../../cases/presets/slope_stability.toml");
const FOOTING: &str = include_str!("../../../../cases/presets/strip_footing.toml");

fn read(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text(
        "case.toml",
        text,
        &overrides.iter().map(ToString::to_string).collect::<Vec<_>>(),
    )
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    read(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

/// Cells along x, their edge in m, points along it, length of a step, force tolerance.
fn discretisation(case: &Case) -> (usize, f64, usize, f64, f64) {
    let x = &case.grid.axes[0];
    (
        x.cells(),
        x.shortest(),
        case.bodies[0].points_per_cell,
        case.analysis.dt,
        case.solver.force_tolerance,
    )
}
