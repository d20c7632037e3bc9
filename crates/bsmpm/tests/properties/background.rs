//! The soft background: what its forms resist and what they leave alone, and which cells get it.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::background::{Background, Blocks, Extent, Kind};
use bsmpm::grid::{Contributions, Grid, KnotVector, Shape};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::tensor::{Tensor, Vector};

const YOUNG: f64 = 50.0;
const COEFFICIENT: f64 = 0.02;

/// The blocks of all cells of a grid; of a form that does not couple the components,
/// that of the first one.
fn blocks<K: Kinematics<D>, const D: usize>(axes: [KnotVector; D], kind: Kind) -> (Grid<D>, Vec<Vec<f64>>) {
    let (grid, shape, found) = background::<K, D>(axes, kind);
    let size = shape.offsets().len() * D;
    let block = |patch: usize| {
        let mut block = vec![0.0; size * size];
        found.add_to::<D>(patch, &mut block);
        if kind == Kind::Curvature {
            block = block.chunks(size).step_by(D).flat_map(|row| row.iter().step_by(D).copied()).collect();
        }
        block
    };
    let blocks = (0..shape.patches().len()).map(block).collect();
    (grid, blocks)
}

/// The background of all cells of a grid, a point in the middle of each.
fn background<K: Kinematics<D>, const D: usize>(axes: [KnotVector; D], kind: Kind) -> (Grid<D>, Shape<D>, Blocks) {
    let cells = axes.each_ref().map(|axis| 0..axis.cells());
    let scene = Scene::<K, D>::new(axes, hencky(YOUNG, 0.3), Regime::QuasiStatic).body(cells, 1, 1.0, |x| x * 0.0);
    let (grid, points) = (scene.model.grid.clone(), &scene.points);
    let shape = Shape::at(&grid, points).expect("points inside");
    let background = Background { kind, coefficient: COEFFICIENT, extent: Extent::Occupied };
    let found = background.blocks::<K, D>(&grid, &shape, points, &scene.model.materials, &scene.halo());
    (grid, shape, found)
}

/// B u of a cell.
fn product(block: &[f64], u: &[f64]) -> Vec<f64> {
    block.chunks_exact(u.len()).map(|row| row.iter().zip(u).map(|(b, u)| b * u).sum()).collect()
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
    grid.offsets().iter().map(|offset| 1.0 + place(first + offset).dot(field)).collect()
}

/// Uneven cells, four to one at most.
fn graded(order: usize) -> KnotVector {
    KnotVector::graded(&[0.0, 0.5, 0.7, 1.5, 1.75], order).expect("a valid axis")
}

fn holds_no_affine_motion_and_is_positive<K: Kinematics<D>, const D: usize>(order: usize) {
    let mut random = Random::new(5);
    let axes = std::array::from_fn(|axis| if axis == 0 { graded(order) } else { self::axis(0.25, 3, order) });
    let (grid, blocks) = blocks::<K, D>(axes, Kind::Curvature);
    for (cell, block) in blocks.iter().enumerate() {
        let size = block.len().isqrt();
        let largest = block.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
        let symmetric = (0..size * size).all(|entry| block[entry] == block[entry % size * size + entry / size]);
        assert!(symmetric && largest > 0.0);
        for _ in 0..5 {
            let u = affine(&grid, cell, &random.vector());
            let held = product(block, &u).iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            let scale = largest * u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
            assert!(held <= 1e-13 * scale, "order {order}, cell {cell}: {held:e} of {scale:e}");
            let u: Vec<f64> = (0..size).map(|_| random.signed()).collect();
            assert!(energy(block, &u) >= 0.0);
        }
    }
}

#[test]
fn curvature_is_symmetric_positive_and_leaves_every_affine_motion_alone() {
    for order in 1..=3 {
        holds_no_affine_motion_and_is_positive::<PlaneStrain, 2>(order);
    }
    holds_no_affine_motion_and_is_positive::<Solid, 3>(2);
}

