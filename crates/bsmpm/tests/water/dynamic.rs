//! Tests of a saturated column under a sudden load: damped waves of the telegraph equation.

use super::{M, column, run, settlement};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::energy::{EnergyAccounts, EnergyBound, StoredEnergy};
use bsmpm::field::pore_water::flow::PermeabilityLaw;
use bsmpm::model::Regime;
use bsmpm::points::Motion;
use bsmpm::tensor::Vector;

/// s M/(q H) at t sqrt(M/rho)/H = 0.5, 1, 2, 4, 10, of gamma_w H/(k sqrt(M rho)) = 1, 10, 100.
const TABLE: [(f64, [f64; 5]); 3] = [
    (1.0, [0.444565, 0.801456, 1.347154, 0.882610, 1.003628]),
    (10.0, [0.238316, 0.347513, 0.498192, 0.697688, 0.933807]),
    (100.0, [0.079386, 0.112555, 0.159377, 0.225535, 0.356734]),
];
const TIMES: [f64; 5] = [0.5, 1.0, 2.0, 4.0, 10.0];

/// Closed form: telegraph equation of a saturated column.
#[test]
fn water_damps_the_waves_of_a_column_as_the_telegraph_equation_says() {
    // A step is accepted once the water's balance is off by 1e-13 of the volume: 1e-6 of the energy under a tenth of
    // this load.
    let load = 1e-4 * M;
    for (damping, expected) in TABLE {
        let mut scene = column(20, 1.0, load, PermeabilityLaw::Constant);
        scene.model.regime = Regime::Dynamic;
        // rho = M, in which the unit of time is H sqrt(rho/M) = 1 s.
        scene.points.mass = scene.points.volume.iter().map(|volume| volume * M).collect();
        scene.model.mass = MassMatrix::Consistent; // lumped: off by 0.029
        let rest = vec![Vector::<2>::zeros(); scene.points.len()];
        scene.points.motion = Some(Motion {
            v: rest.clone(),
            a: rest,
        });
        let flow = scene
            .model
            .water
            .as_mut()
            .and_then(|water| water.flow.as_mut())
            .expect("it flows");
        let along = &mut flow.soils[0]
            .as_mut()
            .and_then(|soil| soil.permeability.as_mut())
            .expect("a soil")
            .along;
        *along *= 1.0 / (damping * along[1] * M / super::WEIGHT);
        scene.model.balances_energy = true;
        let mut found = Vec::new();
        let mut iterations = 0;
        let mut books = EnergyAccounts::open(StoredEnergy::default());
        let mut budget = EnergyBound::open(StoredEnergy::default());
        let mut now = StoredEnergy::default();
        run(
            &mut scene,
            (1..=1000).map(|k| 0.01 * f64::from(k)),
            |t, points, report| {
                iterations += report.iterations;
                let turnover = report.turnover.expect("dynamic");
                budget.enter(&turnover);
                books.flows += report.energy.expect("books are kept");
                now = turnover.stored;
                if TIMES.iter().any(|of| (of - t).abs() < 1e-9) {
                    found.push(settlement(points) * M / load);
                }
            },
        );
        let off = found
            .iter()
            .zip(expected)
            .map(|(found, expected)| (found - expected).abs())
            .fold(0.0, f64::max);
        println!("b = {damping}: {found:.5?} ({expected:?}), off by {off:.4}, {iterations} iterations in 1000 steps");
        assert!(off < 0.02);
        let given = books.flows.external;
        let closure = books.residual(now);
        let growth = budget.growth;
        let parts = [now.kinetic + now.elastic, books.flows.plastic, books.flows.numerical()].map(|part| part / given);
        println!(
            "  of {given:.4e} J stored, seepage, numerical {parts:.4?}, left {:.1e}, made {growth:.4}",
            closure / given
        );
        assert!((closure / given).abs() < 1e-6 && growth < 0.01);
        assert!(parts[2].abs() < 0.05);
    }
}
