//! Which factors are tried: up a ladder until the body fails, then closer and closer about the places where its displacement
//! doubles, where the branch after failure begins and ends, and where both branches meet. It knows no runs.

use serde::Serialize;

use super::curve::{BENT, Band, Curve, DOUBLED, FALLEN, State};
use crate::Error;

/// Strength is multiplied by ten to see the elastic displacement. The least factor that a case may have.
pub(super) const ELASTIC: f64 = 0.1;
/// The greatest one.
pub(super) const GREATEST: f64 = 100.0;
/// From one round of the ladder to the next. Trials before failure are cheap, those far beyond it cost many times as much.
const RUNG: f64 = 1.25;
/// The end of the branch after failure need not be known as well as the rest, by this factor.
const COARSER: f64 = 2.0;
/// Rounds of closing in on a kink that moves with each of them.
const ROUNDS: usize = 8;

/// What is wanted of a search.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Plan {
    /// The least and the greatest factor.
    pub from: f64,
    pub to: f64,
    /// The width of the bands.
    pub width: f64,
    /// Trials at the same time.
    pub jobs: usize,
}

/// Makes the trials of some factors.
type Maker<'a> = dyn FnMut(&[f64]) -> Result<Vec<State>, Error> + 'a;

/// A search under way; `trials` are made by a function, of whose factors none was tried before.
struct Search<'a, 'b> {
    plan: Plan,
    curve: Curve,
    trials: &'a mut Maker<'b>,
}

/// The curve with all trials that the plan needs.
///
/// # Errors
/// [`Error::NoStableState`] where the elastic body or that of the least factor finds no equilibrium or has failed, those of
/// `trials`.
pub(super) fn search(plan: Plan, trials: &mut Maker<'_>) -> Result<Curve, Error> {
    let rungs = plan.rungs();
    let (first, others) = rungs.split_at(plan.jobs.saturating_sub(1).min(rungs.len()));
    let mut states = trials(&[&[ELASTIC], first].concat())?;
    let elastic = states.remove(0);
    if !(elastic.whole && elastic.displacement.is_finite() && elastic.displacement > 0.0) {
        return Err(Error::NoStableState {
            reason: format!(
                "even with {} times its strength the body finds no equilibrium under its load, or does not move: look at \
                 that trial, and at the case's supports, load steps and [solver] max_iterations",
                1.0 / ELASTIC
            ),
        });
    }
    let mut curve = Curve::new(elastic.displacement);
    curve.add(states);
    let mut search = Search { plan, curve, trials };
    search.climb(others)?;
    if search.curve.crossing(DOUBLED).last_stable.is_none() {
        return Err(Error::NoStableState {
            reason: format!(
                "no stable state was found down to the factor {}: try a smaller --from, or look at the trial of that factor \
                 for what fails: the body, or the solver ([solver] max_iterations, more load steps)",
                plan.from
            ),
        });
    }
    search.close_in(DOUBLED, plan.width)?;
    for (level, width) in [(BENT, plan.width), (FALLEN, COARSER * plan.width)] {
        search.go_beyond(level)?;
        search.close_in(level, width)?;
    }
    search.refine()?;
    Ok(search.curve)
}

impl Plan {
    /// From the least to the greatest factor, as many in every round as run at the same time.
    fn rungs(&self) -> Vec<f64> {
        let ratio = RUNG.powf(1.0 / self.jobs as f64);
        let mut rungs = vec![self.from];
        for power in 1.. {
            let next = self.rounded(self.from * ratio.powi(power));
            if next >= self.to - 0.5 * self.width {
                break;
            }
            rungs.push(next);
        }
        rungs.push(self.to);
        rungs
    }

    /// To a tenth of the last digit that the width shows; never out of the range.
    fn rounded(&self, factor: f64) -> f64 {
        let digits = (1.0 - self.width.log10().floor()).max(1.0) as i32;
        let unit = 10.0_f64.powi(digits);
        ((factor * unit).round() / unit).clamp(self.from, self.to)
    }

