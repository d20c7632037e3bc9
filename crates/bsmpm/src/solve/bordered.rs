//! Eliminates the motions of free rigid bodies from the linear system by the Woodbury formula, theory-manual equation
//! (T7.10).

use crate::error::SolveError;
use crate::exact::Exact;
use crate::interactions::rigid::MOTIONS;
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
    /// Creates the solver of a problem with freely moving bodies.
    pub fn of<K>(problem: &Problem<'a, K, D>, solver: &'a mut dyn LinearSolver) -> Self {
        let rigid = &problem.nodes.rigid;
        let halo = problem.halo;
        let (mut columns, blocks) = rigid.coupling(&problem.model.grid, halo);
        for column in &mut columns {
            problem.nodes.reduce(&mut [&mut column[..]], halo);
            column
                .iter_mut()
                .zip(&problem.nodes.free)
                .filter(|(_, free)| !**free)
                .for_each(|(c, _)| *c = 0.0);
        }
        let motions: Vec<(usize, usize)> = rigid.free_motions().collect();
        let resists = DMatrix::from_fn(motions.len(), motions.len(), |row, column| {
            let (body, k) = motions[row];
            let (other, l) = motions[column];
            if body == other { blocks[body][(k, l)] } else { 0.0 }
        });
        debug_assert!(blocks.iter().all(|block| block.len() == MOTIONS * MOTIONS));
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

    fn water(&mut self) -> Option<&mut dyn LinearSolver> {
        self.solver.water()
    }
}
