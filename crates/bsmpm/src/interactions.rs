//! Interactions: whatever acts on the nodes besides the stress of the material points.
//!
//! A boundary condition, a load or a numerical aid is one file (or folder) here. It has a *definition*, which is part
//! of the [model](crate::model), and a *state*, which lasts from step to step. Its function `begin` makes from both an
//! [`Interaction`], which lives for one step: the step asks it for forces and tangent, corrects its statuses, and on
//! acceptance lets it write its new state and its results. A step that fails drops it, and nothing has changed.
//!
//! The numbers are those of the algorithm in section 2.4 of Xie et al. (2023):
//!
//! - (2) start: `begin`, [`Interaction::note_unknowns`], [`Interaction::apply_statuses`]
//! - (2d) external force: [`Interaction::constant_force`]
//! - (5) out-of-balance force: [`Interaction::external_force`], [`Interaction::add_force`],
//!   [`Interaction::add_internal_force`], [`Interaction::add_reaction`]
//! - (6) tangent, as a product: [`Interaction::add_product`], [`Interaction::add_nodal_product`]; as a matrix:
//!   [`Interaction::assemble`], [`Interaction::add_to_cell`], [`Interaction::add_damping`]
//! - (9) active set: [`Interaction::predict`], [`Interaction::correct`], [`Interaction::hold_neutral`]
//! - (11) acceptance: [`Interaction::add_work`], [`Interaction::finish`], [`Interaction::update`]; after the
//!   equilibrium at the start of the run: [`Interaction::finish_start`]
//!
//! # A new interaction
//!
//! Write a file with a type that implements [`Interaction`], and its function `begin`; add one line to
//! [`Interactions::begin`]. All methods have defaults. A state of its own also needs a field of [`InteractionState`],
//! and a result of its own a field of [`InteractionReports`] and of [`StepReport`](crate::step::StepReport). The manual
//! shows an example (`how-to/add-a-boundary.md`).

pub mod absorbing;
pub mod artificial_stiffness;
pub mod contact;
pub mod coulomb;
pub mod free_field;
pub mod load;
pub mod rigid;
pub mod state;
pub mod strip;

use crate::boundary::Boundary;
use crate::dynamics::inertia::Inertia;
use crate::error::StepError;
use crate::exact::Exact;
use crate::field::pore_water::pore_pressure::PorePressure;
use crate::grid::{Contributions, Grid, Shape};
use crate::interactions::absorbing::ColumnAction;
use crate::interactions::artificial_stiffness::{ArtificialStiffnessReport, ResistedDisplacement};
use crate::interactions::coulomb::ContactReport;
use crate::interactions::load::LoadWork;
use crate::interactions::rigid::RigidReport;
use crate::interactions::state::InteractionState;
use crate::interactions::strip::StripReport;
use crate::kinematics::Kinematics;
use crate::linear::MatrixAssembly;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::step::constraints::Constraints;
use crate::tensor::Tensor;
use std::borrow::Cow;
use std::fmt;

/// Corrections of statuses after which a step is given up.
pub const MOST_CORRECTIONS: usize = 40;
/// The same for rigid bodies, whose statuses are finally corrected one by one.
pub const MOST_CORRECTIONS_OF_BODIES: usize = 60;

/// What precedes a step, and its time.
#[derive(Clone, Copy, Debug)]
pub struct StepInput<'a, const D: usize> {
    /// State of the interactions at the start of the step.
    pub state: &'a InteractionState<D>,
    /// Start and length of the step.
    pub interval: TimeInterval,
    /// Nodal displacement of the last step (m, up to a factor); may be empty.
    pub last: &'a [f64],
    /// Part of the displacement that the artificial stiffness resists.
    pub resisted: ResistedDisplacement,
    /// Action of the free-field columns, which are advanced before the step.
    pub columns: &'a [ColumnAction<D>],
}

impl<'a, const D: usize> StepInput<'a, D> {
    /// Creates the input of a step without a predecessor.
    pub fn over(interval: TimeInterval, state: &'a InteractionState<D>) -> Self {
        Self {
            state,
            interval,
            last: &[],
            resisted: ResistedDisplacement::Whole,
            columns: &[],
        }
    }
}

/// Data from which interactions begin a step.
pub struct StepStart<'a, K, const D: usize> {
    /// Definitions of all interactions, materials, grid.
    pub model: &'a Model<K, D>,
    /// Shape functions at the material points.
    pub shape: &'a Shape<D>,
    /// Material points.
    pub points: &'a Points<D>,
    /// Weights of the points in the integrals of the stress (m^D).
    pub volume: &'a [f64],
    /// Unknowns before splines are tied: components that no support prescribes.
    pub constraints: &'a Constraints<D>,
    /// Pore pressure that friction does not act on; `None` without pore pressure or without friction.
    pub pore_pressure: Option<&'a PorePressure<D>>,
    /// State of the interactions at the start of the step, and what precedes it.
    pub input: StepInput<'a, D>,
    /// Communication with the other ranks.
    pub halo: &'a dyn Halo,
}

