//! Tests of node numbers, and of a rank's window (part of the grid) against the whole grid.

use crate::support::random::Random;
use crate::support::scene::axis;
use bsmpm::error::{GridError, StepError};
use bsmpm::grid::{Grid, KnotVector, Shape};
use bsmpm::points::{Points, Seed};
use bsmpm::tensor::Vector;

/// Points at `places`, sorted by cell; ids count in the order given.
fn points_at<const D: usize>(grid: &Grid<D>, places: &[Vector<D>]) -> Points<D> {
    let seed = |(id, x): (usize, &Vector<D>)| Seed {
        id: id as u64,
        material: 0,
        x: *x,
        volume: 1.0,
        mass: 1.0,
        v: Vector::zeros(),
    };
    let mut points = Points::from_seeds(places.iter().enumerate().map(seed), false);
    points.sort_by_cell(grid);
    points
}

/// Per point, in the order of `shape`: global node along each axis with N and grad N.
fn table<const D: usize>(grid: &Grid<D>, shape: &Shape<D>) -> Vec<Vec<([usize; D], f64, Vector<D>)>> {
    let mut rows = Vec::new();
    for patch in shape.patches() {
        for p in patch.points.clone() {
            let nodes = shape
                .offsets()
                .iter()
                .map(|offset| grid.node_at(patch.first_node + offset));
            rows.push(
                nodes
                    .zip(shape.of(p))
                    .map(|(node, (N, grad))| (node, N, grad))
                    .collect(),
            );
        }
    }
    rows
}

#[test]
fn fig_1_point_to_node_connectivity() {
    let grid = Grid::new([axis(1.0, 4, 2), axis(1.0, 3, 2)]).unwrap();
    let points = points_at(&grid, &[Vector::from([1.5, 1.5]), Vector::from([3.5, 2.5])]);
    let shape = Shape::at(&grid, &points).unwrap();
    let found: Vec<Vec<usize>> = (shape.patches().iter())
        .map(|patch| {
            shape
                .offsets()
                .iter()
                .map(|offset| patch.first_node + offset + 1)
                .collect()
        })
        .collect();
    assert_eq!(found[0], [7, 8, 9, 12, 13, 14, 17, 18, 19]);
    assert_eq!(found[1], [18, 19, 20, 23, 24, 25, 28, 29, 30]);
    assert_eq!(grid.nodes(), 30);
}

fn partition_of_unity<const D: usize>(axes: [KnotVector; D]) -> (f64, f64) {
    let grid = Grid::new(axes).unwrap();
    let mut random = Random::new(D as u64);
    let place = |_| Vector::from_fn(|k, _| random.unit() * grid.axes()[k].length());
    let places: Vec<Vector<D>> = (0..200).map(place).collect();
    let shape = Shape::at(&grid, &points_at(&grid, &places)).unwrap();
    let sums = (0..shape.len()).map(|p| {
        let of = shape.of(p);
        let gradient = of.iter().fold(Vector::<D>::zeros(), |sum, (_, grad)| sum + grad);
        (
            (of.iter().map(|(N, _)| N).sum::<f64>() - 1.0).abs(),
            gradient.amax() * grid.smallest_edge(),
        )
    });
    sums.fold((0.0, 0.0), |worst, (unity, gradient)| {
        (unity.max(worst.0), gradient.max(worst.1))
    })
}

#[test]
fn functions_sum_to_one_and_gradients_to_zero_in_one_two_and_three_dimensions() {
    for order in 1..=3 {
        let graded = || KnotVector::graded(&[0.0, 0.2, 0.7, 0.8, 2.0], order).unwrap();
        for (unity, gradient) in [
            partition_of_unity([graded()]),
            partition_of_unity([axis(0.3, 5, order), graded()]),
            partition_of_unity([graded(), axis(0.3, 5, order), axis(2.0, 1, order)]),
        ] {
            println!("q = {order}: unity {unity:.1e}, gradients x smallest edge {gradient:.1e}");
            assert!(unity <= 1e-14 && gradient <= 1e-14); // measured 6.7e-16, 1.8e-16
        }
    }
}

