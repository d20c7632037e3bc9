//! Runs trials of `bsmpm fos` in parallel, and stops unneeded ones.

use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, Scope};

use super::curve::{CurveState, FactorCurve};
use super::guess;
use super::search::{Halt, SearchPlan, search};
use crate::Error;
use crate::launch::Stop;

/// For each trial at the same time, so many guesses of what may be asked for: a trial that begins is one of the first
/// of them, a trial that goes on one of all.
const HORIZON: usize = 4;

/// Where trials come from. The trial of a factor is the same whenever it is made, and whatever else is.
pub(super) trait JobSource: Sync {
    type Trial: Send;

    /// The trial if it is there from before.
    fn kept(&self, factor: f64) -> Result<Option<Self::Trial>, Error>;

    /// Makes the trial; an error if it is stopped before it ends.
    fn make(&self, factor: f64, stop: &Stop) -> Result<Self::Trial, Error>;

    /// What the judge sees of it.
    fn state(trial: &Self::Trial) -> CurveState;
}

/// A trial that is being made.
struct Running {
    factor: f64,
    stop: Arc<Stop>,
}

/// What became of a trial.
type TrialResult<T> = (f64, Result<T, Error>);

/// Trials under way, and those there are.
struct Jobs<'a, S: JobSource> {
    plan: SearchPlan,
    most: usize,
    source: &'a S,
    running: Vec<Running>,
    /// those for which the search has not asked yet
    made: Vec<TrialResult<S::Trial>>,
    asked: Vec<S::Trial>,
    sender: Sender<TrialResult<S::Trial>>,
    receiver: Receiver<TrialResult<S::Trial>>,
}

/// The curve of a search, with up to `most` trials at the same time, and the trials for which it has asked, in that
/// order; `report` gets each as soon as it counts.
///
/// # Errors
/// Those of the search, and of trials for which it has asked. No trial is left running.
pub(super) fn find<S: JobSource>(
    plan: SearchPlan,
    most: usize,
    source: &S,
    mut report: impl FnMut(&S::Trial),
) -> Result<(FactorCurve, Vec<S::Trial>), Error> {
    let (sender, receiver) = mpsc::channel();
    let mut jobs = Jobs {
        plan,
        most,
        source,
        running: Vec::new(),
        made: Vec::new(),
        asked: Vec::new(),
        sender,
        receiver,
    };
    let curve = thread::scope(|scope| {
        let curve = jobs.curve(scope, &mut report);
        jobs.running.iter().for_each(|running| running.stop.ask());
        curve
    })?;
    Ok((curve, jobs.asked))
}

