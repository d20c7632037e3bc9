//! Errors of the numerical method. Each names the material point, node or number that caused it.

use crate::material::MaterialError;
use crate::method::Criteria;
use crate::method::Method;
use thiserror::Error;

/// A grid that cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum GridError {
    /// The order is not linear, quadratic or cubic.
    #[error("B-splines of order {0} are not supported (1, 2 or 3)")]
    Order(usize),
    /// Breakpoints are not finite and increasing, also when counted from the first, or there is no cell.
    #[error("the breakpoints of an axis must be finite, increasing and at least two")]
    Breakpoints,
    /// The axes have different orders.
    #[error("all axes must have the same order")]
    MixedOrders,
}

/// A linear solution that cannot be trusted.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SolveError {
    /// The library reported a failure.
    #[error("{0}")]
    Failed(String),
    /// The solution holds a number that is not finite.
    #[error("the solution is not finite")]
    NotFinite,
    /// The recomputed residual is too large.
    #[error("the relative residual of the solution is {0:.1e}")]
    Residual(f64),
}

/// How far an iteration was from equilibrium (step 9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// |du . f| / |du_0 . f_0|
    pub energy: f64,
    /// |f_oob| / largest force, of all nodes or of one material's own: the larger one
    pub force: f64,
    /// water out of balance over what is stored, flows or leaves, where water flows
    pub water: Option<f64>,
    /// what gave du
    pub method: Method,
}

/// A node whose forces are badly balanced.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstNode {
    /// Number over the whole grid, axis 0 slowest.
    pub number: u64,
    /// Its place from the grid's lower corner, m: the mean of the function's inner knots (Greville).
    pub x: Vec<f64>,
    /// |f_oob| there, N.
    pub force: f64,
}

