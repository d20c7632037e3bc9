//! Adds the contributions of all ranks to nodes that they share: first within columns of cells, then in the order of
//! the columns.

use crate::signals::{Requests, WIDTH};
use crate::slab::{SharedLayer, Slabs, common};
use crate::timers::Timers;
use crate::traffic::TrafficKind;
use bsmpm::exact::{Exact, WORDS};
use bsmpm::grid::{Contributions, Grid};
use bsmpm::parallel::{Halo, OwnedNodes};
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::datatype::PartitionMut;
use mpi::point_to_point::{Destination, Source};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::ops::Range;
use std::rc::Rc;

/// Nodes that this rank shares with others in one partition, and the exchange of their values.
pub struct MpiHalo {
    world: SimpleCommunicator,
    rank: usize,
    slabs: Slabs,
    owned: OwnedNodes,
    layer_nodes: usize,
    neighbours: Vec<Neighbour>, // ascending by rank
    timers: Rc<Timers>,
    requests: Rc<Requests>,
}

/// Rank that shares nodes with this one.
struct Neighbour {
    rank: usize,
    nodes: NodeRuns,  // shared nodes of the window
    mine: NodeRuns,   // those of them that this rank owns
    theirs: NodeRuns, // those that the other rank owns
    layers: Vec<SharedLayer>,
    run: Range<usize>, // shared nodes within a layer
}

/// Ranges of nodes of the window, in the order of a message.
struct NodeRuns(Vec<Range<usize>>);

impl NodeRuns {
    fn count(&self) -> usize {
        self.0.iter().map(Range::len).sum()
    }

    /// Returns the values of these nodes from an array with `width` numbers per node.
    fn packed(&self, nodal: &[f64], width: usize) -> Vec<f64> {
        let mut message = Vec::with_capacity(self.count() * width);
        self.0
            .iter()
            .for_each(|run| message.extend_from_slice(&nodal[run.start * width..run.end * width]));
        message
    }

    /// Replaces each value of these nodes by `both` of it and the value in the message.
    fn unpack(&self, message: &[f64], nodal: &mut [f64], width: usize, both: impl Fn(f64, f64) -> f64) {
        let mut message = message.iter();
        for run in &self.0 {
            let own = &mut nodal[run.start * width..run.end * width];
            own.iter_mut()
                .zip(&mut message)
                .for_each(|(own, other)| *own = both(*own, *other));
        }
    }
}

/// Messages of numbers between two ranks, which arrive in the order of sending.
pub trait Link {
    /// Sends numbers to a rank.
    fn send(&self, to: usize, numbers: &[f64]);
    /// Returns the next message from a rank.
    fn receive(&self, from: usize) -> Vec<f64>;
}

/// Link between the ranks of a halo, which counts the messages.
pub struct Ranks<'a> {
    halo: &'a MpiHalo,
}

impl Link for Ranks<'_> {
    fn send(&self, to: usize, numbers: &[f64]) {
        self.halo
            .timers
            .traffic()
            .count(TrafficKind::Factor, 1, size_of_val(numbers));
        self.halo.world.process_at_rank(to as i32).send(numbers);
    }

    fn receive(&self, from: usize) -> Vec<f64> {
        self.halo.world.process_at_rank(from as i32).receive_vec().0
    }
}

impl MpiHalo {
    /// Creates the halo of this rank's window of `grid` for the partition `slabs`. Every sum also carries the
    /// `requests`.
    pub fn new<const D: usize>(
        world: SimpleCommunicator,
        slabs: &Slabs,
        grid: &Grid<D>,
        timers: Rc<Timers>,
        requests: Rc<Requests>,
    ) -> Self {
        let rank = world.rank().unsigned_abs() as usize;
        let q = grid.order();
        let layer = grid.layer_nodes();
        let rows = &grid.room()[1];
        let start = grid.cells_along()[1].start;
        let row = layer / grid.nodes_along(1);
        let own = slabs.owned(rank, q, rows);
        let mut neighbours = Vec::new();
        for (other, nodes) in slabs.shared(rank, q, rows) {
            let mine = common(&nodes, &own);
            let theirs = common(&nodes, &slabs.owned(other, q, rows));
            let [shared, mine, theirs] = [&nodes, &mine, &theirs].map(|nodes| NodeRuns(grid.nodes_within(nodes)));
            neighbours.push(Neighbour {
                rank: other,
                nodes: shared,
                mine,
                theirs,
                layers: slabs.shared_layers(rank, other, q),
                run: (nodes[1].start - start) * row..(nodes[1].end - start) * row,
            });
        }
        let owned = OwnedNodes::new(own[0].len(), layer, own[1].len() * row);
        Self {
            world,
            rank,
            slabs: slabs.clone(),
            owned,
            layer_nodes: layer,
            neighbours,
            timers,
            requests,
        }
    }

