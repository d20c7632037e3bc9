//! F-bar's average in the stiffness: points of neighbouring patches dilate together.
//!
//! With the splines A of degree q - 1 and volumes as weights, consistent F-bar puts sum_h A_hp (1/W_h) sum_r A_hr V_r tr l_r in
//! the place of tr l_p, W_h = sum_r A_hr V_r. Its elastic stiffness is symmetric, one product a function h:
//! sum_h (kappa_h / W_h) g_h g_h^T with g_h = sum_p A_hp V_p grad N_p, kappa_h the mean of the points' stiffness against dilation.
//! A K_0 without it is as much too stiff as the material is incompressible: short footing, nu = .495, 7,662 iterations without it
//! and 3,383 with it.

use crate::grid::{Contributions, Grid};
use crate::kinematics::Kinematics;
use crate::seam::{Halo, LinearSolver};
use crate::step::nodes::Nodes;
use crate::tensor::{Tensor, Vector};

/// Sums of all functions h.
pub struct Coupling {
    /// per function: W m3, W kappa N m, and g m2 of the nodes that its cells touch
    sums: Contributions,
    /// of the functions of a cell
    offsets: Vec<usize>,
    /// place in g of node k of a cell, per function of the cell
    places: Vec<Vec<usize>>,
    /// nodes that a function's cells touch, along an axis
    side: usize,
}

/// The same of one patch: per function of the cell W, W kappa, and g of the cell's nodes.
pub struct Dilations {
    numbers: Vec<f64>,
}

impl Dilations {
    /// Zeros for a patch of `size` nodes, whose functions are those that `nodes` averages dilations with.
    pub fn of_patch<const D: usize>(nodes: &Nodes<D>, size: usize) -> Self {
        let functions = nodes.lowered().map_or(0, |lower| lower.offsets().len());
        Self { numbers: vec![0.0; functions * (2 + size * D)] }
    }

    /// Adds point `p` of volume V0 in m3 and stiffness against dilation in Pa, with the gradients of its nodes.
    pub fn add<K: Kinematics<D>, const D: usize>(
        &mut self,
        nodes: &Nodes<D>,
        p: usize,
        (volume, bulk): (f64, f64),
        grad: &[Vector<D>],
    ) {
        let Some(lower) = nodes.lowered() else { return };
        let trace = K::in_plane(&Tensor::identity());
        for (k, numbers) in self.numbers.chunks_exact_mut(2 + grad.len() * D).enumerate() {
            let share = lower.value(p, k) * volume;
            numbers[0] += share;
            numbers[1] += share * bulk;
            for (sums, grad) in numbers[2..].chunks_exact_mut(D).zip(grad) {
                let along = trace * grad;
                for i in 0..D {
                    sums[i] += share * along[i];
                }
            }
        }
    }
}

impl Coupling {
    /// No sums yet; `None` where dilations are not averaged by functions of a lower degree, or windows do not reach as far
    /// as these couple ([`Grid::reaching`]).
    pub fn of<const D: usize>(grid: &Grid<D>, nodes: &Nodes<D>) -> Option<Self> {
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
        let sums = Contributions::none(grid, 2 + side.pow(D as u32) * D, Vec::new());
        Some(Self { sums, offsets: lower.offsets().to_vec(), places, side })
    }

    /// Adds what the patch whose first node is `first` contributes.
    pub fn add(&mut self, first: usize, dilations: &Dilations) {
        let width = self.sums.width();
        let sums = self.sums.patch(first);
        let of_function = dilations.numbers.len() / self.offsets.len();
        for ((numbers, offset), places) in
            dilations.numbers.chunks_exact(of_function).zip(&self.offsets).zip(&self.places)
        {
            let sums = &mut sums[offset * width..(offset + 1) * width];
            sums[0] += numbers[0];
            sums[1] += numbers[1];
            let components = (of_function - 2) / places.len();
            for (place, g) in places.iter().zip(numbers[2..].chunks_exact(components)) {
                let sums = &mut sums[2 + place * components..][..components];
                sums.iter_mut().zip(g).for_each(|(sum, g)| *sum += g);
            }
        }
    }

    /// Adds the products to a matrix, each on the rank that owns the first of its nodes. One exchange with the neighbours.
    pub fn assemble<const D: usize>(&self, grid: &Grid<D>, halo: &dyn Halo, solver: &mut dyn LinearSolver) {
        let (width, degree) = (self.sums.width(), grid.order() - 1);
        let sums = halo.sum(&self.sums);
        let is_ours = |function: usize| {
            let layer = grid.node_at(function)[0].saturating_sub(degree).checked_sub(grid.layers().start);
            layer.is_some_and(|layer| halo.owned().contains(&(layer * grid.layer_nodes())))
        };
        let (mut nodes, mut g, mut block) = (Vec::new(), Vec::new(), Vec::new());
        for (function, numbers) in sums.chunks_exact(width).enumerate() {
            let (weight, bulk) = (numbers[0], numbers[1]);
            if weight <= 0.0 || bulk <= 0.0 || !is_ours(function) {
                continue;
            }
            nodes.clear();
            g.clear();
            for (place, along) in numbers[2..].chunks_exact(D).enumerate() {
                if let Some(node) = self.node(grid, (function, degree), place) {
                    nodes.push(node);
                    g.extend_from_slice(along);
                }
            }
            let factor = bulk / (weight * weight);
            block.clear();
            block.extend(g.iter().flat_map(|a| g.iter().map(move |b| factor * a * b)));
            solver.add_among(&nodes, &block);
        }
    }

    /// The node of the window at a place of a function's g; `None` where there is none.
    fn node<const D: usize>(&self, grid: &Grid<D>, (function, degree): (usize, usize), place: usize) -> Option<usize> {
        let at = grid.node_at(function);
        let first = grid.layers().start;
        let mut node = 0;
        for axis in 0..D {
            let step = place / self.side.pow((D - 1 - axis) as u32) % self.side;
            let along = (at[axis] + step).checked_sub(degree).filter(|&n| n < grid.axes()[axis].functions())?;
            node = match axis {
                0 => along.checked_sub(first).filter(|&n| n < grid.layers().len())?,
                _ => node * grid.axes()[axis].functions() + along,
            };
        }
        Some(node)
    }
}
