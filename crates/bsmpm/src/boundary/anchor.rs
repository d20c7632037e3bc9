//! Anchors surface points of footings, loads and drains to the nearest material points, with which they move after each
//! step, theory-manual equation (T6.4).

use super::surface::{Anchors, SurfacePoint};
use super::{Boundary, Support};
use crate::grid::Grid;
use crate::interactions::strip::{Strip, displacement, reduce};
use crate::parallel::Halo;
use crate::points::{PackedTensors, Points};
use crate::tensor::{Tensor, Vector};

/// Distance, as a fraction of the grid's length, within which a position counts as on a face.
const ON: f64 = 1e-9;

/// Material points of this rank, to which surface points can be anchored.
#[derive(Clone, Copy)]
pub struct AnchorCandidates<'a, const D: usize> {
    /// Global ids.
    pub id: &'a [u64],
    /// Indices of the materials.
    pub material: &'a [u16],
    /// Present positions (m), from the grid's lower corner.
    pub x: &'a [Vector<D>],
    /// Displacements since the start (m).
    pub u: &'a [Vector<D>],
    /// Deformation gradients (-).
    pub F: &'a PackedTensors<D, Tensor>,
}

impl<const D: usize> Points<D> {
    /// Returns the points as candidates for anchors of surface points.
    pub fn anchored(&self) -> AnchorCandidates<'_, D> {
        AnchorCandidates {
            id: &self.id,
            material: &self.material,
            x: &self.x,
            u: &self.u,
            F: &self.F,
        }
    }
}

/// Material points, and the anchors of the surface points among them.
#[derive(Clone, Copy)]
pub struct AnchoredPoints<'a, const D: usize> {
    /// Material points of this rank.
    pub points: &'a Points<D>,
    /// Anchors; empty before the first step.
    pub anchors: &'a Anchors,
}

/// Initial position of a surface point (m), and whether water crosses there.
type StartPlace<const D: usize> = (Vector<D>, bool);

/// All boundary conditions that have surface points.
#[derive(Clone)]
pub struct Surfaces<'a, const D: usize> {
    /// Strips and loads.
    pub boundary: &'a Boundary<D>,
    /// Surface points of every drain, then of every inflow.
    pub water: Vec<&'a [SurfacePoint<D>]>,
    /// Per material: whether no water flows in it. Surface points of drains and inflows are not anchored to it.
    pub dry: Vec<bool>,
}

impl<const D: usize> Surfaces<'_, D> {
    /// Returns the initial positions of the surface points of drains and inflows.
    fn starts_of_water(&self) -> impl Iterator<Item = StartPlace<D>> {
        self.water.iter().copied().flatten().map(|point| (point.x, true))
    }

    /// Returns the initial positions of the surface points of strips, then of loads.
    fn starts_of_boundary(&self) -> impl Iterator<Item = StartPlace<D>> {
        starts(self.boundary).into_iter().map(|x| (x, false))
    }
}

/// Surfaces that have not acted yet, and may be anchored to material that is placed later.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Idle {
    /// Per load.
    pub loads: Vec<bool>,
    /// Per drain, then per inflow.
    pub water: Vec<bool>,
}

/// Present positions of the material at the surface points (m).
pub struct AnchorPlaces<const D: usize> {
    /// Per strip and surface point: the anchor's position plus the initial offset, without the deformation in between.
    pub strips: Vec<Vec<Vector<D>>>,
    /// Per load and surface point: position in the deformed material, kept on the face of the grid where it began.
    pub loads: Vec<Vec<Vector<D>>>,
}

impl Anchors {
    /// Returns the ids of the material points that anchor the points of acting strips, and of all loads, drains and
    /// inflows.
    pub fn acting<const D: usize>(&self, boundary: &Boundary<D>) -> Vec<&Vec<u64>> {
        let strips = self.strips.iter().zip(&boundary.strips);
        let strips = strips.filter(|(_, strip)| strip.acts()).map(|(ids, _)| ids);
        strips.chain(&self.loads).chain(&self.water).collect()
    }

    /// Returns the `carried` anchors, or, before the first step, the nearest material points. Two reductions in that
    /// case.
    pub fn of<const D: usize>(
        surfaces: &Surfaces<'_, D>,
        carried: &Self,
        points: AnchorCandidates<'_, D>,
        halo: &dyn Halo,
    ) -> Self {
        let boundary = surfaces.boundary;
        let found = [
            !(carried.strips.is_empty() && carried.loads.is_empty()),
            !carried.water.is_empty(),
        ];
        let mut starts: Vec<StartPlace<D>> = surfaces.starts_of_boundary().filter(|_| !found[0]).collect();
        starts.extend(surfaces.starts_of_water().filter(|_| !found[1]));
        if starts.is_empty() {
            return carried.clone();
        }
        let mut ids = nearest(&starts, &surfaces.dry, points, halo).into_iter();
        let mut anchors = carried.clone();
        if !found[0] {
            anchors.strips = parts(&mut ids, boundary.strips.iter().map(|strip| strip.points.len()));
            anchors.loads = parts(&mut ids, boundary.loads.iter().map(|load| load.points.len()));
        }
        if !found[1] {
            anchors.water = parts(&mut ids, surfaces.water.iter().map(|points| points.len()));
        }
        anchors
    }

