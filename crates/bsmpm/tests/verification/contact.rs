//! Tests of contact at faces of the grid: closed forms of Coulomb friction, impacts, separation and closing.

use crate::support::scene::{Scene, axis, hencky};
use crate::support::solver::Skyline;
use bsmpm::boundary::{Support, surface};
use bsmpm::control::{AcceptedStep, Stepper};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::energy::{EnergyAccounts, StoredEnergy};
use bsmpm::interactions::coulomb::{Contact, ContactReport};
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::{PlaneStrain, Solid};
use bsmpm::method::Nonlinear;
use bsmpm::model::{Gravity, Regime};
use bsmpm::points::Points;
use bsmpm::schedule::Schedule;
use bsmpm::tensor::Vector;

const G: f64 = 9.81;
const RAMP: f64 = 0.1;

const fn rough(friction: f64) -> Contact {
    Contact { friction, lifts: true }
}

/// A block of 1 x 0.5 m, of cells of 1/`n` m, on a base that is inclined by `slope` = tan(theta).
fn block(n: usize, slope: f64, law: Contact, regime: Regime) -> Scene<PlaneStrain, 2> {
    let h = 1.0 / n as f64;
    let mut scene = Scene::<PlaneStrain, 2>::new([axis(h, 3 * n, 2), axis(h, n, 2)], hencky(1e7, 0.3), regime)
        .body([n / 2..n / 2 + n, 0..n / 2], 2, 1000.0, |_| Vector::zeros())
        .support(Support::contact(1, false, law));
    let theta = slope.atan();
    scene.model.gravity = Some(Gravity {
        acceleration: Vector::from([G * theta.sin(), -G * theta.cos()]),
        ramp: RAMP,
        starts_vertical: false,
    });
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-10, 1e-6);
    scene
}

/// Mean over the mass of a vector of the points along x.
fn mean(points: &Points<2>, of: impl Fn(usize) -> f64) -> f64 {
    let sum: f64 = (0..points.len()).map(|p| of(p) * points.mass[p]).sum();
    sum / points.mass.iter().sum::<f64>()
}

fn velocity(points: &Points<2>) -> f64 {
    mean(points, |p| points.motion.as_ref().expect("dynamic").v[p][0])
}

fn weight(scene: &Scene<PlaneStrain, 2>) -> f64 {
    scene.points.mass.iter().sum::<f64>() * G
}

fn of(accepted: &AcceptedStep) -> ContactReport {
    accepted.report.contacts[0]
}

/// Friction over normal force of a step, each summed over the face.
fn used(accepted: &AcceptedStep) -> f64 {
    let [along, normal] = accepted.report.reactions[0][..] else {
        panic!("of the plane")
    };
    along.abs() / normal.max(f64::MIN_POSITIVE)
}

/// Whether a scene reaches `end`.
fn arrives(mut scene: Scene<PlaneStrain, 2>, dt: f64, end: f64) -> bool {
    let halo = scene.halo();
    let schedule = Schedule::new(dt, end, []);
    let mut solver = Skyline::new(&scene.model.grid);
    let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
    let mut step = || scene.advance(&mut stepper, &schedule, &halo, &mut solver);
    std::iter::from_fn(&mut step).all(|found| found.is_ok())
}

/// Way and velocity under gravity that grows over the ramp, at 0.5 s, over those of a rigid block, less 1.
fn slid(n: usize, dt: f64, friction: f64, method: Nonlinear) -> (f64, f64, usize) {
    const END: f64 = 0.5;
    let theta = 0.5_f64.atan();
    let a = G * (theta.sin() - friction * theta.cos());
    let mut scene = block(n, 0.5, rough(friction), Regime::Dynamic);
    (scene.model.nonlinear, scene.model.balances_energy) = (method, true);
    let mut books = EnergyAccounts::open(StoredEnergy::of(&scene.model, &scene.points, 0.0, &scene.halo()));
    let mut iterations = 0;
    let mut dissipated = 0.0;
    scene.march(dt, END, |_, accepted| {
        assert!(
            used(accepted) <= friction * (1.0 + 1e-12) && accepted.rejected.is_empty(),
            "{:?}",
            accepted.rejected
        );
        books.flows += accepted.report.energy.expect("it is balanced");
        dissipated += of(accepted).dissipated;
        iterations = iterations.max(accepted.report.iterations);
    });
    let way = mean(&scene.points, |p| scene.points.u[p][0]);
    let now = StoredEnergy::of(&scene.model, &scene.points, 0.0, &scene.halo());
    assert!(
        books.residual(now).abs() < 1e-6 * now.kinetic,
        "the books close: {:.1e}",
        books.residual(now)
    );
    let friction_work = friction * theta.cos() * weight(&scene) * way;
    assert!(
        (dissipated / friction_work - 1.0).abs() < 0.01,
        "{dissipated} of {friction_work} J"
    );
    let rigid = [
        0.5 * (END - RAMP).powi(2) + 0.5 * RAMP * (END - RAMP) + RAMP * RAMP / 6.0,
        END - 0.5 * RAMP,
    ];
    (
        way / (a * rigid[0]) - 1.0,
        velocity(&scene.points) / (a * rigid[1]) - 1.0,
        iterations,
    )
}