    /// Factors between two others that leave gaps of at least the width, as many as run at the same time.
    fn between(&self, low: f64, high: f64, width: f64) -> Vec<f64> {
        let gaps = ((high - low) / width * (1.0 - 1e-9)).ceil() as usize;
        let count = self.jobs.min(gaps.saturating_sub(1));
        let place = |index: usize| self.rounded(low + (high - low) * index as f64 / (count + 1) as f64);
        let mut factors: Vec<f64> = (1..=count).map(place).filter(|&factor| low < factor && factor < high).collect();
        factors.dedup();
        factors
    }
}

impl Search<'_, '_> {
    fn try_all(&mut self, factors: &[f64]) -> Result<(), Error> {
        let states = (self.trials)(factors)?;
        self.curve.add(states);
        Ok(())
    }

    /// Up the ladder to where the body has failed: its displacement has doubled, or the solver has given up twice running.
    fn climb(&mut self, rungs: &[f64]) -> Result<(), Error> {
        for round in rungs.chunks(self.plan.jobs) {
            if self.has_failed() {
                break;
            }
            self.try_all(round)?;
        }
        Ok(())
    }

    fn has_failed(&self) -> bool {
        let states = self.curve.states();
        states.iter().any(|state| self.curve.growth(state) > DOUBLED)
            || states.windows(2).any(|pair| pair.iter().all(|state| !state.whole))
    }

    /// Trials until the place where the displacement grows beyond a level is known to a width.
    fn close_in(&mut self, level: f64, width: f64) -> Result<(), Error> {
        while let Band { last_stable: Some(low), first_failed: Some(high) } = self.curve.crossing(level) {
            let factors = self.plan.between(low, high, width);
            let factors = if factors.is_empty() { self.doubted(high).into_iter().collect() } else { factors };
            if factors.is_empty() {
                break;
            }
            self.try_all(&factors)?;
        }
        Ok(())
    }

    /// A trial that found no equilibrium before it moved much may be the solver's failure: the next factor tells, unless it
    /// is known to fail as well.
    fn doubted(&self, factor: f64) -> Option<f64> {
        let state = self.curve.at(factor).filter(|state| !state.whole && self.curve.growth(state) <= DOUBLED)?;
        let next = self.plan.rounded(state.factor + self.plan.width);
        let known = self.curve.states().iter().any(|other| state.factor < other.factor && other.factor <= next);
        (!known && next > state.factor).then_some(next)
    }

    /// Trials of growing factors until one is beyond a level.
    fn go_beyond(&mut self, level: f64) -> Result<(), Error> {
        let mut stride = COARSER * self.plan.width;
        while let Band { last_stable: Some(top), first_failed: None } = self.curve.crossing(level) {
            let steps = (1..=self.plan.jobs).map(|step| self.plan.rounded(top + stride * step as f64));
            let mut factors: Vec<f64> = steps.filter(|&factor| factor > top).collect();
            factors.dedup();
            if factors.is_empty() || self.curve.crossing(DOUBLED).first_failed.is_none() {
                break;
            }
            self.try_all(&factors)?;
            stride *= COARSER;
        }
        Ok(())
    }

