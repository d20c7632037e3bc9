#![doc = include_str!("../README.md")]
//! Chapter 1 of the theory manual lists the algorithm of a step, with the file of each part.
#![forbid(unsafe_code)]
// The fields of section 2.4 of the paper keep its letters (F, dF, J, N) if these are unique in mechanics.
#![allow(non_snake_case)]

pub mod boundary;
pub mod control;
pub mod dynamics;
pub mod element;
pub mod energy;
pub mod error;
pub mod exact;
pub mod field;
mod gauss;
pub mod grid;
pub mod initial;
pub mod interactions;
pub mod kinematics;
pub mod lanes;
pub mod linear;
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
