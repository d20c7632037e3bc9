//! Points and nodal values that change their rank: after every step, and when the slabs are cut anew.

use crate::slab::{Slabs, intersection};
use bsmpm::grid::Grid;
use bsmpm::points::Points;
use mpi::collective::CommunicatorCollectives;
use mpi::datatype::{Partition, PartitionMut};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::ops::Range;

/// Sends every point to the rank whose slab it is in, and sorts by cell. `grid` is the window under `slabs`.
pub fn points<const D: usize>(world: &SimpleCommunicator, slabs: &Slabs, grid: &Grid<D>, points: &mut Points<D>) {
    let rank = world.rank().unsigned_abs() as usize;
    let owner = |p: usize| grid.locate(&points.x[p]).map_or(rank, |cell| slabs.owner(cell[0]));
    let owners: Vec<usize> = (0..points.len()).map(owner).collect();
    let mut outgoing = vec![Vec::new(); slabs.ranks()];
    let (mut stay, mut leave) = (Vec::new(), Vec::new());
    for (p, &owner) in owners.iter().enumerate() {
        if owner == rank { stay.push(p as u32) } else { leave.push((p, owner)) }
    }
    for column in points.columns() {
        for &(p, owner) in &leave {
            column.put(p, &mut outgoing[owner]);
        }
        if !leave.is_empty() {
            column.reorder(&stay);
        }
    }
    // Messages are column by column: every column then takes its rows from the message in one run.
    let point_bytes = points.bytes();
    for message in exchange(world, &outgoing) {
        let arrivals = message.len() / point_bytes;
        let mut rest = &message[..];
        for column in points.columns() {
            (0..arrivals).for_each(|_| column.take(&mut rest));
        }
    }
    points.sort_by_cell(grid);
}

/// Nodal values (`width` a node) under the old cut, moved to the windows of the new one.
pub fn nodal<const D: usize>(
    world: &SimpleCommunicator,
    (old, new): (&Slabs, &Slabs),
    grid: &Grid<D>,
    values: &[f64],
    width: usize,
) -> Vec<f64> {
    let rank = world.rank().unsigned_abs() as usize;
    let (q, size) = (grid.order(), grid.layer_nodes() * width);
    let from = old.layers(rank, q).start;
    let part = |to: usize| intersection(&old.owned_layers(rank, q), &new.layers(to, q));
    let cut = |layers: Range<usize>| &values[(layers.start - from) * size..(layers.end - from) * size];
    let bytes = |part: &[f64]| part.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let outgoing: Vec<Vec<u8>> = (0..new.ranks())
        .map(|to| match part(to) {
            layers if layers.is_empty() => Vec::new(),
            layers => bytes(cut(layers)),
        })
        .collect();
    let window = new.layers(rank, q);
    let mut moved = vec![0.0; window.len() * size];
    // Layers of a rank that sends nothing may begin beyond the window.
    for (other, message) in exchange(world, &outgoing).into_iter().enumerate().filter(|(_, m)| !m.is_empty()) {
        let layers = intersection(&old.owned_layers(other, q), &window);
        let to = layers.start.saturating_sub(window.start) * size;
        for (slot, bytes) in moved[to..].iter_mut().zip(message.chunks_exact(8)) {
            *slot = f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        }
    }
    moved
}

/// Sends message `r` to rank `r` and returns those received, by rank.
fn exchange(world: &SimpleCommunicator, outgoing: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let sizes: Vec<i32> =
        outgoing.iter().map(|message| i32::try_from(message.len()).expect("one message stays below 2 GiB")).collect();
    let mut incoming = vec![0_i32; sizes.len()];
    world.all_to_all_into(&sizes[..], &mut incoming[..]);
    // One byte more than is sent: the address of an empty Vec<u8> is 1, which Open MPI reads as MPI_IN_PLACE.
    let flat: Vec<u8> = outgoing.iter().flatten().copied().chain([0]).collect();
    let mut received = vec![0_u8; 1 + incoming.iter().map(|&size| size as usize).sum::<usize>()];
    let starts = |sizes: &[i32]| -> Vec<i32> {
        sizes.iter().scan(0, |at, size| Some(std::mem::replace(at, *at + size))).collect()
    };
    {
        let send = Partition::new(&flat[..], &sizes[..], starts(&sizes));
        let mut receive = PartitionMut::new(&mut received[..], &incoming[..], starts(&incoming));
        world.all_to_all_varcount_into(&send, &mut receive);
    }
    let mut rest = &received[..];
    incoming
        .iter()
        .map(|&size| {
            let (message, tail) = rest.split_at(size as usize);
            rest = tail;
            message.to_vec()
        })
        .collect()
}
