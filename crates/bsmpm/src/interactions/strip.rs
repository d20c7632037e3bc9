//! Rigid footings and prescribed segments (`Strip`). A penalty stiffness imposes the displacement; its traction is
//! stored from step to step, theory-manual equations (T6.5), (T6.6). Between adjacent footings, surface points follow
//! both motions (T6.7). With a [`StripContact`], soil can slide and separate (T7.5), (T7.6).

mod contact;
mod interaction;
mod point;
mod resultant;

use crate::schedule::TimeInterval;
pub use contact::StripContact;
pub use interaction::begin;

use super::coulomb::ContactReport;
use crate::boundary::surface::{Attachment, SurfacePoint, on_grid};
use crate::exact::Exact;
use crate::field::pore_water::pore_pressure::PorePressure;
use crate::grid::{Contributions, Grid};
use crate::interactions::state::InteractionState;
use crate::linear::MatrixAssembly;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::schedule::{between, turns};
use crate::tensor::Vector;
use contact::ContactState;
use point::{LENGTHS, StripPoint, StripSums, contact_report};
use resultant::{Resultant, resultants};
use std::collections::{BTreeMap, BTreeSet};

/// Prescribed displacement as a function of time, linear between its rows. Cutbacks follow the same path.
#[derive(Clone, Debug, PartialEq)]
pub struct Path<const D: usize> {
    /// Increasing times (s, or pseudo-time) and displacements (m). The path starts at (0, 0) and is constant after the
    /// last row.
    pub rows: Vec<(f64, Vector<D>)>,
}

impl<const D: usize> Path<D> {
    /// Returns the displacement at time `t` (m).
    pub fn at(&self, t: f64) -> Vector<D> {
        let rows = &self.rows;
        between(rows, Vector::zeros(), t).unwrap_or_else(|| rows.last().map_or_else(Vector::zeros, |(_, u)| *u))
    }

    /// Returns whether the velocity changes sharply in the interval.
    pub(crate) fn turns(&self, interval: TimeInterval) -> bool {
        turns(&self.rows, Vector::zeros(), |u| u.norm(), interval)
    }
}

/// A rigid footing or prescribed segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip<const D: usize> {
    /// Surface points of the base.
    pub points: Vec<SurfacePoint<D>>,
    /// Unit normal if only the normal component is prescribed; `None`: all components.
    pub normal: Option<Vector<D>>,
    /// Contact law; `None`: the soil is tied to the strip.
    pub contact: Option<StripContact<D>>,
    /// Prescribed displacement.
    pub path: Path<D>,
    /// Shares of other strips' motions in the motion of a point, by index of the point; see [the module](self).
    pub transitions: BTreeMap<usize, Vec<MotionShare<D>>>,
    /// Penalty stiffness beta (Pa/m); 0: the strip is inactive.
    pub penalty: f64,
}

/// Share of another strip's motion in the motion of a surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionShare<const D: usize> {
    /// Index of the other strip.
    pub strip: usize,
    /// Its share. The shares of all other strips add up to at most 1.
    pub share: f64,
    /// Unit normal if both strips prescribe only the normal component; `None`: all components.
    pub normal: Option<Vector<D>>,
}

impl<const D: usize> MotionShare<D> {
    /// Returns the part of a vector that belongs to the other strip.
    fn of(&self, vector: &Vector<D>) -> Vector<D> {
        self.normal.map_or(*vector, |normal| normal * normal.dot(vector)) * self.share
    }
}

impl<const D: usize> Strip<D> {
    /// Returns whether the strip is active.
    pub fn acts(&self) -> bool {
        self.penalty > 0.0
    }

    /// Returns whether the material can separate from the strip.
    pub fn lifts(&self) -> bool {
        self.contact.is_some_and(|contact| contact.law.lifts)
    }

    /// Returns the centroid of its points (m).
    fn middle(&self) -> Vector<D> {
        let area: f64 = self.points.iter().map(|point| point.area).sum();
        self.points
            .iter()
            .fold(Vector::<D>::zeros(), |sum, point| sum + point.x * point.area)
            / area
    }

