//! Direct solver: multifrontal Cholesky factorisation (Duff and Reid, 1983) in an order by nested dissection of a box
//! of nodes.
//!
//! Each rank eliminates the unknowns that no other rank needs. Groups of ranks then eliminate the shared unknowns. The
//! order is fixed, so that runs on the same number of ranks are bitwise identical.

mod factor;
pub(super) mod front;
mod plan;
mod reduction;
#[cfg(test)]
mod tests;
mod tree;

pub use factor::Precision;

use crate::halo::Link;
use crate::slab::Slabs;
use crate::stencil::Stencil;
use bsmpm::grid::Grid;
use bsmpm::nodal::Nodal;
use factor::Factor;
use plan::Plan;
use reduction::TreeReduction;
use std::sync::Mutex;
use tree::{Desk, Elimination, Scratch, Triangles};

/// Factorisation of one rank's share of the matrix. Its memory is kept when the unknowns change, as in most steps of a
/// flow.
#[derive(Default)]
pub struct Dissection {
    plan: Plan,
    factor: Factor, // supernode by supernode
    reduction: TreeReduction,
    desks: Vec<Mutex<Desk>>, // one per thread
    scratch: Scratch,
    work: Vec<f64>, // vector in elimination order
    scale: f64,     // power of two by which the matrix is multiplied
}

impl Dissection {
    /// Plans the elimination of the `free` components of the window of `rank` in the partition `slabs`, with C unknowns
    /// per node. Collective.
    pub fn plan<const D: usize, const C: usize>(
        &mut self,
        link: &dyn Link,
        slabs: &Slabs,
        rank: usize,
        grid: &Grid<D>,
        free: &[bool],
    ) {
        // Distance at which nodes couple.
        let q = grid.order() + grid.beyond();
        // Nodes that only this rank uses, counted from the window's first node.
        let (slab, part) = slabs.place(rank);
        let places = [(slab, slabs.slabs()), (part, slabs.parts_of_slab())];
        let counts: [usize; D] = std::array::from_fn(|axis| grid.nodes_along(axis));
        let inner = std::array::from_fn(|axis| {
            let (at, of) = places.get(axis).copied().unwrap_or((0, 1));
            let start = if at == 0 { 0 } else { q.min(counts[axis]) };
            let end = if at + 1 == of {
                counts[axis]
            } else {
                grid.cells_along()[axis].len()
            };
            start..end.max(start)
        });
        self.plan = Plan::new::<D, C>(counts, q, &inner, free);
        let shared = self.plan.shared().iter().map(|&component| {
            let (node, component) = Nodal::<C>::split(component as usize);
            Nodal::<C>::at(grid.number_of(node), component)
        });
        let shared: Vec<usize> = shared.collect();
        let [layer, row] = [1, 2].map(|first| (first..D).map(|axis| grid.axes()[axis].functions()).product::<usize>());
        let role = reduction::role(slabs.ranks(), rank);
        self.reduction = TreeReduction::new(link, rank, role, &shared, |component| {
            let node = Nodal::<C>::node(component);
            slabs.touching([node / layer, node % layer / row], grid.order())
        });
    }

    /// Factorises the matrix; `false` if a pivot of this rank is not positive and finite. The matrix is divided by the
    /// power of two in `largest`, its approximate largest entry: square roots then round alike in all units that differ
    /// by powers of two. Collective.
    pub fn factorise<const D: usize, const C: usize>(
        &mut self,
        link: &dyn Link,
        precision: Precision,
        stencil: &Stencil<D, C>,
        largest: f64,
    ) -> bool {
        let unit = f64::from_bits(largest.to_bits() & f64::INFINITY.to_bits());
        self.scale = if unit.is_normal() { 1.0 / unit } else { 1.0 };
        let Self {
            plan,
            factor,
            reduction,
            desks,
            scale,
            ..
        } = self;
        let room = factor.restart(precision, plan.entries());
        desks.resize_with(rayon::current_num_threads(), Mutex::default);
        let (rest, good) = Elimination {
            plan,
            stencil,
            scale: *scale,
            desks,
        }
        .run(room);
        reduction.factorise(link, precision, rest) && good
    }

    /// Solves with the last factorisation for the nodal right-hand side, whose `owned` components are this rank's. The
    /// solution is valid at all nodes of the window. Collective.
    pub fn solve(&mut self, link: &dyn Link, owned: impl Fn(usize) -> bool, rhs: &[f64], solution: &mut [f64]) {
        let Self {
            plan,
            factor,
            reduction,
            scratch,
            work,
            scale,
            ..
        } = self;
        work.clear();
        work.extend(plan.order.iter().map(|&component| match component as usize {
            component if owned(component) => rhs[component] * *scale,
            _ => 0.0,
        }));
        let triangles = Triangles { plan, factor };
        triangles.forward(work, scratch);
        reduction.solve(link, &mut work[plan.eliminated()..]);
        triangles.backward(work, scratch);
        solution.fill(0.0);
        plan.order
            .iter()
            .zip(&*work)
            .for_each(|(&component, value)| solution[component as usize] = *value);
    }
}
