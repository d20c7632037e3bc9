//! Materials that meet: which averages over the grid may mix, how they weigh, and what is warned of.

use bsmpm::model::Weighting;
use bsmpm_scene::{Case, model};

/// The two layers of the validation, changed.
fn layers(changes: &[&str]) -> Case {
    let text = include_str!("../../../cases/validation/two_densities.toml");
    let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
    Case::from_text("two_densities.toml", text, &changes).expect("valid")
}

const EQUAL: &str = "material.light.unit_weight=20 kN/m3";

#[test]
fn averages_do_not_mix_materials_of_different_stiffness_and_weigh_different_densities_by_volume() {
    for (changes, groups, weighting) in [
        (&[][..], 1, Weighting::Volume),
        (&[EQUAL][..], 1, Weighting::Mass),
        (&[EQUAL, "material.light.young=2e9"][..], 2, Weighting::Mass),
        (&[EQUAL, "material.light.poisson=0.2"][..], 2, Weighting::Mass),
        (&["material.light.young=2e9"][..], 2, Weighting::Volume),
    ] {
        let case = layers(changes);
        assert_eq!((model::groups(&case).count(), model::weighting(&case)), (groups, weighting), "{changes:?}");
    }
}

#[test]
fn interfaces_beyond_what_was_shown_are_told_of_where_bodies_meet() {
    let apart = ["body.1.box.lower=[0, 8]", "material.light.young=1e11"];
    for (changes, says) in [
        (&[EQUAL][..], None),
        (&[EQUAL, "material.light.young=2e9"][..], None),
        (&[EQUAL, "material.light.young=2.5e9"][..], Some("differ in young by a factor of 2.500")),
        (&[EQUAL, "material.light.young=1e7"][..], Some("differ in young by a factor of 100.000")),
        (&["material.light.unit_weight=5 kN/m3"][..], Some("differ in density by a factor of 4.000")),
        (&["material.light.unit_weight=5 kN/m3", "stabilisation.method=none"][..], None),
        (&apart[..], None),
    ] {
        let warnings = layers(changes).warnings;
        let told: Vec<_> = warnings.iter().filter(|warning| warning.contains("meet and differ")).collect();
        match says {
            Some(says) => assert!(told.len() == 1 && told[0].contains(says), "{changes:?}: {warnings:?}"),
            None => assert!(told.is_empty(), "{changes:?}: {warnings:?}"),
        }
    }
}
