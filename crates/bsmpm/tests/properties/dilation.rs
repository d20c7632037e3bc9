//! Tests of the volume averages of F-bar, their linearisation, and the filter of the elastic volume strain.

use crate::support::random::Random;
use crate::support::scene::{METHODS, Scene, axis, hencky};
use bsmpm::grid::{Grid, KnotVector, Shape, transfer};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::model::Regime;
use bsmpm::points::{Points, Seed};
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::problem::Problem;
use bsmpm::step::smooth;
use bsmpm::step::trial::DeformationIncrement;
use bsmpm::tensor::{Symmetric, Tensor, Vector};

/// Points of different mass at scattered places of a graded grid, deformed.
fn deformed<K: Kinematics<D>, const D: usize>(order: usize, method: Stabilisation) -> Scene<K, D> {
    let graded = KnotVector::graded(&[0.0, 0.2, 0.7, 0.8, 2.0], order).unwrap();
    let axes = std::array::from_fn(|k| if k == 0 { graded.clone() } else { axis(0.4, 3, order) });
    let mut random = Random::new(order as u64);
    let mut scene = Scene::<K, D>::new(axes, hencky(1.0, 0.3), Regime::QuasiStatic).stabilised(method);
    let cells = std::array::from_fn(|k| 0..scene.model.grid.axes()[k].cells());
    scene = scene.body(cells, 2, 3.0, |_| Vector::zeros());
    let points = &mut scene.points;
    for p in 0..points.len() {
        points.x[p] += random.vector::<D>() * 0.01;
        points.mass[p] *= 1.0 + 0.5 * random.signed();
        points.F.set(p, Tensor::identity() * (1.0 + 0.1 * random.signed()));
    }
    scene.points.sort_by_cell(&scene.model.grid);
    scene
}

/// Largest distance between the rate of ln ratio and its central difference.
fn rate_error<K: Kinematics<D>, const D: usize>(order: usize, method: Stabilisation) -> f64 {
    let scene = deformed::<K, D>(order, method);
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let pieces = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let mut random = Random::new(7);
    let u: Vec<f64> = random.array(model.grid.nodes() * D).iter().map(|u| 0.02 * u).collect();
    let du = random.array(u.len());
    let trial = |step: f64| {
        let u: Vec<f64> = u.iter().zip(&du).map(|(u, du)| u + step * du).collect();
        DeformationIncrement::of(model, &shape, &nodes, points, &u, &halo)
    };
    let at = trial(0.0);
    let trace = transfer::gradients::<K, D, _>(&shape, &scene.points.x, &du, |p, grad| {
        (K::gradient::<f64>(&grad) * at.dF(p).try_inverse().expect("sound")).trace()
    });
    let rate = at.dilation_rate(&pieces, &trace).expect("averaged");
    let step = 1e-6;
    let after = trial(step);
    let before = trial(-step);
    let difference = |p: usize| (after.ratio(p) / before.ratio(p)).ln() / (2.0 * step);
    let size = rate.iter().fold(0.0_f64, |size, rate| size.max(rate.abs()));
    (0..points.len())
        .map(|p| (rate[p] - difference(p)).abs() / size)
        .fold(0.0, f64::max)
}

#[test]
fn the_rate_of_the_ratio_is_its_derivative() {
    for method in METHODS.into_iter().filter(|method| method.averages()) {
        for order in 1..=3 {
            let errors = [
                rate_error::<PlaneStrain, 2>(order, method),
                rate_error::<Solid, 3>(order, method),
            ];
            println!("{method:?}, order {order}: {errors:?}");
            assert!(errors.iter().all(|&error| error <= 1e-9)); // measured 1.2e-10
        }
    }
}

