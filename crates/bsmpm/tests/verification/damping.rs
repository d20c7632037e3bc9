//! Tests of numerical damping against its theory, and of Kelvin-Voigt damping of vibrating, rotating and flowing
//! bodies.

use super::bar::{CELLS, PERIOD, bar};
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::{Support, SurfacePoint};
use bsmpm::dynamics::newmark::Newmark;
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::method::Nonlinear;
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;
use nalgebra::Matrix3;
use std::collections::BTreeMap;
use std::f64::consts::PI;

const SPEED: f64 = 1e-7; // m/s, so that the block moves next to nothing over the grid
const OMEGA: f64 = 2.0 * PI;

/// Parameters (alpha, beta, gamma) as published, apart from the code's.
#[derive(Clone, Copy, Debug)]
enum Scheme {
    Bossak(f64),
    Gamma(f64),
}

impl Scheme {
    fn parameters(self) -> (f64, f64, f64) {
        match self {
            Self::Bossak(rho) => {
                let alpha = (rho - 1.0) / (rho + 1.0);
                (alpha, (1.0 - alpha) * (1.0 - alpha) / 4.0, 0.5 - alpha)
            }
            Self::Gamma(gamma) => (0.0, (gamma + 0.5) * (gamma + 0.5) / 4.0, gamma),
        }
    }

    fn newmark(self) -> Newmark {
        match self {
            Self::Bossak(rho) => Newmark::of_spectral_radius(rho),
            Self::Gamma(gamma) => Newmark::of_gamma(gamma),
        }
    }

    /// Amplification of (d, v dt, a dt^2) in a step of the length `turn` / omega, where of the points' v and a the part
    /// `kept` reaches the nodes: 1 - (q+1) k^2 h^2 / 12 of a mode of the wave number k (T3.5), 1 of a uniform
    /// one.
    fn amplification(self, turn: f64, kept: f64) -> Matrix3<f64> {
        let (alpha, beta, gamma) = self.parameters();
        let end = Matrix3::new(1.0, -beta, 0.0, 0.0, -gamma, 1.0, turn * turn, 1.0 - alpha, 0.0);
        // Columns of `end`: d', a', v'.
        let start = Matrix3::new(
            1.0,
            kept,
            (0.5 - beta) * kept,
            0.0,
            1.0,
            1.0 - gamma,
            0.0,
            0.0,
            -alpha * kept,
        );
        let found = end.try_inverse().expect("regular") * start;
        Matrix3::from_rows(&[
            found.row(0).into_owned(),
            found.row(2).into_owned(),
            found.row(1).into_owned(),
        ])
    }

    /// Spectral radius, and angle of the largest pair of eigenvalues.
    fn spectrum(self, turn: f64, kept: f64) -> (f64, f64) {
        let eigenvalues = self.amplification(turn, kept).complex_eigenvalues();
        let largest = eigenvalues
            .iter()
            .copied()
            .max_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()))
            .expect("three");
        (largest.norm(), largest.arg().abs())
    }
}

/// A block that flies freely, and a strip at its own points which holds it like a spring: with the area of a point its
/// volume, every node is pulled in proportion to its mass, and the whole is one degree of freedom, omega^2 = penalty.
fn oscillator(scheme: Scheme) -> Scene<PlaneStrain, 2> {
    let mut scene = Scene::new([axis(1.0, 4, 2), axis(1.0, 4, 2)], hencky(1e-6, 0.0), Regime::Dynamic).body(
        [1..3, 1..3],
        2,
        1.0,
        |_| [SPEED, 0.0].into(),
    );
    let points = (0..scene.points.len()).map(|p| SurfacePoint::at(scene.points.x[p], scene.points.volume[p]));
    let still = Path {
        rows: vec![(1e9, Vector::zeros())],
    };
    scene.model.newmark = scheme.newmark();
    scene.model.criteria.force = 1e-12;
    let strip = Strip {
        contact: None,
        points: points.collect(),
        normal: None,
        transitions: Default::default(),
        path: still,
        penalty: OMEGA * OMEGA,
    };
    scene.strip(strip)
}

