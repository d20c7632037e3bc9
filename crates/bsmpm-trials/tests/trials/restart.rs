//! Tests restarts. Continued runs are bitwise identical on the same ranks.

mod other_cases;

use crate::support::cases::{COLUMN, SLIDING_BLOCK, changed, frictional_block, pressed_block};
use crate::support::results::{all_frames, differences, history, last_frame, manifest, steps};
use crate::support::{Scratch, entries};
use bsmpm_io::manifest::Status;
use std::path::Path;

/// Restart files after every fifth step, all of them kept.
const OFTEN: &str = "output.checkpoint={every_steps=5,keep=100}";

/// All rows of a run's tables but the seconds and messages that they tell (who goes on numbers the unknowns again), and
/// the bytes of its last frame.
fn results(directory: &Path) -> (String, String, Vec<u8>) {
    let text = |name: &str| std::fs::read_to_string(directory.join(name)).unwrap();
    let steps = text("steps.csv");
    let names: Vec<&str> = steps.lines().next().unwrap().split(',').collect();
    let untimed = |line: &str| {
        let cells = names
            .iter()
            .zip(line.split(','))
            .filter(|(name, _)| !["wall", "messages", "bytes"].contains(name));
        cells.map(|(_, cell)| cell).collect::<Vec<_>>().join(",")
    };
    let frame = format!("frames/step_{:09}.vtu", last_frame(directory).step);
    let frame = std::fs::read(directory.join(frame)).unwrap();
    (
        text("history.csv"),
        steps.lines().map(untimed).collect::<Vec<_>>().join("\n"),
        frame,
    )
}

#[test]
fn a_run_that_was_stopped_goes_on_to_the_bit() {
    for ranks in [1, 2, 3, 4] {
        let scratch = Scratch::with_case(SLIDING_BLOCK);
        scratch.mpirun(ranks, &["case.toml", "-q", "-o", "whole"]).expect(0);
        for stop in ["0", "7", "20"] {
            let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
            scratch
                .mpirun(ranks, &[&part[..], &["--max-steps", stop]].concat())
                .expect(75);
            scratch.mpirun(ranks, &part).expect(0);
            assert!(
                results(&scratch.path("whole")) == results(&scratch.path("part")),
                "{ranks} ranks, step {stop}"
            );
            let whole = manifest(&scratch.path("whole"));
            let part = manifest(&scratch.path("part"));
            assert_eq!(part.restarts.len(), 1);
            assert_eq!(whole.summary.iterations, part.summary.iterations);
            assert_eq!(whole.linear, part.linear);
            assert_eq!(part.status, Status::Finished);
            std::fs::remove_dir_all(scratch.path("part")).unwrap();
        }
    }
}

/// What sticks, slips and lifts follows from the points and the last displacement: there is nothing else to keep. Of a
/// pressure its direction and how that changes are kept.
#[test]
fn a_block_with_friction_goes_on_to_the_bit_and_so_does_one_that_is_pressed() {
    [frictional_block(), pressed_block()]
        .iter()
        .for_each(|case| goes_on_to_the_bit(case));
}

fn goes_on_to_the_bit(case: &str) {
    let scratch = Scratch::with_case(case);
    let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
    scratch.mpirun(2, &["case.toml", "-q", "-o", "whole"]).expect(0);
    for stop in ["9", "17", "31"] {
        scratch
            .mpirun(2, &[&part[..], &["--max-steps", stop]].concat())
            .expect(75);
    }
    scratch.mpirun(2, &part).expect(0);
    assert!(results(&scratch.path("whole")) == results(&scratch.path("part")));
}

#[test]
fn of_a_chain_of_restarts_every_step_is_there_once() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let number = manifest(&scratch.path("whole")).summary.steps;
    for stop in (3..number).step_by(3) {
        let stop = stop.to_string();
        scratch
            .mpirun(
                2,
                &[
                    "case.toml",
                    "-q",
                    "-o",
                    "part",
                    "--restart",
                    "auto",
                    "--max-steps",
                    &stop,
                ],
            )
            .expect(75);
    }
    scratch
        .mpirun(2, &["case.toml", "-q", "-o", "part", "--restart", "auto"])
        .expect(0);
    assert!(results(&scratch.path("whole")) == results(&scratch.path("part")));
    let listed: Vec<u64> = all_frames(&scratch.path("part"))
        .iter()
        .map(|frame| frame.step)
        .collect();
    assert!(listed.is_sorted_by(|a, b| a < b), "{listed:?}");
    let every = steps(&scratch.path("part")).get("step").unwrap().to_vec();
    assert_eq!(every, (1..=number).map(|step| step as f64).collect::<Vec<_>>());
}

