//! Tractions and point loads: forces on points of the body's surface that move with the body.

use super::strip::reduce;
use super::surface::{Attachment, Surface, SurfacePoint};
use crate::error::StepError;
use crate::grid::{Contributions, Grid};
use crate::parallel::Halo;
use crate::schedule::between;
use crate::tensor::Vector;

/// A load whose force, direction and area are those of the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Load<const D: usize> {
    /// points of the surface at the start; a point load has one, of area 1
    pub points: Vec<SurfacePoint<D>>,
    /// Pa (point load: N)  when fully applied
    pub traction: Vector<D>,
    /// s (or pseudo-time) over which it grows linearly; 0: at once
    pub ramp: f64,
    /// s (or pseudo-time), increasing, and the share that acts, instead of a ramp: linear between, from 0 at time 0 to
    /// the first row, constant after the last; empty: the ramp holds
    pub amplitude: Vec<(f64, f64)>,
}

impl<const D: usize> Load<D> {
    /// Share of the load that acts at time `t`.
    fn grown(&self, t: f64) -> f64 {
        match self.amplitude.last() {
            Some((_, stays)) => between(&self.amplitude, 0.0, t).unwrap_or(*stays),
            None if self.ramp > 0.0 => (t / self.ramp).clamp(0.0, 1.0),
            None => 1.0,
        }
    }
}

/// Nodal forces of all loads at time `t`, N, added to `f_ext`. Fails on all ranks if a load has lost its material.
pub fn add_forces<const D: usize>(
    loads: &[Load<D>],
    surface: &Surface<D>,
    (grid, active): (&Grid<D>, &[bool]),
    t: f64,
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
        for (point, x) in load.points.iter().zip(&surface.position[number]) {
            if let Some(attachment) = Attachment::at(grid, &offsets, |node| active[node], x) {
                attachment.scatter(&offsets, &(load.traction * (grown * point.area)), &mut force);
                applied[number] += 1.0;
            }
        }
    }
    halo.reduce(&mut applied);
    let lost = (0..loads.len()).find(|&number| applied[number] < loads[number].points.len() as f64);
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
        let moved = load.points.iter().zip(&before.position[number]).zip(&after.position[number]);
        let full: f64 = moved.map(|((point, from), to)| point.area * load.traction.dot(&(to - from))).sum();
        sums.0 += 0.5 * (load.grown(t) + load.grown(t + dt)) * full;
        sums.1 += 0.5 * (load.grown(t + dt) - load.grown(t)) * full;
    }
    sums
}
