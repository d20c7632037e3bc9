//! The state of a run on all ranks. Makes steps, moves points between ranks, and balances the load.

mod partition;

use crate::halo::MpiHalo;
use crate::linear::{Choice, KspSolver, Tallies};
use crate::load;
use crate::migrate;
use crate::signals::Requests;
use crate::slab::Slabs;
use crate::timers::Timers;
use crate::traffic::{TrafficCounts, TrafficKind};
use bsmpm::boundary::Idle;
use bsmpm::control::{AcceptedStep, Failure, Progress, Stepper};
use bsmpm::error::StepError;
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::initial::{self, Equilibrium, EquilibriumSearchReport};
use bsmpm::interactions::free_field;
use bsmpm::interactions::load::follower;
use bsmpm::interactions::state::InteractionState;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::parallel::Halo;
use bsmpm::points::{Column, Points, Seed};
use bsmpm::schedule::Schedule;
use bsmpm::tensor::{Symmetric, Vector};
use bsmpm::threads::Awake;
use mpi::environment::Universe;
use petsc_rs::Petsc;
use std::borrow::Cow;
use std::ops::Range;
use std::rc::Rc;

/// Number of steps between two checks of the load balance.
const LOOK: u64 = 10;

/// Initial stress of the points.
pub enum StartStress<'a, const D: usize> {
    /// Stress (Pa) by material and position (m, from the grid's lower corner).
    Given(&'a dyn Fn(u16, &Vector<D>) -> Symmetric),
    /// Linear elastic equilibrium.
    Elastic,
    /// Vertical and shear stress of linear elastic equilibrium; horizontal stress by K0 (-) of every material.
    Spread(&'a dyn Fn(u16) -> f64),
}

/// Cost of a step in addition to its iterations; the same on all ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Reductions over all ranks.
    pub reductions: u64,
    /// Messages between ranks, in total over all ranks.
    pub messages: u64,
    /// Bytes of these messages.
    pub bytes: u64,
    /// Largest load of a rank divided by the mean load, during the step.
    pub imbalance: f64,
    /// Whether the grid was partitioned again after the step.
    pub is_cut_again: bool,
}

/// Initialised libraries that a simulation needs.
#[derive(Clone, Copy)]
pub struct Libraries<'p> {
    /// MPI.
    pub universe: &'p Universe,
    /// PETSc.
    pub petsc: &'p Petsc<'p>,
}

/// Model at time 0 with its points, distributed over the ranks of a partition.
pub struct PartitionedModel<K, const D: usize> {
    /// The model; its grid covers the active domain of all ranks.
    pub model: Model<K, D>,
    /// The partition.
    pub slabs: Slabs,
    /// The points in this rank's cells.
    pub points: Points<D>,
}

/// Distributed state of a run.
pub struct Simulation<'p, K, const D: usize> {
    /// Model with the window of this rank.
    pub model: Model<K, D>,
    /// Points of this rank.
    pub points: Points<D>,
    /// State of the interactions, the same on all ranks.
    pub state: InteractionState<D>,
    /// Exchange with the other ranks in the present partition.
    pub halo: Rc<MpiHalo>,
    libraries: Libraries<'p>,
    choice: Choice,
    slabs: Slabs,
    schedule: Schedule,
    stepper: Stepper,
    solver: KspSolver<'p, D, D>,
    steps: u64,
    cost: Cost, // of the last step
    timers: Rc<Timers>,
}

impl<'p, K: Kinematics<D>, const D: usize> Simulation<'p, K, D> {
    /// Creates a run at time 0. Collective.
    pub fn new(
        libraries: Libraries<'p>,
        choice: Choice,
        partitioned: PartitionedModel<K, D>,
        schedule: Schedule,
        timers: Rc<Timers>,
        requests: Rc<Requests>,
    ) -> Self {
        let Libraries { universe, petsc } = libraries;
        let PartitionedModel {
            mut model,
            slabs,
            mut points,
        } = partitioned;
        model.grid = model.grid.window_of(slabs.cells(petsc.rank(), model.grid.room()));
        let slabs = slabs.reaching(model.grid.beyond());
        points.sort_by_cell(&model.grid);
        let state = model.boundary.initial_state();
        let halo = MpiHalo::new(universe.world(), &slabs, &model.grid, Rc::clone(&timers), requests);
        let halo = Rc::new(halo);
        let solver = KspSolver::of_model(petsc, &choice, &model, &halo, &timers);
        let stepper = Stepper::new(model.grid.nodes() * D);
        let steps = 0;
        let cost = Cost::default();
        Self {
            model,
            points,
            state,
            halo,
            libraries,
            choice,
            slabs,
            schedule,
            stepper,
            solver,
            steps,
            cost,
            timers,
        }
    }

