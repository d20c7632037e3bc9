//! Report of an accepted step.

use crate::boundary::{ContactReport, RigidReport, StripReport};
use crate::energy::{Flows, Turnover};
use crate::error::Measures;
use crate::grid::Contributions;
use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
use crate::solve::found::StepSolution;
use crate::step::outflow::Outflow;
use crate::step::problem::Problem;
use crate::water::saved::WaterReport;

/// Work of one or more attempts, failed ones included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// quasi-Newton and Newton iterations
    pub iterations: usize,
    /// evaluations of the residual
    pub evaluations: usize,
    /// iterations of the linear solver
    pub linear_iterations: usize,
    /// products with the complete derivative
    pub products: usize,
    /// factorisations
    pub factorisations: usize,
}

/// What an accepted step did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// s  length of the step
    pub dt: f64,
    /// iterations from the guess that led to convergence
    pub iterations: usize,
    /// Newton iterations among them; 0 where the quasi-Newton method got there
    pub newton_iterations: usize,
    /// both measures of every iteration
    pub history: Vec<Measures>,
    /// those that it was accepted by; none of a state that was in balance before any direction was known
    pub judged: Option<Measures>,
    /// force measure |f_oob| / largest force of the accepted state
    pub force: f64,
    /// nodes that carry material, over all ranks
    pub active_nodes: usize,
    /// unknowns of the linear system, over all ranks
    pub unknowns: usize,
    /// active nodes without mass, whose velocity and averages count as zero
    pub massless_nodes: usize,
    /// cells with the soft background, over all ranks
    pub background_cells: usize,
    /// functions that are tied to those of full cells, over all ranks
    pub tied_functions: usize,
    /// functions of nearly empty cells alone that are not tied, over all ranks: no full cell is near enough, or a
    /// footing, a prescribed segment or a rigid body holds them
    pub untied_functions: usize,
    /// whether the forces alone decided: the methods led on no further, and forces balanced far below their tolerance
    pub settled: bool,
    /// whether the first guess of the displacement led to convergence
    pub first_guess: bool,
    /// N  force of every support on the body, by component, in the order of the model's supports
    pub reactions: Vec<Vec<f64>>,
    /// what every face with contact did
    pub contacts: Vec<ContactReport>,
    /// what every rigid body did
    pub rigid: Vec<RigidReport>,
    /// what every rigid strip did
    pub strips: Vec<StripReport>,
    /// J  work (u - w) . B (u - w) on the soft background, w the displacement that it does not resist; and the larger
    /// of the magnitudes of the works f_int u of all nodes and components, the background's among them, and of the
    /// works of the points' stresses. Only with a background.
    pub background: Option<[f64; 2]>,
    /// largest force of the background on a node over the RMS force of the nodes, with a background and without
    /// prescribed motions in the step
    pub background_share: Option<f64>,
    /// J  second-order works of the step: that of elastic ground with its strain, and the actual one; in quasi-static
    /// analysis of material that yields, without water that flows
    pub second_order_works: Option<[f64; 2]>,
    /// J  where the energy went, if the model balances it
    pub energy: Option<Flows>,
    /// J  what bounds the energy, in dynamics and where the model balances it
    pub turnover: Option<Turnover>,
    /// m  the farthest that a point moved, over all ranks
    pub advance: f64,
    /// J  kinetic energy that points within a cell of a fixed face have beyond that of their motion, in dynamics with
    /// such a face
    pub beside_fixed: Option<f64>,
    /// what left the grid, if anything did
    pub outflow: Option<Outflow>,
    /// what the water did, where it flows
    pub water: Option<WaterReport>,
    /// share of a pass of S by which the elastic state was smoothed, mean over the points
    pub smoothed: f64,
}

impl StepReport {
    /// Of a displacement that was found, before the points have taken it; one reduction for the supports' forces, and
    /// one with a background.
    pub fn of<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, found: &StepSolution<K, D>) -> Self {
        let nodes = problem.nodes;
        let resisted = nodes.resisted(&found.u);
        let soft = nodes
            .background
            .as_ref()
            .map(|blocks| blocks.work::<D>(problem.shape, &resisted));
        Self {
            dt: 0.0,
            iterations: found.history.len(),
            history: found.history.clone(),
            judged: found.judged,
            force: found.force,
            newton_iterations: found.newton_iterations,
            active_nodes: nodes.active_nodes,
            unknowns: nodes.unknowns,
            massless_nodes: nodes.massless_nodes,
            background_cells: nodes.background_cells,
            tied_functions: nodes.extension.as_ref().map_or(0, |extension| extension.tied),
            untied_functions: nodes.extension.as_ref().map_or(0, |extension| extension.untied),
            settled: found.settled,
            first_guess: found.first_guess,
            reactions: problem
                .model
                .boundary
                .reactions(&problem.model.grid, &found.reaction, problem.halo),
            contacts: nodes
                .contacts
                .report(&problem.model.boundary, &found.u, &found.reaction, problem.halo),
            rigid: Vec::new(),
            strips: Vec::new(),
            background: soft.map(|work| [problem.halo.reproducible_sum(&[work])[0], found.work]),
            background_share: None,
            second_order_works: None,
            energy: None,
            turnover: None,
            advance: 0.0,
            beside_fixed: None,
            outflow: None,
            water: WaterReport::of(problem, found),
            smoothed: 0.0,
        }
    }
}

/// The largest force of the background on a free node of all ranks over the RMS force of the active nodes; `None`
/// without a background or without forces. A function that has no other stiffness creeps by it.
///
/// One exchange with the neighbours, one reduction, and one gathering where ties are published.
pub fn background_share<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    found: &StepSolution<K, D>,
) -> Option<f64> {
    let Problem {
        model,
        shape,
        nodes,
        halo,
        ..
    } = *problem;
    let blocks = nodes.background.as_ref()?;
    let mut force = Contributions::none(&model.grid, D, Vec::new());
    blocks.multiply::<D>(shape, &nodes.resisted(&found.u), &mut force);
    let mut force = halo.assemble_ghosts(&force);
    nodes.reduce(&mut [&mut force], halo);
    let sizes = halo.owned().nodes().map(|node| {
        let free = Nodal::<D>::of(node).filter(|&at| nodes.free[at]);
        free.map(|at| force[at].powi(2)).sum::<f64>().sqrt()
    });
    let mut largest = [sizes.fold(0.0, f64::max)];
    halo.all_reduce_max(&mut largest);
    let mean = found.scale / (nodes.active_nodes.max(1) as f64).sqrt();
    (mean > 0.0).then(|| largest[0] / mean)
}
