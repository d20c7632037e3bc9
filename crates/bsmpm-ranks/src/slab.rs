//! Divides the grid into slabs along the first axis, and each slab into parts along the second axis, for the ranks.
//!
//! A rank owns its columns of cells and the node layers that begin in these columns. It also stores the next q node
//! layers (q: degree), which are ghost nodes (except on the last rank).

use std::ops::Range;

/// Bisections of the interval that contains the smallest possible maximum cost, down to the last bit of a float.
const BISECTIONS: usize = 60;

/// Partition of the columns into slabs, and optionally of each slab into parts. The parts of a slab belong to
/// consecutive ranks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slabs {
    bounds: Vec<usize>,     // first columns of the slabs, and the end of the last
    parts: Vec<Vec<usize>>, // the same for the rows of each slab; empty if a slab is one rank's
    beyond: usize,          // additional node layers of a window
}

/// Box of nodes: ranges along the two partitioned axes (layers, and rows in them).
pub type NodeBox = [Range<usize>; 2];

impl Slabs {
    /// Partitions columns with the given costs into `ranks` slabs of at least one column. The largest cost of a slab is
    /// as small as possible; within that, the bounds are near equal shares. `None` if there are fewer columns than
    /// ranks.
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
        let mut low = 0.0;
        let mut high = total;
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
            // A column goes to the slab that contains more than half of it.
            let fair = middle.partition_point(|sum| *sum < wanted);
            let least = first[rank].max(start + 1);
            bounds.push(fair.clamp(least, reach.min(cost.len() - (ranks - rank)).max(least)));
        }
        bounds.push(cost.len());
        Some(Self {
            bounds,
            parts: Vec::new(),
            beyond: 0,
        })
    }

    /// Creates slabs from their first columns and the end of the last. Returns `None` unless there is one non-empty
    /// slab per rank and together they are the `columns` of the active domain.
    pub fn new(bounds: Vec<usize>, ranks: usize, columns: Range<usize>) -> Option<Self> {
        let whole = bounds.len() == ranks + 1 && bounds[0] == columns.start && bounds[ranks] == columns.end;
        (whole && bounds.is_sorted_by(|a, b| a < b)).then_some(Self {
            bounds,
            parts: Vec::new(),
            beyond: 0,
        })
    }

    /// Returns the same slabs with all columns shifted by `first`.
    pub fn starting_at(self, first: usize) -> Self {
        Self {
            bounds: self.bounds.iter().map(|bound| bound + first).collect(),
            ..self
        }
    }

    /// Returns the same slabs, whose windows have `beyond` more layers of nodes than their cells touch, as in
    /// [`Grid::reaching`](bsmpm::grid::Grid::reaching).
    pub fn reaching(self, beyond: usize) -> Self {
        Self { beyond, ..self }
    }

    /// Returns the same slabs, each divided into parts. `parts` has for each slab the first rows of its parts and the
    /// end of the last. Returns `None` unless all slabs have the same number of non-empty parts, more than one, that
    /// together are the `rows` of the active domain.
    pub fn parted(self, parts: Vec<Vec<usize>>, rows: &Range<usize>) -> Option<Self> {
        let count = parts.first().map_or(0, Vec::len);
        let is_good = parts.len() + 1 == self.bounds.len() && count > 1;
        let are_whole = parts.iter().all(|part| {
            let is_whole = part.first() == Some(&rows.start) && part.last() == Some(&rows.end);
            part.len() == count && part.is_sorted_by(|a, b| a < b) && is_whole
        });
        (is_good && are_whole).then_some(Self { parts, ..self })
    }

    /// Returns the first columns of the slabs, and the end of the last.
    pub fn bounds(&self) -> &[usize] {
        &self.bounds
    }

    /// Returns for each slab the first rows of its parts and the end of the last; empty if each slab belongs to one
    /// rank.
    pub fn parts(&self) -> &[Vec<usize>] {
        &self.parts
    }

    /// Returns the number of slabs.
    pub fn slabs(&self) -> usize {
        self.bounds.len() - 1
    }

    /// Returns the number of parts of each slab.
    pub fn parts_of_slab(&self) -> usize {
        self.parts.first().map_or(1, |part| part.len() - 1)
    }

    /// Returns the number of ranks: the parts of all slabs.
    pub fn ranks(&self) -> usize {
        self.slabs() * self.parts_of_slab()
    }

    /// Returns the slab of a rank, and the index of its part in the slab.
    pub fn place(&self, rank: usize) -> (usize, usize) {
        (rank / self.parts_of_slab(), rank % self.parts_of_slab())
    }

    /// Returns the columns of cells of a rank.
    pub fn columns(&self, rank: usize) -> Range<usize> {
        let slab = self.place(rank).0;
        self.bounds[slab]..self.bounds[slab + 1]
    }

    /// Returns the cells of a rank along each axis, within the active domain `room`.
    pub fn cells<const D: usize>(&self, rank: usize, room: &[Range<usize>; D]) -> [Range<usize>; D] {
        let (slab, part) = self.place(rank);
        let mut cells = room.clone();
        cells[0] = self.columns(rank);
        if let Some(rows) = self.parts.get(slab) {
            cells[1] = rows[part]..rows[part + 1];
        }
        cells
    }

    /// Returns the rank of a cell; outside the active domain, the rank at that end.
    pub fn owner<const D: usize>(&self, cell: &[usize; D]) -> usize {
        let slab = stretch(&self.bounds, cell[0]);
        self.parts
            .get(slab)
            .map_or(slab, |rows| slab * self.parts_of_slab() + stretch(rows, cell[1]))
    }

    /// Returns the node layers in the window of a rank: those that its cells touch, for splines of degree `q`, and the
    /// additional ones.
    pub fn layers(&self, rank: usize, q: usize) -> Range<usize> {
        window(&self.bounds, self.place(rank).0, q, self.beyond)
    }

    /// Returns the node layers that a rank owns.
    pub fn owned_layers(&self, rank: usize, q: usize) -> Range<usize> {
        owned(&self.bounds, self.place(rank).0, q)
    }

    /// Returns the nodes in the window of a rank. `rows` are the rows of cells of the active domain.
    pub fn nodes(&self, rank: usize, q: usize, rows: &Range<usize>) -> NodeBox {
        let (slab, part) = self.place(rank);
        let rows = self
            .parts
            .get(slab)
            .map_or(rows.start..rows.end + q, |of| window(of, part, q, self.beyond));
        [self.layers(rank, q), rows]
    }

    /// Returns the nodes that a rank owns.
    pub fn owned(&self, rank: usize, q: usize, rows: &Range<usize>) -> NodeBox {
        let (slab, part) = self.place(rank);
        [
            self.owned_layers(rank, q),
            self.parts
                .get(slab)
                .map_or(rows.start..rows.end + q, |of| owned(of, part, q)),
        ]
    }

    /// Returns the other ranks that share nodes with `rank`, ascending, and the shared nodes.
    pub fn shared(&self, rank: usize, q: usize, rows: &Range<usize>) -> Vec<(usize, NodeBox)> {
        let own = self.nodes(rank, q, rows);
        (0..self.ranks())
            .filter(|&other| other != rank)
            .map(|other| (other, common(&own, &self.nodes(other, q, rows))))
            .filter(|(_, nodes)| !nodes.iter().any(Range::is_empty))
            .collect()
    }

    /// Returns the node layers that a rank shares with another one, ascending, with the columns of either rank that
    /// contribute to them.
    pub fn shared_layers(&self, rank: usize, other: usize, q: usize) -> Vec<SharedLayer> {
        let first = self.columns(rank).start;
        let reach = q + self.beyond;
        let mut shared = Vec::new();
        for layer in intersection(&self.layers(rank, q), &self.layers(other, q)) {
            let touching = layer.saturating_sub(reach)..layer + 1;
            let own = intersection(&self.columns(rank), &touching);
            shared.push(SharedLayer {
                layer: layer - first,
                own: own.start - first..own.end - first,
                theirs: intersection(&self.columns(other), &touching).len(),
            });
        }
        shared
    }

    /// Returns the ranks, from the first to the last one, whose window contains the node at a layer and row.
    pub fn touching(&self, [layer, row]: [usize; 2], q: usize) -> Range<usize> {
        let slabs = stretches(&self.bounds, layer, q + self.beyond);
        let first = self.touching_of_slab(slabs.start, row, q);
        let last = self.touching_of_slab(slabs.end - 1, row, q);
        first.start..last.end
    }

    /// Returns the ranks of one slab whose window contains row `row` of nodes.
    fn touching_of_slab(&self, slab: usize, row: usize, q: usize) -> Range<usize> {
        let Some(rows) = self.parts.get(slab) else {
            return slab..slab + 1;
        };
        let first = slab * self.parts_of_slab();
        let parts = stretches(rows, row, q + self.beyond);
        first + parts.start..first + parts.end
    }
}

