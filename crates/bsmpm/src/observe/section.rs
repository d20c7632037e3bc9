//! Section forces: what the stress transmits across a line, of a solid across a plane.
//!
//! They are the virtual work of the stress on motions of the grid that move one side of the section as a rigid body and
//! leave the other one. Forces on the nodes balance for such motions, so normal force, shear forces and moments have
//! their equilibrium as exactly as the step has its own, however the stress oscillates from point to point.

use crate::exact::Exact;
use crate::grid::Grid;
use crate::grid::shape::with_width;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::{Tensor, Vector};

/// Where a body is cut: places in m, from the grid's lower corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Section<const D: usize> {
    /// Ends of a line; of a solid of two lines that cross in their middles, of directions t1 and t2, at right angles:
    /// what of the second is along the first counts for nothing.
    pub lines: Vec<[Vector<D>; 2]>,
    /// Of a solid whether the lines are the axes of an ellipse; they are the lengths of a rectangle's sides else.
    pub round: bool,
}

/// Forces of the material beyond a section on that before it. In a plane they are per metre of thickness, t is the
/// first direction and the second is the plane's normal, along which nothing is told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionForces {
    /// N  int sigma_nn dA, n = t1 x t2, in a plane to the right of t; positive in tension
    pub normal: f64,
    /// N  int sigma_1n dA and int sigma_2n dA
    pub shear: [f64; 2],
    /// N m  int s1 sigma_2n - s2 sigma_1n dA, about n; s from the section's middle
    pub torsion: f64,
    /// N m  int s1 sigma_nn dA and int s2 sigma_nn dA: positive where the side that t points to is in tension
    pub bending: [f64; 2],
}

/// Forces across a section; material beyond its edge, or none, counts for nothing. The cut is smeared over the cells at
/// the section, with its middle on it.
pub fn section_forces<const D: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    section: &Section<D>,
    halo: &dyn Halo,
) -> SectionForces {
    let mut sums = [const { Exact::ZERO }; 6];
    if let Some(cut) = Cut::of(grid, section) {
        for p in 0..points.len() {
            let volume = points.volume[p] * points.F.at(p).determinant();
            let share = cut.share(&points.x[p], volume);
            if share == 0.0 {
                continue;
            }
            if let Some(work) = with_width!(grid.order() + 1, W => cut.work::<W>(grid, points, p)) {
                // The force that balances is that of tau over the reference volume; sigma is tau over F-bar's J.
                let weight = share * volume * points.dilation_of(p);
                sums.iter_mut().zip(work).for_each(|(sum, work)| sum.add(weight * work));
            }
        }
    }
    let sums = halo.total(&sums);
    SectionForces { normal: sums[0], shear: [sums[1], sums[2]], torsion: sums[3], bending: [sums[4], sums[5]] }
}

/// A section that cuts the grid.
struct Cut<const D: usize> {
    middle: Vector<D>,
    along: [Vector<3>; 2], // unit vectors t1 and t2
    across: Vector<3>,     // unit vector n
    halves: [f64; 2],      // m  of its lengths along them
    round: bool,
    smear: f64, // m  over which the nodes' motion grows from 0 to 1
    reach: f64, // m  beyond which a point is from all of that
}

impl<const D: usize> Cut<D> {
    /// `None` of a section without an area, or whose middle has left the grid.
    fn of(grid: &Grid<D>, section: &Section<D>) -> Option<Self> {
        let middles = section.lines.iter().map(|[from, to]| (from + to) / 2.0);
        let middle = middles.sum::<Vector<D>>() / section.lines.len() as f64;
        let mut lines = section.lines.iter().map(|[from, to]| (spatial(&(to - from)), (to - from).norm()));
        let (first, length) = lines.next().filter(|(_, length)| *length > 0.0)?;
        let first = first / length;
        let (second, other) = match lines.next() {
            Some((line, length)) => ((line - first * line.dot(&first)).try_normalize(0.0)?, length),
            None => (Vector::<3>::z(), f64::INFINITY),
        };
        let across = first.cross(&second);
        let (_, size) = grid.cell_box(&grid.locate(&middle)?);
        let over = |size: &dyn Fn(usize) -> f64| (0..D).map(|axis| (across[axis] * size(axis)).abs()).sum::<f64>();
        let smear = over(&|axis| size[axis]);
        let support = over(&|number| {
            let axis = &grid.axes()[number];
            let lengths = (0..axis.cells()).map(|cell| axis.breakpoint(cell + 1) - axis.breakpoint(cell));
            lengths.fold(0.0, f64::max)
        });
        let reach = 0.5 * smear + (grid.order() as f64 + 1.0) * support;
        let (along, halves) = ([first, second], [0.5 * length, 0.5 * other]);
        Some(Self { middle, along, across, halves, round: section.round, smear, reach })
    }

