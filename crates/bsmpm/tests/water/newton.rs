//! Tests of Newton's method with coupled flow: derivative, quadratic convergence, and steps for which quasi-Newton
//! fails.

use super::{DENSITY, Plane, at, flowing};
use crate::support::random::Random;
use crate::support::scene::{Scene, axis};
use crate::support::solver::Skyline;
use bsmpm::boundary::{Support, SurfacePoint};
use bsmpm::error::StepError;
use bsmpm::field::pore_water::Water;
use bsmpm::field::pore_water::ambient::Ambient;
use bsmpm::field::pore_water::flow::{
    Course, Drain, DrainedFace, Flow, Given, Inflow, Motion, Permeability, PermeabilityLaw, Soil,
};
use bsmpm::field::pore_water::retention::Retention;
use bsmpm::grid::Shape;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::artificial_stiffness::ResistedDisplacement;
use bsmpm::interactions::load::Load;
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::method::{Criteria, Method, Nonlinear, QuasiNewton};
use bsmpm::model::Regime;
use bsmpm::observe::{Part, largest_displacement};
use bsmpm::schedule::TimeInterval;
use bsmpm::solve::Backend;
use bsmpm::solve::linearised::ForceTangent;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::problem::Problem;
use bsmpm::step::residual::Residual;
use bsmpm::step::{Counts, StepReport, step};
use bsmpm::tensor::Vector;

/// Soil of which some yields, with water that flows, a drain, a seepage face and rain that runs off.
fn wet<K: Kinematics<D>, const D: usize>(
    method: Stabilisation,
    regime: Regime,
    dilation: f64,
    retention: Option<Retention>,
) -> Scene<K, D> {
    let soil = MohrCoulomb::new(
        Elastic {
            young: 1000.0,
            poisson: 0.3,
        },
        0.5,
        dilation,
        1.0,
    );
    let axes = std::array::from_fn(|k| axis(1.0, if k == 0 { 3 } else { 2 }, 2));
    let mut scene = Scene::<K, D>::new(axes, Material::MohrCoulomb(soil), regime).stabilised(method);
    scene = scene
        .body([const { 0..2 }; D], 3, 1.0, |_| Vector::zeros())
        .support(Support::fixed(D - 1, false));
    scene = scene.gravity(10.0, 0.0);
    scene.model.artificial_stiffness = Some(ArtificialStiffness { coefficient: 1e-3 });
    // None of these points is so near to saturation that its permeability has a bounded slope in the derivative.
    let mut random = Random::new(5);
    scene = scene.scattered(&mut random);
    scene.points.pore_pressure = Some((0..scene.points.len()).map(|_| 20.0 * random.signed()).collect());
    scene.points.sort_by_cell(&scene.model.grid);
    let side = |height: f64| {
        let mut x = Vector::<D>::from_element(0.7);
        (x[0], x[D - 1]) = (1.9, height);
        vec![SurfacePoint::at(x, 0.5)]
    };
    let normals = vec![Vector::<D>::from_fn(|k, _| f64::from(u8::from(k == 0)))];
    let permeability = Permeability {
        along: Vector::from_fn(|k, _| 0.02 * (k + 1) as f64),
        law: PermeabilityLaw::KozenyCarman,
    };
    let soil = Soil {
        porosity: 0.4,
        permeability: Some(permeability),
        retention,
    };
    let drain = |height: f64, given: Given| Drain {
        points: side(height),
        normals: normals.clone(),
        given,
        acts: true,
    };
    let rate = Course(vec![(0.0, 0.3)]);
    let inflow = Inflow {
        points: side(1.3),
        normals: normals.clone(),
        rate,
        runs_off: true,
        acts: true,
    };
    let flow = Flow {
        bulk: 3000.0,
        soils: vec![Some(soil)],
        drains: vec![
            drain(0.3, Given::StillWater),
            drain(0.8, Given::Seepage),
            drain(1.8, Given::Seepage),
        ],
        faces: vec![DrainedFace {
            axis: 0,
            upper: false,
            given: Given::Pressure(Course(vec![(0.0, 5.0)])),
            acts: true,
        }],
        inflows: vec![inflow],
        suction: 0.0,
        motion: Motion::Flows,
    };
    scene.model.water = Some(Water {
        unit_weight: 10.0,
        ambient: Ambient::Level(vec![(0.0, 0.9)]),
        flow: Some(flow),
    });
    scene
}

