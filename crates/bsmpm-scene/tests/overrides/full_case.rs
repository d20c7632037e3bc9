//! Tests that every key of the full case arrives in SI units.

use super::{FULL, valid};
use bsmpm::material::{Law, LayeredMaterial, Material, MohrCoulomb};
use bsmpm_scene::observables::{HistorySubject, Observable};
use bsmpm_scene::{Face, GridAxis, Made, PointSelection, Quantity, Support};

#[test]
fn the_full_case_in_si() {
    let case = valid(FULL, &[]);
    assert_eq!((case.analysis.end, case.analysis.dt), (1.0, 0.01));
    assert_eq!(
        case.grid.axes,
        [8, 6].map(|cells| GridAxis::Uniform {
            lower: 0.0,
            cell: 0.5,
            cells
        })
    );
    let names: Vec<&str> = case.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["sand", "clay", "block", "till"]);
    let LayeredMaterial::Uniform(Material::MohrCoulomb(sand)) = &case.materials[0].material else {
        panic!()
    };
    let whole = MohrCoulomb::new(sand.elastic().clone(), 30_f64.to_radians(), 5_f64.to_radians(), 1e3);
    assert!(sand.elastic().young == 2e7 && *sand == whole.reduced(1.25));
    let LayeredMaterial::Uniform(Material::MohrCoulomb(clay)) = &case.materials[1].material else {
        panic!()
    };
    assert_eq!(clay.parameters(), [0.0, 0.0, 1.6e4]);
    assert!(matches!(
        case.materials[2].material,
        LayeredMaterial::Uniform(Material::Hencky(_))
    ));
    assert_eq!(case.bodies[2].velocity, Some([0.0, -1.0, 0.0]));
    assert_eq!(
        case.boundary,
        [
            [Support::Roller, Support::Free],
            [Support::Fixed; 2],
            [Support::Free; 2]
        ]
    );
    assert_eq!(case.solver.background, 0.0);
    assert_eq!(case.output.times, [0.25, 0.75]);
    assert_eq!(
        case.histories[1].quantity,
        Quantity::new(
            Observable::Reaction,
            HistorySubject::Face(Face { axis: 1, upper: false })
        )
    );
    let columns: Vec<String> = case
        .histories
        .iter()
        .flat_map(|h| h.columns())
        .map(|c| c.name)
        .collect();
    let expected = [
        "runout",
        "floor-x",
        "floor-y",
        "stress-xx",
        "stress-yy",
        "stress-zz",
        "stress-xy",
        "footing-pressure",
        "pressure-noise-average",
        "pressure-noise-plane",
        "heave",
        "centre-of-mass-x",
        "centre-of-mass-y",
        "kinetic-energy",
        "section-forces-n",
        "section-forces-q",
        "section-forces-m",
        "velocity-x",
        "velocity-y",
        "rigid-force-x",
        "rigid-force-y",
    ];
    assert_eq!(columns, expected);
    assert_eq!(
        case.histories[6].quantity,
        Quantity::new(
            Observable::CentreOfMass,
            HistorySubject::Part(PointSelection {
                made: Made::Material(0),
                within: None
            })
        )
    );
    let within = Some([[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]]);
    assert_eq!(
        case.histories[4].quantity,
        Quantity::new(
            Observable::PressureNoise,
            HistorySubject::Part(PointSelection {
                made: Made::All,
                within
            })
        )
    );
    assert_eq!(
        (case.checks[0].at, case.checks[0].max, case.checks[1].at),
        (0.5, Some(4.0), 1.0)
    );
    let count = |code: &str| case.warnings.iter().filter(|warning| warning.starts_with(code)).count();
    let thin = count("W0413: rigid.");
    let placed = count("W0416: rigid.");
    let cut = case.warnings.iter().filter(|warning| warning.contains("W0428")).count();
    let coarse = case
        .warnings
        .iter()
        .filter(|warning| warning.contains("cells per wavelength"))
        .count();
    let approach = case
        .warnings
        .iter()
        .filter(|warning| warning.starts_with("W0229"))
        .count();
    let found = (case.warnings.len(), thin, placed, cut, coarse, approach);
    assert_eq!(found, (10, 2, 1, 2, 1, 1), "{:?}", case.warnings);
}
