//! Warns of moving bodies that approach within a cell. They then share nodes and act on each other.

use crate::case::{Case, Support};
use crate::report::Report;
use crate::rounding::brief;
use bsmpm::model::Regime;

/// Times between start and end at which the distance of two bodies is tried.
const SAMPLES: usize = 100;

/// A connected piece of material, and how it moves at first.
struct Piece {
    /// numbers of its bodies
    bodies: Vec<usize>,
    /// m  lower and upper corner of the box around it
    bounds: [[f64; 3]; 2],
    /// m/s  velocity of its first body
    velocity: [f64; 3],
    /// m/s2  of gravity, none of a piece at a face of the grid that holds it
    acceleration: [f64; 3],
}

/// Warns, in dynamic analysis, of pieces of material that start more than a cell apart and come within a cell of each
/// other if nothing stops them: of the first pair that does.
pub(super) fn check(case: &Case, report: &mut Report<'_>) {
    if case.analysis.regime != Regime::Dynamic {
        return;
    }
    let pieces: Vec<Piece> = case
        .pieces()
        .into_iter()
        .map(|bodies| Piece::of(case, bodies))
        .collect();
    let cell = case.grid.shortest();
    for (number, other) in pieces.iter().enumerate() {
        for one in &pieces[..number] {
            let Some(time) = meeting(one, other, cell, case) else {
                continue;
            };
            let reach = case.grid.order as f64;
            report.warn(format!(
                "W0229: body.{} and body.{} come closer than a cell at t = {time:.3} s. From {:.1} cells ({} m) on \
                 they push on each other. Use smaller cells, or [[rigid]] for one body.",
                one.bodies[0],
                other.bodies[0],
                reach - 0.5,
                brief((reach - 0.5) * cell)
            ));
            return;
        }
    }
}

impl Piece {
    fn of(case: &Case, bodies: Vec<usize>) -> Self {
        let corners: Vec<[[f64; 3]; 2]> = bodies.iter().map(|&body| case.bodies[body].region.corners()).collect();
        let lower = std::array::from_fn(|axis| corners.iter().map(|at| at[0][axis]).fold(f64::INFINITY, f64::min));
        let upper = std::array::from_fn(|axis| corners.iter().map(|at| at[1][axis]).fold(f64::NEG_INFINITY, f64::max));
        let bounds = [lower, upper];
        let velocity = case.bodies[bodies[0]].velocity.unwrap_or_default();
        let falls = !is_supported(case, &bounds);
        let gravity = case.gravity.as_ref().filter(|_| falls);
        let acceleration = gravity.map_or([0.0; 3], |gravity| gravity.acceleration);
        Self {
            bodies,
            bounds,
            velocity,
            acceleration,
        }
    }

    /// m  displacement of the piece at a time if nothing stops it
    fn moved(&self, t: f64) -> [f64; 3] {
        std::array::from_fn(|axis| self.velocity[axis] * t + 0.5 * self.acceleration[axis] * t * t)
    }
}

/// Whether a box lies at a face of the grid that holds material.
fn is_supported(case: &Case, bounds: &[[f64; 3]; 2]) -> bool {
    let lower = case.grid.lower();
    let cell = case.grid.shortest();
    (0..case.grid.dims()).any(|axis| {
        let upper = lower[axis] + case.grid.axes[axis].length();
        let at_lower = bounds[0][axis] - lower[axis] < cell && case.boundary[axis][0] != Support::Free;
        let at_upper = upper - bounds[1][axis] < cell && case.boundary[axis][1] != Support::Free;
        at_lower || at_upper
    })
}

/// Distance (m) of two pieces at time `t`: that along the axis along which they are farthest apart.
fn distance(one: &Piece, other: &Piece, case: &Case, t: f64) -> f64 {
    let [one_moved, other_moved] = [one, other].map(|piece| piece.moved(t));
    let along = (0..case.grid.dims()).map(|axis| {
        let a = one.bounds.map(|corner| corner[axis] + one_moved[axis]);
        let b = other.bounds.map(|corner| corner[axis] + other_moved[axis]);
        a[0].max(b[0]) - a[1].min(b[1])
    });
    along.fold(f64::NEG_INFINITY, f64::max)
}

/// s  when two pieces that start more than a cell apart come within a cell of each other first.
fn meeting(one: &Piece, other: &Piece, cell: f64, case: &Case) -> Option<f64> {
    if distance(one, other, case, 0.0) < cell {
        return None;
    }
    let mut times = (1..=SAMPLES).map(|k| case.analysis.end * k as f64 / SAMPLES as f64);
    times.find(|&t| distance(one, other, case, t) < cell)
}
