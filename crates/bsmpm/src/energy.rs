//! Energy balance of a run, theory-manual equations (T10.1) to (T10.3), in J (plane strain: J per metre).

mod budget;

use crate::schedule::TimeInterval;
pub use budget::{EnergyBound, Turnover};

use crate::exact::Exact;
use crate::field::pore_water::{carried, work};
use crate::grid::transfer;
use crate::interactions::InteractionWork;
use crate::interactions::load::LoadWork;
use crate::kinematics::{Gradient, Kinematics};
use crate::model::Model;
use crate::parallel::{Halo, over_layers};
use crate::points::Points;
use crate::solve::found::StepSolution;
use crate::step::adjoint::Pressures;
use crate::step::commit::PointUpdate;
use crate::step::problem::Problem;
use crate::tensor::Vector;
use crate::threads;
use std::ops::AddAssign;

/// Strain below which energy is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Energy flows in a step, or in all steps so far (J); see the module.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flows<T = f64> {
    /// Work of gravity, water, loads and prescribed motion, minus that of friction and absorbing faces.
    pub external: T,
    /// Dissipation by plastic flow, damping and seepage.
    pub plastic: T,
    /// Loss in the transfer between points and nodes.
    pub transfer: T,
    /// Loss by integration in time and along the strain path.
    pub integration: T,
    /// Loss by smoothing of the elastic strain.
    pub smoothing: T,
    /// Loss to the artificial stiffness.
    pub artificial_stiffness: T,
    /// Loss in the penalty between strips and material.
    pub penalty: T,
}

impl Flows {
    /// Returns the total numerical loss (J).
    pub fn numerical(&self) -> f64 {
        self.transfer + self.integration + self.smoothing + self.artificial_stiffness + self.penalty
    }

    /// Creates the flows from sums in the order of [`Self::each`].
    fn of(sums: &[f64]) -> Self {
        let mut flows = Self::default();
        let each = flows.each().into_iter();
        each.zip(sums).for_each(|(flow, sum)| *flow = *sum);
        flows
    }
}

impl<T> Flows<T> {
    fn each(&mut self) -> [&mut T; 7] {
        let Self {
            external,
            plastic,
            transfer,
            integration,
            smoothing,
            artificial_stiffness,
            penalty,
        } = self;
        [
            external,
            plastic,
            transfer,
            integration,
            smoothing,
            artificial_stiffness,
            penalty,
        ]
    }
}

impl AddAssign for Flows {
    fn add_assign(&mut self, mut other: Self) {
        self.each()
            .into_iter()
            .zip(other.each())
            .for_each(|(sum, step)| *sum += *step);
    }
}

/// Energy stored in the material points (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StoredEnergy {
    /// Kinetic energy `Σ ½ m |v|²`.
    pub kinetic: f64,
    /// Elastic energy `Σ V0 (½ λ tr(ε)² + μ ε : ε)` with ε = ½ ln bᵉ; for flowing water `Σ V0 n p²/(2 K_w)`, and `- Σ
    /// V0 n ∫ p dS` where pores are unsaturated.
    pub elastic: f64,
}

impl StoredEnergy {
    /// Computes the energy of the points of all ranks at time `t` (s). One reduction.
    pub fn of<K: Kinematics<D>, const D: usize>(
        model: &Model<K, D>,
        points: &Points<D>,
        t: f64,
        halo: &dyn Halo,
    ) -> Self {
        let sums = halo.reproducible_sum(&[kinetic(points), elastic(model, points, t)]);
        Self {
            kinetic: sums[0],
            elastic: sums[1],
        }
    }
}

/// Energy account of a run, sufficient to restart it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyAccounts {
    /// Kinetic and elastic energy when the account was opened (J), adjusted for added and removed points.
    pub start: f64,
    /// All flows since then.
    pub flows: Flows,
}

