//! Tests of undrained soil: uniform states, and shear to failure.

use super::{LOAD_PARTS, M, Plane, at, column, flowing, run};
use crate::support::scene::axis;
use bsmpm::boundary::{Support, SurfacePoint};
use bsmpm::field::pore_water::flow::PermeabilityLaw;
use bsmpm::initial;
use bsmpm::interactions::load::Load;
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Symmetric;

/// Confined compression without flow: the water takes 1/(1 + n M/K_w) of the load (Skempton).
#[test]
fn water_that_yields_takes_its_share_of_the_load() {
    let load = 1e-5 * M;
    let mut scene = column(4, 1.0, load, PermeabilityLaw::Constant);
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("it flows");
    (flow.bulk, flow.faces) = (22.0 * M, Vec::new());
    let soil = flow.soils[0].as_mut().expect("a soil");
    (soil.porosity, soil.permeability) = (0.4, None);
    run(&mut scene, [1.0, 2.0], |t, points, report| {
        let off = |p: &f64| (p / load * (1.0 + 0.4 / 22.0) - 1.0).abs();
        let worst = points.pore_pressure.iter().flatten().map(off).fold(0.0, f64::max);
        println!("at {t}: off by {worst:.1e}, {} iterations", report.iterations);
        assert!(worst < 1e-4); // strains are 1e-5 / 50
    });
}

/// Undrained compression in plane strain under a constant total stress beside it, without dilation: s' = s'0, so that
/// s_u = c' cos phi' + s'0 sin phi' = 50 kPa, and p = 50 kPa where it yields.
#[test]
fn undrained_strength_follows_from_the_effective_stress() {
    for method in [Stabilisation::FBar, Stabilisation::ConsistentFBar] {
        let confining = 1e5;
        let law = MohrCoulomb::new(
            Elastic {
                young: 1e8,
                poisson: 0.3,
            },
            30_f64.to_radians(),
            0.0,
            0.0,
        );
        let mut scene = Plane::new(
            [axis(0.5, 3, 2), axis(0.5, 2, 2)],
            Material::MohrCoulomb(law),
            Regime::QuasiStatic,
        )
        .body([0..2, 0..2], 3, 1.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(Support::roller(1, false));
        let mut plate = Support::roller(1, true);
        plate.velocity[1] = Some(-1e-3);
        let side = LOAD_PARTS
            .iter()
            .map(|y| SurfacePoint::at(at(1.0, *y), 1.0 / LOAD_PARTS.len() as f64));
        scene = scene
            .support(plate)
            .load(Load::dead(side.collect(), at(-confining, 0.0), 0.0))
            .stabilised(method);
        let mut water = flowing(PermeabilityLaw::Constant);
        water
            .flow
            .as_mut()
            .and_then(|flow| flow.soils[0].as_mut())
            .expect("a soil")
            .permeability = None;
        scene.model.water = Some(water);
        let isotropic = Symmetric([-confining, -confining, -confining, 0.0, 0.0, 0.0]);
        initial::set_stress(&scene.model, &mut scene.points, |_, _| isotropic);
        (scene.model.criteria.energy, scene.model.criteria.force) = (1e-10, 1e-7);
        let mut last = [0.0; 3];
        run(&mut scene, (1..=4).map(|k| 0.5 * f64::from(k)), |t, points, report| {
            let sum = |of: &dyn Fn(usize) -> f64| (0..points.len()).map(of).sum::<f64>() / points.len() as f64;
            let sigma = |p: usize| points.sigma.at(p).0;
            last = [
                sum(&|p| points.pore_pressure.as_ref().expect("water")[p]),
                sum(&|p| -0.5 * (sigma(p)[0] + sigma(p)[1])),
                sum(&|p| 0.5 * (sigma(p)[0] - sigma(p)[1])),
            ];
            println!("{method:?} {t}: p, s', t {last:.1?}, {} iterations", report.iterations);
        });
        // The dead load is of the first surface, which stretches by 0.1 %.
        assert!((last[0] / 5e4 - 1.0).abs() < 0.005 && (last[1] / 1e5 - 1.0).abs() < 0.005);
        assert!((last[2] / 5e4 - 1.0).abs() < 0.005);
    }
}
