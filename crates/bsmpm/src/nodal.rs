//! Layout of arrays of nodal values: node by node, `C` numbers per node.

use std::ops::Range;

/// The order of nodal arrays with `C` numbers a node.
#[derive(Clone, Copy, Debug)]
pub struct Nodal<const C: usize>;

impl<const C: usize> Nodal<C> {
    /// Place of the number `component` of a node.
    #[inline]
    pub fn at(node: usize, component: usize) -> usize {
        node * C + component
    }

    /// Places of all numbers of a node.
    #[inline]
    pub fn of(node: usize) -> Range<usize> {
        node * C..node * C + C
    }

    /// Places of all numbers of some nodes.
    #[inline]
    pub fn all(nodes: &Range<usize>) -> Range<usize> {
        nodes.start * C..nodes.end * C
    }

    /// The node whose number stands at a place.
    #[inline]
    pub fn node(place: usize) -> usize {
        place / C
    }

    /// The node whose number stands at a place, and which of its numbers it is.
    #[inline]
    pub fn split(place: usize) -> (usize, usize) {
        (place / C, place % C)
    }
}
