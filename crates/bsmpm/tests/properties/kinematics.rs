//! Tests of objectivity, of F-bar with a factor of one, and that geometries agree.

use crate::support::random::Random;
use crate::support::scene::hencky;
use bsmpm::kinematics::{Axisymmetric, Gradient, Kinematics, PlaneStrain, Solid};
use bsmpm::material::Moduli;
use bsmpm::tensor::{Square, Symmetric, Tensor, Vector};
use nalgebra::{Rotation3, SMatrix, Vector3};

/// A deformation in the plane: the third direction is untouched.
fn in_plane(random: &mut Random) -> Tensor {
    PlaneStrain::gradient(&(random.square::<2>() * 0.3)) + Tensor::identity()
}

fn b_of(F: &Tensor) -> Symmetric {
    Symmetric::of(&(F * F.transpose()))
}

#[test]
fn f_bar_with_ratio_one_leaves_the_increment_bit_by_bit() {
    let mut random = Random::new(1);
    for _ in 0..1000 {
        let plane = in_plane(&mut random);
        let solid = Tensor::identity() + random.square::<3>() * 0.3;
        assert_eq!(PlaneStrain::dilate(&plane, 1.0), plane);
        assert_eq!(Solid::dilate(&solid, 1.0), solid);
    }
}

#[test]
fn f_bar_gives_the_wanted_determinant_and_in_plane_leaves_the_third_direction() {
    let mut random = Random::new(2);
    let mut worst = 0.0_f64;
    for _ in 0..1000 {
        let ratio = 2.0_f64.powf(random.signed());
        let plane = in_plane(&mut random);
        let solid = Tensor::identity() + random.square::<3>() * 0.3;
        let pairs = [
            (plane, PlaneStrain::dilate(&plane, ratio)),
            (plane, Axisymmetric::dilate(&plane, ratio)),
            (solid, Solid::dilate(&solid, ratio)),
        ];
        for (before, after) in pairs {
            let wanted = ratio * before.determinant();
            worst = worst.max((after.determinant() / wanted - 1.0).abs());
        }
        assert_eq!(PlaneStrain::dilate(&plane, ratio)[(2, 2)], 1.0);
    }
    println!("determinant to {worst:.1e}");
    assert!(worst <= 1e-14); // measured 6.7e-16
}

#[test]
fn a_rigid_rotation_keeps_the_principal_stress_and_turns_the_stress() {
    let mut random = Random::new(3);
    let law = hencky(1000.0, 0.3);
    let mut worst = 0.0_f64;
    for _ in 0..200 {
        let b = b_of(&(Tensor::identity() + random.square::<3>() * 0.2));
        let before = law.respond(&b, &[]).unwrap();
        let R = *Rotation3::new(random.vector::<3>() * 3.0).matrix();
        let after = law.respond(&Solid::push_forward(&R, &b), &[]).unwrap();
        for (x, y) in before.principal_tau().iter().zip(after.principal_tau()) {
            worst = worst.max((x - y).abs());
        }
        worst = worst.max((after.tau().full() - R * before.tau().full() * R.transpose()).amax());
    }
    println!("worst change {:.1e} E", worst / 1000.0);
    assert!(worst <= 1e-14 * 1000.0); // measured 8e-16 E
}

#[test]
fn ten_turns_in_steps_of_a_degree_keep_the_kirchhoff_stress() {
    // Extreme N17: <= 1e-8 E for an exact rotation at point level.
    let law = hencky(1000.0, 0.3);
    let mut b = b_of(&Tensor::new(1.1, 0.05, 0.0, -0.02, 0.93, 0.0, 0.0, 0.0, 1.0));
    let before = law.respond(&b, &[]).unwrap();
    let R = *Rotation3::new(Vector3::z() * 1.0_f64.to_radians()).matrix();
    (0..3600).for_each(|_| b = PlaneStrain::push_forward(&R, &b));
    let after = law.respond(&b, &[]).unwrap();
    let change = (after.tau().full() - before.tau().full()).amax() / 1000.0;
    println!("change after ten turns {change:.1e} E");
    assert!(change <= 1e-11); // measured 2.2e-13
}

