//! Follower loads: pressures on the deformed surface, theory-manual equation (T6.9), evaluated in each iteration. Their
//! derivative is not part of the stiffness.

use super::Load;
use crate::boundary::anchor::AnchorCandidates;
use crate::boundary::surface::{Anchors, Attachment, CORNERS, SurfacePoint, area};
use crate::grid::{Contributions, Grid};
use crate::interactions::strip::reduce;
use crate::kinematics::Kinematics;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::{Tensor, Vector};
use std::collections::BTreeMap;

/// Distance, as a fraction of the longest edge of a load's pieces, below which corners count as one.
const SAME: f64 = 1e-6;

/// Volume per m^D of the grid at a position, see [`Kinematics::weight`].
type GeometryWeight<const D: usize> = fn(&Vector<D>) -> f64;

/// Corners of the surface pieces of all follower loads. Adjacent pieces share corners.
#[derive(Clone, Debug, Default)]
struct LoadCorners<const D: usize> {
    /// Per piece, in the order of loads and points: indices of its corners.
    of_piece: Vec<[usize; CORNERS]>,
    /// Initial positions of the corners (m).
    start: Vec<Vector<D>>,
    /// Per corner: number of pieces that share it.
    pieces: Vec<usize>,
}

impl<const D: usize> LoadCorners<D> {
    fn of(loads: &[Load<D>]) -> Self {
        let mut corners = Self::default();
        for load in loads.iter().filter(|load| load.follows) {
            let sizes = load
                .points
                .iter()
                .map(|point| (point.corners[2] - point.corners[0]).amax());
            let near = SAME * sizes.fold(f64::MIN_POSITIVE, f64::max);
            let mut known = BTreeMap::new();
            for point in &load.points {
                let numbers = point.corners.map(|x| {
                    let place: [i64; D] = std::array::from_fn(|axis| (x[axis] / near).round() as i64);
                    *known.entry(place).or_insert_with(|| corners.add(x))
                });
                corners.of_piece.push(numbers);
            }
        }
        corners
            .of_piece
            .iter()
            .flatten()
            .for_each(|&corner| corners.pieces[corner] += 1);
        corners
    }

    /// Adds a corner at `x`, m, and returns its number.
    fn add(&mut self, x: Vector<D>) -> usize {
        self.start.push(x);
        self.pieces.push(0);
        self.start.len() - 1
    }

    /// Returns the present positions of the corners (m): the mean over the adjacent pieces of the position extrapolated
    /// from the piece's carrier. `material` returns the position (m) and deformation gradient of a carrier. One
    /// reduction.
    fn carried(
        &self,
        carriers: &[Carrier<D>],
        material: impl Fn(&Carrier<D>) -> (Vector<D>, Tensor),
        halo: &dyn Halo,
    ) -> Vec<Vector<D>> {
        // One rank computes each entry, so sums have the same order on any number of ranks.
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

    /// Returns the tractions at all points of every follower load at full amplitude, per initial area (Pa), with the
    /// corners at these positions (m); empty for dead loads.
    fn tractions(&self, loads: &[Load<D>], corners: &[Vector<D>], weight: GeometryWeight<D>) -> Vec<Vec<Vector<D>>> {
        let mut pieces = self.of_piece.iter();
        let mut tractions = vec![Vec::new(); loads.len()];
        for (load, tractions) in loads.iter().zip(&mut tractions).filter(|(load, _)| load.follows) {
            for (traction, point) in load.traction.iter().zip(&load.points) {
                let piece = pieces.next().map(|piece| piece.map(|corner| corners[corner]));
                tractions.push(piece.map_or(*traction, |piece| turned(traction, point, piece, weight)));
            }
        }
        tractions
    }
}

/// Returns the traction of a point per initial area (Pa) with the corners of its piece at these positions (m).
fn turned<const D: usize>(
    traction: &Vector<D>,
    point: &SurfacePoint<D>,
    corners: [Vector<D>; CORNERS],
    weight: GeometryWeight<D>,
) -> Vector<D> {
    // The initial area uses the piece's own corners: merged corners may leave a thin piece without area.
    let start = weighed(point.corners, weight);
    let size = start.norm();
    // A piece on the axis of symmetry has no area.
    if size == 0.0 {
        return *traction;
    }
    weighed(corners, weight) * (traction.dot(&start) / size.powi(2))
}

/// Returns the area vector of a piece, along its normal, times the geometry weight at its centre.
fn weighed<const D: usize>(corners: [Vector<D>; CORNERS], weight: GeometryWeight<D>) -> Vector<D> {
    area(&corners) * weight(&(corners.iter().sum::<Vector<D>>() / CORNERS as f64))
}

/// A material point of this rank that anchors a piece.
#[derive(Clone, Debug)]
struct Carrier<const D: usize> {
    point: usize,
    /// Initial position of the material point (m).
    start: Vector<D>,
    /// Index of the piece among those of all follower loads.
    piece: usize,
    /// Interpolation of nodal values at the material point.
    seen: Attachment,
}

/// A surface point of a follower load, attached to the nodes.
#[derive(Clone, Debug)]
pub(super) struct AttachedPoint {
    pub load: usize,
    pub point: usize, // index in the load
    pub area: f64,    // m^(D-1), times the amplitude at the end of the step
    pub attachment: Attachment,
}

/// Follower loads of a step, attached to the nodes.
#[derive(Clone, Debug)]
pub struct FollowerLoads<const D: usize> {
    corners: LoadCorners<D>,
    carriers: Vec<Carrier<D>>,
    pushed: Vec<AttachedPoint>,
    weight: GeometryWeight<D>,
}

impl<const D: usize> FollowerLoads<D> {
    /// Creates the follower loads of a step from their attached points `pushed`.
    pub(super) fn of(
        loads: &[Load<D>],
        pushed: Vec<AttachedPoint>,
        grid: &Grid<D>,
        anchors: &Anchors,
        points: AnchorCandidates<'_, D>,
        weight: GeometryWeight<D>,
    ) -> Self {
        Self {
            corners: LoadCorners::of(loads),
            carriers: carriers(loads, grid, anchors, points),
            pushed,
            weight,
        }
    }

