//! Tests that the number of memory allocations in a residual evaluation does not depend on the number of points.

use crate::support::scene::{METHODS, Scene, axis, hencky};
use bsmpm::grid::Shape;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::problem::Problem;
use bsmpm::step::residual::Residual;
use bsmpm::tensor::Vector;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator, counting what each thread asks for.
struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call goes to the system's allocator unchanged; the count is no memory of it, needs none and no
// destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: the caller's promises are those that the system's allocator asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as above.
        unsafe { System.realloc(place, layout, size) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of one evaluation of the residual, with `per_axis`^2 points a cell.
fn allocations(per_axis: usize, method: Stabilisation) -> usize {
    let scene = Scene::<PlaneStrain, 2>::new([axis(1.0, 12, 2), axis(1.0, 6, 2)], hencky(100.0, 0.3), Regime::Dynamic)
        .body([1..9, 0..5], per_axis, 1.0, |_| Vector::zeros())
        .gravity(9.81, 0.0)
        .stabilised(method);
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).expect("points in the grid");
    let nodes = scene.nodes(&shape, 0.1);
    let pieces = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let u: Vec<f64> = (0..model.grid.nodes() * 2).map(|c| 1e-3 * (c as f64).sin()).collect();
    let evaluate = || Residual::of(&pieces, &u).balance.norm;
    assert!(evaluate() > 0.0);
    let before = COUNT.get();
    let _ = evaluate();
    COUNT.get() - before
}

#[test]
fn an_iteration_allocates_as_often_whatever_the_number_of_points() {
    // One thread does all of it; what others allocate meanwhile does not count.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread starts");
    for method in METHODS {
        let counts = pool.install(|| [1, 2, 6].map(|per_axis| allocations(per_axis, method)));
        println!("{method:?}: {counts:?}");
        assert!(
            counts[0] == counts[1] && counts[1] == counts[2] && (1..40).contains(&counts[0]),
            "{method:?}: {counts:?}"
        );
    }
}
