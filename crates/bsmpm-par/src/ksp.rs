//! The linear system on PETSc: numbering of the unknowns, assembly, factorisation, and solutions that are checked.

mod choice;

pub use choice::{Choice, probe};

use crate::halo::MpiHalo;
use crate::stencil::{Numbering, Stencil};
use crate::timers::Timers;
use bsmpm::error::SolveError;
use bsmpm::grid::Grid;
use bsmpm::seam::{Halo, Krylov, LinearSolver, Symmetry};
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use petsc_rs::{Ksp, Matrix, Petsc, Tolerances, Vector};
use std::rc::Rc;

/// Largest relative residual of a solution that is accepted, recomputed: direct solvers report success for NaN.
const TRUSTED: f64 = 1e-6;

/// Most products of one of them.
const MOST_PRODUCTS: usize = 300;

/// The linear solver of a run: one matrix, rebuilt every step; pattern and analysis are kept while the unknowns stay.
pub struct KspSolver<'p, const D: usize> {
    petsc: &'p Petsc<'p>,
    choice: Choice,
    halo: Rc<MpiHalo>,
    stencil: Stencil<D>,
    free: Vec<bool>,
    numbers: Numbering,
    own: usize, // unknowns of this rank
    definite: Option<System<'p>>,
    general: Option<System<'p>>, // where Newton's method is used
    timers: Rc<Timers>,
}

struct System<'p> {
    matrix: Matrix<'p>,
    ksp: Ksp<'p>,
    b: Vector<'p>,
    x: Vector<'p>,
    r: Vector<'p>,
}

impl<'p, const D: usize> KspSolver<'p, D> {
    /// A solver for a window of the grid.
    pub fn new(petsc: &'p Petsc<'p>, choice: Choice, grid: &Grid<D>, halo: Rc<MpiHalo>, timers: Rc<Timers>) -> Self {
        let (stencil, free, numbers) = (Stencil::new(grid), Vec::new(), Vec::new());
        let (definite, general) = (None, None);
        Self { petsc, choice, halo, stencil, free, numbers, own: 0, definite, general, timers }
    }

    /// Numbers the free components: those of rank 0 first, by node; the same number on every rank that shares a node.
    fn number(&mut self, free: &[bool]) {
        let owned = self.halo.owned();
        let owned = owned.start * D..owned.end * D;
        self.own = free[owned.clone()].iter().filter(|&&free| free).count();
        let count = self.own as u64;
        let mut before = 0_u64;
        self.halo.world().exclusive_scan_into(&count, &mut before, SystemOperation::sum());
        let mut next = if self.petsc.rank() == 0 { 0 } else { before };
        let mut numbers = vec![0.0; free.len()]; // one more than the number: 0 is none
        for component in owned.filter(|&component| free[component]) {
            next += 1;
            numbers[component] = next as f64;
        }
        self.halo.share(&mut numbers, D);
        self.numbers = numbers.iter().map(|&number| (number > 0.0).then(|| number as usize - 1)).collect();
        self.free = free.to_vec();
    }

    /// Hands the values over; the pattern too, if the unknowns have changed.
    fn build(&mut self, symmetry: Symmetry) -> petsc_rs::Result<()> {
        let values = self.stencil.entries(&self.numbers);
        let place = match symmetry {
            Symmetry::Definite => &mut self.definite,
            Symmetry::General => &mut self.general,
        };
        let system = match place {
            Some(system) => system,
            none => none
                .insert(System::new((self.petsc, &self.choice, symmetry), (&self.stencil, &self.numbers, self.own))?),
        };
        system.matrix.set_values(&values)?;
        system.ksp.set_operator(&system.matrix)?;
        system.ksp.set_up()
    }

    /// Components of this rank's unknowns, in the order of their numbers.
    fn unknowns(&self) -> Vec<usize> {
        let owned = self.halo.owned();
        (owned.start * D..owned.end * D).filter(|&component| self.free[component]).collect()
    }
}

/// Nodal array, known to all ranks that share a node, of the unknowns that the ranks own.
fn spread<const D: usize>(halo: &MpiHalo, unknowns: &[usize], values: &[f64], nodal: &mut [f64]) {
    nodal.fill(0.0);
    for (&component, value) in unknowns.iter().zip(values) {
        nodal[component] = *value;
    }
    halo.share(nodal, D);
}

fn missing() -> SolveError {
    SolveError::Failed("no matrix was assembled".into())
}

fn failed(error: petsc_rs::Error) -> SolveError {
    SolveError::Failed(error.to_string())
}

