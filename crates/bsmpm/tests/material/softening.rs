//! Tests of softening Mohr-Coulomb: yield, tangent, and paths with closed forms.

use super::{answer, largest, mohr_coulomb, stretched, turned};
use crate::random::Random;
use bsmpm::element::{Control, Element, Target};
use bsmpm::material::{Branch, Decay, Elastic, Law, Material, Rate, Response, SofteningMohrCoulomb, Strength};
use bsmpm::tensor::{Symmetric, Tensor};
use std::collections::BTreeMap;

const DECAYS: [Decay; 2] = [Decay::Linear, Decay::Exponential];

/// Angles in degrees.
fn law(poisson: f64, peak: [f64; 3], residual: [f64; 3], strain: f64, decay: Decay) -> SofteningMohrCoulomb {
    let strength = |[phi, psi, cohesion]: [f64; 3]| Strength {
        friction_angle: phi.to_radians(),
        dilation_angle: psi.to_radians(),
        cohesion,
    };
    SofteningMohrCoulomb::new(
        Elastic { young: 1e3, poisson },
        strength(peak),
        strength(residual),
        strain,
        decay,
    )
}

/// Laws that soften and harden, some of them in strength or angles only, with and without dilation.
fn random_law(random: &mut Random) -> SofteningMohrCoulomb {
    let peak = random.pick(&[[30.0, 10.0, 2.0], [40.0, 40.0, 0.5], [25.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
    let residual = random.pick(&[[20.0, 0.0, 0.5], [30.0, 10.0, 2.0], [35.0, 0.0, 0.1], [0.0, 0.0, 1.0]]);
    law(
        random.pick(&[0.0, 0.3, 0.49]),
        peak,
        residual,
        random.pick(&[0.02, 0.1, 1.0]),
        random.pick(&DECAYS),
    )
}

/// The stress lies on the surface of the strength that the plastic strain after the return leaves, and κ grows by it.
#[test]
fn returns_lie_on_the_surface_of_their_own_plastic_strain() {
    let mut random = Random::new(80);
    let mut seen = BTreeMap::new();
    for _ in 0..40_000 {
        let material = Material::SofteningMohrCoulomb(random_law(&mut random));
        let before = 0.1 * random.unit();
        let (response, after) = answer(&material, &random.trial(-4.0, -0.7), before);
        let tau = response.principal_tau();
        let size = largest(&tau).max(1e-3);
        let excess = material.yield_function(tau, &[after]);
        *seen.entry(format!("{:?}", response.branch())).or_insert(0) += 1;
        if response.branch() == Branch::Elastic {
            assert!(excess <= 0.0 && after == before);
            continue;
        }
        let trial = largest(&response.principal_eps_trial());
        assert!(
            excess.abs() <= 1e-11 * (size + 1e3 * trial),
            "{excess:e} of {size:e}, {material:?}"
        );
        let growth = after - before;
        let increment = response.plastic_increment();
        assert!(
            (increment - growth).abs() <= 1e-11 * (growth + trial),
            "{increment:e} for {growth:e} of {trial:e}, {material:?}"
        );
        assert!(response.dissipation() >= -1e-12 * size * trial);
    }
    println!("{seen:?}");
    assert!(seen.len() == 5 && seen.values().all(|&count| count > 1_000), "{seen:?}");
}

/// Reference: Mohr-Coulomb, bit by bit.
#[test]
fn with_one_strength_it_is_mohr_coulomb() {
    let mut random = Random::new(81);
    let strength = [32.0, 8.0, 1.5];
    let perfect = mohr_coulomb(1e3, 0.3, strength[0], strength[1], strength[2]);
    for decay in DECAYS {
        let material = Material::SofteningMohrCoulomb(law(0.3, strength, strength, 0.05, decay));
        for _ in 0..5_000 {
            let b = random.trial(-4.0, -0.7);
            let found = answer(&material, &b, random.unit()).0;
            let exact = perfect.respond(&b, &[]).unwrap();
            assert_eq!(found.branch(), exact.branch());
            assert_eq!(found.principal_tau(), exact.principal_tau());
            let l = Tensor::from_fn(|_, _| random.signed());
            assert!((found.linearise(&l) - exact.linearise(&l)).amax() <= 1e-9 * 1e3);
        }
    }
}

/// Against fourth-order central differences, where these stay on one branch and on one side of the last strength, and
/// turn no axes far.
#[test]
fn tangent_is_the_derivative() {
    let mut random = Random::new(82);
    let mut worst = 0.0_f64;
    let mut seen = BTreeMap::new();
    for _ in 0..40_000 {
        // Also with a rate, in a step so long that whatever flows is above the reference.
        let rate = Rate {
            per_decade: 0.1,
            reference: 1e-13,
        };
        let law = random_law(&mut random);
        let rated = random.unit() < 0.5;
        let law = if !rated {
            law
        } else {
            law.at_rate(rate).with_time_step(1.0).expect("a rate")
        };
        let strain = law.parameters()[6];
        let before = 0.05 * random.unit();
        let material = Material::SofteningMohrCoulomb(law);
        let mut eps = random.strains(-2.5, -0.7);
        eps.sort_by(f64::total_cmp);
        if eps[1] - eps[0] < 1e-4 || eps[2] - eps[1] < 1e-4 {
            continue;
        }
        let b = turned(&random.rotation(), &stretched(eps));
        let l = Tensor::from_fn(|_, _| random.signed());
        let (found, after) = answer(&material, &b, before);
        let around = [-2.0, -1.0, 1.0, 2.0].map(|steps| {
            let step = Tensor::identity() + l * (steps * 1e-6);
            answer(&material, &turned(&step, &b), before)
        });
        let alike =
            |moved: &(Response, f64)| moved.0.branch() == found.branch() && (moved.1 < strain) == (after < strain);
        // The logarithm of a plastic strain that is no larger than the differences has none.
        let slow = rated && after > before && after - before < 1e-3;
        if slow || !around.iter().all(alike) {
            continue;
        }
        let [a, b, c, d] = around.map(|(moved, _)| moved.tau().full());
        let difference = (a - d + (c - b) * 8.0) / 12e-6;
        let error = (difference - found.linearise(&l)).amax() / 1e3;
        *seen.entry(format!("{:?}", found.branch())).or_insert(0) += 1;
        worst = worst.max(error);
    }
    println!("{seen:?}, error {worst:.1e} of Young's modulus");
    assert!(
        seen.len() == 5 && seen.values().all(|&count| count > 1_000) && worst < 1e-6,
        "{seen:?}, {worst}"
    );
}

/// Steps as they come on a surface that a rate has hardened: trials anywhere between the strength at rest and what it
/// is twelve decades above the reference, so that the plastic strain may be of any size.
#[test]
fn a_strength_by_the_rate_is_found_whatever_the_plastic_strain() {
    let young = 1e3;
    let poisson = 0.49;
    let peak = 3.0;
    let per_decade = 0.1;
    let shear = Elastic { young, poisson }.moduli().mu;
    let mut least = f64::INFINITY;
    for (k, reference) in (0..2_000).flat_map(|k| [1e-3, 1e-7, 1e-10, 1e-13].map(|reference| (k, reference))) {
        let law = law(poisson, [0.0, 0.0, peak], [0.0, 0.0, peak], 1.0, Decay::Exponential);
        let law = law
            .at_rate(Rate { per_decade, reference })
            .with_time_step(1.0)
            .expect("a rate");
        let material = Material::SofteningMohrCoulomb(law);
        let beyond = peak * (1.0 + 2.2 * f64::from(k) / 2_000.0); // of the strength at rest
        let strain = beyond / (2.0 * shear);
        let (response, after) = answer(&material, &stretched([strain, 0.0, -strain]), 0.0);
        let found = 0.5 * (response.principal_tau()[0] - response.principal_tau()[2]);
        let quick = 1.0 + per_decade * (after * 3.0_f64.sqrt() / reference).log10().max(0.0);
        assert!(
            (found / (peak * quick) - 1.0).abs() < 1e-9,
            "{found} at {after:e}, {reference:e}"
        );
        least = if after > 0.0 { least.min(after) } else { least };
    }
    println!("plastic strains from {least:.1e}");
    assert!(least < 1e-12, "{least}");
}

/// Closed form: shear of constant volume without friction, `2μ (e - p) = c(κ)` with κ = 2p/√3, in one step or many.
#[test]
fn pure_shear_softens_by_its_own_plastic_strain_in_any_number_of_steps() {
    let peak = 3.0;
    let residual = 1.0;
    let strain = 0.1;
    for (decay, way) in [(Decay::Linear, 0.05), (Decay::Linear, 0.3), (Decay::Exponential, 0.08)] {
        let law = law(0.3, [0.0, 0.0, peak], [0.0, 0.0, residual], strain, decay);
        let shear = law.elastic().moduli().mu;
        let cohesion = |kappa: f64| match decay {
            Decay::Linear => peak + (residual - peak) * (kappa / strain).min(1.0),
            Decay::Exponential => residual + (peak - residual) * (-3.0 * kappa / strain).exp(),
        };
        let rest = |plastic: f64| 2.0 * shear * (way - plastic) - cohesion(2.0 / 3.0_f64.sqrt() * plastic);
        let mut low = 0.0;
        let mut high = way;
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if rest(middle) > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        let kappa = 2.0 / 3.0_f64.sqrt() * low;
        let material = Material::SofteningMohrCoulomb(law);
        for steps in [1, 7] {
            let mut b_e = Symmetric::IDENTITY;
            let mut state = 0.0;
            let mut tau = 0.0;
            for _ in 0..steps {
                let [x, y, z, ..] = b_e.0;
                let ratio = (2.0 * way / f64::from(steps)).exp();
                let (response, after) = answer(&material, &Symmetric([x * ratio, y / ratio, z, 0.0, 0.0, 0.0]), state);
                (b_e, state, tau) = (response.b_e(), after, response.principal_tau()[0]);
            }
            assert!(
                (state - kappa).abs() <= 1e-12,
                "{decay:?}, {steps}: {state} for {kappa}"
            );
            assert!((tau - cohesion(kappa)).abs() <= 1e-11, "{decay:?}, {steps}: {tau}");
        }
    }
}

/// In plane strain under a lateral stress that stays, σ₁/σ₃ falls from its value at the peak to the residual one.
#[test]
fn a_drained_biaxial_path_ends_at_the_residual_strength() {
    let peak = [38.0, 8.0, 0.2];
    let residual = [30.0, 0.0, 0.0];
    let lateral = -1.0;
    let passive = |[phi, _, c]: [f64; 3]| {
        let sin = phi.to_radians().sin();
        (lateral * (1.0 + sin) - 2.0 * c * phi.to_radians().cos()) / (1.0 - sin)
    };
    let material = Material::SofteningMohrCoulomb(law(0.3, peak, residual, 0.05, Decay::Linear));
    let mut b_e = Symmetric::IDENTITY;
    let mut state = 0.0;
    let mut most = 0.0_f64;
    let mut last = 0.0;
    for _ in 0..400 {
        let [x, y, z, ..] = b_e.0;
        let axial = (-2.0 * 5e-4_f64).exp();
        let respond = |stretch: f64| answer(&material, &Symmetric([x * stretch, y * axial, z, 0.0, 0.0, 0.0]), state);
        let mut low = 0.9;
        let mut high = 1.1;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if respond(middle).0.tau().0[0] < lateral {
                low = middle
            } else {
                high = middle
            }
        }
        let (response, after) = respond(low);
        (b_e, state) = (response.b_e(), after);
        last = response.tau().0[1];
        most = most.min(last);
    }
    println!("{most} of {}, then {last} of {}", passive(peak), passive(residual));
    assert!((last - passive(residual)).abs() <= 1e-9, "{last}");
    assert!(
        most > passive(peak) && most < passive(peak) * 0.95,
        "{most} of {}",
        passive(peak)
    );
}

#[test]
fn reduction_divides_both_strengths() {
    let reduced = law(0.3, [30.0, 5.0, 4.0], [20.0, 0.0, 2.0], 0.1, Decay::Linear).reduced(2.0);
    let parameters = reduced.parameters();
    let tangents = [parameters[0].tan(), parameters[3].tan()];
    let expected = [30.0_f64, 20.0].map(|phi| phi.to_radians().tan() / 2.0);
    assert!((0..2).all(|k| (tangents[k] - expected[k]).abs() < 1e-15));
    assert_eq!((parameters[2], parameters[5], parameters[6]), (2.0, 1.0, 0.1));
}

/// In shear that goes on at a rate the cohesion is c (δ + (1 - δ) exp(-3 ξ/ξ_95)) (1 + μ_r log₁₀(γ̇/γ̇_ref)), whatever
/// the steps; below the reference, or outside of a step, the rate does nothing.
#[test]
fn shear_at_a_rate_is_einav_and_randolphs() {
    let young = 1e6;
    let peak = 3e3;
    let sensitivity = 4.0;
    let reference = 1e-4;
    let per_decade = 0.15;
    let xi = 0.4;
    let clay = |rate| {
        let elastic = Elastic { young, poisson: 0.49 };
        let strain = xi / 3.0_f64.sqrt();
        let [first, last] = [peak, peak / sensitivity].map(|cohesion| Strength {
            cohesion,
            ..Strength::default()
        });
        let law = SofteningMohrCoulomb::new(elastic, first, last, strain, Decay::Exponential);
        Material::SofteningMohrCoulomb(law.at_rate(Rate {
            per_decade: rate,
            reference,
        }))
    };
    let mut shown = Vec::new();
    for (duration, steps) in [(0.5, 200), (0.5, 800), (1e5, 200), (f64::INFINITY, 200)] {
        let mut sample = Element::new(clay(per_decade), Symmetric::default()).unwrap();
        let way = 0.25;
        let volume = Target::Strain(0.0);
        let targets = [Target::Strain(way), Target::Strain(-way), volume, volume];
        let mut last = 0.0;
        sample
            .follow(
                &Control {
                    targets,
                    undrained: false,
                    steps,
                    duration,
                },
                |point| {
                    last = 0.5 * (point.sigma().0[0] - point.sigma().0[1]);
                },
            )
            .unwrap();
        // γ = 2 way, all plastic but what the falling stress gives back.
        let kappa = sample.state()[0];
        let shear = 2.0 * way / duration;
        let left = 1.0 / sensitivity + (1.0 - 1.0 / sensitivity) * (-3.0 * 3.0_f64.sqrt() * kappa / xi).exp();
        let quick = 1.0 + per_decade * (shear / reference).log10().max(0.0);
        let exact = peak * left * quick;
        shown.push(last / exact - 1.0);
        assert!((last / exact - 1.0).abs() < 2e-4, "{last} for {exact} in {duration} s");
    }
    println!("{shown:?}");
    let b = stretched([0.01, 0.0, -0.01]);
    let static_law = clay(0.0).respond(&b, &[0.0]).unwrap().principal_tau();
    assert_eq!(
        clay(per_decade).respond(&b, &[0.0]).unwrap().principal_tau(),
        static_law
    );
}