#[test]
fn on_other_ranks_it_goes_on_within_tolerances_and_says_so() {
    goes_on_on_other_ranks(SLIDING_BLOCK, &[(2, 1), (1, 3), (4, 2)]);
}

/// Its windows hold further layers of the displacement from which a step starts.
#[test]
fn with_coupling_beyond_a_cell_it_goes_on_on_other_ranks_too() {
    let coupled = format!("{SLIDING_BLOCK}\n[stabilisation]\nmethod = \"consistent-f-bar\"\n");
    goes_on_on_other_ranks(&coupled, &[(2, 3), (4, 2)]);
}

/// What a law declares as its state stays with the points: over a restart to the bit, on other ranks, and in frames.
#[test]
fn the_state_of_a_law_goes_along() {
    let clay = "model = \"von-mises\"\nyield_stress = 2e3\nhardening = 5e4";
    let case = changed(SLIDING_BLOCK, "model   = \"elastic\"", clay);
    let scratch = Scratch::with_case(&case);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
    scratch
        .mpirun(2, &[&part[..], &["--max-steps", "20"]].concat())
        .expect(75);
    scratch.mpirun(2, &part).expect(0);
    assert!(results(&scratch.path("whole")) == results(&scratch.path("part")));
    let frame = last_frame(&scratch.path("whole"));
    let [state, flow] = ["hardening_strain", "plastic_strain"].map(|name| frame.real(name, 1).unwrap().to_vec());
    assert!(flow.iter().copied().fold(0.0, f64::max) > 1e-3, "it yields");
    assert!(
        state.iter().zip(&flow).all(|(a, b)| (a - b).abs() <= 1e-12),
        "von Mises hardens with its plastic strain"
    );
    goes_on_on_other_ranks(&case, &[(2, 3)]);
}

#[track_caller]
fn goes_on_on_other_ranks(case: &str, ranks: &[(usize, usize)]) {
    let scratch = Scratch::with_case(case);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let whole = last_frame(&scratch.path("whole"));
    for &(first, then) in ranks {
        let part = ["case.toml", "-o", "part"];
        scratch
            .mpirun(first, &[&part[..], &["-q", "--max-steps", "12"]].concat())
            .expect(75);
        let output = scratch
            .mpirun(then, &[&part[..], &["--restart", "auto"]].concat())
            .expect(0);
        output.says_once(&format!(
            "W0734: the checkpoint was written on {first} rank(s), and the run continues on {then}"
        ));
        for (name, difference) in differences(&last_frame(&scratch.path("part")), &whole) {
            assert!(difference < 1e-9, "{first} -> {then}: {name} differs by {difference:e}");
        }
        std::fs::remove_dir_all(scratch.path("part")).unwrap();
    }
}

#[test]
fn a_checkpoint_that_is_named_is_gone_back_to_and_what_came_later_is_forgotten() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    let run = ["case.toml", "-q", "--set", OFTEN];
    scratch.mpirun(2, &[&run[..], &["-o", "whole"]].concat()).expect(0);
    scratch.mpirun(2, &[&run[..], &["-o", "part"]].concat()).expect(0);
    let back = ["--restart", "part/checkpoint/step_000000010.h5"];
    scratch
        .mpirun(2, &[&run[..], &["-o", "part", "--max-steps", "10"], &back].concat())
        .expect(75);
    let checkpoints = ["step_000000005", "step_000000010"].map(|name| [format!("{name}.h5"), format!("{name}.json")]);
    assert_eq!(entries(&scratch.path("part/checkpoint")), checkpoints.as_flattened());
    assert_eq!(
        *history(&scratch.path("part")).get("step").unwrap().last().unwrap(),
        10.0
    );
    assert!(all_frames(&scratch.path("part")).iter().all(|frame| frame.step <= 10));
    scratch
        .mpirun(2, &[&run[..], &["-o", "part", "--restart", "auto"]].concat())
        .expect(0);
    assert!(results(&scratch.path("whole")) == results(&scratch.path("part")));
    // In another directory it is a run of its own, with the rows of the older one.
    scratch
        .mpirun(2, &[&run[..], &["-o", "other"], &back].concat())
        .expect(0);
    assert!(results(&scratch.path("whole")) == results(&scratch.path("other")));
}

