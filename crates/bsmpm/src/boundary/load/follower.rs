//! Follower loads: pressures on the deformed surface, theory-manual equation (T6.9), evaluated in each iteration. Their
//! derivative is not part of the stiffness.

use super::Load;
use crate::boundary::anchor::Anchored;
use crate::boundary::strip::reduce;
use crate::boundary::surface::{Anchors, Attachment, CORNERS, SurfacePoint, area};
use crate::grid::{Contributions, Grid};
use crate::kinematics::Kinematics;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::{Tensor, Vector};
use std::collections::BTreeMap;

/// Part of the longest edge of a load's pieces by which their corners may differ and still be one.
const SAME: f64 = 1e-6;

/// Corners of the pieces of all loads that follow the surface.
#[derive(Clone, Debug, Default)]
struct LoadCorners<const D: usize> {
    /// per piece, in the order of loads and points
    of_piece: Vec<[usize; CORNERS]>,
    /// m  at the start
    start: Vec<Vector<D>>,
    /// pieces that have it
    pieces: Vec<usize>,
}

impl<const D: usize> LoadCorners<D> {
    fn of(loads: &[Load<D>]) -> Self {
        let mut corners = Self::default();
        for load in loads.iter().filter(|load| load.follows) {
            let pieces = || load.points.iter().map(|point| point.corners);
            let near = SAME
                * pieces()
                    .map(|piece| (piece[2] - piece[0]).amax())
                    .fold(f64::MIN_POSITIVE, f64::max);
            let mut known = BTreeMap::new();
            for piece in pieces() {
                corners.of_piece.push(piece.map(|x| {
                    let place: [i64; D] = std::array::from_fn(|axis| (x[axis] / near).round() as i64);
                    *known.entry(place).or_insert_with(|| {
                        corners.start.push(x);
                        corners.pieces.push(0);
                        corners.start.len() - 1
                    })
                }));
            }
        }
        corners
            .of_piece
            .iter()
            .flatten()
            .for_each(|&corner| corners.pieces[corner] += 1);
        corners
    }

    /// Where these `carriers` bring the corners, m, to the places and by the deformation that `material` has of a point
    /// of this rank. One reduction.
    fn carried(
        &self,
        carriers: &[Carrier<D>],
        material: impl Fn(&Carrier<D>) -> (Vector<D>, Tensor),
        halo: &dyn Halo,
    ) -> Vec<Vector<D>> {
        // Each by one rank alone: sums have one order, whoever has the points.
        let mut brought = vec![vec![Vector::zeros(); CORNERS * self.of_piece.len()]];
        for carrier in carriers {
            let (x, F) = material(carrier);
            for (k, &corner) in self.of_piece[carrier.piece].iter().enumerate() {
                let offset = self.start[corner] - carrier.start;
                brought[0][CORNERS * carrier.piece + k] = x + F.fixed_view::<D, D>(0, 0) * offset;
            }
        }
        reduce(&mut brought, halo);
        let mut mean = vec![Vector::zeros(); self.start.len()];
        for (x, &corner) in brought[0].iter().zip(self.of_piece.iter().flatten()) {
            mean[corner] += x / self.pieces[corner] as f64;
        }
        mean
    }

    /// Of every load that follows the surface its traction at every point when fully applied, Pa, per area of the
    /// start, with the corners at these places; empty for the others.
    fn tractions<K: Kinematics<D>>(&self, loads: &[Load<D>], corners: &[Vector<D>]) -> Vec<Vec<Vector<D>>> {
        let mut pieces = self.of_piece.iter();
        let mut traction = |(traction, point): (&Vector<D>, &SurfacePoint<D>)| {
            let Some(piece) = pieces.next() else { return *traction };
            // By its own corners, as the point's share is: a thin piece may have none of its own left.
            let start = weighed::<K, D>(point.corners);
            let size = start.norm();
            // On an axis there is no area.
            if size == 0.0 {
                return *traction;
            }
            weighed::<K, D>(piece.map(|corner| corners[corner])) * (traction.dot(&start) / size.powi(2))
        };
        let of = |load: &Load<D>| match load.follows {
            true => load.traction.iter().zip(&load.points).map(&mut traction).collect(),
            false => Vec::new(),
        };
        loads.iter().map(of).collect()
    }
}

/// Area of a piece as it weighs, a vector along its normal.
fn weighed<K: Kinematics<D>, const D: usize>(corners: [Vector<D>; CORNERS]) -> Vector<D> {
    area(&corners) * K::weight(&(corners.iter().sum::<Vector<D>>() / CORNERS as f64))
}

/// A point of this rank that carries a piece.
#[derive(Clone, Debug)]
struct Carrier<const D: usize> {
    point: usize,
    /// m  where it was at the start
    start: Vector<D>,
    /// of all loads that follow the surface
    piece: usize,
    /// the point as the nodes see it
    seen: Attachment,
}

