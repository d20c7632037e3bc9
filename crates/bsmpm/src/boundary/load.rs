//! Tractions and point loads: forces on points of the body's surface that move with the body.
//!
//! A dead load keeps force and direction. A pressure turns and stretches with the surface, by Nanson's formula
//! `n da = cof(F) N dA`, F that of the material that its points are anchored to: in a step that of its start, which
//! goes on as it did in the step before. Without the latter it would lag behind by a step, and drive whatever turns: a
//! block that spins under the pressure of water all around turns 4.3 times as fast after a quarter of a turn in 157
//! steps.

use super::strip::reduce;
use super::surface::{Attachment, Surface, SurfacePoint};
use crate::error::StepError;
use crate::grid::{Contributions, Grid};
use crate::parallel::Halo;
use crate::schedule::between;
use crate::tensor::Vector;

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
        Self { traction: vec![traction; points.len()], points, follows: false, ramp, amplitude: Vec::new() }
    }

    /// What a surface at rest knows of its traction, Pa: that of a load that follows it.
    pub(super) fn at_rest(&self) -> Vec<Vector<D>> {
        if self.follows { self.traction.clone() } else { Vec::new() }
    }

    /// Its traction per area of the start when fully applied, Pa, of point `k`, a time `dt` after the state of a
    /// surface, in which it is load `number`.
    fn acting(&self, surface: &Surface<D>, (number, k): (usize, usize), dt: f64) -> Vector<D> {
        if self.follows {
            surface.pressure[number][k] + surface.pressure_rate[number][k] * dt
        } else {
            self.traction[k]
        }
    }

    /// Whether nothing of it ever acts: there may be no material at it yet, or any more.
    pub fn is_idle(&self) -> bool {
        !self.amplitude.is_empty() && self.amplitude.iter().all(|row| row.1 == 0.0)
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

/// Nodal forces of all loads at time `t`, `dt` after the state of the surface, N, added to `f_ext`. Fails on all ranks
/// if a load has lost its material.
pub fn add_forces<const D: usize>(
    loads: &[Load<D>],
    surface: &Surface<D>,
    (grid, active): (&Grid<D>, &[bool]),
    (t, dt): (f64, f64),
    halo: &dyn Halo,
    f_ext: &mut [f64],
) -> Result<(), StepError> {
    if loads.is_empty() {
        return Ok(());
    }
    let (offsets, mut applied) = (grid.offsets(), vec![0.0; loads.len()]);
    let mut force = Contributions::none(grid, D, Vec::new());
    for (number, load) in loads.iter().enumerate() {
        let grown = load.grown(t);
        for (k, (point, x)) in load.points.iter().zip(&surface.position[number]).enumerate() {
            if let Some(attachment) = Attachment::at(grid, &offsets, |node| active[node], x) {
                attachment.scatter(
                    &offsets,
                    &(load.acting(surface, (number, k), dt) * (grown * point.area)),
                    &mut force,
                );
                applied[number] += 1.0;
            }
        }
    }
    halo.reduce(&mut applied);
    let lacks = |number: &usize| applied[*number] < loads[*number].points.len() as f64;
    let lost = (0..loads.len()).filter(|&number| !loads[number].is_idle()).find(lacks);
    if let Some(load) = lost {
        let points = loads[load].points.len() - applied[load] as usize;
        return Err(StepError::Unloaded { load, points });
    }
    f_ext.iter_mut().zip(halo.sum(&force)).for_each(|(sum, force)| *sum += force);
    Ok(())
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
        attachment.map_or_else(Vector::zeros, |attachment| x + attachment.displacement::<D>(&offsets, u))
    };
    let mut position: Vec<Vec<Vector<D>>> =
        surface.position.iter().map(|points| points.iter().map(place).collect()).collect();
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
        let moved = before.position[number].iter().zip(&after.position[number]).map(|(from, to)| to - from);
        let work =
            |(k, moved): (usize, Vector<D>)| load.points[k].area * load.acting(before, (number, k), dt).dot(&moved);
        let full: f64 = moved.enumerate().map(work).sum();
        sums.0 += 0.5 * (load.grown(t) + load.grown(t + dt)) * full;
        sums.1 += 0.5 * (load.grown(t + dt) - load.grown(t)) * full;
    }
    sums
}
