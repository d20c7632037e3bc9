//! Chooses strength reduction factors for trial runs: increasing until failure, then refined.

use serde::Serialize;

use super::curve::{Bracket, CurveState, DOUBLED, FactorCurve};
use super::sought::{ELASTIC, Sought};
use crate::Error;
use crate::line::{BENT, FALLEN};

/// The greatest one.
pub(super) const GREATEST: f64 = 100.0;
/// From one round of the ladder to the next. Trials before failure are cheap, those far beyond it cost many times as
/// much.
const RUNG: f64 = 1.25;
/// The end of the branch after failure need not be known as well as the rest, by this factor.
const COARSER: f64 = 2.0;
/// Rounds of closing in on a kink that moves with each of them.
const ROUNDS: usize = 8;

/// What is wanted of a search.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct SearchPlan {
    /// The least and the greatest factor.
    pub from: f64,
    pub to: f64,
    /// The width of the bands.
    pub width: f64,
    /// Strength falls with strain: no branch after failure is looked for.
    #[serde(skip)]
    pub softens: bool,
    #[serde(skip)]
    pub sought: Sought,
}

/// Why a search goes no further.
#[derive(Debug)]
pub(super) enum Halt {
    /// It needs the trial of this factor, for which it has not asked before.
    Needs(f64),
    /// No further trial would help.
    Over(Error),
}

/// What is known of the trial of a factor, as far as it is.
type Known<'a> = dyn FnMut(f64) -> Option<CurveState> + 'a;

/// A search as far as trials are known.
struct Search<'a, 'b> {
    plan: SearchPlan,
    curve: FactorCurve,
    known: &'a mut Known<'b>,
}

/// The curve with all trials that the plan needs. It follows from the trials alone, which are asked for one after the
/// other, each once; asked again with more of them, the search takes the same way to where it was.
///
/// # Errors
/// [`Halt::Needs`] at the first trial that is not known; [`Error::NoStableState`] where the elastic body or that of the
/// least factor finds no equilibrium or has failed.
pub(super) fn search(plan: SearchPlan, known: &mut Known<'_>) -> Result<FactorCurve, Halt> {
    let over = |reason: String| Halt::Over(Error::NoStableState { reason });
    let elastic = known(ELASTIC).ok_or(Halt::Needs(ELASTIC))?;
    if !(elastic.whole && elastic.displacement.is_finite() && elastic.displacement > 0.0) {
        return Err(over(
            "E0827: the first trial run (trials/0.out) has elastic soil, but finds no equilibrium or no displacement. \
             Check supports and loads, apply the loads with `ramp`, or increase `analysis.steps`."
                .to_owned(),
        ));
    }
    let curve = FactorCurve::new(elastic.displacement);
    let curve = if plan.softens { curve.without_branch() } else { curve };
    let mut search = Search { plan, curve, known };
    search.climb()?;
    if search.curve.crossing(DOUBLED).last_stable.is_none() {
        return Err(over(format!(
            "E0828: the first trial run (with the {} {}) already fails, so no stable state was found. Reduce --from. \
             If displacements in this run are small, increase `analysis.steps` instead.",
            plan.sought.value(),
            plan.from
        )));
    }
    search.close_in(DOUBLED, plan.width)?;
    let levels = [(BENT, plan.width), (FALLEN, COARSER * plan.width)];
    for (level, width) in levels.into_iter().filter(|(level, _)| *level == BENT || !plan.softens) {
        search.go_beyond(level)?;
        search.close_in(level, width)?;
    }
    search.refine()?;
    Ok(search.curve)
}

