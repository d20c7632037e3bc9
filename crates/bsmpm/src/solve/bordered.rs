//! Eliminates the motions of free rigid bodies from the linear system by the Woodbury formula, theory-manual equation
//! (T7.10).

use crate::error::SolveError;
use crate::exact::Exact;
use crate::interactions::MotionCoupling;
use crate::linear::{Krylov, LinearSolver, MatrixAssembly, SolveReport, Symmetry};
use crate::parallel::{Halo, local_dot};
use crate::step::problem::Problem;
use nalgebra::{DMatrix, DVector};

/// K - C B^-1 C^T, based on a solver for K. C couples nodes and rigid motions; B is the stiffness against the motions.
pub struct BorderedSolver<'a, const D: usize> {
    solver: &'a mut dyn LinearSolver,
    halo: &'a dyn Halo,
    columns: Vec<Vec<f64>>,        // C
    resists: DMatrix<f64>,         // B
    solved: Vec<Vec<f64>>,         // K^-1 C
    inverse: Option<DMatrix<f64>>, // of B - C^T K^-1 C
}

impl<'a, const D: usize> BorderedSolver<'a, D> {
    /// Creates the solver of a problem with these motions.
    pub fn of<K>(
        problem: &Problem<'a, K, D>,
        couplings: Vec<MotionCoupling>,
        solver: &'a mut dyn LinearSolver,
    ) -> Self {
        let halo = problem.halo;
        let constraints = &problem.nodes.constraints;
        let count = couplings.iter().map(|coupling| coupling.columns.len()).sum();
        let mut resists = DMatrix::zeros(count, count);
        let mut columns = Vec::with_capacity(count);
        for coupling in couplings {
            let size = coupling.columns.len();
            let block = DMatrix::from_row_slice(size, size, &coupling.stiffness);
            resists
                .view_mut((columns.len(), columns.len()), (size, size))
                .copy_from(&block);
            columns.extend(coupling.columns);
        }
        for column in &mut columns {
            constraints.reduce(&mut [&mut column[..]], halo);
            column
                .iter_mut()
                .zip(&constraints.free)
                .filter(|(_, free)| !**free)
                .for_each(|(c, _)| *c = 0.0);
        }
        Self {
            solver,
            halo,
            columns,
            resists,
            solved: Vec::new(),
            inverse: None,
        }
    }

    /// Returns C^T times a nodal array. One reduction.
    fn seen(&self, nodal: &[f64]) -> Vec<f64> {
        let sums = self.columns.iter().map(|column| local_dot(self.halo, D, column, nodal));
        self.halo.reproducible_sum(&sums.collect::<Vec<Exact>>())
    }
}

impl<const D: usize> LinearSolver for BorderedSolver<'_, D> {
    fn matrix(&mut self) -> &mut dyn MatrixAssembly {
        self.solver.matrix()
    }

    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        self.solver.factorise(symmetry)?;
        (self.solved, self.inverse) = (Vec::new(), None);
        if symmetry == Symmetry::General {
            return Ok(());
        }
        let mut condensed = self.resists.clone();
        for (number, column) in self.columns.iter().enumerate() {
            let mut solved = vec![0.0; column.len()];
            // Collective decision: a body without contact has no coupling.
            let mut couples = [f64::from(u8::from(column.iter().any(|entry| *entry != 0.0)))];
            self.halo.all_reduce_max(&mut couples);
            if couples[0] > 0.0 {
                self.solver.solve(column, &mut solved)?;
            }
            let seen = self.seen(&solved);
            seen.iter()
                .enumerate()
                .for_each(|(row, seen)| condensed[(row, number)] -= seen);
            self.solved.push(solved);
        }
        self.inverse = condensed
            .try_inverse()
            .filter(|inverse| inverse.iter().all(|entry| entry.is_finite()));
        Ok(())
    }

    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        let solved = self.solver.solve(rhs, solution)?;
        // Woodbury: (K - C B^-1 C^T)^-1 f = w + K^-1 C (B - C^T K^-1 C)^-1 C^T w with w = K^-1 f.
        if let Some(inverse) = &self.inverse {
            let motions = inverse * DVector::from_vec(self.seen(solution));
            for (column, motion) in self.solved.iter().zip(motions.iter()) {
                solution
                    .iter_mut()
                    .zip(column)
                    .for_each(|(u, column)| *u += motion * column);
            }
        }
        Ok(solved)
    }

    fn is_rough(&self) -> bool {
        self.solver.is_rough()
    }

    /// The `product` includes the coupling; the preconditioner does not.
    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        self.solver.solve_with(product, relative, rhs, solution)
    }

    fn second_field(&mut self) -> Option<&mut dyn LinearSolver> {
        self.solver.second_field()
    }
}
