//! Steps (3), (7)-(9): how equilibrium is sought: from which guess, by which method, and what comes after a failure.
#![doc = include_str!("equilibrium.md")]

use crate::boundary::strip::Grips;
use crate::error::{Measures, StepError};
use crate::grid::Shape;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::points::Points;
use crate::seam::{Halo, LinearSolver};
use crate::step::mass::Mass;
use crate::step::nodes::Nodes;
use crate::step::progress::{Progress, inverted};
use crate::step::quasi_newton::{self, QuasiNewton, Stopped};
use crate::step::residual::Residual;
use crate::step::trial::Trial;
use crate::step::{Counts, Report, newton, stiffness};

/// How equilibrium is sought.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Nonlinear {
    /// All recent secants, and Newton's method where they stall.
    #[default]
    Auto,
    /// One quasi-Newton method, to the limit of iterations.
    QuasiNewton(QuasiNewton),
    /// Newton's method from the start.
    Newton,
}

/// What gave the direction of one iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Secants on the stiffness at `u`, where they start.
    QuasiNewton(QuasiNewton),
    /// The complete derivative.
    Newton,
}

/// Everything that is fixed while a step is iterated.
pub struct Scene<'a, K, const D: usize> {
    /// the scene
    pub model: &'a Model<K, D>,
    /// step (1)
    pub shape: &'a Shape<D>,
    /// step (2)
    pub nodes: &'a Nodes<D>,
    /// strips, attached to the nodes
    pub grips: &'a Grips<D>,
    /// state at t
    pub points: &'a Points<D>,
    /// the other ranks
    pub halo: &'a dyn Halo,
}

impl<'a, K, const D: usize> Scene<'a, K, D> {
    /// The mass matrix, in dynamics.
    pub fn mass(&self) -> Mass<'_, D> {
        self.nodes.mass(self.model, (self.shape, self.points), self.halo)
    }

    /// What the points weigh in the integrals of the stress, m^D of the reference volume.
    #[inline]
    pub fn volume(&self) -> &'a [f64] {
        self.nodes.volume(self.points)
    }
}

/// A converged displacement.
#[derive(Clone, Debug)]
pub struct Found<const D: usize> {
    /// m, nodal
    pub u: Vec<f64>,
    /// deformation under `u`
    pub trial: Trial<D>,
    /// N  force of the supports on the body, nodal
    pub reaction: Vec<f64>,
    history: Vec<Measures>,
    force: f64,
    work: f64, // J  of all internal forces, with a background
    newton_iterations: usize,
    settled: bool,
    first_guess: bool,
}

impl<const D: usize> Found<D> {
    /// The state that an iteration reached.
    pub fn new(u: Vec<f64>, residual: Residual<D>, progress: &Progress) -> Self {
        let newton_iterations = progress.by_newton();
        let (force, work) = (progress.measure(&residual.balance), residual.balance.work);
        let Residual { trial, balance, .. } = residual;
        let (history, reaction) = (progress.history().to_vec(), balance.reaction);
        Self { u, trial, reaction, history, force, work, newton_iterations, settled: false, first_guess: true }
    }

    /// The step's numbers; one reduction for the supports' forces, and one for the background's work.
    pub fn report<K: Kinematics<D>>(&self, scene: &Scene<'_, K, D>) -> Report {
        let nodes = scene.nodes;
        let soft = nodes.background.as_ref().map(|blocks| blocks.work::<D>(scene.shape, &self.u));
        Report {
            iterations: self.history.len(),
            history: self.history.clone(),
            force: self.force,
            newton_iterations: self.newton_iterations,
            active_nodes: nodes.active_nodes,
            unknowns: nodes.unknowns,
            massless_nodes: nodes.massless_nodes,
            background_cells: nodes.background_cells,
            settled: self.settled,
            first_guess: self.first_guess,
            reactions: scene.model.boundary.reactions(&scene.model.grid, &self.reaction, scene.halo),
            strips: Vec::new(),
            background: soft.map(|work| [scene.halo.total(&[work])[0], self.work]),
            energy: None,
            turnover: None,
            smoothed: 0.0,
        }
    }
}

