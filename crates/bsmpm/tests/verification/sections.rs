//! Tests of section forces, and of stresses and displacements at positions, in a column under self-weight and a bent
//! beam.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::observe::{Section, SectionForces, at_point, moved, nearest, section_forces};
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::{Symmetric, Tensor, Vector};
use std::f64::consts::PI;

pub(super) const G: f64 = 10.0;
pub(super) const DENSITY: f64 = 100.0;

/// A body of cells of `h` on the lower left corner, under its own weight in one step.
pub(super) fn weighed<K: Kinematics<D>, const D: usize>(
    h: f64,
    cells: [usize; D],
    per_cell: usize,
    support: Support<D>,
) -> Scene<K, D> {
    let grid = cells.map(|cells| axis(h, cells + 4, 2));
    let below = |axis: usize| if support.axis == 0 && axis == D - 1 { 2 } else { 0 };
    let filled = std::array::from_fn(|axis| below(axis)..below(axis) + cells[axis]);
    Scene::<K, D>::new(grid, hencky(1e9, 0.0), Regime::QuasiStatic)
        .body(filled, per_cell, DENSITY, |x| x * 0.0)
        .support(support)
        .stabilised(Stabilisation::None)
        .gravity(G, 0.0)
        .solved(1.0, 1.0)
        .0
}

/// Across a line, of a solid across a rectangle of two middle lines, which go with the material.
pub(super) fn cut<K: Kinematics<D>, const D: usize, const N: usize>(
    scene: &Scene<K, D>,
    lines: [[[f64; D]; 2]; N],
) -> SectionForces {
    let at = |place: [f64; D]| moved(&scene.points, &Vector::from(place), &scene.halo()).unwrap();
    let section = Section {
        lines: lines.map(|line| line.map(at)).into(),
        round: false,
    };
    section_forces::<K, D>(&scene.model.grid, &scene.points, &section, &scene.halo())
}

/// Whatever the place of the cut in its cell and its direction.
#[test]
fn the_normal_force_of_a_column_is_the_weight_above() {
    let scene = weighed::<PlaneStrain, 2>(0.25, [4, 12], 2, Support::fixed(1, false));
    for y in [1.0, 1.1, 1.5, 2.17] {
        let found = cut(&scene, [[[1.2, y], [-0.2, y]]]);
        let weight = DENSITY * G * (3.0 - y);
        let shear = found.shear[0];
        let moment = found.bending[0];
        println!(
            "y {y}: N {:.6} of the weight, Q {shear:.1e}, M {moment:.1e}",
            found.normal / weight
        );
        assert!((found.normal / -weight - 1.0).abs() < 2e-4 && shear.abs() < 1e-4 * weight);
        // Half of the line in the body: half of the force, with its arm about the middle of the line.
        let half = cut(&scene, [[[0.5, y], [-0.5, y]]]);
        assert!((half.normal / -weight - 0.5).abs() < 2e-3, "{half:?}");
        assert!((half.bending[0] / weight - 0.125).abs() < 4e-3, "{half:?}");
        assert_eq!([half.shear[1], half.torsion, half.bending[1]], [0.0; 3]);
    }
    // A line at 45 degrees cuts off the same weight on the average; it is the vector sum that balances it.
    let found = cut(&scene, [[[1.3, 1.8], [-0.3, 0.2]]]);
    let vertical = (found.normal - found.shear[0]) / 2.0_f64.sqrt();
    println!("inclined: {:.6}", vertical.abs() / (DENSITY * G * 2.0));
    assert!((vertical.abs() / (DENSITY * G * 2.0) - 1.0).abs() < 2e-3);
}

/// A cantilever of six by one, of two and of four cells over its depth: from the free end, x = 6.
#[test]
fn shear_and_moment_of_a_beam_are_those_of_statics() {
    for (h, tolerance) in [(0.5, 5e-3), (0.25, 2e-3)] {
        let cells = [6.0, 1.0].map(|length: f64| (length / h) as usize);
        let scene = weighed::<PlaneStrain, 2>(h, cells, 2, Support::fixed(0, false));
        let floor = 2.0 * h;
        let mut largest = 0.0_f64;
        for x in [1.0, 2.0, 2.1, 3.3, 4.5] {
            let found = cut(&scene, [[[x, floor - 0.3], [x, floor + 1.3]]]);
            let beyond = 6.0 - x;
            let weight = DENSITY * G;
            // Upward is the line, n to the right: the part beyond hangs on this one by its weight.
            let shear = weight * beyond;
            let moment = 0.5 * weight * beyond * beyond;
            let clamped = 18.0 * weight;
            let off = [
                found.normal / shear,
                found.shear[0] / -shear - 1.0,
                (found.bending[0] - moment) / clamped,
            ];
            println!(
                "h {h} x {x}: N/Q {:.1e}, Q {:.1e}, M {:.1e} of that at the clamp",
                off[0], off[1], off[2]
            );
            largest = off.iter().fold(largest, |largest, off| largest.max(off.abs()));
        }
        assert!(largest < tolerance, "{largest}");
    }
}

