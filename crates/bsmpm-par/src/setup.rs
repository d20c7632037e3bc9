//! Sets up grid division, initial stress and linear solver.

use bsmpm::error::StepError;
use bsmpm::initial::{Equilibrium, EquilibriumSearchReport};
use bsmpm::kinematics::Kinematics;
use bsmpm::model::AverageWeight;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::smooth;
use bsmpm::tensor::Vector;
use bsmpm_io::manifest;
use bsmpm_ranks::linear::{Choice, SPLINE_MULTIGRID};
use bsmpm_ranks::load;
use bsmpm_ranks::simulation::{Simulation, StartStress};
use bsmpm_ranks::slab::Slabs;
use bsmpm_scene::model::{at_rest, penalty, weighting};
use bsmpm_scene::words::LinearSolver;
use bsmpm_scene::{Case, Geometry, GridAxis, Initial};
use std::ops::Range;

/// Partition of the grid at the start.
pub struct Cut {
    /// Cells along each axis that the ranks together see ([`bsmpm::grid::room`]).
    pub room: Vec<Range<usize>>,
    /// Slabs of these cells.
    pub slabs: Slabs,
    /// Number of parts into which each slab is to be cut.
    pub parts: usize,
}

/// A state at the start, and what leading it to equilibrium took, if the case wants that.
pub type Start = (Equilibrium, Option<EquilibriumSearchReport>);

/// Gives the points the stress that the case wants at the start, and reports how well it is balanced.
pub fn start<K: Kinematics<D>, const D: usize>(
    case: &Case,
    simulation: &mut Simulation<'_, K, D>,
) -> Result<Option<Start>, StepError> {
    let (by_weight, by_k0);
    let stress: StartStress<'_, D> = match &case.initial {
        None => return Ok(None),
        Some(Initial::Elastic) => StartStress::Elastic,
        Some(Initial::AtRest(k0)) if case.settles => {
            by_k0 = |material: u16| k0[usize::from(material)];
            StartStress::Spread(&by_k0)
        }
        Some(Initial::AtRest(k0)) => {
            by_weight = |material: u16, x: &Vector<D>| at_rest(case, k0, material, x);
            StartStress::Given(&by_weight)
        }
    };
    simulation.stress(stress, case.settles).map(Some)
}

/// The room that the bodies have in the grid at the start, and its first cut: about equal loads. `None` with more ranks
/// than the grid has room for.
pub fn cut(case: &Case, ranks: usize) -> Option<Cut> {
    let parts = parts(case, ranks)?;
    let slabs = ranks / parts;
    let room = case.room([slabs, parts]);
    let counts: Vec<f64> = case.points_by_column()[room[0].clone()]
        .iter()
        .map(|&count| count as f64)
        .collect();
    let layer_nodes = room[1..].iter().map(|cells| cells.len() + case.grid.order).product();
    let slabs = Slabs::cut(&load::by_column(&counts, layer_nodes), slabs)?.starting_at(room[0].start);
    Some(Cut { room, slabs, parts })
}

/// Parts of a slab at the start.
fn parts(case: &Case, ranks: usize) -> Option<usize> {
    let room = case.room([1; 2]);
    case.parts(ranks, [room[0].len(), room[1].len()])
}

/// The linear solver of a run on so many ranks with further `options` of PETSc. MUMPS does instead of nested dissection
/// what this does not: general matrices, and what the options are about.
pub fn linear(case: &Case, ranks: usize, options: &[String]) -> Choice {
    let solver = case.solver.linear_on(ranks);
    let [ksp, pc] = match solver {
        LinearSolver::Direct => ["preonly", "cholesky"],
        LinearSolver::Multigrid => ["cg", "gamg"],
        LinearSolver::IncompleteCholesky => ["preonly", "bjacobi"],
        LinearSolver::MultigridCycles => ["preonly", "gamg"],
        LinearSolver::SplineMultigrid => ["preonly", SPLINE_MULTIGRID],
    };
    let is_direct = solver == LinearSolver::Direct;
    let dissection = is_direct && !options.iter().any(|option| decides(option));
    Choice {
        dissection,
        ksp: ksp.into(),
        pc: pc.into(),
        factor: is_direct.then(|| "mumps".into()),
        applications: match solver {
            LinearSolver::Direct | LinearSolver::Multigrid => 0,
            LinearSolver::IncompleteCholesky => 1,
            LinearSolver::MultigridCycles | LinearSolver::SplineMultigrid => 2,
        },
        // On one rank, too, where the matrix goes to PETSc: the same factorisation, bit by bit, on any number of ranks.
        redundant: case.solver.reproducible && is_direct && (ranks > 1 || !dissection),
    }
}

/// Whether an option of PETSc is about a preconditioner or a matrix of PETSc's, which need the matrix assembled; those
/// of KSP, and of reports, are for any.
fn decides(option: &str) -> bool {
    ["-pc_", "-mat_", "-sub_", "-mg_", "-redundant_"]
        .iter()
        .any(|prefix| option.starts_with(prefix))
}

