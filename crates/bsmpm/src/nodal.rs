//! Layout of arrays of nodal values: node by node, `C` numbers per node.

use std::ops::Range;

/// Order of nodal arrays with `C` numbers per node.
#[derive(Clone, Copy, Debug)]
pub struct Nodal<const C: usize>;

impl<const C: usize> Nodal<C> {
    /// Returns the index of the number `component` of a node.
    #[inline]
    pub fn at(node: usize, component: usize) -> usize {
        node * C + component
    }

    /// Returns the indices of all numbers of a node.
    #[inline]
    pub fn of(node: usize) -> Range<usize> {
        node * C..node * C + C
    }

    /// Returns the indices of all numbers of a range of nodes.
    #[inline]
    pub fn all(nodes: &Range<usize>) -> Range<usize> {
        nodes.start * C..nodes.end * C
    }

    /// Returns the node of an index.
    #[inline]
    pub fn node(place: usize) -> usize {
        place / C
    }

    /// Returns the node of an index, and the component.
    #[inline]
    pub fn split(place: usize) -> (usize, usize) {
        (place / C, place % C)
    }
}
