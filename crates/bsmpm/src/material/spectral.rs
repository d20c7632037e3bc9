//! Eigenvalues and axes of the trial left Cauchy-Green tensor b, and its Hencky strains, theory-manual equation (T4.1).
//! Each eigenvalue is stored as a nearby number plus a difference, for accuracy near b = I.

mod solid;

use super::MaterialError;
use crate::real::{Real, three};
use crate::tensor::Symmetric;

/// Bound of the components of b, which has no unit; squares of larger numbers might overflow.
const LARGEST: f64 = 1e100;
/// Bound below which an eigenvalue counts as zero; the square of its inverse might overflow.
const SMALLEST: f64 = 1e-100;
/// Distance of an eigenvalue from 1 up to which seven terms of the logarithm's series give 17 digits.
const NEAR: f64 = 0.1;

/// Principal values of b and of ε = ½ ln b, descending, with orthonormal axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spectrum<R: Real = f64> {
    /// Eigenvalues of b (-).
    pub b: [R; 3],
    /// Principal Hencky strains (-).
    pub eps: [R; 3],
    below: [R::Mask; 3], // whether the strain of axis 0 is below that of 1, of 1 below 2, of 0 below 2
    axes: Axes<R>,
}

/// Eigenvalue of b as the sum of a nearby number and a difference.
#[derive(Clone, Copy)]
struct EigenvalueSum<R = f64> {
    start: R,
    gain: R,
}

/// Unit eigenvectors.
#[derive(Clone, Copy, Debug)]
enum Axes<R> {
    /// Axes x and y rotated about z by the angle of this tangent.
    Plane { tan: R },
    /// Eigenvectors, one per row.
    Solid(solid::Rows<R>),
}

impl Spectrum {
    /// Decomposes `b = Σ_A b_A n_A ⊗ n_A`, with `ε_A = ½ ln b_A`. Fails unless b is finite and positive definite.
    #[inline(always)]
    pub fn of(b: &Symmetric) -> Result<Self, MaterialError> {
        let [xx, yy, zz, xy, yz, xz] = b.0;
        let largest = xx.abs() + yy.abs() + zz.abs() + xy.abs() + yz.abs() + xz.abs();
        if largest.is_nan() || largest > LARGEST {
            return Err(MaterialError::NotFinite(b.0));
        }
        if yz != 0.0 || xz != 0.0 {
            let (sums, axes) = solid::solid(b.0);
            return Self::of_sums(sums, Axes::Solid(axes));
        }
        let (sums, axes) = plane([xx, yy, zz], xy);
        Self::of_sums(sums, axes)
    }

    /// Creates the spectrum from eigenvalues as sums.
    #[inline(always)]
    fn of_sums([x, y, z]: [EigenvalueSum; 3], axes: Axes<f64>) -> Result<Self, MaterialError> {
        let principal = [
            Principal::of(x.start, x.gain)?,
            Principal::of(y.start, y.gain)?,
            Principal::of(z.start, z.gain)?,
        ];
        Ok(Self::sorted(principal, axes))
    }

    /// Returns the unit eigenvectors, one per row, in the order of the values.
    pub fn axis(&self) -> [[f64; 3]; 3] {
        let axes = match self.axes {
            Axes::Plane { tan } => {
                let Turn { cos, sin } = Turn::by(tan);
                [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]
            }
            Axes::Solid(axes) => axes,
        };
        let [x, y, z] = three(|i| self.descending([axes[0][i], axes[1][i], axes[2][i]]));
        [0, 1, 2].map(|k| [x[k], y[k], z[k]])
    }
}

impl<R: Real> Spectrum<R> {
    /// Decomposes a tensor with the components XX, YY, ZZ, XY; `None` unless all are finite and positive definite.
    #[inline(always)]
    pub fn planar([xx, yy, zz, xy]: [R; 4]) -> Option<Self> {
        let largest = xx.magnitude() + yy.magnitude() + zz.magnitude() + xy.magnitude();
        let (sums, axes) = plane([xx, yy, zz], xy);
        Self::admitted(largest, sums, axes)
    }

    /// Decomposes a tensor with nonzero YZ or XZ; `None` also if both are zero in any lane, because the result of
    /// [`Spectrum::of`] then differs in round-off.
    #[inline(always)]
    pub fn general(b: [R; 6]) -> Option<Self> {
        let [xx, yy, zz, xy, yz, xz] = b.map(R::magnitude);
        let coupling = yz + xz;
        if R::any(coupling.at_most(coupling.like(0.0))) {
            return None;
        }
        let (sums, axes) = solid::solid(b);
        Self::admitted(xx + yy + zz + xy + yz + xz, sums, Axes::Solid(axes))
    }