#[test]
fn plane_strain_is_the_solid_without_out_of_plane_displacement() {
    let mut random = Random::new(4);
    let mut b_e = 0.0_f64;
    let mut flux = 0.0_f64;
    for _ in 0..200 {
        let dF = in_plane(&mut random);
        let b = b_of(&in_plane(&mut random));
        let plane = PlaneStrain::push_forward(&dF, &b);
        let solid = Solid::push_forward(&dF, &b);
        b_e = b_e.max((plane.full() - solid.full()).amax());
        let tau = hencky(1.0, 0.3).respond(&solid, &[]).unwrap().tau();
        let plane = PlaneStrain::flux(&tau, &dF);
        let solid = Solid::flux(&tau, &dF);
        let corner = solid.fixed_view::<2, 2>(0, 0);
        flux = flux.max((plane - corner).amax() / plane.amax());
    }
    println!("b to {b_e:.1e}, flux to {flux:.1e}");
    assert!(b_e <= 1e-14 && flux <= 1e-14); // measured 2.2e-16, 3.6e-16
}

/// lambda tr(e) I + 2 mu e for the symmetric gradient of a displacement along `a` of node gradient `g`.
fn elastic_force<const D: usize>(moment: &Square<D>, lambda: f64, mu: f64) -> Square<D> {
    // k_ij = sum D_ikjl g_k h_l with D_ikjl = lambda d_ik d_jl + mu (d_ij d_kl + d_il d_kj) and T = g (x) h.
    Square::from_fn(|i, j| {
        let trace = if i == j { mu * moment.trace() } else { 0.0 };
        lambda * moment[(i, j)] + mu * moment[(j, i)] + trace
    })
}

#[test]
fn the_stiffness_of_a_node_pair_is_the_isotropic_one() {
    let mut random = Random::new(6);
    let moduli = Moduli { lambda: 3.0, mu: 2.0 };
    let plane = random.square::<2>();
    let solid = random.square::<3>();
    assert!((PlaneStrain::stiffness(&plane, moduli) - elastic_force(&plane, 3.0, 2.0)).amax() <= 1e-15);
    assert!((Solid::stiffness(&solid, moduli) - elastic_force(&solid, 3.0, 2.0)).amax() <= 2e-15);
}

/// Every unit displacement of two nodes against lambda tr(e) I + 2 mu e of the tensors that their gradients become.
#[test]
fn axisymmetric_forces_are_the_adjoint_of_axisymmetric_gradients() {
    let mut random = Random::new(7);
    let mut worst = 0.0_f64;
    let lambda = 3.0;
    let mu = 2.0;
    for _ in 0..100 {
        let x = Vector::<2>::new(1.5 + random.signed(), random.signed());
        let slopes = [0, 1].map(|_| Axisymmetric::slope::<f64>(|| random.signed(), Vector::repeat(0.7), &x));
        let of = |node: usize, component: usize| {
            let mut gradient = SMatrix::<f64, 2, 3>::zeros();
            gradient.set_row(component, &slopes[node].transpose());
            gradient
        };
        let stiffness = Axisymmetric::stiffness(&(slopes[0] * slopes[1].transpose()), Moduli { lambda, mu });
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let strain = Symmetric::of(&Axisymmetric::gradient(&of(1, j))).full();
            let stress = Tensor::identity() * (lambda * strain.trace()) + strain * (2.0 * mu);
            let works = stress.dot(&Axisymmetric::gradient(&of(0, i)));
            worst = worst.max((stiffness[(i, j)] - works).abs());
            let force = Axisymmetric::working(&stress).times(&slopes[0])[i];
            worst = worst.max((force - works).abs());
            let dilation = Axisymmetric::divergence(&slopes[0])[i];
            worst = worst.max((dilation - Axisymmetric::gradient(&of(0, i)).trace()).abs());
        }
        let grad = SMatrix::<f64, 2, 3>::from_fn(|i, j| if (i, j) == (1, 2) { 0.0 } else { 0.3 * random.signed() });
        let dF = Tensor::identity() + Axisymmetric::gradient(&grad);
        worst = worst.max((Axisymmetric::jacobian(&grad) - dF.determinant()).abs());
    }
    println!("to {worst:.1e}");
    assert!(worst <= 1e-13);
}