/// Largest distances between the product and the central difference of the forces and of the water's balance, each over
/// the largest of its kind, about a mean excess pressure, Pa, under which all outlets are open or closed; points that
/// yield, and all.
fn product_errors<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>, mean: f64) -> ([f64; 2], [usize; 2]) {
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 0.1);
    let pieces = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let pores = nodes.field.as_ref().expect("water flows");
    let mut random = Random::new(11);
    let mut free = |(length, pressure): (f64, f64)| -> Vec<f64> {
        let all = nodes
            .constraints
            .free
            .iter()
            .map(|free| (free, length))
            .chain(pores.free.iter().map(|free| (free, pressure)));
        all.map(|(free, size)| if *free { size * random.signed() } else { 0.0 })
            .collect()
    };
    let mut x = free((0.01, 10.0));
    let v = free((1.0, 1e3));
    for (x, free) in x[nodes.constraints.free.len()..].iter_mut().zip(&pores.free) {
        *x += if *free { mean } else { 0.0 };
    }
    for (at, given) in pores.prescribed.iter().enumerate() {
        x[nodes.constraints.free.len() + at] += given.unwrap_or(0.0);
    }
    let open = pores.drainage.open(&x[nodes.constraints.free.len()..]);
    assert!(
        !open.is_empty() && open.iter().all(|open| *open == (mean > 0.0)),
        "{open:?} under {mean} Pa"
    );
    let residual = Residual::of(&pieces, &x);
    assert!(residual.balance.is_sound());
    let yielding = (0..points.len()).filter(|&p| {
        residual
            .trial
            .respond(model, points, p)
            .is_ok_and(|response| response.plastic_increment() > 0.0)
    });
    let mut product = vec![0.0; x.len()];
    ForceTangent::at(&pieces, &residual)
        .with_field(&x)
        .multiply(&v, &mut product);
    let step = 1e-7;
    let lacking = |by: f64| -> Vec<f64> {
        let x: Vec<f64> = x.iter().zip(&v).map(|(x, v)| x + by * v).collect();
        let balance = Residual::of(&pieces, &x).balance;
        balance
            .f_oob
            .iter()
            .copied()
            .chain(balance.field.iter().flat_map(|water| water.excess.iter().map(|R| -R)))
            .collect()
    };
    let after = lacking(step);
    let before = lacking(-step);
    let errors = [0..nodes.constraints.free.len(), nodes.constraints.free.len()..x.len()].map(|range| {
        let size = product[range.clone()]
            .iter()
            .fold(0.0_f64, |size, value| size.max(value.abs()));
        assert!(size > 0.0);
        range
            .map(|c| (product[c] + (after[c] - before[c]) / (2.0 * step)).abs() / size)
            .fold(0.0, f64::max)
    });
    (errors, [yielding.count(), points.len()])
}

/// Reference: finite differences of both balances.
#[test]
fn the_product_is_the_derivative_of_both_balances() {
    let loam = Retention::van_genuchten(0.3, 1.6, 0.1);
    for method in [Stabilisation::None, Stabilisation::ConsistentFBar] {
        for regime in [Regime::QuasiStatic, Regime::Dynamic] {
            for (dilation, retention) in [(0.0, None), (0.3, None), (0.1, Some(&loam))] {
                let found = [-30.0, 30.0].map(|mean| {
                    [
                        product_errors(
                            &wet::<PlaneStrain, 2>(method, regime, dilation, retention.cloned()),
                            mean,
                        ),
                        product_errors(
                            &wet::<Axisymmetric, 2>(method, regime, dilation, retention.cloned()),
                            mean,
                        ),
                        product_errors(&wet::<Solid, 3>(method, regime, dilation, retention.cloned()), mean),
                    ]
                });
                println!("{method:?}, {regime:?}, {dilation}, {}: {found:?}", retention.is_some());
                for (errors, [yielding, points]) in found.into_iter().flatten() {
                    assert!(errors.iter().all(|error| *error < 1e-6), "{errors:?}"); // central differences
                    assert!(
                        yielding > 0 && yielding < points,
                        "both responses are seen: {yielding} of {points}"
                    );
                }
            }
        }
    }
}

/// Clay under a load on the left half of its surface that grows to `load`, Pa, in 1 s; drained on top.
fn loaded(nonlinear: Nonlinear, method: Stabilisation, load: f64, law: PermeabilityLaw) -> Plane {
    let clay = MohrCoulomb::new(
        Elastic {
            young: 1e6,
            poisson: 0.3,
        },
        25_f64.to_radians(),
        0.0,
        2e3,
    );
    let mut scene = Plane::new(
        [axis(0.5, 6, 2), axis(0.5, 4, 2)],
        Material::MohrCoulomb(clay),
        Regime::QuasiStatic,
    )
    .body([0..6, 0..4], 3, DENSITY, |x| x * 0.0)
    .rollers(0..1)
    .support(Support::fixed(1, false))
    .stabilised(method);
    let mut water = flowing(law);
    let flow = water.flow.as_mut().expect("it flows");
    flow.faces.push(DrainedFace {
        axis: 1,
        upper: true,
        given: Given::StillWater,
        acts: true,
    });
    flow.soils[0]
        .as_mut()
        .and_then(|soil| soil.permeability.as_mut())
        .expect("a soil")
        .along *= 0.1;
    scene.model.water = Some(water);
    scene.model.nonlinear = nonlinear;
    scene.model.criteria = Criteria {
        energy: 1e-16,
        force: 1e-9,
        max_iterations: 400,
    };
    let surface = (0..9).map(|k| SurfacePoint::at(at((f64::from(k) + 0.5) / 6.0, 2.0), 1.0 / 6.0));
    scene.load(Load::dead(surface.collect(), at(0.0, -load), 1.0))
}

