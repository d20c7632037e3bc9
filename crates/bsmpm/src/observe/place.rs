//! Values at given positions, from a weighted least-squares plane through nearby material points, theory-manual
//! equation (T10.7).

use crate::exact::Exact;
use crate::grid::Grid;
use crate::kinematics::Kinematics;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::Vector;
use nalgebra::{Matrix4, Vector4};

/// Number of terms 1, x, y, ... of a plane in three dimensions.
const TERMS: usize = 4;
/// Number of products of two terms.
const PRODUCTS: usize = TERMS * TERMS;
/// Determinant of the moments, relative to points spread over cells, below which they do not define a plane.
const SINGULAR: f64 = 1e-6;

/// Largest distance between a surface and the nearest point, in sizes of the point.
const CORNER: f64 = 2.0;

/// Configuration in which positions are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Configuration {
    /// Initial positions of points, or those where a stage placed them: the positions belong to the material.
    Initial,
    /// The same for positions in the material or at its surface.
    Surface,
    /// Current positions of points.
    Present,
}

/// Returns values of `C` fields at positions (m, from the grid's lower corner): each from the weighted least-squares
/// plane through the points of the same material as the nearest point; `None` outside the material.
///
/// The weight is the quadratic B-spline that extends one and a half cells from the position to each side, times the
/// point's reference volume. A position is in the material if a point is nearer than its size, the D-th root of its
/// share of the grid; the material ends at half the size. At a surface, twice the size is allowed, because that is the
/// distance to the corner of a share that is 15 times as long as thick (in a plane), which occurs where a body ends
/// within a cell.
pub fn values<K: Kinematics<D>, const D: usize, const C: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    places: &[Vector<D>],
    configuration: Configuration,
    field: impl Fn(usize) -> [f64; C],
    halo: &dyn Halo,
) -> Vec<Option<[f64; C]>> {
    let scale = places.iter().map(|at| cell_about(grid, at)).collect();
    let fit = Fit {
        points,
        places,
        configuration,
        weight: K::weight,
        scale,
    };
    let materials = fit.materials(halo);
    let width = PRODUCTS + TERMS * C;
    let mut sums = vec![Exact::ZERO; places.len() * width];
    for p in 0..points.len() {
        let mut fields = None;
        for (number, sums) in sums.chunks_exact_mut(width).enumerate() {
            let Some(terms) = fit.terms(number, p) else { continue };
            if materials[number] != Some(points.material[p]) {
                continue;
            }
            let weight = points.volume[p] * (0..D).map(|axis| spline(terms[axis + 1])).product::<f64>();
            let fields = fields.get_or_insert_with(|| field(p));
            for i in 0..=D {
                (0..=D).for_each(|j| sums[i * TERMS + j].add(weight * terms[i] * terms[j]));
                (0..C).for_each(|c| sums[PRODUCTS + c * TERMS + i].add(weight * terms[i] * fields[c]));
            }
        }
    }
    let totals = halo.reproducible_sum(&sums);
    let values = totals.chunks_exact(width).zip(&materials).map(|(totals, material)| {
        let is_in_material = material.is_some() && totals[0] > 0.0;
        is_in_material.then(|| solved::<D, C>(totals))
    });
    values.collect()
}

/// Positions among points.
struct Fit<'a, const D: usize> {
    points: &'a Points<D>,
    places: &'a [Vector<D>],
    configuration: Configuration,
    weight: fn(&Vector<D>) -> f64, // volume per m^D of the grid
    scale: Vec<Option<Vector<D>>>, // m, edges of the cell of every position in the grid
}