impl<'a, S: JobSource> Jobs<'a, S> {
    fn curve<'scope>(
        &mut self,
        scope: &'scope Scope<'scope, 'a>,
        report: &mut dyn FnMut(&S::Trial),
    ) -> Result<FactorCurve, Error> {
        loop {
            match search(self.plan, &mut |factor| self.ask(factor, report)) {
                Ok(curve) => return Ok(curve),
                Err(Halt::Over(error)) => return Err(error),
                Err(Halt::Needs(factor)) => self.bring(factor, scope)?,
            }
        }
    }

    /// The answer to the search.
    fn ask(&mut self, factor: f64, report: &mut dyn FnMut(&S::Trial)) -> Option<CurveState> {
        if let Some(index) = self.made.iter().position(|made| made.0 == factor && made.1.is_ok()) {
            let trial = self.made.swap_remove(index).1.ok()?;
            report(&trial);
            self.asked.push(trial);
        }
        self.asked.iter().map(S::state).find(|state| state.factor == factor)
    }

    /// What is known, whether the search has asked for it or not.
    fn known(&self, factor: f64) -> Option<CurveState> {
        let made = self.made.iter().filter_map(|made| made.1.as_ref().ok());
        self.asked
            .iter()
            .chain(made)
            .map(S::state)
            .find(|state| state.factor == factor)
    }

    /// One trial more, of those on the way to the one that the search needs.
    fn bring<'scope>(&mut self, needed: f64, scope: &'scope Scope<'scope, 'a>) -> Result<(), Error> {
        if let Some(index) = self.made.iter().position(|made| made.0 == needed) {
            // It is no answer, so it broke.
            return self.made.swap_remove(index).1.map(|_| ());
        }
        // While trials are there from before nothing needs to be run.
        if !self.is_running(needed) && self.takes(needed) {
            return Ok(());
        }
        let wanted = guess::ahead(self.plan, &|factor| self.known(factor), HORIZON * self.most);
        self.make_room(&wanted);
        for &factor in &wanted {
            let is_new = !self.is_running(factor) && self.made.iter().all(|made| made.0 != factor);
            if is_new && self.running.len() < self.most && (factor == needed || !self.takes(factor)) {
                self.begin(factor, scope);
            }
        }
        self.wait();
        Ok(())
    }

    fn is_running(&self, factor: f64) -> bool {
        self.running.iter().any(|running| running.factor == factor)
    }

    /// Whether the trial is there from before; if it cannot be read, that is what the search hears, should it ask.
    fn takes(&mut self, factor: f64) -> bool {
        let kept = self.source.kept(factor).transpose();
        let is_there = kept.is_some();
        self.made.extend(kept.map(|kept| (factor, kept)));
        is_there
    }

    /// Stops the trials for which the search will not ask, and one more if the first wanted one would have to wait
    /// otherwise.
    fn make_room(&self, wanted: &[f64]) {
        let rank = |running: &Running| wanted.iter().position(|&factor| factor == running.factor);
        self.running
            .iter()
            .filter(|running| rank(running).is_none())
            .for_each(|running| running.stop.ask());
        let is_full = self.running.len() >= self.most && self.running.iter().all(|running| !running.stop.is_asked());
        if is_full && !self.is_running(wanted[0]) {
            self.running
                .iter()
                .max_by_key(|running| rank(running))
                .inspect(|running| running.stop.ask());
        }
    }

    fn begin<'scope>(&mut self, factor: f64, scope: &'scope Scope<'scope, 'a>) {
        let stop = Arc::new(Stop::default());
        self.running.push(Running {
            factor,
            stop: Arc::clone(&stop),
        });
        let source = self.source;
        let sender = self.sender.clone();
        scope.spawn(move || {
            // Nobody listens once the search is over.
            let _ = sender.send((factor, source.make(factor, &stop)));
        });
    }

    /// For the next end of a trial.
    fn wait(&mut self) {
        let made = self.receiver.recv().expect("the other end is held here");
        let index = self
            .running
            .iter()
            .position(|running| running.factor == made.0)
            .expect("it was begun");
        let Running { stop, .. } = self.running.swap_remove(index);
        // One that was stopped may have ended by itself before; if not, it is as if it had never begun.
        if made.1.is_ok() || !stop.is_asked() {
            self.made.push(made);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::time::Duration;

    use super::super::search::tests::{PLAN, hockey, searched};
    use super::*;

    /// Trials of a body by a formula, each of which takes a time by chance.
    struct Body<'a> {
        state: &'a (dyn Fn(f64) -> (f64, bool) + Sync),
        seed: u64,
        is_kept: &'a (dyn Fn(f64) -> bool + Sync),
        breaks: &'a (dyn Fn(f64) -> bool + Sync),
        /// those under way, the most there were, and all that ended by themselves
        count: Mutex<(Vec<f64>, usize, Vec<f64>)>,
    }

    impl<'a> Body<'a> {
        fn new(state: &'a (dyn Fn(f64) -> (f64, bool) + Sync), seed: u64) -> Self {
            Self {
                state,
                seed,
                is_kept: &|_| false,
                breaks: &|_| false,
                count: Mutex::default(),
            }
        }

        fn trial(&self, factor: f64) -> CurveState {
            let (displacement, whole) = (self.state)(factor);
            CurveState {
                factor,
                displacement,
                whole,
            }
        }

        /// Whether it ended by itself.
        fn passes(&self, factor: f64, stop: &Stop) -> bool {
            let milliseconds = (factor * 1e3) as u64 * (7 + self.seed) % 5;
            (0..milliseconds).all(|_| {
                thread::sleep(Duration::from_millis(1));
                !stop.is_asked()
            })
        }
    }

    fn broken(factor: f64) -> Error {
        Error::Run {
            what: format!("the trial {factor}"),
            code: 70,
            reason: String::new(),
        }
    }

    impl JobSource for Body<'_> {
        type Trial = CurveState;

        fn kept(&self, factor: f64) -> Result<Option<CurveState>, Error> {
            Ok((self.is_kept)(factor).then(|| self.trial(factor)))
        }

        fn make(&self, factor: f64, stop: &Stop) -> Result<CurveState, Error> {
            let mut count = self.count.lock().unwrap();
            let is_alone = !count.0.contains(&factor);
            count.0.push(factor);
            count.1 = count.1.max(count.0.len());
            drop(count);
            let passes = self.passes(factor, stop);
            let mut count = self.count.lock().unwrap();
            count.0.retain(|&other| other != factor);
            if !passes || !is_alone || (self.breaks)(factor) {
                return Err(broken(factor));
            }
            count.2.push(factor);
            Ok(self.trial(factor))
        }

        fn state(trial: &CurveState) -> CurveState {
            *trial
        }
    }

    #[test]
    fn neither_the_number_of_jobs_nor_who_ends_first_changes_the_search() {
        let bodies: [&(dyn Fn(f64) -> (f64, bool) + Sync); 7] = [
            &hockey(0.55),
            &hockey(1.373),
            &hockey(2.6),
            &hockey(5.0),
            &hockey(0.3),
            &|factor| (1.0, factor < 1.373),
            &|factor| (hockey(1.4)(factor).0, !(1.22..1.23).contains(&factor)),
        ];
        for body in bodies {
            let (curve, asked) = searched(PLAN, body);
            let curve = curve.map_err(|error| error.to_string());
            for (most, seed) in (1..=4).flat_map(|most| (0..4).map(move |seed| (most, seed))) {
                let source = Body::new(body, seed);
                let mut report = Vec::new();
                let found = find(PLAN, most, &source, |trial| report.push(trial.factor));
                assert_eq!(report, asked, "{most} jobs");
                let found = found.map_err(|error| error.to_string()).map(|found| found.0);
                assert_eq!(found, curve, "{most} jobs");
                let (left, together, made) = source.count.into_inner().unwrap();
                assert!(left.is_empty() && together <= most, "{left:?} {together}");
                assert!(most > 1 || made == asked, "{made:?}");
            }
        }
    }

    #[test]
    fn trials_that_are_there_are_not_made_and_none_begin_beside_them() {
        let body = hockey(1.373);
        let (_, asked) = searched(PLAN, &body);
        for most in [1, 2, 4] {
            let source = Body {
                is_kept: &|factor| asked.contains(&factor),
                ..Body::new(&body, 0)
            };
            let (_, trials) = find(PLAN, most, &source, |_| ()).unwrap();
            assert!(trials.iter().map(|trial| trial.factor).eq(asked.iter().copied()));
            assert_eq!(source.count.into_inner().unwrap().1, 0);
        }
    }

    #[test]
    fn a_trial_that_breaks_counts_only_if_it_is_asked_for() {
        let body = hockey(1.373);
        let (curve, asked) = searched(PLAN, &body);
        for (most, seed) in [(1, 0), (2, 0), (3, 0), (4, 0), (4, 1), (4, 2)] {
            let source = Body {
                breaks: &|factor| !asked.contains(&factor),
                ..Body::new(&body, seed)
            };
            assert_eq!(
                find(PLAN, most, &source, |_| ()).map(|found| found.0).unwrap(),
                *curve.as_ref().unwrap()
            );
            for from in [asked[0], asked[4], asked[9]] {
                let source = Body {
                    breaks: &|factor| factor >= from,
                    ..Body::new(&body, seed)
                };
                let first = asked.iter().position(|&factor| factor >= from).unwrap();
                let mut report = Vec::new();
                let error = find(PLAN, most, &source, |trial| report.push(trial.factor)).unwrap_err();
                assert_eq!(error.to_string(), broken(asked[first]).to_string());
                assert_eq!(report, asked[..first]);
            }
        }
    }
}