    /// Creates the spectrum from eigenvalues as sums, and the sum `largest` of the magnitudes of the components.
    #[inline(always)]
    fn admitted(largest: R, sums: [EigenvalueSum<R>; 3], axes: Axes<R>) -> Option<Self> {
        let positive = |sum: EigenvalueSum<R>| sum.start.like(SMALLEST).at_most(sum.start + sum.gain);
        let finite = largest.at_most(largest.like(LARGEST));
        if R::any(!(finite & positive(sums[0]) & positive(sums[1]) & positive(sums[2]))) {
            return None;
        }
        // A closure might not be inlined, so that each vector operation would be a call.
        let principal = [
            Principal::of_sum(sums[0].start, sums[0].gain),
            Principal::of_sum(sums[1].start, sums[1].gain),
            Principal::of_sum(sums[2].start, sums[2].gain),
        ];
        Some(Self::sorted(principal, axes))
    }

    /// Sorts the eigenvalues by comparisons without branches, which random points would mispredict.
    #[inline(always)]
    fn sorted([x, y, z]: [Principal<R>; 3], axes: Axes<R>) -> Self {
        let below = [x.eps.below(y.eps), y.eps.below(z.eps), x.eps.below(z.eps)];
        let found = Self {
            b: [x.b, y.b, z.b],
            eps: [x.eps, y.eps, z.eps],
            below,
            axes,
        };
        Self {
            b: found.descending(found.b),
            eps: found.descending(found.eps),
            ..found
        }
    }

    /// Permutes numbers of the axes to the order of the values.
    #[inline(always)]
    fn descending(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let [a, b, c] = self.below;
        [
            R::choose(a | c, R::choose(b, z, y), x),
            R::choose(
                a,
                R::choose(c, R::choose(b, y, z), x),
                R::choose(c, x, R::choose(b, z, y)),
            ),
            R::choose(a & c, x, R::choose(b & !a, y, z)),
        ]
    }

    /// Permutes numbers of the values to the order of the axes.
    #[inline(always)]
    fn by_axis(&self, s: [R; 3]) -> [R; 3] {
        let [a, b, c] = self.below;
        [
            R::choose(a & c, s[2], R::choose(a | c, s[1], s[0])),
            R::choose(a, R::choose(b, s[1], s[0]), R::choose(b, s[2], s[1])),
            R::choose(b & c, s[0], R::choose(b | c, s[1], s[2])),
        ]
    }

    /// Returns the tensor with the principal values `s`, in the order of those of b, on the same axes; exactly
    /// isotropic if they are equal.
    #[inline(always)]
    pub fn assemble(&self, s: [R; 3]) -> Symmetric<R> {
        match &self.axes {
            Axes::Plane { tan } => {
                let [x, y, z] = self.by_axis(s);
                let shear = *tan * (x - y) / (*tan * *tan + 1.0);
                let moved = *tan * shear;
                Symmetric([x - moved, y + moved, z, shear, x.like(0.0), x.like(0.0)])
            }
            Axes::Solid(axes) => self.assemble_solid(axes, s),
        }
    }

    /// Returns `s₂ I + (s₁ - s₂) n₁ ⊗ n₁ + (s₃ - s₂) n₃ ⊗ n₃`.
    #[inline(always)]
    fn assemble_solid(&self, axes: &[[R; 3]; 3], s: [R; 3]) -> Symmetric<R> {
        // No closures as arguments: see `admitted`.
        let component = |i: usize| self.descending([axes[0][i], axes[1][i], axes[2][i]]);
        let first = s[0] - s[1];
        let third = s[2] - s[1];
        let n = [component(0), component(1), component(2)];
        let at = |i: usize, j: usize| first * (n[i][0] * n[j][0]) + third * (n[i][2] * n[j][2]);
        let spherical = s[1];
        Symmetric([
            spherical + at(0, 0),
            spherical + at(1, 1),
            spherical + at(2, 2),
            at(0, 1),
            at(1, 2),
            at(0, 2),
        ])
    }
}

/// Eigenvalue and its Hencky strain.
#[derive(Clone, Copy)]
struct Principal<R> {
    b: R,
    eps: R,
}

impl<R: Real> Principal<R> {
    /// Returns `ε = artanh(e/(2 + e))` with e = b - 1 without the rounding of b; by a series near b = 1, else by the
    /// logarithm.
    #[inline(always)]
    fn of_sum(start: R, gain: R) -> Self {
        let b = start + gain;
        let strain = (start - 1.0) + gain;
        let far = !(b - 1.0).magnitude().below(b.like(NEAR));
        Self {
            b,
            eps: artanh(strain / (strain + 2.0)).unless(far, [start, gain], logarithm),
        }
    }
}

impl Principal<f64> {
    /// Returns the same, and fails unless the eigenvalue is positive.
    #[inline(always)]
    fn of(start: f64, gain: f64) -> Result<Self, MaterialError> {
        let b = start + gain;
        if b < SMALLEST {
            Err(MaterialError::NotPositive(b))
        } else {
            Ok(Self::of_sum(start, gain))
        }
    }
}

