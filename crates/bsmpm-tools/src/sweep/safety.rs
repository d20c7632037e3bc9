//! Computes the factor of safety with one setting, for a sweep of factors of safety.

use std::path::PathBuf;

use bsmpm_io::exit::DONE;
use bsmpm_io::table::{Columns, TableColumn};

use super::quantity::FACTOR;
use crate::Error;
use crate::batch::{Batch, RunOrder};
use crate::fos;
use crate::launch::{Outcome, RunState};

/// The width of its band; the estimate is finer.
const WIDTH: f64 = 0.02;
/// Between which factors it is looked for.
const RANGE: [f64; 2] = [0.5, 3.0];

/// The outcome of a search: a history of one row with the factor.
pub(super) fn outcome(batch: &Batch, order: &RunOrder) -> Outcome {
    let directory = batch.output.join("runs").join(format!("{}.fos", order.name));
    let arguments = fos::FosArguments {
        from: Some(RANGE[0]),
        to: Some(RANGE[1]),
        width: Some(WIDTH),
        jobs: Some(1),
        set: order.set.clone(),
        output: Some(directory.clone()),
        force: batch.force,
        command: batch.solver.command.to_vec(),
        ..fos::FosArguments::of(batch.path.to_owned())
    };
    match fos::factor(&arguments) {
        Ok(found) => of(found, directory),
        Err(error) => {
            let state = match error {
                Error::NoStableState { .. } => RunState::NoConvergence,
                Error::NoFactor { .. } => RunState::Invalid,
                _ => RunState::Broken,
            };
            let reason = error.to_string().lines().map(str::trim).collect::<Vec<_>>().join(" ");
            Outcome {
                code: Some(error.exit_code()),
                ..Outcome::never(state, reason)
            }
        }
    }
}

fn of(found: fos::FoundFactor, directory: PathBuf) -> Outcome {
    let cost = found.cost;
    let Some(factor) = found.factor else {
        let reason = format!("it does not fail up to the factor {}", RANGE[1]);
        return Outcome {
            cost,
            directory: Some(directory),
            ..Outcome::never(RunState::Broken, reason)
        };
    };
    let headings = ["time", FACTOR].map(|name| TableColumn::new(name, "-")).to_vec();
    let history = Some(Columns {
        headings,
        values: vec![vec![1.0], vec![factor]],
    });
    Outcome {
        code: Some(DONE),
        history,
        cost,
        kept: found.kept,
        directory: Some(directory),
        ..Outcome::never(RunState::Done, String::new())
    }
}