fn windows_agree_with_the_whole<const D: usize>(axes: [KnotVector; D]) {
    let whole = Grid::new(axes).unwrap();
    let mut random = Random::new(7);
    let mut places: Vec<Vector<D>> = (0..300)
        .map(|_| Vector::from_fn(|k, _| random.unit() * whole.axes()[k].length()))
        .collect();
    places.push(Vector::from_fn(|k, _| whole.axes()[k].length()));
    places.push(Vector::from_fn(|k, _| whole.axes()[k].breakpoint(1)));
    let cells = whole.axes()[0].cells();
    let part = |rows: std::ops::Range<usize>| {
        let mut cells = whole.room().clone();
        (cells[0], cells[1]) = (1..3, rows);
        whole.window_of(cells)
    };
    let slabs = [0..2, 2..3, 3..cells, 0..cells].map(|columns| whole.window(columns));
    for window in slabs.into_iter().chain([part(0..1), part(1..2)]) {
        let mine = |x: &&Vector<D>| whole.locate(x).is_some_and(|cell| window.holds(&cell));
        let places: Vec<Vector<D>> = places.iter().filter(mine).copied().collect();
        let in_window = points_at(&window, &places);
        let in_whole = points_at(&whole, &places);
        assert_eq!(in_window, in_whole); // the canonical order is the same
        let local = Shape::at(&window, &in_window).unwrap();
        let global = Shape::at(&whole, &in_whole).unwrap();
        assert_eq!(table(&window, &local), table(&whole, &global)); // bit by bit
        let last = local.offsets()[local.offsets().len() - 1];
        assert!(
            local
                .patches()
                .iter()
                .all(|patch| patch.first_node + last < window.nodes())
        );
    }
}

#[test]
fn a_slabs_window_has_the_nodes_and_functions_of_the_whole_grid() {
    for order in 1..=3 {
        let graded = KnotVector::graded(&[0.0, 0.2, 0.7, 0.8, 2.0, 2.5], order).unwrap();
        windows_agree_with_the_whole([graded.clone(), axis(0.5, 3, order)]);
        windows_agree_with_the_whole([axis(0.4, 6, order), graded, axis(1.0, 2, order)]);
    }
}

#[test]
fn cell_and_node_numbers_are_inverse_to_each_other() {
    let whole = Grid::new([axis(1.0, 5, 2), axis(1.0, 3, 2), axis(1.0, 2, 2)]).unwrap();
    for grid in [whole.clone(), whole.window(2..4), whole.window_of([2..4, 1..2, 0..2])] {
        assert!((0..grid.cells()).all(|cell| grid.cell_index(&grid.cell_at(cell)) == cell));
        assert!((0..grid.nodes()).all(|node| grid.first_node(&grid.node_at(node)) == node));
    }
    assert_eq!((whole.nodes(), whole.window(2..4).nodes()), (7 * 5 * 4, 4 * 5 * 4));
    assert_eq!(whole.window(2..4).layers(), 2..6);
    let part = whole.window_of([2..4, 1..2, 0..2]);
    let layers = part.nodes_within(&[3..5, 1..4]);
    assert_eq!(
        (layers.len(), layers[0].clone()),
        (1, 12..36),
        "whole layers are one range"
    );
    assert_eq!(part.nodes_within(&[2..4, 2..3]), [4..8, 16..20]);
    assert!(part.nodes_within(&[3..3, 1..2]).is_empty() && part.is_parted() && !whole.window(2..4).is_parted());
    let reaching = whole.clone().reaching(1);
    assert_eq!(
        [2..4, 3..5].map(|columns| reaching.window(columns).layers()),
        [2..7, 3..7]
    );
}

#[test]
fn a_point_outside_the_grid_or_the_window_is_an_error_that_names_it() {
    let grid = Grid::new([axis(1.0, 4, 2), axis(1.0, 3, 2)]).unwrap();
    for x in [[-1e-12, 1.0], [1.0, 3.0 + 1e-12], [f64::NAN, 1.0]] {
        let found = Shape::at(&grid, &points_at(&grid, &[Vector::from(x)]));
        assert!(matches!(found, Err(StepError::Outside { id: 0, .. })), "{x:?}");
    }
    let window = grid.window(1..2);
    let found = Shape::at(&window, &points_at(&window, &[Vector::from([0.5, 0.5])]));
    assert!(matches!(found, Err(StepError::Outside { .. })));
}

#[test]
fn axes_of_different_order_are_refused() {
    assert_eq!(
        Grid::new([axis(1.0, 4, 2), axis(1.0, 4, 1)]).err(),
        Some(GridError::MixedOrders)
    );
}
