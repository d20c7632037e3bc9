//! Tests of the constitutive laws: an independent implementation, and limit cases in which two laws must agree.

use super::{Branch, Material, difference, hencky, largest, mohr_coulomb, respond, stretched};
use crate::random::Random;
use bsmpm::material::Moduli;
use bsmpm::tensor::Symmetric;

/// φ, ψ (degrees) and c; principal strain; region; principal stress.
type Row = ([f64; 3], [f64; 3], Branch, [f64; 3]);

#[test]
fn method_section_2_table() {
    let rows: [Row; 5] = [
        (
            [20.0, 0.0, 1.0],
            [0.002, -0.001, -0.01],
            Branch::Face,
            [-4.501294655559524, -5.961538461538462, -12.037166882902014],
        ),
        (
            [20.0, 10.0, 1.0],
            [0.002, 0.0015, -0.01],
            Branch::LeftEdge,
            [-3.764196803964208, -3.764196803964208, -10.533777144737742],
        ),
        (
            [20.0, 0.0, 1.0],
            [0.01, -0.01, -0.011],
            Branch::RightEdge,
            [-4.28952398866601, -11.605238005666994, -11.605238005666994],
        ),
        ([0.0, 0.0, 1.0], [0.005, 0.0, -0.005], Branch::Face, [1.0, 0.0, -1.0]),
        ([30.0, 0.0, 1.0], [0.01; 3], Branch::Apex, [1.7320508075688776; 3]),
    ];
    for ([friction, dilation, cohesion], eps, region, tau) in rows {
        let found = respond(
            &mohr_coulomb(1000.0, 0.3, friction, dilation, cohesion),
            &stretched(eps),
        );
        assert_eq!(found.branch(), region);
        for (a, b) in found.principal_tau().into_iter().zip(tau) {
            assert!((a - b).abs() <= 1e-10 * largest(&tau), "{a} for {b} on {region:?}");
        }
    }
}

/// Reference: Tresca, the limit of a friction angle of zero.
#[test]
fn friction_to_zero_is_tresca() {
    let mut random = Random::new(1);
    let tresca = mohr_coulomb(1e3, 0.3, 0.0, 0.0, 1.0);
    let nearly = mohr_coulomb(1e3, 0.3, 1e-9, 1e-9, 1.0);
    let mut worst = 0.0_f64;
    for _ in 0..10_000 {
        let b = random.trial(-4.0, -1.0);
        let a = respond(&tresca, &b).tau();
        let b = respond(&nearly, &b).tau();
        worst = worst.max(difference(&a, &b) / (1.0 + largest(&a.0)));
    }
    println!("friction of 1e-9 degrees: {worst:.1e}");
    assert!(worst <= 1e-8, "{worst}");
}

#[test]
fn results_scale_exactly_with_the_unit_of_stress() {
    let mut random = Random::new(2);
    let unit = 1024.0 * 1024.0;
    for _ in 0..10_000 {
        let friction = random.pick(&[0.0, 20.0, 45.0]);
        let cohesion = random.pick(&[0.0, 1.0]);
        let b = random.trial(-6.0, -0.5);
        let small = respond(&mohr_coulomb(1e3, 0.3, friction, 0.5 * friction, cohesion), &b);
        let large = respond(
            &mohr_coulomb(1e3 * unit, 0.3, friction, 0.5 * friction, cohesion * unit),
            &b,
        );
        assert_eq!(small.tau().scaled(unit), large.tau());
        assert_eq!((small.branch(), small.b_e()), (large.branch(), large.b_e()));
    }
}

#[test]
fn elastic_state_is_the_trial_bit_for_bit() {
    let mut random = Random::new(3);
    let strong = mohr_coulomb(1e3, 0.3, 20.0, 10.0, 1e6);
    for _ in 0..10_000 {
        let b = random.trial(-8.0, -1.0);
        let a = respond(&strong, &b);
        let c = respond(&hencky(1e3, 0.3), &b);
        assert_eq!((a.branch(), a.b_e(), a.tau()), (Branch::Elastic, b, c.tau()));
        assert_eq!((c.b_e(), a.plastic_increment()), (b, 0.0));
    }
}

#[test]
fn plastic_increment_is_the_deviatoric_strain_lost() {
    let found = respond(
        &mohr_coulomb(1000.0, 0.3, 0.0, 0.0, 1.0),
        &stretched([0.005, 0.0, -0.005]),
    );
    // tau = (1, 0, -1) is eps_e = 1.3e-3 (1, 0, -1): 3.7e-3 (1, 0, -1) is lost.
    let exact = (2.0_f64 / 3.0).sqrt() * 2.0_f64.sqrt() * 3.7e-3;
    assert!((found.plastic_increment() - exact).abs() <= 1e-14);
}

/// Shear beyond c = 1 Pa: the stress grows by c (1, 0, -1) in the first step, whose work on the strain is actual, and
/// not at all in the second one. Elastic ground works 2 mu |strain|^2, mu = 1000/2.6 Pa.
#[test]
fn second_order_work_is_elastic_until_perfect_flow_leaves_none() {
    let weak = mohr_coulomb(1000.0, 0.3, 0.0, 0.0, 1.0);
    let strong = mohr_coulomb(1000.0, 0.3, 0.0, 0.0, 1e3);
    let sheared = |by: f64| Symmetric([by, 0.0, -by, 0.0, 0.0, 0.0]);
    let elastic = 2000.0 / 2.6 * 2.0 * 0.005_f64.powi(2);
    let is_near = |found: [f64; 2], exact: [f64; 2]| (0..2).all(|k| (found[k] - exact[k]).abs() <= 1e-12);
    let first = respond(&strong, &stretched([0.005, 0.0, -0.005]));
    assert!(is_near(
        first.second_order_works(&sheared(0.005).full(), 0.0),
        [elastic; 2]
    ));
    let first = respond(&weak, &stretched([0.005, 0.0, -0.005]));
    assert!(is_near(
        first.second_order_works(&sheared(0.005).full(), 0.0),
        [elastic, 0.01]
    ));
    let [x, _, z] = first.principal_eps_e();
    let second = respond(&weak, &stretched([x + 0.005, 0.0, z - 0.005]));
    assert!(is_near(
        second.second_order_works(&sheared(0.005).full(), 0.0),
        [elastic, 0.0]
    ));
}

#[test]
fn elastic_constants() {
    let material = hencky(1000.0, 0.25);
    let Moduli { lambda, mu } = material.elastic().moduli();
    assert!((lambda - 400.0).abs() <= 1e-12 && (mu - 400.0).abs() <= 1e-12);
    assert!((material.elastic().oedometric() - 1200.0).abs() <= 1e-12);
    assert!(matches!(material, Material::Hencky(_)));
}
