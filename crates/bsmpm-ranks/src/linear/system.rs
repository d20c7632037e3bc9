//! A linear system that PETSc assembles and solves, and the check of its residual.

use super::choice::Choice;
use super::tally::Tally;
use bsmpm::error::SolveError;
use bsmpm::linear::{Krylov, Symmetry};
use petsc_rs::{Ksp, Matrix, NormType, Petsc, Product, Tolerances, Vector};

/// Largest accepted relative residual of a solution. It is recomputed, because direct solvers report success for NaN.
const TRUSTED: f64 = 1e-6;

/// Largest number of conjugate gradient iterations when a preconditioner-only method must solve a system.
pub(super) const MOST_ITERATIONS: usize = 10_000;

/// Largest number of matrix products for one direction of Newton's method.
const MOST_PRODUCTS: usize = 300;

/// Assembled matrix with its solver.
pub(super) struct System<'p> {
    pub(super) matrix: Matrix<'p>,
    pub(super) ksp: Ksp<'p>,
    b: Vector<'p>,
    x: Vector<'p>,
    r: Vector<'p>,
    applications: usize, // of the preconditioner in place of a solution, if not 0
    ksp_type: String,
}

impl<'p> System<'p> {
    /// Creates the system of a matrix, solved as `choice` and the PETSc options define. Collective.
    pub(super) fn new(
        petsc: &'p Petsc<'p>,
        choice: &Choice,
        symmetry: Symmetry,
        mut matrix: Matrix<'p>,
    ) -> petsc_rs::Result<Self> {
        // PETSc's redundant copies are not marked as positive definite. The matrix is not marked on one rank either, so
        // that MUMPS works in the same way on any number of ranks.
        if symmetry == Symmetry::Definite && !choice.redundant {
            matrix.set_symmetry(petsc_rs::Symmetry::PositiveDefinite)?;
        }
        let mut ksp = Ksp::new(petsc)?;
        ksp.set_operator(&matrix)?;
        choice.apply(&mut ksp, symmetry)?;
        let rows = matrix.local_rows();
        let b = Vector::new(petsc, rows)?;
        let x = Vector::new(petsc, rows)?;
        let r = Vector::new(petsc, rows)?;
        let applications = choice.applications;
        let ksp_type = choice.ksp.clone();
        Ok(Self {
            matrix,
            ksp,
            b,
            x,
            r,
            applications,
            ksp_type,
        })
    }

    /// Applies the preconditioner to a right-hand side and then to the residual, as many times as `choice` defines: a
    /// fixed, linear and symmetric function. Fails only if the result is not finite. Collective.
    pub(super) fn approach(&mut self, rhs: &[f64], tally: &mut Tally) -> Result<(usize, Vec<f64>), SolveError> {
        self.b.copy_from(rhs).map_err(failed)?;
        let mut sum = vec![0.0; rhs.len()];
        for number in 0..self.applications {
            if number > 0 {
                self.x.copy_from(&sum).map_err(failed)?;
                self.matrix.residual(&self.b, &self.x, &mut self.r).map_err(failed)?;
            }
            let left = if number > 0 { &self.r } else { &self.b };
            let outcome = self.ksp.solve(left, &mut self.x);
            tally.count(&self.ksp, &outcome);
            outcome.map_err(failed)?;
            let added = self.x.read(|x| sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += x));
            added.map_err(failed)?;
        }
        // The norm is that of all ranks, so all ranks fail together.
        if !self.x.norm().map_err(failed)?.is_finite() {
            return Err(SolveError::NotFinite);
        }
        Ok((self.applications, sum))
    }

    /// Solves to the relative residual `relative` by preconditioned conjugate gradients. Collective.
    pub(super) fn solve_to(
        &mut self,
        relative: f64,
        rhs: &[f64],
        tally: &mut Tally,
    ) -> Result<(usize, Vec<f64>), SolveError> {
        let tolerances = Tolerances {
            relative: 0.1 * relative,
            absolute: 0.0,
            max_iterations: MOST_ITERATIONS,
        };
        self.ksp.set_tolerances(tolerances).map_err(failed)?;
        self.ksp.set_type("cg").map_err(failed)?;
        self.ksp.set_norm(NormType::Unpreconditioned).map_err(failed)?;
        let found = self.solve(rhs, tally);
        self.ksp.set_type(&self.ksp_type).map_err(failed)?;
        self.ksp.set_norm(NormType::None).map_err(failed)?;
        found
    }

    /// Returns the solution of this rank's unknowns. Fails if it is not finite or its recomputed residual is too large.
    /// Collective.
    pub(super) fn solve(&mut self, rhs: &[f64], tally: &mut Tally) -> Result<(usize, Vec<f64>), SolveError> {
        self.b.copy_from(rhs).map_err(failed)?;
        let outcome = self.ksp.solve(&self.b, &mut self.x);
        tally.count(&self.ksp, &outcome);
        let info = outcome.map_err(failed)?;
        self.matrix.residual(&self.b, &self.x, &mut self.r).map_err(failed)?;
        let left = self.r.norm().map_err(failed)?;
        let right = self.b.norm().map_err(failed)?;
        trusted(left, right)?;
        Ok((info.iterations, self.x.read(<[f64]>::to_vec).map_err(failed)?))
    }

    /// Solves for an operator that is known by its product. Returns the relative residual and the solution of this
    /// rank's unknowns. Collective.
    pub(super) fn solve_with(
        &mut self,
        product: &mut Product<'_>,
        relative: f64,
        rhs: &[f64],
        tally: &mut Tally,
    ) -> Result<(Krylov, Vec<f64>), SolveError> {
        self.b.copy_from(rhs).map_err(failed)?;
        let tolerances = Tolerances {
            relative,
            absolute: 0.0,
            max_iterations: MOST_PRODUCTS,
        };
        self.ksp.set_tolerances(tolerances).map_err(failed)?;
        let outcome = self.ksp.solve_with(product, &self.b, &mut self.x);
        tally.count(&self.ksp, &outcome);
        let info = outcome.map_err(failed)?;
        let x = self.x.read(<[f64]>::to_vec).map_err(failed)?;
        self.r.write(|r| product(&x, r)).map_err(failed)?;
        self.r.add_scaled(-1.0, &self.b).map_err(failed)?;
        let residual = self.r.norm().map_err(failed)? / self.b.norm().map_err(failed)?;
        if !residual.is_finite() {
            return Err(SolveError::NotFinite);
        }
        Ok((
            Krylov {
                iterations: info.iterations,
                residual,
            },
            x,
        ))
    }
}

/// Fails if a residual norm `left` is too large for a right-hand side with the norm `right`.
pub(super) fn trusted(left: f64, right: f64) -> Result<(), SolveError> {
    if !left.is_finite() {
        return Err(SolveError::NotFinite);
    }
    if left > TRUSTED * right {
        return Err(SolveError::Residual(left / right));
    }
    Ok(())
}

/// Converts an error of PETSc.
pub(super) fn failed(error: petsc_rs::Error) -> SolveError {
    SolveError::Failed(error.to_string())
}
