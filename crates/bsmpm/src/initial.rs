//! Initial stress on the drawn geometry, theory-manual equations (T9.1), (T9.2); stress after a stage has changed the
//! constitutive law.

mod settle;

use crate::material::Moduli;
use crate::points::MappedPoints;
use crate::schedule::TimeInterval;
pub use settle::{EquilibriumSearchReport, set_spread, settle};

use crate::error::StepError;
use crate::grid::{Shape, transfer};
use crate::interactions::state::InteractionState;
use crate::interactions::strip::StripReport;
use crate::interactions::{EquilibriumState, InteractionReports};
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::material::{Branch, Elastic, Material, Separation};
use crate::model::Model;
use crate::parallel::{Halo, agreed};
use crate::points::{PackedTensors, Points};
use crate::solve::found::StepSolution;
use crate::solve::round_off::RoundOff;
use crate::solve::{Backend, contact};
use crate::step::Counts;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;
use crate::step::residual::{Balance, Residual};
use crate::step::stiffness;
use crate::tensor::{Symmetric, Tensor, Vector};

/// Corrections of the elastic state: the stiffness includes the artificial one, which must carry nothing in the end.
const CORRECTIONS: usize = 20;
/// Relative residual of each correction.
const SOLVED: f64 = 1e-6;
/// Plastic strain up to which a returned stress counts as lying on the yield surface.
const ON: f64 = 1e-12;
/// Relative out-of-balance force at which the elastic state is accepted.
const BALANCED: f64 = 1e-12;

/// Quality of the equilibrium at the start, and the forces that hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// |f_oob| / max(|f_ext|, |f_int|, |reaction|) (-).
    pub force: f64,
    /// Points whose stress lies outside the yield surface, over all ranks.
    pub yielding: u64,
    /// Force of each support on the body (N), by component, in the order of the model's supports.
    pub reactions: Vec<Vec<f64>>,
    /// Reports of the rigid strips.
    pub strips: Vec<StripReport>,
}

/// Gives every point the Cauchy stress `sigma(material, x)` (Pa), with x in m from the grid's lower corner. In two
/// dimensions the shear stresses out of the plane must be zero.
pub fn set_stress<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    sigma: impl Fn(u16, &Vector<D>) -> Symmetric,
) {
    for p in 0..points.len() {
        let stress = sigma(points.material[p], &points.x[p]);
        assert!(
            PackedTensors::<D, Symmetric>::holds(&stress),
            "a stress at the start leaves the plane: {stress:?}"
        );
        let law = model.materials[usize::from(points.material[p])].at(points.height(p));
        let state = points.state.as_mut().map_or(&mut [][..], |state| state.of_point_mut(p));
        points.b_e.set(p, b_e_of(&law, &stress, state));
        points.sigma.set(p, stress);
    }
}

/// Changes the constitutive laws of the points from those of one model to those of another. A point with a new law
/// keeps its Kirchhoff stress; its elastic strain follows from the new law. The state variables of a law of another
/// kind are initialised. Fails on all ranks if the old law rejects a point.
pub fn exchange<K: Kinematics<D>, const D: usize>(
    before: &Model<K, D>,
    after: &Model<K, D>,
    points: &mut Points<D>,
    halo: &dyn Halo,
) -> Result<(), StepError> {
    agreed(halo, exchange_own(before, after, points), StepError::OtherRank)
}

/// Applies [`exchange`] to this rank's points.
fn exchange_own<K: Kinematics<D>, const D: usize>(
    before: &Model<K, D>,
    after: &Model<K, D>,
    points: &mut Points<D>,
) -> Result<(), StepError> {
    for p in 0..points.len() {
        let material = usize::from(points.material[p]);
        let [old, new] = [before, after].map(|model| model.materials[material].at(points.height(p)));
        if old == new {
            continue;
        }
        let response = before.respond(points, p, &points.b_e.at(p));
        let response = response.map_err(|source| StepError::Material {
            id: points.id[p],
            source,
        })?;
        let tau = response.tau();
        if new.separation() != Separation::Closing
            && let Some(gap) = &mut points.gap
        {
            gap[p] = 0.0;
        }
        let state = points.state.as_mut().map_or(&mut [][..], |state| state.of_point_mut(p));
        if old.state() != new.state() {
            state.fill(0.0);
        }
        if !old.is_linear() || old.elastic() != new.elastic() {
            points.b_e.set(p, b_e_of(&new, &tau, state));
        }
    }
    Ok(())
}

/// Returns the elastic left Cauchy-Green tensor of a Cauchy stress (Pa) in the undeformed configuration, and replaces
/// the zeros in `state` by the state of `law`. NaN if the law does not admit the stress.
pub fn b_e_of(law: &Material, stress: &Symmetric, state: &mut [f64]) -> Symmetric {
    if law.is_linear() {
        return exponential(&strain_of(law.elastic(), stress));
    }
    let spectrum = stress.full().symmetric_eigen();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| spectrum.eigenvalues[b].total_cmp(&spectrum.eigenvalues[a]));
    let strain = law.initial_state(axes.map(|k| spectrum.eigenvalues[k]), state);
    let dyads = axes.iter().zip(strain).map(|(&k, eps)| {
        let axis = spectrum.eigenvectors.column(k);
        axis * axis.transpose() * (2.0 * eps).exp()
    });
    Symmetric::of(&dyads.sum::<Tensor>())
}

