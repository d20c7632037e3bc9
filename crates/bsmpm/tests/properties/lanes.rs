//! Tests that a step gives bitwise identical results with vector instructions (SIMD) and point by point.

use crate::support::random::Random;
use crate::support::scene::{METHODS, Scene, axis};
use bsmpm::grid::Shape;
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::lanes::{self, InLanes, LANES, Simd};
use bsmpm::material::{Elastic, Material, MohrCoulomb, VonMises};
use bsmpm::model::{Model, Regime};
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::trial::DeformationIncrement;
use bsmpm::tensor::Vector;
use std::ops::Range;

/// dF and the stress of consecutive points; none of those that are left to one at a time.
struct Stresses<'a, K: Kinematics<D>, const D: usize> {
    model: &'a Model<K, D>,
    points: &'a Points<D>,
    trial: &'a DeformationIncrement<K, D>,
    range: Range<usize>,
}

impl<K: Kinematics<D>, const D: usize> InLanes for Stresses<'_, K, D> {
    type Output = Vec<(usize, [u64; 9], [u64; 6])>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let mut found = Vec::new();
        for eight in lanes::eights(self.range) {
            let Some((dF, tau)) = self.trial.respond_in_lanes(self.model, self.points, simd, eight) else {
                continue;
            };
            for (lane, p) in eight.points().enumerate() {
                let dF = std::array::from_fn(|k| dF[(k % 3, k / 3)].numbers()[lane].to_bits());
                found.push((p, dF, tau.0.map(|component| component.numbers()[lane].to_bits())));
            }
        }
        found
    }
}

/// Clay that hardens beside sand, deformed at random, one point turned inside out; compares all points that lanes
/// answer for and returns how many these are.
fn compared<K: Kinematics<D>, const D: usize>(method: Stabilisation, seed: u64) -> usize {
    let elastic = Elastic {
        young: 1e4,
        poisson: 0.3,
    };
    let clay = Material::VonMises(VonMises::new(elastic.clone(), 20.0, 300.0));
    let sand = Material::MohrCoulomb(MohrCoulomb::new(elastic, 0.6, 0.1, 1.0));
    let mut random = Random::new(seed);
    let mut scene = Scene::<K, D>::new([(); D].map(|()| axis(0.5, 4, 2)), clay, Regime::QuasiStatic)
        .body([(); D].map(|()| 0..3), 3, 1.0, |_| Vector::zeros())
        .with(sand, |x| x[0] > 0.8)
        .stabilised(method);
    let points = &mut scene.points;
    *points = std::mem::take(points).with_state(1);
    for p in 0..points.len() {
        points.state.as_mut().expect("of clay").of_point_mut(p)[0] = random.unit();
        let mut b_e = points.b_e.at(p);
        b_e.0[..4]
            .iter_mut()
            .for_each(|component| *component += 0.01 * random.signed());
        points.b_e.set(p, b_e);
    }
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).expect("points in the grid");
    let nodes = scene.nodes(&shape, 1.0);
    let mut u: Vec<f64> = (0..model.grid.nodes() * D).map(|_| 2e-3 * random.signed()).collect();
    u[0] = 3.0; // the points of the first cell
    let trial = DeformationIncrement::of(model, &shape, &nodes, points, &u, &halo);
    let mut count = 0;
    for first in [0, 1, 5] {
        for length in [1, 7, LANES, LANES + 1, points.len() - first] {
            let found = lanes::run(Stresses {
                model,
                points,
                trial: &trial,
                range: first..first + length,
            });
            count += found.len();
            for (p, dF, tau) in found {
                let expected = trial
                    .respond(model, points, p)
                    .expect("no lane answers for what is no strain");
                assert_eq!(
                    dF,
                    std::array::from_fn(|k| trial.dF(p).as_slice()[k].to_bits()),
                    "dF of point {p}"
                );
                assert_eq!(
                    tau,
                    expected.tau().0.map(f64::to_bits),
                    "{method:?}: stress of point {p}"
                );
            }
        }
    }
    count
}

#[test]
fn points_that_are_alike_have_their_own_bits_and_others_are_left() {
    for (method, seed) in METHODS.into_iter().zip(1..) {
        let counts = [
            compared::<PlaneStrain, 2>(method, seed),
            compared::<Axisymmetric, 2>(method, seed),
            compared::<Solid, 3>(method, seed),
        ];
        assert!(counts.iter().all(|&count| count > 60), "{method:?}: {counts:?}");
    }
}
