//! The ghost penalty: what it leaves alone and what it resists, on uniform and graded grids, and which faces have it.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use crate::support::solver::Dense;
use bsmpm::background::{Background, Blocks, Extent, Kind};
use bsmpm::grid::{Contributions, Grid, KnotVector, Shape};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::parallel::LinearSolver;

const YOUNG: f64 = 50.0;
const COEFFICIENT: f64 = 0.02;

/// Some cells of a grid are full, with a point in the middle of each; the penalty on their faces.
struct Faces<const D: usize> {
    grid: Grid<D>,
    shape: Shape<D>,
    blocks: Blocks,
}

impl<const D: usize> Faces<D> {
    fn of<K: Kinematics<D>>(axes: [KnotVector; D], extent: Extent) -> Self {
        let cells = axes.each_ref().map(|axis| 0..axis.cells());
        let scene = Scene::<K, D>::new(axes, hencky(YOUNG, 0.3), Regime::QuasiStatic).body(cells, 1, 1.0, |x| x * 0.0);
        let (grid, points) = (scene.model.grid.clone().reaching(Kind::GhostPenalty.beyond()), &scene.points);
        let shape = Shape::at(&grid, points).expect("points inside");
        let background = Background { kind: Kind::GhostPenalty, coefficient: COEFFICIENT, extent };
        let blocks = background.blocks::<K, D>(&grid, &shape, points, &scene.model.materials, &scene.halo());
        Self { grid, shape, blocks }
    }

    /// Forces against one scalar displacement of the nodes, the first component of D.
    fn force(&self, u: &[f64]) -> Vec<f64> {
        let vector: Vec<f64> = u.iter().flat_map(|&u| (0..D).map(move |c| if c == 0 { u } else { 0.0 })).collect();
        let mut force = Contributions::none(&self.grid, D, Vec::new());
        self.blocks.multiply::<D>(&self.shape, &vector, &mut force);
        let force = force.alone();
        assert!(force.iter().skip(1).step_by(D).all(|&force| force == 0.0), "components do not mix");
        force.into_iter().step_by(D).collect()
    }

    fn energy(&self, u: &[f64]) -> f64 {
        self.force(u).iter().zip(u).map(|(f, u)| f * u).sum()
    }

    /// Values of the nodes that make a product of functions of one coordinate, each given by its coefficients.
    fn nodal(&self, coefficients: impl Fn(usize, &KnotVector, usize) -> f64) -> Vec<f64> {
        let of = |node: usize| {
            let at = self.grid.node_at(node);
            (0..D).map(|axis| coefficients(axis, &self.grid.axes()[axis], at[axis])).product()
        };
        (0..self.grid.nodes()).map(of).collect()
    }
}

/// Coefficient of function `i` of x^p: the elementary symmetric polynomial of its q inner knots over its number of
/// terms.
fn power(axis: &KnotVector, p: usize, i: usize) -> f64 {
    let q = axis.order();
    let subsets = (0..1_usize << q).filter(|set| set.count_ones() as usize == p);
    let term = |set: usize| (0..q).filter(|j| set >> j & 1 == 1).map(|j| axis.knot(i + 1 + j)).product::<f64>();
    let terms: Vec<f64> = subsets.map(term).collect();
    terms.iter().sum::<f64>() / terms.len() as f64
}

/// Uneven cells, four to one at most.
fn graded(order: usize) -> KnotVector {
    KnotVector::graded(&[0.0, 0.5, 0.7, 1.5, 1.75], order).expect("a valid axis")
}

fn holds_no_polynomial_and_is_positive<K: Kinematics<D>, const D: usize>(order: usize) {
    let axes = std::array::from_fn(|axis| if axis == 0 { graded(order) } else { self::axis(0.25, 3, order) });
    let faces = Faces::<D>::of::<K>(axes, Extent::Occupied);
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let mut random = Random::new(5);
    let any: Vec<f64> = (0..faces.grid.nodes()).map(|_| random.signed()).collect();
    let scale = largest(&faces.force(&any));
    assert!(scale > 0.0 && faces.energy(&any) > 0.0);
    for powers in 0..(order + 1).pow(D as u32) {
        let p = |axis: usize| powers / (order + 1).pow(axis as u32) % (order + 1);
        let u = faces.nodal(|axis, knots, i| power(knots, p(axis), i));
        let held = largest(&faces.force(&u));
        // Rounding of third differences of at most 1.75^3, and of their products.
        assert!(held <= 1e-12 * scale * largest(&u), "order {order}, powers {powers}: {held:e} of {scale:e}");
    }
    let other: Vec<f64> = any.iter().map(|_| random.signed()).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let [one, two] = [dot(&faces.force(&any), &other), dot(&faces.force(&other), &any)];
    assert!((one - two).abs() <= 1e-12 * scale * any.len() as f64, "symmetric: {one} and {two}");
}

