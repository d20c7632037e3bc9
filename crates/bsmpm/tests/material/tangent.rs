//! Tests of the spatial tangent in every region of the return mapping, against fourth-order central differences of the
//! stress.

use super::{Branch, REGIONS, hencky, mohr_coulomb, respond, stretched, turned};
use crate::random::Random;
use bsmpm::material::{Material, Response};
use bsmpm::tensor::{Symmetric, Tensor};

/// Relative error of the tangent along l, or none if the difference leaves the region.
fn error(material: &Material, b: &Symmetric, l: &Tensor, h: f64) -> Option<(Branch, f64)> {
    let found = respond(material, b);
    let mut difference = Tensor::zeros();
    for (weight, steps) in [(-1.0, 2.0), (8.0, 1.0), (-8.0, -1.0), (1.0, -2.0)] {
        let step = Tensor::identity() + l * (steps * h);
        let moved = respond(material, &turned(&step, b));
        if moved.branch() != found.branch() {
            return None;
        }
        difference += moved.tau().full() * weight;
    }
    difference /= 12.0 * h;
    let tangent = found.linearise(l);
    let size = tangent.amax().max(1e-3 * material.elastic().oedometric() * l.amax());
    Some((found.branch(), (difference - tangent).amax() / size))
}

/// The smallest gap of trial strains whose stresses differ: the tangent varies over it, so a difference must stay
/// within.
fn smallest_gap(found: &Response) -> f64 {
    let eps = found.principal_eps_trial();
    let tau = found.principal_tau();
    let pairs = [(0, 1), (1, 2)].into_iter().filter(|(a, b)| tau[*a] != tau[*b]);
    pairs.map(|(a, b)| eps[a] - eps[b]).fold(1.0, f64::min)
}

fn gradient(random: &mut Random) -> Tensor {
    Tensor::from_fn(|_, _| random.signed())
}

/// Reference: central differences of fourth order.
#[test]
fn tangent_is_the_derivative_in_every_region() {
    let mut random = Random::new(50);
    let mut seen = [0; 5];
    let mut worst = [0.0_f64; 5];
    for _ in 0..60_000 {
        let friction = random.pick(&[0.0, 1e-9, 20.0, 30.0, 45.0, 60.0, 89.9]);
        let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
        let material = mohr_coulomb(1e3, random.pick(&[-0.5, 0.0, 0.3, 0.49]), friction, dilation, 1.0);
        let b = random.trial(-2.5, -0.7);
        let l = gradient(&mut random);
        let gap = smallest_gap(&respond(&material, &b));
        if gap < 1e-4 {
            continue;
        }
        if let Some((region, error)) = error(&material, &b, &l, (3e-3 * gap).min(1e-5)) {
            let k = REGIONS.iter().position(|r| *r == region).unwrap();
            seen[k] += 1;
            worst[k] = worst[k].max(error);
        }
    }
    println!("{REGIONS:?}: tried {seen:?}, tangent error {worst:?}");
    assert!(seen.iter().all(|n| *n > 200), "{seen:?}");
    assert!(worst.iter().all(|e| *e <= 1e-7), "{worst:?}");
}

/// Reference: central differences of fourth order.
#[test]
fn tangent_is_the_derivative_for_equal_and_nearly_equal_eigenvalues() {
    let mut random = Random::new(51);
    let mut worst = [0.0_f64; 5];
    let mut seen = [0; 5];
    for gap in [0.0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6] {
        let weak = mohr_coulomb(1e3, 0.3, 20.0, 10.0, 1.0);
        // Left edge (first two nearly equal), right edge (last two), elastic with two and with three nearly equal.
        let cases = [
            (&weak, [0.01 + gap, 0.01, -0.04]),
            (&weak, [0.03, -0.02 + gap, -0.02]),
            (&weak, [0.05 + gap, 0.05, 0.05 - gap]),
            (&hencky(1e3, 0.3), [0.01 + gap, 0.01, -0.04]),
            (&hencky(1e3, 0.3), [0.1 + gap, 0.1, 0.1 - gap]),
            (&mohr_coulomb(1e3, 0.3, 0.0, 0.0, 1.0), [0.01 + gap, 0.01, -0.04]),
        ];
        for (material, eps) in cases {
            for _ in 0..50 {
                let b = turned(&random.rotation(), &stretched(eps));
                let (region, error) = error(material, &b, &gradient(&mut random), 3e-5).expect("one region");
                let k = REGIONS.iter().position(|r| *r == region).unwrap();
                seen[k] += 1;
                worst[k] = worst[k].max(error);
            }
        }
    }
    println!("{REGIONS:?}: tried {seen:?}, tangent error {worst:?}");
    assert!(worst.iter().all(|e| *e <= 1e-7), "{worst:?}");
    assert!([0, 2, 3, 4].iter().all(|k| seen[*k] > 100), "{seen:?}");
}

/// Closed form: a rigid rotation rotates the stress, `dτ = w τ - τ w`.
#[test]
fn spin_only_rotates_the_stress() {
    let mut random = Random::new(52);
    for _ in 0..5_000 {
        let material = mohr_coulomb(1e3, 0.3, 20.0, 10.0, 1.0);
        let b = random.trial(-3.0, -0.5);
        let l = gradient(&mut random);
        let spin = l - l.transpose();
        let found = respond(&material, &b);
        let tau = found.tau().full();
        let exact = spin * tau - tau * spin;
        assert!((found.linearise(&spin) - exact).amax() <= 1e-10 * (1.0 + tau.amax()));
    }
}
