//! Converged state of a step.

use crate::error::Measures;
use crate::field::SecondBalance;
use crate::interactions::EquilibriumState;
use crate::kinematics::Kinematics;
use crate::solve::convergence::Convergence;
use crate::step::residual::Residual;
use crate::step::trial::DeformationIncrement;
use crate::tensor::Tensor;

/// A converged displacement with the quantities evaluated there.
#[derive(Clone, Debug)]
pub struct StepSolution<K: Kinematics<D>, const D: usize> {
    /// Nodal displacement (m).
    pub u: Vec<f64>,
    /// Nodal values of the second field; empty without one.
    pub p: Vec<f64>,
    /// Balance of the second field, if there is one.
    pub field: Option<SecondBalance>,
    /// Deformation increment under `u`.
    pub trial: DeformationIncrement<K, D>,
    /// Nodal force of the supports on the body (N).
    pub reaction: Vec<f64>,
    /// Convergence measures of every iteration.
    pub history: Vec<Measures>,
    /// Measures that met the criteria; `None` if the state was in equilibrium before any direction was known.
    pub judged: Option<Measures>,
    /// Force measure (-).
    pub force: f64,
    /// Reference force of the force measure, a norm over all nodes (N).
    pub scale: f64,
    /// |du_0 . f_0| (N m), the reference of all energies; `None` if no direction was needed.
    pub first_energy: Option<f64>,
    /// Sum of the magnitudes of the works of all internal forces (J), with an artificial stiffness.
    pub work: f64,
    /// Number of Newton iterations.
    pub newton_iterations: usize,
    /// Whether only the force criterion was met.
    pub settled: bool,
    /// Whether the iteration converged from the first guess.
    pub first_guess: bool,
}

impl<K: Kinematics<D>, const D: usize> StepSolution<K, D> {
    /// Returns the state as interactions see it. `dF` is the deformation increment of a material point (-).
    pub fn state<'a>(&'a self, dF: &'a dyn Fn(usize) -> Tensor) -> EquilibriumState<'a> {
        EquilibriumState {
            u: &self.u,
            reaction: &self.reaction,
            dF,
            scale: self.scale,
            internal_work: self.work,
        }
    }

    /// Collects the state that an iteration reached. `u` contains displacements, followed by the values of a
    /// second field.
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
            field: balance.field,
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
