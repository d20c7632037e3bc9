//! Tests indicators on several ranks and with inaccurate methods.

use crate::support::cases::{EXACT, SLIDING_BLOCK, slope};
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
const WHOLE: [&str; 5] = ["--set", "solver.nonlinear=broyden", EXACT[0], EXACT[1], EXACT[2]];

/// Asserts that all are the same on 1 to 4 ranks to round-off, and returns their names.
#[track_caller]
fn agree(scratch: &Scratch, arguments: &[&str], code: i32) -> Vec<String> {
    let runs = [1, 2, 3, 4].map(|ranks| of(scratch, ranks, &[arguments, &WHOLE].concat(), code));
    for run in &runs[1..] {
        assert!(run.keys().eq(runs[0].keys()));
        for (name, found) in run {
            let first = runs[0][name].value;
            assert!(
                (found.value - first).abs() <= 1e-12 * first.abs(),
                "{name}: {} and {first}",
                found.value
            );
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
    assert_eq!(
        names,
        sorted(&[
            "background-work",
            "cells-across-footing",
            "slip",
            "smoothing-length",
            "support-pull"
        ])
    );
    // It slides over the bounds of slabs, smooths nothing, and keeps books.
    let block = Scratch::with_case(&format!("{SLIDING_BLOCK}\n[[history]]\nquantity = \"energy\"\n"));
    let names = agree(&block, &[], 0);
    assert_eq!(
        names,
        sorted(&[
            "energy-closure",
            "energy-growth",
            "energy-loss",
            "step-advance",
            "support-pull"
        ])
    );
}

#[test]
fn a_run_that_goes_on_has_those_of_one_that_was_not_stopped() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    let whole = of(&scratch, 1, &["--max-steps", "60"], 75);
    of(&scratch, 2, &["--max-steps", "30"], 75);
    let go_on = [
        "case.toml",
        "-q",
        "--restart",
        "auto",
        "-o",
        "2.out",
        "--max-steps",
        "60",
    ];
    scratch.mpirun(2, &go_on).expect(75);
    let parts = manifest(&scratch.path("2.out")).indicators;
    assert!(parts.keys().eq(whole.keys()));
    for (name, found) in parts {
        let first = whole[&name].value;
        assert!(
            (found.value - first).abs() <= 1e-6 * first.abs().max(1e-3),
            "{name}: {} and {first}",
            found.value
        );
    }
}

#[test]
fn one_point_a_cell_is_reported_at_the_end() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    // Not longer: what is so unstable soon follows the last digits, which differ from machine to machine.
    let coarse = ["case.toml", "--max-steps", "10", "--set", "body.0.points_per_cell=1"];
    let bad = scratch
        .direct(&[&coarse[..], &["--set", "stabilisation.method=none"]].concat())
        .expect(75);
    assert!(
        bad.stderr.contains("warning I0002: ") && bad.stderr.contains("warning I0005: "),
        "{}",
        bad.stderr
    );
    let good = scratch
        .direct(&["case.toml", "--force", "--max-steps", "40"])
        .expect(75);
    let codes = good.stderr.matches("warning I").count();
    assert!(
        codes == 1 && good.stderr.contains("warning I0023: "),
        "four cells across the footing: {}",
        good.stderr
    );
}

/// The strip footing of the paper: noise of 13.4 (`none`), 1.46 (`f-bar`), 0.38 and 0.31 (`modified-f-bar`,
/// `consistent-f-bar`); with smaller cells 0.16. Where Poisson's ratio is 0.499 it is
/// 0.476 with `consistent-f-bar`, 0.277 as undrained soil.
#[test]
fn the_advice_against_noise_is_not_the_method_in_use() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    let consistent = "Set `stabilisation.method = \"consistent-f-bar\"`.";
    for (method, poisson, remedy) in [
        ("none", "0.3", consistent),
        ("f-bar", "0.499", consistent),
        ("modified-f-bar", "0.3", "Use smaller cells"),
        ("consistent-f-bar", "0.3", "Use smaller cells"),
        ("consistent-f-bar", "0.499", "drainage = \"undrained\""),
        ("subgrid-f-bar", "0.499", "drainage = \"undrained\""),
    ] {
        let [method_key, poisson_key] = [
            format!("stabilisation.method={method}"),
            format!("material.clay.poisson={poisson}"),
        ];
        let found = of(
            &scratch,
            1,
            &["--max-steps", "1", "--set", &method_key, "--set", &poisson_key],
            75,
        );
        let advice = &found["pressure-noise-plane"].advice;
        let recommended = format!("method = \"{method}\"");
        assert!(
            advice.contains(remedy) && !advice.contains(&recommended),
            "{method}, {poisson}: {advice}"
        );
    }
}

/// Beyond failure the artificial stiffness takes more than a tenth of the work.
const ACCEPTING: &str = "output.accept=[\"background-work\"]";

