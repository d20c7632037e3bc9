//! The solver's settings and their defaults that depend on the analysis.

use crate::case::{Linear, Nonlinear, Solver};
use crate::record::Record;
use crate::report::Report;
use bsmpm::background::{Extent, Kind};
use bsmpm::model::Regime;

/// The solver, for a grid of `order`.
pub(super) fn read(
    root: &Record,
    regime: Option<Regime>,
    order: Option<usize>,
    report: &mut Report<'_>,
) -> Option<Solver> {
    let solver = root.record("solver")?;
    let (kind, background) = background(solver, regime, order, report);
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
        background_kind: kind?,
        background_cells: cells(solver, kind?)?,
        linear: linear?,
        reproducible: solver.flag("reproducible")?,
    })
}

/// What the background resists, and its coefficient.
fn background(
    solver: &Record,
    regime: Option<Regime>,
    order: Option<usize>,
    report: &mut Report<'_>,
) -> (Option<Kind>, Option<f64>) {
    let kind = background_kind(solver, order, report);
    let coefficient = if solver.gives("background") {
        solver.number("background")
    } else {
        regime.zip(kind).map(|(regime, kind)| default_background(regime, kind, report))
    };
    (kind, coefficient)
}

const KIND: &str = "background_kind";

/// The cells that the case names, else those that its kind of background is meant for.
fn cells(solver: &Record, kind: Kind) -> Option<Extent> {
    if !solver.gives("background_cells") {
        return Some(if kind == Kind::Curvature { Extent::PartlyFilled } else { Extent::Occupied });
    }
    Some(if solver.word("background_cells")? == "occupied" { Extent::Occupied } else { Extent::PartlyFilled })
}

/// What the case wants the background to resist.
fn background_kind(solver: &Record, order: Option<usize>, report: &mut Report<'_>) -> Option<Kind> {
    let linear = order? == 1;
    let kind = match solver.word(KIND)? {
        "curvature" => Kind::Curvature,
        "ghost-penalty" => Kind::GhostPenalty,
        _ => Kind::Laplacian,
    };
    if linear && kind == Kind::Curvature {
        let message = "functions of a linear grid have no curvature along an axis, so that nothing would hold nearly \
                       empty cells; use \"laplacian\"";
        solver.error(KIND, message, report);
        return None;
    }
    Some(kind)
}

/// Curvature 1e-3 bounds the condition of the stiffness by 7e3 (Laplacian 1e-4: 7e5) and lets a tenth or ten times of it
/// change a slope next to failure by 1 to 3 %; larger ones hold the edge too much.
fn default_background(regime: Regime, kind: Kind, report: &mut Report<'_>) -> f64 {
    let (background, reason) = match (regime, kind) {
        (Regime::Dynamic, _) => (0.0, "inertia holds nearly empty cells in a dynamic analysis"),
        (Regime::QuasiStatic, Kind::Curvature) => (1e-3, QUASI_STATIC),
        (Regime::QuasiStatic, Kind::Laplacian | Kind::GhostPenalty) => (1e-4, QUASI_STATIC),
    };
    report.note("solver.background", format!("{background:?}"), reason);
    background
}

const QUASI_STATIC: &str = "nothing else holds nearly empty cells in a quasi-static analysis";

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
