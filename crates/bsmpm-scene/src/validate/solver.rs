//! The solver's settings and their defaults that depend on the analysis.

use crate::case::{Case, Linear, NamedMaterial, Solver};
use crate::estimate;
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::validate::lines;
use crate::words::{Factor, Ksp, LinearSolver, Pc, Word};
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::Regime;
use bsmpm::quadrature::Quadrature;

/// The solver, for a grid and its materials.
pub(super) fn read(
    root: &Record,
    regime: Option<Regime>,
    (grid, materials): (Option<&GridSpec>, Option<&[NamedMaterial]>),
    report: &mut Report<'_>,
) -> Option<Solver> {
    let solver = root.record("solver")?;
    let quadrature = weights(solver, regime, grid.map(|grid| grid.order), report);
    let extended_splines = extended_splines(solver, regime, grid.map(|grid| grid.order), report);
    let background = background(solver, regime, report);
    let poisson = materials.unwrap_or_default().iter().map(|material| material.material.elastic().poisson);
    let unknowns = grid.map_or(0, |grid| grid.dims() as u128 * estimate::nodes(grid));
    let size = Size { unknowns, poisson: poisson.fold(0.0, f64::max), reproducible: solver.flag("reproducible")? };
    let linear = match solver.record("linear") {
        Some(linear) => read_linear(linear, size, report),
        None => solver.word("linear").map(in_a_word),
    };
    Some(Solver {
        nonlinear: solver.word("nonlinear")?,
        tolerance: solver.number("tolerance")?,
        force_tolerance: solver.number("force_tolerance")?,
        max_iterations: usize::try_from(solver.count("max_iterations")?).ok()?,
        quadrature: quadrature?,
        extended_splines: extended_splines?,
        background: background?,
        linear: linear?,
        reproducible: size.reproducible,
    })
}

/// What points weigh as the case gives it: their own volume in dynamics and on cubic grids.
fn weights(
    solver: &Record,
    regime: Option<Regime>,
    order: Option<usize>,
    report: &mut Report<'_>,
) -> Option<Quadrature> {
    match solver.word_if_given("quadrature")? {
        None | Some(Quadrature::Points) => return Some(Quadrature::Points),
        Some(Quadrature::Fitted) => {}
    }
    if order? == 3 {
        let message = "\"fitted\" is for linear and quadratic grids: cubic ones, which integrate well by themselves, find no \
                       equilibrium with it in a bar compressed to half; use \"points\"";
        solver.error("quadrature", message, report);
        return None;
    }
    if regime? == Regime::Dynamic {
        let message = "\"fitted\" is for quasi-static analysis: weights that change from step to step change the energy of \
                       what moves; use \"points\"";
        solver.error("quadrature", message, report);
        return None;
    }
    Some(Quadrature::Fitted)
}

/// Fits the points' weights where materials of unlike stiffness meet on a C0 line, unless the case says otherwise:
/// material that crosses the line has wrong stresses without. Not in dynamics, on cubic grids and where water flows. At
/// C0 lines at the ends of strips it gains nothing, and limit loads are .6 % higher.
pub(super) fn fit_weights(case: &mut Case, root: &Record, report: &mut Report<'_>) {
    let is_given = root.record("solver").is_none_or(|solver| solver.gives("quadrature"));
    let may_fit = case.analysis.regime == Regime::QuasiStatic && case.grid.order < 3 && case.flow.is_none();
    if is_given || !may_fit || !lines::has_interface(case) {
        return;
    }
    case.solver.quadrature = Quadrature::Fitted;
    let reason = "material may cross the grid line on which others meet it, and its stress would be wrong there";
    report.note("solver.quadrature", Quadrature::Fitted.word(), reason);
}

const EXTENSION: &str = "extension";

/// Whether functions of nearly empty cells are tied: in quasi-static analysis with linear and quadratic splines, unless
/// the case says otherwise.
fn extended_splines(
    solver: &Record,
    regime: Option<Regime>,
    order: Option<usize>,
    report: &mut Report<'_>,
) -> Option<ExtendedSplines> {
    let given = solver.word_if_given(EXTENSION)?;
    let refusal = match (regime?, order?) {
        (Regime::Dynamic, _) => {
            "\"linear\" is for quasi-static analysis. In dynamics it throws layers thinner than a cell ahead of the \
             material behind them. Use \"off\"."
        }
        (Regime::QuasiStatic, 3) => {
            "\"linear\" is for linear and quadratic splines. The edge of cubic ones creeps with it as without it, in \
             five times the iterations. Use \"off\", or grid.degree = \"quadratic\"."
        }
        (Regime::QuasiStatic, _) => {
            let extended = given.unwrap_or(ExtendedSplines::Linear);
            if given.is_none() {
                let reason =
                    "functions of nearly empty cells have no stiffness of their own in a quasi-static analysis";
                report.note("solver.extension", extended.word(), reason);
            }
            return Some(extended);
        }
    };
    if given == Some(ExtendedSplines::Linear) {
        solver.error(EXTENSION, refusal, report);
        return None;
    }
    Some(ExtendedSplines::Off)
}

