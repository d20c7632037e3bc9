//! Rigid bodies and terrain in frictional contact with material points, theory-manual equations (T7.7) to (T7.10).
//! Contacts are detected at the start of a step; [`solve::contact`](crate::solve::contact) later corrects their
//! statuses (open, stick, slip).

mod body;
mod extent;
mod interaction;
mod motion;
mod near;
mod neutral;
mod outline;
mod point;
mod surroundings;
mod terrain;

pub use body::{MOTIONS, RigidBody, RigidState, overlapping};
pub use extent::extents;
pub use interaction::begin;
pub use outline::{Nearest, Outline, Sizes};
pub use point::{Along, ContactStatus};
pub use surroundings::{ParticleDomains, Surroundings};
pub use terrain::Terrain;

use crate::error::StepError;
use crate::exact::Exact;
use crate::grid::{Contributions, Grid};
use crate::linear::MatrixAssembly;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::tensor::Vector;
use motion::BodyInStep;
use nalgebra::Matrix3;
use point::RigidPoint;

/// Penalty stiffness of a contact point as a multiple of the stiffness E A/h of its material plus its inertia. With ten
/// times as much, steps in plastic failure find no equilibrium, because there are more material points than splines at
/// the outline (measured: `decisions.md` of the manual).
const PENALTY: f64 = 1e2;
/// Number of passes in which all contradicted statuses are corrected, and number of passes until which those with at
/// least half of the largest contradiction are; later only the largest. In 2-D, in 3-D dynamic and in 3-D quasi-static
/// analyses; in 3-D, friction also rotates in these passes.
const AT_ONCE: [usize; 3] = [8, 12, 24];
const BY_HALF: [usize; 3] = [16, 32, 32];
/// Penetration, in cell edges, that is round-off.
const ROUNDING: f64 = 1e-9;
/// Gap, in cell edges, below which a material point touches the outline at the start of a step.
const CLOSE: f64 = 1e-6;

/// Results of a rigid body for one step. Units are for 2-D; in 3-D all three components are translations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidReport {
    /// Force of the material on the body about its reference point (N, N and N m).
    pub force: Vector<3>,
    /// Motion since the start (m, m and rad).
    pub moved: Vector<3>,
    /// Velocity (m/s, m/s and rad/s).
    pub velocity: Vector<3>,
    /// Slip distance of the material along the outline since the start (m).
    pub slipped: f64,
    /// Work on the material since the start, including friction (J).
    pub work: f64,
    /// Energy dissipated by friction in the step (J).
    pub dissipated: f64,
    /// Least gap to the material at the end of the step (m); 0 in contact and without material.
    pub gap: f64,
    /// Number of material points that it pushes.
    pub touched: usize,
    /// Largest penetration by a material point, divided by the shortest cell edge (-).
    pub penetration: f64,
    /// Largest motion of the body at a point that it pushes, divided by the shortest cell edge (-).
    pub advance: f64,
}

/// All rigid bodies in one step, and the material points of this rank near them.
#[derive(Clone, Debug, Default)]
pub struct RigidContacts<const D: usize> {
    offsets: Vec<usize>,
    points: Vec<RigidPoint<D>>,
    bodies: Vec<BodyInStep<D>>,
    length: f64, // s (or pseudo-time)
    dt: f64,     // s; 0 without inertia
    edge: f64,
    /// Nodal components that a body may stop in this step; they are integrated by backward Euler. Empty without
    /// inertia.
    moving: Vec<bool>,
}

impl<const D: usize> RigidContacts<D> {
    /// Returns whether there is no body.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Returns whether any body moves freely, so that contact forces of all ranks decide its motion.
    pub fn is_coupled(&self) -> bool {
        self.bodies.iter().any(|at| at.body.is_free())
    }

