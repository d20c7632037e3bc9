//! Tests that a preset chooses what the case leaves open, and that given keys win.

use super::{COLUMN, FOOTING, SLOPE, discretisation, valid};
use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Case, differences};

#[test]
fn every_word_fills_in_another_discretisation_of_the_same_scene() {
    let of = |text, word| discretisation(&valid(text, &[&format!("accuracy={word}")]));
    for text in [COLUMN, SLOPE, FOOTING] {
        let [draft, standard, reference] = ["draft", "standard", "reference"].map(|word| of(text, word));
        assert!(
            draft.1 > standard.1 && standard.1 > reference.1,
            "{draft:?} {standard:?} {reference:?}"
        );
        assert!(draft.2 <= standard.2 && standard.2 < reference.2);
        assert!(draft.3 >= standard.3 && standard.3 > reference.3);
        assert!(draft.4 > standard.4 && standard.4 > reference.4);
    }
    // The shorter side of the column is 0.1 m high, that of the slope 10 m, and the strip is half of one 2 m wide.
    let cells = |text, word| of(text, word).0;
    assert_eq!(
        [
            cells(COLUMN, "draft"),
            cells(COLUMN, "standard"),
            cells(COLUMN, "reference")
        ],
        [55, 110, 220]
    );
    assert_eq!(
        [
            cells(SLOPE, "draft"),
            cells(SLOPE, "standard"),
            cells(SLOPE, "reference")
        ],
        [40, 80, 160]
    );
    assert_eq!(
        [
            cells(FOOTING, "draft"),
            cells(FOOTING, "standard"),
            cells(FOOTING, "reference")
        ],
        [15, 32, 61]
    );
    assert_eq!(
        [of(SLOPE, "draft").2, of(COLUMN, "draft").2, of(FOOTING, "draft").2],
        [2, 2, 3]
    );
    assert_eq!(valid(COLUMN, &[]).stabilisation, Stabilisation::ConsistentFBar);
}

#[test]
fn steps_follow_the_shear_wave_the_motion_or_the_least_number() {
    // G = 5.84e6 / 2.6 Pa and 2079.5 kg/m3: 32.87 m/s.
    let column = valid(COLUMN, &["accuracy=draft", "grid.cell=10 mm"]);
    let crossed = column.analysis.dt * (5.84e6_f64 / 2.6 / (20_400.0 / 9.81)).sqrt() / 0.01;
    assert!((3.9..=4.0).contains(&crossed), "{crossed}");
    // Finer cells by hand, shorter steps.
    let finer = valid(COLUMN, &["accuracy=draft", "grid.cell=5 mm"]);
    assert!((finer.analysis.dt / column.analysis.dt - 0.5).abs() < 0.01);
    let graded = valid(
        COLUMN,
        &[
            "accuracy=draft",
            "grid.knots.x=[0, 0.2, 0.55]",
            "grid.knots.y=[0.0, 0.005, 0.1025]",
        ],
    );
    assert!((graded.analysis.dt / finer.analysis.dt - 1.0).abs() < 1e-12);
    // Twice as stiff at the bottom as at the top.
    let profile = "material.rods.young={ value = \"5840 kPa\", at_y = 0.1, per_metre = \"58400 kPa/m\" }";
    let graded = valid(COLUMN, &["accuracy=draft", profile]);
    assert!((column.analysis.dt / graded.analysis.dt - 2.0_f64.sqrt()).abs() < 0.01);
    let steps = |case: &Case| (case.analysis.end / case.analysis.dt).round();
    assert_eq!(steps(&valid(SLOPE, &["accuracy=draft"])), 10.0);
    // 2 m down in tenths of cells of 0.25 m; the fastest part of a path counts, up to the end.
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft"])), 80.0);
    let path = "footing.path=[[0.5, 0.0, -2.0], [1.0, 0.0, 0.0]]";
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft", path])), 160.0);
    let early = "footing.path=[[0.1, 0.0, -2.0], [0.9, 0.0, -2.0], [1.0, 0.0, -2.1]]";
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft", early])), 800.0);
    let late = "footing.path=[[1.0, 0.0, -2.0], [1.1, 0.0, -9.0]]";
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft", late])), 80.0);
    // A face may move a quarter of a cell (of 20 mm).
    let face = "prescribed.0={ face = \"top\", displacement = [0.0, -0.1], components = \"normal\" }";
    let pressed = [
        "analysis={ type = \"quasi-static\" }",
        "grid.upper=[0.55, 0.1]",
        "output.times=[1.0]",
        "gravity.ramp=1.0",
        face,
    ];
    assert_eq!(
        steps(&valid(
            COLUMN,
            &[&pressed[..], &["accuracy=draft", "grid.cell=10 mm"]].concat()
        )),
        40.0
    );
    // What no body is made of does not count.
    let unused = [
        "accuracy=draft",
        "material.steel={ model = \"tresca\", young = 2e11, poisson = 0.3, cohesion = 1e8, density = 7800.0 }",
    ];
    assert_eq!(
        valid(COLUMN, &unused).analysis.dt,
        valid(COLUMN, &unused[..1]).analysis.dt
    );
    assert_eq!(
        steps(&valid(FOOTING, &["accuracy=draft", "footing.velocity=[0.0, -1.0]"])),
        40.0
    );
}

