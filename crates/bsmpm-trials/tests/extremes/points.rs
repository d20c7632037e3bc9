//! Tests of few and many points per cell.

use crate::physics::scene::{Scene, axis, hencky};
use crate::scenes::{Collapse, Footing};
use crate::solver::Run;
use crate::table::Found;
use bsmpm::boundary::Support;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use std::time::Instant;

/// A bar of 10 cells of 1 m is pulled to `stretch` times its length, 1 m tall between rollers, nu = 0, with so many
/// points a cell and axis: error of its axial stress, E ln(l)/l, in its middle; or a warning that it has come apart.
pub fn stretched(per_cell: usize, stretch: f64) -> Found {
    let pull = 10.0 * (stretch - 1.0);
    let end = 10.0 * stretch + 2.0;
    let text = format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nsteps = 100\n\
         [grid]\nlower = [0.0, 0.0]\nupper = [{end}, 1.0]\ncell = 1.0\ndegree = \"quadratic\"\n\
         [material.bar]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.0\n\
         [[body]]\nmaterial = \"bar\"\nbox = {{ lower = [0.0, 0.0], upper = [10.0, 1.0] }}\npoints_per_cell = {per_cell}\n\
         [boundary]\nleft = \"roller\"\nbottom = \"roller\"\ntop = \"roller\"\n[stabilisation]\nmethod = \"none\"\n\
         [[prescribed]]\nfrom = [10.0, 0.0]\nto = [10.0, 1.0]\ndisplacement = [{pull}, 0.0]\n\
         [output]\ntimes = [1.0]\n[[history]]\nquantity = \"stress\"\nat = [5.2, 0.5]\nname = \"middle\"\n"
    );
    let run = Run::of(&text, 1, &[]);
    run.found_or_warned("without points", |run| {
        let exact = 1e6 * stretch.ln() / stretch;
        let stress = run.last("middle-xx");
        Found::Figure(
            (stress / exact - 1.0).abs(),
            format!("{stress:.3e} for {exact:.3e} Pa, {}", run.effort()),
        )
    })
}

/// p/c of the coarse footing at z/B = 0.1 with so many points a cell and axis; or a warning that they are too few.
pub fn footing(per_cell: usize) -> Found {
    let run = Run::of(
        &Footing {
            per_cell,
            ..Footing::default()
        }
        .text(),
        1,
        &[],
    );
    run.found_or_warned("W0210", |run| {
        Found::Figure(Footing::factor(run.last("pressure")), run.effort())
    })
}

/// The way of the collapse's front with one point a cell over that with four.
pub fn collapse() -> Found {
    let run = |per_cell: usize| {
        Run::of(
            &Collapse {
                per_cell,
                ..Collapse::default()
            }
            .text(),
            1,
            &[],
        )
    };
    let way = |run: &Run, per_cell: f64| run.last("runout") - 0.2 + 0.005 / per_cell;
    let reference = way(&run(2), 2.0);
    run(1).found_or_warned("W0210", |run| way(run, 1.0) / reference)
}

/// A column of four cells under a small weight with n x n points a cell: mean error of its stress, and seconds a point.
fn column(per_cell: usize) -> (f64, f64) {
    let load = 1e-7;
    let started = Instant::now();
    let young = 1.3 * 0.4 / 0.7;
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(0.25, 1, 2), axis(0.25, 4, 2)],
        hencky(young, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..1, 0..4], per_cell, 1.0, |x| x * 0.0)
    .rollers([0])
    .support(Support::roller(1, false))
    .gravity(load, 0.0);
    scene.march(1.0, 1.0, |_, _| ());
    let points = &scene.points;
    let error = |p: usize| (points.sigma.at(p).0[1] + load * (1.0 - points.height(p))).abs();
    let mean = (0..points.len()).map(error).sum::<f64>() / points.len() as f64 / load;
    (mean, started.elapsed().as_secs_f64() / points.len() as f64)
}

/// Points along an axis of a cell.
const MANY: [usize; 4] = [6, 10, 20, 100];

/// Largest ratio of the stress error with more points to that with fewer.
pub fn many() -> Found {
    let errors = MANY.map(|n| column(n).0);
    let worst = errors.windows(2).map(|pair| pair[1] / pair[0]).fold(0.0, f64::max);
    Found::Figure(
        worst,
        format!("errors {}", errors.map(|error| format!("{error:.1e}")).join(", ")),
    )
}

/// Time a point with 1e4 points a cell over that with 100.
pub fn cost() -> f64 {
    column(100).1 / column(10).1
}
