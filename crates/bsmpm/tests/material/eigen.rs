//! Tests of the laws: isotropy, tiny and large strains, and nearly equal eigenvalues.

use super::{difference, hencky, largest, mohr_coulomb, respond, stretched, turned};
use crate::random::Random;
use bsmpm::kinematics::{Kinematics, Solid};
use bsmpm::material::Branch;
use bsmpm::tensor::{Symmetric, Tensor};
use nalgebra::{Rotation3, Vector3};

/// Isotropy: the law commutes with rotations.
#[test]
fn rotated_b_gives_rotated_tau() {
    let mut random = Random::new(40);
    let mut worst = 0.0_f64;
    for _ in 0..50_000 {
        let friction = random.pick(&[0.0, 20.0, 45.0]);
        let material = mohr_coulomb(1e3, 0.3, friction, 0.5 * friction, 1.0);
        let b = random.trial(-4.0, 0.0);
        let q = random.rotation();
        let found = respond(&material, &b);
        let after = respond(&material, &turned(&q, &b));
        let tau = turned(&q, &found.tau());
        // Rounding of b when it is rotated, as stress, is not the material's.
        let stored = 1e3 * 1e-15 * found.principal_eps_trial()[0].exp().powi(4).max(1.0);
        worst = worst.max((difference(&tau, &after.tau()) - stored) / largest(&tau.0));
        let b_e = turned(&q, &found.b_e());
        assert!(difference(&b_e, &after.b_e()) <= 1e-10 * largest(&b_e.0));
    }
    println!("isotropy {worst:.2e}");
    assert!(worst <= 1e-10, "{worst:e}");
}

/// Renaming the axes turns a plane tensor into one with yz or xz only, which takes the general path.
#[test]
fn plane_path_is_the_general_path() {
    let mut random = Random::new(41);
    let mut worst = 0.0_f64;
    for _ in 0..20_000 {
        let material = mohr_coulomb(1e3, 0.3, 20.0, 10.0, random.pick(&[1.0, 100.0]));
        let eps = random.strains(-8.0, 0.3);
        let b = turned(
            &nalgebra::Rotation3::new([0.0, 0.0, 3.0 * random.unit()].into()).into_inner(),
            &stretched(eps),
        );
        let [xx, yy, zz, xy, _, _] = b.0;
        let renamed = Symmetric([zz, xx, yy, 0.0, xy, 0.0]);
        let found = respond(&material, &b);
        let general = respond(&material, &renamed);
        let [a, b, c, d, e, f] = found.tau().0;
        let [z, x, y, g, h, i] = general.tau().0;
        assert_eq!((e, f), (0.0, 0.0));
        let apart = largest(&[a - x, b - y, c - z, d - h, g, i]);
        let size = largest(&[a, b, c, d]).max(1e3 * largest(&eps));
        worst = worst.max(apart / size);
    }
    println!("plane against general {worst:.2e}");
    assert!(worst <= 1e-13, "{worst:e}");
}

/// Closed form: `τ = E ε` for ν = 0, with principal axes along the grid and rotated, for strains from 1e-10 to ln 10.
#[test]
fn hencky_holds_from_tiny_to_large_strain() {
    let material = hencky(1.0, 0.0);
    let mut random = Random::new(42);
    for exponent in 0..=20 {
        let size = 10.0_f64.ln() * 1e-10_f64.powf(f64::from(exponent) / 20.0);
        let mut along = 0.0_f64;
        let mut turn = 0.0_f64;
        for _ in 0..500 {
            let eps = [0; 3].map(|_| size * random.signed());
            let b = stretched(eps);
            let exact = Symmetric([eps[0], eps[1], eps[2], 0.0, 0.0, 0.0]);
            along = along.max(difference(&respond(&material, &b).tau(), &exact) / size);
            let q = random.rotation();
            let mut b = turned(&q, &Symmetric([0, 1, 2, 3, 4, 5].map(|i| (2.0 * exact.0[i]).exp_m1())));
            b.0[..3].iter_mut().for_each(|c| *c += 1.0);
            turn = turn.max(difference(&respond(&material, &b).tau(), &turned(&q, &exact)) / size);
        }
        // Storing b costs 1e-16 of I, and of its largest value when turned.
        let rounding = 4e-16 / size;
        println!("strain {size:.1e}: along the axes {along:.1e}, turned {turn:.1e}");
        assert!(along <= rounding.max(1e-15) * 1.5, "strain {size:e}: {along:e}");
        assert!(
            turn <= 4.0 * rounding.max(1e-15) * (4.0 * size).exp(),
            "strain {size:e}: {turn:e}"
        );
    }
}

