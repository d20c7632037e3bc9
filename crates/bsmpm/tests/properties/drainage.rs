//! Tests of drains and inflows: water balance, motion of their surface points, and several ranks.

mod ranks;

use crate::support::scene::{Scene, axis, hencky};
use crate::support::solver::Dense;
use bsmpm::boundary::{Anchors, Support, SurfacePoint, surface};
use bsmpm::error::StepError;
use bsmpm::field::pore_water::Water;
use bsmpm::field::pore_water::ambient::Ambient;
use bsmpm::field::pore_water::backward::Differences;
use bsmpm::field::pore_water::drain::Drainage;
use bsmpm::field::pore_water::flow::{Course, Drain, Flow, Given, Inflow, Motion, Permeability, PermeabilityLaw, Soil};
use bsmpm::grid::{Contributions, Grid};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::linear::MatrixAssembly;
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::schedule::TimeInterval;
use bsmpm::tensor::{Tensor, Vector};

type Plane = Scene<PlaneStrain, 2>;

const WEIGHT: f64 = 9810.0;
const K: [f64; 2] = [3e-6, 1e-6];
const CELL: f64 = 0.25;
const DT: f64 = 20.0;
/// m3/(Pa m2 s)  of a drain between these places: 1e2 k/(gamma_w h), k that across it.
fn conductance([from, to]: [Vector<2>; 2]) -> f64 {
    let along = (to - from).normalize();
    1e2 * (K[0] * along[1].powi(2) + K[1] * along[0].powi(2)) / (WEIGHT * CELL)
}

fn at(x: f64, y: f64) -> Vector<2> {
    Vector::<2>::new(x, y)
}

fn soil(law: PermeabilityLaw) -> Soil<2> {
    Soil {
        porosity: 0.4,
        permeability: Some(Permeability { along: K.into(), law }),
        retention: None,
    }
}

/// Two columns of 4 cells beside each other, in a grid with two further cells around, of soil with this law; water
/// crosses the line from one place to the other, as the given pressure says, and is put in there at the same time.
fn scene(order: usize, law: PermeabilityLaw, [from, to]: [Vector<2>; 2], given: Given) -> Plane {
    let axes = [axis(CELL, 8, order), axis(CELL, 8, order)];
    let mut scene =
        Plane::new(axes, hencky(1e6, 0.2), Regime::QuasiStatic).body([2..6, 2..6], 3, 1.0, |_| at(0.0, 0.0));
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &from, &to, 3);
    let along = (to - from).normalize();
    let normals = vec![at(-along[1], along[0]); points.len()];
    let flow = Flow {
        bulk: f64::INFINITY,
        soils: vec![Some(soil(law))],
        drains: vec![Drain {
            points: points.clone(),
            normals: normals.clone(),
            given,
            acts: true,
        }],
        faces: Vec::new(),
        inflows: vec![Inflow {
            points,
            normals,
            rate: Course(vec![(0.0, 2e-7), (2.0 * DT, 4e-7)]),
            runs_off: false,
            acts: true,
        }],
        suction: 0.0,
        motion: Motion::Flows,
    };
    scene.model.water = Some(Water {
        unit_weight: WEIGHT,
        ambient: Ambient::None,
        flow: Some(flow),
    });
    scene
}

/// The sloping surface of the bodies that are cut below.
const SLOPE: [[f64; 2]; 2] = [[0.5, 1.1], [1.5, 0.85]];

fn slope() -> [Vector<2>; 2] {
    SLOPE.map(Vector::from)
}

/// Coefficients of a linear function in the splines of degree q - 1, at the nodes that have their numbers: its values
/// in the means of the inner knots. Further nodes have no function.
fn linear(grid: &Grid<2>, value: impl Fn(&Vector<2>) -> f64) -> (Vec<f64>, Vec<Vector<2>>) {
    let q = grid.order();
    let place = |axis: usize, i: usize| {
        let knots = &grid.axes()[axis];
        let inner = (i + 2..=i + q).filter(|&i| i < knots.functions() + q + 1);
        inner.map(|i| knots.knot(i)).sum::<f64>() / (q - 1) as f64
    };
    let places: Vec<Vector<2>> = (0..grid.nodes())
        .map(|node| {
            let node = grid.node_at(node);
            at(place(0, node[0]), place(1, node[1]))
        })
        .collect();
    (places.iter().map(value).collect(), places)
}

fn no_water(_: &Vector<2>) -> f64 {
    0.0
}

fn drainage(scene: &Plane) -> Result<Drainage, StepError> {
    Drainage::at(
        &scene.model,
        scene.anchored(),
        TimeInterval { start: 0.0, dt: DT },
        Differences::EULER,
        |_| true,
        no_water,
        &scene.halo(),
    )
}

/// What leaves the ground in a step at every node, m3.
fn out(grid: &Grid<2>, drainage: &Drainage, p: &[f64]) -> Vec<f64> {
    let mut out = Contributions::none(grid, 1, Vec::new());
    drainage.add_to(p, &mut out);
    out.alone()
}

