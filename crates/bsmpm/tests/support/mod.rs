//! Helpers of the tests in `bsmpm` and `bsmpm-trials`: linear solvers without PETSc, small models, reproducible random
//! numbers.

#![allow(dead_code)] // each uses its own part

pub mod random;
pub mod scene;
pub mod solver;