    /// Trials until the kink lies in a band that is narrow enough.
    fn refine(&mut self) -> Result<(), Error> {
        for _ in 0..ROUNDS {
            let Band { last_stable: Some(low), first_failed: Some(high) } = self.curve.kinked() else { break };
            let factors = self.plan.between(low, high, self.plan.width);
            if factors.is_empty() {
                break;
            }
            self.try_all(&factors)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Trials of a body by a formula, and the factors in the order in which they were tried.
    fn searched(plan: Plan, state: impl Fn(f64) -> (f64, bool)) -> (Result<Curve, Error>, Vec<f64>, Vec<usize>) {
        let (mut tried, mut rounds) = (Vec::new(), Vec::new());
        let curve = search(plan, &mut |factors: &[f64]| {
            tried.extend_from_slice(factors);
            rounds.push(factors.len());
            Ok(factors
                .iter()
                .map(|&factor| {
                    let (displacement, whole) = state(factor);
                    State { factor, displacement, whole }
                })
                .collect())
        });
        (curve, tried, rounds)
    }

    const PLAN: Plan = Plan { from: 0.5, to: 3.0, width: 0.02, jobs: 1 };

    fn hockey(kink: f64) -> impl Fn(f64) -> (f64, bool) {
        move |factor| (2.0 * (1.0 + 100.0 * (factor - kink).max(0.0)), true)
    }

    #[test]
    fn the_kink_is_found_to_the_width_whatever_the_number_of_jobs() {
        for jobs in [1, 2, 3, 8] {
            for kink in [0.55, 0.998, 1.373, 1.7, 2.6] {
                let (curve, tried, rounds) = searched(Plan { jobs, ..PLAN }, hockey(kink));
                let curve = curve.unwrap();
                for band in [curve.kinked(), curve.crossing(DOUBLED)] {
                    let (low, high) = (band.last_stable.unwrap(), band.first_failed.unwrap());
                    assert!(high - low <= PLAN.width + 1e-9, "{band:?}");
                }
                let found = curve.kink().unwrap().factor;
                assert!((found - kink).abs() < 0.005, "{found} {kink}");
                let band = curve.kinked();
                assert!(band.last_stable.unwrap() <= found && found < band.first_failed.unwrap());
                let mut distinct = tried.clone();
                distinct.sort_by(f64::total_cmp);
                distinct.dedup();
                assert_eq!(distinct.len(), tried.len(), "{tried:?}");
                assert!(tried.iter().all(|&factor| factor == ELASTIC || (0.5..=3.0).contains(&factor)));
                assert!(rounds.iter().all(|&round| round <= jobs) && tried.len() <= 24 + 6 * jobs, "{tried:?}");
            }
        }
    }

    #[test]
    fn more_jobs_take_fewer_rounds() {
        let rounds = |jobs| searched(Plan { jobs, ..PLAN }, hockey(1.373)).2.len();
        assert!(rounds(2) < rounds(1) && rounds(4) < rounds(2), "{} {} {}", rounds(1), rounds(2), rounds(4));
    }

    #[test]
    fn a_body_that_stands_to_the_end_is_not_tried_further() {
        let (curve, tried, _) = searched(PLAN, hockey(5.0));
        assert_eq!(curve.unwrap().crossing(DOUBLED), Band { last_stable: Some(3.0), first_failed: None });
        assert_eq!(tried, [0.1, 0.5, 0.625, 0.781, 0.977, 1.221, 1.526, 1.907, 2.384, 2.98, 3.0]);
    }

    #[test]
    fn without_any_stable_state_the_search_says_what_to_try() {
        let (none, tried, _) = searched(PLAN, hockey(0.3));
        let error = none.unwrap_err();
        assert!(error.exit_code() == 80 && error.to_string().contains("--from"), "{error}");
        assert_eq!(tried, [0.1, 0.5]);
        let (none, ..) = searched(PLAN, |_| (1.0, false));
        assert!(none.unwrap_err().to_string().contains("no equilibrium"));
        // A weightless body.
        let (none, ..) = searched(PLAN, |_| (0.0, true));
        assert_eq!(none.unwrap_err().exit_code(), 80);
    }

    #[test]
    fn a_body_without_equilibrium_after_failure_has_its_band_there() {
        for jobs in [1, 2] {
            let (curve, ..) = searched(Plan { jobs, ..PLAN }, |factor| (1.0, factor < 1.373));
            let band = curve.unwrap().kinked();
            let (low, high) = (band.last_stable.unwrap(), band.first_failed.unwrap());
            assert!(low < 1.373 && 1.373 <= high && high - low <= PLAN.width + 1e-9, "{band:?}");
        }
    }

    #[test]
    fn a_solver_that_fails_once_does_not_end_the_search() {
        // About a rung of the ladder, and where the search closes in.
        for (from, to) in [(1.22, 1.23), (1.36, 1.365), (0.77, 0.79)] {
            let (curve, tried, _) = searched(PLAN, |factor| {
                let (displacement, _) = hockey(1.4)(factor);
                (displacement, !(from..to).contains(&factor))
            });
            let curve = curve.unwrap();
            assert!((curve.kink().unwrap().factor - 1.4).abs() < 0.005, "{tried:?}");
            let failed = tried.iter().filter(|factor| (from..to).contains(*factor)).count();
            assert_eq!(curve.isolated().len(), failed);
        }
    }
}
