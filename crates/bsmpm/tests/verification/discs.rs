//! Tests of the rebound of two colliding elastic discs (Sulsky, Chen and Schreyer, 1994).

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::method::Criteria;
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;
use std::collections::HashSet;

const RADIUS: f64 = 0.2; // m
const SPEED: f64 = 0.1; // m/s along each axis
const CENTRES: [Vector<2>; 2] = [Vector::<2>::new(0.3, 0.3), Vector::<2>::new(0.7, 0.7)];
const CELLS: usize = 20;

/// Which disc a place belongs to.
fn side(x: &Vector<2>) -> usize {
    usize::from(x[0] + x[1] > CENTRES[0].sum() * 0.5 + CENTRES[1].sum() * 0.5)
}

/// Speed of the discs' centres away from each other after 3 s, relative to that towards each other before.
fn rebound(method: Stabilisation, steps: usize) -> f64 {
    let h = 1.0 / CELLS as f64;
    let speed = |x: &Vector<2>| Vector::repeat(if side(x) == 0 { SPEED } else { -SPEED });
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(h, CELLS, 2), axis(h, CELLS, 2)],
        hencky(1000.0, 0.3),
        Regime::Dynamic,
    )
    .body([1..CELLS - 1, 1..CELLS - 1], 2, 1000.0, speed)
    .cut(|x| CENTRES.iter().any(|centre| (x - centre).norm() <= RADIUS))
    .stabilised(method);
    scene.model.criteria = Criteria {
        energy: 1e-8,
        force: 1e-4,
        max_iterations: 200,
    };
    let of_first = scene
        .points
        .x
        .iter()
        .zip(&scene.points.id)
        .filter(|(x, _)| side(x) == 0)
        .map(|(_, &id)| id);
    let of_first: HashSet<u64> = of_first.collect();
    scene.march(3.0 / steps as f64, 3.0, |_, _| ());
    let points = &scene.points;
    let v = &points.motion.as_ref().expect("dynamic").v;
    let own: Vec<usize> = (0..points.len())
        .filter(|&p| of_first.contains(&points.id[p]))
        .collect();
    let momentum: f64 = own.iter().map(|&p| points.mass[p] * v[p].sum()).sum();
    let mass: f64 = own.iter().map(|&p| points.mass[p]).sum();
    -momentum / (mass * 2.0 * SPEED)
}

#[test]
fn discs_part_as_fast_with_short_steps_as_with_long_ones_unless_every_step_smooths() {
    // A prototype: none 0.85/0.89, f-bar 0.76/0.80, modified -0.02 (they stick), consistent 0.77/0.80.
    let [f_bar, consistent, modified] = [
        Stabilisation::FBar,
        Stabilisation::ConsistentFBar,
        Stabilisation::ModifiedFBar,
    ]
    .map(|method| {
        let found = [60, 240].map(|steps| rebound(method, steps));
        println!("{method:?}: {found:.3?}");
        found
    });
    assert!((consistent[0] - consistent[1]).abs() <= 0.05); // measured 0.799, 0.822
    assert!(
        consistent
            .iter()
            .zip(f_bar)
            .all(|(found, f_bar)| (found - f_bar).abs() <= 0.03)
    );
    assert!(modified[1] <= 0.1); // measured -0.036
}
