//! Tests material points of boxes.

use bsmpm::kinematics::PlaneStrain;
use bsmpm_scene::{Body, Case, Seed, seed};
use std::collections::HashSet;

/// A quasi-static case on `grid` with the bodies' `boxes` ([x0, y0, x1, y1]) and `n` points per cell.
fn case(grid: &str, boxes: &[[f64; 4]], n: usize) -> Case {
    let mut text = format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nsteps = 1\n[grid]\ndegree = \"linear\"\n{grid}\n\
         [material.m]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\ndensity = 2000\n[boundary]\nleft = \"fixed\"\nbottom = \"fixed\"\n"
    );
    for [x0, y0, x1, y1] in boxes {
        text += &format!(
            "[[body]]\nmaterial = \"m\"\npoints_per_cell = {n}\nbox = {{ lower = [{x0:?}, {y0:?}], upper = [{x1:?}, {y1:?}] }}\n"
        );
    }
    Case::from_text("case.toml", &text, &[]).unwrap_or_else(|errors| panic!("{text}\n{errors:#?}"))
}

/// Everything that must hold of any case's points.
fn verify(case: &Case) -> Vec<Seed<2>> {
    let columns = case.grid.axes[0].cells();
    let seeds: Vec<Seed<2>> = seed::<PlaneStrain, 2>(case, 0..columns).collect();
    assert_eq!(seeds.len() as u64, case.points());
    let mut ids: Vec<u64> = seeds.iter().map(|seed| seed.id).collect();
    assert_eq!(ids.iter().collect::<HashSet<_>>().len(), seeds.len());
    ids.sort_unstable();
    assert!(
        ids.iter().enumerate().all(|(i, id)| i as u64 == *id),
        "ids count from 0 without gaps"
    );
    let area: f64 = case.bodies.iter().map(Body::area).sum();
    let sum: f64 = seeds.iter().map(|seed| seed.volume).sum();
    assert!((sum / area - 1.0).abs() < 1e-12, "{sum} {area}");
    let lower = case.grid.lower();
    for seed in &seeds {
        let x = [seed.x[0] + lower[0], seed.x[1] + lower[1]];
        let inside = case
            .bodies
            .iter()
            .map(Body::bounds)
            .any(|[low, high]| (0..2).all(|i| low[i] < x[i] && x[i] < high[i]));
        assert!(
            inside && seed.volume > 0.0 && (seed.mass / seed.volume / 2000.0 - 1.0).abs() < 1e-14,
            "{seed:?}"
        );
    }
    let mut parts: Vec<Seed<2>> = (0..columns)
        .flat_map(|column| seed::<PlaneStrain, 2>(case, column..column + 1))
        .collect();
    parts.sort_by_key(|seed| seed.id);
    let mut whole = seeds.clone();
    whole.sort_by_key(|seed| seed.id);
    assert_eq!(whole, parts, "columns one by one give the same points");
    seeds
}

#[test]
fn whole_cells() {
    let seeds = verify(&case(
        "lower = [0, 0]\nupper = [2, 2]\ncell = 1",
        &[[0.0, 0.0, 1.0, 2.0]],
        2,
    ));
    let expected = [[0.25, 0.25], [0.25, 0.75], [0.75, 0.25], [0.75, 0.75], [0.25, 1.25]];
    for (seed, x) in seeds.iter().zip(expected) {
        assert_eq!([seed.x[0], seed.x[1]], x);
        assert_eq!(seed.volume, 0.25);
    }
}

#[test]
fn cut_cells_and_an_origin_elsewhere() {
    let grid = "lower = [-3, 10]\nupper = [7, 15]\ncell = [0.3, 0.7]";
    verify(&case(grid, &[[-2.95, 10.01, 1.234, 11.9], [2.0, 10.0, 6.99, 14.5]], 3));
}

#[test]
fn graded_cells() {
    let grid = "knots.x = [0, 0.1, 0.25, 0.5, 1, 2]\nknots.y = [-1, -0.2, 0, 3]";
    verify(&case(grid, &[[0.05, -0.5, 1.7, 2.0], [1.8, -1.0, 2.0, 3.0]], 4));
}

