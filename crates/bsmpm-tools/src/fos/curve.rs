//! Decides from the curve of displacement against strength reduction factor whether the ground failed.

use crate::line::{BENT, FALLEN, FittedLine};

/// Failure, coarsely: this many times the elastic displacement.
pub(super) const DOUBLED: f64 = 2.0;
/// Where the trials after the kink find no equilibrium: the end of the branch must show this many times BENT.
const SHORTEST: f64 = 2.0;
/// The branch before failure: up to this many times the elastic displacement.
const STRAIGHT: f64 = 1.25;

/// What a trial shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CurveState {
    /// by which the strength is divided
    pub factor: f64,
    /// the displacement that decides, in the unit of the history; of the last equilibrium that was found
    pub displacement: f64,
    /// whether equilibrium was found under the whole load
    pub whole: bool,
}

/// The trials in the order of their factors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FactorCurve {
    /// the displacement of the elastic body
    elastic: f64,
    /// whether a branch after failure leads back to a kink
    has_branch: bool,
    states: Vec<CurveState>,
}

/// The greatest factor of stable trials, and the least one of failed trials above it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bracket {
    pub last_stable: Option<f64>,
    pub first_failed: Option<f64>,
}

/// Where both branches meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kink {
    pub factor: f64,
    pub before: FittedLine,
    pub after: FittedLine,
}

impl FactorCurve {
    /// A curve without trials yet, of a body whose `elastic` displacement is positive.
    pub fn new(elastic: f64) -> Self {
        Self {
            elastic,
            has_branch: true,
            states: Vec::new(),
        }
    }

    /// That of a body whose strength falls as it moves: how far it goes once it has failed is no measure of anything.
    pub fn without_branch(self) -> Self {
        Self {
            has_branch: false,
            ..self
        }
    }

    pub fn add(&mut self, states: impl IntoIterator<Item = CurveState>) {
        self.states.extend(states);
        self.states.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    }

    pub fn has_branch(&self) -> bool {
        self.has_branch
    }

    pub fn elastic(&self) -> f64 {
        self.elastic
    }

    pub fn states(&self) -> &[CurveState] {
        &self.states
    }

    /// The displacement over the elastic one.
    pub fn growth(&self, state: &CurveState) -> f64 {
        state.displacement / self.elastic
    }

    fn is_beyond(&self, level: f64, state: &CurveState) -> bool {
        !state.whole || self.growth(state) > level
    }

    /// Between which factors the displacement grows beyond a level.
    ///
    /// A weaker body in equilibrium shows that a stronger one can stand (lower bound theorem), so the greatest factor
    /// below the level counts, and failures before it do not.
    pub fn crossing(&self, level: f64) -> Bracket {
        self.band(|state| self.is_beyond(level, state))
    }

    fn band(&self, failed: impl Fn(&CurveState) -> bool) -> Bracket {
        let last_stable = self
            .states
            .iter()
            .rev()
            .find(|state| !failed(state))
            .map(|state| state.factor);
        let mut above = self
            .states
            .iter()
            .filter(|state| last_stable.is_none_or(|last| state.factor > last));
        Bracket {
            last_stable,
            first_failed: above.next().map(|state| state.factor),
        }
    }

    /// The trial at a factor.
    pub fn at(&self, factor: f64) -> Option<&CurveState> {
        self.states.iter().find(|state| state.factor == factor)
    }

    /// The factor where the displacement grows beyond a level, between whole trials linearly; none where there are
    /// none.
    pub fn reaches(&self, level: f64) -> Option<f64> {
        let band = self.crossing(level);
        let low = self.at(band.last_stable?)?;
        let high = self.at(band.first_failed?).filter(|state| state.whole)?;
        let share = (level * self.elastic - low.displacement) / (high.displacement - low.displacement);
        Some(low.factor + share * (high.factor - low.factor))
    }

    /// Where the branch after failure, from [`BENT`] to [`FALLEN`], meets the one before it when both are continued.
    /// None where there is no branch after failure, or no equilibrium shows it.
    pub fn kink(&self) -> Option<Kink> {
        if !self.has_branch {
            return None;
        }
        let begin = [self.reaches(BENT)?, BENT * self.elastic];
        let end = match self.reaches(FALLEN) {
            Some(factor) => [factor, FALLEN * self.elastic],
            None => self.end_of_branch()?,
        };
        let after = FittedLine::through(begin, end);
        let straight = self
            .states
            .iter()
            .filter(|state| state.whole && self.growth(state) <= STRAIGHT);
        let places: Vec<[f64; 2]> = straight.map(|state| [state.factor, state.displacement]).collect();
        let before = FittedLine::fitted(&places).unwrap_or(FittedLine {
            at_zero: self.elastic,
            slope: 0.0,
        });
        let factor = (before.at_zero - after.at_zero) / (after.slope - before.slope);
        let is_one = end[0] > begin[0] && after.slope > before.slope && factor >= self.states.first()?.factor;
        is_one.then_some(Kink { factor, before, after })
    }

    /// Factor and displacement of the last trial on a branch after failure that ends before [`FALLEN`], if this branch
    /// is long enough.
    fn end_of_branch(&self) -> Option<[f64; 2]> {
        let mut known = self.states.iter().rev();
        let last = known.find(|state| state.whole && self.growth(state) <= FALLEN)?;
        (self.growth(last) >= SHORTEST * BENT).then_some([last.factor, last.displacement])
    }

    /// Whether a trial lies beyond the kink. Without a branch after failure: whether it found no equilibrium, or has
    /// grown so far that it would be on it.
    pub fn is_failed(&self, kink: Option<&Kink>, state: &CurveState) -> bool {
        match kink {
            Some(kink) => state.factor > kink.factor,
            None => self.is_beyond(BENT, state),
        }
    }

