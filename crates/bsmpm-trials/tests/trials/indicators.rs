//! The indicators of real runs: the same on any number of ranks, of what the scene contains, and outside their usual
//! range for methods that are known to be bad.

use crate::support::cases::SLIDING_BLOCK;
use crate::support::results::manifest;
use crate::support::{Scratch, shipped};
use bsmpm_io::manifest::Indicator;
use std::collections::BTreeMap;

type Indicators = BTreeMap<String, Indicator>;

/// Those of a run on so many ranks that ends with `code`.
#[track_caller]
fn of(scratch: &Scratch, ranks: usize, arguments: &[&str], code: i32) -> Indicators {
    let directory = format!("{ranks}.out");
    let own = ["case.toml", "-q", "--force", "-o", &directory];
    scratch.mpirun(ranks, &[&own, arguments].concat()).expect(code);
    manifest(&scratch.path(&directory)).indicators
}

/// Every rank factorises the whole system, so that the runs themselves have the same bits on any number of ranks.
const WHOLE: [&str; 4] =
    ["--set", "solver.linear={ksp=\"preonly\",pc=\"cholesky\",factor=\"mumps\"}", "--set", "solver.nonlinear=broyden"];

/// Asserts that all are the same on 1 to 4 ranks to round-off, and returns their names.
#[track_caller]
fn agree(scratch: &Scratch, arguments: &[&str], code: i32) -> Vec<String> {
    let runs = [1, 2, 3, 4].map(|ranks| of(scratch, ranks, &[arguments, &WHOLE].concat(), code));
    for run in &runs[1..] {
        assert!(run.keys().eq(runs[0].keys()));
        for (name, found) in run {
            let first = runs[0][name].value;
            assert!((found.value - first).abs() <= 1e-12 * first.abs(), "{name}: {} and {first}", found.value);
        }
    }
    runs[0].keys().cloned().collect()
}

#[test]
fn they_are_the_same_on_1_2_3_and_4_ranks() {
    let collapse = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    let names = agree(&collapse, &["--max-steps", "150"], 75);
    let expected = [
        "compression",
        "energy-measure",
        "force-measure",
        "points-per-cell",
        "pressure-noise-average",
        "pressure-noise-plane",
        "quadrature-defect",
        "quadrature-defect-largest",
    ];
    let sorted = |more: &[&'static str]| {
        let mut all = [&expected, more].concat();
        all.sort_unstable();
        all
    };
    assert_eq!(
        names,
        sorted(&[
            "energy-growth",
            "front-setback",
            "smoothing-length",
            "step-advance",
            "support-pull",
            "wall-velocity"
        ])
    );
    let footing = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    let names = agree(&footing, &["--max-steps", "4"], 75);
    assert_eq!(names, sorted(&["background-work", "slip", "smoothing-length", "support-pull"]));
    // It slides over the bounds of slabs, smooths nothing, and keeps books.
    let block = Scratch::with_case(&format!("{SLIDING_BLOCK}\n[[history]]\nquantity = \"energy\"\n"));
    let names = agree(&block, &[], 0);
    assert_eq!(names, sorted(&["energy-closure", "energy-growth", "energy-loss", "step-advance", "support-pull"]));
}

#[test]
fn a_run_that_goes_on_has_those_of_one_that_was_not_stopped() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    let whole = of(&scratch, 1, &["--max-steps", "60"], 75);
    of(&scratch, 2, &["--max-steps", "30"], 75);
    let go_on = ["case.toml", "-q", "--restart", "auto", "-o", "2.out", "--max-steps", "60"];
    scratch.mpirun(2, &go_on).expect(75);
    let parts = manifest(&scratch.path("2.out")).indicators;
    assert!(parts.keys().eq(whole.keys()));
    for (name, found) in parts {
        let first = whole[&name].value;
        assert!((found.value - first).abs() <= 1e-6 * first.abs().max(1e-3), "{name}: {} and {first}", found.value);
    }
}

#[test]
fn one_point_a_cell_is_told_at_the_end() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    // Not longer: what is so unstable soon follows the last digits, which differ from machine to machine.
    let coarse = ["case.toml", "--max-steps", "10", "--set", "body.0.points_per_cell=1"];
    let bad = scratch.direct(&[&coarse[..], &["--set", "stabilisation.method=none"]].concat()).expect(75);
    assert!(
        bad.stderr.contains("unusual: pressure-noise-plane") && bad.stderr.contains("unusual: points-per-cell"),
        "{}",
        bad.stderr
    );
    let good = scratch.direct(&["case.toml", "--force", "--max-steps", "40"]).expect(75);
    assert!(good.stderr.contains("indicators: ") && !good.stderr.contains("unusual: "), "{}", good.stderr);
}