    /// Sets the initial stress of the points, see [`initial`]. With `settles`, it is iterated to equilibrium with the
    /// materials' laws. Returns the residual of the equilibrium and the effort of the iteration. Collective.
    pub fn stress(
        &mut self,
        start: StartStress<'_, D>,
        settles: bool,
    ) -> Result<(Equilibrium, Option<EquilibriumSearchReport>), StepError> {
        let Self {
            model,
            points,
            state,
            halo,
            solver,
            ..
        } = self;
        match start {
            StartStress::Given(sigma) => initial::set_stress(model, points, sigma),
            StartStress::Elastic => initial::set_elastic(model, points, state, &**halo, solver)?,
            StartStress::Spread(k0) => initial::set_spread(model, points, state, k0, &**halo, solver)?,
        }
        let settling = settles
            .then(|| initial::settle(model, points, state, &**halo, solver))
            .transpose()?;
        initial::hold(model, points, state, &**halo, solver)?;
        Ok((initial::balance(model, points, state, &**halo)?, settling))
    }

    /// Sets the state of a run after `steps` steps. The points must have been set before.
    pub fn resume(&mut self, steps: u64, stepper: Stepper, state: InteractionState<D>) {
        (self.steps, self.stepper, self.state) = (steps, stepper, state);
    }

    /// Returns the state of the step size control.
    pub fn progress(&self) -> Progress {
        self.stepper.progress()
    }

    /// Returns all large data of a checkpoint: the points' columns, and the displacements from which the next step
    /// starts, at the nodes that this rank owns. The last number is the length of a row of the latter: the values of a
    /// node layer, or, if slabs have parts, of a row of nodes.
    #[allow(clippy::type_complexity)]
    pub fn arrays(&mut self) -> (Vec<(&'static str, &mut dyn Column)>, (Cow<'_, [f64]>, usize)) {
        let owned = self.halo.owned();
        let grid = &self.model.grid;
        let layer = grid.layer_nodes() * D;
        let guess = if self.slabs.parts().is_empty() {
            let end = owned.runs().last().map_or(0, |run| run.end);
            (Cow::Borrowed(&self.stepper.guess[..end * D]), layer)
        } else {
            let own = owned.places::<D>().map(|place| self.stepper.guess[place]);
            (Cow::Owned(own.collect()), layer / grid.nodes_along(1))
        };
        (self.points.named_columns(), guess)
    }

    /// Returns the partition of the grid.
    pub fn slabs(&self) -> &Slabs {
        &self.slabs
    }

    /// Returns the time of the last converged state (s).
    pub fn time(&self) -> f64 {
        self.stepper.time()
    }

    /// Returns the PETSc options that were not used, without their dash.
    pub fn unused_options(&self) -> Vec<String> {
        self.libraries.petsc.unused_options().unwrap_or_default()
    }

    /// Returns the counts of the linear solves by their outcome.
    pub fn tallies(&self) -> Tallies {
        self.solver.tallies()
    }

    /// Returns the number of accepted steps.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Returns the cost of the last accepted step.
    pub fn cost(&self) -> Cost {
        self.cost
    }

    /// Computes one accepted step and then moves every point to the rank of its cell; `None` at the end of the
    /// schedule. Collective.
    pub fn advance(&mut self) -> Option<Result<AcceptedStep, Failure>> {
        let before = self.timers.traffic().counts();
        let load = load::of_rank(self.points.len(), self.model.grid.nodes());
        let outcome = {
            let _timed = self.timers.time("step");
            let _awake = Awake::over(self.points.len());
            self.stepper.advance(
                &self.schedule,
                &self.model,
                &mut self.points,
                &mut self.state,
                &*self.halo,
                &mut self.solver,
            )?
        };
        if let Ok(accepted) = &outcome {
            self.steps += 1;
            let timers = Rc::clone(&self.timers);
            let _timed = timers.time("migration");
            let world = self.halo.world();
            migrate::points(world, timers.traffic(), &self.slabs, &self.model.grid, &mut self.points);
            let looks = self.slabs.ranks() > 1 && self.steps.is_multiple_of(LOOK);
            let is_cut_again = looks && self.balance(accepted.counts.evaluations as u64);
            let (mut cost, has_room) = self.count(before, load);
            if !has_room {
                self.make_room();
                (cost, _) = self.count(before, load);
            }
            self.cost = Cost {
                is_cut_again: is_cut_again || !has_room,
                ..cost
            };
        }
        Some(outcome)
    }