    /// Replaces the anchors for which `gone` is true with the candidates that were nearest at the start. Two reductions
    /// if there are any.
    pub fn without<const D: usize>(
        &self,
        surfaces: &Surfaces<'_, D>,
        gone: impl Fn(u64) -> bool,
        points: AnchorCandidates<'_, D>,
        halo: &dyn Halo,
    ) -> Self {
        let mut anchors = self.clone();
        let held = anchors
            .strips
            .iter_mut()
            .chain(&mut anchors.loads)
            .flatten()
            .zip(surfaces.starts_of_boundary());
        let wet = anchors.water.iter_mut().flatten().zip(surfaces.starts_of_water());
        let (mut lost, places): (Vec<&mut u64>, Vec<StartPlace<D>>) =
            held.chain(wet).filter(|(id, _)| gone(**id)).unzip();
        if !lost.is_empty() {
            lost.iter_mut()
                .zip(nearest(&places, &surfaces.dry, points, halo))
                .for_each(|(id, found)| **id = found);
        }
        anchors
    }

    /// Replaces the anchors of `idle` surfaces with the candidates nearest to the initial surface points. Two
    /// reductions if there are any.
    pub fn renewed<const D: usize>(
        &self,
        surfaces: &Surfaces<'_, D>,
        idle: &Idle,
        points: AnchorCandidates<'_, D>,
        halo: &dyn Halo,
    ) -> Self {
        let mut anchors = self.clone();
        let loads = surfaces
            .boundary
            .loads
            .iter()
            .map(|load| (&load.points[..], false))
            .zip(&idle.loads);
        // Before the first step there are no anchors.
        let water = surfaces
            .water
            .iter()
            .map(|points| (*points, true))
            .zip(&idle.water)
            .take(anchors.water.len());
        let lost = loads.chain(water).filter(|(_, idle)| **idle);
        let places = lost.flat_map(|((points, wet), _)| points.iter().map(move |point| (point.x, wet)));
        let places: Vec<StartPlace<D>> = places.collect();
        if !places.is_empty() {
            let all = anchors
                .loads
                .iter_mut()
                .zip(&idle.loads)
                .chain(anchors.water.iter_mut().zip(&idle.water));
            let renewed = all.filter(|(_, idle)| **idle).flat_map(|(ids, _)| ids);
            renewed
                .zip(nearest(&places, &surfaces.dry, points, halo))
                .for_each(|(id, found)| *id = found);
        }
        anchors
    }

    /// Returns the present positions of the material at the surface points. One reduction if there are surface points.
    pub fn places<const D: usize>(
        &self,
        boundary: &Boundary<D>,
        grid: &Grid<D>,
        points: AnchorCandidates<'_, D>,
        halo: &dyn Halo,
    ) -> AnchorPlaces<D> {
        let starts = starts(boundary);
        let of_strips: usize = self.strips.iter().map(Vec::len).sum();
        let mut found = vec![vec![Vector::zeros(); starts.len()]];
        if !starts.is_empty() {
            points.visit(self.strips.iter().chain(&self.loads).flatten(), |p, at| {
                found[0][at] = match at < of_strips {
                    true => points.ahead(p, &starts[at]),
                    false => within(boundary, grid, &starts[at], points.along(p, &starts[at])),
                };
            });
            reduce(&mut found, halo);
        }
        let mut found = found.into_iter().flatten();
        AnchorPlaces {
            strips: parts(&mut found, self.strips.iter().map(Vec::len)),
            loads: parts(&mut found, self.loads.iter().map(Vec::len)),
        }
    }
}

impl<const D: usize> AnchorPlaces<D> {
    /// Returns the number of points of strip `number` that at time `t` are ahead of their initial material by more than
    /// half the shortest edge of their cell, measured along the strip's total constrained motion; 0 for strips that
    /// allow separation.
    pub fn left_behind(&self, number: usize, strips: &[Strip<D>], t: f64, grid: &Grid<D>) -> usize {
        let strip = &strips[number];
        let moved = strip.path.at(t);
        let normal = strip.normal.or(strip.contact.map(|contact| contact.inward));
        let held = normal.map_or(moved, |normal| normal * normal.dot(&moved));
        let Some(ahead) = held.try_normalize(0.0).filter(|_| strip.acts() && !strip.lifts()) else {
            return 0;
        };
        let held = self.strips.get(number).map_or(&[][..], Vec::as_slice);
        let mut count = 0;
        for (at, place) in held.iter().enumerate() {
            let x = strip.points[at].x + displacement(strips, number, at, t);
            let cell = grid.locate(&x);
            let reach = 0.5 * cell.map_or(grid.smallest_edge(), |cell| grid.cell_box(&cell).1.min());
            count += usize::from((x - place).dot(&ahead) > reach);
        }
        count
    }
}

