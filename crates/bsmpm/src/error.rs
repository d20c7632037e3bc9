//! Errors of the numerical method. Each names the material point, node or number that caused it.

use crate::material::MaterialError;
use crate::method::Criteria;
use crate::method::Method;
use thiserror::Error;

/// Reason why a grid cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum GridError {
    /// The degree is not 1, 2 or 3.
    #[error("B-splines of order {0} are not supported (1, 2 or 3)")]
    Order(usize),
    /// The breakpoints are not finite or not increasing, also after subtraction of the first one, or there is no cell.
    #[error("the breakpoints of an axis must be finite, increasing and at least two")]
    Breakpoints,
    /// The axes have different degrees.
    #[error("all axes must have the same order")]
    MixedOrders,
}

/// Reason why a linear solution cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SolveError {
    /// The library reported a failure.
    #[error("{0}")]
    Failed(String),
    /// The solution contains a number that is not finite.
    #[error("the solution is not finite")]
    NotFinite,
    /// The recomputed residual is too large.
    #[error("the relative residual of the solution is {0:.1e}")]
    Residual(f64),
}

/// Residuals of an iteration (step 9 of the paper).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Energy residual |du . f| / |du_0 . f_0|.
    pub energy: f64,
    /// Force residual |f_oob| / largest force, the larger one of all nodes and of the nodes of one material.
    pub force: f64,
    /// Water residual, with coupled flow.
    pub water: Option<f64>,
    /// Method that gave the direction.
    pub method: Method,
}

/// Node with a large out-of-balance force.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstNode {
    /// Number in the whole grid, axis 0 slowest.
    pub number: u64,
    /// Position from the lower corner of the grid: the Greville abscissae of the function (m).
    pub x: Vec<f64>,
    /// Out-of-balance force |f_oob| of the node (N).
    pub force: f64,
}

