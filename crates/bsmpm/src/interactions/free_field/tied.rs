//! Solves a free-field soil column, in which the nodes of a row share one displacement, with a band solver.

use crate::error::SolveError;
use crate::exact::Exact;
use crate::grid::{Contributions, Grid};
use crate::linear::{Krylov, LinearSolver, MatrixAssembly, SolveReport, Symmetry};
use crate::parallel::{Halo, OwnedNodes};

/// Largest number of iterative refinements.
const CORRECTIONS: usize = 100;

/// Halo of a column, a grid of one cell along axis 0: the nodes of a row share one displacement, and count once.
#[derive(Clone, Copy, Debug)]
pub struct TiedHalo {
    layer: usize, // nodes per layer
}

impl TiedHalo {
    /// Creates the halo of a grid of one cell along axis 0.
    pub fn of<const D: usize>(grid: &Grid<D>) -> Self {
        Self {
            layer: grid.layer_nodes(),
        }
    }

    /// Combines the numbers of all layers with `join`, and copies the result to every layer.
    fn fold(self, nodal: &mut [f64], width: usize, join: impl Fn(f64, f64) -> f64) {
        let (first, others) = nodal.split_at_mut(self.layer * width);
        for layer in others.chunks_exact(first.len()) {
            first
                .iter_mut()
                .zip(layer)
                .for_each(|(value, other)| *value = join(*value, *other));
        }
        others
            .chunks_exact_mut(first.len())
            .for_each(|layer| layer.copy_from_slice(first));
    }
}

impl Halo for TiedHalo {
    fn owned(&self) -> OwnedNodes {
        OwnedNodes::first(self.layer)
    }
    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64> {
        let mut nodal = contributions.alone();
        self.fold(&mut nodal, contributions.width(), |a, b| a + b);
        nodal
    }
    fn update_ghosts(&self, nodal: &mut [f64], width: usize) {
        self.fold(nodal, width, |own, _| own);
    }
    fn ghost_max(&self, nodal: &mut [f64], width: usize) {
        self.fold(nodal, width, f64::max);
    }
    fn all_reduce_sum(&self, _numbers: &mut [f64]) {}
    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64> {
        sums.iter().map(Exact::value).collect()
    }
    fn all_reduce_max(&self, _numbers: &mut [f64]) {}
}

/// LU factorisation of a column's band matrix, without pivoting. The entries of nodes that share an unknown are summed.
#[derive(Clone, Debug)]
pub struct Band {
    components: usize,          // per node
    offsets: Vec<usize>,        // of a cell's nodes from its first one
    layer: usize,               // components per layer
    half: usize,                // half bandwidth
    number: Vec<Option<usize>>, // index of the unknown, per component of a layer
    rows: Vec<f64>,             // 2 half + 1 entries per row; after factorisation L (unit diagonal) and U
}

impl Band {
    /// Creates the solver for a grid of one cell along axis 0.
    pub fn of<const D: usize>(grid: &Grid<D>) -> Self {
        let row = grid.layer_nodes() / grid.nodes_along(1);
        Self {
            components: D,
            offsets: grid.offsets(),
            layer: grid.layer_nodes() * D,
            half: D * grid.column_layers() * row,
            number: Vec::new(),
            rows: Vec::new(),
        }
    }

    fn unknowns(&self) -> usize {
        self.rows.len() / (2 * self.half + 1)
    }

    /// Returns the position of an entry: row `row` stores the columns `row - half` to `row + half`.
    fn at(&self, row: usize, column: usize) -> usize {
        row * (2 * self.half + 1) + column + self.half - row
    }

    /// Returns the values of the unknowns from the first layer of a nodal array.
    fn picked(&self, nodal: &[f64]) -> Vec<f64> {
        self.number
            .iter()
            .zip(nodal)
            .filter_map(|(number, value)| number.map(|_| *value))
            .collect()
    }

    /// Copies the unknowns to all layers of a nodal array; other components are 0.
    fn spread(&self, x: &[f64], solution: &mut [f64]) {
        for layer in solution.chunks_exact_mut(self.layer) {
            layer
                .iter_mut()
                .zip(&self.number)
                .for_each(|(value, number)| *value = number.map_or(0.0, |i| x[i]));
        }
    }

