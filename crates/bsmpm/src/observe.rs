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

/// Number of bisections for a percentile: the interval shrinks to 1e-15 of the largest coordinate.
const BISECTIONS: usize = 50;

/// Returns the largest coordinate along `axis` of the points of a part, from the grid's lower corner (m); 0 without
/// points. One reduction over all ranks.
pub fn farthest<const D: usize>(points: &Points<D>, part: &Part, axis: usize, halo: &dyn Halo) -> f64 {
    largest(points, part, halo, |p| points.x[p][axis])
}

/// Returns the largest value of the points of a part, or 0 if none is positive. One reduction over all ranks.
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

/// Returns the coordinate along `axis` below which `percentile` per cent of the points of a part lie (m). 52 reductions
/// over all ranks.
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

/// Returns the largest displacement of the points of a part since displacements were last set to zero (m).
pub fn largest_displacement<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    largest(points, part, halo, |p| points.displacement(p).norm())
}

/// Returns the largest coordinate along the last axis (m) of the points of a part within half a cell of `x` (m) along
/// axis 0; 0 if there are none.
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

/// Returns the largest displacement of the points of a part along the last axis (m); 0 if none has risen.
pub fn heave<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    largest(points, part, halo, |p| points.displacement(p)[D - 1])
}

/// Returns sums over the points of a part, bitwise identical for any distribution and order of the points. One
/// reduction over all ranks.
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

/// Returns the mass of the points of a part (kg).
pub fn mass<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    let [mass] = total(points, part, halo, |p, _| points.mass[p]);
    mass
}

/// Returns the momentum of the points of a part (kg m/s); zero in quasi-static cases.
pub fn momentum<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> Vector<D> {
    let Some(motion) = &points.motion else {
        return Vector::zeros();
    };
    Vector::from(total(points, part, halo, |p, axis| motion.v[p][axis] * points.mass[p]))
}

/// Returns the centre of mass of the points of a part, from the grid's lower corner (m); `None` without mass.
pub fn centre_of_mass<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> Option<Vector<D>> {
    let moment: [f64; D] = total(points, part, halo, |p, axis| points.mass[p] * points.x[p][axis]);
    let mass = mass(points, part, halo);
    (mass > 0.0).then(|| Vector::from(moment) / mass)
}

/// Returns the kinetic energy of the points of a part, sum m v^2 / 2 (J); zero in quasi-static cases.
pub fn kinetic_energy<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> f64 {
    let Some(motion) = &points.motion else { return 0.0 };
    let [energy] = total(points, part, halo, |p, _| {
        0.5 * points.mass[p] * motion.v[p].norm_squared()
    });
    energy
}

/// Returns the components of a vector in 3-D.
pub fn in_space<const D: usize>(vector: &Vector<D>) -> [f64; 3] {
    std::array::from_fn(|axis| if axis < D { vector[axis] } else { 0.0 })
}

/// Returns the components XX YY ZZ XY YZ XZ of a stress that D dimensions have: in a plane without the last two.
pub fn stress_components<const D: usize>(stress: &[f64]) -> Vec<f64> {
    stress[..if D == 2 { 4 } else { 6 }].to_vec()
}

/// Returns the mean Cauchy stress of the points of a part, weighted with their current volumes (Pa, components XX YY ZZ
/// XY YZ XZ); zero without points.
pub fn mean_stress<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> [f64; 6] {
    let means: [f64; 7] = means(points, part, halo, |p, k| points.sigma.at(p).0[k]);
    std::array::from_fn(|k| means[k])
}

/// Returns the mean displacement of the points of a part since displacements were last set to zero, weighted with their
/// current volumes (m); zero without points.
pub fn mean_displacement<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> Vector<D> {
    let along: [f64; 4] = means(points, part, halo, |p, axis| {
        if axis < D { points.displacement(p)[axis] } else { 0.0 }
    });
    Vector::from_fn(|axis, _| along[axis])
}

/// Returns the mean velocity of the points of a part, weighted with their current volumes (m/s); zero without points
/// and in quasi-static cases.
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

/// Returns the accumulated plastic strain of the points of a part (-): the mean, weighted with their current volumes,
/// and the maximum; zero without points.
pub fn plastic_strain<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> [f64; 2] {
    let [mean, _] = means(points, part, halo, |p, _| points.eps_p[p]);
    [mean, largest(points, part, halo, |p| points.eps_p[p])]
}

/// Returns the means of `N - 1` values over the points of a part, weighted with their current volumes; zero without
/// points. The last number is not a mean.
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

/// Returns whether a part has any points. One reduction over all ranks.
pub fn is_occupied<const D: usize>(points: &Points<D>, part: &Part, halo: &dyn Halo) -> bool {
    let mut any = [if part.of(points).next().is_some() { 1.0 } else { 0.0 }];
    halo.all_reduce_max(&mut any);
    any[0] > 0.0
}

/// Returns the angular momentum of the points of a part about `place` (m, from the grid's lower corner): sum m (x -
/// place) x v (kg m2/s). In a plane only the component along its normal is non-zero. Zero in quasi-static cases.
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

/// Returns the id of the point nearest to `at` (m, from the grid's lower corner) among those for which `wanted` returns
/// true. The smallest id decides between equal distances.
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

/// Returns the id of the point with the smallest `distance`, if that is finite. The smallest id decides between equal
/// distances. Two reductions over all ranks.
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

/// Returns the displacement (m) of the material that was initially at `place` (m, from the grid's lower corner). It is
/// extrapolated from the point `p`: u_p + (F_p - I)(X - X_p). The error is the curvature of the displacement times half
/// the squared distance.
pub fn displacement<const D: usize>(points: &Points<D>, p: usize, place: &Vector<D>) -> Vector<D> {
    let apart = place - (points.x[p] - points.u[p]);
    points.u[p] + points.F.at(p).fixed_view::<D, D>(0, 0) * apart - apart
}

/// Returns the current position (m, from the grid's lower corner) of the material that was initially at `place`. It is
/// extrapolated from the point that was nearest initially; `None` without points.
pub fn moved<const D: usize>(points: &Points<D>, place: &Vector<D>, halo: &dyn Halo) -> Option<Vector<D>> {
    let id = nearest_by(points, |p| (points.x[p] - points.u[p] - place).norm_squared(), halo)?;
    let along: [f64; D] = at_point(points, id, halo, |p| displacement(points, p, place).into());
    Some(place + Vector::from(along))
}

/// Returns a vector or tensor of the point `id`, on whichever rank it is: `value` is called on that rank. One reduction
/// over all ranks.
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
