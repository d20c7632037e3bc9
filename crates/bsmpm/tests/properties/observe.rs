//! Tests of history quantities on fields with a known answer.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::interactions::coulomb::Contact;
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::{AverageWeight, Regime};
use bsmpm::observe::projection::projected_pressure;
use bsmpm::observe::{Part, angular_momentum, centre_of_mass, heave, kinetic_energy, mean_stress, mean_velocity};
use bsmpm::observe::{farthest, front, is_occupied, mass, momentum, nearest, noise::stress_noise, percentile};
use bsmpm::tensor::{Symmetric, Vector};

/// A block of 4^D cells, one cell off the lower corner.
fn block<K: Kinematics<D>, const D: usize>(order: usize) -> Scene<K, D> {
    Scene::new(
        std::array::from_fn(|_| axis(0.5, 6, order)),
        hencky(1.0, 0.3),
        Regime::QuasiStatic,
    )
    .body(std::array::from_fn(|_| 1..5), 2, 3.0, |x| x * 0.0)
}

fn noise_of_a_linear_field<K: Kinematics<D>, const D: usize>() -> (f64, f64) {
    let mut scene = block::<K, D>(2);
    let field = |x: &Vector<D>| 1.0 + x.iter().enumerate().map(|(k, x)| (k as f64 + 0.3) * x).sum::<f64>();
    let points = &mut scene.points;
    let stress = |yy: f64| Symmetric([0.0, yy, 0.0, 0.0, 0.0, 0.0]);
    (0..points.len()).for_each(|p| points.sigma.set(p, stress(field(&points.x[p]))));
    let linear = stress_noise(&scene.model.grid, &scene.points, AverageWeight::Mass, 1, &scene.halo()).unwrap();
    scene.points.sigma.fill(stress(-7.1));
    let uniform = stress_noise(
        &scene.model.grid,
        &scene.points,
        AverageWeight::Volume,
        1,
        &scene.halo(),
    )
    .unwrap();
    (linear.about_plane, uniform.about_average.max(uniform.about_plane))
}

#[test]
fn a_linear_stress_has_no_noise_about_planes_and_a_uniform_one_none_at_all() {
    for (linear, uniform) in [
        noise_of_a_linear_field::<PlaneStrain, 2>(),
        noise_of_a_linear_field::<Solid, 3>(),
    ] {
        println!("linear about planes {linear:.1e}, uniform {uniform:.1e}");
        assert!(linear <= 1e-13 && uniform <= 1e-13); // measured 5.3e-16, 4.7e-15
    }
}

/// A pressure that is uniform stays as it is, whatever the points weigh; of one that changes its sign from point to
/// point nothing is left but at the corners.
#[test]
fn the_projected_pressure_keeps_what_is_uniform_and_damps_what_alternates() {
    let mut scene = block::<PlaneStrain, 2>(2);
    let signs: Vec<f64> = scene
        .points
        .x
        .iter()
        .map(|x| {
            if (4.0 * x.sum()).round() % 2.0 == 0.0 {
                1.0
            } else {
                -1.0
            }
        })
        .collect();
    let [mut uniform, mut alternating] = [0.0_f64; 2];
    for (p, sign) in signs.iter().enumerate() {
        scene.points.volume[p] *= if *sign > 0.0 { 1.0 } else { 0.5 };
        scene.points.sigma.set(p, Symmetric([3.0, 5.0, 4.0, 1.0, 0.0, 0.0]));
    }
    for pressure in projected_pressure(&scene.model, &scene.points, &scene.halo()).unwrap() {
        uniform = uniform.max((pressure + 4.0).abs());
    }
    assert!(uniform <= 1e-14, "{uniform}");
    for (p, sign) in signs.iter().enumerate() {
        scene.points.volume[p] = 1.0;
        scene
            .points
            .sigma
            .set(p, Symmetric([*sign, *sign, *sign, 0.0, 0.0, 0.0]));
    }
    for pressure in projected_pressure(&scene.model, &scene.points, &scene.halo()).unwrap() {
        alternating = alternating.max(pressure.abs());
    }
    println!("left of 1: {alternating}");
    // At a corner 0.75 x 0.75 of a function whose own mean is 1/4: 0.141; elsewhere nothing.
    assert!(alternating <= 0.15 && signs.contains(&1.0) && signs.contains(&-1.0));
}

#[test]
fn numbers_of_a_known_block() {
    let scene = block::<PlaneStrain, 2>(2);
    let points = &scene.points;
    let halo = scene.halo();
    assert!((mass(points, &Part::Whole, &halo) - 3.0 * 4.0).abs() <= 1e-14);
    assert_eq!(farthest(points, &Part::Whole, 0, &halo), 2.375);
    assert_eq!(front(&scene.model, points, &halo), 2.375);
    assert!((percentile(points, &Part::Whole, 1, 50.0, &halo) - 1.375).abs() <= 1e-12); // half of the rows lie below and on it
    let id = nearest(points, &[0.7, 0.6].into(), |_| true, &halo).unwrap();
    let found = points.id.iter().position(|&other| other == id).unwrap();
    assert_eq!(points.x[found], Vector::from([0.625, 0.625]));
}

