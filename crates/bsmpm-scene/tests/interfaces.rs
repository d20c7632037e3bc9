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
fn interfaces_beyond_what_was_shown_are_told_of() {
    let inside = ["body.0.box.upper=[3, 6.5]", "body.1.box.lower=[0, 6.5]"];
    let soft = "material.heavy={ model = \"tresca\", young = 1e9, poisson = 0.3, cohesion = 1e4, unit_weight = 2e4 }";
    let told = |changes: &[&str]| {
        let warnings = layers(changes).warnings;
        warnings.into_iter().filter(|told| told.contains(" meet")).collect::<Vec<_>>()
    };
    // On a grid line anything elastic was shown; with soil that yields, a stiffer body on it up to 1 : 100.
    assert!(told(&[EQUAL, "material.light.young=1e13"]).is_empty());
    assert!(told(&[soft, EQUAL, "material.light.young=1e11"]).is_empty());
    let moving = told(&[soft, EQUAL, "material.light.young=1.1e11"]);
    assert!(moving.len() == 1 && moving[0].contains("1.100e2 times as stiff"), "{moving:?}");
    // Inside cells, by moduli and by densities.
    for (changes, count) in [
        ([EQUAL, "material.light.young=2e9"], 1),
        ([EQUAL, "material.light.young=1.2e9"], 0),
        (["title=a", "title=b"], 1),
    ] {
        let found = told(&[&inside[..], &changes].concat());
        assert!(
            found.len() == count && found.iter().all(|told| told.contains("inside cells")),
            "{changes:?}: {found:?}"
        );
    }
}
