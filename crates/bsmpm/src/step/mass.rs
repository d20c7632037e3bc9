//! Mass matrix of the nodes, theory-manual equation (T2.8): lumped, or a blend of the consistent and the lumped matrix.
//! The transfer of velocities and the inertia use the same matrix, because two different matrices would create energy.

use crate::grid::{Shape, transfer};
use crate::nodal::Nodal;
use crate::parallel::{Halo, dots};

/// How the mass of the points becomes that of the nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassMatrix {
    /// `M_I = Σ_p N_Ip m_p`, diagonal: the paper's.
    #[default]
    Lumped,
    /// `(1 - s) Σ_p N_Ip m_p δ_IJ + s Σ_p N_Ip m_p N_Jp` with s = [`SHARE`].
    Consistent,
}

/// Part s of the consistent matrix that is consistent. As `0 <= x · M_c x <= x · M_l x`, the eigenvalues relative to
/// the lumped one lie in [1 - s, 1], whatever nodes a body hardly touches: solutions take some tens of iterations.
pub const SHARE: f64 = 0.95;

/// Square of the part of a momentum, in the norm of the kinetic energy, that a solution may leave.
const LEFT: f64 = 1e-24;

/// Iterations that a solution may take: with the eigenvalues of [`SHARE`] each leaves 0.64 of the error at most, and 80
/// reach 1e-12.
const MOST: usize = 120;

/// The mass matrix of a step. Fields are flat, D numbers a node of the window.
pub struct Mass<'a, const D: usize> {
    /// lumped or consistent
    pub matrix: MassMatrix,
    /// shape functions of the points
    pub shape: &'a Shape<D>,
    /// kg  of the points
    pub of_points: &'a [f64],
    /// kg  Σ_p N_Ip m_p of the nodes
    pub lumped: &'a [f64],
    /// kg  at and below which a node counts as massless
    pub threshold: f64,
    /// the other ranks
    pub halo: &'a dyn Halo,
}

impl<const D: usize> Mass<'_, D> {
    /// M times a nodal field: one exchange with the neighbours where M is consistent.
    pub fn times(&self, field: &[f64]) -> Vec<f64> {
        let lumped = field
            .iter()
            .enumerate()
            .map(|(c, value)| self.lumped[Nodal::<D>::node(c)] * value);
        if self.matrix == MassMatrix::Lumped {
            return lumped.collect();
        }
        let carried = transfer::to_points::<D, D, _>(self.shape, field, |p, v| v.map(|v| v * self.of_points[p]));
        let mut product = self
            .halo
            .assemble_ghosts(&transfer::to_nodes::<D, D>(self.shape, |p| carried[p]));
        for (sum, lumped) in product.iter_mut().zip(lumped) {
            *sum = SHARE * *sum + (1.0 - SHARE) * lumped;
        }
        product
    }

    /// The field whose momentum is `momentum` at every component that is not `held`, and which has the value of those
    /// that are. Massless nodes have none. Conjugate gradients with the lumped matrix where M is consistent, one
    /// exchange and two reductions an iteration.
    pub fn solve(&self, momentum: Vec<f64>, held: &[Option<f64>]) -> Vec<f64> {
        let mut x = self.by_lumped(momentum.clone());
        let scale = dots(self.halo, D, &[(&momentum, &x)])[0];
        x.iter_mut().zip(held).for_each(|(x, held)| *x = held.unwrap_or(*x));
        if self.matrix == MassMatrix::Lumped {
            return x;
        }
        let mut left: Vec<f64> = momentum
            .iter()
            .zip(self.times(&x))
            .map(|(b, product)| b - product)
            .collect();
        self.clear(&mut left, held);
        let mut towards = self.by_lumped(left.clone());
        let mut error = dots(self.halo, D, &[(&left, &towards)])[0];
        for _ in 0..MOST {
            if error <= LEFT * scale {
                break;
            }
            let mut product = self.times(&towards);
            self.clear(&mut product, held);
            let along = error / dots(self.halo, D, &[(&towards, &product)])[0];
            for (c, product) in product.into_iter().enumerate() {
                x[c] += along * towards[c];
                left[c] -= along * product;
            }
            let smoothed = self.by_lumped(left.clone());
            let next = dots(self.halo, D, &[(&left, &smoothed)])[0];
            towards
                .iter_mut()
                .zip(smoothed)
                .for_each(|(towards, smoothed)| *towards = smoothed + next / error * *towards);
            error = next;
        }
        x
    }

    /// The lumped matrix's solution.
    fn by_lumped(&self, mut momentum: Vec<f64>) -> Vec<f64> {
        transfer::divide(&mut momentum, self.lumped, self.threshold);
        momentum
    }

    /// Leaves out what is held, and massless nodes.
    fn clear(&self, field: &mut [f64], held: &[Option<f64>]) {
        for (c, value) in field.iter_mut().enumerate() {
            if held[c].is_some() || self.lumped[Nodal::<D>::node(c)] <= self.threshold {
                *value = 0.0;
            }
        }
    }
}
