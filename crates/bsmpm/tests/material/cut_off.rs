//! Tests of the tension cut-off: yield, flow rules, tangent, and paths with closed forms.

use super::projection::{HalfSpace, closest, pyramid};
use super::{largest, mohr_coulomb, stretched, turned};
use crate::random::Random;
use bsmpm::material::{
    Branch, CutOff, Decay, DruckerPrager, Elastic, Law, Match, Material, Moduli, MohrCoulomb, Response,
    TensileStrength, VonMises, split,
};
use bsmpm::tensor::{Symmetric, Tensor};
use nalgebra::{Matrix3, Vector3};
use std::array::from_fn;

const YOUNG: f64 = 1e3; // Pa
const COHESION: f64 = 1.0; // Pa

fn constant(strength: f64) -> TensileStrength {
    TensileStrength {
        strength,
        strain: 0.0,
        decay: Decay::Linear,
        is_reduced: false,
    }
}

fn elastic(poisson: f64) -> Elastic {
    Elastic { young: YOUNG, poisson }
}

/// Mohr-Coulomb with a cut-off, angles in degrees.
fn pyramid_law(poisson: f64, friction: f64, dilation: f64, tension: TensileStrength) -> CutOff<MohrCoulomb> {
    let [friction, dilation] = [friction, dilation].map(f64::to_radians);
    CutOff::new(
        MohrCoulomb::new(elastic(poisson), friction, dilation, COHESION),
        tension,
    )
}

/// A random tensile strength below the apex of a law with cohesion; often zero.
fn strength(random: &mut Random, friction: f64) -> f64 {
    let apex = if friction > 0.0 {
        (COHESION / friction.to_radians().tan()).min(3.0)
    } else {
        3.0
    };
    apex * random.pick(&[0.0, 0.1, 0.5, 0.95])
}

/// A softening that is less steep than the elastic stiffness.
fn softening(random: &mut Random, strength: f64) -> TensileStrength {
    TensileStrength {
        strain: strength / YOUNG * random.pick(&[0.0, 6.0, 60.0]),
        decay: random.pick(&[Decay::Linear, Decay::Exponential]),
        ..constant(strength)
    }
}

/// Any of the laws with a cut-off, and whether plastic flow is associated.
struct Drawn {
    material: Material,
    is_associated: bool,
}

fn draw(random: &mut Random, trial: usize) -> Drawn {
    let friction = random.pick(&[0.0, 15.0, 30.0, 45.0]);
    let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
    let poisson = random.pick(&[0.0, 0.3, 0.45]);
    let strength = strength(random, friction);
    let tension = softening(random, strength);
    let material = match trial % 3 {
        0 => Material::MohrCoulombCutOff(pyramid_law(poisson, friction, dilation, tension)),
        1 => {
            let [friction, dilation] = [friction, dilation].map(f64::to_radians);
            let fit = random.pick(&[Match::Inner, Match::PlaneStrain]);
            let cone = DruckerPrager::new(elastic(poisson), friction, dilation, COHESION, fit);
            Material::DruckerPragerCutOff(CutOff::new(cone, tension))
        }
        _ => {
            let hardening = random.pick(&[0.0, 50.0]);
            let cylinder = VonMises::new(elastic(poisson), 2.0 * COHESION, hardening);
            Material::VonMisesCutOff(CutOff::new(cylinder, tension))
        }
    };
    Drawn {
        material,
        is_associated: friction == dilation,
    }
}

/// The response from a state, and the state after it.
fn answer(material: &Material, b: &Symmetric, state: &[f64]) -> (Response, Vec<f64>) {
    let response = material.respond(b, state).expect("an admissible trial");
    let mut after = state.to_vec();
    response.advance(&mut after);
    (response, after)
}

/// Trial strains with as much tension as compression, in a fifth of the calls with two equal ones.
fn strains(random: &mut Random) -> [f64; 3] {
    let [x, y, z] = random.strains(-3.5, -1.0);
    let mean = (x.abs() + y.abs() + z.abs()) * 0.2;
    let [x, y, z] = [x + mean, y + mean, z + mean];
    random.pick(&[[x, y, z], [x, y, z], [x, y, z], [x, x, z], [x, y, y]])
}

