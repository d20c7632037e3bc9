//! Report of an accepted step.

use crate::boundary::{ContactReport, RigidReport, StripReport};
use crate::energy::{Flows, Turnover};
use crate::error::Measures;
use crate::field::pore_water::saved::WaterReport;
use crate::grid::Contributions;
use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
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
    /// Cells with the artificial stiffness, over all ranks.
    pub background_cells: usize,
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
    /// Two works (J), only with an artificial stiffness. First (u - w) . B (u - w) on this stiffness, which does not
    /// resist the displacement w. Then the larger of two sums of magnitudes: the works f_int u of all nodes
    /// and components (background included), and the works of the points' stresses.
    pub background: Option<[f64; 2]>,
    /// Largest force of the background on a node divided by the RMS force of the nodes (-). Only with a background, and
    /// in steps without prescribed motion.
    pub background_share: Option<f64>,
    /// Second-order works of the step (J): for elastic soil with the same strain, and the actual one. Only in
    /// quasi-static analysis with yielding materials and without flowing water.
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
    /// Report of the flowing water, if any.
    pub water: Option<WaterReport>,
    /// Smoothing of the elastic state as a fraction of one pass of S, mean over the points (-).
    pub smoothed: f64,
}

impl StepReport {
    /// Creates the report of a converged displacement, before the points are updated. One reduction for the forces of
    /// the supports, and one with a background.
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

/// Returns the largest force of the background on a free node of all ranks, divided by the RMS force of the active
/// nodes (-). A spline without other stiffness creeps under this force. `None` without a background or without forces.
///
/// One exchange with the neighbours, one reduction, and one gather if ties are published.
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