#[test]
fn slivers_make_no_points_and_lose_no_area() {
    for off in [0.0, 1e-16, 1e-12, -1e-12, 9e-10, -9e-10] {
        let case = case(
            "lower = [0, 0]\nupper = [4, 2]\ncell = 1",
            &[[1.0 + off, 0.0, 3.0 - off, 1.0 + off]],
            2,
        );
        assert_eq!(case.points(), 2 * 4, "{off:e}");
        verify(&case);
    }
    for off in [1e-8, 1e-3] {
        let case = case(
            "lower = [0, 0]\nupper = [4, 2]\ncell = 1",
            &[[1.0 - off, 0.0, 3.0, 1.0]],
            2,
        );
        assert_eq!(case.points(), 3 * 4, "{off:e}");
        verify(&case);
    }
}

#[test]
fn breakpoints_that_round() {
    for n in 1..60_u32 {
        let cell = 1.0 / f64::from(n) / 3.0;
        let grid = format!("lower = [0, 0]\nupper = [1, 1]\ncell = {cell:?}");
        let case = case(&grid, &[[0.0, 0.0, 1.0 / 3.0, 2.0 / 3.0]], 1);
        assert_eq!(case.points(), u64::from(2 * n * n), "n = {n}");
        verify(&case);
    }
}

#[test]
fn a_column_range_without_bodies_is_empty() {
    let case = case("lower = [0, 0]\nupper = [4, 1]\ncell = 1", &[[0.0, 0.0, 1.0, 1.0]], 2);
    assert_eq!(seed::<PlaneStrain, 2>(&case, 2..4).count(), 0);
    assert_eq!(seed::<PlaneStrain, 2>(&case, 0..0).count(), 0);
}

/// Four bodies in a cell have as many points in it as one with two along each axis.
#[test]
fn one_point_per_cell_is_warned_of_once_and_only_where_points_lie_far_apart() {
    let boxes = |edge: f64| -> Vec<[f64; 4]> {
        let place = |k: usize| [k % 16, k / 16].map(|i| i as f64 * edge);
        (0..256).map(place).map(|[x, y]| [x, y, x + edge, y + edge]).collect()
    };
    let warnings = |edge: f64| case("lower = [0, 0]\nupper = [16, 16]\ncell = 1", &boxes(edge), 1).warnings;
    let warned = |edge: f64| -> Vec<String> {
        warnings(edge)
            .into_iter()
            .filter(|warning| warning.starts_with("W0210"))
            .collect()
    };
    assert_eq!(warned(0.5), [""; 0]);
    let found = warned(1.0);
    assert!(
        found.len() == 1 && found[0].starts_with("W0210: body.0 and 255 others: "),
        "{found:?}"
    );
    let cut = case(
        "lower = [0, 0]\nupper = [2, 2]\ncell = 1",
        &[[0.0, 0.0, 0.5, 0.75], [0.5, 0.0, 1.0, 0.5]],
        1,
    );
    let found: Vec<_> = cut
        .warnings
        .iter()
        .filter(|warning| warning.starts_with("W0210"))
        .collect();
    assert!(found.len() == 1 && found[0].starts_with("W0210: body.0: "), "{found:?}");
}

/// A warning of many bodies is one line with their number, the worst of them named.
#[test]
fn warnings_that_repeat_for_every_body_are_one_line() {
    let boxes: Vec<[f64; 4]> = (0..8).map(|k| [0.0, f64::from(k), 4.0, f64::from(k) + 0.1]).collect();
    let warnings = case("lower = [0, 0]\nupper = [8, 8]\ncell = 1", &boxes, 2).warnings;
    let thin: Vec<_> = warnings.iter().filter(|warning| warning.starts_with("W0212")).collect();
    assert!(
        thin.len() == 1 && thin[0].starts_with("W0212: body.0 and 7 others: the body is only 0.10 cells thick along y"),
        "{thin:?}"
    );
}
