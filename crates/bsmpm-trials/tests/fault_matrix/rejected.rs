//! Tests that results do not change if a converged step is rejected and repeated.

use crate::ground::{Ground, results, same};
use crate::restart::{cases, left};
use crate::support::Scratch;
use crate::support::results::{manifest, steps};
use crate::table::{Tried, trials};
use std::path::{Path, PathBuf};

fn fault(step: u64) -> String {
    format!("reject:step={step}")
}

#[track_caller]
fn was_rejected(run: &Path, step: u64) {
    let reported = format!("W0725: step {step} is repeated");
    let warnings = manifest(run).warnings;
    assert_eq!(
        warnings.iter().filter(|warning| warning.contains(&reported)).count(),
        1,
        "{warnings:?}"
    );
}

/// The first step, the one that is cut, and others all over the run, on one and on two ranks.
pub fn footing(ground: &Ground, count: usize) -> Tried {
    let cut = {
        let table = steps(&ground.whole(2).scratch.path("run"));
        1 + table
            .get("cutbacks")
            .unwrap()
            .iter()
            .position(|&cuts| cuts > 0.0)
            .expect("a step that is cut") as u64
    };
    let tried = trials(count, |index| {
        let ranks = 1 + index % 2;
        let whole = ground.whole(ranks);
        let step = match index / 2 {
            0 => cut,
            1 => 1,
            other => 2 + (other as u64 * 7) % (whole.steps - 1),
        };
        let trial = ground.trial(ranks);
        trial.start(&[], &[("BSMPM_FAULT", &fault(step))]).end().expect(0);
        was_rejected(&trial.directory(), step);
        same(&results(&trial.directory()), &whole.results);
        0.0
    });
    tried.figure(|_| format!("B; step {cut}, which is cut, among them"))
}

/// Every case of some, the step half way of `most` rejected.
fn suite(cases: &[PathBuf], most: u64) -> Tried {
    let tried = trials(cases.len(), |index| {
        let case = cases[index].to_str().unwrap();
        let scratch = Scratch::new();
        let run = |name: &str, fault: &str| {
            let most = most.to_string();
            let job = scratch
                .job(Some(2), &[case, "-q", "-o", name, "--max-steps", &most])
                .within(600);
            let job = if fault.is_empty() {
                job
            } else {
                job.variable("BSMPM_FAULT", fault)
            };
            let output = job.run();
            assert!(
                [Some(0), Some(75), Some(77)].contains(&output.code),
                "{case}: {output:?}"
            );
        };
        run("whole", "");
        let step = manifest(&scratch.path("whole")).summary.steps.div_ceil(2);
        run("again", &fault(step));
        was_rejected(&scratch.path("again"), step);
        same(&left(&scratch, "again"), &left(&scratch, "whole"));
        0.0
    });
    tried.figure(|_| format!("{} cases", cases.len()))
}

/// The short cases.
pub fn short(_: &Ground, steps: usize) -> Tried {
    suite(&cases("short"), steps as u64)
}

/// The cases of the validation.
pub fn validation(_: &Ground, steps: usize) -> Tried {
    suite(&cases("validation"), steps as u64)
}