/// Reference: the closest point of both surfaces in the energy norm, by trying all planes.
#[test]
fn associated_return_is_the_closest_point_of_both_surfaces() {
    let mut random = Random::new(90);
    let mut worst = 0.0_f64;
    let mut cracked = 0;
    for _ in 0..10_000 {
        let friction = random.pick(&[0.0, 15.0, 30.0, 45.0]);
        let strength = strength(&mut random, friction);
        let law = pyramid_law(
            random.pick(&[-0.4, 0.0, 0.3, 0.45]),
            friction,
            friction,
            constant(strength),
        );
        let material = Material::MohrCoulombCutOff(law);
        let (found, after) = answer(&material, &stretched(strains(&mut random)), &[0.0]);
        if found.branch() == Branch::Elastic {
            continue;
        }
        cracked += usize::from(after[0] > 0.0);
        let Moduli { lambda, mu } = material.elastic().moduli();
        let stiffness = Matrix3::from_element(lambda) + Matrix3::identity() * (2.0 * mu);
        let trial = stiffness * Vector3::from(found.principal_eps_trial());
        let (sin, cos) = friction.to_radians().sin_cos();
        let mut planes = pyramid(sin, 2.0 * COHESION * cos);
        planes.extend((0..3).map(|axis| HalfSpace {
            normal: Vector3::ith(axis, 1.0),
            strength,
        }));
        let exact = closest(trial, stiffness, &planes);
        let tau = found.principal_tau();
        let error = largest(&from_fn::<f64, 3, _>(|k| tau[k] - exact[k])) / trial.amax();
        assert!(error < 1e-9, "{tau:?} for {exact:?} with {material:?}");
        worst = worst.max(error);
    }
    println!("{cracked} with cracks, distance to the closest point {worst:.2e}");
    assert!(cracked > 4_000);
}

/// Koiter's conditions with any dilation: the planes of Mohr-Coulomb flow along their potential, cracks along their
/// normal, and only planes that the stress lies on flow.
///
/// The planes change the volume by `(1 + sin ψ)` of the strain of the first axes per `-(1 - sin ψ)` of that of the
/// last ones; what exceeds this ratio is the sum of the crack strains.
#[test]
fn planes_of_both_surfaces_flow_along_their_own_direction() {
    let mut random = Random::new(91);
    let mut seen = [0, 0];
    for _ in 0..20_000 {
        let friction = random.pick(&[0.0, 15.0, 30.0, 45.0]);
        let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
        let strength = strength(&mut random, friction);
        let law = pyramid_law(random.pick(&[0.0, 0.3, 0.45]), friction, dilation, constant(strength));
        let material = Material::MohrCoulombCutOff(law);
        let (found, after) = answer(&material, &stretched(strains(&mut random)), &[0.0]);
        let tau = found.principal_tau();
        let trial = found.principal_eps_trial();
        let elastic = found.principal_eps_e();
        let plastic: [f64; 3] = from_fn(|k| trial[k] - elastic[k]);
        let sin = dilation.to_radians().sin();
        let ratio = (1.0 + sin) / (1.0 - sin);
        let weighted = plastic.map(|strain| if strain < 0.0 { ratio * strain } else { strain });
        let size = 1e-12 * largest(&trial) * ratio;
        let crack: f64 = weighted.iter().sum();
        assert!((crack - after[0]).abs() <= size, "{crack:e} {after:?} {plastic:?}");
        let sheared = -plastic.iter().map(|strain| strain.min(0.0)).sum::<f64>();
        let (sin, cos) = friction.to_radians().sin_cos();
        let excess = (tau[0] - tau[2]) + (tau[0] + tau[2]) * sin - 2.0 * COHESION * cos;
        let stress = 1e-11 * (largest(&tau) + COHESION + YOUNG * largest(&trial));
        assert!(excess <= stress && tau[0] <= strength);
        assert!(sheared <= size || excess >= -stress, "shears below yield: {found:?}");
        assert!(after[0] <= size || tau[0] >= strength - stress, "cracks below strength");
        seen[0] += usize::from(after[0] > size && sheared > size);
        seen[1] += usize::from(after[0] > size && sheared <= size);
    }
    println!("{seen:?} with and without shear");
    assert!(seen.iter().all(|count| *count > 2_000), "{seen:?}");
}

