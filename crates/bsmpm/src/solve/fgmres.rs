//! Flexible GMRES (Saad, 1993) for an operator that is given by its matrix-vector product.

use crate::error::SolveError;
use crate::exact::Exact;
use crate::linear::Krylov;
use crate::parallel::Halo;
use crate::solve::unknowns::Unknowns;

/// Largest number of products of one solution; each stores a basis vector and a direction.
pub const MOST: usize = 300;

/// Solves A x = b for packed vectors of the `unknowns` from x = 0. `product` computes A x, `precondition` approximates
/// A^-1 r. Iterates to the residual `relative` to b, or as far as possible. Three reductions per iteration.
pub fn solve(
    unknowns: &Unknowns,
    halo: &dyn Halo,
    mut product: impl FnMut(&[f64]) -> Vec<f64>,
    mut precondition: impl FnMut(&[f64]) -> Result<Vec<f64>, SolveError>,
    b: &[f64],
    relative: f64,
) -> Result<(Vec<f64>, Krylov), SolveError> {
    let norm = |a: &[f64]| halo.reproducible_sum(&unknowns.dots([a], a))[0].sqrt();
    let size = norm(b);
    if !size.is_finite() {
        return Err(SolveError::NotFinite);
    }
    if size == 0.0 {
        let krylov = Krylov {
            iterations: 0,
            residual: 0.0,
        };
        return Ok((vec![0.0; b.len()], krylov));
    }
    let mut directions: Vec<Vec<f64>> = Vec::new();
    let mut basis = vec![scaled(b, 1.0 / size)];
    let mut least = LeastSquares::new(size);
    while directions.len() < MOST && least.residual() > relative * size {
        let direction = precondition(basis.last().map_or(b, |v| v))?;
        let mut image = product(&direction);
        directions.push(direction);
        let column = orthogonalise(&basis, &mut image, unknowns, halo);
        let rest = norm(&image);
        if !rest.is_finite() {
            return Err(SolveError::NotFinite);
        }
        least.add(column, rest);
        if rest == 0.0 {
            break;
        }
        basis.push(scaled(&image, 1.0 / rest));
    }
    let mut x = vec![0.0; b.len()];
    for (direction, part) in directions.iter().zip(least.solution()) {
        x.iter_mut()
            .zip(direction)
            .for_each(|(x, direction)| *x += part * direction);
    }
    let left: Vec<f64> = b.iter().zip(product(&x)).map(|(b, image)| b - image).collect();
    let residual = norm(&left) / size;
    if !residual.is_finite() {
        return Err(SolveError::NotFinite);
    }
    let krylov = Krylov {
        iterations: directions.len(),
        residual,
    };
    Ok((x, krylov))
}

/// Removes the components along `basis` from `image` and returns them, one number per vector. Two reductions.
fn orthogonalise(basis: &[Vec<f64>], image: &mut [f64], unknowns: &Unknowns, halo: &dyn Halo) -> Vec<f64> {
    let mut column = vec![0.0; basis.len()];
    // Twice, because one pass leaves round-off for nearly parallel vectors.
    for _ in 0..2 {
        let products: Vec<Exact> = basis.iter().flat_map(|v| unknowns.dots([v], image)).collect();
        let along = halo.reproducible_sum(&products);
        for ((v, along), entry) in basis.iter().zip(&along).zip(&mut column) {
            *entry += along;
            image.iter_mut().zip(v).for_each(|(image, v)| *image -= along * v);
        }
    }
    column
}

fn scaled(a: &[f64], factor: f64) -> Vec<f64> {
    a.iter().map(|a| a * factor).collect()
}

/// Minimises |size e_1 - H y| for a Hessenberg matrix H that grows by columns, by Givens rotations.
struct LeastSquares {
    columns: Vec<Vec<f64>>, // of the triangular factor
    rotations: Vec<(f64, f64)>,
    right: Vec<f64>,
}

impl LeastSquares {
    fn new(size: f64) -> Self {
        Self {
            columns: Vec::new(),
            rotations: Vec::new(),
            right: vec![size],
        }
    }

    fn residual(&self) -> f64 {
        self.right.last().map_or(0.0, |last| last.abs())
    }

    /// Adds a column and its entry below the diagonal.
    fn add(&mut self, mut column: Vec<f64>, below: f64) {
        for (k, (c, s)) in self.rotations.iter().enumerate() {
            (column[k], column[k + 1]) = (c * column[k] + s * column[k + 1], c * column[k + 1] - s * column[k]);
        }
        let last = column.len() - 1;
        let length = column[last].hypot(below);
        let (c, s) = if length > 0.0 {
            (column[last] / length, below / length)
        } else {
            (1.0, 0.0)
        };
        column[last] = length;
        let right = self.right[last];
        self.right[last] = c * right;
        self.right.push(-s * right);
        self.rotations.push((c, s));
        self.columns.push(column);
    }

    fn solution(&self) -> Vec<f64> {
        let count = self.columns.len();
        let mut y = self.right[..count].to_vec();
        for k in (0..count).rev() {
            let diagonal = self.columns[k][k];
            y[k] = if diagonal == 0.0 { 0.0 } else { y[k] / diagonal };
            let value = y[k];
            y[..k]
                .iter_mut()
                .zip(&self.columns[k])
                .for_each(|(y, entry)| *y -= value * entry);
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Alone;

    /// An unsymmetric system, preconditioned by nothing and by its diagonal.
    #[test]
    fn it_solves_an_unsymmetric_system() {
        let count = 40;
        let unknowns = Unknowns::of::<1>(&vec![true; count], &Alone { nodes: count });
        let halo = Alone { nodes: count };
        let diagonal = |i: usize| 2.0 + 10.0 * i as f64;
        let product = |x: &[f64]| -> Vec<f64> {
            let at = |i: usize| {
                let before = if i > 0 { x[i - 1] } else { 0.0 };
                let after = x.get(i + 1).unwrap_or(&0.0);
                diagonal(i) * x[i] + 3.0 * before - 1.5 * after
            };
            (0..count).map(at).collect()
        };
        let exact: Vec<f64> = (0..count).map(|i| (i as f64).sin()).collect();
        let b = product(&exact);
        let divided = |r: &[f64]| Ok(r.iter().enumerate().map(|(i, r)| r / diagonal(i)).collect());
        let by_diagonal = solve(&unknowns, &halo, product, divided, &b, 1e-12).unwrap();
        let alone = solve(&unknowns, &halo, product, |r: &[f64]| Ok(r.to_vec()), &b, 1e-12).unwrap();
        for (x, krylov) in [&by_diagonal, &alone] {
            assert!(krylov.residual <= 2e-12 && krylov.iterations <= count, "{krylov:?}");
            assert!(x.iter().zip(&exact).all(|(x, exact)| (x - exact).abs() < 1e-10));
        }
        assert!(by_diagonal.1.iterations < alone.1.iterations);
        let none = solve(&unknowns, &halo, product, divided, &vec![0.0; count], 1e-12).unwrap();
        assert_eq!(
            none,
            (
                vec![0.0; count],
                Krylov {
                    iterations: 0,
                    residual: 0.0
                }
            )
        );
    }
}