/// The coefficient of the soft background.
fn background(solver: &Record, regime: Option<Regime>, report: &mut Report<'_>) -> Option<f64> {
    if solver.gives("background") {
        return solver.number("background");
    }
    let (background, reason) = match regime? {
        Regime::Dynamic => (0.0, "inertia holds nearly empty cells in a dynamic analysis"),
        Regime::QuasiStatic => {
            (1e-4, "functions that extended splines leave untied have no other stiffness in a quasi-static analysis")
        }
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
            "solver.background: {:e} is above {SOFT:e}. Under dead load it makes the ground too strong: with 1e-3, factors of \
             safety are 2 % too high. Delete solver.background.",
            case.solver.background
        ));
    }
}

/// Unknowns from which multigrid is taken by itself: a factor of so many has about 40 GB.
const MANY: u128 = 10_000_000;
/// Poisson's ratio up to which it is: multigrid's iterations grow from 22 at .3 to 124 at .495 and 900 at .4999.
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
            return Some(format!("{up_to}: below {MANY} a factor kept for a step's iterations costs least"));
        }
        if self.poisson > COMPRESSIBLE {
            return Some(format!("{up_to}, but multigrid iterates for long above a Poisson's ratio of {COMPRESSIBLE}"));
        }
        self.reproducible.then(|| format!("{up_to}, but multigrid need not repeat to the bit: solver.reproducible"))
    }
}

/// What a word for the linear solver stands for.
fn in_a_word(solver: LinearSolver) -> Linear {
    let iterative = |ksp, pc, applications| Linear { ksp, pc, factor: None, applications, by_size: false };
    match solver {
        LinearSolver::Direct => Linear { factor: Some(Factor::Dissection), ..iterative(Ksp::Preonly, Pc::Cholesky, 0) },
        LinearSolver::Multigrid => iterative(Ksp::Cg, Pc::Gamg, 0),
        LinearSolver::IncompleteCholesky => iterative(Ksp::Preonly, Pc::Bjacobi, 1),
        LinearSolver::MultigridCycles => iterative(Ksp::Preonly, Pc::Gamg, 2),
        LinearSolver::SplineMultigrid => iterative(Ksp::Preonly, Pc::SplineMultigrid, 2),
    }
}

/// Unknowns of a solid from which a factor takes longer than the iterations that it saves: measured in
/// `cases/results/solid.md`.
const FEW_IN_SPACE: u64 = 10_000;
/// Unknowns of a solid from which multigrid is taken: both take the same time with 115,000 in dynamics (same place).
const MANY_IN_SPACE: u64 = 150_000;

/// The same of nearly incompressible material, from which multigrid over the grid's splines is taken (same place).
const FEW_INCOMPRESSIBLE: u64 = 100_000;

/// Takes what applies in a solid of many unknowns unless the case says it, and refuses what needs solutions of a
/// solver that has none.
pub(super) fn of_case(case: &mut Case, root: &Record, report: &mut Report<'_>) {
    let Some(solver) = root.record("solver") else { return };
    let condenses = case.rigid.iter().any(|rigid| rigid.free.contains(&true));
    let is_own = case.solver.linear.pc == Pc::SplineMultigrid;
    if (is_own || case.solver.linear.applications > 0) && (case.flow.is_some() || condenses) {
        let what = if condenses { "rigid bodies that move freely" } else { "water that flows" };
        let message =
            format!("a preconditioner in place of solutions was not shown to be right with {what}: \"direct\"");
        solver.error("linear", message, report);
        return;
    }
    let (dims, active) = (case.grid.dims(), case.estimate(1).active);
    if dims < 3 && is_own {
        solver.error("linear", "\"spline-multigrid\" was shown to be right for solids only: \"direct\"", report);
        return;
    }
    // Near failure the preconditioner alone may give up before the ground does, and whether it does is the answer.
    let fails = case.strength_reduction.is_some();
    if dims < 3 || solver.gives("linear") {
        return;
    }
    let so_many = format!("up to {active} unknowns in space");
    let by_factor = match () {
        () if active <= FEW_IN_SPACE => Some(format!(", {FEW_IN_SPACE} at most: a factor costs least")),
        () if fails => {
            Some(": near failure a preconditioner in place of solutions may give up before the ground does".into())
        }
        () if case.flow.is_some() || condenses => Some(": what else applies was not shown to be right here".into()),
        () => None,
    };
    if let Some(reason) = by_factor {
        if case.solver.linear.factor.is_some() {
            chosen(LinearSolver::Direct, so_many + &reason, report);
        }
        return;
    }
    if case.is_nearly_incompressible() {
        let what = "of nearly incompressible material, or of soil that flows at rest with poisson above 0.4";
        if case.solver.linear.factor.is_some() && active <= FEW_INCOMPRESSIBLE {
            chosen(LinearSolver::Direct, format!("{so_many} {what}: a factor takes less time than multigrid"), report);
        } else if case.solver.linear.factor.is_some() {
            case.solver.linear = Linear { by_size: true, ..in_a_word(LinearSolver::SplineMultigrid) };
            let reason = format!(
                "{so_many} {what}, more than {FEW_INCOMPRESSIBLE}: a factor takes longer and more memory, what other \
                 preconditioners leave in place of solutions takes several times as long; on several ranks a factor"
            );
            chosen(LinearSolver::SplineMultigrid, reason, report);
        }
        return;
    }
    let many = active > MANY_IN_SPACE;
    let word = if many { LinearSolver::MultigridCycles } else { LinearSolver::IncompleteCholesky };
    case.solver.linear = Linear { by_size: true, ..in_a_word(word) };
    let reason = match many {
        true => format!(
            "{so_many}, more than {MANY_IN_SPACE}: what one application of an incomplete factor leaves grows with them; on \
             several ranks, where this need not repeat to the bit, only with solver.reproducible = false"
        ),
        false => format!(
            "{so_many}, more than {FEW_IN_SPACE}: an application of an incomplete factor in place of a solution; a factor \
             takes longer than the iterations that it saves, and 2.5 times the memory with every doubling"
        ),
    };
    chosen(word, reason, report);
}

