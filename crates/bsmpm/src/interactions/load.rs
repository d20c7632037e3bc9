//! Tractions and point loads. Dead loads, theory-manual equation (T6.8), are added to the external force at the start
//! of a step. [Follower loads](follower) change during a step.

pub mod follower;

use super::{EquilibriumState, Interaction, InteractionReports, StepContext, StepStart};
use crate::boundary::surface::{Anchors, Attachment, SurfacePoint};
use crate::error::StepError;
use crate::grid::{Contributions, Grid};
use crate::interactions::state::InteractionState;
use crate::interactions::strip::reduce;
use crate::kinematics::Kinematics;
use crate::parallel::Halo;
use crate::schedule::TimeInterval;
use crate::schedule::{between, turns};
use crate::tensor::{Tensor, Vector};
use follower::{AttachedPoint, FollowerLoads};

/// A traction or point load on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Load<const D: usize> {
    /// Initial surface points; a point load has one, of area 1.
    pub points: Vec<SurfacePoint<D>>,
    /// Traction at every point at full amplitude, per initial area (Pa; point load: N).
    pub traction: Vec<Vector<D>>,
    /// Whether it is a follower load, which rotates and stretches with the surface like a pressure.
    pub follows: bool,
    /// Time over which the load grows linearly (s, or pseudo-time); 0: at once.
    pub ramp: f64,
    /// Increasing times (s, or pseudo-time) and amplitudes, which replace the ramp: linear between rows, from 0 at time
    /// 0 to the first row, constant after the last. Empty: the ramp applies.
    pub amplitude: Vec<(f64, f64)>,
}

impl<const D: usize> Load<D> {
    /// Creates a dead load with the same traction (Pa) at all points.
    pub fn dead(points: Vec<SurfacePoint<D>>, traction: Vector<D>, ramp: f64) -> Self {
        Self {
            traction: vec![traction; points.len()],
            points,
            follows: false,
            ramp,
            amplitude: Vec::new(),
        }
    }

    /// Returns the initial follower tractions (Pa); empty for a dead load.
    pub(crate) fn at_rest(&self) -> Vec<Vector<D>> {
        if self.follows {
            self.traction.clone()
        } else {
            Vec::new()
        }
    }

    /// Returns whether the amplitude is always zero. Such a load may lie where there is no material.
    pub fn is_idle(&self) -> bool {
        !self.amplitude.is_empty() && self.amplitude.iter().all(|row| row.1 == 0.0)
    }

    /// Returns whether the slope of the amplitude changes sharply in the interval.
    pub(crate) fn turns(&self, interval: TimeInterval) -> bool {
        let rows = if self.amplitude.is_empty() {
            &[(self.ramp, 1.0)][..]
        } else {
            &self.amplitude
        };
        turns(rows, 0.0, f64::abs, interval)
    }

    /// Returns the amplitude of the load at time `t`.
    fn grown(&self, t: f64) -> f64 {
        match self.amplitude.last() {
            Some((_, stays)) => between(&self.amplitude, 0.0, t).unwrap_or(*stays),
            None if self.ramp > 0.0 => (t / self.ramp).clamp(0.0, 1.0),
            None => 1.0,
        }
    }
}

/// Work of loads in a step (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadWork {
    /// Work of the mean of the tractions at both ends.
    pub mean: f64,
    /// Work of half the increase of the tractions.
    pub half_increase: f64,
}

/// Loads in one step.
#[derive(Debug)]
struct AppliedLoads<const D: usize> {
    /// Nodal forces of the dead loads at the end of the step (N), D per node.
    dead: Vec<f64>,
    /// Follower loads, if any.
    followers: Option<FollowerLoads<D>>,
    interval: TimeInterval,
}

/// Begins the loads of a step, if there are any, with the state of their points. Fails on all ranks if a load has lost
/// its material. One reduction and one ghost exchange; before the first step, follower loads need two more reductions.
pub fn begin<K: Kinematics<D>, const D: usize>(
    start: &StepStart<'_, K, D>,
) -> Result<Option<Box<dyn Interaction<D>>>, StepError> {
    let StepStart { model, halo, .. } = *start;
    let interval = start.input.interval;
    let loads = &model.boundary.loads[..];
    if loads.is_empty() {
        return Ok(None);
    }
    let grid = &model.grid;
    let offsets = grid.offsets();
    let state = start.input.state;
    let active = &start.constraints.active;
    let mut applied = vec![0.0; loads.len()];
    let mut pushed = Vec::new();
    let mut force = Contributions::none(grid, D, Vec::new());
    for (number, load) in loads.iter().enumerate() {
        let grown = load.grown(interval.end());
        for (k, (point, x)) in load.points.iter().zip(&state.position[number]).enumerate() {
            if let Some(attachment) = Attachment::at(grid, &offsets, |node| active[node], x) {
                applied[number] += 1.0;
                if load.follows {
                    pushed.push(AttachedPoint {
                        load: number,
                        point: k,
                        area: grown * point.area,
                        attachment,
                    });
                } else {
                    attachment.scatter(&offsets, &(load.traction[k] * (grown * point.area)), &mut force);
                }
            }
        }
    }
    let mut followers = None;
    if loads.iter().any(|load| load.follows) {
        let points = start.points.anchored();
        let anchors = Anchors::of(&model.surfaces(), &state.anchors, points, halo);
        let found = FollowerLoads::of(loads, pushed, grid, &anchors, points, K::weight);
        applied.extend(found.carried(loads));
        followers = Some(found);
    }
    halo.all_reduce_sum(&mut applied);
    if let Some(error) = lost_load(loads, &applied) {
        return Err(error);
    }
    Ok(Some(Box::new(AppliedLoads {
        dead: halo.assemble_ghosts(&force),
        followers,
        interval,
    })))
}

