//! Rigid bodies of any polygon: closed forms of friction, blows, Hertz and punches, free bodies, lifting.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::rigid::Outline;
use bsmpm::boundary::{Path, RigidBody, Strip, Support, surface};
use bsmpm::energy::{Books, Stored};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::method::Nonlinear;
use bsmpm::model::{Gravity, Regime};
use bsmpm::points::Points;
use bsmpm::tensor::Vector;

const G: f64 = 9.81;
const RAMP: f64 = 0.1;

fn polygon(center: [f64; 2], corners: &[[f64; 2]]) -> RigidBody {
    let corners = corners.iter().map(|corner| Vector::from(*corner) - Vector::from(center)).collect();
    of(Outline::Polygon(corners), center)
}

fn of(outline: Outline, center: [f64; 2]) -> RigidBody {
    RigidBody {
        outline,
        center: center.into(),
        friction: 0.0,
        free: [false; 3],
        path: Vec::new(),
        mass: Vector::zeros(),
        load: Vec::new(),
        velocity: Vector::zeros(),
    }
}

/// A rectangle.
fn slab([left, bottom]: [f64; 2], [right, top]: [f64; 2]) -> RigidBody {
    let center = [0.5 * (left + right), 0.5 * (bottom + top)];
    polygon(center, &[[left, bottom], [right, bottom], [right, top], [left, top]])
}

fn path(rows: &[(f64, [f64; 3])]) -> Vec<(f64, Vector<3>)> {
    rows.iter().map(|(t, moved)| (*t, Vector::from(*moved))).collect()
}

fn mean(points: &Points<2>, of: impl Fn(usize) -> f64) -> f64 {
    let sum: f64 = (0..points.len()).map(|p| of(p) * points.mass[p]).sum();
    sum / points.mass.iter().sum::<f64>()
}

/// A block of 1 x .5 m, of cells of 1/`n` m, on a rigid plate; gravity is inclined by `slope` = tan(theta).
fn block(n: usize, slope: f64, friction: f64, regime: Regime) -> Scene<PlaneStrain, 2> {
    let h = 1.0 / n as f64;
    let plate = RigidBody { friction, ..slab([-1.0, -0.5], [5.0, 0.5]) };
    let mut scene = Scene::<PlaneStrain, 2>::new([axis(h, 3 * n, 2), axis(h, 2 * n, 2)], hencky(1e7, 0.3), regime)
        .body([n / 2..n / 2 + n, n / 2..n], 2, 1000.0, |_| Vector::zeros())
        .rigid(plate);
    let theta = slope.atan();
    scene.model.gravity = Some(Gravity { acceleration: Vector::from([G * theta.sin(), -G * theta.cos()]), ramp: RAMP });
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-10, 1e-6);
    scene
}

/// Way and velocity under gravity that grows over the ramp, at .5 s, over those of a rigid block, less 1.
fn slid(n: usize, dt: f64, friction: f64, method: Nonlinear) -> (f64, f64, usize) {
    const END: f64 = 0.5;
    let theta = 0.5_f64.atan();
    let a = G * (theta.sin() - friction * theta.cos());
    let mut scene = block(n, 0.5, friction, Regime::Dynamic);
    (scene.model.nonlinear, scene.model.balances_energy) = (method, true);
    let mut books = Books::open(Stored::of(&scene.model, &scene.points, &scene.halo()));
    let (mut iterations, mut cuts) = (0, 0);
    let mut last = Default::default();
    scene.march(dt, END, |_, accepted| {
        books.flows += accepted.report.energy.expect("it is balanced");
        iterations = iterations.max(accepted.report.iterations);
        cuts += accepted.rejected.len();
        last = accepted.report.rigid[0];
    });
    println!("{last:?} cuts {cuts}");
    let way = mean(&scene.points, |p| scene.points.u[p][0]);
    let velocity = mean(&scene.points, |p| scene.points.motion.as_ref().expect("dynamic").v[p][0]);
    let now = Stored::of(&scene.model, &scene.points, &scene.halo());
    println!("closure {:.1e} of {:.1e}", books.closure(now), now.kinetic);
    let rigid = [0.5 * (END - RAMP).powi(2) + 0.5 * RAMP * (END - RAMP) + RAMP * RAMP / 6.0, END - 0.5 * RAMP];
    (way / (a * rigid[0]) - 1.0, velocity / (a * rigid[1]) - 1.0, iterations)
}

