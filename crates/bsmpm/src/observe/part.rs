//! Selects the material points over which a history quantity is evaluated.

use crate::points::Points;
use std::ops::Range;

/// Subset of the material points.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Part {
    /// All points.
    #[default]
    Whole,
    /// Points with the number of a material.
    Material(u16),
    /// Points with these ids: a body.
    Ids(Range<u64>),
    /// Points of another part that are now between two corners (m, from the grid's lower corner), sides included.
    Within(Box<Part>, [[f64; 3]; 2]),
}

impl Part {
    /// Returns whether a point belongs to the part.
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

    /// Iterates over the points of the part.
    pub fn of<'a, const D: usize>(&'a self, points: &'a Points<D>) -> impl Iterator<Item = usize> + Clone + 'a {
        (0..points.len()).filter(|&p| self.holds(points, p))
    }
}
