//! Tests that transfers between points and nodes are adjoint, and conserve mass and momentum.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::grid::{KnotVector, Shape, transfer};
use bsmpm::kinematics::{Axisymmetric, Gradient, Kinematics, PlaneStrain, Solid};
use bsmpm::model::{Gravity, Regime};
use bsmpm::points::Points;
use bsmpm::tensor::{Square, Vector};
use std::ops::Range;

/// A body of scattered points of different mass with velocities, in a graded grid.
fn scattered<K: Kinematics<D>, const D: usize>(order: usize) -> Scene<K, D> {
    let graded = KnotVector::graded(&[0.0, 0.2, 0.7, 0.8, 2.0], order).unwrap();
    let axes = std::array::from_fn(|k| if k == 0 { graded.clone() } else { axis(0.4, 3, order) });
    let mut random = Random::new(order as u64);
    let mut scene = Scene::<K, D>::new(axes, hencky(1.0, 0.3), Regime::Dynamic);
    let cells = std::array::from_fn(|k| 0..scene.model.grid.axes()[k].cells());
    scene = scene.body(cells, 2, 3.0, |x| x * 2.0 - Vector::repeat(0.3));
    for p in 0..scene.points.len() {
        scene.points.x[p] += random.vector::<D>() * 0.01;
        scene.points.mass[p] *= 1.0 + 0.5 * random.signed();
    }
    scene.points.sort_by_cell(&scene.model.grid);
    scene
}

fn dot(a: &[f64], b: &[f64]) -> (f64, f64) {
    let terms = || a.iter().zip(b).map(|(a, b)| a * b);
    (terms().sum(), terms().map(f64::abs).sum())
}

/// The elements of a gradient, row by row.
fn elements<K: Kinematics<D>, const D: usize>(gradient: &K::Gradient) -> Vec<f64> {
    (0..D)
        .flat_map(|i| (0..K::Gradient::SLOPES).map(move |j| gradient[(i, j)]))
        .collect()
}

/// Largest |<B u, P> - <u, B^T P>| relative to the sum of the terms' sizes: gradients, then values.
fn adjointness<K: Kinematics<D>, const D: usize>(order: usize) -> (f64, f64) {
    let scene = scattered::<K, D>(order);
    let grid = &scene.model.grid;
    let n = scene.points.len();
    let shape = Shape::at(grid, &scene.points).unwrap();
    let mut random = Random::new(11);
    let u = random.array(grid.nodes() * D);
    let P: Vec<K::Gradient> = (0..n).map(|_| K::Gradient::from_fn(|_, _| random.signed())).collect();
    let gradients = transfer::gradients::<K, D, _>(&shape, &scene.points.x, &u, |_, gradient| gradient);
    let at_points: Vec<f64> = gradients.iter().flat_map(elements::<K, D>).collect();
    let flat: Vec<f64> = P.iter().flat_map(elements::<K, D>).collect();
    let f = transfer::divergence::<K, D>(&shape, &scene.points.x, |p| P[p]).alone();
    let (gathered, scale) = dot(&at_points, &flat);
    let (scattered, _) = dot(&u, &f);
    let gradients = (gathered - scattered).abs() / scale;

    let a = random.array(n * 3);
    let nodal = random.array(grid.nodes() * 3);
    let sums = transfer::to_nodes(&shape, |p| [a[3 * p], a[3 * p + 1], a[3 * p + 2]]).alone();
    let at_points = transfer::to_points::<D, 3, _>(&shape, &nodal, |_, value| value).concat();
    let (gathered, scale) = dot(&at_points, &a);
    let (scattered, _) = dot(&nodal, &sums);
    (gradients, (gathered - scattered).abs() / scale)
}

#[test]
fn gather_and_scatter_are_adjoint_in_two_and_three_dimensions() {
    for order in 1..=3 {
        for (gradients, values) in [
            adjointness::<PlaneStrain, 2>(order),
            adjointness::<Axisymmetric, 2>(order),
            adjointness::<Solid, 3>(order),
        ] {
            println!("order {order}: gradients {gradients:.1e}, values {values:.1e}");
            assert!(gradients <= 1e-14 && values <= 1e-14); // measured 1.3e-16, 8.1e-17
        }
    }
}

