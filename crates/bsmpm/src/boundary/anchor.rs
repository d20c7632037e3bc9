//! Anchors surface points of footings, loads and drains to the nearest material points, with which they move after each
//! step, theory-manual equation (T6.4).

use super::strip::{Strip, displacement, reduce};
use super::surface::{Anchors, SurfacePoint};
use super::{Boundary, Support};
use crate::grid::Grid;
use crate::parallel::Halo;
use crate::points::PackedTensors;
use crate::tensor::{Tensor, Vector};

/// Parts of the grid's length within which a point is on a face.
const ON: f64 = 1e-9;

/// What surfaces are anchored to: the points of this rank.
#[derive(Clone, Copy)]
pub struct AnchorCandidates<'a, const D: usize> {
    /// global ids
    pub id: &'a [u64],
    /// numbers of the materials
    pub material: &'a [u16],
    /// m  places now, from the grid's lower corner
    pub x: &'a [Vector<D>],
    /// m  displacements since the start
    pub u: &'a [Vector<D>],
    /// -  deformation gradients
    pub F: &'a PackedTensors<D, Tensor>,
}

/// A surface point's place at the start, m, and whether water crosses there.
type StartPlace<const D: usize> = (Vector<D>, bool);

/// All that has points on surfaces of bodies.
#[derive(Clone)]
pub struct Surfaces<'a, const D: usize> {
    /// strips and loads
    pub boundary: &'a Boundary<D>,
    /// points of every drain, then of every inflow of water
    pub water: Vec<&'a [SurfacePoint<D>]>,
    /// by the material's number: whether no water flows in it, and none of those is anchored to it
    pub dry: Vec<bool>,
}

impl<const D: usize> Surfaces<'_, D> {
    /// All surface points of water at the start.
    fn starts_of_water(&self) -> impl Iterator<Item = StartPlace<D>> {
        self.water.iter().copied().flatten().map(|point| (point.x, true))
    }

    /// All those of strips, then those of loads.
    fn starts_of_boundary(&self) -> impl Iterator<Item = StartPlace<D>> {
        starts(self.boundary).into_iter().map(|x| (x, false))
    }
}

/// Which surfaces have not acted yet, and may be on what comes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Idle {
    /// loads
    pub loads: Vec<bool>,
    /// every drain's surface, then every inflow's
    pub water: Vec<bool>,
}

/// Places of the material now, m.
pub struct AnchorPlaces<const D: usize> {
    /// per strip and point of it: as far from the anchor as at the start, without what the material between has
    /// stretched
    pub strips: Vec<Vec<Vector<D>>>,
    /// per load and point of it: on the material, and on the face of the grid that it began on
    pub loads: Vec<Vec<Vector<D>>>,
}

impl Anchors {
    /// The anchors that are `carried`; before the first step, the nearest points. Two reductions then.
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

    /// The anchors with those that `gone` says replaced by the points that were the nearest ones of the others at the
    /// start. Two reductions if there are such.
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

    /// The anchors with those of the surfaces that are `idle` replaced by the points nearest to their start of all that
    /// are there. Two reductions if there are such.
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
        // Before a first step nothing is anchored yet.
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

    /// Where the material is now. One reduction, if there are surface points at all.
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
    /// Points of a strip, `number` of all, that at time `t` are farther ahead of the material that they held at the
    /// start than half the shortest edge of the cell that they are in, along the strip's whole motion as far as it is
    /// held.
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
    /// Calls with every one of these ids that is of a point of this rank: the point, and which one of the ids.
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

    /// Where the material is now, m, that was at `start`, if it is the one of the point `p`.
    pub(crate) fn along(&self, p: usize, start: &Vector<D>) -> Vector<D> {
        self.x[p] + self.F.at(p).fixed_view::<D, D>(0, 0) * self.offset(p, start)
    }

    /// The place, m, that is as far from the point `p` as `start` was.
    fn ahead(&self, p: usize, start: &Vector<D>) -> Vector<D> {
        self.x[p] + self.offset(p, start)
    }

    fn offset(&self, p: usize, start: &Vector<D>) -> Vector<D> {
        start - (self.x[p] - self.u[p])
    }
}

/// Takes what comes in parts of these lengths.
fn parts<T>(all: &mut impl Iterator<Item = T>, lengths: impl Iterator<Item = usize>) -> Vec<Vec<T>> {
    lengths.map(|length| all.take(length).collect()).collect()
}

/// An area of the start, as a vector along its normal, after the deformation F: cof(F) N dA (Nanson).
pub(crate) fn turned<const D: usize>(F: &Tensor, area: &Vector<D>) -> Vector<D> {
    cofactor(F).fixed_view::<D, D>(0, 0) * area
}

/// Cofactors: J F^-T.
fn cofactor(F: &Tensor) -> Tensor {
    Tensor::from_fn(|i, j| {
        let [i1, i2] = [(i + 1) % 3, (i + 2) % 3];
        let [j1, j2] = [(j + 1) % 3, (j + 2) % 3];
        F[(i1, j1)] * F[(i2, j2)] - F[(i1, j2)] * F[(i2, j1)]
    })
}

/// A place that was at `start`, not beyond the faces that hold or stop material, and on those that it began on if no
/// material leaves them: what the material at it has stretched would take it off.
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

/// Places of all surface points at the start, m: those of strips, then those of loads.
fn starts<const D: usize>(boundary: &Boundary<D>) -> Vec<Vector<D>> {
    let strips = boundary.strips.iter().flat_map(|strip| &strip.points);
    strips
        .chain(boundary.loads.iter().flat_map(|load| &load.points))
        .map(|point| point.x)
        .collect()
}

/// Ids of the points that were nearest to places at the start; of equally near ones the smallest. Where water crosses,
/// of those whose material is not `dry`.
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
