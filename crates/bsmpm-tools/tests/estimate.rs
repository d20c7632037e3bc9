//! Tests `bsmpm estimate` with a stub in place of the solver.

use std::env;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use bsmpm_io::directory::{ExistingRunPolicy, OutputDirectory};
use bsmpm_io::lock::Unseen;
use bsmpm_io::manifest::{Manifest, ManifestCase, Status};
use bsmpm_io::steps::{STEPS, StepRow};
use bsmpm_io::table::CsvTable;
use bsmpm_scene::model::schedule;
use serde_json::Value;

/// The variable that makes this program the solver; it names the folder where calls are noted.
const STUB: &str = "BSMPM_TEST_ESTIMATE";
const COLUMN: &str = include_str!("../../../cases/short/column_collapse.toml");
/// Cells of the column along x, and its points.
const CELLS: f64 = 55.0;
const POINTS: f64 = 800.0;
const STEPS_OF_COLUMN: u64 = 1214;
/// s  of the start, and of an evaluation.
const START: f64 = 0.25;
const EVALUATION: f64 = 2e-3;

/// No test of its own: the solver, when the variable says so.
#[test]
fn stub() {
    let Some(folder) = env::var_os(STUB).map(PathBuf::from) else {
        return;
    };
    let arguments: Vec<String> = env::args().skip_while(|word| word != "--").skip(1).collect();
    let after = |name: &str| {
        arguments
            .windows(2)
            .find(|pair| pair[0] == name)
            .map(|pair| pair[1].clone())
    };
    let bytes = fs::read(&arguments[0]).unwrap();
    let case = bsmpm_scene::Case::from_bytes(&arguments[0], &bytes, &[]).unwrap();
    let code: u8 = fs::read_to_string(folder.join("code")).unwrap().parse().unwrap();
    if code != 0 {
        eprintln!("it broke");
        std::process::exit(i32::from(code));
    }
    let most = after("--max-steps").map_or(u64::MAX, |most| most.parse().unwrap());
    fs::write(folder.join("last"), after("--output").unwrap()).unwrap();
    let stopped = write_run(&case, Path::new(&after("--output").unwrap()), most);
    std::process::exit(if stopped { 75 } else { 0 });
}

/// Evaluations of a step: 4 and 16/55 for each cell along x, in every step the same.
fn evaluations(case: &bsmpm_scene::Case) -> u64 {
    4 + (16.0 * case.grid.axes[0].cells() as f64 / CELLS).round() as u64
}

/// A run of so many steps at most; whether it stopped before the end. A step costs four evaluations besides its own.
fn write_run(case: &bsmpm_scene::Case, directory: &Path, most: u64) -> bool {
    let reported = ManifestCase::new("column.toml", &case.title, "plane-strain", case.text.clone());
    let mut manifest = Manifest::begin("0.1.0", Vec::new(), reported);
    let directory = OutputDirectory::hold(directory, Unseen::Respect)
        .and_then(|held| held.claim(ExistingRunPolicy::Delete, &manifest))
        .unwrap();
    let mut table = CsvTable::create(&directory.path().join(STEPS), &StepRow::columns("s")).unwrap();
    let schedule = schedule(case);
    let mut steps = 0;
    let mut time = 0.0;
    while let Some(next) = schedule.next(time).filter(|_| steps < most) {
        (steps, time) = (steps + 1, next);
        table.row(&row(steps, time, evaluations(case)).cells()).unwrap();
    }
    let work = (steps * (evaluations(case) + 4)) as f64;
    manifest.summary.steps = steps;
    manifest.summary.factorisations = steps;
    manifest.summary.residual_evaluations = steps * evaluations(case);
    manifest.summary.cpu_seconds = START + EVALUATION * case.points() as f64 / POINTS * work;
    manifest.summary.peak_memory = vec![50 << 20];
    manifest.sizes = [("points".to_owned(), case.points()), ("unknowns".to_owned(), 321)].into();
    manifest.timers.insert("wall".into(), manifest.summary.cpu_seconds);
    let stopped = schedule.next(time).is_some();
    manifest.finish(
        if stopped { Status::Stopped } else { Status::Finished },
        if stopped { 75 } else { 0 },
    );
    manifest.write(directory.path()).unwrap();
    stopped
}

fn row(step: u64, time: f64, evaluations: u64) -> StepRow {
    StepRow {
        step,
        time,
        dt: 0.0,
        iterations: evaluations,
        residual: 0.0,
        linear_iterations: evaluations,
        cutbacks: 0,
        active_nodes: 0,
        wall: 0.0,
        newton_iterations: 0,
        evaluations,
        products: 0,
        factorisations: 1,
        reductions: 0,
        messages: 0,
        bytes: 0,
        imbalance: 1.0,
    }
}

