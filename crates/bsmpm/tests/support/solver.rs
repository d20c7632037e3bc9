//! Linear solvers on one rank, without MPI and PETSc.

use bsmpm::error::SolveError;
use bsmpm::grid::Grid;
use bsmpm::linear::{Krylov, LinearSolver, MatrixAssembly, SolveReport, Symmetry};
use nalgebra::{DMatrix, DVector};

/// Numbers of the unknowns, and which of them a block couples.
#[derive(Clone, Debug)]
struct Unknowns {
    components: usize,          // per node
    offsets: Vec<usize>,        // of a patch's nodes from its first one
    number: Vec<Option<usize>>, // of the unknown, per nodal component
}

/// Entry of a matrix.
struct Entry {
    row: usize,
    column: usize,
    value: f64,
}

impl Unknowns {
    fn of_patches(components: usize, offsets: Vec<usize>) -> Self {
        Self {
            components,
            offsets,
            number: Vec::new(),
        }
    }

    /// Numbers the free components; returns their count.
    fn renumber(&mut self, free: &[bool]) -> usize {
        let mut count = 0;
        let numbered = free.iter().map(|&free| {
            count += usize::from(free);
            free.then(|| count - 1)
        });
        self.number = numbered.collect();
        count
    }

    /// Returns the nodes of the patch with this first node.
    fn patch(&self, first_node: usize) -> Vec<usize> {
        self.offsets.iter().map(|offset| first_node + offset).collect()
    }

    /// Returns the entries of a dense row-major block of `nodes`.
    fn entries_among(&self, nodes: &[usize], block: &[f64]) -> Vec<Entry> {
        let of_node = |&node: &usize| (0..self.components).map(move |c| node * self.components + c);
        let unknowns: Vec<_> = nodes.iter().flat_map(of_node).map(|c| self.number[c]).collect();
        let mut entries = Vec::new();
        for (row, values) in unknowns.iter().zip(block.chunks_exact(unknowns.len())) {
            for (column, &value) in unknowns.iter().zip(values) {
                if let (&Some(row), &Some(column)) = (row, column) {
                    entries.push(Entry { row, column, value });
                }
            }
        }
        entries
    }

    /// Returns the entries of a diagonal.
    fn entries_of_diagonal(&self, diagonal: &[f64]) -> Vec<Entry> {
        let numbered = self.number.iter().zip(diagonal);
        numbered
            .filter_map(|(number, &value)| {
                number.map(|row| Entry {
                    row,
                    column: row,
                    value,
                })
            })
            .collect()
    }

    /// Returns the values of a nodal array at the unknowns.
    fn packed(&self, nodal: &[f64]) -> Vec<f64> {
        let at = |(number, value): (&Option<usize>, &f64)| number.map(|_| *value);
        self.number.iter().zip(nodal).filter_map(at).collect()
    }

    /// Fills a nodal array with the values `x` of the unknowns, and zero elsewhere. Fails if a value is not finite.
    fn unpack(&self, x: &[f64], nodal: &mut [f64]) -> Result<(), SolveError> {
        for (number, value) in self.number.iter().zip(nodal) {
            *value = number.map_or(0.0, |i| x[i]);
        }
        x.iter()
            .all(|x| x.is_finite())
            .then_some(())
            .ok_or(SolveError::NotFinite)
    }
}

/// Direct solver: L D L^T within the profile of the lower triangle. Without square roots its rounding does not depend
/// on the unit of stiffness. Refuses a matrix that is not positive definite, and a solution that is not finite.
#[derive(Clone, Debug)]
pub struct Skyline {
    unknowns: Unknowns,
    first: Vec<usize>, // first column of each row's profile
    entries: Vec<f64>, // row-major square: the matrix, then L below the diagonal and D on it
    water: Option<Box<Skyline>>,
}

impl Skyline {
    /// For the systems of `grid`, of the displacements and beside it of pore pressures.
    pub fn new<const D: usize>(grid: &Grid<D>) -> Self {
        let water = Some(Box::new(Self::of_patches(1, grid.lowered_offsets())));
        Self {
            water,
            ..Self::of_patches(D, grid.offsets())
        }
    }

