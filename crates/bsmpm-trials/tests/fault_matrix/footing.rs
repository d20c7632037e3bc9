//! Tests that the run of a strip footing, killed ten times and continued on 2, 3 and 1 ranks, has the results of an
//! uninterrupted run.

use crate::ground::{Ground, spread};
use crate::support::results::{history, manifest};
use crate::support::{Job, Scratch, shipped};
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
    let at = column(whole, "penetration");
    let one = column(whole, "p_over_c");
    let other = column(killed, "p_over_c");
    let mut text = String::from("penetration,uninterrupted,killed\n# m,-,-\n");
    for ((at, one), other) in at.iter().zip(&one).zip(&other) {
        writeln!(text, "{at:?},{one:?},{other:?}").unwrap();
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/faults");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("killed_footing.csv"), text).unwrap();
}

/// Runs of the case in a directory of their own.
struct Runs {
    case: String,
    scratch: Scratch,
}

impl Runs {
    fn job(&self, name: &str, ranks: usize) -> Job {
        let often = "output.checkpoint={every_steps=5}";
        let arguments = [&*self.case, "-q", "-o", name, "--restart", "auto", "--set", often];
        self.scratch.job(Some(ranks), &arguments).within(600)
    }

    /// Kills it again and again; the steps that it had made each time.
    fn killed(&self, name: &str) -> Vec<usize> {
        let table = self.scratch.path(name).join("steps.csv");
        let made = || std::fs::read_to_string(&table).map_or(0, |text| text.lines().count().saturating_sub(2));
        let mut at = Vec::new();
        for time in 0..TIMES {
            let mut running = self.job(name, [2, 3, 1][time % 3]).start();
            // Later and later, after the first checkpoint and before the 160th step.
            let step = 6 + 15 * time + (14.0 * spread(time, 16)) as usize;
            running.until("the step", || made() >= step);
            at.push(made());
            running.kill();
            running.end();
        }
        self.job(name, [2, 3, 1][TIMES % 3]).run().expect(0);
        at
    }
}

/// Runs it both ways.
pub fn killed(_: &Ground, _: usize) -> Tried {
    let mut reported = String::new();
    let tried = trials(1, |_| {
        let case = shipped("short/strip_footing.toml").to_str().unwrap().to_owned();
        let runs = Runs {
            case,
            scratch: Scratch::new(),
        };
        runs.job("whole", 2).run().expect(0);
        let at = runs.killed("killed");
        let directories = ["whole", "killed"].map(|name| runs.scratch.path(name));
        let [whole, killed] = directories.each_ref().map(|directory| history(directory));
        assert_eq!(killed.get("time"), whole.get("time"), "each step once");
        write(&whole, &killed);
        let [one, other] = [&whole, &killed].map(|columns| columns.get("p_over_c").unwrap());
        let largest = one.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let difference = one
            .iter()
            .zip(other)
            .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
            / largest;
        let ranks: Vec<String> = manifest(&directories[1])
            .restarts
            .iter()
            .map(|restart| restart.ranks.to_string())
            .collect();
        reported = format!(
            "killed after steps {at:?}; went on on {} ranks; p/c to {largest:.2}",
            ranks.join(", ")
        );
        assert!(difference <= TOLERATED, "{difference:e}: {reported}");
        difference
    });
    tried
        .figure(|difference| format!("pressure differs by {difference}, relative"))
        .remark(&reported)
}
