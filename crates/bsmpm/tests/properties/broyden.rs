//! Tests of Broyden's product form against the update of a dense matrix.

use crate::support::random::Random;
use crate::support::solver::Skyline;
use bsmpm::linear::{LinearSolver, Symmetry};
use bsmpm::method::QuasiNewton;
use bsmpm::parallel::Alone;
use bsmpm::solve::quasi_newton::Secants;
use nalgebra::{DMatrix, DVector};

const N: usize = 12;

fn stiffness(random: &mut Random) -> DMatrix<f64> {
    let A = DMatrix::from_fn(N, N, |_, _| random.signed());
    &A * A.transpose() / N as f64 + DMatrix::identity(N, N)
}

/// The solver with `K` as its one patch.
fn factorised(K: &DMatrix<f64>) -> Skyline {
    let mut solver = Skyline::of_patches(1, (0..N).collect());
    solver.matrix().reinit(&[true; N]);
    solver.matrix().add_block(0, K.transpose().as_slice());
    solver.factorise(Symmetry::Definite).unwrap();
    solver
}

/// The update after a step a d along the direction d = K^-1 f_old: the secant of least change,
/// K+ = K + ((1-a) f_old - f_new) s^T / s.s with s = a d.
fn updated(K: &DMatrix<f64>, f_old: &DVector<f64>, f_new: &DVector<f64>, d: &DVector<f64>, a: f64) -> DMatrix<f64> {
    let s = d * a;
    K + (f_old * (1.0 - a) - f_new) * s.transpose() / s.norm_squared()
}

/// Largest relative difference of the directions over the iterations with step lengths `lengths`.
fn worst_difference(lengths: &[f64], seed: u64) -> f64 {
    let mut random = Random::new(seed);
    let mut K = stiffness(&mut random);
    let mut solver = factorised(&K);
    let halo = Alone { nodes: N };
    let mut broyden = Secants::new::<1>(QuasiNewton::Broyden, &[true; N], &halo);
    let mut f = DVector::from_vec(random.array(N));
    let mut worst = 0.0_f64;
    for &a in lengths {
        let found = broyden.direction::<1>(f.as_slice(), &halo, &mut solver).unwrap();
        let expected = K.clone().lu().solve(&f).unwrap();
        worst = worst.max((DVector::from_vec(found.du) - &expected).norm() / expected.norm());
        assert!((found.energy - expected.dot(&f)).abs() <= 1e-12 * expected.norm() * f.norm());
        broyden.took(a);
        let noise = DVector::from_vec(random.array(N)) * (0.2 * f.amax());
        let f_new = &f * 0.3 + noise; // far from a restart
        K = updated(&K, &f, &f_new, &expected, a);
        f = f_new;
    }
    worst
}

#[test]
fn the_dense_update_is_the_secant() {
    let mut random = Random::new(9);
    let K = stiffness(&mut random);
    for a in [1.0, 0.5, 0.125] {
        let f_old = DVector::from_vec(random.array(N));
        let f_new = DVector::from_vec(random.array(N));
        let d = K.clone().lu().solve(&f_old).unwrap();
        let K = updated(&K, &f_old, &f_new, &d, a);
        assert!((K * (d * a) - (f_old - f_new)).norm() <= 1e-13);
    }
}

#[test]
fn full_steps_agree_with_the_dense_update() {
    let worst = (0..20)
        .map(|seed| worst_difference(&[1.0; 6], seed))
        .fold(0.0, f64::max);
    println!("worst relative difference {worst:.1e}");
    assert!(worst <= 2e-14); // measured 1.1e-15
}

#[test]
fn shortened_steps_agree_with_the_dense_update() {
    let worst = (0..20)
        .map(|seed| worst_difference(&[1.0, 0.5, 1.0, 0.25, 0.5, 1.0], seed))
        .fold(0.0, f64::max);
    println!("worst relative difference {worst:.1e}");
    assert!(worst <= 2e-14); // measured 7.8e-16; 0.52 when s was the whole direction
}

#[test]
fn a_nearly_singular_update_drops_the_history() {
    let mut random = Random::new(2);
    let K = stiffness(&mut random);
    let mut solver = factorised(&K);
    let halo = Alone { nodes: N };
    let mut broyden = Secants::new::<1>(QuasiNewton::Broyden, &[true; N], &halo);
    let f = random.array(N);
    let plain = broyden.direction::<1>(&f, &halo, &mut solver).unwrap().du;
    broyden.took(1.0);
    let again = broyden.direction::<1>(&f, &halo, &mut solver).unwrap().du; // f unchanged: g = 1
    assert_eq!(again, plain);
}