/// Every function of the degree below at every point is the one of a grid of that degree, under the same number.
fn lowered_error<const D: usize>(order: usize) -> f64 {
    let graded = [0.0, 0.2, 0.7, 0.8, 2.0];
    let grid = |order: usize| {
        let along = |k: usize| match k {
            0 => KnotVector::graded(&graded, order).unwrap(),
            _ => axis(0.4, 3, order),
        };
        Grid::<D>::new(std::array::from_fn(along)).unwrap()
    };
    let upper = grid(order);
    let own = grid(order - 1);
    let mut random = Random::new(3);
    let extent = Vector::<D>::from_fn(|k, _| if k == 0 { 2.0 } else { 1.2 });
    let seed = |id| {
        let x = extent.map(|length| length * random.unit());
        Seed {
            id,
            material: 0,
            x,
            volume: 1.0,
            mass: 1.0,
            v: Vector::zeros(),
        }
    };
    let mut points = Points::from_seeds((0..200).map(seed), false);
    points.sort_by_cell(&upper);
    let lowered = Shape::at(&upper, &points).unwrap().lowered(&upper, &points);
    let exact = Shape::at(&own, &points).unwrap();
    let mut worst = 0.0_f64;
    for (low, patch) in lowered.patches().iter().zip(exact.patches()) {
        assert_eq!((low.cell, &low.points), (patch.cell, &patch.points));
        let number = |grid: &Grid<D>, first: usize, offset: &usize| grid.node_at(first + offset);
        let numbers = |grid, first, shape: &Shape<D>| -> Vec<_> {
            shape
                .offsets()
                .iter()
                .map(|offset| number(grid, first, offset))
                .collect()
        };
        assert_eq!(
            numbers(&upper, low.first_node, &lowered),
            numbers(&own, patch.first_node, &exact)
        );
        for p in low.points.clone() {
            for (N, (exact, _)) in lowered.values_of(p).into_iter().zip(exact.of(p)) {
                worst = worst.max((N - exact).abs());
            }
        }
    }
    worst
}

#[test]
fn the_lowered_splines_are_those_of_the_degree_below_under_the_same_numbers() {
    for order in 2..=3 {
        assert_eq!(lowered_error::<2>(order), 0.0);
        assert_eq!(lowered_error::<3>(order), 0.0);
    }
}

#[test]
fn below_linear_splines_a_cell_has_one_function_that_is_1() {
    let scene = deformed::<Solid, 3>(1, Stabilisation::ConsistentFBar);
    let shape = Shape::at(&scene.model.grid, &scene.points)
        .unwrap()
        .lowered(&scene.model.grid, &scene.points);
    assert_eq!(shape.offsets(), [0]);
    assert!((0..shape.len()).all(|p| shape.values_of(p) == [1.0]));
}

/// Points of a row of cells with elastic strains of `spread`; those left of x = 4 flow.
fn flowing(spread: f64) -> Scene<PlaneStrain, 2> {
    let mut random = Random::new(9);
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(1.0, 12, 2), axis(1.0, 3, 2)],
        hencky(1.0, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..12, 0..3], 2, 1.0, |_| Vector::zeros())
    .stabilised(Stabilisation::ConsistentFBar);
    let soil = MohrCoulomb::new(
        Elastic {
            young: 1.0,
            poisson: 0.3,
        },
        0.0,
        0.0,
        0.01,
    );
    scene.model.materials = vec![Material::MohrCoulomb(soil).into()];
    for p in 0..scene.points.len() {
        let volume = spread * random.signed();
        let shear = if scene.points.x[p][0] < 4.0 { 0.05 } else { 1e-4 };
        let b = |eps: f64| (2.0 * eps).exp();
        scene.points.b_e.set(
            p,
            Symmetric([b(volume + shear), b(volume - shear), b(volume), 0.0, 0.0, 0.0]),
        );
    }
    scene
}

/// tr eps^e and the deviator of eps^e of diagonal b^e.
fn strain(b_e: &Symmetric) -> (f64, [f64; 3]) {
    let eps = [0, 1, 2].map(|k| 0.5 * b_e.0[k].ln());
    let volume: f64 = eps.iter().sum();
    (volume, eps.map(|eps| eps - volume / 3.0))
}

