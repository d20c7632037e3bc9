//! Tests of laws along loading paths with closed forms.

use super::{hencky, mohr_coulomb, respond};
use bsmpm::material::Material;
use bsmpm::tensor::Symmetric;

/// Compresses y in `steps` equal ratios to `height`, the lateral stress τ_xx = τ_zz held at `lateral`; the axial τ_yy.
fn triaxial(material: &Material, lateral: f64, height: f64, steps: u32) -> f64 {
    let mut b_e = Symmetric::IDENTITY;
    let mut axial = 0.0;
    let ratio = height.powf(1.0 / f64::from(steps));
    for _ in 0..steps {
        let trial = |stretch: f64| {
            let [x, y, z, ..] = b_e.0;
            let lateral = stretch * stretch;
            respond(
                material,
                &Symmetric([x * lateral, y * ratio * ratio, z * lateral, 0.0, 0.0, 0.0]),
            )
        };
        let mut low = 0.5;
        let mut high = 2.0;
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if trial(middle).tau().0[0] < lateral {
                low = middle
            } else {
                high = middle
            }
        }
        let found = trial(low);
        (b_e, axial) = (found.b_e(), found.tau().0[1]);
    }
    axial
}

/// Mohr's circle at yield: `-τ₃ = -τ₁ N + 2 c √N`, N = (1 + sin φ)/(1 - sin φ).
#[test]
fn mohr_circle_uniaxial_and_triaxial_strength() {
    for dilation in [0.0, 10.0, 20.0] {
        let material = mohr_coulomb(1e4, 0.3, 20.0, dilation, 10.0);
        for (lateral, printed) in [(0.0, 28.563), (-100.0, 232.524)] {
            let sin = 20.0_f64.to_radians().sin();
            let n = (1.0 + sin) / (1.0 - sin);
            let exact = 20.0 * n.sqrt() - lateral * n;
            assert!((exact - printed).abs() < 5e-4);
            for steps in [1, 20] {
                let found = -triaxial(&material, lateral, 0.9, steps);
                assert!(
                    (found - exact).abs() <= 1e-9 * exact,
                    "{found} for {exact} in {steps} steps"
                );
            }
        }
    }
}

/// Tresca: twice the undrained strength, whatever the confinement.
#[test]
fn tresca_triaxial_strength() {
    let material = mohr_coulomb(1e4, 0.49, 0.0, 0.0, 10.0);
    for lateral in [0.0, -50.0] {
        let found = -triaxial(&material, lateral, 0.9, 10);
        assert!((found - (20.0 - lateral)).abs() <= 1e-9 * 20.0, "{found}");
    }
}

/// Confined compression to a height l: `σ = M ln(l)/l`.
#[test]
fn oedometer_hencky() {
    let material = hencky(1e4, 0.3);
    let modulus = material.elastic().oedometric();
    for height in [1.5_f64, 1.0 - 1e-6, 0.9, 0.5, 0.1] {
        let b = Symmetric([1.0, height * height, 1.0, 0.0, 0.0, 0.0]);
        let sigma = respond(&material, &b).tau().0[1] / height;
        let exact = modulus * height.ln() / height;
        assert!(
            (sigma - exact).abs() <= 1e-10 * exact.abs(),
            "{sigma} for {exact} at {height}"
        );
    }
}

/// Simple shear in plane strain under Tresca flows at τ_max = c on the plane of the circle, without volume change.
#[test]
fn tresca_simple_shear_keeps_its_strength() {
    let material = mohr_coulomb(1e4, 0.3, 0.0, 0.0, 10.0);
    let mut b_e = Symmetric::IDENTITY;
    let step = nalgebra::Matrix3::new(1.0, 0.01, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    for _ in 0..200 {
        let found = respond(&material, &super::turned(&step, &b_e));
        b_e = found.b_e();
        let [first, _, third] = found.principal_tau();
        assert!(first - third <= 20.0 * (1.0 + 1e-12));
    }
    let [xx, yy, _, xy, yz, xz] = respond(&material, &b_e).tau().0;
    let radius = (0.25 * (xx - yy).powi(2) + xy * xy).sqrt();
    assert!((radius - 10.0).abs() <= 1e-10 && (yz, xz) == (0.0, 0.0));
    assert!((b_e.full().determinant() - 1.0).abs() <= 1e-12);
}
