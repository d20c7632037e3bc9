//! Step size control. A failed step is halved; the step size is doubled again after two easy steps. Step sizes are the
//! nominal one divided by powers of two, so the nominal end is reached exactly.

use crate::dynamics::newmark::Newmark;
use crate::energy::{EnergyBound, StoredEnergy};
use crate::error::{Severity, StepError};
use crate::grid::extension::ExtendedSplines;
use crate::interactions::artificial_stiffness::ResistedDisplacement;
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::method::Criteria;
use crate::model::{Model, Regime};
use crate::parallel::Halo;
use crate::points::Points;
use crate::schedule::{Schedule, TimeInterval};
use crate::solve::Backend;
use crate::step::{Counts, StepReport, step};
use std::borrow::Cow;

/// Halvings of the nominal step after which the run stops.
const MOST_CUTS: u32 = 10;
/// Ticks of a nominal step, its smallest parts.
const TICKS: u32 = 1 << MOST_CUTS;
/// Number of consecutive easy steps after which the step size is doubled.
const EASY: u32 = 2;

/// A converged step.
#[derive(Clone, Debug)]
pub struct AcceptedStep {
    /// Time at the end of the step (s).
    pub t: f64,
    /// Step size (s).
    pub dt: f64,
    /// Report of the step.
    pub report: StepReport,
    /// Work of all attempts, including rejected ones.
    pub counts: Counts,
    /// Errors of the rejected attempts, in order.
    pub rejected: Vec<StepError>,
}

/// A step that failed down to the smallest size, or with an error that a smaller step cannot avoid.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Time of the last converged state (s).
    pub t: f64,
    /// Step size of the last attempt (s).
    pub dt: f64,
    /// Errors of the attempts, in order.
    pub attempts: Vec<StepError>,
    /// Work of all attempts.
    pub counts: Counts,
}

impl Failure {
    /// Returns whether the step was interrupted on request, not by an error.
    pub fn is_interruption(&self) -> bool {
        self.attempts.last() == Some(&StepError::Interrupted)
    }
}

/// State of the step size control between two steps, sufficient to restart it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Time of the last converged state (s).
    pub t: f64,
    /// Size of the last converged step (s); 0 before the first.
    pub guess_dt: f64,
    /// Start and end of the current nominal step (s), if any.
    pub nominal: Option<(f64, f64)>,
    /// Completed ticks of the nominal step.
    pub tick: u32,
    /// Number of halvings of the nominal step.
    pub cuts: u32,
    /// Number of consecutive easy steps.
    pub easy: u32,
    /// Energy bound, in dynamics from the first step on.
    pub budget: Option<EnergyBound>,
}

/// Step size control with the last converged displacement.
#[derive(Clone, Debug)]
pub struct Stepper {
    /// Nodal displacement of the last converged step (m), D numbers per node of the window.
    pub guess: Vec<f64>,
    at: Progress,
}

impl Stepper {
    /// Starts at time 0 from zero displacement; `unknowns` is the length of the nodal array.
    pub fn new(unknowns: usize) -> Self {
        Self {
            guess: vec![0.0; unknowns],
            at: Progress::default(),
        }
    }

    /// Restarts from saved progress; `None` if the progress is inconsistent. If `schedule` does not contain the end of
    /// the saved nominal step, a new nominal step begins.
    pub fn resume(guess: Vec<f64>, mut at: Progress, schedule: &Schedule) -> Option<Self> {
        let times = [at.t, at.guess_dt]
            .into_iter()
            .chain(at.nominal.into_iter().flat_map(|(from, to)| [from, to]));
        let budget = at.budget.map_or([0.0; 6], |budget| budget.numbers());
        let sound = times.chain(budget).all(f64::is_finite) && at.cuts <= MOST_CUTS && at.tick < TICKS;
        if !sound || !at.tick.is_multiple_of(TICKS >> at.cuts) {
            return None;
        }
        if at.nominal.is_some_and(|(from, to)| schedule.next(from) != Some(to)) {
            (at.nominal, at.tick) = (None, 0);
        }
        Some(Self { guess, at })
    }