/// The gradient of u = H x + shift at `x`.
fn of_linear<K: Kinematics<D>, const D: usize>(H: &Square<D>, shift: &Vector<D>, x: &Vector<D>) -> K::Gradient {
    let mut gradient = K::Gradient::zeros();
    for k in 0..D {
        let slope = K::slope::<f64>(|| 0.0, H.row(k).transpose(), x);
        (0..K::Gradient::SLOPES).for_each(|j| gradient[(k, j)] = slope[j]);
    }
    let u = H * x + shift;
    let hoop = K::slope::<f64>(|| u[0], Vector::zeros(), x);
    (0..K::Gradient::SLOPES).for_each(|j| gradient[(0, j)] += hoop[j]);
    gradient
}

fn linear_fields_are_exact<K: Kinematics<D>, const D: usize>(order: usize) {
    let scene = scattered::<K, D>(order);
    let shape = Shape::at(&scene.model.grid, &scene.points).unwrap();
    let mut random = Random::new(5);
    let H = random.square::<D>();
    let shift = random.vector::<D>();
    let u = linear_field(&scene, &H, &shift);
    let largest = |errors: Vec<f64>| errors.into_iter().fold(0.0, f64::max);
    let gradient = largest(transfer::gradients::<K, D, _>(
        &shape,
        &scene.points.x,
        &u,
        |p, found| {
            (K::gradient::<f64>(&found) - K::gradient::<f64>(&of_linear::<K, D>(&H, &shift, &scene.points.x[p]))).amax()
        },
    ));
    let value = largest(transfer::to_points::<D, D, _>(&shape, &u, |p, found| {
        let exact = H * scene.points.x[p] + shift;
        (Vector::from(found) - exact).amax()
    }));
    println!("q = {order}, {D}-D: gradient to {gradient:.1e}, value to {value:.1e}");
    assert!(gradient <= 1e-13 && value <= 1e-14); // measured 6.7e-15, 1.6e-15
}

/// Nodal values of H x + shift at the Greville abscissae.
fn linear_field<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>, H: &Square<D>, shift: &Vector<D>) -> Vec<f64> {
    let grid = &scene.model.grid;
    let greville = |k: usize, i: usize| {
        let knots = &grid.axes()[k];
        (1..=knots.order()).map(|j| knots.knot(i + j)).sum::<f64>() / knots.order() as f64
    };
    let at = |node: usize| Vector::<D>::from_fn(|k, _| greville(k, grid.node_at(node)[k]));
    (0..grid.nodes())
        .flat_map(|node| <[f64; D]>::from(H * at(node) + shift))
        .collect()
}

#[test]
fn a_linear_displacement_field_has_its_exact_gradient_at_every_point() {
    for order in 1..=3 {
        linear_fields_are_exact::<PlaneStrain, 2>(order);
        linear_fields_are_exact::<Axisymmetric, 2>(order);
        linear_fields_are_exact::<Solid, 3>(order);
    }
}

fn the_mapping_conserves<K: Kinematics<D>, const D: usize>(order: usize) {
    let mut scene = scattered::<K, D>(order);
    scene.model.gravity = Some(Gravity {
        acceleration: Vector::repeat(-9.81),
        ramp: 0.0,
        starts_vertical: false,
    });
    let points = &scene.points;
    let shape = Shape::at(&scene.model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 0.1);
    let mass: f64 = points.mass.iter().sum();
    let mut worst = [(nodes.weight.iter().sum::<f64>() / mass - 1.0).abs(), 0.0, 0.0];
    let motion = points.motion.as_ref().unwrap();
    let v = &nodes.inertia.as_ref().unwrap().v;
    for c in 0..D {
        let at_points: f64 = (0..points.len()).map(|p| points.mass[p] * motion.v[p][c]).sum();
        let at_nodes: f64 = nodes
            .weight
            .iter()
            .zip(v[c..].iter().step_by(D))
            .map(|(m, v)| m * v)
            .sum();
        worst[1] = worst[1].max((at_nodes - at_points).abs() / (4.0 * mass)); // speeds are up to 4 m/s
        let weight: f64 = nodes.f_ext[c..].iter().step_by(D).sum();
        worst[2] = worst[2].max((weight / (-9.81 * mass) - 1.0).abs());
    }
    println!("q = {order}, {D}-D: mass, momentum, weight to {worst:?}");
    assert!(worst.iter().all(|&error| error <= 1e-14)); // measured 1.3e-15
}

