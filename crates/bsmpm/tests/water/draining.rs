//! Consolidation of bodies whose drained and loaded surfaces cut the cells, and move through them.

use super::{M, Plane, WEIGHT, at, column, flowing, geometric, run, settlement};
use crate::support::scene::{axis, hencky};
use bsmpm::background::{Background, Extent, Kind};
use bsmpm::boundary::{Load, Support, SurfacePoint};
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;
use bsmpm::water::flow::{Course, Drain, Given, PermeabilityLaw};
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// Small enough for small strains.
const LOAD: f64 = 1e-5 * M;

#[test]
fn a_column_settles_alike_wherever_its_drained_surface_cuts_the_cells() {
    // Terzaghi (1923): U at the time factor .2.
    let mut errors = Vec::new();
    for cut in [0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95] {
        let mut scene = column(20, cut, LOAD, PermeabilityLaw::Constant);
        let mut settled = 0.0;
        run(&mut scene, geometric(1e-4, 0.2, 100), |_, points, _| settled = settlement(points) * M / LOAD);
        errors.push(settled - 0.504088);
    }
    println!("errors of U {errors:.5?}");
    assert!(errors.iter().all(|error| error.abs() <= 0.002));
}
