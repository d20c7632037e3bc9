//! What needs the whole physics. One test program, as each would compile all of it again.

#![allow(non_snake_case)] // the paper's letters, as in the crate

mod allocation;
mod properties;
mod support;
mod verification;
mod water;