impl<const D: usize> AnchorCandidates<'_, D> {
    /// Calls `each` with the index of a material point of this rank and the position of its id in `ids`, for every id
    /// that is on this rank.
    pub(crate) fn visit<'i>(&self, ids: impl Iterator<Item = &'i u64>, mut each: impl FnMut(usize, usize)) {
        let mut anchored: Vec<(u64, usize)> = ids.copied().zip(0..).collect();
        anchored.sort_unstable();
        let Some(first) = anchored.first() else { return };
        let Some(last) = anchored.last() else { return };
        for p in (0..self.id.len()).filter(|&p| (first.0..=last.0).contains(&self.id[p])) {
            let from = anchored.partition_point(|(id, _)| *id < self.id[p]);
            for (_, at) in anchored[from..].iter().take_while(|(id, _)| *id == self.id[p]) {
                each(p, *at);
            }
        }
    }

    /// Returns the present position (m) of the material that was at `start`, extrapolated from point `p` with its F.
    pub(crate) fn along(&self, p: usize, start: &Vector<D>) -> Vector<D> {
        self.x[p] + self.F.at(p).fixed_view::<D, D>(0, 0) * self.offset(p, start)
    }

    /// Returns the position of point `p` plus its initial offset to `start` (m).
    fn ahead(&self, p: usize, start: &Vector<D>) -> Vector<D> {
        self.x[p] + self.offset(p, start)
    }

    /// Returns the initial offset from point `p` to `start` (m).
    fn offset(&self, p: usize, start: &Vector<D>) -> Vector<D> {
        start - (self.x[p] - self.u[p])
    }
}

/// Splits the items into lists of these lengths.
fn parts<T>(all: &mut impl Iterator<Item = T>, lengths: impl Iterator<Item = usize>) -> Vec<Vec<T>> {
    lengths.map(|length| all.take(length).collect()).collect()
}

/// Returns an initial area vector after the deformation F: cof(F) N dA (Nanson).
pub(crate) fn turned<const D: usize>(F: &Tensor, area: &Vector<D>) -> Vector<D> {
    cofactor(F).fixed_view::<D, D>(0, 0) * area
}

/// Returns the cofactors J F^-T.
fn cofactor(F: &Tensor) -> Tensor {
    Tensor::from_fn(|i, j| {
        let [i1, i2] = [(i + 1) % 3, (i + 2) % 3];
        let [j1, j2] = [(j + 1) % 3, (j + 2) % 3];
        F[(i1, j1)] * F[(i2, j2)] - F[(i1, j2)] * F[(i2, j1)]
    })
}

/// Moves a position `place` (m) onto a face with a support if it lies beyond the face, or if it began on the face and
/// no material leaves there: extrapolation with F would take it off the face.
fn within<const D: usize>(
    boundary: &Boundary<D>,
    grid: &Grid<D>,
    start: &Vector<D>,
    mut place: Vector<D>,
) -> Vector<D> {
    let closed = boundary.closed();
    for Support { axis, upper, .. } in &boundary.supports {
        let length = grid.axes()[*axis].length();
        let (face, outward) = if *upper { (length, 1.0) } else { (0.0, -1.0) };
        let began_on_it = (start[*axis] - face).abs() <= ON * length;
        if began_on_it && closed[*axis][usize::from(*upper)] || outward * (place[*axis] - face) > 0.0 {
            place[*axis] = face;
        }
    }
    place
}

/// Returns the initial positions of all surface points (m): of strips, then of loads.
fn starts<const D: usize>(boundary: &Boundary<D>) -> Vec<Vector<D>> {
    let strips = boundary.strips.iter().flat_map(|strip| &strip.points);
    strips
        .chain(boundary.loads.iter().flat_map(|load| &load.points))
        .map(|point| point.x)
        .collect()
}

/// Returns the ids of the material points nearest to the positions `at` at the start; the smallest id among equally
/// near ones. Points of `dry` materials are excluded where water crosses. Two reductions.
fn nearest<const D: usize>(
    at: &[StartPlace<D>],
    dry: &[bool],
    points: AnchorCandidates<'_, D>,
    halo: &dyn Halo,
) -> Vec<u64> {
    let mut least = vec![f64::INFINITY; at.len()];
    let mut ids = vec![u64::MAX; at.len()];
    for p in 0..points.id.len() {
        let start = points.x[p] - points.u[p];
        let is_dry = dry.get(usize::from(points.material[p])) == Some(&true);
        for (k, (at, _)) in at.iter().enumerate().filter(|(_, (_, wet))| !(*wet && is_dry)) {
            let distance = (start - at).norm_squared();
            if (distance, points.id[p]) < (least[k], ids[k]) {
                (least[k], ids[k]) = (distance, points.id[p]);
            }
        }
    }
    let own = least.clone();
    least.iter_mut().for_each(|distance| *distance = -*distance);
    halo.all_reduce_max(&mut least);
    let candidates = (0..at.len()).map(|k| match -least[k] == own[k] {
        true => -(ids[k] as f64),
        false => f64::NEG_INFINITY,
    });
    let mut smallest: Vec<f64> = candidates.collect();
    halo.all_reduce_max(&mut smallest);
    smallest.into_iter().map(|id| -id as u64).collect()
}
