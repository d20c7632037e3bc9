//! The cut of the grid into slabs of columns along its first axis: plain data, known to every rank, without MPI.
//!
//! A rank owns the cells of its columns and the node layers that begin in them; the last rank owns the q layers at the
//! far end too. Its window reaches q ghost layers further, into the slab (or, of thin slabs, the slabs) behind.

use std::ops::Range;

/// Halvings of the interval in which the least largest cost lies: to the last bit of a float.
const BISECTIONS: usize = 60;

/// Columns at which the slabs begin, and the number of columns last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slabs {
    bounds: Vec<usize>,
    beyond: usize, // further layers of a window
}

impl Slabs {
    /// Cuts columns of given cost into slabs, each at least one column wide, whose largest cost is as small as it can
    /// be and whose bounds are, within that, near equal shares. `None` if there are fewer columns than ranks.
    pub fn cut(cost: &[f64], ranks: usize) -> Option<Self> {
        if cost.len() < ranks {
            return None;
        }
        let before: Vec<f64> = std::iter::once(0.0)
            .chain(cost.iter().scan(0.0, |sum, cost| {
                *sum += cost;
                Some(*sum)
            }))
            .collect();
        let total = before[cost.len()];
        let middle: Vec<f64> = before.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        let (mut low, mut high) = (0.0, total);
        let mut first = earliest(&before, ranks, total)?;
        for _ in 0..BISECTIONS {
            let most = 0.5 * (low + high);
            match earliest(&before, ranks, most) {
                Some(found) => (high, first) = (most, found),
                None => low = most,
            }
        }
        let mut bounds = vec![0];
        for rank in 1..ranks {
            let start = bounds[rank - 1];
            let reach = before.partition_point(|sum| sum - before[start] <= high) - 1;
            let wanted = total * rank as f64 / ranks as f64;
            // A column goes to the slab in which more than half of it lies.
            let fair = middle.partition_point(|sum| *sum < wanted);
            let least = first[rank].max(start + 1);
            bounds.push(fair.clamp(least, reach.min(cost.len() - (ranks - rank)).max(least)));
        }
        bounds.push(cost.len());
        Some(Self { bounds, beyond: 0 })
    }

    /// Slabs that begin at given columns; `None` if they are not one for each rank, all with cells, of all `columns` of
    /// the grid's room.
    pub fn new(bounds: Vec<usize>, ranks: usize, columns: Range<usize>) -> Option<Self> {
        let whole = bounds.len() == ranks + 1 && bounds[0] == columns.start && bounds[ranks] == columns.end;
        (whole && bounds.is_sorted_by(|a, b| a < b)).then_some(Self { bounds, beyond: 0 })
    }

    /// The same slabs of columns of which the first is number `first`.
    pub fn starting_at(self, first: usize) -> Self {
        Self { bounds: self.bounds.iter().map(|bound| bound + first).collect(), ..self }
    }

    /// The same slabs, whose windows hold `beyond` layers of nodes past those that their cells touch, as those of
    /// [`Grid::reaching`](bsmpm::grid::Grid::reaching) do.
    pub fn reaching(self, beyond: usize) -> Self {
        Self { beyond, ..self }
    }

    /// Columns at which they begin, and the number of columns last.
    pub fn bounds(&self) -> &[usize] {
        &self.bounds
    }

    /// Number of slabs.
    pub fn ranks(&self) -> usize {
        self.bounds.len() - 1
    }

    /// Columns of cells of a rank.
    pub fn columns(&self, rank: usize) -> Range<usize> {
        self.bounds[rank]..self.bounds[rank + 1]
    }

    /// The rank whose slab holds a column; past either end of them all, the rank there.
    pub fn owner(&self, column: usize) -> usize {
        self.bounds.partition_point(|&bound| bound <= column).clamp(1, self.ranks()) - 1
    }

    /// Node layers in the window of a rank: those that its cells touch, for splines of order `q`, and those beyond.
    pub fn layers(&self, rank: usize, q: usize) -> Range<usize> {
        let end = (self.bounds[rank + 1] + self.beyond).min(self.bounds[self.ranks()]);
        self.bounds[rank]..end + q
    }

    /// Node layers that a rank owns.
    pub fn owned_layers(&self, rank: usize, q: usize) -> Range<usize> {
        let extra = if rank + 1 == self.ranks() { q } else { 0 };
        self.bounds[rank]..self.bounds[rank + 1] + extra
    }

    /// Other ranks that share node layers with `rank`, ascending, and the layers.
    pub fn shared(&self, rank: usize, q: usize) -> Vec<(usize, Range<usize>)> {
        let own = self.layers(rank, q);
        (0..self.ranks())
            .filter(|&other| other != rank)
            .map(|other| (other, intersection(&own, &self.layers(other, q))))
            .filter(|(_, layers)| !layers.is_empty())
            .collect()
    }

    /// Layers that a rank shares with another one, ascending, and which columns of either touch them.
    pub fn shared_layers(&self, (rank, other): (usize, usize), q: usize) -> Vec<SharedLayer> {
        let (first, reach) = (self.bounds[rank], q + self.beyond);
        let touching =
            |rank: usize, layer: usize| intersection(&self.columns(rank), &(layer.saturating_sub(reach)..layer + 1));
        let shared = |layer: usize| {
            let own = touching(rank, layer);
            SharedLayer {
                layer: layer - first,
                own: own.start - first..own.end - first,
                theirs: touching(other, layer).len(),
            }
        };
        intersection(&self.layers(rank, q), &self.layers(other, q)).map(shared).collect()
    }
}

