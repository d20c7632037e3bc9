//! Tests of the complete derivative of the forces against finite differences.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis};
use bsmpm::boundary::{Support, surface};
use bsmpm::grid::Shape;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::material::{Branch, CamClay, Elastic, Law, Material, MohrCoulomb, Separation};
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::quadrature::Quadrature;
use bsmpm::solve::linearised::ForceTangent;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::problem::Problem;
use bsmpm::step::residual::Residual;
use bsmpm::tensor::{Symmetric, Vector};
use rayon::prelude::*;

const METHODS: [Stabilisation; 5] = [
    Stabilisation::None,
    Stabilisation::FBar,
    Stabilisation::ModifiedFBar,
    Stabilisation::ConsistentFBar,
    Stabilisation::SubgridFBar,
];

/// A body of frictional soil on a fixed base, some of it yielding, in a cut-off grid with a background.
fn loaded<K: Kinematics<D>, const D: usize>(method: Stabilisation, regime: Regime) -> Scene<K, D> {
    let soil = MohrCoulomb::new(
        Elastic {
            young: 1000.0,
            poisson: 0.3,
        },
        0.5,
        0.1,
        1.0,
    );
    // Averages over pairs of cells need some inside the body.
    let length = if method == Stabilisation::SubgridFBar { 5 } else { 2 };
    let axes = std::array::from_fn(|k| axis(1.0, if k == 0 { length + 1 } else { 2 }, 2));
    let mut scene = Scene::<K, D>::new(axes, Material::MohrCoulomb(soil), regime).stabilised(method);
    let cells = std::array::from_fn(|k| 0..if k == 0 { length } else { 2 });
    scene = scene
        .body(cells, 2, 1.0, |_| Vector::zeros())
        .support(Support::fixed(D - 1, false));
    scene.model.artificial_stiffness = Some(ArtificialStiffness { coefficient: 1e-3 });
    let mut random = Random::new(3);
    scene = scene.scattered(&mut random);
    scene.points.sort_by_cell(&scene.model.grid);
    scene
}

/// Largest distance between K v and the central difference of the forces, over the largest force; points that yield.
fn product_error<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>) -> (f64, usize) {
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 0.01);
    let pieces = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let mut random = Random::new(11);
    let mut free = |size: f64| -> Vec<f64> {
        let values = random.array(nodes.constraints.free.len());
        values
            .iter()
            .zip(&nodes.constraints.free)
            .map(|(value, &free)| if free { size * value } else { 0.0 })
            .collect()
    };
    let u = free(0.01);
    let v = free(1.0);
    let residual = Residual::of(&pieces, &u);
    assert!(residual.balance.is_sound());
    let yielding = (0..points.len()).filter(|&p| {
        residual
            .trial
            .respond(model, points, p)
            .is_ok_and(|response| response.plastic_increment() > 0.0)
    });
    let mut product = vec![0.0; u.len()];
    ForceTangent::at(&pieces, &residual).multiply(&v, &mut product);
    let step = 1e-7;
    let force = |by: f64| {
        let u: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u + by * v).collect();
        Residual::of(&pieces, &u).balance.f_oob
    };
    let after = force(step);
    let before = force(-step);
    let size = product.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
    let error = |c: usize| (product[c] + (after[c] - before[c]) / (2.0 * step)).abs() / size;
    ((0..u.len()).map(error).fold(0.0, f64::max), yielding.count())
}

#[test]
fn the_product_is_the_derivative_of_the_forces() {
    for method in METHODS {
        for regime in [Regime::QuasiStatic, Regime::Dynamic] {
            let plane = loaded::<PlaneStrain, 2>(method, regime);
            let solid = loaded::<Solid, 3>(method, regime);
            let axisymmetric = loaded::<Axisymmetric, 2>(method, regime);
            let found = [
                (product_error(&plane), plane.points.len()),
                (product_error(&axisymmetric), axisymmetric.points.len()),
                (product_error(&solid), solid.points.len()),
            ];
            println!("{method:?}, {regime:?}: {found:?}");
            for ((error, yielding), points) in found {
                assert!(error <= 1e-6, "{error:e}"); // central differences; measured figures are printed
                assert!(
                    yielding > 0 && yielding < points,
                    "both responses are seen: {yielding} of {points}"
                );
            }
        }
    }
}

