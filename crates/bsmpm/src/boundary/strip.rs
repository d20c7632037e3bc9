//! Rigid footings and prescribed segments (`Strip`). A penalty stiffness imposes the displacement; its traction is
//! stored from step to step, theory-manual equations (T6.5), (T6.6). With a [`StripContact`], soil can slide and
//! separate (T7.5), (T7.6).
//!
//! # Adjacent footings
//!
//! Between adjacent footings with different motions, the prescribed displacement is a spline (T6.7). Surface points
//! there follow both motions in fixed proportions ([`MotionShare`]), which also divide their forces.

mod contact;
mod point;

use crate::schedule::TimeInterval;
pub use contact::StripContact;

use super::coulomb::ContactReport;
use super::surface::{Attachment, Surface, SurfacePoint, on_grid};
use crate::exact::Exact;
use crate::grid::{Contributions, Grid};
use crate::nodal::Nodal;
use crate::parallel::{Halo, LinearSolver};
use crate::schedule::{between, turns};
use crate::tensor::Vector;
use crate::water::pore_pressure::PorePressure;
use contact::ContactState;
use point::{LENGTHS, StripPoint, StripSums, contact_report};
use std::collections::{BTreeMap, BTreeSet};

/// A displacement as a function of time, linear between its rows: a cut step follows the same path.
#[derive(Clone, Debug, PartialEq)]
pub struct Path<const D: usize> {
    /// s (or pseudo-time), increasing, and m; it starts at (0, 0) and stays after the last row
    pub rows: Vec<(f64, Vector<D>)>,
}

impl<const D: usize> Path<D> {
    /// Displacement at time `t`, m.
    pub fn at(&self, t: f64) -> Vector<D> {
        let rows = &self.rows;
        between(rows, Vector::zeros(), t).unwrap_or_else(|| rows.last().map_or_else(Vector::zeros, |(_, u)| *u))
    }

    /// Whether it turns sharply in a step.
    pub(super) fn turns(&self, interval: TimeInterval) -> bool {
        turns(&self.rows, Vector::zeros(), |u| u.norm(), interval)
    }
}

/// A rigid strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip<const D: usize> {
    /// points along its base
    pub points: Vec<SurfacePoint<D>>,
    /// unit normal, if only the normal component is held; `None`: all are
    pub normal: Option<Vector<D>>,
    /// what it does instead of holding, if it does
    pub contact: Option<StripContact<D>>,
    /// its motion
    pub path: Path<D>,
    /// by number of a point: parts of other strips' motions in its own, see [the module](self)
    pub transitions: BTreeMap<usize, Vec<MotionShare<D>>>,
    /// Pa/m  penalty beta; 0: it holds nothing
    pub penalty: f64,
}

/// Part of another strip's motion in that of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionShare<const D: usize> {
    /// number of the other strip
    pub strip: usize,
    /// its part, at most 1 with all others
    pub share: f64,
    /// unit normal, if both strips hold the normal component only; `None`: both hold all
    pub normal: Option<Vector<D>>,
}

impl<const D: usize> MotionShare<D> {
    /// The part of a vector that is shared.
    fn of(&self, vector: &Vector<D>) -> Vector<D> {
        self.normal.map_or(*vector, |normal| normal * normal.dot(vector)) * self.share
    }
}

impl<const D: usize> Strip<D> {
    /// Whether it holds anything.
    pub fn acts(&self) -> bool {
        self.penalty > 0.0
    }

    /// Whether material comes off it.
    pub fn lifts(&self) -> bool {
        self.contact.is_some_and(|contact| contact.law.lifts)
    }

    /// m  of its points
    fn middle(&self) -> Vector<D> {
        let area: f64 = self.points.iter().map(|point| point.area).sum();
        self.points
            .iter()
            .fold(Vector::<D>::zeros(), |sum, point| sum + point.x * point.area)
            / area
    }

