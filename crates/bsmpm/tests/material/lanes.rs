//! Tests that SIMD and single evaluation of the laws agree bitwise.

use super::{REGIONS, hencky, mohr_coulomb, turned};
use crate::random::Random;
use bsmpm::lanes::{self, InLanes, LANES, Lanes, Simd};
use bsmpm::material::{DruckerPrager, Elastic, Match, Material, VonMises};
use bsmpm::tensor::Symmetric;
use std::array::from_fn;
use std::collections::BTreeMap;

/// Stresses of eight points by components.
#[derive(Clone)]
struct Stresses<'a> {
    material: &'a Material,
    b_trial: &'a [Symmetric; LANES],
    state: [f64; LANES],
}

impl InLanes for Stresses<'_> {
    type Output = Option<[Symmetric; LANES]>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let b_trial: [Lanes<S>; 6] = from_fn(|k| Lanes::from_fn(simd, |lane| self.b_trial[lane].0[k]));
        let state = [Lanes::from_fn(simd, |lane| self.state[lane])];
        let tau = if self.b_trial.iter().any(|b_trial| b_trial.0[4..] != [0.0; 2]) {
            self.material.stress_in_space(b_trial, &state)?
        } else {
            self.material.stress(from_fn(|k| b_trial[k]), &state)?
        };
        let components = tau.0.map(Lanes::numbers);
        Some(from_fn(|lane| Symmetric(from_fn(|k| components[k][lane]))))
    }
}

/// Every law that runs in lanes, with cohesion and without, with friction and without, hardening and not.
fn laws() -> Vec<Material> {
    let elastic = Elastic {
        young: 1e3,
        poisson: 0.3,
    };
    let mut laws = vec![hencky(1e3, 0.3), mohr_coulomb(1e3, 0.45, 0.0, 0.0, 3.0)];
    for cohesion in [0.0, 3.0] {
        laws.push(mohr_coulomb(1e3, 0.3, 35.0, 10.0, cohesion));
        laws.extend(
            [Match::Outer, Match::Inner, Match::PlaneStrain]
                .map(|fit| Material::DruckerPrager(DruckerPrager::new(elastic.clone(), 0.5, 0.2, cohesion, fit))),
        );
    }
    laws.extend([0.0, 40.0].map(|hardening| Material::VonMises(VonMises::new(elastic.clone(), 3.0, hardening))));
    laws
}

/// Points inside and in every region of the yield surface side by side, on axes and turned, and at rest.
#[test]
fn eight_points_have_the_stresses_of_each() {
    compare(false);
}

/// The same with any axes; of a point that has its axis along z all eight are left.
#[test]
fn eight_points_in_space_have_the_stresses_of_each() {
    compare(true);
    let material = hencky(1e3, 0.3);
    let mut b_trial = [Symmetric([1.0, 1.0, 1.0, 0.1, 0.1, 0.0]); LANES];
    assert!(
        lanes::run(Stresses {
            material: &material,
            b_trial: &b_trial,
            state: [0.0; LANES]
        })
        .is_some()
    );
    b_trial[3] = Symmetric([1.0, 1.0, 1.1, 0.1, 0.0, 0.0]);
    assert!(
        lanes::run(Stresses {
            material: &material,
            b_trial: &b_trial,
            state: [0.0; LANES]
        })
        .is_none()
    );
}

fn compare(in_space: bool) {
    const GROUPS: usize = 4_000;
    let mut random = Random::new(90);
    let mut seen = BTreeMap::new();
    for material in laws() {
        let mut computed = 0;
        for _ in 0..GROUPS {
            let b_trial: [Symmetric; LANES] = from_fn(|_| {
                let size = 10_f64.powf(-0.3 - 4.0 * random.unit());
                let turn = random.pick(&[0.0, 1e-9, 1.0]);
                let strain: [f64; 4] = from_fn(|_| size * random.signed());
                let [xx, yy, zz, xy] = random.pick(&[strain, strain, [0.0; 4]]);
                let plane = Symmetric([1.0 + xx, 1.0 + yy, 1.0 + zz, turn * xy, 0.0, 0.0]);
                if !in_space {
                    return plane;
                }
                let plane = if plane == Symmetric::IDENTITY {
                    Symmetric([1.0, 1.0, 1.0, 1e-9, 0.0, 0.0])
                } else {
                    plane
                };
                let mut turns = std::iter::repeat_with(|| turned(&random.rotation(), &plane));
                turns
                    .find(|b_trial| b_trial.0[4..] != [0.0; 2])
                    .expect("without an end")
            });
            let state: [f64; LANES] = from_fn(|_| 0.1 * random.unit());
            for (vectors, found) in lanes::with_each(&Stresses {
                material: &material,
                b_trial: &b_trial,
                state,
            }) {
                let Some(found) = found else { continue };
                computed += 1;
                for ((found, b_trial), state) in found.iter().zip(&b_trial).zip(state) {
                    let response = material.respond(b_trial, &[state]).expect("an admissible trial");
                    let found = found.0.map(f64::to_bits);
                    let expected = response.tau().0.map(f64::to_bits);
                    assert_eq!(found, expected, "{vectors}, {material:?}: {b_trial:?}");
                    *seen.entry(format!("{:?}", response.branch())).or_insert(0) += 1;
                }
            }
        }
        assert!(computed > GROUPS / 2, "{material:?}: {computed} groups were strains");
    }
    assert!(
        REGIONS.iter().all(|region| seen[&format!("{region:?}")] > 1_000),
        "{seen:?}"
    );
}

/// What is no strain is left to one point at a time, which says so.
#[test]
fn a_lane_that_is_no_strain_is_left() {
    let material = mohr_coulomb(1e3, 0.3, 35.0, 10.0, 3.0);
    for odd in [0.0, -1.0, 1e101, f64::NAN, f64::INFINITY] {
        let mut b_trial = [Symmetric::IDENTITY; LANES];
        assert!(
            lanes::run(Stresses {
                material: &material,
                b_trial: &b_trial,
                state: [0.0; LANES]
            })
            .is_some()
        );
        b_trial[5].0[1] = odd;
        assert!(
            lanes::run(Stresses {
                material: &material,
                b_trial: &b_trial,
                state: [0.0; LANES]
            })
            .is_none(),
            "{odd}"
        );
    }
}
