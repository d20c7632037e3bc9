//! Packed vectors of the unknowns only.

use crate::exact::Exact;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use std::ops::Range;

/// Terms that are summed in parallel lanes. Within one sum, each addition waits for the one before.
const LANES: usize = 8;

/// Packed vectors of the unknowns: components that are zero by definition are left out.
#[derive(Clone, Debug)]
pub struct Unknowns {
    places: Vec<u32>,          // nodal component of each; a second field follows displacements
    layers: Vec<Range<usize>>, // unknowns of this rank's own nodes, by layer
}

impl Unknowns {
    /// Packs the `free` components of the window's nodes, `D` per node.
    pub fn of<const D: usize>(free: &[bool], halo: &dyn Halo) -> Self {
        let places: Vec<u32> = (0..)
            .zip(free)
            .filter(|(_, free)| **free)
            .map(|(place, _)| place)
            .collect();
        let number = |component: usize| places.partition_point(|&place| (place as usize) < component);
        let layers = halo.owned().runs().map(|run| Nodal::<D>::all(&run));
        let layers = layers.map(|layer| number(layer.start)..number(layer.end)).collect();
        Self { places, layers }
    }

    /// Appends the `free` values of a second field, one per node. In nodal arrays they follow the `components`
    /// displacements.
    pub fn with_field(mut self, components: usize, free: &[bool], halo: &dyn Halo) -> Self {
        let field = Self::of::<1>(free, halo);
        let before = self.places.len();
        self.places
            .extend(field.places.iter().map(|place| place + components as u32));
        self.layers.extend(
            field
                .layers
                .iter()
                .map(|layer| layer.start + before..layer.end + before),
        );
        self
    }

    /// Returns the packed vector of a nodal array.
    pub fn packed(&self, nodal: &[f64]) -> Vec<f64> {
        self.places.iter().map(|&place| nodal[place as usize]).collect()
    }

    /// Copies a packed vector into the corresponding components of a nodal array.
    pub fn unpack(&self, packed: &[f64], nodal: &mut [f64]) {
        self.places
            .iter()
            .zip(packed)
            .for_each(|(&place, value)| nodal[place as usize] = *value);
    }

    /// Returns dot products of packed vectors with `a` over this rank's own nodes: rounded within a layer, exact over
    /// the layers.
    pub fn dots<const M: usize>(&self, with: [&[f64]; M], a: &[f64]) -> [Exact; M] {
        let mut sums = [Exact::ZERO; M];
        for layer in &self.layers {
            let of_layer = dots(with.map(|b| &b[layer.clone()]), &a[layer.clone()]);
            sums.iter_mut()
                .zip(of_layer)
                .for_each(|(sum, of_layer)| sum.add(of_layer));
        }
        sums
    }
}

/// Computes several dot products at a time, since reading the stored vectors from memory dominates the cost.
fn dots<const M: usize>(with: [&[f64]; M], a: &[f64]) -> [f64; M] {
    let mut sums = [[0.0; LANES]; M];
    let (eights, rest) = a.as_chunks::<LANES>();
    let with = with.map(|b| b.as_chunks::<LANES>());
    for (k, a) in eights.iter().enumerate() {
        for (sums, (b, _)) in sums.iter_mut().zip(with) {
            (0..LANES).for_each(|lane| sums[lane] += a[lane] * b[k][lane]);
        }
    }
    for (sums, (_, b)) in sums.iter_mut().zip(with) {
        rest.iter().zip(b).zip(sums).for_each(|((a, b), sum)| *sum += a * b);
    }
    sums.map(|sums| sums.iter().sum())
}
