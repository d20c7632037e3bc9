//! Multigrid preconditioner over B-spline grids, on one rank.
//!
//! A coarser grid has every second breakpoint. The smoother is a Chebyshev polynomial of an additive Schwarz method on
//! overlapping boxes of 4 nodes along each axis. The splines of a box can represent divergence-free fields, so the
//! number of iterations does not grow with the bulk modulus (de Prenter et al., 2020; Pé de la Riva et al., 2019).

mod patches;
#[cfg(test)]
mod tests;
mod transfer;

use crate::stencil::Stencil;
use bsmpm::grid::Grid;
use patches::Patches;
use transfer::Transfer;

/// Nodes along an axis of a patch of the smoother, and distance between the first nodes of two patches.
const PATCH: [usize; 2] = [4, 3];
/// Number of free components up to which a level is solved directly.
const FEW: usize = 1000;
/// Iterations of the power method, and factor on its eigenvalue that makes it an upper bound.
const POWER: (usize, f64) = (8, 1.2);
/// Fraction of the largest eigenvalue above which the smoother damps.
const SMOOTHED: f64 = 0.1;

/// Matrix on a window.
#[derive(Clone, Copy)]
pub struct Operator<'a, const D: usize, const C: usize> {
    /// Blocks of the window's nodes.
    pub stencil: &'a Stencil<D, C>,
    /// Which components are unknowns.
    pub free: &'a [bool],
}

/// Matrix on a coarse grid.
struct CoarseOperator<const D: usize, const C: usize> {
    stencil: Stencil<D, C>,
    free: Vec<bool>,
}

impl<const D: usize, const C: usize> CoarseOperator<D, C> {
    fn operator(&self) -> Operator<'_, D, C> {
        Operator {
            stencil: &self.stencil,
            free: &self.free,
        }
    }
}

/// All levels of a matrix, the finest first. The caller keeps the finest matrix.
pub struct Multigrid<const D: usize, const C: usize> {
    levels: Vec<Level<D, C>>,
}

struct Level<const D: usize, const C: usize> {
    own: Option<CoarseOperator<D, C>>, // on all levels but the finest
    patches: Patches,
    bound: f64,                   // upper bound of the eigenvalues of the preconditioned matrix
    coarser: Option<Transfer<D>>, // `None` on the coarsest level, which one patch solves
}

impl<const D: usize, const C: usize> Multigrid<D, C> {
    /// Creates the levels of a matrix on a window that is the whole active domain. Returns `None` if a patch of it is
    /// not positive definite.
    pub fn new(grid: &Grid<D>, finest: Operator<'_, D, C>) -> Option<Self> {
        let mut levels = Vec::new();
        let mut grid = grid.clone();
        let mut own = None::<CoarseOperator<D, C>>;
        loop {
            let operator = own.as_ref().map_or(finest, CoarseOperator::operator);
            let coarser = if count(operator.free) > FEW {
                Transfer::new(&grid)
            } else {
                None
            };
            let along: [usize; D] = std::array::from_fn(|axis| grid.nodes_along(axis));
            let Some((coarse, transfer)) = coarser else {
                let whole = along.iter().copied().fold(1, usize::max);
                let patches = Patches::new(operator, along, whole, whole)?;
                levels.push(Level {
                    own,
                    patches,
                    bound: 1.0,
                    coarser: None,
                });
                return Some(Self { levels });
            };
            let patches = Patches::new(operator, along, PATCH[0], PATCH[1])?;
            let bound = largest_eigenvalue(operator, &patches);
            let next = transfer.galerkin(operator, &coarse);
            levels.push(Level {
                own: own.take(),
                patches,
                bound,
                coarser: Some(transfer),
            });
            (grid, own) = (coarse, Some(next));
        }
    }

    /// Computes x = B b for nodal arrays by `cycles` cycles, each for the residual of the one before.
    pub fn apply(&self, finest: Operator<'_, D, C>, cycles: usize, b: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        let mut left = b.to_vec();
        let mut step = vec![0.0; b.len()];
        for number in 0..cycles {
            if number > 0 {
                subtract_product(finest, &step, &mut left);
            }
            self.cycle(0, finest, &left, &mut step);
            x.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
        }
    }