/// Damped soil whose elasticity is linear, and some whose is not, after a step that smoothed it.
#[test]
fn the_viscous_stress_is_in_the_product() {
    let clay = CamClay::new(
        Elastic {
            young: 1000.0,
            poisson: 0.3,
        },
        [0.03, 0.15, 1.1, 52.0, 0.0],
    );
    let pressed = (2.0 / 3.0 * clay.strain([-50.0; 3]).iter().sum::<f64>()).exp();
    for clay in [None, Some(Material::CamClay(clay))] {
        let mut scene = loaded::<PlaneStrain, 2>(Stabilisation::ConsistentFBar, Regime::Dynamic);
        if let Some(clay) = clay {
            scene.model.materials = vec![clay.into()];
            scene.points = scene.points.with_state(1);
            scene
                .points
                .state
                .iter_mut()
                .for_each(|state| state.par_rows_mut().for_each(|row| row[0] = 52.0));
            scene.points.b_e.fill(Symmetric::IDENTITY.scaled(pressed));
        }
        let smoothed = |p| Symmetric([1.01, 0.99, 1.0, 0.003, 0.0, 0.0]).scaled(1.0 + 1e-3 * f64::from(p));
        scene.points.smoothing = Some((0..scene.points.len() as u32).map(smoothed).collect());
        scene.model.damping = vec![0.005];
        let (error, yielding) = product_error(&scene);
        println!("{error:e}, {yielding} of {} yield", scene.points.len());
        assert!(
            error <= 1e-6 && yielding > 0 && yielding < scene.points.len(),
            "{error:e}"
        ); // central differences
    }
}

/// Two materials that meet inside cells, each averaged by itself.
#[test]
fn averages_of_two_materials_are_in_the_product() {
    for method in METHODS {
        let stiff = MohrCoulomb::new(
            Elastic {
                young: 1e5,
                poisson: 0.2,
            },
            0.3,
            0.0,
            50.0,
        );
        let scene = loaded::<PlaneStrain, 2>(method, Regime::Dynamic);
        let scene = scene.with(Material::MohrCoulomb(stiff), |x| x[0] > 0.4 + 0.5 * x[1]);
        let (error, _) = product_error(&scene);
        println!("{method:?}: {error:e}");
        assert!(error <= 1e-6, "{method:?}: {error:e}"); // central differences
    }
}

/// Dilatant soil, alone and beside some whose force is not the adjoint of its stress.
#[test]
fn adjoint_forces_are_in_the_product() {
    let dilatant = MohrCoulomb::new(
        Elastic {
            young: 1000.0,
            poisson: 0.3,
        },
        0.5,
        0.4,
        1.0,
    );
    for regime in [Regime::QuasiStatic, Regime::Dynamic] {
        let dilatant = Material::MohrCoulomb(dilatant.clone());
        let mut plane = loaded::<PlaneStrain, 2>(Stabilisation::ConsistentFBar, regime);
        let two = plane.clone().with(dilatant.clone(), |x| x[0] > 0.4 + 0.5 * x[1]);
        plane.model.materials = vec![dilatant.clone().into()];
        let mut solid = loaded::<Solid, 3>(Stabilisation::ConsistentFBar, regime);
        solid.model.materials = vec![dilatant.into()];
        let errors = [product_error(&plane).0, product_error(&two).0, product_error(&solid).0];
        println!("{regime:?}: {errors:?}");
        assert!(errors.iter().all(|&error| error <= 1e-6), "{errors:?}"); // central differences
    }
}

/// Volumes that are fitted, also under an adjoint force, whose pressure they weigh.
#[test]
fn fitted_volumes_are_in_the_product() {
    let dilatant = MohrCoulomb::new(
        Elastic {
            young: 1000.0,
            poisson: 0.3,
        },
        0.5,
        0.4,
        1.0,
    );
    for method in METHODS {
        // In the corner of held faces there is a function inside the body.
        let mut plane = loaded::<PlaneStrain, 2>(method, Regime::QuasiStatic)
            .support(Support::roller(0, false))
            .fitted();
        let mut solid = loaded::<Solid, 3>(method, Regime::QuasiStatic).fitted();
        solid = solid
            .support(Support::roller(0, false))
            .support(Support::roller(1, false));
        let mut errors = vec![product_error(&plane).0, product_error(&solid).0];
        plane.model.materials = vec![Material::MohrCoulomb(dilatant.clone()).into()];
        errors.push(product_error(&plane).0);
        println!("{method:?}: {errors:?}");
        assert!(errors.iter().all(|&error| error <= 1e-6), "{method:?}: {errors:?}"); // central differences
        plane.model.quadrature = Quadrature::Points;
        assert_ne!(product_error(&plane).0, errors[2], "the volumes are seen");
    }
}

#[test]
fn strips_are_in_the_product() {
    let scene = loaded::<PlaneStrain, 2>(Stabilisation::FBar, Regime::QuasiStatic);
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &[0.2, 1.9].into(), &[1.4, 1.9].into(), 3);
    let path = Path {
        rows: vec![(1.0, [0.0, -0.1].into())],
    };
    let with = scene.clone().strip(Strip {
        contact: None,
        points,
        normal: Some([0.0, 1.0].into()),
        transitions: Default::default(),
        path,
        penalty: 1e4,
    });
    let [(free, _), (held, _)] = [&scene, &with].map(product_error);
    assert!(free <= 1e-6 && held <= 1e-6, "{free:e} {held:e}");
}

