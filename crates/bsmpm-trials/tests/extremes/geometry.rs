//! Tests of material at any position in its cells.

use crate::physics::scene::{Scene, axis, by_id, hencky};
use crate::physics::solver::Skyline;
use crate::scenes::Collapse;
use crate::solver::Run;
use crate::table::Found;
use bsmpm::boundary::Support;
use bsmpm::control::Stepper;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::{Gravity, Regime};
use bsmpm::observe::{self, Part};
use bsmpm::points::Points;
use bsmpm::schedule::Schedule;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;
use std::collections::HashSet;

const METHODS: [Stabilisation; 3] = [Stabilisation::None, Stabilisation::FBar, Stabilisation::ModifiedFBar];
/// m  edge of the cells that a body is moved through
const H: f64 = 0.25;

/// Vertical stress of the inner points, by id, of a settled block that stands `shift` m off the knots.
fn inner_stress(shift: f64, background: f64) -> Vec<f64> {
    let mut scene =
        Scene::<PlaneStrain, 2>::new([axis(H, 12, 2), axis(H, 5, 2)], hencky(100.0, 0.3), Regime::QuasiStatic)
            .body([2..10, 0..4], 3, 1.0, |x| x * 0.0)
            .support(Support::fixed(1, false))
            .gravity(2.0, 0.0);
    scene.model.artificial_stiffness = (background > 0.0).then_some(ArtificialStiffness {
        coefficient: background,
    });
    let inside = |x: &Vector<2>| (x[0] - 1.5).abs() < 0.5 && (x[1] - 0.5).abs() < 0.25;
    let points = &mut scene.points;
    let inner: HashSet<u64> = (0..points.len())
        .filter(|&p| inside(&points.x[p]))
        .map(|p| points.id[p])
        .collect();
    points.x.iter_mut().for_each(|x| x[0] += shift);
    points.sort_by_cell(&scene.model.grid);
    let points = scene.solved(1.0, 1.0).0.points;
    by_id(&points)
        .into_iter()
        .filter(|&p| inner.contains(&points.id[p]))
        .map(|p| points.sigma.at(p).0[1])
        .collect()
}

/// Largest change of the inner stress over all these shifts (in cells), relative.
fn change(shifts: impl Iterator<Item = f64>, background: f64) -> Found {
    let reference = inner_stress(0.0, background);
    let largest = reference.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
    let of = |shift: f64| {
        let found = inner_stress(shift * H, background);
        found
            .iter()
            .zip(&reference)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
            / largest
    };
    let (shift, worst) = shifts
        .map(|shift| (shift, of(shift)))
        .fold((0.0, 0.0), |a, b| if b.1 > a.1 { b } else { a });
    Found::Figure(worst, format!("worst {shift:.4} h off"))
}

/// Shifted by this part of a cell, the outermost of three points stand on a knot.
const ON_KNOT: f64 = 1.0 / 6.0;

/// The body moved across one cell in 200 places.
pub fn crossing(background: f64) -> Found {
    change((1..200).map(|i| f64::from(i) / 200.0), background)
}

/// The outermost points 1e-2 to 1e-15 of a cell beyond the knot, and on it.
pub fn entering(background: f64) -> Found {
    change(
        (2..=15).map(|k| ON_KNOT + 10.0_f64.powi(-k)).chain([ON_KNOT]),
        background,
    )
}

/// A block of 3 x 3 cells that falls freely and moves across a cell in 200 steps: largest acceleration of any node over
/// g, and largest error of the momentum, relative.
fn falling() -> (f64, f64) {
    let g = 2.0;
    let speed = Vector::from([1.0, 0.3]);
    let steps = 200;
    let mut scene = Scene::<PlaneStrain, 2>::new([axis(H, 10, 2), axis(H, 10, 2)], hencky(100.0, 0.3), Regime::Dynamic)
        .body([2..5, 4..7], 2, 1.0, |_| speed)
        .gravity(g, 0.0);
    let dt = H / speed[0] / f64::from(steps);
    let halo = scene.halo();
    let schedule = Schedule::new(dt, dt * f64::from(steps), []);
    let mut solver = Skyline::new(&scene.model.grid);
    let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
    let mass: f64 = scene.points.mass.iter().sum();
    let mut acceleration = 0.0_f64;
    let mut lost = 0.0_f64;
    let mut before = speed;
    while let Some(step) = scene.advance(&mut stepper, &schedule, &halo, &mut solver) {
        let t = step.expect("a step").t;
        scene.points.sort_by_cell(&scene.model.grid);
        for u in stepper.guess.chunks_exact(2).filter(|u| u[0] != 0.0) {
            acceleration = acceleration.max((Vector::from([u[0], u[1]]) - before * dt).norm() * 2.0 / (dt * dt) / g);
        }
        before = speed + Vector::from([0.0, -g * t]);
        let momentum = observe::momentum(&scene.points, &Part::Whole, &halo);
        lost = lost.max((momentum - before * mass).norm() / (speed.norm() * mass));
    }
    (acceleration, lost)
}

