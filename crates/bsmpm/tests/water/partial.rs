//! Tests of unsaturated soils: columns against the equation of Richards (1931), run-off of rain, and a dam with a
//! seepage face.

use super::{Plane, WEIGHT, at, run, through};
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::{Support, SurfacePoint};
use bsmpm::energy::{EnergyAccounts, StoredEnergy};
use bsmpm::field::pore_water::ambient::Ambient;
use bsmpm::field::pore_water::flow::{
    Course, Drain, DrainedFace, Flow, Given, Inflow, Permeability, PermeabilityLaw, Soil,
};
use bsmpm::field::pore_water::retention::Retention;
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::tensor::Vector;

/// m/s
const K: f64 = 1e-5;
/// Pa
const RIGID: f64 = 1e10;
const POROSITY: f64 = 0.4;
fn loam() -> Retention {
    Retention::van_genuchten(2.0, 2.0, 0.1)
}

/// A body of the cells h of these numbers in a grid of one column more to the right and one row more on top.
fn ground([columns, rows]: [usize; 2], h: f64, retention: Retention) -> Plane {
    let axes = [axis(h, columns + 1, 2), axis(h, rows + 1, 2)];
    let mut scene: Plane = Scene::new(axes, hencky(RIGID, 0.0), Regime::QuasiStatic);
    scene = scene
        .body([0..columns, 0..rows], 3, 2000.0, |x| x * 0.0)
        .gravity(10.0, 0.0);
    scene = scene
        .support(Support::roller(0, false))
        .support(Support::roller(1, false));
    let permeability = Some(Permeability {
        along: at(K, K),
        law: PermeabilityLaw::Constant,
    });
    let soil = Soil {
        porosity: POROSITY,
        permeability,
        retention: Some(retention),
    };
    scene.model.water = Some(through(soil));
    scene.model.criteria.energy = 1e-10;
    scene.model.criteria.force = 1e-6;
    scene
}

fn flow(scene: &mut Plane) -> &mut Flow<2> {
    scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("water flows")
}

/// Three points a cell of the length h of an edge of so many cells, from a corner on along a direction.
fn edge(corner: Vector<2>, along: Vector<2>, cells: usize, h: f64) -> Vec<SurfacePoint<2>> {
    let area = h / 3.0;
    (0..3 * cells)
        .map(|k| SurfacePoint::at(corner + along * ((k as f64 + 0.5) * area), area))
        .collect()
}

/// Kg of all points.
fn mass(points: &Points<2>) -> f64 {
    points.mass.iter().sum()
}

/// Suction heads, m, of steady flow `q` (m/s, upwards) above a table at height 0, by the classical Runge-Kutta method
/// to the heights asked for in rising order.
fn richards(soil: &Retention, q: f64, heights: &[f64]) -> Vec<f64> {
    // q = -K k_r (psi' + 1)
    let slope = |psi: f64| -q / (K * soil.under(psi * WEIGHT, WEIGHT).permeability) - 1.0;
    let mut y = 0.0;
    let mut psi = 0.0;
    let to = |height: &f64| {
        let parts = 200;
        let step = (height - y) / f64::from(parts);
        for _ in 0..parts {
            let a = slope(psi);
            let b = slope(psi + step / 2.0 * a);
            let c = slope(psi + step / 2.0 * b);
            psi += step / 6.0 * (a + 2.0 * b + 2.0 * c + slope(psi + step * c));
        }
        y = *height;
        psi
    };
    heights.iter().map(to).collect()
}

/// A column of 1 m above the water table, so many cells high, into the top of which `rate` (m/s) is put.
fn column(cells: usize, rate: f64, runs_off: bool) -> Plane {
    let h = 1.0 / cells as f64;
    let mut scene = ground([1, cells], h, loam());
    let points = edge(at(0.0, 1.0), at(1.0, 0.0), 1, h);
    let normals = vec![at(0.0, 1.0); points.len()];
    let flow = flow(&mut scene);
    flow.faces.push(DrainedFace {
        axis: 1,
        upper: false,
        given: Given::Pressure(Course(vec![(0.0, 0.0)])),
        acts: true,
    });
    flow.inflows.push(Inflow {
        points,
        normals,
        rate: Course(vec![(0.0, rate)]),
        runs_off,
        acts: true,
    });
    // Hydrostatic suction to begin with.
    scene.points.pore_pressure = Some(scene.points.x.iter().map(|x| -WEIGHT * x[1]).collect());
    scene
}

