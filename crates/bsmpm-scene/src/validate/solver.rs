//! Validates solver settings, and chooses their defaults.

use crate::case::{Case, NamedMaterial, Solver};
use crate::estimate;
use crate::grid::GridSpec;
use crate::report::Report;
use crate::schema::{Draft, SolverTable};
use crate::validate::lines;
use crate::words::{LinearSolver, Word};
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::Regime;
use bsmpm::quadrature::Quadrature;

/// The solver, for a grid and its materials.
pub(super) fn read(
    draft: &Draft,
    regime: Option<Regime>,
    grid: Option<&GridSpec>,
    materials: Option<&[NamedMaterial]>,
    report: &mut Report<'_>,
) -> Option<Solver> {
    let solver = draft.solver.value()?;
    let quadrature = weights(solver, regime, grid.map(|grid| grid.order), report);
    let extended_splines = extended_splines(solver, regime, grid.map(|grid| grid.order), report);
    let background = background(solver, regime, report);
    let poisson = materials
        .unwrap_or_default()
        .iter()
        .map(|material| material.material.elastic().poisson);
    let unknowns = grid.map_or(0, |grid| grid.dims() as u128 * estimate::nodes(grid));
    let size = Size {
        unknowns,
        poisson: poisson.fold(0.0, f64::max),
        reproducible: solver.reproducible.get()?,
    };
    let linear = solver.linear.if_given()?;
    Some(Solver {
        nonlinear: solver.nonlinear.get()?,
        tolerance: solver.tolerance.get()?,
        force_tolerance: solver.force_tolerance.get()?,
        max_iterations: usize::try_from(solver.max_iterations.get()?).ok()?,
        quadrature: quadrature?,
        extended_splines: extended_splines?,
        background: background?,
        linear: linear.unwrap_or_else(|| by_size(size, solver.linear.path().to_owned(), report)),
        by_size: false,
        reproducible: size.reproducible,
    })
}

/// What points weigh as the case gives it: their own volume in dynamics and on cubic grids.
fn weights(
    solver: &SolverTable,
    regime: Option<Regime>,
    order: Option<usize>,
    report: &mut Report<'_>,
) -> Option<Quadrature> {
    match solver.quadrature.if_given()? {
        None | Some(Quadrature::Points) => return Some(Quadrature::Points),
        Some(Quadrature::Fitted) => {}
    }
    if order? == 3 {
        let message = "E0602: the solver does not converge with quadrature = \"fitted\" and cubic splines. Use quadrature = \
             \"points\".";
        solver.quadrature.error(message, report);
        return None;
    }
    if regime? == Regime::Dynamic {
        let message = "E0602: quadrature = \"fitted\" changes the energy of moving soil, and is not available in a \
                       dynamic analysis. Use quadrature = \"points\".";
        solver.quadrature.error(message, report);
        return None;
    }
    Some(Quadrature::Fitted)
}

/// Fits the points' weights where materials of unlike stiffness meet on a C0 line, unless the case says otherwise:
/// material that crosses the line has wrong stresses without. Not in dynamics, on cubic grids and where water flows. At
/// C0 lines at the ends of strips it gains nothing, and limit loads are 0.6 % higher.
pub(super) fn fit_weights(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    let is_given = draft.solver.value().is_none_or(|solver| solver.quadrature.is_given());
    let may_fit = case.analysis.regime == Regime::QuasiStatic && case.grid.order < 3 && case.flow.is_none();
    if is_given || !may_fit || !lines::has_interface(case) {
        return;
    }
    case.solver.quadrature = Quadrature::Fitted;
    let reason = "stresses stay accurate where material crosses a grid line between materials of different stiffness";
    report.note("solver.quadrature", Quadrature::Fitted.word(), reason);
}

