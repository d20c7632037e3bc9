//! Tests of the complete method, in one program to save compilation time.

#![allow(non_snake_case)] // the paper's letters, as in the crate

mod allocation;
mod properties;
mod support;
mod verification;
mod water;
