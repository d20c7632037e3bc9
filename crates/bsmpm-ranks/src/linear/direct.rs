//! The direct solver as preconditioner of PETSc's KSP. The factor is stored in single or, if a solution is inaccurate,
//! double precision.

use super::dissection::{Dissection, Precision};
use super::system::trusted;
use crate::halo::MpiHalo;
use crate::stencil::Stencil;
use crate::timers::Timers;
use bsmpm::error::SolveError;
use bsmpm::grid::Grid;
use bsmpm::nodal::Nodal;
use bsmpm::parallel::{Halo, agreed, over_layers};
use mpi::topology::Communicator;
use petsc_rs::{PcFailure, ShellPc};

/// Largest relative residual of a solution by a single-precision factor; it is sufficient for a quasi-Newton direction.
/// The residual is about 1e-7 in dynamics, and 1e-9 n/(1 - 2 nu) in statics, with n the unknowns of a body in one
/// piece. It is checked for the first right-hand side of a factor only, so an error that this right-hand side does not
/// excite is not seen.
const NEAR: f64 = 1e-2;

/// State of the factor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum FactorState {
    /// There is no factor of the present matrix.
    #[default]
    Missing,
    /// The factor has not solved a system yet.
    Untried,
    /// The factor has solved a system with a small residual.
    Tried,
}

/// Positive definite matrix: the stencil's blocks of the free components.
#[derive(Clone, Copy)]
pub(super) struct StiffnessOperator<'a, const D: usize, const C: usize> {
    pub halo: &'a MpiHalo,
    pub grid: &'a Grid<D>,
    pub stencil: &'a Stencil<D, C>,
    pub free: &'a [bool],
    /// Components of this rank's unknowns.
    pub unknowns: &'a [usize],
    pub timers: &'a Timers,
}

impl<const D: usize, const C: usize> StiffnessOperator<'_, D, C> {
    /// Computes y = A x for this rank's unknowns. Collective.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let mut nodal = vec![0.0; self.free.len()];
        let mut image = vec![0.0; self.free.len()];
        super::spread::<C>(self.halo, self.unknowns, x, &mut nodal);
        self.multiply_nodal(&nodal, &mut image);
        gather(self.unknowns, &image, y);
    }

    fn multiply_nodal(&self, x: &[f64], image: &mut [f64]) {
        self.stencil.multiply(self.free, x, image);
        self.halo.add_shared(image, C);
    }

    /// Returns the norms of a solution's residual, recomputed, and of the right-hand side. Collective.
    pub fn norms(&self, rhs: &[f64], solution: &[f64]) -> (f64, f64) {
        let mut image = vec![0.0; rhs.len()];
        self.multiply_nodal(solution, &mut image);
        let left = over_layers(self.halo, C, |c| square(self.free[c], rhs[c] - image[c]));
        let right = over_layers(self.halo, C, |c| square(self.free[c], rhs[c]));
        let squares = self.halo.reproducible_sum(&[left, right]);
        (squares[0].sqrt(), squares[1].sqrt())
    }
}

/// Copies the entries of the `unknowns` in a nodal array to `values`.
pub(super) fn gather(unknowns: &[usize], nodal: &[f64], values: &mut [f64]) {
    values
        .iter_mut()
        .zip(unknowns)
        .for_each(|(value, &component)| *value = nodal[component]);
}

/// Factor of a positive definite matrix, and the side results of its applications.
#[derive(Default)]
pub(super) struct DissectionFactor {
    dissection: Dissection,
    is_planned: bool, // for the present unknowns
    standing: FactorState,
    rhs: Vec<f64>, // nodal
    /// Result of the last application, valid at all nodes of the window.
    pub solution: Vec<f64>,
    /// Number of factorisations in addition to that of the set-up, since the last reset.
    pub further: usize,
    /// |b - A x| / |b| of the first solution since the last reset.
    pub residual: Option<f64>,
    /// Cause of a failure.
    pub cause: Option<SolveError>,
}

impl DissectionFactor {
    /// Discards the plan, because the unknowns have changed.
    pub fn replan(&mut self) {
        self.is_planned = false;
    }

    /// Discards the factor, because the matrix has changed.
    pub fn outdate(&mut self) {
        self.standing = FactorState::Missing;
    }

