//! Tests that free-field sides move level ground like its soil column, and let scattered waves leave.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::energy::{EnergyAccounts, StoredEnergy};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::{Regime, Shaking};
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;
use nalgebra::Complex;
use std::f64::consts::PI;

const RHO: f64 = 2000.0;
const SOFT: f64 = 4e7;
const STIFF: f64 = 1e8;
const POISSON: f64 = 0.25;

/// Ground of `wide` cells of the edge `h`, m, 10 m deep, soft in its upper 6 m, that a pulse of 0.15 s of acceleration
/// along x, and of a part of it `along_y`, shakes at a base that is to be held; nothing at its sides yet.
fn ground(wide: usize, h: f64, fastest: f64, along_y: f64) -> Scene<PlaneStrain, 2> {
    let high = (10.0 / h).round() as usize;
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(h, wide, 2), axis(h, high + 1, 2)],
        hencky(SOFT, POISSON),
        Regime::Dynamic,
    )
    .body([0..wide, 0..high], 3, RHO, |_| Vector::zeros())
    .with(hencky(STIFF, POISSON), |x| x[1] < 4.0)
    .stabilised(Stabilisation::ConsistentFBar);
    (scene.model.criteria.force, scene.model.criteria.energy) = (1e-12, 1e-16);
    let pulse = |t: f64| {
        if t < 0.15 {
            fastest * (2.0 * PI * t / 0.15).sin()
        } else {
            0.0
        }
    };
    let rows = (1..=60)
        .map(|k| 0.0025 * f64::from(k))
        .map(|t| (t, [pulse(t), along_y * pulse(t)].into()));
    scene.model.shaking = Some(Shaking { rows: rows.collect() });
    scene
}

type Side = fn(usize, bool) -> Support<2>;

fn between(scene: Scene<PlaneStrain, 2>, side: Side) -> Scene<PlaneStrain, 2> {
    scene
        .support(side(0, false))
        .support(side(0, true))
        .support(Support::fixed(1, false))
}

/// Largest distance of a point of `all` from the point of the `column` at its height, and the largest displacement.
fn off(all: &Points<2>, column: &Points<2>) -> [f64; 2] {
    let mut most = [0.0_f64; 2];
    for p in 0..all.len() {
        let alike = (0..column.len())
            .find(|&q| (column.height(q) - all.height(p)).abs() < 1e-9)
            .expect("its height");
        most[0] = most[0].max((all.u[p] - column.u[alike]).norm());
        most[1] = most[1].max(all.u[p].norm());
    }
    most
}

/// Reference: the one-dimensional column of the free field.
#[test]
fn level_ground_moves_as_its_column_everywhere() {
    let mut follows = between(ground(6, 1.0, 1e-3, 0.5), Support::free_field);
    follows.model.balances_energy = true;
    let model = follows.model.clone();
    let halo = follows.halo();
    let mut books = EnergyAccounts::open(StoredEnergy::of(&model, &follows.points, 0.0, &halo));
    let mut worst = 0.0_f64;
    let mut largest = 0.0_f64;
    let mut columns = Vec::new();
    follows.march_watched(0.005, 0.3, |scene, accepted| {
        for column in &scene.state.columns {
            let [off, most] = off(&scene.points, &column.points);
            (worst, largest) = (worst.max(off), largest.max(most));
        }
        books.flows += accepted.report.energy.expect("it is balanced");
        columns.push(scene.state.columns[0].points.clone());
    });
    let closure = books.residual(StoredEnergy::of(&model, &follows.points, 0.0, &halo)) / books.flows.external;
    // 5.2e-7 and 2.9e-10.
    assert!(
        worst < 1e-6 * largest && closure.abs() < 1e-8,
        "{:e}, {closure:e}",
        worst / largest
    );
    for side in [Support::roller as Side, Support::absorbing] {
        let mut scene = between(ground(6, 1.0, 1e-3, 0.5), side);
        let mut k = 0;
        let mut worst = 0.0_f64;
        scene.march(0.005, 0.3, |points, _| {
            worst = worst.max(off(points, &columns[k])[0]);
            k += 1;
        });
        // 1.00 and 1.03.
        assert!(worst > 0.5 * largest, "{}", worst / largest);
    }
}

