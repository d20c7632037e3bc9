//! Quantities of histories and profiles, theory-manual equations (T10.6) to (T10.12): sums, means, maxima, values at
//! positions, run-out front, stress scatter and section forces.

mod front;
pub mod interfaces;
pub mod invariants;
pub mod noise;
mod part;
pub mod place;
pub mod projection;
pub mod quadrature;
mod section;

pub use front::front;
pub use part::Part;
pub use section::{Section, SectionForces, section_forces};

use crate::grid::Grid;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::Vector;
use crate::threads;

/// Bisections of a percentile: the interval shrinks to 1e-15 of the grid.
const BISECTIONS: usize = 50;

/// Largest coordinate of any point of a part along `axis`, from the grid's lower corner (m); 0 without points.
pub fn farthest<const D: usize>(points: &Points<D>, part: &Part, axis: usize, halo: &dyn Halo) -> f64 {
    largest(points, part, halo, |p| points.x[p][axis])
}

/// Largest value among the points of a part, 0 without any that is larger.
fn largest<const D: usize>(
    points: &Points<D>,
    part: &Part,
    halo: &dyn Halo,
    value: impl Fn(usize) -> f64 + Sync,
) -> f64 {
    let mut largest = [threads::largest(points.len(), |p| {
        if part.holds(points, p) { value(p) } else { 0.0 }
    })];
    halo.all_reduce_max(&mut largest);
    largest[0]
}

/// Coordinate along `axis` (m) below which `percentile` per cent of the points of a part lie.
pub fn percentile<const D: usize>(
    points: &Points<D>,
    part: &Part,
    axis: usize,
    percentile: f64,
    halo: &dyn Halo,
) -> f64 {
    let mut count = [part.of(points).count() as f64];
    halo.all_reduce_sum(&mut count);
    let wanted = percentile / 100.0 * count[0];
    let mut lower = 0.0;
    let mut upper = farthest(points, part, axis, halo);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (lower + upper);
        let mut below = [part.of(points).filter(|&p| points.x[p][axis] <= middle).count() as f64];
        halo.all_reduce_sum(&mut below);
        if below[0] >= wanted {
            upper = middle
        } else {
            lower = middle
        }
    }
    upper
}

/// Largest displacement of any point of a part since displacements were last set to zero, m.
pub fn largest_displacement<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    largest(points, part, halo, |p| points.displacement(p).norm())
}

/// Largest coordinate along the last axis (m) of the points of a part that lie within half a cell of `x` along axis 0
/// (m); 0 if there are none.
pub fn surface<const D: usize>(grid: &Grid<D>, points: &Points<D>, part: &Part, x: f64, halo: &dyn Halo) -> f64 {
    let axis = &grid.axes()[0];
    let half = axis
        .cell_of(x)
        .map_or(0.0, |cell| 0.5 * (axis.breakpoint(cell + 1) - axis.breakpoint(cell)));
    largest(points, part, halo, |p| {
        let place = &points.x[p];
        let is_near = (place[0] - x).abs() <= half;
        if is_near { place[D - 1] } else { 0.0 }
    })
}

/// Largest displacement of any point of a part along the last axis, m; 0 if none has risen.
pub fn heave<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    largest(points, part, halo, |p| points.displacement(p)[D - 1])
}

/// Sums over the points of a part: the same bits however they are distributed and ordered.
fn total<const D: usize, const N: usize>(
    points: &Points<D>,
    part: &Part,
    halo: &dyn Halo,
    term: impl Fn(usize, usize) -> f64 + Sync,
) -> [f64; N] {
    let sums = threads::sums::<N>(points.len(), |p| {
        std::array::from_fn(|k| if part.holds(points, p) { term(p, k) } else { 0.0 })
    });
    let sums = halo.reproducible_sum(&sums);
    std::array::from_fn(|k| sums[k])
}

/// Mass of the points of a part, kg.
pub fn mass<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    let [mass] = total(points, part, halo, |p, _| points.mass[p]);
    mass
}

/// Momentum of the points of a part, kg m/s; zero in quasi-static scenes.
pub fn momentum<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> Vector<D> {
    let Some(motion) = &points.motion else {
        return Vector::zeros();
    };
    Vector::from(total(points, part, halo, |p, axis| motion.v[p][axis] * points.mass[p]))
}

/// Centre of mass of the points of a part, from the grid's lower corner (m); `None` without mass.
pub fn centre_of_mass<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> Option<Vector<D>> {
    let moment: [f64; D] = total(points, part, halo, |p, axis| points.mass[p] * points.x[p][axis]);
    let mass = mass(points, part, halo);
    (mass > 0.0).then(|| Vector::from(moment) / mass)
}

/// Kinetic energy of the points of a part, J: sum m v^2 / 2; zero in quasi-static scenes.
pub fn kinetic_energy<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    let Some(motion) = &points.motion else { return 0.0 };
    let [energy] = total(points, part, halo, |p, _| {
        0.5 * points.mass[p] * motion.v[p].norm_squared()
    });
    energy
}

/// Mean Cauchy stress of the points of a part by components XX YY ZZ XY YZ XZ, Pa, weighted with their present volumes;
/// zero without points.
pub fn mean_stress<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> [f64; 6] {
    let means: [f64; 7] = means(points, part, halo, |p, k| points.sigma.at(p).0[k]);
    std::array::from_fn(|k| means[k])
}

/// Mean displacement of the points of a part since displacements were last set to zero, m, weighted with their present
/// volumes; zero without points.
pub fn mean_displacement<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> Vector<D> {
    let along: [f64; 4] = means(points, part, halo, |p, axis| {
        if axis < D { points.displacement(p)[axis] } else { 0.0 }
    });
    Vector::from_fn(|axis, _| along[axis])
}

