//! Compares the positive definite stiffness at yielding points with the tangent.

use super::{Branch, REGIONS, hencky, mohr_coulomb, respond};
use crate::random::Random;
use bsmpm::material::{Response, Stiffness};
use bsmpm::tensor::Tensor;
use std::f64::consts::FRAC_1_SQRT_2;

/// Share of the elastic stiffness in it.
const ELASTIC: f64 = 0.1;

/// 1, or 1/sqrt(2) for shear, where `of` holds: unit strains have a norm of 1.
fn unit_of(of: bool, shear: bool) -> f64 {
    f64::from(u8::from(of)) * if shear { FRAC_1_SQRT_2 } else { 1.0 }
}

/// All six unit strains.
fn units() -> Vec<Tensor> {
    let unit = |k: usize, l: usize| Tensor::from_fn(|i, j| unit_of((i, j) == (k, l) || (i, j) == (l, k), k != l));
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
        .map(|(k, l)| unit(k, l))
        .to_vec()
}

/// The change of stress for a displacement gradient.
fn apply(stiffness: &Stiffness, l: &Tensor) -> Tensor {
    let moduli = stiffness.moduli(|stress: &Tensor| *stress);
    (0..9).map(|at| moduli[(at / 3, at % 3)] * l[(at / 3, at % 3)]).sum()
}

/// As a 6 x 6 matrix on unit strains: what stress works on them.
fn matrix(stiffness: &Stiffness) -> nalgebra::SMatrix<f64, 6, 6> {
    let units = units();
    nalgebra::SMatrix::from_fn(|a, b| units[a].dot(&apply(stiffness, &units[b])))
}

/// Its smallest eigenvalue is the share of that of the elastic stiffness at least.
#[test]
fn it_is_symmetric_and_positive_in_every_region() {
    let mut random = Random::new(51);
    let mut seen = [0; 5];
    let mut least = f64::INFINITY;
    for _ in 0..20_000 {
        let friction = random.pick(&[0.0, 20.0, 45.0, 60.0, 89.0]);
        let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
        let poisson = random.pick(&[-0.5, 0.0, 0.3, 0.499]);
        let found = respond(
            &mohr_coulomb(1e3, poisson, friction, dilation, 1.0),
            &random.trial(-2.5, -0.7),
        );
        seen[REGIONS.iter().position(|region| *region == found.branch()).unwrap()] += 1;
        let Some(stiffness) = found.yielding() else {
            assert_eq!(found.branch(), Branch::Elastic);
            continue;
        };
        let matrix = matrix(&stiffness);
        assert!((matrix - matrix.transpose()).amax() <= 1e-12 * matrix.amax());
        // 2 mu of shear, 3 K of bulk: the smaller one.
        let elastic = (1e3 / (1.0 + poisson)).min(1e3 / (1.0 - 2.0 * poisson));
        least = least.min(matrix.symmetric_eigenvalues().min() / elastic);
    }
    println!("{REGIONS:?}: {seen:?}, least {least}");
    assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
    assert!(least >= ELASTIC * (1.0 - 1e-9), "{least}");
}

/// Tresca's flow is associated and keeps the volume: nothing has to be left out, and but for the elastic share and the
/// strain's own size the stiffness is the tangent.
#[test]
fn of_tresca_it_is_the_tangent() {
    let material = mohr_coulomb(1e3, 0.3, 0.0, 0.0, 1e-5);
    let elastic = hencky(1e3, 0.3);
    let mut random = Random::new(52);
    let mut worst = 0.0_f64;
    let mut seen = 0;
    for _ in 0..2_000 {
        let b = random.trial(-7.0, -6.0);
        let found: Response = respond(&material, &b);
        let Some(stiffness) = found.yielding() else { continue };
        seen += 1;
        let undamaged = respond(&elastic, &b);
        for l in units() {
            let expected = found.linearise(&l) * (1.0 - ELASTIC) + undamaged.linearise(&l) * ELASTIC;
            worst = worst.max((apply(&stiffness, &l) - expected).amax() / 1e3);
        }
    }
    println!("{seen} points, {worst:e}");
    assert!(seen > 200 && worst <= 1e-11, "{seen}: {worst:e}"); // the square of strains of 1e-6; measured 4e-14
}