/// Whether functions of nearly empty cells are tied: in quasi-static analysis with linear and quadratic splines, unless
/// the case says otherwise.
fn extended_splines(
    solver: &SolverTable,
    regime: Option<Regime>,
    order: Option<usize>,
    report: &mut Report<'_>,
) -> Option<ExtendedSplines> {
    let given = solver.extension.if_given()?;
    let refusal = match (regime?, order?) {
        (Regime::Dynamic, _) => {
            "E0603: in a dynamic analysis extension = \"linear\" would make soil layers thinner than a cell move too \
             fast, so it is not available. Use extension = \"off\"."
        }
        (Regime::QuasiStatic, 3) => {
            "E0603: extension = \"linear\" is not available with cubic splines, because it does not improve their \
             results. Use extension = \"off\"."
        }
        (Regime::QuasiStatic, _) => {
            let extended = given.unwrap_or(ExtendedSplines::Linear);
            if given.is_none() {
                let reason = "nearly empty cells have too little stiffness in a quasi-static analysis";
                report.note("solver.extension", extended.word(), reason);
            }
            return Some(extended);
        }
    };
    if given == Some(ExtendedSplines::Linear) {
        solver.extension.error(refusal, report);
        return None;
    }
    Some(ExtendedSplines::Off)
}

/// The coefficient of the artificial stiffness.
fn background(solver: &SolverTable, regime: Option<Regime>, report: &mut Report<'_>) -> Option<f64> {
    if solver.background.is_given() {
        return solver.background.get();
    }
    let (background, reason) = match regime? {
        Regime::Dynamic => (0.0, "nearly empty cells have inertia in a dynamic analysis"),
        Regime::QuasiStatic => (
            1e-4,
            "nearly empty cells that extended splines do not constrain need a small stiffness",
        ),
    };
    report.note("solver.background", format!("{background:?}"), reason);
    Some(background)
}

/// Coefficient of the background up to which answers under dead load were shown not to depend on it.
const SOFT: f64 = 1e-4;

/// Warns of a background that makes ground under dead load too strong. Motion that is prescribed meets none of it.
pub(super) fn warn_of_background(case: &Case, report: &mut Report<'_>) {
    let is_at_rest = case.analysis.regime == Regime::QuasiStatic;
    let bears_loads = !case.has_prescribed_motion() || case.strength_reduction.is_some();
    if is_at_rest && bears_loads && case.solver.background > SOFT {
        report.warn(format!(
            "W0602: solver.background: the artificial stiffness ({:e}) is above {SOFT:e} and makes the ground too \
             strong. Remove `background`.",
            case.solver.background
        ));
    }
}

/// Unknowns from which multigrid is taken by itself: a factor of so many has about 40 GB.
const MANY: u128 = 10_000_000;
/// Poisson's ratio up to which it is: multigrid's iterations grow from 22 at 0.3 to 124 at 0.495 and 900 at 0.4999.
const COMPRESSIBLE: f64 = 0.45;

/// What the linear solver is chosen by.
#[derive(Clone, Copy)]
struct Size {
    unknowns: u128,
    poisson: f64, // largest
    reproducible: bool,
}

impl Size {
    /// Why multigrid is not taken by itself, if it is not.
    fn against_multigrid(self) -> Option<String> {
        let up_to = format!("up to {} unknowns", self.unknowns);
        if self.unknowns <= MANY {
            return Some(format!("{up_to}: below {MANY} a direct solver is fastest"));
        }
        if self.poisson > COMPRESSIBLE {
            return Some(format!(
                "{up_to}, but multigrid converges slowly above a Poisson's ratio of {COMPRESSIBLE}"
            ));
        }
        self.reproducible
            .then(|| format!("{up_to}, but multigrid is not bitwise reproducible (solver.reproducible)"))
    }
}

/// Chooses the linear solver by size, and notes why.
fn by_size(size: Size, path: String, report: &mut Report<'_>) -> LinearSolver {
    let (solver, reason) = match size.against_multigrid() {
        Some(reason) => (LinearSolver::Direct, reason),
        None => (
            LinearSolver::Multigrid,
            format!(
                "up to {} unknowns: above {MANY} multigrid is faster than a direct solver",
                size.unknowns
            ),
        ),
    };
    report.note(path, solver.word(), reason);
    solver
}

