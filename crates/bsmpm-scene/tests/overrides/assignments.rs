//! Tests that `--set KEY=VALUE` changes the case, and that its errors name it.

use super::{FULL, STATIC, set, valid};
use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Error, Every, Face, GridAxis, Place, Site};

#[test]
fn values_arrive_as_toml_bare_words_and_units() {
    assert_eq!(valid(FULL, &["grid.cell=0.25"]).grid.axes[0].cells(), 16);
    assert_eq!(valid(FULL, &["grid.cell=25 cm"]).grid.axes[1].cells(), 12);
    assert_eq!(valid(FULL, &["grid.cell=\"25 cm\""]).grid.axes[1].cells(), 12);
    assert_eq!(valid(FULL, &["grid.cell=[0.25, 0.5]"]).grid.axes[1].cells(), 6);
    assert_eq!(valid(FULL, &["grid.degree=cubic"]).grid.order, 3);
    assert_eq!(
        valid(FULL, &[" stabilisation.method = none "]).stabilisation,
        Stabilisation::None
    );
    assert_eq!(
        valid(FULL, &["title=two words = one title"]).title,
        "two words = one title"
    );
    assert!(!valid(FULL, &["solver.reproducible=false"]).solver.reproducible);
}

#[test]
fn lists_are_reached_by_index_and_absent_tables_are_made() {
    let case = valid(
        FULL,
        &["body.0.points_per_cell=5", "grid.upper.1=4.0", "body.2.box.upper.0=3"],
    );
    assert_eq!(
        (
            case.bodies[0].points_per_cell,
            case.grid.upper()[1],
            case.bodies[2].bounds()[1][0]
        ),
        (5, 4.0, 3.0)
    );
    let case = valid(
        STATIC,
        &["gravity.acceleration=[0, -9.81]", "material.soil.density=2000"],
    );
    assert_eq!(case.gravity.unwrap().acceleration, [0.0, -9.81, 0.0]);
    let case = valid(
        STATIC,
        &[
            "history.0.quantity=height",
            "history.1.quantity=mass",
            "check.0={quantity=\"mass\", min=0}",
        ],
    );
    assert_eq!((case.histories.len(), case.checks[0].min), (2, Some(0.0)));
    assert_eq!(
        valid(STATIC, &["material.clay={model=\"elastic\", young=1e6, poisson=0}"]).materials[1].name,
        "clay"
    );
}

#[test]
fn a_star_is_every_item_of_a_list_and_every_name() {
    let case = valid(
        FULL,
        &[
            "body.*.points_per_cell=5",
            "material.*.poisson=0.25",
            "body.1.points_per_cell=3",
        ],
    );
    let points: Vec<usize> = case.bodies.iter().map(|body| body.points_per_cell).collect();
    assert_eq!(points, [5, 3, 5, 5, 5, 5]);
    assert!(
        case.materials
            .iter()
            .all(|named| named.material.elastic().poisson == 0.25)
    );
    for (text, change) in [(FULL, "body.*=3"), (STATIC, "traction.*.ramp=1"), (FULL, "grid.*=1")] {
        assert!(set(text, &[change]).is_err(), "{change}");
    }
}