/// Notes what is taken, in place of what was before the case was known.
fn chosen(word: LinearSolver, reason: String, report: &mut Report<'_>) {
    report.notes.retain(|note| !note.key.starts_with("solver.linear"));
    report.note("solver.linear", word.word(), reason);
}

/// What the case says of the linear solver by PETSc's names.
struct PetscNames {
    ksp: Option<Ksp>,
    pc: Option<Pc>,
    factor: Option<Factor>,
}

fn read_linear(linear: &Record, size: Size, report: &mut Report<'_>) -> Option<Linear> {
    let asked = PetscNames {
        ksp: linear.word_if_given("ksp")?.flatten(),
        pc: linear.word_if_given("pc")?.flatten(),
        factor: linear.word_if_given("factor")?,
    };
    // Nothing else asks for a factorisation.
    let open = size.against_multigrid().is_none() && asked.ksp != Some(Ksp::Preonly) && asked.factor.is_none();
    let pc = asked.pc.unwrap_or(if open { Pc::Gamg } else { Pc::Cholesky });
    let ksp = asked.ksp.unwrap_or(if pc.solves() { Ksp::Preonly } else { Ksp::Cg });
    if ksp == Ksp::Preonly && !pc.solves() {
        let message = format!("\"{ksp}\" solves with a direct pc (cholesky, lu, redundant) only, not with \"{pc}\"");
        linear.error("ksp", message, report);
        return None;
    }
    let dissects = ksp == Ksp::Preonly && pc == Pc::Cholesky;
    if asked.factor == Some(Factor::Dissection) && !dissects {
        let message =
            format!("\"dissection\" is a \"preonly\" \"cholesky\", neither \"{ksp}\" nor \"{pc}\" can use it");
        linear.error("factor", message, report);
        return None;
    }
    let factor = match (pc.factorises(), asked.factor) {
        (true, Some(factor)) => Some(factor),
        (true, None) => Some(if dissects { Factor::Dissection } else { Factor::Mumps }),
        (false, Some(factor)) => {
            let path = linear.path_of("factor");
            report.warn(format!("{path}: \"{factor}\" is not used: pc = \"{pc}\" is no direct solver"));
            None
        }
        (false, None) => None,
    };
    let found = Linear { ksp, pc, factor, applications: 0, by_size: false };
    explain(linear, (&asked, &found), size, report);
    Some(found)
}

/// Notes what the case has left open, and why it is what it is.
fn explain(linear: &Record, (asked, found): (&PetscNames, &Linear), size: Size, report: &mut Report<'_>) {
    if asked.pc.is_none() {
        let many =
            || format!("up to {} unknowns, more than {MANY}: a factor costs more than iterations", size.unknowns);
        let wanted = || "\"preonly\" or a factor is asked for".to_owned();
        let reason = match (found.pc, size.against_multigrid()) {
            (Pc::Gamg, _) => many(),
            (_, Some(reason)) => reason,
            (_, None) => wanted(),
        };
        report.note(linear.path_of("pc"), found.pc.word(), reason);
    }
    if let (Some(factor), None) = (found.factor, asked.factor) {
        let reason = if factor == Factor::Dissection {
            "nested dissection of the grid: shared between the ranks, repeats to the bit, no analysis of a graph"
        } else {
            "the default package of PETSc's direct solvers"
        };
        report.note(linear.path_of("factor"), factor.word(), reason);
    }
}
