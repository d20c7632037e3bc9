//! Tests the cases in `cases/`, and their memory estimates.

use bsmpm_scene::observables::Observable;
use bsmpm_scene::words::LinearSolver;
use bsmpm_scene::{Base, Case, GridAxis, HistorySubject, PointSelection, Quantity, load};
use std::path::{Path, PathBuf};

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

fn read(path: &Path) -> Case {
    let bytes = load(path).unwrap();
    let errors = |errors: Vec<bsmpm_scene::Error>| errors.iter().map(|e| format!("{e:#}\n")).collect::<String>();
    Case::from_bytes(&path.display().to_string(), &bytes, &[])
        .map_err(errors)
        .unwrap_or_else(|text| panic!("{text}"))
}

#[test]
fn every_shipped_case_is_valid() {
    let mut folders = vec![cases()];
    let mut found = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "toml") && !path.ends_with("matrix.toml") {
                let case = read(&path);
                // The ground of the faults does without C0 lines on purpose, and is reported; so is the study of
                // densities. Where water flows there are none at the ends of loads, nor below fill. What a column that
                // is let go holds of its own water's weight, its first step has at once. Clay of which a level is drawn
                // down stays full.
                let on_purpose = |warning: &String| {
                    let without = [
                        "mini_footing",
                        "embankment_consolidation",
                        "embankment_lifts",
                        "undrained_strip",
                    ]
                    .map(Some);
                    let line = "undrained_footing.toml"; // the study of friction beside one
                    without.contains(&path.file_stem().and_then(|stem| stem.to_str()))
                        && (warning.starts_with("W0216") || warning.starts_with("W0217"))
                        || path.ends_with("two_densities.toml") && warning.starts_with("W0221") && warning.contains("factor of 2.")
                        || path.ends_with(line) && warning.starts_with("W0218")
                        || path.ends_with("lid_square.toml") && warning.starts_with("W0408") // its shear
                        || ["rapid_drawdown.toml", "saturated_slide.toml"].iter().any(|name| path.ends_with(name))
                            && warning.starts_with("W0553")
                        || path.ends_with("saturated_collapse.toml") && warning.starts_with("W0551")
                };
                let is_slip = |warning: &String| warning.starts_with("W01");
                assert!(
                    !case.warnings.iter().any(is_slip),
                    "{}: {:?}",
                    path.display(),
                    case.warnings
                );
                assert!(
                    case.warnings.iter().all(on_purpose),
                    "{}: {:?}",
                    path.display(),
                    case.warnings
                );
                found += 1;
            }
        }
    }
    assert!(found >= 15);
}

#[test]
fn the_column_of_the_paper() {
    let case = read(&cases().join("column_collapse.toml"));
    let estimate = case.estimate(1);
    assert_eq!(
        (estimate.cells, estimate.nodes, estimate.points),
        (220 * 41, 222 * 43, 115_200)
    );
    let density = case.materials[0].density.unwrap();
    assert!((density - 20_400.0 / 9.81).abs() < 1e-10);
    assert_eq!(case.output.times, [0.109, 0.235, 0.3, 0.351, 0.42, 0.607]);
    assert_eq!(case.analysis.dt, 2.5e-4);
}

/// Slabs of a solid are cut along y, too: 56 x 56 cells from above and a C0 line along each axis, 65,000 unknowns.
#[test]
fn ranks_of_a_solid_are_not_bounded_by_its_columns_along_x() {
    let bytes = load(&cases().join("square_footing.toml")).unwrap();
    let case = Case::from_bytes("square_footing.toml", &bytes, &["grid.cell=0.0625".to_owned()]).unwrap();
    let useful = case.estimate(1).useful_ranks;
    assert_eq!((case.most_ranks(), case.parts(57 * 57, [1; 2])), (57 * 57, Some(57)));
    assert!(useful > 57, "{useful} of use");
}

