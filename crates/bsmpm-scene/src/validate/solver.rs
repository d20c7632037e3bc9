//! The solver's settings and their defaults that depend on the analysis.

use crate::case::{Linear, Nonlinear, Solver};
use crate::record::Record;
use crate::report::Report;
use bsmpm::background::Extent;
use bsmpm::model::Regime;

/// The solver.
pub(super) fn read(root: &Record, regime: Option<Regime>, report: &mut Report<'_>) -> Option<Solver> {
    let solver = root.record("solver")?;
    let background = if solver.gives("background") {
        solver.number("background")
    } else {
        regime.map(|regime| default_background(regime, report))
    };
    let linear = solver.record("linear").and_then(|linear| read_linear(linear, report));
    Some(Solver {
        nonlinear: match solver.word("nonlinear")? {
            "broyden" => Nonlinear::Broyden,
            "newton" => Nonlinear::Newton,
            _ => Nonlinear::Auto,
        },
        tolerance: solver.number("tolerance")?,
        force_tolerance: solver.number("force_tolerance")?,
        max_iterations: usize::try_from(solver.count("max_iterations")?).ok()?,
        background: background?,
        background_cells: match solver.word("background_cells")? {
            "occupied" => Extent::Occupied,
            _ => Extent::PartlyFilled,
        },
        linear: linear?,
        reproducible: solver.flag("reproducible")?,
    })
}

fn default_background(regime: Regime, report: &mut Report<'_>) -> f64 {
    let (background, reason) = match regime {
        Regime::Dynamic => (0.0, "inertia holds nearly empty cells in a dynamic analysis"),
        Regime::QuasiStatic => (1e-4, "nothing else holds nearly empty cells in a quasi-static analysis"),
    };
    report.note("solver.background", format!("{background:?}"), reason);
    background
}

fn read_linear(linear: &Record, report: &mut Report<'_>) -> Option<Linear> {
    let (ksp, pc) = (linear.word("ksp")?, linear.word("pc")?);
    if linear.gives("factor") && linear.word("factor").is_none() {
        return None;
    }
    let direct = matches!(pc, "cholesky" | "lu");
    if ksp == "preonly" && !direct && pc != "redundant" {
        let message = format!("\"preonly\" solves with a direct pc (cholesky, lu, redundant) only, not with \"{pc}\"");
        linear.error("ksp", message, report);
        return None;
    }
    let factor = match (direct, linear.word("factor")) {
        (true, Some(factor)) => Some(factor),
        (true, None) => {
            report.note(linear.path_of("factor"), "mumps", "the default package of a direct solver");
            Some("mumps")
        }
        (false, Some(factor)) => {
            report.warn(format!(
                "{}: \"{factor}\" is not used: pc = \"{pc}\" is no direct solver",
                linear.path_of("factor")
            ));
            None
        }
        (false, None) => None,
    };
    Some(Linear { ksp, pc, factor })
}
