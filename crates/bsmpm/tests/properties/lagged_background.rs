//! Tests that in steady motion the artificial stiffness resists only changes of the displacement per step.

use crate::support::scene::{Scene, axis};
use bsmpm::boundary::{Boundary, Support, surface};
use bsmpm::control::AcceptedStep;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::rigid::Outline;
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::model::Regime;
use bsmpm::tensor::Vector;

/// A block of clay in a grid with empty cells above it, into which a smooth strip is pressed along a path.
fn footing(rows: Vec<(f64, [f64; 2])>) -> Scene<PlaneStrain, 2> {
    let clay = MohrCoulomb::new(
        Elastic {
            young: 1e6,
            poisson: 0.4,
        },
        0.0,
        0.0,
        1e3,
    );
    let axes = [axis(0.25, 8, 2), axis(0.25, 6, 2)];
    let scene = Scene::new(axes, Material::MohrCoulomb(clay), Regime::QuasiStatic)
        .body([0..8, 0..4], 2, 0.0, |x| x * 0.0)
        .rollers([0])
        .support(Support::fixed(1, false))
        .extended();
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &[0.0, 1.0].into(), &[0.5, 1.0].into(), 2);
    let path = Path {
        rows: rows.into_iter().map(|(t, u)| (t, u.into())).collect(),
    };
    scene.strip(Strip {
        contact: None,
        points,
        normal: Some([0.0, 1.0].into()),
        transitions: Default::default(),
        path,
        penalty: 4e9,
    })
}

/// The steps under a background of this coefficient.
fn steps(rows: &[(f64, [f64; 2])], coefficient: f64) -> Vec<AcceptedStep> {
    let scene = footing(rows.to_vec()).artificial_stiffness(Some(ArtificialStiffness { coefficient }));
    scene.solved(0.05, rows.last().expect("a path").0).1
}

/// N  the last force of the strip.
fn force(steps: &[AcceptedStep]) -> f64 {
    steps.last().expect("a step").report.strips[0].force[1].abs()
}

#[test]
fn a_limit_load_does_not_depend_on_the_coefficient() {
    let path = [(1.0, [0.0, -0.02])];
    let [stiff, usual, soft] = [1e-3, 1e-4, 1e-5].map(|coefficient| force(&steps(&path, coefficient)));
    println!("{stiff} {usual} {soft} N");
    // 1.2e-6 and 1.2e-7 were found; of what is dragged 1.3e-3.
    assert!(
        (stiff / usual - 1.0).abs() < 1e-5 && (soft / usual - 1.0).abs() < 1e-5,
        "{stiff} {usual} {soft}"
    );
    let mut dragged = footing(path.to_vec()).artificial_stiffness(Some(ArtificialStiffness { coefficient: 1e-3 }));
    dragged.model.extended_splines = ExtendedSplines::Off;
    let dragged = force(&dragged.solved(0.05, 1.0).1);
    assert!(dragged > 1.001 * usual, "without ties it is a drag: {dragged} N");
}

/// Work of the background in every step over that of all internal forces.
fn shares(steps: &[AcceptedStep]) -> Vec<f64> {
    let share = |step: &AcceptedStep| {
        let stiffness = step.report.artificial_stiffness;
        stiffness.map_or(0.0, |of| of.work / of.internal_work.abs())
    };
    steps.iter().map(share).collect()
}

/// Down for half of the time, and then half as fast.
#[test]
fn all_of_the_displacement_is_resisted_where_a_motion_begins_and_where_it_turns() {
    let shares = shares(&steps(&[(0.5, [0.0, -0.01]), (1.0, [0.0, -0.015])], 1e-3));
    println!("{shares:?}");
    let steady = shares[6..10]
        .iter()
        .chain(&shares[15..])
        .fold(0.0, |most: f64, share| most.max(*share));
    assert!(shares[0] > 10.0 * steady && shares[10] > 10.0 * steady, "{shares:?}");
}

/// A disc without mass that moves along no path.
fn disc() -> RigidBody {
    RigidBody {
        acts: true,
        outline: Outline::Circle(0.1),
        center: [0.5, 1.2].into(),
        friction: 0.0,
        free: [false; 3],
        path: Vec::new(),
        mass: Vector::zeros(),
        load: Vec::new(),
        velocity: Vector::zeros(),
    }
}

/// What moves as prescribed in a step of 0.1 from t = 1 on, after one of `last_dt`.
fn is_steady(boundary: &Boundary<2>, last_dt: f64) -> bool {
    boundary.moves_steadily(1.0, last_dt, 0.1)
}

#[test]
fn a_motion_is_steady_whose_velocity_is_that_of_the_last_step_whatever_its_length() {
    let with = |rows: Vec<(f64, [f64; 2])>| footing(rows).model.boundary;
    for last_dt in [0.1, 0.025] {
        assert!(is_steady(&with(vec![(2.0, [0.0, -0.02])]), last_dt));
        assert!(!is_steady(&with(vec![(1.0, [0.0, -0.02])]), last_dt), "it ends");
        assert!(
            !is_steady(&with(vec![(1.0, [0.0, 0.0]), (2.0, [0.0, -0.02])]), last_dt),
            "it begins"
        );
        assert!(
            !is_steady(&with(vec![(1.0, [0.0, -0.02]), (2.0, [0.0, 0.0])]), last_dt),
            "it turns"
        );
        assert!(!is_steady(&with(vec![(2.0, [0.0, 0.0])]), last_dt), "it rests");
        let nothing = Boundary::default();
        assert!(!is_steady(&nothing, last_dt));
        let face = Support::moving(0, false, [Some(0.01), None]);
        assert!(is_steady(
            &Boundary {
                supports: vec![face],
                ..Boundary::default()
            },
            last_dt
        ));
        let body = |free: [bool; 3], end: f64| {
            let path = vec![(end, [0.0, -0.1, 0.0].into())];
            let body = RigidBody { free, path, ..disc() };
            Boundary {
                rigid: vec![body],
                ..Boundary::default()
            }
        };
        assert!(is_steady(&body([false; 3], 2.0), last_dt));
        assert!(!is_steady(&body([false; 3], 1.05), last_dt), "it ends within the step");
        assert!(!is_steady(&body([false, true, false], 2.0), last_dt), "forces move it");
    }
}
