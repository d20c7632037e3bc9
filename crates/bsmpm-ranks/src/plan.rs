//! Plans which material points and nodal values must move to which rank.

use crate::slab::{NodeBox, Slabs, common};
use std::ops::Range;

/// Points of a rank, grouped by the rank that they belong to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PointPlan {
    /// Points that stay, in their order.
    pub stay: Vec<u32>,
    /// Points that leave, by destination rank, in their order.
    pub leave: Vec<(usize, Vec<u32>)>,
}

impl PointPlan {
    /// Creates the plan of `rank` for points that belong to `owners`.
    pub fn new(owners: impl Iterator<Item = usize>, rank: usize) -> Self {
        let mut stay = Vec::new();
        let mut leave = Vec::<(usize, Vec<u32>)>::new();
        for (p, owner) in (0..).zip(owners) {
            if owner == rank {
                stay.push(p);
                continue;
            }
            match leave.binary_search_by_key(&owner, |(other, _)| *other) {
                Ok(place) => leave[place].1.push(p),
                Err(place) => leave.insert(place, (owner, vec![p])),
            }
        }
        Self { stay, leave }
    }
}

/// Nodal values to be moved between two partitions: the old owner of a box sends it to all ranks whose new window
/// contains a part of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodePlan {
    /// What this rank sends, also to itself, ascending by rank.
    pub send: Vec<(usize, NodeBox)>,
    /// What this rank receives, ascending by rank: each node of its new window that existed before, once.
    pub receive: Vec<(usize, NodeBox)>,
}

impl NodePlan {
    /// Creates the plan of `rank` from the partition `old` to the partition `new`, for splines of degree `q`. `rows`
    /// are the rows of cells of the active domain.
    pub fn new(old: &Slabs, new: &Slabs, rank: usize, q: usize, rows: &Range<usize>) -> Self {
        let owned = old.owned(rank, q, rows);
        let window = new.nodes(rank, q, rows);
        let send = (0..new.ranks()).map(|other| (other, common(&owned, &new.nodes(other, q, rows))));
        let receive = (0..new.ranks()).map(|other| (other, common(&old.owned(other, q, rows), &window)));
        Self {
            send: send.filter(|(_, nodes)| !nodes.iter().any(Range::is_empty)).collect(),
            receive: receive
                .filter(|(_, nodes)| !nodes.iter().any(Range::is_empty))
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_stays_or_leaves_once_in_its_order() {
        let plan = PointPlan::new([1, 0, 1, 3, 0, 1].into_iter(), 1);
        assert_eq!(plan.stay, [0, 2, 5]);
        assert_eq!(plan.leave, [(0, vec![1, 4]), (3, vec![3])]);
        assert_eq!(
            PointPlan::new(std::iter::empty(), 2),
            PointPlan {
                stay: vec![],
                leave: vec![]
            }
        );
    }

    /// Bounds of 4 slabs of 12 columns: even, thinner than the splines reach, and all but one column on one rank.
    const CUTS: [[usize; 5]; 4] = [
        [0, 3, 6, 9, 12],
        [0, 1, 2, 3, 12],
        [0, 9, 10, 11, 12],
        [0, 1, 10, 11, 12],
    ];
    /// Bounds of two parts of 6 rows, slab by slab.
    const PARTS: [[usize; 2]; 3] = [[3, 3], [1, 5], [5, 2]];

    fn agrees(old: &Slabs, new: &Slabs, ranks: usize, q: usize) {
        let rows = &(0..6);
        for rank in 0..ranks {
            let plan = NodePlan::new(old, new, rank, q, rows);
            let nodes = |[layers, rows]: &NodeBox| -> Vec<[usize; 2]> {
                layers
                    .clone()
                    .flat_map(|layer| rows.clone().map(move |row| [layer, row]))
                    .collect()
            };
            let mut received: Vec<[usize; 2]> = plan.receive.iter().flat_map(|(_, part)| nodes(part)).collect();
            received.sort_unstable();
            assert_eq!(received, nodes(&new.nodes(rank, q, rows)));
            for (other, part) in plan.receive {
                assert!(NodePlan::new(old, new, other, q, rows).send.contains(&(rank, part)));
            }
            for (other, part) in plan.send {
                assert!(NodePlan::new(old, new, other, q, rows).receive.contains(&(rank, part)));
            }
        }
    }

    #[test]
    fn each_new_window_receives_every_node_once_from_its_old_owner() {
        let cut = |bounds: [usize; 5]| Slabs::new(bounds.to_vec(), 4, 0..12).unwrap();
        for (old, new) in CUTS.iter().flat_map(|old| CUTS.map(|new| (cut(*old), cut(new)))) {
            (1..4).for_each(|q| agrees(&old, &new, 4, q));
        }
        let cut = |at: usize, parts: [usize; 2]| {
            let slabs = Slabs::new(vec![0, at, 12], 2, 0..12).unwrap();
            slabs.parted(parts.map(|at| vec![0, at, 6]).to_vec(), &(0..6)).unwrap()
        };
        for (old, new) in PARTS
            .iter()
            .flat_map(|old| PARTS.map(|new| (cut(4, *old), cut(9, new))))
        {
            (1..4).for_each(|q| agrees(&old, &new, 4, q));
        }
    }

    #[test]
    fn layers_that_were_in_no_window_before_are_sent_by_nobody() {
        let old = Slabs::new(vec![4, 6, 8], 2, 4..8);
        let new = Slabs::new(vec![2, 5, 12], 2, 2..12);
        let old = old.unwrap();
        let new = new.unwrap();
        let boxed = |parts: Vec<(usize, Range<usize>)>| -> Vec<(usize, NodeBox)> {
            parts.into_iter().map(|(rank, layers)| (rank, [layers, 0..3])).collect()
        };
        let [first, last] = [0, 1].map(|rank| NodePlan::new(&old, &new, rank, 2, &(0..1)));
        let received = (boxed(vec![(0, 4..6), (1, 6..7)]), boxed(vec![(0, 5..6), (1, 6..10)]));
        assert_eq!((first.receive, last.receive), received);
        assert_eq!(
            (first.send, last.send),
            (boxed(vec![(0, 4..6), (1, 5..6)]), boxed(vec![(0, 6..7), (1, 6..10)]))
        );
    }

    #[test]
    fn a_cut_that_stays_moves_only_what_neighbours_share() {
        let slabs = Slabs::new(vec![0, 3, 6, 9, 12], 4, 0..12).unwrap();
        let plan = NodePlan::new(&slabs, &slabs, 1, 2, &(0..1));
        assert_eq!(plan.send, [(0, [3..5, 0..3]), (1, [3..6, 0..3])]);
        assert_eq!(plan.receive, [(1, [3..6, 0..3]), (2, [6..8, 0..3])]);
    }
}
