//! Positions axes with equal scales.

use super::axes::{ChartAxes, LEFT, LINEAR};
use super::ticks::ValueRange;

const WIDEST: f64 = 1600.0;
const NARROWEST: f64 = 1000.0;
const HIGHEST: f64 = 1300.0;

/// The parts of a sheet across; [`Layout::axes`] places them downward.
pub(crate) struct Layout {
    /// The sheet's width in pixels.
    pub width: f64,
    left: f64,
    /// The size of the axes' box in pixels.
    wide: f64,
    high: f64,
    /// How much longer a metre upward is than one across: 1, unless the region is lower than what was allowed.
    pub stretch: f64,
    region: [ValueRange; 2],
}

impl Layout {
    /// A layout for the region of x and y, with `beside` pixels right of the axes. A region whose height is less than
    /// `lowest` of its width is stretched to that.
    pub fn of(region: [ValueRange; 2], beside: f64, lowest: f64) -> Self {
        let aspect = aspect(region);
        let stretch = (lowest / aspect).max(1.0);
        let wide = (WIDEST - LEFT - beside).min(HIGHEST / aspect);
        let content = LEFT + wide + beside;
        let width = content.max(NARROWEST);
        Self {
            width,
            left: LEFT + (width - content) / 2.0,
            wide,
            high: wide * aspect * stretch,
            stretch,
            region,
        }
    }

    /// The axes, their box beginning `top` pixels below the sheet's upper edge.
    pub fn axes(&self, top: f64) -> ChartAxes {
        let [x, y] = self.region;
        ChartAxes {
            left: self.left,
            top,
            right: self.left + self.wide,
            bottom: top + self.high,
            x,
            y,
            scales: LINEAR,
        }
    }
}

/// The height of a region over its width.
pub(crate) fn aspect([x, y]: [ValueRange; 2]) -> f64 {
    y.length() / x.length()
}