/// A column of 0.5 m by 0.5 m, cut level, over a part, and at 45 degrees about an axis that is along none of the
/// grid's.
#[test]
fn the_normal_force_of_a_column_in_space_is_the_weight_above() {
    let scene = weighed::<Solid, 3>(0.25, [2, 2, 12], 2, Support::fixed(2, false));
    let area = 0.25;
    for z in [1.0, 1.1, 1.5, 2.17] {
        let found = cut(
            &scene,
            [[[-0.2, 0.25, z], [0.7, 0.25, z]], [[0.25, -0.1, z], [0.25, 0.6, z]]],
        );
        let weight = DENSITY * G * area * (3.0 - z);
        println!("z {z}: N {:.6} of the weight", found.normal / weight);
        assert!((found.normal / -weight - 1.0).abs() < 2e-4);
        let others = [found.shear, found.bending].concat().into_iter().chain([found.torsion]);
        assert!(others.into_iter().all(|other| other.abs() < 1e-4 * weight), "{found:?}");
        // Half of the rectangle in the body: half of the force, with its arm of 0.125 m about the middle of the face.
        let half = cut(
            &scene,
            [[[-0.25, 0.25, z], [0.25, 0.25, z]], [[0.0, -0.5, z], [0.0, 1.0, z]]],
        );
        assert!((half.normal / -weight - 0.5).abs() < 2e-3, "{half:?}");
        assert!(
            (half.bending[0] / -weight - 0.0625).abs() < 2e-3 && half.bending[1].abs() < 1e-3 * weight,
            "{half:?}"
        );
    }
    // The normal (1, 1, sqrt 2) / 2: the vector sum balances what is cut off, that above the middle on the average.
    let middle = Vector::<3>::new(0.25, 0.25, 1.3);
    let root = 0.5_f64.sqrt();
    let axes = [Vector::<3>::new(root, -root, 0.0), Vector::<3>::new(0.5, 0.5, -root)];
    let lines = axes.map(|along| [middle - along, middle + along].map(<[f64; 3]>::from));
    let found = cut(&scene, lines);
    let vertical = found.normal * root - found.shear[1] * root;
    let weight = DENSITY * G * area * 1.7;
    println!("inclined: {:.6}", vertical / weight);
    assert!((vertical / -weight - 1.0).abs() < 2e-3 && found.shear[0].abs() < 1e-3 * weight);
}

/// The cantilever of two cells over its depth, as wide: of 1 m, so that its forces are those of the plane's.
#[test]
fn shear_and_moment_of_a_beam_in_space_are_those_of_statics_and_of_the_plane() {
    let scene = weighed::<Solid, 3>(0.5, [12, 2, 2], 2, Support::fixed(0, false));
    let plane = weighed::<PlaneStrain, 2>(0.5, [12, 2], 2, Support::fixed(0, false));
    for x in [1.0, 2.1, 4.5] {
        let found = cut(
            &scene,
            [[[x, -0.2, 1.5], [x, 1.2, 1.5]], [[x, 0.5, 0.7], [x, 0.5, 2.3]]],
        );
        let flat = cut(&plane, [[[x, 0.7], [x, 2.3]]]);
        let beyond = 6.0 - x;
        let weight = DENSITY * G;
        let shear = weight * beyond;
        let moment = 0.5 * weight * beyond * beyond;
        let clamped = 18.0 * weight;
        let off = [
            found.normal / shear,
            found.shear[1] / -shear - 1.0,
            (found.bending[1] - moment) / clamped,
        ];
        let apart = [
            (found.shear[1] - flat.shear[0]) / shear,
            (found.bending[1] - flat.bending[0]) / clamped,
        ];
        println!("x {x}: N/Q, Q, M off by {off:?}; of the plane's Q, M by {apart:?}");
        assert!(off.iter().all(|off| off.abs() < 5e-3) && apart.iter().all(|off| off.abs() < 1e-6));
        let others = [found.shear[0], found.torsion, found.bending[0]];
        assert!(others.iter().all(|other| other.abs() < 1e-6 * shear), "{found:?}");
    }
}

