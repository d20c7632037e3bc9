//! Tests of one material point at extreme strain, strength and stiffness.

use crate::physics::random::Random;
use crate::physics::scene::hencky;
use crate::table::Found;
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::material::{Branch, Elastic, Material, MohrCoulomb, Response};
use bsmpm::tensor::{Symmetric, Tensor};

const YOUNG: f64 = 1e3;
/// Friction angles of the random trials, degrees.
const FRICTIONS: [f64; 6] = [0.0, 1e-9, 20.0, 45.0, 60.0, 89.9];

/// Angles in degrees.
fn mohr_coulomb(poisson: f64, friction: f64, dilation: f64, cohesion: f64) -> Material {
    let friction = friction.to_radians();
    let dilation = dilation.to_radians();
    Material::MohrCoulomb(MohrCoulomb::new(
        Elastic { young: YOUNG, poisson },
        friction,
        dilation,
        cohesion,
    ))
}

fn respond(material: &Material, b: &Symmetric) -> Response {
    material
        .respond(b, &[])
        .unwrap_or_else(|error| panic!("{error} for {material:?}"))
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| x.abs().max(most))
}

fn turned(q: &Tensor, b: &Symmetric) -> Symmetric {
    Symmetric::of(&(q * b.full() * q.transpose()))
}

fn pick(random: &mut Random, of: &[f64]) -> f64 {
    of[(random.unit() * of.len() as f64) as usize]
}

/// A product of rotations about the axes, for half of the calls about z alone, which takes the plane path.
fn rotation(random: &mut Random) -> Tensor {
    let about = |i: usize, j: usize, angle: f64| {
        let mut q = Tensor::identity();
        (q[(i, i)], q[(j, j)]) = (angle.cos(), angle.cos());
        (q[(i, j)], q[(j, i)]) = (-angle.sin(), angle.sin());
        q
    };
    let z = about(0, 1, 3.0 * random.signed());
    if random.unit() < 0.5 {
        z
    } else {
        z * about(1, 2, 3.0 * random.signed()) * about(2, 0, 3.0 * random.signed())
    }
}

fn stretched(eps: [f64; 3]) -> Symmetric {
    let [x, y, z] = eps.map(|e| (2.0 * e).exp());
    Symmetric([x, y, z, 0.0, 0.0, 0.0])
}

/// A trial b^e in random axes, its strains log-uniform in size between two powers of ten.
fn trial(random: &mut Random, low: f64, high: f64) -> Symmetric {
    let size = 10.0_f64.powf(low + (high - low) * random.unit());
    let eps = [0; 3].map(|_| size * (random.signed() - 0.2));
    turned(&rotation(random), &stretched(eps))
}

/// f of a principal stress, Pa.
fn excess(tau: [f64; 3], friction: f64, cohesion: f64) -> f64 {
    let (sin, cos) = friction.to_radians().sin_cos();
    (tau[0] - tau[2]) + (tau[0] + tau[2]) * sin - 2.0 * cohesion * cos
}

/// Without cohesion, or next to none: largest f / E over 1e5 trials for each, most of them beyond the apex.
pub fn apex() -> Found {
    let mut random = Random::new(2);
    let mut worst = 0.0_f64;
    let mut tips = 0;
    for cohesion in [0.0, 1e-6, 1e-3] {
        for _ in 0..100_000 {
            let friction = pick(&mut random, &[20.0, 45.0, 60.0]);
            let dilation = friction * pick(&mut random, &[0.0, 0.5, 1.0]);
            let poisson = pick(&mut random, &[0.0, 0.3, 0.4999]);
            let found = respond(
                &mohr_coulomb(poisson, friction, dilation, cohesion),
                &trial(&mut random, -7.0, 0.0),
            );
            tips += usize::from(found.branch() == Branch::Apex);
            worst = worst.max(excess(found.principal_tau(), friction, cohesion) / YOUNG);
            assert!(found.tau().0.iter().chain(&found.b_e().0).all(|x| x.is_finite()));
        }
    }
    Found::Figure(worst, format!("{tips} of 3e5 at the apex"))
}

