//! Pareto front of a sweep: settings for which no other setting is both cheaper and more accurate.

/// Of pairs of cost and error those to which no other is better in one and as good in the other; of equal ones the
/// first. None is no result, and neither is a number that is not finite.
pub(super) fn front(places: &[Option<(f64, f64)>]) -> Vec<bool> {
    let beats = |(index, one): (usize, (f64, f64)), (other_index, other): (usize, (f64, f64))| {
        let no_worse = one.0 <= other.0 && one.1 <= other.1;
        no_worse && (one != other || index < other_index)
    };
    let there = || {
        places
            .iter()
            .enumerate()
            .filter_map(|(index, place)| Some((index, counted(*place)?)))
    };
    let is_best = |(index, place): (usize, &Option<(f64, f64)>)| {
        counted(*place).is_some_and(|place| !there().any(|other| beats(other, (index, place))))
    };
    places.iter().enumerate().map(is_best).collect()
}

/// The cheapest of those whose error is at most `within`.
pub(super) fn cheapest(places: &[Option<(f64, f64)>], within: f64) -> Option<usize> {
    let there = places
        .iter()
        .enumerate()
        .filter_map(|(index, place)| Some((index, counted(*place)?)));
    let good = there.filter(|(_, place)| place.1 <= within);
    good.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0))
        .map(|(index, _)| index)
}

fn counted(place: Option<(f64, f64)>) -> Option<(f64, f64)> {
    place.filter(|(cost, error)| cost.is_finite() && error.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [Option<(f64, f64)>; 8] = [
        Some((1.0, 0.5)),
        Some((2.0, 0.5)),
        Some((3.0, 0.1)),
        None,
        Some((4.0, 0.2)),
        Some((5.0, f64::NAN)),
        Some((9.0, 0.0)),
        Some((9.0, 0.0)),
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
