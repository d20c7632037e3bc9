//! Water content of a soil, theory-manual equation (T8.5).

use crate::water::flow::Soil;
use crate::water::retention::{RetainedChange, RetentionState};

impl<const D: usize> Soil<D> {
    /// Water per volume of the start, of soil that has become `J` times that volume, under the excess pressure `p`, Pa;
    /// `bulk`: of the water, Pa. Grains keep their volume.
    #[inline]
    pub fn content(&self, bulk: f64, J: f64, p: f64) -> f64 {
        self.pores(J) * (p / bulk).exp()
    }

    /// Under the whole pore pressure `p`, Pa, of water of the unit weight `weight`, N/m3.
    #[inline]
    pub fn retained(&self, p: f64, weight: f64) -> RetentionState {
        self.retention
            .as_ref()
            .map_or(RetentionState::FULL, |retention| retention.under(p, weight))
    }

    /// What those change by with the whole pore pressure, which was `before`, Pa.
    #[inline]
    pub fn retained_change(&self, before: f64, now: f64, weight: f64) -> RetainedChange {
        match &self.retention {
            Some(retention) => retention.change(before, now, weight),
            None => RetainedChange::default(),
        }
    }

    /// 1/Pa  see [`Retention::chord`](crate::water::retention::Retention::chord); 0 of pores that stay full
    #[inline]
    pub fn chord(&self, before: f64, now: f64, weight: f64) -> f64 {
        self.retention
            .as_ref()
            .map_or(0.0, |retention| retention.chord(before, now, weight))
    }

    /// Pores per volume of the start; none is left where that is not positive
    #[inline]
    pub fn pores(&self, J: f64) -> f64 {
        J - 1.0 + self.porosity
    }
}
