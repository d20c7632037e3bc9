//! Definite systems without PETSc: a factor of single precision, tried by its first solution, or else one of double.

use super::dissection::Precision;
use super::system::trusted;
use super::{KspSolver, missing};
use bsmpm::error::SolveError;
use bsmpm::seam::{Halo, Solved, agreed, over_layers};
use mpi::collective::CommunicatorCollectives;
use std::ops::Range;
use std::rc::Rc;

/// Largest relative residual of a solution by a factor of single precision, which a quasi-Newton direction can do with.
/// It is 1e-7 in dynamics; in statics about 1e-9 n/(1 - 2 nu), n the unknowns of a body in one piece. One right-hand
/// side tells for all of a step: what it does not excite, it does not tell of.
const NEAR: f64 = 1e-2;

/// What is known of the factorisation without PETSc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    /// there is none of the present matrix
    Missing,
    /// it has not solved a system yet
    Untried,
    /// it has, and left little of it
    Tried,
}

impl<const D: usize, const C: usize> KspSolver<'_, D, C> {
    /// Factorises without PETSc.
    pub(super) fn factorise(&mut self, precision: Precision) -> Result<(), SolveError> {
        let (halo, timers) = (Rc::clone(&self.halo), Rc::clone(&self.timers));
        let (world, link, _timed) = (halo.world(), halo.link(), timers.time("factorisation"));
        if !self.planned {
            let mut bounds = vec![0; self.petsc.ranks()];
            world.all_gather_into(&self.grid.columns().start, &mut bounds[..]);
            bounds.push(self.grid.room()[0].end);
            self.direct.plan::<D, C>(&link, (&bounds, self.petsc.rank()), &self.grid, &self.free);
            self.planned = true;
        }
        let mut largest = [self.stencil.largest_diagonal()];
        halo.maximum(&mut largest);
        let good = self.direct.factorise(&link, precision, &self.stencil, largest[0]);
        self.standing = Standing::Untried;
        let pivot =
            |what: &str| SolveError::Failed(format!("a pivot {what} is not positive: the stiffness is not definite"));
        agreed(&*self.halo, if good { Ok(()) } else { Err(pivot("here")) }, pivot("of another rank"))
    }

    /// The solution by the factorisation. The first one tries it: if it is not near, a factor of double precision is
    /// made, whose solution must be.
    pub(super) fn solve_directly(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<Solved, SolveError> {
        let owned = self.halo.owned();
        let owned = owned.start * C..owned.end * C;
        let mut solved = Solved { iterations: 1, ..Solved::default() };
        if self.standing == Standing::Missing {
            return Err(missing());
        }
        self.timed_solution(owned.clone(), rhs, solution);
        if self.standing == Standing::Tried {
            return Ok(solved);
        }
        let (mut left, right) = self.norms(rhs, solution);
        if !right.is_finite() {
            return Err(SolveError::NotFinite);
        }
        if !left.is_finite() || left > NEAR * right {
            self.factorise(Precision::Double)?;
            solved.factorisations = 1;
            self.timed_solution(owned, rhs, solution);
            left = self.norms(rhs, solution).0;
            trusted(left, right)?;
        }
        if right > 0.0 {
            (self.standing, solved.residual) = (Standing::Tried, Some(left / right));
        }
        Ok(solved)
    }

    fn timed_solution(&mut self, owned: Range<usize>, rhs: &[f64], solution: &mut [f64]) {
        let _timed = self.timers.time("linear solve");
        self.direct.solve(&self.halo.link(), owned, rhs, solution);
    }

    /// Norms of the residual that a solution leaves, recomputed, and of the right-hand side.
    fn norms(&self, rhs: &[f64], solution: &[f64]) -> (f64, f64) {
        let mut image = vec![0.0; rhs.len()];
        self.stencil.multiply(&self.free, solution, &mut image);
        self.halo.add_shared(&mut image, C);
        let square = |component: usize, value: f64| if self.free[component] { value * value } else { 0.0 };
        let left = over_layers(&*self.halo, C, |c| square(c, rhs[c] - image[c]));
        let right = over_layers(&*self.halo, C, |c| square(c, rhs[c]));
        let squares = self.halo.total(&[left, right]);
        (squares[0].sqrt(), squares[1].sqrt())
    }
}
