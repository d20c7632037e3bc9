//! Tests that bodies of polygons, circles and cut-outs are filled with the right points.

mod cuts;
mod polygons;
mod symmetry;

use bsmpm::kinematics::PlaneStrain;
use bsmpm_scene::{Body, Case, Error, Seed, seed};
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
