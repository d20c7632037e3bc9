//! Vectors of the unknowns alone: what an iteration keeps of many steps follows the occupied cells, not the grid.

use crate::exact::Exact;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use std::ops::Range;

/// Terms that are summed side by side: sums one after the other would wait for each other.
const LANES: usize = 8;

/// The components without zeros by definition, packed one after the other.
#[derive(Clone, Debug)]
pub struct Unknowns {
    places: Vec<u32>,          // nodal component of each
    layers: Vec<Range<usize>>, // those of this rank's own nodes, layer by layer
}

impl Unknowns {
    /// The `free` ones among the components of the window's nodes, `D` a node.
    pub fn of<const D: usize>(free: &[bool], halo: &dyn Halo) -> Self {
        let places: Vec<u32> = (0..).zip(free).filter(|(_, free)| **free).map(|(place, _)| place).collect();
        let (owned, layer) = (halo.owned(), halo.layer_nodes() * D);
        let number = |component: usize| places.partition_point(|&place| (place as usize) < component);
        let firsts = Nodal::<D>::all(&owned).step_by(layer.max(1));
        let layers = firsts.map(|first| number(first)..number(first + layer)).collect();
        Self { places, layers }
    }

    /// The packed vector of a nodal array.
    pub fn packed(&self, nodal: &[f64]) -> Vec<f64> {
        self.places.iter().map(|&place| nodal[place as usize]).collect()
    }

    /// Puts a packed vector in the place of those components of a nodal array.
    pub fn unpack(&self, packed: &[f64], nodal: &mut [f64]) {
        self.places.iter().zip(packed).for_each(|(&place, value)| nodal[place as usize] = *value);
    }

    /// Dot product of two packed vectors over this rank's own nodes: plainly within a layer, exactly over the layers.
    pub fn dot(&self, a: &[f64], b: &[f64]) -> Exact {
        self.layers.iter().map(|layer| dot(&a[layer.clone()], &b[layer.clone()])).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut sums, (a, rest_of_a), (b, rest_of_b)) = ([0.0; LANES], a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    for (lane, (a, b)) in rest_of_a.iter().zip(rest_of_b).enumerate() {
        sums[lane] += a * b;
    }
    sums.iter().sum()
}
