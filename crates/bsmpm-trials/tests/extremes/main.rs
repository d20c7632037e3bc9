//! Tests of extreme cases. A case passes if its result is within its bound or if the program refuses it.
//!
//! `cargo test` checks only the list of cases (`rows.rs`). The options `--short` and `--full` run the cases.

#![allow(non_snake_case)] // the paper's letters, as in the crate

mod geometry;
mod incompressible;
mod long;
mod materials;
#[path = "../../../bsmpm/tests/support/mod.rs"]
mod physics;
mod points;
mod rows;
mod scenes;
mod solver;
mod steps;
#[path = "../support/mod.rs"]
mod support;
mod table;
mod units;
mod weak;

use std::process::ExitCode;
use support::driver::{Request, look_through};

/// Rows of reliability that there must be.
const IDS: std::ops::RangeInclusive<u32> = 1..=25;

fn main() -> ExitCode {
    let rows = rows::all();
    let Some(request) = Request::read() else {
        let ids: Vec<&str> = rows.iter().map(|row| row.id).collect();
        return look_through("scripts/extremes", IDS.map(|number| format!("N{number:02}")), &ids);
    };
    support::program(); // built before the first row is timed
    let wanted = rows.iter().filter(|row| request.wants(row.depth, row.id, row.what));
    let code = request.run(&table::COLUMNS, wanted, table::Row::judge);
    solver::forget();
    code
}
