//! Tractions and point loads. Dead loads, theory-manual equation (T6.8), are added to the external force at the start
//! of a step. [Follower loads](follower) change during a step.

pub mod follower;

use super::anchor::{Anchored, Surfaces};
use super::strip::reduce;
use super::surface::{Anchors, Attachment, Surface, SurfacePoint};
use crate::error::StepError;
use crate::grid::{Contributions, Grid};
use crate::parallel::Halo;
use crate::schedule::{between, turns};
use crate::tensor::Vector;
use follower::FollowerLoads;

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
    pub(super) fn turns(&self, step: (f64, f64)) -> bool {
        let rows = if self.amplitude.is_empty() {
            &[(self.ramp, 1.0)][..]
        } else {
            &self.amplitude
        };
        turns(rows, 0.0, f64::abs, step)
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

/// Nodal forces of all loads at time `t`, N, added to `f_ext`; those that follow the surface, which is one of these
/// `surfaces`, are returned instead. Fails on all ranks if a load has lost its material.
pub fn add_forces<const D: usize>(
    (surfaces, surface): (&Surfaces<'_, D>, &Surface<D>),
    points: Anchored<'_, D>,
    (grid, active): (&Grid<D>, &[bool]),
    t: f64,
    halo: &dyn Halo,
    f_ext: &mut [f64],
) -> Result<FollowerLoads<D>, StepError> {
    let loads = &surfaces.boundary.loads[..];
    if loads.is_empty() {
        return Ok(FollowerLoads::default());
    }
    let (offsets, mut applied, mut pushed) = (grid.offsets(), vec![0.0; loads.len()], Vec::new());
    let mut force = Contributions::none(grid, D, Vec::new());
    for (number, load) in loads.iter().enumerate() {
        let grown = load.grown(t);
        for (k, (point, x)) in load.points.iter().zip(&surface.position[number]).enumerate() {
            if let Some(attachment) = Attachment::at(grid, &offsets, |node| active[node], x) {
                applied[number] += 1.0;
                if load.follows {
                    pushed.push((number, k, grown * point.area, attachment));
                } else {
                    attachment.scatter(&offsets, &(load.traction[k] * (grown * point.area)), &mut force);
                }
            }
        }
    }
    let followers = match loads.iter().any(|load| load.follows) {
        true => {
            let anchors = Anchors::of(surfaces, &surface.anchors, points, halo);
            FollowerLoads::of(loads, pushed, (grid, &anchors), points)
        }
        false => FollowerLoads::default(),
    };
    applied.extend(followers.carried(loads));
    halo.reduce(&mut applied);
    // Points of a load that have material where it pushes, and whose material is there, if that carries them.
    let found = |number: usize| {
        let carried = applied.get(loads.len() + number).filter(|_| loads[number].follows);
        carried.map_or(applied[number], |carried| carried.min(applied[number]))
    };
    let lacks = |number: &usize| found(*number) < loads[*number].points.len() as f64;
    let lost = (0..loads.len()).filter(|&number| !loads[number].is_idle()).find(lacks);
    if let Some(load) = lost {
        return Err(StepError::Unloaded {
            load,
            points: loads[load].points.len() - found(load) as usize,
        });
    }
    f_ext
        .iter_mut()
        .zip(halo.sum(&force))
        .for_each(|(sum, force)| *sum += force);
    Ok(followers)
}

/// Positions that all loads' points would have after the converged displacement `u`, m, moved by the nodes that their
/// forces act on: what the work of a load is of.
pub fn moved<const D: usize>(
    loads: &[Load<D>],
    surface: &Surface<D>,
    (grid, active): (&Grid<D>, &[bool]),
    u: &[f64],
    halo: &dyn Halo,
) -> Vec<Vec<Vector<D>>> {
    if loads.is_empty() {
        return Vec::new();
    }
    let offsets = grid.offsets();
    let place = |x: &Vector<D>| {
        let attachment = Attachment::at(grid, &offsets, |node| active[node], x);
        attachment.map_or_else(Vector::zeros, |attachment| {
            x + attachment.displacement::<D>(&offsets, u)
        })
    };
    let mut position: Vec<Vec<Vector<D>>> = surface
        .position
        .iter()
        .map(|points| points.iter().map(place).collect())
        .collect();
    reduce(&mut position, halo);
    position
}

/// Work of all loads from `t` to `t + dt` by their mean, N m, and half of what they have grown times the displacement
/// of their points, from one surface to the other.
pub fn work<const D: usize>(
    loads: &[Load<D>],
    (before, after): (&Surface<D>, &Surface<D>),
    (t, dt): (f64, f64),
) -> (f64, f64) {
    let mut sums = (0.0, 0.0);
    for (number, load) in loads.iter().enumerate() {
        let acting = |surface: &Surface<D>| match load.follows {
            true => surface.pressure[number].clone(),
            false => load.traction.clone(),
        };
        let full = |traction: &[Vector<D>]| {
            let moved = before.position[number]
                .iter()
                .zip(&after.position[number])
                .map(|(from, to)| to - from);
            let work = |(k, moved): (usize, Vector<D>)| load.points[k].area * traction[k].dot(&moved);
            moved.enumerate().map(work).sum::<f64>()
        };
        let works = [(before, t), (after, t + dt)].map(|(surface, t)| load.grown(t) * full(&acting(surface)));
        sums.0 += 0.5 * (works[0] + works[1]);
        sums.1 += 0.5 * (works[1] - works[0]);
    }
    sums
}
