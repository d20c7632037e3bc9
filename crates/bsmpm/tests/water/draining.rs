//! Consolidation of bodies whose drained and loaded surfaces cut the cells, and move through them.

use super::{M, Plane, at, column, flowing, geometric, run, settlement};
use crate::support::scene::{axis, hencky};
use bsmpm::background::{Background, Extent, Kind};
use bsmpm::boundary::{Load, Support, SurfacePoint};
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;
use bsmpm::water::flow::{Course, Drain, Given, PermeabilityLaw};
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// Small enough for small strains.
const LOAD: f64 = 1e-5 * M;

#[test]
fn a_column_settles_alike_wherever_its_drained_surface_cuts_the_cells() {
    // Terzaghi (1923): U at the time factor .2.
    let mut errors = Vec::new();
    for cut in [0.05, 0.35, 0.65, 0.95] {
        let mut scene = column(20, cut, LOAD, PermeabilityLaw::Constant);
        let mut settled = 0.0;
        run(&mut scene, geometric(1e-4, 0.2, 200), |_, points, _| settled = settlement(points) * M / LOAD);
        errors.push(settled - 0.504088);
    }
    println!("errors of U {errors:.5?}");
    assert!(errors.iter().all(|error| error.abs() <= 0.002));
}

/// Height of the loaded surface, m: mean of its points.
fn height(points: &Points<2>) -> f64 {
    let places = &points.surface.position[0];
    places.iter().map(|x| x[1]).sum::<f64>() / places.len() as f64
}

#[test]
fn a_drained_surface_that_settles_through_rows_of_cells_stays_drained() {
    // Reference by lines (200 and 400 cells, extrapolated), Hencky's law, .5 M on top: settlement at these time factors.
    let times = [0.1, 0.2, 0.5, 1.0];
    let cases = [
        (PermeabilityLaw::Constant, [0.16429, 0.22932, 0.29163, 0.29649]),
        (PermeabilityLaw::KozenyCarman, [0.09887, 0.13970, 0.21296, 0.26489]),
    ];
    for (law, exact) in cases {
        let mut scene = column(20, 0.999, 0.5 * M, law).stabilised(Stabilisation::ConsistentFBar);
        let soft = Background { kind: Kind::Strain, coefficient: 1e-2, extent: Extent::Occupied };
        scene = scene.background(Some(soft));
        let mut steps = geometric(1e-4, 1.0, 120);
        steps.extend(times);
        steps.sort_by(f64::total_cmp);
        steps.dedup_by(|b, a| *b - *a < 1e-9);
        let (mut errors, mut iterations) = (Vec::new(), 0);
        run(&mut scene, steps, |t, points, report| {
            iterations += report.iterations;
            let water = report.water.as_ref().expect("water flows");
            assert_eq!(water.held, [3], "the drain has material near");
            if let Some(k) = times.iter().position(|time| *time == t) {
                errors.push((1.0 - height(points)) / exact[k] - 1.0);
            }
        });
        let out = scene.points.surface.crossed.out();
        let taken = 1.0 / 20.0 * (1.0 - height(&scene.points));
        println!("{law:?}: errors {errors:.4?}, {iterations} iterations, out {out:.5} of {taken:.5}");
        assert!(errors.iter().all(|error| error.abs() <= 0.02));
    }
}

/// A quarter of a circle about the origin, in pieces of at most a third of a cell, with its normals.
fn arc(radius: f64, cell: f64) -> (Vec<SurfacePoint<2>>, Vec<Vector<2>>) {
    let pieces = (radius * FRAC_PI_2 / cell * 3.0).ceil();
    let angle = |k: usize| (k as f64 + 0.5) * FRAC_PI_2 / pieces;
    let normals: Vec<Vector<2>> = (0..pieces as usize).map(|k| at(angle(k).cos(), angle(k).sin())).collect();
    let area = radius * FRAC_PI_2 / pieces;
    (normals.iter().map(|normal| SurfacePoint { x: normal * radius, area }).collect(), normals)
}

/// A quarter of a weightless body between two radii about the origin, which cut the cells, `cells` of them in 1 m; with
/// water that flows through it, drained as told.
fn quarter(cells: usize, [inner, outer]: [f64; 2], drains: Vec<Drain<2>>) -> Plane {
    let cell = 1.0 / cells as f64;
    let rows = (outer * cells as f64) as usize + 1;
    let mut scene = Plane::new([(); 2].map(|()| axis(cell, rows + 1, 2)), hencky(M, 0.0), Regime::QuasiStatic)
        .body([0..rows, 0..rows], 3, 1.0, |x| x * 0.0)
        .cut(|x| (inner..outer).contains(&x.norm()))
        .support(Support::roller(0, false))
        .support(Support::roller(1, false));
    let mut water = flowing(PermeabilityLaw::Constant);
    water.flow.as_mut().expect("it flows").drains = drains;
    scene.model.water = Some(water);
    scene.model.criteria.energy = 1e-12;
    scene.model.criteria.force = 1e-8;
    scene
}