/// Largest acceleration of a node of the falling block over g.
pub fn nodal_acceleration() -> f64 {
    falling().0
}

/// Momentum that the falling block loses or gains, relative.
pub fn lost_momentum() -> f64 {
    falling().1
}

/// A soft block thrown at a wall, under gravity, on a base that it sticks to; `mirrored` lets everything face right,
/// with `swapped` axes the wall is the floor.
fn thrown(is_mirrored: bool, is_swapped: bool, method: Stabilisation) -> Points<2> {
    let sign = if is_mirrored { -1.0 } else { 1.0 };
    let mut cells = [if is_mirrored { 3..6 } else { 2..5 }, 0..3];
    let mut axes = [axis(0.5, 8, 2), axis(0.5, 5, 2)];
    let mut v = [-0.8 * sign, 0.1];
    let mut g = [0.0, -2.0];
    let mut shift = [-0.05 * sign, 0.0];
    if is_swapped {
        cells.reverse();
        axes.reverse();
        [&mut v, &mut g, &mut shift].into_iter().for_each(|pair| pair.reverse());
    }
    let (wall, floor) = if is_swapped { (1, 0) } else { (0, 1) };
    let mut scene = Scene::<PlaneStrain, 2>::new(axes, hencky(100.0, 0.3), Regime::Dynamic)
        .body(cells, 2, 1.0, |_| v.into())
        .support(Support::roller(wall, is_mirrored))
        .support(Support::fixed(floor, false))
        .stabilised(method);
    scene.model.gravity = Some(Gravity {
        acceleration: g.into(),
        ramp: 0.0,
        starts_vertical: false,
    });
    scene.points.x.iter_mut().for_each(|x| *x += Vector::from(shift));
    scene.points.sort_by_cell(&scene.model.grid);
    scene.solved(0.01, 1.0).0.points
}

/// Largest difference of position (m) and stress (over E) between points and the images of others, found by place.
fn apart(points: &Points<2>, others: &Points<2>, image: impl Fn([f64; 2], [f64; 6]) -> ([f64; 2], [f64; 6])) -> f64 {
    let images: Vec<_> = (0..others.len())
        .map(|p| image(others.x[p].into(), others.sigma.at(p).0))
        .collect();
    let of = |p: usize| {
        let distance = |x: &[f64; 2]| (points.x[p] - Vector::from(*x)).norm();
        let (x, sigma) = images
            .iter()
            .min_by(|a, b| distance(&a.0).total_cmp(&distance(&b.0)))
            .expect("points");
        let stress = points
            .sigma
            .at(p)
            .0
            .into_iter()
            .zip(sigma)
            .map(|(a, b)| (a - b).abs() / 100.0);
        stress.fold(distance(x), f64::max)
    };
    (0..points.len()).map(of).fold(0.0, f64::max)
}

/// Mirrored scene against the mirrored result after 100 elastic steps.
pub fn mirrored() -> f64 {
    let mirror = |[x, y]: [f64; 2], [xx, yy, zz, xy, yz, xz]: [f64; 6]| ([4.0 - x, y], [xx, yy, zz, -xy, yz, -xz]);
    let of = |method| apart(&thrown(true, false, method), &thrown(false, false, method), mirror);
    METHODS.into_iter().map(of).fold(0.0, f64::max)
}

/// The same with the axes exchanged, gravity along x.
pub fn swapped() -> f64 {
    let swap = |[x, y]: [f64; 2], [xx, yy, zz, xy, yz, xz]: [f64; 6]| ([y, x], [yy, xx, zz, xy, xz, yz]);
    let of = |method| apart(&thrown(false, true, method), &thrown(false, false, method), swap);
    METHODS.into_iter().map(of).fold(0.0, f64::max)
}

