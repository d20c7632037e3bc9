//! Positions of the nodes that couple with a node.

use bsmpm::grid::Grid;
use std::collections::HashMap;

/// The places of the stencils of a window.
#[derive(Clone, Debug)]
pub(super) struct Places<const D: usize> {
    functions: [usize; D], // nodes of the window along each axis
    half: usize,           // of the box: q, and the layers beyond
    reach: Vec<isize>,     // offset in local nodes of every place, ascending
    inside: Vec<Vec<u16>>, // places that lie in the window, for every way of being near its faces
    kind: Vec<u16>,        // of every node: which of those
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

    /// Places of a stencil.
    pub fn count(&self) -> usize {
        self.reach.len()
    }

    /// The places of `node` that lie in the window, each with its node.
    pub fn around(&self, node: usize) -> impl Iterator<Item = (usize, usize)> {
        self.inside[usize::from(self.kind[node])].iter().map(move |&place| {
            let place = usize::from(place);
            (place, node.wrapping_add_signed(self.reach[place]))
        })
    }

    /// The place of the node `b` as seen from `a`, if it is one.
    pub fn between(&self, a: usize, b: usize) -> Option<usize> {
        let [a, b] = [a, b].map(|node| digits(node, &self.functions));
        let near = (0..D).all(|axis| a[axis].abs_diff(b[axis]) <= self.half);
        near.then(|| self.of(self.number(a), self.number(b)))
    }

    /// The lowest node of the box around two nodes of the window.
    pub fn lowest(&self, a: usize, b: usize) -> usize {
        let [a, b] = [a, b].map(|node| digits(node, &self.functions));
        (0..D).fold(0, |node, axis| node * self.functions[axis] + a[axis].min(b[axis]))
    }

    /// Number of a node in a box as wide along every axis as a stencil's; differences of two are those of their places.
    pub fn number(&self, at: [usize; D]) -> usize {
        at.into_iter()
            .fold(0, |number, step| number * (2 * self.half + 1) + step)
    }

    /// The same of a node of the window.
    pub fn number_of(&self, node: usize) -> usize {
        self.number(digits(node, &self.functions))
    }

    /// The place of node number `b` as seen from node number `a`.
    pub fn of(&self, a: usize, b: usize) -> usize {
        b + self.number([self.half; D]) - a
    }
}

/// A number by the digits of these bases, the first of which leads and takes what is left.
fn digits<const D: usize>(mut number: usize, bases: &[usize; D]) -> [usize; D] {
    let mut digits = [0; D];
    for axis in (1..D).rev() {
        digits[axis] = number % bases[axis];
        number /= bases[axis];
    }
    digits[0] = number;
    digits
}

/// Whether a step leads to a node, where there are as many nodes below and above along each axis as `room` says.
fn fits<const D: usize>(step: &[isize; D], room: &[[usize; 2]; D]) -> bool {
    (0..D).all(|axis| step[axis].unsigned_abs() <= room[axis][usize::from(step[axis] > 0)])
}