impl<const D: usize> Fit<'_, D> {
    fn place_of(&self, p: usize) -> Vector<D> {
        match self.configuration {
            Configuration::Initial | Configuration::Surface => self.points.x[p] - self.points.u[p],
            Configuration::Present => self.points.x[p],
        }
    }

    /// Returns the terms of a plane about a position at point `p`, in units of the cell; `None` outside the weight's
    /// support.
    fn terms(&self, number: usize, p: usize) -> Option<[f64; TERMS]> {
        let scale = self.scale[number]?;
        let apart = self.place_of(p) - self.places[number];
        let mut terms = [1.0, 0.0, 0.0, 0.0];
        for axis in 0..D {
            terms[axis + 1] = apart[axis] / scale[axis];
            if terms[axis + 1].abs() >= REACH {
                return None;
            }
        }
        Some(terms)
    }

    /// Returns the squared distance of point `p` from a position (m2), if `p` is so near that the position is in the
    /// material.
    fn distance(&self, number: usize, p: usize) -> Option<f64> {
        let apart = (self.place_of(p) - self.places[number]).norm_squared();
        let (volume, sizes) = match self.configuration {
            Configuration::Initial => (self.points.volume[p], 1.0),
            Configuration::Surface => (self.points.volume[p], CORNER),
            Configuration::Present => (self.points.volume[p] * self.points.F.at(p).determinant(), 1.0),
        };
        let size = volume / (self.weight)(&self.place_of(p));
        let within = apart <= sizes * sizes * size.powf(2.0 / D as f64);
        self.terms(number, p).and_then(|_| within.then_some(apart))
    }

    /// Returns the material of the point nearest to every position that is in the material. The smallest id decides
    /// between equal distances. Three reductions over all ranks.
    fn materials(&self, halo: &dyn Halo) -> Vec<Option<u16>> {
        let mut nearest = vec![(f64::INFINITY, u64::MAX, 0_u16); self.places.len()];
        for p in 0..self.points.len() {
            for (number, nearest) in nearest.iter_mut().enumerate() {
                let Some(apart) = self.distance(number, p) else {
                    continue;
                };
                let found = (apart, self.points.id[p], self.points.material[p]);
                if (found.0, found.1) < (nearest.0, nearest.1) {
                    *nearest = found;
                }
            }
        }
        let mut closest: Vec<f64> = nearest.iter().map(|(apart, ..)| -apart).collect();
        halo.all_reduce_max(&mut closest);
        let ids = nearest.iter().zip(&closest).map(|(&(apart, id, _), closest)| {
            let is_nearest = apart.is_finite() && -apart == *closest;
            if is_nearest { -(id as f64) } else { f64::NEG_INFINITY }
        });
        let mut ids: Vec<f64> = ids.collect();
        halo.all_reduce_max(&mut ids);
        let materials = nearest.iter().zip(&ids).map(|(&(_, id, material), first)| {
            let is_first = -(id as f64) == *first;
            if is_first { f64::from(material) } else { -1.0 }
        });
        let mut materials: Vec<f64> = materials.collect();
        halo.all_reduce_max(&mut materials);
        materials
            .iter()
            .map(|&material| (material >= 0.0).then_some(material as u16))
            .collect()
    }
}

/// Number of cells by which a point's weight extends to each side.
const REACH: f64 = 1.5;

/// Returns the quadratic B-spline centred at 0 with knots at distance 1.
fn spline(x: f64) -> f64 {
    let x = x.abs();
    if x <= 0.5 {
        0.75 - x * x
    } else {
        0.5 * (REACH - x).powi(2)
    }
}

/// Returns the edges of the cell that contains a position (m); `None` outside the grid.
fn cell_about<const D: usize>(grid: &Grid<D>, place: &Vector<D>) -> Option<Vector<D>> {
    grid.locate(place).map(|cell| grid.cell_box(&cell).1)
}

/// Returns the values of the planes at the position itself, from the moments; the weighted means if the points do not
/// define a plane.
fn solved<const D: usize, const C: usize>(sums: &[f64]) -> [f64; C] {
    let mut matrix = Matrix4::from_row_slice(&sums[..PRODUCTS]);
    let whole = matrix[(0, 0)];
    (D + 1..TERMS).for_each(|unused| matrix[(unused, unused)] = whole);
    let flat = matrix.determinant() <= SINGULAR * whole.powi(TERMS as i32);
    let inverse = if flat { None } else { matrix.try_inverse() };
    std::array::from_fn(|c| {
        let right = Vector4::from_column_slice(&sums[PRODUCTS + c * TERMS..][..TERMS]);
        inverse.map_or(right[0] / whole, |inverse| (inverse * right)[0])
    })
}