/// Times that double from a start on.
fn doubling(first: f64, count: i32) -> Vec<f64> {
    (0..count).map(|k| first * 2.0_f64.powi(k)).collect()
}

/// Largest error of the pore pressure of the points, m of water, over the heights above the table at steady flow.
fn off(points: &Points<2>, q: f64) -> f64 {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points.x[a][1].total_cmp(&points.x[b][1]));
    let heights: Vec<f64> = order.iter().map(|&p| points.x[p][1]).collect();
    let found = points.pore_pressure.as_ref().expect("water flows");
    let exact = richards(&loam(), q, &heights);
    order
        .iter()
        .zip(&exact)
        .map(|(&p, psi)| (found[p] / WEIGHT - psi).abs())
        .fold(0.0, f64::max)
}

/// Richards (1931): steady infiltration and evaporation of a column.
#[test]
fn steady_columns_follow_the_equation_of_richards() {
    // Rain of half of what the saturated ground lets through, evaporation, rest; bounds: 1.3 times what was measured.
    for (rate, bounds) in [
        (0.5 * K, [1.5e-3, 3.9e-4]),
        (-0.002 * K, [7.6e-4, 2.2e-4]),
        (0.0, [2e-7, 5e-8]),
    ] {
        for (cells, bound) in [10, 20].into_iter().zip(bounds) {
            let mut scene = column(cells, rate, false);
            let start = mass(&scene.points);
            let mut out = 0.0;
            let mut left = 0.0_f64;
            let mut iterations = 0;
            run(&mut scene, doubling(100.0, 16), |_, _, report| {
                let water = report.water.as_ref().expect("water flows");
                out += water.crossed.out();
                left = left.max((water.stored + water.crossed.out() - water.left).abs());
                iterations += report.iterations;
            });
            let gained = (mass(&scene.points) - start) / (WEIGHT / 10.0);
            let error = off(&scene.points, -rate);
            println!(
                "{cells} cells, {rate:e} m/s: psi off by {error:.2e} m, {iterations} iterations, balance {left:.1e}"
            );
            assert!(
                error < bound && left < 1e-14 * POROSITY,
                "the steady state, and what came in and went out"
            );
            assert!(
                (gained + out).abs() < 1e-4 * gained.abs() + 1e-12,
                "{gained:e} of {:e}",
                -out
            );
        }
    }
}

/// Rain gives up the work of its fall to seepage and what suction had put into the pores, and nothing is left over.
#[test]
fn the_books_of_rain_close_with_what_suction_stores() {
    // Beside a water table the unknown is the excess over it, and the work of lifting water is that of the weight; one
    // that rises fills pores from below.
    let stays = vec![(0.0, 0.0)];
    let rises = vec![(0.0, 0.0), (10e3, 0.6)];
    let courses = [
        (50.0, None, 0.5),
        (25.0, None, 0.5),
        (25.0, Some(stays), 0.5),
        (50.0, Some(rises.clone()), 0.0),
    ];
    let lost = courses.into_iter().chain([(25.0, Some(rises), 0.0)]).map(|(dt, table, rain)| {
        let mut scene = column(10, rain * K, false);
        let reported = format!("{dt} s, {table:?}");
        if let Some(rows) = table {
            scene.model.water.as_mut().expect("there is water").ambient = Ambient::Level(rows);
            scene.points.pore_pressure = Some(vec![0.0; scene.points.len()]);
            flow(&mut scene).faces[0].given = Given::StillWater;
        }
        scene.model.balances_energy = true;
        let model = scene.model.clone(); let halo = scene.halo();
        let stored = |points: &Points<2>, t: f64| StoredEnergy::of(&model, points, t, &halo);
        let start = stored(&scene.points, 0.0); let mut now = StoredEnergy::default();
        let mut books = EnergyAccounts::open(start);
        run(&mut scene, (1..).map(|k| dt * f64::from(k)).take_while(|t| *t <= 20e3), |t, points, report| {
            books.flows += report.energy.expect("books are kept");
            now = stored(points, t);
        });
        let given = start.elastic - now.elastic;
        let spent = books.flows.plastic / given; let lost = books.flows.numerical() / given;
        let put_in = books.flows.external / given; let left = books.residual(now) / given;
        println!("{reported}: of {given:.4} J from pores, {put_in:.4} put in: seepage {spent:.4}, lost {lost:.4}, left {left:.1e}");
        assert!(given > 0.0 && spent > 0.0 && left.abs() < 1e-6);
        lost
    });
    let lost: Vec<f64> = lost.collect();
    assert!(lost.iter().all(|lost| lost.abs() < 0.01), "{lost:?}");
    assert!((lost[1] / lost[0]).abs() < 0.6, "of first order in the step: {lost:?}");
}

