//! Rigid bodies of any polygon: closed forms of friction, blows, Hertz and punches, free bodies, lifting.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::rigid::Outline;
use bsmpm::boundary::{RigidBody, Support};
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

/// Hertz: a rigid cylinder on an elastic half plane.
fn hertz(h: f64, method: Nonlinear) {
    let (e, nu, r): (f64, f64, f64) = (1e6, 0.3, 2.0);
    let (w, d) = (2.0, 2.0);
    let (nx, ny) = ((w / h) as usize, (d / h) as usize);
    let down = 0.02;
    let cylinder = RigidBody { path: path(&[(1.0, [0.0, -down, 0.0])]), ..of(Outline::Circle(r), [0.0, d + r]) };
    let mut scene =
        Scene::<PlaneStrain, 2>::new([axis(h, nx, 2), axis(h, ny + 4, 2)], hencky(e, nu), Regime::QuasiStatic)
            .body([0..nx, 0..ny], 2, 1000.0, |_| Vector::zeros())
            .rollers([0])
            .support(Support::fixed(1, false))
            .rigid(cylinder);
    scene.model.nonlinear = method;
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-8, 1e-5);
    let mut rows = Vec::new();
    scene.march(0.1, 1.0, |points, accepted| {
        let report = accepted.report.rigid[0];
        let p = 2.0 * report.force[1];
        let star = e / (1.0 - nu * nu);
        let a = (4.0 * p * r / (std::f64::consts::PI * star)).sqrt();
        let peak = 2.0 * p / (std::f64::consts::PI * a);
        let top =
            (0..points.len()).filter(|&q| points.x[q][0] < h).map(|q| -points.sigma.at(q).0[1]).fold(0.0, f64::max);
        rows.push((
            p,
            a / h,
            top / peak,
            report.touched,
            accepted.report.iterations,
            accepted.rejected.len(),
            report.penetration,
        ));
    });
    for row in rows {
        println!(
            "{h} {method:?} P {:.1} a/h {:.2} peak {:.3} touched {} iterations {} cuts {} pen {:.1e}",
            row.0, row.1, row.2, row.3, row.4, row.5, row.6
        );
    }
}

#[test]
fn a_cylinder_on_a_half_plane_is_hertz() {
    hertz(0.1, Nonlinear::Auto);
    hertz(0.1, Nonlinear::Newton);
    hertz(0.05, Nonlinear::Auto);
}
