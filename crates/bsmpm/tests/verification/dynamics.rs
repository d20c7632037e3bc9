//! Conservation and limits of the dynamic regime.

use crate::support::scene::{METHODS, Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::observe;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

/// Two blocks that fly into each other; largest drift of the momentum relative to sum m |v|, and largest |sigma| / E.
fn collision<K: Kinematics<D>, const D: usize>(method: Stabilisation, steps: usize) -> (f64, f64) {
    let axes = std::array::from_fn(|k| axis(0.5, if k == 0 { 12 } else { 6 }, 2));
    let velocity = |x: &Vector<D>| Vector::from_fn(|k, _| if x[0] < 3.0 { 0.5 } else { -0.3 } * 0.5_f64.powi(k as i32));
    let left = std::array::from_fn(|k| if k == 0 { 2..5 } else { 2..4 });
    let right = std::array::from_fn(|k| if k == 0 { 6..9 } else { 2..5 });
    let mut scene = Scene::<K, D>::new(axes, hencky(100.0, 0.3), Regime::Dynamic)
        .body(left, 2, 1.0, velocity)
        .body(right, 2, 2.0, velocity)
        .stabilised(method);
    let halo = scene.halo();
    let start = observe::momentum(&scene.points, &halo);
    let v = &scene.points.motion.as_ref().unwrap().v;
    let scale: f64 = v.iter().zip(&scene.points.mass).map(|(v, m)| m * v.norm()).sum();
    let (mut drift, mut stress) = (0.0_f64, 0.0_f64);
    scene.march(1.0 / steps as f64, 1.0, |points, _| {
        drift = drift.max((observe::momentum(points, &halo) - start).norm() / scale);
        stress = points.sigma.iter().flat_map(|s| s.0).fold(stress, |most, s| most.max(s.abs() / 100.0));
    });
    (drift, stress)
}

#[test]
fn momentum_of_two_colliding_bodies_does_not_drift() {
    for method in METHODS {
        let (drift, stress) = collision::<PlaneStrain, 2>(method, 100);
        println!("{method:?}: drift {drift:.1e}, stress up to {stress:.2e} E");
        assert!(drift <= 1e-14); // measured 7e-16
        assert!(stress >= 1e-3); // they have met
    }
    let (drift, stress) = collision::<Solid, 3>(Stabilisation::None, 4);
    println!("solid: drift {drift:.1e}, stress up to {stress:.2e} E");
    assert!(drift <= 1e-14); // measured 4e-16
}

/// A block on a fixed base beside a wall, which settles.
fn settling(regime: Regime) -> Scene<PlaneStrain, 2> {
    Scene::new([axis(0.5, 5, 2), axis(0.5, 4, 2)], hencky(100.0, 0.3), regime)
        .body([0..3, 0..3], 3, 1.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(Support::fixed(1, false))
        .gravity(2.0, 0.0)
}

#[test]
fn a_dynamic_step_of_huge_length_is_the_static_solution() {
    for method in METHODS {
        let still = settling(Regime::QuasiStatic).stabilised(method).solved(1.0, 1.0).0;
        for (dt, bound) in [(1e3, 1e-6), (1e6, 1e-11)] {
            let (found, _) = settling(Regime::Dynamic).stabilised(method).solved(dt, dt);
            let difference = still.points.u.iter().zip(&found.points.u).map(|(a, b)| (a - b).norm());
            let scale = still.points.u.iter().map(|u| u.norm()).fold(0.0, f64::max);
            let difference = difference.fold(0.0, f64::max) / scale;
            println!("{method:?}, dt {dt:e}: difference {difference:.1e}");
            assert!(difference <= bound); // measured 4e-8, 3e-13
        }
    }
}

#[test]
fn a_quasi_static_scene_without_load_needs_no_iteration_and_stays_as_it_is() {
    // Extreme N23.
    for method in METHODS {
        let mut scene = settling(Regime::QuasiStatic).stabilised(method);
        scene.model.gravity = None;
        let before = scene.points.clone();
        let (scene, steps) = scene.solved(1.0, 3.0);
        assert!(steps.iter().all(|step| step.report.iterations == 0));
        assert_eq!(scene.points.x, before.x);
        let finite = |s: &[f64; 6]| s.iter().all(|s| s.abs() <= 1e-13);
        assert!(scene.points.sigma.iter().all(|sigma| finite(&sigma.0)));
    }
}
