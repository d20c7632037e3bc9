//! Tests of dense granular flow μ(I): rate-dependent strength, constant volume and tangent.

use super::{largest, respond, stretched, turned};
use crate::random::Random;
use bsmpm::element::{Control, Element, Target};
use bsmpm::material::{Branch, DruckerPrager, Elastic, Law, Match, Material, MuI, split};
use bsmpm::tensor::{Symmetric, Tensor};

const NUMBERS: [f64; 5] = [0.38, 0.64, 0.3, 2e-3, 2.5e3];

fn law(poisson: f64, numbers: [f64; 5]) -> MuI {
    MuI::new(Elastic { young: 1e6, poisson }, numbers)
}

/// At any length of the step the stress has the friction of the rate with which the return shears, and its volume.
#[test]
fn returns_have_the_friction_of_their_own_rate() {
    let mut random = Random::new(90);
    let mut cones = 0;
    let mut tips = 0;
    let mut fast = 0;
    let mut worst = 0.0_f64;
    for _ in 0..30_000 {
        let dt = random.pick(&[1e-9, 1e-5, 1e-3, 1.0, 1e6]);
        let law = law(random.pick(&[-0.5, 0.0, 0.3, 0.49]), NUMBERS)
            .with_time_step(dt)
            .expect("it follows the rate");
        let material = Material::MuI(law);
        let found = respond(&material, &random.trial(-6.0, -0.7));
        let (mean, _, norm) = split(found.principal_tau());
        let root = norm / 2_f64.sqrt();
        let pressure = -mean;
        let trial = found.principal_eps_trial();
        let elastic = found.principal_eps_e();
        let (volume, _, sheared) = split(std::array::from_fn(|k| trial[k] - elastic[k]));
        let [mu_s, mu_2, i_0, diameter, density] = NUMBERS;
        match found.branch() {
            Branch::Elastic => assert!(root <= mu_s * pressure * (1.0 + 1e-12)),
            Branch::Face => {
                cones += 1;
                let inertial = 2_f64.sqrt() * sheared / dt * diameter * (density / pressure).sqrt();
                let mu = mu_s + (mu_2 - mu_s) / (1.0 + i_0 / inertial);
                fast += usize::from(mu > 0.5 * (mu_s + mu_2));
                // The shear is a difference of strains, whose rounding the rate multiplies.
                let lost = 1e-15 / sheared.max(1e-300) + 1e-10;
                let off = (root / (mu * pressure) - 1.0).abs();
                assert!(off <= lost, "{root} {} {sheared}", mu * pressure);
                worst = worst.max(if sheared > 1e-4 { off } else { 0.0 });
                assert!(volume.abs() <= 1e-13 * largest(&trial));
            }
            region => {
                tips += 1;
                assert!(region == Branch::Apex && largest(&found.principal_tau()) == 0.0);
            }
        }
    }
    println!("friction off by {worst:.1e} where a step shears by 1e-4 and more");
    println!("{cones} {tips} {fast}");
    assert!(cones > 8_000 && tips > 5_000 && fast > 1_000, "{cones} {tips} {fast}");
}

/// Reference: a Drucker-Prager cone of constant volume.
#[test]
fn without_a_rate_it_is_a_cone() {
    let mut random = Random::new(91);
    let cone = DruckerPrager::new(
        Elastic {
            young: 1e6,
            poisson: 0.3,
        },
        0.6,
        0.0,
        0.0,
        Match::PlaneStrain,
    );
    let slope = cone.cone().0;
    for law in [
        law(0.3, [slope, 0.9, 0.3, 2e-3, 2.5e3]),
        law(0.3, [slope, slope, 0.3, 2e-3, 2.5e3]).with_time_step(1e-4).unwrap(),
    ] {
        for _ in 0..3_000 {
            let b = random.trial(-6.0, -0.7);
            let [a, b] = [Material::MuI(law.clone()), Material::DruckerPrager(cone.clone())].map(|m| respond(&m, &b));
            assert_eq!(a.branch(), b.branch());
            let a = a.principal_tau();
            let b = b.principal_tau();
            assert!((0..3).all(|k| (a[k] - b[k]).abs() <= 1e-9 * largest(&b)), "{a:?} {b:?}");
        }
    }
}

/// Reference: central differences of fourth order.
#[test]
fn tangent_is_the_derivative() {
    let mut random = Random::new(92);
    let mut worst = 0.0_f64;
    let mut seen = [0, 0];
    for trial in 0..40_000 {
        let dt = random.pick(&[1e-7, 1e-4, 1e-2, 1e3]);
        let material = Material::MuI(law(random.pick(&[0.0, 0.3, 0.49]), NUMBERS).with_time_step(dt).unwrap());
        let eps = random.strains(-3.5, -0.7).map(|strain| strain - 0.02);
        let eps = if trial % 4 == 0 { [eps[0], eps[0], eps[2]] } else { eps };
        let rotation = random.rotation();
        let l = Tensor::from_fn(|_, _| random.signed());
        let b = turned(&rotation, &stretched(eps));
        let found = respond(&material, &b);
        let around = [-2.0, -1.0, 1.0, 2.0]
            .map(|steps| respond(&material, &turned(&(Tensor::identity() + l * (steps * 1e-6)), &b)));
        if around.iter().any(|moved| moved.branch() != found.branch()) {
            continue;
        }
        let [a, b, c, d] = around.map(|moved| moved.tau().full());
        let difference = (a - d + (c - b) * 8.0) / 12e-6;
        let size = found.linearise(&l).amax().max(1e6);
        worst = worst.max((difference - found.linearise(&l)).amax() / size);
        seen[0] += usize::from(found.branch() == Branch::Face);
        seen[1] += usize::from(found.branch() == Branch::Apex);
    }
    println!("{seen:?} on cone and tip, error {worst:.1e}");
    assert!(seen[0] > 5_000 && seen[1] > 500 && worst < 1e-6, "{seen:?} {worst}");
}

/// Closed form: simple shear at a constant rate under a constant pressure, `τ = μ(I) p`, for any step size.
#[test]
fn steady_shear_has_the_friction_of_its_inertial_number() {
    let [mu_s, mu_2, i_0, diameter, density] = NUMBERS;
    let pressure = 500.0;
    for (rate, steps) in [(0.1, 50), (30.0, 50), (30.0, 400), (3e3, 50)] {
        let stress = Symmetric([-pressure, -pressure, -pressure, 0.0, 0.0, 0.0]);
        let mut point = Element::new(Material::MuI(law(0.3, NUMBERS)), stress).expect("within its strength");
        let mut targets = [Target::Strain(0.0); 4];
        (targets[1], targets[3]) = (Target::Stress(-pressure), Target::Strain(0.5));
        let control = Control {
            targets,
            steps,
            duration: 0.5 / rate,
            undrained: false,
        };
        point.follow(&control, |_| {}).expect("it flows");
        let [x, y, z, xy, ..] = point.sigma().0;
        let p = -(x + y + z) / 3.0;
        let inertial = rate * diameter * (density / p).sqrt();
        let mu = mu_s + (mu_2 - mu_s) / (1.0 + i_0 / inertial);
        assert!((xy / (mu * p) - 1.0).abs() <= 2e-3, "{rate}: {xy} for {}", mu * p);
    }
}
