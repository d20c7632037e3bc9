//! The programs from outside, a file for each of what is tried. One test program: each by itself would be linked with
//! the same crates again.

mod axisymmetric;
mod checkpoints;
mod command_line;
mod consolidation;
mod convergence;
mod cut_cells;
mod energy;
mod energy_made;
mod estimate;
mod factor_beside_bodies;
mod factor_of_safety;
mod faults;
mod free_field;
mod indicators;
mod laws;
mod lifts_on_soft_ground;
mod limit_load;
mod lock;
mod meeting_motions;
mod memory;
mod moved_interfaces;
mod open_faces;
mod outputs;
mod ranks;
mod references;
mod restart;
mod rigid;
mod room;
mod saturated_column;
mod scenes;
mod scripts;
mod settled_start;
mod signals;
mod solid;
mod solid_contact;
mod solid_loads;
mod solid_rigid;
mod solid_stages;
mod solid_told;
mod solid_water;
mod stages;
mod still_water;
mod strips;
mod sweep;
mod told;
mod told_parts;
mod undrained_stages;
mod unsaturated_column;
mod water_and_friction;
mod water_in_slopes;
mod waves;

#[path = "../support/mod.rs"]
mod support;
