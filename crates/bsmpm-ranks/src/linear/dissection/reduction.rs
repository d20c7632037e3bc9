//! Eliminates nodes that ranks share: first in pairs of neighbouring ranks, then in groups of pairs, and so on.

use super::factor::{self, Factor, Precision};
use super::front;
use crate::halo::Link;
use std::ops::Range;

/// Role of a rank in the pairing of groups.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Role {
    /// Rank that joins its box with others (possibly itself); none if it is the only rank.
    pub joined_by: Option<usize>,
    /// Join that this rank performs; none for the first rank.
    pub join: Option<Join>,
}

/// Join of two groups of ranks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Join {
    /// Ranks (possibly itself) that send the lower and the upper group's data.
    pub from: [usize; 2],
    /// Ranks of the two groups. Unknowns that only these ranks use are eliminated.
    pub group: Range<usize>,
    /// Rank that joins the result with others; none for the last join.
    pub joined_by: Option<usize>,
}

/// Returns the rank that stores the result of a group: the first of its upper half, which does this for no other group.
fn holder(group: &Range<usize>) -> usize {
    usize::midpoint(group.start, group.end)
}

/// Returns the role of `rank` among `ranks`.
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

/// Dense front of a join.
struct Joint {
    join: Join,
    rows: usize,
    own: usize,
    places: [Vec<usize>; 2], // positions of the components of either group
    factor: Factor,
}

/// Rank in the pairing, with its front.
#[derive(Default)]
pub struct TreeReduction {
    rank: usize,
    joined_by: Option<usize>,
    joint: Option<Joint>,
}

impl TreeReduction {
    /// Creates the front of `rank`, whose box shares the components `shared` (numbers in the whole grid, ascending).
    /// `touching` returns the ranks, from the first to the last one, that use a component. Collective.
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

    /// Factorises, given the packed update matrix of this rank. Returns `false` if a pivot was not positive.
    /// Collective.
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

    /// Solves for the shared unknowns: `x` is this rank's contribution to the right-hand side, then the solution.
    /// Collective.
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

    /// Sends numbers to another rank; returns them if they are for this rank or for none.
    fn hand(&self, link: &dyn Link, to: Option<usize>, numbers: Vec<f64>) -> Option<Vec<f64>> {
        match to {
            Some(to) if to != self.rank => {
                link.send(to, &numbers);
                None
            }
            _ => Some(numbers),
        }
    }

    /// Returns the messages of two ranks; `own` is the message if one of them is this rank.
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
    /// Creates the front of two groups with their components. Returns the components that are not eliminated here, too.
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

    /// Factorises the front from the packed update matrices of the groups. Returns whether all pivots were positive,
    /// and the packed update matrix.
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

    /// Returns the right-hand side of the front, with its own unknowns eliminated.
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

    /// Returns the solution of either group from that of the remaining unknowns.
    fn backward(&self, mut all: Vec<f64>) -> [Vec<f64>; 2] {
        self.factor.backward(0, self.rows, self.own, &mut all);
        [0, 1].map(|group: usize| self.places[group].iter().map(|&place| all[place]).collect())
    }
}

/// Returns the lower triangle of a matrix of order `n`, by columns.
pub fn pack(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut packed = Vec::with_capacity(n * (n + 1) / 2);
    (0..n).for_each(|column| packed.extend_from_slice(&matrix[column * n + column..(column + 1) * n]));
    packed
}

/// Adds a packed triangle, whose rows are at the positions `places` of a front, to its `own` columns and to the matrix
/// of the rest.
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
