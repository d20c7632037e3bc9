//! Tests the lock of the output directory.

use crate::support::cases::endless;
use crate::support::results::{history, manifest};
use crate::support::{Output, Running, Scratch};
use bsmpm_io::manifest::Status;
use serde_json::Value;
use std::time::Duration;

/// s  Far more than anything here takes.
const HANGS: u64 = 120;

/// A run that has begun to write, in a new directory.
fn under_way(scratch: &Scratch, ranks: Option<usize>) -> Running {
    let _ = std::fs::remove_dir_all(scratch.path("case.out"));
    let mut running = scratch.job(ranks, &["case.toml", "--force"]).within(HANGS).start();
    running.until("its first step", || scratch.path("case.out/steps.csv").exists());
    running
}

fn lock(scratch: &Scratch) -> Value {
    serde_json::from_slice(&std::fs::read(scratch.path("case.out/.lock")).unwrap()).unwrap()
}

/// Kills a run at once, so that its lock stays.
fn killed(scratch: &Scratch, ranks: Option<usize>) {
    let running = under_way(scratch, ranks);
    running.kill();
    running.end();
    assert!(scratch.path("case.out/.lock").exists());
}

const ONE_STEP: [&str; 4] = ["case.toml", "--force", "--max-steps", "1"];

#[test]
fn a_second_run_is_refused_with_73_and_the_first_one_goes_on_as_it_was() {
    let scratch = Scratch::with_case(&endless());
    for ranks in [None, Some(2)] {
        let running = under_way(&scratch, ranks);
        let holder = lock(&scratch);
        for arguments in [
            &["case.toml"][..],
            &["case.toml", "--force"],
            &["case.toml", "--force", "--break-lock"],
        ] {
            let output = scratch
                .job(ranks, arguments)
                .variable("PBS_JOBID", "41")
                .start_beside()
                .end()
                .expect(73);
            output.says_once(&format!(
                "process {} on host {}",
                holder["pid"],
                holder["host"].as_str().unwrap()
            ));
            assert!(output.stderr.contains("case.out"), "{output:#?}");
        }
        assert_eq!(lock(&scratch), holder);
        running.signal("USR1");
        running.end().expect(75);
        assert!(!scratch.path("case.out/.lock").exists());
        let first = history(&scratch.path("case.out"));
        let last = first.get("step").unwrap().last().unwrap().to_string();
        scratch
            .job(
                ranks,
                &["case.toml", "-q", "--force", "-o", "alone", "--max-steps", &last],
            )
            .run()
            .expect(75);
        assert_eq!(first.values, history(&scratch.path("alone")).values, "to the bit");
    }
}

/// Twenty at once: one of them runs until it is asked to stop, and the others are refused.
fn one_of_twenty(scratch: &Scratch) -> Output {
    let job = || scratch.job(None, &["case.toml", "--force"]).within(HANGS);
    let mut running = vec![job().start()];
    running.extend((1..20).map(|_| job().start_beside()));
    while running.len() > 1 {
        std::thread::sleep(Duration::from_millis(20));
        for at in (0..running.len()).rev() {
            if !running[at].goes_on() {
                running.swap_remove(at).end().expect(73).says_once("is in use by");
            }
        }
    }
    let mut winner = running.pop().expect("one of them");
    winner.until("its first step", || scratch.path("case.out/steps.csv").exists());
    assert_eq!(manifest(&scratch.path("case.out")).status, Status::Running);
    winner.signal("USR1");
    winner.end().expect(75)
}

#[test]
fn of_twenty_that_start_at_once_one_runs() {
    let scratch = Scratch::with_case(&endless());
    one_of_twenty(&scratch);
    assert!(!scratch.path("case.out/.lock").exists());
}

#[test]
fn of_twenty_that_find_a_dead_runs_lock_one_takes_it_over() {
    let scratch = Scratch::with_case(&endless());
    killed(&scratch, None);
    one_of_twenty(&scratch).says_once("the process is gone");
    let left = crate::support::entries(&scratch.path("case.out"));
    assert!(!left.iter().any(|name| name.contains("lock")), "{left:?}");
}

