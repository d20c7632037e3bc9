//! Mobilised strength: 1 divided by the strength reduction factor at which the stress reaches the yield surface.

use super::Material;

/// Bisections of the mobilised strength: 4e-6 of a strength remains.
const BISECTIONS: usize = 28;
/// Times its strength that a stress is asked to need at most: tension beyond an apex has no end.
const MOST: f64 = 16.0;
/// Part of its strength within which a stress is on the yield surface.
const ON_SURFACE: f64 = 1e-4;

impl Material {
    /// Mobilised strength of a principal Kirchhoff stress (Pa, descending) in a `state`: 1/F, F the factor by which the
    /// strength may be divided (as strength reduction does, [`Material::reduced`]) until the stress is on the yield
    /// surface. 0 of a law without strength and without shear, 1 at yield, above 1 where a law lets the stress beyond
    /// the static surface; 16 at most. A graded law answers through [`Material::at`] only.
    pub fn mobilised(&self, tau: [f64; 3], state: &[f64]) -> f64 {
        if !self.yields() || self.is_graded() {
            return 0.0;
        }
        let outside = |share: f64| self.clone().reduced(1.0 / share).yield_function(tau, state) > 0.0;
        let mut upper = 1.0;
        while outside(upper) && upper < MOST {
            upper *= 2.0;
        }
        if upper == MOST && outside(upper) {
            return MOST;
        }
        let mut lower = 0.5 * upper * f64::from(u8::from(upper > 1.0));
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (lower + upper);
            if outside(middle) {
                lower = middle
            } else {
                upper = middle
            }
        }
        // What is less than can be determined is nothing.
        if lower == 0.0 { 0.0 } else { upper }
    }

    /// Whether a mobilised strength is that of a stress on the yield surface, or beyond.
    pub fn is_yielding(mobilised: f64) -> bool {
        mobilised >= 1.0 - ON_SURFACE
    }
}
