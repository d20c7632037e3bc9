//! Strips that rub and let go: a block that a strip presses and drags, and a footing that comes up and down again.

use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::{Contact, Path, Strip, StripContact, Support, surface};
use bsmpm::control::Accepted;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::method::Nonlinear;
use bsmpm::model::Regime;
use bsmpm::tensor::Vector;

const YOUNG: f64 = 1e7;
const CELL: f64 = 0.25;
const RUBS: Contact = Contact { friction: 0.4, lifts: true };

/// A quasi-static block of 1 m, its base held, at whose top from `from` to `to` a strip moves by these rows (m).
fn pressed(law: Contact, (from, to): (f64, f64), rows: &[(f64, [f64; 2])]) -> Scene<PlaneStrain, 2> {
    let axes = [axis(CELL, 8, 2), axis(CELL, 6, 2)];
    let scene = Scene::new(axes, hencky(YOUNG, 0.2), Regime::QuasiStatic);
    let scene = scene.body([2..6, 0..4], 2, 1e3, |_| Vector::zeros()).support(Support::fixed(1, false));
    let [from, to] = [[from, 1.0], [to, 1.0]].map(Vector::from);
    let points = surface::along::<PlaneStrain>(&scene.model.grid, &from, &to, 4);
    let rows = rows.iter().map(|(t, u)| (*t, Vector::from(*u))).collect();
    let contact = Some(StripContact { law, inward: [0.0, -1.0].into() });
    let strip = Strip { points, normal: None, contact, path: Path { rows }, penalty: std::env::var("PEN").map_or(1e4, |v| v.parse().unwrap()) * YOUNG / CELL };
    let mut scene = scene.strip(strip);
    scene.model.criteria.force = 1e-6;
    scene.model.criteria.energy = 1e-9;
    scene.model.balances_energy = true;
    scene
}

fn passes(accepted: &Accepted) -> String {
    let report = &accepted.report;
    let strip = &report.strips[0];
    format!(
        "t {:.3} iterations {} rejected {} force {:.6?} {:?} slip {:.1e} energy {:?}",
        accepted.t,
        report.iterations,
        accepted.rejected.len(),
        strip.force,
        strip.contact,
        strip.slip,
        report.energy
    )
}

#[test]
fn a_dragged_block_sticks_below_mu_n_and_slides_at_mu_n() {
    let rows = [(0.2, [0.0, -1e-3]), (1.0, [2e-3, -1e-3])];
    for method in [Nonlinear::Auto, Nonlinear::Newton] {
        let mut scene = pressed(RUBS, (0.5, 1.5), &rows);
        scene.model.nonlinear = method;
        scene.march(0.1, 1.0, |_, accepted| println!("{}", passes(accepted)));
    }
}

#[test]
fn a_strip_that_lifts_leaves_the_block_and_meets_it_where_it_left_it() {
    let rows = [(0.2, [0.0, -1e-3]), (0.5, [0.0, 2e-1]), (1.0, [0.0, -1e-3])];
    for method in [Nonlinear::Auto, Nonlinear::Newton] {
        let mut scene = pressed(RUBS, (0.75, 1.25), &rows);
        scene.model.nonlinear = method;
        scene.march(0.1, 1.0, |_, accepted| println!("{}", passes(accepted)));
    }
}