impl SearchPlan {
    /// From the least to the greatest factor.
    fn rungs(&self) -> Vec<f64> {
        let mut rungs = vec![self.from];
        for power in 1.. {
            let next = self.rounded(self.from * RUNG.powi(power));
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

    /// The factor in the middle between two others that are farther apart than the width.
    fn between(&self, low: f64, high: f64, width: f64) -> Option<f64> {
        let middle = self.rounded(low + (high - low) / 2.0);
        (high - low > width * (1.0 + 1e-9) && low < middle && middle < high).then_some(middle)
    }
}

impl Search<'_, '_> {
    fn ask(&mut self, factor: f64) -> Result<(), Halt> {
        let state = (self.known)(factor).ok_or(Halt::Needs(factor))?;
        self.curve.add([state]);
        Ok(())
    }

    /// Up the ladder to where the body has failed: its displacement has doubled, or the solver has given up twice
    /// running.
    fn climb(&mut self) -> Result<(), Halt> {
        for rung in self.plan.rungs() {
            if self.has_failed() {
                break;
            }
            self.ask(rung)?;
        }
        Ok(())
    }

    fn has_failed(&self) -> bool {
        let states = self.curve.states();
        states.iter().any(|state| self.curve.growth(state) > DOUBLED)
            || states.windows(2).any(|pair| pair.iter().all(|state| !state.whole))
    }

    /// Trials until the place where the displacement grows beyond a level is known to a width.
    fn close_in(&mut self, level: f64, width: f64) -> Result<(), Halt> {
        while let Bracket {
            last_stable: Some(low),
            first_failed: Some(high),
        } = self.curve.crossing(level)
        {
            let Some(factor) = self.plan.between(low, high, width).or_else(|| self.doubted(high)) else {
                break;
            };
            self.ask(factor)?;
        }
        Ok(())
    }

    /// A trial that found no equilibrium before it moved much may be the solver's failure: the next factor decides,
    /// unless it is known to fail as well.
    fn doubted(&self, factor: f64) -> Option<f64> {
        let state = self
            .curve
            .at(factor)
            .filter(|state| !state.whole && self.curve.growth(state) <= DOUBLED)?;
        let next = self.plan.rounded(state.factor + self.plan.width);
        let known = self
            .curve
            .states()
            .iter()
            .any(|other| state.factor < other.factor && other.factor <= next);
        (!known && next > state.factor).then_some(next)
    }

    /// Trials of growing factors until one is beyond a level.
    fn go_beyond(&mut self, level: f64) -> Result<(), Halt> {
        let mut stride = COARSER * self.plan.width;
        while let Bracket {
            last_stable: Some(top),
            first_failed: None,
        } = self.curve.crossing(level)
        {
            let factor = self.plan.rounded(top + stride);
            if factor <= top || self.curve.crossing(DOUBLED).first_failed.is_none() {
                break;
            }
            self.ask(factor)?;
            stride *= COARSER;
        }
        Ok(())
    }

    /// Trials until the kink lies in a band that is narrow enough.
    fn refine(&mut self) -> Result<(), Halt> {
        for _ in 0..ROUNDS {
            let Bracket {
                last_stable: Some(low),
                first_failed: Some(high),
            } = self.curve.kinked()
            else {
                break;
            };
            let Some(factor) = self.plan.between(low, high, self.plan.width) else {
                break;
            };
            self.ask(factor)?;
        }
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A search of a body by a formula, and the factors in the order in which they were asked for.
    pub fn searched(plan: SearchPlan, state: impl Fn(f64) -> (f64, bool)) -> (Result<FactorCurve, Error>, Vec<f64>) {
        let mut asked = Vec::new();
        let curve = search(plan, &mut |factor| {
            asked.push(factor);
            let (displacement, whole) = state(factor);
            Some(CurveState {
                factor,
                displacement,
                whole,
            })
        });
        let curve = curve.map_err(|halt| match halt {
            Halt::Needs(factor) => panic!("{factor} is known"),
            Halt::Over(error) => error,
        });
        (curve, asked)
    }

    pub const PLAN: SearchPlan = SearchPlan {
        from: 0.5,
        to: 3.0,
        width: 0.02,
        softens: false,
        sought: Sought::FactorOfSafety,
    };

    /// The displacement of a body that bends at a factor, always in equilibrium.
    pub fn hockey(kink: f64) -> impl Fn(f64) -> (f64, bool) {
        move |factor| (2.0 * (1.0 + 100.0 * (factor - kink).max(0.0)), true)
    }

    #[test]
    fn the_kink_is_found_to_the_width() {
        for kink in [0.55, 0.998, 1.373, 1.7, 2.6] {
            let (curve, asked) = searched(PLAN, hockey(kink));
            let curve = curve.unwrap();
            for band in [curve.kinked(), curve.crossing(DOUBLED)] {
                let low = band.last_stable.unwrap();
                let high = band.first_failed.unwrap();
                assert!(high - low <= PLAN.width + 1e-9, "{band:?}");
            }
            let found = curve.kink().unwrap().factor;
            assert!((found - kink).abs() < 0.005, "{found} {kink}");
            let band = curve.kinked();
            assert!(band.last_stable.unwrap() <= found && found < band.first_failed.unwrap());
            let mut distinct = asked.clone();
            distinct.sort_by(f64::total_cmp);
            distinct.dedup();
            assert_eq!(distinct.len(), asked.len(), "{asked:?}");
            assert!(
                asked
                    .iter()
                    .all(|&factor| factor == ELASTIC || (0.5..=3.0).contains(&factor))
            );
            assert!(asked.len() <= 24, "{asked:?}");
        }
    }

    #[test]
    fn a_search_halts_at_the_first_trial_that_is_not_known_and_goes_the_same_way_again() {
        let (whole, asked) = searched(PLAN, hockey(1.373));
        for (count, &next) in asked.iter().enumerate() {
            let known = |factor| asked[..count].contains(&factor).then(|| hockey(1.373)(factor));
            let halt = search(PLAN, &mut |factor| {
                known(factor).map(|(displacement, whole)| CurveState {
                    factor,
                    displacement,
                    whole,
                })
            });
            assert!(
                matches!(halt, Err(Halt::Needs(factor)) if factor == next),
                "{next} {halt:?}"
            );
        }
        assert_eq!(searched(PLAN, hockey(1.373)).0.unwrap(), whole.unwrap());
    }

    #[test]
    fn a_body_that_stands_to_the_end_is_not_tried_further() {
        let (curve, tried) = searched(PLAN, hockey(5.0));
        assert_eq!(
            curve.unwrap().crossing(DOUBLED),
            Bracket {
                last_stable: Some(3.0),
                first_failed: None
            }
        );
        assert_eq!(
            tried,
            [ELASTIC, 0.5, 0.625, 0.781, 0.977, 1.221, 1.526, 1.907, 2.384, 2.98, 3.0]
        );
    }

    #[test]
    fn without_any_stable_state_the_search_says_what_to_try() {
        let (none, tried) = searched(PLAN, hockey(0.3));
        let error = none.unwrap_err();
        assert!(
            error.exit_code() == 80 && error.to_string().contains("--from"),
            "{error}"
        );
        assert_eq!(tried, [ELASTIC, 0.5]);
        let (none, ..) = searched(PLAN, |_| (1.0, false));
        assert!(none.unwrap_err().to_string().contains("no equilibrium"));
        // A weightless body.
        let (none, ..) = searched(PLAN, |_| (0.0, true));
        assert_eq!(none.unwrap_err().exit_code(), 80);
    }

    #[test]
    fn a_body_without_equilibrium_after_failure_has_its_band_there() {
        let (curve, _) = searched(PLAN, |factor| (1.0, factor < 1.373));
        let band = curve.unwrap().kinked();
        let low = band.last_stable.unwrap();
        let high = band.first_failed.unwrap();
        assert!(
            low < 1.373 && 1.373 <= high && high - low <= PLAN.width + 1e-9,
            "{band:?}"
        );
    }

    #[test]
    fn a_solver_that_fails_once_does_not_end_the_search() {
        // About a rung of the ladder, and where the search closes in.
        for (from, to) in [(1.22, 1.23), (1.36, 1.365), (0.77, 0.79)] {
            let (curve, tried) = searched(PLAN, |factor| {
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