/// Displacement, velocity and acceleration of the first point.
fn state(points: &Points<2>) -> (f64, f64, f64) {
    let motion = points.motion.as_ref().expect("dynamic");
    (points.u[0][0], motion.v[0][0], motion.a[0][0])
}

/// Closed form: amplification matrix of the method of Wood, Bossak and Zienkiewicz (1980).
#[test]
fn one_degree_of_freedom_follows_the_amplification_matrix() {
    for scheme in [0.0, 0.5, 0.8, 1.0]
        .map(Scheme::Bossak)
        .into_iter()
        .chain([0.6, 1.0].map(Scheme::Gamma))
    {
        for steps in [20.0, 2.0] {
            let dt = 1.0 / steps;
            let amplification = scheme.amplification(OMEGA * dt, 1.0);
            let mut expected = nalgebra::Vector3::new(0.0, SPEED * dt, 0.0);
            let mut worst = 0.0_f64;
            oscillator(scheme).march(dt, 60.0 * dt, |points, _| {
                let (d, v, a) = state(points);
                expected = amplification * expected;
                let found = nalgebra::Vector3::new(d, v * dt, a * dt * dt);
                worst = worst.max((found - expected).amax() / (SPEED * dt));
            });
            let (radius, _) = scheme.spectrum(OMEGA * dt, 1.0);
            println!("{scheme:?}, {steps} steps a period: off by {worst:.1e}, spectral radius {radius:.6}");
            assert!(worst <= 1e-6);
        }
    }
}

#[test]
fn the_spectral_radius_at_infinite_frequency_is_the_one_that_is_asked_for() {
    for rho in [0.0, 0.3, 0.8, 1.0] {
        let (radius, _) = Scheme::Bossak(rho).spectrum(1e6, 1.0);
        // The triple root at 0 is found to the cube root of the rounding.
        assert!((radius - rho).abs() <= 1e-3, "{rho}: {radius}");
    }
    let greatest = |scheme: Scheme| {
        (0..200)
            .map(|k| scheme.spectrum(10.0_f64.powf(-3.0 + 0.04 * f64::from(k)), 1.0).0)
            .fold(0.0, f64::max)
    };
    let stable = [0.0, 0.5, 0.9]
        .map(Scheme::Bossak)
        .into_iter()
        .chain([0.5, 0.6, 1.0].map(Scheme::Gamma));
    stable.for_each(|scheme| assert!(greatest(scheme) <= 1.0 + 1e-9, "{scheme:?} is stable for every step"));
}

/// Theory: orders of the methods of Newmark (1959) and of Wood, Bossak and Zienkiewicz (1980).
#[test]
fn bossak_is_of_second_order_and_newmark_with_gamma_above_a_half_of_first() {
    let error = |scheme: Scheme, steps: f64| {
        let mut scene = oscillator(scheme);
        scene.march(1.0 / steps, 1.1, |_, _| {});
        (state(&scene.points).0 - SPEED / OMEGA * (OMEGA * 1.1).sin()).abs() / (SPEED / OMEGA)
    };
    for (scheme, order) in [
        (Scheme::Bossak(0.0), 2.0),
        (Scheme::Bossak(0.8), 2.0),
        (Scheme::Bossak(1.0), 2.0),
        (Scheme::Gamma(0.6), 1.0),
    ] {
        let errors = [160.0, 320.0, 640.0].map(|steps| error(scheme, steps));
        let found = (errors[1] / errors[2]).log2();
        println!("{scheme:?}: errors {errors:?}, order {found:.3}");
        assert!((found - order).abs() <= 0.15);
    }
}

#[test]
fn a_spectral_radius_of_one_is_the_papers_method_to_the_bit() {
    assert_eq!(Newmark::of_spectral_radius(1.0), Newmark::default());
    assert_eq!(Newmark::of_gamma(0.5), Newmark::default());
    let newmark = Newmark::default();
    let mut random = crate::support::random::Random::new(7);
    for _ in 0..1000 {
        let mut number = || random.signed() * 10.0_f64.powf(6.0 * random.signed());
        let u = number();
        let v = number();
        let a = number();
        let dt = number().abs();
        let end = 4.0 / (dt * dt) * u - 4.0 / dt * v - a;
        assert_eq!(newmark.acceleration(dt, u, v, a).to_bits(), end.to_bits());
        assert_eq!(newmark.acting(a, end).to_bits(), end.to_bits());
        assert_eq!(newmark.gained(dt, a, end).to_bits(), ((a + end) * (0.5 * dt)).to_bits());
        assert_eq!((newmark.factor(dt), newmark.pulse(dt)), (4.0 / (dt * dt), 4.0 / dt));
    }
}

