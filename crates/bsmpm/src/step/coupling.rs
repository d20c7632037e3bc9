//! F-bar's average in a matrix: points of neighbouring patches dilate together.
//!
//! With the splines A of degree q - 1 consistent F-bar puts sum_h A_hp (1/W_h) sum_r A_hr w_r tr l_r in the place of tr l_p,
//! W_h = sum_r A_hr w_r. In a stiffness that is one product a function h: sum_h (1/W_h) f_h g_h^T, where g_h are the forces
//! that work on its dilation, g_h = sum_r A_hr w_r grad N_r, and f_h those that a unit of it raises.
//!
//! With volumes as weights, w = V, and the mean kappa_h of the points' stiffness against dilation, f_h = kappa_h g_h is symmetric,
//! and exact for elastic material that is the same wherever the function reaches. A K_0 without it is as much too stiff as the material is incompressible: short footing,
//! nu = .495, 7,662 iterations without it and 3,383 with it.

use crate::grid::{Contributions, Grid};
use crate::model::Model;
use crate::seam::{Halo, LinearSolver};
use crate::step::nodes::Nodes;
use crate::tensor::Vector;

/// What one unit of dilation raises.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Raised {
    /// The force of the dilation itself, times the mean stiffness of the points.
    Along,
    /// A force of its own.
    Own,
}

/// Sums of all functions h, of every group of materials that the average does not mix.
pub struct Coupling {
    /// per group and function its head, W and kappa_h W, and g of the nodes that its cells touch; f of them, if it is its own
    sums: Vec<Contributions>,
    /// of the functions of a cell
    offsets: Vec<usize>,
    /// place in g of node k of a cell, per function of the cell
    places: Vec<Vec<usize>>,
    /// nodes that a function's cells touch, along an axis
    side: usize,
    raised: Raised,
}

/// Numbers of a function before g and f.
const HEAD: usize = 2;

/// The same of one patch: per group and function of the cell its head, and g and f of the cell's nodes.
pub struct Dilations {
    numbers: Vec<f64>,
    of_group: usize,
    of_function: usize,
}

/// A point in the sums of its functions.
pub struct Share<'a, const D: usize> {
    /// group of its material
    pub group: usize,
    /// w of the point: m3, or kg
    pub weight: f64,
    /// kappa of the point, Pa; of no use where the force is its own
    pub bulk: f64,
    /// w grad N of its nodes
    pub dilation: &'a [Vector<D>],
    /// force at its nodes per unit of averaged dilation; empty unless it is its own
    pub force: &'a [Vector<D>],
}

