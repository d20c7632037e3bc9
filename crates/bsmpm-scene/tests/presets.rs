//! `accuracy`: what it fills in, from which parts of a scene, and that everything given by hand wins.

use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Case, Error, Place, differences};

const COLUMN: &str = include_str!("../../../cases/presets/column_collapse.toml");
const SLOPE: &str = include_str!("../../../cases/presets/slope_stability.toml");
const FOOTING: &str = include_str!("../../../cases/presets/strip_footing.toml");

fn read(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text("case.toml", text, &overrides.iter().map(ToString::to_string).collect::<Vec<_>>())
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    read(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

/// Cells along x, their edge in m, points along it, length of a step, force tolerance.
fn discretisation(case: &Case) -> (usize, f64, usize, f64, f64) {
    let x = &case.grid.axes[0];
    (x.cells(), x.shortest(), case.bodies[0].points_per_cell, case.analysis.dt, case.solver.force_tolerance)
}

#[test]
fn every_word_fills_in_another_discretisation_of_the_same_scene() {
    let of = |text, word| discretisation(&valid(text, &[&format!("accuracy={word}")]));
    for text in [COLUMN, SLOPE, FOOTING] {
        let [draft, standard, reference] = ["draft", "standard", "reference"].map(|word| of(text, word));
        assert!(draft.1 > standard.1 && standard.1 > reference.1, "{draft:?} {standard:?} {reference:?}");
        assert!(draft.2 < standard.2 && standard.2 < reference.2);
        assert!(draft.3 >= standard.3 && standard.3 > reference.3);
        assert!(draft.4 > standard.4 && standard.4 > reference.4);
    }
    // The shorter side of the column is .1 m high, that of the slope 10 m, and the strip is 1 m wide.
    let cells = |text, word| of(text, word).0;
    assert_eq!([cells(COLUMN, "draft"), cells(COLUMN, "standard"), cells(COLUMN, "reference")], [55, 110, 220]);
    assert_eq!([cells(SLOPE, "draft"), cells(SLOPE, "standard"), cells(SLOPE, "reference")], [40, 80, 160]);
    assert_eq!([cells(FOOTING, "draft"), cells(FOOTING, "standard"), cells(FOOTING, "reference")], [40, 80, 120]);
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
    let graded = valid(COLUMN, &["accuracy=draft", "grid.knots.x=[0, 0.2, 0.55]", "grid.knots.y=[0.0, 0.005, 0.1025]"]);
    assert!((graded.analysis.dt / finer.analysis.dt - 1.0).abs() < 1e-12);
    // Twice as stiff at the bottom as at the top.
    let profile = "material.rods.young={ value = \"5840 kPa\", at_y = 0.1, per_metre = \"58400 kPa/m\" }";
    let graded = valid(COLUMN, &["accuracy=draft", profile]);
    assert!((column.analysis.dt / graded.analysis.dt - 2.0_f64.sqrt()).abs() < 0.01);
    let steps = |case: &Case| (case.analysis.end / case.analysis.dt).round();
    assert_eq!(steps(&valid(SLOPE, &["accuracy=draft"])), 10.0);
    // 2 m down in quarters of cells of .25 m; the fastest part of a path counts, up to the end.
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft"])), 32.0);
    let path = "footing.path=[[0.5, 0.0, -2.0], [1.0, 0.0, 0.0]]";
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft", path])), 64.0);
    let early = "footing.path=[[0.1, 0.0, -2.0], [0.9, 0.0, -2.0], [1.0, 0.0, -2.1]]";
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft", early])), 320.0);
    let late = "footing.path=[[1.0, 0.0, -2.0], [1.1, 0.0, -9.0]]";
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft", late])), 32.0);
    // What no body is made of does not count.
    let unused = [
        "accuracy=draft",
        "material.steel={ model = \"tresca\", young = 2e11, poisson = 0.3, cohesion = 1e8, density = 7800.0 }",
    ];
    assert_eq!(valid(COLUMN, &unused).analysis.dt, valid(COLUMN, &unused[..1]).analysis.dt);
    assert_eq!(steps(&valid(FOOTING, &["accuracy=draft", "footing.velocity=[0.0, -1.0]"])), 16.0);
}

#[test]
fn every_key_given_by_hand_wins_and_only_the_others_are_told_as_chosen() {
    let by_hand = [
        ("grid.cell", "\"25 mm\""),
        ("grid.order", "\"cubic\""),
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
        assert!(!rest.contains(&key.to_owned()) && rest.len() == all.len() - 1, "{key}: {rest:?}");
    }
    let sets: Vec<String> = by_hand.iter().map(|(key, value)| format!("{key}={value}")).collect();
    let case = Case::from_text("case.toml", COLUMN, &sets).unwrap();
    assert_eq!((case.grid.order, case.bodies[0].points_per_cell, case.stabilisation), (3, 5, Stabilisation::FBar));
    assert!(chosen(&case).is_empty());
    assert_eq!(valid(COLUMN, &["analysis.dt=1 ms"]).analysis.dt, 1e-3);
}

/// What is recorded of a run is the whole case, and reads back as it.
#[test]
fn the_effective_text_is_complete_and_stays_the_same() {
    for text in [COLUMN, SLOPE, FOOTING] {
        let case = valid(text, &[]);
        let again = valid(&case.text, &[]);
        assert_eq!((&again.text, &again.grid, &again.analysis), (&case.text, &case.grid, &case.analysis));
        assert!(!case.text.contains("accuracy") && case.warnings.is_empty(), "{}", case.text);
        // Under another word it would be the same case, and says so.
        let other = valid(&case.text, &["accuracy=draft"]);
        assert!(other.grid == case.grid && other.warnings[0].contains("it does nothing"), "{:?}", other.warnings);
        assert_eq!(differences(text, &case.text).unwrap(), []);
        assert!(!differences(text, &text.replace("standard", "draft")).unwrap().is_empty());
    }
}

#[test]
fn cells_fit_between_faces_that_stay() {
    // .55 m between rollers, where 27.5 cells of 20 mm would be.
    let case = valid(COLUMN, &["body.0.box.upper=[0.2, 0.333]", "grid.upper=[0.55, 0.4]", "accuracy=draft"]);
    let [x, y] = &case.grid.axes;
    assert_eq!((x.cells(), y.shortest()), (28, 0.02));
    assert!((x.length() - 0.55).abs() < 1e-12, "{x:?}");
    // A face that is moved stays where it is, too.
    let moved = "prescribed.0={ face = \"top\", displacement = [0.0, -0.01], components = \"normal\" }";
    let case = valid(COLUMN, &[moved, "grid.upper=[0.55, 0.1]", "body.0.box.upper=[0.55, 0.1]"]);
    assert_eq!(case.grid.axes[1].cells(), 20);
}

#[test]
fn cells_too_wide_for_a_body_are_warned_of() {
    let lining = "body.1={ material = \"rods\", box = { lower = [0.3, 0.0], upper = [0.315, 0.1] } }";
    let warned = |word: &str| {
        let case = valid(COLUMN, &[&format!("accuracy={word}"), lining]);
        case.warnings.iter().any(|warning| warning.contains("fewer than 2 across a body of 0.015"))
    };
    assert!(warned("draft") && !warned("standard"));
}

#[test]
fn elastic_soil_that_does_not_lock_gets_no_stabilisation() {
    let elastic = |poisson: f64| {
        let text: String = COLUMN
            .lines()
            .filter(|line| !["friction", "dilation", "cohesion"].iter().any(|key| line.starts_with(key)))
            .map(|line| format!("{line}\n"))
            .collect();
        let overrides = ["material.rods.model=hencky".to_owned(), format!("material.rods.poisson={poisson}")];
        Case::from_text("case.toml", &text, &overrides).unwrap().stabilisation
    };
    assert_eq!((elastic(0.3), elastic(0.49)), (Stabilisation::None, Stabilisation::ConsistentFBar));
}

/// What a word cannot choose it tells, with what that would follow from; what is given needs no choice.
#[test]
fn what_cannot_be_chosen_is_told_at_the_word() {
    let told = |text: &str, overrides: &[&str]| {
        let errors = read(text, overrides).unwrap_err();
        let own = errors.into_iter().filter(|error| error.key == "accuracy");
        own.map(|error| error.message).collect::<Vec<String>>()
    };
    let weightless = COLUMN.replace("unit_weight = \"20.4 kN/m3\"\n", "");
    assert_ne!(weightless, COLUMN);
    let [steps] = &told(&weightless, &[])[..] else { panic!("one error") };
    assert!(steps.contains("cannot choose analysis.steps") && steps.contains("density"), "{steps}");
    assert_eq!(told(&weightless, &["analysis.dt=1e-3"]), [""; 0]);
    let bodiless = COLUMN.replace("box = { lower = [0.0, 0.0], upper = [0.2, 0.1] }\n", "");
    assert_ne!(bodiless, COLUMN);
    let [cells] = &told(&bodiless, &[])[..] else { panic!("one error") };
    assert!(cells.contains("cannot choose grid.cell") && cells.contains("the size of the bodies"), "{cells}");
}

/// Errors of what was filled in stand at the word; what cannot be filled in is missed as ever.
#[test]
fn errors_have_a_place() {
    let errors = read(COLUMN, &["accuracy=fine"]).unwrap_err();
    assert!(errors.iter().any(|error| error.key == "accuracy" && error.message.contains("\"draft\"")), "{errors:?}");
    let wide = COLUMN.replace("upper = [0.55, 0.1025]", "upper = [1e8, 0.1025]");
    let line = 1 + COLUMN.lines().position(|line| line.starts_with("accuracy")).unwrap();
    let at_the_word = |error: &Error| matches!(error.place, Place::Line { line: found, .. } if found == line);
    let errors = read(&wide, &[]).unwrap_err();
    assert!(errors.iter().any(|error| error.key == "grid.cell" && at_the_word(error)), "{errors:?}");
    let without = COLUMN.replace("lower = [0.0, 0.0]\nupper = [0.55, 0.1025]\n", "");
    let errors = read(&without, &[]).unwrap_err();
    assert!(errors.iter().any(|error| error.message.contains("missing: one of cell, knots")), "{errors:?}");
}

#[test]
fn cells_are_moved_to_where_strips_end_and_materials_meet() {
    // Cells of .25 m from 0; the strip begins at .3 m and ends at 1.3 m.
    let aside = "footing.from=[0.3, 5.0]";
    let moved = valid(FOOTING, &["accuracy=draft", aside, "footing.to=[1.3, 5.0]"]);
    let x = &moved.grid.axes[0];
    let is_line = |wanted: f64| (0..=x.cells()).any(|i| (x.breakpoint(i) - wanted).abs() < 1e-12);
    assert!(is_line(0.3) && is_line(1.3));
    let cells: Vec<f64> = (0..x.cells()).map(|i| x.cell(i)).collect();
    assert!(cells.iter().all(|cell| (0.5..=1.5).contains(&(cell / 0.25))), "{cells:?}");
    assert_eq!(moved.grid.lines[0].len(), 2);
    assert!(moved.warnings.is_empty(), "{:?}", moved.warnings);
    // By hand, nothing is moved, and it is told.
    let by_hand = valid(FOOTING, &["accuracy=draft", aside, "footing.to=[1.3, 5.0]", "grid.cell=0.25"]);
    assert!(by_hand.warnings.iter().any(|told| told.contains("lies inside a cell")), "{:?}", by_hand.warnings);
}
