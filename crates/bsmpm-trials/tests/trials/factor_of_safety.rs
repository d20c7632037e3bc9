//! Tests `bsmpm fos` on a coarse slope.

use crate::support::bounds::pit;
use crate::support::cases::slope;
use crate::support::circles::Embankment;
use crate::support::{processes, program};
use std::path::Path;

use bsmpm_tools::fos::{FosArguments, run};
use serde_json::Value;

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases");

fn search(case: &str, set: &[&str], jobs: usize, output: &Path) -> (Value, usize) {
    between([1.0, 2.0], case, set, jobs, output)
}

fn between(range: [f64; 2], case: &str, set: &[&str], jobs: usize, output: &Path) -> (Value, usize) {
    let search = Search {
        range,
        width: 0.05,
        stage: None,
    };
    of_stage(search, case, set, jobs, output)
}

/// What a search is asked for.
#[derive(Clone, Copy)]
pub(super) struct Search<'a> {
    /// Factors between which the search begins.
    pub range: [f64; 2],
    /// Width of the interval in which it ends.
    pub width: f64,
    /// Stage at whose end the strength is reduced.
    pub stage: Option<&'a str>,
}

pub(super) fn of_stage(search: Search<'_>, case: &str, set: &[&str], jobs: usize, output: &Path) -> (Value, usize) {
    let Search { range, width, stage } = search;
    let arguments = FosArguments {
        from: Some(range[0]),
        to: Some(range[1]),
        stage: stage.map(str::to_owned),
        width: Some(width),
        jobs: Some(jobs),
        set: set.iter().map(|&set| set.to_owned()).collect(),
        ..FosArguments::of(Path::new(CASES).join(case))
    };
    searched(arguments, output)
}

/// What is in `fos.json` after a search with this program in the directory `output`, and how many trials were made.
pub(super) fn searched(arguments: FosArguments, output: &Path) -> (Value, usize) {
    let command = vec![program().to_owned()];
    let arguments = FosArguments {
        output: Some(output.to_owned()),
        command,
        ..arguments
    };
    let mut made = 0;
    let _turn = processes::turn();
    let (_, pictures) = run(&arguments, |line| made += usize::from(!line.contains("kept"))).unwrap();
    assert_eq!(pictures.len(), 3);
    assert!(pictures.iter().all(|picture| picture.is_file()));
    (
        serde_json::from_str(&std::fs::read_to_string(output.join("fos.json")).unwrap()).unwrap(),
        made,
    )
}

#[test]
fn a_slope_of_five_cells_has_the_factor_of_the_literature() {
    let dir = tempfile::tempdir().unwrap();
    let (found, made) = search("short/slope_stability.toml", &["grid.cell=2.0"], 2, dir.path());
    let number = |key: &str| found["factor_of_safety"][key].as_f64().unwrap();
    // Bishop and Morgenstern (1960): 1.380. The program found 1.405 with cells of 2 m and 1.380 with cells of 1 m; 4 %
    // are twice that error.
    assert!((number("estimate") / 1.38 - 1.0).abs() < 0.04, "{found}");
    assert!(
        number("last_stable") <= number("estimate") && number("estimate") <= number("first_failed"),
        "{found}"
    );
    assert!(number("first_failed") - number("last_stable") <= 0.0501, "{found}");
    assert!(made > 5, "{made}");
    let (again, made) = search("short/slope_stability.toml", &["grid.cell=2.0"], 2, dir.path());
    assert_eq!((&again["factor_of_safety"], made), (&found["factor_of_safety"], 0));
}

#[test]
fn the_number_of_jobs_does_not_change_a_digit() {
    let found = |jobs: usize| {
        let dir = tempfile::tempdir().unwrap();
        let (mut found, _) = search("short/slope_stability.toml", &["grid.cell=2.0"], jobs, dir.path());
        let object = found.as_object_mut().unwrap();
        assert_eq!(object.remove("jobs"), Some(jobs.into()));
        object.remove("seconds").unwrap();
        for trial in object["trials"].as_array_mut().unwrap() {
            let trial = trial.as_object_mut().unwrap();
            trial.remove("seconds").zip(trial.remove("cpu_seconds")).unwrap();
        }
        (found, std::fs::read(dir.path().join("fos.png")).unwrap())
    };
    let alone = found(1);
    for jobs in [2, 3, 4] {
        let other = found(jobs);
        assert!(other == alone, "{jobs} jobs: {} {}", other.0, alone.0);
    }
}

pub(super) fn estimate(found: &Value) -> f64 {
    found["factor_of_safety"]["estimate"]
        .as_f64()
        .unwrap_or_else(|| panic!("{found}"))
}

