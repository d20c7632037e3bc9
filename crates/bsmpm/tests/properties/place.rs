//! Tests of the run-out front and the displacement at a position, on fields with known values.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::grid::{Grid, KnotVector};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use bsmpm::observe::{displacement, front};
use bsmpm::tensor::{Tensor, Vector};

/// Cells of 0.5 m, the first four of the base row full, the first two of the next.
fn step() -> Scene<PlaneStrain, 2> {
    Scene::new(
        [axis(0.5, 12, 2), axis(0.5, 4, 2)],
        hencky(1.0, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..4, 0..1], 2, 3.0, |x| x * 0.0)
    .body([0..2, 1..2], 2, 3.0, |x| x * 0.0)
}

/// The farthest point of a cell that is half full went back by a spacing of points (0.25 m) whenever a column of points
/// came into the next cell.
#[test]
fn the_front_of_a_body_that_slides_moves_as_the_body_does() {
    let plain = step();
    // The same cells with the breakpoints at 2.5 and 3 m repeated, which bound cells without length.
    let mut breakpoints: Vec<f64> = (0..=12).map(|k| 0.5 * f64::from(k)).chain([2.5, 3.0]).collect();
    breakpoints.sort_by(f64::total_cmp);
    let repeated = KnotVector::graded(&breakpoints, 2).unwrap();
    let mut lined = plain.model.clone();
    lined.grid = Grid::new([repeated, plain.model.grid.axes()[1].clone()]).unwrap();
    for model in [&plain.model, &lined] {
        let mut scene = step();
        let start = front(model, &scene.points, &scene.halo());
        assert_eq!(start, 1.875);
        for number in 1..=200 {
            let moved = 0.01 * f64::from(number);
            for (x, at) in scene.points.x.iter_mut().zip(&plain.points.x) {
                x[0] = at[0] + moved;
            }
            let found = front(model, &scene.points, &scene.halo());
            assert!((found - start - moved).abs() <= 1e-12, "{moved}: {found}");
        }
    }
}

#[test]
fn loose_points_are_no_front_and_less_than_half_a_cell_is_none() {
    let mut scene = step();
    let farthest = (0..scene.points.len())
        .max_by(|&a, &b| scene.points.x[a][0].total_cmp(&scene.points.x[b][0]))
        .unwrap();
    scene.points.x[farthest][0] = 5.1;
    // The other point of its column is left, and makes half a cell with those behind it.
    assert_eq!(front(&scene.model, &scene.points, &scene.halo()), 1.875);
    scene
        .points
        .F
        .fill(Tensor::from_diagonal(&Vector::<3>::from([0.4, 1.0, 1.0])));
    assert_eq!(front(&scene.model, &scene.points, &scene.halo()), 0.0);
}

#[test]
fn a_place_between_the_points_moves_with_an_affine_motion_exactly() {
    let mut scene = step();
    let turn = [[0.6, -0.9], [0.7, 1.2]];
    let shift = Vector::from([0.3, -0.2]);
    let to = |x: Vector<2>| Vector::from(turn.map(|row| row[0] * x[0] + row[1] * x[1])) + shift;
    let points = &mut scene.points;
    for p in 0..points.len() {
        points.u[p] = to(points.x[p]) - points.x[p];
        points.x[p] += points.u[p];
        let [[xx, xy], [yx, yy]] = turn;
        points.F.set(p, Tensor::new(xx, xy, 0.0, yx, yy, 0.0, 0.0, 0.0, 1.0));
    }
    let place = Vector::from([1.99, 0.02]);
    for p in [0, 3, points.len() - 1] {
        assert!((displacement(points, p, &place) - (to(place) - place)).norm() <= 1e-14);
    }
}