impl<'p> System<'p> {
    fn new<const D: usize>(
        (petsc, choice, symmetry): (&'p Petsc<'p>, &Choice, Symmetry),
        (stencil, numbers, own): (&Stencil<D>, &Numbering, usize),
    ) -> petsc_rs::Result<Self> {
        let places = stencil.coordinates(numbers);
        let mut matrix = Matrix::from_coo(petsc, own, 1, &places.rows, &places.columns)?;
        if symmetry == Symmetry::Definite {
            matrix.set_symmetry(petsc_rs::Symmetry::PositiveDefinite)?;
        }
        let mut ksp = Ksp::new(petsc)?;
        ksp.set_operator(&matrix)?;
        choice.apply(&mut ksp, symmetry)?;
        let vector = || Vector::new(petsc, own);
        Ok(Self { matrix, ksp, b: vector()?, x: vector()?, r: vector()? })
    }

    /// Solution of this rank's unknowns, if it is finite and its recomputed residual small.
    fn solve(&mut self, rhs: &[f64]) -> Result<(usize, Vec<f64>), SolveError> {
        self.b.copy_from(rhs).map_err(failed)?;
        let info = self.ksp.solve(&self.b, &mut self.x).map_err(failed)?;
        self.matrix.residual(&self.b, &self.x, &mut self.r).map_err(failed)?;
        let (left, right) = (self.r.norm().map_err(failed)?, self.b.norm().map_err(failed)?);
        if !left.is_finite() {
            return Err(SolveError::NotFinite);
        }
        if left > TRUSTED * right {
            return Err(SolveError::Residual(left / right));
        }
        Ok((info.iterations, self.x.read(<[f64]>::to_vec).map_err(failed)?))
    }

    /// Solution of this rank's unknowns for an operator known by its product, and what it leaves.
    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
    ) -> Result<(Krylov, Vec<f64>), SolveError> {
        self.b.copy_from(rhs).map_err(failed)?;
        let tolerances = Tolerances { relative, absolute: 0.0, max_iterations: MOST_PRODUCTS };
        self.ksp.set_tolerances(tolerances).map_err(failed)?;
        let info = self.ksp.solve_with(product, &self.b, &mut self.x).map_err(failed)?;
        let x = self.x.read(<[f64]>::to_vec).map_err(failed)?;
        self.r.write(|r| product(&x, r)).map_err(failed)?;
        self.r.add_scaled(-1.0, &self.b).map_err(failed)?;
        let residual = self.r.norm().map_err(failed)? / self.b.norm().map_err(failed)?;
        if !residual.is_finite() {
            return Err(SolveError::NotFinite);
        }
        Ok((Krylov { iterations: info.iterations, residual }, x))
    }
}

impl<const D: usize> LinearSolver for KspSolver<'_, D> {
    fn begin(&mut self, free: &[bool]) {
        let mut changed = [f64::from(self.free != free)];
        self.halo.maximum(&mut changed);
        if changed[0] > 0.0 {
            self.number(free);
            (self.definite, self.general) = (None, None);
        }
        self.stencil.clear();
    }

    fn add(&mut self, first_node: usize, block: &[f64]) {
        self.stencil.add(first_node, block);
    }

    fn add_among(&mut self, nodes: &[usize], block: &[f64]) {
        self.stencil.add_among(nodes, block);
    }

    fn add_diagonal(&mut self, diagonal: &[f64]) {
        for node in self.halo.owned() {
            for component in 0..D {
                self.stencil.add_diagonal(node, component, diagonal[node * D + component]);
            }
        }
    }

    fn finish(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("factorisation");
        self.build(symmetry).map_err(failed)
    }

    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<usize, SolveError> {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("linear solve");
        let unknowns = self.unknowns();
        let own: Vec<f64> = unknowns.iter().map(|&component| rhs[component]).collect();
        let (iterations, x) = self.definite.as_mut().ok_or_else(missing)?.solve(&own)?;
        spread::<D>(&self.halo, &unknowns, &x, solution);
        Ok(iterations)
    }

    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("linear solve");
        let (unknowns, halo) = (self.unknowns(), Rc::clone(&self.halo));
        let own: Vec<f64> = unknowns.iter().map(|&component| rhs[component]).collect();
        let (mut nodal, mut image) = (vec![0.0; rhs.len()], vec![0.0; rhs.len()]);
        let mut on_unknowns = |x: &[f64], y: &mut [f64]| {
            spread::<D>(&halo, &unknowns, x, &mut nodal);
            product(&nodal, &mut image);
            y.iter_mut().zip(&unknowns).for_each(|(y, &component)| *y = image[component]);
        };
        let system = self.general.as_mut().ok_or_else(missing)?;
        let (krylov, x) = system.solve_with(&mut on_unknowns, relative, &own)?;
        spread::<D>(&self.halo, &unknowns, &x, solution);
        Ok(krylov)
    }
}