    /// Other strips whose motions one of its points follows in part.
    fn others(&self, point: usize) -> &[MotionShare<D>] {
        self.transitions.get(&point).map_or(&[], Vec::as_slice)
    }

    /// What other strips leave of a vector at one of its points.
    fn own(&self, point: usize, vector: &Vector<D>) -> Vector<D> {
        self.others(point)
            .iter()
            .fold(*vector, |rest, other| rest - other.of(vector))
    }
}

/// Displacement of a point of strip `number` at time `t`, m.
pub fn displacement<const D: usize>(strips: &[Strip<D>], number: usize, point: usize, t: f64) -> Vector<D> {
    let strip = &strips[number];
    let own = strip.own(point, &strip.path.at(t));
    strip
        .others(point)
        .iter()
        .fold(own, |sum, other| sum + other.of(&strips[other.strip].path.at(t)))
}

/// Force of a strip on the body.
#[derive(Clone, Copy, Debug)]
struct Resultant<const D: usize> {
    force: Vector<D>, // N
    moment: f64,      // N m  about the strip's middle in the plane of the axes 0 and 1, counter-clockwise
}

impl<const D: usize> Resultant<D> {
    /// Adds a force, N, that acts at `arm`, m, from the middle.
    fn add(&mut self, force: Vector<D>, arm: Vector<D>) {
        self.force += force;
        self.moment += arm[0] * force[1] - arm[1] * force[0];
    }
}

/// Forces of all strips on the body, of what their points carry. The force at a point belongs to the strips whose
/// motions it follows, by the same parts, so that force times motion is the work.
fn resultants<const D: usize>(strips: &[Strip<D>], carried: &[Vec<Vector<D>>]) -> Vec<Resultant<D>> {
    let middles: Vec<Vector<D>> = strips.iter().map(Strip::middle).collect();
    let mut resultants = vec![
        Resultant {
            force: Vector::zeros(),
            moment: 0.0
        };
        strips.len()
    ];
    for (number, strip) in strips.iter().enumerate() {
        for (at, (point, carried)) in strip.points.iter().zip(&carried[number]).enumerate() {
            let acting = strip.contact.map_or(*carried, |contact| contact.acting(carried)) * point.area;
            resultants[number].add(strip.own(at, &acting), point.x - middles[number]);
            for other in strip.others(at) {
                resultants[other.strip].add(other.of(&acting), point.x - middles[other.strip]);
            }
        }
    }
    resultants
}

/// Nodes of the window whose functions reach a point of a strip at time `t`.
pub fn nodes_at<const D: usize>(strips: &[Strip<D>], grid: &Grid<D>, t: f64) -> BTreeSet<usize> {
    let mut nodes = BTreeSet::new();
    for (number, strip) in strips.iter().enumerate().filter(|(_, strip)| strip.acts()) {
        let points = strip.points.iter().enumerate();
        let places = points.map(|(at, point)| point.x + displacement(strips, number, at, t));
        let cells: BTreeSet<[usize; D]> = places.filter_map(|place| grid.locate(&on_grid(grid, &place))).collect();
        let functions = cells.into_iter().flat_map(|cell| grid.functions_of(cell));
        nodes.extend(functions.filter_map(|function| grid.node_index(&function)));
    }
    nodes
}

/// What a strip did in a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StripReport {
    /// N  force of the strip on the body, by component
    pub force: Vec<f64>,
    /// N m  moment of it about the strip's middle, in the plane of the axes 0 and 1, counter-clockwise
    pub moment: f64,
    /// J  work of it on the strip's motion in the step
    pub work: f64,
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
    /// of a strip in contact
    pub contact: Option<ContactReport>,
    /// points that came back to material in the step more than half a cell from where they had come off it
    pub moved_on: usize,
}

/// Work of strips in a step, by the mean of their tractions at its ends, N m.
#[derive(Clone, Debug, Default)]
pub struct StripWork {
    /// by the strips' motion
    pub given: Exact,
    /// by the displacement of the material at them
    pub taken: Exact,
    /// half of what the tractions have grown, times that displacement
    pub grown: Exact,
    /// of the first, what friction at strips dissipates
    pub friction_work: Exact,
}