#[test]
fn restart_auto_starts_what_was_not_begun_and_leaves_alone_what_is_complete() {
    let scratch = Scratch::with_case(COLUMN);
    let run = ["case.toml", "-q", "--restart", "auto"];
    scratch.mpirun(2, &run).expect(0);
    let before = std::fs::read(scratch.path("case.out/run.json")).unwrap();
    scratch
        .mpirun(2, &run)
        .expect(0)
        .says_once("`case.out` is already complete");
    scratch
        .mpirun(1, &run)
        .expect(0)
        .says_once("`case.out` is already complete");
    assert_eq!(std::fs::read(scratch.path("case.out/run.json")).unwrap(), before);
}

/// Fitted volumes are those of the points as they are, and no state; another quadrature is another problem.
#[test]
fn with_fitted_volumes_it_goes_on_to_the_bit_and_not_without() {
    let scratch = Scratch::with_case(&changed(COLUMN, "\"1 MPa\"", "\"100 kPa\""));
    let fitted = ["case.toml", "-q", "--set", "solver.quadrature=fitted"];
    for ranks in [1, 2] {
        scratch
            .mpirun(ranks, &[&fitted[..], &["-o", "whole", "--force"]].concat())
            .expect(0);
        scratch
            .mpirun(
                ranks,
                &[&fitted[..], &["-o", "part", "--force", "--max-steps", "3"]].concat(),
            )
            .expect(75);
        let go_on = ["-o", "part", "--restart", "auto"];
        let output = scratch.mpirun(ranks, &[&["case.toml"], &go_on[..]].concat()).expect(76);
        output.says_once("solver.quadrature was");
        scratch.mpirun(ranks, &[&fitted[..], &go_on].concat()).expect(0);
        assert!(
            results(&scratch.path("whole")) == results(&scratch.path("part")),
            "{ranks} ranks"
        );
        scratch
            .mpirun(ranks, &["case.toml", "-q", "-o", "points", "--force"])
            .expect(0);
        let [whole, points] = ["whole", "points"].map(|name| history(&scratch.path(name)));
        let height = |table: &bsmpm_io::table::Columns| *table.get("height").unwrap().last().unwrap();
        assert_ne!(height(&whole), height(&points), "it is seen");
    }
}

#[test]
fn restarts_that_come_to_nothing_end_with_72() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    let run = ["case.toml", "-q", "--restart", "auto", "--max-steps", "5"];
    for _ in 0..4 {
        scratch.mpirun(2, &run).expect(75);
    }
    scratch.mpirun(2, &run).expect(72).says_once("3 restarts in a row");
    scratch
        .mpirun(
            2,
            &["case.toml", "-q", "--restart", "case.out/checkpoint/step_000000005.h5"],
        )
        .expect(0);
}

#[test]
fn a_table_that_was_changed_since_is_not_gone_on_with() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch.mpirun(2, &["case.toml", "-q", "--max-steps", "5"]).expect(75);
    let path = scratch.path("case.out/history.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replacen(',', ";", 1)).unwrap();
    let manifest = std::fs::read(scratch.path("case.out/run.json")).unwrap();
    let output = scratch.mpirun(2, &["case.toml", "-q", "--restart", "auto"]).expect(74);
    output.says_once("bytes are not those that the run had written");
    assert_eq!(
        std::fs::read(scratch.path("case.out/run.json")).unwrap(),
        manifest,
        "nothing was touched"
    );
    std::fs::remove_file(&path).unwrap();
    let output = scratch.mpirun(2, &["case.toml", "--restart", "auto"]).expect(0);
    output
        .says_once("W0738: the file `history.csv` of the earlier steps is missing, so the new file begins with step 6");
    assert_eq!(history(&scratch.path("case.out")).get("step").unwrap()[0], 6.0);
}

#[test]
fn the_clock_can_ask_for_checkpoints_and_they_change_nothing() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "never"]).expect(0);
    assert!(
        !scratch.path("never/checkpoint").exists(),
        "nothing is written where nothing is asked for"
    );
    for (name, wanted) in [
        ("clock", "{wall=\"1 us\",keep=3}"),
        ("steps", "{every_steps=1}"),
        ("seventh", "{every_steps=7}"),
    ] {
        let set = format!("output.checkpoint={wanted}");
        scratch
            .mpirun(2, &["case.toml", "-q", "-o", name, "--set", &set])
            .expect(0);
        assert!(
            results(&scratch.path(name)) == results(&scratch.path("never")),
            "{name}"
        );
        let kept = entries(&scratch.path(name).join("checkpoint")).len();
        assert_eq!(kept, if name == "clock" { 6 } else { 4 });
    }
}