/// What the program chooses by itself in a run on so many ranks with further `options` of PETSc.
pub fn choices(case: &Case, ranks: usize, options: &[String]) -> Vec<manifest::ManifestChoice> {
    let mut choices = Vec::new();
    if case.geometry == Geometry::Axisymmetric {
        let reason = "x is the radius. Histories and run.json are of the whole circle (N, J, kg, m3); the volumes of material \
                      points in frames are per radian. A point load is the total of its ring";
        choices.push(choice("geometry", "axisymmetric", reason));
    }
    if case.flow.is_some() && case.solver.nonlinear == bsmpm_scene::Nonlinear::Auto {
        let reason = "coupled flow: quasi-Newton with multiple secants on soil and water in turn (fixed-stress split); Newton's \
                      method if it does not converge; then shorter steps";
        choices.push(choice("solver.nonlinear", "multisecant, newton", reason));
    } else if case.solver.nonlinear == bsmpm_scene::Nonlinear::Auto {
        let reason = "quasi-Newton with multiple secants, based on the stiffness of the predictor; Newton's method if it stalls; \
                      then shorter steps";
        choices.push(choice("solver.nonlinear", "multisecant, newton", reason));
    }
    if let Some(parts) = parts(case, ranks).filter(|parts| *parts > 1) {
        let reason = match case.grid.dims() {
            3 => "partition along x and then along y, which keeps the interfaces between ranks small",
            _ => "more ranks than columns of cells along x: the partition is along y, too",
        };
        choices.push(choice(
            "ranks",
            &format!("{} slabs of {parts} parts", ranks / parts),
            reason,
        ));
    }
    choices.extend(linear_choices(case, &linear(case, ranks, options), ranks, options));
    if weighting(case) == AverageWeight::Volume {
        choices.push(choice(
            "weights of averages",
            "volume",
            "materials differ in density, or some have none",
        ));
    }
    if case.footing.is_some() || !case.prescribed.is_empty() {
        let reason = "a multiple of the largest Young's modulus over the smallest cell. The traction is kept from step to step, so \
                      that the total slip is pressure / penalty";
        choices.push(choice(
            "penalty of rigid strips",
            &format!("{:.6e} Pa/m", penalty(case)),
            reason,
        ));
    }
    if let Some((length, size)) = smoothing(case, bsmpm_scene::model::nominal_steps(case)) {
        let reason = format!(
            "sqrt(steps (degree+1)/6) h of modified-f-bar for the nominal number of steps; the thinnest body has {size} m"
        );
        choices.push(choice("smoothing length", &format!("{length:.3e} m"), &reason));
    }
    choices
}

fn choice(key: &str, value: &str, reason: &str) -> manifest::ManifestChoice {
    manifest::ManifestChoice {
        key: key.into(),
        value: value.into(),
        reason: reason.into(),
    }
}

/// What the linear solver is chosen for.
fn linear_choices(case: &Case, linear: &Choice, ranks: usize, options: &[String]) -> Vec<manifest::ManifestChoice> {
    let is_open = |name: &str| !options.iter().any(|option| option == name);
    let newton = case.solver.nonlinear != bsmpm_scene::Nonlinear::Broyden;
    let mut rows = Vec::new();
    if linear.factor.is_some() && !linear.dissection && is_open("-pc_factor_mat_solver_type") {
        rows.push(choice(
            "pc_factor_mat_solver_type",
            "mumps",
            "options after -- select the solver of PETSc",
        ));
    }
    if linear.redundant && if linear.dissection { newton } else { is_open("-pc_type") } {
        let reason = "solver.reproducible: every rank factorises the whole system, because a parallel factorisation may not be \
                      reproducible to the bit";
        rows.push(choice(
            if linear.dissection { "newton_pc_type" } else { "pc_type" },
            "redundant",
            reason,
        ));
    }
    if case.solver.linear_on(ranks) != case.solver.linear && linear.dissection {
        rows.push(choice(
            "solver.linear",
            "direct",
            "spline multigrid works on one rank only",
        ));
    } else if case.solver.linear_on(ranks) != case.solver.linear {
        let reason = "solver.reproducible: multigrid on several ranks may not be reproducible to the bit; with false it takes fewer \
                      iterations";
        rows.push(choice("solver.linear", "incomplete-cholesky", reason));
    }
    if case.solver.reproducible && ranks > 1 && linear.whole_nodes() {
        rows.push(choice(
            "solver.reproducible",
            "false",
            "multigrid on several ranks may not be reproducible to the bit",
        ));
    }
    if linear.factor.as_deref() == Some("mumps") && !linear.dissection {
        rows.push(choice(
            "mat_mumps_icntl_7",
            "2",
            "ordering by minimum fill, the fastest for plane grids",
        ));
        rows.push(choice(
            "mat_mumps_icntl_14",
            "100",
            "the estimated workspace may be too small",
        ));
    }
    rows
}

/// Warnings of the case on so many ranks, and of what the program makes of it.
pub fn warnings(case: &Case, ranks: usize) -> Vec<String> {
    let mut warnings = case.warnings_on(ranks);
    if let Some((length, size)) =
        smoothing(case, bsmpm_scene::model::nominal_steps(case)).filter(|(length, size)| length > &(SMALL * size))
    {
        warnings.push(format!(
            "W0729: `modified-f-bar` averages strains over a length that reaches about {length:.2} m over all steps \
             (limit: {:.2} m). Results depend on the number of steps. Use `consistent-f-bar`.",
            SMALL * size
        ));
    }
    warnings
}

/// Part of a body's size beyond which the smoothing of all steps is reported.
const SMALL: f64 = 0.1;

/// Length (m) along which modified F-bar smooths in so many steps, and the thickness of the thinnest piece of connected
/// material (m).
fn smoothing(case: &Case, steps: u64) -> Option<(f64, f64)> {
    if case.stabilisation != Stabilisation::ModifiedFBar {
        return None;
    }
    Some((smoothing_length(case, steps as f64), case.thinnest()))
}

/// Length (m) along which so many passes of smoothing reach in the largest cells.
pub fn smoothing_length(case: &Case, passes: f64) -> f64 {
    smooth::length(
        case.grid.order,
        case.grid.axes.iter().map(GridAxis::longest).fold(0.0, f64::max),
        passes,
    )
}
