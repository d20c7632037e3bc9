//! Tests of extended splines: ties preserve linear fields, forces and moments, and bound the condition number.

use crate::support::random::Random;
use crate::support::scene::{METHODS, Scene, axis, hencky};
use crate::support::solver::Dense;
use bsmpm::boundary::Support;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::grid::{Grid, Shape};
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::nodal::Nodal;
use bsmpm::solve::linearised::ForceTangent;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::problem::Problem;
use bsmpm::step::residual::Residual;
use bsmpm::step::stiffness;
use bsmpm::tensor::{Tensor, Vector};

/// A block on the lower face of the first axis, cut by an inclined plane, with empty cells around it.
fn cut_block<K: Kinematics<D>, const D: usize>(order: usize) -> Scene<K, D> {
    let axes = std::array::from_fn(|k| axis(1.0, if k == 0 { 6 } else { 4 }, order));
    let cells = std::array::from_fn(|k| if k == 0 { 0..4 } else { 1..3 });
    let is_inside = |x: &Vector<D>| x[0] + 0.4 * (1..D).map(|axis| x[axis] - 1.0).sum::<f64>() < 3.1;
    Scene::<K, D>::new(axes, hencky(1000.0, 0.3), Regime::QuasiStatic)
        .body(cells, 3, 1.0, |_| Vector::zeros())
        .cut(is_inside)
        .extended()
}

/// A nodal array of an affine field, D numbers a node.
fn affine<const D: usize>(grid: &Grid<D>, constant: &Vector<D>, slope: &[Vector<D>; D]) -> Vec<f64> {
    let component = |at: usize| {
        let (node, axis) = Nodal::<D>::split(at);
        constant[axis] + slope[axis].dot(&place(grid, node))
    };
    (0..grid.nodes() * D).map(component).collect()
}

/// Where a node's coefficient makes linear fields: its Greville abscissae.
fn place<const D: usize>(grid: &Grid<D>, node: usize) -> Vector<D> {
    let node = grid.node_at(node);
    Vector::from_fn(|axis, _| grid.axes()[axis].greville(node[axis]))
}

/// Forces of the nodes, and the moments of every component about every axis's zero.
fn resultants<const D: usize>(grid: &Grid<D>, force: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; D + D * D];
    for (at, force) in force.iter().enumerate() {
        let (node, i) = Nodal::<D>::split(at);
        sums[i] += force;
        (0..D).for_each(|k| sums[D + i * D + k] += force * place(grid, node)[k]);
    }
    sums
}

fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    let size = expected.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance * size, "{found} for {expected}");
    }
}

fn ties_keep_what_they_must<K: Kinematics<D>, const D: usize>(order: usize) {
    let scene = cut_block::<K, D>(order);
    let grid = &scene.model.grid;
    let halo = scene.halo();
    let shape = Shape::at(grid, &scene.points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let extension = nodes.constraints.extension.as_ref().expect("cut cells");
    assert!(
        extension.tied > 0 && extension.untied == 0,
        "{} and {}",
        extension.tied,
        extension.untied
    );
    let mut random = Random::new(5);
    let constant = random.vector();
    let slope = std::array::from_fn(|_| random.vector());
    let expected = affine(grid, &constant, &slope);
    let inner = |u: &[f64]| -> Vec<f64> {
        u.iter()
            .enumerate()
            .map(|(at, u)| if extension.is_tied(at) { 0.0 } else { *u })
            .collect()
    };
    let mut u = inner(&expected);
    extension.extend(grid, &mut u, &halo);
    close(&u, &expected, 1e-13);
    let force: Vec<f64> = (0..u.len()).map(|_| random.signed()).collect();
    let mut reduced = force.clone();
    extension.reduce(&mut [&mut reduced], &halo);
    close(&resultants(grid, &reduced), &resultants(grid, &force), 1e-13);
    let mut v = inner(&force);
    let work_of = |force: &[f64], v: &[f64]| force.iter().zip(v).map(|(f, v)| f * v).sum::<f64>();
    let work = work_of(&reduced, &v);
    extension.extend(grid, &mut v, &halo);
    assert!(
        (work_of(&force, &v) / work - 1.0).abs() <= 1e-12,
        "the work of E^T f on u_I is that of f on E u_I"
    );
    assert!((0..u.len()).all(|at| !extension.is_tied(at) || reduced[at] == 0.0));
}

#[test]
fn ties_keep_linear_fields_forces_moments_and_work() {
    for order in 1..=3 {
        ties_keep_what_they_must::<PlaneStrain, 2>(order);
        ties_keep_what_they_must::<Axisymmetric, 2>(order);
        ties_keep_what_they_must::<Solid, 3>(order);
    }
}

/// The largest difference between a reduced matrix and the derivative of tied forces, over the largest force.
fn matrix_error<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>, is_general: bool) -> f64 {
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let problem = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let residual = Residual::of(&problem, &vec![0.0; nodes.constraints.free.len()]);
    let derivative = ForceTangent::at(&problem, &residual);
    let mut matrix = Dense::new(&model.grid);
    match is_general {
        true => derivative.assemble(&mut matrix),
        false => stiffness::assemble(&problem, Some(&residual.trial), &mut matrix),
    }
    let mut random = Random::new(11);
    let v: Vec<f64> = nodes
        .constraints
        .free
        .iter()
        .map(|&free| if free { random.signed() } else { 0.0 })
        .collect();
    let mut product = vec![0.0; v.len()];
    derivative.multiply(&v, &mut product);
    let image = matrix.multiply(&v);
    let size = product.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
    image
        .iter()
        .zip(&product)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
        / size
}