/// Closed form: the off-diagonal entry of the strain `½ ln [1 g; g 1]` is `½ artanh g`, also for very small g.
#[test]
fn pure_shear_is_exact_at_any_size() {
    let material = hencky(1.0, 0.0);
    for exponent in 1..=14 {
        let g = 10.0_f64.powi(-exponent);
        for component in 3..6 {
            let mut b = Symmetric::IDENTITY;
            b.0[component] = g;
            let found = respond(&material, &b).tau().0[component];
            let exact = 0.5 * g.atanh();
            assert!((found - exact).abs() <= 1e-15 * exact, "{found:e} for {exact:e}");
        }
    }
}

#[test]
fn determinants_from_1e_minus_6_to_1e6() {
    let material = hencky(1.0, 0.0);
    for exponent in -6..=6 {
        let eps = f64::from(exponent) * 10.0_f64.ln() / 3.0;
        let tau = respond(&material, &stretched([eps; 3])).tau().0;
        assert!(largest(&[tau[0] - eps, tau[1] - eps, tau[2] - eps]) <= 1e-15 * (1.0 + eps.abs()));
        assert_eq!(tau[3..], [0.0; 3]);
    }
}

/// Closed form: `exp(2 τ)` is b for E = 1 and ν = 0, if the eigenvalues differ by 1 to 1e-16.
#[test]
fn nearly_equal_eigenvalues_rebuild_b() {
    let material = hencky(1.0, 0.0);
    let mut random = Random::new(43);
    let mut worst = 0.0_f64;
    for exponent in 0..=16 {
        for _ in 0..200 {
            let gap = 10.0_f64.powi(-exponent);
            let base = 0.5 * random.signed();
            let eps = [base + 0.1 * gap, base, base - 0.05 * gap * random.unit().round()];
            let b = turned(&random.rotation(), &stretched(eps));
            let tau = respond(&material, &b).tau().full();
            worst = worst.max(difference(&Symmetric::of(&exponential(&(2.0 * tau))), &b) / largest(&b.0));
        }
    }
    println!("b rebuilt to {worst:.2e}");
    assert!(worst <= 1e-13, "{worst:e}");
}

/// A hundred turns about any axis, ten degrees at a time, while the material is drawn in its own turning frame, so that
/// Mohr-Coulomb's yields in most steps: the stress is that without turns.
#[test]
fn a_hundred_turns_leave_the_stress() {
    const STEPS: u32 = 3_600;
    let mut random = Random::new(44);
    for (material, yields) in [
        (hencky(1e3, 0.3), false),
        (mohr_coulomb(1e3, 0.3, 30.0, 10.0, 0.1), true),
    ] {
        let mut worst = 0.0_f64;
        for _ in 0..20 {
            let start = turned(&random.rotation(), &stretched(random.strains(-4.0, -2.0)));
            let gradient = Tensor::from_fn(|_, _| random.signed());
            let drawn = Tensor::identity() * (1.0 - 1e-5 * gradient.trace() / 3.0) + 1e-5 * gradient;
            let about = Vector3::new(random.signed(), random.signed(), random.signed()).normalize();
            let turn = |step: u32| Rotation3::new(about * (10.0 * f64::from(step)).to_radians()).into_inner();
            let mut still = start;
            let mut turning = start;
            let mut yielded = 0;
            for step in 0..STEPS {
                let trial = Solid::push_forward(&drawn, &still);
                let found = respond(&material, &trial);
                yielded += u32::from(found.branch() != Branch::Elastic);
                still = found.b_e();
                let moved = turn(step + 1) * drawn * turn(step).transpose();
                turning = respond(&material, &Solid::push_forward(&moved, &turning)).b_e();
            }
            let tau = |b: &Symmetric| respond(&material, b).tau();
            worst = worst.max(difference(&tau(&still), &tau(&turning)) / largest(&tau(&still).0));
            assert_eq!(yielded > STEPS / 2, yields, "{yielded} of {STEPS} steps yield");
        }
        println!(
            "a hundred turns, {} {worst:.1e}",
            if yields { "yielding" } else { "elastic" }
        );
        assert!(worst <= 1e-9, "{worst:e}");
    }
}

/// Taylor series with scaling and squaring.
fn exponential(a: &Tensor) -> Tensor {
    let small = a / 64.0;
    let mut term = Tensor::identity();
    let mut sum = term;
    for k in 1..16 {
        term = term * small / f64::from(k);
        sum += term;
    }
    (0..6).fold(sum, |s, _| s * s)
}
