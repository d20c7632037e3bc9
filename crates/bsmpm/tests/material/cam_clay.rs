//! Tests of modified Cam-clay: yield, flow rule, tangent, and laboratory tests with closed forms.

use super::{answer, largest, stretched, turned};
use crate::random::Random;
use bsmpm::element::{Control, Element, ElementError, Target};
use bsmpm::material::{Branch, CamClay, Elastic, Law, Material, MaterialError, split};
use bsmpm::tensor::{Symmetric, Tensor};

const M: f64 = 1.1;
const KAPPA: f64 = 0.03;
const LAMBDA: f64 = 0.15;
const HELD: Target = Target::Strain(0.0);

/// Pa: the shear modulus; the bulk modulus follows from the pressure.
fn law(shear: f64, preconsolidation: f64, ocr: f64) -> CamClay {
    let elastic = Elastic {
        young: 2.6 * shear,
        poisson: 0.3,
    };
    CamClay::new(elastic, [KAPPA, LAMBDA, M, preconsolidation, ocr])
}

/// Slopes of ln v over the logarithm of Kirchhoff's pressure.
fn slopes() -> (f64, f64) {
    (KAPPA / (1.0 - KAPPA), LAMBDA / (1.0 - LAMBDA))
}

/// Mean pressure and `√(3/2) |dev|`.
fn invariants(tau: [f64; 3]) -> (f64, f64) {
    let (mean, _, norm) = split(tau);
    (-mean, 1.5_f64.sqrt() * norm)
}

/// Strains that give pressures from a tenth to ten times p_c with any shear, and p_c.
fn random_trial(random: &mut Random, law: &CamClay) -> ([f64; 3], f64) {
    let preconsolidation = 1e5;
    let pressure = preconsolidation * 10_f64.powf(2.0 * random.unit() - 1.0);
    let mut shear = random.strains(-3.5, -1.0);
    let mean = (shear[0] + shear[1] + shear[2]) / 3.0;
    let volume = law.strain([-pressure; 3])[0];
    shear.iter_mut().for_each(|eps| *eps += volume - mean);
    (shear, preconsolidation)
}

#[test]
fn returns_lie_on_the_ellipse_that_has_grown_and_flow_along_its_normal() {
    let mut random = Random::new(110);
    let (swelling, compression) = slopes();
    let mut wet = 0;
    let mut dry = 0;
    for _ in 0..40_000 {
        let law = law(random.pick(&[1e6, 5e6, 5e7]), 1e5, 0.0);
        let (eps, before) = random_trial(&mut random, &law);
        let material = Material::CamClay(law);
        let (response, after) = answer(&material, &stretched(eps), before);
        let tau = response.principal_tau();
        let (p, q) = invariants(tau);
        if response.branch() == Branch::Elastic {
            assert!(material.yield_function(tau, &[before]) <= 1e-9 * before && after == before);
            continue;
        }
        assert!(
            p > 0.0 && material.yield_function(tau, &[after]).abs() <= 1e-11 * (p + q),
            "{p} {q} {after}"
        );
        let trial = response.principal_eps_trial();
        let elastic = response.principal_eps_e();
        let flow: [f64; 3] = std::array::from_fn(|k| trial[k] - elastic[k]);
        let size = largest(&trial);
        let volume: f64 = flow.iter().sum();
        assert!(
            (after / before / (-volume / (compression - swelling)).exp() - 1.0).abs() <= 1e-9,
            "{volume}"
        );
        // Along the normal (2P + p_c)/3 I + 3 s/M², s the deviator.
        let normal = tau.map(|tau| (after - 2.0 * p) / 3.0 + 3.0 * (tau + p) / (M * M));
        let along = |a: &[f64; 3], b: &[f64; 3]| -> f64 { (0..3).map(|k| a[k] * b[k]).sum() };
        let multiplier = along(&flow, &normal) / along(&normal, &normal);
        assert!(multiplier >= 0.0);
        assert!(
            (0..3).all(|k| (flow[k] - multiplier * normal[k]).abs() <= 1e-11 * size),
            "{flow:?} {normal:?}"
        );
        if 2.0 * p > after {
            wet += 1
        } else {
            dry += 1
        }
        // The elastic state is that of the stress, and stays.
        let again = material.respond(&response.b_e(), &[after]).unwrap();
        let change = std::array::from_fn::<f64, 3, _>(|k| again.principal_tau()[k] - tau[k]);
        assert!(largest(&change) <= 1e-8 * (p + q) && again.plastic_increment() <= 1e-8 * size);
    }
    assert!(wet > 5_000 && dry > 3_000, "{wet} {dry}");
}

