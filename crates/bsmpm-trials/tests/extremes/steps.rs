//! Tests of tiny, huge and idle steps.

use crate::physics::random::Random;
use crate::physics::scene::{Scene, axis, hencky};
use crate::scenes::{Collapse, Footing, block, layers};
use crate::solver::Run;
use crate::table::Found;
use bsmpm::boundary::Support;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use bsmpm::parallel::Alone;
use bsmpm::points::Points;
use bsmpm::solve::broyden::Broyden;
use bsmpm::stabilisation::Stabilisation;
use std::f64::consts::PI;

const LENGTH: f64 = 25.0;
pub const PERIOD: f64 = 10.0;
/// m/s  largest velocity of the bar
const SPEED: f64 = 0.01;

/// An axial bar, fixed at x = 0, E 100, rho 1, nu 0, with a quarter sine of velocity: its period is 10 s.
pub fn bar() -> Scene<PlaneStrain, 2> {
    let h = LENGTH / 20.0;
    let velocity = |x: f64| SPEED * (PI * x / (2.0 * LENGTH)).sin();
    let mut scene = Scene::new([axis(h, 24, 2), axis(h, 1, 2)], hencky(100.0, 0.0), Regime::Dynamic)
        .body([0..20, 0..1], 3, 1.0, |x| [velocity(x[0]), 0.0].into())
        .support(Support::moving(0, false, [Some(0.0), None]))
        .rollers([1]);
    scene.model.criteria.force = 1e-9;
    scene
}

/// Kinetic and elastic energy of the bar's points.
pub fn energy(points: &Points<2>) -> f64 {
    let v = &points.motion.as_ref().expect("dynamic").v;
    let of = |p: usize| {
        let b = points.b_e.at(p).full().symmetric_eigenvalues();
        let squares: f64 = b.iter().map(|b| (0.5 * b.ln()).powi(2)).sum();
        0.5 * points.mass[p] * v[p].norm_squared() + 50.0 * points.volume[p] * squares
    };
    (0..points.len()).map(of).sum()
}

/// The bar over 1000 steps of `dt` s: relative change of its energy.
pub fn tiny(dt: f64) -> Found {
    let mut scene = bar();
    let start = energy(&scene.points);
    let mut iterations = 0;
    scene.march(dt, 1000.0 * dt, |_, accepted| iterations += accepted.counts.iterations);
    Found::Figure(
        (energy(&scene.points) / start - 1.0).abs(),
        format!("{iterations} iterations"),
    )
}

/// The bar as it flies freely, 1000 steps of `dt` s: largest acceleration of a point, which should have none, over the
/// amplitude of the acceleration that the held bar has at the same speed.
pub fn acceleration_noise(dt: f64) -> f64 {
    let mut scene = bar();
    scene.model.boundary.supports.remove(0);
    scene
        .points
        .motion
        .as_mut()
        .expect("dynamic")
        .v
        .fill([SPEED, 0.0].into());
    let mut noise = 0.0_f64;
    scene.march(dt, 1000.0 * dt, |points, _| {
        let a = &points.motion.as_ref().expect("dynamic").a;
        noise = a.iter().map(|a| a.norm()).fold(noise, f64::max);
    });
    noise / (2.0 * PI / PERIOD * SPEED)
}

fn settling(regime: Regime, method: Stabilisation) -> Scene<PlaneStrain, 2> {
    Scene::new([axis(0.5, 5, 2), axis(0.5, 4, 2)], hencky(100.0, 0.3), regime)
        .body([0..3, 0..3], 3, 1.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(Support::fixed(1, false))
        .gravity(2.0, 0.0)
        .stabilised(method)
}

/// A block that settles in one dynamic step of `dt` s: distance from the static state, over its largest displacement.
pub fn huge(dt: f64) -> f64 {
    let of = |method| {
        let still = settling(Regime::QuasiStatic, method).solved(1.0, 1.0).0;
        let found = settling(Regime::Dynamic, method).solved(dt, dt).0;
        let size = still.points.u.iter().map(|u| u.norm()).fold(0.0, f64::max);
        still
            .points
            .u
            .iter()
            .zip(&found.points.u)
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max)
            / size
    };
    [Stabilisation::None, Stabilisation::FBar]
        .into_iter()
        .map(of)
        .fold(0.0, f64::max)
}

/// 200 dynamic steps of `dt` s: largest distance from the static state over the last 100 steps, over that of the first
/// 100 but for the first step. The trapezoidal rule keeps ringing; it must not ring louder.
pub fn ringing(dt: f64) -> Found {
    let still = settling(Regime::QuasiStatic, Stabilisation::None)
        .solved(1.0, 1.0)
        .0
        .points;
    let size = still.u.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let mut away = Vec::new();
    settling(Regime::Dynamic, Stabilisation::None).march(dt, 200.0 * dt, |points, _| {
        let distance =
            |p: usize| (points.u[p] - still.u[still.id.iter().position(|&id| id == points.id[p]).unwrap()]).norm();
        away.push((0..points.len()).map(distance).fold(0.0, f64::max) / size);
    });
    let most = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
    let before = most(&away[1..100]);
    let after = most(&away[100..]);
    // Below this it is round-off that rings.
    Found::Figure(
        after / before.max(1e-10),
        format!("{before:.1e}, then {after:.1e} of the settlement"),
    )
}

