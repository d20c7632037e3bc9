//! If all nodes of a contact face slide outwards and no equilibrium is found, makes the node stick where the direction
//! of slip changes.

use super::Contacts;
use crate::boundary::coulomb::Status;
use crate::grid::Grid;
use crate::parallel::Halo;
use std::collections::BTreeMap;

impl<const D: usize> Contacts<D> {
    /// Lets nodes stick at which the direction of sliding changes along a face, those that slide least under `u` (m),
    /// or have done so for longer; how many over all ranks. None where some node sticks already. A
    /// reduction, and an exchange with the neighbours where all that has friction slides.
    pub fn hold_neutral(&mut self, grid: &Grid<D>, u: &[f64], halo: &dyn Halo) -> usize {
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

    /// Numbers of nodes that slide less than a neighbour which slides in the opposite direction.
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

    /// Component along an axis of the direction in which a node slides, 0 where it does not.
    fn direction(&self, number: usize, axis: usize) -> f64 {
        match self.nodes[number].status {
            Status::Slip(direction) => direction[axis],
            Status::Open | Status::Stick => 0.0,
        }
    }

    /// Order in which nodes are taken to stick: what has just come to slide would stick at its limit again.
    fn order(&self, number: usize, u: &[f64]) -> (bool, f64) {
        (self.released[number], self.nodes[number].slip(u).norm())
    }
}

/// Whether a node slides against friction.
fn has_friction<const D: usize>(status: Status<D>) -> bool {
    matches!(status, Status::Slip(direction) if direction.norm_squared() > 0.0)
}
