//! Tests that softening, tensile strengths and band widths arrive, and that doubtful ones have warnings.

use super::{FULL, ROUND, STATIC, set, valid};
use bsmpm::material::{Decay, Law, LayeredMaterial, Material};
use bsmpm::model::Regime;
use bsmpm_scene::Case;

/// Strength that falls: its last values, the strain of a band in cells of one size, and what is doubtful or refused.
#[test]
fn softening_strengths() {
    let keys = "young = 1e7, poisson = 0.3, density = 2e3, model = \"mohr-coulomb-softening\", friction_angle = 30, \
                cohesion = 1e3, residual_friction_angle = 25";
    let with = |text: &str| set(FULL, &["grid.cell=0.5", &format!("material.clay={{ {keys}, {text} }}")]);
    let case = with("residual_cohesion = 0, softening_strain = 0.2").expect("a valid case");
    let LayeredMaterial::Uniform(Material::SofteningMohrCoulomb(clay)) = &case.materials[1].material else {
        panic!()
    };
    let parameters = clay.parameters();
    assert_eq!((parameters[2], parameters[5], parameters[6]), (800.0, 0.0, 0.2));
    assert!((parameters[3].tan() * 1.25 - f64::to_radians(25.0).tan()).abs() < 1e-14);
    assert!(
        case.warnings
            .iter()
            .any(|warning| warning.starts_with("W0307: material.clay: ")),
        "{:?}",
        case.warnings
    );
    let case = with("residual_cohesion = 0, softening_strain = 0.2, band_width = \"5 cm\"").expect("a valid case");
    let LayeredMaterial::Uniform(Material::SofteningMohrCoulomb(clay)) = &case.materials[1].material else {
        panic!()
    };
    assert!((clay.parameters()[6] - 0.01).abs() < 1e-15, "{:?}", clay.parameters());
    assert!(!case.warnings.iter().any(|warning| warning.starts_with("W0307")));
    for (text, reported) in [
        ("softening_strain = 0.2", "E0305"),
        ("residual_cohesion = 0, softening_strain = 0", "(softening_strain > 0"),
        (
            "residual_cohesion = 0, softening_strain = 0.2, residual_dilation_angle = 26",
            "E0308",
        ),
        (
            "residual_cohesion = 0, softening_strain = 0.2, softening = \"quadratic\"",
            "exponential",
        ),
        (
            "residual_cohesion = 0, softening_strain = 0.2, separation = \"gap\"",
            "E0304",
        ),
    ] {
        let message = format!("{:?}", with(text).expect_err(text));
        assert!(message.contains(reported), "{message}");
    }
    let case = with("residual_cohesion = 0, softening_strain = 1e-5").expect("a valid case");
    assert!(
        case.warnings
            .iter()
            .any(|warning| warning.starts_with("W0305: material.clay: ")),
        "{:?}",
        case.warnings
    );
}

/// A tensile strength may depend on depth, is reduced on request only, and softens by the cell size.
#[test]
fn a_tensile_strength_is_a_cut_off_of_the_law() {
    let with = |tension: &str, set: &[&str]| {
        let soil = format!(
            "material.soil={{ model = \"mohr-coulomb\", young = 1e7, poisson = 0.3, cohesion = 1e4, friction_angle = 45, \
             density = 2e3{tension} }}"
        );
        valid(STATIC, &[&[soil.as_str()], set].concat())
    };
    let law = |case: &Case, y: f64| case.materials[0].material.at(y).into_owned();
    assert!(matches!(law(&with("", &[]), 0.0), Material::MohrCoulomb(_)));
    let graded = with(
        ", tensile_strength = { value = 2e3, at_y = 0.0, per_metre = -1e3 }",
        &["strength_reduction.factor=2"],
    );
    let Material::MohrCoulombCutOff(cut) = law(&graded, 1.0) else {
        panic!("{:?}", graded.materials[0])
    };
    assert!((cut.tension().strength - 3e3).abs() < 1e-9 && cut.tension().strain == 0.0);
    assert!((cut.law().parameters()[2] - 5e3).abs() < 1e-9);
    let reduced = with(
        ", tensile_strength = 2e3, reduce_tensile_strength = true, crack_opening = 0.01, softening = \"exponential\"",
        &["strength_reduction.factor=2", "grid.cell=0.5"],
    );
    let Material::MohrCoulombCutOff(cut) = law(&reduced, 0.0) else {
        panic!("{:?}", reduced.materials[0])
    };
    let tension = cut.tension();
    assert_eq!(
        (tension.strength, tension.strain, tension.decay),
        (1e3, 0.01, Decay::Exponential)
    );
    for (tension, code) in [
        (", tensile_strength = 1.1e4", "W0318: material.soil.tensile_strength: "),
        (
            ", tensile_strength = 9e3, crack_opening = 1e-5",
            "W0319: material.soil: ",
        ),
    ] {
        let warnings = with(tension, &["grid.cell=0.5"]).warnings;
        assert!(
            warnings.iter().any(|warning| warning.starts_with(code)),
            "{code} {warnings:?}"
        );
    }
    for none in ["", ", tensile_strength = 9e3, crack_opening = 0.01"] {
        let warnings = with(none, &["grid.cell=0.5"]).warnings;
        assert!(
            !warnings
                .iter()
                .any(|warning| warning.starts_with("W0318") || warning.starts_with("W0319"))
        );
    }
    let soil = "material.soil={ model = \"tresca\", young = 1e7, poisson = 0.3, cohesion = 1e4, density = 2e3, \
                tensile_strength = 1e3, crack_opening = 0.01 }";
    let errors = set(STATIC, &[soil, "grid.cell=[0.5, 0.25]"]).expect_err("cells of two sizes");
    assert!(format!("{errors:?}").contains("E0316"), "{errors:?}");
}

