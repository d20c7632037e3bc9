//! Tests of faults: killed ranks, full disks, damaged checkpoints, signals and changed numbers of ranks. After each
//! fault, the continued run must give the results of the uninterrupted run, or the reason why it cannot.
//!
//! `cargo test` checks only the list of faults (`rows.rs`). The options `--short` and `--full` cause the faults.

mod apart;
mod damaged;
mod events;
mod footing;
mod ground;
mod kills;
mod places;
mod rejected;
mod restart;
mod rows;
mod signals;
mod solver;
#[path = "../support/mod.rs"]
mod support;
mod table;
mod writing;

use std::process::ExitCode;
use support::driver::{Request, look_through};

/// Rows of reliability that there must be.
const IDS: std::ops::RangeInclusive<u32> = 1..=40;

fn main() -> ExitCode {
    let rows = rows::all();
    let Some(request) = Request::read() else {
        let ids: Vec<&str> = rows.iter().map(|row| row.id).collect();
        return look_through("scripts/faults", IDS.map(|number| format!("F{number:02}")), &ids);
    };
    support::program(); // built before the first row is timed
    let ground = ground::Ground::new(request.depth);
    let wanted = rows.iter().filter(|row| request.wants(row.depth(), row.id, row.what));
    request.run(&table::COLUMNS, wanted, |row| row.judge(&ground))
}
