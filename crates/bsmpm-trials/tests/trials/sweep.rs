//! Tests `bsmpm sweep` and `bsmpm verify-case`.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{processes, program};
use bsmpm_tools::{sweep, verify_case};
use clap::Parser;
use serde_json::Value;

const COLUMN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/short/column_collapse.toml");
const SHORT: [&str; 6] = [
    "--set",
    "analysis.end=0.02",
    "--set",
    "check=[]",
    "--set",
    "output.times=[0.02]",
];

#[derive(Parser)]
struct Sweep {
    #[command(flatten)]
    arguments: sweep::SweepArguments,
}

#[derive(Parser)]
struct VerifyCase {
    #[command(flatten)]
    arguments: verify_case::VerifyArguments,
}

/// A folder with a solver that is this program, but for cubic splines, with which it panics in the second step.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let bench = Self(tempfile::tempdir().unwrap());
        let script = format!(
            "#!/bin/sh\ncase \"$*\" in *cubic*) export BSMPM_FAULT=panic:rank=0,step=2;; esac\nexec '{}' \"$@\"\n",
            program()
        );
        fs::write(bench.path("solver"), script).unwrap();
        fs::set_permissions(bench.path("solver"), fs::Permissions::from_mode(0o755)).unwrap();
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The text of a sweep, the lines that it reported, and its `sweep.json`.
    fn sweep(&self, options: &[&str]) -> (String, Vec<String>, Value) {
        let output = self.path("sweep");
        let solver = self.path("solver");
        let words = [
            &["sweep", COLUMN, "--output", output.to_str().unwrap()][..],
            &SHORT,
            options,
            &["--", solver.to_str().unwrap()],
        ];
        let mut lines = Vec::new();
        let _turn = processes::turn();
        let line = Sweep::parse_from(words.concat());
        let (text, files) = sweep::run(&line.arguments, |line| lines.push(line.to_owned())).unwrap();
        assert!(files.iter().all(|file| file.is_file()), "{files:?}");
        (
            text,
            lines,
            serde_json::from_str(&fs::read_to_string(output.join("sweep.json")).unwrap()).unwrap(),
        )
    }
}

fn runs(found: &Value) -> Vec<&Value> {
    found["runs"].as_array().unwrap().iter().collect()
}

