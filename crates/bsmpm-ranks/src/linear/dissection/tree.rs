//! Factorises and solves on several threads. The number of threads does not change the results.

use super::factor::{Factor, Room};
use super::front;
use super::plan::{NONE, Plan, Supernode};
use super::reduction::{add_packed, pack};
use crate::stencil::Stencil;
use std::ops::Range;
use std::sync::Mutex;

/// Size of a subtree's factor above which its halves are given to two threads; 2^14 and 2^16 take equally long.
pub(super) const WORTH: usize = 1 << 15;

/// Returns whether the subtree of a supernode is large enough to be divided between threads.
fn is_worth(plan: &Plan, root: usize) -> bool {
    rayon::current_num_threads() > 1 && plan.columns_to(root).len() >= WORTH && plan.parts[root].children > 0
}

/// Returns the first child of a supernode, and the last one if there are two.
fn halves(plan: &Plan, root: usize) -> (usize, Option<usize>) {
    let mut children = plan.children(root);
    let last = children.next().expect("what is worth a cut has children");
    children.next().map_or((last, None), |first| (first, Some(last)))
}

/// Work arrays of one thread.
#[derive(Default)]
pub struct Desk {
    columns: Vec<f64>,  // of the present front
    matrix: Vec<f64>,   // update matrix of the front
    places: Vec<usize>, // positions in the front by elimination number
}

/// Packed update matrices that parents have not received yet, and whether all pivots so far were positive.
struct Left {
    packed: Vec<Vec<f64>>,
    good: bool,
}

impl Left {
    fn nothing() -> Self {
        Self {
            packed: Vec::new(),
            good: true,
        }
    }
}

/// Matrix to be factorised: a stencil's entries times a power of two.
pub struct Elimination<'a, const D: usize, const C: usize> {
    pub plan: &'a Plan,
    pub stencil: &'a Stencil<D, C>,
    pub scale: f64,
    /// One per thread.
    pub desks: &'a [Mutex<Desk>],
}

impl<const D: usize, const C: usize> Elimination<'_, D, C> {
    /// Eliminates all supernodes into `room`. Returns the packed update matrix of the last one, and whether all pivots
    /// were positive and finite.
    pub fn run(&self, room: Room<'_>) -> (Vec<f64>, bool) {
        let mut left = Left::nothing();
        self.subtree(self.plan.parts.len() - 1, room, &mut left);
        (left.packed.pop().expect("a plan has a last part"), left.good)
    }

    /// Eliminates a supernode and its descendants, whose columns begin `room`. Its update matrix is appended last.
    fn subtree(&self, root: usize, room: Room<'_>, left: &mut Left) {
        if !is_worth(self.plan, root) {
            return self.in_order(self.plan.parts[root].first..root + 1, room, left);
        }
        let (first, last) = halves(self.plan, root);
        let (low, rest) = room.split_at(self.plan.columns_to(first).len());
        let Some(last) = last else {
            self.subtree(first, low, left);
            return self.in_order(root..root + 1, rest, left);
        };
        let (high, own) = rest.split_at(self.plan.columns_to(last).len());
        let mut other = Left::nothing();
        rayon::join(
            || self.subtree(first, low, left),
            || self.subtree(last, high, &mut other),
        );
        left.packed.append(&mut other.packed);
        left.good &= other.good;
        self.in_order(root..root + 1, own, left);
    }

    /// Eliminates supernodes one after another, whose columns begin `room`. Does not wait for other threads, because it
    /// locks a desk.
    fn in_order(&self, parts: Range<usize>, mut room: Room<'_>, Left { packed, good }: &mut Left) {
        let start = self.plan.parts[parts.start].start;
        let thread = rayon::current_thread_index().unwrap_or(0) % self.desks.len();
        let mut desk = self.desks[thread].lock().expect("no thread panicked");
        let Desk {
            columns,
            matrix,
            places,
        } = &mut *desk;
        places.resize(self.plan.order.len(), 0);
        for index in parts {
            let part = &self.plan.parts[index];
            (0..)
                .zip(self.plan.front(part))
                .for_each(|(place, number)| places[number] = place);
            let order = part.rim.len();
            columns.clear();
            columns.resize(part.own.len() * part.rows(), 0.0);
            matrix.clear();
            matrix.resize(order * order, 0.0);
            self.take(index, places, columns, matrix);
            for child in self.plan.children(index) {
                let left = packed.pop().expect("children come right before their parent");
                add_packed(&left, &self.plan.parts[child].above, columns, part.own.len(), matrix);
            }
            *good &= front::factorise(columns, part.rows());
            front::subtract_from_rest(columns, part.rows(), matrix);
            room.keep(part.start - start, columns, part.rows());
            packed.push(pack(matrix, order));
        }
    }

    /// Adds the matrix entries of a supernode: its rows and the columns that are eliminated later. For the last one,
    /// the entries between shared unknowns.
    fn take(&self, index: usize, places: &[usize], columns: &mut [f64], matrix: &mut [f64]) {
        let Self {
            plan, stencil, scale, ..
        } = *self;
        let part = &plan.parts[index];
        let rows = part.rows();
        let order = part.rim.len();
        // A separator between two bodies may also have no unknowns, so an empty supernode need not be the last.
        let last = index + 1 == plan.parts.len();
        let numbers = if last {
            plan.eliminated()..plan.order.len()
        } else {
            part.own.clone()
        };
        for number in numbers {
            let place = places[number];
            let target = if last {
                &mut matrix[place * order..][..order]
            } else {
                &mut columns[place * rows..][..rows]
            };
            for (component, values) in stencil.row(plan.order[number] as usize) {
                for (value, &other) in values.iter().zip(&plan.number[component..component + C]) {
                    if other != NONE && other as usize >= number {
                        target[places[other as usize]] += value * scale;
                    }
                }
            }
        }
    }
}

