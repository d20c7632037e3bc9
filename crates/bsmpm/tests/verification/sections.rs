//! Section forces and fields at places against closed forms: a column under its own weight, a beam that it bends.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::observe::{SectionForces, at_point, moved, nearest, section_forces};
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

const G: f64 = 10.0;
const DENSITY: f64 = 100.0;

/// A body of cells of `h` on the lower left corner, under its own weight in one step.
fn weighed<K: Kinematics<D>, const D: usize>(
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

fn cut(scene: &Scene<PlaneStrain, 2>, ends: [[f64; 2]; 2]) -> SectionForces {
    let at = |place: [f64; 2]| moved(&scene.points, &Vector::from(place), &scene.halo()).unwrap();
    section_forces(&scene.model.grid, &scene.points, ends.map(at), &scene.halo())
}

/// Whatever the place of the cut in its cell and its direction.
#[test]
fn the_normal_force_of_a_column_is_the_weight_above() {
    let scene = weighed::<PlaneStrain, 2>(0.25, [4, 12], 2, Support::fixed(1, false));
    for y in [1.0, 1.1, 1.5, 2.17] {
        let found = cut(&scene, [[1.2, y], [-0.2, y]]);
        let weight = DENSITY * G * (3.0 - y);
        println!("y {y}: N {:.6} of the weight, Q {:.1e}, M {:.1e}", found.normal / weight, found.shear, found.moment);
        assert!((found.normal / -weight - 1.0).abs() < 2e-4 && found.shear.abs() < 1e-4 * weight);
        // Half of the line in the body: half of the force, with its arm about the middle of the line.
        let half = cut(&scene, [[0.5, y], [-0.5, y]]);
        assert!((half.normal / -weight - 0.5).abs() < 2e-3, "{half:?}");
        assert!((half.moment / weight - 0.125).abs() < 4e-3, "{half:?}");
    }
    // A line at 45 degrees cuts off the same weight on the average; it is the vector sum that balances it.
    let found = cut(&scene, [[1.3, 1.8], [-0.3, 0.2]]);
    let vertical = (found.normal - found.shear) / 2.0_f64.sqrt();
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
            let found = cut(&scene, [[x, floor - 0.3], [x, floor + 1.3]]);
            let (beyond, weight) = (6.0 - x, DENSITY * G);
            // Upward is the line, n to the right: the part beyond hangs on this one by its weight.
            let (shear, moment) = (weight * beyond, 0.5 * weight * beyond * beyond);
            let clamped = 18.0 * weight;
            let off = [found.normal / shear, found.shear / -shear - 1.0, (found.moment - moment) / clamped];
            println!("h {h} x {x}: N/Q {:.1e}, Q {:.1e}, M {:.1e} of that at the clamp", off[0], off[1], off[2]);
            largest = off.iter().fold(largest, |largest, off| largest.max(off.abs()));
        }
        assert!(largest < tolerance, "{largest}");
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
    let (grid, points, halo) = (&scene.model.grid, &scene.points, scene.halo());
    let of_points = |p: usize| [linear(&(points.x[p] - points.u[p]))];
    let found = place::values::<K, D, _>(grid, points, (&places, Configuration::Initial), of_points, &halo);
    for (place, found) in places.iter().zip(&found) {
        let inside = (0..D - 1).all(|axis| place[axis] <= width) && place[D - 1] <= 3.0;
        assert_eq!(found.is_some(), inside, "{place}");
        assert!(found.is_none_or(|[found]| (found - linear(place)).abs() < 1e-10), "{place} {found:?}");
    }
    let stress = |p: usize| [points.sigma.at(p).0[D - 1]];
    let found = place::values::<K, D, _>(grid, points, (&places, Configuration::Initial), stress, &halo);
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

#[test]
fn planes_reproduce_what_is_linear_to_the_surface_and_a_column_has_its_own_weight() {
    planes::<PlaneStrain, 2>([4, 12]);
    planes::<Solid, 3>([2, 2, 12]);
}
