//! Tests of one-dimensional consolidation of a column under a sudden load (Terzaghi).

use super::{M, Plane, column, geometric, run, run_from, settlement};
use bsmpm::field::pore_water::flow::{Course, DrainedFace, Given, PermeabilityLaw, Soil};
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::grid::{Grid, KnotVector};
use bsmpm::step::StepReport;

/// T, U, and p/p0 at depths of 0.25, 0.5 and 1 of the column below its top.
const TABLE: [(f64, f64, [f64; 3]); 5] = [
    (0.05, 0.252313, [0.570805, 0.886152, 0.996869]),
    (0.1, 0.356823, [0.423759, 0.735651, 0.949305]),
    (0.2, 0.504088, [0.302084, 0.553176, 0.772312]),
    (0.5, 0.763950, [0.141899, 0.262188, 0.370777]),
    (1.0, 0.931260, [0.041321, 0.076351, 0.107977]),
];

const LOAD: f64 = 1e-5 * M;

/// Degree of consolidation.
fn degree(points: &bsmpm::points::Points<2>) -> f64 {
    settlement(points) * M / LOAD
}

/// Terzaghi (1943): degree of consolidation and pore pressure.
#[test]
fn settlement_and_pressures_follow_the_closed_form() {
    let mut times = geometric(1e-5, 1.0, 900);
    times.extend(TABLE.map(|row| row.0));
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut scene = column(20, 1.0, LOAD, PermeabilityLaw::Constant);
    let mut worst = [0.0_f64; 2];
    let mut iterations = 0;
    let mut steps = 0;
    let mut left = 0.0_f64;
    run(&mut scene, times, |t, points, report| {
        iterations += report.iterations;
        steps += 1;
        let water = report.water.as_ref().expect("water flows");
        left = left.max((water.stored + water.crossed.out() - water.left).abs() / water.crossed.out());
        let Some((_, U, p)) = TABLE.iter().find(|row| row.0 == t) else {
            return;
        };
        let pressures = points.pore_pressure.as_ref().expect("water flows");
        let of = |depth: f64| {
            let nearest = |a: &usize, b: &usize| {
                (points.x[*a][1] - 1.0 + depth)
                    .abs()
                    .total_cmp(&(points.x[*b][1] - 1.0 + depth).abs())
            };
            let p = (0..points.len()).min_by(nearest).expect("points");
            let gradient = points.pressure_gradient.as_ref().expect("water flows")[p][1];
            (pressures[p] + gradient * (1.0 - depth - points.x[p][1])) / LOAD
        };
        let found = [0.25, 0.5, 1.0].map(of);
        println!("T {t}: U {:.5} ({U:.5}), p {found:.5?} ({p:?})", degree(points));
        worst[0] = worst[0].max((degree(points) - U).abs());
        worst[1] = found
            .iter()
            .zip(p)
            .map(|(found, p)| (found - p).abs())
            .fold(worst[1], f64::max);
    });
    println!("errors {worst:.5?}, {iterations} iterations in {steps} steps, balance {left:.1e}");
    assert!(worst[0] < 0.002 && worst[1] < 0.003 && left < 1e-12);
}

/// Largest pore pressure of the points over the load.
fn largest(points: &bsmpm::points::Points<2>) -> f64 {
    points.pore_pressure.iter().flatten().copied().fold(0.0, f64::max) / LOAD
}

#[test]
fn pressures_do_not_oscillate_in_the_shortest_step() {
    for cut in [1.0, 0.35] {
        let mut scene = column(20, cut, LOAD, PermeabilityLaw::Constant);
        let mut most = 0.0;
        run(&mut scene, [1e-6 / 400.0], |_, points, report| {
            most = largest(points);
            println!(
                "cut {cut}: largest p/p0 - 1 {:.1e}, {} iterations",
                most - 1.0,
                report.iterations
            );
        });
        assert!(most - 1.0 < 0.01);
    }
}

/// Steps of the same length until T = 0.2, beside what 640 of them come to.
#[test]
fn consolidation_is_of_second_order_in_time() {
    let settled = [10, 20, 40, 640].map(|count| {
        let mut scene = column(20, 1.0, LOAD, PermeabilityLaw::Constant);
        let mut last = 0.0;
        run(
            &mut scene,
            (1..=count).map(|k| 0.2 * f64::from(k) / f64::from(count)),
            |_, points, _| last = degree(points),
        );
        last
    });
    let errors = [0, 1, 2].map(|k: usize| (settled[k] - settled[3]).abs());
    let orders = [0, 1].map(|k: usize| (errors[k] / errors[k + 1]).log2());
    println!("U(0.2) {settled:.6?} in 10, 20, 40 and 640 steps: errors {errors:.6?}, orders {orders:.2?}");
    assert!(errors[0] < 0.001 && (settled[3] - 0.504088).abs() < 0.001);
    assert!(orders.iter().all(|order| *order > 1.8 && *order < 2.3));
}

/// Terzaghi (1943): degree of consolidation.
#[test]
fn a_drained_surface_may_cut_the_cells() {
    let of = |cut: f64| {
        let mut scene = column(20, cut, LOAD, PermeabilityLaw::Constant);
        let mut last = 0.0;
        run(&mut scene, geometric(1e-4, 0.2, 100), |_, points, report| {
            last = degree(points);
            let water = report.water.as_ref().expect("water flows");
            assert!((water.stored + water.crossed.out() - water.left).abs() < 1e-12 * water.crossed.out());
        });
        last
    };
    let whole = of(1.0);
    for cut in [0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95] {
        let found = of(cut);
        println!("cut {cut}: U(0.2) {found:.5}, {:+.5}", found - whole);
        assert!((found - whole).abs() < 0.002);
    }
}