/// Against fourth-order central differences, elastic and yielding, of distinct strains and of equal ones.
#[test]
fn tangent_is_the_derivative() {
    let mut random = Random::new(111);
    let mut worst = 0.0_f64;
    let mut seen = [0; 2];
    for trial in 0..20_000 {
        let law = law(random.pick(&[1e6, 5e6]), 1e5, 0.0);
        let (eps, before) = random_trial(&mut random, &law);
        let eps = if trial % 4 == 0 { [eps[0], eps[0], eps[2]] } else { eps };
        let eps = if trial % 16 == 0 { [eps[0]; 3] } else { eps };
        let material = Material::CamClay(law);
        let b = turned(&random.rotation(), &stretched(eps));
        let l = Tensor::from_fn(|_, _| random.signed());
        let found = material.respond(&b, &[before]).unwrap();
        let around = [-2.0, -1.0, 1.0, 2.0].map(|steps| {
            material
                .respond(&turned(&(Tensor::identity() + l * (steps * 1e-6)), &b), &[before])
                .unwrap()
        });
        if around.iter().any(|moved| moved.branch() != found.branch()) {
            continue;
        }
        let [a, b, c, d] = around.map(|moved| moved.tau().full());
        let difference = (a - d + (c - b) * 8.0) / 12e-6;
        let (p, _) = invariants(found.principal_tau());
        worst = worst.max((difference - found.linearise(&l)).amax() / (1e6 + p / KAPPA));
        seen[usize::from(found.branch() == Branch::Face)] += 1;
    }
    println!("{seen:?}, error {worst:.1e} of the stiffness");
    assert!(seen[0] > 1_000 && seen[1] > 10_000 && worst < 1e-6, "{seen:?}, {worst}");
}

/// Inside the ellipse stress is the derivative of the energy, and b_e that of a stress gives the stress.
#[test]
fn elasticity_keeps_energy_and_has_an_inverse() {
    let mut random = Random::new(112);
    let law = law(3e6, 1e9, 0.0);
    for _ in 0..2_000 {
        let (eps, _) = random_trial(&mut random, &law);
        let tau: [f64; 3] = law.stress(eps);
        let again = law.strain(tau);
        assert!((0..3).all(|k| (again[k] - eps[k]).abs() < 1e-13));
        for k in 0..3 {
            let moved = |step: f64| law.energy(std::array::from_fn(|i| eps[i] + if i == k { step } else { 0.0 }));
            let difference = (moved(-2e-5) - moved(2e-5) + 8.0 * (moved(1e-5) - moved(-1e-5))) / 12e-5;
            assert!(
                (difference - tau[k]).abs() <= 1e-6 * largest(&tau),
                "{difference} {tau:?}"
            );
        }
        let response = Material::CamClay(law.clone()).respond(&stretched(eps), &[1e9]).unwrap();
        assert!((response.elastic_energy() / law.energy(eps) - 1.0).abs() < 1e-10);
    }
}

fn point(law: CamClay, sigma: [f64; 3]) -> Element {
    let [x, y, z] = sigma;
    Element::new(Material::CamClay(law), Symmetric([x, y, z, 0.0, 0.0, 0.0])).expect("a stress of the clay")
}

fn follow(point: &mut Element, targets: [Target; 4], undrained: bool, steps: u64) {
    point
        .follow(
            &Control {
                targets,
                undrained,
                steps,
                duration: f64::INFINITY,
            },
            |_| (),
        )
        .expect("a path");
}

fn of_cauchy(point: &Element) -> (f64, f64) {
    let [x, y, z, ..] = point.sigma().0;
    let mut principal = [x, y, z];
    principal.sort_by(|a, b| b.total_cmp(a));
    invariants(principal)
}

/// Cauchy's pressure makes straight lines in ln v over ln p, of slope λ beyond p_c and κ below, in any steps.
#[test]
fn isotropic_compression_follows_both_lines() {
    for steps in [1, 20] {
        let mut sample = point(law(5e6, 2e5, 0.0), [-1e5; 3]);
        let mut volume = 0.0;
        let mut last = 1e5;
        for (pressure, slope) in [(2e5, KAPPA), (8e5, LAMBDA), (1e5, KAPPA), (7e5, KAPPA)] {
            // p_c is Kirchhoff's: where the point yields first its volume has shrunk by κ ln 2.
            let pressure: f64 = if pressure == 2e5 {
                2e5 * (KAPPA * 2_f64.ln() / (1.0 - KAPPA)).exp()
            } else {
                pressure
            };
            let all = Target::Stress(-pressure);
            follow(&mut sample, [all, all, all, HELD], false, steps);
            volume -= slope * (pressure / last).ln();
            last = pressure;
            assert!(
                (sample.volume_strain() - volume).abs() < 1e-9,
                "{} for {volume}",
                sample.volume_strain()
            );
        }
    }
}

