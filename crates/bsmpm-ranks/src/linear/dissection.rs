//! A direct solver for symmetric positive definite systems on boxes of a grid: nested dissection of the grid, dense
//! fronts.
//!
//! Every rank eliminates what only its own cells touch (multifrontal Cholesky factorisation, Duff and Reid 1983, ACM
//! Trans. Math. Softw. 9, 302-325), then neighbours pair up. Order, schedule and sums depend on the free components and
//! the cut only: the same bits in every run on as many ranks. A rank holds the factor of its box and, but for the
//! first one, a dense front of one cut, which of slabs does not become smaller with more ranks. The order comes from
//! the grid's box of nodes, so that unknowns that come or go cost no analysis of a graph.

mod factor;
pub(super) mod front;
mod plan;
mod reduction;
#[cfg(test)]
mod tests;

pub use factor::Precision;

use crate::halo::Link;
use crate::slab::Slabs;
use crate::stencil::Stencil;
use bsmpm::grid::Grid;
use bsmpm::nodal::Nodal;
use factor::Factor;
use plan::{NONE, Plan, Supernode};
use reduction::{TreeReduction, add_packed, pack};

/// A factorisation of one rank's share of the matrix. Its memory is kept when the unknowns change, as they do in most
/// steps of a flow.
#[derive(Default)]
pub struct Dissection {
    plan: Plan,
    factor: Factor, // part after part
    reduction: TreeReduction,
    columns: Vec<f64>, // of the front in work
    matrix: Vec<f64>,  // what it leaves
    work: Vec<f64>,    // a vector by elimination numbers
    scale: f64,        // a power of two that the matrix is multiplied with
}

impl Dissection {
    /// Plans for the `free` components of the window of `rank` under the cut `slabs`; C unknowns a node. Collective.
    pub fn plan<const D: usize, const C: usize>(
        &mut self,
        link: &dyn Link,
        (slabs, rank): (&Slabs, usize),
        grid: &Grid<D>,
        free: &[bool],
    ) {
        // How far nodes couple.
        let q = grid.order() + grid.beyond();
        // Nodes that no other rank touches, from the window's first.
        let (slab, part) = slabs.place(rank);
        let places = [(slab, slabs.slabs()), (part, slabs.parts_of_slab())];
        let counts: [usize; D] = std::array::from_fn(|axis| grid.nodes_along(axis));
        let inner = std::array::from_fn(|axis| {
            let (at, of) = places.get(axis).copied().unwrap_or((0, 1));
            let start = if at == 0 { 0 } else { q.min(counts[axis]) };
            let end = if at + 1 == of { counts[axis] } else { grid.cells_along()[axis].len() };
            start..end.max(start)
        });
        self.plan = Plan::new::<D, C>(counts, q, &inner, free);
        let whole = |&component: &u32| {
            let (node, component) = Nodal::<C>::split(component as usize);
            Nodal::<C>::at(grid.number_of(node), component)
        };
        let shared: Vec<usize> = self.plan.shared().iter().map(whole).collect();
        let [layer, row] = [1, 2].map(|first| (first..D).map(|axis| grid.axes()[axis].functions()).product::<usize>());
        let touching = |component: usize| {
            let node = Nodal::<C>::node(component);
            slabs.touching([node / layer, node % layer / row], grid.order())
        };
        self.reduction = TreeReduction::new(link, (rank, reduction::role(slabs.ranks(), rank)), &shared, touching);
    }

