//! Element tests against closed forms.

use super::{hencky, mohr_coulomb};
use bsmpm::element::{Control, Element, ElementError, Target};
use bsmpm::material::Material;
use bsmpm::tensor::Symmetric;

const HELD: Target = Target::Strain(0.0);

/// A point under the vertical pressure p and k0 p on the sides.
fn point(law: Material, pressure: f64, k0: f64) -> Element {
    let lateral = -k0 * pressure;
    Element::new(law, Symmetric([lateral, -pressure, lateral, 0.0, 0.0, 0.0])).expect("a stress of the material")
}

fn follow(point: &mut Element, targets: [Target; 4], undrained: bool, steps: u64) {
    point
        .follow(
            &Control {
                targets,
                undrained,
                steps,
                duration: f64::INFINITY,
            },
            |_| (),
        )
        .expect("a path");
}

/// Mohr's circle at yield of Kirchhoff stress, in any number of steps: `-σ_a J = -σ_r J N + 2 c √N`.
#[test]
fn drained_triaxial_strength_is_that_of_the_circle() {
    for (cohesion, dilation) in [(0.0, 0.0), (0.0, 10.0), (5e3, 0.0), (5e3, 20.0)] {
        for steps in [1, 40] {
            let mut sample = point(mohr_coulomb(4e7, 0.25, 30.0, dilation, cohesion), 1e5, 1.0);
            let cell = Target::Stress(-1e5);
            follow(&mut sample, [cell, Target::Strain(-0.05), cell, HELD], false, steps);
            let [x, y, z, xy, ..] = sample.sigma().0;
            let exact = -3e5 - 2.0 * 3_f64.sqrt() * cohesion / sample.volume_strain().exp();
            assert!((y / exact - 1.0).abs() < 1e-9, "{y} for {exact}");
            assert!((x + 1e5).abs() < 1e-5 && (z - x).abs() < 1e-5 && xy.abs() < 1e-5);
            // Then the volume grows by the angle of dilation, dε_v/dε_a = -2 sin ψ/(1 - sin ψ), but for the elastic
            // strain of a Kirchhoff stress that grows with the volume: (σ/E) of it.
            let before = (sample.volume_strain(), sample.strain()[1]);
            follow(&mut sample, [cell, Target::Strain(-0.02), cell, HELD], false, steps);
            let grown = (sample.volume_strain() - before.0) / (sample.strain()[1] - before.1);
            let sin = dilation.to_radians().sin();
            let plastic = 2.0 * sin / (1.0 - sin);
            assert!((grown + plastic).abs() < 0.02 * plastic + 1e-5, "{grown} for {plastic}");
        }
    }
}

/// Without drainage an elastic point keeps p, so that sand fails at q = M p, M = 6 sin φ/(3 - sin φ), with the pore
/// pressure q/3 under a cell pressure that stays; with ψ = 0 it stays there.
#[test]
fn undrained_triaxial_strength_and_pore_pressure() {
    let mut sample = point(mohr_coulomb(4e7, 0.3, 30.0, 0.0, 0.0), 1e5, 1.0);
    let cell = Target::Stress(-1e5);
    follow(&mut sample, [cell, Target::Strain(-0.05), cell, HELD], true, 25);
    let [x, y, ..] = sample.sigma().0;
    let p = -(2.0 * x + y) / 3.0;
    let q = x - y;
    assert!(
        (p / 1e5 - 1.0).abs() < 1e-9 && (q / 1.2e5 - 1.0).abs() < 1e-9,
        "p {p}, q {q}"
    );
    assert!(
        (sample.pore_pressure() / 4e4 - 1.0).abs() < 1e-9,
        "{}",
        sample.pore_pressure()
    );
    assert!(sample.volume_strain().abs() < 1e-14);
}