/// Sand with gaps, some of it closing so far that it resists again.
#[test]
fn what_opens_is_in_the_product() {
    let sand = MohrCoulomb::new(
        Elastic {
            young: 1000.0,
            poisson: 0.3,
        },
        0.5,
        0.0,
        0.0,
    );
    for method in METHODS {
        let mut scene = loaded::<PlaneStrain, 2>(method, Regime::Dynamic);
        scene.model.materials = vec![Material::MohrCoulomb(sand.clone().separating(Separation::Closing)).into()];
        let mut random = Random::new(5);
        scene.points.gap = Some((0..scene.points.len()).map(|_| 0.02 * random.unit()).collect());
        let response = |p: usize, b_e: &Symmetric| scene.model.respond(&scene.points, p, b_e).unwrap();
        let opened = |p: usize, gap: f64| response(p, &scene.points.b_e.at(p).scaled((2.0 / 3.0 * gap).exp()));
        let gaps = scene.points.gap.as_ref().unwrap();
        let open = (0..gaps.len())
            .filter(|&p| opened(p, gaps[p]).branch() == Branch::Apex)
            .count();
        assert!(open > 0 && open < gaps.len(), "{open} of {}", gaps.len());
        let (error, _) = product_error(&scene);
        println!("{method:?}: {error:e}");
        assert!(error <= 1e-6, "{method:?}: {error:e}"); // central differences
        let forgotten = Scene {
            model: scene.model.clone(),
            points: Points {
                gap: None,
                ..scene.points.clone()
            },
            state: scene.state.clone(),
        };
        assert_ne!(product_error(&forgotten).0, error, "the gap is seen");
    }
}

/// Sand, or stiff clay far from yield, strained by about `size`: what is left of the force of a small step v, as large
/// as the strain, once the product is taken off, |f(u + s v) - f(u) + s K v| / |s K v| for s = 0.02 and 0.01; and how
/// many points change their region in it.
fn curvature(cohesion: f64, size: f64) -> ([f64; 2], usize) {
    let mut scene = loaded::<PlaneStrain, 2>(Stabilisation::FBar, Regime::QuasiStatic);
    let law = MohrCoulomb::new(
        Elastic {
            young: 1000.0,
            poisson: 0.3,
        },
        0.5,
        0.0,
        cohesion,
    );
    (scene.model.materials, scene.model.artificial_stiffness) = (vec![Material::MohrCoulomb(law).into()], None);
    let mut random = Random::new(7);
    for p in 0..scene.points.len() {
        let [xx, yy, zz, xy] = [6.0, -12.0, -3.0, 0.0].map(|mean| size * (mean + random.signed()));
        scene
            .points
            .b_e
            .set(p, Symmetric([1.0 + xx, 1.0 + yy, 1.0 + zz, xy, 0.0, 0.0]));
    }
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 0.01);
    let pieces = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let mut free = || -> Vec<f64> {
        nodes
            .constraints
            .free
            .iter()
            .map(|&free| if free { size * random.signed() } else { 0.0 })
            .collect()
    };
    let u = free();
    let v = free();
    let at = |s: f64| Residual::of(&pieces, &u.iter().zip(&v).map(|(u, v)| u + s * v).collect::<Vec<_>>());
    let regions = |residual: &Residual<PlaneStrain, 2>| -> Vec<Branch> {
        (0..points.len())
            .map(|p| residual.trial.respond(model, points, p).unwrap().branch())
            .collect()
    };
    let start = at(0.0);
    let mut product = vec![0.0; u.len()];
    ForceTangent::at(&pieces, &start).multiply(&v, &mut product);
    let norm = |force: &mut dyn Iterator<Item = f64>| force.map(|f| f * f).sum::<f64>().sqrt();
    let left = [0.02, 0.01].map(|s| {
        let after = at(s).balance.f_oob;
        let rest = |c: usize| after[c] - start.balance.f_oob[c] + s * product[c];
        norm(&mut (0..u.len()).map(rest)) / (s * norm(&mut product.iter().copied()))
    });
    let changed = regions(&start)
        .iter()
        .zip(regions(&at(0.02)))
        .filter(|(before, after)| **before != *after)
        .count();
    (left, changed)
}

/// Why Newton's method is slow where sand is next to stress-free: the law without cohesion scales with its strain, so
/// that its curvature goes with the inverse, and a step must be small against the strain itself.
#[test]
fn the_curvature_of_sand_grows_as_its_stress_falls() {
    let [sand, clay] = [0.0, 1e3].map(|cohesion| {
        [1e-3, 1e-5].map(|size| {
            let (left, changed) = curvature(cohesion, size);
            println!("c = {cohesion}, strain {size:e}: left {left:?}, {changed} points change their region");
            assert_eq!(changed, 0, "no kink is crossed");
            assert!((left[0] / left[1] - 2.0).abs() <= 0.05, "what is left falls with s^2"); // measured 0.014 at most
            left[0]
        })
    });
    // In strains of its own size sand is as curved at any stress; stiff clay has the curvature of the geometry alone.
    assert!((sand[0] / sand[1] - 1.0).abs() <= 0.03, "{sand:?}"); // measured 0.002
    assert!((clay[0] / clay[1] / 100.0 - 1.0).abs() <= 0.03, "{clay:?}"); // measured 0.0006
    assert!(sand[1] >= 1e3 * clay[1]); // measured 4.0e3
}
