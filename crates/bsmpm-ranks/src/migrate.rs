//! Points and nodal values that change their rank: after every step, and when the slabs are cut anew.
//! [`plan`](crate::plan) says who gets what.

use crate::plan::{LayerPlan, PointPlan};
use crate::slab::Slabs;
use crate::traffic::{Traffic, TrafficKind};
use bsmpm::grid::Grid;
use bsmpm::points::Points;
use mpi::collective::CommunicatorCollectives;
use mpi::point_to_point::{Destination, Source};
use mpi::topology::{Communicator, SimpleCommunicator};

/// Bytes of one message; more go in several, as MPI counts with 31 bits.
const MESSAGE: usize = 1 << 20;

/// Sends every point to the rank whose slab it is in, and sorts by cell. `grid` is the window under `slabs`.
pub fn points<const D: usize>(
    (world, traffic): (&SimpleCommunicator, &Traffic),
    slabs: &Slabs,
    grid: &Grid<D>,
    points: &mut Points<D>,
) {
    let rank = world.rank().unsigned_abs() as usize;
    let owners = points.x.iter().map(|x| grid.locate(x).map_or(rank, |cell| slabs.owner(cell[0])));
    let PointPlan { stay, leave } = PointPlan::new(owners, rank);
    // Messages are column by column: every column then takes its rows from the message in one run.
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
    for (_, message) in exchange((world, traffic), &outgoing, MESSAGE) {
        let arrivals = message.len() / point_bytes;
        let mut rest = &message[..];
        for column in points.columns() {
            (0..arrivals).for_each(|_| column.take(&mut rest));
        }
    }
    points.sort_by_cell(grid);
}

/// Nodal values (`width` a node) of a window of `old`, as a window of `new` with the same columns' layers has them:
/// what lies outside the old room is zero.
pub fn across<const D: usize>(old: &Grid<D>, new: &Grid<D>, values: &[f64], width: usize) -> Vec<f64> {
    let mut room = new.room().clone();
    room[0] = old.room()[0].clone();
    let new = new.within(room).window(old.columns());
    let value = |node: usize| {
        let held = old.node_index(&new.node_at(node));
        (0..width).map(move |number| held.map_or(0.0, |node| values[node * width + number]))
    };
    (0..new.nodes()).flat_map(value).collect()
}

/// Nodal values (`width` a node) under the old cut, moved to the windows of the new one; zero where there was none.
pub fn nodal<const D: usize>(
    (world, traffic): (&SimpleCommunicator, &Traffic),
    (old, new): (&Slabs, &Slabs),
    grid: &Grid<D>,
    values: &[f64],
    width: usize,
) -> Vec<f64> {
    let rank = world.rank().unsigned_abs() as usize;
    let (q, size) = (grid.order(), grid.layer_nodes() * width);
    let (from, window) = (old.layers(rank, q).start, new.layers(rank, q));
    let mut moved = vec![0.0; window.len() * size];
    let LayerPlan { send, receive } = LayerPlan::new((old, new), rank, q);
    let mut outgoing = Vec::new();
    for (other, layers) in send {
        let part = &values[(layers.start - from) * size..(layers.end - from) * size];
        if other == rank {
            moved[(layers.start - window.start) * size..][..part.len()].copy_from_slice(part);
        } else {
            outgoing.push((other, part.iter().flat_map(|value| value.to_le_bytes()).collect()));
        }
    }
    let receive = receive.into_iter().filter(|(other, _)| *other != rank);
    for ((_, message), (_, layers)) in exchange((world, traffic), &outgoing, MESSAGE).iter().zip(receive) {
        let slots = &mut moved[(layers.start - window.start) * size..];
        for (slot, bytes) in slots.iter_mut().zip(message.chunks_exact(8)) {
            *slot = f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        }
    }
    moved
}

/// Sends every rank its message, and returns those received; both ascending by rank and without empty ones. Longer
/// messages than a `block` of bytes go in several. Collective.
pub fn exchange(
    (world, traffic): (&SimpleCommunicator, &Traffic),
    outgoing: &[(usize, Vec<u8>)],
    block: usize,
) -> Vec<(usize, Vec<u8>)> {
    let mut sizes = vec![0_u64; world.size().unsigned_abs() as usize];
    let mut expected = sizes.clone();
    outgoing.iter().for_each(|(other, message)| sizes[*other] = message.len() as u64);
    world.all_to_all_into(&sizes[..], &mut expected[..]);
    let expected = expected.into_iter().enumerate().filter(|(_, size)| *size > 0);
    let mut incoming: Vec<(usize, Vec<u8>)> =
        expected.map(|(other, size)| (other, vec![0; usize::try_from(size).unwrap_or(usize::MAX)])).collect();
    let messages = outgoing.iter().map(|(_, message)| message.len().div_ceil(block)).sum();
    traffic.count(TrafficKind::Migration, messages, outgoing.iter().map(|(_, message)| message.len()).sum());
    // Messages between two ranks do not overtake each other.
    mpi::request::scope(|scope| {
        let mut receives = Vec::new();
        for (other, message) in &mut incoming {
            let other = world.process_at_rank(*other as i32);
            receives.extend(message.chunks_mut(block).map(|part| other.immediate_receive_into(scope, part)));
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
        let old = whole.within([2..9, 3..7, 0..5]).window(4..6);
        let value = |grid: &Grid<3>, node: usize| 1.0 + grid.number_of(node) as f64;
        let values: Vec<f64> = (0..old.nodes()).flat_map(|node| [value(&old, node), -value(&old, node)]).collect();
        for room in [[0..12, 0..9, 0..7], [3..8, 4..6, 2..3], [1..11, 2..6, 1..6]] {
            let new = whole.within(room);
            let moved = across(&old, &new, &values, 2);
            let layers = new.within([2..9, new.room()[1].clone(), new.room()[2].clone()]).window(4..6);
            assert_eq!(moved.len(), 2 * layers.nodes());
            for (node, pair) in moved.chunks_exact(2).enumerate() {
                let held = old.node_index(&layers.node_at(node)).is_some();
                let expected = if held { value(&layers, node) } else { 0.0 };
                assert_eq!(pair, [expected, -expected], "{:?}", layers.node_at(node));
            }
        }
    }
}