    /// Returns whether there is a factor of the present matrix.
    pub fn is_there(&self) -> bool {
        self.standing != FactorState::Missing
    }
}

/// Factor with its matrix, as KSP's preconditioner.
pub(super) struct DissectionPc<'a, const D: usize, const C: usize> {
    pub factor: &'a mut DissectionFactor,
    pub matrix: StiffnessOperator<'a, D, C>,
}

impl<const D: usize, const C: usize> DissectionPc<'_, D, C> {
    fn factorise(&mut self, precision: Precision) -> Result<(), SolveError> {
        let StiffnessOperator {
            halo,
            grid,
            stencil,
            free,
            timers,
            ..
        } = self.matrix;
        let link = halo.link();
        let _timed = timers.time("factorisation");
        if !self.factor.is_planned {
            let rank = halo.world().rank().unsigned_abs() as usize;
            self.factor
                .dissection
                .plan::<D, C>(&link, halo.slabs(), rank, grid, free);
            self.factor.is_planned = true;
        }
        let mut largest = [stencil.largest_diagonal()];
        halo.all_reduce_max(&mut largest);
        let good = self.factor.dissection.factorise(&link, precision, stencil, largest[0]);
        self.factor.standing = FactorState::Untried;
        let [here, elsewhere] = ["here", "of another rank"].map(|place| {
            SolveError::Failed(format!(
                "a pivot {place} is not positive: the stiffness is not definite"
            ))
        });
        agreed(halo, if good { Ok(()) } else { Err(here) }, elsewhere)
    }

    /// Solves for the nodal right-hand side. The first solution checks the factor, because KSP does not report its
    /// accuracy. If its residual is too large, the matrix is factorised in double precision, and the residual must then
    /// be small.
    fn solve(&mut self) -> Result<(), SolveError> {
        self.back_substitute();
        if self.factor.standing == FactorState::Tried {
            return Ok(());
        }
        let (mut left, right) = self.matrix.norms(&self.factor.rhs, &self.factor.solution);
        if !right.is_finite() {
            return Err(SolveError::NotFinite);
        }
        if !left.is_finite() || left > NEAR * right {
            self.factorise(Precision::Double)?;
            self.factor.further += 1;
            self.back_substitute();
            left = self.matrix.norms(&self.factor.rhs, &self.factor.solution).0;
            trusted(left, right)?;
        }
        if right > 0.0 {
            (self.factor.standing, self.factor.residual) = (FactorState::Tried, Some(left / right));
        }
        Ok(())
    }

    fn back_substitute(&mut self) {
        let _timed = self.matrix.timers.time("linear solve");
        let owned = self.matrix.halo.owned();
        let DissectionFactor {
            dissection,
            rhs,
            solution,
            ..
        } = &mut *self.factor;
        dissection.solve(
            &self.matrix.halo.link(),
            |component| owned.contains(Nodal::<C>::node(component)),
            rhs,
            solution,
        );
    }

    /// Reports a failure to KSP, and stores its cause for the caller.
    fn report(&mut self, outcome: Result<(), SolveError>, failure: PcFailure) -> Result<(), PcFailure> {
        outcome.map_err(|cause| {
            self.factor.cause = Some(cause);
            failure
        })
    }
}

impl<const D: usize, const C: usize> ShellPc for DissectionPc<'_, D, C> {
    fn set_up(&mut self) -> Result<(), PcFailure> {
        let outcome = self.factorise(Precision::Single);
        self.report(outcome, PcFailure::ZeroPivot)
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), PcFailure> {
        let count = self.matrix.free.len();
        let unknowns = self.matrix.unknowns;
        let DissectionFactor { rhs, solution, .. } = &mut *self.factor;
        rhs.clear();
        rhs.resize(count, 0.0);
        solution.resize(count, 0.0);
        unknowns
            .iter()
            .zip(r)
            .for_each(|(&component, value)| rhs[component] = *value);
        let outcome = self.solve();
        gather(unknowns, &self.factor.solution, z);
        self.report(outcome, PcFailure::Other)
    }
}

/// Returns the square of a free component, or 0.
fn square(is_free: bool, value: f64) -> f64 {
    if is_free { value * value } else { 0.0 }
}