/// Cone and cylinder flow along their potential at the final stress; the rest are cracks.
#[test]
fn cones_flow_along_their_potential_and_cracks_take_the_rest() {
    let mut random = Random::new(92);
    let mut seen = [0; 4];
    for _ in 0..20_000 {
        let friction = random.pick(&[0.0, 15.0, 30.0, 45.0]);
        let [phi, psi] = [friction, friction * random.pick(&[0.0, 0.5, 1.0])].map(f64::to_radians);
        let fit = random.pick(&[Match::Inner, Match::PlaneStrain]);
        let cone = DruckerPrager::new(elastic(0.3), phi, psi, COHESION, fit);
        let slope = DruckerPrager::new(elastic(0.3), psi, 0.0, COHESION, fit).cone().0;
        let law = CutOff::new(cone, constant(strength(&mut random, friction)));
        let material = Material::DruckerPragerCutOff(law);
        let (found, after) = answer(&material, &stretched(strains(&mut random)), &[0.0]);
        let (_, deviator, norm) = split(found.principal_tau());
        let trial = found.principal_eps_trial();
        let elastic = found.principal_eps_e();
        let plastic: [f64; 3] = from_fn(|k| trial[k] - elastic[k]);
        if after[0] == 0.0 || norm < 1e-6 {
            continue;
        }
        let cracks = if found.branch() == Branch::LeftEdge { 2 } else { 1 };
        let direction = deviator.map(|part| part / (norm * 2.0_f64.sqrt()) + slope / 3.0);
        let multiplier = plastic[2] / direction[2];
        let size = 1e-9 * largest(&trial);
        let crack: f64 = (0..cracks).map(|k| plastic[k] - multiplier * direction[k]).sum();
        assert!((crack - after[0]).abs() <= size, "{crack:e} {after:?} {found:?}");
        assert!(multiplier >= -size, "{multiplier:e}");
        assert!(cracks == 2 || (plastic[1] - multiplier * direction[1]).abs() <= size);
        seen[cracks - 1 + 2 * usize::from(multiplier > size)] += 1;
    }
    println!("one and two cracks, elastic and yielding: {seen:?}");
    assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
}

/// The stress satisfies both conditions, in the state after the return; a second return changes nothing, and no work is
/// created.
#[test]
fn stress_lies_inside_both_surfaces_and_stays_there() {
    let mut random = Random::new(93);
    for trial in 0..30_000 {
        let Drawn { material, .. } = draw(&mut random, trial);
        let mut state = vec![0.0; material.state().len()];
        let mut b_e = Symmetric::IDENTITY;
        for _ in 0..2 {
            let step = turned(&random.rotation(), &stretched(strains(&mut random)));
            let b = if b_e == Symmetric::IDENTITY {
                step
            } else {
                turned(&step.full(), &b_e)
            };
            let (found, after) = answer(&material, &b, &state);
            let tau = found.principal_tau();
            let size = largest(&tau) + COHESION + YOUNG * largest(&found.principal_eps_trial());
            assert!(
                material.yield_function(tau, &after) <= 1e-13 * size,
                "{found:?} of {material:?}"
            );
            assert!(tau[0] >= tau[1] && tau[1] >= tau[2]);
            assert!(
                found.dissipation() >= -1e-12 * size && after.iter().zip(&state).all(|(a, b)| a >= b),
                "{:e} of {material:?}",
                found.dissipation()
            );
            (b_e, state) = (found.b_e(), after);
            let again = material.respond(&b_e, &state).unwrap().principal_tau();
            assert!(largest(&from_fn::<f64, 3, _>(|k| again[k] - tau[k])) <= 1e-11 * size);
        }
    }
}

