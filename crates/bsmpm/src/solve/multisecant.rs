//! Quasi-Newton direction from all recent secants, theory-manual equations (T5.10), (T5.11) (Anderson, 1965; Fang and
//! Saad, 2009).

use crate::exact::Exact;
use crate::parallel::Halo;
use crate::solve::unknowns::Unknowns;
use crate::threads::{self, CHUNK};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;

/// Largest number of stored secants: older ones do not describe a plastic state that has changed.
const MOST: usize = 20;
/// Relative size of eigenvalues of the scaled products below which they are round-off: their secants are linearly
/// dependent.
const DEPENDENT: f64 = 1e-12;

/// Steps of this iteration and the changes that they caused, in packed vectors.
#[derive(Clone, Debug)]
pub struct Multisecant {
    unknowns: Unknowns,
    secants: Vec<Secant>,
    products: Vec<Vec<f64>>, // dw_i . df_j for j <= i (N m)
    last: Option<Last>,
}

#[derive(Clone, Debug)]
struct Secant {
    both: Vec<f64>, // s + dw
    df: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Last {
    s: Vec<f64>,
    w: Vec<f64>,
    f: Vec<f64>,
}

impl Multisecant {
    /// Creates an empty history.
    pub fn new(unknowns: Unknowns) -> Self {
        Self {
            unknowns,
            secants: Vec::new(),
            products: Vec::new(),
            last: None,
        }
    }

    /// Turns the nodal w = K_0^-1 f into the direction du, and returns du . f (N m). One reduction.
    pub fn correct(&mut self, nodal_w: &mut [f64], f: &[f64], halo: &dyn Halo) -> f64 {
        let w = self.unknowns.packed(nodal_w);
        let f = self.unknowns.packed(f);
        let dw = self.learn(&w, &f);
        let Products {
            right,
            both,
            mut energy,
        } = self.products(&w, &f, dw.as_deref(), halo);
        let weights = least_squares(&self.products, &right);
        weights
            .iter()
            .zip(both)
            .for_each(|(weight, both)| energy -= weight * both);
        let mut du = w.clone();
        du.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, du)| {
            for (weight, secant) in weights.iter().zip(&self.secants) {
                du.iter_mut()
                    .zip(&secant.both[chunk * CHUNK..])
                    .for_each(|(du, both)| *du -= weight * both);
            }
        });
        self.unknowns.unpack(&du, nodal_w);
        self.last = Some(Last { s: du, w, f });
        energy
    }

    /// Records the fraction of the last direction that was taken: 1 for a full step.
    pub fn took(&mut self, length: f64) {
        if let Some(last) = &mut self.last {
            last.s.iter_mut().for_each(|s| *s *= length);
        }
    }

    /// Adds the secant of the last step and removes the oldest one if there are too many. Returns the change of w.
    fn learn(&mut self, w: &[f64], f: &[f64]) -> Option<Vec<f64>> {
        let last = self.last.take()?;
        let dw: Vec<f64> = w.iter().zip(&last.w).map(|(w, before)| w - before).collect();
        let df = f.iter().zip(&last.f).map(|(f, before)| f - before).collect();
        let both = last.s.iter().zip(&dw).map(|(s, dw)| s + dw).collect();
        self.secants.push(Secant { both, df });
        if self.secants.len() > MOST {
            self.secants.remove(0);
            self.products.remove(0);
            for row in &mut self.products {
                row.remove(0);
            }
        }
        Some(dw)
    }

    /// Computes the products with the present force and completes `products` with the row of the newest secant, whose
    /// change of w is `dw`. One reduction.
    fn products(&mut self, w: &[f64], f: &[f64], dw: Option<&[f64]>, halo: &dyn Halo) -> Products {
        let Self { unknowns, secants, .. } = self;
        let count = secants.len();
        let of_secants = threads::each(count, |k| {
            let [own, right] = unknowns.dots([dw.unwrap_or_default(), w], &secants[k].df);
            let [both] = unknowns.dots([f], &secants[k].both);
            [own, right, both]
        });
        let mut sums: Vec<Exact> = of_secants.into_iter().flatten().collect();
        sums.extend(unknowns.dots([w], f));
        let sums = halo.reproducible_sum(&sums);
        // Secant k has three sums: dw . df_k (the row of the newest secant), df_k . w, and (s_k + dw_k) . f.
        let every_third = |from: usize| sums[..3 * count].iter().skip(from).step_by(3).copied().collect();
        if count > 0 {
            self.products.push(every_third(0));
        }
        Products {
            right: every_third(1),
            both: every_third(2),
            energy: sums[3 * count],
        }
    }
}

