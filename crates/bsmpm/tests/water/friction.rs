//! Tests that with excess pore pressure, friction follows the effective normal force.

use super::{Plane, at, flowing};
use crate::support::scene::{axis, hencky};
use bsmpm::boundary::Support;
use bsmpm::field::pore_water::carried;
use bsmpm::field::pore_water::flow::{Motion, PermeabilityLaw};
use bsmpm::field::pore_water::pore_pressure::PorePressure;
use bsmpm::grid::Shape;
use bsmpm::interactions::coulomb::Contact;
use bsmpm::model::Regime;

/// A square of 1 m with an excess pore pressure that is linear in the place, Pa, and a left face with friction; what
/// `of` finds in the pressures that friction takes off.
fn found<T>(friction: f64, of: impl Fn(&PorePressure<2>, &Plane, &Shape<2>) -> T) -> Option<T> {
    let law = Contact { friction, lifts: true };
    let mut scene = Plane::new(
        [axis(0.25, 4, 2), axis(0.25, 4, 2)],
        hencky(1e6, 0.0),
        Regime::QuasiStatic,
    )
    .body([0..4, 0..4], 3, 1e3, |x| x * 0.0)
    .support(Support::contact(0, false, law))
    .support(Support::roller(1, false));
    let mut water = flowing(PermeabilityLaw::Constant);
    water.flow.iter_mut().for_each(|flow| flow.motion = Motion::Held);
    scene.model.water = Some(water);
    scene.points.pore_pressure = Some(scene.points.x.iter().map(|x| 5e3 + 2e3 * x[0] - 3e3 * x[1]).collect());
    let halo = scene.halo();
    let shape = Shape::at(&scene.model.grid, &scene.points).expect("inside");
    let volume = &scene.points.volume;
    let pores = carried::pore_pressure(&scene.model, &shape, &scene.points, volume, 1.0, &halo);
    pores.map(|pores| of(&pores, &scene, &shape))
}

#[test]
fn excess_pore_pressure_is_taken_off_the_normal_force_of_a_face() {
    let force = |pores: &PorePressure<2>, scene: &Plane, shape: &Shape<2>| -> f64 {
        let Plane { model, points, .. } = scene;
        let forces = carried::forces_on_faces(pores, model, shape, points, &points.volume, &scene.halo());
        forces.iter().step_by(2).sum()
    };
    let found = found(0.3, force).expect("it has friction");
    // Along x the functions are exact, along the face by the quadrature of the points.
    println!("{found:.3} N for 3500");
    assert!((found / 3.5e3 - 1.0).abs() < 1e-3, "{found}");
}

#[test]
fn a_linear_pore_pressure_is_exact_at_a_place_inside_and_is_left_out_without_friction() {
    let place = at(0.55, 0.45);
    let at_place = |pores: &PorePressure<2>, scene: &Plane, shape: &Shape<2>| {
        let nearest = |p: &usize| (scene.points.x[*p] - place).norm();
        let p = (0..scene.points.len())
            .min_by(|p, q| nearest(p).total_cmp(&nearest(q)))
            .expect("a point");
        let patch = shape
            .patches()
            .iter()
            .find(|patch| patch.points.contains(&p))
            .expect("its cell");
        let first = patch.first_node;
        let weights = shape
            .of(p)
            .into_iter()
            .zip(shape.offsets())
            .map(|((N, _), offset)| (first + offset, N));
        pores.at(weights, &place)
    };
    let found = [0.3, 0.0].map(|friction| found(friction, at_place));
    let exact = 5e3 + 2e3 * 0.55 - 3e3 * 0.45;
    assert!(
        found[0].is_some_and(|pressure| (pressure / exact - 1.0).abs() < 1e-12),
        "{found:?} {exact}"
    );
    assert!(found[1].is_none());
}
