//! Rigid strips (section 3.3): footings, platens and clamps that move on a given path and hold the material at them.
//!
//! The paper holds the material by a penalty on boundary points (Cortis et al., 2018), whose slip is lost every step.
//! Here the traction of the last step is carried on, as a multiplier: p = p(t) + beta (motion - sum N u). What has
//! slipped in all steps together is then p / beta, so that a moderate penalty does. The hold is bilateral.

use super::surface::{Attachment, Surface, SurfacePoint};
use crate::exact::Exact;
use crate::grid::{Contributions, Grid};
use crate::nodal::Nodal;
use crate::parallel::{Halo, LinearSolver};
use crate::schedule::between;
use crate::tensor::Vector;

/// A displacement as a function of time, linear between its rows: a cut step follows the same path.
#[derive(Clone, Debug, PartialEq)]
pub struct Path<const D: usize> {
    /// s (or pseudo-time), increasing, and m; it starts at (0, 0) and stays after the last row
    pub rows: Vec<(f64, Vector<D>)>,
}

impl<const D: usize> Path<D> {
    /// Displacement at time `t`, m.
    pub fn at(&self, t: f64) -> Vector<D> {
        let stays = || self.rows.last().map_or_else(Vector::zeros, |(_, u)| *u);
        between(&self.rows, Vector::zeros(), t).unwrap_or_else(stays)
    }
}

/// A rigid strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip<const D: usize> {
    /// points along its base
    pub points: Vec<SurfacePoint<D>>,
    /// unit normal, if only the normal component is held; `None`: all are
    pub normal: Option<Vector<D>>,
    /// its motion
    pub path: Path<D>,
    /// Pa/m  penalty beta; 0: it holds nothing
    pub penalty: f64,
}

impl<const D: usize> Strip<D> {
    /// Whether it holds anything.
    pub fn acts(&self) -> bool {
        self.penalty > 0.0
    }
}

/// What a strip did in a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StripReport {
    /// N  force of the strip on the body, by component
    pub force: Vec<f64>,
    /// m  largest distance that the material has slipped from it in the step
    pub slip: f64,
    /// m  largest distance that the material has slipped from it in all steps together: held traction over the penalty
    pub accumulated: f64,
    /// m  length of its motion in the step, as far as it is held
    pub motion: f64,
    /// points with material at them
    pub held: usize,
    /// points that are more than half a cell ahead of the material that they held at the start
    pub left_behind: usize,
}

/// Work of strips in a step, by the mean of their tractions at its ends, N m.
#[derive(Clone, Debug, Default)]
pub struct GripWork {
    /// by the strips' motion
    pub given: Exact,
    /// by the displacement of the material at them
    pub taken: Exact,
    /// half of what the tractions have grown, times that displacement
    pub grown: Exact,
}

/// The strips' points of this rank in one step.
#[derive(Clone, Debug)]
pub struct StripAttachments<const D: usize> {
    offsets: Vec<usize>,
    held: Vec<StripPoint<D>>,
}

#[derive(Clone, Debug)]
struct StripPoint<const D: usize> {
    strip: usize,
    point: usize,
    attachment: [Option<Attachment>; D], // per component: where a support holds all of its nodes, the strip does not
    area: f64,
    penalty: f64,
    normal: Option<Vector<D>>,
    motion: Vector<D>,
    carried: Vector<D>,
}

impl<const D: usize> StripPoint<D> {
    /// The components that the strip and no support holds.
    fn own(&self, vector: Vector<D>) -> Vector<D> {
        Vector::from_fn(|component, _| if self.attachment[component].is_some() { vector[component] } else { 0.0 })
    }

    /// The part of a vector that is held.
    fn part(&self, vector: Vector<D>) -> Vector<D> {
        let own = self.own(vector);
        self.normal.map_or(own, |normal| self.own(normal * normal.dot(&own)))
    }

    /// m  of the material at the point; zero in components that are not held.
    fn displacement(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        let along = |component: usize| {
            let attachment = self.attachment[component].as_ref();
            attachment.map_or(0.0, |attachment| attachment.displacement::<D>(offsets, u)[component])
        };
        Vector::from_fn(|component, _| along(component))
    }

    /// m  what the material lags behind the strip.
    fn slip(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        self.part(self.motion - self.displacement(offsets, u))
    }

    /// Pa  on the body.
    fn traction(&self, offsets: &[usize], u: &[f64]) -> Vector<D> {
        self.own(self.carried) + self.slip(offsets, u) * self.penalty
    }

    /// Adds a force at the point to the nodes.
    fn spread(&self, offsets: &[usize], force: &Vector<D>, out: &mut Contributions) {
        for (component, attachment) in self.attachment.iter().enumerate() {
            let mut along = Vector::<D>::zeros();
            along[component] = force[component];
            if let Some(attachment) = attachment {
                attachment.scatter(offsets, &along, out);
            }
        }
    }

    /// Dense block of beta A N_a N_b in the held direction, over the nodes of the cell.
    fn block(&self, size: usize) -> Option<(usize, Vec<f64>)> {
        let first = self.attachment.iter().flatten().next()?.first_node();
        let direction = |j: usize| {
            let mut unit = Vector::zeros();
            unit[j] = self.penalty * self.area;
            self.part(unit)
        };
        let directions: [Vector<D>; D] = std::array::from_fn(direction);
        let N = |row: usize| self.attachment[row % D].as_ref().map_or(0.0, |attachment| attachment.N()[row / D]);
        let order = size * D;
        let entry = |at: usize| N(at / order) * N(at % order) * directions[at % order % D][at / order % D];
        Some((first, (0..order * order).map(entry).collect()))
    }
}

