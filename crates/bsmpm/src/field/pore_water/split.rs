//! Solves for displacements and pore pressures by the fixed-stress split, theory-manual equation (T8.16): two symmetric
//! positive definite systems.

use crate::error::SolveError;
use crate::field::pore_water::nodes::PorePressureField;
use crate::field::pore_water::residual::pressing;
use crate::kinematics::Kinematics;
use crate::linear::{LinearSolver, SolveReport};
use crate::step::problem::Problem;

/// Direction of the fixed-stress split, the right-hand side that it balances, and the cost.
pub struct Split {
    /// Displacements (m), followed by pressures (Pa), nodal.
    pub z: Vec<f64>,
    /// Forces (N), followed by water volumes (m3), nodal.
    pub f: Vec<f64>,
    /// Iterations and factorisations of both systems.
    pub solved: SolveReport,
}

impl Split {
    /// Solves for the out-of-balance forces (N) followed by water volumes (m3), (f_oob, -R). One exchange with the
    /// neighbours in addition to those of the two solutions.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        pores: &PorePressureField<D>,
        out_of_balance: &[f64],
        solver: &mut dyn LinearSolver,
    ) -> Result<Self, SolveError> {
        let mut f = out_of_balance.to_vec();
        let (f_u, f_p) = f.split_at_mut(problem.nodes.constraints.free.len());
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

/// Returns the linear system of the pressures. Fails if the solver has none.
pub fn system(solver: &mut dyn LinearSolver) -> Result<&mut dyn LinearSolver, SolveError> {
    solver
        .second_field()
        .ok_or_else(|| SolveError::Failed("there is no system of the pore pressures".into()))
}
