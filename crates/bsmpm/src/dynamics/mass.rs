//! Mass matrix of the nodes, theory-manual equation (T2.8): lumped, or a blend of the consistent and the lumped matrix.

use crate::grid::{Shape, transfer};
use crate::nodal::Nodal;
use crate::parallel::{Halo, dot};

/// Nodal mass matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassMatrix {
    /// `M_I = Σ_p N_Ip m_p`, diagonal, as in the paper.
    #[default]
    Lumped,
    /// `(1 - s) Σ_p N_Ip m_p δ_IJ + s Σ_p N_Ip m_p N_Jp` with s = [`SHARE`].
    Consistent,
}

/// Fraction s of the consistent matrix in the blend. As `0 <= x · M_c x <= x · M_l x`, the eigenvalues relative to the
/// lumped matrix are in [1 - s, 1] even if a body barely touches some nodes. Solutions take some tens of iterations.
pub const SHARE: f64 = 0.95;

/// Tolerance of a solution: square of the relative residual momentum in the norm of the kinetic energy.
const LEFT: f64 = 1e-24;

/// Largest number of iterations. With the eigenvalues of [`SHARE`], each iteration reduces the error to at most 0.64,
/// and 80 iterations reach 1e-12.
const MOST: usize = 120;

/// Mass matrix of a step. Fields are flat, D numbers per node of the window.
pub struct Mass<'a, const D: usize> {
    /// Lumped or consistent.
    pub matrix: MassMatrix,
    /// Shape functions at the points.
    pub shape: &'a Shape<D>,
    /// Masses of the points (kg).
    pub of_points: &'a [f64],
    /// Lumped nodal masses Σ_p N_Ip m_p (kg).
    pub lumped: &'a [f64],
    /// Mass at and below which a node counts as massless (kg).
    pub threshold: f64,
    /// Communication with the other ranks.
    pub halo: &'a dyn Halo,
}

impl<const D: usize> Mass<'_, D> {
    /// Multiplies M by a nodal field. One exchange with the neighbours if M is consistent.
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

    /// Solves for the field with the given `momentum` at every component that is not `held`, and the prescribed values
    /// at those that are. Massless nodes have no momentum. A consistent M uses conjugate gradients, preconditioned by
    /// the lumped matrix: one exchange and two reductions per iteration.
    pub fn solve(&self, momentum: Vec<f64>, held: &[Option<f64>]) -> Vec<f64> {
        let mut x = self.by_lumped(momentum.clone());
        let scale = dot(self.halo, D, &momentum, &x);
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
        let mut error = dot(self.halo, D, &left, &towards);
        for _ in 0..MOST {
            if error <= LEFT * scale {
                break;
            }
            let mut product = self.times(&towards);
            self.clear(&mut product, held);
            let along = error / dot(self.halo, D, &towards, &product);
            for (c, product) in product.into_iter().enumerate() {
                x[c] += along * towards[c];
                left[c] -= along * product;
            }
            let smoothed = self.by_lumped(left.clone());
            let next = dot(self.halo, D, &left, &smoothed);
            towards
                .iter_mut()
                .zip(smoothed)
                .for_each(|(towards, smoothed)| *towards = smoothed + next / error * *towards);
            error = next;
        }
        x
    }

    /// Solves with the lumped matrix.
    fn by_lumped(&self, mut momentum: Vec<f64>) -> Vec<f64> {
        transfer::divide(&mut momentum, self.lumped, self.threshold);
        momentum
    }

    /// Sets held components and massless nodes to zero.
    fn clear(&self, field: &mut [f64], held: &[Option<f64>]) {
        for (c, value) in field.iter_mut().enumerate() {
            if held[c].is_some() || self.lumped[Nodal::<D>::node(c)] <= self.threshold {
                *value = 0.0;
            }
        }
    }
}