/// The plastic collapse to the left against the one to the right: largest difference of a point's way, over ten times
/// what one unit in the last place of the cell changes, plus 1e-10 m.
pub fn mirrored_collapse() -> Found {
    let ways = |is_mirrored: bool, cell: f64| {
        let run = Run::of(
            &Collapse {
                mirrored: is_mirrored,
                cell,
                end: 0.05,
                ..Collapse::default()
            }
            .text(),
            1,
            &[],
        );
        let frame = run.frame();
        let moved = frame.real("displacement", 3).expect("displacements").to_vec();
        let sign = if is_mirrored { -1.0 } else { 1.0 };
        let row = |(x, u): (&[f64; 3], &[f64])| {
            let start = [x[0] - u[0], x[1] - u[1]];
            [
                if is_mirrored { 56.0 * cell - start[0] } else { start[0] },
                start[1],
                sign * u[0],
                u[1],
            ]
        };
        let mut rows: Vec<[f64; 4]> = frame.position.iter().zip(moved.chunks_exact(3)).map(row).collect();
        // Lattice places are 5 mm apart: whole numbers of them order the points alike.
        let lattice = |row: &[f64; 4]| ((row[0] / 0.0025).round() as i64, (row[1] / 0.0025).round() as i64);
        rows.sort_by_key(lattice);
        rows
    };
    let difference = |a: &[[f64; 4]], b: &[[f64; 4]]| {
        a.iter()
            .zip(b)
            .map(|(a, b)| (a[2] - b[2]).abs().max((a[3] - b[3]).abs()))
            .fold(0.0, f64::max)
    };
    let left = ways(false, 0.01);
    let spread = difference(&left, &ways(false, 0.01_f64.next_up()));
    let found = difference(&left, &ways(true, 0.01));
    Found::Figure(
        found / (10.0 * spread + 1e-10),
        format!("{found:.1e} m, spread {spread:.1e} m"),
    )
}

/// Change of velocity a step (m/s at 1 m/s) and stress (over E) of a block that flies through 1000 cells, half a cell a
/// step.
fn flight(order: usize) -> (f64, f64) {
    let velocity = Vector::<2>::new(1.0, 0.0);
    // So soft that the round-off floor of the force, which scales with E, lets v change by less than 1e-12.
    let young = 1.0;
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(0.1, 1010, order), axis(0.1, 5, order)],
        hencky(young, 0.3),
        Regime::Dynamic,
    )
    .body([1..4, 1..4], 2, 1.0, |_| velocity);
    let mut change = 0.0_f64;
    let mut stress = 0.0_f64;
    let mut last = vec![velocity; scene.points.len()];
    scene.march(0.05, 100.0, |points, _| {
        for (p, v) in points.motion.as_ref().expect("dynamic").v.iter().enumerate() {
            let id = points.id[p] as usize;
            change = change.max((v - last[id]).amax());
            last[id] = *v;
            stress = points
                .sigma
                .at(p)
                .0
                .iter()
                .fold(stress, |most, s| most.max(s.abs() / young));
        }
    });
    (change, stress)
}

/// Largest change of velocity a step of the block that flies through 1000 cells.
pub fn flight_velocity() -> f64 {
    flight(2).0
}

/// Its largest stress over E.
pub fn flight_stress() -> f64 {
    flight(2).1
}

/// Mean stress error of a column shortened by 24 % over 16 cells, with splines of this order.
fn shortened(order: usize) -> f64 {
    let cells = 16;
    let load = 0.8;
    let h = 1.0 / f64::from(cells as u32);
    let young = 1.3 * 0.4 / 0.7;
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(h, 1, order), axis(h, cells, order)],
        hencky(young, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..1, 0..cells], 3, 1.0, |x| x * 0.0)
    .rollers([0])
    .support(Support::roller(1, false))
    .gravity(load, 20.0);
    scene.march(1.0, 20.0, |_, _| ());
    let points = &scene.points;
    let error = |p: usize| (points.sigma.at(p).0[1] + load * (1.0 - points.height(p))).abs();
    (0..points.len()).map(error).sum::<f64>() / points.len() as f64 / load
}

/// Cell-crossing noise of quadratic splines over that of linear ones, the control.
pub fn crossing_noise() -> Found {
    let linear = shortened(1);
    let quadratic = shortened(2);
    Found::Figure(
        quadratic / linear,
        format!("stress error {quadratic:.1e}, linear {linear:.1e}"),
    )
}

/// A square that spins ten times, 40 steps a turn: part of its angular momentum that is lost.
pub fn spinning() -> f64 {
    let centre = Vector::from([2.0, 2.0]);
    let omega = 1.0;
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(0.25, 16, 2), axis(0.25, 16, 2)],
        hencky(1e3, 0.3),
        Regime::Dynamic,
    )
    .body([6..10, 6..10], 2, 1.0, |x| {
        let r = x - centre;
        [-omega * r[1], omega * r[0]].into()
    });
    let momentum = |points: &Points<2>| {
        let v = &points.motion.as_ref().expect("dynamic").v;
        let of = |p: usize| {
            let r = points.x[p] - centre;
            points.mass[p] * (r[0] * v[p][1] - r[1] * v[p][0])
        };
        (0..points.len()).map(of).sum::<f64>()
    };
    let start = momentum(&scene.points);
    let turn = 2.0 * std::f64::consts::PI / omega;
    scene.march(turn / 40.0, 10.0 * turn, |_, _| ());
    1.0 - momentum(&scene.points) / start
}