/// Follower loads of a step, attached to the nodes.
#[derive(Clone, Debug, Default)]
pub struct FollowerLoads<const D: usize> {
    corners: LoadCorners<D>,
    carriers: Vec<Carrier<D>>,
    /// load, point of it, m^(D-1) times the share that acts at the step's end, and where its force goes
    pushed: Vec<(usize, usize, f64, Attachment)>,
}

impl<const D: usize> FollowerLoads<D> {
    /// Of the loads that follow the surface, which are `pushed` as said there; nothing without any.
    pub(super) fn of(
        loads: &[Load<D>],
        pushed: Vec<(usize, usize, f64, Attachment)>,
        (grid, anchors): (&Grid<D>, &Anchors),
        points: Anchored<'_, D>,
    ) -> Self {
        if !loads.iter().any(|load| load.follows) {
            return Self::default();
        }
        Self {
            corners: LoadCorners::of(loads),
            carriers: carriers(loads, (grid, anchors), points),
            pushed,
        }
    }

    /// Of every load how many of its pieces this rank carries; empty where none follows the surface.
    pub(super) fn carried(&self, loads: &[Load<D>]) -> Vec<f64> {
        if self.is_empty() {
            return Vec::new();
        }
        let ends = loads.iter().scan(0, |end, load| {
            *end += if load.follows { load.points.len() } else { 0 };
            Some(*end)
        });
        let ends: Vec<usize> = ends.collect();
        let mut carried = vec![0.0; loads.len()];
        for carrier in &self.carriers {
            carried[ends.partition_point(|&end| end <= carrier.piece)] += 1.0;
        }
        carried
    }

    /// Whether no load follows the surface.
    pub fn is_empty(&self) -> bool {
        self.corners.of_piece.is_empty()
    }

    /// Of every load that follows the surface its traction at every point when fully applied, Pa, per area of the
    /// start, after the nodal displacement `u` of the step, m, that deforms a point by `dF`. One reduction.
    pub fn tractions<K: Kinematics<D>>(
        &self,
        (loads, grid): (&[Load<D>], &Grid<D>),
        points: &Points<D>,
        (u, dF): (&[f64], &dyn Fn(usize) -> Tensor),
        halo: &dyn Halo,
    ) -> Vec<Vec<Vector<D>>> {
        let offsets = grid.offsets();
        let material = |carrier: &Carrier<D>| {
            let p = carrier.point;
            (
                points.x[p] + carrier.seen.displacement::<D>(&offsets, u),
                dF(p) * points.F.at(p),
            )
        };
        self.corners
            .tractions::<K>(loads, &self.corners.carried(&self.carriers, material, halo))
    }

    /// Nodal forces of these tractions, N. One exchange with the neighbours.
    pub fn forces(&self, traction: &[Vec<Vector<D>>], grid: &Grid<D>, halo: &dyn Halo) -> Vec<f64> {
        let (offsets, mut force) = (grid.offsets(), Contributions::none(grid, D, Vec::new()));
        for (load, k, area, attachment) in &self.pushed {
            attachment.scatter(&offsets, &(traction[*load][*k] * *area), &mut force);
        }
        halo.sum(&force)
    }
}

/// What [`Surface::pressure`](crate::boundary::Surface) is with the points as they are. One reduction, if a load
/// follows.
pub fn now<K: Kinematics<D>, const D: usize>(
    loads: &[Load<D>],
    (grid, anchors): (&Grid<D>, &Anchors),
    points: Anchored<'_, D>,
    halo: &dyn Halo,
) -> Vec<Vec<Vector<D>>> {
    let pressures = FollowerLoads::of(loads, Vec::new(), (grid, anchors), points);
    if pressures.is_empty() {
        return vec![Vec::new(); loads.len()];
    }
    let material = |carrier: &Carrier<D>| (points.x[carrier.point], points.F.at(carrier.point));
    let corners = pressures.corners.carried(&pressures.carriers, material, halo);
    pressures.corners.tractions::<K>(loads, &corners)
}

/// The points of this rank that pieces are anchored to.
fn carriers<const D: usize>(
    loads: &[Load<D>],
    (grid, anchors): (&Grid<D>, &Anchors),
    points: Anchored<'_, D>,
) -> Vec<Carrier<D>> {
    let (offsets, mut carriers) = (grid.offsets(), Vec::new());
    let following = || {
        loads
            .iter()
            .zip(&anchors.loads)
            .filter(|(load, _)| load.follows)
            .flat_map(|(_, ids)| ids)
    };
    points.visit(following(), |point, piece| {
        if let Some(seen) = Attachment::at(grid, &offsets, |_| true, &points.x[point]) {
            carriers.push(Carrier {
                point,
                start: points.x[point] - points.u[point],
                piece,
                seen,
            });
        }
    });
    carriers
}
