//! Tests of runs that stop regularly and continue.

use crate::ground::{Ground, Results, results, same};
use crate::support::results::{differences, history, last_frame, manifest, steps};
use crate::support::{Scratch, shipped};
use crate::table::{Tried, trials};
use std::path::PathBuf;

/// A chain of restarts.
pub fn chain(ground: &Ground, _: usize) -> Tried {
    let whole = ground.whole(2);
    let mut stops = 0;
    let tried = trials(1, |_| {
        let trial = ground.trial(2);
        for stop in (6..whole.steps).step_by(6) {
            trial.start(&["--max-steps", &stop.to_string()], &[]).end().expect(75);
            stops += 1;
        }
        assert_eq!(trial.becomes(&whole), 0);
        let numbers = history(&trial.directory()).get("step").unwrap().to_vec();
        let once: Vec<f64> = (0..=whole.steps).map(|step| step as f64).collect();
        assert_eq!(numbers, once, "each step once");
        assert_eq!(manifest(&trial.directory()).restarts.len(), stops);
        stops as f64
    });
    tried.figure(|stops| format!("{stops} restarts, each step once"))
}

/// What a run of any case left.
pub fn left(scratch: &Scratch, name: &str) -> Results {
    results(&scratch.path(name))
}

/// Every case of a folder, or some, stopped half way and after its second step. At most `most` steps of each are made.
fn recovered(cases: &[PathBuf], most: u64) -> Tried {
    let mut reported = Vec::new();
    let tried = trials(cases.len() * 2, |index| {
        let case = cases[index / 2].to_str().unwrap();
        let scratch = Scratch::new();
        let run = |name: &str, stop: u64| {
            let stop = stop.to_string();
            let arguments = [case, "-q", "-o", name, "--restart", "auto", "--max-steps", &stop];
            let output = scratch.job(Some(2), &arguments).within(600).run();
            assert!(
                [Some(0), Some(75), Some(77)].contains(&output.code),
                "{case}: {output:?}"
            );
        };
        // Without a key for checkpoints, a run that reaches its end leaves none: the last step is not its.
        run("probe", most + 1);
        let steps = manifest(&scratch.path("probe")).summary.steps.min(most + 1) - 1;
        run("whole", steps);
        let stop = if index % 2 == 0 {
            steps.div_ceil(2)
        } else {
            2.min(steps - 1)
        };
        run("part", stop);
        run("part", steps);
        assert_eq!(manifest(&scratch.path("part")).restarts.len(), 1, "{case}");
        same(&left(&scratch, "part"), &left(&scratch, "whole"));
        if index % 2 == 0 {
            reported.push(format!(
                "{} {steps}",
                cases[index / 2].file_stem().unwrap().to_string_lossy()
            ));
        }
        steps as f64
    });
    tried
        .figure(|_| format!("{} cases", cases.len()))
        .remark(&format!("steps: {}", reported.join(", ")))
}

pub fn cases(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(shipped(folder))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let is_case =
        |path: &PathBuf| path.extension().is_some_and(|ending| ending == "toml") && !path.ends_with("matrix.toml");
    let mut cases: Vec<PathBuf> = entries.filter(is_case).collect();
    cases.sort();
    cases
}

/// The short cases.
pub fn recover_short(_: &Ground, steps: usize) -> Tried {
    recovered(&cases("short"), steps as u64)
}

/// The paper's cases, which are large: a few steps of each.
pub fn recover_paper(_: &Ground, steps: usize) -> Tried {
    recovered(&cases("."), steps as u64)
}

/// The cases of the validation.
pub fn recover_validation(_: &Ground, steps: usize) -> Tried {
    recovered(&cases("validation"), steps as u64)
}

/// Checkpoints after every step, every seventh, and none but the last.
pub fn intervals(ground: &Ground, _: usize) -> Tried {
    let whole = ground.whole(2);
    let ways = ["{every_steps=1}", "{every_steps=7}", "{wall=\"100 h\"}"];
    let tried = trials(ways.len(), |index| {
        let trial = ground.trial(2);
        trial
            .start(&["--set", &format!("output.checkpoint={}", ways[index])], &[])
            .end()
            .expect(0);
        same(&results(&trial.directory()), &whole.results);
        0.0
    });
    tried.figure(|_| "every step, every 7th, at the end only".into())
}

/// Half of the run on some ranks, the rest on others.
pub fn other_ranks(ground: &Ground, _: usize) -> Tried {
    let whole = ground.whole(2);
    let mut reported = Vec::new();
    let ways = [(2, 1), (2, 3), (2, 4), (4, 2)];
    let tried = trials(ways.len(), |index| {
        let (before, after) = ways[index];
        let mut trial = ground.stopped(before, whole.steps / 2);
        trial.ranks = after;
        trial.finish();
        trial.has_warned(&format!(
            "written on {before} rank(s), and the run continues on {after}"
        ));
        let found = differences(&last_frame(&trial.directory()), &last_frame(&whole.scratch.path("run")));
        let (name, largest) = found.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        reported.push(format!("{before} -> {after}: {largest:.0e} ({name})"));
        let counts = [&trial.directory(), &whole.scratch.path("run")].map(|run| manifest(run).summary.steps);
        assert_eq!(counts[0], counts[1], "steps");
        // Round-off of single precision in the factor, which steps that are accepted at 1e-8 keep.
        assert!(largest <= 1e-6, "{name} differs by {largest:e}");
        largest
    });
    tried
        .figure(|largest| format!("last frame, relative: {largest}"))
        .remark(&reported.join(", "))
}