    /// Returns the shares of other strips' motions at a point.
    fn others(&self, point: usize) -> &[MotionShare<D>] {
        self.transitions.get(&point).map_or(&[], Vec::as_slice)
    }

    /// Returns the vector at a point less the parts of other strips.
    fn own(&self, point: usize, vector: &Vector<D>) -> Vector<D> {
        self.others(point)
            .iter()
            .fold(*vector, |rest, other| rest - other.of(vector))
    }
}

/// Returns the prescribed displacement of a point of strip `number` at time `t` (m).
pub fn displacement<const D: usize>(strips: &[Strip<D>], number: usize, point: usize, t: f64) -> Vector<D> {
    let strip = &strips[number];
    let own = strip.own(point, &strip.path.at(t));
    strip
        .others(point)
        .iter()
        .fold(own, |sum, other| sum + other.of(&strips[other.strip].path.at(t)))
}

/// Returns the local nodes whose functions are non-zero at a point of an active strip at time `t`.
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

/// Results of a strip for one step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StripReport {
    /// Force of the strip on the body (N), D components.
    pub force: Vec<f64>,
    /// Moment of this force about the strip's centroid, in the plane of axes 0 and 1, counter-clockwise (N m).
    pub moment: f64,
    /// Work of this force on the strip's motion in the step (J).
    pub work: f64,
    /// Largest displacement of the material relative to the strip in the step (m).
    pub slip: f64,
    /// Largest displacement of the material relative to the strip since the start: traction divided by the penalty (m).
    pub accumulated: f64,
    /// Length of the prescribed displacement in the step (m).
    pub motion: f64,
    /// Number of points that have material.
    pub held: usize,
    /// Number of points more than half a cell ahead of the material that they were tied to at the start.
    pub left_behind: usize,
    /// Contact results, if the strip has contact.
    pub contact: Option<ContactReport>,
    /// Number of points that touched material again in the step, more than half a cell from where they had separated.
    pub moved_on: usize,
}

/// Work of all strips in a step, with the mean of the tractions at start and end (N m).
#[derive(Clone, Debug, Default)]
pub struct StripWork {
    /// Work on the motion of the strips.
    pub given: Exact,
    /// Work on the displacement of the material at the strips.
    pub taken: Exact,
    /// Work of half of the increase of the tractions on this displacement.
    pub grown: Exact,
    /// Energy dissipated by friction, contained in `given`.
    pub friction_work: Exact,
}

/// Surface points of all strips on this rank in one step.
#[derive(Clone, Debug)]
pub struct StripConstraints<const D: usize> {
    offsets: Vec<usize>,
    interval: TimeInterval,
    held: Vec<StripPoint<D>>,
    has_contact: bool,  // any strip, on any rank
    has_friction: bool, // any strip, on any rank
}

impl<const D: usize> StripConstraints<D> {
    /// Attaches the points of all active strips, at their positions at the start of the interval, to the components
    /// that are `free`. Supports take precedence: a strip does not act on components that a support prescribes.
    pub fn at(
        strips: &[Strip<D>],
        before: &InteractionState<D>,
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
                let carried = before.traction[number][index];
                let state = strip.contact.map(|contact| ContactState::of(contact, &carried));
                // An open point is attached to the material across its gap.
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
        let mut contacts = strips.iter().filter_map(|strip| strip.contact);
        Self {
            offsets,
            interval,
            held,
            has_contact: strips.iter().any(|strip| strip.contact.is_some()),
            has_friction: contacts.any(|contact| contact.law.friction > 0.0),
        }
    }

    /// Sets the pore pressure at points in contact; Coulomb's law uses the effective pressure.
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

    /// Predicts the contact statuses from `guess`, the displacement of the last step (m).
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

