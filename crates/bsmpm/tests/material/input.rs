//! Tests that invalid deformation gives an error, neither a panic nor a NaN.

use super::{hencky, mohr_coulomb};
use bsmpm::material::MaterialError;
use bsmpm::tensor::Symmetric;

#[test]
fn not_finite() {
    for material in [hencky(1.0, 0.3), mohr_coulomb(1.0, 0.3, 30.0, 0.0, 0.0)] {
        for component in 0..6 {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200] {
                let mut b = Symmetric::IDENTITY;
                b.0[component] = bad;
                assert!(
                    matches!(material.respond(&b, &[]), Err(MaterialError::NotFinite(_))),
                    "{bad} as {component}"
                );
            }
        }
    }
}

#[test]
fn not_positive_definite() {
    let indefinite = [
        [0.0; 6],
        [-1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, -1e-9, 0.0, 0.0, 0.0],
        [1.0, 1.0, 1.0, 1.1, 0.0, 0.0],
        [1.0, 1.0, 1.0, 0.0, 1.1, 0.0],
        [1.0, 1.0, 1.0, 0.9, -0.9, 0.9],
        [1.0, 1.0, 1e-101, 0.0, 0.0, 0.0],
    ];
    for b in indefinite {
        let found = hencky(1.0, 0.3).respond(&Symmetric(b), &[]);
        assert!(
            matches!(found, Err(MaterialError::NotPositive(_))),
            "{b:?} gave {found:?}"
        );
    }
}
