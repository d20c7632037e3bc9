//! Convergence on three grids: observed order and Richardson extrapolation, theory-manual equation (T11.4), and grid
//! convergence index (T11.5).

use serde::Serialize;

/// The safety factor for three grids (Roache, 1998).
const SAFETY: f64 = 1.25;
/// Differences below this share of the value are rounding and tolerances, and show no order.
const NOISE: f64 = 1e-7;
/// The highest order that is looked for; more is no order of a method, but chance.
const HIGHEST: f64 = 30.0;

/// How values change from the coarsest to the finest grid; e32 and e21 are their differences.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ConvergenceType {
    /// They differ by rounding at most.
    Unchanged,
    /// They shrink, with one sign, as those of a positive order do.
    Monotone,
    /// They shrink, and change their sign.
    Oscillatory,
    /// The differences grow, with one sign.
    Diverging,
    /// They grow, and change their sign.
    OscillatoryDiverging,
}

/// What three values say.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Index {
    pub course: ConvergenceType,
    /// p, if the course shows one.
    pub order: Option<f64>,
    /// (r^p f1 - f2) / (r^p - 1), with r = h2/h1
    pub extrapolated: Option<f64>,
    /// 1.25 |f1 - f2| / |f1| / (r^p - 1): the band about the finest value
    pub fine: Option<f64>,
    /// The same of the two coarser grids, about the middle value.
    pub coarse: Option<f64>,
    /// coarse / (r^p fine): near one in the asymptotic range. With one ratio of sizes it is |f1/f2| whatever the order.
    pub ratio: Option<f64>,
}

impl Index {
    /// Of sizes and values from the finest grid to the coarsest.
    pub fn of(h: [f64; 3], f: [f64; 3]) -> Self {
        let course = course(h, f);
        let none = Self {
            course,
            order: None,
            extrapolated: None,
            fine: None,
            coarse: None,
            ratio: None,
        };
        if !matches!(course, ConvergenceType::Monotone | ConvergenceType::Oscillatory) {
            return none;
        }
        let Some(order) = order(h, f) else { return none };
        let powers = [0, 1].map(|fine| (h[fine + 1] / h[fine]).powf(order));
        let [fine, coarse] = [0, 1].map(|fine| {
            let change = ((f[fine] - f[fine + 1]) / f[fine]).abs();
            Some(SAFETY * change / (powers[fine] - 1.0)).filter(|band| band.is_finite())
        });
        Self {
            order: Some(order),
            // Where the sign changes each time, the limit lies between the values.
            extrapolated: (course == ConvergenceType::Monotone).then(|| f[0] + (f[0] - f[1]) / (powers[0] - 1.0)),
            fine,
            coarse,
            ratio: fine
                .zip(coarse)
                .map(|(fine, coarse)| coarse / (powers[0] * fine))
                .filter(|ratio| ratio.is_finite()),
            ..none
        }
    }
}

fn course(h: [f64; 3], f: [f64; 3]) -> ConvergenceType {
    let fine = f[1] - f[0];
    let coarse = f[2] - f[1];
    let scale = f.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    if fine.abs() <= NOISE * scale {
        return ConvergenceType::Unchanged;
    }
    // Where only the finest grid differs, nothing has begun to converge.
    let has_same_sign = coarse.abs() <= NOISE * scale || coarse / fine > 0.0;
    match (has_same_sign, (coarse / fine).abs() > growth(h, 0.0, has_same_sign)) {
        (true, true) => ConvergenceType::Monotone,
        (false, true) => ConvergenceType::Oscillatory,
        (true, false) => ConvergenceType::Diverging,
        (false, false) => ConvergenceType::OscillatoryDiverging,
    }
}

/// |e32/e21| of the order p: r21^p (r32^p - s)/(r21^p - s), s = 1 where both have one sign, else -1 (Celik's Eq. 3).
fn growth(h: [f64; 3], order: f64, has_same_sign: bool) -> f64 {
    let fine = h[1] / h[0];
    let coarse = h[2] / h[1];
    match (has_same_sign, order == 0.0) {
        (true, true) => coarse.ln() / fine.ln(),
        (true, false) => fine.powf(order) * (order * coarse.ln()).exp_m1() / (order * fine.ln()).exp_m1(),
        (false, _) => fine.powf(order) * (coarse.powf(order) + 1.0) / (fine.powf(order) + 1.0),
    }
}

