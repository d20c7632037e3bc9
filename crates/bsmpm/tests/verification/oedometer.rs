//! Tests of uniform confined compression to a stretch l in one step: stress sigma = M ln(l) / l with the constrained
//! modulus M.

use crate::support::scene::{METHODS, Scene, axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::control::AcceptedStep;
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::material::Moduli;
use bsmpm::model::{AverageWeight, Regime};
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Symmetric;

/// Compresses a body of `cells` cells along the last axis (and as many across as fit) to the length `l`.
fn compressed<K: Kinematics<D>, const D: usize>(
    cells: usize,
    l: f64,
    method: Stabilisation,
) -> (Scene<K, D>, Vec<AcceptedStep>) {
    let axes = std::array::from_fn(|_| axis(1.0 / cells as f64, cells, 2));
    let mut face = Support::<D>::roller(D - 1, true);
    face.velocity[D - 1] = Some(l - 1.0);
    let mut scene = Scene::<K, D>::new(axes, hencky(1000.0, 0.3), Regime::QuasiStatic)
        .body(std::array::from_fn(|_| 0..cells), 3, 1.0, |x| x * 0.0)
        .rollers(0..D)
        .support(face)
        .stabilised(method);
    scene.model.criteria.force = 1e-12;
    scene.solved(1.0, 1.0)
}

/// Largest relative error of the vertical stress, and of the lateral one.
fn errors<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>, l: f64) -> f64 {
    let elastic = scene.model.materials[0].elastic();
    let Moduli { lambda, .. } = elastic.moduli();
    let vertical = elastic.oedometric() * l.ln() / l;
    let lateral = lambda * l.ln() / l;
    let of = |p: usize| {
        let sigma = scene.points.sigma.at(p).0;
        (0..3)
            .map(|k| (sigma[k] - if k == D - 1 { vertical } else { lateral }).abs())
            .fold(0.0, f64::max)
    };
    (0..scene.points.len()).map(of).fold(0.0, f64::max) / vertical.abs()
}

/// Closed form: confined compression of a Hencky material, M ln(l)/l.
#[test]
fn one_step_of_a_prescribed_face_gives_the_exact_stress_in_two_and_three_dimensions() {
    for method in METHODS {
        let (plane, steps) = compressed::<PlaneStrain, 2>(2, 0.8, method);
        let (solid, _) = compressed::<Solid, 3>(2, 0.8, method);
        let found = (errors(&plane, 0.8), errors(&solid, 0.8));
        println!("{method:?}: {found:?}, {} iterations", steps[0].report.iterations);
        assert_eq!(steps.len(), 1);
        assert!(found.0 <= 1e-10 && found.1 <= 1e-10); // measured 1.3e-12 at most, by consistent F-bar
    }
}

/// Closed form: confined compression of a Hencky material, M ln(l)/l.
#[test]
fn one_step_over_many_cells_gives_the_exact_stress() {
    for method in METHODS {
        let (scene, steps) = compressed::<PlaneStrain, 2>(6, 0.95, method);
        println!(
            "{method:?}: {:.1e}, {} iterations",
            errors(&scene, 0.95),
            steps[0].report.iterations
        );
        assert_eq!(steps.len(), 1);
        assert!(errors(&scene, 0.95) <= 1e-10); // measured 1.8e-12 at most
    }
}

#[test]
fn a_uniformly_stressed_block_between_fixed_faces_stays_without_iteration() {
    // Extreme N23: already in equilibrium.
    for method in METHODS {
        let (mut scene, _) = compressed::<PlaneStrain, 2>(4, 1.0, method);
        scene.points.b_e.fill(Symmetric([0.9, 0.64, 1.0, 0.0, 0.0, 0.0]));
        let before = scene.points.clone();
        let (scene, steps) = scene.solved(1.0, 3.0);
        let moved = scene
            .points
            .x
            .iter()
            .zip(&before.x)
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max);
        let iterations: Vec<usize> = steps.iter().map(|step| step.report.iterations).collect();
        println!("{method:?}: {iterations:?} iterations, moved {moved:.1e} m");
        assert!(iterations.iter().all(|&count| count == 0) && moved <= 1e-15);
    }
}

#[test]
fn without_mass_the_averages_weigh_with_volume() {
    let axes = || std::array::from_fn(|_| axis(0.5, 2, 2));
    let mut face = Support::<2>::roller(1, true);
    face.velocity[1] = Some(-0.2);
    for method in METHODS {
        let mut scene = Scene::<PlaneStrain, 2>::new(axes(), hencky(1000.0, 0.3), Regime::QuasiStatic)
            .body([0..2, 0..2], 3, 0.0, |x| x * 0.0)
            .rollers(0..2)
            .support(face)
            .stabilised(method);
        scene.model.weighting = AverageWeight::Volume;
        scene.model.criteria.force = 1e-12;
        let (scene, _) = scene.solved(1.0, 1.0);
        println!("{method:?}: {:.1e}", errors(&scene, 0.8));
        assert!(errors(&scene, 0.8) <= 1e-10); // measured 1.3e-12 at most
    }
}

/// Closed form: stress times area.
#[test]
fn the_reaction_of_a_face_is_the_stress_times_its_area() {
    let (scene, steps) = compressed::<PlaneStrain, 2>(2, 0.8, Stabilisation::None);
    let M = scene.model.materials[0].elastic().oedometric();
    let reactions = &steps[0].report.reactions;
    let bottom = reactions[2][1];
    let face = reactions[4][1];
    println!("bottom {bottom}, face {face}, exact {}", M * 0.8_f64.ln() / 0.8);
    assert!((face / (M * 0.8_f64.ln() / 0.8) - 1.0).abs() <= 1e-10);
    assert!((bottom / face + 1.0).abs() <= 1e-10);
}

/// A rough bottom shares edges with smooth sides: what it holds there is pressure on them.
#[test]
fn the_sides_feel_the_stress_down_to_their_edge_on_a_fixed_bottom() {
    let mut face = Support::<3>::roller(2, true);
    face.velocity[2] = Some(-0.2);
    let axes = std::array::from_fn(|_| axis(0.5, 2, 2));
    let mut scene = Scene::<Solid, 3>::new(axes, hencky(1000.0, 0.3), Regime::QuasiStatic)
        .body([0..2, 0..2, 0..2], 3, 1.0, |x| x * 0.0)
        .rollers(0..2)
        .support(Support::fixed(2, false))
        .support(face);
    scene.model.criteria.force = 1e-12;
    let (scene, steps) = scene.solved(1.0, 1.0);
    let Moduli { lambda, .. } = scene.model.materials[0].elastic().moduli();
    let supports = &scene.model.boundary.supports;
    let reactions = &steps[0].report.reactions;
    for (support, force) in supports.iter().zip(reactions).filter(|(support, _)| support.axis < 2) {
        let pressure = force[support.axis] * if support.upper { -1.0 } else { 1.0 };
        assert!((pressure / (-lambda * 0.8_f64.ln()) - 1.0).abs() <= 1e-10, "{pressure}");
    }
}
