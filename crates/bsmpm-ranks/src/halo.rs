//! The exchange of nodal contributions: one message to and from every rank that shares node layers.
//!
//! Ranks exchange what single columns of cells contribute to the layers that they share, and add it in the order of the
//! columns, so that sums have the same bits on any number of ranks: q (q+1)/2 layers a neighbour in place of q.

use crate::signals::{Requests, WIDTH};
use crate::slab::{SharedLayer, Slabs, intersection};
use crate::timers::Timers;
use crate::traffic::TrafficKind;
use bsmpm::exact::{Exact, WORDS};
use bsmpm::grid::{Contributions, Grid};
use bsmpm::parallel::Halo;
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::point_to_point::{Destination, Source};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::ops::Range;
use std::rc::Rc;

/// What this rank shares with others under one cut of the grid.
pub struct MpiHalo {
    world: SimpleCommunicator,
    rank: usize,
    owned: Range<usize>,
    layer_nodes: usize,
    neighbours: Vec<Neighbour>, // ascending by rank
    timers: Rc<Timers>,
    requests: Rc<Requests>,
}

/// A rank that shares layers of nodes with this one.
struct Neighbour {
    rank: usize,
    nodes: Range<usize>, // the shared ones, of the window
    owned: Range<usize>, // those of them that it owns
    layers: Vec<SharedLayer>,
}

/// Messages of numbers from rank to rank, which arrive in the order in which they were sent.
pub trait Link {
    /// Sends to a rank.
    fn send(&self, to: usize, numbers: &[f64]);
    /// What a rank has sent.
    fn receive(&self, from: usize) -> Vec<f64>;
}

/// The ranks of a halo, whose messages are counted.
pub struct Ranks<'a> {
    halo: &'a MpiHalo,
}

impl Link for Ranks<'_> {
    fn send(&self, to: usize, numbers: &[f64]) {
        self.halo.timers.traffic().count(TrafficKind::Factor, 1, size_of_val(numbers));
        self.halo.world.process_at_rank(to as i32).send(numbers);
    }

    fn receive(&self, from: usize) -> Vec<f64> {
        self.halo.world.process_at_rank(from as i32).receive_vec().0
    }
}

impl MpiHalo {
    /// The halo of this rank's window of `grid` under the cut `slabs`; every sum carries the `requests` with it.
    pub fn new<const D: usize>(
        world: SimpleCommunicator,
        slabs: &Slabs,
        grid: &Grid<D>,
        (timers, requests): (Rc<Timers>, Rc<Requests>),
    ) -> Self {
        let rank = world.rank().unsigned_abs() as usize;
        let (q, size, first) = (grid.order(), grid.layer_nodes(), grid.layers().start);
        let nodes = |layers: Range<usize>| (layers.start - first) * size..(layers.end - first) * size;
        let neighbour = |(other, layers): (usize, Range<usize>)| Neighbour {
            rank: other,
            nodes: nodes(layers.clone()),
            owned: nodes(intersection(&layers, &slabs.owned_layers(other, q))),
            layers: slabs.shared_layers((rank, other), q),
        };
        let owned = nodes(slabs.owned_layers(rank, q));
        let neighbours = slabs.shared(rank, q).into_iter().map(neighbour).collect();
        Self { world, rank, owned, layer_nodes: size, neighbours, timers, requests }
    }

    /// The ranks.
    pub fn world(&self) -> &SimpleCommunicator {
        &self.world
    }

    /// The ranks, to be sent numbers one by one.
    pub fn link(&self) -> Ranks<'_> {
        Ranks { halo: self }
    }

    /// What is asked of the run from outside.
    pub fn requests(&self) -> &Rc<Requests> {
        &self.requests
    }

    /// Adds what the other ranks have at the nodes that they share with this one.
    pub fn add_shared(&self, nodal: &mut [f64], width: usize) {
        self.combine(TrafficKind::HaloSum, nodal, width, |own, other| own + other);
    }

    /// Combines the numbers of every shared node with those of the ranks that share it.
    fn combine(&self, kind: TrafficKind, nodal: &mut [f64], width: usize, both: impl Fn(f64, f64) -> f64) {
        if self.neighbours.is_empty() {
            return;
        }
        let _timed = self.timers.time("halo");
        let place = |other: &Neighbour| other.nodes.start * width..other.nodes.end * width;
        let outgoing: Vec<_> = self.neighbours.iter().map(|other| nodal[place(other)].to_vec()).collect();
        let incoming = self.exchange(kind, &outgoing, |other| other.nodes.len() * width);
        for (part, other) in incoming.iter().zip(&self.neighbours) {
            nodal[place(other)].iter_mut().zip(part).for_each(|(own, other)| *own = both(*own, *other));
        }
    }

    /// Gives every neighbour its message and returns theirs, of the given lengths, in the order of the neighbours.
    fn exchange(
        &self,
        kind: TrafficKind,
        outgoing: &[Vec<f64>],
        lengths: impl Fn(&Neighbour) -> usize,
    ) -> Vec<Vec<f64>> {
        let bytes = outgoing.iter().map(|part| size_of_val(&part[..])).sum();
        self.timers.traffic().count(kind, outgoing.len(), bytes);
        let mut incoming: Vec<Vec<f64>> = self.neighbours.iter().map(|other| vec![0.0; lengths(other)]).collect();
        mpi::request::scope(|scope| {
            let receives: Vec<_> = self
                .neighbours
                .iter()
                .zip(&mut incoming)
                .map(|(other, part)| {
                    self.world.process_at_rank(other.rank as i32).immediate_receive_into(scope, &mut part[..])
                })
                .collect();
            let sends: Vec<_> = self
                .neighbours
                .iter()
                .zip(outgoing)
                .map(|(other, part)| self.world.process_at_rank(other.rank as i32).immediate_send(scope, &part[..]))
                .collect();
            receives.into_iter().for_each(|request| {
                let _ = request.wait();
            });
            sends.into_iter().for_each(|request| {
                let _ = request.wait();
            });
        });
        incoming
    }
}