impl Dilations {
    /// Adds point `p`.
    pub fn add<const D: usize>(&mut self, nodes: &Nodes<D>, p: usize, share: &Share<D>) {
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

impl Coupling {
    /// No sums yet; `None` where dilations are not averaged by functions of a lower degree, or windows do not reach as far
    /// as these couple ([`Grid::reaching`]).
    pub fn of<K, const D: usize>(model: &Model<K, D>, nodes: &Nodes<D>, raised: Raised) -> Option<Self> {
        let grid = &model.grid;
        let lower = nodes.lowered().filter(|_| grid.beyond() + 1 >= grid.order())?;
        let (degree, width) = (lower.width() - 1, lower.width() + 1);
        let side = width + degree;
        let digits = |k: usize, base: usize| (0..D).map(move |axis| k / base.pow((D - 1 - axis) as u32) % base);
        let place = |function: usize, node: usize| {
            let along = digits(node, width).zip(digits(function, lower.width()));
            along.fold(0, |place, (node, function)| place * side + node + degree - function)
        };
        let functions = lower.offsets().len();
        let places = (0..functions).map(|h| (0..width.pow(D as u32)).map(|node| place(h, node)).collect()).collect();
        let none = || Contributions::none(grid, HEAD + raised.vectors() * side.pow(D as u32) * D, Vec::new());
        let sums = (0..model.groups.count()).map(|_| none()).collect();
        Some(Self { sums, offsets: lower.offsets().to_vec(), places, side, raised })
    }

    /// Zeros for one patch.
    pub fn of_patch<const D: usize>(&self) -> Dilations {
        let of_function = HEAD + self.raised.vectors() * self.places[0].len() * D;
        let of_group = self.offsets.len() * of_function;
        Dilations { numbers: vec![0.0; self.sums.len() * of_group], of_group, of_function }
    }

    /// Adds what the patch whose first node is `first` contributes.
    pub fn add<const D: usize>(&mut self, first: usize, dilations: &Dilations) {
        let (of_patch, of_all) = (self.places[0].len() * D, self.side.pow(D as u32) * D);
        for (sums, numbers) in self.sums.iter_mut().zip(dilations.numbers.chunks_exact(dilations.of_group)) {
            let functions = numbers.chunks_exact(dilations.of_function);
            if functions.clone().all(|numbers| numbers[0] == 0.0) {
                continue; // no point of the group
            }
            let width = sums.width();
            let sums = sums.patch(first);
            for ((numbers, offset), places) in functions.zip(&self.offsets).zip(&self.places) {
                let sums = &mut sums[offset * width..(offset + 1) * width];
                sums.iter_mut().zip(&numbers[..HEAD]).for_each(|(sum, number)| *sum += number);
                let vectors = numbers[HEAD..].chunks_exact(of_patch);
                for (sums, vectors) in sums[HEAD..].chunks_exact_mut(of_all).zip(vectors) {
                    for (place, vector) in places.iter().zip(vectors.chunks_exact(D)) {
                        let sums = &mut sums[place * D..(place + 1) * D];
                        sums.iter_mut().zip(vector).for_each(|(sum, value)| *sum += value);
                    }
                }
            }
        }
    }

    /// Adds the products to a matrix, each on the rank that owns the first of its nodes. One exchange with the neighbours for
    /// every group.
    pub fn assemble<const D: usize>(&self, grid: &Grid<D>, halo: &dyn Halo, solver: &mut dyn LinearSolver) {
        self.sums.iter().for_each(|sums| self.assemble_group(sums, grid, halo, solver));
    }

    fn assemble_group<const D: usize>(
        &self,
        sums: &Contributions,
        grid: &Grid<D>,
        halo: &dyn Halo,
        solver: &mut dyn LinearSolver,
    ) {
        let (width, degree) = (sums.width(), grid.order() - 1);
        let sums = halo.sum(sums);
        let is_ours = |function: usize| {
            let layer = grid.node_at(function)[0].saturating_sub(degree).checked_sub(grid.layers().start);
            layer.is_some_and(|layer| halo.owned().contains(&(layer * grid.layer_nodes())))
        };
        let (mut nodes, mut g, mut f, mut block) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (function, numbers) in sums.chunks_exact(width).enumerate() {
            let (weight, bulk) = (numbers[0], numbers[1]);
            if weight <= 0.0 || !is_ours(function) {
                continue;
            }
            nodes.clear();
            g.clear();
            f.clear();
            let (dilation, force) = numbers[HEAD..].split_at(self.side.pow(D as u32) * D);
            for (place, along) in dilation.chunks_exact(D).enumerate() {
                if let Some(node) = self.node(grid, (function, degree), place) {
                    nodes.push(node);
                    g.extend_from_slice(along);
                    f.extend_from_slice(if self.raised == Raised::Own { &force[place * D..][..D] } else { along });
                }
            }
            let factor = if self.raised == Raised::Own { 1.0 } else { bulk / weight };
            block.clear();
            for f in &f {
                let scaled = factor / weight * f;
                block.extend(g.iter().map(|g| scaled * g));
            }
            solver.add_among(&nodes, &block);
        }
    }

    /// The node of the window at a place of a function's g; `None` where there is none.
    fn node<const D: usize>(&self, grid: &Grid<D>, (function, degree): (usize, usize), place: usize) -> Option<usize> {
        let mut node = grid.node_at(function);
        for (axis, at) in node.iter_mut().enumerate() {
            *at = (*at + place / self.side.pow((D - 1 - axis) as u32) % self.side).checked_sub(degree)?;
        }
        grid.node_index(&node)
    }
}

impl Raised {
    /// Vectors of the nodes that a function keeps: g, and f.
    fn vectors(self) -> usize {
        if self == Self::Own { 2 } else { 1 }
    }
}
