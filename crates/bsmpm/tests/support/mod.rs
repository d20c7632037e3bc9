//! What the tests of the physics, and the extremes of `bsmpm-trials`, share: a linear solver that stands in for PETSc,
//! scenes built through the public API, and numbers that look random but are the same in every run.

#![allow(dead_code)] // each uses its own part

pub mod random;
pub mod scene;
pub mod solver;