/// Against fourth-order central differences; with associated flow also symmetric.
#[test]
fn tangent_is_the_derivative() {
    let mut random = Random::new(94);
    let mut worst = 0.0_f64;
    let mut seen = [0; 5];
    for trial in 0..40_000 {
        let Drawn {
            material,
            is_associated,
        } = draw(&mut random, trial);
        let mut state = vec![0.0; material.state().len()];
        *state.last_mut().unwrap() = random.pick(&[0.0, 1e-4]);
        let b = turned(&random.rotation(), &stretched(strains(&mut random)));
        let l = Tensor::from_fn(|_, _| random.signed());
        let tau = |steps: f64| {
            let step = Tensor::identity() + l * (steps * 1e-7);
            answer(&material, &turned(&step, &b), &state)
        };
        let (found, after) = answer(&material, &b, &state);
        let around = [-2.0, -1.0, 1.0, 2.0].map(tau);
        // Equal trial strains are a corner for this count, and are tried by the test below.
        let kind = |response: &Response, after: &[f64]| {
            let cracks = after.last() > state.last();
            let shears = response.plastic_increment() > 0.0;
            (response.branch(), cracks, shears, after.last().unwrap() * YOUNG > 1.0)
        };
        let eps = found.principal_eps_trial();
        let apart = (eps[0] - eps[1]).min(eps[1] - eps[2]) > 1e-5;
        if !apart
            || around
                .iter()
                .any(|moved| kind(&moved.0, &moved.1) != kind(&found, &after))
        {
            continue;
        }
        if after.last() == state.last() {
            continue;
        }
        let [a, b, c, d] = around.map(|moved| moved.0.tau().full());
        let difference = (a - d + (c - b) * 8.0) / 12e-7;
        let exact = found.linearise(&l);
        let error = (difference - exact).amax() / YOUNG;
        if error > 1e-4 {
            println!("{error:e} {material:?} {state:?} {after:?} {found:?}");
        }
        worst = worst.max(error);
        let branch = found.branch();
        seen[super::REGIONS.iter().position(|region| *region == branch).unwrap()] += 1;
        if is_associated {
            let m = Tensor::from_fn(|_, _| random.signed());
            let [l, m] = [l, m].map(|l| (l + l.transpose()) * 0.5);
            let asymmetry = principal_work(&found, &l, &m) - principal_work(&found, &m, &l);
            assert!(asymmetry.abs() <= 1e-9 * YOUNG, "{asymmetry:e} of {material:?}");
        }
    }
    println!("{seen:?} cracked, error {worst:.1e} of Young's modulus");
    assert!(
        seen[1..].iter().all(|count| *count > 100) && worst < 1e-6,
        "{seen:?} {worst:e}"
    );
}

/// The work of the stress change by one gradient on another, along the principal axes of the trial.
fn principal_work(response: &Response, l: &Tensor, m: &Tensor) -> f64 {
    let axes = response.b_e().full().symmetric_eigen().eigenvectors;
    let diagonal = |t: Tensor| Tensor::from_diagonal(&(axes.transpose() * t * axes).diagonal());
    let driven = |t: &Tensor| axes * diagonal(*t) * axes.transpose();
    response.linearise(&driven(l)).dot(&driven(m))
}

/// At the apex and beyond, the cut-off changes no bit.
#[test]
fn a_tensile_strength_at_the_apex_is_no_cut_off() {
    let mut random = Random::new(95);
    for _ in 0..5_000 {
        let friction = random.pick(&[15.0, 30.0, 45.0]);
        let dilation = friction * random.unit();
        let apex = COHESION / f64::to_radians(friction).tan();
        let b = turned(&random.rotation(), &stretched(strains(&mut random)));
        let whole = mohr_coulomb(YOUNG, 0.3, friction, dilation, COHESION);
        let cut = Material::MohrCoulombCutOff(pyramid_law(0.3, friction, dilation, constant(apex * (1.0 + 1e-12))));
        let [a, b] = [whole, cut].map(|material| material.respond(&b, &[0.0]).unwrap());
        assert_eq!((a.tau(), a.b_e(), a.branch()), (b.tau(), b.b_e(), b.branch()));
        let l = Tensor::from_fn(|_, _| random.signed());
        assert_eq!(a.linearise(&l), b.linearise(&l));
    }
}

