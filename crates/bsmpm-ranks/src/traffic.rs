//! Counts messages and bytes of this rank.

use std::cell::Cell;

/// Kind of communication.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrafficKind {
    /// Sums at shared nodes.
    HaloSum,
    /// Maxima at shared nodes.
    HaloMax,
    /// Values of shared nodes, sent by their owner.
    HaloShare,
    /// Fronts and solutions of the factorisation by nested dissection.
    Factor,
    /// Numbers combined over all ranks.
    Reduction,
    /// Numbers of all ranks that every rank receives.
    Gathering,
    /// Points and nodal values that move to another rank.
    Migration,
}

impl TrafficKind {
    /// All kinds, in the order of [`TrafficCounts`].
    pub const ALL: [Self; 7] = [
        Self::HaloSum,
        Self::HaloMax,
        Self::HaloShare,
        Self::Factor,
        Self::Reduction,
        Self::Gathering,
        Self::Migration,
    ];

    /// Returns the name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::HaloSum => "halo sum",
            Self::HaloMax => "halo max",
            Self::HaloShare => "halo share",
            Self::Factor => "factor",
            Self::Reduction => "reduction",
            Self::Gathering => "gathering",
            Self::Migration => "migration",
        }
    }
}

/// Traffic of one rank of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Exchanges or reductions in which the rank took part.
    pub calls: u64,
    /// Messages sent to other ranks; reductions and gatherings count none.
    pub messages: u64,
    /// Bytes of these messages; for a reduction or gathering, of the rank's own numbers.
    pub bytes: u64,
}

/// Traffic of one rank by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TrafficCounts([Count; 7]);

impl TrafficCounts {
    /// Returns the traffic of one kind.
    pub fn of(&self, kind: TrafficKind) -> Count {
        self.0[kind as usize]
    }

    /// Returns the number of messages to other ranks and their bytes, over all kinds.
    pub fn sent(&self) -> [u64; 2] {
        let exchanges = [
            TrafficKind::HaloSum,
            TrafficKind::HaloMax,
            TrafficKind::HaloShare,
            TrafficKind::Factor,
            TrafficKind::Migration,
        ]
        .map(|kind| self.of(kind));
        [
            exchanges.iter().map(|count| count.messages).sum(),
            exchanges.iter().map(|count| count.bytes).sum(),
        ]
    }

    /// Returns the traffic since `before`.
    pub fn since(&self, before: &Self) -> Self {
        Self(TrafficKind::ALL.map(|kind| {
            let now = self.of(kind);
            let then = before.of(kind);
            Count {
                calls: now.calls - then.calls,
                messages: now.messages - then.messages,
                bytes: now.bytes - then.bytes,
            }
        }))
    }

    /// Iterates over calls, messages and bytes of every kind.
    pub fn numbers(&self) -> impl Iterator<Item = f64> {
        self.0
            .into_iter()
            .flat_map(|count| [count.calls, count.messages, count.bytes].map(|number| number as f64))
    }
}

/// Traffic counter of a rank.
#[derive(Debug, Default)]
pub struct Traffic(Cell<TrafficCounts>);

impl Traffic {
    /// Counts one call with the given number of messages and their total bytes.
    pub fn count(&self, kind: TrafficKind, messages: usize, bytes: usize) {
        let mut counts = self.0.get();
        let count = &mut counts.0[kind as usize];
        count.calls += 1;
        count.messages += messages as u64;
        count.bytes += bytes as u64;
        self.0.set(counts);
    }

    /// Returns the traffic so far.
    pub fn counts(&self) -> TrafficCounts {
        self.0.get()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_counted_for_itself_and_reductions_send_no_messages() {
        let traffic = Traffic::default();
        traffic.count(TrafficKind::HaloSum, 2, 160);
        let before = traffic.counts();
        traffic.count(TrafficKind::HaloSum, 2, 80);
        traffic.count(TrafficKind::Reduction, 0, 24);
        traffic.count(TrafficKind::Migration, 1, 500);
        let counts = traffic.counts();
        assert_eq!(
            counts.of(TrafficKind::HaloSum),
            Count {
                calls: 2,
                messages: 4,
                bytes: 240
            }
        );
        assert_eq!((counts.sent(), counts.since(&before).sent()), ([5, 740], [3, 580]));
        assert_eq!(counts.since(&before).of(TrafficKind::Reduction).calls, 1);
        let numbers: Vec<f64> = counts.numbers().collect();
        let expected = [
            [2.0, 4.0, 240.0],
            [0.0; 3],
            [0.0; 3],
            [0.0; 3],
            [1.0, 0.0, 24.0],
            [0.0; 3],
            [1.0, 1.0, 500.0],
        ];
        assert_eq!(numbers, expected.concat());
    }
}
