//! Runs a case on one rank, without MPI and PETSc, for the fuzz targets.

use crate::solver::Skyline;
use bsmpm::error::StepError;
use bsmpm::initial;
use bsmpm::interactions::artificial_stiffness::ResistedDisplacement;
use bsmpm::interactions::state::InteractionState;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Model;
use bsmpm::parallel::Alone;
use bsmpm::points::Points;
use bsmpm::schedule::TimeInterval;
use bsmpm::solve::Backend;
use bsmpm::step::{Counts, StepReport, step};
use bsmpm_scene::{Case, Initial, model};

/// A scene on its one rank.
pub struct SerialRun {
    /// the scene
    pub model: Model<PlaneStrain, 2>,
    /// all points
    pub points: Points<2>,
    state: InteractionState<2>,
    /// m  nodal displacement that the next step starts from
    pub guess: Vec<f64>,
    halo: Alone,
    solver: Skyline,
}

impl SerialRun {
    /// A run at time 0.
    pub fn new(model: Model<PlaneStrain, 2>, mut points: Points<2>) -> Self {
        points.sort_by_cell(&model.grid);
        let state = model.boundary.initial_state();
        let nodes = model.grid.nodes();
        let solver = Skyline::new(&model.grid);
        Self {
            model,
            points,
            state,
            guess: vec![0.0; nodes * 2],
            halo: Alone { nodes },
            solver,
        }
    }

    /// Gives the points the stress that the case wants at the start.
    pub fn start(&mut self, case: &Case) -> Result<(), StepError> {
        match &case.initial {
            None => return Ok(()),
            Some(Initial::Elastic) => {
                initial::set_elastic(
                    &self.model,
                    &mut self.points,
                    &mut self.state,
                    &self.halo,
                    &mut self.solver,
                )?;
            }
            Some(Initial::AtRest(k0)) if case.settles => {
                initial::set_spread(
                    &self.model,
                    &mut self.points,
                    &mut self.state,
                    |material| k0[usize::from(material)],
                    &self.halo,
                    &mut self.solver,
                )?;
            }
            Some(Initial::AtRest(k0)) => {
                initial::set_stress(&self.model, &mut self.points, |material, x| {
                    model::at_rest(case, k0, material, x)
                });
            }
        }
        if case.settles {
            initial::settle(
                &self.model,
                &mut self.points,
                &mut self.state,
                &self.halo,
                &mut self.solver,
            )?;
        }
        initial::balance(&self.model, &self.points, &self.state, &self.halo).map(|_| ())
    }

    /// One attempt at one step from `t` on.
    pub fn step(&mut self, t: f64, dt: f64) -> Result<StepReport, StepError> {
        step(
            &self.model,
            &mut self.points,
            &mut self.state,
            &mut self.guess,
            TimeInterval { start: t, dt },
            ResistedDisplacement::Whole,
            &mut Backend {
                halo: &self.halo,
                solver: &mut self.solver,
                counts: &mut Counts::default(),
            },
        )
    }
}