/// Without extended splines it was 1.367, 1.357 and 1.219 with 10, 40 and 100 steps. Now 1.368 to 1.372 is found.
#[test]
fn the_factor_of_a_slope_depends_neither_on_the_background_nor_on_the_number_of_steps() {
    let dir = tempfile::tempdir().unwrap();
    let case = dir.path().join("case.toml");
    std::fs::write(&case, slope(0.0)).unwrap();
    for set in ["solver.background=1e-5", "solver.background=1e-4", "analysis.steps=40"] {
        let output = dir.path().join(set);
        let search = Search {
            range: [1.25, 1.5],
            width: 0.005,
            stage: None,
        };
        let found = estimate(&of_stage(search, case.to_str().unwrap(), &[set], 2, &output).0);
        println!("{set}: {found}");
        assert!((found / 1.370 - 1.0).abs() < 0.0025, "{set}: {found}");
    }
}

/// With E = 10 MPa the displacement of 20 times the elastic one is a third of the slope's height, and geometry that
/// flattens under it lowers the factor: with cells of 1.25 m 0.981 without stiffer trials, 0.994 with them, 0.993 with
/// 1,000 MPa.
#[test]
fn the_factor_of_acads_1a_does_not_depend_on_the_stiffness() {
    let of = |young: &str| {
        let dir = tempfile::tempdir().unwrap();
        let set = [format!("material.soil.young={young}"), "grid.cell=2.5".to_owned()];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let (found, _) = between([0.8, 1.4], "validation/acads_1a.toml", &set, 2, dir.path());
        (estimate(&found), found["conditions"]["stiffness"].as_f64().unwrap())
    };
    let [(soft, times), (stiff, none)] = ["1e7", "1e9"].map(of);
    assert!(times > 10.0 && none == 1.0, "{times} {none}");
    assert!((soft - stiff).abs() < 0.01, "{soft} {stiff}");
}

/// The reference is elastic: with ten times the strength for it the fill had a friction angle of 80.2 degrees without
/// dilation, with which not every embankment finds equilibrium. The program found 1.472 with a band of 0.02, 1.468 at
/// `standard`.
#[test]
fn an_embankment_on_clay_whose_weight_acts_from_the_start_has_a_factor() {
    let dir = tempfile::tempdir().unwrap();
    let (found, _) = search(
        "validation/embankment.toml",
        &["gravity.ramp=0.0", "initial.gravity=elastic"],
        2,
        dir.path(),
    );
    let (found, notes) = (estimate(&found), found["notes"].to_string());
    // Bishop's simplified circles: 1.428.
    assert!((found / 1.428 - 1.0).abs() < 0.05, "{found}");
    assert!(
        notes.contains("a load acts at once") && notes.contains("without the initial stress"),
        "{notes}"
    );
}

/// Built by gravity with the whole strength, which then falls: the factor of the slope that is loaded with less.
#[test]
fn a_slope_that_is_built_and_then_weakened_has_the_same_factor() {
    let found = |stage: Option<&str>| {
        let dir = tempfile::tempdir().unwrap();
        let plan = Search {
            range: [1.0, 2.0],
            width: 0.05,
            stage,
        };
        let (found, made) = of_stage(plan, "short/slope_stability.toml", &["grid.cell=2.0"], 1, dir.path());
        if stage.is_some() {
            let (again, none) = of_stage(plan, "short/slope_stability.toml", &["grid.cell=2.0"], 1, dir.path());
            assert_eq!((&again["factor_of_safety"], none), (&found["factor_of_safety"], 0));
        }
        (estimate(&found), made, found)
    };
    let (plain, ..) = found(None);
    let (staged, made, whole) = found(Some("end"));
    println!("{plain} loaded with less strength, {staged} weakened after it was built");
    assert!((plain - staged).abs() < 0.05, "{plain} {staged}");
    let trials = whole["trials"].as_array().unwrap();
    assert!(made > trials.len() - 1, "the run to the stage, too: {made}");
    let steps = |row: &Value| row["steps"].as_u64().unwrap();
    assert!(
        trials.iter().all(|row| steps(row) <= 11),
        "they go on from its checkpoint: {whole}"
    );
}