/// Returns `½ (ln b + r/b)`, with b the rounded sum of `start` and `gain`, and r its rounding error (Knuth's two-sum).
#[cold]
fn logarithm([start, gain]: [f64; 2]) -> f64 {
    let b = start + gain;
    let kept = b - start;
    let lost = (start - (b - kept)) + (gain - kept);
    0.5 * (b.ln() + lost / b)
}

/// Returns `z + z³/3 + z⁵/5 + ..`, to the last digit for |z| <= NEAR/(2 - NEAR).
#[inline(always)]
fn artanh<R: Real>(z: R) -> R {
    let s = z * z;
    let tail = s * (s * (1.0 / 15.0) + 1.0 / 13.0) + 1.0 / 11.0;
    z + z * s * (s * (s * (s * (s * tail + 1.0 / 9.0) + 1.0 / 7.0) + 1.0 / 5.0) + 1.0 / 3.0)
}

/// Returns the eigenvalues of a tensor with the axis z, as sums, and the axes.
#[inline(always)]
fn plane<R: Real>([xx, yy, zz]: [R; 3], xy: R) -> ([EigenvalueSum<R>; 3], Axes<R>) {
    let tan = tangent((xx - yy) * 0.5, xy);
    let gain = tan * xy;
    let x = EigenvalueSum { start: xx, gain };
    let y = EigenvalueSum { start: yy, gain: -gain };
    let z = EigenvalueSum {
        start: zz,
        gain: zz.like(0.0),
    };
    ([x, y, z], Axes::Plane { tan })
}

/// Returns `tan θ = g/(d ± √(d² + g²))` of the smaller rotation to the principal axes of a pair, for half the
/// difference d of the diagonal entries and the off-diagonal entry g; the sign is that of d.
#[inline(always)]
fn tangent<R: Real>(half: R, coupling: R) -> R {
    let sum = half.magnitude() + (half * half + coupling * coupling).root();
    let zero = half.like(0.0);
    R::choose(zero.below(sum), coupling / sum.signed(half), zero)
}

/// Rotation of a pair of axes.
struct Turn<R = f64> {
    cos: R,
    sin: R,
}

impl<R: Real> Turn<R> {
    #[inline(always)]
    fn by(tan: R) -> Self {
        let cos = tan.like(1.0) / (tan * tan + 1.0).root();
        Self { cos, sin: tan * cos }
    }

    #[inline(always)]
    fn apply(&self, p: R, q: R) -> (R, R) {
        (self.cos * p + self.sin * q, self.cos * q - self.sin * p)
    }
}

#[cfg(test)]
#[path = "spectral/tests.rs"]
mod oracle;

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Vector3};

    fn defect(values: [f64; 3], turn: Vector3<f64>) -> f64 {
        let q = Rotation3::new(turn).into_inner();
        let b = Symmetric::of(&(q * nalgebra::Matrix3::from_diagonal(&values.into()) * q.transpose()));
        let found = Spectrum::of(&b).unwrap();
        let again = found.assemble(found.b);
        let strain = found.assemble(found.eps.map(|e| (2.0 * e).exp()));
        let worst = |t: Symmetric| (0..6).map(|i| (t.0[i] - b.0[i]).abs()).fold(0.0, f64::max);
        worst(again).max(worst(strain)) / values[0]
    }

    #[test]
    fn the_series_is_the_logarithm() {
        for k in -999..=999 {
            let strain = 1e-4 * f64::from(k);
            let found = Principal::of(1.0, strain)
                .ok()
                .map_or(f64::NAN, |principal| principal.eps);
            // A unit in the last place of either.
            assert!(
                (found - 0.5 * strain.ln_1p()).abs() <= 4.5e-16 * found.abs(),
                "{strain}: {found:e}"
            );
        }
    }

    #[test]
    fn an_eigenvalue_that_cancels_is_none_however_large_the_terms() {
        assert!(matches!(
            Principal::of(2.6e27, -2.6e27),
            Err(MaterialError::NotPositive(_))
        ));
    }

    #[test]
    fn b_is_rebuilt_whatever_the_gap() {
        let mut worst = 0.0_f64;
        for exponent in 0..=16 {
            let gap = 10.0_f64.powi(-exponent);
            for (k, base) in [1.0, 0.01, 100.0, 1.0 + 1e-7].into_iter().enumerate() {
                for turn in [[0.0, 0.0, 0.7], [0.3, -0.8, 1.1], [1e-9, 0.4, 2e-5], [1e-3, 0.0, 0.0]] {
                    let turn = Vector3::from(turn) * (1.0 + k as f64);
                    let values = [base * (1.0 + gap), base, base * (1.0 - 0.5 * gap)];
                    worst = worst.max(defect(values, turn));
                    worst = worst.max(defect([base, base, base * gap.max(1e-12)], turn));
                }
            }
        }
        assert!(worst <= 1e-13, "rebuilt to {worst:e}");
    }
}