/// Amplification of the ground's motion at the surface of two layers with the retardation time `beta` at the circular
/// frequency `omega` (Kramer, 1996).
fn amplification(beta: f64, omega: f64) -> f64 {
    let modulus = |young: f64| Complex::new(1.0, omega * beta) * (young / (2.0 * (1.0 + POISSON)));
    let wave = |young: f64| (modulus(young) / RHO).sqrt();
    let [soft, stiff] = [SOFT, STIFF].map(wave);
    let upper = Complex::from(6.0 * omega) / soft;
    let lower = Complex::from(4.0 * omega) / stiff;
    // Of unit motion at the surface.
    (upper.cos() * lower.cos() - soft / stiff * upper.sin() * lower.sin())
        .norm()
        .recip()
}

/// Of a pulse, by the Fourier integrals of the surface's and the ground's acceleration until all is at rest: how far it
/// is off, at the fundamental frequency and beside it, in cells of `h`.
fn off_amplification(h: f64) -> [f64; 3] {
    const BETA: f64 = 0.015;
    let mut scene = between(ground(1, h, 1e-2, 0.0), Support::free_field);
    (scene.model.criteria.force, scene.model.criteria.energy) = (1e-6, 1e-8);
    scene.model.damping = vec![BETA, BETA];
    let shaking = scene.model.shaking.clone().expect("it shakes");
    let frequencies = [10.0, 17.8, 30.0];
    let mut sums = [[Complex::from(0.0); 2]; 3];
    scene.march(0.005 * h, 2.0, |points, accepted| {
        let top = (0..points.len())
            .max_by(|&p, &q| points.x[p][1].total_cmp(&points.x[q][1]))
            .expect("points");
        let ground = shaking.at(accepted.t)[0];
        let surface = points.motion.as_ref().expect("dynamic").a[top][0] + ground;
        for (sums, omega) in sums.iter_mut().zip(frequencies) {
            let turn = Complex::new(0.0, -omega * accepted.t).exp();
            sums[0] += turn * surface;
            sums[1] += turn * ground;
        }
    });
    std::array::from_fn(|k| (sums[k][0] / sums[k][1]).norm() / amplification(BETA, frequencies[k]) - 1.0)
}

/// Kramer (1996): transfer function of two layers on elastic rock.
#[test]
fn layers_amplify_as_waves_in_them_do() {
    let [coarse, fine] = [1.0, 0.5].map(off_amplification);
    for (k, [of_coarse, of_fine]) in [[0.002, 0.007], [0.025, 0.014], [0.05, 0.018]].into_iter().enumerate() {
        // 0.0013 and 0.0061, -0.0218 and -0.0122, 0.0444 and 0.0155.
        assert!(
            coarse[k].abs() < of_coarse && fine[k].abs() < of_fine,
            "{k}: {coarse:?}, {fine:?}"
        );
    }
}

/// Velocity of the surface's points within 5 m of the middle, step after step, of level ground of `wide` m with a
/// stiff block at the surface in its middle, 4 m wide and 3 m deep.
fn scattered(wide: usize, side: Side) -> Vec<Vec<Vector<2>>> {
    let middle = 0.5 * wide as f64;
    let mut scene = between(ground(wide, 1.0, 1e-2, 0.0), side);
    for p in 0..scene.points.len() {
        let x = scene.points.x[p];
        if (x[0] - middle).abs() < 2.0 && x[1] > 7.0 {
            scene.points.material[p] = 1;
        }
    }
    let mut seen = Vec::new();
    scene.march(0.005, 0.35, |points, _| {
        let at_top = |p: &usize| points.height(*p) > 9.7 && (points.x[*p][0] - points.u[*p][0] - middle).abs() < 5.0;
        let mut top: Vec<usize> = (0..points.len()).filter(at_top).collect();
        top.sort_by(|&p, &q| points.x[p][0].total_cmp(&points.x[q][0]));
        seen.push(
            top.iter()
                .map(|&p| points.motion.as_ref().expect("dynamic").v[p])
                .collect(),
        );
    });
    seen
}

/// Reference: the same block in ground so wide that no wave returns.
#[test]
fn what_a_block_scatters_leaves_through_the_sides() {
    let right = scattered(50, Support::free_field);
    let largest = right.iter().flatten().map(Vector::norm).fold(0.0, f64::max);
    let sides = [Support::roller as Side, Support::absorbing, Support::free_field];
    let wrong = sides.map(|side| {
        let found = scattered(12, side);
        let off = |(found, right): (&Vec<Vector<2>>, &Vec<Vector<2>>)| {
            found
                .iter()
                .zip(right)
                .map(|(found, right)| (found - right).norm())
                .fold(0.0, f64::max)
        };
        found.iter().zip(&right).map(off).fold(0.0, f64::max) / largest
    });
    // 1.68, 0.845, 0.0656.
    assert!(wrong[0] > 1.5 && wrong[1] > 0.7 && wrong[2] < 0.075, "{wrong:?}");
}
