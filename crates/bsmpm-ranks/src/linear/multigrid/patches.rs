//! Additive Schwarz method on overlapping boxes of nodes.

use super::Operator;
use crate::linear::dissection::front;

/// Number of partial sums of a product.
const LANES: usize = 8;

/// Boxes of nodes with their Cholesky factors.
pub(super) struct Patches {
    members: Vec<u32>,  // components, box by box
    counts: Vec<usize>, // components of every box
    factors: Vec<f32>,  // columns of L from the diagonal on, with inverted diagonal entries
}

impl Patches {
    /// Creates boxes of `side` nodes along an axis, `apart` nodes from one to the next, in a window of `along` nodes.
    /// Returns `None` if the matrix of a box is not positive definite.
    pub fn new<const D: usize, const C: usize>(
        operator: Operator<'_, D, C>,
        along: [usize; D],
        side: usize,
        apart: usize,
    ) -> Option<Self> {
        let mut patches = Self {
            members: Vec::new(),
            counts: Vec::new(),
            factors: Vec::new(),
        };
        let mut places = vec![u32::MAX; along.iter().product::<usize>() * C];
        // A further box is added where the last one does not extend to the end.
        let boxes = along.map(|nodes| nodes.saturating_sub(side).div_ceil(apart) + 1);
        for number in 0..boxes.iter().product() {
            let mut rest = number;
            let mut lower = [0; D];
            for axis in (0..D).rev() {
                lower[axis] = rest % boxes[axis] * apart;
                rest /= boxes[axis];
            }
            let upper: [usize; D] = std::array::from_fn(|axis| along[axis].min(lower[axis] + side));
            patches.add_box(operator, along, lower, upper, &mut places)?;
        }
        Some(patches)
    }

    fn add_box<const D: usize, const C: usize>(
        &mut self,
        operator: Operator<'_, D, C>,
        along: [usize; D],
        lower: [usize; D],
        upper: [usize; D],
        places: &mut [u32],
    ) -> Option<()> {
        let Operator { stencil, free } = operator;
        let widths: [usize; D] = std::array::from_fn(|axis| upper[axis] - lower[axis]);
        let first = self.members.len();
        for number in 0..widths.iter().product() {
            let mut rest = number;
            let mut at = [0; D];
            for axis in (0..D).rev() {
                at[axis] = lower[axis] + rest % widths[axis];
                rest /= widths[axis];
            }
            let node = (0..D).fold(0, |node, axis| node * along[axis] + at[axis]);
            self.members.extend(
                (node * C..(node + 1) * C)
                    .filter(|&component| free[component])
                    .map(|c| c as u32),
            );
        }
        let members = &self.members[first..];
        let order = members.len();
        if order == 0 {
            return Some(());
        }
        (0..)
            .zip(members)
            .for_each(|(place, &member)| places[member as usize] = place);
        let mut columns = vec![0.0; order * order];
        for (column, &member) in columns.chunks_exact_mut(order).zip(members) {
            for (component, values) in stencil.row(member as usize) {
                for (value, &place) in values.iter().zip(&places[component..component + C]) {
                    if place != u32::MAX {
                        column[place as usize] = *value;
                    }
                }
            }
        }
        members.iter().for_each(|&member| places[member as usize] = u32::MAX);
        if !front::factorise(&mut columns, order) {
            return None;
        }
        for (at, column) in columns.chunks_exact(order).enumerate() {
            self.factors.push((1.0 / column[at]) as f32);
            self.factors.extend(column[at + 1..].iter().map(|&value| value as f32));
        }
        self.counts.push(order);
        Some(())
    }

    /// Adds the sum of the boxes' solutions for `r` to `z`.
    pub fn add(&self, r: &[f64], z: &mut [f64]) {
        let mut members = &self.members[..];
        let mut factors = &self.factors[..];
        // Single precision has a small range, so values are scaled to about 1 in any units.
        let scale = r.iter().fold(0.0_f64, |largest, r| largest.max(r.abs()));
        if scale == 0.0 {
            return;
        }
        let mut x = Vec::new();
        for &order in &self.counts {
            let (own, others) = members.split_at(order);
            let (factor, rest) = factors.split_at(order * (order + 1) / 2);
            (members, factors) = (others, rest);
            x.clear();
            x.extend(own.iter().map(|&member| (r[member as usize] / scale) as f32));
            solve(factor, &mut x);
            own.iter()
                .zip(&x)
                .for_each(|(&member, x)| z[member as usize] += f64::from(*x) * scale);
        }
    }
}

/// Computes x = L^-T L^-1 x.
fn solve(factor: &[f32], x: &mut [f32]) {
    let order = x.len();
    let mut at = 0;
    for column in 0..order {
        let l = &factor[at..at + order - column];
        let (here, below) = x[column..].split_first_mut().expect("a row is left");
        *here *= l[0];
        below.iter_mut().zip(&l[1..]).for_each(|(below, l)| *below -= *here * l);
        at += order - column;
    }
    for column in (0..order).rev() {
        at -= order - column;
        let l = &factor[at..at + order - column];
        let (here, below) = x[column..].split_first_mut().expect("a row is left");
        *here = (*here - product(&l[1..], below)) * l[0];
    }
}

/// Returns a . b by several partial sums.
fn product(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0; LANES];
    let blocks = a.chunks_exact(LANES);
    let others = b.chunks_exact(LANES);
    let rest: f32 = blocks
        .remainder()
        .iter()
        .zip(others.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in blocks.zip(others) {
        sums.iter_mut()
            .zip(a.iter().zip(b))
            .for_each(|(sum, (a, b))| *sum += a * b);
    }
    sums.iter().sum::<f32>() + rest
}
