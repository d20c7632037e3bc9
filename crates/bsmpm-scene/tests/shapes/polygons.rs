//! Tests that polygons have the right points, areas, overlaps and weights.

use super::{ELSEWHERE, GRADED, METRES, Random, case, polygon, shoelace, star, try_case, verify, winds};
use bsmpm_scene::{Case, Region};

#[test]
fn slopes_of_the_paper() {
    let a = "polygon = [[0, 0], [32, 0], [12, 10], [0, 10]]";
    let seeds = verify(&case("lower = [0, 0]\nupper = [40, 12]\ncell = 1", &[a], 6), 1e-12);
    assert_eq!(seeds.len(), 7920);
    let b = "polygon = [[0, 0], [60, 0], [60, 5], [40, 5], [20, 15], [0, 15]]";
    let case = case("lower = [0, 0]\nupper = [60, 17]\ncell = 1", &[b], 6);
    assert_eq!((verify(&case, 1e-12).len(), case.bodies[0].area()), (21_600, 600.0));
    assert_eq!(case.bodies[0].bounds(), [[0.0, 0.0], [60.0, 15.0]]);
}

#[test]
fn points_lie_inside_and_areas_add_up() {
    let mut random = Random(1);
    let mut points = 0;
    for round in 0..150 {
        let (grid, middle) = [(METRES, [20.0, 10.0]), (ELSEWHERE, [14.0, 20.0]), (GRADED, [9.0, 9.5])][round % 3];
        let corners = star(&mut random, middle, [9.0, 2.0, 0.4][round / 3 % 3]);
        let case = case(grid, &[&polygon(&corners)], 1 + round % 5);
        assert!((case.bodies[0].area() / shoelace(&corners) - 1.0).abs() < 1e-12);
        for seed in verify(&case, 1e-11) {
            assert!(winds(&corners, [seed.x[0], seed.x[1]]), "{seed:?} {corners:?}");
            points += 1;
        }
    }
    assert!(points > 10_000);
}

#[test]
fn every_place_of_the_lattice_inside_is_a_point() {
    let mut random = Random(2);
    for n in 1..6_usize {
        let corners = star(&mut random, [20.0, 10.0], 9.0);
        let seeds = verify(&case(METRES, &[&polygon(&corners)], n), 1e-11);
        let place = |k: usize| (k / n) as f64 + ((k % n) as f64 + 0.5) / n as f64;
        let places = (0..40 * n).flat_map(|i| (0..20 * n).map(move |j| [place(i), place(j)]));
        let inside: Vec<[f64; 2]> = places.filter(|at| winds(&corners, *at)).collect();
        let near = |at: &[f64; 2]| seeds.iter().any(|s| (s.x[0] - at[0]).hypot(s.x[1] - at[1]) < 1e-12);
        assert!(!inside.is_empty() && inside.iter().all(near));
    }
}

#[test]
fn orientation_and_first_corner_do_not_matter() {
    let mut corners = star(&mut Random(3), [20.0, 10.0], 8.0);
    let places = |corners: &[[f64; 2]]| {
        let seeds = verify(&case(METRES, &[&polygon(corners)], 3), 1e-12);
        seeds.iter().map(|seed| (seed.id, seed.x)).collect::<Vec<_>>()
    };
    let first = places(&corners);
    corners.rotate_left(2);
    assert_eq!(places(&corners), first);
    corners.reverse();
    assert_eq!(places(&corners), first);
}

#[test]
fn a_polygon_along_the_cells_is_a_box() {
    let whole = "box = { lower = [2, 1], upper = [7, 5] }";
    let boxed = verify(&case(METRES, &[whole], 3), 1e-12);
    let shaped = verify(&case(METRES, &["polygon = [[2, 1], [2, 5], [7, 5], [7, 1]]"], 3), 1e-12);
    assert_eq!(boxed.len(), shaped.len());
    for (a, b) in boxed.iter().zip(&shaped) {
        assert!((a.id, a.x) == (b.id, b.x) && (a.volume - b.volume).abs() < 1e-15);
    }
    assert!(matches!(case(METRES, &[whole], 3).bodies[0].region, Region::Box { .. }));
    let uncut = case(METRES, &[&format!("{whole}\nsubtract = []")], 3);
    assert!(matches!(uncut.bodies[0].region, Region::Box { .. }));
}

/// A skew wall of a twentieth of a cell, and one of a cell.
#[test]
fn walls_thinner_than_points_lie_apart_are_warned_of() {
    let warned = |thick: f64| {
        let wall = format!(
            "polygon = [[2.13, 1], [{}, 1], [{}, 9], [6.13, 9]]",
            2.13 + thick,
            6.13 + thick
        );
        case(METRES, &[&wall], 2)
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0211"))
    };
    assert!(warned(0.05) && !warned(1.0));
    let warned = |thick: f64| {
        let wall = format!("box = {{ lower = [2.13, 1], upper = [{}, 9] }}", 2.13 + thick);
        case(METRES, &[&wall], 2)
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0212"))
    };
    assert!(warned(0.45) && !warned(0.5));
}