    /// Returns the partition of the grid.
    pub fn slabs(&self) -> &Slabs {
        &self.slabs
    }

    /// Returns the communicator of all ranks.
    pub fn world(&self) -> &SimpleCommunicator {
        &self.world
    }

    /// Returns the link for messages between two ranks.
    pub fn link(&self) -> Ranks<'_> {
        Ranks { halo: self }
    }

    /// Returns the requests to the run from outside.
    pub fn requests(&self) -> &Rc<Requests> {
        &self.requests
    }

    /// Adds the values of the other ranks at shared nodes. One exchange with the neighbours.
    pub fn add_shared(&self, nodal: &mut [f64], width: usize) {
        self.combine(TrafficKind::HaloSum, nodal, width, |own, other| own + other);
    }

    /// Combines the values at every shared node with those of the ranks that share it. One exchange with the
    /// neighbours.
    fn combine(&self, kind: TrafficKind, nodal: &mut [f64], width: usize, both: impl Fn(f64, f64) -> f64) {
        if self.neighbours.is_empty() {
            return;
        }
        let _timed = self.timers.time("halo");
        let outgoing: Vec<_> = self
            .neighbours
            .iter()
            .map(|other| other.nodes.packed(nodal, width))
            .collect();
        let incoming = self.exchange(kind, &outgoing, |other| other.nodes.count() * width);
        for (part, other) in incoming.iter().zip(&self.neighbours) {
            other.nodes.unpack(part, nodal, width, &both);
        }
    }

    /// Sends every neighbour its message and returns theirs, in the order of the neighbours. `lengths` gives the
    /// lengths of the messages to receive.
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
                    self.world
                        .process_at_rank(other.rank as i32)
                        .immediate_receive_into(scope, &mut part[..])
                })
                .collect();
            let sends: Vec<_> = self
                .neighbours
                .iter()
                .zip(outgoing)
                .map(|(other, part)| {
                    self.world
                        .process_at_rank(other.rank as i32)
                        .immediate_send(scope, &part[..])
                })
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

impl Neighbour {
    /// Returns the range of the shared nodes' values within a layer.
    fn run(&self, width: usize) -> Range<usize> {
        self.run.start * width..self.run.end * width
    }

    /// Returns the contributions of this rank's columns to the shared nodes, layer by layer and column by column.
    fn pieces(&self, contributions: &Contributions) -> Vec<f64> {
        let run = self.run(contributions.width());
        let mut message = Vec::new();
        for shared in &self.layers {
            for column in shared.own.clone() {
                match contributions.of(column, shared.layer) {
                    Some(sums) => message.extend_from_slice(&sums[run.clone()]),
                    None => message.resize(message.len() + run.len(), 0.0),
                }
            }
        }
        message
    }

    /// Returns the count of numbers in such a message from the other rank.
    fn pieces_of_other(&self, width: usize) -> usize {
        self.layers.iter().map(|shared| shared.theirs).sum::<usize>() * self.run(width).len()
    }

    /// Adds a message of the other rank to the nodal array, whose layers have `layer` nodes.
    fn add_pieces(&self, message: &[f64], layer: usize, width: usize, nodal: &mut [f64]) {
        let run = self.run(width);
        let mut pieces = message.chunks_exact(run.len());
        for shared in &self.layers {
            let nodes = &mut nodal[shared.layer * layer * width..][run.clone()];
            for piece in pieces.by_ref().take(shared.theirs) {
                nodes.iter_mut().zip(piece).for_each(|(total, sum)| *total += sum);
            }
        }
    }
}

