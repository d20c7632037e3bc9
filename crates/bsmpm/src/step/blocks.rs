//! Assembles parts that the matrices of theory-manual equations (T5.8), (T5.14) share: tangent moduli, mass and
//! interactions.

use crate::dynamics::mass::{MassMatrix, SHARE};
use crate::grid::Shape;
use crate::grid::shape::Patch;
use crate::kinematics::{Gradient, GradientModuli, Kinematics, Slope};
use crate::linear::MatrixAssembly;
use crate::nodal::Nodal;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;

/// Largest number of nodes of a point: cubic splines in three dimensions.
pub const MOST: usize = 64;

/// Node pairs (a, b) of a patch (occupied cell).
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Pairs {
    /// All pairs.
    All,
    /// Pairs with a <= b.
    Upper,
}

/// Adds grad N_a . moduli . grad N_b of one point to the block of its patch.
pub fn add_point<K: Kinematics<D>, const D: usize>(
    moduli: &GradientModuli<K, D>,
    slopes: &[Slope<K, D>],
    pairs: Pairs,
    block: &mut [f64],
) {
    let order = slopes.len() * D;
    let numbers = K::Gradient::SLOPES;
    for (a, of_a) in slopes.iter().enumerate() {
        // Entry (a i, b k) = sum_jl of_a[j] moduli[(k, l)][(i, j)] of_b[l], with the unit gradient (k, l) and the flux
        // (i, j). `along` is the sum over j, formed once per row. In a row, nodes b are consecutive in memory.
        let first = if pairs == Pairs::All { 0 } else { a };
        for i in 0..D {
            let row = &mut block[(a * D + i) * order..][..order];
            let along = K::Gradient::from_fn(|k, l| (0..numbers).map(|j| moduli[(k, l)][(i, j)] * of_a[j]).sum());
            for (entries, of_b) in row[first * D..].chunks_exact_mut(D).zip(&slopes[first..]) {
                for k in 0..D {
                    entries[k] += (0..numbers).map(|l| along[(k, l)] * of_b[l]).sum::<f64>();
                }
            }
        }
    }
}

/// Adds interactions and inertia to a matrix with assembled patches.
pub fn complete<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, matrix: &mut dyn MatrixAssembly) {
    let nodes = problem.nodes;
    let context = problem.context();
    for interaction in nodes.interactions.iter() {
        interaction.assemble(&context, matrix);
    }
    if let Some(inertia) = &nodes.inertia {
        let factors = (0..nodes.constraints.free.len()).map(|c| match problem.model.mass {
            MassMatrix::Lumped => inertia.factor_of(c),
            MassMatrix::Consistent => (1.0 - SHARE) * inertia.factor(),
        });
        let mut diagonal: Vec<f64> = factors
            .enumerate()
            .map(|(c, factor)| factor * nodes.weight[Nodal::<D>::node(c)])
            .collect();
        for interaction in nodes.interactions.iter() {
            interaction.add_damping(inertia, &mut diagonal);
        }
        matrix.add_diagonal(&diagonal);
    }
}

/// Adds the off-diagonal mass of a patch if the mass is consistent; [`complete`] adds the diagonal.
pub fn add_mass<const D: usize>(
    matrix: MassMatrix,
    nodes: &GridState<D>,
    shape: &Shape<D>,
    patch: &Patch,
    mass: &[f64],
    block: &mut [f64],
) {
    let Some(inertia) = nodes.inertia.as_ref().filter(|_| matrix == MassMatrix::Consistent) else {
        return;
    };
    let size = shape.offsets().len();
    let mut pairs = vec![0.0; size * size];
    let mut N = [0.0; MOST];
    let N = &mut N[..size];
    for p in patch.points.clone() {
        shape.values_into(p, N);
        let weight = SHARE * inertia.factor() * mass[p];
        for (row, N_a) in pairs.chunks_exact_mut(size).zip(&*N) {
            row.iter_mut()
                .zip(&*N)
                .for_each(|(pair, N_b)| *pair += weight * N_a * N_b);
        }
    }
    // Pair a * size + b has the entries (a D + i, b D + i) of a matrix with size * D columns.
    for (pair, mass) in pairs.iter().enumerate() {
        for i in 0..D {
            block[(pair / size * D + i) * size * D + pair % size * D + i] += mass;
        }
    }
}