/// Data of a step that interactions use during its iterations.
#[derive(Clone, Copy)]
pub struct StepContext<'a, const D: usize> {
    /// Definitions of the boundary conditions.
    pub boundary: &'a Boundary<D>,
    /// Grid, restricted to the window of this rank.
    pub grid: &'a Grid<D>,
    /// Shape functions at the material points.
    pub shape: &'a Shape<D>,
    /// Material points at the start of the step.
    pub points: &'a Points<D>,
    /// Unknowns.
    pub constraints: &'a Constraints<D>,
    /// Inertia; `None` in quasi-static analysis.
    pub inertia: Option<&'a Inertia>,
    /// Communication with the other ranks.
    pub halo: &'a dyn Halo,
}

/// Nodal forces that depend on nodal displacements only, at the components of the window (N).
pub struct NodalForces<'a> {
    /// Out-of-balance force.
    pub f_oob: &'a mut [f64],
    /// Force of the supports on the body.
    pub reaction: &'a mut [f64],
}

/// Equilibrium at which statuses are checked, or that the step accepts.
#[derive(Clone, Copy)]
pub struct EquilibriumState<'a> {
    /// Nodal displacement (m).
    pub u: &'a [f64],
    /// Nodal force of the supports on the body (N).
    pub reaction: &'a [f64],
    /// Deformation increment of a material point (-).
    pub dF: &'a dyn Fn(usize) -> Tensor,
    /// Reference force of the force measure, a norm over all nodes (N).
    pub scale: f64,
    /// Sum of the magnitudes of the works of all internal forces (J), if an interaction needs it.
    pub internal_work: f64,
}

/// Tolerance and progress of a correction of statuses.
#[derive(Clone, Copy, Debug)]
pub struct Correction {
    /// Force by which a status may be contradicted (N).
    pub force: f64,
    /// Corrections before this one.
    pub pass: usize,
}

/// Free motions of rigid bodies that an interaction adds to the unknowns.
pub struct MotionCoupling {
    /// Coupling of each motion with the nodes (N/m or N), one nodal array per motion.
    pub columns: Vec<Vec<f64>>,
    /// Stiffness against the motions, row-major.
    pub stiffness: Vec<f64>,
}

/// Works of interactions in a step on this rank (J).
#[derive(Clone, Debug, Default)]
pub struct InteractionWork {
    /// External work by the mean of the forces at both ends of the step.
    pub external: Exact,
    /// Loss by integration in time.
    pub integration: Exact,
    /// Loss in penalties.
    pub penalty: Exact,
    /// Loss to the artificial stiffness.
    pub artificial_stiffness: Exact,
    /// Half the work of friction and dashpots at faces, which the energy bound leaves out.
    pub friction: Exact,
}

/// Results of all interactions for an accepted step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InteractionReports {
    /// Results of the faces with contact.
    pub contacts: Vec<ContactReport>,
    /// Results of the rigid bodies.
    pub rigid: Vec<RigidReport>,
    /// Results of the rigid strips.
    pub strips: Vec<StripReport>,
    /// Results of the artificial stiffness, if there is one.
    pub artificial_stiffness: Option<ArtificialStiffnessReport>,
    /// Work of the loads, equal on all ranks.
    pub load_work: LoadWork,
}

