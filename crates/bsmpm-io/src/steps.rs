//! `steps.csv`: cost of each accepted step.

use crate::table::{Cell, TableColumn};

/// Name of the file.
pub const STEPS: &str = "steps.csv";

/// Row of `steps.csv`: one accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRow {
    /// Number of the step.
    pub step: u64,
    /// Time at the end of the step (s, or pseudo-time in a quasi-static analysis).
    pub time: f64,
    /// Length of the step (s or pseudo-time).
    pub dt: f64,
    /// Iterations of the nonlinear solution.
    pub iterations: u64,
    /// Force measure of the accepted state (-).
    pub residual: f64,
    /// Iterations of the linear solver in all attempts; a direct solve counts as one.
    pub linear_iterations: u64,
    /// Number of cutbacks before the step converged.
    pub cutbacks: u64,
    /// Number of nodes with material.
    pub active_nodes: u64,
    /// Wall-clock time since the start of the run (s).
    pub wall: f64,
    /// Newton iterations among the nonlinear iterations; 0 if a quasi-Newton method converged.
    pub newton_iterations: u64,
    /// Evaluations of the out-of-balance force in all attempts.
    pub evaluations: u64,
    /// Products with the complete derivative (Jacobian) in all attempts.
    pub products: u64,
    /// Factorisations in all attempts.
    pub factorisations: u64,
    /// Reductions over all ranks, in all attempts and the subsequent exchange of points.
    pub reductions: u64,
    /// Messages between ranks in the same period, in total over all ranks, without those of PETSc.
    pub messages: u64,
    /// Bytes of these messages.
    pub bytes: u64,
    /// Largest load of a rank divided by the mean.
    pub imbalance: f64,
}

impl StepRow {
    /// Returns the columns of the file; `time_unit` is `s`, or `-` for pseudo-time.
    pub fn columns(time_unit: &str) -> [TableColumn; 17] {
        [
            ("step", "-"),
            ("time", time_unit),
            ("dt", time_unit),
            ("iterations", "-"),
            ("residual", "-"),
            ("linear_iterations", "-"),
            ("cutbacks", "-"),
            ("active_nodes", "-"),
            ("wall", "s"),
            ("newton_iterations", "-"),
            ("evaluations", "-"),
            ("products", "-"),
            ("factorisations", "-"),
            ("reductions", "-"),
            ("messages", "-"),
            ("bytes", "-"),
            ("imbalance", "-"),
        ]
        .map(|(name, unit)| TableColumn::new(name, unit))
    }

    /// Returns the step as a row for [`StepRow::columns`].
    pub fn cells(&self) -> [Cell; 17] {
        [
            Cell::Int(self.step),
            Cell::Float(self.time),
            Cell::Float(self.dt),
            Cell::Int(self.iterations),
            Cell::Float(self.residual),
            Cell::Int(self.linear_iterations),
            Cell::Int(self.cutbacks),
            Cell::Int(self.active_nodes),
            Cell::Float(self.wall),
            Cell::Int(self.newton_iterations),
            Cell::Int(self.evaluations),
            Cell::Int(self.products),
            Cell::Int(self.factorisations),
            Cell::Int(self.reductions),
            Cell::Int(self.messages),
            Cell::Int(self.bytes),
            Cell::Float(self.imbalance),
        ]
    }
}
