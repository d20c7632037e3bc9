//! Tests that a failure on any rank ends all ranks.

use crate::support::cases::{COLUMN, SLIDING_BLOCK, changed};
use crate::support::results::{all_finite, all_frames, history, manifest, steps};
use crate::support::{Output, Scratch};
use bsmpm_io::manifest::Status;
use std::process::Command;
use std::time::Duration;

/// s  Far more than a job that ends by itself takes here.
const HANGS: u64 = 30;

fn with_fault(scratch: &Scratch, ranks: Option<usize>, fault: &str) -> Output {
    scratch
        .job(ranks, &["case.toml", "--force"])
        .variable("BSMPM_FAULT", fault)
        .within(HANGS)
        .run()
}

#[test]
fn a_panic_on_any_rank_ends_the_job_with_70_and_one_message() {
    for (ranks, rank) in [(2, 0), (2, 1), (3, 0), (3, 2)] {
        let scratch = Scratch::with_case(SLIDING_BLOCK);
        let output = with_fault(&scratch, Some(ranks), &format!("panic:rank={rank},step=3")).expect(70);
        output.says_once(&format!("panic on rank {rank}"));
        assert_eq!(output.count("panic on rank"), 1, "{output:#?}");
    }
}

#[test]
fn a_panic_in_the_first_step_and_without_a_launcher_ends_with_70() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    with_fault(&scratch, Some(2), "panic:rank=1,step=1")
        .expect(70)
        .says_once("panic on rank 1");
    with_fault(&scratch, Some(1), "panic:rank=0,step=3")
        .expect(70)
        .says_once("panic on rank 0");
    with_fault(&scratch, None, "panic:rank=0,step=3")
        .expect(70)
        .says_once("panic on rank 0");
}

/// The manifest of a run that was killed says `running`, names what there is, and lets `--force` clear it away.
#[test]
fn what_a_panic_leaves_is_readable_and_can_be_replaced() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    // A thread ends frames: a checkpoint waits for all before it, those of the last moments are lost with the run.
    let arguments = [
        "case.toml",
        "--force",
        "--set",
        "output.checkpoint={ every_steps = 25 }",
    ];
    scratch
        .job(Some(2), &arguments)
        .variable("BSMPM_FAULT", "panic:rank=1,step=30")
        .within(HANGS)
        .run()
        .expect(70);
    let directory = scratch.path("case.out");
    assert_eq!(manifest(&directory).status, Status::Running);
    assert_eq!(*steps(&directory).get("step").unwrap().last().unwrap(), 29.0);
    assert!(all_frames(&directory).iter().any(|frame| frame.time == 0.02));
    all_finite(&directory);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(73);
    scratch.mpirun(2, &["case.toml", "-q", "--force"]).expect(0);
}

#[test]
fn a_fault_that_cannot_be_read_or_cannot_happen_is_refused() {
    let wrong = [
        "",
        "panic",
        "panic:rank=0",
        "panic:step=1",
        "panic:rank=x,step=1",
        "panic:rank=0,step=-1",
        "melt:rank=0,step=1",
    ];
    for fault in wrong {
        let scratch = Scratch::with_case(COLUMN);
        let output = with_fault(&scratch, Some(2), fault).expect(2);
        output.says_once("error E0709: BSMPM_FAULT");
        assert_eq!(scratch.entries(), ["case.toml"], "{fault}");
    }
    let scratch = Scratch::with_case(COLUMN);
    with_fault(&scratch, Some(2), "panic:rank=2,step=1")
        .expect(2)
        .says_once("error E0708: BSMPM_FAULT");
}

/// What a failed run must have left, whatever the reason.
fn failed(scratch: &Scratch, code: u8) -> bsmpm_io::manifest::Manifest {
    let directory = scratch.path("case.out");
    all_finite(&directory);
    let manifest = manifest(&directory);
    assert_eq!((manifest.status, manifest.exit_code), (Status::Failed, Some(code)));
    assert_eq!(
        manifest.checkpoint,
        Some(format!("checkpoint/step_{:09}.h5", manifest.summary.steps))
    );
    let failure = manifest.failure.as_ref().expect("a failure");
    let times = history(&directory).get("time").unwrap().to_vec();
    let frames = all_frames(&directory);
    let last = *times.last().unwrap();
    assert_eq!(
        frames.last().unwrap().time,
        last,
        "the last converged state is in the last frame"
    );
    assert_eq!((failure.time, failure.step), (last, times.len() as u64));
    manifest
}

