//! Computes the largest number of ranks that a case can use, and the division of its grid among ranks.

use crate::case::Case;
use crate::words::Support;

/// Whether slabs may be cut into parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Parting {
    /// never
    Never,
    /// where there are more ranks than columns
    Needed,
    /// so that the largest face between two ranks is the least
    LeastFace,
}

impl Parting {
    /// Parts of a slab for so many `ranks`, in a grid of so many `cells` along the two axes of which the `room` is
    /// taken up: a divisor of the number of ranks, the least of those that serve alike. `None` if there are too many
    /// ranks.
    fn parts(self, ranks: usize, cells: [usize; 2], room: [usize; 2]) -> Option<usize> {
        let most = if self == Self::Never { 1 } else { ranks };
        let fits = |parts: &usize| ranks.is_multiple_of(*parts) && ranks / parts <= cells[0] && *parts <= cells[1];
        // Faces in cells: across a part between slabs, along a slab between parts.
        let face = |parts: usize| {
            let slabs = ranks / parts;
            let across = if slabs > 1 { room[1].div_ceil(parts) } else { 0 };
            across.max(if parts > 1 { room[0].div_ceil(slabs) } else { 0 })
        };
        let mut fitting = (1..=most).filter(fits);
        let first = fitting.next()?;
        if self == Self::Needed && first == 1 {
            return Some(1);
        }
        Some(fitting.fold(first, |best, parts| if face(parts) < face(best) { parts } else { best }))
    }
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
        if self.parting() == Parting::Never {
            columns
        } else {
            columns * rows
        }
    }

    fn parting(&self) -> Parting {
        let free_field = |faces: &[Support; 2]| faces.contains(&Support::FreeField);
        match self.grid.dims() {
            _ if self.boundary.iter().any(free_field) => Parting::Never,
            3 => Parting::LeastFace,
            _ => Parting::Needed,
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
        let parts = |parting: Parting, ranks: usize| parting.parts(ranks, [40, 40], [20, 20]);
        assert_eq!(
            [1, 2, 3, 4, 6, 16].map(|ranks| parts(Parting::LeastFace, ranks)),
            [1, 1, 1, 2, 2, 4].map(Some)
        );
        assert_eq!([1, 4, 40].map(|ranks| parts(Parting::Needed, ranks)), [Some(1); 3]);
        assert_eq!((parts(Parting::Needed, 42), parts(Parting::Never, 42)), (Some(6), None));
        assert_eq!(parts(Parting::Needed, 41), None, "a prime number");
        assert_eq!(
            Parting::LeastFace.parts(4, [40, 2], [40, 2]),
            Some(1),
            "slabs of a long body"
        );
        assert_eq!(
            Parting::LeastFace.parts(2, [40, 40], [10, 30]),
            Some(2),
            "slabs along the other axis"
        );
        assert_eq!(Parting::Needed.parts(8, [4, 3], [4, 3]), Some(2));
    }
}
