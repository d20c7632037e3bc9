//! Tests that the artificial stiffness resists strain, but neither translation nor rotation.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::grid::{Contributions, Grid, KnotVector, Shape};
use bsmpm::interactions::artificial_stiffness::{ArtificialStiffness, Blocks};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::tensor::Vector;

const YOUNG: f64 = 50.0;
const COEFFICIENT: f64 = 0.02;

/// The blocks of all cells of a grid.
fn blocks<K: Kinematics<D>, const D: usize>(axes: [KnotVector; D]) -> (Grid<D>, Vec<Vec<f64>>) {
    let (grid, shape, found) = background::<K, D>(axes);
    let size = shape.offsets().len() * D;
    let block = |patch: usize| {
        let mut block = vec![0.0; size * size];
        found.add_to(patch, &mut block);
        block
    };
    let blocks = (0..shape.patches().len()).map(block).collect();
    (grid, blocks)
}

/// The background of all cells of a grid, a point in the middle of each.
fn background<K: Kinematics<D>, const D: usize>(axes: [KnotVector; D]) -> (Grid<D>, Shape<D>, Blocks) {
    let cells = axes.each_ref().map(|axis| 0..axis.cells());
    let scene = Scene::<K, D>::new(axes, hencky(YOUNG, 0.3), Regime::QuasiStatic).body(cells, 1, 1.0, |x| x * 0.0);
    let grid = scene.model.grid.clone();
    let points = &scene.points;
    let shape = Shape::at(&grid, points).expect("points inside");
    let background = ArtificialStiffness {
        coefficient: COEFFICIENT,
    };
    let found = background.blocks::<K, D>(&grid, &shape, points, &scene.model.materials);
    (grid, shape, found)
}

/// B u of a cell.
fn product(block: &[f64], u: &[f64]) -> Vec<f64> {
    block
        .chunks_exact(u.len())
        .map(|row| row.iter().zip(u).map(|(b, u)| b * u).sum())
        .collect()
}

/// u . B u of a cell.
fn energy(block: &[f64], u: &[f64]) -> f64 {
    product(block, u).iter().zip(u).map(|(f, u)| f * u).sum()
}

/// Values of the cell's nodes that make the field sum_i c_i x_i exactly: those at the functions' places.
fn affine<const D: usize>(grid: &Grid<D>, cell: usize, field: &Vector<D>) -> Vec<f64> {
    let first = grid.first_node(&grid.cell_at(cell));
    let place = |node: usize| {
        let node = grid.node_at(node);
        Vector::<D>::from_fn(|axis, _| grid.axes()[axis].greville(node[axis]))
    };
    grid.offsets()
        .iter()
        .map(|offset| 1.0 + place(first + offset).dot(field))
        .collect()
}

/// Uneven cells, four to one at most.
fn graded(order: usize) -> KnotVector {
    KnotVector::graded(&[0.0, 0.5, 0.7, 1.5, 1.75], order).expect("a valid axis")
}

/// c E int eps : eps dV of an affine motion, and nothing of a translation or a small rotation.
fn measures_strain<K: Kinematics<D>, const D: usize>(order: usize) {
    let mut random = Random::new(7);
    let axes = std::array::from_fn(|axis| {
        if axis == 0 {
            graded(order)
        } else {
            self::axis(0.25, 3, order)
        }
    });
    let (grid, blocks) = blocks::<K, D>(axes);
    for (cell, block) in blocks.iter().enumerate() {
        let size = block.len().isqrt();
        let largest = block.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
        let skewed = |entry: usize| (block[entry] - block[entry % size * size + entry / size]).abs();
        assert!((0..size * size).map(skewed).fold(0.0, f64::max) <= 1e-14 * largest && largest > 0.0);
        let rows: [Vector<D>; D] = std::array::from_fn(|_| random.vector());
        let motion = |rows: &[Vector<D>; D]| -> Vec<f64> {
            let components = rows.each_ref().map(|row| affine(&grid, cell, row));
            (0..size).map(|at| components[at % D][at / D]).collect()
        };
        let part = |i: usize, j: usize, sign: f64| 0.5 * (rows[i][j] + sign * rows[j][i]);
        let strain: f64 = (0..D * D).map(|k| part(k / D, k % D, 1.0).powi(2)).sum();
        let (_, edges) = grid.cell_box(&grid.cell_at(cell));
        let expected = COEFFICIENT * YOUNG * strain * edges.product();
        let found = energy(block, &motion(&rows));
        assert!(
            (found / expected - 1.0).abs() <= 1e-11,
            "order {order}, cell {cell}: {found} for {expected}"
        );
        let turn = std::array::from_fn(|i| Vector::<D>::from_fn(|j, _| part(i, j, -1.0)));
        assert!(
            energy(block, &motion(&turn)).abs() <= 1e-12 * expected,
            "order {order}, cell {cell}"
        );
    }
}

