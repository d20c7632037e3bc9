//! Eigenvalues and axes of any symmetric tensor without branches, after Scherzinger and Dohrmann (2008).

use super::{EigenvalueSum, Turn, tangent};
use crate::real::Real;

/// Vectors, one per row.
pub(super) type Rows<R> = [[R; 3]; 3];

/// Distance of b from I up to which eigenvalues are stored as differences from 1, without loss of digits.
const NEAR: f64 = 0.5;
/// Bound below which a deviator counts as zero; its squares would lose digits.
const NONE: f64 = 1e-140;
/// Newton iterations for a root between √3 and 2; the errors are 3e-3 initially, then 7e-6, 4e-11, and below one digit.
const NEWTON: usize = 3;

/// Returns the eigenvalues, as sums, and axes of the tensor with the components XX, YY, ZZ, XY, YZ, XZ.
#[inline(always)]
pub(super) fn solid<R: Real>(b: [R; 6]) -> ([EigenvalueSum<R>; 3], Rows<R>) {
    let [xx, yy, zz, xy, yz, xz] = b;
    let one = xx.like(1.0);
    let far = (xx - 1.0).magnitude() + (yy - 1.0).magnitude() + (zz - 1.0).magnitude();
    let start = R::choose(far.below(xx.like(NEAR)), one, xx.like(0.0));
    let mean = ((xx - start) + (yy - start) + (zz - start)) / 3.0;
    let a = xx - yy;
    let b = yy - zz;
    let c = zz - xx;
    let deviator = [(a - c) / 3.0, (b - a) / 3.0, (c - b) / 3.0, xy, yz, xz];
    // n is the axis of the most distinct eigenvalue. u and v span the plane normal to n, in which one rotation makes
    // the deviator diagonal.
    let n = distinct(deviator);
    let (u, v) = beside(n);
    let of_n = times(deviator, n);
    let of_u = times(deviator, u);
    let of_v = times(deviator, v);
    let uu = dot(u, of_u);
    let vv = dot(v, of_v);
    let uv = dot(u, of_v);
    let tan = tangent((uu - vv) * 0.5, uv);
    let gain = tan * uv;
    let turn = Turn::by(tan);
    let (ux, vx) = turn.apply(u[0], v[0]);
    let (uy, vy) = turn.apply(u[1], v[1]);
    let (uz, vz) = turn.apply(u[2], v[2]);
    let sums = [
        EigenvalueSum {
            start,
            gain: mean + dot(n, of_n),
        },
        EigenvalueSum {
            start,
            gain: mean + (uu + gain),
        },
        EigenvalueSum {
            start,
            gain: mean + (vv - gain),
        },
    ];
    (sums, [n, [ux, uy, uz], [vx, vy, vz]])
}

/// Returns the unit axis of the most distinct eigenvalue of a deviator; the axis x for a zero deviator.
#[inline(always)]
fn distinct<R: Real>([xx, yy, zz, xy, yz, xz]: [R; 6]) -> [R; 3] {
    let zero = xx.like(0.0);
    let one = xx.like(1.0);
    let squares = xx * xx + yy * yy + zz * zz + (xy * xy + yz * yz + xz * xz) * 2.0;
    let size = (squares / 6.0).root();
    let unit = R::choose(size.below(xx.like(NONE)), zero, one / size);
    let x = xx * unit;
    let y = yy * unit;
    let z = zz * unit;
    let p = xy * unit;
    let q = yz * unit;
    let s = xz * unit;
    // Scaled to J2 = 3, the characteristic equation is t³ - 3 t - 2 half = 0 with half = det/2.
    let half = (x * (y * z - q * q) - p * (p * z - q * s) + s * (p * q - y * s)) * 0.5;
    let root = root(half.magnitude()).signed(half);
    let x = x - root;
    let y = y - root;
    let z = z - root;
    // Matrix with rows (x p s), (p y q), (s q z) of rank 2: cross products of its rows are parallel to the axis.
    let products = [
        [y * z - q * q, q * s - p * z, p * q - y * s],
        [q * s - p * z, x * z - s * s, p * s - x * q],
        [p * q - y * s, p * s - x * q, x * y - p * p],
    ];
    let lengths = [
        dot(products[0], products[0]),
        dot(products[1], products[1]),
        dot(products[2], products[2]),
    ];
    let second = lengths[0].below(lengths[1]);
    let length = R::choose(second, lengths[1], lengths[0]);
    let third = length.below(lengths[2]);
    let scale = one / R::choose(third, lengths[2], length).root();
    let at = |k: usize| R::choose(third, products[2][k], R::choose(second, products[1][k], products[0][k])) * scale;
    [at(0), at(1), at(2)]
}

/// Returns the root `t ≥ √3` of `t³ - 3 t - 2 r` for 0 <= r <= 1: `2 cos(acos(r)/3)`.
#[inline(always)]
fn root<R: Real>(r: R) -> R {
    let r = R::choose(r.below(r.like(1.0)), r, r.like(1.0));
    let mut t = (r * -0.0653841 + 0.3333333) * r + 1.7320508;
    for _ in 0..NEWTON {
        let square = t * t;
        t = (square * t + r) * 2.0 / ((square - 1.0) * 3.0);
    }
    t
}

/// Returns two unit vectors that are orthogonal to a unit vector and to each other (Duff et al. 2017).
#[inline(always)]
fn beside<R: Real>([x, y, z]: [R; 3]) -> ([R; 3], [R; 3]) {
    let sign = z.like(1.0).signed(z);
    let a = z.like(-1.0) / (sign + z);
    let b = x * y * a;
    (
        [sign * x * x * a + 1.0, sign * b, -(sign * x)],
        [b, y * y * a + sign, -y],
    )
}

#[inline(always)]
fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn times<R: Real>([xx, yy, zz, xy, yz, xz]: [R; 6], n: [R; 3]) -> [R; 3] {
    [dot([xx, xy, xz], n), dot([xy, yy, yz], n), dot([xz, yz, zz], n)]
}