/// Peaks of resident memory (bytes), summed over the ranks, as `run.json` reported them after two steps: shipped
/// cases, most with other cells, points and methods, so that each part of the estimate is the largest somewhere.
const MEASURED: &[(&str, &[&str], usize, f64)] = &[
    ("short/strip_footing", &[], 1, 54.2e6),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=3"],
        1,
        85.2e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=3", "solver.nonlinear=newton"],
        1,
        134.5e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=3", "stabilisation.method=none"],
        1,
        77.5e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=3", "solver.nonlinear=broyden"],
        1,
        84.7e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.1",
            "body.0.points_per_cell=3",
            "stabilisation.method=modified-f-bar",
        ],
        2,
        134.6e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=3"],
        2,
        139.6e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=3", "solver.nonlinear=newton"],
        2,
        252.2e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=3"],
        1,
        189.8e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=3", "solver.nonlinear=newton"],
        1,
        419.0e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=3",
            "solver.nonlinear=newton",
            "stabilisation.method=none",
        ],
        1,
        279.4e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=6", "solver.nonlinear=newton"],
        1,
        678.0e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=1", "solver.nonlinear=newton"],
        1,
        369.7e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=6"],
        1,
        402.0e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=2", "solver.nonlinear=newton"],
        2,
        722.1e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=2",
            "solver.nonlinear=newton",
            "solver.reproducible=false",
        ],
        2,
        514.2e6,
    ),
    ("slope_stability", &["grid.cell=0.25"], 1, 153.7e6),
    (
        "slope_stability",
        &["grid.cell=0.25", "solver.nonlinear=newton"],
        1,
        250.6e6,
    ),
    (
        "slope_foundation",
        &["grid.cell=0.25", "body.0.points_per_cell=3"],
        2,
        238.2e6,
    ),
    (
        "slope_foundation",
        &["grid.cell=0.25", "body.0.points_per_cell=3", "solver.linear=multigrid"],
        1,
        233.8e6,
    ),
    (
        "slope_foundation",
        &["grid.cell=0.25", "body.0.points_per_cell=3", "solver.linear=multigrid"],
        2,
        323.4e6,
    ),
    ("column_collapse", &[], 1, 155.8e6),
    ("column_collapse", &["grid.upper=[11,0.205]"], 1, 156.3e6),
    ("column_collapse", &["grid.upper=[11,0.205]"], 2, 209.1e6),
    ("column_collapse", &["solver.nonlinear=newton"], 1, 244.8e6),
    (
        "column_collapse",
        &["grid.degree=cubic", "body.0.points_per_cell=3"],
        1,
        118.0e6,
    ),
    (
        "column_collapse",
        &["grid.degree=linear", "body.0.points_per_cell=3"],
        1,
        78.1e6,
    ),
    (
        "column_collapse",
        &["grid.cell=1.25e-3", "body.0.points_per_cell=4"],
        2,
        348.1e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=2"],
        1,
        155.1e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=2", "solver.nonlinear=newton"],
        1,
        387.6e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=1",
            "stabilisation.method=none",
            "solver.nonlinear=broyden",
        ],
        1,
        125.8e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=6",
            "stabilisation.method=none",
        ],
        1,
        339.8e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=6",
            "stabilisation.method=none",
            "solver.nonlinear=newton",
        ],
        1,
        500.7e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=6",
            "stabilisation.method=f-bar",
        ],
        1,
        367.3e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=6",
            "stabilisation.method=modified-f-bar",
        ],
        1,
        369.6e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.025", "body.0.points_per_cell=2"],
        1,
        497.1e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.025", "body.0.points_per_cell=2", "solver.nonlinear=newton"],
        1,
        1597.6e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=2"],
        2,
        213.4e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=6"],
        2,
        459.6e6,
    ),
    ("slope_stability", &["grid.cell=0.25"], 2, 208.7e6),
    ("column_collapse", &[], 2, 208.3e6),
    ("column_collapse", &["solver.nonlinear=newton"], 2, 359.9e6),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=2",
            "solver.reproducible=false",
        ],
        2,
        214.1e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.05", "body.0.points_per_cell=2"],
        3,
        301.0e6,
    ),
    (
        "slope_foundation",
        &["grid.cell=0.25", "body.0.points_per_cell=6"],
        1,
        338.1e6,
    ),
    (
        "short/strip_footing",
        &[
            "grid.cell=0.05",
            "body.0.points_per_cell=4",
            "output.every_steps=100000",
        ],
        1,
        251.7e6,
    ),
    ("embankment_consolidation", &["grid.cell=0.5"], 1, 70.6e6),
    ("embankment_consolidation", &["grid.cell=0.25"], 1, 131.6e6),
    ("embankment_consolidation", &["grid.cell=0.25"], 2, 189.9e6),
    ("rapid_drawdown", &["grid.cell=0.5"], 1, 93.7e6),
    ("rapid_drawdown", &["grid.cell=0.5"], 2, 147.6e6),
    ("validation/undrained_strip", &["grid.cell=0.0625"], 1, 351.3e6),
    ("validation/undrained_strip", &["grid.cell=0.0625"], 2, 413.7e6),
    ("round_column", &[], 1, 126.1e6),
    ("round_column", &[], 2, 212.3e6),
    (
        "round_column",
        &["grid.cell=0.05", "solver.linear=\"direct\""],
        1,
        899.0e6,
    ),
    ("round_column", &["grid.cell=0.05"], 1, 638.4e6),
    ("round_column", &["grid.cell=0.05"], 2, 1303.3e6),
    (
        "round_column",
        &["grid.cell=0.0666666667", "solver.linear=\"direct\""],
        1,
        340.1e6,
    ),
    (
        "round_column",
        &["grid.cell=0.0666666667", "solver.linear=\"multigrid-cycles\""],
        1,
        339.7e6,
    ),
    ("round_column", &["grid.cell=0.04"], 1, 1223.2e6),
    ("round_column", &["grid.cell=0.04"], 2, 2414.3e6),
    (
        "round_column",
        &["grid.cell=0.04", "solver.linear=\"spline-multigrid\""],
        1,
        550.5e6,
    ),
    ("square_footing", &[], 1, 302.0e6),
    ("square_footing", &[], 2, 436.7e6),
    ("square_footing", &["grid.cell=0.125"], 1, 2798.5e6),
    ("square_footing", &["grid.cell=0.125"], 2, 3880.8e6),
    (
        "square_footing",
        &["grid.cell=0.125", "material.clay.poisson=0.3", "solver.linear=direct"],
        1,
        1308.2e6,
    ),
    (
        "square_footing",
        &["grid.cell=0.125", "material.clay.poisson=0.3", "solver.linear=direct"],
        2,
        1797.7e6,
    ),
    ("square_footing", &["solver.nonlinear=newton"], 1, 314.2e6),
    ("square_footing", &["material.clay.poisson=0.3"], 1, 165.7e6),
    (
        "square_footing",
        &["material.clay.poisson=0.3", "grid.cell=0.125"],
        1,
        1139.5e6,
    ),
    (
        "square_footing",
        &[
            "material.clay.poisson=0.3",
            "grid.cell=0.125",
            "solver.nonlinear=newton",
        ],
        1,
        1197.3e6,
    ),
];