impl EnergyAccounts {
    /// Opens the account in a state.
    pub fn open(stored: StoredEnergy) -> Self {
        Self {
            start: stored.kinetic + stored.elastic,
            flows: Flows::default(),
        }
    }

    /// Adds the energy of points that were added, and subtracts that of points that were removed.
    pub fn exchange(&mut self, before: StoredEnergy, after: StoredEnergy) {
        self.start += (after.kinetic + after.elastic) - (before.kinetic + before.elastic);
    }

    /// Returns the energy residual of a state (J): `external - Δ(T + E) - plastic - numerical`.
    pub fn residual(&self, now: StoredEnergy) -> f64 {
        let spent = self.flows.plastic + self.flows.numerical();
        (self.flows.external - spent) - ((now.kinetic + now.elastic) - self.start)
    }
}

/// Energy flows of a step on this rank, before the points are updated.
#[derive(Clone, Debug)]
pub struct StepEnergy {
    flows: Flows<Exact>,
    damped: Exact, // part of the dissipation
    elastic: Exact,
    dry: Option<Vec<f64>>, // masses before the points take in water (kg), if water flows
    friction_work: Exact,  // half the work of friction and dashpots at faces, part of the external work
    interval: TimeInterval,
}

impl StepEnergy {
    /// Computes all terms that do not need the updated points. Without an energy balance, only the terms of
    /// [`EnergyBound`] are computed.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
        answers: &[PointUpdate],
        interval: TimeInterval,
    ) -> Self {
        let Problem {
            model, nodes, points, ..
        } = *problem;
        let u = &found.u[..];
        let mut flows = Flows {
            external: over_layers(problem.halo, D, |c| found.reaction[c] * u[c]),
            ..Flows::<Exact>::default()
        };
        let friction_work = add_interactions(&mut flows, problem, found);
        add_gravity(&mut flows, problem, u, interval);
        add_water(&mut flows, problem, u, interval);
        let [plastic, mut elastic] = threads::sums(points.len(), |p| {
            [answers[p].dissipation, answers[p].elastic_energy].map(|dense| points.volume[p] * dense)
        });
        flows.plastic = plastic;
        let mut damped = Exact::ZERO;
        if !model.damping.is_empty() {
            damped = threads::sum(points.len(), |p| {
                points.volume[p] * found.trial.damping_takes(model, points, p).unwrap_or(0.0)
            });
            flows.plastic += &damped;
        }
        if model.balances_energy {
            flows.integration -= &flows.plastic;
        }
        if let Some(water) = work::Work::of(problem, found) {
            flows.external += &water.external;
            flows.plastic += &water.seepage;
            flows.integration += &water.stored;
            flows.integration += &water.tau;
            elastic += &water.held;
        }
        let dry = nodes.field.is_some().then(|| points.mass.to_vec());
        let mut draft = Self {
            flows,
            damped,
            elastic,
            dry,
            friction_work,
            interval,
        };
        if model.balances_energy {
            draft.add_losses(problem, found, answers);
        }
        draft
    }

    /// Adds the numerical losses.
    fn add_losses<K: Kinematics<D>, const D: usize>(
        &mut self,
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
        answers: &[PointUpdate],
    ) {
        let Problem {
            model, shape, points, ..
        } = *problem;
        let flows = &mut self.flows;
        let u = &found.u[..];
        let pressures = Pressures::of(problem, &found.trial);
        let volume = problem.volume();
        let work = transfer::gradients::<K, D, _>(shape, &points.x, u, |p, grad| {
            let tau = pressures.acting::<K, D>(p, volume[p], answers[p].tau);
            let tau = found.trial.pressed(p, found.trial.damped_at(model, points, p, tau));
            volume[p] * K::flux(&tau, &found.trial.dF(p)).dot(&grad)
        });
        flows.integration += &threads::sum(work.len(), |p| work[p]);
        flows.integration -= &self.elastic;
        flows.integration += &elastic(model, points, self.interval.start);
        flows.smoothing += &self.elastic;
        flows.transfer += &kinetic(points);
        add_inertia(flows, problem, u);
    }

    /// Completes the flows of the step over all ranks, with the work of the loads. Returns the flows, if the model
    /// balances its energy, and the terms of the energy bound. The points are updated. One reduction.
    pub fn close<K: Kinematics<D>, const D: usize>(
        self,
        model: &Model<K, D>,
        points: &Points<D>,
        load_work: LoadWork,
        halo: &dyn Halo,
    ) -> (Option<Flows>, Turnover) {
        let Self {
            flows: mut own,
            damped,
            elastic: strained,
            dry,
            friction_work,
            interval,
        } = self;
        let moving = kinetic(points);
        if let Some((dry, motion)) = dry.zip(points.motion.as_ref()) {
            let brought = brought(points, &dry, &motion.v);
            own.external += &brought;
            own.transfer += &brought;
        }
        let mut external = own.external.clone();
        // If loads grow in the first step, forces at its end do up to twice the work of their mean, which is what the
        // balance counts. Half the work of friction and dashpots is therefore left out of the bound.
        external -= &friction_work;
        let mut sums = vec![
            external,
            own.plastic.clone(),
            damped,
            moving.clone(),
            strained,
            round_off(model, points),
        ];
        if model.balances_energy {
            own.transfer -= &moving;
            own.smoothing -= &elastic(model, points, interval.end());
            sums.extend(own.each().map(|flow| flow.clone()));
        }
        let sums = halo.reproducible_sum(&sums);
        // The points of loads are the same on every rank.
        let turnover = Turnover {
            external: sums[0] + load_work.mean,
            plastic: sums[1],
            damped: sums[2],
            stored: StoredEnergy {
                kinetic: sums[3],
                elastic: sums[4],
            },
            round_off: sums[5],
        };
        let flows = model.balances_energy.then(|| {
            let mut flows = Flows::of(&sums[6..]);
            flows.external += load_work.mean;
            flows.integration -= load_work.half_increase;
            flows
        });
        (flows, turnover)
    }
}