/// Returns the index of the interval of `bounds` that contains a cell; outside, the first or the last.
fn stretch(bounds: &[usize], cell: usize) -> usize {
    bounds
        .partition_point(|&bound| bound <= cell)
        .clamp(1, bounds.len() - 1)
        - 1
}

/// Returns the intervals of `bounds` whose windows contain a node, if windows extend `reach` nodes beyond their cells.
fn stretches(bounds: &[usize], node: usize, reach: usize) -> Range<usize> {
    let last = bounds.len() - 1;
    let first = bounds[1..].partition_point(|&end| end + reach <= node).min(last - 1);
    first..bounds[..last].partition_point(|&start| start <= node).max(first + 1)
}

/// Returns the nodes along an axis in the window of an interval of cells.
fn window(bounds: &[usize], stretch: usize, q: usize, beyond: usize) -> Range<usize> {
    let end = (bounds[stretch + 1] + beyond).min(bounds[bounds.len() - 1]);
    bounds[stretch]..end + q
}

/// Returns the nodes along an axis that the rank of an interval of cells owns.
fn owned(bounds: &[usize], stretch: usize, q: usize) -> Range<usize> {
    let extra = if stretch + 2 == bounds.len() { q } else { 0 };
    bounds[stretch]..bounds[stretch + 1] + extra
}

