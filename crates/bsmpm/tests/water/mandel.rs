//! A block pressed by a rigid plate, drained at its sides: the pressure in the middle grows before it falls (Mandel,
//! 1953; Cheng and Detournay, 1988). Its settlement is given, what it takes is found.

use super::{Plane, WEIGHT, at, flowing, geometric};
use crate::support::scene::{axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::model::Regime;
use bsmpm::water::flow::{DrainedFace, Given, PermeabilityLaw};

const NU: f64 = 0.2;
const E: f64 = 1e6;
/// p(0)/p0 of nu = .2
const TABLE: [(f64, f64); 4] = [(0.05, 1.098883), (0.1, 1.095414), (0.2, 0.968114), (0.5, 0.592785)];

/// Roots of tan(al)/al = 2 (1 - nu)/(1 - 2 nu).
fn roots(count: usize) -> Vec<f64> {
    use std::f64::consts::PI;
    let ratio = 2.0 * (1.0 - NU) / (1.0 - 2.0 * NU);
    let root = |k: usize| {
        let (mut low, mut high) = (k as f64 * PI + 1e-9, (k as f64 + 0.5) * PI - 1e-12);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if middle.tan() < ratio * middle { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    (0..count).map(root).collect()
}

/// `cells` of the half width of 1 m by 4, between rollers and a plate, drained at the far side.
fn block(cells: usize) -> Plane {
    let M = E * (1.0 - NU) / ((1.0 + NU) * (1.0 - 2.0 * NU));
    let h = 1.0 / cells as f64;
    let mut scene = Plane::new([axis(h, cells, 2), axis(h, 4, 2)], hencky(E, NU), Regime::QuasiStatic)
        .body([0..cells, 0..4], 3, 1.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(Support::roller(1, false))
        .support(Support::roller(1, true));
    let mut water = flowing(PermeabilityLaw::Constant);
    let flow = water.flow.as_mut().expect("it flows");
    flow.faces.push(DrainedFace { axis: 0, upper: true, given: Given::StillWater });
    flow.soils[0].as_mut().and_then(|soil| soil.permeability.as_mut()).expect("a soil").along =
        at(1.0, 1.0) * (WEIGHT / M);
    scene.model.water = Some(water);
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-10, 1e-8);
    scene
}

#[test]
fn the_pressure_in_the_middle_rises_before_it_falls() {
    let (cells, stress) = (16_usize, 1e-5 * E);
    let shear = E / (2.0 * (1.0 + NU));
    let roots = roots(400);
    let settled = |t: f64| {
        let term = |al: &f64| al.sin() * al.cos() / (al - al.sin() * al.cos()) * (-al * al * t).exp();
        stress * (1.0 - NU) / (2.0 * shear) - stress / (2.0 * shear) * roots.iter().map(term).sum::<f64>()
    };
    let mut scene = block(cells);
    let mut times = geometric(1e-4, 0.5, 150);
    times.extend(TABLE.map(|row| row.0));
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let (mut worst, mut before, mut t) = ([0.0_f64; 2], 0.0, 0.0);
    for next in times {
        // The height is a quarter of the width's half.
        let plate = settled(next) * 4.0 / cells as f64;
        let one = run_one(&mut scene, (t, next), (plate - before) / (next - t));
        (before, t) = (plate, next);
        let Some((_, expected)) = TABLE.iter().find(|row| (row.0 - next).abs() < 1e-9) else { continue };
        let off = [one[0] / (0.5 * stress) - expected, one[1] / stress - 1.0];
        println!("T {next}: p(0)/p0 {:.5} ({expected}), stress {:.5}", one[0] / (0.5 * stress), one[1] / stress);
        worst = [0, 1].map(|k: usize| worst[k].max(off[k].abs()));
    }
    println!("off by {worst:.5?}");
    assert!(worst[0] < 0.01 && worst[1] < 0.01);
}

/// One step with the plate at a velocity: the pressure in the middle, and the mean stress below the plate, Pa.
fn run_one(scene: &mut Plane, (from, to): (f64, f64), velocity: f64) -> [f64; 2] {
    scene.model.boundary.supports[2].velocity[1] = Some(-velocity);
    let mut found = [0.0; 2];
    super::run_from(scene, from, [to], |_, points, report| {
        let middle = |a: &usize, b: &usize| points.x[*a].norm().total_cmp(&points.x[*b].norm());
        let p = (0..points.len()).min_by(middle).expect("points");
        found = [points.pore_pressure.as_ref().expect("water flows")[p], report.reactions[2][1].abs()];
    });
    found
}

#[test]
fn threads_change_no_bit() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut scene = block(6);
            for k in 0..3 {
                run_one(&mut scene, (f64::from(k), f64::from(k + 1)), 1e-6);
            }
            scene.points
        })
    };
    let (one, three) = (of(1), of(3));
    assert!(one.pore_pressure.iter().flatten().any(|p| *p > 0.0) && one == three);
}
