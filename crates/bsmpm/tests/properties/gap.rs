//! Tests that the volume of Mohr-Coulomb soil is elastic strain plus gap (separation at the apex): `ln J = tr εᵉ +
//! gap`.

use crate::support::scene::{Scene, axis};
use bsmpm::boundary::Support;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Elastic, Material, MohrCoulomb, Separation};
use bsmpm::model::Regime;
use bsmpm::points::Points;

/// Sand between smooth walls, thrown up the faster the higher it lies: it comes apart and falls back.
fn thrown(separation: Separation) -> Scene<PlaneStrain, 2> {
    let sand = MohrCoulomb::new(
        Elastic {
            young: 1e5,
            poisson: 0.3,
        },
        0.5,
        0.0,
        0.0,
    )
    .separating(separation);
    Scene::new(
        [axis(0.25, 4, 2), axis(0.25, 8, 2)],
        Material::MohrCoulomb(sand),
        Regime::Dynamic,
    )
    .body([0..4, 0..4], 2, 2000.0, |x| [0.0, x[1]].into())
    .rollers([0])
    .support(Support::roller(1, false))
    .gravity(10.0, 0.0)
}

/// `ln J - tr εᵉ - gap`, the volume that is forgotten.
fn forgotten(points: &Points<2>, p: usize) -> f64 {
    let elastic = 0.5 * points.b_e.at(p).full().determinant().ln();
    points.F.at(p).determinant().ln() - elastic - points.gap.as_ref().map_or(0.0, |gap| gap[p])
}

#[test]
fn no_volume_is_forgotten_where_gaps_close() {
    let mut scene = thrown(Separation::Closing);
    let mut worst = 0.0_f64;
    let mut most = 0;
    let mut left = 0;
    scene.march(2e-3, 0.5, |points, _| {
        let gap = points.gap.as_ref().expect("a material closes its gaps");
        assert!((0..points.len()).all(|p| gap[p] >= 0.0 && (gap[p] == 0.0 || points.sigma.at(p).0 == [0.0; 6])));
        worst = (0..points.len())
            .map(|p| forgotten(points, p).abs())
            .fold(worst, f64::max);
        left = gap.iter().filter(|gap| **gap > 1e-3).count();
        most = most.max(left);
    });
    println!(
        "forgotten {worst:e}; {most} of {} points gape, {left} in the end",
        scene.points.len()
    );
    assert!(worst <= 1e-12); // measured 2.3e-15
    assert!(
        most == scene.points.len() && 4 * left <= 3 * most,
        "all comes apart, and much of it closes"
    ); // measured 40 of 64
}

#[test]
fn without_gaps_nothing_is_stored_and_sand_stays_as_loose_as_it_was_thrown() {
    let (scene, _) = thrown(Separation::Forgotten).solved(2e-3, 0.5);
    assert_eq!(scene.points.gap, None);
    let worst = (0..scene.points.len())
        .map(|p| forgotten(&scene.points, p))
        .fold(0.0, f64::max);
    println!("forgotten {worst:e}");
    assert!(worst >= 1e-2);
}