#[test]
fn a_line_across_which_strains_may_jump_does_not_tear_the_pressure() {
    let of = |line: bool| {
        let mut scene = column(20, 1.0, LOAD, PermeabilityLaw::Constant);
        if line {
            let mut breakpoints: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
            breakpoints.insert(10, 0.5);
            let [across, _] = scene.model.grid.axes().clone();
            scene.model.grid = Grid::new([across, KnotVector::graded(&breakpoints, 2).expect("knots")]).expect("grid");
            scene.points.sort_by_cell(&scene.model.grid);
        }
        let mut last = Vec::new();
        run(&mut scene, geometric(1e-4, 0.2, 100), |_, points, report| {
            let mut by_height: Vec<(f64, f64)> = points
                .x
                .iter()
                .map(|x| x[1])
                .zip(points.pore_pressure.iter().flatten().copied())
                .collect();
            by_height.sort_by(|a, b| a.0.total_cmp(&b.0));
            last = by_height
                .iter()
                .map(|(_, p)| p / LOAD)
                .chain([degree(points)])
                .collect();
            let water = report.water.as_ref().expect("water flows");
            assert!((water.stored + water.crossed.out() - water.left).abs() < 1e-12 * water.crossed.out());
        });
        last
    };
    let whole = of(false);
    let lined = of(true);
    let off = whole.iter().zip(&lined).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("pressures and U(0.2) with a line at half the height: off by {off:.1e}");
    assert!(off < 5e-4);
}

/// The lower half lets nothing through, and exchanges what functions of both halves let it: no water is lost there.
#[test]
fn books_hold_where_soil_that_lets_nothing_through_touches_soil_that_does() {
    let mut scene = column(8, 1.0, LOAD, PermeabilityLaw::Constant);
    scene.model.materials.push(scene.model.materials[0].clone());
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("it flows");
    let tight = flow.soils[0].clone().map(|soil| Soil {
        permeability: None,
        ..soil
    });
    flow.soils.push(tight);
    for p in 0..scene.points.len() {
        scene.points.material[p] = u16::from(scene.points.x[p][1] < 0.45);
    }
    let mut out = 0.0;
    let mut worst = 0.0_f64;
    run(&mut scene, geometric(1e-3, 0.2, 30), |_, _, report| {
        let water = report.water.as_ref().expect("water flows");
        out += water.crossed.out();
        worst = worst.max((water.stored + water.crossed.out() - water.left).abs());
    });
    println!("out {out:.3e} m3, books off by {worst:.1e}");
    assert!(out > 0.4 * scene.model.grid.smallest_edge() * LOAD / M && worst < 1e-12 * out);
}

/// What drives water through a column that has settled works p times what crosses, and seepage takes it.
#[test]
fn steady_seepage_takes_what_drives_it() {
    let mut scene = column(8, 1.0, 0.0, PermeabilityLaw::Constant);
    scene.model.balances_energy = true;
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("it flows");
    let given = Given::Pressure(Course(vec![(0.0, LOAD)]));
    flow.faces.push(DrainedFace {
        axis: 1,
        upper: false,
        given,
        acts: true,
    });
    let mut last = [0.0; 3];
    run(&mut scene, geometric(1e-3, 8.0, 60), |_, _, report| {
        let energy = report.energy.expect("books are kept");
        let water = report.water.as_ref().expect("water flows");
        last = [-LOAD * water.crossed.faces[1], energy.external, energy.plastic];
    });
    println!(
        "pressure times what came in {:.6e} J, external {:.6e}, seepage {:.6e}",
        last[0], last[1], last[2]
    );
    assert!(last[0] > 0.0 && last.iter().all(|work| (work / last[0] - 1.0).abs() < 1e-5));
}

/// Water that comes in below swells a column, until its upper quarter is taken away: what has come and gone, what the
/// points hold and what went with those taken away differ by what the iterations left, at tolerances that leave much.
#[test]
fn books_of_ground_that_a_part_is_taken_from_are_off_by_what_the_iterations_left() {
    let mut scene = column(8, 1.0, 0.0, PermeabilityLaw::Constant);
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-6, 1e-3);
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("it flows");
    let given = Given::Pressure(Course(vec![(0.0, 1e-2 * M)]));
    flow.faces.push(DrainedFace {
        axis: 1,
        upper: false,
        given,
        acts: true,
    });
    let mut out = 0.0;
    let mut left = 0.0;
    let mut enter = |report: &StepReport| {
        let water = report.water.as_ref().expect("water flows");
        (out, left) = (out + water.crossed.out(), left + water.left);
    };
    run(&mut scene, geometric(1e-3, 0.2, 20), |_, _, report| enter(report));
    let gone: Vec<u64> = (0..scene.points.len())
        .filter(|p| scene.points.height(*p) > 0.75)
        .map(|p| scene.points.id[p])
        .collect();
    let halo = scene.halo();
    let taken = |scene: &Plane, t: f64, wanted: &dyn Fn(u64) -> bool| {
        PoreWater::of(&scene.model, &scene.points, t)
            .expect("water")
            .taken_by(wanted, &halo)
    };
    let removed = taken(&scene, 0.2, &|id| gone.contains(&id));
    scene.points.remove(|id| gone.contains(&id));
    scene.points.forget_flow();
    scene.state.flowed = None;
    run_from(
        &mut scene,
        0.2,
        (1..=10).map(|k| 0.2 + 0.02 * f64::from(k)),
        |_, _, report| enter(report),
    );
    let held = taken(&scene, 0.4, &|_| true);
    let off = held + removed + out;
    println!("held {held:.3e}, removed {removed:.3e}, out {out:.3e} m3: off by {off:.3e}, left {left:.3e}");
    assert!(removed > 0.02 * held && left.abs() > 1e-8 * held && (off - left).abs() < 1e-12 * held);
}
