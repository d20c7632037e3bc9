//! Tests that associated returns find the closest point of the yield surface in the energy norm, by comparison with
//! brute-force search.

use super::{Branch, largest, mohr_coulomb, respond, stretched};
use crate::random::Random;
use bsmpm::material::Moduli;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Half space `normal · τ ≤ strength`.
pub struct HalfSpace {
    pub normal: Vector3<f64>,
    pub strength: f64, // Pa
}

/// The six planes of Mohr-Coulomb, with the strength 2 c cos φ (Pa).
pub fn pyramid(sin: f64, strength: f64) -> Vec<HalfSpace> {
    [(0, 1), (1, 0), (1, 2), (2, 1), (0, 2), (2, 0)]
        .into_iter()
        .map(|(i, j)| {
            let mut normal = Vector3::zeros();
            normal[i] = 1.0 + sin;
            normal[j] = sin - 1.0;
            HalfSpace { normal, strength }
        })
        .collect()
}

/// The closest admissible point among the projections onto all sets of one, two and three planes.
pub fn closest(trial: Vector3<f64>, stiffness: Matrix3<f64>, planes: &[HalfSpace]) -> Vector3<f64> {
    let compliance = stiffness.try_inverse().unwrap();
    let admissible = |tau: &Vector3<f64>| {
        planes.iter().all(|plane| {
            let size = plane.strength + tau.amax() + 1e-3 * trial.amax();
            plane.normal.dot(tau) - plane.strength <= 1e-9 * size
        })
    };
    let mut best = (f64::INFINITY, trial);
    for set in 1_u32..1 << planes.len() {
        if set.count_ones() > 3 {
            continue;
        }
        let active: Vec<_> = (0..planes.len())
            .filter(|i| set >> i & 1 == 1)
            .map(|i| &planes[i])
            .collect();
        let rows = DMatrix::from_fn(active.len(), 3, |i, j| active[i].normal[j]);
        let flow = DMatrix::from_fn(3, 3, |i, j| stiffness[(i, j)]) * rows.transpose();
        let excess = DVector::from_fn(active.len(), |i, _| active[i].normal.dot(&trial) - active[i].strength);
        let normal = &rows * &flow;
        let size = normal.amax();
        if (&normal / size).determinant().abs() < 1e-10 {
            continue;
        }
        let step = flow * normal.lu().solve(&excess).unwrap();
        let tau = trial - Vector3::new(step[0], step[1], step[2]);
        let distance = (trial - tau).dot(&(compliance * (trial - tau)));
        if admissible(&tau) && distance < best.0 {
            best = (distance, tau);
        }
    }
    best.1
}

fn region(tau: &[f64; 3], size: f64) -> Branch {
    let ties = (tau[0] - tau[1] <= 1e-8 * size, tau[1] - tau[2] <= 1e-8 * size);
    match ties {
        (true, true) => Branch::Apex,
        (true, false) => Branch::LeftEdge,
        (false, true) => Branch::RightEdge,
        (false, false) => Branch::Face,
    }
}

/// Reference: the closest point of the yield surface in the energy norm, by trying all planes.
#[test]
fn associated_return_is_the_closest_point() {
    let mut random = Random::new(30);
    let mut tried = 0;
    let mut worst = 0.0_f64;
    while tried < 10_000 {
        let friction = random.pick(&[0.0, 10.0, 20.0, 45.0, 60.0]);
        let poisson = random.pick(&[0.0, 0.3, 0.45]);
        let material = mohr_coulomb(1e3, poisson, friction, friction, 1.0);
        let found = respond(&material, &stretched(random.strains(-3.0, -1.0)));
        if found.branch() == Branch::Elastic {
            continue;
        }
        tried += 1;
        let Moduli { lambda, mu } = material.elastic().moduli();
        let stiffness = Matrix3::from_element(lambda) + Matrix3::identity() * (2.0 * mu);
        let trial = stiffness * Vector3::from(found.principal_eps_trial());
        let (sin, cos) = friction.to_radians().sin_cos();
        let exact = closest(trial, stiffness, &pyramid(sin, 2.0 * cos));
        let tau = found.principal_tau();
        let size = trial.amax();
        worst = worst.max(largest(&[tau[0] - exact[0], tau[1] - exact[1], tau[2] - exact[2]]) / size);
        assert_eq!(
            found.branch(),
            region(&exact.into(), size),
            "{tau:?} for {exact:?} with friction {friction}"
        );
    }
    println!("distance to the closest point {worst:.2e}");
    assert!(worst <= 1e-9, "{worst:e}");
}