/// Loss of stiffness of the case with what is set, the time at which the ground failed, and the log.
#[track_caller]
fn stiffness(scratch: &Scratch, set: &[&str]) -> (Indicator, Option<f64>, String) {
    let set: Vec<&str> = set.iter().flat_map(|&set| ["--set", set]).collect();
    let accepting = ["case.toml", "--force", "--set", ACCEPTING];
    let log = scratch.direct(&[&accepting[..], &set].concat()).expect(0).stderr;
    let manifest = manifest(&scratch.path("case.out"));
    (
        manifest.indicators["stiffness-loss"].clone(),
        manifest.summary.failed_at,
        log,
    )
}

/// `bsmpm fos` finds a factor of 1.37. A loss of 2.4 to 3.0 was found at 1.3, and 1.1 at 1.
#[test]
fn a_slope_that_stands_keeps_its_stiffness_in_any_number_of_steps() {
    let scratch = Scratch::with_case(&slope(0.0));
    for steps in ["analysis.steps=10", "analysis.steps=40", "analysis.steps=100"] {
        for (factor, least, most) in [("1.0", 1.05, 1.15), ("1.3", 2.0, 4.0)] {
            let (found, failed_at, log) = stiffness(&scratch, &[steps, &format!("strength_reduction.factor={factor}")]);
            println!("{factor}, {steps}: {}", found.value);
            assert!(
                (least..most).contains(&found.value) && !found.unusual,
                "{factor}, {steps}: {}",
                found.value
            );
            assert!(
                failed_at.is_none() && !log.contains("I0027"),
                "{factor}, {steps}: {log}"
            );
        }
    }
}

/// A loss of 500 to 10,000 was found. The load at which a slope fails does not depend on the steps that lead there.
#[test]
fn a_slope_that_has_failed_is_reported_with_the_time() {
    let scratch = Scratch::with_case(&slope(0.0));
    for (factor, within) in [("1.45", 0.82..0.901), ("1.6", 0.64..0.701)] {
        for steps in ["analysis.steps=10", "analysis.steps=40", "analysis.steps=100"] {
            let (found, failed_at, log) = stiffness(&scratch, &[steps, &format!("strength_reduction.factor={factor}")]);
            println!("{factor}, {steps}: {} from {failed_at:?} on", found.value);
            let failed_at = failed_at.expect("it has failed");
            assert!(
                found.unusual && found.value > 300.0 && within.contains(&failed_at),
                "{found:?}, {failed_at}"
            );
            assert!(log.contains("warning I0027: ") && log.contains("`bsmpm fos`"), "{log}");
            let reported = format!("the ground failed at t = {}:", (failed_at * 1e6).round() / 1e6);
            assert!(log.contains(&reported), "{log}");
        }
    }
}

/// Stress that is redistributed under a load that rests is no failure: of gravity at once, of a stress at the start
/// beyond the strength, and of a strength that falls.
#[test]
fn ground_that_comes_to_rest_has_not_failed() {
    let begins = "\n[initial]\ngravity = \"elastic\"\n[strength_reduction]\nfactor = 1.3\n";
    let weakens = "\n[[stage]]\nat = 0.5\nstrength_reduction = 1.3\n";
    for (more, ramp) in [
        ("", "gravity.ramp=0"),
        (begins, "gravity.ramp=0"),
        (weakens, "gravity.ramp=0.4"),
    ] {
        let scratch = Scratch::with_case(&format!("{}{more}", slope(0.0)));
        let reduced = if more.is_empty() {
            "strength_reduction.factor=1.3"
        } else {
            "analysis.steps=20"
        };
        let log = scratch
            .direct(&["case.toml", "--set", ramp, "--set", reduced])
            .expect(0)
            .stderr;
        assert!(!log.contains("I0027"), "{log}");
    }
}

#[test]
fn failure_is_reported_alike_on_any_number_of_ranks_and_after_restarts() {
    let scratch = Scratch::with_case(&format!("{}[strength_reduction]\nfactor = 1.6\n", slope(0.0)));
    // Broyden's method finds no equilibrium so far beyond failure.
    let linear = &[&["--set", ACCEPTING], &EXACT[..]].concat()[..];
    let whole = of(&scratch, 1, linear, 0)["stiffness-loss"].clone();
    assert!(
        whole.unusual && whole.meaning.contains("the ground failed at t = 0.7"),
        "{whole:?}"
    );
    let parts = ["case.toml", "-q", "-o", "parts.out", "--restart", "auto"];
    scratch
        .mpirun(2, &[&parts[..], &["--max-steps", "7"], linear].concat())
        .expect(75);
    scratch.mpirun(3, &[&parts[..], linear].concat()).expect(0);
    let found = manifest(&scratch.path("parts.out")).indicators["stiffness-loss"].clone();
    assert!(
        (found.value / whole.value - 1.0).abs() < 1e-6 && found.meaning == whole.meaning,
        "{found:?}, {whole:?}"
    );
}

/// A motion that is prescribed leaves no load that the ground could fail under.
#[test]
fn stiffness_is_not_judged_beside_a_prescribed_motion() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    assert!(!of(&scratch, 1, &["--max-steps", "2"], 75).contains_key("stiffness-loss"));
}
