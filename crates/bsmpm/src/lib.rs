#![doc = include_str!("../README.md")]
//! ## The paper's steps, and where they are
//!
//! Who has read the paper's section 2.4 finds its numbered steps here:
//!
//! | step | what | where |
//! | --- | --- | --- |
//! | (1) | shape functions and topology | [`grid::spline`], [`grid::shape`] |
//! | (2) | points to nodes | [`step::nodes`] |
//! | | functions of nearly empty cells, which are no unknowns (beyond the paper) | [`step::extension`] |
//! | (3), (7)-(9) | quasi-Newton iteration, both convergence measures | [`solve`], [`solve::quasi_newton`] |
//! | | where it ends, and what is round-off | [`solve::convergence`], [`solve::round_off`] |
//! | | Newton's method where it stalls | [`solve::newton`] |
//! | (9) | whether an elastic equilibrium is stable (beyond the paper) | [`solve::stability`] |
//! | (4) | trial deformation, F-bar | [`step::trial`] |
//! | (5) | out-of-balance force; what points weigh in it | [`step::residual`]; [`quadrature`] |
//! | (6) | stiffness K_0 at the first guess, complete derivative | [`step::stiffness`], [`solve::linearised`] |
//! | | both without the functions that are no unknowns | [`step::reduced_system`] |
//! | (10), (11) | grid kinematics, converged points | [`step::commit`] |
//!
//! [`boundary`] holds and loads the bodies, [`initial`] gives them stress at the start. [`control`] cuts and grows the
//! steps so that a non-converged one is never accepted; [`parallel`] holds the two traits behind which ranks and linear
//! algebra live, [`grid::contributions`] and [`exact`] what makes sums the same on any number of ranks and threads;
//! [`observe`] evaluates what a history records, [`energy`] where the energy of a step went. [`element`] drives one
//! point by itself.
#![forbid(unsafe_code)]
// The fields of section 2.4 keep the paper's letters (F, dF, J, N) where they have one meaning in mechanics.
#![allow(non_snake_case)]

pub mod background;
pub mod boundary;
pub mod control;
pub mod element;
pub mod energy;
pub mod error;
pub mod exact;
pub mod free_field;
mod gauss;
pub mod grid;
pub mod initial;
pub mod kinematics;
pub mod lanes;
pub mod material;
pub mod method;
pub mod model;
pub mod nodal;
pub mod observe;
pub mod parallel;
pub mod points;
pub mod quadrature;
pub mod real;
pub mod schedule;
pub mod solve;
pub mod stabilisation;
pub mod step;
pub mod tensor;
pub mod threads;
pub mod water;
