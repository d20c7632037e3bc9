//! Tests that circles and cut-outs have the right points.

use super::{METRES, Random, case, polygon, shoelace, star, try_case, verify, winds};

#[test]
fn a_ball_on_the_axis_is_what_a_box_leaves_of_a_circle() {
    let circle = "circle = { centre = [0, 9], radius = 4 }";
    let half = format!("{circle}\nsubtract = [{{ box = {{ lower = [-5, 0], upper = [0, 20] }} }}]");
    let case = case(METRES, &[&half], 3);
    assert!((case.bodies[0].area() / (8.0 * std::f64::consts::PI) - 1.0).abs() < 1e-13);
    verify(&case, 1e-12);
    let error = &try_case(METRES, &[circle], 3).unwrap_err()[0].message;
    assert!(error.contains("x = -4 m is outside the grid"), "{error}");
}

#[test]
fn circles_and_rings() {
    let pi = std::f64::consts::PI;
    for (n, center, radius) in [
        (1, [10.0, 9.0], 4.0),
        (3, [10.3, 9.7], 0.3),
        (4, [5.123, 4.567], 4.5),
        (2, [5.0, 5.0], 5.0),
        (2, [6.0, 6.0], 2.4),
    ] {
        let circle = format!("circle = {{ center = {center:?}, radius = {radius:?} }}");
        let case = case(METRES, &[&circle], n);
        assert!((case.bodies[0].area() / (pi * radius * radius) - 1.0).abs() < 1e-14);
        for seed in verify(&case, 1e-12) {
            assert!(
                (seed.x[0] - center[0]).hypot(seed.x[1] - center[1]) < radius,
                "{seed:?}"
            );
        }
    }
    let ring =
        "circle = { centre = [20, 10], radius = 6 }\nsubtract = [{ circle = { centre = [20, 10], radius = 2.5 } }]";
    let case = case(METRES, &[ring], 3);
    assert!((case.bodies[0].area() / (pi * (36.0 - 6.25)) - 1.0).abs() < 1e-12);
    assert!(
        verify(&case, 1e-12)
            .iter()
            .all(|s| (2.5..6.0).contains(&(s.x[0] - 20.0).hypot(s.x[1] - 10.0)))
    );
}

#[test]
fn what_is_cut_out_is_gone_once() {
    // Two cuts overlap each other, one reaches beyond the body, one shares its side, one misses it.
    let body = "box = { lower = [2, 2], upper = [12, 12] }\nsubtract = [\n\
        { box = { lower = [3, 3], upper = [6, 6] } }, { polygon = [[5, 5], [8, 5], [8, 8], [5, 8]] },\n\
        { box = { lower = [11, 2.5], upper = [15, 4.25] } }, { polygon = [[2, 9], [4.5, 9], [2, 12]] },\n\
        { circle = { centre = [30, 10], radius = 5 } } ]";
    let case = case(METRES, &[body], 4);
    let expected = 100.0 - (9.0 + 9.0 - 1.0) - 1.75 - 0.5 * 2.5 * 3.0;
    assert!(
        (case.bodies[0].area() / expected - 1.0).abs() < 1e-13,
        "{}",
        case.bodies[0].area()
    );
    for seed in verify(&case, 1e-12) {
        let [x, y] = [seed.x[0], seed.x[1]];
        let within = |a: f64, b: f64, c: f64, d: f64| a < x && x < c && b < y && y < d;
        assert!(within(2.0, 2.0, 12.0, 12.0) && !within(3.0, 3.0, 6.0, 6.0) && !within(5.0, 5.0, 8.0, 8.0));
        assert!(!within(11.0, 2.5, 12.0, 4.25) && (y < 9.0 || (x - 2.0) / 2.5 + (y - 9.0) / 3.0 > 1.0));
    }
}

#[test]
fn random_cuts_against_counted_places() {
    let mut random = Random(4);
    for round in 0..20 {
        let whole = star(&mut random, [20.0, 10.0], 9.0);
        let cut = star(&mut random, [22.0, 11.0], 6.0);
        let body = format!("{}\nsubtract = [{{ {} }}]", polygon(&whole), polygon(&cut));
        let case = case(METRES, &[&body], 3);
        let n = 400;
        let place = |k: usize| (k as f64 + 0.5) / 20.0;
        let places = (0..2 * n).flat_map(|i| (0..n).map(move |j| [place(i), place(j)]));
        let count = places.filter(|at| winds(&whole, *at) && !winds(&cut, *at)).count() as f64 / 400.0;
        let area = case.bodies[0].area();
        assert!(
            (area - count).abs() < 0.01 * shoelace(&whole) + 0.05,
            "round {round}: {area} {count}"
        );
        let seeds = verify(&case, 1e-11);
        assert!(
            seeds
                .iter()
                .all(|s| winds(&whole, s.x.into()) && !winds(&cut, s.x.into()))
        );
    }
}

#[test]
fn a_cell_without_a_place_inside_has_one_point() {
    // A needle through the row between the lattice's places, and a sliver.
    let seeds = verify(&case(METRES, &["polygon = [[1, 1.4], [9, 1.5], [1, 1.45]]"], 2), 1e-12);
    assert_eq!(seeds.len(), 8);
    let sliver = try_case(METRES, &["polygon = [[1, 1.4], [1.5, 1.4], [1.2, 1.400000001]]"], 2).unwrap_err();
    assert!(sliver[0].message.contains("no material points"), "{sliver:?}");
    let gone = "box = { lower = [1, 1], upper = [2, 2] }\nsubtract = [{ box = { lower = [0, 0], upper = [3, 3] } }]";
    assert!(
        try_case(METRES, &[gone], 2).unwrap_err()[0]
            .message
            .contains("no material points")
    );
}

#[test]
fn the_one_point_of_a_cap_is_its_centroid() {
    // What a circle has above y = 12 where no place of the lattice is: chord 2 m, height 0.2 m.
    let radius: f64 = (1.0 + 0.2 * 0.2) / (2.0 * 0.2);
    let circle = format!(
        "circle = {{ centre = [12.5, {:?}], radius = {radius:?} }}",
        12.2 - radius
    );
    let grid = "lower = [0, 0]\nupper = [40, 20]\ncell = [5.0, 4.0]";
    let seeds = verify(&case(grid, &[&circle], 1), 1e-12);
    let caps: Vec<_> = seeds.iter().filter(|seed| seed.x[1] > 12.0).collect();
    let angle = 2.0 * (1.0 / radius).asin();
    let area = 0.5 * radius * radius * (angle - angle.sin());
    let centroid = 12.2 - radius + 8.0 / (12.0 * area);
    assert_eq!(caps.len(), 1);
    assert!((caps[0].x[0] - 12.5).abs() < 1e-9, "{:?}", caps[0]);
    assert!(
        (caps[0].x[1] - centroid).abs() < 1e-9 && (caps[0].volume / area - 1.0).abs() < 1e-9,
        "{:?}",
        caps[0]
    );
}
