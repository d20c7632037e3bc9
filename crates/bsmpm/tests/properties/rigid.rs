//! Tests of motion without deformation: free flight across cells, and rigid rotation.

use crate::support::scene::{METHODS, Scene, axis, hencky};
use crate::support::solver::Skyline;
use bsmpm::control::Stepper;
use bsmpm::grid::Shape;
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::schedule::Schedule;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::trial::DeformationIncrement;
use bsmpm::tensor::{Square, Symmetric, Vector};
use nalgebra::Rotation2;

/// Young's modulus (Pa) of what flies: so soft that the round-off floor of the force, below which a step is accepted
/// without an iteration, 1e-13 E h^(D-1) sqrt(n), changes v by less than 1e-12. With 100 Pa it allows 6e-12.
const SOFT: f64 = 1.0;

/// Flies a block of 3^D cells through a longer grid; worst change of velocity per step and largest |sigma| / E.
fn flight<K: Kinematics<D>, const D: usize>(order: usize, method: Stabilisation, steps: usize) -> (f64, f64) {
    let axes = std::array::from_fn(|k| axis(0.1, if k == 0 { 12 } else { 6 }, order));
    let velocity = Vector::<D>::from_fn(|k, _| if k == 0 { 1.0 } else { 0.37 });
    let mut scene = Scene::<K, D>::new(axes, hencky(SOFT, 0.3), Regime::Dynamic)
        .body(std::array::from_fn(|_| 1..4), 2, 1.0, |_| velocity)
        .stabilised(method);
    let dt = 0.4 / steps as f64;
    let mut change = 0.0_f64;
    let mut stress = 0.0_f64;
    let mut last = vec![velocity; scene.points.len()];
    scene.march(dt, 0.4, |points, _| {
        let v = &points.motion.as_ref().unwrap().v;
        for (id, v) in points.id.iter().map(|&id| id as usize).zip(v) {
            change = change.max((v - last[id]).amax());
            last[id] = *v;
        }
        stress = points
            .sigma
            .iter()
            .flat_map(|sigma| sigma.0)
            .fold(stress, |most, s| most.max(s.abs() / SOFT));
    });
    let travelled = scene
        .points
        .u
        .iter()
        .map(|u| (u - velocity * 0.4).amax())
        .fold(0.0, f64::max);
    println!("travelled to {travelled:.1e} m");
    assert!(travelled <= 2e-13); // measured 4.7e-15, solid 2.7e-14
    (change, stress)
}

#[test]
fn free_flight_across_cells_keeps_velocity_and_no_stress() {
    // Extreme N16: velocity change <= 1e-12 per step, stress <= 1e-10 E.
    for method in METHODS {
        for order in 1..=3 {
            let (change, stress) = flight::<PlaneStrain, 2>(order, method, 50);
            println!("{method:?}, q = {order}: change of v {change:.1e}, stress {stress:.1e} E");
            assert!(change <= 2e-13 && stress <= 4e-13); // measured <= 2.8e-14, 3.9e-14
        }
    }
    let (change, stress) = flight::<Solid, 3>(2, Stabilisation::ModifiedFBar, 10);
    println!("solid: change of v {change:.1e}, stress {stress:.1e} E");
    assert!(change <= 1e-12 && stress <= 1e-12); // measured 2.8e-13, 1.4e-13
}

/// A free block of 3 x 3 cells with velocity `v`.
fn free_block(v: Vector<2>) -> Scene<PlaneStrain, 2> {
    Scene::new([axis(0.1, 8, 2), axis(0.1, 8, 2)], hencky(100.0, 0.3), Regime::Dynamic).body(
        [1..4, 4..7],
        2,
        1.0,
        |_| v,
    )
}

#[test]
fn the_guess_is_scaled_to_the_step_so_that_free_flight_needs_no_iteration_after_the_first() {
    let mut scene = free_block(Vector::from([1.0, -0.5]));
    let halo = scene.halo();
    let schedule = Schedule::new(0.005, 0.02, [0.012, 0.013]);
    let mut solver = Skyline::new(&scene.model.grid);
    let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
    let mut iterations = Vec::new();
    while let Some(step) = scene.advance(&mut stepper, &schedule, &halo, &mut solver) {
        iterations.push(step.unwrap().report.iterations);
        scene.points.sort_by_cell(&scene.model.grid);
    }
    // Within its cells: a node that the body has just reached has no guess.
    assert_eq!(iterations, [1, 0, 0, 0, 0, 0]);
}

#[test]
fn free_fall_gains_g_dt_a_step_from_the_first_one_on() {
    for method in METHODS {
        let mut scene = free_block(Vector::zeros()).gravity(2.0, 0.0).stabilised(method);
        let mut worst = 0.0_f64;
        scene.march(0.01, 0.3, |points, accepted| {
            let expected = Vector::from([0.0, -2.0 * accepted.t]);
            let v = &points.motion.as_ref().unwrap().v;
            worst = v.iter().map(|v| (v - expected).amax()).fold(worst, f64::max);
        });
        println!("{method:?}: velocity to {worst:.1e} m/s");
        assert!(worst <= 1e-11); // measured 8.3e-13
    }
}

#[test]
fn a_rigidly_rotating_field_turns_the_stress_of_every_point() {
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(0.5, 4, 2), axis(0.5, 4, 2)],
        hencky(100.0, 0.3),
        Regime::QuasiStatic,
    )
    .body([1..3, 1..3], 3, 1.0, |_| Vector::zeros())
    .stabilised(Stabilisation::SubgridFBar); // reaches farthest
    let b_e = Symmetric([1.2, 0.9, 1.05, 0.1, 0.0, 0.0]);
    scene.points.b_e.fill(b_e);
    let R = *Rotation2::new(0.8).matrix();
    let u = field(&scene, &(R - Square::identity()));
    let mut worst = 0.0_f64;
    for method in METHODS {
        scene.model.stabilisation = method;
        let points = &scene.points;
        let halo = scene.halo();
        let shape = Shape::at(&scene.model.grid, points).unwrap();
        let nodes = scene.nodes(&shape, 1.0);
        let trial = DeformationIncrement::of(&scene.model, &shape, &nodes, points, &u, &halo);
        let before = scene.model.materials[0].at(0.0).respond(&b_e, &[]).unwrap();
        for p in 0..points.len() {
            let after = trial.respond(&scene.model, points, p).unwrap();
            for (x, y) in before.principal_tau().iter().zip(after.principal_tau()) {
                worst = worst.max((x - y).abs() / 100.0);
            }
            let turned = R * before.tau().full().fixed_view::<2, 2>(0, 0) * R.transpose();
            worst = worst.max((after.tau().full().fixed_view::<2, 2>(0, 0) - turned).amax() / 100.0);
        }
    }
    println!("stress to {worst:.1e} E");
    assert!(worst <= 1e-14); // measured 5.3e-16
}

/// Nodal values of the linear field H x, at the Greville abscissae.
fn field(scene: &Scene<PlaneStrain, 2>, H: &Square<2>) -> Vec<f64> {
    let grid = &scene.model.grid;
    let along = |k: usize, i: usize| 0.5 * (grid.axes()[k].knot(i + 1) + grid.axes()[k].knot(i + 2));
    let at = |node: usize| {
        let [i, j] = grid.node_at(node);
        Vector::<2>::new(along(0, i), along(1, j))
    };
    (0..grid.nodes())
        .flat_map(|node| <[f64; 2]>::from(H * at(node)))
        .collect()
}