struct Bench(tempfile::TempDir);

impl Bench {
    fn new(code: u8) -> Self {
        let bench = Self(tempfile::tempdir().unwrap());
        bench.write("column.toml", COLUMN);
        bench.write("code", &code.to_string());
        let program = env::current_exe().unwrap();
        let script = format!(
            "#!/bin/sh\nexec '{}' --exact stub --nocapture -- \"$@\"\n",
            program.display()
        );
        bench.write("solver", &script);
        fs::set_permissions(bench.path("solver"), fs::Permissions::from_mode(0o755)).unwrap();
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn estimate(&self, options: &[&str]) -> Output {
        let arguments = [&["estimate"], options, &["--", "./solver"]].concat();
        let mut command = Command::new(env!("CARGO_BIN_EXE_bsmpm"));
        command
            .current_dir(self.0.path())
            .env(STUB, self.0.path())
            .args(arguments)
            .output()
            .unwrap()
    }

    #[track_caller]
    fn json(&self, options: &[&str]) -> Value {
        let output = self.estimate(&[&["column.toml", "--json"], options].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    }
}

#[test]
fn a_cost_that_follows_the_law_is_found_and_nothing_is_left() {
    let bench = Bench::new(0);
    let found = bench.json(&[]);
    // 20 evaluations a step, by the line through 8 and 12 of the coarse forms; 4 more of the step itself.
    let evaluations = found["work"]["evaluations"].as_f64().unwrap();
    assert!(
        (evaluations / (20.0 * STEPS_OF_COLUMN as f64) - 1.0).abs() < 0.02,
        "{found}"
    );
    let cpu = found["cpu_seconds"]["value"].as_f64().unwrap();
    let law = START + EVALUATION * 24.0 * STEPS_OF_COLUMN as f64;
    assert!((cpu / law - 1.0).abs() < 0.02, "{cpu} {law}");
    assert_eq!(
        (found["points"].as_u64(), found["unknowns"].as_u64()),
        (Some(800), Some(321))
    );
    assert!(found["cpu_seconds"]["high"].as_f64().unwrap() <= 1.51 * cpu);
    let last = fs::read_to_string(bench.path("last")).unwrap();
    assert!(!Path::new(&last).exists() && !Path::new(&last).parent().unwrap().exists());
}

#[test]
fn a_finished_run_is_set_beside_it() {
    let bench = Bench::new(0);
    let case = bsmpm_scene::Case::from_text("column.toml", COLUMN, &[]).unwrap();
    write_run(&case, &bench.path("column.out"), u64::MAX);
    let found = bench.json(&["--against", "column.out"]);
    assert!((found["ratio"].as_f64().unwrap() - 1.0).abs() < 0.02, "{found}");
    let output = bench.estimate(&["column.toml", "--no-probe", "--against", "column.out"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("actual, 1 rank(s)") && text.contains("estimated / actual"),
        "{text}"
    );
    let reported = bench.estimate(&[
        "column.toml",
        "--no-probe",
        "--against",
        "column.out",
        "--set",
        "grid.degree=cubic",
    ]);
    assert!(String::from_utf8(reported.stderr).unwrap().contains("W0854"));
}

#[test]
fn without_probes_nothing_is_run_and_the_band_is_wide() {
    let bench = Bench::new(70);
    let found = bench.json(&["--no-probe", "--ranks", "2"]);
    let [value, high] = ["value", "high"].map(|key| found["cpu_seconds"][key].as_f64().unwrap());
    assert!(high >= 3.0 * value && !bench.path("last").exists());
    assert_eq!(found["seconds"]["value"].as_f64(), Some(value / 2.0));
}

#[test]
fn errors_have_the_codes_of_the_other_commands() {
    let bench = Bench::new(71);
    let code = |options: &[&str]| bench.estimate(options).status.code();
    assert_eq!(code(&["column.toml"]), Some(71));
    assert_eq!(code(&["nowhere.toml"]), Some(66));
    assert_eq!(code(&["column.toml", "--against", "nowhere"]), Some(66));
    assert_eq!(code(&["column.toml", "--set", "grid.degree=quartic"]), Some(65));
    for bad in [
        &["--budget", "-1"][..],
        &["--budget", "nan"],
        &["--ranks", "0"],
        &["--ranks", "59"],
    ] {
        assert_eq!(code(&[&["column.toml"], bad].concat()), Some(2), "{bad:?}");
    }
    fs::remove_file(bench.path("solver")).unwrap();
    assert_eq!(code(&["column.toml"]), Some(74));
}