/// Returns the energy of a strain that is round-off (J).
fn round_off<K, const D: usize>(model: &Model<K, D>, points: &Points<D>) -> Exact {
    let young: Vec<f64> = model
        .materials
        .iter()
        .map(|material| material.elastic().young)
        .collect();
    threads::sum(points.len(), |p| {
        points.volume[p] * young[usize::from(points.material[p])] * ROUND_OFF.powi(2)
    })
}

fn kinetic<const D: usize>(points: &Points<D>) -> Exact {
    let Some(motion) = &points.motion else {
        return Exact::ZERO;
    };
    threads::sum(points.len(), |p| 0.5 * points.mass[p] * motion.v[p].norm_squared())
}

/// Returns the kinetic energy of the water that the points took in since their masses were `dry` (kg), in J.
fn brought<const D: usize>(points: &Points<D>, dry: &[f64], v: &[Vector<D>]) -> Exact {
    let masses = points.mass.iter().zip(dry).zip(v);
    masses
        .map(|((mass, dry), v)| 0.5 * (mass - dry) * v.norm_squared())
        .collect()
}

/// Returns the elastic energy of the points; NaN in a state without a valid strain.
fn elastic<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, points: &Points<D>, t: f64) -> Exact {
    let mut energy = threads::sum(points.len(), |p| {
        points.volume[p] * model.elastic_energy(points, p, &points.b_e.at(p))
    });
    energy += &work::in_points(model, points, t);
    energy
}

