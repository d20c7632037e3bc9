//! Tests of indicators on states with a known answer.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::grid::{KnotVector, Shape, transfer};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::{AverageWeight, Model, Regime};
use bsmpm::observe::noise::relative_pressure_noise;
use bsmpm::observe::quadrature::{Defect, compression, defect};
use bsmpm::parallel::Halo;
use bsmpm::quadrature;
use bsmpm::step::smooth;
use bsmpm::tensor::{Symmetric, Tensor, Vector};

/// Cells of 0.5 m, 6 along each axis, of which `cells` hold 2^D points each.
fn block<K: Kinematics<D>, const D: usize>(order: usize, cells: std::ops::Range<usize>) -> Scene<K, D> {
    let axes = std::array::from_fn(|_| axis(0.5, 6, order));
    let cells = std::array::from_fn(|_| cells.clone());
    Scene::new(axes, hencky(1.0, 0.3), Regime::QuasiStatic).body(cells, 2, 3.0, |x| x * 0.0)
}

fn of<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>) -> Option<Defect> {
    defect(&scene.model, &scene.points, &scene.halo())
}

fn exact(cells: u64, points: f64) -> Defect {
    Defect {
        cells,
        points,
        rms: 0.0,
        largest: 0.0,
    }
}

#[test]
fn cells_are_interior_where_all_neighbours_that_the_grid_has_hold_points() {
    for order in 1..=3 {
        assert_eq!(of(&block::<PlaneStrain, 2>(order, 1..5)), Some(exact(4, 4.0)));
        // Faces of the grid are no surface.
        assert_eq!(of(&block::<PlaneStrain, 2>(order, 0..6)), Some(exact(36, 4.0)));
        assert_eq!(of(&block::<PlaneStrain, 2>(order, 0..3)), Some(exact(4, 4.0)));
        assert_eq!(of(&block::<PlaneStrain, 2>(order, 2..4)), None);
    }
    assert_eq!(of(&block::<Solid, 3>(2, 1..5)), Some(exact(8, 8.0)));
}

#[test]
fn the_defect_is_that_of_the_points_present_volumes() {
    let mut scene = block::<PlaneStrain, 2>(2, 1..5);
    // One of four points of the interior cell (2, 2) has grown to twice its area, one of cell (3, 3) is lost.
    let at = |scene: &Scene<PlaneStrain, 2>, x: [f64; 2]| {
        scene
            .points
            .x
            .iter()
            .position(|found| (found - Vector::from(x)).norm() < 1e-12)
            .unwrap()
    };
    let grown = at(&scene, [1.125, 1.125]);
    scene
        .points
        .F
        .set(grown, Tensor::from_diagonal(&[2.0, 1.0, 1.0].into()));
    let lost = at(&scene, [1.875, 1.875]);
    scene.points.volume[lost] = 0.0;
    let found = of(&scene).unwrap();
    assert_eq!((found.cells, found.largest), (4, 0.25));
    assert!((found.rms - (2.0 * 0.25_f64.powi(2) / 4.0).sqrt()).abs() <= 1e-15);
}

/// Points that have moved at random, each with a dilation of its own, in cells of different sizes.
fn stirred<K: Kinematics<D>, const D: usize>() -> Scene<K, D> {
    let breakpoints: Vec<f64> = (0..=8).map(|k| 0.5 * f64::from(k) + 0.01 * f64::from(k * k)).collect();
    let axes = std::array::from_fn(|_| KnotVector::graded(&breakpoints, 2).unwrap());
    let mut scene = Scene::<K, D>::new(axes, hencky(1.0, 0.3), Regime::QuasiStatic)
        .body(std::array::from_fn(|k| if k == 0 { 0..7 } else { 1..7 }), 2, 3.0, |x| {
            x * 0.0
        })
        .support(Support::roller(0, false));
    let mut random = Random::new(17);
    for p in 0..scene.points.len() {
        let moved = scene.points.x[p] + random.vector::<D>() * 0.04;
        scene.points.x[p] = moved.map(|x| x.max(0.0));
        scene.points.F.set(
            p,
            Tensor::from_diagonal(&[1.0 + 0.2 * random.signed(), 1.0, 1.0].into()),
        );
    }
    scene.points.sort_by_cell(&scene.model.grid);
    scene
}

