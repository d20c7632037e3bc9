#![doc = include_str!("../README.md")]
//! ## Guarantees
//!
//! [`load`] reads the bytes of a case file. [`Case::from_bytes`] turns them into a valid [`Case`], or reports all
//! errors. Reading needs little memory, whatever numbers a case contains.
#![forbid(unsafe_code)]

#[macro_use]
pub mod words;
pub mod model;
pub mod observables;
mod parting;
pub mod schema;
pub mod surfaces;
pub mod unit;

mod case;
mod connected;
mod constants;
mod difference;
mod document;
mod earlier;
mod error;
mod estimate;
mod grid;
mod key_path;
mod nearest;
mod openings;
mod overrides;
mod preset;
mod read;
mod record;
mod reference;
mod report;
mod rounding;
mod seed;
mod shape_error;
mod sketch;
mod slips;
mod source;
mod spectrum;
mod validate;
mod waves;

pub use bsmpm::model::Regime;
pub use bsmpm::points::Seed;
pub use bsmpm::quadrature::Quadrature;
pub use bsmpm_shapes::{GridAxis, Outline, Region, Volume};
pub use case::{
    ActiveLoads, Analysis, Base, Body, Case, Check, Checkpoint, Column, Drain, DrainSite, ElementStage, ElementTest,
    Every, Face, FaceSupport, Flow, Footing, Format, Geometry, Gravity, History, HistorySubject, Inflow, Initial,
    LimitLoad, LoadWidth, LoadedLine, MASS, Made, MotionPath, NamedMaterial, NarrowestOpening, Nonlinear, Output,
    Plate, PointLoad, PointSelection, PrescribedMotion, Profile, Push, Quantity, Rigid, RigidShape, Shares, Site,
    Solver, SoughtLoad, Stage, Support, Traction, Triangle, Water,
};
pub use difference::{Difference, differences};
pub use error::{Choice, Error, Place};
pub use estimate::Estimate;
pub use grid::{GridSpec, Line};
pub use reference::reference;
pub use seed::seed;
pub use sketch::{Sketch, SketchedHistory};
pub use source::{MAX_BYTES, load};
pub use validate::HELD_WATER;
