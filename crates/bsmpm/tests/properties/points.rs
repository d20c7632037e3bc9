//! The columns of the points: canonical order, and bit by bit through a message.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use bsmpm::points::Points;
use bsmpm::tensor::{Symmetric, Tensor};

/// Points whose every number is different, also NaN-free extremes.
fn varied(regime: Regime) -> Scene<PlaneStrain, 2> {
    let mut random = Random::new(1);
    let mut scene = Scene::new([axis(0.5, 6, 2), axis(0.25, 4, 2)], hencky(1.0, 0.2), regime);
    scene = scene.body([1..5, 0..3], 3, 2.0, |x| x * 0.7);
    let points = &mut scene.points;
    for p in 0..points.len() {
        points.x[p] += random.vector::<2>() * 0.05;
        points.u[p] = random.vector::<2>() * 1e-200;
        points.material[p] = (random.unit() * 65535.0) as u16;
        points.mass[p] *= random.unit();
        points.volume[p] *= random.unit();
        points.F[p] = Tensor::from_fn(|_, _| random.signed());
        points.b_e[p] = Symmetric(std::array::from_fn(|_| random.signed()));
        points.sigma[p] = Symmetric(std::array::from_fn(|_| 1e200 * random.signed()));
        points.eps_p[p] = -0.0;
        if let Some(motion) = &mut points.motion {
            motion.a[p] = random.vector();
        }
    }
    points.dilation = (regime == Regime::QuasiStatic).then(|| random.array(points.len()));
    points.gap = (regime == Regime::Dynamic).then(|| random.array(points.len()));
    points.sort_by_cell(&scene.model.grid);
    scene
}

fn shuffled(points: &Points<2>, seed: u64) -> Points<2> {
    let mut random = Random::new(seed);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, (random.unit() * (i + 1) as f64) as usize);
    }
    let mut points = points.clone();
    points.columns().into_iter().for_each(|column| column.reorder(&order));
    points
}

#[test]
fn sorting_is_canonical_whatever_the_order_before() {
    for regime in [Regime::Dynamic, Regime::QuasiStatic] {
        let scene = varied(regime);
        for seed in 0..10 {
            let mut points = shuffled(&scene.points, seed);
            assert_ne!(points, scene.points);
            points.sort_by_cell(&scene.model.grid);
            assert_eq!(points, scene.points);
        }
    }
}

#[test]
fn sorted_points_ascend_by_cell_then_id_and_those_outside_the_window_come_last() {
    let scene = varied(Regime::Dynamic);
    let window = scene.model.grid.window(2..4);
    let mut points = shuffled(&scene.points, 3);
    points.x[0][0] = -1.0;
    points.sort_by_cell(&window);
    let key = |p: usize| match window.locate(&points.x[p]) {
        Some(cell) if (2..4).contains(&cell[0]) => (window.cell_index(&cell), points.id[p]),
        _ => (usize::MAX, points.id[p]),
    };
    let keys: Vec<_> = (0..points.len()).map(key).collect();
    assert!(keys.is_sorted());
    assert!(keys[0].0 == 0 && keys[keys.len() - 1].0 == usize::MAX);
}

#[test]
fn every_column_travels_through_a_message_bit_by_bit() {
    for regime in [Regime::Dynamic, Regime::QuasiStatic] {
        let mut points = varied(regime).points;
        points.sigma[0].0[0] = f64::MIN_POSITIVE / 8.0; // subnormal
        let mut message = Vec::new();
        for p in 0..points.len() {
            points.columns().iter().for_each(|column| column.put(p, &mut message));
        }
        assert_eq!(message.len(), points.len() * points.bytes());
        let mut received = Points::<2>::from_seeds([], regime == Regime::Dynamic);
        received.dilation = points.dilation.as_ref().map(|_| Vec::new());
        received.gap = points.gap.as_ref().map(|_| Vec::new());
        let mut rest = message.as_slice();
        while !rest.is_empty() {
            received.columns().into_iter().for_each(|column| column.take(&mut rest));
        }
        assert_eq!(received, points);
        assert!(received.eps_p.iter().all(|eps_p| eps_p.is_sign_negative()));
    }
}

#[test]
fn quasi_static_points_carry_no_motion() {
    let (mut dynamic, mut quasi_static) = (varied(Regime::Dynamic).points, varied(Regime::QuasiStatic).points);
    (quasi_static.dilation, dynamic.gap) = (None, None);
    assert!(quasi_static.motion.is_none());
    assert_eq!(dynamic.bytes() - quasi_static.bytes(), 4 * 8);
    assert_eq!(quasi_static.bytes(), 8 + 2 + 8 * (2 + 2 + 1 + 1 + 9 + 6 + 6 + 1));
}
