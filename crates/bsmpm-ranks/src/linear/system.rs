//! A linear system that PETSc assembles and solves, and the check of its residual.

use super::choice::Choice;
use super::tally::Tally;
use bsmpm::error::SolveError;
use bsmpm::parallel::{Krylov, Symmetry};
use petsc_rs::{Ksp, Matrix, NormType, Petsc, Product, Tolerances, Vector};

/// Largest relative residual of a solution that is accepted, recomputed: direct solvers report success for NaN.
const TRUSTED: f64 = 1e-6;

/// Most iterations around a preconditioner that is applied in place of a solution elsewhere.
pub(super) const MOST_ITERATIONS: usize = 10_000;

/// Most products of one of Newton's directions.
const MOST_PRODUCTS: usize = 300;

/// A matrix with its solver.
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
    /// The system of a matrix, to be solved as `choice` and the options say. Collective.
    pub(super) fn new(
        petsc: &'p Petsc<'p>,
        choice: &Choice,
        symmetry: Symmetry,
        mut matrix: Matrix<'p>,
    ) -> petsc_rs::Result<Self> {
        // PETSc's copies of the whole do not know that they are definite: on one rank, too, MUMPS shall do as with
        // them.
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

    /// The preconditioner applied to a right-hand side, and to what that leaves, so often as the choice says: a fixed,
    /// linear and symmetric function. Only refused if it is not finite.
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
        // Of all ranks, as all or none go on.
        if !self.x.norm().map_err(failed)?.is_finite() {
            return Err(SolveError::NotFinite);
        }
        Ok((self.applications, sum))
    }

    /// Solution to the residual `relative` by conjugate gradients around the preconditioner.
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

    /// Solution of this rank's unknowns, if it is finite and its recomputed residual small.
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

    /// Solution of this rank's unknowns for an operator known by its product, and what it leaves.
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

/// Refuses a solution whose residual has the norm `left`, of a right-hand side with the norm `right`.
pub(super) fn trusted(left: f64, right: f64) -> Result<(), SolveError> {
    if !left.is_finite() {
        return Err(SolveError::NotFinite);
    }
    if left > TRUSTED * right {
        return Err(SolveError::Residual(left / right));
    }
    Ok(())
}

/// An error of PETSc.
pub(super) fn failed(error: petsc_rs::Error) -> SolveError {
    SolveError::Failed(error.to_string())
}
