//! Tests of rigid bodies that move freely.

use super::{G, RAMP, ground, inclined, last, slab};
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::method::Nonlinear;
use bsmpm::model::Regime;
use bsmpm::tensor::Vector;

/// A rectangle that moves freely.
fn free(lower: [f64; 2], upper: [f64; 2], mass: f64) -> RigidBody {
    let polar = mass * ((upper[0] - lower[0]).powi(2) + (upper[1] - lower[1]).powi(2)) / 12.0;
    RigidBody {
        free: [true; 3],
        mass: [mass, mass, polar].into(),
        ..slab(lower, upper)
    }
}

/// A footing that moves freely under a load beside its middle: what acts on it is what it gives on, and where the load
/// is beyond a sixth of its width it lifts.
#[test]
fn a_free_footing_lifts_under_an_eccentric_load() {
    let footing = RigidBody {
        friction: 0.5,
        ..free([1.5, 1.0], [2.5, 1.25], 0.0)
    };
    let turned = [0.05, 0.1, 0.3].map(|eccentricity| {
        let load = vec![(1.0, Vector::<3>::new(0.0, -1e4, -1e4 * eccentricity))];
        let body = RigidBody {
            load,
            ..footing.clone()
        };
        let mut scene = ground(0.125, [32, 8], 4, Regime::QuasiStatic).rigid(body);
        let found = last(&mut scene, 0.25, 1.0);
        println!("{eccentricity}: {found:?}");
        let off = found.force - Vector::<3>::new(0.0, 1e4, 1e4 * eccentricity);
        assert!(
            off.norm() < 1e-6 * 1e4 && found.moved[2] < 0.0 && found.moved[1] < 0.0,
            "{found:?}"
        );
        found.moved[2]
    });
    println!("{turned:?}");
    // measured 2.00; 3.25, where a bilateral hold has 3
    assert!((turned[1] / turned[0] - 2.0).abs() < 0.02 && turned[2] / turned[1] > 3.1);
}

/// Velocity that a step gives a body beyond that of what acts on it (m/s2 at its start and end), by the mean of both
/// or, in a blow and after it, by the end's.
fn beyond(gained: f64, dt: f64, [start, end]: [f64; 2]) -> f64 {
    let [mean, blow] = [0.5 * (start + end), end].map(|acts| (gained - acts * dt).abs());
    mean.min(blow)
}

/// A block falls, meets ground and leaves it: its momentum is what the ground and gravity gave it, to round-off.
#[test]
fn a_free_block_falls_and_bounces() {
    let mass = 500.0;
    for method in [Nonlinear::Auto, Nonlinear::Newton] {
        let mut scene = ground(0.25, [8, 4], 4, Regime::Dynamic).rigid(free([0.75, 1.05], [1.25, 1.55], mass));
        scene = scene.gravity(G, 0.0);
        scene.model.nonlinear = method;
        let mut before = [0.0, -G];
        let mut touches = false;
        let mut leaves = false;
        let mut worst = 0.0_f64;
        scene.march(0.004, 0.26, |_, accepted| {
            let now = accepted.report.rigid[0];
            let acts = now.force[1] / mass - G;
            worst = worst.max(beyond(now.velocity[1] - before[0], accepted.dt, [before[1], acts]));
            before = [now.velocity[1], acts];
            assert!(worst < 1e-10 && now.force[1] >= 0.0);
            if !touches && now.gap > 0.02 {
                let fallen = 0.5 * G * accepted.t.powi(2);
                assert!((now.moved[1] + fallen).abs() < 1e-12, "it falls freely");
            }
            touches |= now.touched > 0;
            leaves |= touches && now.touched == 0 && now.velocity[1] > 0.3;
            assert!(now.moved[2].abs() < 1e-9 && now.moved[0].abs() < 1e-9, "upright");
        });
        println!("{method:?}: velocity of a step off by {worst:.1e} m/s");
        assert!(touches && leaves, "{method:?}");
    }
}

/// A free rigid block slides on soft ground, at last as fast as Coulomb says.
#[test]
fn a_rigid_block_slides_on_soil() {
    let theta = 0.5_f64.atan();
    let mass = 200.0;
    let body = RigidBody {
        friction: 0.3,
        ..free([0.5, 1.0], [1.5, 1.25], mass)
    };
    let mut scene = ground(0.25, [16, 4], 2, Regime::Dynamic).rigid(body);
    scene.model.gravity = Some(inclined(0.5));
    let mut before = [Vector::<2>::zeros(); 2];
    let mut velocity = 0.0;
    let mut cuts = 0;
    scene.march(0.01, 0.5, |_, accepted| {
        let now = accepted.report.rigid[0];
        let weight = Vector::<2>::new(theta.sin(), -theta.cos()) * (mass * G * (accepted.t / RAMP).min(1.0));
        let moves = now.velocity.fixed_rows::<2>(0).into_owned();
        let acts = now.force.fixed_rows::<2>(0) + weight;
        for k in 0..2 {
            let off = beyond(
                moves[k] - before[0][k],
                accepted.dt,
                [before[1][k] / mass, acts[k] / mass],
            );
            assert!(off < 1e-10, "{off}");
        }
        before = [moves, acts];
        (velocity, cuts) = (now.velocity[0], cuts + accepted.rejected.len());
    });
    let exact = G * (theta.sin() - 0.3 * theta.cos()) * (0.5 - 0.5 * RAMP);
    println!("{:.4} of it, {cuts} cuts", velocity / exact);
    // measured 0.9998; without correcting statuses one by one 22 cuts
    assert!((velocity / exact - 1.0).abs() < 0.005 && cuts == 0);
}