/// The first pit of `cases/excavation.toml` is a vertical cut, 4 m high, which stands up to gamma H/c = 3.7603 to
/// 3.7859 (Pastor et al., 2000). In cells of 1 m its factor is 2.99, of 0.5 m 2.83, and 2.68 where these lead to; that
/// of the second one is 1.88, where blocks allow 1.884.
#[test]
fn a_pit_has_the_factor_of_a_vertical_cut_and_then_no_more_than_blocks_allow() {
    let of = |cell: &str, stage: &str, range: [f64; 2]| {
        let dir = tempfile::tempdir().unwrap();
        let grid = format!("grid={{ lower = [0, 0], upper = [32, 18], cell = {cell}, degree = \"quadratic\" }}");
        let plan = Search {
            range,
            width: 0.1,
            stage: Some(stage),
        };
        let (found, _) = of_stage(plan, "excavation.toml", &[&grid], 2, dir.path());
        let notes = found["notes"].to_string();
        assert!(notes.contains(&format!("the stage \\\"{stage}\\\"")), "{notes}");
        estimate(&found)
    };
    let number = 50.0 / (18.0 * 4.0);
    let [coarse, fine] = ["1.0", "0.5"].map(|cell| of(cell, "pit 1", [2.4, 3.2]));
    let cut = 2.0 * fine - coarse;
    let blocks = pit(1, 2.0);
    println!("{coarse}, {fine}, {cut}; blocks {blocks}");
    assert!(
        coarse > fine && fine > 3.7859 * number && blocks > 3.7603 * number,
        "{coarse} {fine} {blocks}"
    );
    assert!((cut / (3.7731 * number) - 1.0).abs() < 0.03, "{coarse} {fine} {cut}");
    let second = of("1.0", "pit 2", [1.5, 2.2]);
    let blocks = pit(2, 2.0);
    println!("{second}; blocks {blocks}");
    assert!((second / blocks - 1.0).abs() < 0.03, "{second} {blocks}");
}

/// `cases/embankment.toml` at its end. With a fill that has no friction the circles are an upper bound: 1.507, where
/// the program finds 1.502; it finds 1.497 with the case's own, in cells of 1 m and of 0.5 m.
#[test]
fn the_embankment_of_the_scenes_has_the_factor_of_bishops_circles() {
    let fill = [19e3, 5e3, 30.0];
    let clay = [17e3, 16e3, 1.5e3];
    let embankment = Embankment {
        toe: [20.0, 8.0],
        slope: [4.0, 8.0],
        fill,
        clay,
        within: [0.0, 40.0],
    };
    let (bishop, circle) = embankment.least_factor([[22.0, 12.0], [27.0, 18.0]], [3.0, 7.5], 24);
    assert!((bishop - 1.463).abs() < 0.01, "{bishop} of {circle:?}");
    let dir = tempfile::tempdir().unwrap();
    let (found, _) = search("embankment.toml", &["stage=[]"], 2, dir.path());
    let found = estimate(&found);
    assert!((found / bishop - 1.0).abs() < 0.04, "{found}, {bishop} of {circle:?}");
}

/// Greatest factor of `slope_between_ends` of a length, m, whose slide turns on a cylinder about `centre` between plane
/// ends, as Baligh and Azzouz (1975) have it: what c holds on it and at both ends over the weight's moment. The true
/// one is less, as a mechanism bounds it from above.
fn turns_between_ends(length: f64, centre: [f64; 2], radius: f64) -> f64 {
    let c = 20.0;
    let gamma = 20.0;
    let cell = 0.02;
    let angle = 1e-3;
    let is_ground = |x: f64, z: f64| z < (14.0 - x).clamp(2.0, 7.0);
    let on = |k: i32| (f64::from(k) * angle).sin_cos();
    let turned = (-3141..3141).filter(|&k| is_ground(centre[0] + radius * on(k).0, centre[1] - radius * on(k).1));
    let mut held = c * radius * radius * turned.count() as f64 * angle;
    let mut weight = 0.0;
    for (k, l) in (0..1000).flat_map(|k| (0..350).map(move |l| (k, l))) {
        let [x, z] = [k, l].map(|at| (f64::from(at) + 0.5) * cell);
        let r = (x - centre[0]).hypot(z - centre[1]);
        if r < radius && is_ground(x, z) {
            held += 2.0 * c * r * cell * cell / length;
            weight += gamma * (centre[0] - x) * cell * cell;
        }
    }
    held / weight
}

/// Half of 10 m between rough ends: 1.404 with cells of 1 m, 1.398 with 0.5 m; the plane slope 1.110 and 1.111. The
/// circles are those with the least bounds, 1.160 and 1.578.
#[test]
fn rough_ends_hold_a_slope_up_to_what_a_cylinder_between_them_allows() {
    let of = |range, set: &[&str]| {
        let dir = tempfile::tempdir().unwrap();
        estimate(&between(range, "slope_between_ends.toml", set, 2, dir.path()).0)
    };
    let slice = ["grid.upper=[20, 1, 8]", "body.0.extrude.to=1", "boundary.back=roller"];
    let plane = of([0.9, 1.3], &slice);
    let held = of([1.2, 1.6], &[]);
    let most = turns_between_ends(1e9, [9.5, 9.5], 9.5);
    assert!(0.93 * most < plane && plane < most, "{plane} {most}");
    let most = turns_between_ends(10.0, [10.25, 8.0], 6.25);
    assert!(1.2 * plane < held && held < most, "{plane} {held} {most}");
}

