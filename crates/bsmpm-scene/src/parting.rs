//! Computes the largest number of ranks that a case can use, and the division of its grid among ranks.

use crate::case::Case;
use crate::words::Support;

/// Whether slabs may be cut into parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PartingRule {
    /// never
    Never,
    /// where there are more ranks than columns
    Needed,
    /// so that the largest face between two ranks is the least
    LeastFace,
}

impl PartingRule {
    /// Parts of a slab for so many `ranks`, in a grid of so many `cells` along the two axes of which the `room` is
    /// taken up: a divisor of the number of ranks, the least of those that serve alike. `None` if there are too many
    /// ranks.
    fn parts(self, ranks: usize, cells: [usize; 2], room: [usize; 2]) -> Option<usize> {
        let most = if self == Self::Never { 1 } else { ranks };
        let mut fitting =
            (1..=most).filter(|parts| ranks.is_multiple_of(*parts) && ranks / parts <= cells[0] && *parts <= cells[1]);
        let first = fitting.next()?;
        if self == Self::Needed && first == 1 {
            return Some(1);
        }
        Some(fitting.fold(first, |best, parts| {
            let is_less = largest_face(ranks, parts, room) < largest_face(ranks, best, room);
            if is_less { parts } else { best }
        }))
    }
}

/// Cells of the larger face that `parts` of a slab have: across a part between slabs, or along a slab between parts.
fn largest_face(ranks: usize, parts: usize, room: [usize; 2]) -> usize {
    let slabs = ranks / parts;
    let across = if slabs > 1 { room[1].div_ceil(parts) } else { 0 };
    across.max(if parts > 1 { room[0].div_ceil(slabs) } else { 0 })
}

impl Case {
    /// Parts along y into which slabs of columns are cut for so many ranks, in a `room` of so many cells along x and y.
    /// Of a solid the least largest face decides; in a plane there is one, unless there are more ranks than columns.
    /// `None` if there are too many ranks, or more than columns beside a free field, whose faces are one rank's each.
    pub fn parts(&self, ranks: usize, room: [usize; 2]) -> Option<usize> {
        self.parting().parts(ranks, self.columns_and_rows(), room)
    }

    /// The most ranks that the case can have; not every number below has two divisors that fit, see [`Case::parts`].
    pub fn most_ranks(&self) -> usize {
        let [columns, rows] = self.columns_and_rows();
        if self.parting() == PartingRule::Never {
            columns
        } else {
            columns * rows
        }
    }

    fn parting(&self) -> PartingRule {
        match self.grid.dims() {
            _ if self.boundary.as_flattened().contains(&Support::FreeField) => PartingRule::Never,
            3 => PartingRule::LeastFace,
            _ => PartingRule::Needed,
        }
    }

    fn columns_and_rows(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.grid.spans(axis))
    }

    /// Why so many ranks are refused.
    pub fn too_many(&self, ranks: usize) -> String {
        let [columns, rows] = self.columns_and_rows();
        format!(
            "E0850: the grid has {columns} columns of {rows} cells, too few for {ranks} ranks. Use at most {columns} ranks, or \
             m x n ranks with m up to {columns} and n up to {rows}."
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_the_largest_face_least_or_more_ranks_possible() {
        let parts = |parting: PartingRule, ranks: usize| parting.parts(ranks, [40, 40], [20, 20]);
        assert_eq!(
            [1, 2, 3, 4, 6, 16].map(|ranks| parts(PartingRule::LeastFace, ranks)),
            [1, 1, 1, 2, 2, 4].map(Some)
        );
        assert_eq!([1, 4, 40].map(|ranks| parts(PartingRule::Needed, ranks)), [Some(1); 3]);
        assert_eq!(
            (parts(PartingRule::Needed, 42), parts(PartingRule::Never, 42)),
            (Some(6), None)
        );
        assert_eq!(parts(PartingRule::Needed, 41), None, "a prime number");
        assert_eq!(
            PartingRule::LeastFace.parts(4, [40, 2], [40, 2]),
            Some(1),
            "slabs of a long body"
        );
        assert_eq!(
            PartingRule::LeastFace.parts(2, [40, 40], [10, 30]),
            Some(2),
            "slabs along the other axis"
        );
        assert_eq!(PartingRule::Needed.parts(8, [4, 3], [4, 3]), Some(2));
    }
}
