//! Tests that bodies are cut at planes of symmetry.

use super::{METRES, case, try_case, verify};
use bsmpm::kinematics::Solid;
use bsmpm_scene::{Case, Seed, seed};

/// A circle about the corner of the grid, a strip of a box and a half of a triangle: the same as cut by hand.
#[test]
fn bodies_are_cut_at_planes_of_symmetry() {
    const ROLLERS: &str =
        "lower = [0, 0]\nupper = [40, 20]\ncell = 1\n[boundary]\nleft = \"roller\"\nbottom = \"roller\"";
    let points = |body: &str| {
        let case = case(ROLLERS, &[body], 2);
        (
            case.notes
                .iter()
                .filter(|note| note.value.starts_with("cut at"))
                .count(),
            verify(&case, 1e-12),
        )
    };
    let circle = "circle = { centre = [0, 0], radius = 9.7 }";
    let by_hand = format!(
        "{circle}\nsubtract = [{{ box = {{ lower = [-20, -20], upper = [0, 20] }} }}, \
         {{ box = {{ lower = [-20, -20], upper = [20, 0] }} }}]"
    );
    let quarter = points(circle);
    let expected = points(&by_hand);
    assert_eq!((quarter.0, expected.0), (1, 0));
    assert_eq!(quarter.1, expected.1);
    let area: f64 = quarter.1.iter().map(|seed| seed.volume).sum();
    assert!(
        (area / (0.25 * std::f64::consts::PI * 9.7 * 9.7) - 1.0).abs() < 1e-12,
        "{area}"
    );
    let half_box = points("box = { lower = [-3.5, 1], upper = [3.5, 4] }");
    assert_eq!(half_box.1, points("box = { lower = [0, 1], upper = [3.5, 4] }").1);
    let half = points("polygon = [[-5.5, 1], [5.5, 1], [0, 9]]").1;
    assert!((half.iter().map(|seed| seed.volume).sum::<f64>() / 22.0 - 1.0).abs() < 1e-12);
    // No symmetry: refused as before; so without a roller.
    for body in [
        "box = { lower = [-3, 1], upper = [3.5, 4] }",
        "circle = { centre = [0.1, 0], radius = 9.7 }",
    ] {
        assert!(
            try_case(ROLLERS, &[body], 2).unwrap_err()[0]
                .message
                .contains("outside the grid"),
            "{body}"
        );
    }
    assert!(try_case(METRES, &[circle], 2).is_err());
}

/// A quarter of a cylinder about the corner of the grid, and an eighth of a sphere.
#[test]
fn solids_are_cut_at_planes_of_symmetry() {
    let volume = |body: &str| {
        let text = format!(
            "geometry = \"3d\"\nanalysis = {{ type = \"quasi-static\", steps = 1 }}\n\
             boundary = {{ bottom = \"roller\", left = \"roller\", front = \"roller\" }}\n\
             grid = {{ lower = [0, 0, 0], upper = [3, 3, 3], cell = 0.25, degree = \"quadratic\" }}\n\
             [material.m]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\n\
             [[body]]\nmaterial = \"m\"\npoints_per_cell = 2\n{body}\n"
        );
        let case = Case::from_text("case.toml", &text, &[]).unwrap_or_else(|errors| panic!("{errors:#?}"));
        let points: Vec<Seed<3>> = seed::<Solid, 3>(&case, 0..case.grid.axes[0].cells()).collect();
        points.iter().map(|point| point.volume).sum::<f64>()
    };
    let quarter = volume("extrude = { circle = { centre = [0, 0], radius = 2 }, along = \"z\", from = 0, to = 1.5 }");
    assert!((quarter / (1.5 * std::f64::consts::PI) - 1.0).abs() < 1e-9, "{quarter}");
    let eighth = volume("sphere = { centre = [0, 0, 0], radius = 2 }");
    assert!(
        (eighth / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3,
        "{eighth}"
    );
}