/// Something that acts on the nodes in one step besides the stress of the material points.
///
/// Ranks that share a node compute the same nodal values. Contributions of surface points are those of this rank only,
/// and are summed over the ranks. Methods that communicate are called on all ranks together.
pub trait Interaction<const D: usize>: fmt::Debug + Send + Sync {
    /// (2) Marks the local nodes whose splines must remain unknowns. Communicates if all ranks have the interaction.
    fn mark_untied(&self, _context: &StepContext<'_, D>, _interval: TimeInterval, _marks: &mut [bool]) {}

    /// (2) Notes the unknowns after splines are tied. `last` is the displacement of the last step (m).
    fn note_unknowns(&mut self, _context: &StepContext<'_, D>, _last: &[f64]) {}

    /// (2) Frees or prescribes components according to the present statuses.
    fn apply_statuses(&self, _free: &mut [bool], _prescribed: &mut [Option<f64>]) {}

    /// (2b) Holds components at rest that remain at rest: sets their velocity to zero (m/s).
    fn hold_at_rest(&self, _velocities: &mut [Option<f64>]) {}

    /// (2b) Marks components that may stop in a step of `dt` (s) with these initial nodal velocities (m/s). They are
    /// integrated by backward Euler. `moving` is empty before anything is marked.
    fn mark_moving(&self, _velocities: &[f64], _dt: f64, _moving: &mut Vec<bool>) {}

    /// (2b) Marks those of the moving components that stop although they are unknowns.
    fn mark_stopped(&self, _stopped: &mut [bool]) {}

    /// (2d) Returns the part of the external force that does not depend on the displacement (N); empty if there is
    /// none.
    fn constant_force(&self) -> &[f64] {
        &[]
    }

    /// (5) Returns the external force that depends on the displacement `u` (m), which deforms the material points by
    /// `dF` (N, summed over the ranks); `None` if there is none.
    fn external_force(
        &self,
        _context: &StepContext<'_, D>,
        _u: &[f64],
        _dF: &dyn Fn(usize) -> Tensor,
    ) -> Option<Vec<f64>> {
        None
    }

    /// Returns whether [`Self::add_force`] adds anything on any rank.
    fn has_penalty(&self) -> bool {
        false
    }

    /// (5) Adds the forces of elastic supports under the displacement `u` (m) to the nodes (N).
    fn add_force(&self, _context: &StepContext<'_, D>, _u: &[f64], _out: &mut Contributions) {}

    /// Returns whether the results need [`EquilibriumState::internal_work`].
    fn needs_internal_work(&self) -> bool {
        false
    }

    /// (5) Adds forces that count as internal ones, with opposite sign (N).
    fn add_internal_force(&self, _context: &StepContext<'_, D>, _u: &[f64], _out: &mut Contributions) {}

    /// (5) Adds forces at nodes under the displacement `u` (m). All other forces are balanced already.
    fn add_reaction(&self, _context: &StepContext<'_, D>, _u: &[f64], _forces: NodalForces<'_>) {}

    /// (6) Adds the product of the stiffness with `v` (m).
    fn add_product(&self, _context: &StepContext<'_, D>, _v: &[f64], _out: &mut Contributions) {}

    /// (6) Adds the product of the derivative of [`Self::add_reaction`] with `v` (m), where the nodes had the
    /// `reaction` (N). `out` contains the product of all other parts.
    fn add_nodal_product(&self, _context: &StepContext<'_, D>, _reaction: &[f64], _v: &[f64], _out: &mut [f64]) {}

    /// (6) Adds the stiffness in an occupied cell, the `number`-th, to its block of the matrix (N/m).
    fn add_to_cell(&self, _number: usize, _block: &mut [f64]) {}

    /// (6) Adds the stiffness to the matrix. It is symmetric and may be approximate.
    fn assemble(&self, _context: &StepContext<'_, D>, _matrix: &mut dyn MatrixAssembly) {}

    /// (6) Adds the derivative of forces that depend on the velocity to the diagonal of the matrix (N/m).
    fn add_damping(&self, _inertia: &Inertia, _diagonal: &mut [f64]) {}

    /// (6) Returns the coupling with motions that are unknowns besides the displacements of nodes, if there are any.
    fn coupling(&self, _context: &StepContext<'_, D>) -> Option<MotionCoupling> {
        None
    }

    /// Returns du . K du of the penalty stiffness on this rank (N m).
    fn penalty_energy(&self, _du: &[f64], _halo: &dyn Halo) -> Exact {
        Exact::ZERO
    }

    /// Returns whether friction makes the tangent unsymmetric.
    fn has_friction(&self) -> bool {
        false
    }

    /// (9) Returns the number of corrections of statuses after which the step is given up; `None` without statuses.
    fn most_corrections(&self) -> Option<usize> {
        None
    }

    /// (9) Predicts the statuses from `guess`, the displacement of the last step (m).
    fn predict(&mut self, _guess: &[f64]) {}

    /// (9) Corrects the statuses that an equilibrium contradicts, and returns their number over all ranks.
    fn correct(
        &mut self,
        _context: &StepContext<'_, D>,
        _at: &EquilibriumState<'_>,
        _correction: Correction,
    ) -> Result<usize, StepError> {
        Ok(0)
    }

    /// (9) Makes parts stick that hinder a body from moving freely, after no equilibrium was found from `u` (m).
    /// Returns their number over all ranks.
    fn hold_neutral(&mut self, _context: &StepContext<'_, D>, _u: &[f64]) -> usize {
        0
    }

    /// (11) Adds the works in the accepted step.
    fn add_work(&self, _context: &StepContext<'_, D>, _at: &EquilibriumState<'_>, _work: &mut InteractionWork) {}

    /// Writes the forces that an equilibrium at the start of the run has given the interaction, with which the first
    /// step begins, and the results. Nothing has moved, so that all other state stays.
    fn finish_start(
        &self,
        _context: &StepContext<'_, D>,
        _at: &EquilibriumState<'_>,
        _after: &mut InteractionState<D>,
        _reports: &mut InteractionReports,
    ) {
    }

    /// (11) Writes the state at the end of the step, before the material points are updated, and the results. `after`
    /// begins as the state at the start. Fails on all ranks if the step cannot be accepted.
    fn finish(
        &self,
        _context: &StepContext<'_, D>,
        _at: &EquilibriumState<'_>,
        _after: &mut InteractionState<D>,
        _reports: &mut InteractionReports,
    ) -> Result<(), StepError> {
        Ok(())
    }

    /// (11) Completes the state with the updated material points, which moved by `u` (m, nodal).
    fn update(
        &mut self,
        _grid: &Grid<D>,
        _u: &[f64],
        _points: &mut Points<D>,
        _after: &mut InteractionState<D>,
        _halo: &dyn Halo,
    ) {
    }
}

/// All interactions of a step.
#[derive(Debug, Default)]
pub struct Interactions<const D: usize> {
    list: Vec<Box<dyn Interaction<D>>>,
    /// Whether the step has no length. Nothing moves, and forces that follow the surface are constant.
    is_instant: bool,
}

impl<const D: usize> Interactions<D> {
    /// Begins the interactions of a step. Fails on all ranks if a load has lost its material, or if nothing supports a
    /// rigid body.
    pub fn begin<K: Kinematics<D>>(start: &StepStart<'_, K, D>) -> Result<Self, StepError> {
        // The order of sums of forces. A new kind of interaction needs one line here.
        let kinds = [
            artificial_stiffness::begin(start),
            strip::begin(start),
            rigid::begin(start)?,
            absorbing::begin(start),
            contact::begin(start),
            load::begin(start)?,
        ];
        Ok(Self {
            list: kinds.into_iter().flatten().collect(),
            is_instant: start.input.interval.dt == 0.0,
        })
    }

    /// Iterates over the interactions in the order of sums.
    pub fn iter(&self) -> impl Iterator<Item = &dyn Interaction<D>> {
        self.list.iter().map(|interaction| &**interaction)
    }

    /// Iterates over the interactions in the order of sums.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Box<dyn Interaction<D>>> {
        self.list.iter_mut()
    }

    /// Adds the external forces that depend on the displacement `u` (m) to `f_ext` (N), unless the step has no length:
    /// then they are part of the constant force.
    pub fn add_external_forces(
        &self,
        context: &StepContext<'_, D>,
        u: &[f64],
        dF: &dyn Fn(usize) -> Tensor,
        f_ext: &mut Cow<'_, [f64]>,
    ) {
        if !self.is_instant {
            self.add_following_forces(context, u, dF, f_ext);
        }
    }

    /// Adds the forces that follow the surface to the constant force, if the step has no length.
    pub fn add_forces_at_rest(&self, context: &StepContext<'_, D>, f_ext: &mut Cow<'_, [f64]>) {
        if self.is_instant {
            let u = vec![0.0; f_ext.len()];
            self.add_following_forces(context, &u, &|_| Tensor::identity(), f_ext);
        }
    }

    fn add_following_forces(
        &self,
        context: &StepContext<'_, D>,
        u: &[f64],
        dF: &dyn Fn(usize) -> Tensor,
        f_ext: &mut Cow<'_, [f64]>,
    ) {
        for mut force in self
            .iter()
            .filter_map(|interaction| interaction.external_force(context, u, dF))
        {
            context.constraints.reduce(&mut [&mut force], context.halo);
            f_ext
                .to_mut()
                .iter_mut()
                .zip(force)
                .for_each(|(all, force)| *all += force);
        }
    }

    /// Returns the force of elastic supports under the displacement `u` (N), D numbers per node; empty without any.
    /// Otherwise one exchange with the neighbours.
    pub fn penalty_force(&self, context: &StepContext<'_, D>, u: &[f64]) -> Vec<f64> {
        if !self.has_penalty() {
            return Vec::new();
        }
        let mut force = Contributions::none(context.grid, D, Vec::new());
        self.iter()
            .for_each(|interaction| interaction.add_force(context, u, &mut force));
        context.halo.assemble_ghosts(&force)
    }

    /// Returns whether any interaction has a penalty stiffness.
    pub fn has_penalty(&self) -> bool {
        self.iter().any(Interaction::has_penalty)
    }

    /// Returns the number of corrections of statuses after which the step is given up; `None` without statuses.
    pub fn most_corrections(&self) -> Option<usize> {
        self.iter().filter_map(Interaction::most_corrections).max()
    }
}