    /// Begins a stage. What moved or strained the points may have been removed, so the next step starts from zero
    /// displacement, and the energy bound from the points that are present now.
    pub fn begin_stage(&mut self) {
        (self.at.guess_dt, self.at.budget) = (0.0, None);
    }

    /// Returns the progress.
    pub fn progress(&self) -> Progress {
        self.at
    }

    /// Returns the time of the last converged state (s).
    pub fn time(&self) -> f64 {
        self.at.t
    }

    /// Makes one accepted step towards the end of `schedule`; `None` if the end is reached. Fails before the step if
    /// the energy of the previous steps exceeds its bound.
    pub fn advance<K: Kinematics<D>, const D: usize>(
        &mut self,
        schedule: &Schedule,
        model: &Model<K, D>,
        points: &mut Points<D>,
        state: &mut InteractionState<D>,
        halo: &dyn Halo,
        solver: &mut dyn LinearSolver,
    ) -> Option<Result<AcceptedStep, Failure>> {
        if let Err(made) = self.at.budget.map_or(Ok(()), |budget| budget.require()) {
            return Some(Err(self.failure(self.at.guess_dt, vec![made], Counts::default())));
        }
        let before = (self.at.cuts, self.at.easy, self.at.budget);
        let (from, to) = self.begin(schedule, model, points, halo)?;
        let mut rejected = Vec::new();
        let mut counts = Counts::default();
        let mut has_drag = false; // whether the artificial stiffness resists the complete displacement in the next attempt
        loop {
            let end = self.end_of_attempt(from, to);
            let dt = end - self.at.t;
            let resisted = match has_drag {
                true => ResistedDisplacement::Whole,
                false => self.resisted(model, dt),
            };
            let interval = TimeInterval { start: self.at.t, dt };
            let backend = &mut Backend {
                halo,
                solver,
                counts: &mut counts,
            };
            let error = match self.attempt(model, points, state, interval, resisted, backend) {
                Ok((report, guess)) => {
                    (self.guess, self.at.guess_dt, self.at.t) = (guess, dt, end);
                    self.accept(&report, &model.criteria);
                    return Some(Ok(AcceptedStep {
                        t: end,
                        dt,
                        report,
                        counts,
                        rejected,
                    }));
                }
                Err(error) => error,
            };
            let is_final = error.meaning().severity == Severity::Final;
            rejected.push(error);
            if rejected.last() == Some(&StepError::Interrupted) {
                // Restores the state as before this call, so that a restarted run makes the same attempts.
                (self.at.cuts, self.at.easy, self.at.budget) = before;
                return Some(Err(self.failure(dt, rejected, counts)));
            }
            has_drag = resisted == ResistedDisplacement::Change && !is_final;
            if has_drag {
                continue;
            }
            if is_final || self.at.cuts == MOST_CUTS {
                // A restart with another nominal step begins as this step did.
                (self.at.cuts, self.at.easy, _) = before;
                return Some(Err(self.failure(dt, rejected, counts)));
            }
            (self.at.cuts, self.at.easy) = (self.at.cuts + 1, 0);
        }
    }

    /// Attempts a step over `interval`. Returns its report and the converged nodal displacement (m).
    fn attempt<K: Kinematics<D>, const D: usize>(
        &self,
        model: &Model<K, D>,
        points: &mut Points<D>,
        state: &mut InteractionState<D>,
        interval: TimeInterval,
        resisted: ResistedDisplacement,
        backend: &mut Backend<'_>,
    ) -> Result<(StepReport, Vec<f64>), StepError> {
        let mut guess = self.scaled_guess(interval.dt);
        let model = self.with_sudden_forces(model.over(interval.dt));
        let report = step(&model, points, state, &mut guess, interval, resisted, backend)?;
        Ok((report, guess))
    }