impl Halo for MpiHalo {
    fn owned(&self) -> OwnedNodes {
        self.owned
    }

    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64> {
        if self.neighbours.is_empty() {
            return contributions.alone();
        }
        let _timed = self.timers.time("halo");
        let layer = self.layer_nodes;
        let width = contributions.width();
        let outgoing: Vec<_> = self
            .neighbours
            .iter()
            .map(|other| other.pieces(contributions))
            .collect();
        let incoming = self.exchange(TrafficKind::HaloSum, &outgoing, |other| other.pieces_of_other(width));
        // Every layer adds the columns in their order: those of lower ranks are before this rank's.
        let mut nodal = contributions.nodal();
        let lower = self.neighbours.partition_point(|other| other.rank < self.rank);
        let (before, after) = incoming.split_at(lower);
        for (part, other) in before.iter().zip(&self.neighbours) {
            other.add_pieces(part, layer, width, &mut nodal);
        }
        contributions.add_to(&mut nodal);
        for (part, other) in after.iter().zip(&self.neighbours[lower..]) {
            other.add_pieces(part, layer, width, &mut nodal);
        }
        nodal
    }

    fn update_ghosts(&self, nodal: &mut [f64], width: usize) {
        if self.neighbours.is_empty() {
            return;
        }
        let _timed = self.timers.time("halo");
        let outgoing: Vec<_> = self
            .neighbours
            .iter()
            .map(|other| other.mine.packed(nodal, width))
            .collect();
        let incoming = self.exchange(TrafficKind::HaloShare, &outgoing, |other| other.theirs.count() * width);
        for (part, other) in incoming.iter().zip(&self.neighbours) {
            other.theirs.unpack(part, nodal, width, |_, received| received);
        }
    }

    fn ghost_max(&self, nodal: &mut [f64], width: usize) {
        self.combine(TrafficKind::HaloMax, nodal, width, f64::max);
    }

    fn all_reduce_sum(&self, numbers: &mut [f64]) {
        let _timed = self.timers.time("reduction");
        let own = [&*numbers, &self.requests.share()].concat();
        self.timers
            .traffic()
            .count(TrafficKind::Reduction, 0, size_of_val(&own[..]));
        let mut sums = vec![0.0; own.len()];
        self.world
            .all_reduce_into(&own[..], &mut sums[..], SystemOperation::sum());
        numbers.copy_from_slice(&sums[..numbers.len()]);
        let mut requested = [0.0; WIDTH];
        requested.copy_from_slice(&sums[numbers.len()..]);
        self.requests.agree(requested);
    }

    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64> {
        let _timed = self.timers.time("reduction");
        let mut own: Vec<i64> = sums.iter().flat_map(|sum| sum.words()).copied().collect();
        own.extend(self.requests.share().map(|count| count as i64));
        self.timers
            .traffic()
            .count(TrafficKind::Reduction, 0, size_of_val(&own[..]));
        let mut all = vec![0; own.len()];
        self.world
            .all_reduce_into(&own[..], &mut all[..], SystemOperation::sum());
        let (words, requested) = all.split_at(sums.len() * WORDS);
        self.requests.agree(std::array::from_fn(|k| requested[k] as f64));
        words
            .chunks_exact(WORDS)
            .map(|words| Exact::of_words(words).value())
            .collect()
    }

    fn all_reduce_max(&self, numbers: &mut [f64]) {
        let _timed = self.timers.time("reduction");
        let own = numbers.to_vec();
        self.timers
            .traffic()
            .count(TrafficKind::Reduction, 0, size_of_val(&own[..]));
        self.world.all_reduce_into(&own[..], numbers, SystemOperation::max());
    }

    fn gather(&self, numbers: &[f64]) -> Vec<f64> {
        if self.world.size() == 1 {
            return numbers.to_vec();
        }
        let _timed = self.timers.time("reduction");
        self.timers
            .traffic()
            .count(TrafficKind::Gathering, 0, size_of_val(numbers));
        let mut counts = vec![0; self.world.size().unsigned_abs() as usize];
        self.world.all_gather_into(&(numbers.len() as i32), &mut counts[..]);
        let starts: Vec<i32> = counts
            .iter()
            .scan(0, |sum, count| {
                *sum += count;
                Some(*sum - count)
            })
            .collect();
        let mut all = vec![0.0; counts.iter().sum::<i32>().unsigned_abs() as usize];
        let mut parts = PartitionMut::new(&mut all[..], &counts[..], &starts[..]);
        self.world.all_gather_varcount_into(numbers, &mut parts);
        all
    }

    fn is_private(&self, node: usize) -> bool {
        let mut shared = self.neighbours.iter().flat_map(|other| &other.nodes.0);
        self.owned.contains(node) && !shared.any(|run| run.contains(&node))
    }

    fn is_interrupted(&self) -> bool {
        self.requests.stop()
    }

    fn rejects(&self) -> bool {
        self.requests.take_rejection()
    }
}
