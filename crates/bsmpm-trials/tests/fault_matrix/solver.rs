//! Tests of steps without a solution: the program shortens the step, and accepts no wrong solution.

use crate::ground::{Ground, RUN};
use crate::support::Scratch;
use crate::support::cases::COLUMN;
use crate::support::results::{all_finite, manifest};
use crate::table::{Tried, trials};
use serde_json::Value;

/// Halvings of a step before the run gives up.
const CUTS: usize = 10;

/// Runs a case that cannot be solved: 80, no step, nothing that is not finite; its `failure.json`.
fn fails(case: &str, further: &[&str]) -> Value {
    let scratch = Scratch::with_case(case);
    let arguments = [&["case.toml", "-q", "-o", RUN], further].concat();
    scratch.mpirun(2, &arguments).expect(80);
    let run = scratch.path(RUN);
    all_finite(&run);
    let checkpoint = manifest(&run)
        .checkpoint
        .expect("a checkpoint of the last converged state");
    bsmpm_io::checkpoint::named(&run.join(checkpoint)).unwrap();
    serde_json::from_slice(&std::fs::read(run.join("failure.json")).unwrap()).unwrap()
}

/// Every attempt's reason.
fn attempts(failure: &Value) -> Vec<&str> {
    failure["attempts"]
        .as_array()
        .unwrap()
        .iter()
        .map(|reason| reason.as_str().unwrap())
        .collect()
}

/// Krylov methods that may not iterate long enough, and a factorisation that is none.
const DIVERGING: [(&[&str], &str); 4] = [
    (
        &["-ksp_type", "cg", "-pc_type", "jacobi", "-ksp_max_it", "1"],
        "DIVERGED_ITS (-3)",
    ),
    (
        &["-ksp_type", "gmres", "-pc_type", "bjacobi", "-ksp_max_it", "1"],
        "DIVERGED_ITS (-3)",
    ),
    (
        &["-ksp_type", "richardson", "-pc_type", "none", "-ksp_divtol", "10"],
        "DIVERGED_DTOL (-4)",
    ),
    (
        &["-ksp_type", "preonly", "-pc_type", "jacobi"],
        "the relative residual of the solution is",
    ),
];

/// Linear solves that diverge, through the whole program.
pub fn diverging(_: &Ground, _: usize) -> Tried {
    let tried = trials(DIVERGING.len(), |index| {
        let (options, reason) = DIVERGING[index];
        let failure = fails(COLUMN, &[&["--"], options].concat());
        let attempts = attempts(&failure);
        assert_eq!(attempts.len(), CUTS + 1);
        assert!(
            attempts.iter().all(|warning| warning.contains(reason)),
            "{reason}: {attempts:?}"
        );
        0.0
    });
    tried
        .figure(|_| "80 after 10 cuts, its class in failure.json".into())
        .remark("NaN, zero rows, indefinite, each with 3 solvers: petsc-rs/tests/solve.rs")
}

/// Two layers of the ground are pushed through each other: what lies between them is turned inside out.
const CROSSING: &str = "
[[prescribed]]
from = [0.0, 2.0]
to = [4.0, 2.0]
displacement = [0.0, -1.5]
components = \"all\"

[[prescribed]]
from = [0.0, 1.0]
to = [4.0, 1.0]
displacement = [0.0, 1.5]
components = \"all\"
";

/// One nominal step by a method that shortens no step of its own accord, in small cells.
const COARSE: [&str; 8] = [
    "--set",
    "analysis.steps=1",
    "--set",
    "solver.nonlinear=broyden",
    "--set",
    "grid.cell=0.25",
    "--set",
    "grid.upper=[4.0,8.0]",
];

/// What is reported of an attempt that turned material inside out.
const INVERTED: &str = "E0746: ";

/// Material that is turned inside out: shorter steps help, or nothing does.
pub fn folded(_: &Ground, _: usize) -> Tried {
    let mut reported = Vec::new();
    let tried = trials(2, |index| {
        let inverted = if index == 0 {
            let failure = fails(&format!("{COLUMN}{CROSSING}"), &COARSE);
            assert!(
                failure["worst"].as_array().is_some_and(|worst| !worst.is_empty()),
                "{failure}"
            );
            attempts(&failure)
                .iter()
                .filter(|reason| reason.contains(INVERTED))
                .count()
        } else {
            // Two hundred times its weight.
            let scratch = Scratch::with_case(COLUMN);
            let heavy = [
                "case.toml",
                "-vv",
                "-o",
                RUN,
                "--set",
                "gravity.acceleration=[0.0,-2000.0]",
            ];
            let output = scratch.mpirun(2, &[&heavy, &COARSE[..6]].concat()).expect(0);
            all_finite(&scratch.path(RUN));
            output.count(INVERTED)
        };
        reported.push(inverted.to_string());
        assert!(inverted > 0, "no attempt turned material inside out");
        0.0
    });
    tried
        .figure(|_| format!("cuts, then 80, or the end; inverted {}", reported.join(" and ")))
        .remark("det F <= 0 in a checkpoint: F26")
}
