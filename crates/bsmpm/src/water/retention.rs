//! Retention curve and relative permeability: van Genuchten and Mualem, theory-manual equation (T8.15), or measured.

mod measured;

pub use measured::MeasuredCurve;

use crate::gauss::GAUSS;

/// Least relative permeability: what a soil lets through as films and vapour, and what keeps a dry one from being cut
/// off. A flux of a millionth of the saturated one changes no balance; the flow past a dry zone would lose its only
/// way.
const LEAST: f64 = 1e-6;

/// Least alpha s at which the derivative of the relative permeability is taken: below n = 2 that goes beyond all bounds
/// where air enters, as (alpha s)^(n-2).
const ENTERED: f64 = 1e-3;

/// Retention curve of a soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Retention {
    /// what the suction lets go, and what still conducts
    pub curve: Curve,
    /// -  saturation that no suction removes, of which Bishop's chi takes no part
    pub residual: f64,
    /// m and m  heads at which the curve changes its course, from 0 on, and its integral until there
    filled: Vec<[f64; 2]>,
}

/// How the effective saturation and the relative permeability follow the suction head s, m.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// (1 + (alpha s)^n)^-m, m = 1 - 1/n (van Genuchten 1980), and the permeability of Mualem (1976)
    VanGenuchten {
        /// 1/m  over the head at which air enters
        alpha: f64,
        /// -  above 1: the larger, the more alike the pores
        n: f64,
    },
    /// rows as measured
    Measured(MeasuredCurve),
}

/// Heads at most up to which a curve is integrated once for all.
const BENDS: usize = 32;

/// What a curve says under one suction.
struct RetentionPoint {
    /// -
    effective: f64,
    /// 1/m  what the effective saturation loses by suction, not negative
    by_head: f64,
    /// -  may be less than the least
    permeability: f64,
}

/// A soil under a pore pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RetentionState {
    /// -  share of the pores that water fills
    pub saturation: f64,
    /// 1/Pa  its derivative by the pressure, not negative
    pub slope: f64,
    /// -  effective saturation: 0 where only the residual water is left; what Bishop's chi is taken as
    pub effective: f64,
    /// -  permeability over that of the saturated soil
    pub permeability: f64,
}

/// Derivatives by the pore pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RetainedChange {
    /// 1/Pa  of the effective saturation
    pub effective: f64,
    /// 1/Pa  of the relative permeability; where air enters, that at a thousandth of the entry's suction
    pub permeability: f64,
    /// 1/Pa2  of [`Retention::chord`]
    pub chord: f64,
}

impl RetentionState {
    /// All pores full of water.
    pub const FULL: Self = Self {
        saturation: 1.0,
        slope: 0.0,
        effective: 1.0,
        permeability: 1.0,
    };
}

impl Curve {
    /// m  the suction head at which air has entered: that of the rows at which half of the water has left
    pub fn entry(&self) -> f64 {
        match self {
            Self::VanGenuchten { alpha, .. } => 1.0 / alpha,
            Self::Measured(of) => {
                let drawn = of.rows.iter().find(|row| row[1] <= 0.5);
                drawn.unwrap_or(&of.rows[of.rows.len() - 1])[0]
            }
        }
    }

    /// m  the least head above `s` at which it changes its course: where it is drawn so, and doubled from the entry's
    /// sixty-fourth on
    fn bend(&self, s: f64) -> f64 {
        match self {
            Self::VanGenuchten { alpha, .. } => (2.0 * s).max(1.0 / (64.0 * alpha)),
            Self::Measured(of) => of
                .rows
                .iter()
                .map(|row| row[0])
                .find(|head| *head > s)
                .unwrap_or(f64::INFINITY),
        }
    }

    /// m  integral of the effective saturation over heads between which it does not change its course: Gauss' rule
    fn between(&self, from: f64, to: f64) -> f64 {
        let middle = 0.5 * (from + to);
        let half = 0.5 * (to - from);
        GAUSS
            .iter()
            .map(|(at, weight)| half * weight * self.drawn(middle + half * at).effective)
            .sum()
    }

    /// Under the suction head `s`, m, above 0.
    fn drawn(&self, s: f64) -> RetentionPoint {
        match self {
            Self::VanGenuchten { alpha, n } => {
                let m = 1.0 - 1.0 / n;
                let head = alpha * s;
                let drawn = head.powf(*n);
                let effective = (1.0 + drawn).powf(-m);
                // 1 - Se^(1/m) = drawn/(1 + drawn), which does not cancel.
                let wide = 1.0 - (drawn / (1.0 + drawn)).powf(m);
                RetentionPoint {
                    effective,
                    // (alpha s)^(n-1): where n is near 1 and s near 0 the quotient of the powers has no meaning.
                    by_head: m * n * alpha * head.powf(n - 1.0) * effective / (1.0 + drawn),
                    permeability: effective.sqrt() * wide.powi(2),
                }
            }
            Self::Measured(of) => {
                let [[effective, slope], [permeability, _]] = of.at(s);
                RetentionPoint {
                    effective,
                    by_head: -slope,
                    permeability,
                }
            }
        }
    }

