//! Transfers nodal values between a grid and the next coarser multigrid level.

use super::{CoarseOperator, Operator};
use crate::stencil::Stencil;
use bsmpm::grid::{Grid, KnotVector};
use std::ops::Range;

/// Smallest number of cells along an axis that is coarsened.
const FEWEST: usize = 4;

/// Transfer between a window and its coarser window, axis by axis.
pub(super) struct Transfer<const D: usize> {
    parents: [Vec<Vec<(usize, f64)>>; D], // of every node along an axis: coarse nodes with their weights
    coarse: [usize; D],                   // number of nodes of the coarse window
}

impl<const D: usize> Transfer<D> {
    /// Returns the coarser grid of a window and the transfer between them; `None` if no axis can be coarsened.
    pub fn new(grid: &Grid<D>) -> Option<(Grid<D>, Self)> {
        let axes = grid.axes().each_ref().map(coarser);
        if (0..D).all(|axis| axes[axis].cells() == grid.axes()[axis].cells()) {
            return None;
        }
        let mut parents: [Vec<Vec<(usize, f64)>>; D] = std::array::from_fn(|axis| {
            let start = grid.cells_along()[axis].start;
            (start..start + grid.nodes_along(axis))
                .map(|fine| weights(&grid.axes()[axis], &axes[axis], fine))
                .collect()
        });
        let room = std::array::from_fn(|axis| {
            let numbers = parents[axis].iter().flatten().map(|(number, _)| *number);
            let (first, last) = numbers.fold((usize::MAX, 0), |(first, last), at| (first.min(at), last.max(at)));
            let start = first.min(axes[axis].cells() - 1);
            start
                ..(last + 1)
                    .saturating_sub(grid.order())
                    .clamp(start + 1, axes[axis].cells())
        });
        for (axis, room) in room.iter().enumerate() {
            parents[axis]
                .iter_mut()
                .flatten()
                .for_each(|(number, _)| *number -= room.start);
        }
        let coarse = Grid::new(axes).ok()?.reaching(grid.beyond()).within(room);
        let nodes = std::array::from_fn(|axis| coarse.nodes_along(axis));
        Some((coarse, Self { parents, coarse: nodes }))
    }

    /// Returns the nodal values of the window from those of the coarse window.
    pub fn prolong<const C: usize>(&self, coarse: &[f64]) -> Vec<f64> {
        (0..D).fold(coarse.to_vec(), |values, axis| self.along::<C>(axis, &values, false))
    }

    /// Applies the transpose of [`Transfer::prolong`].
    pub fn restrict<const C: usize>(&self, fine: &[f64]) -> Vec<f64> {
        (0..D)
            .rev()
            .fold(fine.to_vec(), |values, axis| self.along::<C>(axis, &values, true))
    }

    /// Transfers along one axis. The axes before it have fine nodes, those after it coarse nodes.
    fn along<const C: usize>(&self, axis: usize, from: &[f64], back: bool) -> Vec<f64> {
        let inner = self.coarse[axis + 1..].iter().product::<usize>() * C;
        let [fine, coarse] = [self.parents[axis].len(), self.coarse[axis]].map(|nodes| nodes * inner);
        let (length, size) = if back { (fine, coarse) } else { (coarse, fine) };
        let mut to = vec![0.0; from.len() / length * size];
        for (from, to) in from.chunks_exact(length).zip(to.chunks_exact_mut(size)) {
            for (child, parents) in self.parents[axis].iter().enumerate() {
                for (parent, weight) in parents {
                    let (at, into) = if back { (child, *parent) } else { (*parent, child) };
                    let values = &from[at * inner..][..inner];
                    let sums = &mut to[into * inner..][..inner];
                    sums.iter_mut()
                        .zip(values)
                        .for_each(|(sum, value)| *sum += weight * value);
                }
            }
        }
        to
    }

    /// Returns the coarse matrix P^T A P with its unknowns. Components without stiffness are not unknowns.
    pub fn galerkin<const C: usize>(&self, operator: Operator<'_, D, C>, coarse: &Grid<D>) -> CoarseOperator<D, C> {
        let Operator { stencil, free } = operator;
        let mut made = Stencil::<D, C>::new(coarse);
        let mut reached = vec![false; coarse.nodes()];
        let nodes: usize = self.parents.iter().map(Vec::len).product();
        for node in (0..nodes).filter(|node| free[node * C..(node + 1) * C].contains(&true)) {
            self.parents_of(self.split(node), |at, _, _| reached[at] = true);
        }
        made.keep(|node| reached[node]);
        let mut sums = Vec::new();
        let mut blocks: Vec<(usize, &[f64])> = Vec::new();
        let mut around: Vec<[usize; D]> = Vec::new();
        for node in 0..nodes {
            blocks.clear();
            blocks.extend(stencil.blocks(node));
            around.clear();
            around.extend(blocks.iter().map(|&(other, _)| self.split(other)));
            if around.is_empty() {
                continue;
            }
            let parents = self.parents_around(&around);
            let widths = parents.each_ref().map(Range::len);
            sums.clear();
            sums.resize(widths.iter().product::<usize>() * C * C, 0.0);
            for (&(other, block), &at) in blocks.iter().zip(&around) {
                let mut known = [[0.0; C]; C];
                for (i, j) in (0..C * C).map(|k| (k / C, k % C)) {
                    known[i][j] = if free[node * C + i] && free[other * C + j] {
                        block[i * C + j]
                    } else {
                        0.0
                    };
                }
                let known = known.as_flattened();
                self.parents_of(at, |_, place, weight| {
                    let local = (0..D).fold(0, |local, axis| {
                        local * widths[axis] + place[axis] - parents[axis].start
                    });
                    let sums = &mut sums[local * C * C..][..C * C];
                    sums.iter_mut()
                        .zip(known)
                        .for_each(|(sum, value)| *sum += weight * value);
                });
            }
            self.parents_of(self.split(node), |parent, _, weight| {
                for (local, sum) in sums.chunks_exact(C * C).enumerate() {
                    let mut rest = local;
                    let mut place = [0; D];
                    for axis in (0..D).rev() {
                        place[axis] = parents[axis].start + rest % widths[axis];
                        rest /= widths[axis];
                    }
                    made.add_block(parent, self.joined(&place), weight, sum);
                }
            });
        }
        let least = made.largest_diagonal() * f64::EPSILON;
        let free = (0..coarse.nodes() * C)
            .map(|component| made.on_diagonal(component) > least)
            .collect();
        CoarseOperator { stencil: made, free }
    }

