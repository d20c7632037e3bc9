//! Water in the ground: its unit weight, the still water that is given, and, where it flows, what the soils and the
//! drains are to it.
//!
//! Stresses are effective ones. The pore pressure is p = p_a + p_e: p_a of the still water around (`ambient`), whose
//! gradient acts as a force on the material, and the excess p_e, an unknown where water flows.
#![doc = include_str!("water.md")]

pub mod ambient;
pub mod backward;
pub mod carried;
pub mod content;
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

/// What a scene says of water.
#[derive(Clone, Debug, PartialEq)]
pub struct Water<const D: usize> {
    /// N/m3
    pub unit_weight: f64,
    /// still water
    pub ambient: Ambient,
    /// present where the excess pressure is an unknown
    pub flow: Option<Flow<D>>,
}
