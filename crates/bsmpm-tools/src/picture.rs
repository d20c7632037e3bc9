//! What pictures are made of: a sheet of paper (`canvas`), axes (`layout`, `axes`, `ticks`), a legend (`legend`),
//! colours (`colour`, `bar`), a body of points (`splat`) and curves (`chart`). It knows no run.

pub(crate) mod axes;
pub(crate) mod bar;
pub(crate) mod canvas;
pub(crate) mod chart;
pub(crate) mod colour;
pub(crate) mod layout;
pub(crate) mod legend;
pub(crate) mod splat;
pub(crate) mod ticks;
