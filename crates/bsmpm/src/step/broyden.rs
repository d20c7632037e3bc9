//! Steps (6), (7): Broyden's quasi-Newton direction in product form, one solve with K_0 per iteration.
//!
//! H_{k+1} = (I + z_k s_k^T / s_k.s_k) H_k, where s is the step that was taken and a the part of the direction that it
//! is: the printed update K+ = K - f s^T / s.s holds for full steps, in general it is
//! K+ = K + ((1-a) f_old - f_new) s^T / s.s.

use crate::error::SolveError;
use crate::seam::{Halo, LinearSolver, dots};
use crate::step::quasi_newton::Direction;

/// Denominator 1 - a g below which the update is nearly singular and the history is dropped.
const SINGULAR: f64 = 0.1;

/// Steps taken so far in this load step, with what the product form needs of them.
#[derive(Clone, Debug, Default)]
pub struct Broyden {
    steps: Vec<Step>,
    length: f64,         // of the last direction
    gram: Vec<Vec<f64>>, // s_j . z_i for i < j
}

#[derive(Clone, Debug)]
struct Step {
    s: Vec<f64>,
    s_squared: f64,
    z: Vec<f64>, // empty for the last direction, whose z follows from the next solve
}

impl Broyden {
    /// Direction du = H f for the out-of-balance force `f`, `D` components a node.
    pub fn direction<const D: usize>(
        &mut self,
        f: &[f64],
        halo: &dyn Halo,
        solver: &mut dyn LinearSolver,
    ) -> Result<Direction, SolveError> {
        let mut w = vec![0.0; f.len()];
        let linear_iterations = solver.solve(f, &mut w)?;
        let du = self.correct::<D>(w, halo);
        let numbers = dots(halo, D, &[(&du, f), (&du, &du)]);
        self.steps.push(Step { s: du.clone(), s_squared: numbers[1], z: Vec::new() });
        Ok(Direction { du, energy: numbers[0].abs(), linear_iterations })
    }

    /// Tells how much of the last direction was taken: 1 for a full step.
    pub fn took(&mut self, length: f64) {
        self.length = length;
        if let Some(last) = self.steps.last_mut() {
            last.s.iter_mut().for_each(|s| *s *= length);
            last.s_squared *= length * length;
        }
    }

    /// Applies the product form to w = K_0^-1 f; completes the last step's z. All dots come from one reduction.
    fn correct<const D: usize>(&mut self, mut w: Vec<f64>, halo: &dyn Halo) -> Vec<f64> {
        let Some(last) = self.steps.len().checked_sub(1) else { return w };
        let s = &self.steps[last].s;
        let with_w = self.steps.iter().map(|step| (step.s.as_slice(), w.as_slice()));
        let with_z = self.steps[..last].iter().map(|step| (s.as_slice(), step.z.as_slice()));
        let pairs: Vec<_> = with_w.chain(with_z).collect();
        let mut sums = dots(halo, D, &pairs);
        self.gram.push(sums.split_off(last + 1));
        let mut coefficients: Vec<f64> = Vec::with_capacity(last + 1);
        for (j, step) in self.steps.iter().enumerate() {
            let through: f64 = coefficients.iter().zip(&self.gram[j]).map(|(c, g)| c * g).sum();
            coefficients.push((sums[j] + through) / step.s_squared);
        }
        let (a, g) = (self.length, coefficients[last]);
        let denominator = 1.0 - a * g;
        if !(denominator.abs() >= SINGULAR && denominator.is_finite()) {
            *self = Self::default();
            return w;
        }
        for (coefficient, step) in coefficients.iter().zip(&self.steps[..last]) {
            axpy(*coefficient, &step.z, &mut w);
        }
        let s = &self.steps[last].s;
        for (w, s) in w.iter_mut().zip(s) {
            *w = (*w - (1.0 - a) * g * s) / denominator;
        }
        let z = w.iter().zip(s).map(|(du, s)| a * du - (1.0 - a) * s).collect();
        self.steps[last].z = z;
        w
    }
}

fn axpy(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