/// Gives every point the stress of linear elastic equilibrium under the loads at time 0. Fails if the system cannot be
/// solved, a load has no material, or the run is interrupted.
pub fn set_elastic<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    state: &mut InteractionState<D>,
    halo: &dyn Halo,
    solver: &mut dyn LinearSolver,
) -> Result<(), StepError> {
    let model = &model.settling();
    let start = UndeformedState::of(model, points, state, halo)?;
    let problem = start.problem(model, points, halo);
    stiffness::factorise(&problem, None, solver)?;
    let mut u = vec![0.0; model.grid.nodes() * D];
    let mut du = u.clone();
    let mut strains = vec![Symmetric::default(); points.len()];
    for _ in 0..CORRECTIONS {
        let residual = elastic_residual(&problem, &strains, &u);
        if residual.measure() <= BALANCED {
            break;
        }
        if halo.is_interrupted() {
            return Err(StepError::Interrupted);
        }
        solver.solve_to(SOLVED, &residual.f_oob, &mut du)?;
        u.iter_mut().zip(&du).for_each(|(u, du)| *u += du);
        start.nodes.constraints.extend(&model.grid, &mut u, halo);
        strains = transfer::gradients::<K, D, _>(&start.shape, &points.x, &u, |_, grad| {
            Symmetric::of(&K::gradient::<f64>(&grad))
        });
    }
    let reaction = vec![0.0; u.len()];
    start.finish(model, points, state, &u, &reaction, halo);
    for (p, strain) in strains.iter().enumerate() {
        points.b_e.set(p, exponential(strain));
        points.sigma.set(p, stress_of(&elastic_at(model, points, p), strain));
    }
    Ok(())
}

/// Finds the forces on absorbing faces that keep the initial state in equilibrium; they remain applied. They belong to
/// the equilibrium nearest to the given stress, which is balanced only up to the quadrature of the points. Without this
/// correction, a body that only dashpots support would drift. Fails if there is no equilibrium.
pub fn hold<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    state: &mut InteractionState<D>,
    halo: &dyn Halo,
    solver: &mut dyn LinearSolver,
) -> Result<(), StepError> {
    hold_at(model, points, state, 0.0, halo, solver)
}

/// Finds the forces as [`hold`], at a later time `t` (s) after the soil or its loads have changed.
pub fn hold_at<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    state: &mut InteractionState<D>,
    t: f64,
    halo: &dyn Halo,
    solver: &mut dyn LinearSolver,
) -> Result<(), StepError> {
    if model.boundary.absorbing().next().is_none() {
        return Ok(());
    }
    let at_rest = &model.at_rest();
    let mut start = UndeformedState::at(at_rest, points, state, t, halo)?;
    let backend = &mut Backend {
        halo,
        solver,
        counts: &mut Counts::default(),
    };
    let found = start.find(at_rest, points, backend)?;
    state.held = model.boundary.held(&model.grid, &found.reaction, halo);
    Ok(())
}

/// Evaluates the equilibrium of the points under the loads at time 0. Fails on all ranks if a law rejects the strain of
/// a point.
pub fn balance<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    state: &InteractionState<D>,
    halo: &dyn Halo,
) -> Result<Equilibrium, StepError> {
    let model = &model.at_rest();
    let counted = (0..points.len()).try_fold(0.0, |sum, p| {
        let yields = yields(model, points, p)?;
        Ok(sum + f64::from(u32::from(yields)))
    });
    let mut yielding = [agreed(halo, counted, StepError::OtherRank)?];
    let start = UndeformedState::of(model, points, state, halo)?;
    let at_rest = vec![0.0; model.grid.nodes() * D];
    let balance = Residual::of(&start.problem(model, points, halo), &at_rest).balance;
    halo.all_reduce_sum(&mut yielding);
    let reactions = model.boundary.reactions(&model.grid, &balance.reaction, halo);
    let mut after = state.clone();
    let reports = start.finish(model, points, &mut after, &at_rest, &balance.reaction, halo);
    Ok(Equilibrium {
        force: balance.measure(),
        yielding: yielding[0] as u64,
        reactions,
        strips: reports.strips,
    })
}

/// Returns whether the stress of a point lies outside the yield surface.
fn yields<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    p: usize,
) -> Result<bool, StepError> {
    let response = model.respond(points, p, &points.b_e.at(p));
    let response = response.map_err(|source| StepError::Material {
        id: points.id[p],
        source,
    })?;
    Ok(response.branch() != Branch::Elastic && response.plastic_increment() > ON)
}

