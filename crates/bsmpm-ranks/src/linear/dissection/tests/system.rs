//! Linear systems with known solutions.

use super::super::Dissection;
use super::super::factor::Precision;
use crate::halo::Link;
use crate::slab::Slabs;
use crate::stencil::Stencil;
use bsmpm::grid::{Grid, KnotVector};
use bsmpm::nodal::Nodal;
use nalgebra::{DMatrix, DVector};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

/// A number in 0..1 that looks random.
pub fn noise(seed: usize) -> f64 {
    let mixed = (seed as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    ((mixed ^ (mixed >> 32)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Channels to and from every rank.
struct Wire {
    to: Vec<SyncSender<Vec<f64>>>,
    from: Vec<Receiver<Vec<f64>>>,
    delay: usize,
}

impl Link for Wire {
    fn send(&self, to: usize, numbers: &[f64]) {
        std::thread::sleep(Duration::from_micros(
            (noise(self.delay + to + numbers.len()) * 2000.0) as u64,
        ));
        self.to[to].send(numbers.to_vec()).unwrap();
    }

    fn receive(&self, from: usize) -> Vec<f64> {
        self.from[from].recv().unwrap()
    }
}

fn wires(ranks: usize, delay: usize) -> Vec<Wire> {
    let mut wires: Vec<Wire> = (0..ranks)
        .map(|rank| Wire {
            to: Vec::new(),
            from: Vec::new(),
            delay: delay * (rank + 1),
        })
        .collect();
    for from in 0..ranks {
        for to in 0..ranks {
            let (sender, receiver) = sync_channel(0); // as large messages do, a send waits until it is received
            wires[from].to.push(sender);
            wires[to].from.push(receiver);
        }
    }
    wires
}

/// A made-up system of C unknowns a node on a grid, of which some cells are empty and some components held.
pub struct System<const C: usize> {
    pub grid: Grid<2>,
    pub slabs: Slabs,
    pub gap: std::ops::Range<usize>, // columns of empty cells
}

impl<const C: usize> System<C> {
    pub fn new([columns, rows]: [usize; 2], order: usize, bounds: &[usize]) -> Self {
        let axis = |cells| KnotVector::uniform(1.0, cells, order).unwrap();
        let slabs = Slabs::new(bounds.to_vec(), bounds.len() - 1, 0..columns).unwrap();
        Self {
            grid: Grid::new([axis(columns), axis(rows)]).unwrap(),
            slabs,
            gap: 0..0,
        }
    }

    /// The same, with every slab cut into parts.
    pub fn parted(cells: [usize; 2], order: usize, bounds: &[usize], parts: &[&[usize]]) -> Self {
        let system = Self::new(cells, order, bounds);
        let parts = parts.iter().map(|part| part.to_vec()).collect();
        let slabs = system.slabs.parted(parts, &(0..cells[1])).unwrap();
        Self { slabs, ..system }
    }

    /// Numbers in the whole grid of the nodal components of a window.
    fn components(&self, window: &Grid<2>) -> Vec<usize> {
        (0..window.nodes())
            .flat_map(|node| Nodal::<C>::of(window.number_of(node)))
            .collect()
    }

    /// The window of a rank.
    fn window(&self, rank: usize) -> Grid<2> {
        self.grid.window_of(self.slabs.cells(rank, self.grid.room()))
    }

    /// Positive definite block of a cell, or none.
    fn block(&self, cell: usize) -> Option<DMatrix<f64>> {
        let size = self.grid.cell_nodes() * C;
        let g = DMatrix::from_fn(size, size, |i, j| noise((cell * size + i) * size + j) - 0.5);
        let empty = noise(cell) >= 0.9 || self.gap.contains(&self.grid.cell_at(cell)[0]);
        (!empty).then(|| &g * g.transpose() + 0.1 * DMatrix::identity(size, size))
    }

    /// Nodes of a cell of the whole grid.
    fn nodes(&self, cell: usize) -> Vec<usize> {
        let first = self.grid.first_node(&self.grid.cell_at(cell));
        self.grid.offsets().iter().map(|offset| first + offset).collect()
    }

    pub fn free(&self) -> Vec<bool> {
        let mut free = vec![false; self.grid.nodes() * C];
        for cell in (0..self.grid.cells()).filter(|&cell| self.block(cell).is_some()) {
            self.nodes(cell)
                .into_iter()
                .flat_map(|node| C * node..C * (node + 1))
                .for_each(|c| free[c] = noise(c) < 0.95);
        }
        free
    }

    fn rhs(&self) -> Vec<f64> {
        (0..self.grid.nodes() * C)
            .map(|component| noise(component) - 0.5)
            .collect()
    }

    fn dense_solution(&self) -> Vec<f64> {
        let free = self.free();
        let size = free.len();
        let mut matrix = DMatrix::identity(size, size);
        free.iter()
            .enumerate()
            .filter(|(_, free)| **free)
            .for_each(|(c, _)| matrix[(c, c)] = 0.0);
        for (cell, block) in (0..self.grid.cells()).filter_map(|cell| Some((cell, self.block(cell)?))) {
            let components: Vec<usize> = self
                .nodes(cell)
                .into_iter()
                .flat_map(|node| C * node..C * (node + 1))
                .collect();
            for (i, &row) in components.iter().enumerate().filter(|(_, row)| free[**row]) {
                for (j, &column) in components.iter().enumerate().filter(|(_, column)| free[**column]) {
                    matrix[(row, column)] += block[(i, j)];
                }
            }
        }
        let rhs = self
            .rhs()
            .into_iter()
            .zip(&free)
            .map(|(value, &free)| if free { value } else { 0.0 });
        matrix
            .cholesky()
            .unwrap()
            .solve(&DVector::from_iterator(size, rhs))
            .as_slice()
            .to_vec()
    }

    /// What the only rank finds with so many threads.
    pub fn on_threads(&self, threads: usize) -> Vec<f64> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| self.solution(0, Precision::Single, &wires(1, 1).remove(0)))
    }

    /// What `rank` finds at the nodes of its window, after a first factorisation of another matrix in the other
    /// precision.
    fn solution(&self, rank: usize, precision: Precision, wire: &Wire) -> Vec<f64> {
        let grid = self.window(rank);
        let free = self.free();
        let rhs = self.rhs();
        let components = self.components(&grid);
        let free: Vec<bool> = components.iter().map(|&component| free[component]).collect();
        let rhs: Vec<f64> = components.iter().map(|&component| rhs[component]).collect();
        let mut direct = Dissection::default();
        direct.plan::<2, C>(wire, &self.slabs, rank, &grid, &free);
        let mut stencil = Stencil::<2, C>::new(&grid);
        stencil.keep(|_| true);
        let other = if precision == Precision::Double {
            Precision::Single
        } else {
            Precision::Double
        };
        for (scale, precision) in [(3.0, other), (1.0, precision)] {
            stencil.clear();
            for cell in 0..grid.cells() {
                let at = grid.cell_at(cell);
                if let Some(block) = self.block(self.grid.cell_index(&at)) {
                    stencil.add(grid.first_node(&at), (block * scale).as_slice());
                }
            }
            assert!(direct.factorise(wire, precision, &stencil, 3.0));
        }
        let owned = grid.nodes_within(&self.slabs.owned(rank, grid.order(), &grid.room()[1]));
        let is_owned = |component: usize| owned.iter().any(|run| run.contains(&Nodal::<C>::node(component)));
        let mut solution = vec![f64::NAN; rhs.len()];
        direct.solve(wire, is_owned, &rhs, &mut solution);
        solution
    }

    /// Holds the ranks' solutions against the dense one: to round-off of either precision.
    pub fn is_solved(&self) {
        let dense = self.dense_solution();
        let scale = dense.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for (precision, least, most) in [(Precision::Double, 0.0, 1e-9), (Precision::Single, 1e-9, 1e-3)] {
            let mut largest = 0.0_f64;
            for (rank, found) in self.solutions(precision, 0).into_iter().enumerate() {
                let expected = self
                    .components(&self.window(rank))
                    .into_iter()
                    .map(|component| dense[component]);
                assert!(found.iter().all(|x| x.is_finite()));
                largest = found
                    .iter()
                    .zip(expected)
                    .fold(largest, |most, (a, b)| most.max((a - b).abs()));
            }
            let range = least * scale..most * scale;
            assert!(
                range.contains(&largest),
                "{:?} {:?}: {largest:e} of {scale:e}",
                self.grid,
                self.slabs
            );
        }
    }

    /// Solutions of all ranks, whose messages take their time.
    pub fn solutions(&self, precision: Precision, delay: usize) -> Vec<Vec<f64>> {
        let ranks = self.slabs.ranks();
        std::thread::scope(|scope| {
            let threads: Vec<_> = wires(ranks, delay)
                .into_iter()
                .enumerate()
                .map(|(rank, wire)| scope.spawn(move || self.solution(rank, precision, &wire)))
                .collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        })
    }
}
