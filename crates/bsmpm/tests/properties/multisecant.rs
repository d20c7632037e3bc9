//! Tests of the multisecant method on linear problems, where it is equivalent to GMRES, and of packed vectors.

use crate::support::random::Random;
use crate::support::solver::Skyline;
use bsmpm::exact::Exact;
use bsmpm::grid::Contributions;
use bsmpm::linear::{LinearSolver, Symmetry};
use bsmpm::method::QuasiNewton;
use bsmpm::parallel::{Alone, Halo, OwnedNodes, dot};
use bsmpm::solve::quasi_newton::Secants;
use bsmpm::solve::unknowns::Unknowns;
use nalgebra::{DMatrix, DVector};

const NODES: usize = 9;
const SIZE: usize = 2 * NODES;

/// Components held here and there, and a whole node.
fn free() -> [bool; SIZE] {
    std::array::from_fn(|c| ![0, 3, 8, 9, 17].contains(&c))
}

fn zero_where_held(vector: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(SIZE, |c, _| if free()[c] { vector[c] } else { 0.0 })
}

/// A symmetric positive matrix whose rows and columns of held components are those of the identity.
fn matrix(random: &mut Random, spread: f64) -> DMatrix<f64> {
    let A = DMatrix::from_fn(SIZE, SIZE, |_, _| spread * random.signed());
    let full = &A * A.transpose() / SIZE as f64 + DMatrix::identity(SIZE, SIZE);
    let both = |i: usize, j: usize| free()[i] && free()[j];
    DMatrix::from_fn(SIZE, SIZE, |i, j| {
        if both(i, j) {
            full[(i, j)]
        } else {
            f64::from(u8::from(i == j))
        }
    })
}

#[test]
fn a_linear_problem_takes_one_direction_more_than_it_has_unknowns_whatever_is_factorised() {
    let unknowns = free().iter().filter(|free| **free).count();
    for seed in 0..10 {
        let mut random = Random::new(seed);
        let K = matrix(&mut random, 2.0);
        let K_0 = matrix(&mut random, 0.5);
        let halo = Alone { nodes: NODES };
        let mut solver = Skyline::of_patches(2, (0..NODES).collect());
        solver.matrix().reinit(&free());
        solver.matrix().add_block(0, K_0.as_slice());
        solver.factorise(Symmetry::Definite).unwrap();
        let mut secants = Secants::new::<2>(QuasiNewton::Multisecant, &free(), &halo);
        let b = zero_where_held(&DVector::from_vec(random.array(SIZE)));
        let mut u = DVector::zeros(SIZE);
        let mut norms = vec![b.norm()];
        for _ in 0..=unknowns {
            let f = zero_where_held(&(&b - &K * &u));
            let found = secants.direction::<2>(f.as_slice(), &halo, &mut solver).unwrap();
            let du = DVector::from_vec(found.du);
            assert_eq!(zero_where_held(&du), du);
            assert!((found.energy - du.dot(&f)).abs() <= 1e-10 * du.norm() * f.norm());
            secants.took(1.0);
            u += du;
            norms.push(zero_where_held(&(&b - &K * &u)).norm());
        }
        let first = norms[0];
        let last = norms[norms.len() - 1];
        assert!(last <= 1e-8 * first && norms[2] > 1e-3 * first, "{norms:?}");
    }
}

#[test]
fn packed_vectors_have_the_products_of_nodal_ones_and_come_back() {
    let mut random = Random::new(4);
    let halo = Alone { nodes: NODES };
    let unknowns = Unknowns::of::<2>(&free(), &halo);
    let vector = |random: &mut Random| zero_where_held(&DVector::from_vec(random.array(SIZE)));
    let a = vector(&mut random);
    let b = vector(&mut random);
    let packed_a = unknowns.packed(a.as_slice());
    let packed_b = unknowns.packed(b.as_slice());
    assert_eq!(packed_a.len(), free().iter().filter(|free| **free).count());
    let whole = dot(&halo, 2, a.as_slice(), b.as_slice());
    assert!((unknowns.dots([&packed_a], &packed_b)[0].value() - whole).abs() <= 1e-14);
    let mut nodal = vec![0.0; SIZE];
    unknowns.unpack(&packed_a, &mut nodal);
    assert_eq!(nodal, a.as_slice());
}

/// A rank with three layers of three nodes, of which two of each of the first two are its own: a part of a slab.
struct Between;

impl Halo for Between {
    fn owned(&self) -> OwnedNodes {
        OwnedNodes::new(2, 3, 2)
    }
    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64> {
        contributions.alone()
    }
    fn update_ghosts(&self, _: &mut [f64], _: usize) {}
    fn ghost_max(&self, _: &mut [f64], _: usize) {}
    fn all_reduce_sum(&self, _: &mut [f64]) {}
    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64> {
        sums.iter().map(Exact::value).collect()
    }
    fn all_reduce_max(&self, _: &mut [f64]) {}
}

#[test]
fn ghosts_do_not_count_twice() {
    let mut random = Random::new(5);
    let a = random.array(SIZE);
    let b = random.array(SIZE);
    let unknowns = Unknowns::of::<2>(&free(), &Between);
    let own: f64 = (0..4).chain(6..10).filter(|&c| free()[c]).map(|c| a[c] * b[c]).sum();
    assert_eq!(
        (0..9)
            .filter(|&node| Between.owned().contains(node))
            .collect::<Vec<_>>(),
        [0, 1, 3, 4]
    );
    assert_eq!(
        Between.owned().places::<2>().collect::<Vec<_>>(),
        [0, 1, 2, 3, 6, 7, 8, 9]
    );
    let found = unknowns.dots([&unknowns.packed(&a)], &unknowns.packed(&b))[0].value();
    assert!((found - own).abs() <= 1e-14 && own.abs() > 1e-3, "{found} {own}");
}