    /// The part of a point of some volume (m^D) that is within the section's edge; 0 of one that is far from it.
    fn share(&self, x: &Vector<D>, volume: f64) -> f64 {
        let apart = spatial(&(x - self.middle));
        if apart.dot(&self.across).abs() > self.reach {
            return 0.0;
        }
        let volume = volume.max(f64::MIN_POSITIVE);
        let half = 0.5 * if D == 2 { volume.sqrt() } else { volume.cbrt() };
        let within = |at: f64, end: f64| {
            let inside = (at + half).min(end) - (at - half).max(-end);
            (inside / (2.0 * half)).clamp(0.0, 1.0)
        };
        let at = self.along.map(|along| apart.dot(&along));
        if self.round {
            let (away, part) = (at[0].hypot(at[1]), (at[0] / self.halves[0]).hypot(at[1] / self.halves[1]));
            // As far as the edge is on the ray through the point.
            return if part > 0.0 { within(away, away / part) } else { 1.0 };
        }
        (0..D - 1).map(|k| within(at[k], self.halves[k])).product()
    }

    /// Virtual work of the stress of a point per volume, Pa or N/m, on the motion of what is beyond the section: by 1
    /// along n, t1 and t2, by a rotation of 1 about n, against t2 and about t1 through the middle.
    fn work<const W: usize>(&self, grid: &Grid<D>, points: &Points<D>, p: usize) -> Option<[f64; 6]> {
        let cell = grid.locate(&points.x[p])?;
        let rows: [_; D] = std::array::from_fn(|axis| grid.axes()[axis].basis::<W>(points.x[p][axis], cell[axis]));
        let (mut slope, mut turn) = (Vector::<3>::zeros(), [[0.0; 3]; 3]);
        for node in 0..W.pow(D as u32) {
            let number: [usize; D] = std::array::from_fn(|axis| node / W.pow((D - 1 - axis) as u32) % W);
            let place = Vector::from_fn(|axis, _| grid.axes()[axis].greville(cell[axis] + number[axis]));
            let arm = spatial::<D>(&(place - self.middle));
            let beyond = (arm.dot(&self.across) / self.smear + 0.5).clamp(0.0, 1.0);
            let gradient = spatial(&Vector::<D>::from_fn(|along, _| {
                let factor =
                    |axis: usize| if axis == along { rows[axis].1[number[axis]] } else { rows[axis].0[number[axis]] };
                (0..D).map(factor).product()
            }));
            slope += gradient * beyond;
            (0..D).for_each(|i| (0..D).for_each(|j| turn[i][j] += beyond * arm[i] * gradient[j]));
        }
        let (traction, moment) = force_and_moment::<D>(&points.sigma.at(p).full(), &slope, &turn);
        let [first, second] = self.along;
        let forces = [self.across, first, second].map(|along| traction.dot(&along));
        let moments = [self.across, -second, first].map(|about| moment.dot(&about));
        Some(std::array::from_fn(|k| if k < 3 { forces[k] } else { moments[k - 3] }))
    }
}

/// Work of a stress on motions by 1 along the axes, `slope` the gradient of what moves, and on rotations by 1 about
/// them, `turn` the gradients of what moves times the components of the arm; in a plane about its normal alone.
fn force_and_moment<const D: usize>(
    stress: &Tensor,
    slope: &Vector<3>,
    turn: &[[f64; 3]; 3],
) -> (Vector<3>, Vector<3>) {
    let traction = Vector::<3>::from_fn(|i, _| (0..D).map(|j| stress[(i, j)] * slope[j]).sum());
    // On a rotation that moves by arm_b along a, and by -arm_a along b.
    let turned = |a: usize, b: usize| {
        let both = stress[(a, a)] * turn[b][a] - stress[(b, b)] * turn[a][b];
        let both = both + stress[(a, b)] * (turn[b][b] - turn[a][a]);
        let others = (0..D).filter(|c| ![a, b].contains(c));
        others.fold(both, |sum, c| sum + stress[(a, c)] * turn[b][c] - stress[(b, c)] * turn[a][c])
    };
    let moment = Vector::<3>::from_fn(|c, _| {
        let [a, b] = [(c + 1) % 3, (c + 2) % 3];
        if a.max(b) < D { turned(b, a) } else { 0.0 }
    });
    (traction, moment)
}

/// A vector in space; one of a plane has nothing along its normal.
fn spatial<const D: usize>(vector: &Vector<D>) -> Vector<3> {
    Vector::from_fn(|axis, _| if axis < D { vector[axis] } else { 0.0 })
}
