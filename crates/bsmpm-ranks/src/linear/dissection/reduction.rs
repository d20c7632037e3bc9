//! Eliminates nodes that ranks share: first in pairs of neighbouring ranks, then in groups of pairs, and so on.

use super::factor::{self, Factor, Precision};
use super::front;
use crate::halo::Link;
use std::ops::Range;

/// What a rank does in the pairing, from the ranks' boxes upwards.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Role {
    /// the rank, itself perhaps, that joins its box with others; none if it is alone
    pub joined_by: Option<usize>,
    /// the two groups that it joins; the first rank joins none
    pub join: Option<Join>,
}

/// Two groups of ranks that become one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Join {
    /// the ranks, itself perhaps, from which it hears of the lower and of the upper group
    pub from: [usize; 2],
    /// the ranks of the two: what only they touch is eliminated
    pub group: Range<usize>,
    /// the rank that joins them with others; none for the last two
    pub joined_by: Option<usize>,
}

/// The rank that holds what a group of ranks leaves: the first of its upper half, which is that of no other group.
fn holder(group: &Range<usize>) -> usize {
    usize::midpoint(group.start, group.end)
}

/// The role of a rank of so many.
pub fn role(ranks: usize, rank: usize) -> Role {
    let mut group = 0..ranks;
    let mut role = Role::default();
    while group.len() > 1 {
        let middle = holder(&group);
        if rank == middle {
            let from = [holder(&(group.start..middle)), holder(&(middle..group.end))];
            role.join = Some(Join {
                from,
                group: group.clone(),
                joined_by: role.joined_by,
            });
        }
        role.joined_by = Some(middle);
        group = if rank < middle {
            group.start..middle
        } else {
            middle..group.end
        };
    }
    role
}

/// The dense front of a cut.
struct Joint {
    join: Join,
    rows: usize,
    own: usize,
    places: [Vec<usize>; 2], // of the components of either group
    factor: Factor,
}

/// A rank in the pairing, with its front.
#[derive(Default)]
pub struct TreeReduction {
    rank: usize,
    joined_by: Option<usize>,
    joint: Option<Joint>,
}

impl TreeReduction {
    /// The front of the `rank` whose box leaves the `shared` components of the whole grid, ascending; `touching` are
    /// the ranks from the first to the last one that touch a component. Collective.
    pub fn new(
        link: &dyn Link,
        rank: usize,
        role: Role,
        shared: &[usize],
        touching: impl Fn(usize) -> Range<usize>,
    ) -> Self {
        let mut reduction = Self {
            rank,
            joined_by: role.joined_by,
            joint: None,
        };
        let slab: Vec<f64> = shared.iter().map(|&component| component as f64).collect();
        let slab = reduction.hand(link, reduction.joined_by, slab);
        if let Some(join) = role.join {
            let groups = reduction.hear(link, join.from, slab);
            let groups = groups.map(|group| group.into_iter().map(|component| component as usize).collect());
            let (joint, left) = Joint::new(join, &groups, touching);
            let left = left.iter().map(|&component| component as f64).collect();
            reduction.hand(link, joint.join.joined_by, left);
            reduction.joint = Some(joint);
        }
        reduction
    }

    /// Factorises, given what this rank's slab leaves, packed. `false` where a pivot was not positive. Collective.
    pub fn factorise(&mut self, link: &dyn Link, precision: Precision, packed: Vec<f64>) -> bool {
        let packed = self.hand(link, self.joined_by, packed);
        let Some(mut joint) = self.joint.take() else {
            return true;
        };
        let (good, left) = joint.factorise(precision, self.hear(link, joint.join.from, packed));
        self.hand(link, joint.join.joined_by, left);
        self.joint = Some(joint);
        good
    }

    /// Solves for what the slabs share: `x` holds what this rank's slab leaves of the right-hand side, then the
    /// solution there. Collective.
    pub fn solve(&self, link: &dyn Link, x: &mut [f64]) {
        let mut slab = self.hand(link, self.joined_by, x.to_vec());
        if let Some(joint) = &self.joint {
            let Join { from, joined_by, .. } = &joint.join;
            let mut all = joint.forward(&self.hear(link, *from, slab.take()));
            if let Some(by) = joined_by {
                link.send(*by, &all[joint.own..]);
                all[joint.own..].copy_from_slice(&link.receive(*by));
            }
            for (&of, solution) in from.iter().zip(joint.backward(all)) {
                slab = self.hand(link, Some(of), solution).or(slab);
            }
        }
        match (slab, self.joined_by) {
            (Some(slab), _) => x.copy_from_slice(&slab),
            (None, Some(by)) => x.copy_from_slice(&link.receive(by)),
            (None, None) => {}
        }
    }

