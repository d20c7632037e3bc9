//! `bsmpm limit-load`: computes limit loads on several grids and extrapolates them, theory-manual equation (T9.9).

use std::path::PathBuf;

use bsmpm_messages::headed;
use bsmpm_scene::Case;
use clap::Args;

use crate::batch::{Options, RunOrder};
use crate::launch::{Outcome, RunState, command};
use crate::report::save;
use crate::verify_case::grids::{divided, divided_equally, is_graded};
use crate::{Error, case};

mod picture;
mod report;

use report::LimitLoadReport;

/// The override that every run has.
const PURPOSE: &str = "analysis.purpose=\"limit-load\"";
/// Of its files.
const NAME: &str = "limit-load";

/// Which case, and how many grids.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The case is run with [analysis] purpose = \"limit-load\", whether it says so or not: that chooses points, order, method, steps
and tolerances which the case does not give, and raises the stiffness, so that the geometry stays as drawn (the notes of
`bsmpm-par CASE --check` list them). Something must be moved: [footing], [[prescribed]] or [[rigid]].

The first grid is the case's own; each further one has cells half as large. Limit loads of footings converge from above, with
an error in proportion to the size of the cells, so the extrapolated load is 2 fine - coarse, of the two finest grids. Its band
is half of what the finest grid is off (all of it where loads rise as cells shrink), or the difference from the extrapolation
of the two grids before, whichever is larger. In all verified cases it contains the exact load. Where the load still changes
by more than 1 % over the last quarter of the displacement, there is no limit load: nothing is extrapolated.

If a material has friction, and a cohesion that is small against its weight, one more run on the coarsest grid without this
cohesion measures its part of the load, at least.

DIR gets limit-load.json, limit-load.csv, limit-load.png (load against displacement) and runs/. Finished runs are kept.

Exit codes: 0 found; 2 command line; 65 the case has errors, or nothing moves; 66 no such case; 80 no limit was reached; that
of a run that did not come to its end.

Examples:
  bsmpm limit-load footing.toml
  bsmpm limit-load footing.toml --grids 3 --set material.sand.friction_angle=35")]
pub struct LimitLoadArguments {
    /// The case file
    pub case: PathBuf,
    /// Grids: the case's own, and finer ones
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(2..=4))]
    pub grids: u32,
    /// How the runs are made.
    #[command(flatten)]
    pub options: Options,
}

/// What was found, for the screen.
#[derive(Debug)]
pub struct FoundLimitLoads {
    /// Tables and sentences.
    pub text: String,
    /// What was written.
    pub files: Vec<PathBuf>,
    /// Whether every load has reached its limit on every grid.
    pub is_reached: bool,
}

/// Finds the loads; `say` gets a line for every run as soon as it has ended.
///
/// # Errors
/// Those of the command line and of the case on each grid before anything runs; [`Error::Run`] for a run that did not
/// come to its end; those of files.
pub fn run(arguments: &LimitLoadArguments, mut say: impl FnMut(&str)) -> Result<FoundLimitLoads, Error> {
    let options = &arguments.options;
    let path = &*arguments.case;
    let command = options.words();
    let output = options.directory(path, ".limit-load");
    let bytes = case::load(path)?;
    let orders = arguments.orders(&bytes)?;
    let batch = options.batch(&command, path, &output)?;
    let outcomes = batch.run(&orders, command::ranks(&command), |index, outcome| {
        let cell = orders[index].case.grid.shortest();
        let cpu = outcome.cost.cpu_seconds;
        say(format!(
            "cells of {cell:.4} m: {}, {cpu:.1} CPU s {}",
            outcome.words(),
            outcome.reason
        )
        .trim_end());
    });
    let grids = arguments.grids as usize;
    for (order, outcome) in orders.iter().zip(&outcomes).take(grids) {
        ended(order, outcome)?;
    }
    let without_cohesion = outcomes.get(grids);
    if let Some(outcome) = without_cohesion.filter(|outcome| outcome.state != RunState::Done) {
        let warning = format!(
            "W0853: the run without the small cohesions failed ({}), so the part of the limit load that they carry is \
             unknown. Set these cohesions to 0 in a copy of the case, and find out why it fails.",
            outcome.reason
        );
        say(&headed(&warning, "warning"));
    }
    let without_cohesion = without_cohesion.filter(|outcome| outcome.state == RunState::Done);
    let report = LimitLoadReport::of(&orders[..grids], &outcomes[..grids], without_cohesion)?;
    let mut files = save(&output, NAME, &report.csv(), &report)?;
    files.extend(picture::draw(&report, &orders[..grids], &outcomes[..grids], &output)?);
    Ok(FoundLimitLoads {
        text: report.text(),
        files,
        is_reached: report.is_reached(),
    })
}

fn ended(order: &RunOrder, outcome: &Outcome) -> Result<(), Error> {
    match outcome.state {
        RunState::Done => Ok(()),
        _ => Err(outcome.error(format!("the run with cells of {} m", order.case.grid.shortest()))),
    }
}

impl LimitLoadArguments {
    /// A run on each grid, the coarsest first, and one without small cohesions on the coarsest if there are any.
    fn orders(&self, bytes: &[u8]) -> Result<Vec<RunOrder>, Error> {
        let set = [&self.options.set[..], &[PURPOSE.to_owned()]].concat();
        let own = case::parsed(&self.case, bytes, &set)?;
        let finer = (1..self.grids).map(|level| refined(&own, 1 << level));
        let mut all: Vec<Vec<String>> = std::iter::once(Vec::new()).chain(finer).collect();
        let sought = own.limit_load.iter();
        let small: Vec<&String> = sought.flat_map(|sought| &sought.small_cohesions).collect();
        if !small.is_empty() {
            all.push(
                small
                    .iter()
                    .map(|name| format!("material.{name}.cohesion=0.0"))
                    .collect(),
            );
        }
        let mut orders = Vec::new();
        for further in all {
            let order = RunOrder::read(&self.case, bytes, [&set[..], &further].concat(), further.len());
            orders.push(order.map_err(|errors| Error::BadCase {
                path: self.case.clone(),
                errors,
            })?);
        }
        Ok(orders)
    }
}

/// The settings of the case's grid with each cell divided into so many parts, in as many steps.
fn refined(own: &Case, parts: usize) -> Vec<String> {
    let mut set = if is_graded(own) {
        divided(own, parts)
    } else {
        divided_equally(own, parts)
    };
    // Steps that a preset chooses would follow the cells.
    set.push(format!(
        "analysis.steps={}",
        (own.analysis.end / own.analysis.dt).round()
    ));
    set
}
