//! How much water a soil keeps under suction, and how well it still conducts (van Genuchten 1980, Mualem 1976).

/// Least relative permeability: what a soil lets through as films and vapour, and what keeps a dry one from being cut
/// off. A flux of a millionth of the saturated one changes no balance; the flow past a dry zone would lose its only
/// way.
const LEAST: f64 = 1e-6;

/// Least alpha s at which the derivative of the relative permeability is taken: below n = 2 that goes beyond all bounds
/// where air enters, as (alpha s)^(n-2).
const ENTERED: f64 = 1e-3;

/// Retention curve of a soil: effective saturation (1 + (alpha s)^n)^-m, m = 1 - 1/n, under the suction head s, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retention {
    /// 1/m  over the head at which air enters
    pub alpha: f64,
    /// -  above 1: the larger, the more alike the pores
    pub n: f64,
    /// -  saturation that no suction removes
    pub residual: f64,
}

/// A soil under a pore pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retained {
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

impl Retained {
    /// All pores full of water.
    pub const FULL: Self = Self { saturation: 1.0, slope: 0.0, effective: 1.0, permeability: 1.0 };
}

impl Retention {
    /// Under the pore pressure `p`, Pa, of water of the unit weight `weight`, N/m3.
    pub fn under(&self, p: f64, weight: f64) -> Retained {
        if p >= 0.0 {
            return Retained::FULL;
        }
        let (n, m) = (self.n, 1.0 - 1.0 / self.n);
        let head = self.alpha * -p / weight;
        let drawn = head.powf(n);
        let effective = (1.0 + drawn).powf(-m);
        // (alpha s)^(n-1): where n is near 1 and s near 0 the quotient of the powers has no meaning.
        let by_head = m * n * self.alpha * head.powf(n - 1.0) * effective / (1.0 + drawn);
        // 1 - Se^(1/m) = drawn/(1 + drawn), which does not cancel.
        let wide = 1.0 - (drawn / (1.0 + drawn)).powf(m);
        Retained {
            saturation: self.residual + (1.0 - self.residual) * effective,
            slope: (1.0 - self.residual) * by_head / weight,
            effective,
            permeability: (effective.sqrt() * wide.powi(2)).max(LEAST),
        }
    }

    /// What changes with the pore pressure `now`, Pa, which was `before`; where its functions have kinks on their sides
    /// of the full and of the driest soil.
    pub fn change(&self, before: f64, now: f64, weight: f64) -> RetainedChange {
        if now >= 0.0 {
            return RetainedChange { chord: self.chord_change(before, now, weight), ..RetainedChange::default() };
        }
        let (n, m, found) = (self.n, 1.0 - 1.0 / self.n, self.under(now, weight));
        let head = self.alpha * -now / weight;
        let drawn = head.powf(n);
        let effective = found.slope / (1.0 - self.residual);
        let wide = 1.0 - (drawn / (1.0 + drawn)).powf(m);
        // (drawn/(1 + drawn))^(m-1) has the factor head^-1, as n (1 - m) = 1.
        let steep = if n < 2.0 { head.max(ENTERED) } else { head }.powf(n - 2.0);
        let widens = m * n * self.alpha / weight * steep * (1.0 + drawn).powf(-1.0 - m);
        let root = found.effective.sqrt();
        let permeability = 0.5 * effective / root * wide.powi(2) + 2.0 * root * wide * widens;
        let conducts = found.permeability > LEAST;
        RetainedChange {
            effective,
            permeability: if conducts { permeability } else { 0.0 },
            chord: self.chord_change(before, now, weight),
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
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOAM: Retention = Retention { alpha: 3.6, n: 1.56, residual: 0.18 };
    const SAND: Retention = Retention { alpha: 14.5, n: 2.68, residual: 0.1 };
    const WEIGHT: f64 = 9810.0;

    #[test]
    fn saturation_and_permeability_follow_their_formulas() {
        for soil in [LOAM, SAND] {
            let m = 1.0 - 1.0 / soil.n;
            for head in [0.01, 0.1, 1.0, 3.0] {
                let found = soil.under(-head * WEIGHT, WEIGHT);
                let effective = (1.0 + (soil.alpha * head).powf(soil.n)).powf(-m);
                let k = effective.sqrt() * (1.0 - (1.0 - effective.powf(1.0 / m)).powf(m)).powi(2);
                assert!((found.effective - effective).abs() < 1e-14);
                assert!((found.saturation - soil.residual - (1.0 - soil.residual) * effective).abs() < 1e-14);
                assert!((found.permeability / k.max(LEAST) - 1.0).abs() < 1e-9, "{found:?} {k}");
            }
            assert_eq!(soil.under(0.0, WEIGHT), Retained::FULL);
            assert_eq!(soil.under(1e4, WEIGHT), Retained::FULL);
        }
        // Half of what can leave has left where (alpha s)^n = 2^(1/m) - 1; fully dry soil keeps the residual water.
        assert!((SAND.under(-1e12, WEIGHT).saturation - 0.1).abs() < 1e-6);
        assert_eq!(SAND.under(-1e12, WEIGHT).permeability, LEAST);
    }

    #[test]
    fn the_slope_is_the_derivative() {
        for soil in [LOAM, SAND] {
            for head in [0.02, 0.3, 2.0] {
                let (p, step) = (-head * WEIGHT, 3e-5 * head * WEIGHT);
                let (found, saturation) = (soil.under(p, WEIGHT).slope, |p: f64| soil.under(p, WEIGHT).saturation);
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
        let clay = Retention { alpha: 0.8, n: 1.09, residual: 0.07 };
        for soil in [LOAM, SAND, clay] {
            for head in [0.01, 0.3, 2.0] {
                let (p, step) = (-head * WEIGHT, 3e-5 * head * WEIGHT);
                let (found, of) = (soil.change(-WEIGHT, p, WEIGHT), |p: f64| soil.under(p, WEIGHT));
                let difference = (of(p + step).permeability - of(p - step).permeability) / (2.0 * step);
                if of(p).permeability > LEAST && soil.alpha * head > ENTERED {
                    assert!((difference / found.permeability - 1.0).abs() < 1e-6, "{difference} {found:?}");
                }
            }
            // The factors besides the one that is cut are at most 1.
            let (m, steep) = (1.0 - 1.0 / soil.n, ENTERED.powf((soil.n - 2.0).min(0.0)));
            let most = m * soil.n * soil.alpha / WEIGHT * (0.5 + 2.0 * steep);
            for k in 1..200 {
                let near = soil.change(-WEIGHT, -WEIGHT * ENTERED / soil.alpha * 0.5_f64.powi(k), WEIGHT).permeability;
                assert!((0.0..=most).contains(&near), "{near} {most}");
            }
        }
    }

    #[test]
    fn saturation_rises_with_the_pressure_and_so_does_permeability() {
        for soil in [LOAM, SAND] {
            let under = |k: i32| soil.under(-WEIGHT * 1.3_f64.powi(k), WEIGHT);
            for k in -40..20 {
                let (more, less) = (under(k), under(k + 1));
                assert!(more.saturation > less.saturation && more.permeability >= less.permeability);
                assert!(more.slope > 0.0);
            }
        }
    }
}