#[test]
fn bodies_that_only_seem_to_overlap() {
    let warned = |a: &str, b: &str| {
        let warnings = try_case(METRES, &[a, b], 2).unwrap().warnings;
        warnings
            .iter()
            .any(|warning| warning.contains("body.0 and body.1 overlap"))
    };
    let triangle = "polygon = [[1, 1], [9, 1], [1, 9]]";
    assert!(!warned(triangle, "polygon = [[9, 1], [9, 9], [1, 9]]"));
    assert!(warned(triangle, "polygon = [[8.9, 1], [9, 9], [1, 9]]"));
    assert!(!warned(triangle, "box = { lower = [6, 6], upper = [9, 9] }"));
    assert!(warned(triangle, "box = { lower = [2, 2], upper = [3, 3] }"));
    let hole =
        "circle = { centre = [15, 10], radius = 5 }\nsubtract = [{ circle = { centre = [15, 10], radius = 3 } }]";
    assert!(!warned(hole, "circle = { centre = [15, 10], radius = 3 }"));
    assert!(warned(hole, "circle = { centre = [15, 10], radius = 3.01 }"));
}

#[test]
fn weight_above_a_place() {
    let bodies = [
        "box = { lower = [0, 1], upper = [4, 3] }",
        "box = { lower = [4, 1], upper = [8, 2] }",
        "polygon = [[0, 5], [4, 5], [4, 9]]",
        "box = { lower = [10, 2], upper = [20, 12] }\nsubtract = [{ circle = { centre = [15, 7], radius = 3 } }]",
    ];
    let case = case(METRES, &bodies, 2);
    let rows = [
        ([1.0, 1.0], 2.0 + 1.0),
        ([1.0, 2.5], 0.5 + 1.0),
        ([3.0, 3.5], 3.0),
        ([3.0, 7.5], 0.5),
        ([4.0, 1.0], 1.0),
        ([15.0, 3.0], 10.0 - 6.0 - 1.0),
        ([15.0, 7.0], 2.0),
        ([18.0, 0.0], 10.0),
        ([15.0, 12.0], 0.0),
        ([30.0, 1.0], 0.0),
    ];
    for ([x, y], length) in rows {
        let found = case.overburden([x, y, 0.0]);
        assert!((found - 20_000.0 * length).abs() < 1e-9, "{x} {y}: {found}");
    }
    assert_eq!(Case { gravity: None, ..case }.overburden([1.0, 1.0, 0.0]), 0.0);
}

#[test]
fn outlines_that_would_take_too_long_are_refused_soon() {
    let started = std::time::Instant::now();
    let comb: Vec<[f64; 2]> = (0..2000)
        .map(|k| {
            [
                if k % 4 == 1 || k % 4 == 2 { 39.0 } else { 1.0 },
                1.0 + 0.004 * (k / 2) as f64,
            ]
        })
        .chain([[0.5, 18.0], [0.5, 0.5]])
        .collect();
    let fine = "lower = [0, 0]\nupper = [40, 20]\ncell = 0.002";
    let errors = try_case(fine, &[&polygon(&comb)], 3).unwrap_err();
    assert!(
        errors.iter().any(|error| error.code.as_deref() == Some("E0036")),
        "{errors:?}"
    );
    assert!(try_case(METRES, &[&polygon(&comb)], 3).is_ok());
    let many: Vec<String> = vec!["{ circle = { centre = [1, 1], radius = 1 } }".to_owned(); 6000];
    let body = format!(
        "box = {{ lower = [1, 1], upper = [2, 2] }}\nsubtract = [{}]",
        many.join(", ")
    );
    let errors = try_case(METRES, &[&body], 3).unwrap_err();
    assert!(
        errors[0].message.contains("has 12004 edges, but at most 10000"),
        "{errors:?}"
    );
    let corners: Vec<[f64; 2]> = (0..20_000).map(|k| [f64::from(k), 0.0]).collect();
    assert!(
        try_case(METRES, &[&polygon(&corners)], 3).unwrap_err()[0]
            .message
            .contains("at most 10000")
    );
    assert!(started.elapsed().as_secs() < 20, "{:?}", started.elapsed());
}

#[test]
fn a_polygon_may_repeat_its_first_corner_at_its_end() {
    let of = |corners: &str| case(METRES, &[&format!("polygon = [{corners}]")], 2);
    let open = of("[1, 0], [9, 0], [4, 6]");
    let closed = of("[1, 0], [9, 0], [4, 6], [1, 0]");
    assert_eq!(open.bodies[0].area(), closed.bodies[0].area());
    assert_eq!(open.points(), closed.points());
}
