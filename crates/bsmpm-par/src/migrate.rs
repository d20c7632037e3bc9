//! Points and nodal values that change their rank: after every step, and when the slabs are cut anew.

use crate::slab::{Slabs, intersection};
use bsmpm::grid::Grid;
use bsmpm::points::Points;
use mpi::collective::CommunicatorCollectives;
use mpi::point_to_point::{Destination, Source};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::ops::Range;

/// bytes  Most that one message has: MPI counts in 32 bits.
const BLOCK: usize = 1 << 30;

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
    for message in exchange(world, outgoing, BLOCK) {
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
    for (other, message) in exchange(world, outgoing, BLOCK).into_iter().enumerate().filter(|(_, m)| !m.is_empty()) {
        let layers = intersection(&old.owned_layers(other, q), &window);
        let to = layers.start.saturating_sub(window.start) * size;
        for (slot, bytes) in moved[to..].iter_mut().zip(message.chunks_exact(8)) {
            *slot = f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        }
    }
    moved
}

/// Sends message `r` to rank `r` and returns those received, by rank. Longer messages than a `block` go in several.
/// Collective.
pub fn exchange(world: &SimpleCommunicator, mut outgoing: Vec<Vec<u8>>, block: usize) -> Vec<Vec<u8>> {
    let own = std::mem::take(&mut outgoing[world.rank().unsigned_abs() as usize]);
    let sizes: Vec<u64> = outgoing.iter().map(|message| message.len() as u64).collect();
    let mut coming = vec![0_u64; sizes.len()];
    world.all_to_all_into(&sizes[..], &mut coming[..]);
    let mut incoming: Vec<Vec<u8>> = coming.iter().map(|&size| vec![0; size as usize]).collect();
    mpi::request::scope(|scope| {
        let mut receives = Vec::new();
        for (other, message) in incoming.iter_mut().enumerate() {
            let other = world.process_at_rank(other as i32);
            receives.extend(message.chunks_mut(block).map(|part| other.immediate_receive_into(scope, part)));
        }
        let mut sends = Vec::new();
        for (other, message) in outgoing.iter().enumerate() {
            let other = world.process_at_rank(other as i32);
            sends.extend(message.chunks(block).map(|part| other.immediate_send(scope, part)));
        }
        receives.into_iter().for_each(|request| {
            let _ = request.wait();
        });
        sends.into_iter().for_each(|request| {
            let _ = request.wait();
        });
    });
    incoming[world.rank().unsigned_abs() as usize] = own;
    incoming
}