#[test]
fn a_linear_pressure_gives_the_exact_flux_and_its_moment() {
    for order in [2, 3] {
        let head = Given::Head(Course(vec![(0.0, 1.0), (2.0 * DT, 2.0)]));
        let scene = scene(order, PermeabilityLaw::Constant, slope(), head);
        let grid = &scene.model.grid;
        let field = |x: &Vector<2>| 700.0 - 300.0 * x[0] + 900.0 * x[1];
        let still = |x: &Vector<2>| 200.0 * x[0];
        let (p, places) = linear(grid, field);
        let drainage = Drainage::at(
            &scene.model,
            scene.anchored(),
            TimeInterval { start: 0.0, dt: DT },
            Differences::EULER,
            |_| true,
            still,
            &scene.halo(),
        )
        .expect("permeable");
        // A head of 1.5 m at the end of the step, the still water's pressure taken off; the mean of a rate.
        let [from, to] = slope();
        let middle = (from + to) / 2.0;
        let length = (to - from).norm();
        let excess = |x: &Vector<2>| field(x) - WEIGHT * (1.5 - x[1]) + still(x);
        let drained = DT * conductance(slope()) * excess(&middle) * length;
        let put_in = DT * 2.5e-7 * length;
        let [drains, inflows] = drainage.report(&p, &scene.halo());
        let near = |value: f64, exact: f64| {
            println!("order {order}: flux off by {:.1e}", value / exact - 1.0);
            assert!((value - exact).abs() <= 1e-12 * exact.abs(), "{value} {exact}")
        };
        near(drains[0].through, drained);
        near(inflows[0].through, put_in);
        let points = scene.model.surfaces().water[0].len();
        assert_eq!([drains[0].held, inflows[0].held], [points; 2]);
        let out = out(grid, &drainage, &p);
        near(out.iter().sum(), drained - put_in);
        // Linear functions see where it leaves: the points' moments, which no function of the pressure changes.
        let points = scene.model.surfaces().water[0].iter();
        let of = |point: &SurfacePoint<2>| DT * point.area * (conductance(slope()) * excess(&point.x) - 2.5e-7);
        let exact = points
            .map(|point| point.x * of(point))
            .fold(at(0.0, 0.0), |sum, moment| sum + moment);
        let moment = out
            .iter()
            .zip(&places)
            .fold(at(0.0, 0.0), |sum, (out, x)| sum + x * *out);
        assert!((moment - exact).norm() <= 1e-12 * exact.norm(), "{moment:?} {exact:?}");
    }
}

#[test]
fn the_matrix_is_the_derivative_of_the_terms() {
    let scene = scene(
        2,
        PermeabilityLaw::Constant,
        slope(),
        Given::Pressure(Course(vec![(0.0, 5e3)])),
    );
    let grid = &scene.model.grid;
    let drainage = drainage(&scene).expect("permeable");
    let mut matrix = Dense::of_patches(1, grid.lowered_offsets());
    matrix.reinit(&vec![true; grid.nodes()]);
    let (p, _) = linear(grid, |x| (7.0 * x[0]).sin() * 1e3 + x[1].powi(2) * 4e3);
    let now = out(grid, &drainage, &p);
    let none = out(grid, &drainage, &vec![0.0; p.len()]);
    drainage.assemble(&p, &mut matrix);
    let largest = now.iter().fold(0.0_f64, |most, out| most.max(out.abs()));
    for (node, by_matrix) in matrix.multiply(&p).iter().enumerate() {
        let change = now[node] - none[node];
        assert!((by_matrix - change).abs() <= 1e-13 * largest);
    }
    assert!(largest > 0.0);
}

/// Deforms the body about (1, 1) m.
fn deform(points: &mut Points<2>, F: [[f64; 2]; 2]) {
    let mut whole = Tensor::identity();
    (0..4).for_each(|k| whole[(k / 2, k % 2)] = F[k / 2][k % 2]);
    for p in 0..points.len() {
        let x = deformed(F, &points.x[p]);
        points.u[p] += x - points.x[p];
        points.x[p] = x;
        points.F.set(p, whole);
    }
}

fn deformed(F: [[f64; 2]; 2], x: &Vector<2>) -> Vector<2> {
    let d = x - at(1.0, 1.0);
    at(
        1.0 + F[0][0] * d[0] + F[0][1] * d[1],
        1.0 + F[1][0] * d[0] + F[1][1] * d[1],
    )
}

