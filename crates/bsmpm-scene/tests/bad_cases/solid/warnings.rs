//! Tests that doubtful 3-D cases are accepted with a warning.

/// Pipes' walls: by the factor of a hundredth of a cell and of a fifth, by their points of a tenth and of two fifths.
#[test]
fn thin_walls_are_warned_of() {
    let base = crate::SOLID;
    let at = base.find("revolve =").expect("a turned outline");
    let end = at + base[at..].find("points_per_cell").expect("its points");
    let warned = |[inner, outer]: [f64; 2], of: &str| {
        let wall = format!("polygon = [[{inner}, 1.0], [{outer}, 1.0], [{outer}, 2.0], [{inner}, 2.0]]");
        let text = format!(
            "{}revolve = {{ {wall}, about = [1.0, 1.5] }}\n{}",
            &base[..at],
            &base[end..]
        );
        let warnings = bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings;
        warnings.iter().any(|warning| warning.starts_with(of))
    };
    let factor = "W0214: body.3.";
    let alone = "W0211: body.3";
    assert!(warned([0.8, 0.803], factor) && !warned([0.8, 0.95], factor));
    assert!(warned([0.8, 0.85], alone) && !warned([0.8, 0.99], alone));
}

/// The default is that of plane strain wherever the cone is used; the word for it is not warned of.
#[test]
fn the_default_match_of_a_cone_is_warned_of_outside_of_plane_strain() {
    let warned = |base: &str, given: &str| {
        let law = format!("model = \"drucker-prager\"\nfriction_angle = 30\ncohesion = 1e3{given}\n");
        let text = base.replacen("model   = \"elastic\"", &law, 1);
        let warnings = bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings;
        warnings
            .into_iter()
            .find(|warning| ["W0310", "W0311"].iter().any(|code| warning.starts_with(code)))
    };
    for base in [crate::SOLID, crate::ROUND] {
        let reported = warned(base, "").expect("a warning");
        // (3 - sin 30)/sqrt(13) and (3 + sin 30)/sqrt(13).
        assert!(
            reported.starts_with("W0310: material.soil.fit: ") && reported.contains("69.3 %"),
            "{reported}"
        );
        assert!(
            reported.contains("97.1 % in extension") && reported.contains("fit = \"outer\""),
            "{reported}"
        );
        for word in ["outer", "inner", "plane-strain"] {
            assert_eq!(warned(base, &format!("\nmatch = \"{word}\"")), None);
        }
    }
    let flat = warned(crate::STATIC, "\nfit = \"outer\"").expect("a warning");
    assert!(flat.starts_with("W0311: material.soil: "), "{flat}");
}

/// Every triangle of the surface turned; of one that is not the row of open surfaces reports.
#[test]
fn a_surface_that_is_turned_inside_out_as_a_whole_is_taken_and_warned_of() {
    let base = crate::SOLID;
    let turned = base
        .replacen("[5, 3, 4, 5, 5, 4, 7, 3, 4]", "[5, 3, 4, 7, 3, 4, 5, 5, 4]", 1)
        .replacen("[5, 3, 4, 7, 3, 4, 5, 3, 6]", "[5, 3, 4, 5, 3, 6, 7, 3, 4]", 1)
        .replacen("[7, 3, 4, 5, 5, 4, 5, 3, 6]", "[7, 3, 4, 5, 3, 6, 5, 5, 4]", 1)
        .replacen("[5, 3, 4, 5, 3, 6, 5, 5, 4]", "[5, 3, 4, 5, 5, 4, 5, 3, 6]", 1);
    let case = |text: &str| bsmpm_scene::Case::from_text("case.toml", text, &[]).expect("a valid case");
    let warned = |text: &str| {
        case(text)
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0215: body.5.surface.triangles"))
    };
    assert!(warned(&turned) && !warned(base));
    assert_eq!(case(&turned).bodies[5].region, case(base).bodies[5].region);
}