/// Uniaxial tension: elastic up to the strength, then softening. Until nothing is left, the work per volume is the area
/// below the curve of softening, `f_t κ_r/2` or `f_t κ_r/3`, in any number of steps and for one, two and three cracks.
#[test]
fn cracks_soften_to_zero_and_dissipate_the_fracture_energy() {
    for decay in [Decay::Linear, Decay::Exponential] {
        for axes in 1..=3 {
            for steps in [400, 1600] {
                let tension = TensileStrength {
                    strain: if decay == Decay::Linear { 0.016 } else { 0.024 },
                    decay,
                    ..constant(0.5)
                };
                let law = pyramid_law(0.0, 30.0, 0.0, tension);
                let material = Material::MohrCoulombCutOff(law);
                let last = if decay == Decay::Linear { 0.04 } else { 0.2 };
                let mut b_e = Symmetric::IDENTITY;
                let mut state = vec![0.0];
                let mut most = 0.0_f64;
                let mut dissipated = 0.0;
                for _ in 0..steps {
                    let ratio = (2.0 * last / f64::from(steps)).exp();
                    let b = Symmetric(from_fn(|k| if k < axes { b_e.0[k] * ratio } else { b_e.0[k] }));
                    let (found, after) = answer(&material, &b, &state);
                    most = most.max(found.principal_tau()[0]);
                    dissipated += found.dissipation();
                    (b_e, state) = (found.b_e(), after);
                }
                let left = material.respond(&b_e, &state).unwrap().principal_tau()[0];
                // A step dissipates with the strength at its end, on average half a step's decrease less than the mean.
                // The crack strain of a step exceeds the strain by the elastic part that it releases.
                let steepest = 0.5 * 0.5 / 4e-3 / YOUNG;
                let crack_strain = last * axes as f64 / (1.0 - axes as f64 * steepest);
                let error = 0.5 * 0.5 * crack_strain / f64::from(steps);
                assert!(most <= 0.5 && most > 0.4, "{most}");
                assert!(
                    left.abs() <= if decay == Decay::Linear { 1e-12 } else { 1e-8 },
                    "{left:e}"
                );
                assert!(
                    (dissipated - 4e-3).abs() <= error,
                    "{dissipated:e} for 4e-3 within {error:e}, {decay:?} along {axes} axes in {steps} steps"
                );
            }
        }
    }
}

#[test]
fn reduction_divides_the_tensile_strength_on_request() {
    for is_reduced in [false, true] {
        let tension = TensileStrength {
            strain: 3.0,
            is_reduced,
            ..constant(0.5)
        };
        let whole = pyramid_law(0.3, 30.0, 10.0, tension);
        let reduced = whole.clone().reduced(2.0);
        let expected = if is_reduced { [0.25, 3.0] } else { [0.5, 3.0] };
        assert_eq!(reduced.parameters()[3..], expected);
        assert_eq!(reduced.law(), &whole.law().clone().reduced(2.0));
    }
}

#[test]
fn a_cut_off_stores_its_crack_strain_after_the_state_of_its_law() {
    let cylinder = VonMises::new(elastic(0.3), 2.0, 50.0);
    let material = Material::VonMisesCutOff(CutOff::new(cylinder, constant(0.5)));
    let names: Vec<_> = material.state().iter().map(|variable| variable.name).collect();
    assert_eq!(names, ["hardening_strain", "crack_strain"]);
    let names: Vec<_> = material
        .parameter_names()
        .iter()
        .map(|variable| variable.name)
        .collect();
    assert_eq!(
        names,
        ["yield_stress", "hardening", "tensile_strength", "crack_opening"]
    );
}
