//! A scene on the ranks: steps, migration, and the cut of the grid that follows the points.

use crate::halo::MpiHalo;
use crate::ksp::{Choice, KspSolver};
use crate::migrate;
use crate::signals::Requests;
use crate::slab::{Slabs, imbalance};
use crate::timers::Timers;
use bsmpm::boundary::Surface;
use bsmpm::control::{Accepted, Failure, Progress, Stepper};
use bsmpm::error::StepError;
use bsmpm::grid::Grid;
use bsmpm::initial::{self, Equilibrium};
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::points::{Column, Points};
use bsmpm::schedule::Schedule;
use bsmpm::seam::Halo;
use bsmpm::tensor::{Symmetric, Vector};
use mpi::environment::Universe;
use petsc_rs::Petsc;
use std::rc::Rc;

/// Steps between two looks at the balance.
const LOOK: u64 = 10;
/// Largest load over the mean, relative to the best possible cut, that is left alone.
const TOLERATED: f64 = 1.05;

/// The stress of the points at the start.
pub enum StartStress<'a, const D: usize> {
    /// Pa  by material and position (m, from the grid's lower corner)
    Given(&'a dyn Fn(u16, &Vector<D>) -> Symmetric),
    /// linear elastic equilibrium
    Elastic,
}

/// The distributed state of a run.
pub struct Simulation<'p, K, const D: usize> {
    /// the scene, seen through this rank's window
    pub model: Model<K, D>,
    /// this rank's points
    pub points: Points<D>,
    /// the exchange with the other ranks under the present cut
    pub halo: Rc<MpiHalo>,
    universe: &'p Universe,
    petsc: &'p Petsc<'p>,
    choice: Choice,
    slabs: Slabs,
    schedule: Schedule,
    stepper: Stepper,
    solver: KspSolver<'p, D>,
    steps: u64,
    timers: Rc<Timers>,
}

impl<'p, K: Kinematics<D>, const D: usize> Simulation<'p, K, D> {
    /// A run at time 0. `model` has the whole grid as its window, `points` are those of this rank's slab.
    pub fn new(
        (universe, petsc, choice): (&'p Universe, &'p Petsc<'p>, Choice),
        mut model: Model<K, D>,
        (slabs, mut points): (Slabs, Points<D>),
        schedule: Schedule,
        (timers, requests): (Rc<Timers>, Rc<Requests>),
    ) -> Self {
        model.grid = model.grid.window(slabs.columns(petsc.rank()));
        let slabs = slabs.reaching(model.grid.beyond());
        points.sort_by_cell(&model.grid);
        points.surface = model.boundary.surface();
        let halo = MpiHalo::new(universe.world(), &slabs, &model.grid, (Rc::clone(&timers), requests));
        let halo = Rc::new(halo);
        let solver = KspSolver::new(petsc, choice.clone(), &model.grid, Rc::clone(&halo), Rc::clone(&timers));
        let stepper = Stepper::new(model.grid.nodes() * D);
        let (halo, steps) = (halo, 0);
        Self { model, points, halo, universe, petsc, choice, slabs, schedule, stepper, solver, steps, timers }
    }

    /// Gives the points a stress at the start, see [`initial`], and tells how well it is balanced.
    pub fn stress(&mut self, start: StartStress<'_, D>) -> Result<Equilibrium, StepError> {
        match start {
            StartStress::Given(sigma) => initial::set_stress(&self.model, &mut self.points, sigma),
            StartStress::Elastic => {
                initial::set_elastic(&self.model, &mut self.points, (&*self.halo, &mut self.solver))?
            }
        }
        initial::balance(&self.model, &self.points, &*self.halo)
    }

    /// Puts the run where another one stood after `steps` steps; the points are there already.
    pub fn resume(&mut self, steps: u64, stepper: Stepper, surface: Surface<D>) {
        (self.steps, self.stepper, self.points.surface) = (steps, stepper, surface);
    }

    /// The step control.
    pub fn progress(&self) -> Progress {
        self.stepper.progress()
    }

    /// Everything that is large and must be kept to go on: the points' columns, and the nodal displacement of the layers
    /// that this rank owns, from which the next step starts, with the numbers of a layer.
    #[allow(clippy::type_complexity)]
    pub fn arrays(&mut self) -> (Vec<(&'static str, &mut dyn Column)>, (&[f64], usize)) {
        let owned = self.halo.owned();
        let guess = &self.stepper.guess[owned.start * D..owned.end * D];
        (self.points.named_columns(), (guess, self.model.grid.layer_nodes() * D))
    }

    /// The cut of the grid.
    pub fn slabs(&self) -> &Slabs {
        &self.slabs
    }

    /// Time of the last converged state.
    pub fn time(&self) -> f64 {
        self.stepper.time()
    }

    /// Options given to PETSc that nothing has asked for, without their dash.
    pub fn unused_options(&self) -> Vec<String> {
        self.petsc.unused_options().unwrap_or_default()
    }

    /// Accepted steps.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// One accepted step, after which every point is on the rank of its slab; `None` at the end.
    pub fn advance(&mut self) -> Option<Result<Accepted, Failure>> {
        let outcome = {
            let _timed = self.timers.time("step");
            self.stepper.advance(&self.schedule, &self.model, &mut self.points, &*self.halo, &mut self.solver)?
        };
        if outcome.is_ok() {
            self.steps += 1;
            let timers = Rc::clone(&self.timers);
            let _timed = timers.time("migration");
            migrate::points(self.halo.world(), &self.slabs, &self.model.grid, &mut self.points);
            if self.slabs.ranks() > 1 && self.steps.is_multiple_of(LOOK) {
                self.balance();
            }
        }
        Some(outcome)
    }

    /// Cuts the grid anew where the points have moved away from the present cut: a rule of counts and of the step's
    /// number only, so that a run repeats.
    fn balance(&mut self) {
        let mut counts = points_by_column(&self.model.grid, &self.points);
        self.halo.reduce(&mut counts);
        let load = |slabs: &Slabs| {
            let loads: Vec<f64> = (0..slabs.ranks()).map(|rank| counts[slabs.columns(rank)].iter().sum()).collect();
            imbalance(loads.into_iter())
        };
        let Some(better) = Slabs::cut(&counts, self.slabs.ranks()) else { return };
        let better = better.reaching(self.model.grid.beyond());
        if load(&self.slabs) > TOLERATED * load(&better) {
            self.recut(better);
        }
    }

    fn recut(&mut self, slabs: Slabs) {
        let world = self.universe.world();
        self.stepper.guess = migrate::nodal(&world, (&self.slabs, &slabs), &self.model.grid, &self.stepper.guess, D);
        self.model.grid = self.model.grid.window(slabs.columns(self.petsc.rank()));
        migrate::points(&world, &slabs, &self.model.grid, &mut self.points);
        self.slabs = slabs;
        let shared = (Rc::clone(&self.timers), Rc::clone(self.halo.requests()));
        self.halo = Rc::new(MpiHalo::new(world, &self.slabs, &self.model.grid, shared));
        let (halo, timers) = (Rc::clone(&self.halo), Rc::clone(&self.timers));
        self.solver = KspSolver::new(self.petsc, self.choice.clone(), &self.model.grid, halo, timers);
    }
}

/// Points of this rank in every column of cells of the whole grid.
pub fn points_by_column<const D: usize>(grid: &Grid<D>, points: &Points<D>) -> Vec<f64> {
    let mut counts = vec![0.0; grid.axes()[0].cells()];
    for cell in points.x.iter().filter_map(|x| grid.locate(x)) {
        counts[cell[0]] += 1.0;
    }
    counts
}
