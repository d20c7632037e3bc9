//! Tests the values that `accuracy` chooses.

use bsmpm::kinematics::PlaneStrain;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Case, Error, GridAxis, Place, differences, seed};

const COLUMN: &str = include_str!("../../../cases/presets/column_collapse.toml");
const SLOPE: &str = include_str!("../../../cases/presets/slope_stability.toml");
const FOOTING: &str = include_str!("../../../cases/presets/strip_footing.toml");

fn read(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text(
        "case.toml",
        text,
        &overrides.iter().map(ToString::to_string).collect::<Vec<_>>(),
    )
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    read(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

/// Cells along x, their edge in m, points along it, length of a step, force tolerance.
fn discretisation(case: &Case) -> (usize, f64, usize, f64, f64) {
    let x = &case.grid.axes[0];
    (
        x.cells(),
        x.shortest(),
        case.bodies[0].points_per_cell,
        case.analysis.dt,
        case.solver.force_tolerance,
    )
}

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

/// What a word cannot choose it reports, with what that would follow from; where that is an error itself, this is the
/// only one. What is given needs no choice.
#[test]
fn what_cannot_be_chosen_is_reported_at_the_word() {
    let only = |text: &str, overrides: &[&str]| {
        let mut errors = read(text, overrides).unwrap_err();
        assert_eq!(errors.len(), 1, "{errors:?}");
        errors.remove(0)
    };
    let without = |line: &str| {
        assert!(COLUMN.contains(line), "{line}");
        COLUMN.replace(line, "")
    };
    let weightless = only(&without("unit_weight    = \"20.4 kN/m3\"\n"), &[]);
    assert!(weightless.code.as_deref() == Some("E0310"), "{weightless}");
    let bodiless = only(&without("box = { lower = [0.0, 0.0], upper = [0.2, 0.1] }\n"), &[]);
    assert!(bodiless.code.as_deref() == Some("E0014"), "{bodiless}");
    let in_time = ["analysis.type=consolidation", "analysis.growth=1.2"];
    let errors = read(COLUMN, &in_time).unwrap_err();
    let is_of_steps = |error: &Error| error.key == "accuracy" && error.code.as_deref() == Some("E0254");
    assert!(errors.iter().any(is_of_steps), "{errors:?}");
    let given = read(COLUMN, &[&in_time[..], &["analysis.dt=1e-3"]].concat())
        .err()
        .unwrap_or_default();
    assert!(!given.iter().any(is_of_steps), "{given:?}");
}

/// Errors of what was filled in stand at the word; what cannot be filled in is missed as ever.
#[test]
fn errors_have_a_place() {
    let errors = read(COLUMN, &["accuracy=fine"]).unwrap_err();
    assert!(
        errors
            .iter()
            .any(|error| error.key == "accuracy" && error.message.contains("\"draft\"")),
        "{errors:?}"
    );
    let wide = COLUMN.replace("upper = [0.55, 0.1025]", "upper = [1e8, 0.1025]");
    let line = 1 + COLUMN.lines().position(|line| line.starts_with("accuracy")).unwrap();
    let at_the_word = |error: &Error| matches!(error.place, Place::Line { line: found, .. } if found == line);
    let errors = read(&wide, &[]).unwrap_err();
    assert!(
        errors
            .iter()
            .any(|error| error.key == "grid.cell" && at_the_word(error)),
        "{errors:?}"
    );
    let without = COLUMN.replace("lower = [0.0, 0.0]\nupper = [0.55, 0.1025]\n", "");
    let errors = read(&without, &[]).unwrap_err();
    let keys: Vec<&str> = errors.iter().map(|error| error.key.as_str()).collect();
    assert_eq!(keys, ["grid.lower", "grid.upper"], "{errors:?}");
}

/// m  the breakpoints of an axis, in the case's coordinates
fn breakpoints(axis: &GridAxis) -> Vec<f64> {
    (0..=axis.cells()).map(|i| axis.lower() + axis.breakpoint(i)).collect()
}

fn edges(axis: &GridAxis) -> Vec<f64> {
    (0..axis.cells()).map(|i| axis.cell(i)).collect()
}

/// Breakpoints cover the grid, neighbours are as `most` to one at most, no cell is longer than `longest` (m).
fn assert_sound(case: &Case, corners: [[f64; 2]; 2], longest: f64, most: f64) {
    for (axis, [lower, upper]) in case
        .grid
        .axes
        .iter()
        .zip([0, 1].map(|k| [corners[0][k], corners[1][k]]))
    {
        let all = breakpoints(axis);
        let edges = edges(axis);
        assert!(
            all[0] == lower && all[all.len() - 1] == upper && all.is_sorted(),
            "{all:?}"
        );
        assert!((edges.iter().sum::<f64>() - (upper - lower)).abs() < 1e-12 * (upper - lower));
        let ratio = |pair: &[f64]| (pair[1] / pair[0]).max(pair[0] / pair[1]);
        assert!(edges.windows(2).all(|pair| ratio(pair) <= most), "{edges:?}");
        assert!(edges.iter().all(|edge| *edge <= longest), "{edges:?}");
    }
}

/// Whether each of the cells between two places is `edge` long (m), with grid lines at both places.
fn is_fine(axis: &GridAxis, [lower, upper]: [f64; 2], edge: f64) -> bool {
    let inside: Vec<f64> = breakpoints(axis)
        .into_iter()
        .filter(|at| (lower..=upper).contains(at))
        .collect();
    let ends = inside.first() == Some(&lower) && inside.last() == Some(&upper);
    ends && inside.windows(2).all(|pair| (pair[1] - pair[0] - edge).abs() < 1e-9)
}

#[test]
fn cells_are_small_around_a_strip_and_on_its_way_and_grow_away_from_it() {
    for (word, edge, reach, longest, growth) in [
        ("draft", 0.25, 0.25, 1.0, 1.5),
        ("standard", 0.125, 0.5, 0.5, 1.2),
        ("reference", 1.0 / 12.0, 1.0, 0.25, 1.1),
    ] {
        let case = valid(FOOTING, &[&format!("accuracy={word}")]);
        let x = &case.grid.axes[0];
        let y = &case.grid.axes[1];
        assert_sound(&case, [[0.0, 0.0], [10.0, 12.0]], 1.1 * longest, 1.15 * growth);
        // From the strip's axis to beyond its end; from below its last place to above its first, all breakpoints.
        assert!(
            is_fine(x, [0.0, 1.0], edge) && is_fine(x, [1.0, 1.0 + reach], edge),
            "{x:?}"
        );
        assert!(
            is_fine(y, [8.0 - reach, 10.0], edge) && is_fine(y, [10.0, 10.0 + reach], edge),
            "{y:?}"
        );
        assert!(x.longest() > 2.5 * edge && y.longest() > 2.5 * edge);
        assert!(case.warnings.is_empty(), "{:?}", case.warnings);
        // Sizes, places and reasons are reported.
        let reports: Vec<_> = case.notes.iter().filter(|note| note.key == "grid.knots").collect();
        let [all, zone, rest] = &reports[..] else {
            panic!("{reports:?}")
        };
        assert!(all.reason.contains("cells across the bodies (10 m)") && all.reason.contains(&growth.to_string()));
        assert!(zone.value.contains(&format!(
            "x = 0 to {}, y = {} to {}",
            1.0 + reach,
            8.0 - reach,
            10.0 + reach
        )));
        assert!(
            zone.reason.contains("across `footing` (2 m wide, half of it modelled)"),
            "{}",
            zone.reason
        );
        assert!(
            rest.value.starts_with("up to ") && rest.value.ends_with(" elsewhere"),
            "{}",
            rest.value
        );
        // Points fill the ground, whose volume does not depend on the cells; the estimate counts them.
        let seeds: Vec<f64> = seed::<PlaneStrain, 2>(&case, 0..x.cells())
            .map(|seed| seed.volume)
            .collect();
        assert_eq!(case.estimate(1).points, seeds.len() as u64);
        assert!((seeds.iter().sum::<f64>() - 100.0).abs() < 1e-9);
    }
}

/// A plate at the axis is half of what it is across, as one at a plane of symmetry is; a ring has its own width.
#[test]
fn a_circular_plate_has_the_cells_of_a_strip_as_wide() {
    let plate = valid(FOOTING, &["accuracy=draft", "geometry=axisymmetric"]);
    let strip = valid(FOOTING, &["accuracy=draft"]);
    assert!(
        plate.grid == strip.grid && discretisation(&plate) == discretisation(&strip),
        "{:?}",
        plate.grid
    );
    assert!(
        is_fine(&plate.grid.axes[0], [0.0, 1.25], 0.25) && plate.warnings.is_empty(),
        "{:?}",
        plate.warnings
    );
    let ring = valid(
        FOOTING,
        &["accuracy=draft", "geometry=axisymmetric", "footing.from=[0.5, 10.0]"],
    );
    assert!(
        is_fine(&ring.grid.axes[0], [0.5, 1.0], 0.0625),
        "{:?}",
        ring.grid.axes[0]
    );
}

/// A rigid punch has the cells of a strip as wide; a pipe those around it and its way, a thin plate in the ground two
/// across, a wall that turns those where its end comes to.
#[test]
fn rigid_bodies_have_small_cells_around_the_edges_that_soil_lies_at() {
    let of = |rigid: &str, hole: &str| {
        let (ground, rest) = FOOTING.split_once("[footing]").unwrap();
        let rest = rest
            .split_once("[boundary]")
            .unwrap()
            .1
            .split_once("[[history]]")
            .unwrap()
            .0;
        let text = format!("{ground}[boundary]{rest}");
        let cut = format!("body.0.subtract=[{hole}]");
        valid(
            &text,
            &[
                "accuracy=draft",
                &format!("rigid=[{{ name = \"body\", {rigid} }}]"),
                &cut,
            ],
        )
    };
    let punch = of(
        "polygon = [[-1, 10], [1, 10], [1, 11], [-1, 11]], displacement = [0.0, -2.0]",
        "",
    );
    let strip = valid(FOOTING, &["accuracy=draft"]);
    assert!(
        is_fine(&punch.grid.axes[0], [0.0, 1.25], 0.25),
        "{:?}",
        punch.grid.axes[0]
    );
    assert!(
        is_fine(&punch.grid.axes[1], [7.75, 10.0], 0.25),
        "{:?}",
        punch.grid.axes[1]
    );
    let steps = |case: &Case| (case.analysis.end / case.analysis.dt).round();
    assert_eq!(steps(&punch), steps(&strip));
    assert!(punch.warnings.is_empty(), "{:?}", punch.warnings);
    let circle = "circle = { centre = [5, 5], radius = 0.8 }";
    let pipe = of(
        &format!("{circle}, displacement = [0.0, 1.0]"),
        &format!("{{ {circle} }}"),
    );
    assert!(
        is_fine(&pipe.grid.axes[0], [4.0, 6.0], 0.2) && is_fine(&pipe.grid.axes[1], [4.0, 7.0], 0.2),
        "{:?}",
        pipe.grid
    );
    let plate = "polygon = [[4, 5], [6, 5], [6, 5.2], [4, 5.2]]";
    let plate = of(plate, &format!("{{ {plate} }}"));
    assert!(
        is_fine(&plate.grid.axes[1], [5.0, 5.2], 0.1),
        "{:?}",
        plate.grid.axes[1]
    );
    // By a right angle about its lower end: 2 m to the left.
    let wall = "polygon = [[5, 7], [5.5, 7], [5.5, 9], [5, 9]]";
    let hole = format!("{{ {wall} }}");
    let turns = of(
        &format!("{wall}, about = [5, 7], rotation = [[0.5, 0], [1.0, 90]]"),
        &hole,
    );
    let still = of(wall, &hole);
    let cells = |case: &Case| case.grid.axes[0].cells();
    assert!(
        cells(&turns) > cells(&still) && steps(&turns) > 100.0 && steps(&still) == 10.0,
        "{}",
        steps(&turns)
    );
}

/// What is small follows each strip or load and its way, not the shortest of them.
#[test]
fn every_strip_and_load_has_small_cells_of_its_own() {
    let load = "traction.0={ from = [6.0, 10.0], to = [6.5, 10.0], stress = [0.0, -100.0], ramp = 1.0 }";
    let case = valid(FOOTING, &[load]);
    let x = &case.grid.axes[0];
    let y = &case.grid.axes[1];
    assert!(
        is_fine(x, [0.0, 1.5], 0.125) && is_fine(x, [6.0, 6.5], 0.03125),
        "{x:?}"
    );
    assert!(is_fine(y, [9.875, 10.0], 0.03125), "{y:?}");
    assert_sound(&case, [[0.0, 0.0], [10.0, 12.0]], 0.55, 1.5);
    let reports = |case: &Case| case.notes.iter().filter(|note| note.key == "grid.knots").count();
    assert_eq!(reports(&case), 4);
    // A strip between two others' rollers is no half, and a wide one asks for no smaller cells than the bodies do.
    let wide = valid(FOOTING, &["footing.to=[10.0, 10.0]"]);
    assert_eq!((reports(&wide), wide.grid.axes[0].cells()), (0, 20));
    let whole = valid(FOOTING, &["footing.from=[4.0, 10.0]", "footing.to=[6.0, 10.0]"]);
    assert!(
        is_fine(&whole.grid.axes[0], [3.5, 6.5], 0.125),
        "{:?}",
        whole.grid.axes[0]
    );
    // A wall beside the soil, and its way until the end.
    let wall = "footing={ from = [5.0, 8.0], to = [5.0, 10.0], path = [[0.5, -1.0, 0.0], [1.5, 1.0, 0.0]] }";
    let pushed = valid(FOOTING, &[wall]);
    assert!(is_fine(&pushed.grid.axes[0], [3.5, 5.0], 0.125) && is_fine(&pushed.grid.axes[0], [5.0, 5.5], 0.125));
    assert!(
        is_fine(&pushed.grid.axes[1], [7.5, 8.0], 0.125),
        "{:?}",
        pushed.grid.axes[1]
    );
    // By hand, cells stay as they are.
    let by_hand = valid(FOOTING, &["grid.cell=0.5"]);
    assert_eq!((reports(&by_hand), edges(&by_hand.grid.axes[0])), (0, vec![0.5; 20]));
}

/// So many breakpoints are the author's to ask for.
#[test]
fn a_strip_too_small_for_its_grid_is_an_error() {
    let tiny = ["footing.from=[4.0, 10.0]", "footing.to=[4.00001, 10.0]"];
    let errors = read(FOOTING, &tiny).unwrap_err();
    assert!(
        errors.iter().any(|error| error.code.as_deref() == Some("E0253")),
        "{errors:?}"
    );
}

#[test]
fn cells_are_moved_to_where_strips_end_and_materials_meet() {
    // Equal cells of 1 m from 0: the strip, from 1.2 to 9.3 m, is wide enough for them.
    let aside = "footing.from=[1.2, 5.0]";
    let moved = valid(FOOTING, &["accuracy=draft", aside, "footing.to=[9.3, 5.0]"]);
    let x = &moved.grid.axes[0];
    let is_line = |wanted: f64| (0..=x.cells()).any(|i| (x.breakpoint(i) - wanted).abs() < 1e-12);
    assert!(is_line(1.2) && is_line(9.3));
    let cells: Vec<f64> = (0..x.cells()).map(|i| x.cell(i)).collect();
    assert!(cells.iter().all(|cell| (0.5..=1.5).contains(cell)), "{cells:?}");
    assert_eq!(moved.grid.lines[0].len(), 2);
    assert!(moved.warnings.is_empty(), "{:?}", moved.warnings);
    // By hand, nothing is moved, and it is reported.
    let by_hand = valid(
        FOOTING,
        &["accuracy=draft", aside, "footing.to=[9.3, 5.0]", "grid.cell=1.0"],
    );
    assert!(
        by_hand
            .warnings
            .iter()
            .any(|warning| warning.contains("is not on a grid line")),
        "{:?}",
        by_hand.warnings
    );
}

/// Softening goes by the edge of equal squares: a preset neither grades its cells nor makes them oblong.
#[test]
fn cells_of_what_softens_in_bands_of_a_given_width_are_equal_squares() {
    let soft = |name: &str| {
        format!(
            "material.{name}={{ model = \"mohr-coulomb-softening\", young = 1e7, poisson = 0.3, unit_weight = 2e4, \
             friction_angle = 0, cohesion = 1e4, residual_friction_angle = 0, residual_cohesion = 5e3, softening_strain = 0.5, \
             band_width = 0.1 }}"
        )
    };
    let oblong = |case: &Case| case.grid.axes[0].longest().max(case.grid.axes[1].longest()) / case.grid.shortest();
    // Whole along both axes: 10 m and 4.3 m in 23 and 10 cells would be 0.4348 by 0.43 m.
    let flat = [
        "accuracy=draft",
        "body.0.box.upper=[10.0, 4.3]",
        "grid.upper=[10.0, 4.3]",
        "boundary.top=roller",
    ];
    assert!(oblong(&valid(COLUMN, &flat)) > 1.01);
    let case = valid(COLUMN, &[&flat[..], &[&soft("rods")]].concat());
    let x = &case.grid.axes[0];
    let y = &case.grid.axes[1];
    assert!(
        oblong(&case) <= 1.01 && (0.2..0.44).contains(&x.longest()),
        "{x:?} {y:?}"
    );
    assert!(
        (x.length() - 10.0).abs() < 1e-12 && (y.length() - 4.3).abs() < 1e-12,
        "{x:?} {y:?}"
    );
    // As small everywhere as a strip wants them, with lines at its end and on the ground.
    let case = valid(FOOTING, &["accuracy=draft", &soft("clay")]);
    let x = &case.grid.axes[0];
    let y = &case.grid.axes[1];
    assert!(
        is_fine(x, [0.0, 10.0], 0.25) && is_fine(y, [0.0, 10.0], 0.25),
        "{x:?} {y:?}"
    );
    // A strip whose end is on no line of the cells that it wants: of smaller ones one has it.
    let case = valid(FOOTING, &["accuracy=draft", &soft("clay"), "footing.to=[1.2, 10.0]"]);
    let x = &case.grid.axes[0];
    assert!(x.longest() < 0.3 && oblong(&case) < 1.0 + 1e-9, "{x:?}");
    assert!((0..=x.cells()).any(|i| (x.breakpoint(i) - 1.2).abs() < 1e-9), "{x:?}");
}

/// A bar of 64 m between rollers; a pulse of 95 % of its energy below 1.664 times 2 Hz runs along it at 60 m/s.
fn pulsed(frequency: f64) -> String {
    let pulse = |t: f64| {
        let x = (std::f64::consts::PI * frequency * (t - 0.6)).powi(2);
        (1.0 - 2.0 * x) * (-x).exp()
    };
    let rows: Vec<String> = (1..=240)
        .map(|k| 0.005 * f64::from(k))
        .map(|t| format!("[{t:?}, {:?}]", pulse(t)))
        .collect();
    format!(
        r#"
        geometry = "plane-strain"
        [analysis]
        type = "dynamic"
        end = 4.0
        [grid]
        lower = [0.0, 0.0]
        upper = [64.0, 16.0]
        [material.elastic]
        model = "elastic"
        young = 6.48e6
        poisson = 0.0
        density = 1800.0
        [[body]]
        material = "elastic"
        box = {{ lower = [0.0, 0.0], upper = [64.0, 16.0] }}
        [boundary]
        right = "absorbing"
        bottom = "roller"
        top = "roller"
        [[traction]]
        from = [0.0, 0.0]
        to = [0.0, 16.0]
        stress = [1000.0, 0.0]
        amplitude = [{}]
        "#,
        rows.join(", ")
    )
}

/// Wavelength 60/(1.664 f), 8 cells of it with the consistent mass that an elastic case has and 24 with the lumped one.
#[test]
fn waves_of_a_table_ask_for_cells() {
    let edge = |frequency: f64, overrides: &[&str]| {
        let case = valid(&pulsed(frequency), overrides);
        assert!(
            case.warnings.iter().all(|warning| !warning.contains("wavelength")),
            "{:?}",
            case.warnings
        );
        case.grid.axes[0].longest()
    };
    let wanted = |frequency: f64, fewest: f64| 60.0 / (1.664 * frequency * fewest);
    // Bodies alone want 1.6 m.
    assert!((edge(1.0, &["accuracy=draft"]) - 1.6).abs() < 1e-9);
    let lumped = ["accuracy=draft", "analysis.mass=lumped"];
    for (found, wanted) in [
        (edge(2.0, &lumped), wanted(2.0, 24.0)),
        (edge(4.0, &["accuracy=draft"]), wanted(4.0, 8.0)),
    ] {
        assert!(found <= 1.02 * wanted && found > 0.9 * wanted, "{found} {wanted}");
    }
    let slow = valid(&pulsed(16.0), &["accuracy=draft"]);
    assert!((slow.grid.axes[0].longest() - 0.4).abs() < 1e-9);
    let warned = |case: &bsmpm_scene::Case| {
        case.warnings
            .iter()
            .filter(|warning| warning.contains("wavelength"))
            .count()
    };
    assert_eq!(warned(&slow), 1);
}
