//! Comparison of eigenvalues with cyclic Jacobi rotations.

use super::*;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Sweeps; the iteration converges quadratically, in 3 to 5.
const SWEEPS: usize = 12;

/// `½ ln b` by Jacobi rotations of b; with the digits of small strains where the diagonal is near 1.
fn jacobi(b: &Symmetric) -> Symmetric {
    let [xx, yy, zz, xy, yz, xz] = b.0;
    let start = [xx, yy, zz];
    // off[k] couples the two axes other than k; gain is what the rotations have added to the diagonal.
    let mut off = [yz, xz, xy];
    let mut gain = [0.0; 3];
    let mut axis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        for (p, q, k) in [(0, 1, 2), (1, 2, 0), (0, 2, 1)] {
            let tan = tangent(0.5 * ((start[p] - start[q]) + (gain[p] - gain[q])), off[k]);
            gain[p] += tan * off[k];
            gain[q] -= tan * off[k];
            off[k] = 0.0;
            let turn = Turn::by(tan);
            (off[q], off[p]) = turn.apply(off[q], off[p]);
            let pair = [0, 1, 2].map(|i| turn.apply(axis[p][i], axis[q][i]));
            (axis[p], axis[q]) = (pair.map(|x| x.0), pair.map(|x| x.1));
        }
    }
    let sums = [0, 1, 2].map(|k| EigenvalueSum {
        start: start[k],
        gain: gain[k],
    });
    let spectrum = Spectrum::of_sums(sums, Axes::Solid(axis)).expect("positive definite");
    spectrum.assemble(spectrum.eps)
}

/// `I + q diag(strains) qᵀ`, by components.
fn turned(strains: [f64; 3], turn: [f64; 3]) -> Symmetric {
    let q = Rotation3::new(Vector3::from(turn)).into_inner();
    let mut b = Symmetric::of(&(q * Matrix3::from_diagonal(&strains.into()) * q.transpose()));
    b.0[..3].iter_mut().for_each(|c| *c += 1.0);
    b
}

fn largest(t: impl IntoIterator<Item = f64>) -> f64 {
    t.into_iter().fold(0.0, |most, number| most.max(number.abs()))
}

/// Values that are distinct, equal, equal but for a digit, in any order, at strains of 1e-12 to 1.
#[test]
fn the_strain_is_that_of_jacobi_rotations() {
    let mut worst = 0.0_f64;
    for exponent in 0..=12 {
        let size = 10.0_f64.powi(-exponent);
        for gap in [1.0, 0.3, 1e-3, 1e-8, 1e-15, 0.0] {
            for values in [
                [1.0, 0.2, -0.4],
                [0.5, 0.5 - gap, -0.2],
                [0.3, -0.4 * gap, 0.0],
                [0.1, 0.1 - gap, 0.1],
            ] {
                for turn in [
                    [0.3, -0.8, 1.1],
                    [1e-9, 0.4, 2e-5],
                    [2.0, 1.0, -3.0],
                    [1e-3, 0.0, 0.0],
                    [0.0, 1.5, 0.0],
                ] {
                    let b = turned(values.map(|value| size * value), turn);
                    let spectrum = Spectrum::of(&b).expect("positive definite");
                    let found = spectrum.assemble(spectrum.eps);
                    let exact = jacobi(&b);
                    let apart = largest((0..6).map(|k| found.0[k] - exact.0[k]));
                    worst = worst.max(apart / largest(exact.0));
                }
            }
        }
    }
    assert!(worst <= 4e-15, "apart by {worst:e}");
}

#[test]
fn axes_are_orthonormal_and_values_descend() {
    for k in 0..200 {
        let angle = f64::from(k);
        let b = turned(
            [0.3 * angle.sin(), 1e-7 * angle.cos(), 0.2],
            [angle, 1.0 - 0.1 * angle, 2.0],
        );
        let found = Spectrum::of(&b).expect("positive definite");
        let axes = Matrix3::from_fn(|i, j| found.axis()[i][j]);
        assert!(
            largest((axes * axes.transpose() - Matrix3::identity()).iter().copied()) <= 2e-15,
            "{axes}"
        );
        assert!(
            found.eps[0] >= found.eps[1] && found.eps[1] >= found.eps[2],
            "{:?}",
            found.eps
        );
    }
}
