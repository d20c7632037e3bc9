#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

pub mod halo;
pub mod launch;
pub mod linear;
pub mod load;
pub mod migrate;
pub mod plan;
pub mod signals;
pub mod simulation;
pub mod slab;
pub mod stencil;
pub mod timers;
pub mod traffic;