#[test]
fn it_is_symmetric_positive_and_leaves_every_polynomial_of_the_degree_alone() {
    for order in 1..=3 {
        holds_no_polynomial_and_is_positive::<PlaneStrain, 2>(order);
    }
    holds_no_polynomial_and_is_positive::<Solid, 3>(2);
}

/// u = (x - s)_+^q jumps by q! in its q-th derivative at the breakpoint s, and nowhere else: gamma E h^(2q-1) q!^2
/// times the area of the section.
#[test]
fn the_jump_of_a_truncated_power_is_exact() {
    for order in 1..=3 {
        let faces = Faces::<2>::of::<PlaneStrain>([graded(order), axis(0.25, 3, order)], Extent::Occupied);
        for (breakpoint, h) in [(1, 0.35), (2, 0.5), (3, 0.525)] {
            let truncated = |axis: usize, knots: &KnotVector, i: usize| {
                let s = knots.breakpoint(breakpoint);
                let beyond = axis == 0 && knots.knot(i + 1) > s;
                let product = (1..=order).map(|j| knots.knot(i + j) - s).product::<f64>();
                if axis == 1 { 1.0 } else { f64::from(u8::from(beyond)) * product }
            };
            let jump = (1..=order).product::<usize>() as f64;
            let exact = COEFFICIENT * YOUNG * f64::powi(h, 2 * order as i32 - 1) * jump * jump * 0.75;
            let found = faces.energy(&faces.nodal(truncated));
            assert!((found / exact - 1.0).abs() <= 1e-10, "order {order}, breakpoint {breakpoint}: {found} {exact}");
        }
    }
}

#[test]
fn it_is_free_of_scale() {
    let mut random = Random::new(7);
    for order in 1..=3 {
        let of = |h: f64| Faces::<2>::of::<PlaneStrain>([axis(h, 4, order), axis(2.0 * h, 3, order)], Extent::Occupied);
        let (small, large) = (of(0.125), of(0.25));
        let u: Vec<f64> = (0..small.grid.nodes()).map(|_| random.signed()).collect();
        assert_eq!(small.force(&u), large.force(&u), "order {order}: a plane's stiffness has no length");
    }
    let of = |h: f64| Faces::<3>::of::<Solid>([axis(h, 2, 2), axis(h, 3, 2), axis(2.0 * h, 2, 2)], Extent::Occupied);
    let (small, large) = (of(0.125), of(0.25));
    let u: Vec<f64> = (0..small.grid.nodes()).map(|_| random.signed()).collect();
    let doubled: Vec<f64> = small.force(&u).iter().map(|force| 2.0 * force).collect();
    assert_eq!(doubled, large.force(&u), "that of a solid grows with it");
}

#[test]
fn the_matrix_is_that_of_the_product() {
    let faces = Faces::<2>::of::<PlaneStrain>([graded(2), axis(0.25, 3, 2)], Extent::Occupied);
    let mut matrix = Dense::new(&faces.grid);
    matrix.begin(&vec![true; 2 * faces.grid.nodes()]);
    faces.blocks.assemble::<2>(&mut matrix);
    let mut u = vec![0.0; faces.grid.nodes()];
    let largest = (0..u.len()).map(|node| matrix.entry(2 * node, 2 * node)).fold(0.0, f64::max);
    for column in 0..u.len() {
        u[column] = 1.0;
        for (row, force) in faces.force(&u).into_iter().enumerate() {
            for component in 0..2 {
                let entry = matrix.entry(2 * row + component, 2 * column + component);
                assert!((entry - force).abs() <= 1e-14 * largest, "{row}, {column}: {entry} and {force}");
            }
            assert_eq!(matrix.entry(2 * row, 2 * column + 1), 0.0);
        }
        u[column] = 0.0;
    }
}

#[test]
fn faces_lie_between_occupied_cells_of_which_one_is_concerned() {
    // 4 x 3 full cells: 3 x 3 faces across the first axis and 4 x 2 across the second; none is partly filled.
    let count = |extent| Faces::<2>::of::<PlaneStrain>([graded(2), axis(0.25, 3, 2)], extent).blocks.count();
    assert_eq!((count(Extent::Occupied), count(Extent::PartlyFilled)), (17, 0));
}