#[test]
fn mapping_to_the_nodes_conserves_mass_momentum_and_weight() {
    for order in 1..=3 {
        the_mapping_conserves::<PlaneStrain, 2>(order);
        the_mapping_conserves::<Solid, 3>(order);
    }
}

#[test]
fn squared_gradients_are_the_trace_of_the_moment() {
    let scene = scattered::<PlaneStrain, 2>(2);
    let shape = Shape::at(&scene.model.grid, &scene.points).unwrap();
    let found = transfer::squared_gradients(&shape, |p| scene.points.volume[p]).alone();
    let mut expected = vec![0.0; found.len()];
    for patch in shape.patches() {
        for p in patch.points.clone() {
            for (offset, (_, grad)) in shape.offsets().iter().zip(shape.of(p)) {
                expected[patch.first_node + offset] += scene.points.volume[p] * grad.norm_squared();
            }
        }
    }
    assert!(
        found
            .iter()
            .zip(&expected)
            .all(|(a, b)| (a - b).abs() <= 1e-13 * b.abs())
    );
}

/// Sums of the windows of any cut, each layer adding its columns in their order, are those of the whole grid to the
/// bit.
fn sums_of_windows<K: Kinematics<D>, const D: usize>(order: usize) {
    let scene = scattered::<K, D>(order);
    let grid = &scene.model.grid;
    let all = 0..scene.model.grid.columns().end;
    let force = |p: usize, points: &Points<D>| {
        let F = points.F.at(p);
        K::Gradient::from_fn(|i, j| points.mass[p] + F[(i, j)])
    };
    let of_window = |columns: Range<usize>| {
        let window = grid.window(columns.clone());
        let mut points = scene.points.clone();
        let column = |p: usize| grid.locate(&scene.points.x[p]).expect("inside")[0];
        let inside: Vec<u32> = (0..points.len())
            .filter(|&p| columns.contains(&column(p)))
            .map(|p| p as u32)
            .collect();
        points.columns().into_iter().for_each(|array| array.reorder(&inside));
        points.sort_by_cell(&window);
        let shape = Shape::at(&window, &points).unwrap();
        (
            columns.start,
            transfer::divergence::<K, D>(&shape, &points.x, |p| force(p, &points)),
        )
    };
    let (_, whole) = of_window(all.clone());
    let whole = whole.alone();
    let layer = grid.layer_nodes() * D;
    for cut in all.start + 1..all.end {
        let parts = [of_window(all.start..cut), of_window(cut..all.end)];
        for number in 0..grid.layers().len() {
            let mut sum = vec![0.0; layer];
            for (first, part) in &parts {
                for column in 0..all.end - first {
                    let found = (number >= *first).then(|| part.of(column, number - first)).flatten();
                    sum.iter_mut()
                        .zip(found.unwrap_or(&[]))
                        .for_each(|(sum, value)| *sum += value);
                }
            }
            assert_eq!(
                sum,
                whole[number * layer..(number + 1) * layer],
                "layer {number}, cut {cut}, order {order}"
            );
        }
    }
}

#[test]
fn nodal_sums_do_not_depend_on_the_cut() {
    for order in 1..=3 {
        sums_of_windows::<PlaneStrain, 2>(order);
        sums_of_windows::<Solid, 3>(order);
    }
}

#[test]
fn nodal_sums_do_not_depend_on_the_number_of_threads() {
    let scene = scattered::<PlaneStrain, 2>(2);
    let shape = Shape::at(&scene.model.grid, &scene.points).unwrap();
    let sums = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads start");
        pool.install(|| {
            let nodal = transfer::to_nodes(&shape, |p| [scene.points.mass[p]]).alone();
            (transfer::to_points::<2, 1, _>(&shape, &nodal, |_, [mean]| mean), nodal)
        })
    };
    assert_eq!(sums(1), sums(2));
    assert_eq!(sums(1), sums(5));
}
