//! What a run needs of its case beside the model: the first cut, the linear solver, what is reported of it in the
//! manifest.

use bsmpm::error::StepError;
use bsmpm::initial::{Equilibrium, Settling};
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Weighting;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::smooth;
use bsmpm::tensor::Vector;
use bsmpm_io::manifest;
use bsmpm_ranks::linear::Choice;
use bsmpm_ranks::load;
use bsmpm_ranks::simulation::{Simulation, StartStress};
use bsmpm_ranks::slab::Slabs;
use bsmpm_scene::model::{at_rest, penalty, weighting};
use bsmpm_scene::words::{Factor, Word};
use bsmpm_scene::{Case, Geometry, GridAxis, Initial};
use std::ops::Range;

/// Cells along each axis that the ranks together see ([`bsmpm::grid::room`]), the slabs of them, and in how many parts
/// each of these is to be cut.
pub type Cut = (Vec<Range<usize>>, Slabs, usize);

/// A state at the start, and what leading it to equilibrium took, if the case wants that.
pub type Start = (Equilibrium, Option<Settling>);

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
    let counts: Vec<f64> = case.points_by_column()[room[0].clone()].iter().map(|&count| count as f64).collect();
    let layer_nodes = room[1..].iter().map(|cells| cells.len() + case.grid.order).product();
    let slabs = Slabs::cut(&load::by_column(&counts, layer_nodes), slabs)?.starting_at(room[0].start);
    Some((room, slabs, parts))
}

/// Parts of a slab at the start.
fn parts(case: &Case, ranks: usize) -> Option<usize> {
    let room = case.room([1; 2]);
    case.parts(ranks, [room[0].len(), room[1].len()])
}

/// The linear solver of a run on so many ranks with further `options` of PETSc.
pub fn linear(case: &Case, ranks: usize, options: &[String]) -> Choice {
    let linear = &case.solver.linear_on(ranks);
    let dissection = linear.factor == Some(DISSECTION);
    Choice {
        dissection: dissection && !options.iter().any(|option| decides(option)),
        ksp: linear.ksp.word().into(),
        pc: linear.pc.word().into(),
        factor: linear.factor.map(|package| if dissection { Factor::Mumps } else { package }.word().into()),
        // On one rank, too, where the matrix goes to PETSc: the same factorisation, bit by bit, on any number of ranks.
        applications: linear.applications,
        redundant: case.solver.reproducible && linear.pc.factorises() && (ranks > 1 || !dissection),
    }
}

/// The factorisation that is this program's own; PETSc and MUMPS do instead of it what it does not: general matrices.
const DISSECTION: Factor = Factor::Dissection;

/// Whether an option of PETSc is about a preconditioner or a matrix of PETSc's, which need the matrix assembled; those
/// of KSP, and of reports, are for any.
fn decides(option: &str) -> bool {
    ["-pc_", "-mat_", "-sub_", "-mg_", "-redundant_"].iter().any(|prefix| option.starts_with(prefix))
}