/// Stress that is linear over the section and balances itself, across each axis: s_nn = a + b s1 + c s2,
/// s_1n = d - e s2, s_2n = f + e s1. Of points the mean of s^2 is less than its integral by a twelfth of their spacing
/// squared.
#[test]
fn the_six_forces_of_a_plane_are_the_integrals_of_the_stress_and_of_a_disc_those_of_a_shaft() {
    let [a, b, c, d, e, f] = [3.0, -2.0, 5.0, 0.7, -1.1, 2.3];
    let h = 0.25;
    let spacing = 0.125;
    let middle = 1.5;
    let mut scene = Scene::<Solid, 3>::new(
        [12; 3].map(|cells| axis(h, cells, 2)),
        hencky(1.0, 0.0),
        Regime::QuasiStatic,
    )
    .body([1..11, 1..11, 1..11], 2, DENSITY, |x| x * 0.0);
    for n in 0..3 {
        let first = (n + 1) % 3;
        let second = (n + 2) % 3;
        for p in 0..scene.points.len() {
            let [s1, s2] = [first, second].map(|axis| scene.points.x[p][axis] - middle);
            let mut stress = Tensor::zeros();
            for (along, value) in [(n, a + b * s1 + c * s2), (first, d - e * s2), (second, f + e * s1)] {
                (stress[(n, along)], stress[(along, n)]) = (value, value);
            }
            scene.points.sigma.set(p, Symmetric::of(&stress));
        }
        let line = |axis: usize, half: f64| -> [Vector<3>; 2] {
            [-half, half].map(|end| Vector::from_fn(|k, _| if k == axis { middle + end } else { middle }))
        };
        let across = |halves: [f64; 2], round: bool| {
            let section = Section {
                lines: vec![line(first, halves[0]), line(second, halves[1])],
                round,
            };
            section_forces::<Solid, 3>(&scene.model.grid, &scene.points, &section, &scene.halo())
        };
        let found = across([0.5, 0.75], false);
        let area = 1.5;
        let square = |width: f64| (width * width - spacing * spacing) / 12.0 * 1.5;
        let square1 = square(1.0);
        let square2 = square(1.5);
        let expected = [
            a * area,
            d * area,
            f * area,
            e * (square1 + square2),
            b * square1,
            c * square2,
        ];
        let numbers = |of: SectionForces| {
            [
                of.normal,
                of.shear[0],
                of.shear[1],
                of.torsion,
                of.bending[0],
                of.bending[1],
            ]
        };
        for (found, expected) in numbers(found).into_iter().zip(expected) {
            println!("across axis {n}: {found} for {expected}");
            assert!((found - expected).abs() < 1e-10);
        }
        let radius = 1.0_f64;
        let found = across([1.0; 2], true);
        let area = PI * radius.powi(2);
        let square = PI * radius.powi(4) / 4.0;
        let expected = [a * area, d * area, f * area, 2.0 * e * square, b * square, c * square];
        for (found, expected) in numbers(found).into_iter().zip(expected) {
            println!("disc across axis {n}: {:.1e}", found / expected - 1.0);
            assert!((found / expected - 1.0).abs() < 3e-3);
        }
    }
}

/// Stress of a linear field at places inside, at corners and on surfaces; where there is no material there is none.
fn planes<K: Kinematics<D>, const D: usize>(cells: [usize; D]) {
    let scene = weighed::<K, D>(0.25, cells, 2, Support::fixed(D - 1, false));
    let width = 0.25 * cells[0] as f64;
    // Parts of the width along x, and of a solid along y; the height.
    let places = [
        ([0.5, 0.4], 0.9),
        ([0.0, 0.0], 3.0),
        ([1.0, 1.0], 3.0),
        ([0.31, 0.5], 0.0),
        ([0.5, 1.6], 1.0),
        ([1.6, 0.5], 1.0),
        ([0.5, 0.5], 3.3),
        ([0.5, 0.7], 1.6),
    ];
    let place = |(parts, height): ([f64; 2], f64)| -> Vector<D> {
        Vector::from_fn(|axis, _| if axis == D - 1 { height } else { width * parts[axis] })
    };
    let places: Vec<Vector<D>> = places.into_iter().map(place).collect();
    let linear = |place: &Vector<D>| 3.0 - 2.0 * place[0] + 7.0 * place[1] + 5.0 * place[D - 1];
    let grid = &scene.model.grid;
    let points = &scene.points;
    let halo = scene.halo();
    let of_points = |p: usize| [linear(&(points.x[p] - points.u[p]))];
    let found = place::values::<K, D, _>(grid, points, &places, Configuration::Initial, of_points, &halo);
    for (place, found) in places.iter().zip(&found) {
        let inside = (0..D - 1).all(|axis| place[axis] <= width) && place[D - 1] <= 3.0;
        assert_eq!(found.is_some(), inside, "{place}");
        let off = found.map_or(0.0, |[found]| (found - linear(place)).abs());
        println!("linear field off by {off:.1e}");
        assert!(off < 1e-10, "{place} {found:?}");
    }
    let stress = |p: usize| [points.sigma.at(p).0[D - 1]];
    let found = place::values::<K, D, _>(grid, points, &places, Configuration::Initial, stress, &halo);
    for number in [0, 1, 2, 7] {
        let off = found[number].unwrap()[0] + DENSITY * G * (3.0 - places[number][D - 1]);
        let id = nearest(points, &places[number], |_| true, &halo).unwrap();
        let near = at_point(points, id, &halo, stress)[0] + DENSITY * G * (3.0 - places[number][D - 1]);
        println!(
            "{:?}: off by {:.1e} of the largest, of the nearest point {:.1e}",
            places[number].as_slice(),
            off / 3e3,
            near / 3e3
        );
        assert!(off.abs() < if number == 0 || number == 7 { 1e-3 } else { 2e-2 } * DENSITY * G * 3.0);
    }
}

/// Closed form: linear fields, and the stress of a column under its weight.
#[test]
fn planes_reproduce_what_is_linear_to_the_surface_and_a_column_has_its_own_weight() {
    planes::<PlaneStrain, 2>([4, 12]);
    planes::<Solid, 3>([2, 2, 12]);
}
