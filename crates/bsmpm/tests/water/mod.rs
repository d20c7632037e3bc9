//! Tests of coupled flow in a deforming skeleton, against closed forms.

mod draining;
mod dynamic;
mod element;
mod friction;
mod large;
mod mandel;
mod newton;
mod pair;
mod partial;
mod terzaghi;

use crate::support::scene::{Scene, axis, hencky};
use crate::support::solver::Skyline;
use bsmpm::boundary::{Support, SurfacePoint};
use bsmpm::field::pore_water::Water;
use bsmpm::field::pore_water::ambient::Ambient;
use bsmpm::field::pore_water::flow::{Drain, DrainedFace, Flow, Given, Motion, Permeability, PermeabilityLaw, Soil};
use bsmpm::interactions::artificial_stiffness::ResistedDisplacement;
use bsmpm::interactions::load::Load;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::schedule::TimeInterval;
use bsmpm::solve::Backend;
use bsmpm::step::{Counts, StepReport, step};
use bsmpm::tensor::Vector;

/// Where the points of a load on an edge of 1 m are.
pub const LOAD_PARTS: [f64; 6] = [1.0 / 12.0, 3.0 / 12.0, 5.0 / 12.0, 7.0 / 12.0, 9.0 / 12.0, 11.0 / 12.0];

/// Plane strain.
pub type Plane = Scene<PlaneStrain, 2>;

/// N/m3
pub const WEIGHT: f64 = 1e4;
/// kg/m3  of grains and water together
pub const DENSITY: f64 = 2e3;
/// Pa  stiffness of the columns in one direction
pub const M: f64 = 1e6;

fn at(x: f64, y: f64) -> Vector<2> {
    Vector::<2>::new(x, y)
}

/// Water that flows through one soil of porosity 0.6, at the rate that makes the coefficient of consolidation 1 m2/s in
/// a skeleton of the stiffness M; incompressible.
pub fn flowing(law: PermeabilityLaw) -> Water<2> {
    let permeability = Permeability {
        along: at(WEIGHT / M, WEIGHT / M),
        law,
    };
    let soil = Soil {
        porosity: 0.6,
        permeability: Some(permeability),
        retention: None,
    };
    through(soil)
}

/// Incompressible water that flows through one soil.
pub fn through(soil: Soil<2>) -> Water<2> {
    let flow = Flow {
        bulk: f64::INFINITY,
        soils: vec![Some(soil)],
        drains: Vec::new(),
        faces: Vec::new(),
        inflows: Vec::new(),
        suction: 0.0,
        motion: Motion::Flows,
    };
    Water {
        unit_weight: WEIGHT,
        ambient: Ambient::None,
        flow: Some(flow),
    }
}

/// A column of the height 1 m, `cells` of them in it, one across; its top in the middle of the cell above by the share
/// `cut` of it, which is then drained by surface points, else by the grid's face. The `load`, Pa, acts on top at once.
pub fn column(cells: usize, cut: f64, load: f64, law: PermeabilityLaw) -> Plane {
    column_of([1, cells], cut, load, law)
}

/// The same of so many cells across and up.
pub fn column_of([across, cells]: [usize; 2], cut: f64, load: f64, law: PermeabilityLaw) -> Plane {
    let h = 1.0 / (cells as f64 - 1.0 + cut);
    let is_cut = cut < 1.0;
    let rows = if is_cut { cells + 1 } else { cells };
    let mut scene = Plane::new(
        [axis(h, across, 2), axis(h, rows, 2)],
        hencky(M, 0.0),
        Regime::QuasiStatic,
    );
    scene = scene
        .body([0..across, 0..cells], 3, DENSITY, |x| x * 0.0)
        .rollers([0])
        .support(Support::roller(1, false));
    let surface: Vec<SurfacePoint<2>> = (0..3 * across)
        .map(|k| SurfacePoint::at(at(h * (k as f64 + 0.5) / 3.0, 1.0), h / 3.0))
        .collect();
    let mut water = flowing(law);
    let flow = water.flow.as_mut().expect("it flows");
    if is_cut {
        let normals = vec![at(0.0, 1.0); 3 * across];
        flow.drains.push(Drain {
            points: surface.clone(),
            normals,
            given: Given::StillWater,
            acts: true,
        });
        let top = cells as f64 - 1.0;
        // Rows of points that follow the surface: those of the cut cell fill its height.
        let mut x = scene.points.x.clone();
        let mut volume = scene.points.volume.clone();
        for (x, volume) in x.iter_mut().zip(&mut volume) {
            if x[1] > top * h {
                x[1] = top * h + (x[1] - top * h) * cut;
                *volume *= cut;
            }
        }
        (scene.points.x, scene.points.volume) = (x, volume);
    } else {
        flow.faces.push(DrainedFace {
            axis: 1,
            upper: true,
            given: Given::StillWater,
            acts: true,
        });
    }
    scene.model.water = Some(water);
    if load > 0.0 {
        scene = scene.load(Load::dead(surface, at(0.0, -load), 0.0));
    }
    scene.model.criteria.energy = 1e-12;
    scene.model.criteria.force = 1e-8;
    scene
}

/// Steps a scene to these times one after the other; `watch` sees the state after each. Panics on a failure.
pub fn run(scene: &mut Plane, times: impl IntoIterator<Item = f64>, watch: impl FnMut(f64, &Points<2>, &StepReport)) {
    run_from(scene, 0.0, times, watch);
}

/// The same from a time on, with no displacement to start from.
pub fn run_from(
    scene: &mut Plane,
    from: f64,
    times: impl IntoIterator<Item = f64>,
    mut watch: impl FnMut(f64, &Points<2>, &StepReport),
) {
    run_watched(scene, from, times, |t, scene, report| watch(t, &scene.points, report));
}

/// The same; `watch` sees the scene.
pub fn run_watched(
    scene: &mut Plane,
    from: f64,
    times: impl IntoIterator<Item = f64>,
    mut watch: impl FnMut(f64, &Plane, &StepReport),
) {
    let halo = scene.halo();
    let mut solver = Skyline::new(&scene.model.grid);
    let mut guess = vec![0.0; scene.model.grid.nodes() * 2];
    let mut t = from;
    let mut last = 0.0;
    for next in times {
        let dt = next - t;
        if last > 0.0 {
            guess.iter_mut().for_each(|u| *u *= dt / last);
        }
        let report = step(
            &scene.model,
            &mut scene.points,
            &mut scene.state,
            &mut guess,
            TimeInterval { start: t, dt },
            ResistedDisplacement::Whole,
            &mut Backend {
                halo: &halo,
                solver: &mut solver,
                counts: &mut Counts::default(),
            },
        )
        .unwrap_or_else(|error| panic!("from {t} to {next}: {error}"));
        (t, last) = (next, dt);
        scene.points.sort_by_cell(&scene.model.grid);
        watch(t, scene, &report);
    }
}

/// Times of `count` steps that grow geometrically from `first` to `end`.
pub fn geometric(first: f64, end: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|k| first * (end / first).powf(k as f64 / (count - 1) as f64))
        .collect()
}

/// Settlement of the top of a column, m: its topmost point's, and the strain there over what is above.
pub fn settlement(points: &Points<2>) -> f64 {
    let top = (0..points.len())
        .max_by(|a, b| points.x[*a][1].total_cmp(&points.x[*b][1]))
        .expect("points");
    let above = 1.0 - points.height(top);
    -points.u[top][1] + above * (1.0 - points.F.at(top)[(1, 1)])
}
