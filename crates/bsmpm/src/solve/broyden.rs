//! Broyden's quasi-Newton direction in product form, theory-manual equation (T5.12); for shortened corrections (T5.13).

use crate::exact::Exact;
use crate::parallel::{Halo, local_dot};

/// Denominator 1 - a g below which the update is nearly singular and the history is discarded.
const SINGULAR: f64 = 0.1;

/// Steps after which the history is discarded; each step stores two vectors.
const MOST: usize = 100;

/// Previous steps of this load step, with their data for the product form.
#[derive(Clone, Debug, Default)]
pub struct Broyden {
    steps: Vec<Step>,
    length: f64,         // of the last direction
    gram: Vec<Vec<f64>>, // s_j . z_i for i < j
    with_w: Vec<f64>,    // s_j . w of the present direction
}

#[derive(Clone, Debug)]
struct Step {
    s: Vec<f64>,
    s_squared: f64,
    z: Vec<f64>, // empty for the last direction, whose z follows from the next solution
}

impl Broyden {
    /// Records the fraction of the last direction that was taken: 1 for a full step.
    pub fn took(&mut self, length: f64) {
        self.length = length;
        if let Some(last) = self.steps.last_mut() {
            last.s.iter_mut().for_each(|s| *s *= length);
        }
    }

    /// Returns the direction du from w = K_0^-1 f, `D` components per node. One reduction.
    pub fn correct<const D: usize>(&mut self, w: Vec<f64>, halo: &dyn Halo) -> Vec<f64> {
        let du = self.product_form::<D>(w, halo);
        self.steps.push(Step {
            s: du.clone(),
            s_squared: f64::NAN,
            z: Vec::new(),
        });
        du
    }

    /// Applies all steps to w and completes z of the last step.
    fn product_form<const D: usize>(&mut self, mut w: Vec<f64>, halo: &dyn Halo) -> Vec<f64> {
        if self.steps.len() == MOST {
            *self = Self::default();
        }
        let Some(last) = self.steps.len().checked_sub(1) else {
            return w;
        };
        self.complete_products::<D>(&w, halo);
        let coefficients = self.coefficients();
        let a = self.length;
        let g = coefficients[last];
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

    /// Computes s_j . w for all steps, and s . s and s . z_i for the last one. One reduction.
    fn complete_products<const D: usize>(&mut self, w: &[f64], halo: &dyn Halo) {
        let last = self.steps.len() - 1;
        let s = self.steps[last].s.as_slice();
        let with_w = self.steps.iter().map(|step| local_dot(halo, D, &step.s, w));
        let with_s = self.steps[..last].iter().map(|step| local_dot(halo, D, s, &step.z));
        let sums: Vec<Exact> = with_w.chain([local_dot(halo, D, s, s)]).chain(with_s).collect();
        self.with_w = halo.reproducible_sum(&sums);
        let mut of_last = self.with_w.split_off(last + 1);
        self.gram.push(of_last.split_off(1));
        self.steps[last].s_squared = of_last[0];
    }

    /// Returns c_j = s_j . w_j / s_j . s_j, where w_j is w after the steps before j.
    fn coefficients(&self) -> Vec<f64> {
        let mut coefficients: Vec<f64> = Vec::with_capacity(self.steps.len());
        for (j, step) in self.steps.iter().enumerate() {
            let through: f64 = coefficients.iter().zip(&self.gram[j]).map(|(c, g)| c * g).sum();
            coefficients.push((self.with_w[j] + through) / step.s_squared);
        }
        coefficients
    }
}

fn axpy(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