/// The strips' points of this rank in one step.
#[derive(Clone, Debug)]
pub struct StripConstraints<const D: usize> {
    offsets: Vec<usize>,
    interval: TimeInterval,
    held: Vec<StripPoint<D>>,
}

impl<const D: usize> StripConstraints<D> {
    /// Attaches the strips at their places at time `t`, to move until `t + dt`, by the components that are `free`:
    /// where a support of the grid holds a node, it stays the one that does.
    pub fn at(
        strips: &[Strip<D>],
        surface: &Surface<D>,
        grid: &Grid<D>,
        free: &[bool],
        interval: TimeInterval,
    ) -> Self {
        let offsets = if strips.is_empty() { Vec::new() } else { grid.offsets() };
        let mut held = Vec::new();
        for (number, strip) in strips.iter().enumerate().filter(|(_, strip)| strip.acts()) {
            for (index, point) in strip.points.iter().enumerate() {
                let place = displacement(strips, number, index, interval.start);
                let motion = displacement(strips, number, index, interval.end()) - place;
                let carried = surface.traction[number][index];
                let state = strip.contact.map(|contact| ContactState::of(contact, &carried));
                // The material across a gap is what the gap is to.
                let off = strip
                    .contact
                    .zip(state)
                    .map(|(contact, state)| contact.inward * state.gap_before(&carried, strip.penalty));
                let x = point.x + place;
                let x = off.map_or(x, |off| x + off);
                let attachment = std::array::from_fn(|c| {
                    Attachment::at(grid, &offsets, |node: usize| free[Nodal::<D>::at(node, c)], &x)
                });
                if attachment.iter().all(Option::is_none) {
                    continue;
                }
                held.push(StripPoint {
                    strip: number,
                    point: index,
                    place: x,
                    attachment,
                    area: point.area,
                    penalty: strip.penalty,
                    normal: strip.normal,
                    motion,
                    carried,
                    state,
                });
            }
        }
        Self {
            offsets,
            interval,
            held,
        }
    }

    /// Takes what pore water carries of the pressure at points in contact off what friction acts on.
    pub fn wet(&mut self, pores: Option<&PorePressure<D>>) {
        let Some(pores) = pores else { return };
        let offsets = &self.offsets;
        for held in &mut self.held {
            let Some(attachment) = held.attachment.iter().flatten().next() else {
                continue;
            };
            let water = pores.at(attachment.weights(offsets), &held.place);
            held.state.iter_mut().for_each(|state| state.water = water);
        }
    }

    /// Expects of points in contact what the last displacement, `guess`, makes likely.
    pub fn predict_status(&mut self, guess: &[f64]) {
        let offsets = &self.offsets;
        for held in &mut self.held {
            let Some(mut state) = held.state else { continue };
            let trial = held.trial(&state, offsets, guess);
            let before = held.own(state.start(&held.carried));
            state.recall(&trial, &before);
            held.state = Some(state);
        }
    }

    /// Corrects what the displacement `u` (m) contradicts by more than `force`, N; how many points over all ranks.
    pub fn correct(&mut self, u: &[f64], force: f64, halo: &dyn Halo) -> usize {
        let offsets = &self.offsets;
        let mut corrected = [0.0];
        for held in &mut self.held {
            let Some(mut state) = held.state else { continue };
            let is_corrected = state.correct(&held.trial(&state, offsets, u), force / held.area);
            corrected[0] += f64::from(u8::from(is_corrected));
            held.state = Some(state);
        }
        halo.all_reduce_sum(&mut corrected);
        corrected[0] as usize
    }

    /// Adds the strips' forces on the body to the nodes; other ranks' parts are not yet in them.
    pub fn add_forces(&self, u: &[f64], out: &mut Contributions) {
        for held in &self.held {
            held.spread(&self.offsets, &(held.traction(&self.offsets, u) * held.area), out);
        }
    }