/// Closed form: in undrained shear p (1 + (η/M)²)^Λ is constant after yield, with Λ = 1 - κ̂/λ̂, so that the strength
/// is s_u = M/2 p_0 (R/2)^Λ; to first order in the step size the strain is `ε_s = q/3μ + κ̂ Λ/M (ln((M + η)/(M - η)) -
/// 2 arctan(η/M))`.
#[test]
fn undrained_triaxial_path_strength_and_strain() {
    let (swelling, compression) = slopes();
    let rest = 1.0 - swelling / compression;
    let p0 = 1e5;
    let shear = 3e6;
    let mut errors = Vec::new();
    for steps in [50, 100, 200] {
        let mut sample = point(law(shear, 0.0, 1.0), [-p0; 3]);
        let cell = Target::Stress(-p0);
        let control = Control {
            targets: [cell, Target::Strain(-0.05), cell, HELD],
            undrained: true,
            steps,
            duration: f64::INFINITY,
        };
        let mut worst = 0.0_f64;
        let mut end = 0.0;
        let followed = sample.follow(&control, |point| {
            let (p, q) = of_cauchy(point);
            let eta = q / p;
            worst = worst.max((p * (1.0 + (eta / M).powi(2)).powf(rest) / p0 - 1.0).abs());
            let plastic = ((M + eta) / (M - eta)).ln() - 2.0 * (eta / M).atan();
            end = -point.strain()[1] - (q / (3.0 * shear) + swelling * rest / M * plastic);
            // Water carries what the cell and q/3 do not leave to the soil.
            assert!((point.pore_pressure() - (p0 + q / 3.0 - p)).abs() < 1e-4);
        });
        followed.expect("a path");
        assert!(worst < 1e-9, "{worst}");
        errors.push(end.abs());
    }
    println!("{errors:?}");
    assert!(
        errors[2] < 1e-3 && errors.windows(2).all(|pair| (1.7..2.3).contains(&(pair[0] / pair[1]))),
        "{errors:?}"
    );
    for ocr in [1.0, 1.5, 8.0_f64] {
        let mut sample = point(law(shear, 0.0, ocr), [-p0; 3]);
        let cell = Target::Stress(-p0);
        follow(&mut sample, [cell, Target::Strain(-1.0), cell, HELD], true, 500);
        let exact = M * p0 * (ocr / 2.0).powf(rest);
        let (_, q) = of_cauchy(&sample);
        assert!((q / exact - 1.0).abs() < 1e-6, "ocr {ocr}: {q} for {exact}");
    }
}

