//! Tests material interfaces: averages, weights and warnings.

use bsmpm::model::AverageWeight;
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
        (&[][..], 1, AverageWeight::Volume),
        (&[EQUAL][..], 1, AverageWeight::Mass),
        (&[EQUAL, "material.light.young=2e9"][..], 2, AverageWeight::Mass),
        (&[EQUAL, "material.light.poisson=0.2"][..], 2, AverageWeight::Mass),
        (&["material.light.young=2e9"][..], 2, AverageWeight::Volume),
    ] {
        let case = layers(changes);
        assert_eq!(
            (model::groups(&case).count(), model::weighting(&case)),
            (groups, weighting),
            "{changes:?}"
        );
    }
}

/// The dilatant one has the adjoint force, and the other one does not.
#[test]
fn averages_do_not_mix_dilatant_material_with_other_material() {
    let yielding = "model=\"mohr-coulomb\", young=1e9, poisson=0.3, cohesion=1e6, friction_angle=30, unit_weight=2e4";
    for method in ["consistent-f-bar", "subgrid-f-bar"] {
        let case = layers(&[
            &format!("stabilisation.method=\"{method}\""),
            &format!("material.light={{ {yielding}, dilation_angle=20 }}"),
            &format!("material.heavy={{ {yielding}, dilation_angle=0 }}"),
        ]);
        assert_eq!(model::groups(&case).count(), 2, "{method}");
    }
}

#[test]
fn interfaces_beyond_what_was_verified_have_a_warning() {
    let inside = ["body.0.box.upper=[3, 6.5]", "body.1.box.lower=[0, 6.5]"];
    let soft = "material.heavy={ model = \"tresca\", young = 1e9, poisson = 0.3, cohesion = 1e4, unit_weight = 2e4 }";
    let warned = |changes: &[&str]| {
        let warnings = layers(changes).warnings;
        let of_interfaces = |warning: &String| ["W0220", "W0221", "W0222"].iter().any(|code| warning.starts_with(code));
        warnings.into_iter().filter(of_interfaces).collect::<Vec<_>>()
    };
    // On a grid line anything elastic was shown; with soil that yields, a stiffer body on it up to 1 : 100.
    assert!(warned(&[EQUAL, "material.light.young=1e13"]).is_empty());
    assert!(warned(&[soft, EQUAL, "material.light.young=1e11"]).is_empty());
    let moving = warned(&[soft, EQUAL, "material.light.young=1.1e11"]);
    assert!(
        moving.len() == 1 && moving[0].contains("differs by a factor of 110 "),
        "{moving:?}"
    );
    // Inside cells, by moduli and by densities.
    for (changes, count) in [
        ([EQUAL, "material.light.young=2e9"], 1),
        ([EQUAL, "material.light.young=1.2e9"], 0),
        (["title=a", "title=b"], 1),
    ] {
        let found = warned(&[&inside[..], &changes].concat());
        assert!(
            found.len() == count && found.iter().all(|warning| warning.starts_with("W0222")),
            "{changes:?}: {found:?}"
        );
    }
}

/// A quasi-static case in cells of 1 m with these shapes as bodies.
fn shapes(shapes: &[&str]) -> Vec<String> {
    let mut text = "geometry = \"plane-strain\"\nanalysis = { type = \"quasi-static\", steps = 1 }\n\
                    grid = { lower = [0, 0], upper = [12, 12], cell = 1, degree = \"quadratic\" }\n\
                    boundary = { bottom = \"fixed\", left = \"fixed\" }\n\
                    [material.m]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\n"
        .to_owned();
    for shape in shapes {
        text += &format!("[[body]]\nmaterial = \"m\"\npoints_per_cell = 4\n{shape}\n");
    }
    let warnings = Case::from_text("case.toml", &text, &[]).expect("valid").warnings;
    warnings
        .into_iter()
        .filter(|warning| warning.starts_with("W0228"))
        .collect()
}

#[test]
fn bodies_that_are_apart_by_less_than_a_cell_are_warned_of() {
    const GROUND: &str = "box = { lower = [0, 0], upper = [8, 2] }";
    let block = |lower: f64| format!("box = {{ lower = [2, {lower:?}], upper = [5, {:?}] }}", lower + 2.0);
    let found = shapes(&[GROUND, &block(2.25)]);
    assert!(
        found.len() == 1 && found[0].starts_with("W0228: body.0 and body.1 are 0.25 m apart (0.25 cells)"),
        "{found:?}"
    );
    // Touching, a cell away or farther, and overlapping; beside and diagonally a cell away.
    for lower in [2.0, 2.0 + 1e-9, 3.0, 5.0, 1.5] {
        assert_eq!(shapes(&[GROUND, &block(lower)]), [""; 0], "{lower}");
    }
    assert_eq!(shapes(&[GROUND, "box = { lower = [9, 0], upper = [10, 2] }"]), [""; 0]);
    assert_eq!(
        shapes(&[GROUND, "box = { lower = [8.5, 2.5], upper = [10, 4] }"]).len(),
        1
    );
    assert_eq!(
        shapes(&[GROUND, "box = { lower = [9, 2.5], upper = [10, 4] }"]),
        [""; 0]
    );
    // A layer that is thinner than a cell fills the gap.
    let layer = "box = { lower = [0, 2], upper = [8, 2.5] }";
    assert_eq!(
        shapes(&[GROUND, "box = { lower = [0, 2.5], upper = [8, 4] }", layer]),
        [""; 0]
    );
    // Several gaps are one line, the narrowest first.
    let blocks = [block(2.5), "box = { lower = [5.125, 2.5], upper = [7, 4] }".to_owned()];
    let found = shapes(&[GROUND, &blocks[0], &blocks[1]]);
    assert!(
        found.len() == 1 && found[0].starts_with("W0228: body.1 and body.2 (and 2 more pairs) are 0.125 m"),
        "{found:?}"
    );
}

#[test]
fn the_gap_of_other_shapes_is_that_between_their_edges() {
    let slope = "polygon = [[0, 0], [8, 0], [0, 8]]";
    let circle = |center: f64| format!("circle = {{ centre = [{center:?}, {center:?}], radius = 1 }}");
    // The slope's surface is x + y = 8.
    let apart = |gap: f64| 4.0 + (1.0 + gap) / std::f64::consts::SQRT_2;
    let found = shapes(&[slope, &circle(apart(0.25))]);
    assert!(found.len() == 1 && found[0].contains("are 0.25 m apart"), "{found:?}");
    for gap in [0.0, 1.01, -0.5] {
        assert_eq!(shapes(&[slope, &circle(apart(gap))]), [""; 0], "{gap}");
    }
    let above = "polygon = [[0, 8], [8, 0], [8, 8]]";
    assert_eq!(shapes(&[slope, above]), [""; 0]);
    let circles = |x: f64| {
        [
            "circle = { centre = [2, 4], radius = 1 }".to_owned(),
            format!("circle = {{ centre = [{x:?}, 4], radius = 1 }}"),
        ]
    };
    for (x, warned) in [(4.5, 1), (5.5, 0)] {
        let [one, other] = circles(x);
        assert_eq!(
            shapes(&["box = { lower = [0, 0], upper = [8, 1] }", &one, &other]).len(),
            warned,
            "{x}"
        );
    }
}
