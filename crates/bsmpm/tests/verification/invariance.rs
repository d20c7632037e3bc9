//! Tests that results do not depend on mirroring, axes, position and units, and depend little on the artificial
//! stiffness.

use crate::support::scene::{METHODS, Scene, axis, by_id, hencky};
use bsmpm::boundary::Support;
use bsmpm::grid::KnotVector;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Elastic, Material, MohrCoulomb, Separation};
use bsmpm::model::{Gravity, Regime};
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

/// Per id: position, velocity and stress, as numbers.
fn rows(points: &Points<2>) -> Vec<Vec<f64>> {
    let row = |p: usize| {
        let mut row = points.x[p].as_slice().to_vec();
        row.extend(points.motion.iter().flat_map(|motion| motion.v[p].as_slice().to_vec()));
        row.extend(points.sigma.at(p).0);
        row
    };
    by_id(points).into_iter().map(row).collect()
}

/// A soft block thrown at a wall, under gravity, on a base that it sticks to; `mirror` lets everything face right.
fn thrown(mirror: bool, method: Stabilisation) -> Scene<PlaneStrain, 2> {
    let sign = if mirror { -1.0 } else { 1.0 };
    let cells = if mirror { 3..6 } else { 2..5 };
    let mut scene = Scene::new([axis(0.5, 8, 2), axis(0.5, 5, 2)], hencky(100.0, 0.3), Regime::Dynamic)
        .body([cells, 0..3], 2, 1.0, |_| [-0.8 * sign, 0.1].into())
        .support(Support::roller(0, mirror))
        .support(Support::fixed(1, false))
        .gravity(2.0, 0.0)
        .stabilised(method);
    scene.points.x.iter_mut().for_each(|x| x[0] -= 0.05 * sign);
    scene.points.sort_by_cell(&scene.model.grid);
    scene
}

/// Invariance: reflection of the axes.
#[test]
fn a_mirrored_case_has_the_mirrored_result() {
    // Extreme N15: <= 1e-10 after 100 elastic steps.
    for method in METHODS {
        let run = |mirror| thrown(mirror, method).solved(0.01, 1.0).0.points;
        let left = run(false);
        let right = run(true);
        let mirrored = |x: &Vector<2>| Vector::<2>::new(4.0 - x[0], x[1]);
        let mut worst = 0.0_f64;
        for (x, sigma) in right.x.iter().zip(right.sigma.iter()) {
            let partner = (0..left.len())
                .min_by(|&a, &b| {
                    (mirrored(x) - left.x[a])
                        .norm()
                        .total_cmp(&(mirrored(x) - left.x[b]).norm())
                })
                .unwrap();
            worst = worst.max((mirrored(x) - left.x[partner]).amax());
            for (k, sign) in [1.0, 1.0, 1.0, -1.0].iter().enumerate() {
                worst = worst.max((sigma.0[k] - sign * left.sigma.at(partner).0[k]).abs() / 100.0);
            }
        }
        println!("{method:?}: worst difference {worst:.1e} (m, E)");
        assert!(worst <= 1e-10); // measured 5e-15
    }
}

/// Invariance: exchange of the axes.
#[test]
fn exchanged_axes_give_the_exchanged_result() {
    let scene = |exchanged: bool, method| {
        let swap = |pair: [f64; 2]| Vector::<2>::from(if exchanged { [pair[1], pair[0]] } else { pair });
        let axes = [axis(0.5, 8, 2), axis(0.5, 5, 2)];
        let cells = [2..5, 0..3];
        let (axes, cells) = if exchanged {
            let [x, y] = axes;
            let [i, j] = cells;
            ([y, x], [j, i])
        } else {
            (axes, cells)
        };
        let other = usize::from(exchanged);
        let mut scene = Scene::<PlaneStrain, 2>::new(axes, hencky(100.0, 0.3), Regime::Dynamic)
            .body(cells, 2, 1.0, |_| swap([-0.8, 0.1]))
            .support(Support::roller(other, false))
            .support(Support::fixed(1 - other, false))
            .stabilised(method);
        scene.model.gravity = Some(Gravity {
            acceleration: swap([0.0, -2.0]),
            ramp: 0.0,
            starts_vertical: false,
        });
        scene.solved(0.01, 0.5).0.points
    };
    for method in METHODS {
        let upright = scene(false, method);
        let lying = scene(true, method);
        let worst = upright.x.iter().map(|x| {
            let exchanged = Vector::<2>::new(x[1], x[0]);
            lying
                .x
                .iter()
                .map(|y| (y - exchanged).amax())
                .fold(f64::INFINITY, f64::min)
        });
        let worst = worst.fold(0.0, f64::max);
        println!("{method:?}: worst difference {worst:.1e} m");
        assert!(worst <= 1e-10);
    }
}