fn states(found: &Value) -> Vec<String> {
    runs(found)
        .iter()
        .map(|run| run["state"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn runs_that_fail_end_nothing_and_what_is_there_is_kept() {
    let bench = Bench::new();
    // 20 mm do not fit between the walls; cubic splines break.
    let options = [
        "--vary",
        "grid.cell=20 mm,10 mm,5 mm",
        "--vary",
        "grid.degree=cubic,quadratic",
        "--quantity",
        "runout@0.0151",
        "--quantity",
        "height,surface-200@0.02",
        "--within",
        "10%",
        "--jobs",
        "2",
    ];
    let (text, lines, found) = bench.sweep(&options);
    assert_eq!(
        states(&found),
        ["invalid", "invalid", "broken", "done", "broken", "done"],
        "{text}"
    );
    assert_eq!(lines.len(), 4, "those that were begun: {lines:?}");
    let [invalid, _, broken, coarse, _, fine] = runs(&found)[..] else {
        panic!("{found}")
    };
    assert!(
        broken["code"] == 70 && invalid["reason"].as_str().unwrap().contains("grid"),
        "{found}"
    );
    assert!(fine["is_reference"] == true && coarse["is_baseline"] == true, "{found}");
    let error = |index: usize| coarse["errors"][index].as_f64().unwrap();
    // Cells of 10 mm are good for a few per cent of a length of 0.2 m, and no two grids agree to rounding.
    assert!(
        (1e-7..0.05).contains(&error(0)) && (1e-7..0.05).contains(&error(1)),
        "{coarse}"
    );
    assert!(coarse["cpu_seconds"].as_f64().unwrap() > 0.0 && coarse["peak_memory"].as_u64().unwrap() > 1 << 20);
    assert!(
        text.contains("cheapest within 10 % of all quantities: cell 10 mm, degree quadratic"),
        "{text}"
    );

    // Only the broken ones are tried again.
    let (_, _, again) = bench.sweep(&options);
    let kept: Vec<bool> = runs(&again).iter().map(|run| run["kept"].as_bool().unwrap()).collect();
    assert_eq!(kept, [false, false, false, true, false, true]);
    assert_eq!(runs(&again)[5]["values"], fine["values"]);
}

#[test]
fn a_run_that_was_stopped_goes_on_to_the_same_end() {
    let bench = Bench::new();
    let options = [
        "--vary",
        "solver.tolerance=1e-8,1e-6",
        "--quantity",
        "runout",
        "--jobs",
        "1",
    ];
    let (_, _, found) = bench.sweep(&options);
    assert_eq!(states(&found), ["done", "done"]);
    let [run, _] = runs(&found)[..] else { panic!("{found}") };
    let directory = Path::new(run["directory"].as_str().unwrap());
    let sets = run["set"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|set| ["--set", set.as_str().unwrap()]);
    let turn = processes::turn();
    let stopped = Command::new(program())
        .arg(COLUMN)
        .args(sets)
        .args(["--quiet", "--force", "--max-steps", "7", "--output"])
        .arg(directory)
        .env("OMP_NUM_THREADS", "1")
        .status()
        .unwrap();
    drop(turn);
    assert_eq!(stopped.code(), Some(75));
    let (_, _, again) = bench.sweep(&options);
    let [first, second] = runs(&again)[..] else {
        panic!("{again}")
    };
    assert!(first["kept"] == false && second["kept"] == true, "{again}");
    assert_eq!((&first["state"], &first["values"]), (&run["state"], &run["values"]));
    let manifest = fs::read_to_string(directory.join("run.json")).unwrap();
    let manifest: Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!(manifest["restarts"][0]["step"], 7);
}

#[test]
fn the_cheapest_setting_is_written_back_as_a_case_that_passes() {
    let bench = Bench::new();
    let best = bench.path("best.toml");
    let options = [
        "--vary",
        "body.*.points_per_cell=3,2",
        "--vary",
        "grid.cell=10 mm,12.5 mm",
        "--one-at-a-time",
        "--quantity",
        "runout",
        "--within",
        "50%",
        "--write",
        best.to_str().unwrap(),
    ];
    let (_, _, found) = bench.sweep(&options);
    // With the case as it is, which is one of the first axis's values, too: two more.
    assert_eq!(states(&found).len(), 3, "{found}");
    let text = fs::read_to_string(&best).unwrap();
    assert!(text.contains("# A column of aluminium rods, 0.2 m wide"), "{text}");
    let checked = Command::new(program()).arg(&best).arg("--check").output().unwrap();
    assert!(checked.status.success(), "{checked:?}");
}

#[test]
fn runs_that_would_not_fit_are_not_begun() {
    let bench = Bench::new();
    let output = bench.path("sweep");
    let words = [
        "sweep",
        COLUMN,
        "--vary",
        "grid.cell=10 mm",
        "--quantity",
        "runout",
        "--max-memory",
        "1MB",
        "--output",
        output.to_str().unwrap(),
        "--",
        program(),
    ];
    let error = sweep::run(&Sweep::parse_from(words).arguments, |line| panic!("{line}")).unwrap_err();
    assert_eq!(error.exit_code(), 80);
    let table = fs::read_to_string(output.join("sweep.csv")).unwrap();
    assert!(
        table
            .lines()
            .nth(1)
            .is_some_and(|row| row.starts_with("10 mm,memory,") && row.contains("it needs about"))
    );
    assert!(!output.join("runs").exists());
}

#[test]
fn three_grids_tell_an_order_or_why_there_is_none() {
    let bench = Bench::new();
    let output = bench.path("verify");
    let words = [
        &[
            "verify-case",
            COLUMN,
            "--output",
            output.to_str().unwrap(),
            "--cells",
            "12.5 mm,10 mm,5 mm",
            "--at",
            "0.01",
        ][..],
        &SHORT,
        &["--", program()],
    ];
    let line = VerifyCase::parse_from(words.concat());
    let _turn = processes::turn();
    let (text, _) = verify_case::run(&line.arguments, |_| ()).unwrap();
    let found: Value = serde_json::from_str(&fs::read_to_string(output.join("verify.json")).unwrap()).unwrap();
    let rows = found["rows"].as_array().unwrap();
    let row = |name: &str| {
        rows.iter()
            .find(|row| row["quantity"] == name && row["time"].is_null())
            .unwrap()
    };
    assert!(
        row("mass")["course"] == "unchanged" && row("mass")["verdict"] == "does not depend on the grid",
        "{text}"
    );
    assert!(
        row("runout")["values"]
            .as_array()
            .unwrap()
            .iter()
            .all(|value| value.as_f64().unwrap() > 0.19),
        "{text}"
    );
    assert_eq!(rows.iter().filter(|row| row["time"] == 0.01).count(), rows.len() / 2);
    assert_eq!(
        fs::read_to_string(output.join("verify.csv")).unwrap().lines().count(),
        rows.len() + 1
    );
}

/// A body of revolution: the outer wall of a thick cylinder under pressure, continued from three cells to none (Lamé).
#[test]
fn a_sweep_of_a_thick_cylinder_leads_to_its_closed_form() {
    let bench = Bench::new();
    let case = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../cases/validation/thick_cylinder.toml"
    );
    let output = bench.path("sweep");
    let solver = bench.path("solver");
    let linear = [
        "traction.0.stress=[1, 0]",
        "material.wall.young=1 MPa",
        "solver.background=1e-9",
    ];
    let set = linear.iter().flat_map(|set| ["--set", set]).collect::<Vec<_>>();
    let words = [
        &[
            "sweep",
            case,
            "--output",
            output.to_str().unwrap(),
            "--vary",
            "grid.cell=0.1,0.05,0.025",
        ][..],
        &["--quantity", "outer-x", "--reference", "extrapolated"],
        &set,
        &["--", solver.to_str().unwrap()],
    ];
    let _turn = processes::turn();
    sweep::run(&Sweep::parse_from(words.concat()).arguments, |_| ()).unwrap();
    let found: Value = serde_json::from_str(&fs::read_to_string(output.join("sweep.json")).unwrap()).unwrap();
    let limit = found["reference"]["values"][0][0].as_f64().unwrap();
    let radius = 0.5_f64;
    let wall = 1.0_f64;
    let poisson = 0.3;
    let young = 1e6;
    let exact = 2.0 * (1.0 - poisson * poisson) * radius.powi(2) * wall / (young * (wall.powi(2) - radius.powi(2)));
    assert!((limit / exact - 1.0).abs() <= 1e-5, "{limit:e} {exact:e}"); // 2e-6; 0.005 % with the smallest cells
}
