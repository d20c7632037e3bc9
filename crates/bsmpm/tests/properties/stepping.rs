//! Tests of step size control: halving, growth, and failure without change of the points.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use crate::support::solver::{Reluctant, Skyline};
use bsmpm::boundary::Support;
use bsmpm::control::{AcceptedStep, Failure, Stepper};
use bsmpm::error::{SolveError, StepError};
use bsmpm::exact::Exact;
use bsmpm::grid::Contributions;
use bsmpm::initial;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::method::Nonlinear;
use bsmpm::method::QuasiNewton;
use bsmpm::model::Regime;
use bsmpm::parallel::{Alone, Halo, OwnedNodes};
use bsmpm::schedule::Schedule;
use std::cell::Cell;

/// A block settling on a fixed base.
fn block(regime: Regime) -> Scene<PlaneStrain, 2> {
    Scene::new([axis(0.5, 2, 2), axis(0.5, 3, 2)], hencky(100.0, 0.3), regime)
        .body([0..2, 0..2], 2, 1.0, |x| x * 0.1)
        .support(Support::roller(0, false))
        .support(Support::fixed(1, false))
        .gravity(1.0, 4.0)
}

fn run(scene: &mut Scene<PlaneStrain, 2>, schedule: &Schedule, refusals: usize) -> Result<Vec<AcceptedStep>, Failure> {
    let mut solver = Reluctant {
        solver: Skyline::new(&scene.model.grid),
        refusals,
    };
    let halo = scene.halo();
    let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
    let mut steps = Vec::new();
    while let Some(found) = scene.advance(&mut stepper, schedule, &halo, &mut solver) {
        steps.push(found?);
        scene.points.sort_by_cell(&scene.model.grid);
    }
    Ok(steps)
}

#[test]
fn a_cut_step_lands_on_its_nominal_end_and_grows_back_after_two_easy_ones() {
    let steps = run(&mut block(Regime::QuasiStatic), &Schedule::new(1.0, 4.0, []), 2).unwrap();
    let lengths: Vec<f64> = steps.iter().map(|step| step.dt).collect();
    assert_eq!(lengths, [0.25, 0.25, 0.5, 0.5, 0.5, 1.0, 1.0]);
    assert_eq!(steps[0].rejected.len(), 2);
    assert!(steps[1..].iter().all(|step| step.rejected.is_empty()));
    assert_eq!(steps.last().map(|step| step.t), Some(4.0));
}

#[test]
fn whatever_is_cut_every_wanted_time_is_hit_exactly() {
    let wanted = [0.1, 0.7, 1.3, 2.9];
    let schedule = Schedule::new(0.3, 3.0, wanted);
    for refusals in [0, 1, 3, 5] {
        let steps = run(&mut block(Regime::QuasiStatic), &schedule, refusals).unwrap();
        let times: Vec<f64> = steps.iter().map(|step| step.t).collect();
        assert!(times.is_sorted_by(|a, b| a < b));
        assert!(
            wanted.iter().chain(&[3.0]).all(|t| times.contains(t)),
            "{refusals}: {times:?}"
        );
        assert!((steps.iter().map(|step| step.dt).sum::<f64>() - 3.0).abs() <= 1e-14);
    }
}

#[test]
fn nominal_ends_of_a_schedule_ascend_and_are_a_function_of_time_alone() {
    let mut random = Random::new(1);
    for _ in 0..200 {
        let dt = 0.01 + random.unit();
        let end = 0.5 + 10.0 * random.unit();
        let wanted: Vec<f64> = (0..4).map(|_| 12.0 * random.unit()).collect();
        let schedule = Schedule::new(dt, end, wanted.clone());
        let stations: Vec<f64> = std::iter::successors(schedule.next(0.0), |&t| schedule.next(t)).collect();
        assert_eq!(stations.last(), Some(&end));
        assert!(
            stations
                .windows(2)
                .all(|pair| pair[0] < pair[1] && pair[1] - pair[0] <= dt * (1.0 + 2e-6))
        );
        assert!(
            wanted
                .iter()
                .filter(|&&t| t < end - 1e-6 * dt)
                .all(|t| stations.contains(t))
        );
        let restarted = schedule.next(stations[stations.len() / 2]);
        assert_eq!(restarted, stations.get(stations.len() / 2 + 1).copied());
    }
}

/// Points and interactions have the same state in both.
fn assert_is_same(scene: &Scene<PlaneStrain, 2>, other: &Scene<PlaneStrain, 2>) {
    assert_eq!(scene.points, other.points);
    assert_eq!(scene.state, other.state);
}

#[test]
fn a_step_that_never_converges_fails_after_ten_halvings_and_leaves_the_points_bit_by_bit() {
    for regime in [Regime::QuasiStatic, Regime::Dynamic] {
        let mut scene = block(regime);
        let before = scene.clone();
        let failure = run(&mut scene, &Schedule::new(1.0, 4.0, []), usize::MAX).unwrap_err();
        assert_eq!((failure.t, failure.dt), (0.0, 1.0 / 1024.0));
        assert_eq!(failure.attempts.len(), 11);
        assert!(matches!(failure.attempts[10], StepError::Solve(SolveError::Failed(_))));
        assert_is_same(&scene, &before);
    }
}

