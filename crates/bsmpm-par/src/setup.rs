//! From a valid case to a model and its points: the only place where the case's words become the physics' types.

use crate::ksp::Choice;
use crate::slab::Slabs;
use bsmpm::background::Background;
use bsmpm::boundary::{Boundary, Support};
use bsmpm::error::GridError;
use bsmpm::grid::{Grid, KnotVector};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::{Criteria, Gravity, Model, Weighting};
use bsmpm::points::Points;
use bsmpm::schedule::Schedule;
use bsmpm::step::quasi_newton::QuasiNewton;
use bsmpm_scene::{Axis, Case, Every, Nonlinear, Regime};
use std::marker::PhantomData;

/// The model of a plane-strain case over its whole grid.
pub fn model(case: &Case) -> Result<Model<PlaneStrain, 2>, GridError> {
    let order = case.grid.order;
    let axis = |axis: &Axis| match axis {
        Axis::Uniform { cell, cells, .. } => KnotVector::uniform(*cell, *cells, order),
        Axis::Graded(breakpoints) => KnotVector::graded(breakpoints, order),
    };
    let all_have_mass = case.bodies.iter().all(|body| case.materials[body.material].density.is_some());
    Ok(Model {
        grid: Grid::new([axis(&case.grid.axes[0])?, axis(&case.grid.axes[1])?])?,
        materials: case.materials.iter().map(|named| named.material.clone()).collect(),
        regime: case.analysis.regime,
        weighting: if all_have_mass { Weighting::Mass } else { Weighting::Volume },
        gravity: case
            .gravity
            .as_ref()
            .map(|gravity| Gravity { acceleration: gravity.acceleration.into(), ramp: gravity.ramp }),
        boundary: boundary(case),
        stabilisation: case.stabilisation,
        background: (case.solver.background > 0.0)
            .then_some(Background { coefficient: case.solver.background, extent: case.solver.background_cells }),
        criteria: Criteria {
            energy: case.solver.tolerance,
            force: case.solver.force_tolerance,
            max_iterations: case.solver.max_iterations,
        },
        quasi_newton: match case.solver.nonlinear {
            Nonlinear::Auto => QuasiNewton::Multisecant,
            Nonlinear::Broyden => QuasiNewton::Broyden,
        },
        kinematics: PhantomData,
    })
}

fn boundary(case: &Case) -> Boundary<2> {
    let mut supports = Vec::new();
    for (axis, faces) in case.boundary.iter().enumerate() {
        for (upper, support) in [false, true].into_iter().zip(faces) {
            match support {
                bsmpm_scene::Support::Fixed => supports.push(Support::fixed(axis, upper)),
                bsmpm_scene::Support::Roller => supports.push(Support::roller(axis, upper)),
                bsmpm_scene::Support::Free => {}
            }
        }
    }
    Boundary { supports }
}

/// The points of the columns of one slab.
pub fn points(case: &Case, columns: std::ops::Range<usize>) -> Points<2> {
    Points::from_seeds(bsmpm_scene::seed(case, columns), case.analysis.regime == Regime::Dynamic)
}

/// The first cut of the grid: about equal numbers of points. `None` with more ranks than columns.
pub fn slabs(case: &Case, ranks: usize) -> Option<Slabs> {
    Slabs::cut(&case.points_by_column().into_iter().map(|count| count as f64).collect::<Vec<_>>(), ranks)
}

/// Steps and the times that they must hit: frames, pictures and checks.
pub fn schedule(case: &Case) -> Schedule {
    let checks = case.checks.iter().map(|check| check.at);
    Schedule::new(case.analysis.dt, case.analysis.end, frame_times(case).into_iter().chain(checks))
}

/// Times at which a frame is wanted, apart from the start, the end and every so many steps.
pub fn frame_times(case: &Case) -> Vec<f64> {
    let mut times = case.output.times.clone();
    if let Some(Every::Time(every)) = case.output.every {
        let count = (case.analysis.end / every).floor() as u64;
        times.extend((1..=count).map(|k| k as f64 * every));
    }
    times
}

/// The linear solver by PETSc's names.
pub fn linear(case: &Case) -> Choice {
    let linear = &case.solver.linear;
    Choice { ksp: linear.ksp.into(), pc: linear.pc.into(), factor: linear.factor.map(Into::into) }
}
