//! Elimination of what slabs share: pairs of neighbours, pairs of pairs, up to all ranks. What a cut couples is a dense
//! front on the lowest rank of the slabs that it parts; which rank does what when is fixed, so that all sums repeat.

use super::front;
use crate::halo::Link;
use std::ops::Range;

/// What a rank does at one level of the pairing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Rung {
    /// joins the group of the rank `from`, and eliminates the node layers that only the two of them touch
    Join {
        /// the other group's lowest rank
        from: usize,
        /// layers of the grid
        layers: Range<usize>,
    },
    /// hands over to the lowest rank of the other group; the last thing it does
    Hand {
        /// that rank
        to: usize,
    },
}

/// What `rank` does from the pairs of slabs upwards, for slabs that begin at `bounds` and splines of order `q`.
pub fn rungs(bounds: &[usize], q: usize, rank: usize) -> Vec<Rung> {
    let (mut lower, mut upper, last) = (0, bounds.len() - 1, bounds.len() - 1);
    let mut rungs = Vec::new();
    while upper - lower > 1 {
        let middle = usize::midpoint(lower, upper);
        if rank == lower {
            // A layer is touched by the slabs that begin at or before it and end less than q before it.
            let start = bounds[middle].max(if lower > 0 { bounds[lower] + q } else { 0 });
            let end = (bounds[middle] + q).min(if upper < last { bounds[upper] } else { usize::MAX });
            rungs.push(Rung::Join { from: middle, layers: start..end.max(start) });
        } else if rank == middle {
            rungs.push(Rung::Hand { to: lower });
        }
        if rank < middle { upper = middle } else { lower = middle }
    }
    rungs.reverse();
    rungs
}

/// Two groups of slabs that became one.
struct Joint {
    from: usize,
    rows: usize,
    mine: Vec<usize>,   // places of the components of this rank's group
    theirs: Vec<usize>, // of the other's
    columns: Vec<f64>,  // of the factor
    own: usize,
}

/// The rungs of a rank with their fronts.
#[derive(Default)]
pub struct Ladder {
    joints: Vec<Joint>,
    hand: Option<usize>,
}

impl Ladder {
    /// The fronts for a rank whose slab leaves the `shared` components of the whole grid, ascending, of which `layer` make
    /// a layer of nodes. Collective.
    pub fn new(link: &dyn Link, rungs: &[Rung], mut shared: Vec<usize>, layer: usize) -> Self {
        let (mut joints, mut hand) = (Vec::new(), None);
        for rung in rungs {
            match rung {
                Rung::Join { from, layers } => {
                    let others = link.receive(*from).into_iter().map(|component| component as usize).collect();
                    let (joint, left) = Joint::new(*from, (shared, others), |at| layers.contains(&(at / layer)));
                    joints.push(joint);
                    shared = left;
                }
                Rung::Hand { to } => {
                    let numbers: Vec<f64> = shared.iter().map(|&component| component as f64).collect();
                    link.send(*to, &numbers);
                    hand = Some(*to);
                }
            }
        }
        Self { joints, hand }
    }

    /// Factorises, given what this rank's slab leaves, packed. `false` where a pivot was not positive. Collective.
    pub fn factorise(&mut self, link: &dyn Link, mut packed: Vec<f64>) -> bool {
        let mut good = true;
        for joint in &mut self.joints {
            let (others, order) = (link.receive(joint.from), joint.rows - joint.own);
            joint.columns.clear();
            joint.columns.resize(joint.own * joint.rows, 0.0);
            let mut rest = vec![0.0; order * order];
            for (places, packed) in [(&joint.mine, &packed), (&joint.theirs, &others)] {
                add_packed(packed, places, (&mut joint.columns, joint.own), &mut rest);
            }
            good &= front::factorise(&mut joint.columns, joint.rows);
            front::subtract_from_rest(&joint.columns, joint.rows, &mut rest);
            packed = pack(&rest, order);
        }
        if let Some(to) = self.hand {
            link.send(to, &packed);
        }
        good
    }

    /// Solves for what the slabs share: `x` holds what this rank's slab leaves of the right-hand side, then the solution
    /// there. Collective.
    pub fn solve(&self, link: &dyn Link, x: &mut [f64]) {
        let (mut left, mut fronts) = (x.to_vec(), Vec::new());
        for joint in &self.joints {
            let (others, mut all) = (link.receive(joint.from), vec![0.0; joint.rows]);
            joint.mine.iter().zip(&left).for_each(|(&place, value)| all[place] += value);
            joint.theirs.iter().zip(&others).for_each(|(&place, value)| all[place] += value);
            front::forward(&joint.columns, joint.rows, &mut all);
            left = all[joint.own..].to_vec();
            fronts.push(all);
        }
        if let Some(to) = self.hand {
            link.send(to, &left);
            left = link.receive(to);
        }
        for (joint, mut all) in self.joints.iter().zip(fronts).rev() {
            all[joint.own..].copy_from_slice(&left);
            front::backward(&joint.columns, joint.rows, &mut all);
            let others: Vec<f64> = joint.theirs.iter().map(|&place| all[place]).collect();
            link.send(joint.from, &others);
            left = joint.mine.iter().map(|&place| all[place]).collect();
        }
        x.copy_from_slice(&left);
    }
}

impl Joint {
    /// Of this rank's group and that of `from`, each with its components; what is not eliminated `here` is left.
    fn new(from: usize, (mine, theirs): (Vec<usize>, Vec<usize>), here: impl Fn(usize) -> bool) -> (Self, Vec<usize>) {
        let mut all = [&mine[..], &theirs[..]].concat();
        let key = |&component: &usize| (!here(component), component);
        all.sort_unstable_by_key(key);
        all.dedup();
        let own = all.partition_point(|&component| here(component));
        let place = |component: &usize| all.partition_point(|other| key(other) < key(component));
        let (mine, theirs) = (mine.iter().map(place).collect(), theirs.iter().map(place).collect());
        let joint = Self { from, rows: all.len(), mine, theirs, columns: Vec::new(), own };
        (joint, all.split_off(own))
    }
}

/// The lower triangle of a matrix of order `n`, by columns.
pub fn pack(matrix: &[f64], n: usize) -> Vec<f64> {
    (0..n).flat_map(|column| &matrix[column * n + column..(column + 1) * n]).copied().collect()
}

/// Adds a packed triangle whose rows stand at `places` of a front: `own` columns, and the rest's matrix.
pub fn add_packed(packed: &[f64], places: &[usize], (columns, own): (&mut [f64], usize), rest: &mut [f64]) {
    let mut start = 0;
    let rows = columns.len().checked_div(own).unwrap_or(0);
    let order = rest.len().isqrt();
    for (column, &place) in places.iter().enumerate() {
        let length = places.len() - column;
        for (value, &other) in packed[start..start + length].iter().zip(&places[column..]) {
            let (i, j) = (place.max(other), place.min(other));
            if j < own {
                columns[j * rows + i] += value;
            } else {
                rest[(j - own) * order + i - own] += value;
            }
        }
        start += length;
    }
}