    fn cycle(&self, number: usize, finest: Operator<'_, D, C>, b: &[f64], x: &mut [f64]) {
        let level = &self.levels[number];
        let operator = level.own.as_ref().map_or(finest, CoarseOperator::operator);
        x.fill(0.0);
        let Some(transfer) = &level.coarser else {
            return level.patches.add(b, x);
        };
        let mut left = b.to_vec();
        let last = level.smooth(operator, &mut left, x);
        subtract_product(operator, &last, &mut left);
        let coarse = transfer.restrict::<C>(&left);
        let mut below = vec![0.0; coarse.len()];
        self.cycle(number + 1, finest, &coarse, &mut below);
        let mut step = transfer.prolong::<C>(&below);
        step.iter_mut()
            .zip(operator.free)
            .filter(|(_, free)| !**free)
            .for_each(|(step, _)| *step = 0.0);
        subtract_product(operator, &step, &mut left);
        x.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
        level.smooth(operator, &mut left, x);
    }
}

impl<const D: usize, const C: usize> Level<D, C> {
    /// Adds two steps of Chebyshev's method for the residual `left` to `x`. Returns the second step, whose product with
    /// the matrix is not yet subtracted from `left`.
    fn smooth(&self, operator: Operator<'_, D, C>, left: &mut [f64], x: &mut [f64]) -> Vec<f64> {
        // Chebyshev iteration for the eigenvalues from `lower` to `upper` (Saad, 2003, algorithm 12.1): with theta =
        // middle, delta = half and rho_0 = delta/theta, d_0 = z_0/theta, rho_1 = 1/(2/rho_0 - rho_0) and d_1 = rho_1
        // rho_0 d_0 + 2 rho_1/delta z_1. The products with rho_0 delta/2 and 2 rho_1/delta form both terms of d_1.
        let upper = self.bound;
        let lower = SMOOTHED * self.bound;
        let middle = 0.5 * (upper + lower);
        let half = 0.5 * (upper - lower);
        let mut step = vec![0.0; left.len()];
        self.patches.add(left, &mut step);
        step.iter_mut().for_each(|step| *step /= middle);
        x.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
        subtract_product(operator, &step, left);
        let first = half / middle;
        let second = 1.0 / (2.0 / first - first);
        step.iter_mut().for_each(|step| *step *= 0.5 * first * half);
        self.patches.add(left, &mut step);
        step.iter_mut().for_each(|step| *step *= 2.0 * second / half);
        x.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
        step
    }
}

/// Computes b -= A x.
fn subtract_product<const D: usize, const C: usize>(operator: Operator<'_, D, C>, x: &[f64], b: &mut [f64]) {
    let mut image = vec![0.0; x.len()];
    operator.stencil.multiply(operator.free, x, &mut image);
    b.iter_mut().zip(&image).for_each(|(b, image)| *b -= image);
}

/// Estimates the largest eigenvalue of the matrix preconditioned by the patches, with a margin: by the power method
/// from a random vector, which contains all eigenvectors.
fn largest_eigenvalue<const D: usize, const C: usize>(operator: Operator<'_, D, C>, patches: &Patches) -> f64 {
    let Operator { stencil, free } = operator;
    let mut state = 1_u32;
    let mut x = vec![0.0; free.len()];
    for (x, _) in x.iter_mut().zip(free).filter(|(_, free)| **free) {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *x = f64::from(state) / f64::from(u32::MAX) - 0.5;
    }
    let mut image = vec![0.0; x.len()];
    let mut largest = 1.0;
    for _ in 0..POWER.0 {
        stencil.multiply(free, &x, &mut image);
        x.fill(0.0);
        patches.add(&image, &mut x);
        largest = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        x.iter_mut().for_each(|x| *x /= largest);
    }
    largest * POWER.1
}

fn count(free: &[bool]) -> usize {
    free.iter().filter(|free| **free).count()
}