#[test]
fn every_key_given_by_hand_wins_and_only_the_others_are_reported_as_chosen() {
    let by_hand = [
        ("grid.cell", "\"25 mm\""),
        ("grid.degree", "\"cubic\""),
        ("body.0.points_per_cell", "5"),
        ("analysis.steps", "77"),
        ("stabilisation.method", "\"f-bar\""),
        ("solver.tolerance", "1e-9"),
        ("solver.force_tolerance", "2e-4"),
    ];
    let chosen = |case: &Case| -> Vec<String> {
        let own = case.notes.iter().filter(|note| note.reason.starts_with("accuracy = "));
        own.map(|note| note.key.replace('*', "0")).collect()
    };
    let all = chosen(&valid(COLUMN, &[]));
    assert_eq!(all.len(), by_hand.len(), "{all:?}");
    for (key, value) in by_hand {
        let case = valid(COLUMN, &[&format!("{key}={value}")]);
        let rest = chosen(&case);
        assert!(
            !rest.contains(&key.to_owned()) && rest.len() == all.len() - 1,
            "{key}: {rest:?}"
        );
    }
    let sets: Vec<String> = by_hand.iter().map(|(key, value)| format!("{key}={value}")).collect();
    let case = Case::from_text("case.toml", COLUMN, &sets).unwrap();
    assert_eq!(
        (case.grid.order, case.bodies[0].points_per_cell, case.stabilisation),
        (3, 5, Stabilisation::FBar)
    );
    assert!(chosen(&case).is_empty());
    assert_eq!(valid(COLUMN, &["analysis.dt=1 ms"]).analysis.dt, 1e-3);
}

/// What is recorded of a run is the whole case, and reads back as it.
#[test]
fn the_effective_text_is_complete_and_stays_the_same() {
    for text in [COLUMN, SLOPE, FOOTING] {
        let case = valid(text, &[]);
        let again = valid(&case.text, &[]);
        assert_eq!(
            (&again.text, &again.grid, &again.analysis),
            (&case.text, &case.grid, &case.analysis)
        );
        assert!(
            !case.text.contains("accuracy") && case.warnings.is_empty(),
            "{}",
            case.text
        );
        // Under another word it would be the same case, and says so.
        let other = valid(&case.text, &["accuracy=draft"]);
        assert!(
            other.grid == case.grid && other.warnings[0].starts_with("W0202"),
            "{:?}",
            other.warnings
        );
        assert_eq!(differences(text, &case.text).unwrap(), []);
        assert!(
            !differences(text, &text.replace("standard", "draft"))
                .unwrap()
                .is_empty()
        );
    }
}

#[test]
fn cells_fit_between_faces_that_stay() {
    // 0.55 m between rollers, where 27.5 cells of 20 mm would be.
    let case = valid(
        COLUMN,
        &[
            "body.0.box.upper=[0.2, 0.333]",
            "grid.upper=[0.55, 0.4]",
            "accuracy=draft",
        ],
    );
    let x = &case.grid.axes[0];
    let y = &case.grid.axes[1];
    assert_eq!((x.cells(), y.shortest()), (28, 0.02));
    assert!((x.length() - 0.55).abs() < 1e-12, "{x:?}");
    // A face that is moved stays where it is, too.
    let moved = "prescribed.0={ face = \"top\", displacement = [0.0, -0.01], components = \"normal\" }";
    let case = valid(
        COLUMN,
        &[moved, "grid.upper=[0.55, 0.1]", "body.0.box.upper=[0.55, 0.1]"],
    );
    assert_eq!(case.grid.axes[1].cells(), 20);
}

#[test]
fn what_no_preset_knows_has_a_warning() {
    let disc = "rigid=[{ name = \"disc\", circle = { centre = [0.4, 0.1], radius = 0.02 }";
    let of = |further: &str| valid(COLUMN, &[&format!("{disc}{further} }}]")]);
    let warned = |case: &Case| case.warnings.iter().any(|warning| warning.starts_with("W0201"));
    assert!(warned(&of(", free = [\"x\"], mass = 1.0")) && !warned(&of("")));
}

#[test]
fn cells_too_wide_for_a_body_are_warned_of() {
    let lining = "body.1={ material = \"rods\", box = { lower = [0.3, 0.0], upper = [0.315, 0.1] } }";
    let warned = |word: &str| {
        let case = valid(COLUMN, &[&format!("accuracy={word}"), lining]);
        case.warnings
            .iter()
            .any(|warning| warning.contains("a body with a thickness of 0.015 m has fewer than 2 cells"))
    };
    assert!(warned("draft") && !warned("standard"));
}

#[test]
fn elastic_soil_that_does_not_lock_gets_no_stabilisation() {
    let elastic = |poisson: f64| {
        let text: String = COLUMN
            .lines()
            .filter(|line| {
                !["friction", "dilation", "cohesion"]
                    .iter()
                    .any(|key| line.starts_with(key))
            })
            .map(|line| format!("{line}\n"))
            .collect();
        let overrides = [
            "material.rods.model=elastic".to_owned(),
            format!("material.rods.poisson={poisson}"),
        ];
        Case::from_text("case.toml", &text, &overrides).unwrap().stabilisation
    };
    assert_eq!(
        (elastic(0.3), elastic(0.49)),
        (Stabilisation::None, Stabilisation::ConsistentFBar)
    );
}
