//! Converged state of a step.

use crate::error::Measures;
use crate::kinematics::Kinematics;
use crate::solve::convergence::Convergence;
use crate::step::residual::Residual;
use crate::step::trial::DeformationIncrement;
use crate::water::residual::WaterBalance;

/// A converged displacement.
#[derive(Clone, Debug)]
pub struct StepSolution<K: Kinematics<D>, const D: usize> {
    /// m, nodal
    pub u: Vec<f64>,
    /// Pa, nodal  excess pore pressure, where water flows
    pub p: Vec<f64>,
    /// balance of the water, where it flows
    pub water: Option<WaterBalance>,
    /// deformation under `u`
    pub trial: DeformationIncrement<K, D>,
    /// N  force of the supports on the body, nodal
    pub reaction: Vec<f64>,
    /// both measures of every iteration
    pub history: Vec<Measures>,
    /// the measures that it was accepted by; none of a state that was in balance before any direction was known
    pub judged: Option<Measures>,
    /// force measure
    pub force: f64,
    /// N  largest force, norm of all nodes
    pub scale: f64,
    /// N m  |du_0 . f_0|, which energies were measured by; none where no direction was needed
    pub first_energy: Option<f64>,
    /// J  magnitudes of the works of all internal forces, with a background
    pub work: f64,
    /// Newton iterations
    pub newton_iterations: usize,
    /// whether the forces alone decided
    pub settled: bool,
    /// whether the first guess led here
    pub first_guess: bool,
}

impl<K: Kinematics<D>, const D: usize> StepSolution<K, D> {
    /// The state that an iteration reached: displacements, and pressures behind them where water flows.
    pub fn new(mut u: Vec<f64>, residual: Residual<K, D>, convergence: &Convergence) -> Self {
        let newton_iterations = convergence.by_newton();
        let force = convergence.measure(&residual.balance);
        let work = residual.balance.work;
        let scale = residual.balance.scale;
        let Residual { trial, balance, .. } = residual;
        let history = convergence.history().to_vec();
        let reaction = balance.reaction;
        let first_energy = convergence.first_energy();
        let p = u.split_off(reaction.len());
        let judged = history.last().copied().filter(|last| last.force == force);
        Self {
            u,
            p,
            water: balance.water,
            trial,
            reaction,
            history,
            judged,
            force,
            scale,
            first_energy,
            work,
            newton_iterations,
            settled: false,
            first_guess: true,
        }
    }
}
