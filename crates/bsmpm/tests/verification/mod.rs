#![doc = include_str!("README.md")]
//! Tests against closed forms. Comments after `measured` give the development machine's value.

mod absorbing;
mod axisymmetric;
mod bar;
mod cauchy;
mod column;
mod contact;
mod damping;
mod discs;
mod dynamics;
mod energy;
mod entering;
mod free_field;
mod geostatic;
mod inf_sup;
mod interface;
mod invariance;
mod locking;
mod newton;
mod oedometer;
mod penalty;
mod rigid;
mod rotation;
mod sections;
mod sections_at_ends;
mod seepage;
mod stability;
mod strips;
mod surfaces;
