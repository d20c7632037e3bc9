//! Tests of axisymmetry: uniform strain, and Lamé's thick-walled cylinder.

use super::sections::{DENSITY, G, cut};
use crate::support::scene::{METHODS, Scene, axis, hencky, rms};
use crate::support::solver::Skyline;
use bsmpm::boundary::{Support, surface};
use bsmpm::control::Stepper;
use bsmpm::grid::{Grid, KnotVector};
use bsmpm::interactions::load::Load;
use bsmpm::kinematics::{Axisymmetric, Kinematics};
use bsmpm::material::Moduli;
use bsmpm::model::{AverageWeight, Regime};
use bsmpm::schedule::Schedule;
use bsmpm::stabilisation::Stabilisation;

type Round = Scene<Axisymmetric, 2>;

/// A disc pressed flat: its rim and its top move, the axis and the base do not; every stretch is the same everywhere.
/// With linear functions, of which N + r dN/dr is linear, the points' rule is exact and so is the stress.
#[test]
fn uniform_strain_is_exact_in_one_step_with_every_method() {
    for method in METHODS {
        let radial = 1.05;
        let axial = 0.9;
        let moving = |axis: usize, stretch: f64| {
            let mut face = Support::<2>::roller(axis, true);
            face.velocity[axis] = Some(stretch - 1.0);
            face
        };
        let mut scene = Round::new(
            [axis(0.25, 4, 1), axis(0.25, 4, 1)],
            hencky(1000.0, 0.3),
            Regime::QuasiStatic,
        )
        .body([0..4, 0..4], 2, 1.0, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(Support::roller(1, false))
        .support(moving(0, radial))
        .support(moving(1, axial))
        .stabilised(method);
        scene.model.criteria.force = 1e-12;
        let (scene, steps) = scene.solved(1.0, 1.0);
        let Moduli { lambda, mu } = scene.model.materials[0].elastic().moduli();
        let J: f64 = radial * radial * axial;
        let stress = |stretch: f64| (lambda * J.ln() + 2.0 * mu * stretch.ln()) / J;
        let expected = [stress(radial), stress(axial), stress(radial)];
        let error = |p: usize| {
            let sigma = scene.points.sigma.at(p).0;
            (0..3)
                .map(|k| (sigma[k] - expected[k]).abs())
                .fold(sigma[3].abs(), f64::max)
        };
        let worst = (0..scene.points.len()).map(error).fold(0.0, f64::max) / expected[1].abs();
        println!("{method:?}: {worst:.1e}");
        assert_eq!(steps.len(), 1);
        assert!(worst <= 1e-10, "{method:?}: {worst:e}");
    }
}

/// Relative error of the radial displacement (root of the mean square over the body), of a cylinder with inner radius 1
/// and outer radius 2 between smooth plates under a small pressure inside.
fn cylinder(cells: usize, method: Stabilisation) -> f64 {
    let inner = 1.0;
    let outer = 2.0;
    let pressure = 1e-7;
    let poisson = 0.3;
    let (_, scene) = wall(cells, method);
    // Lame (1852) in plane strain: u = A r + B/r.
    let factor = (1.0 + poisson) * pressure * inner * inner / (outer * outer - inner * inner);
    let exact = |r: f64| factor * ((1.0 - 2.0 * poisson) * r + outer * outer / r);
    let start: Vec<f64> = scene
        .points
        .x
        .iter()
        .zip(&scene.points.u)
        .map(|(x, u)| x[0] - u[0])
        .collect();
    rms(&scene.points, |p| scene.points.u[p][0] - exact(start[p])) / rms(&scene.points, |p| exact(start[p]))
}

/// The cell and the state of that cylinder, two cells high.
fn wall(cells: usize, method: Stabilisation) -> (f64, Round) {
    let inner = 1.0;
    let outer = 2.0;
    let pressure = 1e-7;
    let poisson = 0.3;
    let h = (outer - inner) / cells as f64;
    let columns = 3 * cells;
    let mut scene = Round::new(
        [axis(h, columns, 2), axis(h, 2, 2)],
        hencky(1.0, poisson),
        Regime::QuasiStatic,
    )
    .body([cells..2 * cells, 0..2], 3, 0.0, |x| x * 0.0)
    .rollers(1..2)
    .stabilised(method);
    scene.model.weighting = AverageWeight::Volume;
    let from = [inner, 0.0].into();
    let to = [inner, 2.0 * h].into();
    let points = surface::along::<Axisymmetric, 2>(&scene.model.grid, &from, &to, 3);
    (
        h,
        scene
            .load(Load::dead(points, [pressure, 0.0].into(), 1.0))
            .solved(1.0, 1.0)
            .0,
    )
}

/// Lamé (1852): displacement of a thick-walled elastic cylinder.
#[test]
fn a_thick_cylinder_under_pressure_converges_to_lame() {
    for method in [Stabilisation::None, Stabilisation::FBar, Stabilisation::ConsistentFBar] {
        let errors = [4, 8, 16].map(|cells| cylinder(cells, method));
        let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
        println!("{method:?}: {errors:?}, orders {orders:?}"); // measured 7.5e-5 at the finest, orders 1.97 to 1.99
        assert!(
            errors[2] <= 1e-4 && orders.iter().all(|&order| order >= 1.9),
            "{method:?}: {errors:?}"
        );
    }
}

/// A tube of the radii 1 and 2 whose pressure inside grows, in parts of Young's modulus: how far the outer points have
/// moved at the end or in the last state that was found, with the pressure there.
fn inflated(cells: usize, pressure: f64) -> (f64, f64) {
    let h = 1.0 / cells as f64;
    let mut scene = Round::new(
        [axis(h, 3 * cells, 2), axis(h, 2, 2)],
        hencky(1.0, 0.3),
        Regime::QuasiStatic,
    )
    .body([cells..2 * cells, 0..2], 3, 0.0, |x| x * 0.0)
    .rollers(1..2);
    let points = surface::along::<Axisymmetric, 2>(&scene.model.grid, &[1.0, 0.0].into(), &[1.0, 2.0 * h].into(), 3);
    scene = scene.load(Load {
        follows: true,
        ..Load::dead(points, [pressure, 0.0].into(), 1.0)
    });
    let schedule = Schedule::new(0.1, 1.0, []);
    let halo = scene.halo();
    let mut solver = Skyline::new(&scene.model.grid);
    let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
    while let Some(Ok(_)) = scene.advance(&mut stepper, &schedule, &halo, &mut solver) {
        scene.points.sort_by_cell(&scene.model.grid);
    }
    let outer = scene
        .points
        .u
        .iter()
        .zip(&scene.points.x)
        .max_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    (outer.expect("points").0[0], pressure * stepper.time())
}

/// Equilibrium of the same tube along the radius, integrated numerically with a tolerance of 1e-11: its outermost
/// points are moved so far by 0.1 E, and it bears no more than 0.148913 E.
#[test]
fn a_tube_bears_its_limit_pressure_and_no_more() {
    for (cells, exact) in [(4, 0.203_785), (8, 0.202_904)] {
        let (moved, _) = inflated(cells, 0.1);
        let (_, most) = inflated(cells, 0.15);
        println!("{cells}: {:.1e} {:.1e}", moved / exact - 1.0, most / 0.148_913 - 1.0);
        assert!((moved / exact - 1.0).abs() <= 2e-3, "{moved}");
        assert!((most / 0.148_913 - 1.0).abs() <= 1e-3, "{most}");
    }
}

/// Points with equal shares of a cell at the axis integrate what has degree 3 there nearly, and whatever their spread
/// is, the volume exactly.
#[test]
fn points_at_the_axis_are_spread_and_those_far_from_it_even() {
    for n in 2..=4 {
        let moment = |part: [f64; 2], degree: i32| {
            let spread = Axisymmetric::spread(0, part, n);
            let middle = 0.5 * (part[0] + part[1]);
            let width = part[1] - part[0];
            let off = |k: usize| spread * width * ((k as f64 + 0.5) / n as f64 - 0.5);
            let sum: f64 = (0..n).map(|k| (middle + off(k)).powi(degree)).sum();
            sum * width / n as f64
        };
        let exact = |[a, b]: [f64; 2], degree: i32| (b.powi(degree + 1) - a.powi(degree + 1)) / f64::from(degree + 1);
        let error = |part: [f64; 2], degree: i32| moment(part, degree) / exact(part, degree) - 1.0;
        for cell in 0..8 {
            let part = [0.5 * f64::from(cell), 0.5 * f64::from(cell + 1)];
            assert!(error(part, 1).abs() <= 1e-15);
        }
        let even = -0.25 / (n * n) as f64; // of r^2 in the cell at the axis
        assert!(
            (error([0.0, 0.5], 2) - even / 8.0).abs() <= 1e-15,
            "{n}: {}",
            error([0.0, 0.5], 2)
        );
        assert_eq!(Axisymmetric::spread(0, [2.0, 2.5], n), 1.0);
        assert_eq!(Axisymmetric::spread(1, [0.0, 0.5], n), 1.0);
    }
    assert_eq!(Axisymmetric::spread(0, [0.0, 0.5], 1), 1.0);
}

/// Largest relative error of the stress of a disc under a small pressure at its rim, at points within a quarter of its
/// radius.
fn disc(cells: usize, per_axis: usize) -> f64 {
    let h = 1.0 / cells as f64;
    let pressure = 1e-6;
    let mut scene = Round::new(
        [axis(h, cells + 1, 2), axis(h, 3, 2)],
        hencky(1.0, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..cells, 0..2], per_axis, 0.0, |x| x * 0.0)
    .support(Support::roller(0, false))
    .support(Support::roller(1, false));
    scene.model.weighting = AverageWeight::Volume;
    let from = [1.0, 0.0].into();
    let to = [1.0, 2.0 * h].into();
    let points = surface::along::<Axisymmetric, 2>(&scene.model.grid, &from, &to, per_axis);
    let (scene, _) = scene
        .load(Load::dead(points, [-pressure, 0.0].into(), 1.0))
        .solved(1.0, 1.0);
    let near = |p: &usize| scene.points.x[*p][0] < 0.25;
    let error = |p: usize| {
        let [radial, axial, around, ..] = scene.points.sigma.at(p).0;
        (radial + pressure)
            .abs()
            .max(axial.abs())
            .max((around + pressure).abs())
            / pressure
    };
    (0..scene.points.len()).filter(near).map(error).fold(0.0, f64::max)
}

/// However small the cells are, evenly spaced points leave 9.5, 5 and 3 % there.
#[test]
fn a_pressed_disc_has_uniform_stress_at_the_axis() {
    for (per_axis, least) in [(2, 4e-3), (3, 2e-3), (4, 1e-3)] {
        let errors = [4, 8].map(|cells| disc(cells, per_axis));
        println!("{per_axis}: {errors:?}");
        assert!(errors.iter().all(|error| *error <= least), "{per_axis}: {errors:?}");
    }
}

/// The volumes of cells and of functions of the order below add up to that of a sector of one radian, and a function's
/// is its own integral.
#[test]
fn volumes_of_cells_and_functions_are_those_of_the_sector() {
    for order in 1..=3 {
        let radial = KnotVector::graded(&[0.0, 0.3, 0.5, 0.5, 1.2], order).unwrap_or_else(|_| axis(0.3, 4, order));
        let grid = Grid::new([radial, axis(0.5, 3, order)]).unwrap();
        let whole = 0.5 * grid.axes()[0].length().powi(2) * 1.5;
        let cells: f64 = (0..grid.cells())
            .map(|cell| grid.cell_volume::<Axisymmetric>(&grid.cell_at(cell)))
            .sum();
        let functions: f64 = (0..grid.nodes())
            .map(|node| grid.lowered_volume::<Axisymmetric>(node))
            .sum();
        println!(
            "order {order}: {:.1e}, {:.1e}",
            cells / whole - 1.0,
            functions / whole - 1.0
        );
        assert!((cells / whole - 1.0).abs() <= 1e-14 && (functions / whole - 1.0).abs() <= 1e-14);
        assert_eq!(Axisymmetric::weight(&[0.7, 0.2].into()), 0.7);
        if order == 1 {
            continue; // functions that are constant in a cell have no Greville place
        }
        // sum_I r_I int N_I = int r dV, r_I the Greville places: the moment shows a wrong mean of a function.
        let r = |node: usize| grid.axes()[0].lowered_greville(grid.node_at(node)[0]);
        let moment: f64 = (0..grid.nodes())
            .map(|node| r(node) * grid.lowered_volume::<Axisymmetric>(node))
            .sum();
        let exact = grid.axes()[0].length().powi(3) / 3.0 * 1.5;
        assert!(
            (moment / exact - 1.0).abs() <= 1e-14,
            "order {order}: {moment} for {exact}"
        );
    }
}

/// A column of radius 1 m on a fixed base and a plate of radius 10 m and 1 m that its rim holds, four cells high, under
/// their own weight.
#[test]
fn section_forces_are_those_of_a_column_and_of_a_clamped_plate() {
    let h = 0.25;
    let poisson = 0.3;
    let heavy = |cells: [usize; 2], held: Support<2>| {
        let columns = if held.axis == 0 { cells[0] } else { cells[0] + 4 };
        let above = if held.axis == 0 { 4 } else { 0 };
        Round::new(
            [axis(h, columns, 2), axis(h, above + cells[1] + 4, 2)],
            hencky(1e11, poisson),
            Regime::QuasiStatic,
        )
        .body([0..cells[0], above..above + cells[1]], 3, DENSITY, |x| x * 0.0)
        .support(Support::roller(0, false))
        .support(held)
        .gravity(G, 0.0)
        .solved(1.0, 1.0)
        .0
    };
    let column = heavy([4, 12], Support::fixed(1, false));
    for z in [0.0, 0.1, 1.1, 1.5, 2.9] {
        let weight = |radius: f64| 0.5 * radius * radius * DENSITY * G * (3.0 - z);
        let whole = cut(&column, [[[1.2, z], [0.0, z]]]).normal / -weight(1.0);
        let inner = cut(&column, [[[0.5, z], [0.0, z]]]).normal / -weight(0.5);
        println!("column z {z}: N {whole:.6}, within half of the radius {inner:.4} of the weight");
        // Points at the axis, which are spread, reach beyond the line's end there: 3.5e-4 is lost. A line that ends
        // in the column is off by 2 to 4.5 %, and at its base the inner half carries what the held surface leaves it.
        assert!((whole - 1.0).abs() < 4e-4 && (z < 1.0 || (inner - 1.0).abs() < 5e-2));
    }
    let plate = heavy([40, 4], Support::fixed(0, true));
    let radius = 10.0;
    let weight = DENSITY * G;
    let clamped = weight * radius * radius / 8.0;
    for r in [1.0, 2.6, 5.0, 7.5, 9.0, 10.0] {
        let found = cut(&plate, [[[r, 0.9], [r, 2.1]]]);
        // Timoshenko and Woinowsky-Krieger (1959), per length of the circle; the upper side is in tension at the rim.
        let moment = weight / 16.0 * (r * r * (3.0 + poisson) - radius * radius * (1.0 + poisson));
        let off = [
            found.normal / (clamped * r),
            found.shear[0] / (0.5 * weight * r * r) - 1.0,
        ];
        let bent = (found.bending[0] / r - moment) / clamped;
        println!(
            "plate r {r}: N {:.1e}, Q {:.1e}, M {bent:.1e} of that at the rim",
            off[0], off[1]
        );
        // A cut is spread over a cell, and so is the weight within it: 0.17 (h/r)^2 at lines of cells, 0.41 at 2.6 m.
        assert!(off[0].abs() < 1e-4 && off[1].abs() < 0.5 * (h / r).powi(2) + 2e-4 && bent.abs() < 4e-3);
    }
}

/// From wall to wall: N = r sigma_rr times the height by Lame (1852), of a radian.
#[test]
fn the_normal_force_across_cylinders_in_a_wall_is_that_of_lame() {
    let inner = 1.0;
    let outer = 2.0;
    let pressure = 1e-7;
    for (cells, tolerance) in [(8, 3e-2), (16, 5e-3)] {
        let (h, scene) = wall(cells, Stabilisation::None);
        let factor = pressure * inner * inner / (outer * outer - inner * inner);
        for r in [inner, 1.02, 1.2, 1.5, 1.97, outer] {
            let found = cut(&scene, [[[r, 0.0], [r, 2.0 * h]]]);
            let expected = 2.0 * h * r * factor * (1.0 - outer * outer / (r * r));
            let off = (found.normal - expected) / (2.0 * h * inner * pressure);
            println!("{cells} cells, r {r}: N off by {off:.1e} of that inside");
            assert!(off.abs() < tolerance && found.shear[0].abs() < 1e-9 * pressure);
        }
    }
}
