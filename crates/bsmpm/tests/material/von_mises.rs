//! Tests of Von Mises with linear hardening: yield, flow rule, tangent, and paths with closed forms.

use super::{answer, largest, respond, stretched, turned};
use crate::random::Random;
use bsmpm::material::{Branch, Elastic, Law, Material, VonMises, split};
use bsmpm::tensor::{Symmetric, Tensor};

const STRENGTH: f64 = 3.0; // Pa

fn law(poisson: f64, hardening: f64) -> VonMises {
    VonMises::new(Elastic { young: 1e3, poisson }, STRENGTH, hardening)
}

/// The stress lies on the surface of the state after the return; flow goes along the deviator, and κ grows by √(2/3) of
/// it.
#[test]
fn returns_lie_on_the_surface_that_has_grown_and_flow_along_its_normal() {
    let mut random = Random::new(70);
    let mut plastic = 0;
    for _ in 0..20_000 {
        let hardening = random.pick(&[0.0, 1.0, 1e3]);
        let law = law(random.pick(&[-0.5, 0.0, 0.3, 0.49]), hardening);
        let before = random.unit();
        let material = Material::VonMises(law);
        let (response, after) = answer(&material, &random.trial(-4.0, -0.7), before);
        let (_, deviator, norm) = split(response.principal_tau());
        let q = 1.5_f64.sqrt() * norm;
        let strength = STRENGTH + hardening * after;
        if response.branch() == Branch::Elastic {
            assert!(q <= strength * (1.0 + 1e-14) && after == before);
            continue;
        }
        plastic += 1;
        assert!((q - strength).abs() <= 1e-11 * strength, "{q} for {strength}");
        let trial = response.principal_eps_trial();
        let elastic = response.principal_eps_e();
        let flow: [f64; 3] = std::array::from_fn(|k| trial[k] - elastic[k]);
        let size = largest(&trial);
        assert!(
            (flow[0] + flow[1] + flow[2]).abs() <= 1e-13 * size,
            "no change of volume"
        );
        let along = |k: usize| 1.5 * (after - before) * deviator[k] / (STRENGTH + hardening * after);
        assert!((0..3).all(|k| (flow[k] - along(k)).abs() <= 1e-11 * size), "{flow:?}");
        assert!((response.plastic_increment() - (after - before)).abs() <= 1e-11 * size);
        let again = material.respond(&response.b_e(), &[after]).unwrap();
        assert!(
            largest(&std::array::from_fn::<f64, 3, _>(
                |k| again.principal_tau()[k] - response.principal_tau()[k]
            )) <= 1e-10 * strength
        );
    }
    assert!(plastic > 5_000);
}

/// Against fourth-order central differences, of distinct trial strains and of equal ones, elastic and yielding.
#[test]
fn tangent_is_the_derivative() {
    let mut random = Random::new(71);
    let mut worst = 0.0_f64;
    let mut seen = 0;
    for trial in 0..20_000 {
        let material = Material::VonMises(law(random.pick(&[0.0, 0.3, 0.49]), random.pick(&[0.0, 10.0, 1e3])));
        let eps = random.strains(-2.5, -0.7);
        let eps = if trial % 4 == 0 { [eps[0], eps[0], eps[2]] } else { eps };
        let b = turned(&random.rotation(), &stretched(eps));
        let l = Tensor::from_fn(|_, _| random.signed());
        let tau = |steps: f64| {
            let step = Tensor::identity() + l * (steps * 1e-6);
            material.respond(&turned(&step, &b), &[0.1]).unwrap()
        };
        let found = material.respond(&b, &[0.1]).unwrap();
        let around = [-2.0, -1.0, 1.0, 2.0].map(tau);
        if around.iter().any(|moved| moved.branch() != found.branch()) {
            continue;
        }
        let [a, b, c, d] = around.map(|moved| moved.tau().full());
        let difference = (a - d + (c - b) * 8.0) / 12e-6;
        worst = worst.max((difference - found.linearise(&l)).amax() / 1e3);
        seen += usize::from(found.branch() == Branch::Face);
    }
    println!("{seen} yielding, error {worst:.1e} of Young's modulus");
    assert!(seen > 10_000 && worst < 1e-7, "{seen}, {worst}");
}

/// Shear without change of volume: τ = G γ, then √3 τ = σ_y + H κ with γ = τ/G + √3 κ in logarithmic strain, in one
/// step or many.
#[test]
fn pure_shear_hardens_linearly_in_any_number_of_steps() {
    let hardening = 50.0;
    let way = 0.1; // principal strains ± way
    let law = law(0.3, hardening);
    let shear = law.elastic().moduli().mu;
    // q = √3 τ₁, q = 3 μ (2/√3 way - κ) = σ_y + H κ.
    let kappa = (3.0 * shear * 2.0 / 3_f64.sqrt() * way - STRENGTH) / (3.0 * shear + hardening);
    let exact = (STRENGTH + hardening * kappa) / 3_f64.sqrt();
    let material = Material::VonMises(law);
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
            (state - kappa).abs() <= 1e-12 && (tau - exact).abs() <= 1e-12 * exact,
            "{steps}: {state} {tau}"
        );
    }
}

#[test]
fn reduction_divides_strength_and_hardening() {
    let reduced = law(0.3, 40.0).reduced(2.0);
    assert_eq!(reduced.parameters(), [1.5, 20.0]);
    let b = stretched([1e-4, 0.0, -1e-4]);
    assert_eq!(
        respond(&super::hencky(1e3, 0.3), &b).tau(),
        Material::VonMises(reduced).respond(&b, &[0.0]).unwrap().tau()
    );
}