#[test]
fn a_dead_runs_lock_on_this_host_is_taken_over_and_that_is_reported() {
    let scratch = Scratch::with_case(&endless());
    for ranks in [None, Some(2)] {
        killed(&scratch, ranks);
        let holder = lock(&scratch);
        scratch
            .job(ranks, &["case.toml"])
            .run()
            .expect(73)
            .says_once("error E0769: ");
        killed(&scratch, ranks);
        assert_ne!(lock(&scratch), holder);
        scratch
            .job(ranks, &ONE_STEP)
            .run()
            .expect(75)
            .says_once("W0737: the output directory was locked by process");
        let warnings = manifest(&scratch.path("case.out")).warnings;
        assert!(
            warnings.iter().any(|warning| warning.contains("the process is gone")),
            "{warnings:?}"
        );
        assert!(!scratch.path("case.out/.lock").exists());
    }
}

#[test]
fn a_lock_of_another_process_that_got_the_number_is_taken_over() {
    let scratch = Scratch::with_case(&endless());
    killed(&scratch, None);
    let mut holder = lock(&scratch);
    holder["pid"] = std::process::id().into();
    scratch.write("case.out/.lock", holder.to_string());
    scratch
        .job(None, &ONE_STEP)
        .run()
        .expect(75)
        .says_once("another has its number");
}

#[test]
fn a_lock_of_another_host_holds_until_it_is_broken_unless_its_job_has_been_started_again() {
    let scratch = Scratch::with_case(&endless());
    killed(&scratch, None);
    let mut holder = lock(&scratch);
    (holder["host"], holder["job"]) = ("elsewhere".into(), "PBS_JOBID=41".into());
    let lend = || scratch.write("case.out/.lock", holder.to_string());
    lend();
    let before = std::fs::read(scratch.path("case.out/run.json")).unwrap();
    for job in ["", "42"] {
        let output = scratch.job(None, &ONE_STEP).variable("PBS_JOBID", job).run().expect(73);
        ["--break-lock", "on host elsewhere", "PBS_JOBID=41"]
            .into_iter()
            .for_each(|text| output.says_once(text));
        assert_eq!(std::fs::read(scratch.path("case.out/run.json")).unwrap(), before);
    }
    scratch
        .job(None, &ONE_STEP)
        .variable("PBS_JOBID", "41")
        .run()
        .expect(75)
        .says_once("has been started again");
    lend();
    scratch
        .job(None, &[&ONE_STEP[..], &["--break-lock"]].concat())
        .run()
        .expect(75)
        .says_once("by --break-lock");
    // A file that names nobody, and a takeover that was never finished.
    for files in [&[".lock"][..], &[".lock", ".lock.takeover"]] {
        files
            .iter()
            .for_each(|file| scratch.write(&format!("case.out/{file}"), "?"));
        scratch.job(None, &ONE_STEP).run().expect(73).says_once("--break-lock");
        scratch
            .job(None, &[&ONE_STEP[..], &["--break-lock"]].concat())
            .run()
            .expect(75);
        assert!(files.iter().all(|file| !scratch.path("case.out").join(file).exists()));
    }
}

/// A panic and an error of rank 0 leave no lock behind, so that a run on another host need not break it.
#[test]
fn a_run_that_fails_lets_the_directory_go() {
    let scratch = Scratch::with_case(&endless());
    let job = scratch
        .job(Some(2), &["case.toml", "--force"])
        .variable("BSMPM_FAULT", "panic:rank=0,step=3");
    job.run().expect(70);
    assert!(!scratch.path("case.out/.lock").exists());
    scratch.write("case.out/steps.csv", "");
    scratch.job(None, &["case.toml"]).run().expect(73);
    assert!(!scratch.path("case.out/.lock").exists());
}
