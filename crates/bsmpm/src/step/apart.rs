//! Finds nodes that only one material touches, because the force criterion, theory-manual equation (T5.16), is also
//! evaluated for each material.

use crate::exact::Exact;
use crate::grid::Shape;
use crate::parallel::Halo;
use crate::points::Points;

/// Nodes that only one material touches, in a case with several materials.
#[derive(Clone, Debug)]
pub struct MaterialNodeSets {
    /// Number of materials.
    pub materials: usize,
    of: Vec<Option<u16>>, // material per node of the window
}

impl MaterialNodeSets {
    /// Finds these nodes; equal on all ranks. `None` if there is only one material. One exchange with the neighbours.
    pub fn of<const D: usize>(
        materials: usize,
        shape: &Shape<D>,
        points: &Points<D>,
        nodes: usize,
        halo: &dyn Halo,
    ) -> Option<Self> {
        if materials < 2 {
            return None;
        }
        // Per node, the largest number of a material and the largest negative number, whose magnitude is the smallest
        // number.
        let mut ends = vec![f64::NEG_INFINITY; 2 * nodes];
        for patch in shape.patches() {
            let of = &points.material[patch.points.clone()];
            let Some((&least, &most)) = of.iter().min().zip(of.iter().max()) else {
                continue;
            };
            for offset in shape.offsets() {
                let ends = &mut ends[2 * (patch.first_node + offset)..][..2];
                (ends[0], ends[1]) = (ends[0].max(f64::from(most)), ends[1].max(-f64::from(least)));
            }
        }
        halo.ghost_max(&mut ends, 2);
        let of = ends
            .chunks_exact(2)
            .map(|ends| (ends[0] == -ends[1]).then_some(ends[0] as u16))
            .collect();
        Some(Self { materials, of })
    }

    /// Sums `terms` for each material over the components of this rank's own nodes that only this material touches,
    /// `width` per node. The N sums of a material are consecutive. Rounded like
    /// [`over_layers`](crate::parallel::over_layers).
    pub fn sums<const N: usize>(&self, halo: &dyn Halo, width: usize, terms: impl Fn(usize) -> [f64; N]) -> Vec<Exact> {
        let mut sums = vec![Exact::ZERO; self.materials * N];
        for run in halo.owned().runs() {
            let mut plain = vec![[0.0; N]; self.materials];
            for node in run {
                let Some(material) = self.of[node] else { continue };
                for c in node * width..(node + 1) * width {
                    plain[usize::from(material)]
                        .iter_mut()
                        .zip(terms(c))
                        .for_each(|(sum, term)| *sum += term);
                }
            }
            sums.iter_mut()
                .zip(plain.iter().flatten())
                .for_each(|(sum, plain)| sum.add(*plain));
        }
        sums
    }
}