    /// Sends to another rank; what is for this rank, or nobody, comes back.
    fn hand(&self, link: &dyn Link, to: Option<usize>, numbers: Vec<f64>) -> Option<Vec<f64>> {
        match to {
            Some(to) if to != self.rank => {
                link.send(to, &numbers);
                None
            }
            _ => Some(numbers),
        }
    }

    /// What two ranks have sent, one of which may be this one, with `own`.
    fn hear(&self, link: &dyn Link, from: [usize; 2], mut own: Option<Vec<f64>>) -> [Vec<f64>; 2] {
        from.map(|of| {
            if of == self.rank {
                own.take().unwrap_or_default()
            } else {
                link.receive(of)
            }
        })
    }
}

impl Joint {
    /// Of two groups with their components; what is not eliminated here is left.
    fn new(join: Join, groups: &[Vec<usize>; 2], touching: impl Fn(usize) -> Range<usize>) -> (Self, Vec<usize>) {
        let keys = groups.each_ref().map(|group| {
            let keys = group.iter().map(|&component| {
                let ranks = touching(component);
                (ranks.start < join.group.start || join.group.end < ranks.end, component) // what stays comes last
            });
            keys.collect::<Vec<(bool, usize)>>()
        });
        let mut all = keys.concat();
        all.sort_unstable();
        all.dedup();
        let own = all.partition_point(|(stays, _)| !stays);
        let places = keys.map(|keys| {
            let places = keys.iter().map(|key| all.partition_point(|other| other < key));
            places.collect()
        });
        let left = all[own..].iter().map(|(_, component)| *component).collect();
        (
            Self {
                rows: all.len(),
                own,
                places,
                factor: Factor::default(),
                join,
            },
            left,
        )
    }

    /// Factorises the front of what the groups leave, packed; whether all pivots were positive, and what is left,
    /// packed.
    fn factorise(&mut self, precision: Precision, groups: [Vec<f64>; 2]) -> (bool, Vec<f64>) {
        let order = self.rows - self.own;
        let mut columns = vec![0.0; self.own * self.rows];
        let mut rest = vec![0.0; order * order];
        for (places, packed) in self.places.iter().zip(groups) {
            add_packed(&packed, places, &mut columns, self.own, &mut rest);
        }
        let good = front::factorise(&mut columns, self.rows);
        front::subtract_from_rest(&columns, self.rows, &mut rest);
        self.factor
            .restart(precision, factor::entries(self.rows, self.own))
            .keep(0, &columns, self.rows);
        (good, pack(&rest, order))
    }

    /// The right-hand side of the front, with its own unknowns eliminated.
    fn forward(&self, groups: &[Vec<f64>; 2]) -> Vec<f64> {
        let mut all = vec![0.0; self.rows];
        for (places, values) in self.places.iter().zip(groups) {
            places
                .iter()
                .zip(values)
                .for_each(|(&place, value)| all[place] += value);
        }
        self.factor.forward(0, self.rows, self.own, &mut all);
        all
    }

    /// The solution of either group, from that of what is left.
    fn backward(&self, mut all: Vec<f64>) -> [Vec<f64>; 2] {
        self.factor.backward(0, self.rows, self.own, &mut all);
        [0, 1].map(|group: usize| self.places[group].iter().map(|&place| all[place]).collect())
    }
}

/// The lower triangle of a matrix of order `n`, by columns.
pub fn pack(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut packed = Vec::with_capacity(n * (n + 1) / 2);
    (0..n).for_each(|column| packed.extend_from_slice(&matrix[column * n + column..(column + 1) * n]));
    packed
}

/// Adds a packed triangle whose rows stand at `places` of a front: `own` columns, and the rest's matrix.
pub fn add_packed(packed: &[f64], places: &[usize], columns: &mut [f64], own: usize, rest: &mut [f64]) {
    let mut start = 0;
    let rows = columns.len().checked_div(own).unwrap_or(0);
    let order = rest.len().isqrt();
    for (column, &place) in places.iter().enumerate() {
        let length = places.len() - column;
        for (value, &other) in packed[start..start + length].iter().zip(&places[column..]) {
            let i = place.max(other);
            let j = place.min(other);
            if j < own {
                columns[j * rows + i] += value;
            } else {
                rest[(j - own) * order + i - own] += value;
            }
        }
        start += length;
    }
}
