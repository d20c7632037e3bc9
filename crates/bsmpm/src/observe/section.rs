//! Section forces across a line or plane, theory-manual equations (T10.10) to (T10.12): the virtual work of the stress
//! on a rigid motion of one side. Stress scatter has no effect.

use crate::exact::Exact;
use crate::grid::Grid;
use crate::grid::shape::with_width;
use crate::kinematics::Kinematics;
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
/// first direction and the second is the plane's normal, along which nothing is reported. In axisymmetry they are sums
/// over one radian of the surface that the line sweeps: of the components in the meridian plane, not of vectors.
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
/// the section, with its middle on it; at a support or a surface over cells inside of it, from which the forces are
/// extrapolated to the section.
pub fn section_forces<K: Kinematics<D>, const D: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    section: &Section<D>,
    halo: &dyn Halo,
) -> SectionForces {
    let mut sums = [const { Exact::ZERO }; 6];
    if let Some(cut) = SectionPlane::of(grid, section).and_then(|cut| cut.inside::<K>(grid, points, halo)) {
        for p in 0..points.len() {
            let volume = points.volume[p] * points.F.at(p).determinant();
            let share = cut.share(&points.x[p], volume / K::weight(&points.x[p]));
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
    let sums = halo.reproducible_sum(&sums);
    SectionForces {
        normal: sums[0],
        shear: [sums[1], sums[2]],
        torsion: sums[3],
        bending: [sums[4], sums[5]],
    }
}

/// A section that cuts the grid.
struct SectionPlane<const D: usize> {
    middle: Vector<D>,
    along: [Vector<3>; 2], // unit vectors t1 and t2
    across: Vector<3>,     // unit vector n
    halves: [f64; 2],      // m  of its lengths along them
    round: bool,
    smear: f64,           // m  over which the nodes' motion grows from 0 to 1
    reach: f64,           // m  beyond which a point is from all of that
    ramps: Vec<[f64; 2]>, // m, -  where along n it grows, and how much of it
}

/// How far a smeared cut may go to one side of a section along n.
struct Side {
    room: f64,  // m  from the section to the end of the material
    least: f64, // m  from the middle of a ramp to there
    held: bool, // whether the material ends at a face of the grid
}

impl Side {
    /// m  by which a ramp in the section is too near to the end
    fn lack(&self) -> f64 {
        self.least - self.room
    }

    /// Whether a ramp that is too near to this end moves towards the other one.
    fn gives_way_to(&self, other: &Self) -> bool {
        self.lack() > 0.0 && (other.lack() <= 0.0 || self.held && !other.held)
    }
}

impl<const D: usize> SectionPlane<D> {
    /// `None` of a section without an area, or whose middle has left the grid; its ramp is in the section.
    fn of(grid: &Grid<D>, section: &Section<D>) -> Option<Self> {
        let middles = section.lines.iter().map(|[from, to]| (from + to) / 2.0);
        let middle = onto(grid, middles.sum::<Vector<D>>() / section.lines.len() as f64);
        let mut lines = section
            .lines
            .iter()
            .map(|[from, to]| (spatial(&(to - from)), (to - from).norm()));
        let (first, length) = lines.next().filter(|(_, length)| *length > 0.0)?;
        let first = first / length;
        let (second, other) = match lines.next() {
            Some((line, length)) => ((line - first * line.dot(&first)).try_normalize(0.0)?, length),
            None => (Vector::<3>::z(), f64::INFINITY),
        };
        let across = first.cross(&second);
        let (_, size) = grid.cell_box(&grid.locate(&middle)?);
        let longest = Vector::<D>::from_fn(|axis, _| {
            let knots = &grid.axes()[axis];
            let lengths = (0..knots.cells()).map(|cell| knots.breakpoint(cell + 1) - knots.breakpoint(cell));
            lengths.fold(0.0, f64::max)
        });
        let smear = extent_along(&across, &size);
        let support = extent_along(&across, &longest);
        let reach = 0.5 * smear + (grid.order() as f64 + 1.0) * support;
        let along = [first, second];
        let halves = [0.5 * length, 0.5 * other];
        Some(Self {
            middle,
            along,
            across,
            halves,
            round: section.round,
            smear,
            reach,
            ramps: vec![[0.0, 1.0]],
        })
    }

    /// With ramps that neither what holds the material nor a load on its surface has a part in: its forces are those at
    /// the section less the loads between, so they are extrapolated. `None` where the material does not reach.
    fn inside<K: Kinematics<D>>(mut self, grid: &Grid<D>, points: &Points<D>, halo: &dyn Halo) -> Option<Self> {
        let sides = self.sides::<K>(grid, points, halo);
        if sides.iter().any(|side| side.room < -0.25 * self.smear) {
            return None;
        }
        let [before, beyond] = &sides;
        // Of a body too thin for a ramp between its ends the face of the grid is what surely acts on it.
        let (onward, shift) = if before.gives_way_to(beyond) {
            (1.0, before.lack())
        } else if beyond.gives_way_to(before) {
            (-1.0, beyond.lack())
        } else {
            return Some(self);
        };
        let left = -before.lack() - beyond.lack();
        let apart = self.smear.min(0.5 * left);
        let count = if apart >= 0.25 * self.smear { 3 } else { 1 };
        let places: Vec<f64> = (0..count).map(|k| onward * (shift + f64::from(k) * apart)).collect();
        self.ramps.clear();
        for (own, place) in places.iter().enumerate() {
            let others = places.iter().enumerate().filter(|(k, _)| *k != own);
            let weight = others.map(|(_, other)| other / (other - place)).product();
            self.ramps.push([*place, weight]);
        }
        self.reach += places[places.len() - 1].abs();
        Some(self)
    }

    /// Before and beyond the section.
    fn sides<K: Kinematics<D>>(&self, grid: &Grid<D>, points: &Points<D>, halo: &dyn Halo) -> [Side; 2] {
        // A function that is not zero at a surface has its node within half of its support.
        let least = (0.5 * grid.order() as f64 + 1.0) * self.smear;
        let far = 2.0 * least + 3.0 * self.smear;
        let mut ends = [-far; 2];
        let wide = Self {
            reach: far,
            ramps: Vec::new(),
            ..*self
        };
        for p in 0..points.len() {
            let volume = points.volume[p] * points.F.at(p).determinant() / K::weight(&points.x[p]);
            if wide.share(&points.x[p], volume) > 0.0 {
                let half = 0.5 * volume.powf(1.0 / D as f64);
                let apart = spatial(&(points.x[p] - self.middle)).dot(&self.across);
                ends = [ends[0].max(half - apart), ends[1].max(half + apart)];
            }
        }
        halo.all_reduce_max(&mut ends);
        [0, 1].map(|side| {
            let face = self.to_face(grid, side == 1);
            let room = ends[side];
            let held = room + 0.25 * self.smear >= face;
            // At a face one node moves what is held, and the cells of as many nodes as the order are shorter: a ramp
            // over them moves another weight than is beyond its middle.
            let at_face = Side {
                room: face,
                least: 0.5 * grid.order() as f64 * self.smear,
                held,
            };
            if held { at_face } else { Side { room, least, held } }
        })
    }

    /// From the section to the face of the grid along or against n, m: from its edge if it is all but parallel to it.
    fn to_face(&self, grid: &Grid<D>, along: bool) -> f64 {
        let mut least = f64::INFINITY;
        for axis in 0..D {
            let slope = if along { self.across[axis] } else { -self.across[axis] };
            if slope == 0.0 {
                continue;
            }
            let at = self.middle[axis];
            let length = grid.axes()[axis].length();
            let tilt: f64 = (0..D - 1).map(|k| self.halves[k] * self.along[k][axis].abs()).sum();
            let tilt = if tilt < 0.25 * self.smear { tilt } else { 0.0 };
            let straight = if slope > 0.0 { length - at } else { at };
            least = least.min((straight - tilt) / slope.abs());
        }
        least
    }

    /// Part of the motion that a node has, by its place along n from the section (m).
    fn beyond(&self, place: f64) -> f64 {
        let ramps = self.ramps.iter();
        ramps
            .map(|[at, weight]| weight * ((place - at) / self.smear + 0.5).clamp(0.0, 1.0))
            .sum()
    }

    /// The part of a point of some volume (m^D of the grid) that is within the section's edge; 0 of one that is far
    /// from it.
    fn share(&self, x: &Vector<D>, volume: f64) -> f64 {
        let apart = spatial(&(x - self.middle));
        if apart.dot(&self.across).abs() > self.reach {
            return 0.0;
        }
        let volume = volume.max(f64::MIN_POSITIVE);
        let half = 0.5 * if D == 2 { volume.sqrt() } else { volume.cbrt() };
        let at = self.along.map(|along| apart.dot(&along));
        if self.round {
            let away = at[0].hypot(at[1]);
            let part = (at[0] / self.halves[0]).hypot(at[1] / self.halves[1]);
            // As far as the edge is on the ray through the point.
            return if part > 0.0 {
                part_within(half, away, away / part)
            } else {
                1.0
            };
        }
        (0..D - 1).map(|k| part_within(half, at[k], self.halves[k])).product()
    }

    /// Virtual work of the stress of a point per volume, Pa or N/m, on the motion of what is beyond the section: by 1
    /// along n, t1 and t2, by a rotation of 1 about n, against t2 and about t1 through the middle.
    fn work<const W: usize>(&self, grid: &Grid<D>, points: &Points<D>, p: usize) -> Option<[f64; 6]> {
        let cell = grid.locate(&points.x[p])?;
        let rows: [_; D] = std::array::from_fn(|axis| grid.axes()[axis].basis::<W>(points.x[p][axis], cell[axis]));
        let mut slope = Vector::<3>::zeros();
        let mut turn = [[0.0; 3]; 3];
        for node in 0..W.pow(D as u32) {
            let number: [usize; D] = std::array::from_fn(|axis| node / W.pow((D - 1 - axis) as u32) % W);
            let place = Vector::from_fn(|axis, _| grid.axes()[axis].greville(cell[axis] + number[axis]));
            let arm = spatial::<D>(&(place - self.middle));
            let beyond = self.beyond(arm.dot(&self.across));
            let gradient = Vector::<D>::from_fn(|along, _| {
                let factors = (0..D).map(|axis| match axis == along {
                    true => rows[axis].1[number[axis]],
                    false => rows[axis].0[number[axis]],
                });
                factors.product()
            });
            let gradient = spatial(&gradient);
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

/// m  sum of edges along the axes, each projected onto a direction.
fn extent_along<const D: usize>(direction: &Vector<3>, edges: &Vector<D>) -> f64 {
    (0..D).map(|axis| (direction[axis] * edges[axis]).abs()).sum::<f64>()
}

/// Part of what reaches by `half` to each side of `at` that is nearer to 0 than `end`, all in m.
fn part_within(half: f64, at: f64, end: f64) -> f64 {
    let inside = (at + half).min(end) - (at - half).max(-end);
    (inside / (2.0 * half)).clamp(0.0, 1.0)
}

/// Work of a stress on motions by 1 along the axes, `slope` the gradient of what moves, and on rotations by 1 about
/// them, `turn` the gradients of what moves times the components of the arm; in a plane about its normal alone.
fn force_and_moment<const D: usize>(
    stress: &Tensor,
    slope: &Vector<3>,
    turn: &[[f64; 3]; 3],
) -> (Vector<3>, Vector<3>) {
    let traction = Vector::<3>::from_fn(|i, _| (0..D).map(|j| stress[(i, j)] * slope[j]).sum());
    let moment = Vector::<3>::from_fn(|c, _| {
        let [a, b] = [(c + 1) % 3, (c + 2) % 3];
        if a.max(b) < D {
            work_of_rotation::<D>(stress, turn, b, a)
        } else {
            0.0
        }
    });
    (traction, moment)
}

/// Work of a stress on a rotation that moves by arm_b along a, and by -arm_a along b.
fn work_of_rotation<const D: usize>(stress: &Tensor, turn: &[[f64; 3]; 3], a: usize, b: usize) -> f64 {
    let both = stress[(a, a)] * turn[b][a] - stress[(b, b)] * turn[a][b];
    let both = both + stress[(a, b)] * (turn[b][b] - turn[a][a]);
    let others = (0..D).filter(|c| ![a, b].contains(c));
    others.fold(both, |sum, c| {
        sum + stress[(a, c)] * turn[b][c] - stress[(b, c)] * turn[a][c]
    })
}

/// A place, on the face of the grid if it has left the grid by less than half of the cell there: a section in a face
/// goes with material whose motion is known to that.
fn onto<const D: usize>(grid: &Grid<D>, place: Vector<D>) -> Vector<D> {
    let nearest = Vector::from_fn(|axis, _| place[axis].clamp(0.0, grid.axes()[axis].length()));
    let Some(cell) = grid.locate(&nearest) else {
        return place;
    };
    let (_, size) = grid.cell_box(&cell);
    if (0..D).all(|axis| (place[axis] - nearest[axis]).abs() < 0.5 * size[axis]) {
        nearest
    } else {
        place
    }
}

/// A vector in space; one of a plane has nothing along its normal.
fn spatial<const D: usize>(vector: &Vector<D>) -> Vector<3> {
    Vector::from_fn(|axis, _| if axis < D { vector[axis] } else { 0.0 })
}
