//! Tests `bsmpm fos` with a stub solver.

mod refusals;
mod trials;

use std::env;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Duration;

use bsmpm_io::directory::{ExistingRunPolicy, HISTORY, OutputDirectory};
use bsmpm_io::frame::{Field, Frame};
use bsmpm_io::frames::{COLLECTION, Frames};
use bsmpm_io::lock::Unseen;
use bsmpm_io::manifest::{GridExtent, Manifest, ManifestCase, ManifestFailure, Status};
use bsmpm_io::table::{Cell, CsvTable, TableColumn};
use serde_json::Value;

use crate::Picture;

/// The variable that makes this program the solver; it names the folder where calls are noted.
const STUB: &str = "BSMPM_TEST_FOS";
const SLOPE: &str = include_str!("../../../../cases/short/slope_stability.toml");
const SCALED: &str = "E_delta_over_gamma_H2";

/// What the body of a stub does, as `KEY=NUMBER ...`: it bends at the factor `kink`, ends early from `stops` to `until`
/// with `code`, from `loose` on because a rigid body slips, and has no end above `lasts`.
fn behaviour(folder: &Path, key: &str, otherwise: f64) -> f64 {
    let text = fs::read_to_string(folder.join("behaviour")).unwrap();
    let value = text
        .split_whitespace()
        .find_map(|word| word.strip_prefix(key)?.strip_prefix('='));
    value.map_or(otherwise, |value| value.parse().unwrap())
}

/// No test of its own: the solver, when the variable says so.
#[test]
fn stub() {
    let Some(folder) = env::var_os(STUB).map(PathBuf::from) else {
        return;
    };
    let arguments: Vec<String> = env::args().skip_while(|word| word != "--").skip(1).collect();
    let after = |name: &str| {
        let pairs = arguments.windows(2).filter(|pair| pair[0] == name);
        pairs.map(|pair| pair[1].clone()).collect::<Vec<_>>()
    };
    let bytes = fs::read(&arguments[0]).unwrap();
    let case = bsmpm_scene::Case::from_bytes(&arguments[0], &bytes, &after("--set")).unwrap();
    let factor = case.strength_reduction.unwrap();
    let mut calls = OpenOptions::new()
        .create(true)
        .append(true)
        .open(folder.join("calls"))
        .unwrap();
    calls.write_all(format!("{factor}\n").as_bytes()).unwrap();
    if factor > behaviour(&folder, "breaks", f64::INFINITY) {
        eprintln!("it broke");
        std::process::exit(70);
    }
    if factor > behaviour(&folder, "lasts", f64::INFINITY) {
        let mut pids = OpenOptions::new()
            .create(true)
            .append(true)
            .open(folder.join("pids"))
            .unwrap();
        pids.write_all(format!("{}\n", std::process::id()).as_bytes()).unwrap();
        std::thread::sleep(Duration::from_secs(600));
    }
    let growth = 1.0 + 0.05 * factor + 100.0 * (factor - behaviour(&folder, "kink", f64::INFINITY)).max(0.0);
    let stops = behaviour(&folder, "stops", f64::INFINITY);
    let code = match (stops..behaviour(&folder, "until", f64::INFINITY)).contains(&factor) {
        true => behaviour(&folder, "code", 80.0) as u8,
        false => 0,
    };
    let output = after("--output").remove(0);
    let slips = factor >= behaviour(&folder, "loose", f64::INFINITY);
    let (code, loose) = if slips {
        (80, Some("block".to_owned()))
    } else {
        (code, None)
    };
    write_run(
        &case,
        arguments.clone(),
        Path::new(&output),
        7.5e-3 * growth,
        code,
        loose,
    );
    std::process::exit(i32::from(code));
}

