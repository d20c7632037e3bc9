//! Tests that the number of ranks does not change results.

use crate::support::cases::{EXACT, SLIDING_BLOCK, changed, frictional_block, pressed_block};
use crate::support::results::{all_frames, differences, history, ids, last_frame, manifest, steps};
use crate::support::{Scratch, example, processes, shipped};
use std::collections::BTreeSet;
use std::process::Command;
use std::time::Duration;

/// Asserts that the last frames of runs on these numbers of ranks agree with the first one's to `tolerance`, relative
/// to the largest number of each field.
#[track_caller]
fn agree(scratch: &Scratch, case: &str, further: &[&str], ranks: &[usize], tolerance: f64) {
    let frames: Vec<_> = ranks
        .iter()
        .map(|&count| {
            let directory = format!("{count}.out");
            let arguments = [&[case, "-q", "-o", &directory], further].concat();
            scratch.mpirun(count, &arguments).expect(0);
            assert_eq!(manifest(&scratch.path(&directory)).ranks as usize, count);
            last_frame(&scratch.path(&directory))
        })
        .collect();
    for (frame, count) in frames.iter().zip(ranks) {
        for (field, difference) in differences(frame, &frames[0]) {
            assert!(
                difference <= tolerance,
                "{field} on {count} ranks differs by {difference:.1e}"
            );
        }
    }
}

#[test]
fn an_elastic_block_that_slides_from_slab_to_slab_is_the_same_on_1_2_3_and_4_ranks() {
    agree(
        &Scratch::with_case(SLIDING_BLOCK),
        "case.toml",
        &[],
        &[1, 2, 3, 4],
        1e-9,
    );
    agree(&Scratch::with_case(&pressed_block()), "case.toml", &[], &[1, 3], 1e-8);
}

/// Nodes on a face stick, slip and lift as the whole of them says, also where two ranks share them.
#[test]
fn a_block_with_friction_is_the_same_on_1_2_3_and_4_ranks() {
    let scratch = Scratch::with_case(&frictional_block());
    agree(&scratch, "case.toml", &[], &[1, 2, 3, 4], 1e-8);
    let histories = [1, 4].map(|count| history(&scratch.path(&format!("{count}.out"))));
    for column in [
        "contact-closed",
        "contact-sliding",
        "gap-largest",
        "slip-rate",
        "friction-power",
        "reaction-x",
    ] {
        let [one, four] = histories.each_ref().map(|history| history.get(column).unwrap());
        let largest = one.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        assert!(
            largest > 0.0 && one.iter().zip(four).all(|(a, b)| (a - b).abs() <= 1e-6 * largest),
            "{column}"
        );
    }
    let [closed, pushed, friction_work] =
        ["contact-closed", "reaction-y", "reaction-x"].map(|column| histories[0].get(column).unwrap());
    assert!(closed[1..].contains(&0.0) && closed.contains(&1.0));
    assert!(
        pushed
            .iter()
            .zip(friction_work)
            .all(|(push, rub)| *push >= 0.0 && rub.abs() <= 0.4 * push * (1.0 + 1e-9))
    );
}

/// The modified F-bar smooths the strain of the points, the consistent one exchanges functions of the degree below.
#[test]
fn the_block_is_the_same_on_1_2_3_and_4_ranks_with_every_f_bar() {
    for method in ["modified-f-bar", "consistent-f-bar"] {
        let scratch = Scratch::with_case(&format!("{SLIDING_BLOCK}\n[stabilisation]\nmethod = \"{method}\"\n"));
        agree(
            &scratch,
            "case.toml",
            &["--set", "analysis.end=0.02"],
            &[1, 2, 3, 4],
            1e-9,
        );
    }
}

