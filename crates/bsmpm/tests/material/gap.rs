//! Tests Mohr-Coulomb soil that separated at the apex (gap): it resists compression only after the gap has closed.

use super::{mohr_coulomb, respond};
use bsmpm::material::{Branch, Material, Response};
use bsmpm::tensor::Symmetric;

/// A step of a point: its elastic state and gap, driven by the stretches of the axes.
fn driven(material: &Material, b_e: Symmetric, gap: f64, stretch: [f64; 3]) -> Response {
    let [x, y, z, ..] = b_e.0;
    let open = (2.0 / 3.0 * gap).exp();
    let [p, q, r] = stretch.map(|ratio| ratio * ratio * open);
    respond(material, &Symmetric([x * p, y * q, z * r, 0.0, 0.0, 0.0]))
}

/// From rest apart to J = 1.5, in plane strain with shear on the way, back and into compression: without stress until J
/// = 1, and then on the path of sand that has never come apart.
#[test]
fn sand_resists_again_at_the_volume_at_which_it_came_apart() {
    let material = mohr_coulomb(1e4, 0.3, 30.0, 0.0, 0.0);
    let shares = [[0.5, 0.5, 0.0], [1.4, -0.4, 0.0], [0.1, 0.9, 0.0]];
    let up = (0..50).map(|step| 1.5_f64.ln() / 50.0 * if step < 25 { 1.2 } else { 0.8 });
    let mut state = (Symmetric::IDENTITY, 0.0);
    let mut volume = 0.0_f64;
    let mut worst = 0.0_f64;
    for (step, change) in up.clone().chain(up.map(|change| -change)).enumerate() {
        let found = driven(
            &material,
            state.0,
            state.1,
            shares[step % 3].map(|share| (share * change).exp()),
        );
        volume += change;
        state = (found.b_e(), found.gap());
        let closed = volume <= 1e-12;
        assert!(
            closed || (found.branch() == Branch::Apex && found.principal_tau() == [0.0; 3]),
            "step {step}"
        );
        worst = worst.max((state.1 - volume.max(0.0)).abs());
        assert!(worst <= 1e-13, "step {step}: {} for {volume}", state.1);
    }
    println!("volume of the gap off by {worst:.1e}");
    assert!(state.1 <= 1e-13 && volume.abs() <= 1e-13);
    let squeeze = |state: (Symmetric, f64)| driven(&material, state.0, state.1, [0.99, 0.995, 1.0]);
    let again = squeeze(state);
    let virgin = squeeze((Symmetric::IDENTITY, 0.0));
    assert_eq!(again.branch(), virgin.branch());
    for (again, virgin) in again.principal_tau().into_iter().zip(virgin.principal_tau()) {
        assert!((again - virgin).abs() <= 1e-10 * 1e4, "{again} for {virgin}");
    }
    let forgotten = squeeze((state.0, 0.0));
    assert!(forgotten.principal_tau()[2] < 0.0 && squeeze((state.0, 0.1)).principal_tau() == [0.0; 3]);
}

/// One step that closes the gap and compresses by as much more: what is beyond closing is all that is elastic.
#[test]
fn a_step_across_the_closing_keeps_the_volume_beyond_it() {
    let material = mohr_coulomb(1e4, 0.3, 30.0, 0.0, 0.0);
    let change = |by: f64| [(0.5 * by).exp(), (0.5 * by).exp(), 1.0];
    let open = driven(&material, Symmetric::IDENTITY, 0.0, change(0.01));
    let closed = driven(&material, open.b_e(), open.gap(), change(-0.02));
    let volume: f64 = closed.principal_eps_e().iter().sum();
    assert!((volume + 0.01).abs() <= 1e-14 && closed.gap() == 0.0, "{volume}");
}

/// What shear dilates with psi > 0 off the apex is plastic, as ever.
#[test]
fn dilation_is_no_gap() {
    let material = mohr_coulomb(1e4, 0.3, 30.0, 15.0, 0.0);
    let mut state = (Symmetric::IDENTITY, 0.0);
    state.0 = driven(&material, state.0, state.1, [0.99, 0.99, 0.99]).b_e();
    for _ in 0..10 {
        let found = driven(&material, state.0, state.1, [1.002, 0.998, 1.0]);
        assert!(found.branch() != Branch::Elastic || found.plastic_increment() == 0.0);
        assert!(found.branch() != Branch::Apex && found.gap() == 0.0);
        state = (found.b_e(), found.gap());
    }
}

/// Sand that has come apart works nothing while it opens and closes; once closed, it works as elastic ground does.
#[test]
fn an_open_gap_has_no_second_order_work() {
    let material = mohr_coulomb(1e4, 0.3, 30.0, 0.0, 0.0);
    let stretch = |by: f64| [by.exp(), by.exp(), by.exp()];
    let strain = |by: f64| Symmetric([by, by, by, 0.0, 0.0, 0.0]);
    let open = driven(&material, Symmetric::IDENTITY, 0.0, stretch(0.01));
    for by in [0.01, -0.005] {
        let next = driven(&material, open.b_e(), open.gap(), stretch(by));
        let [elastic, actual] = next.second_order_works(&strain(by).full(), open.gap());
        assert!(elastic > 0.1 && actual.abs() <= 1e-12, "{by}: {actual} of {elastic}");
    }
    // From a gap of 0.03 by -0.06: half of the strain closes the gap, half of it strains the sand.
    let closed = driven(&material, open.b_e(), open.gap(), stretch(-0.02));
    let [elastic, actual] = closed.second_order_works(&strain(-0.02).full(), open.gap());
    assert!((actual / elastic - 0.5).abs() <= 1e-12, "{actual} of {elastic}");
}