/// Layer of nodes that two ranks share, as one of them stores it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SharedLayer {
    /// Index of the layer in this rank's window.
    pub layer: usize,
    /// Columns of this rank's window that contribute to the layer.
    pub own: Range<usize>,
    /// Number of columns of the other rank that contribute to the layer.
    pub theirs: usize,
}

/// Returns the intersection of two ranges; empty if there is none.
pub fn intersection(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    let start = a.start.max(b.start);
    start..a.end.min(b.end).max(start)
}

/// Returns the intersection of two boxes; without nodes if there is none.
pub fn common(a: &NodeBox, b: &NodeBox) -> NodeBox {
    std::array::from_fn(|axis| intersection(&a[axis], &b[axis]))
}

/// Returns the first column at which each slab can begin if no slab costs more than `most`; `None` if that is
/// impossible. `before` has the costs before each column, and the total.
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
                let own = slabs.owned_layers(rank, q);
                let window = slabs.layers(rank, q);
                assert!(window.start <= own.start && own.end <= window.end);
                assert!(slabs.columns(rank).all(|column| slabs.owner(&[column]) == rank));
            }
        }
    }

    #[test]
    fn sharing_is_mutual_also_when_slabs_are_thinner_than_the_order() {
        let slabs = Slabs::cut(&[1.0; 4], 4).unwrap();
        for rank in 0..4 {
            for (other, nodes) in slabs.shared(rank, 3, &(0..5)) {
                assert!(slabs.shared(other, 3, &(0..5)).contains(&(rank, nodes)));
            }
        }
        assert_eq!(slabs.shared(0, 3, &(0..5)).len(), 3);
    }

    #[test]
    fn the_columns_that_touch_a_layer_are_those_of_the_ranks_that_share_it() {
        let cuts = [
            (vec![0, 4, 9], 2, 0),
            (vec![0, 1, 2, 5], 3, 0),
            (vec![0, 3, 4], 1, 0),
            (vec![0, 2, 3, 6], 2, 1),
        ];
        for (bounds, q, beyond) in cuts {
            let ranks = bounds.len() - 1;
            let columns = bounds[bounds.len() - 1];
            let slabs = Slabs::new(bounds, ranks, 0..columns).unwrap().reaching(beyond);
            for rank in 0..ranks {
                for layer in slabs.layers(rank, q) {
                    let touching = layer.saturating_sub(q + beyond)..layer + 1;
                    let own = intersection(&slabs.columns(rank), &touching).len();
                    let others = (0..ranks).filter(|&other| other != rank).map(|other| {
                        let layers = slabs.shared_layers(rank, other, q);
                        let shared = layers.iter().find(|shared| shared.layer + slabs.bounds[rank] == layer);
                        shared.map_or(0, |shared| shared.theirs)
                    });
                    assert_eq!(
                        own + others.sum::<usize>(),
                        intersection(&(0..columns), &touching).len()
                    );
                }
            }
        }
    }

    #[test]
    fn windows_that_reach_beyond_their_cells_end_with_the_grid() {
        let slabs = Slabs::new(vec![0, 2, 3, 5], 3, 0..5).unwrap().reaching(1);
        assert_eq!([0, 1, 2].map(|rank| slabs.layers(rank, 2)), [0..5, 2..6, 3..7]);
        assert_eq!([0, 1, 2].map(|rank| slabs.owned_layers(rank, 2)), [0..2, 2..3, 3..7]);
        assert_eq!(slabs.shared(0, 2, &(0..1)), [(1, [2..5, 0..3]), (2, [3..5, 0..3])]);
    }

    /// Three slabs of three parts each, of even and of thin ones, none of which lie side by side.
    fn parted(beyond: usize) -> Slabs {
        let slabs = Slabs::new(vec![2, 6, 7, 11], 3, 2..11).unwrap().reaching(beyond);
        slabs
            .parted(vec![vec![1, 4, 7, 10], vec![1, 2, 3, 10], vec![1, 6, 9, 10]], &(1..10))
            .unwrap()
    }

    #[test]
    fn every_node_and_cell_has_one_owner_whose_window_has_it_and_neighbours_agree_on_what_they_share() {
        for (q, beyond) in [(1, 0), (2, 0), (2, 3), (3, 1)] {
            let slabs = parted(beyond);
            let rows = 1..10;
            let windows: Vec<NodeBox> = (0..9).map(|rank| slabs.nodes(rank, q, &rows)).collect();
            let holds = |nodes: &NodeBox, at: [usize; 2]| (0..2).all(|axis| nodes[axis].contains(&at[axis]));
            for at in (2..11 + q).flat_map(|layer| (1..10 + q).map(move |row| [layer, row])) {
                let owners: Vec<usize> = (0..9).filter(|&rank| holds(&slabs.owned(rank, q, &rows), at)).collect();
                assert!(
                    owners.len() == 1 && holds(&windows[owners[0]], at),
                    "{at:?}: {owners:?}"
                );
                let seen: Vec<usize> = (0..9).filter(|&rank| holds(&windows[rank], at)).collect();
                let touching = slabs.touching(at, q);
                assert_eq!(
                    [touching.start, touching.end - 1],
                    [seen[0], seen[seen.len() - 1]],
                    "{at:?}"
                );
                if at[0] < 11 && at[1] < 10 {
                    assert_eq!(slabs.owner(&at), owners[0]);
                }
            }
            for rank in 0..9 {
                let [columns, rows_of] = slabs.cells(rank, &[2..11, 1..10]);
                assert!(
                    columns
                        .clone()
                        .all(|i| rows_of.clone().all(|j| slabs.owner(&[i, j]) == rank))
                );
                for (other, nodes) in slabs.shared(rank, q, &rows) {
                    assert!(slabs.shared(other, q, &rows).contains(&(rank, nodes)));
                }
            }
        }
    }

    #[test]
    fn a_cut_that_leaves_parts_without_cells_or_rows_without_a_part_is_none() {
        let slabs = || Slabs::new(vec![0, 3, 5], 2, 0..5).unwrap();
        assert!(slabs().parted(vec![vec![0, 2, 4], vec![0, 1, 4]], &(0..4)).is_some());
        for parts in [
            vec![vec![0, 2, 4]],
            vec![vec![0, 2, 4], vec![0, 4]],
            vec![vec![0, 2, 4], vec![0, 0, 4]],
        ] {
            assert!(slabs().parted(parts, &(0..4)).is_none());
        }
        assert!(slabs().parted(vec![vec![0, 2, 4], vec![0, 1, 3]], &(0..4)).is_none());
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
            (0..3)
                .map(|rank| cost[slabs.columns(rank)].iter().sum::<f64>())
                .fold(0.0, f64::max)
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
