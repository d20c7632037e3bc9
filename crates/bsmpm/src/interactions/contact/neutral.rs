//! If all nodes of a contact face slide outwards and no equilibrium is found, makes the node stick where the direction
//! of slip changes.

use super::Contacts;
use crate::grid::Grid;
use crate::interactions::coulomb::Status;
use crate::parallel::Halo;
use std::collections::BTreeMap;

impl<const D: usize> Contacts<D> {
    /// Makes a node stick wherever the direction of slip changes along a face: the one of the two neighbours with less
    /// slip under `u` (m), or that did not start to slip in the last correction. Returns the number of these nodes on
    /// all ranks; 0 if any node sticks already. One reduction; if no node sticks, a second one and a ghost exchange.
    pub fn make_neutral_stick(&mut self, grid: &Grid<D>, u: &[f64], halo: &dyn Halo) -> usize {
        let mut sticking = [f64::from(u8::from(
            self.nodes.iter().any(|at| at.status == Status::Stick),
        ))];
        halo.all_reduce_max(&mut sticking);
        if sticking[0] > 0.0 {
            return 0;
        }
        let mut marks = vec![0.0; grid.nodes()];
        for number in self.neutral(grid, u) {
            marks[self.nodes[number].node] = 1.0;
        }
        halo.ghost_max(&mut marks, 1);
        let owned = halo.owned();
        let mut held = [0.0];
        for at in self
            .nodes
            .iter_mut()
            .filter(|at| marks[at.node] > 0.0 && has_friction(at.status))
        {
            (at.status, at.is_neutral) = (Status::Stick, true);
            held[0] += f64::from(u8::from(owned.contains(at.node)));
        }
        halo.all_reduce_sum(&mut held);
        held[0] as usize
    }

    /// Returns the indices of nodes with less slip than a neighbour that slides in the opposite direction.
    fn neutral(&self, grid: &Grid<D>, u: &[f64]) -> Vec<usize> {
        let numbered = self
            .nodes
            .iter()
            .enumerate()
            .map(|(number, at)| ((at.support, at.node), number));
        let numbers: BTreeMap<(usize, usize), usize> = numbered.collect();
        let mut found = Vec::new();
        for (number, at) in self.nodes.iter().enumerate() {
            for axis in (0..D).filter(|axis| *axis != at.axis) {
                let mut beyond = grid.node_at(at.node);
                beyond[axis] += 1;
                let next = grid
                    .node_index(&beyond)
                    .and_then(|node| numbers.get(&(at.support, node)));
                let opposite = next.filter(|next| self.direction(number, axis) * self.direction(**next, axis) < 0.0);
                let Some(&next) = opposite else { continue };
                found.push(if self.order(next, u) < self.order(number, u) {
                    next
                } else {
                    number
                });
            }
        }
        found
    }

    /// Returns the component of a node's slip direction along an axis; 0 if it does not slide.
    fn direction(&self, number: usize, axis: usize) -> f64 {
        match self.nodes[number].status {
            Status::Slip(direction) => direction[axis],
            Status::Open | Status::Stick => 0.0,
        }
    }

    /// Returns the sort key by which nodes are made to stick: nodes that just began to slide come last, because they
    /// would reach Coulomb's limit again.
    fn order(&self, number: usize, u: &[f64]) -> (bool, f64) {
        (self.released[number], self.nodes[number].slip(u).norm())
    }
}

/// Returns whether a node slides against friction.
fn has_friction<const D: usize>(status: Status<D>) -> bool {
    matches!(status, Status::Slip(direction) if direction.norm_squared() > 0.0)
}