/// Returns whether the forces at time 0 are out of balance by more than the tolerance and round-off.
pub fn is_pushed<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    state: &InteractionState<D>,
    halo: &dyn Halo,
) -> Result<bool, StepError> {
    let shaking = model.shaking.clone();
    let model = &Model {
        shaking,
        ..model.at_rest()
    };
    let start = UndeformedState::of(model, points, state, halo)?;
    let problem = start.problem(model, points, halo);
    let balance = Residual::of(&problem, &vec![0.0; model.grid.nodes() * D]).balance;
    Ok(balance.measure() > model.criteria.force && !RoundOff::of(&problem).covers(&balance, &problem))
}

/// Steps (1) and (2) at a given time, without motion.
struct UndeformedState<const D: usize> {
    shape: Shape<D>,
    nodes: GridState<D>,
}

impl<const D: usize> UndeformedState<D> {
    fn of<K: Kinematics<D>>(
        model: &Model<K, D>,
        points: &Points<D>,
        state: &InteractionState<D>,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        Self::at(model, points, state, 0.0, halo)
    }

    fn at<K: Kinematics<D>>(
        model: &Model<K, D>,
        points: &Points<D>,
        state: &InteractionState<D>,
        t: f64,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let shape = agreed(halo, Shape::at(&model.grid, points), StepError::OtherRank)?;
        let instant = TimeInterval { start: t, dt: 0.0 };
        let nodes = GridState::from_points(model, &shape, points, state, instant, halo)?;
        Ok(Self { shape, nodes })
    }

    /// Writes the forces that the equilibrium under the displacement `u` (m) has given the interactions into their
    /// `state`, and returns their results.
    fn finish<K: Kinematics<D>>(
        &self,
        model: &Model<K, D>,
        points: &Points<D>,
        state: &mut InteractionState<D>,
        u: &[f64],
        reaction: &[f64],
        halo: &dyn Halo,
    ) -> InteractionReports {
        let context = self.nodes.context(model, &self.shape, points, halo);
        let mut reports = InteractionReports::default();
        let at = EquilibriumState {
            u,
            reaction,
            dF: &|_| Tensor::identity(),
            scale: 0.0,
            internal_work: 0.0,
        };
        for interaction in self.nodes.interactions.iter() {
            interaction.finish_start(&context, &at, state, &mut reports);
        }
        reports
    }

    /// Finds the equilibrium of the points from zero displacement.
    fn find<K: Kinematics<D>>(
        &mut self,
        model: &Model<K, D>,
        points: &Points<D>,
        backend: &mut Backend<'_>,
    ) -> Result<StepSolution<K, D>, StepError> {
        let shape = &self.shape;
        let mapped = MappedPoints { shape, points };
        let guess = vec![0.0; model.grid.nodes() * D];
        contact::find(model, mapped, &mut self.nodes, &guess, backend)
    }

    fn problem<'a, K>(
        &'a self,
        model: &'a Model<K, D>,
        points: &'a Points<D>,
        halo: &'a dyn Halo,
    ) -> Problem<'a, K, D> {
        Problem {
            model,
            shape: &self.shape,
            nodes: &self.nodes,
            points,
            halo,
        }
    }
}

/// Returns the out-of-balance force of linear elastic stress on the undeformed geometry.
fn elastic_residual<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    strains: &[Symmetric],
    u: &[f64],
) -> Balance {
    let volume = problem.volume();
    let f_int = transfer::divergence::<K, D>(problem.shape, &problem.points.x, |p| {
        let tau = stress_of(&elastic_at(problem.model, problem.points, p), &strains[p]);
        K::flux(&tau, &Tensor::identity()) * volume[p]
    });
    Balance::of(
        problem,
        u,
        &|_| Tensor::identity(),
        problem.halo.assemble_ghosts(&f_int),
        0,
    )
}

fn elastic_at<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, points: &Points<D>, p: usize) -> Elastic {
    model.materials[usize::from(points.material[p])]
        .at(points.height(p))
        .elastic()
        .clone()
}

/// Returns D eps = lambda tr(eps) I + 2 mu eps (Pa).
fn stress_of(elastic: &Elastic, strain: &Symmetric) -> Symmetric {
    let Moduli { lambda, mu } = elastic.moduli();
    let [xx, yy, zz, ..] = strain.0;
    let mut stress = strain.scaled(2.0 * mu);
    stress.0[..3]
        .iter_mut()
        .for_each(|normal| *normal += lambda * (xx + yy + zz));
    stress
}

/// Returns D^-1 sigma = (1 + nu)/E sigma - nu/E tr(sigma) I.
fn strain_of(elastic: &Elastic, stress: &Symmetric) -> Symmetric {
    let [xx, yy, zz, ..] = stress.0;
    let mut strain = stress.scaled((1.0 + elastic.poisson) / elastic.young);
    strain.0[..3]
        .iter_mut()
        .for_each(|normal| *normal -= elastic.poisson / elastic.young * (xx + yy + zz));
    strain
}

/// Returns b^e = exp(2 eps).
fn exponential(strain: &Symmetric) -> Symmetric {
    let spectrum = strain.full().symmetric_eigen();
    let stretches = Tensor::from_diagonal(&spectrum.eigenvalues.map(|eps| (2.0 * eps).exp()));
    Symmetric::of(&(spectrum.eigenvectors * stretches * spectrum.eigenvectors.transpose()))
}