/// Values that make x y, and those that make x^2, on quadratic functions.
fn quadratic(grid: &Grid<2>, cell: usize) -> [Vec<f64>; 2] {
    let at = grid.cell_at(cell);
    // The blossom of x^2 at a function's two inner knots, and of x at one.
    let square = |axis: usize, i: usize| grid.axes()[axis].knot(i + 1) * grid.axes()[axis].knot(i + 2);
    let node = |k: usize| [at[0] + k / 3, at[1] + k % 3];
    let place = |axis: usize, i: usize| grid.axes()[axis].greville(i);
    let mixed = |k: usize| place(0, node(k)[0]) * place(1, node(k)[1]);
    [(0..9).map(mixed).collect(), (0..9).map(|k| square(0, node(k)[0])).collect()]
}

#[test]
fn curvature_of_quadratic_fields_is_exact() {
    let (grid, blocks) = blocks::<PlaneStrain, 2>([graded(2), axis(0.25, 3, 2)], Kind::Curvature);
    for (cell, block) in blocks.iter().enumerate() {
        let (_, size) = grid.cell_box(&grid.cell_at(cell));
        let [mixed, square] = quadratic(&grid, cell).map(|u| energy(block, &u) / (COEFFICIENT * YOUNG));
        let volume = size.product();
        // u = x y: twice h_x h_y; u = x^2: h_x^2 (2)^2.
        assert!((mixed / (2.0 * volume * volume) - 1.0).abs() <= 1e-10);
        assert!((square / (4.0 * size[0].powi(2) * volume) - 1.0).abs() <= 1e-10);
    }
}

/// c E int eps : eps dV of an affine motion, and nothing of a translation or a small rotation.
fn measures_strain<K: Kinematics<D>, const D: usize>(order: usize) {
    let mut random = Random::new(7);
    let axes = std::array::from_fn(|axis| if axis == 0 { graded(order) } else { self::axis(0.25, 3, order) });
    let (grid, blocks) = blocks::<K, D>(axes, Kind::Strain);
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
        assert!((found / expected - 1.0).abs() <= 1e-11, "order {order}, cell {cell}: {found} for {expected}");
        let turn = std::array::from_fn(|i| Vector::<D>::from_fn(|j, _| part(i, j, -1.0)));
        assert!(energy(block, &motion(&turn)).abs() <= 1e-12 * expected, "order {order}, cell {cell}");
    }
}

/// B u of all cells, which in space is made by axes.
fn multiplies_by_its_blocks<K: Kinematics<D>, const D: usize>(order: usize, kind: Kind) {
    let mut random = Random::new(7);
    let axes = std::array::from_fn(|axis| if axis == 1 { self::axis(0.25, 3, order) } else { graded(order) });
    let (grid, shape, found) = background::<K, D>(axes, kind);
    let u: Vec<f64> = (0..grid.nodes() * D).map(|_| random.signed()).collect();
    let (mut expected, mut work) = (vec![0.0; u.len()], 0.0);
    for (number, patch) in shape.patches().iter().enumerate() {
        let places =
            || shape.offsets().iter().flat_map(|offset| (0..D).map(move |i| (patch.first_node + offset) * D + i));
        let own: Vec<f64> = places().map(|at| u[at]).collect();
        let mut block = vec![0.0; own.len().pow(2)];
        found.add_to::<D>(number, &mut block);
        places().zip(product(&block, &own)).for_each(|(at, force)| expected[at] += force);
        work += energy(&block, &own);
    }
    let mut forces = Contributions::none(&grid, D, (0..grid.axes()[0].cells()).collect());
    found.multiply::<D>(&shape, &u, &mut forces);
    let largest = expected.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    let forces = forces.alone();
    for (force, expected) in forces.iter().zip(&expected) {
        assert!((force - expected).abs() < 1e-13 * largest, "order {order}: {force:e} for {expected:e}");
    }
    let made = found.work::<D>(&shape, &u).value();
    assert!((made - work).abs() < 1e-12 * work, "order {order}: {made:e} for {work:e}");
}

#[test]
fn forces_are_those_of_the_blocks() {
    for order in 1..=3 {
        for kind in [Kind::Strain, Kind::Curvature] {
            multiplies_by_its_blocks::<PlaneStrain, 2>(order, kind);
            multiplies_by_its_blocks::<Solid, 3>(order, kind);
        }
    }
}