/// Points are computed eight at a time with whatever vectors the machine has: the last digit does not tell which.
#[test]
fn the_bits_are_the_same_with_the_vectors_of_any_machine() {
    for case in ["short/column_collapse.toml", "short/strip_footing.toml"] {
        let scratch = Scratch::new();
        let case = shipped(case).to_str().unwrap().to_owned();
        let mut histories = ["sse2", "avx2", "avx512"].iter().filter_map(|vectors| {
            let arguments = [&case, "-q", "--max-steps", "12", "-o", vectors];
            let run = scratch.job(None, &arguments).variable("BSMPM_LANES", vectors).run();
            if run.code == Some(2) && run.stderr.contains("this machine has no such vectors") {
                println!("not compared here: {vectors}");
                return None;
            }
            run.expect(75);
            Some(std::fs::read_to_string(scratch.path(vectors).join("history.csv")).unwrap())
        });
        let first = histories.next().expect("one of them");
        assert!(
            first.lines().count() > 10 && histories.all(|history| history == first),
            "{case}"
        );
    }
}

/// A consistent mass is solved with in every step and multiplied with in every evaluation, across the cuts.
#[test]
fn the_block_is_the_same_on_1_2_3_and_4_ranks_with_a_consistent_mass() {
    let further = ["--set", "analysis.mass=consistent", "--set", "analysis.end=0.02"];
    agree(
        &Scratch::with_case(SLIDING_BLOCK),
        "case.toml",
        &further,
        &[1, 2, 3, 4],
        1e-9,
    );
}

/// Plastic flow, whose largest values neighbours tell each other, and gaps, which go along with the points.
#[test]
fn the_filter_of_consistent_f_bar_and_gaps_are_the_same_on_1_2_and_3_ranks() {
    let text = std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap();
    let (case, _check) = text.split_once("[[check]]").unwrap();
    let times = "times = [\"0.109 s\", \"0.235 s\", \"0.300 s\", \"0.351 s\", \"0.420 s\", \"0.607 s\"]";
    let case = changed(case, times, "");
    let gaping = changed(&case, "cohesion    = 0.0", "cohesion    = 0.0\nseparation  = \"gap\"");
    for case in [case, gaping] {
        let scratch = Scratch::with_case(&case);
        agree(&scratch, "case.toml", &["--set", "analysis.end=0.04"], &[1, 2, 3], 1e-9);
    }
}

/// MPI counts in 32 bits: what is longer goes in blocks, here of some bytes.
#[test]
fn messages_longer_than_a_block_arrive_whole_on_1_2_3_and_4_ranks() {
    for (ranks, block) in [(1, "16"), (2, "1"), (3, "7"), (4, "4096")] {
        let mut launcher = Command::new("mpirun");
        launcher
            .args(["-q", "--oversubscribe", "-n", &ranks.to_string()])
            .arg(example("exchange"))
            .arg(block);
        processes::run(launcher, &[], true, Duration::from_secs(120)).expect(0);
    }
}

/// No point is lost or changed on its way, however the sum is made.
#[test]
fn the_total_mass_is_the_same_in_every_step_to_the_bit() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    for ranks in [1, 2, 3, 4] {
        scratch.mpirun(ranks, &["case.toml", "-q", "--force"]).expect(0);
        let history = history(&scratch.path("case.out"));
        let mass = history.get("mass").unwrap();
        let masses: BTreeSet<u64> = mass.iter().map(|value| value.to_bits()).collect();
        let masses: Vec<f64> = masses.into_iter().map(f64::from_bits).collect();
        assert!(
            masses.len() == 1 && (masses[0] - 80.0).abs() < 1e-10,
            "on {ranks} ranks: {masses:?}"
        );
    }
}

/// On 4 ranks the block's 8 columns of cells begin as 4 slabs of 2; each point then moves by more than 3 columns. So
/// that no rank keeps its points unless all slabs move along, which the next test excludes.
#[test]
fn the_sliding_block_does_cross_the_bounds_of_slabs() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch.mpirun(1, &["case.toml", "-q"]).expect(0);
    let frames = all_frames(&scratch.path("case.out"));
    let first = &frames[0];
    let last = &frames[frames.len() - 1];
    let moved = first
        .position
        .iter()
        .zip(&last.position)
        .map(|(from, to)| to[0] - from[0]);
    let least = moved.fold(f64::INFINITY, f64::min);
    assert!(least > 3.0 * 0.05, "{least}");
}

