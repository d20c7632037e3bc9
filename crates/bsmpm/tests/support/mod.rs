//! Helpers of the tests and of `bsmpm-trials`: linear solvers without PETSc, small models, and reproducible random
//! numbers.

#![allow(dead_code)] // each uses its own part

pub mod random;
pub mod scene;
pub mod solver;
