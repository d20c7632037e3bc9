//! Tests of the influence of a rigid footing's penalty stiffness on the collapse pressure.

use crate::support::scene::{Scene, axis};
use bsmpm::boundary::{Support, surface};
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::method::Criteria;
use bsmpm::model::{AverageWeight, Regime};
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

const YOUNG: f64 = 100.0;
const CELL: f64 = 0.5;

/// Mean pressure under a strip of 1 m that has been pushed 0.4 m into half of a block of clay, 3 m x 2 m, with E/c =
/// 100.
fn pressure(factor: f64) -> f64 {
    let elastic = Elastic {
        young: YOUNG,
        poisson: 0.495,
    };
    let clay = Material::MohrCoulomb(MohrCoulomb::new(elastic, 0.0, 0.0, 1.0));
    let mut scene = Scene::<PlaneStrain, 2>::new([axis(CELL, 6, 2), axis(CELL, 6, 2)], clay, Regime::QuasiStatic)
        .body([0..6, 0..4], 3, 0.0, |x| x * 0.0)
        .rollers(0..1)
        .support(Support::fixed(1, false))
        .stabilised(Stabilisation::FBar);
    scene.model.weighting = AverageWeight::Volume;
    scene.model.criteria = Criteria {
        energy: 1e-10,
        force: 1e-6,
        max_iterations: 1000,
    };
    scene.model.artificial_stiffness = Some(ArtificialStiffness { coefficient: 1e-3 });
    let at = |x: f64, y: f64| Vector::<2>::new(x, y);
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &at(0.0, 2.0), &at(1.0, 2.0), 4);
    let path = Path {
        rows: vec![(1.0, at(0.0, -0.4))],
    };
    let mut scene = scene.strip(Strip {
        contact: None,
        points,
        normal: Some(at(0.0, 1.0)),
        transitions: Default::default(),
        path,
        penalty: factor * YOUNG / CELL,
    });
    let mut last = 0.0;
    scene.march(1.0 / 16.0, 1.0, |_, accepted| {
        last = -accepted.report.strips[0].force[1]
    });
    last.abs()
}

#[test]
fn what_the_pressure_feels_of_the_penalty_falls_with_it() {
    let [soft, firm, used, hard] = [1e2, 1e3, 1e4, 1e5].map(pressure);
    println!("p/c with penalties of 1e2, 1e3, 1e4, 1e5 E/h: {soft:.5} {firm:.5} {used:.5} {hard:.5}");
    assert!(hard > 5.14, "it has collapsed");
    // Measured 1.7e-3, 1.7e-4, 1.5e-5: the slip is pressure / penalty.
    for (pressure, factor) in [(soft, 1e2), (firm, 1e3), (used, 1e4)] {
        assert!((pressure / hard - 1.0).abs() <= 0.22 / factor, "{factor:e}");
    }
}
