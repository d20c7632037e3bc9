//! Factorises and solves on several threads. The number of threads does not change the results.

use super::factor::{Factor, Room};
use super::front;
use super::plan::{NONE, Plan, Supernode};
use super::reduction::{add_packed, pack};
use crate::stencil::Stencil;
use std::ops::Range;
use std::sync::Mutex;

/// Numbers of a subtree's factor from which on its halves are worth two threads: 2^14 and 2^16 take as long.
pub(super) const WORTH: usize = 1 << 15;

/// Whether the subtree of a part is worth being cut for threads.
fn is_worth(plan: &Plan, root: usize) -> bool {
    rayon::current_num_threads() > 1 && plan.columns_to(root).len() >= WORTH && plan.parts[root].children > 0
}

/// The first child of a part, and the last one if there are two.
fn halves(plan: &Plan, root: usize) -> (usize, Option<usize>) {
    let mut children = plan.children(root);
    let last = children.next().expect("what is worth a cut has children");
    children.next().map_or((last, None), |first| (first, Some(last)))
}

/// What one thread works with.
#[derive(Default)]
pub struct Desk {
    columns: Vec<f64>,  // of the front in work
    matrix: Vec<f64>,   // what it leaves
    places: Vec<usize>, // in its front by elimination number
}

/// What parts leave that has not been taken, packed, and whether all pivots so far were positive.
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

/// The matrix that is factorised: a stencil's entries times a power of two.
pub struct Elimination<'a, const D: usize, const C: usize> {
    pub plan: &'a Plan,
    pub stencil: &'a Stencil<D, C>,
    pub scale: f64,
    /// one for every thread
    pub desks: &'a [Mutex<Desk>],
}

impl<const D: usize, const C: usize> Elimination<'_, D, C> {
    /// Eliminates all parts into `room`. What is left of the last one's front, packed, and whether all pivots were
    /// positive and finite.
    pub fn run(&self, room: Room<'_>) -> (Vec<f64>, bool) {
        let mut left = Left::nothing();
        self.subtree(self.plan.parts.len() - 1, room, &mut left);
        (left.packed.pop().expect("a plan has a last part"), left.good)
    }

    /// Eliminates a part and all below it, whose columns `room` begins with; what it leaves comes last.
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

    /// Eliminates parts one after another, whose columns `room` begins with. Nothing in here waits for other threads.
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

    /// Adds the matrix's own entries of a part: its rows against what is eliminated later; of the last part, what it
    /// shares.
    fn take(&self, index: usize, places: &[usize], columns: &mut [f64], matrix: &mut [f64]) {
        let Self {
            plan, stencil, scale, ..
        } = *self;
        let part = &plan.parts[index];
        let rows = part.rows();
        let order = part.rim.len();
        // Between two bodies a separator may be without unknowns, too.
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

/// What one thread solves with.
#[derive(Default)]
pub struct Scratch {
    x: Vec<f64>,    // of the front in work
    rims: Vec<f64>, // of parts whose neighbours in the tree have not taken theirs
}

/// The triangular solves with a factor.
#[derive(Clone, Copy)]
pub struct Triangles<'a> {
    pub plan: &'a Plan,
    pub factor: &'a Factor,
}

impl Triangles<'_> {
    /// Takes what is eliminated from the right-hand side `work`, by elimination numbers.
    pub fn forward(&self, work: &mut [f64], scratch: &mut Scratch) {
        let (eliminated, others) = work.split_at_mut(self.plan.eliminated());
        self.forward_to(self.plan.parts.len() - 1, eliminated, scratch);
        others
            .iter_mut()
            .zip(&scratch.rims)
            .for_each(|(value, taken)| *value += taken);
        scratch.rims.clear();
    }

    /// Solves for what is eliminated, given the solution of the last numbers of `work`.
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
            // The last child is the next one.
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
