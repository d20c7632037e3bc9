//! Retention curve and relative permeability: van Genuchten and Mualem, theory-manual equation (T8.15), or measured.

mod measured;

pub use measured::MeasuredCurve;

use crate::gauss::GAUSS;

/// Smallest relative permeability. It represents film and vapour flow and keeps dry zones connected. A flux of 1e-6 of
/// the saturated one does not change any balance noticeably.
const LEAST: f64 = 1e-6;

/// Smallest alpha s at which the derivative of the relative permeability is evaluated. For n < 2 it grows without bound
/// at air entry, as (alpha s)^(n-2).
const ENTERED: f64 = 1e-3;

/// Retention curve of a soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Retention {
    /// Effective saturation and relative permeability under suction.
    pub curve: Curve,
    /// Residual saturation, which is excluded from Bishop's chi (-).
    pub residual: f64,
    /// Suction heads at the breakpoints of the curve, from 0 on, and the integral of the effective saturation up to
    /// each (m).
    filled: Vec<[f64; 2]>,
}

/// Effective saturation and relative permeability as functions of the suction head s (m).
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// Effective saturation (1 + (alpha s)^n)^-m with m = 1 - 1/n (van Genuchten 1980), permeability of Mualem (1976).
    VanGenuchten {
        /// Inverse of the air-entry suction head (1/m).
        alpha: f64,
        /// Exponent above 1; larger for more uniform pores (-).
        n: f64,
    },
    /// Measured curve.
    Measured(MeasuredCurve),
}

/// Largest number of breakpoints up to which the integral of a curve is tabulated.
const BENDS: usize = 32;

/// Values of a curve at one suction head.
struct RetentionPoint {
    /// Effective saturation (-).
    effective: f64,
    /// Decrease of the effective saturation per suction head, not negative (1/m).
    by_head: f64,
    /// Relative permeability, before the lower bound (-).
    permeability: f64,
}

/// Retention state of a soil under a pore pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RetentionState {
    /// Saturation (-).
    pub saturation: f64,
    /// Derivative of the saturation with respect to the pressure, not negative (1/Pa).
    pub slope: f64,
    /// Effective saturation, 0 at residual saturation; equal to Bishop's chi (-).
    pub effective: f64,
    /// Relative permeability (-).
    pub permeability: f64,
}

/// Derivatives of the retention state with respect to the pore pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RetainedChange {
    /// Of the effective saturation (1/Pa).
    pub effective: f64,
    /// Of the relative permeability (1/Pa); near air entry, its value at a thousandth of the entry suction.
    pub permeability: f64,
    /// Of [`Retention::chord`] (1/Pa2).
    pub chord: f64,
}

impl RetentionState {
    /// Saturated pores.
    pub const FULL: Self = Self {
        saturation: 1.0,
        slope: 0.0,
        effective: 1.0,
        permeability: 1.0,
    };
}

impl Curve {
    /// Returns the air-entry suction head (m); for measured curves the first row with an effective saturation of at
    /// most 0.5.
    pub fn entry(&self) -> f64 {
        match self {
            Self::VanGenuchten { alpha, .. } => 1.0 / alpha,
            Self::Measured(of) => {
                let drawn = of.rows.iter().find(|row| row[1] <= 0.5);
                drawn.unwrap_or(&of.rows[of.rows.len() - 1])[0]
            }
        }
    }

    /// Returns the next breakpoint of the curve above the head `s` (m): the rows of a measured curve, otherwise a
    /// geometric sequence from 1/64 of the entry head with the ratio 2.
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

    /// Returns the integral of the effective saturation between two heads without a breakpoint in between, by Gauss
    /// quadrature (m).
    fn between(&self, from: f64, to: f64) -> f64 {
        let middle = 0.5 * (from + to);
        let half = 0.5 * (to - from);
        GAUSS
            .iter()
            .map(|(at, weight)| half * weight * self.drawn(middle + half * at).effective)
            .sum()
    }

    /// Returns the values of the curve at the suction head `s` > 0 (m).
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

    /// Returns the decrease of the relative permeability per suction head at `s` > 0 (m) (1/m). Near air entry it is
    /// that at a thousandth of the entry suction.
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
    /// Creates the retention curve with the residual saturation `residual` (-).
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

    /// Creates van Genuchten's curve with `alpha` (1/m), `n` and `residual` (-).
    pub fn van_genuchten(alpha: f64, n: f64, residual: f64) -> Self {
        Self::new(Curve::VanGenuchten { alpha, n }, residual)
    }

    /// Returns the retention state under the pore pressure `p` (Pa) for water of the unit weight `weight` (N/m3).
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

    /// Returns the derivatives at the pore pressure `now` (Pa) after the pressure `before`. At kinks they are
    /// one-sided, from the saturated and from the driest soil.
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
        // For a small change the chord is the tangent, and its derivative half the curvature, which is negligible in
        // the stabilisation term.
        if change.abs() < 1e-6 * weight {
            return 0.0;
        }
        (self.under(now, weight).slope - self.chord(before, now, weight)) / change
    }

    /// Returns the change of saturation per change of pressure between `before` and `now` (Pa) (1/Pa).
    pub fn chord(&self, before: f64, now: f64, weight: f64) -> f64 {
        let change = now - before;
        // Below 1e-6 m of water head the difference quotient is dominated by round-off.
        if change.abs() < 1e-6 * weight {
            return self.under(now, weight).slope;
        }
        ((self.under(now, weight).saturation - self.under(before, weight).saturation) / change).max(0.0)
    }

    /// Returns the work of suction per pore volume at the pore pressure `p` (Pa), the integral of -q dS from saturated
    /// pores on, by Gauss quadrature between breakpoints (J/m3). `weight` is the unit weight of water (N/m3).
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
        // Integration by parts from saturation on: -int s dSe = int Se ds - s Se.
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
