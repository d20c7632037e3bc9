//! The linear solvers for displacements and pore pressures.

use super::{Choice, KspSolver, Tallies};
use crate::halo::MpiHalo;
use crate::timers::Timers;
use bsmpm::error::SolveError;
use bsmpm::model::Model;
use bsmpm::parallel::{Krylov, LinearSolver, SolveReport, Symmetry};
use petsc_rs::Petsc;
use std::rc::Rc;

/// Linear solvers for displacements and, with transient seepage, for pore pressures.
pub struct Solvers<'p, const D: usize> {
    displacements: KspSolver<'p, D, D>,
    water: Option<KspSolver<'p, D, 1>>,
}

impl<'p, const D: usize> Solvers<'p, D> {
    /// Creates the solvers for the window of a model's grid.
    pub fn new<K>(
        petsc: &'p Petsc<'p>,
        choice: &Choice,
        model: &Model<K, D>,
        halo: &Rc<MpiHalo>,
        timers: &Rc<Timers>,
    ) -> Self {
        let grid = &model.grid;
        let flows = model.water.as_ref().is_some_and(|water| water.flow.is_some());
        let displacements = KspSolver::new(petsc, choice.clone(), grid, Rc::clone(halo), Rc::clone(timers));
        let water = flows.then(|| KspSolver::lowered(petsc, choice.clone(), grid, Rc::clone(halo), Rc::clone(timers)));
        Self { displacements, water }
    }

    /// Returns the outcomes of the solves so far.
    pub fn tallies(&self) -> Tallies {
        let water = self.water.as_ref().and_then(|water| water.tallies().definite.clone());
        Tallies {
            water,
            ..self.displacements.tallies().clone()
        }
    }

    /// Continues the counts of former solvers of the run.
    pub fn count_on(&mut self, tallies: Tallies) {
        if let Some(water) = &mut self.water {
            water.count_on(Tallies {
                definite: tallies.water.clone(),
                ..Tallies::default()
            });
        }
        self.displacements.count_on(tallies);
    }
}

impl<const D: usize> LinearSolver for Solvers<'_, D> {
    fn reinit(&mut self, free: &[bool]) {
        self.displacements.reinit(free);
    }

    fn add_block(&mut self, first_node: usize, block: &[f64]) {
        self.displacements.add_block(first_node, block);
    }

    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]) {
        self.displacements.add_block_among(nodes, block);
    }

    fn add_diagonal(&mut self, diagonal: &[f64]) {
        self.displacements.add_diagonal(diagonal);
    }

    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        self.displacements.factorise(symmetry)
    }

    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        self.displacements.solve(rhs, solution)
    }

    fn is_rough(&self) -> bool {
        self.displacements.is_rough()
    }

    fn solve_to(&mut self, relative: f64, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        self.displacements.solve_to(relative, rhs, solution)
    }

    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        self.displacements.solve_with(product, relative, rhs, solution)
    }

    fn water(&mut self) -> Option<&mut dyn LinearSolver> {
        self.water.as_mut().map(|water| water as &mut dyn LinearSolver)
    }
}
