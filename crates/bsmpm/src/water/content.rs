//! How much water a soil holds.

use crate::water::flow::Soil;

impl<const D: usize> Soil<D> {
    /// Water per volume of the start, of soil that has become `J` times that volume, under the excess pressure `p`, Pa;
    /// `bulk`: of the water, Pa. Grains keep their volume.
    #[inline]
    pub fn content(&self, bulk: f64, J: f64, p: f64) -> f64 {
        self.pores(J) * (p / bulk).exp()
    }

    /// Pores per volume of the start; none is left where that is not positive
    #[inline]
    pub fn pores(&self, J: f64) -> f64 {
        J - 1.0 + self.porosity
    }
}