#[test]
fn one_of_two_exclusive_keys_removes_the_other() {
    assert_eq!(valid(FULL, &["analysis.steps=4"]).analysis.dt, 0.25);
    assert_eq!(valid(STATIC, &["analysis.dt=0.5"]).analysis.dt, 0.5);
    assert_eq!(
        valid(STATIC, &["analysis.dt=0.5", "analysis.steps=8"]).analysis.dt,
        0.125
    );
    assert_eq!(
        valid(FULL, &["output.every_steps=7"]).output.every,
        Some(Every::Steps(7))
    );
    assert_eq!(
        valid(FULL, &["material.clay.density=1500"]).materials[1].density,
        Some(1500.0)
    );
    assert!(
        valid(FULL, &["material.sand.unit_weight=981 kN/m3"]).materials[0]
            .density
            .is_some_and(|d| d > 9.9e4)
    );
    let case = valid(FULL, &["grid.knots.x=[0, 1, 4]", "grid.knots.y=[0, 1.5, 3]"]);
    assert_eq!(
        case.grid.axes,
        [
            GridAxis::Graded(vec![0.0, 1.0, 4.0]),
            GridAxis::Graded(vec![0.0, 1.5, 3.0])
        ]
    );
    assert_eq!(valid(&case.text, &["grid.cell=1"]).grid.axes[0].cells(), 4);
    let round = valid(FULL, &["body.3.circle={centre=[3, 2], radius=0.5}"]);
    assert_eq!(round.bodies[3].bounds(), [[2.5, 1.5], [3.5, 2.5]]);
    assert_eq!(
        valid(FULL, &["body.4.box={lower=[0, 2], upper=[0.5, 2.5]}"]).bodies[4].area(),
        0.25
    );
    let moved = |set: &str| valid(FULL, &[set]).footing.unwrap().path.rows;
    assert_eq!(moved("footing.velocity=[0, -0.25]"), [(1.0, [0.0, -0.25, 0.0])]);
    assert_eq!(
        moved("footing.path=[[0, 0, 0], [0.5, 0, -0.25]]"),
        [(0.5, [0.0, -0.25, 0.0])]
    );
    let case = valid(
        FULL,
        &[
            "prescribed.1.face=left",
            "boundary.left=free",
            "prescribed.1.path.0=[0.5, 0.1, 0]",
        ],
    );
    assert_eq!(case.prescribed[1].site, Site::Face(Face { axis: 0, upper: false }));
    let errors = set(FULL, &["initial.gravity=elastic"]).unwrap_err();
    assert!(
        errors.len() == 1 && errors[0].key == "material.till.k0",
        "only its own k0 is left: {errors:?}"
    );
}

#[test]
fn errors_cite_the_override() {
    let rows = [
        ("grid.cell=-1", "grid.cell", "(cell > 0"),
        ("grid.cell=5 s", "grid.cell", "unit of time"),
        ("grid.cel=5 mm", "grid.cel", "did you mean `cell`?"),
        ("body.6.points_per_cell=3", "body.6", "missing"),
        (
            "body.9.points_per_cell=3",
            "body.9.points_per_cell",
            "has no item 9. It has 6 items",
        ),
        (
            "body.x.points_per_cell=3",
            "body.x.points_per_cell",
            "`x` is not a number, but a list needs the number of an item",
        ),
        ("shaking.acceleration.file=a.csv", "shaking.acceleration.file", "E0027"),
        (
            "shaking={acceleration={file=\"a.csv\"}}",
            "shaking.acceleration",
            "E0027",
        ),
        ("title.x=3", "title.x", "not a table"),
        ("grid.cell", "", "E0025"),
        ("grid..cell=1", "grid..cell", "E0025"),
        ("=1", "", "E0025"),
        ("grid.cell=[1", "grid.cell", "E0025"),
        ("a.b.c.d.e.f.g.h=1", "a.b.c.d.e.f.g.h", "E0025"),
        ("material.mud.young=1", "material.mud.model", "missing"),
        (
            "footing.interface=soft",
            "footing.interface",
            "expected one of \"smooth\", \"rough\"",
        ),
        (
            "strength_reduction.factor=0.01",
            "strength_reduction.factor",
            "0.1 <= factor <= 100",
        ),
        (
            "body.3.subtract.0.circle.radius=0",
            "body.3.subtract.0.circle.radius",
            "radius > 0",
        ),
        ("profile.0.end=1", "profile.0.end", "E0011"),
    ];
    for (text, key, says) in rows {
        let errors = set(FULL, &[text]).unwrap_err();
        let fits = |error: &Error| {
            error.place == Place::Override(text.to_owned())
                && error.key.starts_with(key)
                && error.to_string().contains(says)
        };
        assert!(errors.iter().any(fits), "{text}: {errors:#?}");
        assert!(
            errors[0].to_string().starts_with(&format!("--set {text}: ")),
            "{}",
            errors[0]
        );
    }
}

#[test]
fn the_effective_text_gives_the_same_case() {
    for (text, overrides) in [
        (
            FULL,
            &[
                "grid.cell=0.25",
                "title=a \"quoted\" \\ title",
                "body.0.box.upper=[4, 0.9]",
            ][..],
        ),
        (
            STATIC,
            &["history.0={quantity=\"displacement\", at=[1, 1]}", "analysis.dt=0.125"][..],
        ),
    ] {
        let case = valid(text, overrides);
        let again = valid(&case.text, &[]);
        assert_eq!(again, case);
        assert_eq!(valid(text, &[]).text, text);
    }
}