fn the_matrix_is_the_derivative<K: Kinematics<D>, const D: usize>(order: usize) {
    for method in [Stabilisation::None, Stabilisation::ConsistentFBar] {
        let mut scene = cut_block::<K, D>(order)
            .stabilised(method)
            .support(Support::fixed(0, false));
        scene.model.grid = scene.model.grid.reaching(8); // nothing is too far apart for the pattern
        for is_general in [false, true] {
            let error = matrix_error(&scene, is_general);
            assert!(
                error <= 1e-12,
                "{method:?}, order {order}, general {is_general}: {error:e}"
            );
        }
    }
}

#[test]
fn the_reduced_matrix_is_the_derivative_of_elastic_material() {
    for order in 1..=3 {
        the_matrix_is_the_derivative::<PlaneStrain, 2>(order);
        the_matrix_is_the_derivative::<Axisymmetric, 2>(order);
    }
    the_matrix_is_the_derivative::<Solid, 3>(2);
}

/// Condition of the stiffness without any background, as the solvers get it: within the usual pattern.
fn condition(scene: &Scene<PlaneStrain, 2>) -> f64 {
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let problem = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let mut matrix = Dense::new(&model.grid);
    stiffness::assemble(&problem, None, &mut matrix);
    matrix.conditions()[0]
}

/// A block whose last column of cells is filled to this part only: all functions tied, and all free.
fn conditions(order: usize, part: f64) -> [f64; 2] {
    let axes = [axis(1.0, 8, order), axis(1.0, 3, order)];
    let mut scene = Scene::<PlaneStrain, 2>::new(axes, hencky(1000.0, 0.3), Regime::QuasiStatic)
        .body([0..5, 0..3], 4, 1.0, |_| Vector::zeros())
        .rollers([1])
        .support(Support::roller(0, false))
        .extended();
    for p in 0..scene.points.len() {
        let beyond = scene.points.x[p][0] - 4.0;
        if beyond > 0.0 {
            scene.points.x[p][0] = 4.0 + part * beyond;
            scene.points.volume[p] *= part;
            scene.points.mass[p] *= part;
        }
    }
    let tied = condition(&scene);
    scene.model.extended_splines = ExtendedSplines::Off;
    [tied, condition(&scene)]
}

#[test]
fn the_condition_with_ties_does_not_depend_on_how_small_a_cut_is() {
    for order in [1, 2] {
        let [[tied, free], [tied_smaller, free_smaller]] = [1e-2, 1e-4].map(|part| conditions(order, part));
        println!(
            "order {order}: {tied:.3e} and {tied_smaller:.3e} with ties, {free:.3e} and {free_smaller:.3e} without"
        );
        assert!((tied_smaller / tied - 1.0).abs() < 0.1, "{tied:e} {tied_smaller:e}");
        assert!(free_smaller > 50.0 * free, "{free:e} {free_smaller:e}");
    }
}

/// The whole block moves by the prescribed displacement of one face: no point is strained.
#[test]
fn a_rigid_translation_of_a_cut_block_makes_no_stress() {
    for method in METHODS {
        let face = Support::moving(0, false, [Some(0.02), Some(-0.01)]);
        let mut scene = cut_block::<PlaneStrain, 2>(2).stabilised(method).support(face);
        let start = scene.points.x.clone();
        scene.march(1.0, 1.0, |_, _| {});
        for (p, start) in start.iter().enumerate() {
            assert!((scene.points.x[p] - start - Vector::from([0.02, -0.01])).norm() <= 1e-13);
            let strain = scene.points.b_e.at(p).full() - Tensor::identity();
            let largest = strain.amax();
            assert!(largest <= 1e-12, "{method:?}: {largest:e}");
        }
    }
}