/// Unknowns of a solid from which a factor takes longer than the iterations that it saves (measured
/// with a slope and a column in 3-D).
const FEW_IN_SPACE: u64 = 10_000;
/// Unknowns of a solid from which multigrid is taken: both take the same time with 115,000 in dynamics (same place).
const MANY_IN_SPACE: u64 = 150_000;

/// The same of nearly incompressible material, from which multigrid over the grid's splines is taken (same place).
const FEW_INCOMPRESSIBLE: u64 = 100_000;

/// Chooses the linear solver of a 3-D case with many unknowns unless the case gives it, and refuses iterative ones
/// where they are not available.
pub(super) fn of_case(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    let Some(solver) = draft.solver.value() else { return };
    let condenses = case.rigid.iter().any(|rigid| rigid.free.contains(&true));
    if let Some(message) = against_iterations(case, condenses) {
        solver.linear.error(message, report);
        return;
    }
    if case.grid.dims() < 3 || solver.linear.is_given() {
        return;
    }
    let active = case.estimate(1).active;
    let so_many = format!("up to {active} unknowns in 3-D");
    // Near failure the preconditioner alone may give up before the ground does, and whether it does is the answer.
    let fails = case.strength_reduction.is_some();
    let by_factor = match () {
        () if active <= FEW_IN_SPACE => Some(format!(": up to {FEW_IN_SPACE} a direct solver is fastest")),
        () if fails => Some(": near failure an iterative solver may fail before the ground does".into()),
        () if case.flow.is_some() || condenses => Some(": no iterative solver is available for this case".into()),
        () => None,
    };
    if let Some(reason) = by_factor {
        if case.solver.linear == LinearSolver::Direct {
            chosen(LinearSolver::Direct, so_many + &reason, report);
        }
        return;
    }
    let (word, reason) = match case.is_nearly_incompressible() {
        true if case.solver.linear != LinearSolver::Direct => return,
        true => of_incompressible(active, &so_many),
        false if active > MANY_IN_SPACE => (
            LinearSolver::MultigridCycles,
            format!(
                "{so_many}: above {MANY_IN_SPACE} faster than other solvers; on several ranks only with \
                 solver.reproducible = false, as it is not bitwise reproducible there"
            ),
        ),
        false => (
            LinearSolver::IncompleteCholesky,
            format!("{so_many}: above {FEW_IN_SPACE} faster than a direct solver, with less memory"),
        ),
    };
    if word != LinearSolver::Direct {
        (case.solver.linear, case.solver.by_size) = (word, true);
    }
    chosen(word, reason, report);
}

/// Says why the iterative solver of a case is not available for it, if it is not.
fn against_iterations(case: &Case, condenses: bool) -> Option<String> {
    let linear = case.solver.linear;
    if linear.is_rough() && (case.flow.is_some() || condenses) {
        let what = if condenses {
            "freely moving rigid bodies"
        } else {
            "flow of water"
        };
        return Some(format!(
            "E0604: the chosen linear solver is iterative and is not verified for a case with {what}. Use linear = \
             \"direct\"."
        ));
    }
    let message = "E0604: the linear solver \"spline-multigrid\" is available in 3-D only. Use linear = \"direct\".";
    (case.grid.dims() < 3 && linear == LinearSolver::SplineMultigrid).then(|| message.to_owned())
}

/// The solver of a 3-D case with so many unknowns and nearly incompressible material, and why it is chosen.
fn of_incompressible(active: u64, so_many: &str) -> (LinearSolver, String) {
    let what = "with nearly incompressible material";
    if active <= FEW_INCOMPRESSIBLE {
        let reason = format!("{so_many} {what}: a direct solver is faster than multigrid");
        return (LinearSolver::Direct, reason);
    }
    let reason = format!(
        "{so_many} {what}: above {FEW_INCOMPRESSIBLE} faster than a direct solver; several ranks use the direct \
         one"
    );
    (LinearSolver::SplineMultigrid, reason)
}

/// Notes what is taken, in place of what was before the case was known.
fn chosen(word: LinearSolver, reason: String, report: &mut Report<'_>) {
    report.notes.retain(|note| !note.key.starts_with("solver.linear"));
    report.note("solver.linear", word.word(), reason);
}