/// Products of the secants with the force f (N m).
struct Products {
    right: Vec<f64>, // df_j . w
    both: Vec<f64>,  // (s_j + dw_j) . f
    energy: f64,     // w . f
}

/// Solves the symmetric system of the products (lower triangle by rows) in the subspace of independent secants.
fn least_squares(products: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let size = right.len();
    let unit = unit(products);
    if unit == 0.0 {
        return vec![0.0; size];
    }
    let scale = (0..size).map(|i| (products[i][i] / unit).abs().sqrt());
    let inverse: Vec<f64> = scale.map(|scale| if scale > 0.0 { 1.0 / scale } else { 0.0 }).collect();
    let matrix = DMatrix::from_fn(size, size, |i, j| {
        products[i.max(j)][i.min(j)] / unit * inverse[i] * inverse[j]
    });
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return vec![0.0; size];
    }
    let SymmetricEigen {
        eigenvectors,
        eigenvalues,
    } = SymmetricEigen::new(matrix);
    let mut along = eigenvectors.tr_mul(&DVector::from_fn(size, |i, _| right[i] / unit * inverse[i]));
    let least = DEPENDENT * eigenvalues.amax();
    for (component, value) in along.iter_mut().zip(&eigenvalues) {
        *component = if *value > least { *component / value } else { 0.0 };
    }
    (eigenvectors * along)
        .iter()
        .zip(inverse)
        .map(|(weight, inverse)| weight * inverse)
        .collect()
}

/// Returns the power of two of the largest diagonal product (N m). Division by it makes results bitwise independent of
/// units that differ by powers of two, although square roots are rounded.
fn unit(products: &[Vec<f64>]) -> f64 {
    let largest = products
        .iter()
        .enumerate()
        .map(|(i, row)| row[i].abs())
        .fold(0.0, f64::max);
    f64::from_bits(largest.to_bits() & f64::INFINITY.to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_units_of_energy_change_no_bit_of_the_weights() {
        let products = [vec![4.3], vec![1.1, 3.7], vec![0.3, -0.9, 0.11]];
        let weights = |unit: f64| {
            let scaled: Vec<Vec<f64>> = products
                .iter()
                .map(|row| row.iter().map(|p| p * unit).collect())
                .collect();
            least_squares(&scaled, &[1.3 * unit, 0.7 * unit, -0.2 * unit])
        };
        let reference = weights(1.0);
        for power in [-31, -10, 1, 7, 40] {
            assert_eq!(weights(2.0_f64.powi(power)), reference);
        }
    }

    #[test]
    fn a_secant_that_repeats_another_does_no_harm() {
        let weights = least_squares(&[vec![4.0], vec![4.0, 4.0]], &[2.0, 2.0]);
        assert!((weights[0] + weights[1] - 0.5).abs() < 1e-14, "{weights:?}");
    }

    #[test]
    fn independent_secants_solve_the_system() {
        let weights = least_squares(&[vec![4.0], vec![1.0, 3.0]], &[1.0, 2.0]);
        assert!((4.0 * weights[0] + weights[1] - 1.0).abs() < 1e-14);
        assert!((weights[0] + 3.0 * weights[1] - 2.0).abs() < 1e-14);
    }
}
