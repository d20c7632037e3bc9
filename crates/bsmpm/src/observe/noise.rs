//! Scatter of the stress between material points: about the average on the grid, theory-manual equation (T10.9), and
//! about a local plane.

use crate::error::StepError;
use crate::exact::Exact;
use crate::grid::{Contributions, Grid, Shape, transfer};
use crate::model::AverageWeight;
use crate::observe::Part;
use crate::parallel::{Halo, agreed};
use crate::points::Points;
use crate::tensor::Vector;
use crate::threads;
use nalgebra::{Matrix4, Vector4};

/// Root mean square of the difference between the stress and two smooth approximations of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// About S sigma, the weighted average that is mapped to the nodes and back (Eqs 16-18).
    pub about_average: f64,
    /// About the least-squares plane through the points of the cell and its neighbours.
    pub about_plane: f64,
}

/// Number of coefficients of a plane in three dimensions.
const MOST: usize = 4;
/// Count of numbers in the moments at a node: t t^T and t sigma.
const WIDTH: usize = MOST * MOST + MOST;
/// Determinant of the moments, relative to points spread over cells, below which they do not define a plane.
const SINGULAR: f64 = 1e-9;

/// Returns the noise of component `component` (XX YY ZZ XY YZ XZ) of the Cauchy stress over all points, relative to the
/// mean of its absolute value; zero without stress. The points must be sorted by cell. The plane is fitted to all
/// points in the support of the cell's middle node: for quadratic splines, the cell and its 3^D - 1 neighbours.
pub fn stress_noise<const D: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    weighting: AverageWeight,
    component: usize,
    halo: &dyn Halo,
) -> Result<Noise, StepError> {
    let squares = Squares::of(
        grid,
        points,
        &Part::Whole,
        weighting,
        &|p| points.sigma.at(p).0[component],
        halo,
    )?;
    Ok(if squares.mean == 0.0 {
        Noise::default()
    } else {
        squares.noise(squares.mean)
    })
}

/// Returns the noise of the pressure -tr(sigma)/3 over the points of a part (Pa).
pub fn pressure_noise<const D: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    part: &Part,
    weighting: AverageWeight,
    halo: &dyn Halo,
) -> Result<Noise, StepError> {
    Ok(Squares::of(grid, points, part, weighting, &|p| pressure(points, p), halo)?.noise(1.0))
}

/// Fraction of Young's modulus below which a pressure is round-off of F, as in material in free flight.
const ROUNDING: f64 = 1e-13;

/// Returns the noise of the pressure over all points, relative to its mean absolute value. Returns zero if the mean is
/// round-off for material with Young's modulus `young` (Pa).
pub fn relative_pressure_noise<const D: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    weighting: AverageWeight,
    young: f64,
    halo: &dyn Halo,
) -> Result<Noise, StepError> {
    let squares = Squares::of(grid, points, &Part::Whole, weighting, &|p| pressure(points, p), halo)?;
    Ok(if squares.mean <= ROUNDING * young {
        Noise::default()
    } else {
        squares.noise(squares.mean)
    })
}

/// Returns -tr(sigma)/3 of a point (Pa).
pub(super) fn pressure<const D: usize>(points: &Points<D>, p: usize) -> f64 {
    -points.sigma.at(p).0[..3].iter().sum::<f64>() / 3.0
}

/// Means over the points of a part: the absolute value of a stress, and its squared differences from the two
/// approximations.
struct Squares {
    mean: f64, // of the absolute value
    average: f64,
    plane: f64,
}

impl Squares {
    fn of<const D: usize>(
        grid: &Grid<D>,
        points: &Points<D>,
        part: &Part,
        weighting: AverageWeight,
        stress: &(impl Fn(usize) -> f64 + Sync),
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let shape = agreed(halo, Shape::at(grid, points), StepError::OtherRank)?;
        let average = averaged(&shape, points, weighting, stress, halo);
        let planes = planes(grid, &shape, points, stress, halo);
        let sums = threads::total(shape.columns().len(), |column| {
            let mut sums = [const { Exact::ZERO }; 4];
            for number in shape.columns()[column].patches.clone() {
                let patch = &shape.patches()[number];
                let cell = grid.cell_at(patch.cell);
                for p in patch.points.clone().filter(|&p| part.holds(points, p)) {
                    let terms = terms(grid, &cell, &points.x[p]);
                    let on_plane: f64 = planes[number].iter().zip(&terms).map(|(a, b)| a * b).sum();
                    sums[0].add(1.0);
                    sums[1].add(stress(p).abs());
                    sums[2].add((stress(p) - average[p]).powi(2));
                    sums[3].add((stress(p) - on_plane).powi(2));
                }
            }
            sums
        });
        let sums = halo.reproducible_sum(&sums);
        let [count, absolute, average, plane] = [0, 1, 2, 3].map(|k| sums[k]);
        let [mean, average, plane] = [absolute, average, plane].map(|sum| if count > 0.0 { sum / count } else { 0.0 });
        Ok(Self { mean, average, plane })
    }

    fn noise(&self, unit: f64) -> Noise {
        Noise {
            about_average: self.average.sqrt() / unit,
            about_plane: self.plane.sqrt() / unit,
        }
    }
}

