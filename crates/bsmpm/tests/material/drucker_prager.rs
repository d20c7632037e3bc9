//! Tests of Drucker-Prager: comparison with Mohr-Coulomb, yield, flow rule and tangent.

use super::{largest, mohr_coulomb, respond, stretched, turned};
use crate::random::Random;
use bsmpm::material::{Branch, DruckerPrager, Elastic, Law, Match, Material, split};
use bsmpm::tensor::{Symmetric, Tensor};

const FITS: [Match; 3] = [Match::Outer, Match::Inner, Match::PlaneStrain];
const COHESION: f64 = 1.0;

fn law(poisson: f64, friction: f64, dilation: f64, fit: Match) -> DruckerPrager {
    let elastic = Elastic { young: 1e3, poisson };
    DruckerPrager::new(elastic, friction.to_radians(), dilation.to_radians(), COHESION, fit)
}

/// √J₂ and mean stress.
fn invariants(tau: [f64; 3]) -> (f64, f64) {
    let (mean, _, norm) = split(tau);
    (norm / 2_f64.sqrt(), mean)
}

/// Closed form: the yield function and the flow rule of Drucker and Prager (1952).
#[test]
fn returns_lie_on_the_cone_or_its_tip_and_flow_along_the_potential() {
    let mut random = Random::new(80);
    let mut cones = 0;
    let mut tips = 0;
    for _ in 0..30_000 {
        let friction = random.pick(&[0.0, 1e-9, 20.0, 45.0, 80.0]);
        let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
        let law = law(
            random.pick(&[-0.5, 0.0, 0.3, 0.49]),
            friction,
            dilation,
            random.pick(&FITS),
        );
        let (eta, strength) = law.cone();
        let material = Material::DruckerPrager(law);
        let found = respond(&material, &random.trial(-4.0, -0.7));
        let (root, p) = invariants(found.principal_tau());
        let size = strength.max(eta * p.abs()).max(root);
        match found.branch() {
            Branch::Elastic => assert!(root + eta * p <= strength + 1e-13 * size),
            Branch::Face => {
                cones += 1;
                assert!((root + eta * p - strength).abs() <= 1e-11 * size, "{root} {p}");
            }
            region => {
                tips += 1;
                assert!(region == Branch::Apex && root <= 1e-15 * size, "{root}");
                assert!((eta * p - strength).abs() <= 1e-12 * size);
            }
        }
        let again = respond(&material, &found.b_e()).principal_tau();
        assert!((0..3).all(|k| (again[k] - found.principal_tau()[k]).abs() <= 1e-9 * size.max(1.0)));
        if found.branch() == Branch::Face {
            // Volume over shear of the flow is that of the potential: tr εᵖ = η_ψ Δγ, |dev εᵖ| = Δγ/√2.
            let trial = found.principal_eps_trial();
            let elastic = found.principal_eps_e();
            let (mean, _, norm) = split(std::array::from_fn(|k| trial[k] - elastic[k]));
            let Material::DruckerPrager(law) = &material else {
                unreachable!()
            };
            let dilating = DruckerPrager::new(law.elastic().clone(), law.dilation(), 0.0, COHESION, law.fit())
                .cone()
                .0;
            assert!((3.0 * mean - dilating * 2_f64.sqrt() * norm).abs() <= 1e-11 * largest(&trial));
        }
    }
    assert!(cones > 5_000 && tips > 500, "{cones} {tips}");
}