impl<const D: usize> StripAttachments<D> {
    /// Attaches the strips at their places at time `t`, to move until `t + dt`, by the components that are `free`:
    /// where a support of the grid holds a node, it stays the one that does.
    pub fn at(
        strips: &[Strip<D>],
        surface: &Surface<D>,
        (grid, free): (&Grid<D>, &[bool]),
        (t, dt): (f64, f64),
    ) -> Self {
        let (offsets, mut held) = (if strips.is_empty() { Vec::new() } else { grid.offsets() }, Vec::new());
        for (number, strip) in strips.iter().enumerate().filter(|(_, strip)| strip.acts()) {
            let (place, motion) = (strip.path.at(t), strip.path.at(t + dt) - strip.path.at(t));
            for (index, point) in strip.points.iter().enumerate() {
                let x = point.x + place;
                let attachment = std::array::from_fn(|c| {
                    Attachment::at(grid, &offsets, |node: usize| free[Nodal::<D>::at(node, c)], &x)
                });
                if attachment.iter().all(Option::is_none) {
                    continue;
                }
                held.push(StripPoint {
                    strip: number,
                    point: index,
                    attachment,
                    area: point.area,
                    penalty: strip.penalty,
                    normal: strip.normal,
                    motion,
                    carried: surface.traction[number][index],
                });
            }
        }
        Self { offsets, held }
    }

    /// Adds the strips' forces on the body to the nodes; other ranks' parts are not yet in them.
    pub fn add_forces(&self, u: &[f64], out: &mut Contributions) {
        for held in &self.held {
            held.spread(&self.offsets, &(held.traction(&self.offsets, u) * held.area), out);
        }
    }

    /// Adds the product of [`StripAttachments::assemble`]'s stiffness with `v`; other ranks' parts are not yet in it.
    pub fn multiply(&self, v: &[f64], out: &mut Contributions) {
        for held in &self.held {
            let force = held.part(held.displacement(&self.offsets, v)) * (held.penalty * held.area);
            held.spread(&self.offsets, &force, out);
        }
    }

    /// Adds beta A N_a N_b, in the held direction, to the stiffness.
    pub fn assemble(&self, solver: &mut dyn LinearSolver) {
        for (first_node, block) in self.held.iter().filter_map(|held| held.block(self.offsets.len())) {
            solver.add(first_node, &block);
        }
    }

    /// du . K du of the strips' stiffness on this rank, N m.
    pub fn energy(&self, du: &[f64]) -> Exact {
        let of = |held: &StripPoint<D>| {
            let moved = held.part(held.displacement(&self.offsets, du));
            held.penalty * held.area * moved.norm_squared()
        };
        self.held.iter().map(of).collect()
    }

    /// Work on this rank under the converged displacement `u`.
    pub fn work(&self, u: &[f64]) -> GripWork {
        let mut work = GripWork::default();
        for held in &self.held {
            let (before, after) = (held.own(held.carried), held.traction(&self.offsets, u));
            let (moved, mean) = (held.displacement(&self.offsets, u), (before + after) * (0.5 * held.area));
            work.given.add(mean.dot(&held.motion));
            work.taken.add(mean.dot(&moved));
            work.grown.add(0.5 * held.area * (after - before).dot(&moved));
        }
        work
    }

    /// What every strip did under the converged displacement `u`, and the tractions that the next step starts from.
    pub fn conclude(&self, strips: &[Strip<D>], u: &[f64], halo: &dyn Halo) -> (Vec<StripReport>, Vec<Vec<Vector<D>>>) {
        if strips.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let mut traction: Vec<Vec<Vector<D>>> = strips.iter().map(|s| vec![Vector::zeros(); s.points.len()]).collect();
        let (mut held_count, mut longest) = (vec![0.0; strips.len()], vec![0.0; 3 * strips.len()]);
        for held in &self.held {
            traction[held.strip][held.point] = held.traction(&self.offsets, u);
            held_count[held.strip] += 1.0;
            let (slip, motion) = (held.slip(&self.offsets, u).norm(), held.part(held.motion).norm());
            let accumulated = traction[held.strip][held.point].norm() / held.penalty;
            for (most, length) in longest[3 * held.strip..].iter_mut().zip([slip, accumulated, motion]) {
                *most = f64::max(*most, length);
            }
        }
        halo.maximum(&mut longest);
        halo.reduce(&mut held_count);
        reduce(&mut traction, halo);
        let report = |number: usize| {
            let shares = strips[number].points.iter().zip(&traction[number]);
            let force = shares.fold(Vector::<D>::zeros(), |sum, (point, traction)| sum + traction * point.area);
            let [slip, accumulated, motion] = [0, 1, 2].map(|k| longest[3 * number + k]);
            let (force, held) = (force.as_slice().to_vec(), held_count[number] as usize);
            StripReport { force, slip, accumulated, motion, held, left_behind: 0 }
        };
        ((0..strips.len()).map(report).collect(), traction)
    }
}

/// Sums vectors of which each is non-zero on one rank only: exact.
pub(super) fn reduce<const D: usize>(lists: &mut [Vec<Vector<D>>], halo: &dyn Halo) {
    let mut flat: Vec<f64> = lists.iter().flatten().flat_map(|vector| vector.iter().copied()).collect();
    halo.reduce(&mut flat);
    let summed = flat.chunks_exact(D).map(Vector::from_column_slice);
    lists.iter_mut().flatten().zip(summed).for_each(|(vector, sum)| *vector = sum);
}