/// Work arrays of one thread for a solution.
#[derive(Default)]
pub struct Scratch {
    x: Vec<f64>,    // of the present front
    rims: Vec<f64>, // values at rims that neighbours in the tree have not received yet
}

/// Triangular solution with a factor.
#[derive(Clone, Copy)]
pub struct Triangles<'a> {
    pub plan: &'a Plan,
    pub factor: &'a Factor,
}

impl Triangles<'_> {
    /// Eliminates this rank's own unknowns from the right-hand side `work`, in elimination order.
    pub fn forward(&self, work: &mut [f64], scratch: &mut Scratch) {
        let (eliminated, others) = work.split_at_mut(self.plan.eliminated());
        self.forward_to(self.plan.parts.len() - 1, eliminated, scratch);
        others
            .iter_mut()
            .zip(&scratch.rims)
            .for_each(|(value, taken)| *value += taken);
        scratch.rims.clear();
    }

    /// Solves for this rank's own unknowns, given the solution of the shared ones at the end of `work`.
    pub fn backward(&self, work: &mut [f64], scratch: &mut Scratch) {
        let (eliminated, others) = work.split_at_mut(self.plan.eliminated());
        scratch.rims.extend_from_slice(others);
        self.backward_to(self.plan.parts.len() - 1, eliminated, scratch);
    }

    fn forward_to(&self, root: usize, work: &mut [f64], scratch: &mut Scratch) {
        if !is_worth(self.plan, root) {
            return self.forward_in_order(self.plan.parts[root].first..root + 1, work, scratch);
        }
        let (first, last) = halves(self.plan, root);
        let (low, rest) = work.split_at_mut(self.plan.numbers_to(first).len());
        let Some(last) = last else {
            self.forward_to(first, low, scratch);
            return self.forward_in_order(root..root + 1, rest, scratch);
        };
        let (high, own) = rest.split_at_mut(self.plan.numbers_to(last).len());
        let mut other = Scratch::default();
        rayon::join(
            || self.forward_to(first, low, scratch),
            || self.forward_to(last, high, &mut other),
        );
        scratch.rims.extend(other.rims);
        self.forward_in_order(root..root + 1, own, scratch);
    }

    fn forward_in_order(&self, parts: Range<usize>, work: &mut [f64], Scratch { x, rims }: &mut Scratch) {
        let base = self.plan.parts[parts.start].own.start;
        for index in parts {
            let part = &self.plan.parts[index];
            let own = &mut work[part.own.start - base..part.own.end - base];
            x.clear();
            x.extend_from_slice(own);
            x.resize(part.rows(), 0.0);
            for child in self.plan.children(index) {
                let above = &self.plan.parts[child].above;
                let start = rims.len() - above.len();
                above
                    .iter()
                    .zip(&rims[start..])
                    .for_each(|(&place, taken)| x[place] += taken);
                rims.truncate(start);
            }
            self.factor.forward(part.start, part.rows(), part.own.len(), x);
            own.copy_from_slice(&x[..own.len()]);
            rims.extend_from_slice(&x[own.len()..]);
        }
    }

    fn backward_to(&self, root: usize, work: &mut [f64], scratch: &mut Scratch) {
        if !is_worth(self.plan, root) {
            return self.backward_in_order(self.plan.parts[root].first..root + 1, work, scratch);
        }
        let (first, last) = halves(self.plan, root);
        let (low, rest) = work.split_at_mut(self.plan.numbers_to(first).len());
        let Some(last) = last else {
            self.backward_in_order(root..root + 1, rest, scratch);
            return self.backward_to(first, low, scratch);
        };
        let (high, own) = rest.split_at_mut(self.plan.numbers_to(last).len());
        self.backward_in_order(root..root + 1, own, scratch);
        let start = scratch.rims.len() - self.plan.parts[last].rim.len();
        let mut other = Scratch {
            rims: scratch.rims.split_off(start),
            ..Scratch::default()
        };
        rayon::join(
            || self.backward_to(first, low, scratch),
            || self.backward_to(last, high, &mut other),
        );
    }

    fn backward_in_order(&self, parts: Range<usize>, work: &mut [f64], Scratch { x, rims }: &mut Scratch) {
        let base = self.plan.parts[parts.start].own.start;
        for index in parts.rev() {
            let part: &Supernode = &self.plan.parts[index];
            let own = &mut work[part.own.start - base..part.own.end - base];
            let start = rims.len() - part.rim.len();
            x.clear();
            x.extend_from_slice(own);
            x.extend_from_slice(&rims[start..]);
            rims.truncate(start);
            self.factor.backward(part.start, part.rows(), part.own.len(), x);
            own.copy_from_slice(&x[..own.len()]);
            // The last child is processed next, so its values go on top.
            let children: [Option<usize>; 2] = {
                let mut children = self.plan.children(index);
                [children.next(), children.next()]
            };
            for child in children.into_iter().rev().flatten() {
                rims.extend(self.plan.parts[child].above.iter().map(|&place| x[place]));
            }
        }
    }
}
