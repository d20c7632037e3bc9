//! Tests that the energy balance closes.

use crate::support::results::history;
use crate::support::{Scratch, shipped};
use bsmpm_io::table::Columns;

const TIGHT: [&str; 4] = [
    "--set",
    "solver.tolerance=1e-14",
    "--set",
    "solver.force_tolerance=1e-10",
];

/// Histories of the first steps of a short case on 1 and 2 ranks.
fn both(name: &str, steps: &str, further: &[&str]) -> [Columns; 2] {
    let case = std::fs::read_to_string(shipped(name)).unwrap();
    let scratch = Scratch::with_case(&format!("{case}\n[[history]]\nquantity = \"energy\"\n"));
    [1, 2].map(|ranks| {
        let directory = format!("{ranks}.out");
        let own = ["case.toml", "-q", "-o", &directory, "--max-steps", steps];
        scratch
            .job(Some(ranks), &[&own, &TIGHT[..], further].concat())
            .within(240)
            .run()
            .expect(75);
        history(&scratch.path(&directory))
    })
}

/// Largest closure over the largest energy, after the columns were found to add up; and the largest difference
/// between the ranks over it.
fn closure(histories: &[Columns; 2]) -> (f64, f64) {
    let [column, other] = histories
        .each_ref()
        .map(|history| move |name: &str| history.get(name).unwrap());
    let names = history_names(&histories[0]);
    let largest = |name: &str| column(name).iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let scale = names.iter().map(|name| largest(name)).fold(0.0, f64::max);
    for row in 0..column("time").len() {
        let at = |part: &str| column(&format!("energy-{part}"))[row] - column(&format!("energy-{part}"))[0];
        let parts = ["transfer", "integration", "smoothing", "background", "penalty"];
        assert!((at("numerical") - parts.iter().map(|part| at(part)).sum::<f64>()).abs() <= 1e-14 * scale);
        let left = at("external") - at("kinetic") - at("elastic") - at("plastic") - at("numerical");
        assert!((left - at("closure")).abs() <= 1e-14 * scale, "row {row}");
    }
    let apart = |name: &String| {
        column(name)
            .iter()
            .zip(other(name))
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    let spread = names.iter().map(apart).fold(0.0, f64::max);
    (largest("energy-closure") / scale, spread / scale)
}

fn history_names(history: &Columns) -> Vec<String> {
    let names = history.headings.iter().map(|heading| heading.name.clone());
    let names: Vec<String> = names.filter(|name| name.starts_with("energy-")).collect();
    assert_eq!(names.len(), 11);
    names
}

#[test]
fn the_collapse_closes_with_and_without_numerical_damping_on_1_and_2_ranks() {
    for further in [
        &[][..],
        &["--set", "analysis.spectral_radius=0.8"],
        &["--set", "analysis.newmark_gamma=0.6"],
    ] {
        let histories = both("short/column_collapse.toml", "100", further);
        let (closure, spread) = closure(&histories);
        println!("{further:?}: closure {closure:.1e}, ranks differ by {spread:.1e}");
        assert!(closure <= 1e-8 && spread <= 1e-9); // measured 2e-11, 2e-12
        let last = |name: &str| *histories[0].get(name).unwrap().last().unwrap();
        assert!(last("energy-kinetic") > 0.0 && last("energy-plastic") > 0.0 && last("energy-smoothing") > 0.0);
    }
}

#[test]
fn the_footing_closes_on_1_and_2_ranks() {
    let histories = both("short/strip_footing.toml", "20", &[]);
    let (closure, spread) = closure(&histories);
    println!("closure {closure:.1e}, ranks differ by {spread:.1e}");
    assert!(closure <= 1e-8 && spread <= 1e-9); // measured 2e-11, 2e-12
    let last = |name: &str| *histories[0].get(name).unwrap().last().unwrap();
    assert!(last("energy-penalty") > 0.0 && last("energy-background") > 0.0 && last("energy-external") > 0.0);
    assert_eq!(last("energy-kinetic"), 0.0);
}