/// Reason why a step was not accepted. All ranks return an error together; an error known to one rank is
/// [`StepError::OtherRank`] elsewhere.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepError {
    /// A point lies outside the grid, or outside the window of this rank.
    #[error("E0740: material point {id} lies outside the grid, at {x:?} m from the lower corner of the grid.")]
    Outside {
        /// Global id of the point.
        id: u64,
        /// Position from the lower corner of the grid (m).
        x: Vec<f64>,
    },
    /// A point would leave the grid in this step.
    #[error("E0741: {count} material point(s) would leave the grid in this step.")]
    Left {
        /// Number of points over all ranks.
        count: u64,
        /// Id and position (m) of the first point on this rank, if any.
        first: Option<(u64, Vec<f64>)>,
    },
    /// All material would leave the grid through outflow boundaries.
    #[error(
        "E0742: the last {count} material point(s) leave the grid through outflow boundaries in this step, so no \
         material is left."
    )]
    Emptied {
        /// Number of points over all ranks.
        count: u64,
    },
    /// A load has surface points without material.
    #[error(
        "E0743: load number {load} (counted from 0, first tractions, then point loads) cannot act, because {points} \
         of its points lie outside the soil."
    )]
    Unloaded {
        /// Number of the load, tractions first.
        load: usize,
        /// Number of surface points without material.
        points: usize,
    },
    /// Material was compressed by more than its pore volume.
    #[error(
        "E0744: {count} material point(s) are compressed by more than the volume of their pores in iteration \
        {iteration}."
    )]
    Closed {
        /// Number of points over all ranks.
        count: u64,
        /// Iteration in which this happened.
        iteration: usize,
    },
    /// A drain or inflow lies on impermeable material.
    #[error(
        "E0745: {points} point(s) of drain number {drain} (counted from 0, first drains, then inflows) lie on \
         impermeable soil, so no water flows. Move the drain, or set `permeability` of the soil."
    )]
    Undrained {
        /// Number of the drain; inflows follow the drains.
        drain: usize,
        /// Number of surface points on impermeable material.
        points: usize,
    },
    /// Material reached a negative volume or non-finite values, also with shortened corrections.
    #[error(
        "E0746: {count} material point(s) reach a negative volume, or values that are not finite, in iteration \
        {iteration}."
    )]
    Inverted {
        /// Number of points over all ranks.
        count: u64,
        /// Iteration in which this happened.
        iteration: usize,
        /// Id and position (m) of the first point on this rank, if any.
        first: Option<(u64, Vec<f64>)>,
    },
    /// The limit of iterations was reached, or no search direction reduced the residual.
    #[error(
        "E0747: no convergence after {iterations} iterations{}. Final residuals: {}{}{}.",
        if *iterations < criteria.max_iterations { "" } else { " (the limit)" },
        criteria.judged(*energy, *force, *material),
        history.last().and_then(|last| last.water).map_or_else(String::new, |water| criteria.judged_water(water)),
        unsolved.as_ref().map_or_else(String::new, |reason| format!("; the linear solver failed: {reason}"))
    )]
    NotConverged {
        /// Number of iterations.
        iterations: usize,
        /// Energy residual |du . f| / |du_0 . f_0|.
        energy: f64,
        /// Force residual |f_oob| / largest force, the larger one of all nodes and of the nodes of one material.
        force: f64,
        /// Number of that material; `None` if the residual is that of all nodes.
        material: Option<usize>,
        /// Convergence criteria.
        criteria: Box<Criteria>,
        /// Residuals of every iteration.
        history: Vec<Measures>,
        /// Nodes of this rank with the largest out-of-balance forces, in descending order.
        worst: Vec<WorstNode>,
        /// Failure of the linear solver, if it ended the iteration.
        unsolved: Option<SolveError>,
    },
    /// The iteration approached a static equilibrium of elastic material along a direction of negative second-order
    /// work. That equilibrium is unstable, and round-off would determine the further path.
    #[error(
        "E0748: the equilibrium is unstable, because the second-order work is negative ({work:.2e} J in iteration \
        {iteration})."
    )]
    Unstable {
        /// Iteration in which this happened.
        iteration: usize,
        /// Second-order work du . (f_old - f_new) along the direction (N m).
        work: f64,
    },
    /// The contact states of nodes on contact faces did not agree with the resulting displacement.
    #[error("E0749: the contact states of the nodes (open, stick, slip) still change after {passes} corrections.")]
    Unsettled {
        /// Number of corrections.
        passes: usize,
    },
    /// The iteration for the initial equilibrium did not converge.
    #[error(
        "E0750: no initial equilibrium was found in {rounds} rounds of iteration. The unbalanced force is still \
         {force:.1e} of the largest force."
    )]
    Unbalanced {
        /// Number of rounds.
        rounds: usize,
        /// Force residual |f_oob| / largest force.
        force: f64,
        /// Nodes of this rank with the largest out-of-balance forces, in descending order.
        worst: Vec<WorstNode>,
    },
    /// A rigid body without inertia is free to move and not supported, so its equilibrium is undetermined.
    #[error(
        "E0751: nothing supports rigid body number {body} (counted from 0) in a direction in which the body is \
        free to move."
    )]
    Loose {
        /// Number of the body.
        body: usize,
    },
    /// Rigid bodies would overlap; contact between rigid bodies is not modelled.
    #[error("E0752: rigid bodies number {} and {} (counted from 0) would overlap in this step.", bodies[0], bodies[1])]
    Overlapping {
        /// Numbers of the bodies.
        bodies: [usize; 2],
    },
    /// The energy balance shows created energy: the results are wrong, although every step is in equilibrium.
    #[error(
        "E0753: energy was created: kinetic, elastic and dissipated energy exceed the initial energy plus external \
         work ({given:.3e} J) by {:.1} % of the peak energy (limit: {:.0} %).", 100.0 * growth, 100.0 * slack
    )]
    EnergyMade {
        /// Largest excess divided by the peak energy.
        growth: f64,
        /// Initial energy plus work of gravity, loads and prescribed motion (J).
        given: f64,
        /// Bound of `growth`.
        slack: f64,
    },
    /// The step was interrupted on request, see [`Halo::is_interrupted`](crate::parallel::Halo::is_interrupted).
    #[error("E0754: the step was interrupted by Ctrl-C, or by another signal to stop (TERM, USR1).")]
    Interrupted,
    /// Another rank returned the error; this rank had none.
    #[error(
        "E0755: the step failed on another rank (MPI process) of this run. The message of that rank names the \
         cause."
    )]
    OtherRank,
    /// The linear system could not be solved.
    #[error("E0756: the system of linear equations was not solved: {0}.")]
    Solve(#[from] SolveError),
    /// The law has no response to a trial state when the points are updated.
    #[error("E0757: the stress of material point {id} cannot be computed: {source}.")]
    Material {
        /// Global id of the point.
        id: u64,
        /// Error of the law.
        source: MaterialError,
    },
}

/// What may avoid an error of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Another method or predictor at the same step size, then a shorter step.
    AnotherMethod,
    /// A shorter step only.
    ShorterStep,
    /// Nothing. The run ends.
    Final,
}

/// What a run that ends with an error reports as its cause; each kind has an exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// The case is wrong.
    Case,
    /// Material is where it must not be, or is missing where it is needed.
    LeftMaterial,
    /// A load lost its material; in the first step the case is wrong.
    LostLoad,
    /// No step size gives a valid state.
    NoConvergence,
}