    /// Returns, per load, the number of its pieces whose anchor is on this rank.
    pub(super) fn carried(&self, loads: &[Load<D>]) -> Vec<f64> {
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

    /// Returns the tractions at all points of every follower load at full amplitude, per initial area (Pa), after the
    /// nodal displacement `u` of the step (m); `dF` returns the deformation increment of a material point. One
    /// reduction.
    pub fn tractions(
        &self,
        loads: &[Load<D>],
        grid: &Grid<D>,
        points: &Points<D>,
        u: &[f64],
        dF: &dyn Fn(usize) -> Tensor,
        halo: &dyn Halo,
    ) -> Vec<Vec<Vector<D>>> {
        let offsets = grid.offsets();
        let corners = self.corners.carried(
            &self.carriers,
            |carrier| {
                let p = carrier.point;
                let x = points.x[p] + carrier.seen.displacement::<D>(&offsets, u);
                (x, dF(p) * points.F.at(p))
            },
            halo,
        );
        self.corners.tractions(loads, &corners, self.weight)
    }

    /// Returns the nodal forces of these tractions (N). One ghost exchange.
    pub fn forces(&self, traction: &[Vec<Vector<D>>], grid: &Grid<D>, halo: &dyn Halo) -> Vec<f64> {
        let offsets = grid.offsets();
        let mut force = Contributions::none(grid, D, Vec::new());
        for at in &self.pushed {
            at.attachment
                .scatter(&offsets, &(traction[at.load][at.point] * at.area), &mut force);
        }
        halo.assemble_ghosts(&force)
    }
}

/// Returns [`InteractionState::pressure`](crate::interactions::state::InteractionState) for the present material
/// points. One reduction if there are follower loads.
pub fn now<K: Kinematics<D>, const D: usize>(
    loads: &[Load<D>],
    grid: &Grid<D>,
    anchors: &Anchors,
    points: AnchorCandidates<'_, D>,
    halo: &dyn Halo,
) -> Vec<Vec<Vector<D>>> {
    if !loads.iter().any(|load| load.follows) {
        return vec![Vec::new(); loads.len()];
    }
    let pressures = FollowerLoads::of(loads, Vec::new(), grid, anchors, points, K::weight);
    let corners = pressures.corners.carried(
        &pressures.carriers,
        |carrier| (points.x[carrier.point], points.F.at(carrier.point)),
        halo,
    );
    pressures.corners.tractions(loads, &corners, K::weight)
}

/// Returns the material points of this rank that anchor pieces of follower loads.
fn carriers<const D: usize>(
    loads: &[Load<D>],
    grid: &Grid<D>,
    anchors: &Anchors,
    points: AnchorCandidates<'_, D>,
) -> Vec<Carrier<D>> {
    let offsets = grid.offsets();
    let mut carriers = Vec::new();
    let following = loads.iter().zip(&anchors.loads).filter(|(load, _)| load.follows);
    points.visit(following.flat_map(|(_, ids)| ids), |point, piece| {
        let start = points.x[point] - points.u[point];
        let seen = Attachment::at(grid, &offsets, |_| true, &points.x[point]);
        carriers.extend(seen.map(|seen| Carrier {
            point,
            start,
            piece,
            seen,
        }));
    });
    carriers
}
