//! Reproducible random trial states (generator of Knuth's MMIX).

use bsmpm::tensor::{Symmetric, Tensor};
use nalgebra::{Rotation3, Vector3};

pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in -1..1.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.unit() * of.len() as f64) as usize]
    }

    /// Principal strains, log-uniform in size between two powers of ten, with a compressive bias.
    pub fn strains(&mut self, low: f64, high: f64) -> [f64; 3] {
        let size = 10.0_f64.powf(low + (high - low) * self.unit());
        [0; 3].map(|_| size * (self.signed() - 0.2))
    }

    /// A rotation: about z for half of the calls, so that the plane path is tried as often as the general one.
    pub fn rotation(&mut self) -> Tensor {
        let angle = 3.0 * self.signed();
        let axis = if self.unit() < 0.5 {
            Vector3::new(0.0, 0.0, angle)
        } else {
            Vector3::new(angle, 3.0 * self.signed(), 3.0 * self.signed())
        };
        Rotation3::new(axis).into_inner()
    }

    /// A trial tensor of [`Random::strains`] in random axes.
    pub fn trial(&mut self, low: f64, high: f64) -> Symmetric {
        let eps = self.strains(low, high);
        super::turned(&self.rotation(), &super::stretched(eps))
    }
}