/// Of first order in the step, as the face's nodes go by backward Euler; what is left is the block's own elasticity.
#[test]
fn a_block_slides_down_as_coulomb_says() {
    let [coarse, middle, fine] = [0.02, 0.01, 0.005].map(|dt| slid(4, dt, 0.3, Nonlinear::Auto));
    let order = ((coarse.0 - middle.0) / (middle.0 - fine.0)).log2();
    let cells = slid(8, 0.01, 0.3, Nonlinear::Auto);
    println!("way {coarse:?} {middle:?} {fine:?}, order {order:.2}; cells half as large {cells:?}");
    // measured 0.00690, 0.00360, 0.00220, order 1.24; velocity 5e-5; cells half as large 0.00202
    assert!(coarse.0 < 0.01 && (0.9..1.6).contains(&order) && fine.0 < 0.003 && cells.0 < 0.003);
    assert!(
        [coarse, middle, fine, cells]
            .iter()
            .all(|(_, velocity, _)| velocity.abs() < 2e-3)
    );
}

/// With the derivative of friction each step takes few iterations, also where the normal force changes with the slip.
#[test]
fn newtons_method_knows_friction() {
    let secants = slid(4, 0.01, 0.3, Nonlinear::Auto);
    let newton = slid(4, 0.01, 0.3, Nonlinear::Newton);
    assert!(
        (secants.0 - newton.0).abs() < 1e-5 && newton.2 <= 8,
        "{secants:?} {newton:?}"
    );
}

/// Closed form: Coulomb friction on an incline.
#[test]
fn a_block_sticks_where_friction_is_larger_than_the_slope() {
    for law in [
        rough(0.6),
        Contact {
            lifts: false,
            ..rough(0.6)
        },
    ] {
        let mut scene = block(4, 0.5, law, Regime::Dynamic);
        scene.march(0.01, 0.5, |_, accepted| assert!(used(accepted) < 0.6));
        let way = mean(&scene.points, |p| scene.points.u[p][0]);
        println!("{law:?}: {way:.1e} m, {:.1e} m/s", velocity(&scene.points));
        assert!((0.0..5e-4).contains(&way) && velocity(&scene.points).abs() < 5e-3);
    }
}

/// Without inertia nothing holds a block that slides.
#[test]
fn at_rest_a_block_lies_below_the_angle_of_friction_and_not_above() {
    let lies = |friction: f64| arrives(block(4, 0.3, rough(friction), Regime::QuasiStatic), 0.05, RAMP);
    assert!(lies(0.31) && !lies(0.29));
    let mut scene = block(8, 0.3, rough(0.31), Regime::QuasiStatic);
    let mut force = Vec::new();
    let mut sliding = 0.0;
    scene.march(0.05, RAMP, |_, accepted| {
        (force, sliding) = (accepted.report.reactions[0].clone(), of(accepted).sliding)
    });
    let theta = 0.3_f64.atan();
    let expected = [-theta.sin(), theta.cos()].map(|part| part * weight(&scene));
    assert!(
        force
            .iter()
            .zip(expected)
            .all(|(force, expected)| (force - expected).abs() < 1e-5 * weight(&scene))
    );
    assert!(
        (0.5..1.0).contains(&sliding),
        "most of its base slides a little before it does: {sliding}"
    );
}