/// Finds equilibrium from the last displacement `guess` (step 3b); if that fails, from zero.
pub fn find<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    guess: &[f64],
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
) -> Result<Found<D>, StepError> {
    let (last, zero) = (admissible(scene.nodes, guess), admissible(scene.nodes, &vec![0.0; guess.len()]));
    let mut differs = [f64::from(u8::from(last != zero))];
    scene.halo.maximum(&mut differs);
    let method = scene.model.nonlinear;
    match search(scene, method, last, (solver, counts)) {
        Err(error) if !error.is_final() && differs[0] > 0.0 => {
            let method = if method == Nonlinear::Auto { Nonlinear::Newton } else { method };
            let found = search(scene, method, zero, (solver, counts))?;
            Ok(Found { first_guess: false, ..found })
        }
        found => found,
    }
}

/// Seeks equilibrium from one guess.
fn search<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    method: Nonlinear,
    u: Vec<f64>,
    (solver, counts): (&mut dyn LinearSolver, &mut Counts),
) -> Result<Found<D>, StepError> {
    let mut progress = Progress::new(scene);
    let secants = match method {
        Nonlinear::Newton => {
            let found = newton::iterate(scene, u, solver, counts, &mut progress);
            return found
                .or_else(|failure| settled(scene, failure, counts, &progress))
                .map_err(|failure| *failure.error);
        }
        Nonlinear::QuasiNewton(secants) => secants,
        Nonlinear::Auto => QuasiNewton::Multisecant,
    };
    let patient = method != Nonlinear::Auto;
    let mut failure = match by_secants(scene, (secants, patient), u, (solver, counts), &mut progress) {
        Ok(found) => return Ok(found),
        Err(failure) => failure,
    };
    if let (Some(best), false) = (failure.best.take(), patient) {
        let found = newton::iterate(scene, best, solver, counts, &mut progress);
        failure = match found.or_else(|failure| settled(scene, failure, counts, &progress)) {
            Ok(found) => return Ok(found),
            Err(failure) => failure,
        };
        if let Some(best) = failure.best.take() {
            failure = match by_secants(scene, (secants, true), best, (solver, counts), &mut progress) {
                Ok(found) => return Ok(found),
                Err(failure) => failure,
            };
        }
    }
    // Secants alone that come to their limit might have gone on.
    let found = if patient { Err(failure) } else { settled(scene, failure, counts, &progress) };
    found.map_err(|failure| *failure.error)
}

/// The first state of an iteration that led on no further whose forces balance far below their tolerance.
fn settled<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    failure: Stopped,
    counts: &mut Counts,
    progress: &Progress,
) -> Result<Found<D>, Stopped> {
    if failure.error.is_final() {
        return Err(failure);
    }
    let Some(u) = progress.settled() else { return Err(failure) };
    let residual = evaluate(scene, u, counts);
    Ok(Found { settled: true, ..Found::new(u.clone(), residual, progress) })
}

/// Secants on the stiffness at `u`, where they start.
fn by_secants<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    method: (QuasiNewton, bool),
    u: Vec<f64>,
    (solver, counts): (&mut dyn LinearSolver, &mut Counts),
    progress: &mut Progress,
) -> Result<Found<D>, Stopped> {
    let residual = evaluate(scene, &u, counts);
    if !residual.balance.is_sound() {
        return Err(inverted(scene, &residual, progress.iterations()).into());
    }
    if scene.nodes.unknowns > 0 && !progress.is_balanced(&residual.balance, scene) {
        stiffness::assemble(scene, Some(&residual.trial), solver)?;
        counts.factorisations += 1;
    }
    quasi_newton::iterate(scene, method, (u, residual), solver, counts, progress)
}

/// The guess where it is free, the prescribed values, zero elsewhere.
fn admissible<const D: usize>(nodes: &Nodes<D>, guess: &[f64]) -> Vec<f64> {
    let component = |(c, &value): (usize, &f64)| match nodes.prescribed[c] {
        Some(prescribed) => prescribed,
        None if nodes.free[c] => value,
        None => 0.0,
    };
    guess.iter().enumerate().map(component).collect()
}

/// The forces under `u`, counted.
pub fn evaluate<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    u: &[f64],
    counts: &mut Counts,
) -> Residual<D> {
    counts.evaluations += 1;
    Residual::of(scene, u)
}
