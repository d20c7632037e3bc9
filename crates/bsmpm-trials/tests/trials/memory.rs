//! Tests that memory estimates agree with runs.

use crate::support::results::manifest;
use crate::support::{Scratch, shipped};
use bsmpm_scene::Case;

/// Shipped cases, large enough that not the libraries decide, by different parts of the estimate: points, cells,
/// Newton's system, and what every further rank repeats.
const RUNS: [(&str, &[&str], usize); 6] = [
    ("short/strip_footing", &[], 1),
    ("short/strip_footing", &["grid.cell=0.1"], 2),
    (
        "short/strip_footing",
        &["grid.cell=0.1", "solver.nonlinear=newton", "body.0.points_per_cell=2"],
        1,
    ),
    ("slope_stability", &["grid.cell=0.25", "body.0.points_per_cell=2"], 2),
    ("slope_foundation", &["body.0.points_per_cell=16"], 1),
    ("column_collapse", &["body.0.points_per_cell=4"], 1),
];

#[test]
fn f37_the_estimate_is_near_the_measured_peak() {
    let mut failed = Vec::new();
    for (name, set, ranks) in RUNS {
        let path = shipped(&format!("{name}.toml"));
        let overrides: Vec<String> = set.iter().map(ToString::to_string).collect();
        let case = Case::from_bytes(name, &bsmpm_scene::load(&path).unwrap(), &overrides).unwrap();
        let estimate = case.estimate(ranks).bytes as f64;
        let scratch = Scratch::new();
        let set = set.iter().flat_map(|set| ["--set", set]);
        let arguments = [path.to_str().unwrap(), "-q", "-o", "out", "--max-steps", "1"]
            .into_iter()
            .chain(set);
        scratch.mpirun(ranks, &arguments.collect::<Vec<_>>()).expect(75);
        let peaks = manifest(&scratch.path("out")).summary.peak_memory;
        assert_eq!(peaks.len(), ranks);
        let peak = peaks.iter().sum::<u64>() as f64;
        let ratio = estimate / peak;
        let row = format!(
            "{ratio:.2} = {:.1} / {:.1} MB: {name} {overrides:?} on {ranks}",
            estimate / 1e6,
            peak / 1e6
        );
        println!("{row}");
        if !(0.8..1.5).contains(&ratio) {
            failed.push(row);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