/// The cone passes through the edges of triaxial compression (outer) and extension (inner) of the pyramid with the same
/// strength; where flow goes on in plane strain it has the part of the pyramid's that it reports.
#[test]
fn the_cone_meets_the_pyramid_where_it_is_said_to() {
    let friction = 30_f64;
    let compression = [-0.001, -0.001, -0.2];
    let extension = [0.0, -0.2, -0.2];
    for (fit, eps) in [(Match::Outer, compression), (Match::Inner, extension)] {
        let cone = Material::DruckerPrager(law(0.3, friction, 0.0, fit));
        let pyramid = mohr_coulomb(1e3, 0.3, friction, 0.0, COHESION);
        let [a, b] = [cone, pyramid].map(|material| respond(&material, &stretched(eps)).principal_tau());
        assert!(
            (0..3).all(|k| (a[k] - b[k]).abs() <= 1e-11 * largest(&b)),
            "{a:?} {b:?}"
        );
    }
    for (fit, dilation) in [
        (Match::PlaneStrain, friction),
        (Match::PlaneStrain, 0.0),
        (Match::Inner, 10.0),
    ] {
        let law = law(0.3, friction, dilation, fit);
        let expected = law.strength_in_plane_strain();
        let (radius, mean) = sheared_in_the_plane(&Material::DruckerPrager(law));
        let (sin, cos) = friction.to_radians().sin_cos();
        let found = radius / (COHESION * cos - mean * sin);
        assert!(
            (found / expected - 1.0).abs() <= 2e-3,
            "{fit:?} {dilation}: {found} for {expected}"
        );
    }
    assert!((law(0.3, 30.0, 30.0, Match::PlaneStrain).strength_in_plane_strain() - 1.0).abs() < 1e-14);
    let weaker = 1.0 / (1.0 + 0.25_f64 / 3.0).sqrt();
    assert!((law(0.3, 30.0, 0.0, Match::PlaneStrain).strength_in_plane_strain() - weaker).abs() < 1e-14);
}

/// Radius of Mohr's circle and mean stress in the plane, sheared under a constant one until nothing changes.
fn sheared_in_the_plane(cone: &Material) -> (f64, f64) {
    let mut b_e = stretched([0.0; 3]);
    let mut tau = [0.0; 3];
    let mean_of = |tau: [f64; 3], z: f64| (tau[0] + tau[1] + tau[2] - z) / 2.0;
    for _ in 0..400 {
        let trial = |volume: f64| {
            let x = (2e-3 + volume).exp();
            let y = (-2e-3 + volume).exp();
            respond(cone, &Symmetric([b_e.0[0] * x, b_e.0[1] * y, b_e.0[2], 0.0, 0.0, 0.0]))
        };
        let mut low = -0.1;
        let mut high = 0.1;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let found = trial(0.5 * (low + high));
            let lower = mean_of(found.principal_tau(), found.tau().0[2]) < -100.0;
            if lower { low = middle } else { high = middle }
        }
        let found = trial(low);
        (b_e, tau) = (found.b_e(), found.tau().0[..3].try_into().expect("three"));
    }
    ((tau[0] - tau[1]) / 2.0, (tau[0] + tau[1]) / 2.0)
}

/// Reference: central differences of fourth order.
#[test]
fn tangent_is_the_derivative_on_cone_and_tip() {
    let mut random = Random::new(81);
    let mut worst = 0.0_f64;
    let mut seen = [0, 0];
    for trial in 0..40_000 {
        let friction = random.pick(&[0.0, 20.0, 45.0]);
        let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
        let material = Material::DruckerPrager(law(
            random.pick(&[0.0, 0.3, 0.49]),
            friction,
            dilation,
            random.pick(&FITS),
        ));
        let eps = random.strains(-2.5, -0.7);
        let eps = if trial % 4 == 0 { [eps[0], eps[0], eps[2]] } else { eps };
        let rotation = random.rotation();
        let l = Tensor::from_fn(|_, _| random.signed());
        let b = turned(&rotation, &stretched(eps));
        let found = respond(&material, &b);
        let around = [-2.0, -1.0, 1.0, 2.0]
            .map(|steps| respond(&material, &turned(&(Tensor::identity() + l * (steps * 1e-6)), &b)));
        if around.iter().any(|moved| moved.branch() != found.branch()) {
            continue;
        }
        let [a, b, c, d] = around.map(|moved| moved.tau().full());
        let difference = (a - d + (c - b) * 8.0) / 12e-6;
        let size = found.linearise(&l).amax().max(1e3);
        worst = worst.max((difference - found.linearise(&l)).amax() / size);
        seen[0] += usize::from(found.branch() == Branch::Face);
        seen[1] += usize::from(found.branch() == Branch::Apex);
    }
    println!("{seen:?} on cone and tip, error {worst:.1e}");
    assert!(seen[0] > 5_000 && seen[1] > 500 && worst < 1e-6, "{seen:?} {worst}");
}

#[test]
fn reduction_is_mohr_coulombs() {
    let whole = law(0.3, 30.0, 30.0, Match::Inner);
    let reduced = whole.clone().reduced(1.5);
    let friction = (30_f64.to_radians().tan() / 1.5).atan();
    assert_eq!(reduced.parameters(), [friction, friction, COHESION / 1.5]);
    assert_eq!(whole.clone().reduced(1.0), whole);
}