    /// Returns the box of coarse nodes on which the nodes at the given positions of the window depend.
    fn parents_around(&self, places: &[[usize; D]]) -> [Range<usize>; D] {
        std::array::from_fn(|axis| {
            let parents = places.iter().flat_map(|at| &self.parents[axis][at[axis]]);
            let (first, last) = parents.fold((usize::MAX, 0), |(first, last), (at, _)| {
                (first.min(*at), last.max(*at))
            });
            first..last + 1
        })
    }

    /// Visits the coarse nodes on which a node depends: number, position and weight.
    fn parents_of(&self, at: [usize; D], mut visit: impl FnMut(usize, [usize; D], f64)) {
        let lists: [&[(usize, f64)]; D] = std::array::from_fn(|axis| &self.parents[axis][at[axis]][..]);
        for number in 0..lists.iter().map(|list| list.len()).product() {
            let mut rest = number;
            let mut weight = 1.0;
            let mut place = [0; D];
            for axis in (0..D).rev() {
                let (parent, part) = lists[axis][rest % lists[axis].len()];
                rest /= lists[axis].len();
                weight *= part;
                place[axis] = parent;
            }
            visit(self.joined(&place), place, weight);
        }
    }

    /// Returns the position along every axis of a node of the window.
    fn split(&self, mut node: usize) -> [usize; D] {
        let mut at = [0; D];
        for axis in (0..D).rev() {
            at[axis] = node % self.parents[axis].len();
            node /= self.parents[axis].len();
        }
        at
    }

    /// Returns the number of a node of the coarse window.
    fn joined(&self, place: &[usize; D]) -> usize {
        (0..D).fold(0, |number, axis| number * self.coarse[axis] + place[axis])
    }
}

/// Keeps every second breakpoint with its multiplicity, and the last one.
fn coarser(axis: &KnotVector) -> KnotVector {
    let all: Vec<f64> = (0..=axis.cells()).map(|i| axis.breakpoint(i)).collect();
    let runs: Vec<&[f64]> = all.chunk_by(|a, b| a == b).collect();
    let last = runs.len() - 1;
    if last < FEWEST {
        return axis.clone();
    }
    let kept = runs
        .iter()
        .enumerate()
        .filter(|(number, _)| number % 2 == 0 || *number == last);
    let kept: Vec<f64> = kept.flat_map(|(_, run)| run.to_vec()).collect();
    KnotVector::graded(&kept, axis.order()).unwrap_or_else(|_| axis.clone())
}

/// Returns the position of `x` between the knots `j` and `j + degree` as a fraction of their distance; 0 if they
/// coincide.
fn part(coarse: &KnotVector, j: usize, degree: usize, x: f64) -> f64 {
    let length = coarse.knot(j + degree) - coarse.knot(j);
    if length > 0.0 {
        (x - coarse.knot(j)) / length
    } else {
        0.0
    }
}

/// Returns the weights of a fine function's coefficient in those of the coarse functions, the discrete B-splines
/// (Cohen, Lyche and Riesenfeld 1980, Comput. Graph. Image Process. 14, 87-111).
fn weights(fine: &KnotVector, coarse: &KnotVector, number: usize) -> Vec<(usize, f64)> {
    let q = fine.order();
    // Last coarse cell with a length that begins at or before the start of the function's support.
    let begins = (q..coarse.functions())
        .rev()
        .find(|&j| coarse.knot(j) <= fine.knot(number))
        .unwrap_or(q);
    let mut found = vec![1.0];
    for degree in 1..=q {
        let x = fine.knot(number + degree);
        let first = begins - degree;
        // Weights of the degree before, of the functions from `first + 1` to `begins`, with a zero on either side.
        let old = [&[0.0], &found[..], &[0.0]].concat();
        found = (first..=begins)
            .map(|j| {
                let [rising, falling] = [j, j + 1].map(|j| part(coarse, j, degree, x));
                rising * old[j - first] + (1.0 - falling) * old[j + 1 - first]
            })
            .collect();
    }
    found
        .into_iter()
        .enumerate()
        .map(|(k, weight)| (begins - q + k, weight))
        .filter(|(_, w)| *w != 0.0)
        .collect()
}