/// Largest yield violation over c + |p| of 1e6 trials, p the mean stress; principal stresses must keep their order.
pub fn yielding(friction: f64) -> f64 {
    let mut random = Random::new(3);
    let mut worst = 0.0_f64;
    for _ in 0..1_000_000 {
        let dilation = friction * pick(&mut random, &[0.0, 0.5, 1.0]);
        let poisson = pick(&mut random, &[0.0, 0.3, 0.49, 0.49999]);
        let cohesion = pick(&mut random, &[0.0, 1e-6, 1.0]);
        let found = respond(
            &mohr_coulomb(poisson, friction, dilation, cohesion),
            &trial(&mut random, -7.0, 0.3),
        );
        let tau = found.principal_tau();
        assert!(tau[0] >= tau[1] && tau[1] >= tau[2], "{tau:?} is out of order");
        let violation = excess(tau, friction, cohesion);
        let size = cohesion + (tau[0] + tau[1] + tau[2]).abs() / 3.0;
        if violation > 0.0 {
            worst = worst.max(violation / size);
        }
    }
    worst
}

/// Largest relative error of the tangent against fourth-order central differences that stay in one region.
pub fn tangent() -> Found {
    let mut random = Random::new(4);
    let mut worst = 0.0_f64;
    let mut tried = 0;
    for _ in 0..60_000 {
        let friction = pick(&mut random, &FRICTIONS);
        let dilation = friction * pick(&mut random, &[0.0, 0.5, 1.0]);
        let material = mohr_coulomb(pick(&mut random, &[-0.5, 0.0, 0.3, 0.49]), friction, dilation, 1.0);
        let b = trial(&mut random, -2.5, -0.7);
        let l = Tensor::from_fn(|_, _| random.signed());
        let found = respond(&material, &b);
        let eps = found.principal_eps_trial();
        let tau = found.principal_tau();
        let gaps = [(0, 1), (1, 2)]
            .into_iter()
            .filter(|(i, j)| tau[*i] != tau[*j])
            .map(|(i, j)| eps[i] - eps[j]);
        let gap = gaps.fold(1.0, f64::min);
        let h = (3e-3 * gap).min(1e-5);
        let at = |steps: f64| respond(&material, &turned(&(Tensor::identity() + l * (steps * h)), &b));
        let around = [(-1.0, 2.0), (8.0, 1.0), (-8.0, -1.0), (1.0, -2.0)].map(|(weight, steps)| (weight, at(steps)));
        if gap < 1e-4 || around.iter().any(|(_, moved)| moved.branch() != found.branch()) {
            continue;
        }
        tried += 1;
        let sum = around.iter().fold(Tensor::zeros(), |sum, (weight, moved)| {
            sum + moved.tau().full() * *weight
        });
        let tangent = found.linearise(&l);
        let size = tangent.amax().max(1e-3 * material.elastic().oedometric() * l.amax());
        worst = worst.max((sum / (12.0 * h) - tangent).amax() / size);
    }
    Found::Figure(worst, format!("{tried} trials"))
}

