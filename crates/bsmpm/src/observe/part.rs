//! Selects the material points over which a history quantity is evaluated.

use crate::points::Points;
use std::ops::Range;

/// A part of all points.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Part {
    /// All of them.
    #[default]
    Whole,
    /// Those that carry the number of a material.
    Material(u16),
    /// Those with these ids: a body.
    Ids(Range<u64>),
    /// Those of a part that are between two corners now, m from the grid's lower corner; a point at a side is.
    Within(Box<Part>, [[f64; 3]; 2]),
}

impl Part {
    /// Whether a point is of the part.
    #[inline]
    pub fn holds<const D: usize>(&self, points: &Points<D>, p: usize) -> bool {
        match self {
            Self::Whole => true,
            Self::Material(number) => points.material[p] == *number,
            Self::Ids(ids) => ids.contains(&points.id[p]),
            Self::Within(of, [lower, upper]) => {
                let x = &points.x[p];
                (0..D).all(|axis| (lower[axis]..=upper[axis]).contains(&x[axis])) && of.holds(points, p)
            }
        }
    }

    /// The points of the part.
    pub fn of<'a, const D: usize>(&'a self, points: &'a Points<D>) -> impl Iterator<Item = usize> + Clone + 'a {
        (0..points.len()).filter(|&p| self.holds(points, p))
    }
}