    /// Returns, per local node, whether it belongs to a cell with a material point in contact. One ghost exchange if
    /// there are bodies.
    pub fn touched_nodes(&self, nodes: usize, halo: &dyn Halo) -> Vec<bool> {
        if self.is_empty() {
            return vec![false; nodes];
        }
        let mut marks = vec![0.0; nodes];
        for point in self.points.iter().filter(|point| point.status != ContactStatus::Open) {
            self.offsets
                .iter()
                .for_each(|offset| marks[point.first_node + offset] = 1.0);
        }
        halo.ghost_max(&mut marks, 1);
        marks.into_iter().map(|mark| mark > 0.0).collect()
    }

    /// Returns whether any body has friction.
    pub fn is_rough(&self) -> bool {
        self.bodies.iter().any(|at| at.body.friction > 0.0)
    }

    /// Computes the inverse stiffness of the free motions for the present statuses. One reduction if a body moves
    /// freely. Fails on all ranks if nothing supports a free motion.
    pub fn settle(&mut self, halo: &dyn Halo) -> Result<(), StepError> {
        if !self.is_coupled() {
            return Ok(());
        }
        let stiffness = self.stiffness(true, halo);
        for (number, (at, stiffness)) in self.bodies.iter_mut().zip(stiffness).enumerate() {
            let free = at.body.freedom();
            let mut whole = Matrix3::from_diagonal(&at.inertia) + stiffness;
            for k in 0..MOTIONS {
                for l in 0..MOTIONS {
                    whole[(k, l)] *= free[k] * free[l];
                }
                whole[(k, k)] += 1.0 - free[k];
            }
            let inverse = whole
                .try_inverse()
                .filter(|inverse| inverse.iter().all(|entry| entry.is_finite()));
            let Some(mut inverse) = inverse else {
                return Err(StepError::Loose { body: number });
            };
            (0..MOTIONS).for_each(|k| inverse[(k, k)] -= 1.0 - free[k]);
            at.resists = inverse;
        }
        Ok(())
    }

    /// Returns the contact stiffness of every body's motions with the soil fixed (N/m, N and N m); `whole`: including
    /// the unsymmetric part. One reduction.
    fn stiffness(&self, whole: bool, halo: &dyn Halo) -> Vec<Matrix3<f64>> {
        self.stiffness_by(|point, moved| point.rate(moved, whole), halo)
    }

    /// As [`Self::stiffness`], with `rate` as the change of the contact force at a point. One reduction.
    fn stiffness_by(
        &self,
        rate: impl Fn(&RigidPoint<D>, &Vector<D>) -> Vector<D>,
        halo: &dyn Halo,
    ) -> Vec<Matrix3<f64>> {
        let mut sums = vec![Exact::ZERO; self.bodies.len() * MOTIONS * MOTIONS];
        for point in &self.points {
            for l in 0..MOTIONS {
                let mut unit = Vector::<3>::zeros();
                unit[l] = 1.0;
                let force = point.on_motions(&-rate(point, &point.carried_by(&unit)));
                for k in 0..MOTIONS {
                    sums[(point.body * MOTIONS + k) * MOTIONS + l].add(force[k]);
                }
            }
        }
        halo.reproducible_sum(&sums)
            .chunks_exact(MOTIONS * MOTIONS)
            .map(Matrix3::from_row_slice)
            .collect()
    }

    /// Returns the free motions of the bodies beyond the predicted ones, in equilibrium with the contact forces under
    /// `u` (m). One reduction if a body moves freely.
    fn found(&self, u: &[f64], halo: &dyn Halo) -> Vec<Vector<3>> {
        if !self.is_coupled() {
            return vec![Vector::zeros(); self.bodies.len()];
        }
        let forces = self.on_bodies(|point| point.force(&point.displacement(&self.offsets, u)), halo);
        self.bodies
            .iter()
            .zip(forces)
            .map(|(at, force)| at.resists * (at.unbalanced + force))
            .collect()
    }

    /// Returns the derivative of the free motions in the direction `v` (m). One reduction if a body moves freely.
    fn follow(&self, v: &[f64], whole: bool, halo: &dyn Halo) -> Vec<Vector<3>> {
        if !self.is_coupled() {
            return vec![Vector::zeros(); self.bodies.len()];
        }
        let forces = self.on_bodies(|point| point.rate(&point.displacement(&self.offsets, v), whole), halo);
        self.bodies
            .iter()
            .zip(forces)
            .map(|(at, force)| at.resists * force)
            .collect()
    }