    /// 1/m  what the relative permeability loses by suction under the head `s`, m, above 0; where air enters, that at a
    /// thousandth of the entry's suction
    fn closes(&self, s: f64) -> f64 {
        match self {
            Self::VanGenuchten { alpha, n } => {
                let m = 1.0 - 1.0 / n;
                let found = self.drawn(s);
                let head = alpha * s;
                let drawn = head.powf(*n);
                let wide = 1.0 - (drawn / (1.0 + drawn)).powf(m);
                // (drawn/(1 + drawn))^(m-1) has the factor head^-1, as n (1 - m) = 1.
                let steep = if *n < 2.0 { head.max(ENTERED) } else { head }.powf(n - 2.0);
                let widens = m * n * alpha * steep * (1.0 + drawn).powf(-1.0 - m);
                let root = found.effective.sqrt();
                0.5 * found.by_head / root * wide.powi(2) + 2.0 * root * wide * widens
            }
            Self::Measured(of) => -of.at(s)[1][1],
        }
    }
}

impl Retention {
    /// Of a curve with what no suction removes, -.
    pub fn new(curve: Curve, residual: f64) -> Self {
        let mut filled = vec![[0.0; 2]];
        while filled.len() < BENDS {
            let [from, area] = filled[filled.len() - 1];
            let to = curve.bend(from);
            if !to.is_finite() {
                break;
            }
            filled.push([to, area + curve.between(from, to)]);
        }
        Self {
            curve,
            residual,
            filled,
        }
    }

    /// Of van Genuchten's curve: `alpha`, 1/m, `n` and `residual`, -.
    pub fn van_genuchten(alpha: f64, n: f64, residual: f64) -> Self {
        Self::new(Curve::VanGenuchten { alpha, n }, residual)
    }

    /// Under the pore pressure `p`, Pa, of water of the unit weight `weight`, N/m3.
    pub fn under(&self, p: f64, weight: f64) -> RetentionState {
        if p >= 0.0 {
            return RetentionState::FULL;
        }
        let found = self.curve.drawn(-p / weight);
        RetentionState {
            saturation: self.residual + (1.0 - self.residual) * found.effective,
            slope: (1.0 - self.residual) * found.by_head / weight,
            effective: found.effective,
            permeability: found.permeability.max(LEAST),
        }
    }

    /// What changes with the pore pressure `now`, Pa, which was `before`; where its functions have kinks on their sides
    /// of the full and of the driest soil.
    pub fn change(&self, before: f64, now: f64, weight: f64) -> RetainedChange {
        let chord = self.chord_change(before, now, weight);
        if now >= 0.0 {
            return RetainedChange {
                chord,
                ..RetainedChange::default()
            };
        }
        let found = self.under(now, weight);
        let conducts = found.permeability > LEAST;
        RetainedChange {
            effective: found.slope / (1.0 - self.residual),
            permeability: if conducts {
                self.curve.closes(-now / weight) / weight
            } else {
                0.0
            },
            chord,
        }
    }

    fn chord_change(&self, before: f64, now: f64, weight: f64) -> f64 {
        let change = now - before;
        // Where the chord is the slope itself, half of what that changes by; next to nothing of the tau term.
        if change.abs() < 1e-6 * weight {
            return 0.0;
        }
        (self.under(now, weight).slope - self.chord(before, now, weight)) / change
    }

    /// 1/Pa  what the saturation changes by over what the pressure does between `before` and `now`, Pa.
    pub fn chord(&self, before: f64, now: f64, weight: f64) -> f64 {
        let change = now - before;
        // Below a thousandth of a millimetre of water the difference is round-off.
        if change.abs() < 1e-6 * weight {
            return self.under(now, weight).slope;
        }
        ((self.under(now, weight).saturation - self.under(before, weight).saturation) / change).max(0.0)
    }

