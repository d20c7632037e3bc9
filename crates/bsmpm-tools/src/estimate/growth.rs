//! Extrapolates the work of coarser versions of a case to the case itself. In dynamics, a + b/h is fitted to the number
//! of iterations (h: cell size).

use bsmpm_scene::Regime;

use super::work::Effort;

/// Growth in a halving of the cells beyond which a trend is taken for noise, and what the first steps show.
const MOST: [f64; 2] = [2.0, 4.0];

/// A coarse form, run to its end or as far as it came.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GrowthLevel {
    /// its cells over the case's
    pub factor: usize,
    /// work over all the case's time
    pub work: Effort,
    /// work of the iterations up to the time that the case's own first steps reached
    pub early: f64,
    /// active nodes, mean over all steps over that of the steps up to that time
    pub spread: f64,
}

/// The work of a case whose first steps took `early` in their iterations, from one coarse form or more, the finest one
/// last; none without.
pub(super) fn extrapolate(levels: &[GrowthLevel], regime: Regime, early: f64) -> Option<Effort> {
    let finest = levels.last()?;
    let factor = finest.factor as f64;
    let bounded = |growth: f64, most: f64| growth.clamp(1.0, most.powf(factor.log2()));
    let seen = if finest.early > 0.0 {
        bounded(early / finest.early, MOST[1])
    } else {
        1.0
    };
    let coarser = levels
        .len()
        .checked_sub(2)
        .map(|before| &levels[before])
        .filter(|_| regime == Regime::Dynamic);
    let trend = coarser.map_or(1.0, |coarser| {
        let fine = finest.work.iterations();
        let coarse = coarser.work.iterations();
        // The line through both in 1/factor, at 1.
        let slope = (fine - coarse) / (1.0 / factor - 1.0 / coarser.factor as f64);
        bounded(1.0 + slope * (1.0 - 1.0 / factor) / fine.max(1.0), MOST[0])
    });
    Some(finest.work.grown(seen.max(trend)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(factor: usize, evaluations: f64, early: f64) -> GrowthLevel {
        GrowthLevel {
            factor,
            work: Effort {
                steps: 100.0,
                evaluations,
                ..Effort::default()
            },
            early,
            spread: 1.0,
        }
    }

    #[test]
    fn a_line_in_the_inverse_of_the_cells_is_found() {
        let of = |factor: f64| 1000.0 + 500.0 / factor;
        let levels = [level(8, of(8.0), 0.0), level(4, of(4.0), 0.0)];
        let found = extrapolate(&levels, Regime::Dynamic, 0.0).unwrap();
        assert!((found.evaluations - of(1.0)).abs() < 1e-9 && found.steps == 100.0);
    }

    #[test]
    fn the_papers_column_is_within_5_per_cent() {
        let levels = [level(8, 12_571.0, 604.0), level(4, 17_508.0, 748.0)];
        let found = extrapolate(&levels, Regime::Dynamic, 748.0).unwrap();
        assert!((found.evaluations / 48_917.0 - 1.0).abs() < 0.05, "{found:?}");
    }

    #[test]
    fn one_form_alone_grows_as_the_first_steps_do_and_no_trend_makes_less_or_runs_away() {
        let of = |levels: &[GrowthLevel], regime, early| extrapolate(levels, regime, early).unwrap().evaluations;
        for regime in [Regime::Dynamic, Regime::QuasiStatic] {
            assert_eq!(extrapolate(&[], regime, 1.0), None);
            assert_eq!(of(&[level(2, 1000.0, 40.0)], regime, 50.0), 1250.0);
            assert_eq!(
                of(&[level(4, 2000.0, 40.0), level(2, 1000.0, 40.0)], regime, 40.0),
                1000.0
            );
        }
        let rising = [level(4, 10.0, 40.0), level(2, 1000.0, 40.0)];
        assert_eq!(of(&rising, Regime::Dynamic, 40.0), 2000.0);
        assert_eq!(of(&rising, Regime::QuasiStatic, 44.0), 1100.0);
        assert_eq!(of(&rising, Regime::QuasiStatic, 400.0), 4000.0);
    }
}