    /// Returns the resultants of the reversed contact forces on the bodies (N, N and N m). One reduction.
    fn on_bodies(&self, force: impl Fn(&RigidPoint<D>) -> Vector<D>, halo: &dyn Halo) -> Vec<Vector<3>> {
        let mut sums = vec![Exact::ZERO; self.bodies.len() * MOTIONS];
        for point in &self.points {
            let on = point.on_motions(&-force(point));
            (0..MOTIONS).for_each(|k| sums[point.body * MOTIONS + k].add(on[k]));
        }
        halo.reproducible_sum(&sums)
            .chunks_exact(MOTIONS)
            .map(Vector::<3>::from_column_slice)
            .collect()
    }

    /// Returns the displacement of the material at a point relative to the free motion of its body (m).
    fn moved(&self, point: &RigidPoint<D>, u: &[f64], motions: &[Vector<3>]) -> Vector<D> {
        point.displacement(&self.offsets, u) - point.carried_by(&motions[point.body])
    }

    /// Adds the forces of the bodies on the material to the nodes (N), this rank's contributions only. One reduction if
    /// a body moves freely.
    pub fn add_forces(&self, u: &[f64], out: &mut Contributions, halo: &dyn Halo) {
        let motions = self.found(u, halo);
        self.scatter(|point| point.force(&self.moved(point, u, &motions)), out);
    }

    /// Adds the product of the contact stiffness with `v`, this rank's contributions only. One reduction if a body
    /// moves freely.
    pub fn multiply(&self, v: &[f64], out: &mut Contributions, halo: &dyn Halo) {
        let motions = self.follow(v, true, halo);
        self.scatter(|point| -point.rate(&self.moved(point, v, &motions), true), out);
    }

    fn scatter(&self, force: impl Fn(&RigidPoint<D>) -> Vector<D>, out: &mut Contributions) {
        for point in self.points.iter().filter(|point| point.status != ContactStatus::Open) {
            let force = force(point);
            let out = out.patch(point.first_node);
            for (N, offset) in point.N.iter().zip(&self.offsets) {
                (0..D).for_each(|component| out[Nodal::<D>::at(*offset, component)] += N * force[component]);
            }
        }
    }

    /// Adds the symmetric part of the contact stiffness, with the bodies fixed, to the matrix.
    pub fn add_stiffness(&self, matrix: &mut dyn MatrixAssembly) {
        for point in self.points.iter().filter(|point| point.status != ContactStatus::Open) {
            matrix.add_block(point.first_node, &point.block());
        }
    }

    /// Returns the coupling of every free motion with the nodes in the symmetric contact stiffness (N/m or N, one nodal
    /// array per motion), and per body the matrix of its inertia and contact stiffness. One reduction, and one ghost
    /// exchange per free motion.
    pub fn motion_coupling(&self, grid: &Grid<D>, halo: &dyn Halo) -> (Vec<Vec<f64>>, Vec<Matrix3<f64>>) {
        let columns = self.free_motions().map(|(body, k)| self.column(body, k, grid, halo));
        let columns = columns.collect();
        let stiffness = self.stiffness(false, halo);
        let bodies = self.bodies.iter().zip(stiffness);
        let whole = bodies.map(|(at, stiffness)| Matrix3::from_diagonal(&at.inertia) + stiffness);
        (columns, whole.collect())
    }

    /// Returns the coupling of one motion of a body with the nodes (N/m or N). One ghost exchange.
    fn column(&self, body: usize, motion: usize, grid: &Grid<D>, halo: &dyn Halo) -> Vec<f64> {
        let mut unit = Vector::<3>::zeros();
        unit[motion] = 1.0;
        let mut out = Contributions::none(grid, D, Vec::new());
        self.scatter(
            |point| match point.body == body {
                true => -point.rate(&point.carried_by(&unit), false),
                false => Vector::zeros(),
            },
            &mut out,
        );
        halo.assemble_ghosts(&out)
    }