    /// J/m3  what the suction of the pore pressure `p`, Pa, has put into the pores: the integral of -q dS from full
    /// pores on, by Gauss' rule between the heads at which the curve changes its course; `weight`: of the water, N/m3.
    pub fn stored(&self, p: f64, weight: f64) -> f64 {
        let suction = -p / weight;
        if suction <= 0.0 {
            return 0.0;
        }
        let [mut from, mut area] = self.filled[self.filled.partition_point(|[head, _]| *head <= suction) - 1];
        while from < suction {
            let to = self.curve.bend(from).min(suction);
            area += self.curve.between(from, to);
            from = to;
        }
        // By parts: the area under the curve, above what it ends with.
        area -= suction * self.curve.drawn(suction).effective;
        (1.0 - self.residual) * weight * area
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loam() -> Retention {
        Retention::van_genuchten(3.6, 1.56, 0.18)
    }

    fn sand() -> Retention {
        Retention::van_genuchten(14.5, 2.68, 0.1)
    }

    const WEIGHT: f64 = 9810.0;

    /// Van Genuchten's alpha and n.
    fn parameters(soil: &Retention) -> (f64, f64) {
        let Curve::VanGenuchten { alpha, n } = soil.curve else {
            panic!("measured")
        };
        (alpha, n)
    }

    /// Rows of a measured curve: what the Liakopoulos sand keeps under so many heads, m.
    fn measured(heads: impl IntoIterator<Item = f64>) -> Retention {
        let row = |head: f64| {
            let left = 1.9722e-11 * (head * WEIGHT).powf(2.4279);
            [head, 1.0 - left, 1.0 - 2.207 * left.powf(1.0121)]
        };
        Retention::new(
            Curve::Measured(MeasuredCurve::new(heads.into_iter().map(row).collect())),
            0.0,
        )
    }

    #[test]
    fn saturation_and_permeability_follow_their_formulas() {
        for soil in [loam(), sand()] {
            let (alpha, n) = parameters(&soil);
            let m = 1.0 - 1.0 / n;
            for head in [0.01, 0.1, 1.0, 3.0] {
                let found = soil.under(-head * WEIGHT, WEIGHT);
                let effective = (1.0 + (alpha * head).powf(n)).powf(-m);
                let k = effective.sqrt() * (1.0 - (1.0 - effective.powf(1.0 / m)).powf(m)).powi(2);
                assert!((found.effective - effective).abs() < 1e-14);
                assert!((found.saturation - soil.residual - (1.0 - soil.residual) * effective).abs() < 1e-14);
                assert!((found.permeability / k.max(LEAST) - 1.0).abs() < 1e-9, "{found:?} {k}");
            }
            assert_eq!(soil.under(0.0, WEIGHT), RetentionState::FULL);
            assert_eq!(soil.under(1e4, WEIGHT), RetentionState::FULL);
        }
        // Half of what can leave has left where (alpha s)^n = 2^(1/m) - 1; fully dry soil keeps the residual water.
        assert!((sand().under(-1e12, WEIGHT).saturation - 0.1).abs() < 1e-6);
        assert_eq!(sand().under(-1e12, WEIGHT).permeability, LEAST);
    }

    /// Off by 1e-6 at most, as the sum that it is held against; of clay, under little suction, by 4e-5.
    #[test]
    fn what_suction_stores_is_the_integral_of_suction_by_saturation() {
        let rows = measured((0..8).map(|k| 0.1 * f64::from(k)));
        for (soil, error) in [
            (loam(), 2e-6),
            (sand(), 2e-6),
            (Retention::van_genuchten(0.8, 1.09, 0.07), 1e-4),
            (rows, 2e-6),
        ] {
            for head in [0.03, 0.5, 2.0, 30.0] {
                // By parts in a million parts of the logarithm of the suction.
                let parts = 1_000_000;
                let at = |k: i32| head * (14.0 * (f64::from(k) / f64::from(parts) - 1.0)).exp();
                let saturation = |head: f64| soil.under(-head * WEIGHT, WEIGHT).saturation;
                let part = |k: i32| 0.5 * (at(k) + at(k + 1)) * (saturation(at(k)) - saturation(at(k + 1)));
                let sum = WEIGHT * (0..parts).map(part).sum::<f64>();
                let found = soil.stored(-head * WEIGHT, WEIGHT);
                assert!((found / sum - 1.0).abs() < error, "{soil:?} {head}: {found} {sum}");
            }
            assert_eq!(soil.stored(WEIGHT, WEIGHT), 0.0);
        }
    }

    #[test]
    fn the_slope_is_the_derivative() {
        for soil in [loam(), sand()] {
            for head in [0.02, 0.3, 2.0] {
                let p = -head * WEIGHT;
                let step = 3e-5 * head * WEIGHT;
                let found = soil.under(p, WEIGHT).slope;
                let saturation = |p: f64| soil.under(p, WEIGHT).saturation;
                let difference = (saturation(p + step) - saturation(p - step)) / (2.0 * step);
                assert!((difference / found - 1.0).abs() < 1e-8, "{difference} {found}");
                // Chords go over to the slope where what they would be the quotient of is round-off.
                assert_eq!(soil.chord(p, p, WEIGHT), found);
                let long = soil.chord(p - 10.0 * WEIGHT, p, WEIGHT) * 10.0 * WEIGHT;
                assert!((long - saturation(p) + saturation(p - 10.0 * WEIGHT)).abs() < 1e-14);
            }
        }
    }

    /// Newton's method has the derivatives, which stay finite where air enters, also of fine soils.
    #[test]
    fn changes_are_derivatives_and_bounded_where_air_enters() {
        let clay = Retention::van_genuchten(0.8, 1.09, 0.07);
        for soil in [loam(), sand(), clay] {
            let (alpha, n) = parameters(&soil);
            for head in [0.01, 0.3, 2.0] {
                let p = -head * WEIGHT;
                let step = 3e-5 * head * WEIGHT;
                let found = soil.change(-WEIGHT, p, WEIGHT);
                let of = |p: f64| soil.under(p, WEIGHT);
                let difference = (of(p + step).permeability - of(p - step).permeability) / (2.0 * step);
                if of(p).permeability > LEAST && alpha * head > ENTERED {
                    assert!(
                        (difference / found.permeability - 1.0).abs() < 1e-6,
                        "{difference} {found:?}"
                    );
                }
            }
            // The factors besides the one that is cut are at most 1.
            let m = 1.0 - 1.0 / n;
            let steep = ENTERED.powf((n - 2.0).min(0.0));
            let most = m * n * alpha / WEIGHT * (0.5 + 2.0 * steep);
            for k in 1..200 {
                let near = soil
                    .change(-WEIGHT, -WEIGHT * ENTERED / alpha * 0.5_f64.powi(k), WEIGHT)
                    .permeability;
                assert!((0.0..=most).contains(&near), "{near} {most}");
            }
        }
    }

    /// Between rows the cubic is the function that the rows are of, to the third order, its slopes are its derivatives,
    /// and it rises nowhere, also where rows do not look like a curve.
    #[test]
    fn measured_rows_are_joined_by_curves_that_fall() {
        let exact = |head: f64| 1.0 - 1.9722e-11 * (head * WEIGHT).powf(2.4279);
        let error = |rows: i32| {
            let soil = measured((0..=rows).map(|k| f64::from(k) / f64::from(rows)));
            let off = |k: i32| {
                (soil.under(-WEIGHT * f64::from(k) / 500.0, WEIGHT).saturation - exact(f64::from(k) / 500.0)).abs()
            };
            (1..500).map(off).fold(0.0, f64::max)
        };
        let coarse = error(10);
        let fine = error(20);
        assert!(fine < 2e-5 && coarse / fine > 4.0, "{coarse} {fine}");
        let steps = vec![
            [0.0, 1.0, 1.0],
            [0.1, 1.0, 1.0],
            [0.2, 0.4, 0.01],
            [1.0, 0.4, 0.01],
            [1.1, 0.05, 0.0],
        ];
        let stepped = Retention::new(Curve::Measured(MeasuredCurve::new(steps)), 0.05);
        for soil in [measured([0.0, 0.2, 0.4, 0.7, 1.0]), measured([0.0, 1.0]), stepped] {
            let at = |s: f64| soil.under(-s * WEIGHT, WEIGHT);
            for k in 1..300 {
                let s = f64::from(k) * 0.004 + 1e-4;
                let step = 1e-6;
                let found = at(s);
                let change = soil.change(-WEIGHT, -s * WEIGHT, WEIGHT);
                let by =
                    |of: fn(&RetentionState) -> f64| (of(&at(s - step)) - of(&at(s + step))) / (2.0 * step * WEIGHT);
                assert!((by(|of| of.saturation) - found.slope).abs() < 1e-6 / WEIGHT, "{s}");
                assert!(found.slope >= 0.0 && change.permeability >= 0.0 && found.permeability >= LEAST);
                if found.permeability > LEAST {
                    assert!(
                        (by(|of| of.permeability) - change.permeability).abs() < 1e-6 / WEIGHT,
                        "{s}"
                    );
                }
            }
            let last = at(2.0);
            assert_eq!((last.slope, at(3.0)), (0.0, last));
        }
    }

    #[test]
    fn saturation_rises_with_the_pressure_and_so_does_permeability() {
        for soil in [loam(), sand()] {
            let under = |k: i32| soil.under(-WEIGHT * 1.3_f64.powi(k), WEIGHT);
            for k in -40..20 {
                let more = under(k);
                let less = under(k + 1);
                assert!(more.saturation > less.saturation && more.permeability >= less.permeability);
                assert!(more.slope > 0.0);
            }
        }
    }
}