/// A layer of nodes that two ranks share, as one of them sees it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SharedLayer {
    /// layer of its window
    pub layer: usize,
    /// columns of its window that touch the layer
    pub own: Range<usize>,
    /// number of columns of the other rank that do
    pub theirs: usize,
}

/// The common part of two ranges; empty if there is none.
pub fn intersection(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    let start = a.start.max(b.start);
    start..a.end.min(b.end).max(start)
}

/// First column at which each slab can begin if none costs more than `most`; `before` are the costs before each column,
/// and the whole one. `None` if there is no such cut.
fn earliest(before: &[f64], ranks: usize, most: f64) -> Option<Vec<usize>> {
    let mut first = vec![0; ranks];
    let mut end = before.len() - 1;
    for rank in (0..ranks).rev() {
        first[rank] = before.partition_point(|sum| before[end] - sum > most).max(rank);
        if first[rank] >= end {
            return None;
        }
        end = first[rank];
    }
    (end == 0).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_layer_has_one_owner_and_every_window_holds_what_it_owns() {
        for (columns, ranks, q) in [(10, 3, 2), (4, 4, 3), (7, 1, 2), (5, 4, 1)] {
            let slabs = Slabs::cut(&vec![1.0; columns], ranks).unwrap();
            let owned: Vec<usize> = (0..ranks).flat_map(|rank| slabs.owned_layers(rank, q)).collect();
            assert_eq!(owned, (0..columns + q).collect::<Vec<_>>());
            for rank in 0..ranks {
                let (own, window) = (slabs.owned_layers(rank, q), slabs.layers(rank, q));
                assert!(window.start <= own.start && own.end <= window.end);
                assert!(slabs.columns(rank).all(|column| slabs.owner(column) == rank));
            }
        }
    }

    #[test]
    fn sharing_is_mutual_also_when_slabs_are_thinner_than_the_order() {
        let slabs = Slabs::cut(&[1.0; 4], 4).unwrap();
        for rank in 0..4 {
            for (other, layers) in slabs.shared(rank, 3) {
                assert!(slabs.shared(other, 3).contains(&(rank, layers)));
            }
        }
        assert_eq!(slabs.shared(0, 3).len(), 3);
    }

    #[test]
    fn the_columns_that_touch_a_layer_are_those_of_the_ranks_that_share_it() {
        let cuts = [(vec![0, 4, 9], 2, 0), (vec![0, 1, 2, 5], 3, 0), (vec![0, 3, 4], 1, 0), (vec![0, 2, 3, 6], 2, 1)];
        for (bounds, q, beyond) in cuts {
            let (ranks, columns) = (bounds.len() - 1, bounds[bounds.len() - 1]);
            let slabs = Slabs::new(bounds, ranks, 0..columns).unwrap().reaching(beyond);
            for rank in 0..ranks {
                for layer in slabs.layers(rank, q) {
                    let touching = layer.saturating_sub(q + beyond)..layer + 1;
                    let own = intersection(&slabs.columns(rank), &touching).len();
                    let others = (0..ranks).filter(|&other| other != rank).map(|other| {
                        let layers = slabs.shared_layers((rank, other), q);
                        let shared = layers.iter().find(|shared| shared.layer + slabs.bounds[rank] == layer);
                        shared.map_or(0, |shared| shared.theirs)
                    });
                    assert_eq!(own + others.sum::<usize>(), intersection(&(0..columns), &touching).len());
                }
            }
        }
    }

    #[test]
    fn windows_that_reach_beyond_their_cells_end_with_the_grid() {
        let slabs = Slabs::new(vec![0, 2, 3, 5], 3, 0..5).unwrap().reaching(1);
        assert_eq!([0, 1, 2].map(|rank| slabs.layers(rank, 2)), [0..5, 2..6, 3..7]);
        assert_eq!([0, 1, 2].map(|rank| slabs.owned_layers(rank, 2)), [0..2, 2..3, 3..7]);
        assert_eq!(slabs.shared(0, 2), [(1, 2..5), (2, 3..5)]);
    }

    #[test]
    fn the_cut_follows_the_cost_and_leaves_no_rank_without_a_column() {
        let mut cost = vec![36.0; 80];
        cost.extend(vec![0.0; 140]);
        let slabs = Slabs::cut(&cost, 2).unwrap();
        assert_eq!(slabs.columns(0), 0..40);
        let slabs = Slabs::cut(&[0.0, 0.0, 5.0], 3).unwrap();
        assert_eq!(slabs.bounds, [0, 1, 2, 3]);
        assert_eq!(slabs.starting_at(7).bounds, [7, 8, 9, 10]);
        assert_eq!(Slabs::cut(&[1.0; 2], 3), None);
    }

    #[test]
    fn no_other_cut_has_a_smaller_largest_cost() {
        let most = |slabs: &Slabs, cost: &[f64]| {
            (0..3).map(|rank| cost[slabs.columns(rank)].iter().sum::<f64>()).fold(0.0, f64::max)
        };
        let costs = [
            [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
            [9.0, 1.0, 1.0, 7.0, 0.5, 3.0, 2.0],
            [0.0, 0.0, 4.0, 5.0, 4.0, 0.0, 1.0],
        ];
        for cost in costs {
            let found = most(&Slabs::cut(&cost, 3).unwrap(), &cost);
            for bounds in (1..6).flat_map(|first| (first + 1..7).map(move |second| vec![0, first, second, 7])) {
                assert!(found <= most(&Slabs::new(bounds, 3, 0..7).unwrap(), &cost));
            }
        }
        assert_eq!(Slabs::cut(&[1.0; 10], 4).unwrap().bounds, [0, 2, 5, 7, 10]);
    }
}
