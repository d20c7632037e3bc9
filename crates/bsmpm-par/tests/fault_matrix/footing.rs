//! The strip footing, killed ten times, on 2, 3 and 1 ranks in turn: its pressure against the uninterrupted run's.

use crate::ground::{Ground, spread};
use crate::support::results::{history, manifest, steps};
use crate::support::{Scratch, shipped};
use crate::table::{Tried, trials};
use bsmpm_io::table::Columns;
use std::fmt::Write;
use std::path::Path;

/// Kills.
const TIMES: usize = 10;
/// Largest difference of the pressure, relative to its largest value.
const TOLERATED: f64 = 1e-5;

/// Both curves, for whoever wants to see them.
fn write(whole: &Columns, killed: &Columns) {
    let column = |columns: &Columns, name: &str| columns.get(name).unwrap().to_vec();
    let (at, one, other) = (column(whole, "penetration"), column(whole, "p_over_c"), column(killed, "p_over_c"));
    let mut text = String::from("penetration,uninterrupted,killed\n# m,-,-\n");
    for ((at, one), other) in at.iter().zip(&one).zip(&other) {
        writeln!(text, "{at:?},{one:?},{other:?}").unwrap();
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/faults");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("killed_footing.csv"), text).unwrap();
}

/// Runs it both ways.
pub fn killed(_: &Ground, _: usize) -> Tried {
    let case = shipped("short/strip_footing.toml");
    let mut told = String::new();
    let tried = trials(1, |_| {
        let scratch = Scratch::new();
        let often = "output.checkpoint={every_steps=5}";
        let run = |name: &str, ranks: usize| {
            let arguments = [case.to_str().unwrap(), "-q", "-o", name, "--restart", "auto", "--set", often];
            scratch.job(Some(ranks), &arguments).within(600)
        };
        run("whole", 2).run().expect(0);
        let directory = scratch.path("killed");
        let made = || std::fs::read_to_string(directory.join("steps.csv")).map_or(0, |text| text.lines().count());
        let mut at = Vec::new();
        for time in 0..TIMES {
            let mut running = run("killed", [2, 3, 1][time % 3]).start();
            // Later and later, and always before the 160th step.
            let step = 15 * time + (15.0 * spread(time, 16)) as usize;
            running.until("the step", || made() >= step + 2);
            at.push(made() - 2);
            running.kill();
            running.end();
        }
        run("killed", [2, 3, 1][TIMES % 3]).run().expect(0);
        let (whole, killed) = (history(&scratch.path("whole")), history(&directory));
        assert_eq!(killed.get("time"), whole.get("time"), "each step once");
        write(&whole, &killed);
        let [one, other] = [&whole, &killed].map(|columns| columns.get("p_over_c").unwrap());
        let largest = one.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let difference = one.iter().zip(other).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / largest;
        let restarts = &manifest(&directory).restarts;
        let ranks: Vec<String> = restarts.iter().map(|restart| restart.ranks.to_string()).collect();
        let iterations = |name: &str| steps(&scratch.path(name)).get("iterations").unwrap().iter().sum::<f64>();
        told = format!(
            "killed at steps {at:?}; on 2, then {} ranks; {} iterations for {}; p/c to {largest:.2}",
            ranks.join(", "),
            iterations("killed"),
            iterations("whole")
        );
        assert!(difference <= TOLERATED, "{difference:e}: {told}");
        difference
    });
    tried.figure(|difference| format!("pressure differs by {difference}, relative")).remark(&told)
}
