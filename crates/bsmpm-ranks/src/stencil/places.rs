//! Positions of the nodes that couple with a node.

use bsmpm::grid::Grid;
use std::collections::HashMap;

/// Positions in the stencils of a window.
#[derive(Clone, Debug)]
pub(super) struct Places<const D: usize> {
    functions: [usize; D], // nodes of the window along each axis
    half: usize,           // half width of a stencil: q and the additional layers
    reach: Vec<isize>,     // offset in local nodes of every position, ascending
    inside: Vec<Vec<u16>>, // positions inside the window, for every combination of near faces
    kind: Vec<u16>,        // of every node: index of its combination
}

impl<const D: usize> Places<D> {
    pub fn new(grid: &Grid<D>) -> Self {
        let half = grid.order() + grid.beyond();
        let side = 2 * half + 1;
        let functions = std::array::from_fn(|axis| grid.nodes_along(axis));
        let within: Vec<[isize; D]> = (0..side.pow(D as u32))
            .map(|place| digits(place, &[side; D]).map(|step| step as isize - half as isize))
            .collect();
        let reach = within
            .iter()
            .map(|step| (1..D).fold(step[0], |sum, axis| sum * functions[axis] as isize + step[axis]))
            .collect();
        let mut kinds = HashMap::new();
        let mut inside = Vec::new();
        let mut kind = Vec::with_capacity(grid.nodes());
        for node in 0..grid.nodes() {
            let node = digits(node, &functions);
            let room: [[usize; 2]; D] =
                std::array::from_fn(|axis| [node[axis], functions[axis] - 1 - node[axis]].map(|nodes| nodes.min(half)));
            kind.push(*kinds.entry(room).or_insert_with(|| {
                let places = within.iter().enumerate().filter(|(_, step)| fits(step, &room));
                inside.push(places.map(|(place, _)| place as u16).collect());
                (inside.len() - 1) as u16
            }));
        }
        Self {
            functions,
            half,
            reach,
            inside,
            kind,
        }
    }

    /// Returns the number of positions of a stencil.
    pub fn count(&self) -> usize {
        self.reach.len()
    }

    /// Iterates over the positions of the stencil of `node` that are inside the window, each with its node.
    pub fn around(&self, node: usize) -> impl Iterator<Item = (usize, usize)> {
        self.inside[usize::from(self.kind[node])].iter().map(move |&place| {
            let place = usize::from(place);
            (place, node.wrapping_add_signed(self.reach[place]))
        })
    }

    /// Returns the position of the node `b` in the stencil of `a`, if it is inside.
    pub fn between(&self, a: usize, b: usize) -> Option<usize> {
        let [a, b] = [a, b].map(|node| digits(node, &self.functions));
        let near = (0..D).all(|axis| a[axis].abs_diff(b[axis]) <= self.half);
        near.then(|| self.of(self.number(a), self.number(b)))
    }

    /// Returns the lowest node of the box around two nodes of the window.
    pub fn lowest(&self, a: usize, b: usize) -> usize {
        let [a, b] = [a, b].map(|node| digits(node, &self.functions));
        (0..D).fold(0, |node, axis| node * self.functions[axis] + a[axis].min(b[axis]))
    }

    /// Returns the number of a node in a box as wide as a stencil. Differences of two numbers are differences of
    /// positions.
    pub fn number(&self, at: [usize; D]) -> usize {
        at.into_iter()
            .fold(0, |number, step| number * (2 * self.half + 1) + step)
    }

    /// Returns this number for a node of the window.
    pub fn number_of(&self, node: usize) -> usize {
        self.number(digits(node, &self.functions))
    }

    /// Returns the position of the node with number `b` in the stencil of the node with number `a`.
    pub fn of(&self, a: usize, b: usize) -> usize {
        // The step from a to b has the digits b_k - a_k, from -half to half, in the base 2 half + 1. Adding half to
        // each digit gives the position, and the numbers are linear in their digits.
        b + self.number([self.half; D]) - a
    }
}

/// Returns the digits of a number in mixed bases. The first digit is the most significant and is not limited.
fn digits<const D: usize>(mut number: usize, bases: &[usize; D]) -> [usize; D] {
    let mut digits = [0; D];
    for axis in (1..D).rev() {
        digits[axis] = number % bases[axis];
        number /= bases[axis];
    }
    digits[0] = number;
    digits
}

/// Returns whether a step stays inside the window; `room` has the number of nodes below and above along each axis.
fn fits<const D: usize>(step: &[isize; D], room: &[[usize; 2]; D]) -> bool {
    (0..D).all(|axis| step[axis].unsigned_abs() <= room[axis][usize::from(step[axis] > 0)])
}