/// The direction of slip is that of the motion in space, too.
#[test]
fn in_space_a_block_slides_along_the_fall_line() {
    let axes = [axis(0.25, 6, 2), axis(0.25, 6, 2), axis(0.25, 2, 2)];
    let mut scene = Scene::<Solid, 3>::new(axes, hencky(1e7, 0.3), Regime::Dynamic)
        .body([1..3, 1..3, 0..1], 2, 1000.0, |_| Vector::zeros())
        .support(Support::contact(2, false, rough(0.2)));
    scene.model.gravity = Some(Gravity {
        acceleration: [3.0, 4.0, -10.0].into(),
        ramp: RAMP,
        starts_vertical: false,
    });
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-8, 1e-5);
    let mut force = Vec::new();
    scene.march(0.02, 0.4, |_, accepted| force.clone_from(&accepted.report.reactions[0]));
    let mass: f64 = scene.points.mass.iter().sum();
    let v = |c: usize| {
        let motion = scene.points.motion.as_ref().expect("dynamic");
        motion
            .v
            .iter()
            .zip(&scene.points.mass)
            .map(|(v, m)| v[c] * m)
            .sum::<f64>()
            / mass
    };
    let speed = (5.0 - 0.2 * 10.0) * (0.4 - 0.5 * RAMP);
    println!(
        "{:.4} {:.4} of {:.4} {:.4}, {force:?}",
        v(0),
        v(1),
        0.6 * speed,
        0.8 * speed
    );
    assert!((v(0) / (0.6 * speed) - 1.0).abs() < 0.01 && (v(1) / (0.8 * speed) - 1.0).abs() < 0.01);
    assert!((force[0].hypot(force[1]) / force[2] - 0.2).abs() < 1e-3);
}

/// What the upper face does is the mirror image of what the lower one does.
#[test]
fn the_faces_are_alike() {
    let lower = block(4, 0.5, rough(0.3), Regime::Dynamic);
    let mut upper = lower.clone();
    upper.model.boundary.supports = vec![Support::contact(1, true, rough(0.3))];
    upper.model.gravity.as_mut().expect("gravity").acceleration[1] *= -1.0;
    upper.points.x.iter_mut().for_each(|x| x[1] = 1.0 - x[1]);
    upper.points.sort_by_cell(&upper.model.grid);
    let ways = [lower, upper].map(|scene| {
        let scene = scene.solved(0.01, 0.2).0;
        [
            mean(&scene.points, |p| scene.points.u[p][0]),
            mean(&scene.points, |p| scene.points.u[p][1]),
        ]
    });
    assert!(
        (ways[0][0] - ways[1][0]).abs() < 1e-7 && (ways[0][1] + ways[1][1]).abs() < 1e-7,
        "{ways:?}"
    );
}

/// A bar of 1 m, of cells of 1/`n` m, meets a wall from 0.2 m with 1 m/s. Its impulse over the exact one; its time at
/// the wall over that of the wave there and back; its energy after over that before.
fn bounced(n: usize, mass: MassMatrix) -> [f64; 3] {
    let h = 1.0 / n as f64;
    let c = (1e6_f64 / 1000.0).sqrt();
    let mut scene = Scene::<PlaneStrain, 2>::new([axis(h, 2 * n, 2), axis(h, 1, 2)], hencky(1e6, 0.0), Regime::Dynamic)
        .body([n / 5..n + n / 5, 0..1], 2, 1000.0, |_| Vector::from([-1.0, 0.0]))
        .rollers([1])
        .support(Support::contact(0, false, rough(0.0)))
        .with_mass(mass);
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-10, 1e-6);
    let start = StoredEnergy::of(&scene.model, &scene.points, 0.0, &scene.halo());
    let body = weight(&scene) / G;
    let mut impulse = 0.0;
    let mut from = f64::INFINITY;
    let mut to = 0.0_f64;
    scene.march(0.5 * h / c, 0.3, |_, accepted| {
        let push = accepted.report.reactions[2][0];
        assert!(push >= 0.0, "it pulls: {push}");
        impulse += push * accepted.dt;
        if push > 0.0 {
            (from, to) = (from.min(accepted.t), accepted.t);
        }
    });
    assert!((from - 0.2).abs() <= 0.5 * h / c, "the bar meets the wall at {from} s");
    let end = StoredEnergy::of(&scene.model, &scene.points, 0.0, &scene.halo());
    // A consistent mass also takes away what the points bring along to nodes that rest, in every step.
    let taken = velocity(&scene.points) + 1.0 - impulse / body;
    assert!(
        taken.abs() < if mass == MassMatrix::Lumped { 1e-6 } else { 0.02 },
        "momentum is the impulse: {taken}"
    );
    let energy = (end.kinetic + end.elastic) / start.kinetic;
    assert!(energy < 1.0 + 1e-6);
    [impulse / (2.0 * body), (to - from) * c / 2.0, energy]
}