/// Name of the advice that is printed with an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Advice {
    /// Compression by more than the pore volume.
    ClosedPores,
    /// Energy that was created.
    CreatedEnergy,
    /// All material left the grid.
    EmptyGrid,
    /// Drain on impermeable soil.
    ImpermeableDrain,
    /// Initial stress without equilibrium.
    InitialEquilibrium,
    /// Unstable equilibrium.
    Instability,
    /// Material turned inside out.
    InvertedMaterial,
    /// Iteration that did not converge.
    Iteration,
    /// Material outside the grid.
    LeavingMaterial,
    /// Linear system with an unusable solution.
    LinearSolver,
    /// Rigid body that nothing supports.
    LooseBody,
    /// Load without material.
    LostLoad,
    /// No advice.
    None,
    /// Rigid bodies that would overlap.
    OverlappingBodies,
    /// Shorter steps.
    ShorterSteps,
    /// Linear system that the library did not solve.
    SingularSystem,
    /// Contact states that keep changing.
    UnsettledContact,
}

/// What an error means for the step control and for the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ErrorMeaning {
    /// What may avoid the error.
    pub severity: Severity,
    /// Kind of failure if nothing avoided it.
    pub kind: FailureKind,
    /// Advice to the user.
    pub advice: Advice,
}

impl ErrorMeaning {
    const fn new(severity: Severity, kind: FailureKind, advice: Advice) -> Self {
        Self { severity, kind, advice }
    }
}

impl StepError {
    /// Returns severity, kind and advice of the error.
    pub fn meaning(&self) -> ErrorMeaning {
        use FailureKind::{Case, LeftMaterial, NoConvergence};
        use Severity::{AnotherMethod, Final, ShorterStep};
        match self {
            Self::Outside { .. } => ErrorMeaning::new(Final, LeftMaterial, Advice::LeavingMaterial),
            Self::Left { .. } => ErrorMeaning::new(ShorterStep, LeftMaterial, Advice::LeavingMaterial),
            Self::Emptied { .. } => ErrorMeaning::new(ShorterStep, LeftMaterial, Advice::EmptyGrid),
            Self::Unloaded { .. } => ErrorMeaning::new(Final, FailureKind::LostLoad, Advice::LostLoad),
            Self::Closed { .. } => ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::ClosedPores),
            Self::Undrained { .. } => ErrorMeaning::new(Final, Case, Advice::ImpermeableDrain),
            Self::Inverted { .. } => ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::InvertedMaterial),
            Self::NotConverged { .. } => ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::Iteration),
            // An unstable equilibrium does not depend on the path to it.
            Self::Unstable { .. } => ErrorMeaning::new(ShorterStep, NoConvergence, Advice::Instability),
            Self::Unsettled { .. } => ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::UnsettledContact),
            Self::Unbalanced { .. } => ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::InitialEquilibrium),
            Self::Loose { .. } => ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::LooseBody),
            Self::Overlapping { .. } => ErrorMeaning::new(ShorterStep, NoConvergence, Advice::OverlappingBodies),
            Self::EnergyMade { .. } => ErrorMeaning::new(ShorterStep, NoConvergence, Advice::CreatedEnergy),
            Self::Interrupted => ErrorMeaning::new(Final, NoConvergence, Advice::None),
            Self::OtherRank => ErrorMeaning::new(Final, NoConvergence, Advice::ShorterSteps),
            Self::Solve(SolveError::Failed(_)) => {
                ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::SingularSystem)
            }
            Self::Solve(_) => ErrorMeaning::new(AnotherMethod, NoConvergence, Advice::LinearSolver),
            // While a step iterates, a state without response counts as `Inverted`, which another method or a shorter
            // step may avoid. This error arises where points are updated or a free field is evaluated, with a state
            // that the iteration has accepted: then the law contradicts itself.
            Self::Material { .. } => ErrorMeaning::new(Final, NoConvergence, Advice::ShorterSteps),
        }
    }

    /// Returns whether another method or predictor may avoid the error at this step size.
    pub fn another_method_may_help(&self) -> bool {
        self.meaning().severity == Severity::AnotherMethod
    }

    /// Returns the nodes of this rank with the largest out-of-balance forces; `None` if the error is not about nodes.
    pub fn worst_nodes(&self) -> Option<&[WorstNode]> {
        match self {
            Self::NotConverged { worst, .. } | Self::Unbalanced { worst, .. } => Some(worst),
            _ => None,
        }
    }

    /// Returns id and position (m, from the lower corner of the grid) of the point of this rank that caused the error.
    pub fn point(&self) -> Option<(u64, &[f64])> {
        match self {
            Self::Outside { id, x } => Some((*id, x)),
            Self::Left { first, .. } | Self::Inverted { first, .. } => first.as_ref().map(|(id, x)| (*id, &x[..])),
            _ => None,
        }
    }
}