#[test]
fn surfaces_turn_and_stretch_with_their_material() {
    let turned = [[0.8, -0.6], [0.6, 0.8]];
    let bent = [[0.9, 0.3], [-0.2, 0.7]];
    for (F, law) in [
        (turned, PermeabilityLaw::Constant),
        (bent, PermeabilityLaw::Constant),
        (bent, PermeabilityLaw::KozenyCarman),
    ] {
        let mut scene = scene(2, law, slope(), Given::Pressure(Course(vec![(0.0, 50.0)])));
        deform(&mut scene.points, F);
        scene.points.sort_by_cell(&scene.model.grid);
        let field = |x: &Vector<2>| 700.0 - 300.0 * x[0] + 900.0 * x[1];
        let (p, _) = linear(&scene.model.grid, field);
        let [drains, inflows] = drainage(&scene).expect("permeable").report(&p, &scene.halo());
        let [from, to] = slope().map(|x| deformed(F, &x));
        let length = (to - from).norm();
        let J: f64 = F[0][0] * F[1][1] - F[0][1] * F[1][0];
        let n = 1.0 - 0.6 / J;
        let of = |n: f64| n.powi(3) / (1.0 - n).powi(2);
        let relative = if law == PermeabilityLaw::Constant {
            1.0
        } else {
            of(n) / of(0.4)
        };
        let exact = DT * conductance([from, to]) * relative * length * (field(&((from + to) / 2.0)) - 50.0);
        assert!(
            (drains[0].through / exact - 1.0).abs() <= 1e-12,
            "{} {exact}",
            drains[0].through
        );
        assert!((inflows[0].through / (DT * 2.5e-7 * length) - 1.0).abs() <= 1e-12);
    }
}

#[test]
fn the_points_that_a_surface_is_anchored_to_are_carried_and_replaced() {
    let mut scene = scene(2, PermeabilityLaw::Constant, slope(), Given::StillWater);
    let anchors = |scene: &Plane, carried: &Anchors| {
        Anchors::of(&scene.model.surfaces(), carried, scene.points.anchored(), &scene.halo())
    };
    let first = anchors(&scene, &Anchors::default());
    assert_eq!(first.water.len(), 2);
    assert_eq!(
        first.water[0], first.water[1],
        "a drain and an inflow at the same places"
    );
    // Found by where the points were at the start, whatever has become of them.
    deform(&mut scene.points, [[0.0, -1.0], [1.0, 0.0]]);
    assert_eq!(anchors(&scene, &Anchors::default()), first);
    let carried = Anchors {
        water: vec![vec![7; 3]],
        ..Anchors::default()
    };
    assert_eq!(anchors(&scene, &carried), carried);
    // Where one goes, the nearest of those that stay takes its place, and the others stay.
    let gone = first.water[0][2];
    scene.points.remove(|id| id == gone);
    let after = first.without(
        &scene.model.surfaces(),
        |id| id == gone,
        scene.points.anchored(),
        &scene.halo(),
    );
    for (before, after) in first.water.iter().flatten().zip(after.water.iter().flatten()) {
        assert_eq!(*before != gone, before == after);
    }
}

#[test]
fn water_goes_through_no_surface_without_material_near_nor_one_of_tight_soil() {
    let mut scene = scene(
        2,
        PermeabilityLaw::Constant,
        slope(),
        Given::Pressure(Course(vec![(0.0, 50.0)])),
    );
    let (p, _) = linear(&scene.model.grid, |_| 1e3);
    // Only the functions left of 1 m count.
    let grid = scene.model.grid.clone();
    let left = |node: usize| grid.node_at(node)[0] <= 4;
    let some = Drainage::at(
        &scene.model,
        scene.anchored(),
        TimeInterval { start: 0.0, dt: DT },
        Differences::EULER,
        left,
        no_water,
        &scene.halo(),
    )
    .expect("permeable");
    let [drains, inflows] = some.report(&p, &scene.halo());
    let near = scene.model.surfaces().water[0]
        .iter()
        .filter(|point| point.x[0] < 1.0 + 0.75 * CELL)
        .count();
    assert_eq!([drains[0].held, inflows[0].held], [near; 2]);
    let all = out(&grid, &some, &p);
    assert!((0..grid.nodes()).all(|node| left(node) || all[node] == 0.0));
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("water flows");
    flow.soils.push(Some(Soil {
        porosity: 0.4,
        permeability: None,
        retention: None,
    }));
    scene = scene.with(hencky(1e6, 0.2), |x| x[0] > 1.2);
    // The columns of points beside 1.2 m are at 1.125 and 1.2083 m: half way begins what is nearest to the tight ones.
    let tight = scene.model.surfaces().water[0]
        .iter()
        .filter(|point| point.x[0] > 7.0 / 6.0)
        .count();
    assert_eq!(
        drainage(&scene).expect_err("tight"),
        StepError::Undrained {
            drain: 0,
            points: tight
        }
    );
}

#[test]
fn a_surface_that_is_found_beyond_a_face_is_on_it_where_that_holds_the_ground() {
    let mut scene = scene(2, PermeabilityLaw::Constant, slope(), Given::StillWater);
    let top = scene.model.grid.axes()[1].length();
    let above = |beyond: f64| at(1.0, top + beyond);
    assert_eq!(
        scene.model.boundary.kept_in(&scene.model.grid, above(0.01)),
        above(0.01)
    );
    scene.model.boundary.supports = vec![Support::roller(1, true), Support::roller(0, false)];
    let kept = |x: Vector<2>| scene.model.boundary.kept_in(&scene.model.grid, x);
    assert_eq!(
        [above(0.01), above(-0.01), at(-1e-3, 0.5)].map(kept),
        [above(0.0), above(-0.01), at(0.0, 0.5)]
    );
}
