//! `steps.csv`: cost of each accepted step.

use crate::table::{Cell, TableColumn};

/// The file's name.
pub const STEPS: &str = "steps.csv";

/// What `steps.csv` keeps of one accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRow {
    /// The step's number.
    pub step: u64,
    /// s (pseudo-time in a quasi-static analysis)  at its end.
    pub time: f64,
    /// s (pseudo-time)  its length.
    pub dt: f64,
    /// Iterations of the nonlinear solution.
    pub iterations: u64,
    /// The force measure of the accepted state, without unit.
    pub residual: f64,
    /// Iterations of the linear solver in all attempts; a direct solve counts as one.
    pub linear_iterations: u64,
    /// How often the step was cut before it converged.
    pub cutbacks: u64,
    /// Nodes that carry material.
    pub active_nodes: u64,
    /// s  by the clock since the run began.
    pub wall: f64,
    /// Newton iterations among those of the nonlinear solution; 0 where a quasi-Newton method found equilibrium.
    pub newton_iterations: u64,
    /// Evaluations of the out-of-balance force in all attempts.
    pub evaluations: u64,
    /// Products with the complete derivative in all attempts.
    pub products: u64,
    /// Factorisations in all attempts.
    pub factorisations: u64,
    /// Reductions over all ranks, in all attempts and the exchange of points after them.
    pub reductions: u64,
    /// Messages between ranks there, of all ranks together, without the linear solver's own.
    pub messages: u64,
    /// Bytes of these messages.
    pub bytes: u64,
    /// Largest load of a rank over the mean.
    pub imbalance: f64,
}

impl StepRow {
    /// The file's columns; `time_unit` is `s`, or `-` for pseudo-time.
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

    /// The step as a row under [`StepRow::columns`].
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