/// Closed form: `σ_x/σ_y = ν/(1 - ν)` and `σ_y = M ln l/l`, loaded by a given strain and by a given stress, and
/// unloaded.
#[test]
fn oedometer_follows_the_constrained_modulus_and_its_k0() {
    let law = hencky(1e7, 0.3);
    let modulus = law.elastic().oedometric();
    let mut sample = point(law, 0.0, 1.0);
    follow(&mut sample, [HELD, Target::Strain(0.9_f64.ln()), HELD, HELD], false, 3);
    let [x, y, ..] = sample.sigma().0;
    let exact = modulus * 0.9_f64.ln() / 0.9;
    assert!(
        (y / exact - 1.0).abs() < 1e-12 && (x / y - 3.0 / 7.0).abs() < 1e-12,
        "{y} for {exact}, {x}"
    );
    follow(&mut sample, [HELD, Target::Stress(0.0), HELD, HELD], false, 3);
    assert!(sample.strain()[1].abs() < 1e-12);
    follow(&mut sample, [HELD, Target::Stress(exact), HELD, HELD], false, 3);
    assert!((sample.strain()[1] / 0.9_f64.ln() - 1.0).abs() < 1e-10);
}

/// Closed form: Mohr's circle at yield; in plane strain `-σ_y = -σ_x N`, and in simple shear of clay its radius is c.
#[test]
fn biaxial_and_simple_shear_strength() {
    let mut sample = point(mohr_coulomb(4e7, 0.25, 30.0, 0.0, 0.0), 1e5, 1.0);
    let cell = Target::Stress(-1e5);
    follow(&mut sample, [cell, Target::Strain(-0.05), HELD, HELD], false, 10);
    assert!((sample.sigma().0[1] + 3e5).abs() < 1e-3);
    for undrained in [false, true] {
        let mut sample = point(mohr_coulomb(1e7, 0.49, 0.0, 0.0, 3e4), 5e4, 1.0);
        let normal = Target::Stress(-5e4);
        follow(&mut sample, [HELD, normal, HELD, Target::Strain(0.05)], undrained, 10);
        let [x, y, _, xy, ..] = sample.sigma().0;
        let radius = (0.25 * (x - y).powi(2) + xy * xy).sqrt();
        assert!((radius / 3e4 - 1.0).abs() < 1e-4, "{radius}");
        assert!((sample.total(1) + 5e4).abs() < 1e-4 && (sample.pore_pressure() != 0.0) == undrained);
    }
}

/// Any stress inside the yield surface is reached from any other, and its strain is that of the linear law.
#[test]
fn mixed_control_reaches_its_stress() {
    let young = 1e7;
    let poisson = 0.3;
    let mut sample = point(hencky(young, poisson), 3e4, 0.5);
    let start = sample.sigma().0;
    let wanted = [-2e4, -9e4, -4e4, 1e4];
    follow(&mut sample, wanted.map(Target::Stress), false, 4);
    let found = sample.sigma().0;
    assert!((0..4).all(|k| (found[k] - wanted[k]).abs() < 1e-5), "{found:?}");
    // Within the order of the strain squared, which the linear law knows not.
    let grown: Vec<f64> = (0..3).map(|k| found[k] - start[k]).collect();
    for k in 0..3 {
        let strain = ((1.0 + poisson) * grown[k] - poisson * grown.iter().sum::<f64>()) / young;
        assert!(
            (sample.strain()[k] - strain).abs() < 2e-4,
            "{k}: {} for {strain}",
            sample.strain()[k]
        );
    }
}

#[test]
fn a_stress_beyond_strength_ends_the_path_and_one_at_the_start_is_refused() {
    let law = mohr_coulomb(4e7, 0.25, 30.0, 0.0, 0.0);
    let mut sample = point(law.clone(), 1e5, 1.0);
    let cell = Target::Stress(-1e5);
    let control = Control {
        targets: [cell, Target::Stress(-4e5), cell, HELD],
        undrained: false,
        steps: 31,
        duration: f64::INFINITY,
    };
    let mut steps = 0;
    let ended = sample.follow(&control, |_| steps += 1);
    let Err(ElementError::NoEquilibrium { done, reason }) = ended else {
        panic!("{ended:?}")
    };
    // 3e5 of 1e5 to 4e5 is two thirds of the way.
    assert!(done < 2.0 / 3.0 && done > 0.666 && steps == 20, "{done}, {steps}");
    assert!(reason.contains("stress-yy") && sample.sigma().0[1] > -3e5, "{reason}");
    let beyond = Element::new(law, Symmetric([-1e5, -4e5, -1e5, 0.0, 0.0, 0.0]));
    assert!(matches!(beyond, Err(ElementError::BeyondYield(strain)) if strain > 0.0));
}