/// Closed form: in the end the ground takes rain at the rate of its saturated permeability.
#[test]
fn rain_that_the_ground_does_not_take_runs_off() {
    let mut scene = column(10, 3.0 * K, true);
    let mut taken = Vec::new();
    run(&mut scene, doubling(100.0, 14), |_, points, report| {
        taken.push(report.water.as_ref().expect("water flows").crossed.inflows[0] / (report.dt * 0.1 * K));
        let top = points
            .pore_pressure
            .iter()
            .flatten()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        assert!(top < 0.01 * WEIGHT, "no more than a film of water stands on the ground");
    });
    println!("taken over K: {taken:.4?}");
    // All of it at first; in the end what a saturated column lets through under its own weight.
    assert!((taken[0] - 3.0).abs() < 1e-9 && (taken[13] - 1.0).abs() < 0.003);
    assert!(taken.windows(2).all(|pair| pair[1] <= pair[0] + 1e-5));
}

#[test]
fn a_front_of_rain_goes_down_without_oscillations() {
    let dry = -20.0 * WEIGHT;
    let mut scene = column(20, 0.5 * K, false);
    scene.points.pore_pressure = Some(scene.points.x.iter().map(|_| dry).collect());
    flow(&mut scene).faces.clear();
    let start = mass(&scene.points);
    let mut iterations = 0;
    let mut worst = [0.0_f64; 2];
    run(
        &mut scene,
        (1..=60).map(|k| 400.0 * f64::from(k)),
        |t, points, report| {
            iterations += report.iterations;
            let pressures = points.pore_pressure.as_ref().expect("water flows");
            let rows: std::collections::BTreeMap<u64, f64> = points
                .x
                .iter()
                .zip(pressures)
                .map(|(x, p)| ((x[1] * 1e6) as u64, *p))
                .collect();
            let rows: Vec<f64> = rows.into_values().collect();
            let falls = rows.windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max);
            let least = rows.iter().copied().fold(0.0, f64::min);
            let gained = (mass(points) - start) / (WEIGHT / 10.0);
            worst = [worst[0].max(falls / WEIGHT), worst[1].max(least / dry - 1.0)];
            assert!(
                (gained / (0.05 * 0.5 * K * t) - 1.0).abs() < 2e-4,
                "all of the rain is in the ground"
            );
        },
    );
    println!(
        "{iterations} iterations in 60 steps, falls {:.3} m, beyond the start {:.1e}",
        worst[0], worst[1]
    );
    // A front of one cell between heads of 20 m and 0.1 m: ripples of two thousandths before it. Bounds: 1.3 times
    // them.
    assert!(worst[0] < 0.1 && worst[1] < 3.0e-3);
}

/// Bishop (1959): effective stress in unsaturated soil.
#[test]
fn suction_presses_the_skeleton_as_bishop_says() {
    // A column free on two sides, without weight and without flow: E ln J = 2 J chi p, and the water that it holds
    // stays.
    let young = 1e6;
    let start = -0.8 * WEIGHT;
    let mut scene = column(4, 0.0, false);
    scene.model.materials = vec![hencky(young, 0.0).into()];
    scene.model.gravity = None;
    scene.points.pore_pressure = Some(scene.points.x.iter().map(|_| start).collect());
    let flow = flow(&mut scene);
    (flow.faces, flow.inflows) = (Vec::new(), Vec::new());
    run(&mut scene, [1.0], |_, _, report| {
        println!("{} iterations", report.iterations)
    });
    let held = |J: f64, p: f64| (J - 1.0 + POROSITY) * loam().under(p, WEIGHT).saturation;
    let mut low = start;
    let mut high = 0.0;
    let of = |p: f64| {
        // J by the fixed point of that, which contracts.
        (0..60).fold(1.0, |J: f64, _| {
            (2.0 * J * loam().under(p, WEIGHT).effective * p / young).exp()
        })
    };
    for _ in 0..80 {
        let p = 0.5 * (low + high);
        if held(of(p), p) < held(1.0, start) {
            low = p
        } else {
            high = p
        }
    }
    let J = of(low);
    let p = low;
    let mut worst = 0.0_f64;
    for (point, found) in scene
        .points
        .pore_pressure
        .as_ref()
        .expect("water flows")
        .iter()
        .enumerate()
    {
        let found = found / p;
        let F = scene.points.F.at(point).determinant();
        worst = worst.max((found - 1.0).abs()).max(((F - 1.0) / (J - 1.0) - 1.0).abs());
        assert!(worst < 1e-6, "{found} {F} {J}");
    }
    println!("J {J}, p {p} from {start}, off by {worst:.1e}");
}