    /// Adds the product of [`StripConstraints::assemble`]'s stiffness with `v`; other ranks' parts are not yet in it.
    pub fn multiply(&self, v: &[f64], out: &mut Contributions) {
        for held in &self.held {
            let moved = held.displacement(&self.offsets, v);
            let force = held.part(moved) * (held.penalty * held.area);
            let force = match &held.state {
                Some(state) => force + held.own(state.rubbing(&moved)) * (held.penalty * held.area),
                None => force,
            };
            held.spread(&self.offsets, &force, out);
        }
    }

    /// Adds beta A N_a N_b, in the held direction, to the stiffness.
    pub fn assemble(&self, solver: &mut dyn LinearSolver) {
        for (first_node, block) in self.held.iter().filter_map(|held| held.block(self.offsets.len())) {
            solver.add_block(first_node, &block);
        }
    }

    /// du . K du of the strips' stiffness on this rank, N m.
    pub fn energy(&self, du: &[f64]) -> Exact {
        let energies = self.held.iter().map(|held| {
            let moved = held.part(held.displacement(&self.offsets, du));
            held.penalty * held.area * moved.norm_squared()
        });
        energies.collect()
    }

    /// Work on this rank under the converged displacement `u`.
    pub fn work(&self, u: &[f64]) -> StripWork {
        let mut work = StripWork::default();
        for held in &self.held {
            let before = held.before();
            let after = held.traction(&self.offsets, u);
            let moved = held.displacement(&self.offsets, u);
            let mean = held.mean(&self.offsets, u);
            work.given.add(mean.dot(&held.motion));
            work.taken.add(mean.dot(&moved));
            if let Some(state) = &held.state {
                work.friction_work
                    .add(mean.dot(&state.slid(&held.trial(state, &self.offsets, u), held.penalty)));
                // The force at the end, less the one that is counted.
                work.grown.add((after * held.area - mean).dot(&moved));
            } else {
                work.grown.add(0.5 * held.area * (after - before).dot(&moved));
            }
        }
        work
    }

    /// What every strip did under the converged displacement `u`, and the tractions that the next step starts from.
    pub fn finish_step(
        &self,
        strips: &[Strip<D>],
        grid: &Grid<D>,
        surface: &Surface<D>,
        u: &[f64],
        halo: &dyn Halo,
    ) -> (Vec<StripReport>, Vec<Vec<Vector<D>>>) {
        if strips.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let at_rest = strips.iter().map(|strip| vec![Vector::zeros(); strip.points.len()]);
        let mut traction: Vec<Vec<Vector<D>>> = at_rest.collect();
        // Which points of strips that lift are held by some rank.
        let mut there = traction.clone();
        let others = strips.iter().zip(&mut there).filter(|(strip, _)| !strip.lifts());
        others.for_each(|(_, list)| list.clear());
        let mut sums: Vec<StripSums> = strips.iter().map(|_| StripSums::default()).collect();
        let mut longest = vec![0.0; LENGTHS * strips.len()];
        for (number, _) in strips.iter().enumerate().filter(|(_, strip)| strip.contact.is_some()) {
            longest[LENGTHS * number + 3] = f64::NEG_INFINITY;
        }
        for held in &self.held {
            let lengths = held.lengths(&self.offsets, u, grid.smallest_edge(), &mut sums[held.strip]);
            let acting = held.traction(&self.offsets, u);
            sums[held.strip].held.add(1.0);
            let mean = held.mean(&self.offsets, u);
            self.add_given(strips, held, &mean, &mut sums);
            let most = longest[LENGTHS * held.strip..].iter_mut().zip(lengths);
            most.for_each(|(most, length)| *most = f64::max(*most, length));
            traction[held.strip][held.point] = match &held.state {
                Some(state) => held.own(state.carry(&held.trial(state, &self.offsets, u), &held.carried)),
                None => acting,
            };
            if let Some(there) = there[held.strip].get_mut(held.point) {
                there[0] = 1.0;
            }
        }
        halo.all_reduce_max(&mut longest);
        let contact = strips.iter().any(|strip| strip.contact.is_some());
        let totals = halo.reproducible_sum(&sums.iter().flat_map(|sums| sums.each(contact)).collect::<Vec<_>>());
        let count = traction.len();
        traction.extend(there);
        reduce(&mut traction, halo);
        let there = traction.split_off(count);
        self.keep_apart(strips, &there, surface, &mut traction);
        let resultants = resultants(strips, &traction);
        let of_strip = totals.len() / strips.len();
        let reports = strips.iter().enumerate().map(|(number, strip)| {
            let totals = &totals[of_strip * number..][..of_strip];
            let lengths = &longest[LENGTHS * number..][..LENGTHS];
            let contact = strip.contact.map(|_| contact_report(number, totals, lengths));
            report(&resultants[number], totals, lengths, contact)
        });
        (reports.collect(), traction)
    }

