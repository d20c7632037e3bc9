//! The extremes: nearly incompressible and cohesionless soil, tiny and huge steps, points on knots, long runs, other
//! units and origins. Every row gives the right value or a clean refusal, or is printed as failing.
//!
//! `rows` declares them, one below the other, with their bounds and what is known to fail; `table` judges and prints;
//! the others measure: on the physics alone, with a solver of one rank that needs no PETSc, or through the real program.
//! Without `--short` or `--full`, as `cargo test` calls it, only the declaration itself is looked through.

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
use std::time::Instant;
use table::{Depth, Judged, Row};

/// Rows of reliability that there must be.
const IDS: std::ops::RangeInclusive<u32> = 1..=25;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |name: &str| arguments.iter().any(|argument| argument == name);
    let after = |name: &str| arguments.iter().skip_while(|argument| *argument != name).nth(1);
    let rows = rows::all();
    if let Some(depth) = [("--short", Depth::Short), ("--full", Depth::Full)].iter().find(|(name, _)| given(name)) {
        return run(&rows, depth.1, after("--only").map_or("", String::as_str), after("--output"));
    }
    let missing: Vec<String> =
        IDS.map(|number| format!("N{number:02}")).filter(|id| rows.iter().all(|row| row.id != id)).collect();
    missing.iter().for_each(|id| println!("no row for {id}"));
    println!("{} rows are declared; scripts/extremes measures them", rows.len());
    println!("{} passed, {} failed", usize::from(missing.is_empty()), missing.len());
    ExitCode::from(u8::from(!missing.is_empty()))
}

/// Measures the rows of a depth whose id or text contains `part`, and prints each as soon as it is there.
fn run(rows: &[Row], depth: Depth, part: &str, output: Option<&String>) -> ExitCode {
    let started = Instant::now();
    // What a measurement has to say goes into its row.
    std::panic::set_hook(Box::new(|_| ()));
    let wanted = |row: &&Row| row.depth <= depth && (row.id.contains(part) || row.what.contains(part));
    let mut judged: Vec<Judged> = Vec::new();
    println!("{}", table::heading());
    for row in rows.iter().filter(wanted) {
        judged.push(row.judge());
        println!("{}", judged[judged.len() - 1].line());
        if let Some(path) = output {
            std::fs::write(path, table::markdown(&judged)).expect("the table can be written");
        }
    }
    solver::forget();
    let known = judged.iter().filter(|row| row.verdict.is_known()).count();
    let failed = judged.iter().filter(|row| row.verdict.is_failure()).count();
    println!("\n{} rows, {known} of them failing as declared, {:.0} s", judged.len(), started.elapsed().as_secs_f64());
    println!("{} passed, {failed} failed", judged.len() - known - failed);
    ExitCode::from(u8::from(failed > 0 || judged.is_empty()))
}
