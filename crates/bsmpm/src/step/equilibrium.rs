//! Steps (3), (7)-(9): the quasi-Newton iteration, and when it has converged.
//!
//! Step (9) of the paper prints the same numerator and denominator; read |du_k . f_k| / |du_0 . f_0|. That product is
//! no norm (it crosses zero while the forces are far from balanced), so the relative out-of-balance
//! force must be small too. The displacement that is accepted is the one whose forces were evaluated.

use crate::boundary::strip::Grips;
use crate::error::{StepError, WorstNode};
use crate::grid::Shape;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::points::Points;
use crate::seam::{Halo, LinearSolver, dots};
use crate::step::nodes::Nodes;
use crate::step::quasi_newton::{Direction, Secants};
use crate::step::residual::Residual;
use crate::step::stiffness;
use crate::step::trial::Trial;
use crate::step::{Counts, Report};

/// A first residual this much below the force tolerance needs no iteration: |du_0 . f_0| would only be noise.
const ALREADY: f64 = 1e-2;
/// Round-off of the internal force, relative to E h^(D-1) x 1 m^(3-D) per square root of an unknown.
const ROUND_OFF: f64 = 1e-13;
/// Round-off of the inertia, relative to |4/dt M v| (with numerical damping: its factor): a few roundings.
const CANCELLED: f64 = 4.0 * f64::EPSILON;
/// Shortest part of a direction that is tried when points invert.
const SHORTEST: f64 = 1.0 / 16.0;

/// Everything that is fixed while a step is iterated.
pub struct Scene<'a, K, const D: usize> {
    /// the scene
    pub model: &'a Model<K, D>,
    /// step (1)
    pub shape: &'a Shape<D>,
    /// step (2)
    pub nodes: &'a Nodes,
    /// strips, attached to the nodes
    pub grips: &'a Grips<D>,
    /// state at t
    pub points: &'a Points<D>,
    /// the other ranks
    pub halo: &'a dyn Halo,
}

/// A converged displacement.
#[derive(Clone, Debug)]
pub struct Found {
    /// m, nodal
    pub u: Vec<f64>,
    /// deformation under `u`
    pub trial: Trial,
    /// N  force of the supports on the body, nodal
    pub reaction: Vec<f64>,
    iterations: usize,
    force: f64,
    first_guess: bool,
}

impl Found {
    /// The step's numbers; one reduction for the supports' forces.
    pub fn report<K: Kinematics<D>, const D: usize>(&self, scene: &Scene<'_, K, D>) -> Report {
        let nodes = scene.nodes;
        Report {
            iterations: self.iterations,
            force: self.force,
            active_nodes: nodes.active_nodes,
            unknowns: nodes.unknowns,
            massless_nodes: nodes.massless_nodes,
            first_guess: self.first_guess,
            reactions: scene.model.boundary.reactions(&scene.model.grid, &self.reaction, scene.halo),
            strips: Vec::new(),
            energy: None,
        }
    }
}

/// Finds equilibrium from the last displacement `guess` (step 3b); if that fails, from zero.
pub fn find<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    guess: &[f64],
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
) -> Result<Found, StepError> {
    if scene.nodes.unknowns > 0 {
        stiffness::assemble(scene, solver)?;
    }
    let (last, zero) = (admissible(scene.nodes, guess), admissible(scene.nodes, &vec![0.0; guess.len()]));
    let mut differs = [f64::from(u8::from(last != zero))];
    scene.halo.maximum(&mut differs);
    match iterate(scene, last, solver, counts) {
        Err(_) if differs[0] > 0.0 => {
            let found = iterate(scene, zero, solver, counts)?;
            Ok(Found { first_guess: false, ..found })
        }
        found => found,
    }
}

/// The guess where it is free, the prescribed values, zero elsewhere.
fn admissible(nodes: &Nodes, guess: &[f64]) -> Vec<f64> {
    let component = |(c, &value): (usize, &f64)| match nodes.prescribed[c] {
        Some(prescribed) => prescribed,
        None if nodes.free[c] => value,
        None => 0.0,
    };
    guess.iter().enumerate().map(component).collect()
}