/// Steps a scene to these times; largest displacement, m, what the steps took, and products of the derivative.
fn steps(scene: &mut Plane, times: &[f64]) -> Result<(f64, Vec<StepReport>, usize), StepError> {
    let halo = scene.halo();
    let mut solver = Skyline::new(&scene.model.grid);
    let mut guess = vec![0.0; scene.model.grid.nodes() * 2];
    let mut t = 0.0;
    let mut reports = Vec::new();
    let mut products = 0;
    for next in times {
        let dt = next - t;
        let mut counts = Counts::default();
        reports.push(step(
            &scene.model,
            &mut scene.points,
            &mut scene.state,
            &mut guess,
            TimeInterval { start: t, dt },
            ResistedDisplacement::Whole,
            &mut Backend {
                halo: &halo,
                solver: &mut solver,
                counts: &mut counts,
            },
        )?);
        products += counts.products;
        t = *next;
        scene.points.sort_by_cell(&scene.model.grid);
    }
    Ok((
        largest_displacement(&scene.points, &Part::Whole, &halo),
        reports,
        products,
    ))
}

/// Theory: quadratic convergence of Newton's method.
#[test]
fn the_residuals_of_force_and_water_converge_quadratically() {
    for method in [Stabilisation::None, Stabilisation::ConsistentFBar] {
        for law in [PermeabilityLaw::Constant, PermeabilityLaw::KozenyCarman] {
            let mut found = Vec::new();
            for nonlinear in [Nonlinear::Newton, Nonlinear::Auto] {
                let mut scene = loaded(nonlinear, method, 9e3, law);
                let (u, reports, products) = steps(&mut scene, &[0.25, 0.5, 0.75, 1.0]).expect("it converges");
                found.push((
                    u,
                    reports.iter().map(|report| report.iterations).sum::<usize>(),
                    products,
                ));
                let last = reports.last().expect("steps");
                let measures: Vec<(f64, f64)> = last
                    .history
                    .iter()
                    .map(|m| (m.force, m.water.expect("flows")))
                    .collect();
                if nonlinear == Nonlinear::Auto {
                    continue;
                }
                println!("{method:?}, {law:?}: {measures:?}");
                assert!(last.history.iter().all(|measures| measures.method == Method::Newton) && measures.len() <= 5);
                // Once the plastic set no longer changes; measured C, of the larger of both: 3.1 to 3.8.
                let [.., before, after] = measures[..] else {
                    panic!("too few iterations")
                };
                assert!(
                    after.0.max(after.1) <= 10.0 * before.0.max(before.1).powi(2),
                    "{measures:?}"
                );
            }
            println!("displacement, iterations, products: {found:?}");
            let [newton, auto] = [found[0].0, found[1].0];
            let [quick, slow] = [found[0].1, found[1].1];
            assert!(
                (newton / auto - 1.0).abs() < 1e-6 && quick < slow,
                "the same state in fewer iterations"
            );
            assert!(
                found[0].2 < 10 * quick,
                "the split is near the derivative: {} products",
                found[0].2
            );
        }
    }
}

/// Next to what the clay bears without drainage, in one step: secants take 53 iterations, and are given 40.
#[test]
fn it_does_a_step_that_secants_do_not() {
    let attempt = |nonlinear: Nonlinear| {
        let law = PermeabilityLaw::KozenyCarman;
        let mut scene = loaded(nonlinear, Stabilisation::ConsistentFBar, 1.014e4, law);
        scene.model.criteria = Criteria {
            energy: 1e-8,
            force: 1e-4,
            max_iterations: 40,
        };
        let found =
            steps(&mut scene, &[1.0]).map(|(_, reports, _)| (reports[0].iterations, reports[0].newton_iterations));
        println!("{nonlinear:?}: {:?}", found.as_ref().map_err(|error| error.to_string()));
        found.ok()
    };
    assert_eq!(
        attempt(Nonlinear::QuasiNewton(QuasiNewton::Multisecant)),
        None,
        "secants alone do not"
    );
    let (iterations, newton) = attempt(Nonlinear::Auto).expect("a step");
    assert!(newton == iterations && newton <= 15, "from the same guess");
    assert_eq!(attempt(Nonlinear::Newton), Some((iterations, newton)));
}