    /// Factorises; `false` where a pivot of this rank was not positive and finite. `largest` is about the largest
    /// number of the matrix: without its power of two, square roots round alike in all units that differ by powers of
    /// two. Collective.
    pub fn factorise<const D: usize, const C: usize>(
        &mut self,
        link: &dyn Link,
        precision: Precision,
        stencil: &Stencil<D, C>,
        largest: f64,
    ) -> bool {
        let unit = f64::from_bits(largest.to_bits() & f64::INFINITY.to_bits());
        self.scale = if unit.is_normal() { 1.0 / unit } else { 1.0 };
        let Self { plan, factor, reduction, columns, matrix, scale, .. } = self;
        factor.restart(precision, plan.entries());
        let mut stack = Vec::new();
        let mut places = vec![0; plan.order.len()];
        let mut good = true;
        for part in &plan.parts {
            (0..).zip(plan.front(part)).for_each(|(place, number)| places[number] = place);
            let order = part.rim.len();
            columns.clear();
            columns.resize(part.own.len() * part.rows(), 0.0);
            matrix.clear();
            matrix.resize(order * order, 0.0);
            take(plan, part, (stencil, &places, *scale), columns, matrix);
            for _ in 0..part.children {
                let (child, packed): (&Supernode, Vec<f64>) =
                    stack.pop().expect("children come right before their parent");
                let rim: Vec<usize> = child.rim.iter().map(|&number| places[number as usize]).collect();
                add_packed(&packed, &rim, (columns, part.own.len()), matrix);
            }
            good &= front::factorise(columns, part.rows());
            front::subtract_from_rest(columns, part.rows(), matrix);
            factor.keep(columns, part.rows());
            stack.push((part, pack(matrix, order)));
        }
        let (_, rest) = stack.pop().expect("a plan has a last part");
        reduction.factorise(link, precision, rest) && good
    }

    /// Solves for the nodal right-hand side whose `owned` components are this rank's, with the last factorisation; the
    /// solution is right at all nodes of the window. Collective.
    pub fn solve(&mut self, link: &dyn Link, owned: impl Fn(usize) -> bool, rhs: &[f64], solution: &mut [f64]) {
        let Self { plan, factor, reduction, work, scale, .. } = self;
        let own = |component: usize| if owned(component) { rhs[component] * *scale } else { 0.0 };
        work.clear();
        work.extend(plan.order.iter().map(|&component| own(component as usize)));
        let mut x = Vec::new();
        for part in &plan.parts {
            x.clear();
            x.extend_from_slice(&work[part.own.clone()]);
            x.resize(part.rows(), 0.0);
            factor.forward(part.start, part.shape(), &mut x);
            work[part.own.clone()].copy_from_slice(&x[..part.own.len()]);
            part.rim.iter().zip(&x[part.own.len()..]).for_each(|(&number, taken)| work[number as usize] += taken);
        }
        reduction.solve(link, &mut work[plan.eliminated()..]);
        for part in plan.parts.iter().rev() {
            x.clear();
            x.extend(plan.front(part).map(|number| work[number]));
            factor.backward(part.start, part.shape(), &mut x);
            work[part.own.clone()].copy_from_slice(&x[..part.own.len()]);
        }
        solution.fill(0.0);
        plan.order.iter().zip(&*work).for_each(|(&component, value)| solution[component as usize] = *value);
    }
}

/// Adds the matrix's own entries of a part: its rows against what is eliminated later; of the last part, what it
/// shares.
fn take<const D: usize, const C: usize>(
    plan: &Plan,
    part: &Supernode,
    (stencil, places, scale): (&Stencil<D, C>, &[usize], f64),
    columns: &mut [f64],
    matrix: &mut [f64],
) {
    let (rows, order) = (part.rows(), part.rim.len());
    // Between two bodies a separator may be without unknowns, too.
    let last = plan.parts.last().is_some_and(|last| std::ptr::eq(last, part));
    let numbers = if last { plan.eliminated()..plan.order.len() } else { part.own.clone() };
    for number in numbers {
        let place = places[number];
        let target = if last { &mut matrix[place * order..][..order] } else { &mut columns[place * rows..][..rows] };
        for (component, values) in stencil.row(plan.order[number] as usize) {
            for (value, &other) in values.iter().zip(&plan.number[component..component + C]) {
                if other != NONE && other as usize >= number {
                    target[places[other as usize]] += value * scale;
                }
            }
        }
    }
}
