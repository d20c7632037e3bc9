//! Convergence criteria, theory-manual equations (T5.15), (T5.16), and early termination of slow iterations.

use crate::error::{Measures, SolveError, StepError, WorstNode};
use crate::exact::Exact;
use crate::field::FieldBalance;
use crate::kinematics::Kinematics;
use crate::method::Criteria;
use crate::method::Method;
use crate::nodal::Nodal;
use crate::solve::round_off::RoundOff;
use crate::step::problem::Problem;
use crate::step::residual::{Balance, Residual};
use crate::tensor::Vector;

/// Fraction of the force tolerance below which an initial state needs no direction: |du_0 . f_0| would be noise.
const ALREADY: f64 = 1e-2;
/// Fraction of the force tolerance at which forces alone suffice if no method makes progress. States that meet both
/// criteria have 0.01 to 0.07 of the tolerance (in the active wedge behind a wall; 0.5 at most), so that no accepted
/// state is balanced worse.
const SETTLED: f64 = 1e-1;
/// Iterations over which the rate of convergence is measured.
const WINDOW: usize = 20;
/// Expected further iterations up to which a quasi-Newton method is continued: about the cost of the Newton iterations
/// that would replace them.
const PATIENCE: f64 = 60.0;

/// Number of nodes that an error lists.
const WORST: usize = 5;

/// Convergence measures of all iterations from one guess.
#[derive(Clone, Debug)]
pub struct Convergence {
    criteria: Criteria,
    round_off: RoundOff,
    first_energy: Option<f64>, // |du_0 . f_0| (N m)
    history: Vec<Measures>,
    settled: Option<Vec<f64>>, // nodal displacement (m)
}

impl Convergence {
    /// Starts without iterations. `first_energy` is |du_0 . f_0| of the step's first iteration (N m), if statuses have
    /// changed since: it remains the reference of all energies.
    pub fn new<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, first_energy: Option<f64>) -> Self {
        let criteria = problem.model.criteria;
        let round_off = RoundOff::of(problem);
        Self {
            criteria,
            round_off,
            first_energy,
            history: Vec::new(),
            settled: None,
        }
    }

    /// Returns whether a state is in equilibrium before any direction is known: the initial guess is far below the
    /// force tolerance, or at every node the out-of-balance force is round-off.
    pub fn is_balanced<K, const D: usize>(&self, balance: &Balance, problem: &Problem<'_, K, D>) -> bool {
        let field = self.field(balance).unwrap_or(0.0);
        (self.history.is_empty()
            && self.measure(balance) <= ALREADY * self.criteria.force
            && field <= ALREADY * self.criteria.second_field())
            || (self.round_off.covers(balance, problem) && field == 0.0)
    }

    /// Returns the first displacement whose forces balanced far below their tolerance (m, nodal). Later states only
    /// drift away from it where the stiffness is nearly singular.
    pub fn settled(&self) -> Option<&Vec<f64>> {
        self.settled.as_ref()
    }

    /// Returns the force measure (-): the largest of all nodes together and of every material's own nodes.
    pub fn measure(&self, balance: &Balance) -> f64 {
        self.round_off.measure(balance).0
    }

    /// Returns the measure of the second field (-), if there is one, see [`FieldBalance::measure`].
    pub fn field(&self, balance: &Balance) -> Option<f64> {
        let field = balance.field.as_ref()?;
        Some(field.measure(self.round_off.of_field()))
    }

    /// Returns the norm of the round-off of the forces (N).
    pub fn round_off(&self) -> f64 {
        self.round_off.norm()
    }

    /// Returns whether any direction has been measured.
    pub fn has_begun(&self) -> bool {
        self.first_energy.is_some()
    }

    /// Returns |du_0 . f_0| (N m), if any direction has been measured.
    pub fn first_energy(&self) -> Option<f64> {
        self.first_energy
    }

    /// Sets |du_0 . f_0| (N m), the reference of all later energies.
    pub fn begin(&mut self, energy: f64) {
        self.first_energy = Some(energy);
    }

    /// Records the measures of a state `u` and of the direction that `method` found there. Returns whether all criteria
    /// are met.
    pub fn reaches(&mut self, method: Method, energy: f64, u: &[f64], balance: &Balance) -> bool {
        let energy = energy / self.first_energy.unwrap_or(f64::INFINITY);
        let force = self.measure(balance);
        let field = self.field(balance);
        self.history.push(Measures {
            energy,
            force,
            water: field,
            method,
        });
        let far_below = field.is_none_or(|field| field <= SETTLED * self.criteria.second_field());
        if self.settled.is_none() && force <= SETTLED * self.criteria.force && far_below {
            self.settled = Some(u.to_vec());
        }
        let is_balanced = field.is_none_or(|field| field < self.criteria.second_field());
        energy < self.criteria.energy && force < self.criteria.force && is_balanced
    }

    /// Returns the measures so far.
    pub fn history(&self) -> &[Measures] {
        &self.history
    }

    /// Returns the number of iterations measured.
    pub fn iterations(&self) -> usize {
        self.history.len()
    }

    /// Returns whether convergence is out of reach at the rate of the last iterations.
    pub fn stalls(&self) -> bool {
        let Some(before) = self.history.len().checked_sub(WINDOW) else {
            return false;
        };
        let then = self.least_excess(before.max(1));
        let now = self.least_excess(self.history.len());
        let per_iteration = (then / now).ln() / WINDOW as f64;
        now.ln() > PATIENCE * per_iteration
    }

    /// Returns the smallest ratio of measure to criterion among the first `count` iterations.
    fn least_excess(&self, count: usize) -> f64 {
        self.history[..count]
            .iter()
            .map(|m| (m.energy / self.criteria.energy).max(m.force / self.criteria.force))
            .fold(f64::INFINITY, f64::min)
    }

    /// Returns the number of Newton iterations.
    pub fn by_newton(&self) -> usize {
        self.history
            .iter()
            .filter(|measures| measures.method == Method::Newton)
            .count()
    }

    /// Creates the error of an iteration that ended at `residual`; `unsolved` if no direction was found there.
    pub fn failed<K: Kinematics<D>, const D: usize>(
        &self,
        problem: &Problem<'_, K, D>,
        residual: &Residual<K, D>,
        unsolved: Option<SolveError>,
    ) -> StepError {
        let (force, material) = self.round_off.measure(&residual.balance);
        StepError::NotConverged {
            iterations: self.history.len(),
            energy: self.history.last().map_or(f64::INFINITY, |measures| measures.energy),
            force,
            material,
            criteria: Box::new(self.criteria),
            history: self.history.clone(),
            worst: worst_nodes(problem, &residual.balance),
            unsolved,
        }
    }
}