/// Two blocks move towards each other: whatever way the slabs follow, points of one of them change their ranks.
#[test]
fn blocks_that_move_in_opposite_directions_are_the_same_on_1_2_3_and_4_ranks() {
    let second = "[[body]]\nmaterial = \"rubber\"\nbox = { lower = [0.55, 0.0], upper = [0.9, 0.2] }\n\
                  points_per_cell = 2\nvelocity = [-4.0, 0.0]\n\n[gravity]";
    let apart = changed(SLIDING_BLOCK, "upper = [0.5, 0.2]", "upper = [0.35, 0.2]");
    let scratch = Scratch::with_case(&changed(&apart, "[gravity]", second));
    agree(
        &scratch,
        "case.toml",
        &["--set", "analysis.end=0.035"],
        &[1, 2, 3, 4],
        1e-9,
    );
}

#[test]
fn the_shipped_elastic_column_is_the_same_on_1_2_3_and_4_ranks() {
    let case = shipped("short/self_weight_column.toml");
    agree(&Scratch::new(), case.to_str().unwrap(), &[], &[1, 2, 3, 4], 1e-9);
}

#[test]
fn a_run_repeats_to_the_bit_on_as_many_ranks() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    for ranks in [1, 2, 4] {
        let runs = [1, 2, 3].map(|_| {
            scratch
                .mpirun(ranks, &["case.toml", "-q", "--force", "--set", "analysis.end=0.02"])
                .expect(0);
            let read = |name: &str| std::fs::read(scratch.path("case.out").join(name)).unwrap();
            (read("history.csv"), read("frames/step_000000020.vtu"))
        });
        assert!(runs[0] == runs[1] && runs[0] == runs[2], "on {ranks} ranks");
    }
}

/// What the arguments leave, on so many ranks: tables and last frame as bytes.
fn left(scratch: &Scratch, ranks: usize, arguments: &[&str], step: usize) -> (Vec<u8>, Vec<u8>) {
    scratch.mpirun(ranks, arguments).expect(75);
    let read = |name: &str| std::fs::read(scratch.path("case.out").join(name)).unwrap();
    (read("history.csv"), read(&format!("frames/step_{step:09}.vtu")))
}

/// Nodal sums, reductions and the stiffness do not depend on the cut; with one factorisation of the whole, nothing
/// does.
#[test]
fn where_all_ranks_factorise_the_whole_the_collapse_has_the_same_bits_on_1_2_3_and_4_ranks() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    let arguments = [&["case.toml", "-q", "--force", "--max-steps", "120"], &EXACT[..]].concat();
    let runs = [1, 2, 3, 4].map(|ranks| left(&scratch, ranks, &arguments, 120));
    assert_eq!(
        manifest(&scratch.path("case.out")).summary.products,
        0,
        "Newton's method has PETSc's sums"
    );
    assert!(runs[1..].iter().all(|run| *run == runs[0]));
}

/// Strips, cubic splines, fitted volumes, of cells whose neighbours another rank has, and averages on pairs of cells,
/// which slabs cut.
#[test]
fn where_all_ranks_factorise_the_whole_the_footing_has_the_same_bits_on_1_2_3_and_4_ranks() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    for further in [
        "grid.degree=cubic",
        "solver.quadrature=fitted",
        "stabilisation.method=subgrid-f-bar",
    ] {
        let set = ["--set", "solver.nonlinear=broyden", "--set", further];
        let arguments = [&["case.toml", "-q", "--force", "--max-steps", "3"], &set[..], &EXACT].concat();
        let runs = [1, 2, 3, 4].map(|ranks| left(&scratch, ranks, &arguments, 3));
        assert!(runs[1..].iter().all(|run| *run == runs[0]), "{further}");
    }
}

/// A square that is nearly incompressible, loaded unevenly, is solved by a factor of double precision, others by one of
/// single.
#[test]
fn a_factor_of_single_precision_that_is_too_coarse_is_made_again_on_1_2_and_3_ranks() {
    let reports = |nu: &str, ranks: usize| {
        let mut launcher = Command::new("mpirun");
        launcher
            .args(["-q", "--oversubscribe", "-n", &ranks.to_string()])
            .arg(example("solvers"));
        launcher.args(["direct", nu, "20"]);
        processes::run(launcher, &[], true, Duration::from_secs(120))
            .expect(0)
            .stdout
    };
    for ranks in [1, 2, 3] {
        let stiff = reports("0.499999", ranks);
        let usual = reports("0.3", ranks);
        assert!(
            stiff.contains("1 factorisations more") && usual.contains("0 factorisations more"),
            "{stiff} {usual}"
        );
    }
}