/// What the columns of this rank contribute to the layers shared with another one: layer after layer, column after
/// column.
fn pieces(contributions: &Contributions, layers: &[SharedLayer], layer: usize) -> Vec<f64> {
    let mut message = Vec::new();
    for shared in layers {
        for column in shared.own.clone() {
            match contributions.of(column, shared.layer) {
                Some(sums) => message.extend_from_slice(sums),
                None => message.resize(message.len() + layer, 0.0),
            }
        }
    }
    message
}

/// Adds such pieces of another rank to the nodal array.
fn add_pieces(message: &[f64], layers: &[SharedLayer], layer: usize, nodal: &mut [f64]) {
    let mut pieces = message.chunks_exact(layer);
    for shared in layers {
        let nodes = &mut nodal[shared.layer * layer..(shared.layer + 1) * layer];
        for piece in pieces.by_ref().take(shared.theirs) {
            nodes.iter_mut().zip(piece).for_each(|(total, sum)| *total += sum);
        }
    }
}

impl Halo for MpiHalo {
    fn owned(&self) -> Range<usize> {
        self.owned.clone()
    }

    fn layer_nodes(&self) -> usize {
        self.layer_nodes
    }

    fn sum(&self, contributions: &Contributions) -> Vec<f64> {
        if self.neighbours.is_empty() {
            return contributions.alone();
        }
        let _timed = self.timers.time("halo");
        let layer = self.layer_nodes * contributions.width();
        let outgoing: Vec<_> =
            self.neighbours.iter().map(|other| pieces(contributions, &other.layers, layer)).collect();
        let incoming = self.exchange(TrafficKind::HaloSum, &outgoing, |other| {
            other.layers.iter().map(|shared| shared.theirs).sum::<usize>() * layer
        });
        // The columns of lower ranks lie before this rank's: every layer adds its columns in their order.
        let mut nodal = contributions.nodal();
        let lower = self.neighbours.partition_point(|other| other.rank < self.rank);
        let (before, after) = incoming.split_at(lower);
        for (part, other) in before.iter().zip(&self.neighbours) {
            add_pieces(part, &other.layers, layer, &mut nodal);
        }
        contributions.add_to(&mut nodal);
        for (part, other) in after.iter().zip(&self.neighbours[lower..]) {
            add_pieces(part, &other.layers, layer, &mut nodal);
        }
        nodal
    }

    fn share(&self, nodal: &mut [f64], width: usize) {
        if self.neighbours.is_empty() {
            return;
        }
        let _timed = self.timers.time("halo");
        let mine = |other: &Neighbour| intersection(&other.nodes, &self.owned);
        let outgoing: Vec<_> = self
            .neighbours
            .iter()
            .map(|other| nodal[mine(other).start * width..mine(other).end * width].to_vec())
            .collect();
        let incoming = self.exchange(TrafficKind::HaloShare, &outgoing, |other| other.owned.len() * width);
        for (part, other) in incoming.iter().zip(&self.neighbours) {
            nodal[other.owned.start * width..other.owned.end * width].copy_from_slice(part);
        }
    }

    fn max(&self, nodal: &mut [f64], width: usize) {
        self.combine(TrafficKind::HaloMax, nodal, width, f64::max);
    }

    fn reduce(&self, numbers: &mut [f64]) {
        let _timed = self.timers.time("reduction");
        let own = [&*numbers, &self.requests.share()].concat();
        self.timers.traffic().count(TrafficKind::Reduction, 0, size_of_val(&own[..]));
        let mut sums = vec![0.0; own.len()];
        self.world.all_reduce_into(&own[..], &mut sums[..], SystemOperation::sum());
        numbers.copy_from_slice(&sums[..numbers.len()]);
        let mut requested = [0.0; WIDTH];
        requested.copy_from_slice(&sums[numbers.len()..]);
        self.requests.agree(requested);
    }

    fn total(&self, sums: &[Exact]) -> Vec<f64> {
        let _timed = self.timers.time("reduction");
        let mut own: Vec<i64> = sums.iter().flat_map(|sum| sum.words()).copied().collect();
        own.extend(self.requests.share().map(|count| count as i64));
        self.timers.traffic().count(TrafficKind::Reduction, 0, size_of_val(&own[..]));
        let mut all = vec![0; own.len()];
        self.world.all_reduce_into(&own[..], &mut all[..], SystemOperation::sum());
        let (words, requested) = all.split_at(sums.len() * WORDS);
        self.requests.agree(std::array::from_fn(|k| requested[k] as f64));
        words.chunks_exact(WORDS).map(|words| Exact::of_words(words).value()).collect()
    }

    fn maximum(&self, numbers: &mut [f64]) {
        let _timed = self.timers.time("reduction");
        let own = numbers.to_vec();
        self.timers.traffic().count(TrafficKind::Reduction, 0, size_of_val(&own[..]));
        self.world.all_reduce_into(&own[..], numbers, SystemOperation::max());
    }

    fn is_interrupted(&self) -> bool {
        self.requests.stop()
    }

    fn rejects(&self) -> bool {
        self.requests.take_rejection()
    }
}
