//! Tests polygons, circles and cut-outs.

use bsmpm::kinematics::{PlaneStrain, Solid};
use bsmpm_scene::{Body, Case, Error, Region, Seed, seed};
use std::collections::HashSet;

/// A case on `grid` with `bodies`, the keys of a body each, and `n` points per cell.
fn try_case(grid: &str, bodies: &[&str], n: usize) -> Result<Case, Vec<Error>> {
    let mut text = format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"dynamic\"\nend = 1\ndt = 1\n[grid]\ndegree = \
         \"linear\"\n{grid}\n\
         [material.m]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\ndensity = 2000\n[gravity]\nacceleration = [0, \
         -10]\n"
    );
    for body in bodies {
        text += &format!("[[body]]\nmaterial = \"m\"\npoints_per_cell = {n}\n{body}\n");
    }
    Case::from_text("case.toml", &text, &[])
}

fn case(grid: &str, bodies: &[&str], n: usize) -> Case {
    try_case(grid, bodies, n).unwrap_or_else(|errors| panic!("{bodies:?}\n{errors:#?}"))
}

const METRES: &str = "lower = [0, 0]\nupper = [40, 20]\ncell = 1";
const ELSEWHERE: &str = "lower = [-3, 10]\nupper = [37, 31]\ncell = [0.3125, 0.7]";
const GRADED: &str = "knots.x = [0, 0.1, 0.25, 0.5, 1, 2, 5, 9, 9.5, 40]\nknots.y = [0, 0.5, 0.9, 3, 7, 7.1, 20]";

/// Everything that must hold of any case's points; the seeds, with positions in the case's coordinates.
fn verify(case: &Case, tolerance: f64) -> Vec<Seed<2>> {
    let columns = case.grid.axes[0].cells();
    let mut seeds: Vec<Seed<2>> = seed::<PlaneStrain, 2>(case, 0..columns).collect();
    assert_eq!(seeds.len() as u64, case.points());
    assert_eq!(case.points_by_column().iter().sum::<u64>(), case.points());
    let ids: HashSet<u64> = seeds.iter().map(|seed| seed.id).collect();
    assert!(
        ids.len() == seeds.len() && ids.iter().all(|id| *id < case.points()),
        "ids count from 0 without gaps"
    );
    let area: f64 = case.bodies.iter().map(Body::area).sum();
    let sum: f64 = seeds.iter().map(|seed| seed.volume).sum();
    assert!((sum / area - 1.0).abs() < tolerance, "{sum} {area}");
    let mut parts = Vec::new();
    for (column, count) in case.points_by_column().into_iter().enumerate() {
        let part: Vec<Seed<2>> = seed::<PlaneStrain, 2>(case, column..column + 1).collect();
        assert_eq!(part.len() as u64, count, "column {column}");
        let ends = [column, column + 1].map(|at| case.grid.axes[0].breakpoint(at));
        let out = part.iter().find(|seed| !(ends[0] <= seed.x[0] && seed.x[0] <= ends[1]));
        assert!(out.is_none(), "column {column} has {out:?}");
        parts.extend(part);
    }
    parts.sort_by_key(|seed| seed.id);
    seeds.sort_by_key(|seed| seed.id);
    assert_eq!(seeds, parts, "columns one by one give the same points");
    for seed in &mut seeds {
        assert!(
            seed.volume > 0.0 && (seed.mass / seed.volume / 2000.0 - 1.0).abs() < 1e-14,
            "{seed:?}"
        );
        seed.x += bsmpm_scene::model::vector::<2, _>(case.grid.lower());
    }
    seeds
}

/// Whether `at` lies inside a polygon: the angles under which its edges are seen add up to a whole turn.
fn winds(corners: &[[f64; 2]], at: [f64; 2]) -> bool {
    let seen = |k: usize| {
        let corner = corners[k % corners.len()];
        [corner[0] - at[0], corner[1] - at[1]]
    };
    let angle = |k: usize| {
        let p = seen(k);
        let q = seen(k + 1);
        (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1])
    };
    (0..corners.len()).map(angle).sum::<f64>().abs() > 1.0
}

fn shoelace(corners: &[[f64; 2]]) -> f64 {
    let term = |k: usize| {
        let from = |k: usize| [0, 1].map(|axis| corners[k % corners.len()][axis] - corners[0][axis]);
        let p = from(k);
        let q = from(k + 1);
        p[0] * q[1] - q[0] * p[1]
    };
    0.5 * (0..corners.len()).map(term).sum::<f64>().abs()
}

fn polygon(corners: &[[f64; 2]]) -> String {
    format!("polygon = {corners:?}")
}

/// Numbers in [0, 1), always the same ones.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A polygon that is seen whole from its middle: simple, and mostly not convex.
fn star(random: &mut Random, middle: [f64; 2], size: f64) -> Vec<[f64; 2]> {
    let n = 3 + (random.next() * 10.0) as usize;
    let mut corners: Vec<[f64; 2]> = (0..n)
        .map(|k| {
            let angle = std::f64::consts::TAU * (k as f64 + 0.8 * random.next()) / n as f64;
            let radius = size * (0.1 + 0.9 * random.next());
            [middle[0] + radius * angle.cos(), middle[1] + radius * angle.sin()]
        })
        .collect();
    if random.next() < 0.5 {
        corners.reverse();
    }
    corners
}

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

#[test]
fn a_polygon_may_repeat_its_first_corner_at_its_end() {
    let of = |corners: &str| case(METRES, &[&format!("polygon = [{corners}]")], 2);
    let open = of("[1, 0], [9, 0], [4, 6]");
    let closed = of("[1, 0], [9, 0], [4, 6], [1, 0]");
    assert_eq!(open.bodies[0].area(), closed.bodies[0].area());
    assert_eq!(open.points(), closed.points());
}
