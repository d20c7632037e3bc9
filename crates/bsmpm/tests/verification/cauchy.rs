//! Tests that the Cauchy stress remains on the yield surface during large plastic flow.

use crate::support::scene::{METHODS, Scene, axis};
use bsmpm::boundary::{Support, surface};
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::method::Criteria;
use bsmpm::model::{AverageWeight, Regime};
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

const COHESION: f64 = 1.0;

/// Clay, whose nu is 0.495, into which a smooth strip is pushed by half its half width, 1 m.
fn pressed(method: Stabilisation) -> Points<2> {
    let clay = MohrCoulomb::new(
        Elastic {
            young: 100.0,
            poisson: 0.495,
        },
        0.0,
        0.0,
        COHESION,
    );
    let axes = [axis(0.5, 8, 2), axis(0.5, 10, 2)];
    let mut scene = Scene::<PlaneStrain, 2>::new(axes, Material::MohrCoulomb(clay), Regime::QuasiStatic)
        .stabilised(method)
        .body([0..8, 0..6], 3, 1.0, |_| Vector::zeros())
        .rollers([0])
        .support(Support::fixed(1, false));
    scene.model.weighting = AverageWeight::Volume;
    scene.model.criteria = Criteria {
        energy: 1e-6,
        force: 1e-4,
        max_iterations: 1000,
    };
    let soft = ArtificialStiffness { coefficient: 1e-3 };
    scene = scene.artificial_stiffness(Some(soft));
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &[0.0, 3.0].into(), &[1.0, 3.0].into(), 4);
    let path = Path {
        rows: vec![(1.0, [0.0, -0.5].into())],
    };
    let strip = Strip {
        contact: None,
        points,
        normal: Some([0.0, 1.0].into()),
        transitions: Default::default(),
        path,
        penalty: 1e4 * 100.0 / 0.5,
    };
    scene.strip(strip).solved(1.0 / 40.0, 1.0).0.points
}

/// Largest shear stress over the cohesion, of sigma and of sigma J-bar/J, which is tau/J.
fn shear(points: &Points<2>) -> [f64; 2] {
    let largest = |p: usize| {
        let [xx, yy, _, xy, ..] = points.sigma.at(p).0; // zz lies between the others
        (0.25 * (xx - yy).powi(2) + xy * xy).sqrt() / COHESION
    };
    let of = |factor: &dyn Fn(usize) -> f64| (0..points.len()).map(|p| largest(p) * factor(p)).fold(0.0, f64::max);
    [of(&|_| 1.0), of(&|p| points.dilation_of(p))]
}

/// By the elastic dilation, 3 % of the cohesion in 30, at most.
#[test]
fn shear_stress_does_not_exceed_the_cohesion() {
    for method in METHODS.into_iter().filter(|method| method.averages()) {
        let [barred, own] = shear(&pressed(method));
        println!("{method:?}: {barred:.4} with J-bar, {own:.4} with J");
        assert!((0.99..=1.01).contains(&barred), "{method:?}: {barred}");
        assert!(own >= 1.05, "J drifts: {own}");
    }
}