/// B u of all cells, which in space is made by axes.
fn multiplies_by_its_blocks<K: Kinematics<D>, const D: usize>(order: usize) {
    let mut random = Random::new(7);
    let axes = std::array::from_fn(|axis| {
        if axis == 1 {
            self::axis(0.25, 3, order)
        } else {
            graded(order)
        }
    });
    let (grid, shape, found) = background::<K, D>(axes);
    let u: Vec<f64> = (0..grid.nodes() * D).map(|_| random.signed()).collect();
    let mut expected = vec![0.0; u.len()];
    let mut work = 0.0;
    for (number, patch) in shape.patches().iter().enumerate() {
        let places = || {
            shape
                .offsets()
                .iter()
                .flat_map(|offset| (0..D).map(move |i| (patch.first_node + offset) * D + i))
        };
        let own: Vec<f64> = places().map(|at| u[at]).collect();
        let mut block = vec![0.0; own.len().pow(2)];
        found.add_to(number, &mut block);
        places()
            .zip(product(&block, &own))
            .for_each(|(at, force)| expected[at] += force);
        work += energy(&block, &own);
    }
    let mut forces = Contributions::none(&grid, D, (0..grid.axes()[0].cells()).collect());
    found.multiply::<D>(&shape, &u, &mut forces);
    let largest = expected.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    let forces = forces.alone();
    for (force, expected) in forces.iter().zip(&expected) {
        assert!(
            (force - expected).abs() < 1e-13 * largest,
            "order {order}: {force:e} for {expected:e}"
        );
    }
    let made = found.work::<D>(&shape, &u).value();
    assert!(
        (made - work).abs() < 1e-12 * work,
        "order {order}: {made:e} for {work:e}"
    );
}

#[test]
fn forces_are_those_of_the_blocks() {
    for order in 1..=3 {
        multiplies_by_its_blocks::<PlaneStrain, 2>(order);
        multiplies_by_its_blocks::<Solid, 3>(order);
    }
}

#[test]
fn the_background_measures_strain_and_leaves_rotations_alone() {
    for order in 1..=3 {
        measures_strain::<PlaneStrain, 2>(order);
    }
    measures_strain::<Solid, 3>(2);
}

#[test]
fn the_background_is_free_of_scale() {
    for order in 1..=3 {
        let of = |h: f64| blocks::<PlaneStrain, 2>([axis(h, 4, order), axis(3.0 * h, 3, order)]).1;
        assert_eq!(of(0.125), of(0.25), "order {order}: a plane's stiffness has no length");
    }
    let of = |h: f64| blocks::<Solid, 3>([axis(h, 2, 2), axis(h, 3, 2), axis(2.0 * h, 2, 2)]).1;
    let doubled = |rows: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        rows.into_iter()
            .map(|row| row.into_iter().map(|entry| 2.0 * entry).collect())
            .collect()
    };
    assert_eq!(doubled(of(0.125)), of(0.25), "that of a solid grows with it");
}