/// What the program chooses by itself in a run on so many ranks with further `options` of PETSc.
pub fn choices(case: &Case, ranks: usize, options: &[String]) -> Vec<manifest::ManifestChoice> {
    let choice = |key: &str, value: &str, reason: &str| manifest::ManifestChoice {
        key: key.into(),
        value: value.into(),
        reason: reason.into(),
    };
    let mut choices = Vec::new();
    if case.geometry == Geometry::Axisymmetric {
        let reason = "x is the radius: histories and this file are of the whole circle (N, J, kg, m3), 2 pi times what acts \
                      on a radian, of which frames have the points' volumes; a point load is all of its ring";
        choices.push(choice("geometry", "axisymmetric", reason));
    }
    if case.flow.is_some() && case.solver.nonlinear == bsmpm_scene::Nonlinear::Auto {
        let reason = "water that flows: all recent secants on both systems by turns (fixed stress); Newton's method with \
                      the complete derivative where they come to no end, preconditioned by both; then shorter steps";
        choices.push(choice("solver.nonlinear", "multisecant, newton", reason));
    } else if case.solver.nonlinear == bsmpm_scene::Nonlinear::Auto {
        let reason = "all recent secants on the stiffness at the first guess, in fewer iterations than Broyden's update; \
                      Newton's method with the complete derivative where they stall; then shorter steps";
        choices.push(choice("solver.nonlinear", "multisecant, newton", reason));
    }
    if let Some(parts) = parts(case, ranks).filter(|parts| *parts > 1) {
        let reason = match case.grid.dims() {
            3 => "slabs along x, each cut along y: so the largest face between two ranks is the least",
            _ => "more ranks than columns along x: slabs are cut along y, too",
        };
        choices.push(choice("ranks", &format!("{} slabs of {parts} parts", ranks / parts), reason));
    }
    choices.extend(linear_choices(case, &linear(case, ranks, options), ranks));
    if weighting(case) == Weighting::Volume {
        choices.push(choice("weights of averages", "volume", "materials differ in density, or some have none"));
    }
    if case.footing.is_some() || !case.prescribed.is_empty() {
        let reason = "E of the stiffest material over the smallest cell, times a factor; the traction is carried from step \
                      to step, so that the slips of all steps add up to pressure / penalty";
        choices.push(choice("penalty of rigid strips", &format!("{:.6e} Pa/m", penalty(case)), reason));
    }
    if let Some((length, size)) = smoothing(case, bsmpm_scene::model::nominal_steps(case)) {
        let reason = format!(
            "sqrt(steps (q+1)/6) h of modified-f-bar at the nominal steps; the thinnest connected material has {size} m"
        );
        choices.push(choice("smoothing length", &format!("{length:.3e} m"), &reason));
    }
    choices
}

/// What the linear solver is chosen for.
fn linear_choices(case: &Case, linear: &Choice, ranks: usize) -> Vec<manifest::ManifestChoice> {
    let newton = case.solver.nonlinear != bsmpm_scene::Nonlinear::Broyden;
    let mut rows = Vec::new();
    if case.solver.linear.factor == Some(DISSECTION) && !linear.dissection {
        rows.push(("solver.linear.factor", "mumps", "options after -- say how PETSc solves"));
    }
    if linear.redundant && (newton || !linear.dissection) {
        let reason = "solver.reproducible: every rank factorises the whole system, as a parallel factorisation need not \
                      repeat to the bit";
        rows.push((if linear.dissection { "newton_pc_type" } else { "solver.linear.pc" }, "redundant", reason));
    }
    if case.solver.linear_on(ranks) != case.solver.linear && linear.dissection {
        rows.push(("solver.linear", "direct", "multigrid over the grid's splines is for one rank"));
    } else if case.solver.linear_on(ranks) != case.solver.linear {
        let reason = "multigrid on several ranks need not repeat to the bit, as solver.reproducible wants; with false it takes \
                      fewer iterations";
        rows.push(("solver.linear", "incomplete-cholesky", reason));
    }
    if case.solver.reproducible && ranks > 1 && linear.whole_nodes() {
        rows.push(("solver.reproducible", "false", "multigrid on several ranks need not repeat to the bit"));
    }
    if linear.factor.as_deref() == Some("mumps") && !linear.dissection {
        rows.push(("mat_mumps_icntl_7", "2", "ordering by minimum fill, the cheapest for plane grids"));
        rows.push(("mat_mumps_icntl_14", "100", "the estimated workspace is at times too little"));
    }
    let owned = |(key, value, reason): (&str, &str, &str)| manifest::ManifestChoice {
        key: key.into(),
        value: value.into(),
        reason: reason.into(),
    };
    rows.into_iter().map(owned).collect()
}

/// Warnings of the case on so many ranks, and of what the program makes of it.
pub fn warnings(case: &Case, ranks: usize) -> Vec<String> {
    let mut warnings = case.warnings_on(ranks);
    if let Some((length, size)) =
        smoothing(case, bsmpm_scene::model::nominal_steps(case)).filter(|(length, size)| length > &(SMALL * size))
    {
        warnings.push(format!(
            "modified-f-bar smooths the elastic strain once a step, whatever the step's length: over all steps along about \
             {length:.2e} m, where the thinnest connected material has {size} m; results belong to their number of \
             steps"
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
    let longest = |axis: &GridAxis| (0..axis.cells()).map(|i| axis.cell(i)).fold(0.0, f64::max);
    smooth::length(case.grid.order, case.grid.axes.iter().map(longest).fold(0.0, f64::max), passes)
}
