//! Who gets what when points leave their slab and when the slabs are cut anew: plain data, without MPI.

use crate::slab::{Slabs, intersection};
use std::ops::Range;

/// The points of a rank, by the rank that they belong to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PointPlan {
    /// those that stay, in their order
    pub stay: Vec<u32>,
    /// those that leave, in their order, by the rank that they go to
    pub leave: Vec<(usize, Vec<u32>)>,
}

impl PointPlan {
    /// The plan of `rank` for points that belong to `owners`.
    pub fn new(owners: impl Iterator<Item = usize>, rank: usize) -> Self {
        let (mut stay, mut leave) = (Vec::new(), Vec::<(usize, Vec<u32>)>::new());
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

/// Node layers that change hands between two cuts: the old owner of a layer tells it to all whose new window has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerPlan {
    /// what this rank tells, itself included, ascending by rank
    pub send: Vec<(usize, Range<usize>)>,
    /// what it is told, ascending by rank: together what of its new window there was before, each layer once
    pub receive: Vec<(usize, Range<usize>)>,
}

impl LayerPlan {
    /// The plan of `rank` from the cut `old` to the cut `new`, for splines of order `q`.
    pub fn new((old, new): (&Slabs, &Slabs), rank: usize, q: usize) -> Self {
        let (owned, window) = (old.owned_layers(rank, q), new.layers(rank, q));
        let parts = |part: &dyn Fn(usize) -> Range<usize>| {
            (0..new.ranks()).map(|other| (other, part(other))).filter(|(_, layers)| !layers.is_empty()).collect()
        };
        Self {
            send: parts(&|other| intersection(&owned, &new.layers(other, q))),
            receive: parts(&|other| intersection(&old.owned_layers(other, q), &window)),
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
        assert_eq!(PointPlan::new(std::iter::empty(), 2), PointPlan { stay: vec![], leave: vec![] });
    }

    /// Bounds of 4 slabs of 12 columns: even, thinner than the splines reach, and all but one column on one rank.
    const CUTS: [[usize; 5]; 4] = [[0, 3, 6, 9, 12], [0, 1, 2, 3, 12], [0, 9, 10, 11, 12], [0, 1, 10, 11, 12]];

    #[test]
    fn each_new_window_is_told_every_layer_once_by_its_old_owner() {
        let cut = |bounds: [usize; 5]| Slabs::new(bounds.to_vec(), 4, 0..12).unwrap();
        for (old, new) in CUTS.iter().flat_map(|old| CUTS.map(|new| (cut(*old), cut(new)))) {
            for (rank, q) in (0..4).flat_map(|rank| [1, 2, 3].map(|q| (rank, q))) {
                let plan = LayerPlan::new((&old, &new), rank, q);
                let told: Vec<usize> = plan.receive.iter().flat_map(|(_, layers)| layers.clone()).collect();
                assert_eq!(told, new.layers(rank, q).collect::<Vec<_>>());
                for (other, layers) in plan.receive {
                    assert!(LayerPlan::new((&old, &new), other, q).send.contains(&(rank, layers)));
                }
                for (other, layers) in plan.send {
                    assert!(LayerPlan::new((&old, &new), other, q).receive.contains(&(rank, layers)));
                }
            }
        }
    }

    #[test]
    fn layers_that_were_in_no_window_before_are_told_by_nobody() {
        let (old, new) = (Slabs::new(vec![4, 6, 8], 2, 4..8), Slabs::new(vec![2, 5, 12], 2, 2..12));
        let (old, new) = (old.unwrap(), new.unwrap());
        let [first, last] = [0, 1].map(|rank| LayerPlan::new((&old, &new), rank, 2));
        assert_eq!((first.receive, last.receive), (vec![(0, 4..6), (1, 6..7)], vec![(0, 5..6), (1, 6..10)]));
        assert_eq!((first.send, last.send), (vec![(0, 4..6), (1, 5..6)], vec![(0, 6..7), (1, 6..10)]));
    }

    #[test]
    fn a_cut_that_stays_moves_only_what_neighbours_share() {
        let slabs = Slabs::new(vec![0, 3, 6, 9, 12], 4, 0..12).unwrap();
        let plan = LayerPlan::new((&slabs, &slabs), 1, 2);
        assert_eq!(plan.send, [(0, 3..5), (1, 3..6)]);
        assert_eq!(plan.receive, [(1, 3..6), (2, 6..8)]);
    }
}
