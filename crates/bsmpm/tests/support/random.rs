//! Reproducible random numbers (xorshift64*), seeded by the test.

use bsmpm::tensor::{Square, Vector};

/// A stream of numbers.
pub struct Random(u64);

impl Random {
    /// A stream of its own for every `seed`.
    pub fn new(seed: u64) -> Self {
        let mut stream = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        for _ in 0..8 {
            stream.unit();
        }
        stream
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// `n` numbers in [-1, 1).
    pub fn array(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.signed()).collect()
    }

    /// A vector with components in [-1, 1).
    pub fn vector<const D: usize>(&mut self) -> Vector<D> {
        Vector::from_fn(|_, _| self.signed())
    }

    /// A matrix with entries in [-1, 1).
    pub fn square<const D: usize>(&mut self) -> Square<D> {
        Square::from_fn(|_, _| self.signed())
    }
}