/// Mean velocity of the points of a part, m/s, weighted with their present volumes; zero without points and in
/// quasi-static scenes.
pub fn mean_velocity<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> Vector<D> {
    let Some(motion) = &points.motion else {
        return Vector::zeros();
    };
    let along: [f64; 4] = means(
        points,
        part,
        halo,
        |p, axis| if axis < D { motion.v[p][axis] } else { 0.0 },
    );
    Vector::from_fn(|axis, _| along[axis])
}

/// Accumulated plastic strain of the points of a part: its mean, weighted with their present volumes, and the largest;
/// zero without points.
pub fn plastic_strain<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> [f64; 2] {
    let [mean, _] = means(points, part, halo, |p, _| points.eps_p[p]);
    [mean, largest(points, part, halo, |p| points.eps_p[p])]
}

/// Means of `N - 1` values over the points of a part, weighted with their present volumes, and a last number that is
/// none; zero without points.
fn means<const D: usize, const N: usize>(
    points: &Points<D>,
    part: &Part,
    halo: &dyn Halo,
    value: impl Fn(usize, usize) -> f64 + Sync,
) -> [f64; N] {
    let sums: [f64; N] = total(points, part, halo, |p, k| {
        let volume = points.volume[p] * points.F.at(p).determinant();
        if k + 1 < N { volume * value(p, k) } else { volume }
    });
    sums.map(|sum| if sums[N - 1] > 0.0 { sum / sums[N - 1] } else { 0.0 })
}

/// Whether a part has any point.
pub fn is_occupied<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> bool {
    let mut any = [if part.of(points).next().is_some() { 1.0 } else { 0.0 }];
    halo.all_reduce_max(&mut any);
    any[0] > 0.0
}

/// Angular momentum of the points of a part about `place` (m, from the grid's lower corner): sum m (x - place) x v
/// along the axes, in a plane along its normal alone, kg m2/s; zero in quasi-static scenes.
pub fn angular_momentum<const D: usize>(
    points: &Points<D>,
    part: &Part,
    place: &Vector<D>,
    halo: &dyn Halo,
) -> [f64; 3] {
    let Some(motion) = &points.motion else { return [0.0; 3] };
    total(points, part, halo, |p, k| {
        let arm = points.x[p] - place;
        let v = motion.v[p];
        let [a, b] = [[1, 2], [2, 0], [0, 1]][k];
        if a.max(b) < D {
            points.mass[p] * (arm[a] * v[b] - arm[b] * v[a])
        } else {
            0.0
        }
    })
}

/// Id of the point nearest to `at` (m, from the grid's lower corner) among those whose ids are `wanted`; of equally
/// near ones the smallest id.
pub fn nearest<const D: usize>(
    points: &Points<D>,
    at: &Vector<D>,
    wanted: impl Fn(u64) -> bool,
    halo: &dyn Halo,
) -> Option<u64> {
    nearest_by(
        points,
        |p| {
            if wanted(points.id[p]) {
                (points.x[p] - at).norm_squared()
            } else {
                f64::INFINITY
            }
        },
        halo,
    )
}

/// Id of the point whose `distance` is the smallest, if that is finite; of equally near ones the smallest id.
fn nearest_by<const D: usize>(points: &Points<D>, distance: impl Fn(usize) -> f64, halo: &dyn Halo) -> Option<u64> {
    let mut closest = [-(0..points.len()).map(&distance).fold(f64::INFINITY, f64::min)];
    halo.all_reduce_max(&mut closest);
    let candidates = (0..points.len()).filter(|&p| closest[0].is_finite() && -distance(p) == closest[0]);
    let mut id = [candidates
        .map(|p| -(points.id[p] as f64))
        .fold(f64::NEG_INFINITY, f64::max)];
    halo.all_reduce_max(&mut id);
    id[0].is_finite().then(|| -id[0] as u64)
}

/// Displacement (m) of the material that was at `place` (m, from the grid's lower corner) before anything moved, by the
/// motion about the point `p` near it: u_p + (F_p - I)(X - X_p), off by the curvature of the motion times half the
/// squared distance. The displacement of the point itself is off by the strain times the distance.
pub fn displacement<const D: usize>(points: &Points<D>, p: usize, place: &Vector<D>) -> Vector<D> {
    let apart = place - (points.x[p] - points.u[p]);
    points.u[p] + points.F.at(p).fixed_view::<D, D>(0, 0) * apart - apart
}

/// Where the material is now (m, from the grid's lower corner) that was at `place` before anything moved, by the motion
/// about the point that was the nearest to it then; `None` without points.
pub fn moved<const D: usize>(points: &Points<D>, place: &Vector<D>, halo: &dyn Halo) -> Option<Vector<D>> {
    let id = nearest_by(points, |p| (points.x[p] - points.u[p] - place).norm_squared(), halo)?;
    let along: [f64; D] = at_point(points, id, halo, |p| displacement(points, p, place).into());
    Some(place + Vector::from(along))
}

/// A vector or tensor of the point `id`, wherever it is: `value` is called on the rank that has it.
pub fn at_point<const D: usize, const C: usize>(
    points: &Points<D>,
    id: u64,
    halo: &dyn Halo,
    value: impl Fn(usize) -> [f64; C],
) -> [f64; C] {
    let mut found = points.id.iter().position(|&own| own == id).map_or([0.0; C], value);
    halo.all_reduce_sum(&mut found);
    found
}
