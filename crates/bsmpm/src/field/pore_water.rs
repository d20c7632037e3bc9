//! Pore water: effective stress, theory-manual equation (T8.1), hydrostatic pressure, given pressures, coupled flow and
//! suction. In coupled flow the excess pore pressures are additional unknowns.

pub mod ambient;
pub mod backward;
pub mod carried;
pub mod content;
mod coupling;
pub mod crossed;
pub mod drain;
pub mod flow;
pub mod follow;
pub mod linearised;
pub mod matrix;
pub mod newton;
pub mod nodes;
pub mod observed;
pub mod pore_pressure;
pub mod residual;
pub mod retention;
pub mod saved;
pub mod split;
pub mod still;
pub mod ties;
pub mod work;

use ambient::Ambient;
use flow::Flow;

/// Pore water of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Water<const D: usize> {
    /// Unit weight (N/m3).
    pub unit_weight: f64,
    /// Hydrostatic pressure field.
    pub ambient: Ambient,
    /// Coupled flow; `None` if the excess pressure is not an unknown.
    pub flow: Option<Flow<D>>,
}