/// Amplitude of the tip at the last turning point over that at the first, with the turns between, and the period.
fn mode(scheme: Scheme, steps: usize) -> (f64, f64, f64) {
    let mut scene = bar(Stabilisation::None);
    scene.model.newmark = scheme.newmark();
    swing(scene, steps)
}

/// The same of any bar.
fn swing(mut scene: Scene<PlaneStrain, 2>, steps: usize) -> (f64, f64, f64) {
    let mut course: Vec<f64> = vec![0.0];
    scene.march(PERIOD / steps as f64, 5.0 * PERIOD, |points, _| {
        let tip = (0..points.len())
            .max_by(|&a, &b| points.x[a][0].total_cmp(&points.x[b][0]))
            .expect("points");
        course.push(points.u[tip][0]);
    });
    let mut turns: Vec<(f64, f64)> = Vec::new();
    for k in 1..course.len() - 1 {
        let [before, at, after] = [course[k - 1].abs(), course[k].abs(), course[k + 1].abs()];
        if at > before && at >= after {
            // The vertex of the parabola through three points.
            let slope = 0.5 * (after - before);
            let bend = after - 2.0 * at + before;
            turns.push((k as f64 - slope / bend, at - 0.5 * slope * slope / bend));
        }
    }
    let first = turns[0];
    let last = turns[turns.len() - 1];
    let count = (turns.len() - 1) as f64;
    (last.1 / first.1, last.0 - first.0, 2.0 * (last.0 - first.0) / count)
}

/// Closed form: eigenvalues of the amplification matrix.
#[test]
fn a_mode_of_the_bar_decays_and_slows_down_as_the_theory_says() {
    // The mesh's share of the period is divided out by the run without damping.
    let wave = PI / (2.0 * CELLS as f64); // k h
    let kept = 1.0 - 3.0 * wave * wave / 12.0;
    for steps in [20, 40] {
        let spectrum = |scheme: Scheme| scheme.spectrum(2.0 * PI / steps as f64, kept);
        let plain = (mode(Scheme::Bossak(1.0), steps), spectrum(Scheme::Bossak(1.0)));
        for scheme in [
            Scheme::Bossak(1.0),
            Scheme::Bossak(0.0),
            Scheme::Bossak(0.5),
            Scheme::Gamma(0.6),
        ] {
            let (left, passed, period) = mode(scheme, steps);
            let (radius, angle) = spectrum(scheme);
            let decay = (left.ln() / passed, radius.ln());
            let slower = (period / plain.0.2, plain.1.1 / angle);
            println!("{scheme:?}, {steps} steps a period: ln of the decay a step {decay:?}, period {slower:?}");
            // The end cells keep less: 1.05e-5 without damping, 1.2e-5 at most.
            assert!((decay.0 - decay.1).abs() <= 2e-3 * decay.1.abs() + 1.5e-5);
            assert!((slower.0 - slower.1).abs() <= 2e-4); // measured 1.0e-4
        }
    }
}