    /// Begins a stage: removes the points for whose id `gone` returns true, and adds those that `placed` returns for a
    /// range of the grid's columns. Surfaces marked in `idle`, which did not act so far, are anchored to the new
    /// ground. Returns the numbers of removed and added points over all ranks. Collective.
    pub fn begin_stage<P: Iterator<Item = Seed<D>>>(
        &mut self,
        gone: impl Fn(u64) -> bool,
        placed: impl FnOnce(Range<usize>) -> P,
        idle: &Idle,
    ) -> [u64; 2] {
        let water = PoreWater::of(&self.model, &self.points, self.time());
        let taken = water.map_or(0.0, |water| water.taken_by(&gone, &*self.halo));
        self.state.crossed.removed += taken;
        let before = self.points.len();
        self.points.remove(&gone);
        let left = self.points.len();
        let anchored = self.points.anchored();
        let anchors = self
            .state
            .anchors
            .without(&self.model.surfaces(), &gone, anchored, &*self.halo);
        self.state.anchors = anchors;
        let slabs = self.slabs.clone();
        let rank = self.libraries.petsc.rank();
        let grid = self.model.grid.clone();
        let seeds = placed(self.columns());
        self.points
            .place(seeds.filter(|seed| grid.locate(&seed.x).is_none_or(|cell| slabs.owner(&cell) == rank)));
        let mut numbers = [
            (before - left) as f64,
            (self.points.len() - left) as f64,
            f64::from(self.lacks_room()),
        ];
        self.halo.all_reduce_sum(&mut numbers);
        if numbers[1] > 0.0 {
            self.fill(left);
        }
        if numbers[2] > 0.0 {
            self.make_room();
        }
        if numbers[..2] != [0.0; 2] {
            self.settle_surfaces(idle);
        }
        self.points.sort_by_cell(&self.model.grid);
        if numbers[..2] != [0.0; 2] {
            self.begin_afresh();
        }
        [numbers[0] as u64, numbers[1] as u64]
    }

    /// Discards the changes of the last step: extrapolating them would be wrong after a sudden change.
    fn begin_afresh(&mut self) {
        self.stepper.begin_stage();
        self.points.forget_flow();
        self.state.flowed = None;
    }

    /// Initialises the pore water of the newly placed points from index `first` on, and adds it to the water balance.
    /// Collective.
    fn fill(&mut self, first: usize) {
        let t = self.time();
        let Some(water) = self.model.water.as_ref().filter(|water| water.flow.is_some()) else {
            return;
        };
        water.fill(&mut self.points, first, t);
        let mut placed = self.points.id[first..].to_vec();
        placed.sort_unstable();
        let water = PoreWater::of(&self.model, &self.points, t);
        let held = water.map_or(0.0, |water| {
            water.taken_by(|id| placed.binary_search(&id).is_ok(), &*self.halo)
        });
        self.state.crossed.removed -= held;
    }

    /// Anchors surfaces that did not act so far to the present ground, and moves their loads there. Collective.
    fn settle_surfaces(&mut self, idle: &Idle) {
        let boundary = &self.model.boundary;
        let anchored = self.points.anchored();
        let anchors = self
            .state
            .anchors
            .renewed(&self.model.surfaces(), idle, anchored, &*self.halo);
        let places = anchors.places(boundary, &self.model.grid, anchored, &*self.halo);
        let pressure = follower::now::<K, D>(&boundary.loads, &self.model.grid, &anchors, anchored, &*self.halo);
        let state = &mut self.state;
        state.anchors = anchors;
        for load in (0..idle.loads.len()).filter(|&load| idle.loads[load]) {
            state.position[load].clone_from(&places.loads[load]);
        }
        // Loads that continue may have new anchors where bodies were removed.
        state.pressure = pressure;
    }

    /// Replaces the laws, supports and loads by those of the model `next`, which has the same grid. Fails on all ranks
    /// if a point has no previous stress. Collective.
    pub fn exchange(&mut self, next: Model<K, D>) -> Result<(), StepError> {
        let next = Model {
            grid: self.model.grid.clone(),
            ..next
        };
        initial::exchange(&self.model, &next, &mut self.points, &*self.halo)?;
        self.model = next;
        self.begin_afresh();
        Ok(())
    }

    /// Computes the holding forces of absorbing boundaries again, after a stage has changed the ground, its supports or
    /// its loads. The free field continues. Fails on all ranks if there is no equilibrium. Collective.
    pub fn hold(&mut self) -> Result<(), StepError> {
        let t = self.time();
        let Self {
            model,
            points,
            state,
            halo,
            solver,
            ..
        } = self;
        state.held.clear();
        initial::hold_at(model, points, state, t, &**halo, solver)?;
        free_field::go_on(model, state, t)
    }

    /// Returns whether the active domain is too small for a point of this rank.
    fn lacks_room(&self) -> bool {
        let grid = &self.model.grid;
        grid.occupied(&self.points.x)
            .is_some_and(|occupied| !grid.has_room(&occupied))
    }

    /// Returns the traffic of all ranks since `before` and the balance of their loads (`load` is this rank's), and
    /// whether the active domain is large enough for the points of all ranks. One reduction.
    fn count(&self, before: TrafficCounts, load: f64) -> (Cost, bool) {
        let sent = self.timers.traffic().counts().since(&before);
        let mut numbers = vec![0.0; 3 + self.slabs.ranks()];
        numbers[..2].copy_from_slice(&sent.sent().map(|count| count as f64));
        numbers[2] = f64::from(self.lacks_room());
        numbers[3 + self.libraries.petsc.rank()] = load;
        self.halo.all_reduce_sum(&mut numbers);
        let cost = Cost {
            reductions: sent.of(TrafficKind::Reduction).calls + 1,
            messages: numbers[0] as u64,
            bytes: numbers[1] as u64,
            imbalance: load::imbalance(&numbers[3..]),
            is_cut_again: false,
        };
        (cost, numbers[2] == 0.0)
    }
}
