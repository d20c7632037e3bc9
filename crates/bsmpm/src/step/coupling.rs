//! Stiffness of the F-bar average: the third term of theory-manual equation (T5.8), with the sums (T5.9).

use crate::grid::{Contributions, Grid, Shape, digit};
use crate::linear::MatrixAssembly;
use crate::model::Model;
use crate::parallel::{Halo, OwnedNodes};
use crate::step::nodes::GridState;
use crate::tensor::Vector;

/// Nodal force per unit of averaged dilation.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum DilationForce {
    /// Parallel to the nodal dilation g, times the mean stiffness of the points.
    Along,
    /// An independent vector f.
    Own,
}

/// Sums (T5.9) of all functions h, for every group of materials that the average does not mix.
pub struct Coupling<'a, const D: usize> {
    grid: &'a Grid<D>,
    lower: &'a Shape<D>,
    cells: FunctionSums,
    pairs: Option<FunctionSums>, // if functions are merged
    raised: DilationForce,
}

/// Sums of functions on cells, or on pairs of cells.
struct FunctionSums {
    /// Per group and function: the head (W and kappa_h W), then g of the nodes that its cells touch, then f if it is
    /// independent.
    sums: Vec<Contributions>,
    /// Nodes along an axis that a function's cells touch.
    side: usize,
    /// Position of node k of a cell in the g of a function that starts at the cell.
    places: Vec<usize>,
}

/// Numbers of a function before g and f.
const HEAD: usize = 2;

/// Sums of one patch: per group and function of the cell the head, g and f of the cell's nodes.
pub struct Dilations {
    numbers: Vec<f64>,
    of_group: usize,
    of_function: usize,
}

/// Contribution of a point to the sums of its functions.
pub struct Share<'a, const D: usize> {
    /// Group of the point's material.
    pub group: usize,
    /// Weight w of the point (m3 or kg).
    pub weight: f64,
    /// Bulk stiffness kappa of the point (Pa); unused if the force is independent.
    pub bulk: f64,
    /// w grad N at the nodes of the point.
    pub dilation: &'a [Vector<D>],
    /// Force at the nodes per unit of averaged dilation; empty unless it is independent.
    pub force: &'a [Vector<D>],
}

impl Dilations {
    /// Adds point `p`.
    pub fn add<const D: usize>(&mut self, nodes: &GridState<D>, p: usize, share: &Share<D>) {
        let Some(lower) = nodes.lowered() else { return };
        let mut values = [0.0; 27];
        let values = &mut values[..lower.offsets().len()];
        lower.values_into(p, values);
        let functions = self.numbers[share.group * self.of_group..].chunks_exact_mut(self.of_function);
        for (A, numbers) in values.iter().zip(functions) {
            let (head, sums) = numbers.split_at_mut(HEAD);
            head[0] += *A * share.weight;
            head[1] += *A * share.weight * share.bulk;
            let (dilation, force) = sums.split_at_mut(share.dilation.len() * D);
            for (sums, vectors) in [(dilation, share.dilation), (force, share.force)] {
                for (sums, vector) in sums.chunks_exact_mut(D).zip(vectors) {
                    (0..D).for_each(|i| sums[i] += *A * vector[i]);
                }
            }
        }
    }
}

impl<'a, const D: usize> Coupling<'a, D> {
    /// Creates zero sums. `None` if dilations are not averaged by functions of lower degree, or if windows do not reach
    /// as far as the coupling ([`Grid::reaching`]).
    pub fn of<K>(model: &'a Model<K, D>, nodes: &'a GridState<D>, raised: DilationForce) -> Option<Self> {
        let grid = &model.grid;
        let groups = model.groups.count();
        let lower = nodes.lowered().filter(|_| grid.beyond() + 1 >= grid.order())?;
        let q = grid.order();
        // A function spans q cells or q pairs of cells, which touch q more nodes than cells.
        Some(Self {
            grid,
            lower,
            cells: FunctionSums::of(grid, groups, 2 * q, raised),
            pairs: lower.merger().map(|_| FunctionSums::of(grid, groups, 3 * q, raised)),
            raised,
        })
    }

