//! Section forces and fields at places against closed forms: a column under its own weight, a beam that it bends.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::observe::{SectionForces, at_point, moved, nearest, section_forces};
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

const G: f64 = 10.0;
const DENSITY: f64 = 100.0;

/// A body of cells of `h` on the lower left corner, under its own weight in one step.
fn weighed(h: f64, cells: [usize; 2], per_cell: usize, support: Support<2>) -> Scene<PlaneStrain, 2> {
    let grid = cells.map(|cells| axis(h, cells + 4, 2));
    let below = usize::from(support.axis == 0) * 2;
    Scene::<PlaneStrain, 2>::new(grid, hencky(1e9, 0.0), Regime::QuasiStatic)
        .body([0..cells[0], below..below + cells[1]], per_cell, DENSITY, |x| x * 0.0)
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
    let scene = weighed(0.25, [4, 12], 2, Support::fixed(1, false));
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
        let scene = weighed(h, cells, 2, Support::fixed(0, false));
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
#[test]
fn planes_reproduce_what_is_linear_to_the_surface_and_a_column_has_its_own_weight() {
    let scene = weighed(0.25, [4, 12], 2, Support::fixed(1, false));
    let places: Vec<Vector<2>> = [[0.5, 0.9], [0.0, 3.0], [1.0, 3.0], [0.31, 0.0], [1.3, 1.0], [0.5, 3.3], [0.5, 1.6]]
        .into_iter()
        .map(Vector::from)
        .collect();
    let linear = |points: &Points<2>| {
        let places_of: Vec<Vector<2>> = points.x.iter().zip(&points.u).map(|(x, u)| x - u).collect();
        move |p: usize| [3.0 - 2.0 * places_of[p][0] + 7.0 * places_of[p][1]]
    };
    let (grid, points, halo) = (&scene.model.grid, &scene.points, scene.halo());
    let found =
        place::values::<PlaneStrain, 2, _>(grid, points, (&places, Configuration::Initial), linear(points), &halo);
    for (place, found) in places.iter().zip(&found) {
        let inside = place[0] <= 1.0 && place[1] <= 3.0;
        assert_eq!(found.is_some(), inside, "{place}");
        let exact = 3.0 - 2.0 * place[0] + 7.0 * place[1];
        assert!(found.is_none_or(|[found]| (found - exact).abs() < 1e-10), "{place} {found:?}");
    }
    let stress = |p: usize| [points.sigma.at(p).0[1]];
    let found = place::values::<PlaneStrain, 2, _>(grid, points, (&places, Configuration::Initial), stress, &halo);
    for number in [0, 1, 2, 6] {
        let off = found[number].unwrap()[0] + DENSITY * G * (3.0 - places[number][1]);
        let id = nearest(points, &places[number], |_| true, &halo).unwrap();
        let near = at_point(points, id, &halo, stress)[0] + DENSITY * G * (3.0 - places[number][1]);
        println!(
            "{:?}: off by {:.1e} of the largest, of the nearest point {:.1e}",
            places[number],
            off / 3e3,
            near / 3e3
        );
        assert!(off.abs() < if number == 0 || number == 6 { 1e-3 } else { 2e-2 } * DENSITY * G * 3.0);
    }
}