/// De Leeuw's disc (1964), Poisson's ratio 0: centre pressed by a radial pressure on its drained rim.
struct Disc {
    roots: Vec<f64>, // of J0(x) = J1(x)/x
}

/// Bessel's function J_n.
fn bessel(n: i32, x: f64) -> f64 {
    let angles = (0..100).map(|k| (f64::from(k) + 0.5) * PI / 100.0);
    angles.map(|angle| (f64::from(n) * angle - x * angle.sin()).cos()).sum::<f64>() / 100.0
}

impl Disc {
    fn new() -> Self {
        let f = |x: f64| bessel(0, x) - bessel(1, x) / x;
        let root = |k: i32| {
            let (mut low, mut high) = (PI * f64::from(k) + 1.0, PI * f64::from(k) + 3.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
            }
            0.5 * (low + high)
        };
        Self { roots: (0..20).map(root).collect() }
    }

    /// Pressure over that on the rim at r/a, time factor T.
    fn pressure(&self, r: f64, T: f64) -> f64 {
        let term = |x: &f64| {
            let D = bessel(1, *x) * (1.0 / x.powi(2) - 1.0);
            2.0 * (bessel(0, *x) - bessel(0, x * r)) / (x * D) * (-x * x * T).exp()
        };
        self.roots.iter().map(term).sum()
    }
}

#[test]
fn a_disc_that_is_pressed_on_its_drained_rim_follows_its_closed_form() {
    let disc = Disc::new();
    for (T, middle) in [(0.05, 1.261192), (0.1, 1.221267), (0.2, 0.915338)] {
        assert!((disc.pressure(0.0, T) - middle).abs() < 2e-6, "the closed form itself");
    }
    for (cells, bounds) in [(10, [0.02; 3])] {
        let (points, normals) = arc(1.0, 1.0 / f64::from(cells));
        let drain = Drain { points: points.clone(), normals: normals.clone(), given: Given::StillWater };
        let traction = normals.iter().map(|normal| normal * -LOAD).collect();
        let load = Load { traction, ..Load::dead(points, at(0.0, 0.0), 0.0) };
        let mut scene = quarter(cells as usize, [0.0, 1.0], vec![drain]).load(load);
        let times = [0.05, 0.1, 0.2];
        let mut steps = geometric(1e-3, 0.2, 60);
        steps.extend(times);
        steps.sort_by(f64::total_cmp);
        steps.dedup_by(|b, a| *b - *a < 1e-9);
        let (mut errors, mut iterations) = (Vec::new(), 0);
        run(&mut scene, steps, |t, points, report| {
            iterations += report.iterations;
            if !times.contains(&t) {
                return;
            }
            let pressures = points.pore_pressure.as_ref().expect("water flows");
            let square = |p: usize| (pressures[p] / LOAD - disc.pressure(points.x[p].norm(), t)).powi(2);
            errors.push(((0..points.len()).map(square).sum::<f64>() / points.len() as f64).sqrt());
        });
        println!("{cells} cells: {errors:.4?}, {iterations} iterations");
        assert!(errors.iter().zip(bounds).all(|(error, bound)| *error <= bound));
    }
}

#[test]
fn water_flows_through_a_ring_between_its_drained_arcs() {
    // As in `verification::seepage`, through a skeleton that gives way, once it is steady.
    let head = |height: f64| Given::Pressure(Course(vec![(0.0, height * LOAD)]));
    let drain = |radius: f64, given: Given| {
        let (points, normals) = arc(radius, 1.0 / 8.0);
        Drain { points, normals, given }
    };
    let mut scene = quarter(8, [0.5, 2.0], vec![drain(0.5, head(1.0)), drain(2.0, head(0.0))]);
    let mut rates = [0.0; 2];
    run(&mut scene, geometric(1e-1, 1e3, 8), |_, _, report| {
        let water = report.water.as_ref().expect("water flows");
        let exact = FRAC_PI_2 / M * LOAD / (2.0 * LN_2) * report.dt;
        rates = [water.crossed.drains[0] / exact, water.crossed.drains[1] / exact];
    });
    println!("in and out over the closed form: {rates:.5?}");
    assert!((rates[0] + 1.0).abs() <= 0.01 && (rates[1] - 1.0).abs() <= 0.01);
}