#[test]
fn a_block_slides_down_a_rigid_plate_as_coulomb_says() {
    for (n, dt, method) in [
        (4, 0.02, Nonlinear::Auto),
        (4, 0.01, Nonlinear::Auto),
        (4, 0.01, Nonlinear::Newton),
        (8, 0.01, Nonlinear::Auto),
    ] {
        println!("{n} {dt} {method:?} {:?}", slid(n, dt, 0.3, method));
    }
}

#[test]
fn a_block_sticks() {
    let mut scene = block(4, 0.5, 0.6, Regime::Dynamic);
    let mut last = Default::default();
    scene.march(0.01, 0.5, |_, accepted| last = accepted.report.rigid[0]);
    let way = mean(&scene.points, |p| scene.points.u[p][0]);
    println!("{way:.1e} {last:?}");
    let mut scene = block(4, 0.3, 0.31, Regime::QuasiStatic);
    scene.march(0.05, 0.1, |_, accepted| last = accepted.report.rigid[0]);
    let way = mean(&scene.points, |p| scene.points.u[p][0]);
    println!("{way:.1e} {last:?}");
}

/// An elastic bar that hits a rigid wall.
fn bar(cells: usize, steps_per_transit: f64, method: Nonlinear) {
    let (l, e, rho, v) = (1.0, 1e6, 1000.0, std::env::var("V").map_or(0.1, |v| v.parse().unwrap()));
    let h = l / cells as f64;
    let c = (e / rho as f64).sqrt();
    let gap: f64 = std::env::var("GAP").map_or(0.02, |v| v.parse().unwrap()) * h;
    let wall = slab([0.0, -1.0], [2.0 * h - gap, 2.0]);
    let mut scene =
        Scene::<PlaneStrain, 2>::new([axis(h, cells + 8, 2), axis(h, 1, 2)], hencky(e, 0.0), Regime::Dynamic)
            .body([2..2 + cells, 0..1], 2, rho, |_| Vector::from([-v, 0.0]))
            .rollers([1])
            .rigid(wall);
    scene.model.nonlinear = method;
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-10, 1e-6);
    scene.model.balances_energy = true;
    let dt = l / c / steps_per_transit;
    let (mut first, mut last, mut impulse, mut t) = (0.0, 0.0, 0.0, 0.0);
    let mut most: f64 = 0.0;
    let mut books = Books::open(Stored::of(&scene.model, &scene.points, &scene.halo()));
    scene.march(dt, 4.0 * l / c, |_, accepted| {
        t += accepted.dt;
        books.flows += accepted.report.energy.unwrap();
        let push = -accepted.report.rigid[0].force[0];
        assert!(push >= 0.0);
        if push > 0.0 {
            if first == 0.0 {
                first = t;
            }
            last = t;
            most = most.max(push);
        }
        if cells == 20 && steps_per_transit == 20.0 {
            ();
            if false {
                println!(
                    "{:.3} {:.3} gap {:.2e} v {:.3}",
                    t * c / l,
                    push / (rho * c * v * h),
                    accepted.report.rigid[0].gap / h,
                    0.0
                );
            }
        }
        impulse += push * accepted.dt;
    });
    let mass: f64 = scene.points.mass.iter().sum();
    let after = mean(&scene.points, |p| scene.points.motion.as_ref().unwrap().v[p][0]);
    let now = Stored::of(&scene.model, &scene.points, &scene.halo());
    println!(
        "{cells} {steps_per_transit}: contact {:.3} of 2L/c, rebound {:.4}, impulse {:.4}, peak {:.3} of rho c v, energy {:.4} closure {:.1e}",
        (last - first) * c / (2.0 * l),
        after / v,
        impulse / (mass * v),
        most / (rho * c * v * h),
        (now.kinetic + now.elastic) / (0.5 * mass * v * v),
        books.closure(now)
    );
}

#[test]
fn a_bar_that_hits_a_wall_leaves_again() {
    for (cells, steps) in [(20, 20.0), (20, 40.0), (40, 40.0), (40, 80.0)] {
        bar(cells, steps, Nonlinear::Auto);
    }
    bar(20, 20.0, Nonlinear::Newton);
}