/// A thick cylinder of clay under pressure inside: the whole wall yields at 2 c ln(b/a).
#[test]
fn a_thick_cylinder_has_the_factor_of_its_limit_pressure() {
    let dir = tempfile::tempdir().unwrap();
    let clay = r#"material.wall={ model = "tresca", young = "10 GPa", poisson = 0.3, cohesion = "1 kPa" }"#;
    let set = [
        clay,
        "traction.0.stress=[1000, 0]",
        "grid.cell=0.1",
        "solver.background=1e-6",
        "stabilisation.method=consistent-f-bar",
    ];
    let range = Search {
        range: [1.0, 2.0],
        width: 0.02,
        stage: None,
    };
    let (found, _) = of_stage(range, "validation/thick_cylinder.toml", &set, 2, dir.path());
    let [stable, failed] = ["last_stable", "first_failed"].map(|key| found["factor_of_safety"][key].as_f64().unwrap());
    let exact = 2.0 * std::f64::consts::LN_2;
    // 1.386 to 1.406 for 1.3863: the band is 0.0195 wide, and within its width of the limit.
    assert!(
        failed - stable <= 0.0201 && (0.5 * (stable + failed) - exact).abs() <= 0.02,
        "{stable} {failed}"
    );
}

/// Without ties a material point at the toe creeps in every step. By the largest displacement the factor of the slope
/// was 1.219 with 100 steps; the displacement of a block of cells gives 1.370 within the band.
#[test]
fn a_point_that_creeps_at_the_surface_does_not_decide() {
    let dir = tempfile::tempdir().unwrap();
    let case = dir.path().join("case.toml");
    std::fs::write(&case, slope(0.0)).unwrap();
    let set = ["solver.extension=off", "analysis.steps=100"];
    let (found, _) = of_stage(
        Search {
            range: [1.0, 1.5],
            width: 0.02,
            stage: None,
        },
        case.to_str().unwrap(),
        &set,
        2,
        &dir.path().join("out"),
    );
    println!("{}", estimate(&found));
    assert!((estimate(&found) / 1.37 - 1.0).abs() < 0.01, "{found}");
    let notes = found["notes"].to_string();
    assert!(notes.contains("W0801: in trial "), "{notes}");
    let [low, high] = ["lower", "upper"].map(|key| found["mechanism"][key][0].as_f64().unwrap());
    assert!(
        4.0 < low && low < 12.0 && 28.0 < high && high < 33.0,
        "{}",
        found["mechanism"]
    );
}

/// A steep cut in clay, 3.5 m high and 3 m from a side of the grid.
const CUT: &str = r#"
    geometry = "plane-strain"
    analysis = { type = "quasi-static", steps = 10 }
    gravity  = { acceleration = [0.0, -9.81], ramp = 1.0 }
    boundary = { bottom = "fixed", left = "roller", right = "roller" }
    grid     = { lower = [0.0, -2.0], upper = [10.0, 4.0], cell = 0.5, degree = "quadratic" }
    body     = [{ material = "clay", polygon = [[0, -2], [10, -2], [10, 0], [4, 0], [3, 3.5], [0, 3.5]], points_per_cell = 3 }]
    stabilisation = { method = "consistent-f-bar" }
    [material.clay]
    model       = "mohr-coulomb"
    young       = "10 MPa"
    poisson     = 0.3
    cohesion    = "25 kPa"
    friction_angle    = 0
    dilation_angle    = 0
    unit_weight = "20 kN/m3"
"#;

/// Held back by the side 1.586, released by it 1.492.
#[test]
fn a_side_in_tension_that_holds_a_mechanism_back_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let case = dir.path().join("case.toml");
    std::fs::write(&case, CUT).unwrap();
    let of = |set: &[&str]| {
        of_stage(
            Search {
                range: [1.2, 2.0],
                width: 0.02,
                stage: None,
            },
            case.to_str().unwrap(),
            set,
            2,
            &dir.path().join(set.len().to_string()),
        )
        .0
    };
    let [held, released] = [of(&[]), of(&["boundary.left=contact"])];
    assert!(estimate(&held) > 1.05 * estimate(&released), "{held} {released}");
    assert_eq!(held["mechanism"]["pulled"][0]["side"], "left", "{held}");
    assert!(
        held["notes"].to_string().contains("W0803: ")
            && held["notes"].to_string().contains("pull on the soil (tension): left"),
        "{held}"
    );
    assert!(!released["notes"].to_string().contains("W0803"), "{released}");
}