fn weights<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>) -> Vec<f64> {
    let Model { grid, boundary, .. } = &scene.model;
    let shape = Shape::at(grid, &scene.points).unwrap();
    quadrature::fitted::<K, D>(grid, boundary, &shape, &scene.points, &scene.halo())
}

/// Largest relative error of the integrals of the lower splines that only reach cells of which `inside` holds, with the
/// points' own volumes and the fitted ones.
fn errors<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>, inside: impl Fn(usize, usize) -> bool) -> [f64; 2] {
    let grid = &scene.model.grid;
    let points = &scene.points;
    let lower = Shape::at(grid, points).unwrap().lowered(grid, points);
    // Function i of degree q - 1 reaches the cells i - (q - 1) to i.
    let reached = |at: usize| at.saturating_sub(grid.order() - 1)..=at;
    let counts = |node: &usize| (0..D).all(|axis| reached(grid.node_at(*node)[axis]).all(|cell| inside(axis, cell)));
    [&points.volume, &weights(scene)].map(|weights| {
        let present = |p: usize| [weights[p] * points.F.at(p).determinant()];
        let sums = scene.halo().assemble_ghosts(&transfer::to_nodes(&lower, present));
        let error = |node: usize| (sums[node] / grid.lowered_volume::<K>(node) - 1.0).abs();
        (0..grid.nodes()).filter(counts).map(error).fold(0.0, f64::max)
    })
}

fn fits_inside_and_only_there<K: Kinematics<D>, const D: usize>() {
    let scene = stirred::<K, D>();
    // At the lower face of axis 0 a support holds the body, which ends there nowhere else.
    let [own, fitted] = errors(
        &scene,
        |axis, cell| if axis == 0 { cell < 6 } else { (2..6).contains(&cell) },
    );
    println!("D = {D}: {own:e} {fitted:e}");
    assert!(own >= 0.05 && fitted <= 0.01 * own, "{own:e} {fitted:e}");
    let points = &scene.points;
    let weights = weights(&scene);
    let factors = || {
        weights
            .iter()
            .zip(&points.volume)
            .map(|(weight, volume)| weight / volume)
    };
    assert!(factors().all(|factor| (0.1..=10.0).contains(&factor)) && factors().any(|factor| factor != 1.0));
    // Functions of a corner's cell all reach the edge.
    for (p, &weight) in weights.iter().enumerate() {
        if points.x[p]
            .iter()
            .all(|&x| scene.model.grid.axes()[0].cell_of(x) == Some(6))
        {
            assert_eq!(weight, points.volume[p]);
        }
    }
}

#[test]
fn fitted_volumes_integrate_lower_splines_inside_and_are_the_points_own_at_the_edge() {
    fits_inside_and_only_there::<PlaneStrain, 2>();
    fits_inside_and_only_there::<Solid, 3>();
}

/// Wherever an even lattice lies in the cells, it integrates splines of degree 1 and more exactly.
#[test]
fn evenly_spaced_points_keep_their_volumes_to_round_off() {
    for order in [2, 3] {
        for shift in [0.0, 0.1, 0.2, 0.3] {
            let mut scene = block::<PlaneStrain, 2>(order, 1..5);
            scene.points.x.iter_mut().for_each(|x| x.add_scalar_mut(shift));
            scene.points.sort_by_cell(&scene.model.grid);
            let changed = weights(&scene)
                .iter()
                .zip(&scene.points.volume)
                .map(|(w, v)| (w / v - 1.0).abs())
                .fold(0.0, f64::max);
            assert!(changed <= 1e-13, "{order} {shift}: {changed:e}");
        }
    }
}

/// Material that has left a face of the grid which does not hold it ends there, and its cells count as full nowhere.
#[test]
fn faces_of_the_grid_that_hold_nothing_are_surfaces() {
    let block = |held: bool| {
        let scene = block::<PlaneStrain, 2>(2, 0..6);
        let mut scene = if held { scene.rollers([0, 1]) } else { scene };
        scene.points.x.iter_mut().for_each(|x| *x *= 0.97);
        let weights = weights(&scene);
        weights
            .iter()
            .zip(&scene.points.volume)
            .map(|(w, v)| (w / v - 1.0).abs())
            .fold(0.0, f64::max)
    };
    let held = block(true);
    let free = block(false);
    println!("largest change of a volume: {held} held, {free} free");
    assert!(held >= 0.3 && free <= 0.12);
}