#[test]
fn the_filter_smooths_the_elastic_dilation_where_the_material_flows_and_nothing_else() {
    let mut scene = flowing(0.002);
    let halo = scene.halo();
    let shape = Shape::at(&scene.model.grid, &scene.points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let mut flow = Vec::new();
    for p in 0..scene.points.len() {
        let response = scene.model.respond(&scene.points, p, &scene.points.b_e.at(p)).unwrap();
        flow.push(smooth::PlasticFlow::of(&response, 0.0));
        scene.points.b_e.set(p, response.b_e());
    }
    let before = scene.points.b_e.clone();
    let share = smooth::filter_dilation(&scene.model, &shape, &nodes, &mut scene.points, &flow, &halo);
    assert!(share > 0.0 && share < 1.0, "{share}");
    let mut changed = 0.0_f64;
    let mut fluctuation = [0.0, 0.0];
    for (p, b_e) in before.iter().enumerate() {
        let (volume, deviator) = strain(&b_e);
        let (filtered, kept) = strain(&scene.points.b_e.at(p));
        changed = (0..3).map(|k| (deviator[k] - kept[k]).abs()).fold(changed, f64::max);
        match scene.points.x[p][0] {
            x if x < 4.0 => fluctuation = [fluctuation[0] + volume.powi(2), fluctuation[1] + filtered.powi(2)],
            // A flowing point is seen two cells off, and its share two more.
            x if x > 9.0 => assert_eq!(scene.points.b_e.at(p), b_e),
            _ => (),
        }
    }
    println!("deviator changes by {changed:.1e}, fluctuation from {fluctuation:?}");
    assert!(changed <= 1e-15); // measured 2e-16
    assert!(fluctuation[1] <= 0.2 * fluctuation[0]); // measured 0.11
}

#[test]
fn without_flow_the_filter_leaves_every_bit() {
    let mut scene = flowing(1e-4);
    scene.model.materials = vec![hencky(1.0, 0.3).into()];
    let before = scene.points.clone();
    let halo = scene.halo();
    let shape = Shape::at(&scene.model.grid, &scene.points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let respond = |p: usize| scene.model.respond(&before, p, &before.b_e.at(p)).unwrap();
    let flow: Vec<_> = (0..before.len())
        .map(|p| smooth::PlasticFlow::of(&respond(p), 0.0))
        .collect();
    let share = smooth::filter_dilation(&scene.model, &shape, &nodes, &mut scene.points, &flow, &halo);
    assert_eq!((share, scene.points), (0.0, before));
}

/// Mean of a value of every point that F-bar puts into its place.
fn means<K: Kinematics<D>, const D: usize>(scene: &Scene<K, D>, value: &[f64]) -> Vec<f64> {
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    nodes.mean_dilation(model, &shape, points, &halo, |p| value[p])
}

/// Body in cells of 0.5 x 0.4 m, `filled` of 8 x 7, 3 x 3 points each, the points of different mass and off the
/// lattice.
fn scattered(axes: [KnotVector; 2], method: Stabilisation, filled: [usize; 2]) -> Scene<PlaneStrain, 2> {
    let mut scene = Scene::<PlaneStrain, 2>::new(axes, hencky(1.0, 0.3), Regime::QuasiStatic).stabilised(method);
    let mut random = Random::new(4);
    let mut seeds = Vec::new();
    for k in 0..9 * filled[0] * filled[1] {
        let lattice = Vector::<2>::new(
            (k % (3 * filled[0])) as f64 / 6.0,
            (k / (3 * filled[0])) as f64 * 0.4 / 3.0,
        );
        let x = lattice + Vector::<2>::new(0.06, 0.05) + random.vector::<2>() * 0.04;
        let mass = 1.0 + 0.5 * random.signed();
        seeds.push(Seed {
            id: k as u64,
            material: 0,
            x,
            volume: 1.0,
            mass,
            v: Vector::zeros(),
        });
    }
    scene.points = Points::from_seeds(seeds, false);
    scene.points.sort_by_cell(&scene.model.grid);
    scene
}

#[test]
fn over_pairs_of_cells_the_average_is_that_of_the_coarser_grid_inside_and_of_the_grid_at_an_edge() {
    for order in 1..=3 {
        let fine = || [axis(0.5, 8, order), axis(0.4, 6, order)];
        let coarse = [axis(1.0, 4, order), axis(0.8, 3, order)];
        // It fills the grid up to its faces, which cut no cell.
        let value = |scene: &Scene<PlaneStrain, 2>| -> Vec<f64> {
            scene
                .points
                .x
                .iter()
                .map(|x| (3.0 * x[0]).sin() + (5.0 * x[1]).cos())
                .collect()
        };
        let by_id = |scene: &Scene<PlaneStrain, 2>| {
            let mut means: Vec<_> = scene
                .points
                .id
                .iter()
                .copied()
                .zip(means(scene, &value(scene)))
                .collect();
            means.sort_by_key(|(id, _)| *id);
            means
        };
        let whole = [Stabilisation::SubgridFBar, Stabilisation::ConsistentFBar]
            .map(|method| by_id(&scattered(fine(), method, [8, 6])));
        let twice = by_id(&scattered(coarse, Stabilisation::ConsistentFBar, [8, 6]));
        let distance =
            |a: &[(u64, f64)], b: &[(u64, f64)]| a.iter().zip(b).map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
        assert!(distance(&whole[0], &twice) <= 1e-13, "order {order}");
        assert!(distance(&whole[0], &whole[1]) >= 1e-2, "order {order}");
        // A row of cells is empty: at that edge the average is the one of the grid.
        let cut =
            [Stabilisation::SubgridFBar, Stabilisation::ConsistentFBar].map(|method| scattered(fine(), method, [8, 5]));
        let at_edge: Vec<u64> = cut[0]
            .points
            .id
            .iter()
            .zip(&cut[0].points.x)
            .filter(|(_, x)| x[1] > 1.6)
            .map(|(id, _)| *id)
            .collect();
        let found = cut.each_ref().map(by_id);
        let edge = found
            .each_ref()
            .map(|means| -> Vec<(u64, f64)> { means.iter().filter(|(id, _)| at_edge.contains(id)).copied().collect() });
        assert!(
            !at_edge.is_empty() && distance(&edge[0], &edge[1]) <= 1e-14,
            "order {order}"
        );
        assert!(
            distance(&found[0], &found[1]) >= 1e-2,
            "order {order}: inside it is another"
        );
    }
}

#[test]
fn over_pairs_of_cells_the_average_keeps_constants_and_is_symmetric() {
    // Stretches of an odd number of cells, cells of unlike length, a repeated breakpoint, and a free edge.
    let breakpoints = [0.0, 0.5, 1.0, 1.3, 1.3, 2.0, 2.6, 3.2, 4.0, 4.5];
    for order in 2..=3 {
        let axes = [KnotVector::graded(&breakpoints, order).unwrap(), axis(0.4, 7, order)];
        let scene = scattered(axes, Stabilisation::SubgridFBar, [8, 5]);
        let ones = means(&scene, &vec![1.0; scene.points.len()]);
        assert!(ones.iter().all(|one| (one - 1.0).abs() <= 1e-14), "order {order}");
        let mut random = Random::new(8);
        let a = random.array(ones.len());
        let b = random.array(ones.len());
        let mean_a = means(&scene, &a);
        let mean_b = means(&scene, &b);
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter()
                .zip(b)
                .zip(&scene.points.mass)
                .map(|((a, b), mass)| a * b * mass)
                .sum()
        };
        let left = product(&a, &mean_b);
        let right = product(&mean_a, &b);
        assert!(
            (left - right).abs() <= 1e-12 * product(&a, &a),
            "order {order}: {left} {right}"
        );
        assert!(product(&a, &mean_a) > 0.0 && product(&mean_a, &mean_a) < product(&a, &mean_a));
    }
}
