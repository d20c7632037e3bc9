//! Tractions and point loads. Dead loads, theory-manual equation (T6.8), are added to the external force at the start
//! of a step. [Follower loads](follower) change during a step.

pub mod follower;

use super::anchor::{AnchorCandidates, Surfaces};
use super::strip::reduce;
use super::surface::{Anchors, Attachment, Surface, SurfacePoint};
use crate::error::StepError;
use crate::grid::{Contributions, Grid};
use crate::parallel::Halo;
use crate::schedule::TimeInterval;
use crate::schedule::{between, turns};
use crate::tensor::Vector;
use follower::{AttachedPoint, FollowerLoads};

/// A load on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Load<const D: usize> {
    /// points of the surface at the start; a point load has one, of area 1
    pub points: Vec<SurfacePoint<D>>,
    /// Pa (point load: N)  at every point when fully applied, per area of the start
    pub traction: Vec<Vector<D>>,
    /// whether it turns and stretches with the surface, as a pressure does
    pub follows: bool,
    /// s (or pseudo-time) over which it grows linearly; 0: at once
    pub ramp: f64,
    /// s (or pseudo-time), increasing, and the share that acts, instead of a ramp: linear between, from 0 at time 0 to
    /// the first row, constant after the last; empty: the ramp holds
    pub amplitude: Vec<(f64, f64)>,
}

impl<const D: usize> Load<D> {
    /// The same traction at all points, whatever becomes of the surface.
    pub fn dead(points: Vec<SurfacePoint<D>>, traction: Vector<D>, ramp: f64) -> Self {
        Self {
            traction: vec![traction; points.len()],
            points,
            follows: false,
            ramp,
            amplitude: Vec::new(),
        }
    }

    /// What a surface at rest knows of its traction, Pa: that of a load that follows it.
    pub(super) fn at_rest(&self) -> Vec<Vector<D>> {
        if self.follows {
            self.traction.clone()
        } else {
            Vec::new()
        }
    }

    /// Whether nothing of it ever acts: there may be no material at it yet, or any more.
    pub fn is_idle(&self) -> bool {
        !self.amplitude.is_empty() && self.amplitude.iter().all(|row| row.1 == 0.0)
    }

    /// Whether its course turns sharply in a step.
    pub(super) fn turns(&self, interval: TimeInterval) -> bool {
        let rows = if self.amplitude.is_empty() {
            &[(self.ramp, 1.0)][..]
        } else {
            &self.amplitude
        };
        turns(rows, 0.0, f64::abs, interval)
    }

    /// Share of the load that acts at time `t`.
    fn grown(&self, t: f64) -> f64 {
        match self.amplitude.last() {
            Some((_, stays)) => between(&self.amplitude, 0.0, t).unwrap_or(*stays),
            None if self.ramp > 0.0 => (t / self.ramp).clamp(0.0, 1.0),
            None => 1.0,
        }
    }
}

/// Nodal forces of all loads.
pub struct LoadForces<const D: usize> {
    /// Nodal forces of the dead loads, N, D per node; empty without loads.
    pub dead: Vec<f64>,
    /// Loads that follow the surface.
    pub followers: FollowerLoads<D>,
}

/// Returns the forces of all loads at time `t` on the `surface`, which is one of these `surfaces`. Fails on all ranks
/// if a load has lost its material.
pub fn forces<const D: usize>(
    surfaces: &Surfaces<'_, D>,
    surface: &Surface<D>,
    points: AnchorCandidates<'_, D>,
    grid: &Grid<D>,
    active: &[bool],
    t: f64,
    halo: &dyn Halo,
) -> Result<LoadForces<D>, StepError> {
    let loads = &surfaces.boundary.loads[..];
    if loads.is_empty() {
        return Ok(LoadForces {
            dead: Vec::new(),
            followers: FollowerLoads::default(),
        });
    }
    let offsets = grid.offsets();
    let mut applied = vec![0.0; loads.len()];
    let mut pushed = Vec::new();
    let mut force = Contributions::none(grid, D, Vec::new());
    for (number, load) in loads.iter().enumerate() {
        let grown = load.grown(t);
        for (k, (point, x)) in load.points.iter().zip(&surface.position[number]).enumerate() {
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
    let followers = if loads.iter().any(|load| load.follows) {
        let anchors = Anchors::of(surfaces, &surface.anchors, points, halo);
        FollowerLoads::of(loads, pushed, grid, &anchors, points)
    } else {
        FollowerLoads::default()
    };
    applied.extend(followers.carried(loads));
    halo.all_reduce_sum(&mut applied);
    if let Some(error) = lost_load(loads, &applied) {
        return Err(error);
    }
    Ok(LoadForces {
        dead: halo.assemble_ghosts(&force),
        followers,
    })
}

/// Returns the error of the first load that has lost some of its material, by the numbers of points of every load that
/// have material where it pushes and, where some load follows the surface, of those whose material is there.
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

/// Positions that all loads' points would have after the converged displacement `u`, m, moved by the nodes that their
/// forces act on: what the work of a load is of.
pub fn moved<const D: usize>(
    loads: &[Load<D>],
    surface: &Surface<D>,
    grid: &Grid<D>,
    active: &[bool],
    u: &[f64],
    halo: &dyn Halo,
) -> Vec<Vec<Vector<D>>> {
    if loads.is_empty() {
        return Vec::new();
    }
    let offsets = grid.offsets();
    let mut position = surface.position.clone();
    for x in position.iter_mut().flatten() {
        let attachment = Attachment::at(grid, &offsets, |node| active[node], x);
        let moved = attachment.map(|attachment| *x + attachment.displacement::<D>(&offsets, u));
        *x = moved.unwrap_or_else(Vector::zeros);
    }
    reduce(&mut position, halo);
    position
}

/// Work of all loads from `t` to `t + dt` by their mean, N m, and half of what they have grown times the displacement
/// of their points, from one surface to the other.
pub fn work<const D: usize>(
    loads: &[Load<D>],
    before: &Surface<D>,
    after: &Surface<D>,
    interval: TimeInterval,
) -> (f64, f64) {
    let mut sums = (0.0, 0.0);
    for (number, load) in loads.iter().enumerate() {
        let places = before.position[number].iter().zip(&after.position[number]);
        let moved: Vec<Vector<D>> = places.map(|(from, to)| to - from).collect();
        let works = [(before, interval.start), (after, interval.end())].map(|(surface, t)| {
            let traction = match load.follows {
                true => &surface.pressure[number],
                false => &load.traction,
            };
            load.grown(t) * full_work(load, traction, &moved)
        });
        sums.0 += 0.5 * (works[0] + works[1]);
        sums.1 += 0.5 * (works[1] - works[0]);
    }
    sums
}

/// Work of the tractions of a load when fully applied, Pa, on points that have `moved`, m; N m.
fn full_work<const D: usize>(load: &Load<D>, traction: &[Vector<D>], moved: &[Vector<D>]) -> f64 {
    let moved = moved.iter().enumerate();
    moved
        .map(|(k, moved)| load.points[k].area * traction[k].dot(moved))
        .sum()
}
