//! Every case that the project ships is valid, and the paper's column has the sizes that it should.

use bsmpm_scene::{Axis, Base, Case, Quantity, load};
use std::path::{Path, PathBuf};

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

fn read(path: &Path) -> Case {
    let bytes = load(path).unwrap();
    let errors = |errors: Vec<bsmpm_scene::Error>| errors.iter().map(|e| format!("{e:#}\n")).collect::<String>();
    Case::from_bytes(&path.display().to_string(), &bytes, &[]).map_err(errors).unwrap_or_else(|text| panic!("{text}"))
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
                assert!(case.warnings.is_empty(), "{}: {:?}", path.display(), case.warnings);
                found += 1;
            }
        }
    }
    assert!(found >= 15);
}

#[test]
fn the_column_of_the_paper() {
    let case = read(&cases().join("column_collapse.toml"));
    let estimate = case.estimate();
    assert_eq!((estimate.cells, estimate.nodes, estimate.points), (220 * 41, 222 * 43, 115_200));
    let ratio = estimate.bytes_on(2) as f64 / 287e6; // the measured peak of both ranks
    assert!((0.8..1.5).contains(&ratio), "{ratio}");
    let short = read(&cases().join("short/column_collapse.toml")).estimate();
    let ratio = short.bytes_on(1) as f64 / 51e6;
    assert!((0.8..1.5).contains(&ratio), "{ratio}");
    let density = case.materials[0].density.unwrap();
    assert!((density - 20_400.0 / 9.81).abs() < 1e-10);
    assert_eq!(case.output.times, [0.109, 0.235, 0.3, 0.351, 0.42, 0.607]);
    assert_eq!(case.analysis.dt, 2.5e-4);
}

/// Peaks of resident memory, summed over the ranks, as `run.json` told them: the whole runs of the paper's column on two
/// ranks (138.1e6 + 148.9e6 bytes) and of the coarse one on one, and ten steps of the paper's column with other values.
#[test]
fn estimated_memory_is_near_what_runs_took() {
    let measured: [(&str, &[&str], usize, f64); 9] = [
        ("column_collapse", &[], 2, 287.0e6),
        ("short/column_collapse", &[], 1, 51.7e6),
        ("column_collapse", &[], 1, 182.5e6),
        ("column_collapse", &["solver.reproducible=false"], 2, 247.8e6),
        ("column_collapse", &["body.0.points_per_cell=1"], 1, 94.1e6),
        ("column_collapse", &["body.0.points_per_cell=3"], 1, 111.5e6),
        ("column_collapse", &["body.0.points_per_cell=2", "grid.cell=0.05"], 1, 47.8e6),
        ("column_collapse", &["body.0.points_per_cell=2", "grid.cell=1.25e-3"], 1, 277.0e6),
        // Four times as many empty cells.
        ("column_collapse", &["body.0.points_per_cell=2", "grid.upper=[2.2, 0.1025]"], 1, 149.8e6),
    ];
    for (name, set, ranks, peak) in measured {
        let overrides: Vec<String> = set.iter().map(ToString::to_string).collect();
        let text = load(&cases().join(name).with_extension("toml")).unwrap();
        let estimate = Case::from_bytes(name, &text, &overrides).unwrap().estimate();
        let ratio = estimate.bytes_on(ranks) as f64 / peak;
        println!("{name} {set:?} on {ranks}: {ratio:.3} of {peak:.4e}");
        assert!((0.85..1.1).contains(&ratio), "{name} {set:?}: {ratio} of {peak}, {estimate:?}");
    }
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
        assert!((case.overburden([0.5, 5.0]) - 20e3 * (case.bodies[0].bounds()[1][1] - 5.0)).abs() < 1e-6);
        assert!((case.histories[0].scale - 1e8 / (20e3 * 100.0)).abs() < 1e-12);
    }
    assert_eq!(read(&cases().join("short/slope_stability.toml")).points(), 1980);
}

#[test]
fn the_footing_of_the_paper() {
    for (name, points, ground) in [("strip_footing", 360_000, 10.0), ("short/strip_footing", 900, 5.0)] {
        let case = read(&cases().join(name).with_extension("toml"));
        let footing = case.footing.as_ref().unwrap();
        assert_eq!((case.points(), footing.from, footing.to), (points, [0.0, ground], [1.0, ground]), "{name}");
        assert_eq!((footing.base, &footing.path.rows[..]), (Base::Smooth, &[(1.0, [0.0, -2.0])][..]));
        let within = Some([[0.0, ground - 2.5], [2.5, ground - 0.5]]);
        assert_eq!(case.histories[5].quantity, Quantity::PressureNoise { within });
    }
}

#[test]
fn the_coarse_column_moves_its_free_top_outward() {
    let case = read(&cases().join("short/column_collapse.toml"));
    assert_eq!(case.grid.axes[1], Axis::Uniform { lower: 0.0, cell: 0.01, cells: 11 });
    let note = case.notes.iter().find(|note| note.key == "grid.upper.1").unwrap();
    assert!(note.reason.contains("outward"), "{note:?}");
    assert_eq!(case.points(), 800);
}
