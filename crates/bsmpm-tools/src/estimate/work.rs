//! Combines the work of a run into one number.

use serde::Serialize;

/// Evaluations of the forces, with their solve, that a step costs besides those that it makes: mapping, assembly,
/// factorisation, saving. Fitted, as what follows, to the processor seconds of the shipped short cases.
const STEP: f64 = 4.0;
/// The same of a product with the complete derivative.
const PRODUCT: f64 = 0.6;
/// The same of an iteration of Newton's method: its matrix and its factorisation by PETSc.
const NEWTON: f64 = 10.0;

/// What was counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct Effort {
    /// accepted steps
    pub steps: f64,
    /// evaluations of the out-of-balance force
    pub evaluations: f64,
    /// products with the complete derivative
    pub products: f64,
    /// iterations of Newton's method
    pub newton: f64,
}

impl Effort {
    /// All of it, in evaluations.
    pub fn units(&self) -> f64 {
        STEP * self.steps + self.iterations()
    }

    /// That of the iterations.
    pub fn iterations(&self) -> f64 {
        self.evaluations + PRODUCT * self.products + NEWTON * self.newton
    }

    /// Part of that which Newton's method took.
    pub fn newton_part(&self) -> f64 {
        (self.iterations() - self.evaluations) / self.iterations().max(1.0)
    }

    /// This work and another one.
    pub fn with(&self, other: &Self) -> Self {
        Self {
            steps: self.steps + other.steps,
            evaluations: self.evaluations + other.evaluations,
            products: self.products + other.products,
            newton: self.newton + other.newton,
        }
    }

    /// So many times the iterations, in as many steps.
    pub fn grown(&self, factor: f64) -> Self {
        Self {
            evaluations: factor * self.evaluations,
            products: factor * self.products,
            newton: factor * self.newton,
            ..*self
        }
    }

    /// So many times everything.
    pub fn times(&self, factor: f64) -> Self {
        Self {
            steps: factor * self.steps,
            ..self.grown(factor)
        }
    }
}