/// More ranks than columns: slabs are cut along y. Any stiffness leads to the same state, but only the same one in as
/// many iterations, to the same rest. Here dilations couple 2 q layers of nodes, which slabs of one column are much
/// thinner than. Of the default factor, single precision is left.
#[test]
fn the_stiffness_is_the_same_on_1_3_10_and_12_ranks_of_one_column_at_most() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    let shared = [
        "--set",
        "solver.reproducible=false",
        "--",
        "-pc_factor_mat_solver_type",
        "mumps",
    ];
    let [quadratic, cubic] = ["grid.degree=quadratic", "grid.degree=cubic"];
    let cases = [
        (quadratic, &[][..], 5e-2),
        (cubic, &[], 5e-2),
        (quadratic, &shared, 1e-5),
        (cubic, &shared, 1e-5),
    ];
    for (order, solver, most) in cases {
        let further = [&["--set", order], solver].concat();
        let arguments = [&["case.toml", "-q", "--force", "--max-steps", "3"], &further[..]].concat();
        let found = [1, 3, 10, 12].map(|ranks| {
            scratch.mpirun(ranks, &arguments).expect(75);
            let steps = steps(&scratch.path("case.out"));
            ["iterations", "residual"].map(|name| steps.get(name).unwrap().to_vec())
        });
        for [iterations, residual] in &found[1..] {
            assert_eq!(*iterations, found[0][0], "{further:?}");
            let close = |(a, b): (&f64, &f64)| (a - b).abs() <= most * b; // round-off, through a dozen iterations
            assert!(
                residual.iter().zip(&found[0][1]).all(close),
                "{further:?}: {residual:?} for {:?}",
                found[0][1]
            );
        }
    }
}

/// Points come to the first rank in blocks of 16,384 ids, of which ranks have any part.
#[test]
fn frames_of_several_blocks_have_the_same_bytes_on_1_2_and_3_ranks() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    let arguments = [
        "case.toml",
        "-q",
        "--force",
        "--max-steps",
        "1",
        "--set",
        "body.0.points_per_cell=13",
    ];
    let frames = [1, 2, 3].map(|ranks| {
        scratch.mpirun(ranks, &arguments).expect(75);
        std::fs::read(scratch.path("case.out/frames/step_000000000.vtu")).unwrap()
    });
    assert!(frames[1..].iter().all(|frame| *frame == frames[0]));
    let ids: Vec<u64> = ids(&all_frames(&scratch.path("case.out"))[0]);
    assert_eq!(ids, (0..33_800).collect::<Vec<_>>());
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap());
    let run = |threads: &str| {
        // More points on a rank than threads take at a time.
        let points = "body.0.points_per_cell=6";
        let arguments = [
            "case.toml",
            "-q",
            "--force",
            "--max-steps",
            "20",
            "--threads",
            threads,
            "--set",
            points,
        ];
        let left = left(&scratch, 2, &arguments, 20);
        assert_eq!(manifest(&scratch.path("case.out")).threads.to_string(), threads);
        left
    };
    let one = run("1");
    assert!(one == run("2") && one == run("3"));
}

#[test]
fn petscs_factorisations_whole_on_every_rank_and_shared_give_the_same() {
    let case = shipped("short/self_weight_column.toml");
    let shared = [
        "--set",
        "solver.reproducible=false",
        "--",
        "-pc_factor_mat_solver_type",
        "mumps",
    ];
    for options in [&EXACT[..], &shared] {
        agree(&Scratch::new(), case.to_str().unwrap(), options, &[1, 2, 4, 8], 1e-9);
    }
}

/// Nodes keep the components that are held, as multigrid wants whole ones; slabs of one column, ranks without points.
#[test]
fn multigrid_gives_the_same_on_1_2_4_and_8_ranks() {
    let case = shipped("short/self_weight_column.toml");
    let set = ["--set", "solver.linear=multigrid"];
    agree(&Scratch::new(), case.to_str().unwrap(), &set, &[1, 2, 4, 8], 1e-7);
    let scratch = Scratch::with_case(&changed(SLIDING_BLOCK, "upper = [0.5, 0.2]", "upper = [0.2, 0.2]"));
    agree(
        &scratch,
        "case.toml",
        &[&set[..], &["--set", "analysis.end=0.01"]].concat(),
        &[1, 4],
        1e-7,
    );
}