/// m  the integral of k_r over the suction head from so dry as makes no difference to `psi`, m.
fn conducted(soil: &Retention, psi: f64) -> f64 {
    let parts = 4000;
    let lowest = -3.0;
    let step = (psi.min(0.0) - lowest) / f64::from(parts);
    let k = |i: i32| {
        soil.under((lowest + (f64::from(i) + 0.5) * step) * WEIGHT, WEIGHT)
            .permeability
    };
    (0..parts).map(k).sum::<f64>() * step + psi.max(0.0)
}

/// Charny (1951): the discharge of a rectangular dam is that of Dupuit.
#[test]
fn a_dam_lets_through_what_dupuit_says() {
    // m
    let h1 = 1.0;
    let h2 = 0.25;
    let length = 0.75;
    let soil = Retention::van_genuchten(15.0, 3.0, 0.05);
    let dupuit = (h1 * h1 - h2 * h2) / (2.0 * length);
    for (cells, bound) in [(8, 0.01), (16, 0.005)] {
        let h = h1 / cells as f64;
        let columns = (length / h).round() as usize;
        let mut scene = ground([columns, cells], h, soil.clone());
        let below = cells / 4;
        let drain = |x: f64, y: f64, cells: usize, given: Given| {
            let points = edge(at(x, y), at(0.0, 1.0), cells, h);
            Drain {
                normals: vec![at(1.0, 0.0); points.len()],
                points,
                given,
                acts: true,
            }
        };
        let head = |height: f64| Given::Head(Course(vec![(0.0, height)]));
        flow(&mut scene).drains = vec![
            drain(0.0, 0.0, cells, head(h1)),
            drain(length, 0.0, below, head(h2)),
            drain(length, h2, cells - below, Given::Seepage),
        ];
        scene.points.pore_pressure = Some(scene.points.x.iter().map(|x| WEIGHT * (h2 - x[1])).collect());
        let mut out = Vec::new();
        let mut most = 0;
        run(&mut scene, doubling(100.0, 14), |_, _, report| {
            let water = report.water.as_ref().expect("water flows");
            assert!(water.crossed.drains[2] >= 0.0, "water only comes out of a seepage face");
            out = water.crossed.drains.iter().map(|out| out / report.dt / K).collect();
            most = most.max(report.iterations);
        });
        // Charny's proof (1951), with the flow above the phreatic line: d/dx of the integral over the height of what
        // is conducted up to the pressure there is -Q/K. At the exit from the points next to it.
        let points = &scene.points;
        let pressures = points.pore_pressure.as_ref().unwrap();
        let gradients = points.pressure_gradient.as_ref().unwrap();
        let last = |p: &usize| points.x[*p][0] > length - h / 3.0;
        let at_exit = |p: usize| pressures[p] + gradients[p][0] * (length - points.x[p][0]);
        let exit: f64 = (0..points.len())
            .filter(last)
            .map(|p| h / 3.0 * conducted(&soil, at_exit(p) / WEIGHT))
            .sum();
        let entry = h1 * h1 / 2.0 + conducted(&soil, 0.0) * h1;
        let exact = (entry - exit) / length;
        println!("{cells} cells: {out:.4?} K, Charny {exact:.4}, Dupuit {dupuit:.4}; up to {most} iterations a step");
        assert!((-out[0] / exact - 1.0).abs() < bound && (-out[0] / (out[1] + out[2]) - 1.0).abs() < 1e-3);
        assert!(out[2] > 0.2 * dupuit && (-out[0] / dupuit - 1.0).abs() < 0.04);
    }
}