/// Under a cell pressure that stays the critical state is at p = 3 p_0/(3 - M); on the way the volume is a function of
/// η alone, and the shear strain its integral along the normal.
#[test]
fn drained_triaxial_volume_and_strain_to_the_critical_state() {
    let (swelling, compression) = slopes();
    let p0 = 1e5;
    let shear = 3e6;
    let hardening = compression - swelling;
    // (1 + λ̂) ln J = -λ̂ ln(p/p_0) - (λ̂ - κ̂) ln(1 + (η/M)²), p = 3 p_0/(3 - η).
    let volume = |eta: f64| {
        let grown = hardening * (1.0 + (eta / M).powi(2)).ln();
        -(compression * (3.0 / (3.0 - eta)).ln() + grown) / (1.0 + compression)
    };
    let plastic_volume = |eta: f64| volume(eta) + swelling * ((3.0 / (3.0 - eta)).ln() + volume(eta));
    let mut errors = Vec::new();
    for steps in [100, 200, 400] {
        let mut sample = point(law(shear, 0.0, 1.0), [-p0; 3]);
        let cell = Target::Stress(-p0);
        let mut worst = 0.0_f64;
        let control = Control {
            targets: [cell, Target::Strain(-0.2), cell, HELD],
            undrained: false,
            steps,
            duration: f64::INFINITY,
        };
        let followed = sample.follow(&control, |point| {
            let (p, q) = of_cauchy(point);
            assert!((q - 3.0 * (p - p0)).abs() < 1e-4);
            worst = worst.max((point.volume_strain() - volume(q / p)).abs());
        });
        followed.expect("a path");
        assert!(worst < 1e-9, "{worst}");
        let (p, q) = of_cauchy(&sample);
        let eta = q / p;
        let pieces = 200_000;
        let mut strain = q * sample.volume_strain().exp() / (3.0 * shear);
        for k in 0..pieces {
            let (from, to) = (
                eta * f64::from(k) / f64::from(pieces),
                eta * f64::from(k + 1) / f64::from(pieces),
            );
            let middle = 0.5 * (from + to);
            strain += (plastic_volume(from) - plastic_volume(to)) * 2.0 * middle / (M * M - middle * middle);
        }
        let found = -(sample.strain()[1] - sample.volume_strain() / 3.0);
        errors.push((found - strain).abs());
    }
    println!("{errors:?}");
    assert!(
        errors[2] < 1e-3 && errors.windows(2).all(|pair| (1.7..2.3).contains(&(pair[0] / pair[1]))),
        "{errors:?}"
    );
    let mut sample = point(law(shear, 0.0, 1.0), [-p0; 3]);
    let cell = Target::Stress(-p0);
    follow(&mut sample, [cell, Target::Strain(-3.0), cell, HELD], false, 400);
    let (p, _) = of_cauchy(&sample);
    assert!((p / (3.0 * p0 / (3.0 - M)) - 1.0).abs() < 1e-6 && (sample.volume_strain() - volume(M)).abs() < 1e-7);
}

/// Closed form: virgin compression without lateral strain has a constant η if the shear modulus is large,
/// `(M² - η²)/2η = 3/2 (1 - κ̂/λ̂)`.
#[test]
fn oedometer_tends_to_its_stress_ratio_and_slope() {
    let (swelling, compression) = slopes();
    let rest = 1.0 - swelling / compression;
    let exact = 0.5 * (-3.0 * rest + (9.0 * rest * rest + 4.0 * M * M).sqrt());
    let mut sample = point(law(1e10, 0.0, 1.0), [-1e4; 3]);
    follow(&mut sample, [HELD, Target::Stress(-1e5), HELD, HELD], false, 200);
    let before = of_cauchy(&sample).0;
    let start = sample.volume_strain();
    follow(&mut sample, [HELD, Target::Stress(-1e6), HELD, HELD], false, 200);
    let (p, q) = of_cauchy(&sample);
    let slope = -(sample.volume_strain() - start) / (p / before).ln();
    println!("eta {} for {exact}, slope {slope}", q / p);
    assert!(
        (q / p / exact - 1.0).abs() < 1e-3 && (slope / LAMBDA - 1.0).abs() < 1e-4,
        "{} {exact} {slope}",
        q / p
    );
}

#[test]
fn the_start_gives_the_ellipse_and_no_pressure_gives_none() {
    let clay = law(3e6, 0.0, 2.0);
    let mut state = [0.0];
    clay.initial_state([-4e4, -4e4, -1e5], &mut state);
    let p = 6e4;
    let q = 6e4;
    assert!((state[0] / (2.0 * (p + q * q / (M * M * p))) - 1.0).abs() < 1e-14);
    let given = law(3e6, 3e5, 0.0);
    given.initial_state([-4e4, -4e4, -1e5], &mut state);
    assert_eq!(state[0], 3e5);
    for mean in [0.0, 1e3] {
        let stress = Symmetric([mean, mean, mean, 0.0, 0.0, 0.0]);
        let none = Element::new(Material::CamClay(clay.clone()), stress);
        assert!(matches!(none, Err(ElementError::NoPressure)));
    }
    // A point that was given no state, and one torn or crushed beyond all pressures.
    let material = Material::CamClay(clay);
    for (eps, state) in [([0.0; 3], 0.0), ([30.0; 3], 1e5), ([-30.0; 3], 1e5)] {
        let answer = material.respond(&stretched(eps), &[state]);
        assert!(matches!(answer, Err(MaterialError::NoStress(_))), "{eps:?}: {answer:?}");
    }
}

#[test]
fn reduction_divides_the_tangent_of_the_critical_angle() {
    let ratio = law(3e6, 0.0, 1.0).reduced(2.0).parameters()[2];
    let tan = |ratio: f64| (3.0 * ratio / (6.0 + ratio)).asin().tan();
    assert!((tan(M) / tan(ratio) - 2.0).abs() < 1e-12);
}