    /// Begins a nominal step unless one is in progress, and returns its start and end (s); `None` at the end of the
    /// schedule. In dynamics the first step of a stage creates the energy bound.
    fn begin<K: Kinematics<D>, const D: usize>(
        &mut self,
        schedule: &Schedule,
        model: &Model<K, D>,
        points: &Points<D>,
        halo: &dyn Halo,
    ) -> Option<(f64, f64)> {
        let nominal = match self.at.nominal {
            Some(nominal) => nominal,
            None => (self.at.t, schedule.next(self.at.t)?),
        };
        self.at.nominal = Some(nominal);
        if model.regime == Regime::Dynamic && self.at.budget.is_none() {
            self.at.budget = Some(EnergyBound::open(StoredEnergy::of(model, points, self.at.t, halo)));
        }
        Some(nominal)
    }

    /// Returns the end of the next attempt in a nominal step, s.
    fn end_of_attempt(&self, from: f64, to: f64) -> f64 {
        let done = self.at.tick + (TICKS >> self.at.cuts);
        if done == TICKS {
            to
        } else {
            from + (to - from) * fraction(done)
        }
    }

    fn failure(&self, dt: f64, attempts: Vec<StepError>, counts: Counts) -> Failure {
        Failure {
            t: self.at.t,
            dt,
            attempts,
            counts,
        }
    }

    /// Returns the model for the first step of a stage. Forces act there at once that the points' acceleration
    /// does not include.
    fn with_sudden_forces<'a, K: Kinematics<D>, const D: usize>(
        &self,
        model: Cow<'a, Model<K, D>>,
    ) -> Cow<'a, Model<K, D>> {
        let begins = self.at.guess_dt == 0.0 && self.at.t > 0.0 && model.regime == Regime::Dynamic;
        if begins {
            Cow::Owned(Model {
                newmark: Newmark::for_sudden_load(),
                ..model.into_owned()
            })
        } else {
            model
        }
    }

    /// Selects what the artificial stiffness resists in a step of size `dt` (s): the change from the last step if
    /// prescribed motion continues steadily and splines of nearly empty cells are tied. Under loads there is no steady
    /// flow, and the complete displacement is resisted.
    fn resisted<K, const D: usize>(&self, model: &Model<K, D>, dt: f64) -> ResistedDisplacement {
        let is_tied = model.artificial_stiffness.is_some() && model.extended_splines == ExtendedSplines::Linear;
        let last_dt = self.at.guess_dt;
        match is_tied && last_dt > 0.0 && model.boundary.moves_steadily(self.at.t, last_dt, dt) {
            true => ResistedDisplacement::Change,
            false => ResistedDisplacement::Whole,
        }
    }

    /// Scales the last displacement by the ratio of the step sizes (step 3b).
    fn scaled_guess(&self, dt: f64) -> Vec<f64> {
        if self.at.guess_dt == 0.0 {
            return vec![0.0; self.guess.len()];
        }
        let ratio = dt / self.at.guess_dt;
        self.guess.iter().map(|u| ratio * u).collect()
    }

    /// Advances the step size control after an accepted step and records its energy.
    fn accept(&mut self, report: &StepReport, criteria: &Criteria) {
        if let (Some(budget), Some(turnover)) = (&mut self.at.budget, &report.turnover) {
            budget.enter(turnover);
            if let Some(outflow) = &report.outflow {
                budget.exchange(&outflow.stored);
            }
        }
        let is_easy = report.first_guess && report.iterations * 2 <= criteria.max_iterations;
        let size = TICKS >> self.at.cuts;
        self.at.tick += size;
        self.at.easy = if is_easy { self.at.easy + 1 } else { 0 };
        if self.at.tick == TICKS {
            (self.at.tick, self.at.nominal) = (0, None);
        }
        if self.at.cuts > 0 && self.at.easy >= EASY && self.at.tick.is_multiple_of(2 * size) {
            self.at.cuts -= 1;
            self.at.easy = 0;
        }
    }
}

fn fraction(tick: u32) -> f64 {
    f64::from(tick) / f64::from(TICKS)
}