/// Where the farthest points of the collapse start, m: half a spacing of 5 mm within its face at 0.2 m.
const FARTHEST: f64 = 0.1975;

/// The collapse with steps of `dt` s: error of the way of its front at `end`, over that with 0.5 ms.
pub fn collapse(dt: f64, end: f64) -> Found {
    let run = |dt: f64| {
        Run::of(
            &Collapse {
                end,
                dt,
                ..Collapse::default()
            }
            .text(),
            1,
            &[],
        )
    };
    let way = |run: &Run| run.last("runout") - FARTHEST;
    let reference = way(&run(0.5e-3));
    let run = run(dt);
    let error = (way(&run) / reference - 1.0).abs();
    let advance = run
        .manifest()
        .indicators
        .remove("step-advance")
        .filter(|indicator| indicator.unusual);
    match advance {
        Some(reported) => Found::Warned(
            if reported.failed { 82 } else { 0 },
            format!(
                "step-advance is {:.2}: {}; figure {error:.3}",
                reported.value, reported.meaning
            ),
        ),
        None => run.found(|run| Found::Figure(error, run.effort())),
    }
}

/// Broyden's update with steps of no length and with more steps than it keeps: non-finite numbers in its directions.
pub fn degenerate_broyden() -> f64 {
    let halo = Alone { nodes: 10 };
    let mut random = Random::new(22);
    let mut broyden = Broyden::default();
    let mut broken = 0;
    for k in 0..250 {
        let w = if k % 7 == 3 { vec![0.0; 20] } else { random.array(20) };
        broken += broyden.correct::<2>(w, &halo).iter().filter(|x| !x.is_finite()).count();
        broyden.took(if k % 5 == 4 { 0.0 } else { 1.0 });
    }
    broken as f64
}

/// The footing on nearly incompressible clay by Broyden's update, with more iterations than it keeps: p/c at z/B = 0.1.
pub fn long_broyden() -> Found {
    let text = Footing {
        poisson: 0.4999,
        solver: "nonlinear = \"broyden\"",
        ..Footing::default()
    }
    .text();
    Run::of(&text, 1, &[]).found(|run| Found::Figure(Footing::factor(run.last("pressure")), run.effort()))
}

/// A footing by Broyden's update to the last digit that round-off leaves: iterations beyond that must be refused or
/// end.
pub fn beyond_round_off() -> Found {
    let solver = "nonlinear = \"broyden\"\ntolerance = 1e-30\nforce_tolerance = 1e-15";
    let text = Footing {
        solver,
        steps: 2,
        depth: 1e-3,
        ..Footing::default()
    }
    .text();
    Run::of(&text, 1, &[]).found(|run| Footing::factor(run.last("pressure")))
}

/// Nothing acts: iterations of ten steps and the largest displacement, quasi-static and dynamic.
pub fn no_load(is_dynamic: bool) -> Found {
    let text = layers(&[(1e7, 2e3, 4.0)], "", 10, 9.81);
    let text = text.replacen("acceleration = [0.0, -9.81]", "acceleration = [0.0, 0.0]", 1);
    let text = if is_dynamic {
        text.replacen("quasi-static", "dynamic", 1)
            .replacen("steps = 10", "end = 1.0\ndt = 0.1", 1)
    } else {
        text
    };
    Run::of(&text, 1, &[]).found(|run| {
        assert_eq!(run.last("max-displacement"), 0.0);
        run.manifest().summary.iterations as f64
    })
}

/// A state that is in equilibrium already, held for ten more steps: iterations per step.
pub fn in_equilibrium() -> Found {
    let text = layers(&[(1e7, 2e3, 4.0)], "[initial]\ngravity = \"elastic\"\n", 10, 9.81);
    let text = text.replacen("ramp = 1.0", "ramp = 0.0", 1);
    Run::of(&text, 1, &[]).found(|run| {
        let moved = run.last("max-displacement");
        Found::Figure(
            run.manifest().summary.iterations as f64 / 10.0,
            format!("moved by {moved:.1e} m"),
        )
    })
}

/// A block that flies with 1e-310 m/s: residual evaluations of 200 steps over those with 1 m/s.
pub fn denormal() -> Found {
    let run = |speed: f64| Run::of(&block([speed, 0.0], 200, ""), 1, &[]);
    let usual = run(1.0);
    let tiny = run(1e-310);
    tiny.found(|tiny| {
        let cost = |run: &Run| run.manifest().summary.residual_evaluations as f64;
        let seconds = |run: &Run| run.manifest().timers.get("wall").copied().unwrap_or(f64::NAN);
        Found::Figure(
            cost(tiny) / cost(&usual),
            format!("time x {:.2}", seconds(tiny) / seconds(&usual)),
        )
    })
}