    /// Corrects the contact statuses that the displacement `u` (m) contradicts by more than `force` (N). Returns the
    /// number of corrected points. One reduction over all ranks.
    pub fn correct_statuses(&mut self, u: &[f64], force: f64, halo: &dyn Halo) -> usize {
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

    /// Adds the forces of the strips on the body to the nodes (N), this rank's contributions only.
    pub fn add_forces(&self, u: &[f64], out: &mut Contributions) {
        for held in &self.held {
            held.spread(&self.offsets, &(held.traction(&self.offsets, u) * held.area), out);
        }
    }

    /// Adds the product of the stiffness of [`StripConstraints::add_stiffness`], and of the derivative of friction by
    /// the pressure, with `v`; this rank's contributions only.
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

    /// Adds beta A N_a N_b, in the prescribed directions, to the stiffness.
    pub fn add_stiffness(&self, matrix: &mut dyn MatrixAssembly) {
        for (first_node, block) in self.held.iter().filter_map(|held| held.block(self.offsets.len())) {
            matrix.add_block(first_node, &block);
        }
    }

    /// Returns du . K du of the strips' stiffness on this rank (N m).
    pub fn energy(&self, du: &[f64]) -> Exact {
        let energies = self.held.iter().map(|held| {
            let moved = held.part(held.displacement(&self.offsets, du));
            held.penalty * held.area * moved.norm_squared()
        });
        energies.collect()
    }

    /// Returns the work on this rank under the converged displacement `u` (m).
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
                // Force at the end less the mean force.
                work.grown.add((after * held.area - mean).dot(&moved));
            } else {
                work.grown.add(0.5 * held.area * (after - before).dot(&moved));
            }
        }
        work
    }

    /// Returns the results of every strip under the converged displacement `u` (m), and the tractions with which the
    /// next step starts (Pa). `before` are the tractions with which this one started (Pa). Three reductions over all
    /// ranks.
    pub fn finish_step(
        &self,
        strips: &[Strip<D>],
        grid: &Grid<D>,
        before: &[Vec<Vector<D>>],
        u: &[f64],
        halo: &dyn Halo,
    ) -> (Vec<StripReport>, Vec<Vec<Vector<D>>>) {
        if strips.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let at_rest = strips.iter().map(|strip| vec![Vector::zeros(); strip.points.len()]);
        let mut traction: Vec<Vec<Vector<D>>> = at_rest.collect();
        // Marks the points of separating strips that some rank has.
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
        self.keep_apart(strips, &there, before, &mut traction);
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

    /// Adds the work of the `mean` force of a point (N) on the motions of the strips that it follows.
    fn add_given(&self, strips: &[Strip<D>], held: &StripPoint<D>, mean: &Vector<D>, sums: &mut [StripSums]) {
        let strip = &strips[held.strip];
        let given = strip.own(held.point, mean).dot(&self.motion(strip));
        sums[held.strip].given.add(given);
        for other in strip.others(held.point) {
            let given = other.of(mean).dot(&self.motion(&strips[other.strip]));
            sums[other.strip].given.add(given);
        }
    }

    /// Returns the displacement of a strip in the step (m).
    fn motion(&self, strip: &Strip<D>) -> Vector<D> {
        strip.path.at(self.interval.end()) - strip.path.at(self.interval.start)
    }

    /// Updates the gaps of points that have no material in range, which is then assumed to be at rest.
    fn keep_apart(
        &self,
        strips: &[Strip<D>],
        there: &[Vec<Vector<D>>],
        before: &[Vec<Vector<D>>],
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
                let gap = inward.dot(&before[number][point]).min(0.0);
                traction[number][point] = inward * (gap + strip.penalty * closer).min(0.0);
            }
        }
    }
}

/// Assembles the results of a strip from its force, and from the sums and largest lengths over its points.
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

/// Sums vectors over all ranks. Each is non-zero on one rank only, so the sum is exact.
pub(crate) fn reduce<const D: usize>(lists: &mut [Vec<Vector<D>>], halo: &dyn Halo) {
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
