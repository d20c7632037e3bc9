//! Elements of pictures, such as canvas, axes and legend.

pub(crate) mod axes;
pub(crate) mod bar;
pub(crate) mod canvas;
pub(crate) mod chart;
pub(crate) mod colour;
pub(crate) mod layout;
pub(crate) mod legend;
pub(crate) mod splat;
pub(crate) mod ticks;