    /// Returns zero sums for one patch.
    pub fn of_patch(&self) -> Dilations {
        let of_function = HEAD + self.raised.vectors() * self.grid.cell_nodes() * D;
        let of_group = self.lower.offsets().len() * of_function;
        Dilations {
            numbers: vec![0.0; self.cells.sums.len() * of_group],
            of_group,
            of_function,
        }
    }

    /// Adds the sums of patch `number`.
    pub fn add(&mut self, number: usize, dilations: &Dilations) {
        let grid = self.grid;
        let lower = self.lower;
        let first = lower.patches()[number].first_node;
        let of_function = dilations.of_function;
        let cell = grid.cell_at(lower.patches()[number].cell);
        for (group, numbers) in dilations.numbers.chunks_exact(dilations.of_group).enumerate() {
            if numbers.chunks_exact(of_function).all(|numbers| numbers[0] == 0.0) {
                continue; // no point of the group
            }
            for (h, (numbers, offset)) in numbers.chunks_exact(of_function).zip(lower.offsets()).enumerate() {
                let share = lower.merger().map_or(1.0, |merged| merged.rest(number, group, h));
                let shift: [usize; D] =
                    std::array::from_fn(|axis| grid.order() - 1 - digit::<D>(h, axis, grid.order()));
                if share > 0.0 {
                    self.cells.add(group, first, *offset, shift, share, numbers);
                }
            }
            let Some((merged, pairs)) = lower.merger().zip(self.pairs.as_mut()) else {
                continue;
            };
            for (k, shares) in merged.rows(number, group) {
                let offset = merged.offsets(number)[k];
                let slot = grid.node_at(first + offset);
                let shift: [usize; D] =
                    std::array::from_fn(|axis| cell[axis] - merged.first_cell(axis, slot[axis]).unwrap_or(0));
                for (share, numbers) in shares.iter().zip(numbers.chunks_exact(of_function)) {
                    pairs.add(group, first, offset, shift, *share, numbers);
                }
            }
        }
    }

    /// Adds the products g f^T of all functions to a matrix, each on the rank that owns the first of its nodes. One
    /// exchange with the neighbours for every group, and one more if functions are merged.
    pub fn assemble(&self, halo: &dyn Halo, matrix: &mut dyn MatrixAssembly) {
        let grid = self.grid;
        let degree = self.grid.order() - 1;
        for sums in &self.cells.sums {
            self.assemble_group(
                sums,
                self.cells.side,
                |_, number| Some(number as isize - degree as isize),
                halo,
                matrix,
            );
        }
        let Some((merged, pairs)) = self.lower.merger().zip(self.pairs.as_ref()) else {
            return;
        };
        debug_assert!(grid.beyond() + 1 >= 2 * grid.order());
        for sums in &pairs.sums {
            self.assemble_group(
                sums,
                pairs.side,
                |axis, number| merged.first_cell(axis, number).map(|cell| cell as isize),
                halo,
                matrix,
            );
        }
    }

    /// Assembles one group. `first(axis, number)` is the first node along an axis that the cells of a function touch;
    /// it may lie before the grid.
    fn assemble_group(
        &self,
        sums: &Contributions,
        side: usize,
        first: impl Fn(usize, usize) -> Option<isize>,
        halo: &dyn Halo,
        matrix: &mut dyn MatrixAssembly,
    ) {
        let width = sums.width();
        let grid = self.grid;
        let sums = halo.assemble_ghosts(sums);
        let owned = halo.owned();
        let mut nodes = Vec::new();
        let mut g = Vec::new();
        let mut f = Vec::new();
        let mut block = Vec::new();
        for (function, numbers) in sums.chunks_exact(width).enumerate() {
            let weight = numbers[0];
            let bulk = numbers[1];
            let number = grid.node_at(function);
            let starts: [Option<isize>; D] = std::array::from_fn(|axis| first(axis, number[axis]));
            if weight <= 0.0 || !is_owned(grid, &starts, &owned) {
                continue;
            }
            nodes.clear();
            g.clear();
            f.clear();
            let (dilation, force) = numbers[HEAD..].split_at(side.pow(D as u32) * D);
            for (place, along) in dilation.chunks_exact(D).enumerate() {
                let node = node_at(grid, |axis| {
                    starts[axis].map(|first| first + digit::<D>(place, axis, side) as isize)
                });
                if let Some(node) = node {
                    nodes.push(node);
                    g.extend_from_slice(along);
                    f.extend_from_slice(if self.raised == DilationForce::Own {
                        &force[place * D..][..D]
                    } else {
                        along
                    });
                }
            }
            let factor = if self.raised == DilationForce::Own {
                1.0
            } else {
                bulk / weight
            };
            block.clear();
            for f in &f {
                let scaled = factor / weight * f;
                block.extend(g.iter().map(|g| scaled * g));
            }
            matrix.add_block_among(&nodes, &block);
        }
    }
}