    /// Returns the body and the index of every free motion.
    pub fn free_motions(&self) -> impl Iterator<Item = (usize, usize)> {
        let free = self.bodies.iter().map(|at| at.body.free).enumerate();
        free.flat_map(|(body, free)| (0..MOTIONS).filter(move |&k| free[k]).map(move |k| (body, k)))
    }

    /// Returns du . K du of the symmetric contact stiffness on this rank (N m). One reduction if a body moves freely.
    pub fn energy(&self, du: &[f64], halo: &dyn Halo) -> Exact {
        let motions = self.follow(du, false, halo);
        let energies = self.points.iter().map(|point| {
            let moved = self.moved(point, du, &motions);
            -moved.dot(&point.rate(&moved, false))
        });
        energies.collect()
    }

    /// Corrects the statuses that the displacement `u` (m) contradicts by more than `force` (N): all of them in the
    /// first `passes`, later only the largest contradictions, because correcting all may cycle. Returns the number of
    /// corrected points on all ranks. Two reductions; more if a body moves freely.
    pub fn correct_statuses(
        &mut self,
        u: &[f64],
        force: f64,
        passes: usize,
        halo: &dyn Halo,
    ) -> Result<usize, StepError> {
        if self.is_empty() {
            return Ok(0);
        }
        let motions = self.found(u, halo);
        let length = ROUNDING * self.edge;
        let moved: Vec<Vector<D>> = self.points.iter().map(|point| self.moved(point, u, &motions)).collect();
        let statuses = self
            .points
            .iter()
            .zip(&moved)
            .map(|(point, moved)| point.corrected(moved, force, length));
        let statuses: Vec<(ContactStatus, f64)> = statuses.collect();
        let kind = usize::from(D > 2) + usize::from(D > 2 && self.dt == 0.0);
        let share = if passes < AT_ONCE[kind] {
            0.0
        } else if passes < BY_HALF[kind] {
            0.5
        } else {
            1.0
        };
        let mut most = [statuses.iter().map(|(_, by)| *by).fold(0.0, f64::max)];
        halo.all_reduce_max(&mut most);
        let mut corrected = [0.0];
        let mut released = vec![false; self.points.len()];
        for (number, (status, by)) in statuses.into_iter().enumerate() {
            let point = &mut self.points[number];
            if point.status != status && by >= share * most[0] {
                corrected[0] += 1.0;
                released[number] = point.status == ContactStatus::Stick;
                point.take(status, &moved[number]);
            }
        }
        halo.all_reduce_sum(&mut corrected);
        let held = if corrected[0] > 0.0 {
            self.hold_neutral(&moved, &released, halo)
        } else {
            0
        };
        self.strike(halo);
        self.settle(halo)?;
        Ok(corrected[0] as usize + held)
    }

    /// Integrates an impact: free bodies that touch new material in this step change to backward Euler. One reduction
    /// in dynamic analyses with free bodies.
    fn strike(&mut self, halo: &dyn Halo) {
        if !self.is_coupled() || self.dt == 0.0 {
            return;
        }
        let mut met = vec![0.0; self.bodies.len()];
        let touching = self.points.iter().filter(|point| point.status != ContactStatus::Open);
        for point in touching.filter(|point| point.gap_before() > CLOSE * self.edge) {
            met[point.body] = 1.0;
        }
        halo.all_reduce_max(&mut met);
        for (at, _) in self.bodies.iter_mut().zip(met).filter(|(_, met)| *met > 0.0) {
            at.strike(self.dt);
        }
    }

    /// Returns three works on the material of this rank (J): of the mean forces of the step; of the forces at the end
    /// less the mean; and, with inertia only, half of the (negative) work of friction on the slip.
    pub fn work(&self, u: &[f64], halo: &dyn Halo) -> [Exact; 3] {
        let motions = self.found(u, halo);
        let mut work = [Exact::ZERO; 3];
        for point in &self.points {
            let moved = self.moved(point, u, &motions);
            let (mean, grown) = point.mean(&moved, self.dt > 0.0);
            let way = point.displacement(&self.offsets, u);
            work[0].add(mean.dot(&way));
            work[1].add(grown.dot(&way));
            work[2].add(if self.dt > 0.0 {
                0.5 * point.friction_work(&moved)
            } else {
                0.0
            });
        }
        work
    }

