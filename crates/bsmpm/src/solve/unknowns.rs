//! Packed vectors of the unknowns only.

use crate::exact::Exact;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use std::ops::Range;

/// Terms that are summed side by side: sums one after the other would wait for each other.
const LANES: usize = 8;

/// The components without zeros by definition, packed one after the other.
#[derive(Clone, Debug)]
pub struct Unknowns {
    places: Vec<u32>,          // nodal component of each, those of pressures behind those of displacements
    layers: Vec<Range<usize>>, // those of this rank's own nodes, layer by layer
}

impl Unknowns {
    /// The `free` ones among the components of the window's nodes, `D` a node.
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

    /// The same with the `free` pressures of the pore water behind those `components`, one a node.
    pub fn with_pressures(mut self, components: usize, free: &[bool], halo: &dyn Halo) -> Self {
        let pressures = Self::of::<1>(free, halo);
        let before = self.places.len();
        self.places
            .extend(pressures.places.iter().map(|place| place + components as u32));
        self.layers.extend(
            pressures
                .layers
                .iter()
                .map(|layer| layer.start + before..layer.end + before),
        );
        self
    }

    /// The packed vector of a nodal array.
    pub fn packed(&self, nodal: &[f64]) -> Vec<f64> {
        self.places.iter().map(|&place| nodal[place as usize]).collect()
    }

    /// Puts a packed vector in the place of those components of a nodal array.
    pub fn unpack(&self, packed: &[f64], nodal: &mut [f64]) {
        self.places
            .iter()
            .zip(packed)
            .for_each(|(&place, value)| nodal[place as usize] = *value);
    }

    /// Dot products of packed vectors with another one over this rank's own nodes: plainly within a layer, exactly over
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

/// Several at a time, as what is kept of many steps comes from memory.
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