/// Why a step was not accepted. All ranks return an error together; what only one of them knows is in the fields.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepError {
    /// A point is outside the grid, or was not sorted into this rank's window.
    #[error("E0740: material point {id} lies outside the grid, at {x:?} m from the lower corner of the grid.")]
    Outside {
        /// Global id of the point.
        id: u64,
        /// Position from the grid's lower corner, m.
        x: Vec<f64>,
    },
    /// A point would leave the grid in this step.
    #[error("E0741: {count} material point(s) would leave the grid in this step.")]
    Left {
        /// Number of points over all ranks.
        count: u64,
        /// Id and position (m) of the first one on this rank, if any.
        first: Option<(u64, Vec<f64>)>,
    },
    /// All material would have left the grid through its outlets.
    #[error(
        "E0742: the last {count} material point(s) leave the grid through outflow boundaries in this step, so no \
         material is left."
    )]
    Emptied {
        /// Number of points over all ranks.
        count: u64,
    },
    /// A load has no material at some of its points any more.
    #[error(
        "E0743: load number {load} (counted from 0, first tractions, then point loads) cannot act, because {points} \
         of its points lie outside the soil."
    )]
    Unloaded {
        /// Number of the load, tractions first.
        load: usize,
        /// Points without material.
        points: usize,
    },
    /// Material was pressed together by more than its pores.
    #[error(
        "E0744: {count} material point(s) are compressed by more than the volume of their pores in iteration \
        {iteration}."
    )]
    Closed {
        /// Number of points over all ranks.
        count: u64,
        /// Iteration.
        iteration: usize,
    },
    /// A drain or inflow is on material through which no water flows.
    #[error(
        "E0745: {points} point(s) of drain number {drain} (counted from 0, first drains, then inflows) lie on \
         impermeable soil, so no water flows. Move the drain, or set `permeability` of the soil."
    )]
    Undrained {
        /// Number of the drain; the inflows behind the drains.
        drain: usize,
        /// Points on such material.
        points: usize,
    },
    /// Material turned inside out or became non-finite, also with shortened iterations.
    #[error(
        "E0746: {count} material point(s) reach a negative volume, or values that are not finite, in iteration \
        {iteration}."
    )]
    Inverted {
        /// Number of points over all ranks.
        count: u64,
        /// Iteration.
        iteration: usize,
        /// Id and position (m) of the first one on this rank, if any.
        first: Option<(u64, Vec<f64>)>,
    },
    /// The iteration limit was reached, or no direction led on.
    #[error(
        "E0747: no convergence after {iterations} iterations{}. Final residuals: {}{}{}.",
        if *iterations < criteria.max_iterations { "" } else { " (the limit)" },
        criteria.judged(*energy, *force, *material),
        history.last().and_then(|last| last.water).map_or_else(String::new, |water| criteria.judged_water(water)),
        unsolved.as_ref().map_or_else(String::new, |reason| format!("; the linear solver failed: {reason}"))
    )]
    NotConverged {
        /// Iterations made.
        iterations: usize,
        /// |du . f| / |du_0 . f_0|.
        energy: f64,
        /// |f_oob| / largest force, of all nodes or of one material's own: the larger one.
        force: f64,
        /// Number of that material; `None` where it is that of all nodes.
        material: Option<usize>,
        /// What was asked for.
        criteria: Box<Criteria>,
        /// Both measures of every iteration.
        history: Vec<Measures>,
        /// The worst nodes of this rank, worst first.
        worst: Vec<WorstNode>,
        /// Why there is no direction from the last state, if that ended it.
        unsolved: Option<SolveError>,
    },
    /// The iteration came near a static equilibrium of elastic material along a direction of negative second-order
    /// work: it is not stable, and round-off decides where an iteration goes from there.
    #[error(
        "E0748: the equilibrium is unstable, because the second-order work is negative ({work:.2e} J in iteration \
        {iteration})."
    )]
    Unstable {
        /// Iteration.
        iteration: usize,
        /// du . (f_old - f_new) along its direction, N m.
        work: f64,
    },
    /// No statuses of the nodes on faces with contact were found that the displacement under them agrees with.
    #[error("E0749: the contact states of the nodes (open, stick, slip) still change after {passes} corrections.")]
    Unsettled {
        /// Corrections made.
        passes: usize,
    },
    /// Rounds towards equilibrium at the start came to no end.
    #[error(
        "E0750: no initial equilibrium was found in {rounds} rounds of iteration. The unbalanced force is still \
         {force:.1e} of the largest force."
    )]
    Unbalanced {
        /// Rounds made.
        rounds: usize,
        /// |f_oob| / largest force.
        force: f64,
        /// The worst nodes of this rank, worst first.
        worst: Vec<WorstNode>,
    },
    /// Nothing holds a rigid body that moves freely, and it has no inertia: no equilibrium of it is known.
    #[error(
        "E0751: nothing supports rigid body number {body} (counted from 0) in a direction in which the body is \
        free to move."
    )]
    Loose {
        /// Number of the body.
        body: usize,
    },
    /// Rigid bodies would overlap: they do not touch each other.
    #[error("E0752: rigid bodies number {} and {} (counted from 0) would overlap in this step.", bodies[0], bodies[1])]
    Overlapping {
        /// Numbers of the bodies.
        bodies: [usize; 2],
    },
    /// The steps so far have made energy: the run is wrong, though each of them is in equilibrium.
    #[error(
        "E0753: energy was created: kinetic, elastic and dissipated energy exceed the initial energy plus external \
         work ({given:.3e} J) by {:.1} % of the peak energy (limit: {:.0} %).", 100.0 * growth, 100.0 * slack
    )]
    EnergyMade {
        /// Largest excess over the largest energy.
        growth: f64,
        /// Energy at the start and work of gravity, loads and what moves since, J.
        given: f64,
        /// Bound of `growth`.
        slack: f64,
    },
    /// The step was given up on request, see [`Halo::is_interrupted`](crate::parallel::Halo::is_interrupted).
    #[error("E0754: the step was interrupted by Ctrl-C, or by another signal to stop (TERM, USR1).")]
    Interrupted,
    /// Another rank has the error; this rank's part was good.
    #[error(
        "E0755: the step failed on another rank (MPI process) of this run. The message of that rank names the \
         cause."
    )]
    OtherRank,
    /// The linear system could not be solved.
    #[error("E0756: the system of linear equations was not solved: {0}.")]
    Solve(#[from] SolveError),
    /// The constitution refused a trial state when the step was committed.
    #[error("E0757: the stress of material point {id} cannot be computed: {source}.")]
    Material {
        /// Global id of the point.
        id: u64,
        /// The constitution's reason.
        source: MaterialError,
    },
}

impl StepError {
    /// Whether no other guess of the displacement can mend a step of this length: an unstable equilibrium is one
    /// whatever leads there.
    pub fn is_final(&self) -> bool {
        matches!(self, Self::Interrupted | Self::Unstable { .. })
    }

    /// Id and position (m, from the grid's lower corner) of a point of this rank that the error is about.
    pub fn point(&self) -> Option<(u64, &[f64])> {
        match self {
            Self::Outside { id, x } => Some((*id, x)),
            Self::Left { first, .. } | Self::Inverted { first, .. } => first.as_ref().map(|(id, x)| (*id, &x[..])),
            _ => None,
        }
    }
}