/// Closed form: a quarter wave of circular frequency omega with the damping ratio `xi = beta omega/2` decays by
/// `exp(-xi omega t)`, and its frequency is higher by `xi omega dt/2`, because the viscous force acts half a step late.
#[test]
fn a_damped_mode_decays_by_its_ratio_to_second_order_and_is_late_by_half_a_step() {
    let ratio = 0.05;
    let omega = 2.0 * PI / PERIOD;
    let error = |method: Stabilisation, steps: usize| {
        let plain = swing(bar(method), steps);
        let mut damped = bar(method);
        damped.model.damping = vec![2.0 * ratio / omega];
        let (left, passed, period) = swing(damped, steps);
        let dt = PERIOD / steps as f64;
        let decay = -(left.ln() / passed - plain.0.ln() / plain.1) / (omega * dt);
        (
            decay / ratio - 1.0,
            (plain.2 / period - 1.0) + 0.5 * ratio * ratio,
            0.5 * ratio * omega * dt,
        )
    };
    for method in [Stabilisation::None, Stabilisation::FBar, Stabilisation::ConsistentFBar] {
        let [coarse, fine] = [40, 80].map(|steps| error(method, steps));
        println!(
            "{method:?}: decay {:.1e} {:.1e}, frequency {:.2e} for {:.2e}",
            coarse.0, fine.0, fine.1, fine.2
        );
        assert!(coarse.0.abs() <= 0.02 && fine.0.abs() <= 0.006, "{coarse:?} {fine:?}");
        assert!((fine.1 / fine.2 - 1.0).abs() <= 0.2, "{fine:?}");
    }
}

/// A yielding block that turns and is struck: without damping, with it by the secants, and by Newton's method.
#[test]
fn newtons_tangent_knows_the_viscous_stress() {
    let run = |nonlinear: Nonlinear, time: f64, method: Stabilisation| {
        let sand = MohrCoulomb::new(
            Elastic {
                young: 100.0,
                poisson: 0.3,
            },
            0.3,
            0.0,
            0.2,
        );
        let law = Material::MohrCoulomb(sand);
        let thrown = |x: &Vector<2>| [1.0 - 2.0 * x[1], 2.0 * x[0] - 3.0].into();
        let mut scene = Scene::<PlaneStrain, 2>::new([axis(0.5, 8, 2), axis(0.5, 6, 2)], law, Regime::Dynamic)
            .body([2..5, 1..4], 3, 1.0, thrown)
            .support(Support::fixed(1, false))
            .stabilised(method);
        scene.model.damping = if time > 0.0 { vec![time] } else { Vec::new() };
        scene.model.nonlinear = nonlinear;
        scene.model.criteria.force = 1e-10;
        scene.solved(0.05, 0.4)
    };
    for method in [Stabilisation::None, Stabilisation::ConsistentFBar] {
        let (plain, _) = run(Nonlinear::Auto, 0.0, method);
        let [(auto, _), (newton, steps)] = [Nonlinear::Auto, Nonlinear::Newton].map(|how| run(how, 0.05, method));
        let far = |a: &Scene<PlaneStrain, 2>, b: &Scene<PlaneStrain, 2>| {
            a.points
                .x
                .iter()
                .zip(&b.points.x)
                .map(|(a, b)| (a - b).norm())
                .fold(0.0, f64::max)
        };
        let most = steps.iter().map(|step| step.report.iterations).max().expect("steps");
        println!(
            "{method:?}: {:.1e}, undamped {:.1e}, {most} iterations",
            far(&auto, &newton),
            far(&auto, &plain)
        );
        assert!(far(&auto, &newton) <= 1e-7 && far(&auto, &plain) > 1e-3 && most <= 9);
    }
}

/// A sheared layer carries its strength, however fast: elastic strain alone is damped.
#[test]
fn what_flows_is_not_damped() {
    let shear = |time: f64| {
        let elastic = Elastic {
            young: 100.0,
            poisson: 0.3,
        };
        let law = Material::MohrCoulomb(MohrCoulomb::new(elastic, 0.0, 0.0, 0.2));
        let mut scene = Scene::<PlaneStrain, 2>::new([axis(0.5, 8, 2), axis(0.5, 2, 2)], law, Regime::Dynamic)
            .body([2..5, 0..2], 3, 1.0, |x| [x[1], 0.0].into())
            .support(Support::fixed(1, false))
            .support(Support::moving(1, true, [Some(1.0), Some(0.0)]));
        scene.model.damping = if time > 0.0 { vec![time] } else { Vec::new() };
        let (scene, _) = scene.solved(0.02, 0.2);
        let stress = |k: usize| {
            (0..scene.points.len())
                .map(|p| scene.points.sigma.at(p).0[k])
                .sum::<f64>()
        };
        [stress(3), stress(0) + stress(1) + stress(2)].map(|sum| sum / scene.points.len() as f64)
    };
    // 38.5 x 0.05 x 1 Pa of viscous stress by the rate of all strain, ten times the strength.
    let [plain, damped] = [0.0, 0.05].map(shear);
    println!("{plain:?} {damped:?}");
    assert!((damped[0] / plain[0] - 1.0).abs() <= 0.02, "{plain:?} {damped:?}");
    // A strain of the step that is no logarithm dilates in shear.
    assert!((damped[1] - plain[1]).abs() <= 0.02, "{plain:?} {damped:?}");
}