#[test]
fn the_strain_form_measures_strain_and_leaves_rotations_alone() {
    for order in 1..=3 {
        measures_strain::<PlaneStrain, 2>(order);
    }
    measures_strain::<Solid, 3>(2);
}

#[test]
fn both_forms_within_cells_are_free_of_scale() {
    for kind in [Kind::Strain, Kind::Curvature] {
        for order in 1..=3 {
            let of = |h: f64| blocks::<PlaneStrain, 2>([axis(h, 4, order), axis(3.0 * h, 3, order)], kind).1;
            assert_eq!(of(0.125), of(0.25), "{kind:?}, order {order}: a plane's stiffness has no length");
        }
        let of = |h: f64| blocks::<Solid, 3>([axis(h, 2, 2), axis(h, 3, 2), axis(2.0 * h, 2, 2)], kind).1;
        let doubled = |rows: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            rows.into_iter().map(|row| row.into_iter().map(|entry| 2.0 * entry).collect()).collect()
        };
        assert_eq!(doubled(of(0.125)), of(0.25), "{kind:?}: that of a solid grows with it");
    }
}

/// Cells that get the background when a block of 8 x 4 filled cells was deformed by F about its lower corner.
fn concerned(F: [[f64; 2]; 2], extent: Extent) -> Vec<[usize; 2]> {
    let axes = [axis(0.25, 24, 2), axis(0.25, 24, 2)];
    let mut scene =
        Scene::<PlaneStrain, 2>::new(axes, hencky(YOUNG, 0.3), Regime::QuasiStatic)
            .body([2..10, 2..6], 3, 1.0, |x| x * 0.0);
    let corner = Vector::<2>::new(0.5, 0.5);
    let points = &mut scene.points;
    for p in 0..points.len() {
        let from = points.x[p] - corner;
        points.x[p] =
            corner + Vector::<2>::new(F[0][0] * from[0] + F[0][1] * from[1], F[1][0] * from[0] + F[1][1] * from[1]);
        points.F.set(p, Tensor::new(F[0][0], F[0][1], 0.0, F[1][0], F[1][1], 0.0, 0.0, 0.0, 1.0));
    }
    scene.points.sort_by_cell(&scene.model.grid);
    let (grid, points) = (&scene.model.grid, &scene.points);
    let shape = Shape::at(grid, points).expect("points inside");
    let background = Background { kind: Kind::Curvature, coefficient: COEFFICIENT, extent };
    let found = background.blocks::<PlaneStrain, 2>(grid, &shape, points, &scene.model.materials, &scene.halo());
    let patches = shape.patches().iter().enumerate();
    let cells = patches.filter(|(number, _)| found.concerns(*number)).map(|(_, patch)| grid.cell_at(patch.cell));
    let cells: Vec<_> = cells.collect();
    assert_eq!(cells.len(), found.count());
    cells
}

#[test]
fn cells_in_the_middle_of_a_deformed_body_are_not_taken_for_its_edge() {
    let whole = [[1.0, 0.0], [0.0, 1.0]];
    assert_eq!(concerned(whole, Extent::PartlyFilled).len(), 0);
    assert_eq!(concerned(whole, Extent::Occupied).len(), 32);
    // Stretched twofold and flattened, compressed to a half, sheared by 1, and spread: a cell's share of points
    // differs from cell to cell, and only the last cells along an edge may count.
    for F in [[[2.0, 0.0], [0.0, 0.55]], [[0.45, 0.0], [0.0, 1.0]], [[1.0, 1.0], [0.0, 1.0]], [[2.1, 0.0], [0.0, 2.1]]]
    {
        let (length, height) = (2.0 * F[0][0], F[1][1]);
        for [i, j] in concerned(F, Extent::PartlyFilled) {
            // The middle of the cell in the frame of the undeformed block, and how far a cell reaches there.
            let [x, y] = [i, j].map(|k| 0.25 * (k as f64 + 0.5) - 0.5);
            let across = x - F[0][1] * y / F[1][1];
            let reach = 0.25 * (1.0 + F[0][1].abs());
            let inside = [across, y].into_iter().zip([length, height]).all(|(s, end)| s > reach && s < end - reach);
            assert!(!inside, "{F:?}: cell {i}, {j} lies inside");
        }
    }
}