/// A run of one step whose largest displacement is that many metres, how it ended, and the rigid body that slipped.
fn write_run(
    case: &bsmpm_scene::Case,
    argv: Vec<String>,
    directory: &Path,
    displacement: f64,
    code: u8,
    loose: Option<String>,
) {
    let reported = ManifestCase::new("slope.toml", &case.title, "plane-strain", case.text.clone());
    let mut manifest = Manifest::begin("0.1.0", argv, reported);
    manifest.grid = Some(GridExtent {
        lower: vec![0.0; 2],
        upper: vec![40.0, 12.0],
        cell: vec![1.0; 2],
    });
    let directory = OutputDirectory::hold(directory, Unseen::Respect)
        .and_then(|held| held.claim(ExistingRunPolicy::Delete, &manifest))
        .unwrap();
    let mut headings = vec![TableColumn::new("step", ""), TableColumn::new("time", "")];
    let columns = case.histories.iter().flat_map(bsmpm_scene::History::columns);
    headings.extend(columns.map(|column| TableColumn::new(&column.name, &column.unit)));
    let mut table = CsvTable::create(&directory.path().join(HISTORY), &headings).unwrap();
    let row = |step: u64, displacement: f64| -> Vec<Cell> {
        let quantities = headings[2..].iter().map(|heading| match &*heading.name {
            SCALED => Cell::Float(50.0 * displacement),
            _ => Cell::Float(displacement),
        });
        [Cell::Int(step), Cell::Float(step as f64)]
            .into_iter()
            .chain(quantities)
            .collect()
    };
    table.row(&row(0, 0.0)).unwrap();
    table.row(&row(1, displacement)).unwrap();
    let position: Vec<[f64; 3]> = (0..100)
        .map(|index| [f64::from(index % 10) + 0.5, f64::from(index / 10) + 0.5, 0.0])
        .collect();
    let moved: Vec<f64> = position
        .iter()
        .flat_map(|place| [displacement * place[1] / 10.0, 0.0, 0.0])
        .collect();
    let strain: Vec<f64> = position.iter().map(|place| displacement * place[0] / 100.0).collect();
    let fields = vec![
        Field::real("displacement", 3, moved),
        Field::real("plastic_strain", 1, strain),
        Field::real("stress", 6, vec![0.0; 600]),
    ];
    let mut frames = Frames::create(directory.path()).unwrap();
    frames
        .write(&Frame {
            step: 1,
            time: 1.0,
            position,
            fields,
        })
        .unwrap();
    [COLLECTION, HISTORY, &Frames::file(1)]
        .iter()
        .for_each(|name| manifest.name_output(name));
    if code == 0 {
        manifest.finish(Status::Finished, 0);
    } else {
        let reason = "no step converged".to_owned();
        manifest.failure = Some(ManifestFailure {
            step: 2,
            time: 0.875,
            reason,
            residuals: Vec::new(),
            worst: None,
            loose,
        });
        manifest.finish(Status::Failed, code);
    }
    manifest.write(directory.path()).unwrap();
}

struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new(case: &str, behaviour: &str) -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        bench.write("slope.toml", case);
        bench.write("behaviour", behaviour);
        let program = env::current_exe().unwrap();
        bench.write(
            "solver",
            &format!(
                "#!/bin/sh\nexec '{}' --exact fos::stub --nocapture -- \"$@\"\n",
                program.display()
            ),
        );
        fs::set_permissions(bench.path("solver"), fs::Permissions::from_mode(0o755)).unwrap();
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn fos(&self, options: &[&str]) -> Output {
        self.fos_with("2", options)
    }

    fn fos_with(&self, jobs: &str, options: &[&str]) -> Output {
        self.command(jobs, options).output().unwrap()
    }

    fn command(&self, jobs: &str, options: &[&str]) -> Command {
        let arguments = [&["fos", "slope.toml", "--jobs", jobs], options, &["--", "./solver"]].concat();
        let mut command = Command::new(env!("CARGO_BIN_EXE_bsmpm"));
        command
            .current_dir(self.folder.path())
            .env(STUB, self.folder.path())
            .args(arguments);
        command
    }

    fn calls(&self) -> usize {
        fs::read_to_string(self.path("calls")).map_or(0, |text| text.lines().count())
    }

    fn found(&self) -> Value {
        serde_json::from_str(&fs::read_to_string(self.path("slope.fos/fos.json")).unwrap()).unwrap()
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn the_factor_is_found_and_written_with_its_conditions_and_pictures() {
    let bench = Bench::new(SLOPE, "kink=1.373");
    let output = bench.fos_with("1", &[]);
    let said = text(&output.stdout);
    assert!(said.contains("\nUse the result by the kink"), "{said}");
    assert!(output.status.success(), "{output:?}");
    assert!(
        said.contains("h = 1 m, 3 x 3 points a cell, order 2; consistent-f-bar; background 1e-4 E"),
        "{said}"
    );
    assert!(
        said.contains("10 load steps; tolerances 1e-8 (energy), 1e-4 (forces); E = 100 MPa"),
        "{said}"
    );
    let found = bench.found();
    let factor = &found["factor_of_safety"];
    let number = |key: &str| factor[key].as_f64().unwrap();
    assert!(
        number("last_stable") <= 1.373 && 1.373 <= number("first_failed"),
        "{factor}"
    );
    assert!(number("first_failed") - number("last_stable") < 0.0201 && (number("estimate") - 1.373).abs() < 2e-3);
    assert_eq!(found["criteria"][1]["criterion"], "doubled");
    assert_eq!(
        (&found["conditions"]["background"], &found["column"]),
        (&1e-4.into(), &SCALED.into())
    );
    let trials = found["trials"].as_array().unwrap();
    assert!(trials[0]["verdict"] == "elastic" && trials[0]["factor"] == 0.0 && trials[1]["status"] == "equilibrium");
    assert!(
        trials
            .iter()
            .all(|trial| trial["plastic_strain"].as_f64().unwrap() > 0.0)
    );
    let table = fs::read_to_string(bench.path("slope.fos/fos.csv")).unwrap();
    assert_eq!((table.lines().count(), bench.calls()), (2 + trials.len(), trials.len()));
    for name in ["fos.png", "fos_plastic-strain.png", "fos_displacement.png"] {
        let path = bench.path("slope.fos").join(name);
        assert!(
            said.contains(&format!("slope.fos/{name}")) && Picture::read(&path).colours() > 20,
            "{name}"
        );
    }
}

#[test]
fn a_trial_without_equilibrium_is_a_result() {
    for (code, status) in [(80, "no-equilibrium"), (81, "left")] {
        let bench = Bench::new(SLOPE, &format!("stops=1.373 code={code}"));
        let output = bench.fos(&[]);
        assert!(output.status.success(), "{output:?}");
        let said = text(&output.stdout);
        assert!(said.contains("at 0.875 of the load: no step converged"), "{said}");
        assert!(said.contains("There is no kink. Use the first result"), "{said}");
        let found = bench.found();
        let number = |key: &str| found["factor_of_safety"][key].as_f64().unwrap();
        assert!(
            number("last_stable") < 1.373 && 1.373 <= number("first_failed"),
            "{found}"
        );
        assert!(found["factor_of_safety"]["estimate"].is_null());
        let trials = found["trials"].as_array().unwrap();
        assert!(
            trials
                .iter()
                .any(|trial| trial["status"] == status && trial["load"] == 0.875),
            "{found}"
        );
        assert!(bench.path("slope.fos/fos_displacement.png").exists());
    }
    // In the middle, where a weaker body stands.
    let bench = Bench::new(SLOPE, "kink=1.373 stops=0.7 until=0.8");
    let output = bench.fos(&[]);
    assert!(text(&output.stdout).contains("\nwarning W0806: "), "{output:?}");
    assert!((bench.found()["factor_of_safety"]["estimate"].as_f64().unwrap() - 1.373).abs() < 2e-3);
}

#[test]
fn a_trial_that_breaks_ends_the_search_with_its_code() {
    let bench = Bench::new(SLOPE, "kink=1.373");
    assert!(bench.fos(&[]).status.success());
    bench.write("behaviour", "kink=1.373 breaks=0.7");
    let output = bench.fos(&["--force"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(70));
    assert!(
        said.contains("bsmpm: error E0802: ")
            && said.contains("it broke")
            && !bench.path("slope.fos/fos.json").exists(),
        "{said}"
    );
}

#[test]
fn a_body_that_never_stands_or_never_fails_is_reported() {
    let bench = Bench::new(SLOPE, "kink=0.3");
    let output = bench.fos(&[]);
    let said = text(&output.stderr);
    assert!(
        output.status.code() == Some(80) && said.contains("bsmpm: error E0828: "),
        "{said}"
    );
    let bench = Bench::new(SLOPE, "kink=9");
    let output = bench.fos(&["--to", "2"]);
    let said = text(&output.stdout);
    assert!(
        output.status.success() && said.contains("above 2: no failure up to there"),
        "{said}"
    );
    assert!(!said.contains("Use the"), "{said}");
    assert!(bench.found()["factor_of_safety"]["first_failed"].is_null());
    assert!(bench.path("slope.fos/fos.png").exists() && !bench.path("slope.fos/fos_displacement.png").exists());
}

#[test]
fn a_case_that_records_no_displacement_gets_it_recorded() {
    let bare = SLOPE.split("[[history]]").next().unwrap();
    let bench = Bench::new(bare, "kink=1.373");
    assert!(bench.fos(&[]).status.success());
    assert_eq!(bench.found()["column"], "max-displacement");
    assert!((bench.found()["factor_of_safety"]["estimate"].as_f64().unwrap() - 1.373).abs() < 2e-3);
}

#[test]
fn weight_that_comes_at_once_and_soft_soil_are_mended_and_reported() {
    let of = |set: &[&str]| {
        let bench = Bench::new(SLOPE, "kink=1.373");
        let options: Vec<&str> = set.iter().flat_map(|set| ["--set", *set]).collect();
        let output = bench.fos(&options);
        assert!(output.status.success(), "{output:?}");
        let run = fs::read_to_string(bench.path("slope.fos/trials/0.out/run.json")).unwrap();
        (text(&output.stdout), bench.found(), run)
    };
    let (said, as_it_is, run) = of(&[]);
    assert!(!said.contains("stiffness") && !said.contains("at once"), "{said}");
    assert!(
        as_it_is["conditions"]["stiffness"] == 1.0 && run.contains("elastic = true"),
        "{run}"
    );
    let (said, found, run) = of(&["gravity.ramp=0.0"]);
    assert!(
        said.contains("note: a load acts at once in the case") && run.contains("unloaded = true"),
        "{said} {run}"
    );
    assert_eq!(found["elastic_displacement"], as_it_is["elastic_displacement"]);
    let (said, found, _) = of(&["gravity.ramp=0.0", "initial.k0=0.5"]);
    assert!(
        said.contains("note: the trials start without the initial stress"),
        "{said}"
    );
    assert_eq!(found["elastic_displacement"], as_it_is["elastic_displacement"]);
    // The weight of 10 m over E: 0.2 % as it is, 2 % with a tenth of E.
    let (said, found, run) = of(&["material.soil.young=1e7"]);
    assert!(
        said.contains("note: the trials use 10 times the stiffness of the case")
            && said.contains("E = 10 MPa, times 10")
    );
    assert!(
        found["conditions"]["stiffness"] == 10.0 && run.contains("stiffness = 10.0"),
        "{run}"
    );
    // The stub moves as far whatever the stiffness: reported as of the case's own it is ten times that.
    let displacement = |found: &Value| found["elastic_displacement"].as_f64().unwrap();
    assert!((displacement(&found) / displacement(&as_it_is) - 10.0).abs() < 1e-12);
    assert_eq!(found["factor_of_safety"], as_it_is["factor_of_safety"]);
}

const CLAY: &str = "material.soil={ model = \"modified-cam-clay\", young = 1e7, poisson = 0.3, density = 2e3, \
                    kappa_star = 0.02, lambda_star = 0.12, critical_state_ratio = 1.0, preconsolidation = 2e5 }";

/// Only what is there when the strength falls has strength that matters; what softens has its own stiffness, and a band
/// only.
#[test]
fn what_is_not_there_does_not_matter_and_what_softens_has_a_band() {
    let of = |set: &[&str], further: &[&str]| {
        let bench = Bench::new(SLOPE, "kink=1.373");
        let set = set.iter().flat_map(|set| ["--set", *set]);
        let output = bench.fos(&set.chain(further.iter().copied()).collect::<Vec<_>>());
        assert!(output.status.success(), "{output:?}");
        bench.found()
    };
    let softening = |young: f64, last: f64| {
        format!(
            "{{ model = \"mohr-coulomb-softening\", young = {young:e}, poisson = 0.3, density = 2e3, friction_angle = 30, \
             cohesion = 1e4, residual_friction_angle = {last}, residual_cohesion = 0, softening_strain = 0.1 }}"
        )
    };
    let spare = of(&[&format!("material.spare={}", softening(1e7, 20.0))], &[]);
    assert_eq!(spare["conditions"]["young"].as_array().unwrap().len(), 1, "{spare}");
    assert!(!spare["factor_of_safety"]["estimate"].is_null());
    let soil = of(&[&format!("material.soil={}", softening(1e7, 20.0))], &[]);
    let found = &soil["factor_of_safety"];
    assert!(
        soil["conditions"]["stiffness"] == 1.0 && found["estimate"].is_null(),
        "{soil}"
    );
    assert!(
        found["last_stable"].as_f64() < Some(1.42) && found["first_failed"].as_f64() > Some(1.41),
        "{soil}"
    );
    assert!(soil["notes"].to_string().contains("W0809"), "{soil}");
}

/// The largest displacement of a body has the name of that of all; a search judges by the latter.
#[test]
fn a_case_may_record_the_displacement_of_a_body() {
    let bench = Bench::new(SLOPE, "kink=1.373");
    let of_a_body = "history=[{ quantity = \"max-displacement\", body = \"slope\" }]";
    let output = bench.fos(&["--set", "body.0.name=slope", "--set", of_a_body]);
    assert!(output.status.success(), "{output:?}");
}

/// Only what lies in the box counts: the lower part of the stub's ground moves less, and fails at the same factor.
#[test]
fn a_region_is_judged_alone() {
    let bench = Bench::new(SLOPE, "kink=1.373");
    let of = |options: &[&str]| {
        let output = bench.fos(options);
        assert!(output.status.success(), "{output:?}");
        bench.found()
    };
    let whole = of(&[]);
    let lower = of(&["--region", "0,0,10,5"]);
    let displacement = |found: &Value| found["elastic_displacement"].as_f64().unwrap();
    assert!(displacement(&lower) < 0.8 * displacement(&whole), "{lower}");
    assert!((displacement(&lower) - displacement(&whole)).abs() > 0.0 && whole["region"].is_null());
    assert_eq!(
        lower["factor_of_safety"]["last_stable"],
        whole["factor_of_safety"]["last_stable"]
    );
    assert!(lower["mechanism"]["upper"][1].as_f64().unwrap() <= 5.0, "{lower}");
    for region in ["0,0,10", "0,0,10,0", "5,0,4,1"] {
        let output = bench.fos(&["--region", region]);
        assert!(
            output.status.code() == Some(2) && text(&output.stderr).contains("E0832: --region"),
            "{output:?}"
        );
    }
    let output = bench.fos(&["--region", "20,0,30,5"]);
    assert!(text(&output.stderr).contains("E0832: no material point"), "{output:?}");
}

#[test]
fn a_rigid_body_that_slips_is_no_failure_of_the_ground() {
    let bench = Bench::new(SLOPE, "kink=1.373 loose=1.1");
    let output = bench.fos(&[]);
    let said = text(&output.stderr);
    assert!(
        output.status.code() == Some(80) && said.contains("E0826: only friction supports rigid body `block`. It slips"),
        "{said}"
    );
    assert!(!bench.path("slope.fos/fos.json").exists());
}
