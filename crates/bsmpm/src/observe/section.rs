//! Section forces across a line or plane, theory-manual equations (T10.10) to (T10.12).

use crate::exact::Exact;
use crate::grid::Grid;
use crate::grid::shape::with_width;
use crate::kinematics::Kinematics;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::{Tensor, Vector};

/// Section across a body; positions in m from the grid's lower corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Section<const D: usize> {
    /// Ends of a line. A section of a solid has two lines that cross at their midpoints, with the directions t1 and t2.
    /// They should be perpendicular: the component of the second along the first is ignored.
    pub lines: Vec<[Vector<D>; 2]>,
    /// For a solid: whether the lines are the axes of an ellipse. Otherwise they are the lengths of the sides of a
    /// rectangle.
    pub round: bool,
}

/// Forces of the material beyond a section on the material before it. In a plane they are per metre of thickness; t is
/// the first direction, the second is the plane's normal, and its components are not reported. In axisymmetry they are
/// sums over one radian of the surface that the line generates, of components in the meridian plane, not of vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionForces {
    /// int sigma_nn dA (N), n = t1 x t2 (in a plane to the right of t); positive in tension.
    pub normal: f64,
    /// int sigma_1n dA and int sigma_2n dA (N).
    pub shear: [f64; 2],
    /// int s1 sigma_2n - s2 sigma_1n dA about n (N m); s is the position from the section's midpoint.
    pub torsion: f64,
    /// int s1 sigma_nn dA and int s2 sigma_nn dA (N m); positive if the side that t points to is in tension.
    pub bending: [f64; 2],
}

/// Returns the forces across a section. Material beyond its edge does not count. The cut is distributed over the cells
/// at the section, with its middle on the section. At a support or a surface it is distributed over cells inside the
/// body, and the forces are extrapolated to the section.
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
                // The equilibrium force is that of tau over the reference volume; sigma is tau divided by F-bar's J.
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

/// Section that intersects the grid.
struct SectionPlane<const D: usize> {
    middle: Vector<D>,
    along: [Vector<3>; 2], // unit vectors t1 and t2
    across: Vector<3>,     // unit vector n
    halves: [f64; 2],      // m, of its lengths along t1 and t2
    round: bool,
    smear: f64,           // m, distance over which the nodes' motion grows from 0 to 1 (a ramp)
    reach: f64,           // m, distance beyond which a point has no effect
    ramps: Vec<[f64; 2]>, // positions of the ramps along n (m) and their weights (-)
}

/// Space for a ramp on one side of a section, along n.
struct Side {
    room: f64,  // m, from the section to the end of the material
    least: f64, // m, smallest distance from the middle of a ramp to that end
    held: bool, // whether the material ends at a face of the grid
}

impl Side {
    /// Returns the distance by which a ramp at the section is too near to the end of the material (m).
    fn lack(&self) -> f64 {
        self.least - self.room
    }

    /// Returns whether a ramp that is too near to this end must be shifted towards the other end.
    fn gives_way_to(&self, other: &Self) -> bool {
        self.lack() > 0.0 && (other.lack() <= 0.0 || self.held && !other.held)
    }
}

impl<const D: usize> SectionPlane<D> {
    /// Creates a section plane with one ramp at the section; `None` if the section has no area, or if its middle has
    /// left the grid.
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

    /// Shifts the ramps so that neither supports nor loads on a surface act within them. The forces there are those at
    /// the section minus the loads between, so they are extrapolated. Returns `None` if the material does not extend to
    /// the section.
    fn inside<K: Kinematics<D>>(mut self, grid: &Grid<D>, points: &Points<D>, halo: &dyn Halo) -> Option<Self> {
        let sides = self.sides::<K>(grid, points, halo);
        if sides.iter().any(|side| side.room < -0.25 * self.smear) {
            return None;
        }
        let [before, beyond] = &sides;
        // In a body too thin for a ramp between its ends, only the face of the grid certainly exerts a force on it.
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

    /// Returns the space before and beyond the section. One reduction over all ranks.
    fn sides<K: Kinematics<D>>(&self, grid: &Grid<D>, points: &Points<D>, halo: &dyn Halo) -> [Side; 2] {
        // A function that is non-zero at a surface has its node within half of its support.
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
            // At a face only one layer of nodes moves the support, and the cells of the nearest q nodes are shorter: a
            // ramp over them would move another weight than that beyond its middle.
            let at_face = Side {
                room: face,
                least: 0.5 * grid.order() as f64 * self.smear,
                held,
            };
            if held { at_face } else { Side { room, least, held } }
        })
    }

    /// Returns the distance from the section to the face of the grid along or against n (m). If the section is almost
    /// parallel to the face, it is measured from the section's edge.
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

    /// Returns the fraction of the motion that a node has, from its position along n relative to the section (m).
    fn beyond(&self, place: f64) -> f64 {
        let ramps = self.ramps.iter();
        ramps
            .map(|[at, weight]| weight * ((place - at) / self.smear + 0.5).clamp(0.0, 1.0))
            .sum()
    }

    /// Returns the fraction of a point of the given volume (m^D of the grid) that is within the section's edge; 0 if
    /// the point is far from it.
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
            // The edge is at the distance away / part along the ray through the point.
            return if part > 0.0 {
                part_within(half, away, away / part)
            } else {
                1.0
            };
        }
        (0..D - 1).map(|k| part_within(half, at[k], self.halves[k])).product()
    }

    /// Returns the virtual work of a point's stress per volume (Pa or N/m) on rigid motions of the side beyond the
    /// section: unit translations along n, t1 and t2, and unit rotations through the middle about n, -t2 and t1.
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

/// Returns the sum of the edges along the axes, each projected onto `direction` (m).
fn extent_along<const D: usize>(direction: &Vector<3>, edges: &Vector<D>) -> f64 {
    (0..D).map(|axis| (direction[axis] * edges[axis]).abs()).sum::<f64>()
}

/// Returns the fraction of the interval `at` +- `half` that is between -`end` and `end` (all in m).
fn part_within(half: f64, at: f64, end: f64) -> f64 {
    let inside = (at + half).min(end) - (at - half).max(-end);
    (inside / (2.0 * half)).clamp(0.0, 1.0)
}

/// Returns the work of a stress on unit translations along the axes and on unit rotations about them. `slope` is the
/// gradient of the moved fraction; `turn` has its products with the components of the arm. In a plane there is only the
/// rotation about the normal.
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

/// Returns the work of a stress on a rotation with the displacements arm_b along a and -arm_a along b.
fn work_of_rotation<const D: usize>(stress: &Tensor, turn: &[[f64; 3]; 3], a: usize, b: usize) -> f64 {
    let both = stress[(a, a)] * turn[b][a] - stress[(b, b)] * turn[a][b];
    let both = both + stress[(a, b)] * (turn[b][b] - turn[a][a]);
    let others = (0..D).filter(|c| ![a, b].contains(c));
    others.fold(both, |sum, c| {
        sum + stress[(a, c)] * turn[b][c] - stress[(b, c)] * turn[a][c]
    })
}

/// Moves a position to the face of the grid if it is outside by less than half of the cell there: a section in a face
/// follows material whose motion is only known with that accuracy.
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

/// Extends a vector to three dimensions with zeros.
fn spatial<const D: usize>(vector: &Vector<D>) -> Vector<3> {
    Vector::from_fn(|axis, _| if axis < D { vector[axis] } else { 0.0 })
}