/// The same by secants and, where they stalled, Newton's method: in solids in step 9 or 10 of 12.
const MEASURED_WITH_NEWTON: &[(&str, &[&str], usize, f64)] = &[
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=2", "analysis.steps=40"],
        1,
        157.9e6,
    ),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "body.0.points_per_cell=1"],
        1,
        142.1e6,
    ),
    (
        "round_column",
        &["grid.cell=0.0666666667", "solver.linear=\"multigrid-cycles\""],
        1,
        445.0e6,
    ),
    (
        "round_column",
        &[
            "grid.cell=0.0666666667",
            "solver.linear=\"multigrid-cycles\"",
            "solver.reproducible=false",
        ],
        2,
        798.0e6,
    ),
    (
        "round_column",
        &[
            "grid.cell=0.05",
            "solver.linear=\"multigrid-cycles\"",
            "solver.reproducible=false",
        ],
        2,
        1629.0e6,
    ),
    (
        "round_column",
        &["grid.cell=0.04", "solver.linear=\"multigrid-cycles\""],
        1,
        1823.5e6,
    ),
    (
        "round_column",
        &["grid.cell=0.05", "solver.linear=\"incomplete-cholesky\""],
        1,
        868.0e6,
    ),
    (
        "round_column",
        &["grid.cell=0.025", "solver.linear=\"incomplete-cholesky\""],
        2,
        11403.1e6,
    ),
];

