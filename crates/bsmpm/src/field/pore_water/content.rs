//! Water content of a soil, theory-manual equation (T8.5).

use crate::field::pore_water::flow::Soil;
use crate::field::pore_water::retention::{RetainedChange, RetentionState};

impl<const D: usize> Soil<D> {
    /// Returns the water content of full pores per initial volume, at the volume ratio `J` and the pressure `p` (Pa),
    /// for water of the bulk modulus `bulk` (Pa). Grains are incompressible.
    #[inline]
    pub fn content(&self, bulk: f64, J: f64, p: f64) -> f64 {
        self.pores(J) * (p / bulk).exp()
    }

    /// Returns the retention state under the whole pore pressure `p` (Pa) for water of the unit weight `weight` (N/m3).
    #[inline]
    pub fn retained(&self, p: f64, weight: f64) -> RetentionState {
        self.retention
            .as_ref()
            .map_or(RetentionState::FULL, |retention| retention.under(p, weight))
    }

    /// Returns derivatives of the retention state at the whole pore pressure `now` after `before` (Pa).
    #[inline]
    pub fn retained_change(&self, before: f64, now: f64, weight: f64) -> RetainedChange {
        match &self.retention {
            Some(retention) => retention.change(before, now, weight),
            None => RetainedChange::default(),
        }
    }

    /// Returns the chord of the saturation (1/Pa), see [`Retention::chord`](super::retention::Retention::chord);
    /// 0 without retention.
    #[inline]
    pub fn chord(&self, before: f64, now: f64, weight: f64) -> f64 {
        self.retention
            .as_ref()
            .map_or(0.0, |retention| retention.chord(before, now, weight))
    }

    /// Returns the pore volume per initial volume; not positive if the pores are closed.
    #[inline]
    pub fn pores(&self, J: f64) -> f64 {
        J - 1.0 + self.porosity
    }
}