fn averaged<const D: usize>(
    shape: &Shape<D>,
    points: &Points<D>,
    weighting: AverageWeight,
    stress: &(impl Fn(usize) -> f64 + Sync),
    halo: &dyn Halo,
) -> Vec<f64> {
    let weights = match weighting {
        AverageWeight::Mass => &points.mass,
        AverageWeight::Volume => &points.volume,
    };
    let nodal = halo.assemble_ghosts(&transfer::to_nodes(shape, |p| [weights[p], weights[p] * stress(p)]));
    let pairs = nodal.chunks_exact(2);
    let means = pairs.map(|pair| if pair[0] > 0.0 { pair[1] / pair[0] } else { 0.0 });
    let nodal: Vec<f64> = means.collect();
    transfer::to_points(shape, &nodal, |_, [average]| average)
}

/// Returns the terms 1, x, y, ... of a plane at `x`, measured from the centre of `cell` in units of the cell.
fn terms<const D: usize>(grid: &Grid<D>, cell: &[usize; D], x: &Vector<D>) -> [f64; MOST] {
    let (lower, size) = grid.cell_box(cell);
    let mut terms = [1.0, 0.0, 0.0, 0.0];
    for axis in 0..D {
        terms[axis + 1] = (x[axis] - lower[axis]) / size[axis] - 0.5;
    }
    terms
}

/// Returns the coefficients of the least-squares plane of every patch. One exchange with the neighbours.
///
/// The sums of t t^T and t sigma are formed at every node over the points in its support, so one exchange gives every
/// cell the points of its neighbours on other ranks. A node belongs to the cell (with a length) whose middle node it
/// is. No function extends across a breakpoint of multiplicity q, where the stress may be discontinuous.
fn planes<const D: usize>(
    grid: &Grid<D>,
    shape: &Shape<D>,
    points: &Points<D>,
    stress: &(impl Fn(usize) -> f64 + Sync),
    halo: &dyn Halo,
) -> Vec<[f64; MOST]> {
    let middle = grid.order() / 2;
    let mut sums = Contributions::none(grid, WIDTH, Vec::new());
    let moments = threads::each(shape.patches().len(), |number| {
        let patch = &shape.patches()[number];
        let own = grid.cell_at(patch.cell);
        let mut moments = [0.0; WIDTH];
        for p in patch.points.clone() {
            add_moments(&terms(grid, &own, &points.x[p]), stress(p), &mut moments);
        }
        moments
    });
    for (patch, moments) in shape.patches().iter().zip(&moments) {
        let own = grid.cell_at(patch.cell);
        let sums = sums.patch(patch.first_node);
        for offset in shape.offsets() {
            let of_node = grid.node_at(patch.first_node + offset);
            let cell =
                std::array::from_fn(|axis| of_node[axis].saturating_sub(middle).min(grid.axes()[axis].cells() - 1));
            if !(0..D).all(|axis| grid.axes()[axis].has_length(cell[axis])) {
                continue;
            }
            add_moved(
                moments,
                &between(grid, &own, &cell),
                &mut sums[offset * WIDTH..(offset + 1) * WIDTH],
            );
        }
    }
    let sums = halo.assemble_ghosts(&sums);
    let middle_offset = shape.offsets()[(0..D).fold(0, |k, _| k * shape.width() + middle)];
    threads::each(shape.patches().len(), |number| {
        let node = shape.patches()[number].first_node + middle_offset;
        fit::<D>(&sums[node * WIDTH..(node + 1) * WIDTH])
    })
}

/// Returns scale and shift that convert the [`terms`] of one cell to those of another: t' = scale t + shift.
fn between<const D: usize>(grid: &Grid<D>, from: &[usize; D], to: &[usize; D]) -> [[f64; 2]; MOST] {
    let (lower, size) = grid.cell_box(from);
    let (other, length) = grid.cell_box(to);
    let mut change = [[1.0, 0.0]; MOST];
    for axis in 0..D {
        let shift = (lower[axis] - other[axis] + 0.5 * size[axis]) / length[axis] - 0.5;
        change[axis + 1] = [size[axis] / length[axis], shift];
    }
    change
}

/// Adds moments in the terms t of one cell to the moments in the terms t' of another.
fn add_moved(own: &[f64; WIDTH], change: &[[f64; 2]; MOST], sum: &mut [f64]) {
    // With t'_i = a t_i + d, t'_j = b t_j + e and t_0 = 1, the sum of t'_i t'_j is a (b S_ij + e S_i0) + d (b S_0j + e
    // S_00), where S_ij is the sum of t_i t_j.
    for (i, [a, d]) in change.iter().enumerate() {
        for (j, [b, e]) in change.iter().enumerate() {
            sum[i * MOST + j] += a * (b * own[i * MOST + j] + e * own[i * MOST]) + d * (b * own[j] + e * own[0]);
        }
        sum[MOST * MOST + i] += a * own[MOST * MOST + i] + d * own[MOST * MOST];
    }
}

fn add_moments(t: &[f64; MOST], stress: f64, sum: &mut [f64]) {
    for i in 0..MOST {
        for j in 0..MOST {
            sum[i * MOST + j] += t[i] * t[j];
        }
        sum[MOST * MOST + i] += t[i] * stress;
    }
}

/// Solves the least-squares problem from the moments; returns the mean if the points do not define a plane.
fn fit<const D: usize>(sum: &[f64]) -> [f64; MOST] {
    let mut matrix = Matrix4::from_row_slice(&sum[..MOST * MOST]);
    let right = Vector4::from_column_slice(&sum[MOST * MOST..]);
    for unused in D + 1..MOST {
        matrix[(unused, unused)] = 1.0;
    }
    let mean = [right[0] / matrix[(0, 0)], 0.0, 0.0, 0.0];
    let singular = matrix.determinant() <= SINGULAR * matrix[(0, 0)].powi(D as i32 + 1);
    if singular {
        mean
    } else {
        matrix.lu().solve(&right).map_or(mean, |plane| plane.into())
    }
}
