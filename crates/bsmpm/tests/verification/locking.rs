//! Tests that F-bar prevents locking and stress oscillation in nearly incompressible material.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::method::Criteria;
use bsmpm::method::Nonlinear;
use bsmpm::method::QuasiNewton;
use bsmpm::model::{AverageWeight, Regime};
use bsmpm::observe::{Part, largest_displacement, noise};
use bsmpm::stabilisation::Stabilisation;

/// A block of 6 x 6 cells with nu = 0.49 on a fixed base beside a wall, under its weight: noise of the vertical stress
/// about planes, and the largest displacement.
fn pressed(method: Stabilisation) -> (f64, f64) {
    let (noise, displacement, _) = pressed_by(QuasiNewton::default(), method);
    (noise, displacement)
}

fn pressed_by(quasi_newton: QuasiNewton, method: Stabilisation) -> (f64, f64, usize) {
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(1.0, 8, 2), axis(1.0, 6, 2)],
        hencky(1000.0, 0.49),
        Regime::QuasiStatic,
    )
    .body([0..6, 0..6], 3, 1.0, |x| x * 0.0)
    .support(Support::roller(0, false))
    .support(Support::fixed(1, false))
    .gravity(5.0, 4.0)
    .stabilised(method);
    scene.model.criteria = Criteria {
        energy: 1e-8,
        force: 1e-4,
        max_iterations: 200,
    };
    scene.model.nonlinear = Nonlinear::QuasiNewton(quasi_newton);
    let (scene, steps) = scene.solved(1.0, 4.0);
    let halo = scene.halo();
    let noise = noise::stress_noise(&scene.model.grid, &scene.points, AverageWeight::Mass, 1, &halo).expect("inside");
    let displacement = largest_displacement(&scene.points, &Part::Whole, &halo);
    let iterations: Vec<usize> = steps.iter().map(|step| step.report.iterations).collect();
    println!("{method:?}, {quasi_newton:?}: {noise:.3?}, displacement {displacement:.4} m, iterations {iterations:?}");
    (noise.about_plane, displacement, iterations.iter().sum())
}

/// Confined block with Poisson's ratio 0.49: oscillation of the stress with and without F-bar.
#[test]
fn f_bar_relieves_locking_and_the_oscillation_of_stress() {
    let [none, f_bar, modified] = [Stabilisation::None, Stabilisation::FBar, Stabilisation::ModifiedFBar].map(pressed);
    assert!(f_bar.0 <= 0.5 * none.0); // measured 0.095 against 0.328
    assert!(modified.0 <= f_bar.0); // measured 0.070
    assert!(f_bar.1 >= none.1); // measured 0.0599 against 0.0588
}

#[test]
fn both_quasi_newton_methods_find_the_same_equilibrium() {
    let [all, one] = [QuasiNewton::Multisecant, QuasiNewton::Broyden].map(|by| pressed_by(by, Stabilisation::FBar));
    assert!((all.1 / one.1 - 1.0).abs() <= 1e-5, "{} against {}", all.1, one.1);
    assert!(all.2 < one.2, "{} iterations against {}", all.2, one.2);
}
