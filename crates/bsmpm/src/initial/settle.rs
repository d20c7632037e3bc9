//! Equilibrium at the start with the materials' own laws: a stress that was guessed is led to it in parts, and nothing
//! moves. A round seeks the displacement under which the laws' stress balances the loads, keeps the stress, and lets
//! the displacement go; what the lost displacement did to the lever arms is a part in the strain of the forces of that
//! round, and the next one mends it.

use super::{BALANCED, CORRECTIONS, Undeformed, b_e_of, elastic_at, elastic_residual, stress_of};
use crate::error::StepError;
use crate::grid::transfer;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::{Halo, LinearSolver};
use crate::points::Points;
use crate::solve;
use crate::step::commit;
use crate::step::residual::Residual;
use crate::step::report::Counts;
use crate::step::stiffness;
use crate::tensor::Symmetric;

/// Rounds after which the search is given up.
const MOST_ROUNDS: usize = 60;
/// Least part of what is out of balance that a round takes on.
const LEAST: f64 = 1.0 / 64.0;

/// What a search for equilibrium took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settling {
    /// equilibria that were found on the way
    pub rounds: usize,
    /// evaluations of the forces
    pub evaluations: usize,
}

/// Puts the vertical stress of linear elastic equilibrium next to the given one in its place, with the shear that goes
/// with it, and `k0(material)` times it as horizontal stress: of level ground that is an equilibrium, in which no
/// quadrature is left, and beneath a step of the surface the weight above is spread. Fails as
/// [`set_elastic`](super::set_elastic).
pub fn spread<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    k0: impl Fn(u16) -> f64,
    (halo, solver): (&dyn Halo, &mut dyn LinearSolver),
) -> Result<(), StepError> {
    let model = &model.at_rest();
    let start = Undeformed::of(model, points, halo)?;
    let problem = start.problem(model, points, halo);
    stiffness::assemble(&problem, None, solver)?;
    let mut u = vec![0.0; model.grid.nodes() * D];
    let mut du = u.clone();
    let given: Vec<Symmetric> = (0..points.len()).map(|p| points.sigma.at(p)).collect();
    let mut stresses = given.clone();
    for _ in 0..CORRECTIONS {
        let residual = elastic_residual(&problem, &stresses, &u);
        if residual.measure() <= BALANCED {
            break;
        }
        if halo.is_interrupted() {
            return Err(StepError::Interrupted);
        }
        solver.solve(&residual.f_oob, &mut du)?;
        u.iter_mut().zip(&du).for_each(|(u, du)| *u += du);
        let strains = transfer::gradients::<K, D, _>((&start.shape, &points.x), &u, |_, grad| {
            Symmetric::of(&K::gradient::<f64>(&grad))
        });
        for (p, strain) in strains.iter().enumerate() {
            let added = stress_of(&elastic_at(model, points, p), strain);
            stresses[p] = Symmetric(std::array::from_fn(|k| given[p].0[k] + added.0[k]));
        }
    }
    for (p, mut stress) in stresses.into_iter().enumerate() {
        let vertical = stress.0[D - 1];
        let side = k0(points.material[p]) * vertical;
        (0..3).filter(|k| *k != D - 1).for_each(|k| stress.0[k] = side);
        let law = model.materials[usize::from(points.material[p])].at(points.height(p));
        let state = points.state.as_mut().map_or(&mut [][..], |state| state.of_point_mut(p));
        state.fill(0.0);
        points.b_e.set(p, b_e_of(&law, &stress, state));
        points.sigma.set(p, stress);
    }
    Ok(())
}

/// Leads the stress at the start to equilibrium under the loads at time 0, on and within the yield surfaces. Places, F,
/// displacements and plastic strains stay those of the start; the laws' state goes with the stress. Fails if there is
/// no equilibrium.
pub fn settle<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    points: &mut Points<D>,
    (halo, solver): (&dyn Halo, &mut dyn LinearSolver),
) -> Result<Settling, StepError> {
    let model = &model.at_rest();
    let at_rest = vec![0.0; model.grid.nodes() * D];
    let (mut held, mut counts, mut rounds) = (None::<Vec<f64>>, Counts::default(), 0);
    let (mut left, mut part) = (1.0_f64, 1.0_f64);
    loop {
        let mut start = Undeformed::of(model, points, halo)?;
        let balance = Residual::of(&start.problem(model, points, halo), &at_rest).balance;
        let is_balanced = balance.measure() <= model.criteria.force;
        if is_balanced && (left == 0.0 || rounds == 0 && super::balance(model, points, halo)?.yielding == 0) {
            return Ok(Settling { rounds, evaluations: counts.evaluations });
        }
        if rounds == MOST_ROUNDS {
            return Err(StepError::Unbalanced { rounds, force: balance.measure() });
        }
        // What is out of balance at first, the stress beyond yield returned, is held by forces that go.
        let (held, next) = (held.get_or_insert(balance.f_oob), (left - part).max(0.0));
        start.nodes.f_ext.iter_mut().zip(&*held).for_each(|(force, held)| *force -= next * held);
        let around = (&start.grips, &*points);
        let found =
            solve::contact::find(model, &start.shape, &mut start.nodes, around, &at_rest, (halo, solver), &mut counts);
        match found {
            Ok(found) => {
                let responses = commit::responses(model, &found.trial, points, halo)?;
                let (_, traction) = start.grips.conclude(&model.boundary.strips, &found.u, halo);
                points.surface.traction = traction;
                for (p, response) in responses.iter().enumerate() {
                    points.b_e.set(p, response.b_e());
                    points.sigma.set(p, response.tau());
                    if let Some(state) = &mut points.state {
                        response.advance(state.of_point_mut(p));
                    }
                }
                (left, part, rounds) = (next, 2.0 * part, rounds + 1);
            }
            Err(error) if error.is_final() || part.min(left) <= LEAST => return Err(error),
            Err(_) => part = 0.5 * part.min(left),
        }
    }
}