/// Returns |du_0 . (f_0 - K_p du_0)| (N m), the energy of the first direction without the penalty energy of footings
/// and rigid bodies, whose prescribed motion is in this direction. With the penalty energy the criterion would be too
/// lenient by the ratio of the penalty to the stiffness. `work` is du_0 . f_0.
pub fn first_energy<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, du: &[f64], work: f64) -> f64 {
    let interactions = &problem.nodes.interactions;
    if !interactions.has_penalty() {
        return work.abs();
    }
    let mut du = du.to_vec();
    problem
        .nodes
        .constraints
        .extend(&problem.model.grid, &mut du, problem.halo);
    let mut penalty = Exact::ZERO;
    for interaction in interactions.iter() {
        penalty += &interaction.penalty_energy(&du, problem.halo);
    }
    let penalty = problem.halo.reproducible_sum(&[penalty]);
    (work - penalty[0]).abs()
}

/// Creates the error of a state in which points have inverted, or have no admissible state of the second field.
pub fn inverted<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    residual: &Residual<K, D>,
    iteration: usize,
) -> StepError {
    let of_field = residual.balance.field.as_ref().and_then(|field| field.error(iteration));
    if let Some(error) = of_field.filter(|_| residual.balance.inverted == 0) {
        return error;
    }
    let first = residual
        .first_inverted
        .map(|p| (problem.points.id[p], problem.points.x[p].as_slice().to_vec()));
    StepError::Inverted {
        count: residual.balance.inverted,
        iteration,
        first,
    }
}

/// Returns this rank's own nodes with the largest out-of-balance forces, in descending order.
pub fn worst_nodes<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, balance: &Balance) -> Vec<WorstNode> {
    let grid = &problem.model.grid;
    let force = |node: usize| Vector::<D>::from_column_slice(&balance.f_oob[Nodal::<D>::of(node)]).norm();
    let mut nodes: Vec<usize> = problem.halo.owned().nodes().filter(|&node| force(node) > 0.0).collect();
    nodes.sort_by(|&a, &b| force(b).total_cmp(&force(a)));
    let mut worst = Vec::new();
    for node in nodes.into_iter().take(WORST) {
        let place = grid.node_at(node);
        worst.push(WorstNode {
            number: grid.number_of(node) as u64,
            x: (0..D).map(|axis| grid.axes()[axis].greville(place[axis])).collect(),
            force: force(node),
        });
    }
    worst
}