/// Associated returns are projections in the energy norm onto a cone with the apex a and the edges r_i: with
/// s = C (trial - tau), s . r_i <= 0 for all i and s . (tau - a) = 0 (Moreau). Largest violation, relative.
pub fn projection() -> Found {
    let mut random = Random::new(5);
    let mut worst = 0.0_f64;
    let mut returned = 0;
    while returned < 10_000 {
        let friction = pick(&mut random, &[20.0, 45.0, 60.0]);
        let poisson = pick(&mut random, &[0.0, 0.3, 0.45]);
        let found = respond(
            &mohr_coulomb(poisson, friction, friction, 1.0),
            &trial(&mut random, -3.0, -1.0),
        );
        if found.branch() == Branch::Elastic {
            continue;
        }
        returned += 1;
        let eps = found.principal_eps_trial();
        let eps_e = found.principal_eps_e();
        let tau = found.principal_tau();
        let s: [f64; 3] = std::array::from_fn(|i| eps[i] - eps_e[i]);
        let apex = 1.0 / friction.to_radians().tan();
        let along: f64 = (0..3).map(|i| s[i] * (tau[i] - apex)).sum();
        let sin = friction.to_radians().sin();
        let ratio = (1.0 - sin) / (1.0 + sin);
        let edges = (0..3).flat_map(|i| [(i, ratio, 1.0), (i, 1.0, ratio)]);
        let out = edges.map(|(i, one, others)| -(0..3).map(|k| s[k] * if k == i { one } else { others }).sum::<f64>());
        let size = largest(&s);
        worst = out.fold(worst.max(along.abs() / (size * (largest(&tau) + apex))), |most, out| {
            most.max(out / size)
        });
    }
    Found::Figure(worst, "1e4 returns".into())
}

/// Distance of the return for a friction angle of 1e-9 degrees from Tresca's, over c.
pub fn tresca_limit() -> f64 {
    let mut random = Random::new(6);
    let mut worst = 0.0_f64;
    for _ in 0..100_000 {
        let b = trial(&mut random, -5.0, -1.0);
        let [limit, tresca] = [1e-9, 0.0].map(|friction| respond(&mohr_coulomb(0.3, friction, 0.0, 1.0), &b).tau());
        worst = (0..6).map(|i| (limit.0[i] - tresca.0[i]).abs()).fold(worst, f64::max);
    }
    worst
}

/// exp(2 tau) = b for E = 1, nu = 0: largest relative error for principal strains 1 to 1e-16 apart.
pub fn nearly_equal() -> f64 {
    let material = hencky(1.0, 0.0);
    let mut random = Random::new(7);
    let mut worst = 0.0_f64;
    for exponent in 0..=16 {
        for _ in 0..1_000 {
            let gap = 10.0_f64.powi(-exponent);
            let base = 0.5 * random.signed();
            let b = turned(
                &rotation(&mut random),
                &stretched([base + 0.1 * gap, base, base - 0.05 * gap * random.unit().round()]),
            );
            let rebuilt = Symmetric::of(&exponential(&(2.0 * respond(&material, &b).tau().full())));
            worst = worst.max((0..6).map(|i| (rebuilt.0[i] - b.0[i]).abs()).fold(0.0, f64::max) / largest(&b.0));
        }
    }
    worst
}

/// Taylor series with scaling and squaring.
fn exponential(a: &Tensor) -> Tensor {
    let small = a / 64.0;
    let mut term = Tensor::identity();
    let mut sum = Tensor::identity();
    for k in 1..16 {
        term = term * small / f64::from(k);
        sum += term;
    }
    (0..6).fold(sum, |s, _| s * s)
}

/// Change of tau over that of b where principal strains come within 1e-16 to 1e-6, less what storing them costs; E = 1,
/// nu = 0, b between 1/2 and 2, so that the exact Lipschitz constant is 1.
pub fn no_jump() -> f64 {
    let material = hencky(1.0, 0.0);
    let mut random = Random::new(8);
    let mut worst = 0.0_f64;
    for exponent in 6..=16 {
        for _ in 0..1_000 {
            let gap = 10.0_f64.powi(-exponent);
            let base = 0.25 * random.signed();
            let b = turned(&rotation(&mut random), &stretched([base + gap, base, base - gap]));
            let mut moved = b;
            moved.0.iter_mut().for_each(|c| *c += gap * random.signed());
            let change: f64 = largest(&std::array::from_fn::<f64, 6, _>(|i| moved.0[i] - b.0[i]));
            let [before, after] = [&b, &moved].map(|b| respond(&material, b).tau().0);
            let jump = largest(&std::array::from_fn::<f64, 6, _>(|i| after[i] - before[i]));
            worst = worst.max((jump - 4e-15) / change.max(1e-16));
        }
    }
    worst
}

