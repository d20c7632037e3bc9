//! Report of an accepted step.

use crate::energy::{Flows, Turnover};
use crate::error::Measures;
use crate::field::FieldReport;
use crate::interactions::InteractionReports;
use crate::interactions::artificial_stiffness::ArtificialStiffnessReport;
use crate::interactions::coulomb::ContactReport;
use crate::interactions::rigid::RigidReport;
use crate::interactions::state::InteractionState;
use crate::interactions::strip::StripReport;
use crate::kinematics::Kinematics;
use crate::solve::found::StepSolution;
use crate::step::outflow::Outflow;
use crate::step::problem::Problem;

/// Computational work of one or more attempts, including failed ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Quasi-Newton and Newton iterations.
    pub iterations: usize,
    /// Evaluations of the residual.
    pub evaluations: usize,
    /// Iterations of the linear solver.
    pub linear_iterations: usize,
    /// Matrix-vector products with the complete derivative.
    pub products: usize,
    /// Factorisations.
    pub factorisations: usize,
}

/// Report of an accepted step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Step size (s).
    pub dt: f64,
    /// Iterations from the initial guess that led to convergence.
    pub iterations: usize,
    /// Newton iterations among these; 0 if the quasi-Newton method converged.
    pub newton_iterations: usize,
    /// Convergence measures of every iteration.
    pub history: Vec<Measures>,
    /// Measures that met the criteria; `None` if the initial state was already in equilibrium.
    pub judged: Option<Measures>,
    /// Force measure of the accepted state: |f_oob| / largest force (-).
    pub force: f64,
    /// Nodes that carry material, over all ranks.
    pub active_nodes: usize,
    /// Unknowns of the linear system, over all ranks.
    pub unknowns: usize,
    /// Active nodes whose mass is negligible, over all ranks. Their velocity and averages are set to zero.
    pub massless_nodes: usize,
    /// Splines that are tied to those of full cells, over all ranks.
    pub tied_functions: usize,
    /// Splines of nearly empty cells that are not tied, over all ranks: no full cell is near enough, or a footing, a
    /// prescribed segment or a rigid body touches them.
    pub untied_functions: usize,
    /// Whether only the force criterion was met: no method converged further, and the forces balance far below their
    /// tolerance.
    pub settled: bool,
    /// Whether the iteration converged from the first guess of the displacement.
    pub first_guess: bool,
    /// Force of each support on the body (N), by component, in the order of the model's supports.
    pub reactions: Vec<Vec<f64>>,
    /// Reports of the faces with contact.
    pub contacts: Vec<ContactReport>,
    /// Reports of the rigid bodies.
    pub rigid: Vec<RigidReport>,
    /// Reports of the rigid strips.
    pub strips: Vec<StripReport>,
    /// Results of the artificial stiffness, if there is one.
    pub artificial_stiffness: Option<ArtificialStiffnessReport>,
    /// Second-order works of the step (J): for elastic soil with the same strain, and the actual one. Only in
    /// quasi-static analysis with yielding materials and without a second field.
    pub second_order_works: Option<[f64; 2]>,
    /// Energy flows of the step (J), if the model balances its energy.
    pub energy: Option<Flows>,
    /// Terms of the energy bound (J), in dynamics and if the model balances its energy.
    pub turnover: Option<Turnover>,
    /// Largest displacement of a material point in the step, over all ranks (m).
    pub advance: f64,
    /// Kinetic energy of points within a cell of a fixed face in excess of that of their displacement (J). Only in
    /// dynamics with such a face.
    pub beside_fixed: Option<f64>,
    /// Material that left the grid, if any.
    pub outflow: Option<Outflow>,
    /// Report of the second field, if there is one.
    pub water: Option<FieldReport>,
    /// Smoothing of the elastic state as a fraction of one pass of S, mean over the points (-).
    pub smoothed: f64,
}

impl StepReport {
    /// Creates the report of a converged displacement with the results of the interactions, before the points are
    /// updated. `before` is the state of the interactions at the start of the step. One reduction for the forces of the
    /// supports.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        found: &StepSolution<K, D>,
        interactions: InteractionReports,
        before: &InteractionState<D>,
    ) -> Self {
        let constraints = &problem.nodes.constraints;
        let extension = constraints.extension.as_ref();
        let boundary = &problem.model.boundary;
        Self {
            iterations: found.history.len(),
            history: found.history.clone(),
            judged: found.judged,
            force: found.force,
            newton_iterations: found.newton_iterations,
            active_nodes: constraints.active_nodes,
            unknowns: constraints.unknowns,
            massless_nodes: constraints.massless_nodes,
            tied_functions: extension.map_or(0, |extension| extension.tied),
            untied_functions: extension.map_or(0, |extension| extension.untied),
            settled: found.settled,
            first_guess: found.first_guess,
            reactions: boundary.reactions(&problem.model.grid, &found.reaction, problem.halo),
            contacts: interactions.contacts,
            rigid: interactions.rigid,
            strips: interactions.strips,
            artificial_stiffness: interactions.artificial_stiffness,
            water: FieldReport::of(problem, found, before.flowed.as_ref()),
            ..Self::default()
        }
    }
}
