//! Steps (6), (7): directions from one factorised stiffness K_0 and what the iteration has seen of the true one.

use crate::error::SolveError;
use crate::seam::{Halo, LinearSolver, dots};
use crate::step::broyden::Broyden;
use crate::step::multisecant::Multisecant;

/// How the elastic stiffness is corrected from iteration to iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum QuasiNewton {
    /// All recent secants in the least-squares sense (Anderson, 1965).
    #[default]
    Multisecant,
    /// The paper's rank-one update (Broyden, 1965).
    Broyden,
}

/// A direction and the linear iterations that it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// m, nodal
    pub du: Vec<f64>,
    /// |du . f|, N m
    pub energy: f64,
    /// iterations of the linear solver
    pub linear_iterations: usize,
}

/// The state of one iteration; both methods cost one solve with K_0 a direction.
#[derive(Clone, Debug)]
pub enum Secants {
    /// see [`Multisecant`]
    Multisecant(Multisecant),
    /// see [`Broyden`]
    Broyden(Broyden),
}

impl Secants {
    /// Nothing seen yet.
    pub fn new(method: QuasiNewton) -> Self {
        match method {
            QuasiNewton::Multisecant => Self::Multisecant(Multisecant::default()),
            QuasiNewton::Broyden => Self::Broyden(Broyden::default()),
        }
    }

    /// Direction du = H f for the out-of-balance force `f`, `D` components a node.
    pub fn direction<const D: usize>(
        &mut self,
        f: &[f64],
        halo: &dyn Halo,
        solver: &mut dyn LinearSolver,
    ) -> Result<Direction, SolveError> {
        let mut w = vec![0.0; f.len()];
        let linear_iterations = solver.solve(f, &mut w)?;
        let du = match self {
            Self::Multisecant(secants) => secants.correct::<D>(w, f, halo),
            Self::Broyden(secants) => secants.correct::<D>(w, halo),
        };
        let energy = dots(halo, D, &[(&du, f)])[0].abs();
        Ok(Direction { du, energy, linear_iterations })
    }

    /// Tells how much of the last direction was taken: 1 for a full step.
    pub fn took(&mut self, length: f64) {
        match self {
            Self::Multisecant(secants) => secants.took(length),
            Self::Broyden(secants) => secants.took(length),
        }
    }
}