    /// Solves L U x = b by forward and back substitution.
    fn substituted(&self, mut x: Vec<f64>) -> Vec<f64> {
        let n = x.len();
        for i in 0..n {
            x[i] -= (i.saturating_sub(self.half)..i)
                .map(|j| self.rows[self.at(i, j)] * x[j])
                .sum::<f64>();
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..(i + self.half + 1).min(n))
                .map(|j| self.rows[self.at(i, j)] * x[j])
                .sum();
            x[i] = (x[i] - known) / self.rows[self.at(i, i)];
        }
        x
    }
}

impl MatrixAssembly for Band {
    fn reinit(&mut self, free: &[bool]) {
        let mut count = 0;
        let numbered = free[..self.layer].iter().map(|&free| {
            count += usize::from(free);
            free.then(|| count - 1)
        });
        self.number = numbered.collect();
        self.rows = vec![0.0; count * (2 * self.half + 1)];
    }

    fn add_block(&mut self, first_node: usize, block: &[f64]) {
        let nodes: Vec<usize> = self.offsets.iter().map(|offset| first_node + offset).collect();
        self.add_block_among(&nodes, block);
    }

    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]) {
        let components = self.components;
        let of_nodes = nodes
            .iter()
            .flat_map(|&node| (0..components).map(move |c| node * components + c));
        let unknowns: Vec<_> = of_nodes.map(|c| self.number[c % self.layer]).collect();
        for (row, values) in unknowns.iter().zip(block.chunks_exact(unknowns.len())) {
            for (column, value) in unknowns.iter().zip(values) {
                if let (Some(row), Some(column)) = (row, column) {
                    let at = self.at(*row, *column);
                    self.rows[at] += value;
                }
            }
        }
    }

    fn add_diagonal(&mut self, diagonal: &[f64]) {
        for (c, value) in diagonal.iter().enumerate().take(self.layer) {
            if let Some(row) = self.number[c] {
                let at = self.at(row, row);
                self.rows[at] += value;
            }
        }
    }
}

impl LinearSolver for Band {
    fn matrix(&mut self) -> &mut dyn MatrixAssembly {
        self
    }

    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        let n = self.unknowns();
        for k in 0..n {
            let pivot = self.rows[self.at(k, k)];
            let is_wrong = if symmetry == Symmetry::Definite {
                pivot <= 0.0
            } else {
                pivot == 0.0
            };
            if is_wrong || !pivot.is_finite() {
                return Err(SolveError::Failed(format!(
                    "free field: pivot {pivot:e} of unknown {k} of {n}"
                )));
            }
            for i in k + 1..(k + self.half + 1).min(n) {
                let of_k = self.at(i, k);
                let factor = self.rows[of_k] / pivot;
                self.rows[of_k] = factor;
                if factor != 0.0 {
                    for j in k + 1..(k + self.half + 1).min(n) {
                        let at = self.at(i, j);
                        let above = self.at(k, j);
                        self.rows[at] -= factor * self.rows[above];
                    }
                }
            }
        }
        Ok(())
    }

    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        let x = self.substituted(self.picked(rhs));
        if !x.iter().all(|x| x.is_finite()) {
            return Err(SolveError::NotFinite);
        }
        self.spread(&x, solution);
        Ok(SolveReport {
            iterations: 1,
            ..SolveReport::default()
        })
    }

    /// Solves by iterative refinement while the residual decreases. The matrix equals that of `product` except for
    /// averages that couple distant nodes.
    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        let right = self.picked(rhs);
        let scale = norm(&right);
        let mut x = vec![0.0; right.len()];
        let mut left = right.clone();
        let mut residual = 1.0;
        let mut trial = vec![0.0; rhs.len()];
        let mut image = vec![0.0; rhs.len()];
        let mut iterations = 0;
        while residual > relative && scale > 0.0 && iterations < CORRECTIONS {
            let better: Vec<f64> = self
                .substituted(left.clone())
                .iter()
                .zip(&x)
                .map(|(dx, x)| x + dx)
                .collect();
            self.spread(&better, &mut trial);
            product(&trial, &mut image);
            let remains: Vec<f64> = right.iter().zip(self.picked(&image)).map(|(b, Ax)| b - Ax).collect();
            iterations += 1;
            let found = norm(&remains) / scale;
            if !found.is_finite() || found >= residual {
                break;
            }
            (x, left, residual) = (better, remains, found);
        }
        if scale > 0.0 && residual >= 1.0 {
            return Err(SolveError::Residual(residual));
        }
        self.spread(&x, solution);
        Ok(Krylov {
            iterations,
            residual: if scale > 0.0 { residual } else { 0.0 },
        })
    }
}

/// Returns the Euclidean norm.
fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