#[test]
fn a_run_that_has_ended_is_never_begun_again_by_itself() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let before = std::fs::read(scratch.path("case.out/history.csv")).unwrap();
    let further = ["case.toml", "-q", "--set", "analysis.end=0.06", "--restart", "auto"];
    scratch.mpirun(2, &further).expect(76).says_once("error E0726: ");
    let shorter = ["case.toml", "-q", "--set", "analysis.end=0.04", "--restart", "auto"];
    scratch.mpirun(2, &shorter).expect(0).says_once("is already complete");
    assert_eq!(std::fs::read(scratch.path("case.out/history.csv")).unwrap(), before);
    // Nor is one whose checks failed, which is complete with its own code.
    let check = [
        "--set",
        "check.0.quantity=runout",
        "--set",
        "check.0.max=0.1",
        "-o",
        "checked",
    ];
    scratch
        .mpirun(2, &[&["case.toml", "-q"][..], &check].concat())
        .expect(77);
    scratch
        .mpirun(2, &[&["case.toml", "-q", "--restart", "auto"][..], &check].concat())
        .expect(77)
        .says_once("already complete");
}

#[test]
fn a_run_that_is_killed_before_its_first_checkpoint_starts_again_but_not_for_ever() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    let run = |fault: &str| {
        scratch
            .job(Some(2), &["case.toml", "--restart", "auto"])
            .variable("BSMPM_FAULT", fault)
            .run()
    };
    run("panic:rank=1,step=5").expect(70);
    for _ in 0..3 {
        run("panic:rank=1,step=5").expect(70).says_once("warning W0730: ");
    }
    run("panic:rank=1,step=500").expect(72).says_once("3 restarts in a row");
    let output = scratch.mpirun(2, &["case.toml", "--force"]).expect(0);
    assert_eq!(output.count("W0730"), 0);
}

#[test]
fn a_branch_in_another_directory_has_a_checkpoint_of_its_own_at_once() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch
        .mpirun(2, &["case.toml", "-q", "-o", "a", "--max-steps", "5"])
        .expect(75);
    let branch = ["case.toml", "-q", "-o", "b", "--restart"];
    let from = ["a/checkpoint/step_000000005.h5", "--max-steps", "5"];
    scratch.mpirun(2, &[&branch[..], &from].concat()).expect(75);
    assert_eq!(
        entries(&scratch.path("b/checkpoint")),
        ["step_000000005.h5", "step_000000005.json"]
    );
    scratch.mpirun(2, &[&branch[..], &["auto"]].concat()).expect(0);
    assert_eq!(
        history(&scratch.path("b")).get("step").unwrap()[0],
        0.0,
        "the rows of before are there"
    );
    let beyond = [
        "-o",
        "c",
        "--set",
        "analysis.end=0.001",
        "--restart",
        "a/checkpoint/step_000000005.h5",
    ];
    scratch
        .mpirun(2, &[&["case.toml", "-q"][..], &beyond].concat())
        .expect(76)
        .says_once("error E0723: ");
}

#[test]
fn a_failure_that_was_mended_is_no_longer_reported() {
    let scratch = Scratch::with_case(COLUMN);
    let run = ["case.toml", "-q", "--set", OFTEN];
    scratch
        .mpirun(2, &[&run[..], &["--max-steps", "2"]].concat())
        .expect(75);
    let stuck = [
        "solver.nonlinear=broyden",
        "solver.max_iterations=1",
        "solver.tolerance=1e-15",
    ];
    let stuck = [
        &run[..],
        stuck.map(|set| ["--set", set]).as_flattened(),
        &["--restart", "auto"],
    ]
    .concat();
    scratch.mpirun(2, &stuck).expect(80);
    assert!(scratch.path("case.out/failure.json").exists());
    scratch
        .mpirun(2, &[&run[..], &["--restart", "auto"]].concat())
        .expect(0);
    assert!(!scratch.path("case.out/failure.json").exists());
    let manifest = manifest(&scratch.path("case.out"));
    assert!(manifest.failure.is_none() && manifest.outputs.iter().all(|output| output.path != "failure.json"));
}