/// A rigid block that falls on an elastic bed and leaves it again.
#[test]
fn a_free_block_falls_bounces_and_keeps_the_momentum_that_it_was_given() {
    let h = 0.25;
    let (mass, drop) = (500.0, 0.05);
    let block = RigidBody {
        free: [true; 3],
        mass: Vector::from([mass, mass, mass * (0.5_f64.powi(2) + 0.5_f64.powi(2)) / 12.0]),
        ..slab([0.75, 1.0 + drop], [1.25, 1.5 + drop])
    };
    let mut scene = Scene::<PlaneStrain, 2>::new([axis(h, 8, 2), axis(h, 8, 2)], hencky(1e6, 0.2), Regime::Dynamic)
        .body([0..8, 0..4], 2, 1000.0, |_| Vector::zeros())
        .rollers([0])
        .support(Support::fixed(1, false))
        .rigid(block)
        .gravity(G, 0.0);
    scene.model.gravity.as_mut().unwrap().ramp = 0.0;
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-9, 1e-6);
    let dt = 0.002;
    let (mut momentum, mut worst, mut t): (f64, f64, f64) = (0.0, 0.0, 0.0);
    scene.march(dt, 0.4, |_, accepted| {
        t += accepted.dt;
        let now = accepted.report.rigid[0];
        momentum += (now.force[1] - mass * G) * accepted.dt;
        worst = worst.max((mass * now.velocity[1] - momentum).abs() / (mass * G * 0.1));
        if (t / 0.01).fract() < 0.2 {
            println!(
                "{t:.3} y {:.4} v {:.4} F {:.3} rot {:.1e} touched {} gap {:.1e} it {} cuts {}",
                now.moved[1],
                now.velocity[1],
                now.force[1] / (mass * G),
                now.moved[2],
                now.touched,
                now.gap,
                accepted.report.iterations,
                accepted.rejected.len()
            );
        }
    });
    println!("momentum off by {worst:.1e}");
}

/// A rigid cylinder on an elastic half plane: the stress below it over that of Hertz, 1/sqrt(1 + (z/a)^2) of the largest,
/// at the depths that are asked for.
fn hertz(h: f64, method: Nonlinear) {
    let (e, nu, r): (f64, f64, f64) = (1e6, 0.3, 2.0);
    let (w, d) = (4.0, 4.0);
    let (nx, ny) = ((w / h) as usize, (d / h) as usize);
    let down = 0.02;
    let cylinder = RigidBody { path: path(&[(1.0, [0.0, -down, 0.0])]), ..of(Outline::Circle(r), [0.0, d + r]) };
    let mut scene =
        Scene::<PlaneStrain, 2>::new([axis(h, nx, 2), axis(h, ny + 2, 2)], hencky(e, nu), Regime::QuasiStatic)
            .body([0..nx, 0..ny], 2, 1000.0, |_| Vector::zeros())
            .rollers([0])
            .support(Support::fixed(1, false))
            .rigid(cylinder);
    scene.model.nonlinear = method;
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-8, 1e-5);
    let mut last = Default::default();
    let mut iterations = 0;
    scene.march(0.25, 1.0, |_, accepted| {
        last = accepted.report.rigid[0];
        iterations = iterations.max(accepted.report.iterations)
    });
    let p = 2.0 * last.force[1];
    let star = e / (1.0 - nu * nu);
    let a = (4.0 * p * r / (std::f64::consts::PI * star)).sqrt();
    let peak = 2.0 * p / (std::f64::consts::PI * a);
    let points = &scene.points;
    print!(
        "{h} {method:?} P {p:.1} a {a:.3} touched {} of {:.1} its {iterations} pen {:.1e};",
        last.touched,
        a / h * 2.0,
        last.penetration
    );
    for wanted in [0.1, 0.2, 0.3, 0.4, 0.5, 0.8] {
        let near = (0..points.len())
            .filter(|&q| points.x[q][0] < 0.5 * h)
            .min_by(|&p, &q| (points.x[p][1] - (d - wanted)).abs().total_cmp(&(points.x[q][1] - (d - wanted)).abs()))
            .unwrap();
        let z = d - points.x[near][1];
        let exact = peak / (1.0 + (z / a).powi(2)).sqrt();
        print!(" {wanted}: {:.3}", -points.sigma.at(near).0[1] / exact);
    }
    println!();
}

#[test]
fn a_cylinder_on_a_half_plane_is_hertz() {
    hertz(0.2, Nonlinear::Auto);
    hertz(0.1, Nonlinear::Auto);
}