    /// For patches whose nodes stand at `offsets` from their first one, with `components` unknowns a node.
    pub fn of_patches(components: usize, offsets: Vec<usize>) -> Self {
        Self {
            unknowns: Unknowns::of_patches(components, offsets),
            first: Vec::new(),
            entries: Vec::new(),
            water: None,
        }
    }

    fn size(&self) -> usize {
        self.first.len()
    }

    /// Adds the entries of the lower triangle.
    fn add(&mut self, entries: Vec<Entry>) {
        for Entry { row, column, value } in entries.into_iter().filter(|entry| entry.column <= entry.row) {
            let at = row * self.size() + column;
            self.first[row] = self.first[row].min(column);
            self.entries[at] += value;
        }
    }
}

impl MatrixAssembly for Skyline {
    fn reinit(&mut self, free: &[bool]) {
        let count = self.unknowns.renumber(free);
        self.first = (0..count).collect();
        self.entries = vec![0.0; count * count];
    }

    fn add_block(&mut self, first_node: usize, block: &[f64]) {
        self.add_block_among(&self.unknowns.patch(first_node), block);
    }

    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]) {
        self.add(self.unknowns.entries_among(nodes, block));
    }

    fn add_diagonal(&mut self, diagonal: &[f64]) {
        self.add(self.unknowns.entries_of_diagonal(diagonal));
    }
}

impl LinearSolver for Skyline {
    fn matrix(&mut self) -> &mut dyn MatrixAssembly {
        self
    }

    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        if symmetry == Symmetry::General {
            return Ok(()); // the product is all that `solve_with` looks at
        }
        let n = self.size();
        for i in 0..n {
            let (above, below) = self.entries.split_at_mut(i * n);
            let row = &mut below[..=i];
            let first = self.first[i];
            for j in first..i {
                let from = first.max(self.first[j]);
                let lower = &above[j * n + from..j * n + j];
                row[j] -= row[from..j].iter().zip(lower).map(|(u, l)| u * l).sum::<f64>();
            }
            for j in first..i {
                let factor = row[j] / above[j * n + j];
                row[i] -= factor * row[j];
                row[j] = factor;
            }
            if row[i].is_nan() || row[i] <= 0.0 {
                return Err(SolveError::Failed(format!("pivot {:e} of unknown {i} of {n}", row[i])));
            }
        }
        Ok(())
    }

    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        let n = self.size();
        let mut x = self.unknowns.packed(rhs);
        for i in 0..n {
            let row = &self.entries[i * n + self.first[i]..i * n + i];
            x[i] -= row.iter().zip(&x[self.first[i]..i]).map(|(l, x)| l * x).sum::<f64>();
        }
        for (i, x) in x.iter_mut().enumerate() {
            *x /= self.entries[i * n + i];
        }
        for i in (0..n).rev() {
            let row = &self.entries[i * n + self.first[i]..i * n + i];
            let value = x[i];
            x[self.first[i]..i]
                .iter_mut()
                .zip(row)
                .for_each(|(x, l)| *x -= l * value);
        }
        self.unknowns.unpack(&x, solution)?;
        Ok(SolveReport {
            iterations: 1,
            ..SolveReport::default()
        })
    }

    fn second_field(&mut self) -> Option<&mut dyn LinearSolver> {
        self.water.as_deref_mut().map(|water| water as &mut dyn LinearSolver)
    }

    /// Solves with the dense matrix of the product's columns: exact, whatever the operator is.
    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        _relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        let free: Vec<usize> = (0..rhs.len()).filter(|&c| self.unknowns.number[c].is_some()).collect();
        let mut unit = vec![0.0; rhs.len()];
        let mut image = vec![0.0; rhs.len()];
        let mut matrix = DMatrix::zeros(free.len(), free.len());
        for (column, &c) in free.iter().enumerate() {
            unit[c] = 1.0;
            product(&unit, &mut image);
            unit[c] = 0.0;
            free.iter()
                .enumerate()
                .for_each(|(row, &c)| matrix[(row, column)] = image[c]);
        }
        let right = DVector::from_vec(self.unknowns.packed(rhs));
        let x = matrix
            .lu()
            .solve(&right)
            .ok_or_else(|| SolveError::Failed("singular".into()))?;
        self.unknowns.unpack(x.as_slice(), solution)?;
        Ok(Krylov {
            iterations: free.len(),
            residual: 0.0,
        })
    }
}