    /// Returns the tangential force on each of this rank's `count` material points (N), from which the next step
    /// starts; `None` without friction.
    pub fn carried(&self, u: &[f64], count: usize, halo: &dyn Halo) -> Option<Vec<Vector<D>>> {
        if !self.is_rough() {
            return None;
        }
        let motions = self.found(u, halo);
        let mut carried = vec![Vector::zeros(); count];
        for point in &self.points {
            let (_, along) = point.pushed(&self.moved(point, u, &motions));
            let force = point.vector(along);
            if force.norm_squared() > 0.0 {
                carried[point.point] = force;
            }
        }
        Some(carried)
    }

    /// Returns the results of every body under the converged displacement `u` (m), and its state at the end of the
    /// step. Three reductions; four if a body moves freely.
    pub fn finish_step(&self, u: &[f64], halo: &dyn Halo) -> (Vec<RigidReport>, Vec<RigidState>) {
        if self.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let motions = self.found(u, halo);
        let forces = self.on_bodies(|point| point.force(&self.moved(point, u, &motions)), halo);
        let count = self.bodies.len();
        let mut sums = vec![Exact::ZERO; 5 * count]; // touched, pushed, pushed slip, dissipated, work
        let mut most = vec![f64::NEG_INFINITY; 3 * count]; // gap, penetration, advance
        for point in &self.points {
            let moved = self.moved(point, u, &motions);
            let gap = point.gap_after(&moved);
            let (pushed, _) = point.pushed(&moved);
            let advance = point.carried_by(&motions[point.body]).norm().max(point.way);
            let touched = f64::from(u8::from(pushed > 0.0));
            let work = point
                .mean(&moved, self.dt > 0.0)
                .0
                .dot(&point.displacement(&self.offsets, u));
            let slipped = pushed.max(0.0) * point.slipped(&moved);
            let each = [touched, pushed.max(0.0), slipped, -point.friction_work(&moved), work];
            sums[5 * point.body..]
                .iter_mut()
                .zip(each)
                .for_each(|(sum, value)| sum.add(value));
            let each = [-gap, -gap * touched / self.edge, advance * touched / self.edge];
            most[3 * point.body..]
                .iter_mut()
                .zip(each)
                .for_each(|(most, value)| *most = most.max(value));
        }
        let sums = halo.reproducible_sum(&sums);
        halo.all_reduce_max(&mut most);
        let reports = (0..count).map(|number| {
            let sums = &sums[5 * number..][..5];
            let most = &most[3 * number..][..3];
            self.report(number, &motions[number], forces[number], sums, most)
        });
        reports.unzip()
    }

    /// Assembles the results and the new state of a body from the sums over its points in [`Self::finish_step`].
    fn report(
        &self,
        number: usize,
        motion: &Vector<3>,
        force: Vector<3>,
        sums: &[f64],
        most: &[f64],
    ) -> (RigidReport, RigidState) {
        let at = &self.bodies[number];
        let [touched, pushed, slipped, dissipated, work] = [0, 1, 2, 3, 4].map(|k| sums[k]);
        let slip = if pushed > 0.0 { slipped / pushed } else { 0.0 };
        let state = at.state(motion, self.length, slip, work);
        let [near, penetration, advance] = [0, 1, 2].map(|k| most[k]);
        // If no material point is in range, the least gap is that found at the start.
        let gap = if near.is_finite() { -near } else { at.least }.max(0.0);
        let report = RigidReport {
            force,
            moved: state.moved,
            velocity: state.velocity,
            slipped: state.slipped,
            work: state.work,
            dissipated,
            gap: if gap.is_finite() { gap } else { 0.0 },
            touched: touched as usize,
            penetration: penetration.max(0.0),
            advance: advance.max(0.0),
        };
        (report, state)
    }
}