#[test]
fn the_origin_of_the_axes_does_not_matter_and_neither_do_whole_cells() {
    // Extreme N14: positions are relative to the grid's corner.
    let run = |origin: f64, shift: usize| {
        let breakpoints: Vec<f64> = (0..=14).map(|i| origin + f64::from(i) * 0.5).collect();
        let knots = KnotVector::graded(&breakpoints, 2).unwrap();
        let scene = Scene::<PlaneStrain, 2>::new([knots, axis(0.5, 5, 2)], hencky(100.0, 0.3), Regime::Dynamic)
            .body([3 + shift..6 + shift, 0..3], 2, 1.0, |x| [0.3 * x[1], 0.1].into())
            .support(Support::fixed(1, false))
            .gravity(2.0, 0.0);
        rows(&scene.solved(0.01, 0.5).0.points)
    };
    let reference = run(0.0, 0);
    for origin in [1e3, 1e6, 1e8] {
        assert_eq!(run(origin, 0), reference); // bit by bit
    }
    let moved = run(0.0, 4);
    let difference = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let shifted = a.iter().enumerate().map(|(k, a)| if k == 0 { a + 2.0 } else { *a });
        shifted.zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let worst = reference.iter().zip(&moved).map(difference).fold(0.0, f64::max);
    println!("shifted by four cells: {worst:.1e}");
    assert!(worst <= 1e-11); // measured 9e-14
}

/// A block thrown at a wall with all data in other units, and its rows back in the first ones; `material` of a stress.
fn in_units(
    [length, mass, time]: [f64; 3],
    method: Stabilisation,
    material: impl Fn(f64) -> Material,
) -> Vec<Vec<f64>> {
    let stress = mass / (length * time * time);
    let speed = length / time;
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(0.5 * length, 8, 2), axis(0.5 * length, 5, 2)],
        material(stress),
        Regime::Dynamic,
    )
    .body([2..5, 0..3], 2, mass / (length * length * length), |x| {
        [-0.8 * speed, 0.1 * speed + 0.0 * x[0]].into()
    })
    .support(Support::roller(0, false))
    .support(Support::fixed(1, false))
    .gravity(2.0 * length / (time * time), 0.0)
    .stabilised(method);
    scene.march(0.01 * time, 0.5 * time, |_, _| ());
    let scales = [
        length, length, speed, speed, stress, stress, stress, stress, stress, stress,
    ];
    rows(&scene.points)
        .iter()
        .map(|row| row.iter().zip(scales).map(|(value, scale)| value / scale).collect())
        .collect()
}

/// Invariance: scaling by powers of two is exact in floating point.
#[test]
fn powers_of_two_as_units_change_no_bit() {
    let rubber = |stress: f64| hencky(100.0 * stress, 0.3);
    let sand = |stress: f64| {
        let sand = MohrCoulomb::new(
            Elastic {
                young: 1e4 * stress,
                poisson: 0.3,
            },
            0.5,
            0.0,
            0.0,
        );
        Material::MohrCoulomb(sand.separating(Separation::Closing))
    };
    let check = |method, material: &dyn Fn(f64) -> Material| {
        let reference = in_units([1.0; 3], method, material);
        for powers in [[10, 20, 5], [-7, 33, -12], [3, -50, 9]] {
            let scaled = in_units(powers.map(|power| 2.0_f64.powi(power)), method, material);
            assert_eq!(scaled, reference, "{method:?}: 2^n m, kg, s with n = {powers:?}");
        }
    };
    for method in METHODS {
        check(method, &rubber);
    }
    check(Stabilisation::ConsistentFBar, &sand);
}

#[test]
fn the_soft_background_changes_a_filled_elastic_block_by_the_order_of_its_coefficient() {
    let settled = |background| {
        let scene = Scene::<PlaneStrain, 2>::new(
            [axis(0.5, 6, 2), axis(0.5, 4, 2)],
            hencky(100.0, 0.3),
            Regime::QuasiStatic,
        )
        .body([0..4, 0..4], 3, 1.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(Support::fixed(1, false))
        .gravity(1.0, 0.0)
        .artificial_stiffness(background);
        scene.solved(1.0, 1.0).0.points
    };
    let plain = settled(None);
    let scale = plain.u.iter().map(|u| u.norm()).fold(0.0, f64::max);
    for coefficient in [1e-5, 1e-3, 1e-2] {
        let soft = settled(Some(ArtificialStiffness { coefficient }));
        let change = soft
            .u
            .iter()
            .zip(&plain.u)
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max)
            / scale;
        println!("coefficient {coefficient:.0e}: displacement changes by {change:.1e}");
        assert!((0.7..1.3).contains(&(change / coefficient))); // measured 0.98 to 0.99
    }
}