/// Relative error of Hencky strains of this size along the axes, E = 1, nu = 0; the rounding of b, which holds them as
/// 1 + 2 eps, is part of it.
pub fn strain(size: f64) -> f64 {
    let material = hencky(1.0, 0.0);
    let errors = [[size; 3], [size, -size, size], [-size; 3]].map(|eps| {
        let tau = respond(&material, &stretched(eps)).tau().0;
        largest(&[tau[0] - eps[0], tau[1] - eps[1], tau[2] - eps[2]]) / size
    });
    largest(&errors)
}

/// Largest error of a spherical strain with det F from 1e-6 to 1e6, E = 1, nu = 0, relative to one or itself.
pub fn dilated() -> f64 {
    let material = hencky(1.0, 0.0);
    let error = |exponent: i32| {
        let eps = f64::from(exponent) * 10.0_f64.ln() / 3.0;
        let tau = respond(&material, &stretched([eps; 3])).tau().0;
        largest(&[tau[0] - eps, tau[1] - eps, tau[2] - eps, tau[3], tau[4], tau[5]]) / (1.0 + eps.abs())
    };
    (-6..=6).map(error).fold(0.0, f64::max)
}

/// Ten turns in steps of half a degree: change of the principal stress over E.
pub fn turning() -> f64 {
    let angle = 0.5_f64.to_radians();
    let q = Tensor::new(
        angle.cos(),
        -angle.sin(),
        0.0,
        angle.sin(),
        angle.cos(),
        0.0,
        0.0,
        0.0,
        1.0,
    );
    let material = hencky(YOUNG, 0.3);
    let start = respond(&material, &Symmetric([1.2, 0.9, 1.05, 0.1, 0.0, 0.0]));
    let mut b = start.b_e();
    let mut worst = 0.0_f64;
    for _ in 0..7200 {
        let found = respond(&material, &PlaneStrain::push_forward(&q, &b));
        b = found.b_e();
        let change = |i: usize| found.principal_tau()[i] - start.principal_tau()[i];
        worst = worst.max(largest(&[change(0), change(1), change(2)]) / YOUNG);
    }
    worst
}

/// Bits that F-bar with dJ-bar / dJ = 1 changes in dF, in both geometries.
pub fn untouched() -> f64 {
    let mut random = Random::new(11);
    let changed = |a: &Tensor, b: &Tensor| {
        a.iter()
            .zip(b.iter())
            .filter(|(a, b)| a.to_bits() != b.to_bits())
            .count()
    };
    let one = |_| {
        let dF = Tensor::identity() + Tensor::from_fn(|_, _| 0.3 * random.signed());
        changed(&PlaneStrain::dilate(&dF, 1.0), &dF) + changed(&<Solid as Kinematics<3>>::dilate(&dF, 1.0), &dF)
    };
    (0..1_000).map(one).sum::<usize>() as f64
}

/// F-bar gives dF the averaged determinant: exponent 1/2 in the plane, without touching zz, 1/3 in space. Largest
/// error.
pub fn exponents() -> f64 {
    let mut random = Random::new(12);
    let mut worst = 0.0_f64;
    for _ in 0..1_000 {
        let ratio = 0.5 + random.unit();
        let mut dF = Tensor::identity() + Tensor::from_fn(|_, _| 0.2 * random.signed());
        let solid = <Solid as Kinematics<3>>::dilate(&dF, ratio);
        worst = worst.max((solid.determinant() / dF.determinant() / ratio - 1.0).abs());
        for (i, j) in [(0, 2), (1, 2), (2, 0), (2, 1)] {
            dF[(i, j)] = 0.0;
        }
        let plane = PlaneStrain::dilate(&dF, ratio);
        worst = worst.max((plane.determinant() / dF.determinant() / ratio - 1.0).abs());
        worst = worst.max((plane[(2, 2)] - dF[(2, 2)]).abs());
    }
    worst
}