/// A solver that refuses to factorise a number of times before it works: steps fail on demand.
#[derive(Clone, Debug)]
pub struct Reluctant {
    /// The solver behind it.
    pub solver: Skyline,
    /// Factorisations that it still refuses.
    pub refusals: usize,
}

impl LinearSolver for Reluctant {
    fn matrix(&mut self) -> &mut dyn MatrixAssembly {
        self.solver.matrix()
    }
    fn factorise(&mut self, symmetry: Symmetry) -> Result<(), SolveError> {
        if self.refusals == 0 {
            return self.solver.factorise(symmetry);
        }
        self.refusals -= 1;
        Err(SolveError::Failed("refused by the test".into()))
    }
    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, SolveError> {
        self.solver.solve(rhs, solution)
    }
    fn solve_with(
        &mut self,
        product: &mut dyn FnMut(&[f64], &mut [f64]),
        relative: f64,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Krylov, SolveError> {
        self.solver.solve_with(product, relative, rhs, solution)
    }
}

/// The whole matrix, to examine its spectrum.
#[derive(Clone, Debug)]
pub struct Dense {
    unknowns: Unknowns,
    matrix: DMatrix<f64>,
}

impl Dense {
    /// For the systems of `grid`.
    pub fn new<const D: usize>(grid: &Grid<D>) -> Self {
        Self::of_patches(D, grid.offsets())
    }

    /// For patches whose nodes stand at `offsets` from their first one, with `components` unknowns a node.
    pub fn of_patches(components: usize, offsets: Vec<usize>) -> Self {
        Self {
            unknowns: Unknowns::of_patches(components, offsets),
            matrix: DMatrix::zeros(0, 0),
        }
    }

    /// For the systems of pore pressures of `grid`.
    pub fn of_pressures<const D: usize>(grid: &Grid<D>) -> Self {
        Self::of_patches(1, grid.lowered_offsets())
    }

    fn add(&mut self, entries: Vec<Entry>) {
        for Entry { row, column, value } in entries {
            self.matrix[(row, column)] += value;
        }
    }

    /// Entry of two nodal components; zero where one of them is no unknown.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        self.unknowns.number[row]
            .zip(self.unknowns.number[column])
            .map_or(0.0, |at| self.matrix[at])
    }

    /// Product with a nodal array, zero where it is not free.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let image = &self.matrix * DVector::from_vec(self.unknowns.packed(x));
        let numbers = self.unknowns.number.iter();
        numbers.map(|number| number.map_or(0.0, |row| image[row])).collect()
    }

    /// Largest over smallest eigenvalue of the symmetric matrix: as it is, and scaled to a unit diagonal. Infinite if
    /// it is not positive definite to rounding.
    pub fn conditions(&self) -> [f64; 2] {
        let diagonal = self.matrix.diagonal();
        let scaled = self
            .matrix
            .map_with_location(|i, j, value| value / (diagonal[i] * diagonal[j]).sqrt());
        [self.matrix.clone(), scaled].map(|matrix| {
            let values = matrix.symmetric_eigenvalues();
            if values.min() > 0.0 {
                values.max() / values.min()
            } else {
                f64::INFINITY
            }
        })
    }
}

impl MatrixAssembly for Dense {
    fn reinit(&mut self, free: &[bool]) {
        let count = self.unknowns.renumber(free);
        self.matrix = DMatrix::zeros(count, count);
    }

    fn add_block(&mut self, first_node: usize, block: &[f64]) {
        self.add_block_among(&self.unknowns.patch(first_node), block);
    }

    fn add_block_among(&mut self, nodes: &[usize], block: &[f64]) {
        self.add(self.unknowns.entries_among(nodes, block));
    }

    fn add_diagonal(&mut self, diagonal: &[f64]) {
        self.add(self.unknowns.entries_of_diagonal(diagonal));
    }
}
