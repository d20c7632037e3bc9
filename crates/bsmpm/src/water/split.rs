//! Solves for displacements and pore pressures by the fixed-stress split, theory-manual equation (T8.16): two symmetric
//! positive definite systems.

use crate::error::SolveError;
use crate::kinematics::Kinematics;
use crate::parallel::{LinearSolver, SolveReport};
use crate::step::problem::Problem;
use crate::water::nodes::PoreField;
use crate::water::residual::pressing;

/// A direction before secants, the forces that it balances, and what it took.
pub struct Split {
    /// m and Pa, nodal
    pub z: Vec<f64>,
    /// N and m3, nodal
    pub f: Vec<f64>,
    /// both systems
    pub solved: SolveReport,
}

impl Split {
    /// Of forces, N, and behind them what the water lacks, m3: (f_oob, -R). One exchange with the neighbours besides
    /// those of the solutions.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        pores: &PoreField<D>,
        out_of_balance: &[f64],
        solver: &mut dyn LinearSolver,
    ) -> Result<Self, SolveError> {
        let mut f = out_of_balance.to_vec();
        let (f_u, f_p) = f.split_at_mut(problem.nodes.free.len());
        let mut z = vec![0.0; f_u.len() + f_p.len()];
        let (z_u, z_p) = z.split_at_mut(f_u.len());
        let of_water = system(solver)?.solve(f_p, z_p)?;
        f_u.iter_mut()
            .zip(pressing(problem, pores, z_p))
            .for_each(|(f, pressed)| *f += pressed);
        let mut solved = solver.solve(f_u, z_u)?;
        solved.iterations += of_water.iterations;
        solved.factorisations += of_water.factorisations;
        Ok(Self { z, f, solved })
    }
}

/// The system of the pressures.
pub fn system(solver: &mut dyn LinearSolver) -> Result<&mut dyn LinearSolver, SolveError> {
    solver
        .water()
        .ok_or_else(|| SolveError::Failed("there is no system of the pore pressures".into()))
}
