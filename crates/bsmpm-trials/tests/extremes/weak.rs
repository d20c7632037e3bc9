//! Tests of cohesionless soil, of layers with very different stiffness and of very large or small gravity.

use crate::physics::scene::{Scene, axis, by_id, hencky};
use crate::scenes::{Collapse, RODS, Soil, layers};
use crate::solver::Run;
use crate::support::results::steps;
use crate::table::Found;
use bsmpm::boundary::Support;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use std::sync::Arc;

/// A cohesionless column between smooth walls under its weight: error of the reaction of its base.
pub fn resting(poisson: f64) -> Found {
    let law = format!("model = \"mohr-coulomb\"\nfriction_angle = 30.0\ncohesion = 0.0\npoisson = {poisson}");
    let text = layers(&[(1e7, 2e3, 8.0)], "", 5, 9.81).replace("model = \"elastic\"", &law);
    let text = text.replacen("poisson = 0.3\n", "", 1);
    let weight = 2e3 * 9.81 * 16.0;
    let run = Run::of(&text, 1, &[]);
    run.found(|run| Found::Figure((run.last("reaction-y") / weight - 1.0).abs(), run.effort()))
}

/// Change of the runout at `end` if the rods have a cohesion of 1e-3 gamma H.
pub fn little_cohesion(end: f64) -> Found {
    let runout = |cohesion: f64| {
        let soil = Soil { cohesion, ..RODS };
        Run::of(
            &Collapse {
                soil,
                end,
                ..Collapse::default()
            }
            .text(),
            1,
            &[],
        )
    };
    let reference = runout(0.0).last("runout");
    runout(1e-3 * 20.4e3 * 0.1).found(|run| (run.last("runout") / reference - 1.0).abs())
}

/// The beginning of the collapse, 20 steps, with this Poisson's ratio: change of the largest displacement with steps of
/// half the length.
pub fn beginning(poisson: f64, friction: f64, method: &'static str) -> Found {
    let soil = Soil {
        poisson,
        friction,
        ..RODS
    };
    let run = |dt: f64| {
        Run::of(
            &Collapse {
                soil,
                method,
                end: 0.01,
                dt,
                ..Collapse::default()
            }
            .text(),
            1,
            &[],
        )
    };
    let coarse = run(0.5e-3);
    let fine = run(0.25e-3);
    coarse.found(|coarse| {
        let change = |fine: &Run| (coarse.last("max-displacement") / fine.last("max-displacement") - 1.0).abs();
        fine.found(|fine| Found::Figure(change(fine), coarse.effort()))
    })
}

/// Four metres of soil on four metres `contrast` times as stiff.
fn contrast(contrast: f64, is_airy: bool) -> (Arc<Run>, f64) {
    let soil = (1e6, 2e3, 4.0);
    let air = (1e3, 1.0, 2.0);
    let stack = [(1e6 * contrast, 2e3, 4.0), soil, air];
    let stack = if is_airy { &stack[..] } else { &stack[..2] };
    let weight: f64 = stack
        .iter()
        .map(|(_, density, height)| density * height * 2.0 * 9.81)
        .sum();
    (
        Run::of(&layers(stack, "[solver]\nforce_tolerance = 1e-8\n", 5, 9.81), 2, &[]),
        weight,
    )
}

/// Error of the reaction of the base below layers of that contrast, with another layer 1e-3 as stiff as the soil on
/// top.
pub fn weight(ratio: f64, is_airy: bool) -> Found {
    let (run, weight) = contrast(ratio, is_airy);
    run.found(|run| Found::Figure((run.last("reaction-y") / weight - 1.0).abs(), run.effort()))
}

/// Largest force measure of an accepted step below layers of that contrast; the tolerance is 1e-8, round-off of the
/// stiff layer may be more.
pub fn balance(ratio: f64) -> Found {
    let (run, _) = contrast(ratio, false);
    run.found(|run| {
        let residuals = steps(&run.directory()).get("residual").expect("residuals").to_vec();
        Found::Figure(residuals.into_iter().fold(0.0, f64::max), run.effort())
    })
}

/// Largest error of the vertical stress of points in the two cells at the interface, over the stress there.
pub fn interface(ratio: f64) -> Found {
    let (run, _) = contrast(ratio, false);
    run.found(|run| {
        let frame = run.frame();
        let stress = frame.real("stress", 6).expect("stress");
        let moved = frame.real("displacement", 3).expect("u");
        let above = |depth: f64| 2e3 * 9.81 * depth;
        let near = frame.position.iter().enumerate().filter_map(|(p, x)| {
            let depth = 8.0 - (x[1] - moved[3 * p + 1]);
            ((depth - 4.0).abs() < 1.0).then(|| (stress[6 * p + 1] + above(depth)).abs() / above(4.0))
        });
        Found::Figure(near.fold(0.0, f64::max), run.effort())
    })
}

/// Displacement over size and stress over E of a block that settles, by id.
fn settled(gravity: f64, young: f64) -> Vec<f64> {
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(0.5, 5, 2), axis(0.5, 4, 2)],
        hencky(young, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..3, 0..3], 3, 1.0, |x| x * 0.0)
    .support(Support::roller(0, false))
    .support(Support::fixed(1, false))
    .gravity(gravity, 2.0);
    scene.march(1.0, 2.0, |_, _| ());
    let points = &scene.points;
    let row = |p: usize| {
        points.u[p]
            .iter()
            .copied()
            .chain(points.sigma.at(p).0.map(|s| s / young))
            .collect::<Vec<_>>()
    };
    by_id(points).into_iter().flat_map(row).collect()
}

/// Largest difference when gravity and stiffness are `factor` times as large, over the largest displacement.
pub fn scaled_gravity(factor: f64) -> f64 {
    let reference = settled(2.0, 100.0);
    let scaled = settled(2.0 * factor, 100.0 * factor);
    let size = reference.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    reference
        .iter()
        .zip(&scaled)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
        / size
}

/// A column under gravity x 1e3 that would be shortened to a third: error of the reaction of its base.
pub fn heavy() -> Found {
    let run = Run::of(&layers(&[(1e7, 2e3, 8.0)], "", 5, 9.81e3 / 16.0), 1, &[]);
    let weight = 2e3 * 9.81e3 / 16.0 * 16.0;
    run.found(|run| Found::Figure((run.last("reaction-y") / weight - 1.0).abs(), run.effort()))
}
