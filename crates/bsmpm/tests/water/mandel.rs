//! Tests of Mandel's problem: consolidation below a loaded rigid plate, drained at the sides (Mandel, 1953; Cheng and
//! Detournay, 1988).

use super::{Plane, WEIGHT, at, flowing, geometric};
use crate::support::scene::{axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::field::pore_water::flow::{DrainedFace, Given, PermeabilityLaw};
use bsmpm::model::Regime;

const E: f64 = 1e6;
/// Pa  what the plate presses with
const LOAD: f64 = 1e-5 * E;
const TIMES: [f64; 6] = [0.01, 0.05, 0.1, 0.2, 0.5, 1.0];
/// nu, p(0)/p0 at these times, and the plate's way over s0 b/M, of the series.
const TABLE: [(f64, [f64; 6], [f64; 6]); 3] = [
    (
        0.0,
        [1.059016, 1.136520, 1.151791, 1.049272, 0.702735, 0.356285],
        [0.529508, 0.569896, 0.603365, 0.655923, 0.771324, 0.884064],
    ),
    (
        0.2,
        [1.043761, 1.098883, 1.095414, 0.968114, 0.592785, 0.258844],
        [0.695841, 0.734746, 0.766155, 0.814079, 0.913227, 0.999668],
    ),
    (
        0.3,
        [1.033074, 1.073166, 1.057660, 0.915512, 0.527240, 0.207872],
        [0.903939, 0.941829, 0.971865, 1.016794, 1.106062, 1.178108],
    ),
];

/// Pa  stiffness in one direction
fn modulus(nu: f64) -> f64 {
    E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
}

/// `cells` of the half width of 1 m by 4, between rollers and a plate, drained at the far side.
fn block(cells: usize, nu: f64) -> Plane {
    let h = 1.0 / cells as f64;
    let mut scene = Plane::new([axis(h, cells, 2), axis(h, 4, 2)], hencky(E, nu), Regime::QuasiStatic)
        .body([0..cells, 0..4], 3, 1.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(Support::roller(1, false))
        .support(Support::roller(1, true));
    let mut water = flowing(PermeabilityLaw::Constant);
    let flow = water.flow.as_mut().expect("it flows");
    flow.faces.push(DrainedFace {
        axis: 0,
        upper: true,
        given: Given::StillWater,
        acts: true,
    });
    flow.soils[0]
        .as_mut()
        .and_then(|soil| soil.permeability.as_mut())
        .expect("a soil")
        .along = at(1.0, 1.0) * (WEIGHT / modulus(nu));
    scene.model.water = Some(water);
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-10, 1e-8);
    scene
}

/// Mandel (1953), Cheng and Detournay (1988): consolidation of a block between two plates.
#[test]
fn the_pressure_in_the_middle_rises_before_it_falls_and_the_plate_sinks() {
    let cells = 16;
    let mut times = geometric(1e-4, 1.0, 250);
    times.extend(TIMES);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let mut worst = [0.0_f64; 2];
    for (nu, pressure, way) in TABLE {
        let mut scene = block(cells, nu);
        let mut t = 0.0;
        let mut velocity = 0.0;
        let mut sunk = 0.0;
        for &next in &times {
            velocity = under(&scene, (t, next), velocity);
            let [middle, _] = run_one(&mut scene, t, next, velocity);
            sunk += velocity * (next - t);
            t = next;
            let Some(row) = TIMES.iter().position(|time| (time - next).abs() < 1e-9) else {
                continue;
            };
            // The height is four cells.
            let found = [middle / (0.5 * LOAD), sunk * modulus(nu) / LOAD * cells as f64 / 4.0];
            println!(
                "nu {nu}, T {next}: p(0)/p0 {:.5} ({}), way {:.5} ({})",
                found[0], pressure[row], found[1], way[row]
            );
            worst[0] = worst[0].max((found[0] - pressure[row]).abs());
            worst[1] = worst[1].max((found[1] / way[row] - 1.0).abs());
        }
    }
    println!("off by {worst:.5?}");
    assert!(worst[0] < 0.01 && worst[1] < 0.003);
}

/// The velocity of the plate with which it takes its load in a step: the problem is linear, so that two trials tell.
fn under(scene: &Plane, step: (f64, f64), guess: f64) -> f64 {
    let tried = [guess, guess + LOAD / (E * (step.1 - step.0))];
    let [one, two] = tried.map(|velocity| run_one(&mut scene.clone(), step.0, step.1, velocity)[1]);
    tried[0] + (LOAD - one) / (two - one) * (tried[1] - tried[0])
}

/// One step with the plate at a velocity: the pressure in the middle, and the mean stress below the plate, Pa.
fn run_one(scene: &mut Plane, from: f64, to: f64, velocity: f64) -> [f64; 2] {
    scene.model.boundary.supports[2].velocity[1] = Some(-velocity);
    let mut found = [0.0; 2];
    super::run_from(scene, from, [to], |_, points, report| {
        let middle = |a: &usize, b: &usize| points.x[*a].norm().total_cmp(&points.x[*b].norm());
        let p = (0..points.len()).min_by(middle).expect("points");
        found = [
            points.pore_pressure.as_ref().expect("water flows")[p],
            -report.reactions[2][1],
        ];
    });
    found
}

#[test]
fn threads_change_no_bit() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            let mut scene = block(6, 0.2);
            for k in 0..3 {
                run_one(&mut scene, f64::from(k), f64::from(k + 1), 1e-6);
            }
            scene.points
        })
    };
    let one = of(1);
    let three = of(3);
    assert!(one.pore_pressure.iter().flatten().any(|p| *p > 0.0) && one == three);
}
