//! Pareto front of a sweep: settings for which no other setting is both cheaper and more accurate.

/// Where a run lies between being cheap and being accurate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CostError {
    /// s  of processor time
    pub cost: f64,
    /// relative
    pub error: f64,
}

impl CostError {
    /// Returns whether both numbers are finite.
    fn is_finite(&self) -> bool {
        self.cost.is_finite() && self.error.is_finite()
    }
}

/// Of costs and errors those to which no other is better in one and as good in the other; of equal ones the first. None
/// is no result, and neither is a number that is not finite.
pub(super) fn front(places: &[Option<CostError>]) -> Vec<bool> {
    let mut front = vec![false; places.len()];
    for (index, place) in finite(places) {
        front[index] = !finite(places).any(|(other_index, other)| {
            let no_worse = other.cost <= place.cost && other.error <= place.error;
            no_worse && (other != place || other_index < index)
        });
    }
    front
}

/// The cheapest of those whose error is at most `within`.
pub(super) fn cheapest(places: &[Option<CostError>], within: f64) -> Option<usize> {
    let good = finite(places).filter(|(_, place)| place.error <= within);
    good.min_by(|(_, a), (_, b)| a.cost.total_cmp(&b.cost))
        .map(|(index, _)| index)
}

/// Those whose numbers are finite, with their indices.
fn finite(places: &[Option<CostError>]) -> impl Iterator<Item = (usize, CostError)> {
    let places = places.iter().enumerate();
    places.filter_map(|(index, place)| Some((index, place.filter(CostError::is_finite)?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn at(cost: f64, error: f64) -> Option<CostError> {
        Some(CostError { cost, error })
    }

    const PLACES: [Option<CostError>; 8] = [
        at(1.0, 0.5),
        at(2.0, 0.5),
        at(3.0, 0.1),
        None,
        at(4.0, 0.2),
        at(5.0, f64::NAN),
        at(9.0, 0.0),
        at(9.0, 0.0),
    ];

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let expected = [true, false, true, false, false, false, true, false];
        assert_eq!(front(&PLACES), expected);
        // In any order.
        let turned: Vec<_> = PLACES[..7].iter().rev().copied().collect();
        assert!(front(&turned).iter().rev().eq(&expected[..7]));
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn the_cheapest_within_an_error_is_found() {
        assert_eq!(cheapest(&PLACES, 0.2), Some(2));
        assert_eq!((cheapest(&PLACES, 0.05), cheapest(&PLACES, 1.0)), (Some(6), Some(0)));
        assert_eq!(cheapest(&PLACES[..5], 0.05), None);
    }
}