/// The column is 4 cells wide: on 4 ranks slabs of one column have ghosts from beyond the next slab, on 8 and 9 slabs
/// are cut along its height.
#[test]
fn slabs_thinner_than_the_splines_reach_work_for_every_order() {
    let case = shipped("short/self_weight_column.toml");
    for order in ["linear", "quadratic", "cubic"] {
        let order = format!("grid.degree={order}");
        agree(
            &Scratch::new(),
            case.to_str().unwrap(),
            &["--set", &order],
            &[1, 3, 4, 8, 9],
            1e-9,
        );
    }
}

/// Consistent F-bar couples nodes beyond a cell, over the faces between slabs: of slabs that are thinner than the
/// splines reach, and in the quasi-static matrix.
#[test]
fn coupling_beyond_a_cell_is_the_same_on_1_2_4_and_8_ranks() {
    let case = shipped("short/self_weight_column.toml");
    for order in ["linear", "quadratic", "cubic"] {
        let order = format!("grid.degree={order}");
        let further = ["--set", "stabilisation.method=consistent-f-bar", "--set", &order];
        agree(&Scratch::new(), case.to_str().unwrap(), &further, &[1, 2, 4, 8], 1e-9);
    }
}

#[test]
fn ranks_without_points_take_part() {
    let scratch = Scratch::with_case(&changed(SLIDING_BLOCK, "upper = [0.5, 0.2]", "upper = [0.2, 0.2]"));
    agree(&scratch, "case.toml", &[], &[1, 4], 1e-9);
}

#[test]
fn more_ranks_than_slabs_and_parts_allow_are_refused_with_the_most_that_are_possible() {
    let scratch = Scratch::new();
    let case = shipped("short/self_weight_column.toml");
    let output = scratch.mpirun(11, &[case.to_str().unwrap()]).expect(65);
    let lines: Vec<&str> = output.stderr.lines().filter(|line| line.contains("ranks")).collect();
    assert!(
        lines.len() == 1 && lines[0].contains("11") && lines[0].contains('4'),
        "{output:#?}"
    );
    assert_eq!(scratch.entries(), [""; 0]);
}

/// Plastic flow amplifies round-off, so that only the result that matters is compared. Slabs that stayed as they are at
/// first would be uneven to 1.37 on four ranks over the whole run.
#[test]
fn the_collapse_runs_out_as_far_on_1_2_3_and_4_ranks_whose_slabs_follow_it() {
    let text = std::fs::read_to_string(shipped("short/column_collapse.toml")).unwrap();
    let (case, _check) = text.split_once("[[check]]").unwrap();
    let times = "times = [\"0.109 s\", \"0.235 s\", \"0.300 s\", \"0.351 s\", \"0.420 s\", \"0.607 s\"]";
    let case = changed(&changed(case, times, ""), "end  = \"0.607 s\"", "end  = \"0.3 s\"");
    let scratch = Scratch::with_case(&case);
    let runouts = [1, 2, 3, 4].map(|ranks| {
        let directory = format!("{ranks}.out");
        // Four ranks on two cores take their time when others want those too.
        scratch
            .job(Some(ranks), &["case.toml", "-q", "-o", &directory])
            .within(240)
            .run()
            .expect(0);
        if let Some(balance) = manifest(&scratch.path(&directory)).balance {
            assert!(
                balance.mean <= 1.1 && (balance.cuts > 0 || ranks < 4),
                "{balance:?} on {ranks} ranks"
            );
        }
        let history = history(&scratch.path(&directory));
        *history.get("runout").unwrap().last().unwrap()
    });
    assert!(runouts[0] > 0.36, "{runouts:?}");
    // Measured 3e-14 m at 0.3 s and 5e-12 m at 0.607 s.
    assert!(
        runouts.iter().all(|runout| (runout - runouts[0]).abs() < 1e-9),
        "{runouts:?}"
    );
}