/// The same run again while ranks are stopped and let go at random.
pub fn repeated(ground: &Ground, count: usize) -> Tried {
    let ranks = [1, 2, 4];
    let tried = trials(count * ranks.len(), |index| {
        let ranks = ranks[index % ranks.len()];
        let whole = ground.whole(ranks);
        let trial = ground.trial(ranks);
        let running = trial.under_way(1, 0.0, &[]);
        for delay in 0..4 {
            let rank = (index + delay) % ranks;
            running.signal_rank("STOP", rank);
            std::thread::sleep(std::time::Duration::from_millis(20 + 17 * ((index + delay) as u64 % 5)));
            running.signal_rank("CONT", rank);
        }
        running.end().expect(0);
        same(&results(&trial.directory()), &whole.results);
        ranks as f64
    });
    tried.figure(|_| "on 1, 2 and 4 ranks, with ranks that pause".into())
}

/// Keys with which a checkpoint is of another case, with what must be reported of them.
const BOUND: [(&str, &str); 9] = [
    (
        "material.clay.poisson=0.31",
        "material.clay.poisson was 0.3, and is 0.31",
    ),
    (
        "material.clay.cohesion=\"6 kPa\"",
        "material.clay.cohesion was 5000.0, and is 6000.0",
    ),
    ("grid.cell=\"0.2 m\"", "grid.cell was [0.1], and is [0.2]"),
    (
        "grid.degree=\"cubic\"",
        "grid.degree was \"quadratic\", and is \"cubic\"",
    ),
    ("body.0.points_per_cell=3", "body.0.points_per_cell was 2, and is 3"),
    (
        "body.1.velocity=[21.0,0.0]",
        "body.1.velocity was [22.0, 0.0], and is [21.0, 0.0]",
    ),
    (
        "stabilisation.method=\"modified-f-bar\"",
        "stabilisation.method was \"consistent-f-bar\", and is \"modified-f-bar\"",
    ),
    ("analysis.end=\"0.31 s\"", "analysis.end was"),
    (
        "gravity.acceleration=[0.0,-9.81]",
        "gravity.acceleration was not given, and is [0.0, -9.81]",
    ),
];

/// Another case, by name and by `auto`; a material of another name.
pub fn other_case(ground: &Ground, _: usize) -> Tried {
    let trial = ground.stopped(1, 10);
    let file = trial.checkpoint("step_000000010.h5");
    let before = std::fs::read(trial.directory().join("run.json")).unwrap();
    trial.scratch.write("named.toml", ground.text().replace("clay", "loam"));
    let tried = trials(2 * (BOUND.len() + 1), |index| {
        let from = if index % 2 == 0 { "auto" } else { file.to_str().unwrap() };
        let run = |case: &str, further: &[&str]| {
            trial
                .scratch
                .direct(&[&[case, "-o", "run", "--restart", from], further].concat())
                .expect(76)
        };
        match BOUND.get(index / 2) {
            Some((set, reported)) => run("case.toml", &["--set", set]).says_once(reported),
            None => run("named.toml", &[]).says_once("material.loam.cohesion was not given, and is 5000.0"),
        }
        assert!(
            std::fs::read(trial.directory().join("run.json")).unwrap() == before,
            "the run is touched"
        );
        0.0
    });
    tried.figure(|_| "76, with the key and both values".into())
}

/// Keys that may change, which `run.json` reports.
pub fn free_keys(ground: &Ground, _: usize) -> Tried {
    let free = [
        ("title=\"another\"", "title"),
        ("output.every_steps=3", "output.every_steps"),
        ("solver.tolerance=1e-9", "solver.tolerance"),
        ("solver.max_iterations=40", "solver.max_iterations"),
        ("solver.nonlinear=\"newton\"", "solver.nonlinear"),
        ("analysis.dt=\"2 ms\"", "analysis.dt"),
    ];
    let stopped = ground.stopped(1, 10);
    let tried = trials(free.len(), |index| {
        let trial = stopped.copy();
        let (set, key) = free[index];
        trial.start(&["--set", set, "--max-steps", "12"], &[]).end().expect(75);
        let changed = &manifest(&trial.directory()).restarts[0].changed;
        assert!(changed.len() == 1 && changed[0].starts_with(key), "{changed:?}");
        0.0
    });
    tried.figure(|_| "goes on, run.json reports the change".into())
}

/// Steps that cannot converge end the run with 80; it goes on with shorter ones, or as if that had not been.
pub fn no_convergence(ground: &Ground, _: usize) -> Tried {
    let whole = ground.whole(2);
    let measures = [
        "--set",
        "solver.tolerance=1e-30",
        "--set",
        "solver.force_tolerance=1e-30",
    ];
    let hard = [&measures[..], &["--set", "solver.max_iterations=1"]].concat();
    let stopped = ground.stopped(2, 10);
    stopped.start(&hard, &[]).end().expect(80);
    let tried = trials(2, |index| {
        let trial = stopped.copy();
        assert!(trial.directory().join("failure.json").exists(), "failure.json");
        if index == 0 {
            trial
                .start(&["--set", "analysis.dt=\"2.5 ms\"", "--max-steps", "20"], &[])
                .end()
                .expect(75);
            let dt = steps(&trial.directory()).get("dt").unwrap().to_vec();
            assert!(dt[12..].iter().all(|&dt| dt < 2.6e-3), "{dt:?}");
        } else {
            trial.becomes(&whole);
        }
        0.0
    });
    tried.figure(|_| "goes on with shorter steps; as it was: B".into())
}