#[test]
fn too_few_iterations_are_a_failure_and_not_an_answer() {
    let mut scene = block(Regime::QuasiStatic);
    scene.model.criteria.max_iterations = 1;
    scene.model.nonlinear = Nonlinear::QuasiNewton(QuasiNewton::Broyden);
    let before = scene.clone();
    let failure = run(&mut scene, &Schedule::new(1.0, 1.0, []), 0).unwrap_err();
    assert!(
        failure
            .attempts
            .iter()
            .all(|error| matches!(error, StepError::NotConverged { iterations: 1, .. }))
    );
    assert_is_same(&scene, &before);
}

#[test]
fn a_point_that_leaves_the_grid_whatever_the_step_ends_the_run_with_the_points_unchanged() {
    let mut scene = block(Regime::Dynamic);
    scene.model.gravity = None;
    scene.model.boundary.supports.clear();
    scene
        .points
        .motion
        .as_mut()
        .unwrap()
        .v
        .iter_mut()
        .for_each(|v| *v = [-1.0, 0.0].into());
    let before = scene.clone();
    // Even the smallest step takes the first column of points, 0.125 m from the face, beyond it.
    let failure = run(&mut scene, &Schedule::new(1024.0, 1024.0, []), 0).unwrap_err();
    assert_eq!((failure.t, failure.dt, failure.attempts.len()), (0.0, 1.0, 11));
    assert!(failure.attempts.iter().all(|error| matches!(
        error,
        StepError::Left {
            count: 16,
            first: Some((0, _))
        }
    )));
    assert_is_same(&scene, &before);
}

/// At 1 m/s they are there after 0.125 s.
#[test]
fn a_step_that_throws_points_out_of_the_grid_is_cut_and_ends_where_they_are_about_to_leave() {
    let mut scene = block(Regime::Dynamic);
    scene.model.gravity = None;
    scene.model.boundary.supports.clear();
    scene
        .points
        .motion
        .as_mut()
        .unwrap()
        .v
        .iter_mut()
        .for_each(|v| *v = [-1.0, 0.0].into());
    let failure = run(&mut scene, &Schedule::new(1.0, 1.0, []), 0).unwrap_err();
    assert!(
        (0.125 - 2.0 / 1024.0..=0.125).contains(&failure.t) && failure.dt == 1.0 / 1024.0,
        "{failure:?}"
    );
    assert!(
        failure
            .attempts
            .iter()
            .all(|error| matches!(error, StepError::Left { .. }))
    );
    assert!(scene.points.x.iter().all(|x| x[0] >= 0.0) && scene.points.x[0][0] < 2.0 / 1024.0);
}

/// The last column, 0.875 m from the face, follows the others 0.75 s after them.
#[test]
fn a_grid_that_empties_through_its_outlets_ends_the_run_and_says_so() {
    let mut scene = block(Regime::Dynamic);
    scene.model.gravity = None;
    scene.model.boundary.supports.clear();
    scene.model.boundary.outlets = vec![(0, false)];
    scene
        .points
        .motion
        .as_mut()
        .unwrap()
        .v
        .iter_mut()
        .for_each(|v| *v = [-1.0, 0.0].into());
    let failure = run(&mut scene, &Schedule::new(1.0 / 64.0, 2.0, []), 0).unwrap_err();
    let last = failure.attempts.last().expect("an attempt");
    assert!(matches!(last, StepError::Emptied { count: 4 }), "{failure:?}");
    assert!(last.to_string().contains("no material is left"), "{last}");
    assert!(
        (failure.t - 0.875).abs() < 1e-3 && scene.points.len() == 4,
        "{}",
        failure.t
    );
}

#[test]
fn a_step_that_turns_material_inside_out_is_cut_and_then_finds_equilibrium() {
    let mut scene = block(Regime::QuasiStatic);
    scene.model.gravity = None;
    let push = Support::moving(0, true, [Some(-0.4), None]);
    scene = scene.support(push);
    let steps = run(&mut scene, &Schedule::new(1.0, 1.0, []), 0).unwrap();
    let rejected: Vec<_> = steps.iter().flat_map(|step| &step.rejected).collect();
    assert!(!rejected.is_empty() && rejected.iter().all(|e| matches!(e, StepError::Inverted { .. })));
    assert_eq!(steps.last().map(|step| step.t), Some(1.0));
}

#[test]
fn the_same_run_twice_is_the_same_bit_by_bit() {
    let run = || block(Regime::Dynamic).solved(0.1, 2.0).0.points;
    assert_eq!(run(), run());
}

/// One rank that is interrupted in the reduction of a number, and not again.
struct Impatient {
    halo: Alone,
    reductions: Cell<usize>,
    interrupted_in: usize,
    convinced: Cell<bool>, // else it gives the next step up that has converged
}

