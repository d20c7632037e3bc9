//! Section forces: what the stress transmits across a line.
//!
//! They are the virtual work of the stress on motions of the grid that move one side of the line as a rigid body and
//! leave the other one. Forces on the nodes balance for such motions, so normal force, shear force and moment have
//! their equilibrium as exactly as the step has its own, however the stress oscillates from point to point.

use crate::exact::Exact;
use crate::grid::Grid;
use crate::grid::shape::with_width;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::Vector;

/// Forces of the material beyond a line on that before it, per metre of thickness.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionForces {
    /// N  int sigma_nn ds, n pointing to the right of the line's direction t; positive in tension
    pub normal: f64,
    /// N  int sigma_tn ds
    pub shear: f64,
    /// N m  int s sigma_nn ds, s along the line from its middle: positive where the side of its end is in tension
    pub moment: f64,
}

/// Forces across the line between two places (m, from the grid's lower corner); material beyond its ends, or none,
/// counts for nothing. The cut is smeared over the cells at the line, with its middle on it.
pub fn section_forces(grid: &Grid<2>, points: &Points<2>, ends: [Vector<2>; 2], halo: &dyn Halo) -> SectionForces {
    let mut sums = [const { Exact::ZERO }; 3];
    if let Some(cut) = Cut::of(grid, ends) {
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
    SectionForces { normal: sums[0], shear: sums[1], moment: sums[2] }
}

/// A line that cuts the grid.
struct Cut {
    middle: Vector<2>,
    along: Vector<2>,  // unit vector t
    across: Vector<2>, // unit vector n
    half: f64,         // m  of its length
    smear: f64,        // m  over which the nodes' motion grows from 0 to 1
    reach: f64,        // m  beyond which a point is from all of that
}

impl Cut {
    /// `None` of a line without a length, or whose middle has left the grid.
    fn of(grid: &Grid<2>, [from, to]: [Vector<2>; 2]) -> Option<Self> {
        let (middle, length) = ((from + to) / 2.0, (to - from).norm());
        let along = (length > 0.0).then(|| (to - from) / length)?;
        let across = Vector::from([along[1], -along[0]]);
        let (_, size) = grid.cell_box(&grid.locate(&middle)?);
        let smear = (across[0] * size[0]).abs() + (across[1] * size[1]).abs();
        let largest = grid.axes().each_ref().map(|axis| {
            let lengths = (0..axis.cells()).map(|cell| axis.breakpoint(cell + 1) - axis.breakpoint(cell));
            lengths.fold(0.0, f64::max)
        });
        let support = (across[0] * largest[0]).abs() + (across[1] * largest[1]).abs();
        let reach = 0.5 * smear + (grid.order() as f64 + 1.0) * support;
        Some(Self { middle, along, across, half: 0.5 * length, smear, reach })
    }

    /// The part of a point of some volume (m2) that is between the line's ends; 0 of one that is far from the line.
    fn share(&self, x: &Vector<2>, volume: f64) -> f64 {
        let apart = x - self.middle;
        if apart.dot(&self.across).abs() > self.reach {
            return 0.0;
        }
        let (at, half) = (apart.dot(&self.along), 0.5 * volume.max(f64::MIN_POSITIVE).sqrt());
        let inside = (at + half).min(self.half) - (at - half).max(-self.half);
        (inside / (2.0 * half)).clamp(0.0, 1.0)
    }

    /// Virtual work of the stress of a point per volume, Pa or N/m, on the motion of what is beyond the line: by 1
    /// along n, by 1 along t, by a rotation of 1 about the line's middle, clockwise.
    fn work<const W: usize>(&self, grid: &Grid<2>, points: &Points<2>, p: usize) -> Option<[f64; 3]> {
        let cell = grid.locate(&points.x[p])?;
        let [(Nx, dNx), (Ny, dNy)] = [0, 1].map(|axis| grid.axes()[axis].basis::<W>(points.x[p][axis], cell[axis]));
        let (mut slope, mut turn) = (Vector::<2>::zeros(), [[0.0; 2]; 2]);
        for (a, (&Nx, &dNx)) in Nx.iter().zip(&dNx).enumerate() {
            for (b, (&Ny, &dNy)) in Ny.iter().zip(&dNy).enumerate() {
                let node = Vector::from([grid.axes()[0].greville(cell[0] + a), grid.axes()[1].greville(cell[1] + b)]);
                let arm = node - self.middle;
                let beyond = (arm.dot(&self.across) / self.smear + 0.5).clamp(0.0, 1.0);
                let gradient = Vector::from([dNx * Ny, Nx * dNy]);
                slope += gradient * beyond;
                for (i, turned) in [arm[1], -arm[0]].into_iter().enumerate() {
                    (0..2).for_each(|j| turn[i][j] += beyond * turned * gradient[j]);
                }
            }
        }
        let [xx, yy, _, xy, ..] = points.sigma.at(p).0;
        let traction = Vector::from([xx * slope[0] + xy * slope[1], xy * slope[0] + yy * slope[1]]);
        let moment = xx * turn[0][0] + yy * turn[1][1] + xy * (turn[0][1] + turn[1][0]);
        Some([traction.dot(&self.across), traction.dot(&self.along), moment])
    }
}
