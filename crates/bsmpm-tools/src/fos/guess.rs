//! Predicts the next factors of a search.

use super::curve::CurveState;
use super::search::{Halt, SearchPlan, search};
use crate::line::FALLEN;

/// A body stands rather than fails where no weaker one is known to have failed: of the rungs of a ladder most stand.
const STANDS: f64 = 0.75;
/// Continuations that are looked at, for each factor that is wanted: many guesses lead to the same one.
const LOOKS: usize = 8;

/// A guess of trials that are not known.
struct GuessPath {
    /// a measure of how likely it is
    weight: f64,
    guesses: Vec<CurveState>,
}

/// Up to `most` factors for which the search may ask next, none of them known: the one that it needs now, then the
/// likeliest.
pub(super) fn ahead(plan: SearchPlan, known: &dyn Fn(f64) -> Option<CurveState>, most: usize) -> Vec<f64> {
    let mut factors = Vec::new();
    let mut paths = vec![GuessPath {
        weight: 1.0,
        guesses: Vec::new(),
    }];
    for _ in 0..LOOKS * most {
        // Of paths that are as likely as each other the shorter one, which was added earlier.
        let likeliest = (0..paths.len())
            .rev()
            .max_by(|&a, &b| paths[a].weight.total_cmp(&paths[b].weight));
        let Some(path) = likeliest.map(|index| paths.remove(index)) else {
            break;
        };
        let mut states = Vec::new();
        let halt = search(plan, &mut |factor| {
            let guessed = path.guesses.iter().find(|state| state.factor == factor).copied();
            known(factor).or(guessed).inspect(|&state| states.push(state))
        });
        let Err(Halt::Needs(factor)) = halt else { continue };
        if !factors.contains(&factor) {
            factors.push(factor);
        }
        if factors.len() == most {
            break;
        }
        paths.extend(outcomes(factor, &states).map(|(share, state)| GuessPath {
            weight: share * path.weight,
            guesses: path.guesses.iter().copied().chain([state]).collect(),
        }));
    }
    factors
}

/// How a trial may end, with the share of each way: as those of a stronger and of a weaker body did.
fn outcomes(factor: f64, states: &[CurveState]) -> impl Iterator<Item = (f64, CurveState)> {
    let nearest = |a: &&CurveState, b: &&CurveState| (a.factor - factor).abs().total_cmp(&(b.factor - factor).abs());
    let stronger = states
        .iter()
        .filter(|state| state.factor < factor && state.whole)
        .min_by(nearest);
    let weaker = states.iter().filter(|state| state.factor > factor).min_by(nearest);
    let elastic = states.first().map(|state| state.displacement);
    let stands = stronger.map_or(
        CurveState {
            factor,
            displacement: 1.0,
            whole: true,
        },
        |state| CurveState { factor, ..*state },
    );
    let falls = weaker.map(|state| CurveState { factor, ..*state });
    // Nobody fails as the elastic body, the first of all.
    let falls = falls.or_else(|| {
        Some(CurveState {
            factor,
            displacement: 2.0 * FALLEN * elastic?,
            whole: true,
        })
    });
    let share = if weaker.is_some() { 0.5 } else { STANDS };
    [(share, stands)]
        .into_iter()
        .chain(falls.map(|state| (1.0 - share, state)))
}

#[cfg(test)]
mod tests {
    use super::super::search::tests::{PLAN, hockey};
    use super::super::sought::ELASTIC;
    use super::*;

    fn state(kink: f64, factor: f64) -> CurveState {
        let (displacement, whole) = hockey(kink)(factor);
        CurveState {
            factor,
            displacement,
            whole,
        }
    }

    /// What is wanted when the trials of these factors are known.
    fn wanted(made: &[f64], most: usize) -> Vec<f64> {
        ahead(
            PLAN,
            &|factor| made.contains(&factor).then(|| state(1.373, factor)),
            most,
        )
    }

    /// Rounds of a search in each of which so many trials are made, and how many those are in all.
    fn rounds(kink: f64, most: usize) -> (usize, usize) {
        let mut made: Vec<CurveState> = Vec::new();
        let mut rounds: usize = 0;
        loop {
            let wanted = ahead(
                PLAN,
                &|factor| made.iter().find(|state| state.factor == factor).copied(),
                most,
            );
            if wanted.is_empty() {
                return (rounds, made.len());
            }
            assert!(
                wanted.len() <= most
                    && wanted
                        .iter()
                        .all(|factor| made.iter().all(|state| state.factor != *factor))
            );
            made.extend(wanted.into_iter().map(|factor| state(kink, factor)));
            rounds += 1;
        }
    }

    #[test]
    fn the_next_rungs_are_guessed_and_both_halves_of_a_bisection() {
        assert_eq!(wanted(&[], 3), [ELASTIC, 0.5, 0.625]);
        assert_eq!(wanted(&[ELASTIC, 0.5, 0.625], 2), [0.781, 0.977]);
        // The body fails between the last rungs.
        let ladder = [ELASTIC, 0.5, 0.625, 0.781, 0.977, 1.221, 1.526];
        assert_eq!(wanted(&ladder, 1), [1.374]);
        let mut three = wanted(&ladder, 3);
        three.sort_by(f64::total_cmp);
        assert_eq!(three, [1.298, 1.374, 1.45]);
    }

    #[test]
    fn a_trial_that_is_known_is_no_guess() {
        // 1.45 has failed, so the upper half is between it and the middle.
        let mut three = wanted(&[ELASTIC, 0.5, 0.625, 0.781, 0.977, 1.221, 1.526, 1.45], 3);
        three.sort_by(f64::total_cmp);
        assert_eq!(three, [1.298, 1.374, 1.412]);
    }

    #[test]
    fn more_trials_at_the_same_time_take_fewer_rounds() {
        for kink in [0.8, 1.373, 1.7, 2.6] {
            let [one, two, four] = [1, 2, 4].map(|most| rounds(kink, most));
            assert_eq!(one.0, one.1);
            assert!(two.0 < one.0 && four.0 < two.0, "{one:?} {two:?} {four:?}");
        }
    }
}