#[test]
fn a_first_step_that_never_converges_ends_with_80_and_saves_the_start() {
    for ranks in [1, 2] {
        let scratch = Scratch::with_case(COLUMN);
        let hard = [
            "--set",
            "solver.nonlinear=broyden",
            "--set",
            "solver.max_iterations=1",
            "--set",
            "solver.tolerance=1e-15",
        ];
        let output = scratch.mpirun(ranks, &[&["case.toml"], &hard[..]].concat()).expect(80);
        assert_eq!(output.count("bsmpm-par:"), 1, "{output:#?}");
        let manifest = failed(&scratch, 80);
        assert_eq!(manifest.summary.steps, 0);
        let failure = manifest.failure.unwrap();
        assert!(failure.reason.starts_with("E0747: "), "{}", failure.reason);
    }
}

/// Gravity grows beyond what a cut in clay can bear; five iterations are enough for the elastic steps before only.
#[test]
fn a_later_step_that_never_converges_ends_with_80_and_saves_the_last_good_state() {
    let clay = changed(
        COLUMN,
        "model   = \"elastic\"",
        "model = \"tresca\"\ncohesion = \"6 kPa\"",
    );
    let cut = changed(&clay, "upper = [4.0, 4.0]", "upper = [2.0, 4.0]");
    let scratch = Scratch::with_case(&changed(&cut, "steps = 5", "steps = 10"));
    let few = ["--set", "solver.max_iterations=5", "--set", "solver.nonlinear=broyden"];
    for ranks in [1, 2] {
        scratch
            .mpirun(ranks, &[&["case.toml", "-q", "--force"], &few[..]].concat())
            .expect(80);
        let manifest = failed(&scratch, 80);
        assert!(
            manifest.summary.steps > 0 && manifest.summary.cutbacks > 0,
            "{:?}",
            manifest.summary
        );
        let time = manifest.failure.unwrap().time;
        assert!((0.1..0.5).contains(&time), "{time}");
    }
}

/// Its front points are 12.5 mm from its face, which is 50 mm from the grid's free end: they leave after 15.6 ms.
#[test]
fn a_point_that_leaves_the_grid_ends_the_run_with_81_and_is_named() {
    let open = changed(SLIDING_BLOCK, "right  = \"roller\"\n", "");
    let near = "lower = [0.75, 0.0], upper = [0.95, 0.2]";
    let case = changed(&open, "lower = [0.1, 0.0], upper = [0.5, 0.2]", near);
    for ranks in [1, 2, 3] {
        let scratch = Scratch::with_case(&case);
        let output = scratch.mpirun(ranks, &["case.toml"]).expect(81);
        let manifest = failed(&scratch, 81);
        let failure = manifest.failure.unwrap();
        let worst = failure.worst.as_ref().expect("the point that left");
        assert_eq!(worst.kind, "point");
        assert!(worst.position.len() == 2 && worst.position[0] > 1.0, "{worst:?}");
        output.says_once(&format!("point {}", worst.id));
        assert!(failure.time > 0.01 && failure.time < 0.02, "{failure:?}");
    }
}

/// The tests above are worth what their harness notices.
#[test]
#[should_panic(expected = "hangs")]
fn a_run_that_does_not_end_is_noticed() {
    let mut launcher = Command::new("mpirun");
    launcher.args(["-q", "--oversubscribe", "-n", "2", "sleep", "100"]);
    crate::support::processes::run(launcher, &[], true, Duration::from_secs(1));
}

#[test]
#[should_panic(expected = "outlive their run")]
fn a_process_that_is_left_behind_is_noticed() {
    let mut shell = Command::new("sh");
    shell.args(["-c", "setsid sleep 100 & exit 0"]);
    crate::support::processes::run(shell, &[], true, Duration::from_secs(10));
}
