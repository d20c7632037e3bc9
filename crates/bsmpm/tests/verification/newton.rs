//! Tests that Newton's method converges quadratically with plasticity and F-bar, and finds the equilibrium of
//! quasi-Newton.

use crate::support::scene::{Scene, axis};
use bsmpm::boundary::{Support, surface};
use bsmpm::control::AcceptedStep;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::method::Criteria;
use bsmpm::method::{Method, Nonlinear};
use bsmpm::model::{AverageWeight, Regime};
use bsmpm::observe::{Part, largest_displacement};
use bsmpm::stabilisation::Stabilisation;

type Plane = Scene<PlaneStrain, 2>;

/// A platen pressed into the left half of a nearly incompressible clay that yields, in ten steps.
fn indented(nonlinear: Nonlinear, method: Stabilisation) -> (Plane, Vec<AcceptedStep>) {
    let clay = MohrCoulomb::new(
        Elastic {
            young: 100.0,
            poisson: 0.49,
        },
        0.0,
        0.0,
        1.0,
    );
    let mut scene = Plane::new(
        [axis(0.5, 4, 2), axis(0.5, 5, 2)],
        Material::MohrCoulomb(clay),
        Regime::QuasiStatic,
    )
    .body([0..4, 0..3], 3, 0.0, |x| x * 0.0)
    .rollers(0..1)
    .support(Support::fixed(1, false))
    .stabilised(method);
    scene.model.weighting = AverageWeight::Volume;
    scene.model.criteria = Criteria {
        energy: 1e-16,
        force: 1e-9,
        max_iterations: 400,
    };
    scene.model.artificial_stiffness = Some(ArtificialStiffness { coefficient: 1e-3 });
    scene.model.nonlinear = nonlinear;
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &[0.0, 1.5].into(), &[1.0, 1.5].into(), 3);
    let path = Path {
        rows: vec![(1.0, [0.0, -0.1].into())],
    };
    scene
        .strip(Strip {
            contact: None,
            points,
            normal: Some([0.0, 1.0].into()),
            transitions: Default::default(),
            path,
            penalty: 2e5,
        })
        .solved(0.1, 1.0)
}

/// Theory: quadratic convergence of Newton's method.
#[test]
fn the_residual_force_converges_quadratically() {
    for method in [Stabilisation::None, Stabilisation::FBar, Stabilisation::ConsistentFBar] {
        let (_, steps) = indented(Nonlinear::Newton, method);
        let last = steps.last().expect("ten steps");
        let forces: Vec<f64> = last.report.history.iter().map(|measures| measures.force).collect();
        println!("{method:?}, step 10: {forces:?}");
        assert_eq!(last.report.newton_iterations, forces.len());
        assert!(
            last.report
                .history
                .iter()
                .all(|measures| measures.method == Method::Newton)
        );
        assert!(forces.len() <= 8, "{} iterations", forces.len());
        // f_k+1 <= C f_k^2 once the plastic set no longer changes; measured C: 9.4, 0.09, 5.1.
        let [.., before, after] = forces[..] else {
            panic!("too few iterations")
        };
        assert!(after <= 30.0 * before * before, "{forces:?}");
    }
}

#[test]
fn newton_and_the_secants_find_the_same_equilibrium() {
    for method in [Stabilisation::None, Stabilisation::FBar, Stabilisation::ModifiedFBar] {
        let [auto, newton] = [Nonlinear::Auto, Nonlinear::Newton].map(|nonlinear| indented(nonlinear, method));
        let [a, b] = [&auto.0, &newton.0].map(|scene| largest_displacement(&scene.points, &Part::Whole, &scene.halo()));
        let count = |steps: &[AcceptedStep]| steps.iter().map(|step| step.report.iterations).sum::<usize>();
        println!(
            "{method:?}: {a} {b}, iterations {} {}",
            count(&auto.1),
            count(&newton.1)
        );
        assert!((a / b - 1.0).abs() <= 1e-6, "{a} against {b}");
        assert!(count(&newton.1) < count(&auto.1));
        assert!(newton.1.iter().all(|step| step.rejected.is_empty()), "no step is cut");
    }
}
