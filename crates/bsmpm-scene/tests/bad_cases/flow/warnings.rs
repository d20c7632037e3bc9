//! Tests that doubtful cases with pore-water flow are accepted with a warning.

/// More rain than the ground takes, and walls and gaps that are thinner than the pressure's functions.
#[test]
fn rain_that_lifts_and_walls_that_leak_are_warned_of() {
    let case = |changes: &[(&str, &str)]| {
        let text = changes
            .iter()
            .fold(include_str!("../seeping.toml").to_owned(), |text, (was, is)| {
                text.replace(was, is)
            });
        bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings
    };
    let has = |warnings: &[String], words: &str| warnings.iter().any(|warning| warning.contains(words));
    let lifts = "W0531: inflow.0: 2.7";
    let gap = "W0535: the gap";
    let wall = "W0535: the wall of `tight`";
    let whole = case(&[]);
    assert!(![lifts, gap, wall].into_iter().any(|of| has(&whole, of)), "{whole:?}");
    assert!(has(&case(&[("runoff = true\n", "")]), lifts));
    let steep = [("alpha = 2.0", "alpha = 100.0")];
    assert!(has(&case(&steep), "W0540: material.clay.retention: ") && !has(&whole, "W0540"));
    let clay = "box = { lower = [0.0, 0.0], upper = [4.0, 2.0] }\npoints_per_cell = 3\n";
    let apart = |x: f64| {
        format!(
            "box = {{ lower = [0.0, 0.0], upper = [1.0, 2.0] }}\npoints_per_cell = 3\n[[body]]\nmaterial = \"clay\"\n\
             box = {{ lower = [{x}, 0.0], upper = [4.0, 2.0] }}\npoints_per_cell = 3\n"
        )
    };
    assert!(has(&case(&[(clay, &apart(1.5))]), gap));
    let held = apart(1.5)
        + "[[body]]\nmaterial = \"tight\"\nbox = { lower = [1.0, 0.0], upper = [1.5, 2.0] }\npoints_per_cell = 3\n";
    assert!(has(&case(&[(clay, &held)]), wall));
    let finer = ("cell  = \"1 m\"", "cell = 0.25");
    assert!(!has(&case(&[(clay, &held), finer]), wall) && !has(&case(&[(clay, &apart(1.5)), finer]), gap));
}

/// Ground above the water table that stays full, and a step of the table that no point may see.
#[test]
fn water_that_hangs_and_steps_that_are_narrow_are_warned_of() {
    let case = |water: &str, more: &str| {
        let text = include_str!("../../../../../cases/rapid_drawdown.toml")
            .replace("level_path = [[\"0 d\", 15.0], [\"10 d\", 5.0]]", water)
            .replace(
                "permeability   = \"1e-9 m/s\"",
                &format!("permeability = \"1e-9 m/s\"\n{more}"),
            );
        bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings
    };
    let has = |warnings: &[String], words: &str| warnings.iter().any(|warning| warning.contains(words));
    let hangs = "the soil stays saturated to 5.00 m above the water table";
    assert!(has(&case("level = 10.0", ""), hangs));
    assert!(!has(&case("level = 15.0", ""), "W0553"));
    let retention = "retention = { alpha = 0.1, n = 2.0, residual = 0.1 }";
    assert!(!has(&case("level = 10.0", retention), "W0553"));
    let step = |width: f64| format!("line = [[0, 15], [30, 15], [{}, 5], [60, 5]]", 30.0 + width);
    assert!(has(&case(&step(0.5), retention), "W0522"));
    assert!(!has(&case(&step(2.0), retention), "W0522"));
}

/// The flux in the cell of a surface, where it jumps; deeper it does not.
#[test]
fn a_flux_next_to_a_surface_is_warned_of() {
    let case = |at: &str| {
        let text = include_str!("../../../../../cases/rapid_drawdown.toml").to_owned();
        let text = text + &format!("\n[[history]]\nquantity = \"flux\"\nat = {at}\n");
        bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings
    };
    let has = |warnings: &[String]| warnings.iter().any(|warning| warning.contains("W0532"));
    assert!(has(&case("[10.0, 14.2]")) && has(&case("[29.8, 9.6]")));
    assert!(
        !has(&case("[10.0, 13.5]")) && !has(&case("[0.1, 0.1]")),
        "a face of the grid is no surface"
    );
}

/// Ground one cell across under a load of half its stiffness, of which averages leave a way to go sideways.
#[test]
fn ground_one_cell_across_under_a_large_load_is_warned_of() {
    let case = |more: &[(&str, &str)]| {
        let text = include_str!("../../../../../cases/validation/large_consolidation.toml").to_owned();
        let text = more.iter().fold(text, |text, (from, to)| text.replace(from, to));
        bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings
    };
    let has = |warnings: &[String]| warnings.iter().any(|warning| warning.contains("W0542"));
    let narrow = [
        ("[0.1, 1.0]", "[0.05, 1.0]"),
        ("at       = [0.05, 1.0]", "at       = [0.025, 1.0]"),
    ];
    assert!(has(&case(&narrow)) && !has(&case(&[])));
    assert!(!has(&case(&[&narrow[..], &[("consistent-f-bar", "none")]].concat())));
    assert!(!has(&case(&[&narrow[..], &[("-500 kPa", "-200 kPa")]].concat())));
}