    /// The trials before and after the kink.
    pub fn kinked(&self) -> Bracket {
        let kink = self.kink();
        self.band(|state| !state.whole || self.is_failed(kink.as_ref(), state))
    }

    /// Trials that found no equilibrium although a weaker body did.
    pub fn isolated(&self) -> Vec<f64> {
        let last = self.crossing(DOUBLED).last_stable.unwrap_or(0.0);
        self.states
            .iter()
            .filter(|state| !state.whole && state.factor < last)
            .map(|state| state.factor)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curve of `displacement` over factors from `from` to `to`.
    fn curve(from: f64, to: f64, step: f64, displacement: impl Fn(f64) -> f64) -> FactorCurve {
        let mut curve = FactorCurve::new(1.0);
        let count = ((to - from) / step).round() as usize;
        let factors = (0..=count).map(|index| from + index as f64 * step);
        curve.add(factors.map(|factor| CurveState {
            factor,
            displacement: displacement(factor),
            whole: true,
        }));
        curve
    }

    fn near(found: Option<f64>, wanted: f64) -> bool {
        found.is_some_and(|found| (found - wanted).abs() < 1e-9)
    }

    #[test]
    fn a_sharp_kink_is_where_it_is() {
        // The growth before it is 10 % per unit of the factor.
        let curve = curve(0.5, 1.7, 0.02, |factor| {
            0.95 + 0.1 * factor + 100.0 * (factor - 1.373).max(0.0)
        });
        assert!(near(curve.kink().map(|kink| kink.factor), 1.373), "{:?}", curve.kink());
        assert!(near(curve.kinked().last_stable, 1.36) && near(curve.kinked().first_failed, 1.38));
        let doubled = (2.0 - 0.95 + 137.3) / 100.1;
        assert!(near(curve.reaches(DOUBLED), doubled), "{:?}", curve.reaches(DOUBLED));
    }

    #[test]
    fn a_smooth_growth_has_its_kink_where_the_branch_leads_back() {
        // A parabola from 1.3 on, of which a chord between 5 and 20 leads back to where both square roots meet.
        let curve = curve(0.5, 1.7, 0.005, |factor| 1.0 + 200.0 * (factor - 1.3).max(0.0).powi(2));
        let bent = (4.0_f64 / 200.0).sqrt();
        let fallen = (19.0_f64 / 200.0).sqrt();
        let wanted = 1.3 + bent * fallen / (bent + fallen);
        let found = curve.kink().unwrap().factor;
        assert!((found - wanted).abs() < 2e-3, "{found} {wanted}");
    }

    #[test]
    fn noise_moves_the_kink_by_no_more_than_itself() {
        let mut sign = 1.0;
        let mut curve = curve(0.5, 1.7, 0.02, |factor| 1.0 + 100.0 * (factor - 1.4).max(0.0));
        for state in &mut curve.states {
            sign = -sign;
            state.displacement *= 1.0 + 0.04 * sign;
        }
        let found = curve.kink().unwrap().factor;
        assert!((found - 1.4).abs() < 0.01, "{found}");
    }

    #[test]
    fn all_stable_and_all_failed_have_one_end_only() {
        let level = curve(0.5, 1.5, 0.1, |_| 1.1);
        assert!(level.kink().is_none() && level.reaches(DOUBLED).is_none());
        assert_eq!(
            level.kinked(),
            Bracket {
                last_stable: Some(1.5),
                first_failed: None
            }
        );
        let fallen = curve(0.5, 1.5, 0.1, |_| 30.0);
        assert!(fallen.kink().is_none());
        assert_eq!(
            fallen.crossing(DOUBLED),
            Bracket {
                last_stable: None,
                first_failed: Some(0.5)
            }
        );
        assert_eq!(
            fallen.kinked(),
            Bracket {
                last_stable: None,
                first_failed: Some(0.5)
            }
        );
    }

    #[test]
    fn a_failure_before_a_weaker_body_that_stands_is_not_the_slope_s() {
        let mut curve = curve(0.5, 1.7, 0.02, |factor| 1.0 + 100.0 * (factor - 1.4).max(0.0));
        curve.states[10] = CurveState {
            displacement: 0.9,
            whole: false,
            ..curve.states[10]
        };
        assert!(near(curve.kink().map(|kink| kink.factor), 1.4));
        assert!(near(curve.crossing(DOUBLED).last_stable, 1.4) && near(curve.crossing(DOUBLED).first_failed, 1.42));
        assert_eq!(curve.isolated(), [0.7]);
    }

    #[test]
    fn without_equilibrium_after_failure_the_band_ends_there() {
        let mut curve = curve(0.5, 1.7, 0.1, |_| 1.1);
        curve
            .states
            .iter_mut()
            .filter(|state| state.factor > 1.35)
            .for_each(|state| state.whole = false);
        assert!(curve.kink().is_none());
        assert!(near(curve.kinked().last_stable, 1.3) && near(curve.kinked().first_failed, 1.4));
        // A branch that breaks off is one if it is long enough.
        let mut curve = self::curve(0.5, 1.7, 0.02, |factor| 1.0 + 100.0 * (factor - 1.4).max(0.0));
        curve
            .states
            .iter_mut()
            .filter(|state| state.factor > 1.55)
            .for_each(|state| state.whole = false);
        assert!(near(curve.kink().map(|kink| kink.factor), 1.4), "{:?}", curve.kink());
        curve
            .states
            .iter_mut()
            .filter(|state| state.factor > 1.45)
            .for_each(|state| state.whole = false);
        assert!(curve.kink().is_none());
    }
}