/// The order whose growth of the differences is that of the values; it grows with the order, so halving finds it.
fn order(h: [f64; 3], f: [f64; 3]) -> Option<f64> {
    let ratio = (f[2] - f[1]) / (f[1] - f[0]);
    let is_below = |order: f64| growth(h, order, ratio > 0.0) < ratio.abs();
    let mut low = 0.0;
    let mut high = HIGHEST;
    if is_below(high) {
        return None;
    }
    while high - low > 1e-13 * high {
        let middle = f64::midpoint(low, high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    Some(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(h: [f64; 3], order: f64) -> [f64; 3] {
        h.map(|h| 5.0 - 3.0 * h.powf(order))
    }

    #[test]
    fn a_known_order_and_limit_are_found_whatever_the_ratios() {
        for h in [[0.1, 0.2, 0.4], [0.1, 0.15, 0.3], [0.1, 0.3, 0.45], [0.1, 0.13, 0.16]] {
            for order in [0.7, 1.0, 2.0, 3.0] {
                let found = Index::of(h, values(h, order));
                assert_eq!(found.course, ConvergenceType::Monotone, "{h:?} {order}");
                // Differences of values cost digits.
                assert!((found.order.unwrap() - order).abs() < 1e-7, "{h:?} {order}: {found:?}");
                assert!((found.extrapolated.unwrap() - 5.0).abs() < 1e-7);
                // 1.25 times the true error.
                let true_error = (values(h, order)[0] - 5.0).abs() / values(h, order)[0];
                assert!((found.fine.unwrap() / true_error - 1.25).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn the_published_example_is_met() {
        // Celik et al. (2008), Table 1, phi = reattachment length: r21 = 1.5, r32 = 1.333, 6.063, 5.972, 5.863.
        let found = Index::of([1.0, 1.5, 1.5 * 1.333], [6.063, 5.972, 5.863]);
        assert!((found.order.unwrap() - 1.53).abs() < 0.01, "{found:?}");
        assert!((found.extrapolated.unwrap() - 6.1685).abs() < 1e-3);
        assert!((found.fine.unwrap() - 0.022).abs() < 5e-4);
    }

    #[test]
    fn oscillation_is_named_and_has_an_order() {
        for h in [[1.0, 2.0, 4.0_f64], [1.0, 1.5, 3.0]] {
            let f = [5.0 + h[0].powf(1.5), 5.0 - h[1].powf(1.5), 5.0 + h[2].powf(1.5)];
            let found = Index::of(h, f);
            assert_eq!((found.course, found.extrapolated), (ConvergenceType::Oscillatory, None));
            assert!(
                (found.order.unwrap() - 1.5).abs() < 1e-9 && found.fine.is_some(),
                "{found:?}"
            );
        }
    }

    #[test]
    fn what_does_not_converge_has_no_order() {
        let h = [1.0, 2.0, 4.0];
        for (f, course) in [
            ([5.0, 5.0, 5.0], ConvergenceType::Unchanged),
            ([5.0, 5.0, 4.0], ConvergenceType::Unchanged),
            ([5.0, 4.0, 3.5], ConvergenceType::Diverging),
            ([5.0, 4.0, 4.5], ConvergenceType::OscillatoryDiverging),
            ([0.0, 0.0, 0.0], ConvergenceType::Unchanged),
        ] {
            let found = Index::of(h, f);
            assert_eq!((found.course, found.order, found.fine), (course, None, None), "{f:?}");
        }
        // About zero there is no relative band.
        let found = Index::of(h, [0.0, 1.0, 3.0]);
        assert!(
            found.fine.is_none() && (found.extrapolated.unwrap() + 1.0).abs() < 1e-12,
            "{found:?}"
        );
    }

    #[test]
    fn with_one_ratio_the_check_is_that_of_the_values() {
        let found = Index::of([1.0, 2.0, 4.0], [1.0, 1.1, 1.4]);
        assert!((found.ratio.unwrap() - 1.0 / 1.1).abs() < 1e-12);
    }
}