/// The mean viscous stress is the bulk modulus times the rate of the elastic dilation from the end of one step to that
/// of the next, both before smoothing: what smoothing took and the next step's strain brings back is no rate.
#[test]
fn what_smoothing_takes_is_not_damped() {
    const TIME: f64 = 0.05; // s
    const DT: f64 = 0.05; // s
    let elastic = Elastic {
        young: 100.0,
        poisson: 0.3,
    };
    let bulk = elastic.young / (3.0 * (1.0 - 2.0 * elastic.poisson));
    for method in [
        Stabilisation::FBar,
        Stabilisation::ModifiedFBar,
        Stabilisation::ConsistentFBar,
    ] {
        let law = Material::MohrCoulomb(MohrCoulomb::new(elastic.clone(), 0.3, 0.1, 0.2));
        let thrown = |x: &Vector<2>| [1.0 - 2.0 * x[1], 2.0 * x[0] - 3.0].into();
        let mut scene = Scene::<PlaneStrain, 2>::new([axis(0.5, 8, 2), axis(0.5, 6, 2)], law, Regime::Dynamic)
            .body([2..5, 1..4], 3, 1.0, thrown)
            .support(Support::fixed(1, false))
            .stabilised(method);
        scene.model.damping = vec![TIME];
        let mut before = BTreeMap::new();
        let mut off = 0.0_f64;
        let mut largest = 0.0_f64;
        let mut smoothed = 0.0_f64;
        scene.march(DT, 0.4, |points, accepted| {
            for p in 0..points.len() {
                let taken = 0.5 * points.smoothing_of(p).full().determinant().ln();
                let dilation = 0.5 * points.b_e.at(p).full().determinant().ln() - taken;
                let jacobian = points.F.at(p).determinant() * points.dilation_of(p);
                // The dilation that the stress has felt shows smoothing as well, which came after the stress.
                let mean = points.sigma.at(p).full().trace() / 3.0 * jacobian / taken.exp();
                let rate = (dilation - before.insert(points.id[p], dilation).unwrap_or(0.0)) / accepted.dt;
                off = off.max((mean - bulk * (dilation + TIME * rate)).abs());
                (largest, smoothed) = (largest.max(bulk * TIME * rate.abs()), smoothed.max(taken.abs()));
            }
        });
        println!("{method:?}: {off:.1e} of {largest:.3} Pa, smoothed by {smoothed:.1e}");
        assert!(off <= 1e-9 * largest && (method == Stabilisation::FBar || smoothed > 1e-4));
    }
}

/// Bodies that move and turn as if rigid keep their energy: strain alone is damped.
#[test]
fn a_rotation_is_not_damped() {
    let spin =
        |time: f64| {
            let mut scene =
                Scene::<PlaneStrain, 2>::new([axis(0.5, 8, 2), axis(0.5, 8, 2)], hencky(1e4, 0.3), Regime::Dynamic)
                    .body([3..5, 3..5], 3, 1.0, |x| [0.1 - (x[1] - 2.0), x[0] - 2.0].into());
            scene.model.damping = vec![time];
            scene.march(0.01, 0.5, |_, _| {});
            let v = &scene.points.motion.as_ref().expect("dynamic").v;
            v.iter()
                .zip(&scene.points.mass)
                .map(|(v, m)| 0.5 * m * v.norm_squared())
                .sum::<f64>()
        };
    let plain = spin(0.0);
    let damped = spin(0.05);
    println!("{plain} {damped}");
    assert!((damped / plain - 1.0).abs() <= 2e-3, "{plain} {damped}");
}
