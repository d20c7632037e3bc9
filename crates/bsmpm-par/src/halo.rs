//! The exchange of nodal contributions: one message to and from every rank that shares node layers.

use crate::signals::{Requests, WIDTH};
use crate::slab::Slabs;
use crate::timers::Timers;
use bsmpm::grid::Grid;
use bsmpm::seam::Halo;
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
    shared: Vec<(usize, Range<usize>)>, // rank and local nodes, ascending by rank
    timers: Rc<Timers>,
    requests: Rc<Requests>,
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
        let owned = nodes(slabs.owned_layers(rank, q));
        let shared = slabs.shared(rank, q).into_iter().map(|(other, layers)| (other, nodes(layers))).collect();
        Self { world, rank, owned, shared, timers, requests }
    }

    /// The ranks.
    pub fn world(&self) -> &SimpleCommunicator {
        &self.world
    }

    /// What is asked of the run from outside.
    pub fn requests(&self) -> &Rc<Requests> {
        &self.requests
    }

    /// What every sharing rank contributes to the shared nodes, in the order of `shared`.
    fn receive(&self, nodal: &[f64], width: usize) -> Vec<Vec<f64>> {
        let mut incoming: Vec<Vec<f64>> = self.shared.iter().map(|(_, nodes)| vec![0.0; nodes.len() * width]).collect();
        mpi::request::scope(|scope| {
            let receives: Vec<_> = self
                .shared
                .iter()
                .zip(&mut incoming)
                .map(|((other, _), part)| {
                    self.world.process_at_rank(*other as i32).immediate_receive_into(scope, &mut part[..])
                })
                .collect();
            let sends: Vec<_> = self
                .shared
                .iter()
                .map(|(other, nodes)| {
                    let part = &nodal[nodes.start * width..nodes.end * width];
                    self.world.process_at_rank(*other as i32).immediate_send(scope, part)
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

impl Halo for MpiHalo {
    fn owned(&self) -> Range<usize> {
        self.owned.clone()
    }

    fn sum(&self, nodal: &mut [f64], width: usize) {
        if self.shared.is_empty() {
            return;
        }
        let _timed = self.timers.time("halo");
        let incoming = self.receive(nodal, width);
        let own: Vec<Vec<f64>> =
            self.shared.iter().map(|(_, nodes)| nodal[nodes.start * width..nodes.end * width].to_vec()).collect();
        // Every sharing rank adds the same numbers in the order of the ranks: all of them get the same bits.
        for (_, nodes) in &self.shared {
            nodal[nodes.start * width..nodes.end * width].fill(0.0);
        }
        let lower = self.shared.partition_point(|(other, _)| *other < self.rank);
        for (part, (_, nodes)) in incoming[..lower].iter().zip(&self.shared) {
            add(part, &mut nodal[nodes.start * width..nodes.end * width]);
        }
        self.add_own(&own, nodal, width);
        for (part, (_, nodes)) in incoming[lower..].iter().zip(&self.shared[lower..]) {
            add(part, &mut nodal[nodes.start * width..nodes.end * width]);
        }
    }

    fn max(&self, nodal: &mut [f64]) {
        if self.shared.is_empty() {
            return;
        }
        let _timed = self.timers.time("halo");
        let incoming = self.receive(nodal, 1);
        for (part, (_, nodes)) in incoming.iter().zip(&self.shared) {
            nodal[nodes.clone()].iter_mut().zip(part).for_each(|(value, other)| *value = value.max(*other));
        }
    }

    fn reduce(&self, numbers: &mut [f64]) {
        let _timed = self.timers.time("reduction");
        let own = [&*numbers, &self.requests.share()].concat();
        let mut sums = vec![0.0; own.len()];
        self.world.all_reduce_into(&own[..], &mut sums[..], SystemOperation::sum());
        numbers.copy_from_slice(&sums[..numbers.len()]);
        let mut requested = [0.0; WIDTH];
        requested.copy_from_slice(&sums[numbers.len()..]);
        self.requests.agree(requested);
    }

    fn maximum(&self, numbers: &mut [f64]) {
        let _timed = self.timers.time("reduction");
        let own = numbers.to_vec();
        self.world.all_reduce_into(&own[..], numbers, SystemOperation::max());
    }

    fn is_interrupted(&self) -> bool {
        self.requests.stop()
    }

    fn rejects(&self) -> bool {
        self.requests.take_rejection()
    }
}

impl MpiHalo {
    /// Adds this rank's own contribution once to every shared node, whichever and however many ranks share it.
    fn add_own(&self, own: &[Vec<f64>], nodal: &mut [f64], width: usize) {
        let mut done: Vec<Range<usize>> = Vec::new();
        for (part, (_, nodes)) in own.iter().zip(&self.shared) {
            for node in nodes.clone().filter(|node| !done.iter().any(|range| range.contains(node))) {
                let at = (node - nodes.start) * width;
                add(&part[at..at + width], &mut nodal[node * width..(node + 1) * width]);
            }
            done.push(nodes.clone());
        }
    }
}

fn add(part: &[f64], nodal: &mut [f64]) {
    nodal.iter_mut().zip(part).for_each(|(total, contribution)| *total += contribution);
}