/// Adds the work of the interactions, and of impacts at nodes. Returns half the work of friction and dashpots.
fn add_interactions<K: Kinematics<D>, const D: usize>(
    flows: &mut Flows<Exact>,
    problem: &Problem<'_, K, D>,
    found: &StepSolution<K, D>,
) -> Exact {
    let Problem { nodes, halo, .. } = *problem;
    let mut work = InteractionWork::default();
    let context = problem.context();
    let dF = |p: usize| found.trial.dF(p);
    for interaction in nodes.interactions.iter() {
        interaction.add_work(&context, &found.state(&dF), &mut work);
    }
    flows.external += &work.external;
    flows.integration += &work.integration;
    flows.penalty = work.penalty;
    flows.artificial_stiffness = work.artificial_stiffness;
    if let Some(inertia) = nodes.inertia.as_ref().filter(|inertia| !inertia.struck.is_empty()) {
        let blow = over_layers(halo, D, |c| inertia.struck[c]);
        flows.external += &blow;
        flows.transfer = blow;
    }
    work.friction
}

/// Adds the work of gravity by its mean over the step; half its increment times u is a loss by integration.
fn add_gravity<K: Kinematics<D>, const D: usize>(
    flows: &mut Flows<Exact>,
    problem: &Problem<'_, K, D>,
    u: &[f64],
    interval: TimeInterval,
) {
    let Some(before) = problem.model.body_force(interval.start) else {
        return;
    };
    let Some(after) = problem.model.body_force(interval.end()) else {
        return;
    };
    let moved = transfer::to_points::<D, D, _>(problem.shape, u, |p, du| Vector::from(du) * problem.points.mass[p]);
    let by = [0.5 * (before + after), -0.5 * (after - before)];
    let [external, integration] = threads::sums(moved.len(), |p| by.map(|force| force.dot(&moved[p])));
    flows.external += &external;
    flows.integration += &integration;
}

fn add_water<K: Kinematics<D>, const D: usize>(
    flows: &mut Flows<Exact>,
    problem: &Problem<'_, K, D>,
    u: &[f64],
    interval: TimeInterval,
) {
    let times = [interval.start, interval.end()];
    let Problem {
        model, points, shape, ..
    } = *problem;
    if let Some(work) = carried::work::<K, D>(model, shape, points, problem.volume(), u, times) {
        flows
            .external
            .extend(work.iter().map(|[before, after]| 0.5 * (before + after)));
        flows
            .integration
            .extend(work.iter().map(|[before, after]| -0.5 * (after - before)));
    }
    let Some(before) = model.still_water(interval.start) else {
        return;
    };
    let Some(after) = model.still_water(interval.end()) else {
        return;
    };
    let work = transfer::to_points::<D, D, _>(problem.shape, u, |p, du| {
        let follows = model.follows_water(points, p);
        let span = model.span(points, p);
        let [before, after] =
            [&before, &after].map(|water| water.force(points, p, span, follows).dot(&Vector::from(du)));
        [0.5 * (before + after), -0.5 * (after - before)]
    });
    flows.external.extend(work.iter().map(|work| work[0]));
    flows.integration.extend(work.iter().map(|work| work[1]));
}

/// Adds the work of inertia, and the kinetic energy of this rank's own nodes at both ends of the step.
fn add_inertia<K, const D: usize>(flows: &mut Flows<Exact>, problem: &Problem<'_, K, D>, u: &[f64]) {
    let Some(inertia) = &problem.nodes.inertia else { return };
    let halo = problem.halo;
    let mass = problem.mass();
    let velocity: Vec<f64> = u.iter().enumerate().map(|(c, &u)| inertia.velocity(c, u)).collect();
    let acting: Vec<f64> = u.iter().enumerate().map(|(c, &u)| inertia.acting(c, u)).collect();
    let [before, after] = [&inertia.v[..], &velocity].map(|v| {
        let momentum = mass.times(v);
        over_layers(halo, D, |c| 0.5 * momentum[c] * v[c])
    });
    let force = mass.times(&acting);
    // Transfer loses what the points have more than the nodes at the start, and less at the end. Integration loses
    // what the inertia works more than the nodes gain.
    flows.transfer += &after;
    flows.transfer -= &before;
    flows.integration += &over_layers(halo, D, |c| force[c] * u[c]);
    flows.integration -= &after;
    flows.integration += &before;
}
