//! Compares `bsmpm estimate` with runs.

use std::path::PathBuf;

use crate::support::{Scratch, processes, program, shipped};
use bsmpm_tools::estimate::{EstimateArguments, run};
use serde_json::Value;

/// Of what a run took, as a program reads it, from probes only.
fn beside(case: PathBuf, run: PathBuf) -> EstimateArguments {
    EstimateArguments {
        case,
        ranks: None,
        no_probe: false,
        no_whole: true,
        budget: 60.0,
        against: Some(run),
        json: true,
        set: Vec::new(),
        command: vec![program().to_owned()],
    }
}

#[test]
fn the_short_footing_is_estimated_beside_its_run() {
    let scratch = Scratch::new();
    let case = shipped("short/strip_footing.toml");
    scratch
        .direct(&[case.to_str().unwrap(), "-q", "-o", "run.out"])
        .expect(0);
    let mut arguments = beside(case, scratch.path("run.out"));
    let mut reported = Vec::new();
    let _turn = processes::turn();
    let found: Value = serde_json::from_str(&run(&arguments, |line| reported.push(line.to_owned())).unwrap()).unwrap();
    assert!(
        reported.iter().any(|line| line.starts_with("cells 2 times")),
        "{reported:?}"
    );
    let number = |path: &str| {
        let value = found.pointer(&format!("/{path}")).and_then(Value::as_f64);
        value.unwrap_or_else(|| panic!("{path}: {found}"))
    };
    // Counts, which no other program's load changes: measured 1.03 of them; the band that is reported is 1.5.
    assert!(
        (1.0 / 1.5..1.5).contains(&(number("work/evaluations") / number("actual/evaluations"))),
        "{found}"
    );
    assert_eq!(
        (number("points"), number("work/steps")),
        (number("actual/points"), number("actual/steps"))
    );
    assert!(
        (1.0 / 1.5..1.5).contains(&(number("memory_per_rank/0") / number("actual/memory"))),
        "{found}"
    );
    assert!(
        (1.0 / 1.2..1.2).contains(&(number("disk") / number("actual/disk"))),
        "{found}"
    );
    // Seconds are those of a machine that others use, too.
    assert!(number("ratio") > 0.0 && number("cpu_seconds/low") < number("cpu_seconds/high"));

    // A case that takes next to nothing is run whole: then there is no doubt of its work.
    arguments.no_whole = false;
    let found: Value = serde_json::from_str(&run(&arguments, |line| reported.push(line.to_owned())).unwrap()).unwrap();
    assert!(
        reported.last().is_some_and(|line| line.starts_with("the whole case: ")),
        "{reported:?}"
    );
    let evaluations = ["work", "actual"].map(|of| found[of]["evaluations"].as_f64());
    assert!(
        evaluations[0].is_some() && evaluations[0] == evaluations[1],
        "{evaluations:?}"
    );
}

/// Clay that consolidates, whose pore pressures are unknowns, too: measured 1.10 of the evaluations.
#[test]
fn the_embankment_on_clay_is_estimated_beside_its_run() {
    let scratch = Scratch::new();
    let case = shipped("embankment_consolidation.toml");
    scratch
        .direct(&[case.to_str().unwrap(), "-q", "-o", "run.out"])
        .expect(0);
    let arguments = beside(case, scratch.path("run.out"));
    let _turn = processes::turn();
    let found: Value = serde_json::from_str(&run(&arguments, |_| ()).unwrap()).unwrap();
    for [ours, of] in [
        ["work/evaluations", "actual/evaluations"],
        ["memory_per_rank/0", "actual/memory"],
    ] {
        let [ours, of] = [ours, of].map(|path| found.pointer(&format!("/{path}")).and_then(Value::as_f64).unwrap());
        assert!((1.0 / 1.5..1.5).contains(&(ours / of)), "{found}");
    }
    assert!(
        found["pressures"].as_f64().is_some_and(|pressures| pressures > 0.0),
        "{found}"
    );
}