impl<const D: usize> AppliedLoads<D> {
    /// Returns the tractions at all points of every follower load at full amplitude, per initial area (Pa), see
    /// [`FollowerLoads::tractions`]; empty lists for dead loads.
    fn tractions(&self, context: &StepContext<'_, D>, u: &[f64], dF: &dyn Fn(usize) -> Tensor) -> Vec<Vec<Vector<D>>> {
        let loads = &context.boundary.loads;
        match &self.followers {
            Some(followers) => followers.tractions(loads, context.grid, context.points, u, dF, context.halo),
            None => vec![Vec::new(); loads.len()],
        }
    }
}

impl<const D: usize> Interaction<D> for AppliedLoads<D> {
    fn constant_force(&self) -> &[f64] {
        &self.dead
    }

    fn external_force(
        &self,
        context: &StepContext<'_, D>,
        u: &[f64],
        dF: &dyn Fn(usize) -> Tensor,
    ) -> Option<Vec<f64>> {
        let followers = self.followers.as_ref()?;
        let tractions = self.tractions(context, u, dF);
        Some(followers.forces(&tractions, context.grid, context.halo))
    }

    fn finish(
        &self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        after: &mut InteractionState<D>,
        reports: &mut InteractionReports,
    ) -> Result<(), StepError> {
        let loads = &context.boundary.loads;
        let position = moved(
            &after.position,
            context.grid,
            &context.constraints.active,
            at.u,
            context.halo,
        );
        let pressure = self.tractions(context, at.u, at.dF);
        let positions = [&after.position, &position];
        let pressures = [&after.pressure, &pressure];
        reports.load_work = work(loads, positions, pressures, self.interval);
        after.position = position;
        after.pressure = pressure;
        Ok(())
    }
}

/// Returns the error of the first load that has lost material. `applied` has, per load, the number of points with
/// material in range, and then, if there are follower loads, the number of points whose anchor is present.
fn lost_load<const D: usize>(loads: &[Load<D>], applied: &[f64]) -> Option<StepError> {
    for (number, load) in loads.iter().enumerate().filter(|(_, load)| !load.is_idle()) {
        let carried = applied.get(loads.len() + number).filter(|_| load.follows);
        let found = carried.map_or(applied[number], |carried| carried.min(applied[number]));
        if found < load.points.len() as f64 {
            return Some(StepError::Unloaded {
                load: number,
                points: load.points.len() - found as usize,
            });
        }
    }
    None
}

/// Returns the positions of all load points, which were `before` (m), after the converged displacement `u` (m),
/// interpolated with the nodes on which the forces act; the work of the loads uses them. One reduction.
fn moved<const D: usize>(
    before: &[Vec<Vector<D>>],
    grid: &Grid<D>,
    active: &[bool],
    u: &[f64],
    halo: &dyn Halo,
) -> Vec<Vec<Vector<D>>> {
    let offsets = grid.offsets();
    let mut position = before.to_vec();
    for x in position.iter_mut().flatten() {
        let attachment = Attachment::at(grid, &offsets, |node| active[node], x);
        let moved = attachment.map(|attachment| *x + attachment.displacement::<D>(&offsets, u));
        *x = moved.unwrap_or_else(Vector::zeros);
    }
    reduce(&mut position, halo);
    position
}

/// Returns the work of all loads in the interval. `positions` (m) and `pressures` (Pa) are those of the load
/// points at the start and at the end.
fn work<const D: usize>(
    loads: &[Load<D>],
    positions: [&Vec<Vec<Vector<D>>>; 2],
    pressures: [&Vec<Vec<Vector<D>>>; 2],
    interval: TimeInterval,
) -> LoadWork {
    let mut sums = LoadWork::default();
    for (number, load) in loads.iter().enumerate() {
        let places = positions[0][number].iter().zip(&positions[1][number]);
        let moved: Vec<Vector<D>> = places.map(|(from, to)| to - from).collect();
        let works = [(pressures[0], interval.start), (pressures[1], interval.end())].map(|(pressure, t)| {
            let traction = match load.follows {
                true => &pressure[number],
                false => &load.traction,
            };
            load.grown(t) * full_work(load, traction, &moved)
        });
        sums.mean += 0.5 * (works[0] + works[1]);
        sums.half_increase += 0.5 * (works[1] - works[0]);
    }
    sums
}

/// Returns the work of the tractions of a load at full amplitude (Pa) on displacements `moved` of its points (m), in N
/// m.
fn full_work<const D: usize>(load: &Load<D>, traction: &[Vector<D>], moved: &[Vector<D>]) -> f64 {
    let moved = moved.iter().enumerate();
    moved
        .map(|(k, moved)| load.points[k].area * traction[k].dot(moved))
        .sum()
}