impl FunctionSums {
    /// Creates zero sums of functions whose cells touch `side` nodes along an axis.
    fn of<const D: usize>(grid: &Grid<D>, groups: usize, side: usize, raised: DilationForce) -> Self {
        let width = HEAD + raised.vectors() * side.pow(D as u32) * D;
        let places = (0..grid.cell_nodes())
            .map(|node| (0..D).fold(0, |place, axis| place * side + digit::<D>(node, axis, grid.order() + 1)));
        Self {
            sums: vec![Contributions::none(grid, width, Vec::new()); groups],
            side,
            places: places.collect(),
        }
    }

    /// Adds a `share` of the `numbers` of a patch's function to the function that is stored `offset` from the patch's
    /// `first` node and starts `shift` cells before the patch.
    fn add<const D: usize>(
        &mut self,
        group: usize,
        first: usize,
        offset: usize,
        shift: [usize; D],
        share: f64,
        numbers: &[f64],
    ) {
        let width = self.sums[group].width();
        let side = self.side;
        let sums = &mut self.sums[group].patch(first)[offset * width..(offset + 1) * width];
        sums.iter_mut()
            .zip(&numbers[..HEAD])
            .for_each(|(sum, number)| *sum += share * number);
        // A function's nodes form a box with `side` nodes along each axis, the last axis fastest. The patch begins
        // `shift` cells after the function, so its node k is at `start + places[k]` in this box.
        let start = shift.iter().fold(0, |place, along| place * side + along);
        let vectors = numbers[HEAD..].chunks_exact(self.places.len() * D);
        for (sums, vectors) in sums[HEAD..].chunks_exact_mut(side.pow(D as u32) * D).zip(vectors) {
            for (place, vector) in self.places.iter().zip(vectors.chunks_exact(D)) {
                let sums = &mut sums[(start + place) * D..(start + place + 1) * D];
                sums.iter_mut()
                    .zip(vector)
                    .for_each(|(sum, value)| *sum += share * value);
            }
        }
    }
}

/// Returns whether this rank owns the first node inside the grid of a function that begins at `starts`.
fn is_owned<const D: usize>(grid: &Grid<D>, starts: &[Option<isize>; D], owned: &OwnedNodes) -> bool {
    let first = starts.map(|start| start.map(|start| start.max(0) as usize));
    let node = grid.cells_along().each_ref().map(|cells| cells.start);
    let node = std::array::from_fn(|axis| first[axis].unwrap_or(node[axis]));
    first[0].is_some() && grid.node_index(&node).is_some_and(|node| owned.contains(node))
}

/// Returns the node of the window at a position along each axis; `None` outside the window.
fn node_at<const D: usize>(grid: &Grid<D>, along: impl Fn(usize) -> Option<isize>) -> Option<usize> {
    let mut node = [0; D];
    for (axis, at) in node.iter_mut().enumerate() {
        *at = usize::try_from(along(axis)?).ok()?;
    }
    grid.node_index(&node)
}

impl DilationForce {
    /// Returns the number of nodal vectors of a function: g, and f if it is independent.
    fn vectors(self) -> usize {
        if self == Self::Own { 2 } else { 1 }
    }
}