/// The nodes of the face lose their velocity in the blow: a part of the mass that goes with the cells.
#[test]
fn a_bar_bounces() {
    for (mass, [coarse, fine]) in [
        (MassMatrix::Lumped, [0.07, 0.042]),
        (MassMatrix::Consistent, [0.032, 0.022]),
    ] {
        let [a, b] = [10, 20].map(|n| bounced(n, mass));
        println!("{mass:?}: {a:.4?} {b:.4?}");
        // measured: lumped 0.930, 0.958 (n = 40: 0.974), energy 0.874, 0.929; consistent 0.969, 0.978, 0.918, 0.955
        assert!(1.0 - a[0] < coarse && 1.0 - b[0] < fine && b[2] > a[2] && b[2] > 0.9);
        assert!((a[1] - 1.0).abs() < 0.06 && (b[1] - 1.0).abs() < 0.03);
    }
}

/// A quasi-static block under its weight, at whose top a strip moves by these rows (m).
fn gripped(law: Contact, normal: Option<Vector<2>>, rows: &[(f64, [f64; 2])]) -> Scene<PlaneStrain, 2> {
    let scene = block(4, 0.0, law, Regime::QuasiStatic);
    let [from, to] = [[0.5, 0.5], [1.5, 0.5]].map(Vector::from);
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &from, &to, 2);
    let rows = rows.iter().map(|(t, u)| (*t, Vector::from(*u))).collect();
    scene.strip(Strip {
        contact: None,
        points,
        normal,
        transitions: Default::default(),
        path: Path { rows },
        penalty: 4e11,
    })
}

#[test]
fn a_block_that_is_lifted_leaves_the_face_and_comes_down_on_it_again() {
    let rows = [(0.0, [0.0; 2]), (0.5, [0.0; 2]), (1.0, [0.0, 2e-3]), (1.5, [0.0; 2])];
    let mut scene = gripped(rough(0.5), None, &rows);
    let weight = weight(&scene);
    let mut lay = 0.0;
    scene.march(0.05, 1.5, |_, accepted| {
        let push = accepted.report.reactions[0][1];
        let held = accepted.report.strips[0].force[1];
        let found = of(accepted);
        let full = (accepted.t / RAMP).min(1.0) * weight;
        assert!(
            (push + held - full).abs() < 1e-4 * weight && push >= 0.0,
            "{push} + {held} of {full}"
        );
        match accepted.t {
            t if t < 0.51 => lay = push,
            t if t < 1.46 => {
                assert!(push == 0.0 && found.closed == 0.0);
                // As high as the strip, but for what the block stretches by as it hangs: 2.5e-4 of its height.
                let risen = 2e-3 * (1.0 - (t - 1.0).abs() / 0.5);
                assert!(
                    (found.gap[0] - risen).abs() < 2.5e-4 && found.gap[1] - found.gap[0] < 2e-5,
                    "{found:?}"
                );
            }
            _ => assert!(
                (push / lay - 1.0).abs() < 0.1 && found.gap == [0.0; 2],
                "{push} of {lay}, {found:?}"
            ),
        }
    });
}

#[test]
fn a_face_that_does_not_let_go_pulls() {
    let rows = [(0.0, [0.0; 2]), (0.5, [0.0; 2]), (1.0, [0.0, 2e-3])];
    let (_, steps) = gripped(
        Contact {
            lifts: false,
            ..rough(0.5)
        },
        None,
        &rows,
    )
    .solved(0.1, 1.0);
    let last = &steps.last().expect("steps").report;
    assert!(
        last.reactions[0][1] < -4e4 && last.reactions[0][0].abs() < 1e-6,
        "{:?}",
        last.reactions
    );
    assert!(last.contacts[0].closed == 1.0 && last.contacts[0].gap == [0.0; 2]);
}

/// Pushed at its top to both sides, a block lifts its heel and sets it down again.
#[test]
fn a_block_that_rocks_comes_to_lie_on_all_of_its_base() {
    let rows = [
        (0.0, [0.0; 2]),
        (0.2, [0.0; 2]),
        (0.5, [1e-3, 0.0]),
        (1.0, [-1e-3, 0.0]),
        (1.25, [0.0; 2]),
    ];
    let mut scene = gripped(rough(1.0), Some([1.0, 0.0].into()), &rows);
    let weight = weight(&scene);
    let mut closed = Vec::new();
    scene.march(0.025, 1.25, |_, accepted| {
        closed.push(of(accepted).closed);
        let full = (accepted.t / RAMP).min(1.0) * weight;
        assert!((accepted.report.reactions[0][1] - full).abs() < 1e-4 * weight);
    });
    assert!(
        closed[19] < 0.8 && closed[39] < 0.8 && closed[29] == 1.0 && closed[49] == 1.0,
        "{closed:?}"
    );
    assert!(mean(&scene.points, |p| scene.points.u[p][1]).abs() < 2e-5);
}