fn iterate<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    mut u: Vec<f64>,
    solver: &mut dyn LinearSolver,
    counts: &mut Counts,
) -> Result<Found, StepError> {
    let criteria = scene.model.criteria;
    let floor = round_off(scene);
    let mut secants = Secants::new(scene.model.quasi_newton);
    let mut residual = evaluate(scene, &u, counts);
    if !residual.balance.is_sound() {
        return Err(inverted(scene, &residual, 0));
    }
    let mut first_energy = f64::INFINITY;
    let mut energies = Vec::new();
    for iteration in 0..criteria.max_iterations {
        let force = residual.balance.measure();
        let found = |residual: Residual, u| Found {
            u,
            trial: residual.trial,
            reaction: residual.balance.reaction,
            iterations: iteration,
            force,
            first_guess: true,
        };
        if residual.balance.norm <= floor || (iteration == 0 && force <= ALREADY * criteria.force) {
            return Ok(found(residual, u));
        }
        let direction = secants.direction::<D>(&residual.balance.f_oob, scene.halo, solver)?; // (6), (7)
        counts.iterations += 1;
        counts.linear_iterations += direction.linear_iterations;
        if iteration == 0 {
            first_energy = predicted_energy(scene, &residual.balance.f_oob, &direction);
        }
        let energy = direction.energy / first_energy;
        energies.push(energy);
        if energy < criteria.energy && force < criteria.force {
            return Ok(found(residual, u)); // (9)
        }
        let length = advance(scene, &mut u, &direction.du, &mut residual, counts, iteration)?; // (8), (4), (5)
        secants.took(length);
    }
    let energy = energies.last().copied().unwrap_or(f64::INFINITY);
    let (iterations, force) = (criteria.max_iterations, residual.balance.measure());
    Err(StepError::NotConverged { iterations, energy, force, energies, worst: worst_node(scene, &residual) })
}

/// Step (8): takes the direction, or the first half, quarter, .. of it under which no point inverts.
fn advance<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    u: &mut Vec<f64>,
    du: &[f64],
    residual: &mut Residual,
    counts: &mut Counts,
    iteration: usize,
) -> Result<f64, StepError> {
    let mut length = 1.0;
    loop {
        let next: Vec<f64> = u.iter().zip(du).map(|(u, du)| u + length * du).collect();
        let found = evaluate(scene, &next, counts);
        if found.balance.is_sound() {
            (*u, *residual) = (next, found);
            return Ok(length);
        }
        if length <= SHORTEST {
            return Err(inverted(scene, &found, iteration + 1));
        }
        length *= 0.5;
    }
}

/// |du_0 . (f_0 - K_strips du_0)|: the energy of the first direction without that of the strips' penalty, which takes up
/// their motion in it and would make the measure as much too lenient as the penalty is stiff.
fn predicted_energy<K: Kinematics<D>, const D: usize>(scene: &Scene<'_, K, D>, f: &[f64], first: &Direction) -> f64 {
    if scene.model.boundary.strips.is_empty() {
        return first.energy;
    }
    let mut penalty = [scene.grips.energy(&first.du)];
    scene.halo.reduce(&mut penalty);
    (dots(scene.halo, D, &[(&first.du, f)])[0] - penalty[0]).abs()
}

fn evaluate<K: Kinematics<D>, const D: usize>(scene: &Scene<'_, K, D>, u: &[f64], counts: &mut Counts) -> Residual {
    counts.evaluations += 1;
    Residual::of(scene, u)
}

fn inverted<K, const D: usize>(scene: &Scene<'_, K, D>, residual: &Residual, iteration: usize) -> StepError {
    let first = residual.first_inverted.map(|p| (scene.points.id[p], scene.points.x[p].as_slice().to_vec()));
    StepError::Inverted { count: residual.balance.inverted, iteration, first }
}

/// Where the forces of this rank's own nodes are the least balanced.
fn worst_node<K, const D: usize>(scene: &Scene<'_, K, D>, residual: &Residual) -> WorstNode {
    let grid = &scene.model.grid;
    let force =
        |node: usize| residual.balance.f_oob[node * D..(node + 1) * D].iter().map(|f| f * f).sum::<f64>().sqrt();
    let Some(worst) = scene.halo.owned().max_by(|&a, &b| force(a).total_cmp(&force(b))) else {
        return WorstNode::default();
    };
    let place = grid.node_at(worst);
    let x = (0..D).map(|axis| grid.axes()[axis].greville(place[axis])).collect();
    let first = grid.columns().start * grid.layer_nodes();
    WorstNode { number: (first + worst) as u64, x, force: force(worst) }
}

/// Out-of-balance force that is round-off, N: of the stiffest material, 1e-13 E_max h^(D-1) sqrt(n), or of the inertia,
/// whose terms 4/dt^2 u and 4/dt v cancel when dt is tiny.
fn round_off<K: Kinematics<D>, const D: usize>(scene: &Scene<'_, K, D>) -> f64 {
    let edge = scene.model.grid.smallest_edge();
    let nodes = scene.nodes;
    let internal = ROUND_OFF * scene.model.stiffest() * edge.powi(D as i32 - 1) * (nodes.unknowns as f64).sqrt();
    let Some(inertia) = &nodes.inertia else { return internal };
    let pulse = |(c, v): (usize, &f64)| inertia.newmark.pulse(inertia.dt) * nodes.weight[c / D] * v;
    let pulse: Vec<f64> = inertia.v.iter().enumerate().map(pulse).collect();
    internal.max(CANCELLED * dots(scene.halo, D, &[(&pulse, &pulse)])[0].sqrt())
}