#[test]
fn compression_is_that_of_each_material() {
    let mut scene = block::<PlaneStrain, 2>(2, 0..2);
    let halo = scene.halo();
    assert_eq!(compression(&scene.points, 2, &halo), [0.0, 0.0]);
    // Half of the points are of another material and shrink to 0.8; one of the first material grows to twice its area.
    for p in 0..scene.points.len() {
        scene.points.material[p] = u16::from(p % 2 == 1);
        let stretch = if p % 2 == 1 { 0.8 } else { 1.0 };
        scene
            .points
            .F
            .set(p, Tensor::from_diagonal(&[stretch, 1.0, 1.0].into()));
    }
    scene.points.F.set(0, Tensor::from_diagonal(&[2.0, 1.0, 1.0].into()));
    let found = compression(&scene.points, 2, &halo);
    let grown = 1.0 / (scene.points.len() / 2) as f64;
    assert!(
        (found[0] + grown).abs() <= 1e-15 && (found[1] - 0.2).abs() <= 1e-15,
        "{found:?}"
    );
}

#[test]
fn the_noise_of_the_pressure_has_no_unit() {
    let mut scene = block::<PlaneStrain, 2>(2, 0..6);
    let noise = |scene: &Scene<PlaneStrain, 2>| {
        relative_pressure_noise(
            &scene.model.grid,
            &scene.points,
            AverageWeight::Mass,
            0.0,
            &scene.halo(),
        )
        .unwrap()
    };
    assert_eq!(noise(&scene).about_plane, 0.0);
    // A checkerboard of points: 1 +- 0.5, times any stress.
    for unit in [1.0, 1e6] {
        for p in 0..scene.points.len() {
            let place = (scene.points.x[p] / 0.25).map(|x| x as i64);
            let sign = if (place[0] + place[1]) % 2 == 0 { 1.0 } else { -1.0 };
            let [normal, shear] = [-unit * (1.0 + 0.5 * sign); 2];
            scene
                .points
                .sigma
                .set(p, Symmetric([normal, normal, normal, shear, 0.0, 0.0]));
        }
        let found = noise(&scene);
        assert!(
            (found.about_plane - 0.5).abs() <= 0.01 && (found.about_average - 0.5).abs() <= 0.05,
            "{found:?}"
        );
    }
}

/// What the formula says of a pass, measured on S itself: the variance of its kernel is that by which S x^2 exceeds
/// x^2.
#[test]
fn a_pass_of_smoothing_has_the_variance_of_its_formula() {
    for order in 1..=3 {
        let axes = [axis(0.5, 16, order), axis(0.5, 1, order)];
        let scene = Scene::<PlaneStrain, 2>::new(axes, hencky(1.0, 0.3), Regime::QuasiStatic).body(
            [0..16, 0..1],
            12,
            1.0,
            |x| x * 0.0,
        );
        let points = &scene.points;
        let halo = scene.halo();
        let shape = Shape::at(&scene.model.grid, points).unwrap();
        let nodes = scene.nodes(&shape, 1.0);
        let square = |p: usize| points.x[p][0].powi(2);
        let spread = nodes.average(
            &scene.model,
            &shape,
            points,
            &halo,
            |p| [square(p)],
            |p, [mean]| mean - square(p),
        );
        let inner = (0..points.len()).filter(|&p| (3.0..5.0).contains(&points.x[p][0]));
        let variances: Vec<f64> = inner.map(|p| spread[p]).collect();
        let variance = variances.iter().sum::<f64>() / variances.len() as f64;
        let formula = smooth::length(order, 0.5, 1.0).powi(2);
        println!("order {order}: variance {variance}, formula {formula}");
        // 12 points a cell in place of an integral.
        assert!((variance / formula - 1.0).abs() <= 0.01);
        assert!((smooth::length(order, 0.5, 9.0) - 3.0 * formula.sqrt()).abs() <= 1e-15);
    }
}