#[test]
fn estimated_memory_is_near_what_runs_took() {
    let mut failed = Vec::new();
    let all = MEASURED
        .iter()
        .map(|row| (row, false))
        .chain(MEASURED_WITH_NEWTON.iter().map(|row| (row, true)));
    for ((name, set, ranks, peak), newton) in all {
        let overrides: Vec<String> = set.iter().map(ToString::to_string).collect();
        let text = load(&cases().join(name).with_extension("toml")).unwrap();
        let estimate = Case::from_bytes(name, &text, &overrides).unwrap().estimate(*ranks);
        let bytes = if newton {
            estimate.bytes_with_newton
        } else {
            estimate.bytes
        };
        let ratio = bytes as f64 / peak;
        let row = format!("{ratio:.2} of {:.1} MB: {name} {set:?} on {ranks}", peak / 1e6);
        println!("{row}");
        if !(0.8..1.5).contains(&ratio) {
            failed.push(row);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn the_slopes_of_the_paper() {
    for (name, points, area) in [("slope_stability", 7920, 220.0), ("slope_foundation", 21_600, 600.0)] {
        let case = read(&cases().join(name).with_extension("toml"));
        assert_eq!(
            (case.points(), case.bodies[0].area(), case.strength_reduction),
            (points, area, Some(1.3)),
            "{name}"
        );
        assert!((case.overburden([0.5, 5.0, 0.0]) - 20e3 * (case.bodies[0].bounds()[1][1] - 5.0)).abs() < 1e-6);
        assert!((case.histories[0].scale - 1e8 / (20e3 * 100.0)).abs() < 1e-12);
    }
    assert_eq!(read(&cases().join("short/slope_stability.toml")).points(), 1980);
}

#[test]
fn the_footing_of_the_paper() {
    for (name, points, ground) in [("strip_footing", 360_000, 10.0), ("short/strip_footing", 900, 5.0)] {
        let case = read(&cases().join(name).with_extension("toml"));
        let footing = case.footing.as_ref().unwrap();
        assert_eq!(
            (case.points(), footing.site.ends()),
            (points, Some([[0.0, ground], [1.0, ground]])),
            "{name}"
        );
        assert_eq!(
            (footing.base, &footing.path.rows[..]),
            (Base::Smooth, &[(1.0, [0.0, -2.0, 0.0])][..])
        );
        let within = Some([[0.0, ground - 2.5, 0.0], [2.5, ground - 0.5, 0.0]]);
        assert_eq!(
            case.histories[5].quantity,
            Quantity::new(
                Observable::PressureNoise,
                HistorySubject::Part(PointSelection {
                    within,
                    ..PointSelection::default()
                })
            )
        );
    }
}

#[test]
fn the_coarse_column_moves_its_free_top_outward() {
    let case = read(&cases().join("short/column_collapse.toml"));
    assert_eq!(
        case.grid.axes[1],
        GridAxis::Uniform {
            lower: 0.0,
            cell: 0.01,
            cells: 11
        }
    );
    let note = case.notes.iter().find(|note| note.key == "grid.upper.1").unwrap();
    assert!(note.reason.contains("outward"), "{note:?}");
    assert_eq!(case.points(), 800);
}

/// By unknowns, Poisson's ratio and what must repeat to the bit.
#[test]
fn the_linear_solver_of_a_solid_is_taken_by_size() {
    let text = load(&cases().join("round_column.toml")).unwrap();
    let on = |ranks: usize, set: &[&str]| {
        let overrides: Vec<String> = set.iter().map(ToString::to_string).collect();
        let case = Case::from_bytes("round_column", &text, &overrides).unwrap();
        case.solver.linear_on(ranks)
    };
    assert_eq!(on(1, &[]), LinearSolver::Direct);
    assert_eq!(on(2, &["grid.cell=0.05"]), LinearSolver::IncompleteCholesky);
    assert_eq!(
        on(1, &["grid.cell=0.05", "material.sand.poisson=0.49"]),
        LinearSolver::Direct
    );
    assert_eq!(
        on(1, &["grid.cell=0.05", "solver.linear=\"direct\""]),
        LinearSolver::Direct
    );
    assert_eq!(
        on(1, &["grid.cell=0.05", "strength_reduction.factor=1.2"]),
        LinearSolver::Direct
    );
    for (set, why) in [
        (vec![], "up to 10000 a direct solver is fastest"),
        (vec!["grid.cell=0.05", "strength_reduction.factor=1.2"], "near failure"),
    ] {
        let overrides: Vec<String> = set.iter().map(ToString::to_string).collect();
        let notes = Case::from_bytes("round_column", &text, &overrides).unwrap().notes;
        let reported: Vec<_> = notes
            .iter()
            .filter(|note| note.key.starts_with("solver.linear"))
            .collect();
        assert!(
            matches!(reported[..], [note] if note.value == "direct" && note.reason.contains(why)),
            "{reported:?}"
        );
    }
    let many = "grid.cell=0.025";
    assert_eq!(on(1, &[many]), LinearSolver::MultigridCycles);
    assert_eq!(on(2, &[many]), LinearSolver::IncompleteCholesky);
    assert_eq!(
        on(2, &[many, "solver.reproducible=false"]),
        LinearSolver::MultigridCycles
    );
    // Several ranks factorise what one has multigrid over the grid's splines for: memory and warning are theirs.
    let set = [many, "material.sand.poisson=0.49"];
    assert_eq!(
        (on(1, &set), on(2, &set)),
        (LinearSolver::SplineMultigrid, LinearSolver::Direct)
    );
    let case = Case::from_bytes("round_column", &text, &set.map(str::to_owned)).unwrap();
    let warned = |ranks| {
        case.warnings_on(ranks)
            .iter()
            .any(|warning| warning.starts_with("W0235"))
    };
    assert!(!warned(1) && warned(2));
    let named = [many, set[1], "solver.linear=\"direct\""].map(str::to_owned);
    let named = Case::from_bytes("round_column", &text, &named).unwrap();
    assert_eq!(case.estimate(2), named.estimate(2));
    assert!(
        case.estimate(2).bytes > 2 * case.estimate(1).bytes,
        "{:?}",
        case.estimate(2)
    );
}