    /// Adds the work of the mean force of a point, N, on the motions of the strips that it follows.
    fn add_given(&self, strips: &[Strip<D>], held: &StripPoint<D>, mean: &Vector<D>, sums: &mut [StripSums]) {
        let strip = &strips[held.strip];
        let given = strip.own(held.point, mean).dot(&self.motion(strip));
        sums[held.strip].given.add(given);
        for other in strip.others(held.point) {
            let given = other.of(mean).dot(&self.motion(&strips[other.strip]));
            sums[other.strip].given.add(given);
        }
    }

    /// m  of a strip in the step.
    fn motion(&self, strip: &Strip<D>) -> Vector<D> {
        strip.path.at(self.interval.end()) - strip.path.at(self.interval.start)
    }

    /// Goes on with the gaps of points that have no material across them, which is then taken to rest.
    fn keep_apart(
        &self,
        strips: &[Strip<D>],
        there: &[Vec<Vector<D>>],
        surface: &Surface<D>,
        traction: &mut [Vec<Vector<D>>],
    ) {
        for (number, strip) in strips
            .iter()
            .enumerate()
            .filter(|(_, strip)| strip.acts() && strip.lifts())
        {
            let Some(StripContact { inward, .. }) = strip.contact else {
                continue;
            };
            let times = [self.interval.start, self.interval.end()];
            for (point, _) in there[number].iter().enumerate().filter(|(_, there)| there[0] == 0.0) {
                let [start, end] = times.map(|t| displacement(strips, number, point, t));
                let closer = (end - start).dot(&inward);
                let before = inward.dot(&surface.traction[number][point]).min(0.0);
                traction[number][point] = inward * (before + strip.penalty * closer).min(0.0);
            }
        }
    }
}

/// What a strip did, by its force, the totals and the largest lengths of its points.
fn report<const D: usize>(
    resultant: &Resultant<D>,
    totals: &[f64],
    lengths: &[f64],
    contact: Option<ContactReport>,
) -> StripReport {
    StripReport {
        force: resultant.force.as_slice().to_vec(),
        moment: resultant.moment,
        work: totals[1],
        slip: lengths[0],
        accumulated: lengths[1],
        motion: lengths[2],
        held: totals[0] as usize,
        left_behind: 0,
        moved_on: totals.get(7).map_or(0, |count| *count as usize),
        contact,
    }
}

/// Sums vectors of which each is non-zero on one rank only: exact.
pub(super) fn reduce<const D: usize>(lists: &mut [Vec<Vector<D>>], halo: &dyn Halo) {
    let mut flat: Vec<f64> = lists
        .iter()
        .flatten()
        .flat_map(|vector| vector.iter().copied())
        .collect();
    halo.all_reduce_sum(&mut flat);
    let summed = flat.chunks_exact(D).map(Vector::from_column_slice);
    lists
        .iter_mut()
        .flatten()
        .zip(summed)
        .for_each(|(vector, sum)| *vector = sum);
}
