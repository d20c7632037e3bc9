//! Tests that the stress is continuous between regions of the return mapping, by bisection between trial states.

use super::{REGIONS, largest, mohr_coulomb, respond, stretched};
use crate::random::Random;
use bsmpm::material::{Branch, Material};

fn at(material: &Material, from: [f64; 3], to: [f64; 3], s: f64) -> (Branch, [f64; 3]) {
    let eps = [0, 1, 2].map(|i| from[i] + s * (to[i] - from[i]));
    let found = respond(material, &stretched(eps));
    (found.branch(), found.principal_tau())
}

/// The regions on both sides of a boundary on the segment, and the jump of stress across it.
fn jump(material: &Material, from: [f64; 3], to: [f64; 3]) -> Option<(Branch, Branch, f64)> {
    let mut low = 0.0;
    let mut high = 1.0;
    let start = at(material, from, to, low).0;
    if at(material, from, to, high).0 == start {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at(material, from, to, middle).0 == start {
            low = middle
        } else {
            high = middle
        }
    }
    let (a, tau) = at(material, from, to, low);
    let (b, other) = at(material, from, to, high);
    Some((
        a,
        b,
        largest(&[tau[0] - other[0], tau[1] - other[1], tau[2] - other[2]]),
    ))
}

/// Bisection between trial states in different regions of the yield surface.
#[test]
fn stress_is_continuous_where_regions_meet() {
    let mut random = Random::new(20);
    let mut met = [[0; 5]; 5];
    let mut worst = 0.0_f64;
    for _ in 0..60_000 {
        let friction = random.pick(&[0.0, 5.0, 20.0, 45.0, 60.0]);
        let dilation = friction * random.pick(&[0.0, 0.5, 1.0]);
        let poisson = random.pick(&[0.0, 0.3, 0.45]);
        let material = mohr_coulomb(1e3, poisson, friction, dilation, random.pick(&[0.0, 1.0]));
        let from = random.strains(-3.0, -1.5);
        let to = random.strains(-3.0, -1.5);
        if let Some((a, b, jump)) = jump(&material, from, to) {
            let index = |r: Branch| REGIONS.iter().position(|x| *x == r).unwrap();
            met[index(a)][index(b)] += 1;
            worst = worst.max(jump / 1e3);
        }
    }
    println!("largest jump {worst:.2e} of E; boundaries met {met:?}");
    assert!(worst <= 1e-13, "{worst:e}");
    // Elastic-face, face-left, face-right, left-apex, right-apex, in either direction.
    for (i, j) in [(0, 1), (1, 2), (1, 3), (2, 4), (3, 4)] {
        assert!(met[i][j] + met[j][i] > 50, "{i}-{j}: {met:?}");
    }
}
