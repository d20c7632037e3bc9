//! Moves material points and nodal values to their new ranks, as a [`plan`](crate::plan) prescribes.

use crate::plan::{NodePlan, PointPlan};
use crate::slab::{NodeBox, Slabs};
use crate::traffic::{Traffic, TrafficKind};
use bsmpm::grid::Grid;
use bsmpm::points::Points;
use bsmpm::threads;
use mpi::collective::CommunicatorCollectives;
use mpi::point_to_point::{Destination, Source};
use mpi::topology::{Communicator, SimpleCommunicator};

/// Largest message (bytes). Longer messages are divided, because MPI counts with 31 bits.
const MESSAGE: usize = 1 << 20;

/// Sends every point to the rank of its cell, and sorts the points by cell. `grid` is this rank's window in the
/// partition `slabs`. Collective.
pub fn points<const D: usize>(
    world: &SimpleCommunicator,
    traffic: &Traffic,
    slabs: &Slabs,
    grid: &Grid<D>,
    points: &mut Points<D>,
) {
    let rank = world.rank().unsigned_abs() as usize;
    let owners = threads::each(points.len(), |p| {
        grid.locate(&points.x[p]).map_or(rank, |cell| slabs.owner(&cell))
    });
    let PointPlan { stay, leave } = PointPlan::new(owners.into_iter(), rank);
    // Messages are ordered column by column, so each column takes its rows from one contiguous range.
    let mut outgoing: Vec<(usize, Vec<u8>)> = leave.iter().map(|(other, _)| (*other, Vec::new())).collect();
    for column in points.columns() {
        for ((_, leaving), (_, message)) in leave.iter().zip(&mut outgoing) {
            leaving.iter().for_each(|&p| column.put(p as usize, message));
        }
        if !leave.is_empty() {
            column.reorder(&stay);
        }
    }
    let point_bytes = points.bytes();
    for (_, message) in exchange(world, traffic, &outgoing, MESSAGE) {
        let arrivals = message.len() / point_bytes;
        let mut rest = &message[..];
        for column in points.columns() {
            (0..arrivals).for_each(|_| column.take(&mut rest));
        }
    }
    points.sort_by_cell(grid);
}

/// Converts nodal values (`width` per node) from the window `old` to the active domain of `new` along the axes that are
/// not partitioned. Returns the new window and its values. Nodes outside the old active domain are zero.
pub fn across<const D: usize>(old: &Grid<D>, new: &Grid<D>, values: &[f64], width: usize) -> (Grid<D>, Vec<f64>) {
    let mut room = new.room().clone();
    let mut window = new.room().clone();
    for axis in 0..if old.is_parted() { 2 } else { 1 } {
        (room[axis], window[axis]) = (old.room()[axis].clone(), old.cells_along()[axis].clone());
    }
    let new = new.within(room).window_of(window);
    let mut moved = vec![0.0; new.nodes() * width];
    for (node, moved) in moved.chunks_exact_mut(width).enumerate() {
        if let Some(held) = old.node_index(&new.node_at(node)) {
            moved.copy_from_slice(&values[held * width..(held + 1) * width]);
        }
    }
    (new, moved)
}

/// Partition of the grid, and this rank's window in it.
#[derive(Clone, Copy)]
pub struct GridPartition<'a, const D: usize> {
    /// The partition.
    pub slabs: &'a Slabs,
    /// This rank's window of the grid.
    pub window: &'a Grid<D>,
}

/// Moves nodal values (`width` per node) from the partition `old` to `new`, and returns those of this rank's new
/// window. Nodes without an old value are zero. Collective.
pub fn nodal<const D: usize>(
    world: &SimpleCommunicator,
    traffic: &Traffic,
    old: GridPartition<'_, D>,
    new: GridPartition<'_, D>,
    values: &[f64],
    width: usize,
) -> Vec<f64> {
    let rank = world.rank().unsigned_abs() as usize;
    let from = old.window;
    let to = new.window;
    let mut moved = vec![0.0; to.nodes() * width];
    let NodePlan { send, receive } = NodePlan::new(old.slabs, new.slabs, rank, to.order(), &to.room()[1]);
    let mut outgoing = Vec::new();
    for (other, nodes) in send {
        let part = numbers(from, &nodes, width);
        if other == rank {
            numbers(to, &nodes, width)
                .zip(part)
                .for_each(|(slot, at)| moved[slot] = values[at]);
        } else {
            outgoing.push((other, part.flat_map(|at| values[at].to_le_bytes()).collect()));
        }
    }
    let receive = receive.into_iter().filter(|(other, _)| *other != rank);
    for ((_, message), (_, nodes)) in exchange(world, traffic, &outgoing, MESSAGE).iter().zip(receive) {
        for (slot, bytes) in numbers(to, &nodes, width).zip(message.chunks_exact(8)) {
            moved[slot] = f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        }
    }
    moved
}

