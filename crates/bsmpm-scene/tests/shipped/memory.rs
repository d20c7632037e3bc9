//! Tests that estimated memory is near what runs took.

use super::cases;
use bsmpm_scene::{Case, load};

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
