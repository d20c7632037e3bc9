//! Convergence criteria, theory-manual equations (T5.15), (T5.16), and early termination of slow iterations.

use crate::error::{Measures, SolveError, StepError, WorstNode};
use crate::kinematics::Kinematics;
use crate::method::Criteria;
use crate::method::Method;
use crate::nodal::Nodal;
use crate::solve::round_off::RoundOff;
use crate::step::problem::Problem;
use crate::step::residual::{Balance, Residual};
use crate::tensor::Vector;

/// A first residual this much below the force tolerance needs no direction: |du_0 . f_0| would only be noise.
const ALREADY: f64 = 1e-2;
/// Forces this much below their tolerance are enough where no method leads on: the states of steps that meet both
/// criteria have such forces (0.01 to 0.07 of the tolerance in a wall's active wedge, 0.5 at most), so that none is
/// balanced worse.
const SETTLED: f64 = 1e-1;
/// Iterations over which the rate of convergence is taken.
const WINDOW: usize = 20;
/// Iterations that a quasi-Newton method may still need to be left going: about the cost of the exact iterations that
/// would replace them.
const PATIENCE: f64 = 60.0;

/// Nodes that an error names.
const WORST: usize = 5;

/// Both measures over the iterations that started from one guess.
#[derive(Clone, Debug)]
pub struct Convergence {
    criteria: Criteria,
    round_off: RoundOff,
    first_energy: Option<f64>, // N m  |du_0 . f_0|
    history: Vec<Measures>,
    settled: Option<Vec<f64>>, // m, nodal
}

impl Convergence {
    /// Nothing iterated yet.
    pub fn new<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>) -> Self {
        let criteria = problem.model.criteria;
        let round_off = RoundOff::of(problem);
        let first_energy = problem.nodes.contacts.first_energy;
        Self {
            criteria,
            round_off,
            first_energy,
            history: Vec::new(),
            settled: None,
        }
    }

    /// Whether a state is in equilibrium before any direction is known: a guess far below the force tolerance, or
    /// forces that no node has further out of balance than by round-off.
    pub fn is_balanced<K, const D: usize>(&self, balance: &Balance, problem: &Problem<'_, K, D>) -> bool {
        let water = self.water(balance).unwrap_or(0.0);
        (self.history.is_empty()
            && self.measure(balance) <= ALREADY * self.criteria.force
            && water <= ALREADY * self.criteria.water())
            || (self.round_off.covers(balance, problem) && water == 0.0)
    }

    /// The first state whose forces balanced far below their tolerance, m, nodal: later ones only wander from it where
    /// the stiffness is next to singular.
    pub fn settled(&self) -> Option<&Vec<f64>> {
        self.settled.as_ref()
    }

    /// The force measure: the largest of the whole and of every material.
    pub fn measure(&self, balance: &Balance) -> f64 {
        self.round_off.measure(balance).0
    }

    /// The measure of the water, where it flows: what is out of balance over what is stored, flows or leaves.
    pub fn water(&self, balance: &Balance) -> Option<f64> {
        balance
            .water
            .as_ref()
            .map(|water| water.measure(self.round_off.of_water()))
    }

    /// Norm of what is round-off in the forces, N.
    pub fn round_off(&self) -> f64 {
        self.round_off.norm()
    }

    /// Whether any direction has been measured yet.
    pub fn has_begun(&self) -> bool {
        self.first_energy.is_some()
    }

    /// |du_0 . f_0|, if any direction has been measured yet, N m.
    pub fn first_energy(&self) -> Option<f64> {
        self.first_energy
    }

    /// |du_0 . f_0|, which the later energies are measured by.
    pub fn begin(&mut self, energy: f64) {
        self.first_energy = Some(energy);
    }

    /// Takes the measures of a state `u` and the direction that `method` found there; whether both criteria hold.
    pub fn reaches(&mut self, method: Method, energy: f64, u: &[f64], balance: &Balance) -> bool {
        let energy = energy / self.first_energy.unwrap_or(f64::INFINITY);
        let force = self.measure(balance);
        let water = self.water(balance);
        self.history.push(Measures {
            energy,
            force,
            water,
            method,
        });
        let far_below = water.is_none_or(|water| water <= SETTLED * self.criteria.water());
        if self.settled.is_none() && force <= SETTLED * self.criteria.force && far_below {
            self.settled = Some(u.to_vec());
        }
        let is_dry_or_balanced = water.is_none_or(|water| water < self.criteria.water());
        energy < self.criteria.energy && force < self.criteria.force && is_dry_or_balanced
    }

    /// The measures so far.
    pub fn history(&self) -> &[Measures] {
        &self.history
    }

    /// Iterations measured.
    pub fn iterations(&self) -> usize {
        self.history.len()
    }

    /// Whether, at the rate of the last iterations, convergence is out of reach.
    pub fn stalls(&self) -> bool {
        let Some(before) = self.history.len().checked_sub(WINDOW) else {
            return false;
        };
        let then = self.least_excess(before.max(1));
        let now = self.least_excess(self.history.len());
        let per_iteration = (then / now).ln() / WINDOW as f64;
        now.ln() > PATIENCE * per_iteration
    }

    /// The least of the first `count` iterations' measures over their criteria.
    fn least_excess(&self, count: usize) -> f64 {
        self.history[..count]
            .iter()
            .map(|m| (m.energy / self.criteria.energy).max(m.force / self.criteria.force))
            .fold(f64::INFINITY, f64::min)
    }

    /// How many of the iterations were Newton's.
    pub fn by_newton(&self) -> usize {
        self.history
            .iter()
            .filter(|measures| measures.method == Method::Newton)
            .count()
    }

    /// The error of an iteration that ended at `residual`; `unsolved` where no direction was found there.
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

/// |du_0 . (f_0 - K_strips du_0)|: the energy of the first direction without that of the penalty of strips and
/// rigid bodies, which takes up their motion in it and would make the measure as much too lenient as the penalty is
/// stiff. `work`: du_0 . f_0.
pub fn first_energy<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, du: &[f64], work: f64) -> f64 {
    let rigid = &problem.nodes.rigid;
    if problem.model.boundary.strips.is_empty() && rigid.is_empty() {
        return work.abs();
    }
    let mut du = du.to_vec();
    problem.nodes.extend(&problem.model.grid, &mut du, problem.halo);
    let mut penalty = problem.attachments.energy(&du);
    penalty += &rigid.energy(&du, problem.halo);
    let penalty = problem.halo.reproducible_sum(&[penalty]);
    (work - penalty[0]).abs()
}

/// The error of a state in which points have inverted, or have no pores left.
pub fn inverted<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    residual: &Residual<K, D>,
    iteration: usize,
) -> StepError {
    if let Some(water) = residual.balance.water.as_ref().filter(|water| water.closed > 0)
        && residual.balance.inverted == 0
    {
        return StepError::Closed {
            count: water.closed,
            iteration,
        };
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

/// This rank's own nodes whose forces are the least balanced, worst first.
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