/// Iterates over the positions of the values of `nodes` in a nodal array (`width` per node) of the window `grid`.
fn numbers<const D: usize>(grid: &Grid<D>, nodes: &NodeBox, width: usize) -> impl Iterator<Item = usize> {
    let runs = grid.nodes_within(nodes).into_iter();
    runs.flat_map(move |run| run.start * width..run.end * width)
}

/// Sends messages to other ranks and returns those received; both are ascending by rank and have no empty messages.
/// Messages longer than `block` bytes are divided. Collective.
pub fn exchange(
    world: &SimpleCommunicator,
    traffic: &Traffic,
    outgoing: &[(usize, Vec<u8>)],
    block: usize,
) -> Vec<(usize, Vec<u8>)> {
    let mut sizes = vec![0_u64; world.size().unsigned_abs() as usize];
    let mut expected = sizes.clone();
    outgoing
        .iter()
        .for_each(|(other, message)| sizes[*other] = message.len() as u64);
    world.all_to_all_into(&sizes[..], &mut expected[..]);
    let expected = expected.into_iter().enumerate().filter(|(_, size)| *size > 0);
    let mut incoming: Vec<(usize, Vec<u8>)> = expected
        .map(|(other, size)| (other, vec![0; usize::try_from(size).unwrap_or(usize::MAX)]))
        .collect();
    let messages = outgoing.iter().map(|(_, message)| message.len().div_ceil(block)).sum();
    traffic.count(
        TrafficKind::Migration,
        messages,
        outgoing.iter().map(|(_, message)| message.len()).sum(),
    );
    // MPI delivers messages between two ranks in the order of sending.
    mpi::request::scope(|scope| {
        let mut receives = Vec::new();
        for (other, message) in &mut incoming {
            let other = world.process_at_rank(*other as i32);
            receives.extend(
                message
                    .chunks_mut(block)
                    .map(|part| other.immediate_receive_into(scope, part)),
            );
        }
        let mut sends = Vec::with_capacity(messages);
        for (other, message) in outgoing {
            let other = world.process_at_rank(*other as i32);
            sends.extend(message.chunks(block).map(|part| other.immediate_send(scope, part)));
        }
        receives.into_iter().for_each(|request| {
            let _ = request.wait();
        });
        sends.into_iter().for_each(|request| {
            let _ = request.wait();
        });
    });
    incoming
}

#[cfg(test)]
mod tests {
    use super::*;
    use bsmpm::grid::KnotVector;

    #[test]
    fn nodal_values_keep_their_places_in_a_wider_and_a_narrower_room() {
        let axis = |cells| KnotVector::uniform(1.0, cells, 2).unwrap();
        let whole = Grid::new([axis(12), axis(9), axis(7)]).unwrap();
        let seen = whole.within([2..9, 3..7, 0..5]);
        let value = |grid: &Grid<3>, node: usize| 1.0 + grid.number_of(node) as f64;
        for (old, cut) in [(seen.window(4..6), 1), (seen.window_of([4..6, 4..5, 0..5]), 2)] {
            let values: Vec<f64> = (0..old.nodes())
                .flat_map(|node| [value(&old, node), -value(&old, node)])
                .collect();
            for room in [[0..12, 0..9, 0..7], [3..8, 4..6, 2..3], [1..11, 2..6, 1..6]] {
                let new = whole.within(room);
                let (same, moved) = across(&old, &new, &values, 2);
                assert_eq!(same.cells_along()[..cut], old.cells_along()[..cut]);
                assert_eq!(same.cells_along()[cut..], new.room()[cut..]);
                assert_eq!(moved.len(), 2 * same.nodes());
                for (node, pair) in moved.chunks_exact(2).enumerate() {
                    let held = old.node_index(&same.node_at(node)).is_some();
                    let expected = if held { value(&same, node) } else { 0.0 };
                    assert_eq!(pair, [expected, -expected], "{:?}", same.node_at(node));
                }
            }
        }
    }
}
