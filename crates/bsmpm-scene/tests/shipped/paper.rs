//! Tests that the cases of the paper have its dimensions.

use super::{cases, read};
use bsmpm_scene::observables::Observable;
use bsmpm_scene::{Base, GridAxis, HistorySubject, PointSelection, Quantity};

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
