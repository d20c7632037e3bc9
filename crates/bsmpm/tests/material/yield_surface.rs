//! Tests of the Mohr-Coulomb return mapping: yield, order of principal stresses, idempotence and flow rule.

use super::{Branch, difference, largest, mohr_coulomb, respond};
use crate::random::Random;
use bsmpm::material::Moduli;
use bsmpm::material::{Law, Material, Response};

const FRICTIONS: [f64; 6] = [0.0, 1e-9, 20.0, 45.0, 60.0, 89.9];
const POISSONS: [f64; 6] = [-0.99, -0.5, 0.0, 0.3, 0.49, 0.49999];

/// Calls `check(material, sin ψ, response)` for 1e5 trials of every friction angle; returns the largest of its results.
fn worst(seed: u64, high: f64, check: impl Fn(&Material, &Response) -> f64) -> f64 {
    let mut random = Random::new(seed);
    let mut worst = 0.0_f64;
    for friction in FRICTIONS {
        for _ in 0..100_000 {
            let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
            let poisson = random.pick(&POISSONS);
            let cohesion = random.pick(&[0.0, 1e-6, 1.0, 100.0]);
            let material = mohr_coulomb(1e3, poisson, friction, dilation, cohesion);
            let found = check(&material, &respond(&material, &random.trial(-7.0, high)));
            assert!(!found.is_nan(), "{material:?}");
            worst = worst.max(found);
        }
    }
    worst
}

fn sines(material: &Material) -> (f64, f64, f64) {
    let Material::MohrCoulomb(law) = material else {
        panic!("Mohr-Coulomb only")
    };
    let [friction, dilation, cohesion] = law.parameters()[..] else {
        panic!("three parameters")
    };
    (friction.sin(), dilation.sin(), 2.0 * cohesion * friction.cos())
}

/// Random trial states for six friction angles.
#[test]
fn yield_is_satisfied_and_order_kept() {
    let violation = worst(10, 0.3, |material, response| {
        let [first, second, third] = response.principal_tau();
        let (sin, _, strength) = sines(material);
        assert!(
            first >= second && second >= third,
            "{:?} in {:?}",
            response.principal_tau(),
            response.branch()
        );
        let f = (first - third) + (first + third) * sin - strength;
        let scale = first.abs() + third.abs() + strength;
        if f <= 0.0 { 0.0 } else { f / scale }
    });
    println!("yield violation {violation:.2e}");
    assert!(violation <= 1e-12, "{violation:e}");
}

#[test]
fn second_return_changes_nothing() {
    let change = worst(11, -0.5, |material, response| {
        let again = respond(material, &response.b_e());
        let Moduli { lambda, mu } = material.elastic().moduli();
        let tau = response.tau();
        // What storing b to the last digit can change; the rest must be below 1e-10 of the stress.
        let stored = 1e-15 * (3.0 * lambda.abs() + 2.0 * mu);
        (difference(&again.tau(), &tau) - 4.0 * stored) / largest(&tau.0).max(stored)
    });
    println!("second return {change:.2e}");
    assert!(change <= 1e-10, "{change:e}");
}

/// Koiter's rule in principal values: plastic strain is a combination of the active flows, with multipliers not
/// negative.
#[test]
fn plastic_strain_obeys_the_flow_rule() {
    let violation = worst(12, -0.5, |material, response| {
        let (plus, minus) = {
            let (_, sin, _) = sines(material);
            (1.0 + sin, 1.0 - sin)
        };
        let eps_e = response.principal_eps_e();
        let [x, y, z] = response.principal_eps_trial();
        let [x, y, z] = [x - eps_e[0], y - eps_e[1], z - eps_e[2]];
        let size = largest(&response.principal_eps_trial());
        let (negative, off) = match response.branch() {
            Branch::Elastic => (0.0, largest(&[x, y, z])),
            Branch::Face => (-x, largest(&[y, minus * x + plus * z])),
            Branch::RightEdge => (y.max(z), (minus * x + plus * (y + z)).abs()),
            Branch::LeftEdge => ((-x).max(-y), (minus * (x + y) + plus * z).abs()),
            Branch::Apex => (0.0, 0.0),
        };
        negative.max(off) / size
    });
    println!("flow rule {violation:.2e}");
    assert!(violation <= 1e-10, "{violation:e}");
}

#[test]
fn every_region_is_visited() {
    for friction in FRICTIONS {
        let mut seen = [0; 5];
        let mut random = Random::new(13);
        for _ in 0..20_000 {
            let material = mohr_coulomb(1e3, 0.3, friction, 0.5 * friction, 1.0);
            let region = respond(&material, &random.trial(-5.0, -1.0)).branch();
            seen[super::REGIONS.iter().position(|r| *r == region).unwrap()] += 1;
        }
        let has_apex = friction >= 20.0;
        assert!(
            seen[..4].iter().all(|n| *n > 20) && (seen[4] > 20) == has_apex,
            "{friction}: {seen:?}"
        );
    }
}

/// bᵉ keeps its digits however far it is from the identity: the stress that belongs to it is the returned one.
#[test]
fn states_of_large_strain_keep_their_digits() {
    let mut random = Random::new(14);
    for _ in 0..10_000 {
        let material = mohr_coulomb(1e3, 0.3, 0.0, 0.0, 1.0);
        let volume = 30.0 * random.signed();
        let response = respond(&material, &random.trial(-3.0, 0.0).scaled(volume.exp()));
        let again = respond(&material, &response.b_e());
        let change = difference(&again.tau(), &response.tau());
        assert!(
            change <= 1e-12 * largest(&response.tau().0).max(1.0),
            "{change:e} at {response:?}"
        );
    }
}
