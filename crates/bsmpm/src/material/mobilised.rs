//! Mobilised strength: 1 divided by the strength reduction factor at which the stress reaches the yield surface.

use super::Material;

/// Bisections of the mobilised strength, which leave an error of 4e-9 below the strength, and of at most 3e-8 above it.
const BISECTIONS: usize = 28;
/// Upper bound of the mobilised strength; it is unlimited for tension beyond an apex.
const MOST: f64 = 16.0;
/// Relative distance from the strength within which a stress counts as being on the yield surface.
const ON_SURFACE: f64 = 1e-4;

impl Material {
    /// Returns the mobilised strength 1/F of a principal Kirchhoff stress (Pa, descending) in a `state`. F is the
    /// factor of [`Material::reduced`] for which the stress lies on the yield surface. The result is 0 without strength
    /// limit or shear, 1 at yield, above 1 for stresses outside the static yield surface, and at most 16. A tension
    /// cut-off does not count.
    pub fn mobilised(&self, tau: [f64; 3], state: &[f64]) -> f64 {
        if !self.yields() {
            return 0.0;
        }
        let law = self.without_cut_off();
        let outside = |share: f64| law.clone().into_owned().reduced(1.0 / share).yield_function(tau, state) > 0.0;
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
        // A strength below the resolution of the bisection is set to 0.
        if lower == 0.0 { 0.0 } else { upper }
    }

    /// Returns whether a mobilised strength belongs to a stress on or outside the yield surface.
    pub fn is_yielding(mobilised: f64) -> bool {
        mobilised >= 1.0 - ON_SURFACE
    }
}
