//! Tests of Poisson's ratios towards one half.

use crate::physics::scene::{Scene, axis, hencky};
use crate::physics::solver::Skyline;
use crate::scenes::Footing;
use crate::solver::Run;
use crate::table::Found;
use bsmpm::boundary::Support;
use bsmpm::control::{Failure, Stepper};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::method::Criteria;
use bsmpm::model::Regime;
use bsmpm::schedule::Schedule;
use bsmpm::stabilisation::Stabilisation;

/// Height of Hencky's confined column under rho0 g l0 / M = 0.4, M the oedometric modulus, over its first one.
const SETTLED: f64 = 0.853_305_216_7;

/// Error of the height of a confined column of 20 cells, gravity in ten steps, over its length; or the physics' reason,
/// which the program would end with 80 for.
pub fn confined(poisson: f64, method: Stabilisation) -> Found {
    column(poisson, method, 1.0)
}

/// The largest error of so many columns that differ by round-off alone, where it decides what is found; reported if all
/// are.
pub fn confined_by_round_off(poisson: f64, method: Stabilisation, columns: i32) -> Found {
    let mut worst = None;
    for k in 0..columns {
        let found = column(poisson, method, 1.0 + f64::from(k) * 1e-13);
        worst = match (worst, found) {
            (Some(Found::Figure(before, reported)), Found::Figure(now, _)) if before >= now => {
                Some(Found::Figure(before, reported))
            }
            (Some(before @ Found::Figure(..)), Found::Warned(..)) => Some(before),
            (Some(before @ Found::Broken(_)), _) => Some(before),
            (_, found) => Some(found),
        };
    }
    worst.unwrap_or_else(|| Found::Broken("no columns".to_owned()))
}

/// A column with Young's modulus times `factor`.
fn column(poisson: f64, method: Stabilisation, factor: f64) -> Found {
    let cells = 20;
    let h = 0.05;
    let young = factor * (1.0 + poisson) * (1.0 - 2.0 * poisson) / (1.0 - poisson);
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(h, 1, 2), axis(h, cells, 2)],
        hencky(young, poisson),
        Regime::QuasiStatic,
    )
    .body([0..1, 0..cells], 3, 1.0, |x| x * 0.0)
    .rollers([0])
    .support(Support::roller(1, false))
    .gravity(0.4, 10.0)
    .stabilised(method);
    // Tight enough for the bound; quasi-Newton takes long for more.
    scene.model.criteria = Criteria {
        energy: 1e-8,
        force: 1e-5,
        max_iterations: 1000,
    };
    if let Err(failure) = march(&mut scene) {
        let reason = failure.attempts.last().map(ToString::to_string).unwrap_or_default();
        return Found::Warned(80, format!("t = {:.4}: {reason}", failure.t));
    }
    let points = &scene.points;
    let top = (0..points.len())
        .max_by(|&a, &b| points.x[a][1].total_cmp(&points.x[b][1]))
        .expect("points");
    Found::from((points.x[top][1] + h / 6.0 * points.F.at(top)[(1, 1)] - SETTLED).abs())
}

/// Ten steps; fails where the program would.
fn march(scene: &mut Scene<PlaneStrain, 2>) -> Result<(), Failure> {
    let halo = scene.halo();
    let schedule = Schedule::new(1.0, 10.0, []);
    let mut solver = Skyline::new(&scene.model.grid);
    let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
    while let Some(step) = scene.advance(&mut stepper, &schedule, &halo, &mut solver) {
        step?;
        scene.points.sort_by_cell(&scene.model.grid);
    }
    Ok(())
}

/// p/c of the coarse footing at z/B = 0.1.
pub fn footing(poisson: f64, method: &'static str) -> Found {
    let run = Run::of(
        &Footing {
            poisson,
            method,
            ..Footing::default()
        }
        .text(),
        1,
        &[],
    );
    run.found(|run| Found::Figure(Footing::factor(run.last("pressure")), run.effort()))
}

/// Root mean square of the pressure about the planes of neighbouring cells, under the footing at z/B = 0.1, over the
/// mean of its absolute value.
pub fn checkerboard(poisson: f64, method: &'static str) -> Found {
    let run = Run::of(
        &Footing {
            poisson,
            method,
            ..Footing::default()
        }
        .text(),
        1,
        &[],
    );
    run.found(|run| {
        let frame = run.frame();
        let pressure = frame.real("pressure", 1).expect("a pressure");
        let mean = pressure.iter().map(|p| p.abs()).sum::<f64>() / pressure.len() as f64;
        run.last("noise-plane") / mean
    })
}

/// Iterations of the footing with this Poisson's ratio over those with 0.3.
pub fn iterations(poisson: f64, method: &'static str) -> Found {
    let [many, few] = [poisson, 0.3].map(|poisson| {
        let run = Run::of(
            &Footing {
                poisson,
                method,
                ..Footing::default()
            }
            .text(),
            1,
            &[],
        );
        run.manifest().summary.iterations as f64
    });
    Found::Figure(many / few, format!("{many} for {few}"))
}

/// A cantilever 8 m long and 1 m thick with a small force at its end: deflection with this ratio over that with 0.495,
/// both with the same E / (1 - nu^2), less one.
pub fn bending(poisson: f64, method: &'static str) -> Found {
    let run = |poisson: f64| {
        let young = 1e8 * (1.0 - poisson * poisson);
        let text = format!(
            "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nsteps = 1\n\
             [grid]\nlower = [0.0, 0.0]\nupper = [8.5, 2.0]\ncell = 0.25\ndegree = \"quadratic\"\n\
             [material.beam]\nmodel = \"elastic\"\nyoung = {young}\npoisson = {poisson}\n\
             [[body]]\nmaterial = \"beam\"\nbox = {{ lower = [0.0, 0.5], upper = [8.0, 1.5] }}\npoints_per_cell = 3\n\
             [boundary]\nleft = \"fixed\"\n[stabilisation]\nmethod = \"{method}\"\n\
             [solver]\nbackground = 1e-6\nmax_iterations = 1000\n[output]\ntimes = [1.0]\n\
             [[point_load]]\nat = [8.0, 1.0]\nforce = [0.0, -100.0]\n\
             [[history]]\nquantity = \"displacement\"\nat = [8.0, 1.0]\nname = \"tip\"\n"
        );
        Run::of(&text, 1, &[])
    };
    let reference = run(0.495).last("tip-y");
    run(poisson).found(|run| Found::Figure((run.last("tip-y") / reference - 1.0).abs(), run.effort()))
}

/// Whether a case with this ratio is asked to be nearly incompressible.
pub fn warned(poisson: f64) -> Found {
    let text = Footing {
        poisson,
        steps: 100,
        depth: 1e-3,
        ..Footing::default()
    }
    .text();
    Run::of(&text, 1, &["--max-steps", "1"]).found_or_warned("W0303", |_| f64::NAN)
}