/// The width of a band was measured in plane strain, with some methods and splines, and not under what pushes.
#[test]
fn band_widths_are_warned_of_where_they_were_not_measured() {
    let clay = "material.soil={ model = \"sensitive-clay\", young = 1e7, poisson = 0.3, cohesion = 1e4, density = 2e3, \
                sensitivity = 3, softening_strain = 2, band_width = 0.1 }";
    let reports = |base: &str, set: &[&str]| {
        let warnings = valid(base, &[&[clay], set].concat()).warnings;
        let found: Vec<_> = warnings
            .into_iter()
            .filter(|warning| warning.starts_with("W0304: material.soil.band_width: "))
            .collect();
        assert!(found.len() <= 1, "{found:?}");
        found.concat()
    };
    let with = |method: &str, more: &[&str]| {
        reports(
            STATIC,
            &[&[&*format!("stabilisation.method={method}")], &["grid.cell=0.5"], more].concat(),
        )
    };
    assert!(
        ["consistent-f-bar", "f-bar", "subgrid-f-bar"]
            .iter()
            .all(|method| with(method, &[]).is_empty())
    );
    for (found, expected) in [
        (
            with("modified-f-bar", &[]),
            "with \"modified-f-bar\" (dissipation -35 %)",
        ),
        (with("none", &[]), "without stabilisation (dissipation +50 %)"),
        (
            with("f-bar", &["grid.degree=linear"]),
            "with linear splines (dissipation +12 %)",
        ),
        (
            with(
                "f-bar",
                &["footing={ from = [0.5, 1], to = [1, 1], displacement = [0, -0.1] }"],
            ),
            "below a footing",
        ),
        (
            reports(ROUND, &["grid.cell=0.25", "stabilisation.method=f-bar"]),
            "for geometry = \"axisymmetric\"",
        ),
    ] {
        assert!(found.contains(expected), "{expected}: {found}");
    }
    let platen = "footing={ from = [0, 1], to = [2, 1], displacement = [0, -0.1] }";
    assert!(with("f-bar", &[platen]).is_empty());
}

/// Sensitive clay: what is left of its cohesion at every height, the strain in the law's own measure, and its rate.
#[test]
fn sensitive_clay_softens_by_its_sensitivity_and_follows_the_rate() {
    let keys = "model = \"sensitive-clay\", young = 1e7, poisson = 0.49, density = 1.7e3, softening_strain = 20, \
                cohesion = { value = 2e4, at_y = 2.0, per_metre = 2e3 }, sensitivity = 4";
    let rate = "rate_parameter = 0.1, reference_rate = 1e-4";
    let with = |text: &str| {
        set(
            FULL,
            &[
                "strength_reduction.factor=1.0",
                &format!("material.clay={{ {keys}, {text} }}"),
            ],
        )
    };
    let clay = with(rate).expect("a valid case").materials[1].material.clone();
    let numbers = clay.at(1.0).parameters();
    assert_eq!((numbers[0], numbers[2], numbers[5]), (0.0, 2.2e4, 5.5e3));
    assert!((numbers[6] - 20.0 / 3.0_f64.sqrt()).abs() < 1e-14);
    assert!(
        clay.with_time_step(0.1).is_some()
            && with("k0 = 0.5").expect("no rate").materials[1]
                .material
                .with_time_step(0.1)
                .is_none()
    );
    for (text, reported) in [
        ("rate_parameter = 0.1", "E0305"),
        ("sensitivity = 0.5", "duplicate key"),
        ("friction_angle = 10", "E0304"),
    ] {
        let message = format!("{:?}", with(text).expect_err("refused"));
        assert!(message.contains(reported), "{text}: {message}");
    }
    let clay = format!("material.soil={{ {keys}, {rate} }}");
    let time = "analysis.type=quasi-static-rate";
    let case = set(STATIC, &[&clay, time]).expect("in real time");
    assert!(!case.analysis.kind.is_timeless() && case.analysis.regime == Regime::QuasiStatic);
}