impl Halo for Impatient {
    fn owned(&self) -> OwnedNodes {
        self.halo.owned()
    }
    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64> {
        self.halo.assemble_ghosts(contributions)
    }
    fn update_ghosts(&self, _nodal: &mut [f64], _width: usize) {}
    fn ghost_max(&self, _nodal: &mut [f64], _width: usize) {}
    fn all_reduce_sum(&self, _numbers: &mut [f64]) {
        self.reductions.set(self.reductions.get() + 1);
    }
    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64> {
        self.reductions.set(self.reductions.get() + 1);
        self.halo.reproducible_sum(sums)
    }
    fn all_reduce_max(&self, _numbers: &mut [f64]) {}
    fn is_interrupted(&self) -> bool {
        self.reductions.get() == self.interrupted_in
    }
    fn rejects(&self) -> bool {
        !self.convinced.replace(true)
    }
}

fn impatient(scene: &Scene<PlaneStrain, 2>, interrupted_in: usize) -> Impatient {
    Impatient {
        halo: scene.halo(),
        reductions: Cell::new(0),
        interrupted_in,
        convinced: Cell::new(true),
    }
}

/// Whenever it is given up: the points are those before it, and the steps after it those of a run without.
#[test]
fn a_step_that_is_given_up_on_request_has_never_been() {
    for nonlinear in [
        Nonlinear::Auto,
        Nonlinear::QuasiNewton(QuasiNewton::Broyden),
        Nonlinear::Newton,
    ] {
        let schedule = Schedule::new(1.0, 2.0, []);
        let mut whole = block(Regime::Dynamic);
        whole.model.nonlinear = nonlinear;
        let mut given_up = 0;
        for interrupted_in in 1..40 {
            let mut scene = whole.clone();
            let halo = impatient(&scene, interrupted_in);
            let mut solver = Reluctant {
                solver: Skyline::new(&scene.model.grid),
                refusals: 1,
            };
            let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
            let mut lengths = Vec::new();
            loop {
                let before = scene.clone();
                match scene.advance(&mut stepper, &schedule, &halo, &mut solver) {
                    None => break,
                    Some(Ok(accepted)) => lengths.push(accepted.dt),
                    Some(Err(failure)) => {
                        assert!(failure.is_interruption(), "{:?}", failure.attempts);
                        assert_is_same(&scene, &before);
                        given_up += 1;
                        // The fault of the step's first attempt repeats with it.
                        halo.reductions.set(usize::MAX / 2);
                        solver.refusals = usize::from(lengths.is_empty());
                    }
                }
                scene.points.sort_by_cell(&scene.model.grid);
            }
            let mut expected = whole.clone();
            let steps = run(&mut expected, &schedule, 1).unwrap();
            assert_eq!(lengths, steps.iter().map(|step| step.dt).collect::<Vec<_>>());
            assert_is_same(&scene, &expected);
        }
        assert!(given_up > 5, "{nonlinear:?}: {given_up}");
    }
}

/// Steps of all methods, each given up once when it has converged.
#[test]
fn a_converged_step_that_is_rejected_has_never_been() {
    for nonlinear in [
        Nonlinear::Auto,
        Nonlinear::QuasiNewton(QuasiNewton::Broyden),
        Nonlinear::Newton,
    ] {
        let schedule = Schedule::new(1.0, 4.0, []);
        let mut scene = block(Regime::Dynamic);
        scene.model.nonlinear = nonlinear;
        let mut expected = scene.clone();
        let halo = impatient(&scene, usize::MAX);
        let mut solver = Reluctant {
            solver: Skyline::new(&scene.model.grid),
            refusals: 0,
        };
        let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
        loop {
            halo.convinced.set(false);
            let before = scene.clone();
            match scene.advance(&mut stepper, &schedule, &halo, &mut solver) {
                None => break,
                found => assert!(
                    found.unwrap().is_err_and(|failure| failure.is_interruption()),
                    "rejected"
                ),
            }
            assert_is_same(&scene, &before);
            scene
                .advance(&mut stepper, &schedule, &halo, &mut solver)
                .unwrap()
                .unwrap();
            scene.points.sort_by_cell(&scene.model.grid);
        }
        assert_eq!(run(&mut expected, &schedule, 0).unwrap().len(), 4);
        assert_is_same(&scene, &expected);
    }
}

#[test]
fn a_start_that_is_given_up_on_request_leaves_the_points_as_they_are() {
    let mut scene = block(Regime::QuasiStatic);
    scene.model.gravity.as_mut().unwrap().ramp = 0.0;
    let before = scene.points.clone();
    let mut given_up = 0;
    for interrupted_in in 1..20 {
        let halo = impatient(&scene, interrupted_in);
        let mut solver = Skyline::new(&scene.model.grid);
        let mut points = before.clone();
        let mut state = scene.state.clone();
        match initial::set_elastic(&scene.model, &mut points, &mut state, &halo, &mut solver) {
            Ok(()) => assert_ne!(points, before),
            Err(error) => {
                assert_eq!(error, StepError::Interrupted);
                assert_eq!(points, before);
                assert_eq!(state, scene.state);
                given_up += 1;
            }
        }
    }
    assert!(given_up > 0);
}