#[test]
fn totals_are_those_of_a_material_or_of_all() {
    let center = Vector::from([1.5, 1.5]);
    let spin = |x: &Vector<2>| Vector::from([2.0 - 3.0 * (x[1] - 1.5), 3.0 * (x[0] - 1.5)]);
    let axes = [axis(0.5, 6, 2), axis(0.5, 6, 2)];
    let right = |x: &Vector<2>| x[0] > 1.5;
    let scene = Scene::<PlaneStrain, 2>::new(axes, hencky(1.0, 0.3), Regime::Dynamic)
        .body([1..5, 1..5], 2, 3.0, spin)
        .with(hencky(1.0, 0.3), right);
    let points = &scene.points;
    let halo = scene.halo();
    let of = |part: &Part| {
        let middle = centre_of_mass(points, part, &halo).unwrap();
        let p = momentum(points, part, &halo);
        let spin = angular_momentum(points, part, &middle, &halo)[2];
        (mass(points, part, &halo), middle, p, spin)
    };
    // A rectangle of a x b cells of points has m (a^2 + b^2 - 2/n^2)/12 about its middle, its points at theirs.
    let inertia = |m: f64, a: f64, b: f64| m * (a * a + b * b - 2.0 * 0.25_f64.powi(2)) / 12.0;
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12, "{a} for {b}");
    let parts = [
        (Part::Whole, 12.0, 1.5, 2.0),
        (Part::Material(0), 6.0, 1.0, 1.0),
        (Part::Material(1), 6.0, 2.0, 1.0),
        // Ids count column by column.
        (Part::Ids(0..32), 6.0, 1.0, 1.0),
        (Part::Ids(32..64), 6.0, 2.0, 1.0),
        (
            Part::Within(Box::new(Part::Whole), [[1.5, 0.0, 0.0], [9.0, 9.0, 0.0]]),
            6.0,
            2.0,
            1.0,
        ),
    ];
    for (part, m, x, a) in &parts {
        let m = *m;
        let x = *x;
        let a = *a;
        let (mass, middle, p, spin) = of(part);
        close(mass, m);
        close((middle - Vector::from([x, 1.5])).norm(), 0.0);
        close((p - Vector::from([2.0 * m, 3.0 * (x - 1.5) * m])).norm(), 0.0);
        close((mean_velocity(points, part, &halo) - p / m).norm(), 0.0);
        close(spin, 3.0 * inertia(m, a, 2.0));
        // About another place the momentum has an arm.
        let about = angular_momentum(points, part, &center, &halo)[2];
        close(about, spin + (middle - center).perp(&p));
        // By Koenig, with the rotation of 3 rad/s about the middle.
        close(
            kinetic_energy(points, part, &halo),
            0.5 * (p.norm_squared() / m + 3.0 * spin),
        );
        // The farthest point is half a spacing within.
        close(farthest(points, part, 0, &halo), x + 0.5 * a - 0.125);
        close(percentile(points, part, 0, 50.0, &halo), x - 0.125);
        close(heave(points, part, &halo), 0.0);
    }
    let nowhere = Part::Within(Box::new(Part::Material(1)), [[0.0; 3], [1.5, 9.0, 0.0]]);
    assert_eq!(centre_of_mass(points, &Part::Material(2), &halo), None);
    assert!(centre_of_mass(points, &nowhere, &halo).is_none() && !is_occupied(points, &nowhere, &halo));
    assert_eq!(mean_stress(points, &Part::Ids(64..99), &halo), [0.0; 6]);
}

/// A column that rests against a wall in contact on a base that is fixed: the wall has what it has beside a roller.
#[test]
fn a_wall_in_contact_has_the_thrust_of_the_edge_that_a_fixed_base_holds() {
    let thrust = |wall: Support<2>| {
        let (_, steps) = Scene::<PlaneStrain, 2>::new(
            [axis(0.5, 2, 2), axis(0.5, 4, 2)],
            hencky(1e4, 0.3),
            Regime::QuasiStatic,
        )
        .body([0..2, 0..4], 2, 2.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(wall)
        .support(Support::fixed(1, false))
        .gravity(1.0, 0.0)
        .solved(1.0, 1.0);
        steps[0].report.reactions[1][0]
    };
    let contact = Contact {
        friction: 0.0,
        lifts: true,
    };
    let rolls = thrust(Support::roller(0, true));
    let touches = thrust(Support::contact(0, true, contact));
    println!("{rolls} and {touches}");
    assert!(rolls < 0.0 && (touches / rolls - 1.0).abs() < 1e-6);
}

#[test]
fn reactions_sum_to_the_weight_also_where_two_supports_hold_the_same_node() {
    let (_, steps) = Scene::<PlaneStrain, 2>::new(
        [axis(0.5, 4, 2), axis(0.5, 4, 2)],
        hencky(100.0, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..3, 0..3], 2, 2.0, |x| x * 0.0)
    .support(Support::fixed(0, false))
    .support(Support::fixed(1, false))
    .gravity(1.0, 0.0)
    .solved(1.0, 1.0);
    let reactions = &steps[0].report.reactions;
    let sideways = reactions[0][0] + reactions[1][0];
    let upwards = reactions[0][1] + reactions[1][1];
    println!("reactions {reactions:?}, weight {}", 2.0 * 2.25);
    assert!(sideways.abs() <= 1e-9 && (upwards / (2.0 * 2.25) - 1.0).abs() <= 1e-9);
}