/// A flat punch presses on an elastic layer as a smooth or rough strip does.
#[test]
fn a_flat_punch_is_a_strip() {
    for h in [0.25, 0.125] {
        let n = (1.0 / h) as usize;
        let down = 0.01;
        let scene = || {
            let mut scene = Scene::<PlaneStrain, 2>::new(
                [axis(h, 3 * n, 2), axis(h, 3 * n, 2)],
                hencky(1e6, 0.3),
                Regime::QuasiStatic,
            )
            .body([0..3 * n, 0..2 * n], 2, 1000.0, |_| Vector::zeros())
            .rollers([0])
            .support(Support::fixed(1, false));
            (scene.model.criteria.energy, scene.model.criteria.force) = (1e-8, 1e-5);
            scene
        };
        for (friction, smooth) in [(0.0, true), (1.0, false)] {
            let punch =
                RigidBody { friction, path: path(&[(1.0, [0.0, -down, 0.0])]), ..slab([-1.0, 2.0], [1.0, 2.5]) };
            let mut with_body = scene().rigid(punch);
            let mut last = Default::default();
            with_body.march(0.5, 1.0, |_, accepted| last = accepted.report.rigid[0]);
            let points = surface::along::<PlaneStrain>(
                &with_body.model.grid,
                &Vector::from([0.0, 2.0]),
                &Vector::from([1.0, 2.0]),
                4,
            );
            let strip = Strip {
                points,
                normal: smooth.then(|| Vector::from([0.0, 1.0])),
                path: Path { rows: vec![(1.0, Vector::from([0.0, -down]))] },
                penalty: 1e10 / h,
            };
            let mut force = 0.0;
            scene().strip(strip).march(0.5, 1.0, |_, accepted| force = -accepted.report.strips[0].force[1]);
            println!(
                "{h} smooth {smooth}: {:.1} {force:.1} {:.4} touched {}",
                last.force[1],
                last.force[1] / force,
                last.touched
            );
        }
    }
}

/// A block that is pressed and let go: its force ends with the last touch, and the plate leaves.
#[test]
fn nothing_is_pulled() {
    let plate = RigidBody {
        friction: 0.5,
        path: path(&[(1.0, [0.0, -0.01, 0.0]), (3.0, [0.0, 0.01, 0.0])]),
        ..slab([-1.0, 1.0], [2.0, 1.5])
    };
    let mut scene =
        Scene::<PlaneStrain, 2>::new([axis(0.25, 4, 2), axis(0.25, 8, 2)], hencky(1e6, 0.3), Regime::QuasiStatic)
            .body([0..4, 0..4], 2, 1000.0, |_| Vector::zeros())
            .rollers([0])
            .support(Support::fixed(1, false))
            .rigid(plate);
    scene.march(0.25, 3.0, |points, accepted| {
        let now = accepted.report.rigid[0];
        println!("{} {:.3} gap {:.2e} stress {:.3e}", accepted.t, now.force[1], now.gap, points.sigma.at(0).0[1]);
    });
}

/// A free rigid block slides on an elastic bed.
#[test]
fn a_rigid_block_slides_on_soil() {
    let slope = 0.5_f64.atan();
    let block = RigidBody {
        friction: 0.3,
        free: [true; 3],
        mass: Vector::from([200.0, 200.0, 200.0 * (1.0 + 0.0625) / 12.0]),
        ..slab([0.5, 1.0], [1.5, 1.25])
    };
    for (dt, method) in [(0.01, Nonlinear::Auto)] {
        let mut scene =
            Scene::<PlaneStrain, 2>::new([axis(0.25, 16, 2), axis(0.25, 6, 2)], hencky(1e6, 0.3), Regime::Dynamic)
                .body([0..16, 0..4], 2, 1000.0, |_| Vector::zeros())
                .rollers([0])
                .support(Support::fixed(1, false))
                .rigid(block.clone());
        scene.model.nonlinear = method;
        (scene.model.criteria.energy, scene.model.criteria.force) = (1e-8, 1e-5);
        scene.model.gravity =
            Some(Gravity { acceleration: Vector::from([G * slope.sin(), -G * slope.cos()]), ramp: RAMP });
        let (mut worst, mut momentum, mut its, mut cuts): (f64, Vector<2>, usize, usize) = (0.0, Vector::zeros(), 0, 0);
        let mut last = Default::default();
        scene.march(dt, 0.5, |_, accepted| {
            last = accepted.report.rigid[0];
            its = its.max(accepted.report.iterations);
            cuts += accepted.rejected.len();
            for error in &accepted.rejected {
                println!("{} {}", accepted.t, &error.to_string()[..100.min(error.to_string().len())]);
            }
            let grown = (accepted.t / RAMP).min(1.0);
            let force = Vector::<2>::new(last.force[0], last.force[1])
                + Vector::<2>::new(slope.sin(), -slope.cos()) * (200.0 * G * grown);
            momentum += force * accepted.dt;
            worst = worst.max((momentum - 200.0 * Vector::<2>::new(last.velocity[0], last.velocity[1])).norm());
        });
        let exact = G * (slope.sin() - 0.3 * slope.cos()) * (0.5 - 0.5 * RAMP);
        println!(
            "{dt} {method:?} v {:.4} of it; momentum off {worst:.1e} its {its} cuts {cuts} {last:?}",
            last.velocity[0] / exact
        );
    }
}
