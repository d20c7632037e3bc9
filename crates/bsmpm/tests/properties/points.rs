//! Tests of the arrays of material points: sorting, transfer in messages, and memory.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::points::{Column, PackedTensors, Points};
use bsmpm::tensor::{Symmetric, Tensor};

/// A tensor whose every number is different, but for those that couple a plane with its normal.
fn tensor<const D: usize>(random: &mut Random) -> Tensor {
    let couples = |row, column| D == 2 && (row == 2) != (column == 2);
    Tensor::from_fn(|row, column| if couples(row, column) { 0.0 } else { random.signed() })
}

/// Points whose every number is different, also NaN-free extremes.
fn varied<K: Kinematics<D>, const D: usize>(regime: Regime) -> Scene<K, D> {
    let mut random = Random::new(1);
    let axes = std::array::from_fn(|k| if k == 0 { axis(0.5, 6, 2) } else { axis(0.25, 4, 2) });
    let mut scene = Scene::<K, D>::new(axes, hencky(1.0, 0.2), regime);
    scene = scene.body(std::array::from_fn(|k| if k == 0 { 1..5 } else { 0..3 }), 3, 2.0, |x| {
        x * 0.7
    });
    let points = &mut scene.points;
    for p in 0..points.len() {
        points.x[p] += random.vector::<D>() * 0.05;
        points.u[p] = random.vector::<D>() * 1e-200;
        points.material[p] = (random.unit() * 65535.0) as u16;
        points.mass[p] *= random.unit();
        points.volume[p] *= random.unit();
        points.F.set(p, tensor::<D>(&mut random));
        points.b_e.set(p, Symmetric::of(&tensor::<D>(&mut random)));
        points
            .sigma
            .set(p, Symmetric::of(&tensor::<D>(&mut random)).scaled(1e200));
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

fn shuffled<const D: usize>(points: &Points<D>, seed: u64) -> Points<D> {
    let mut random = Random::new(seed);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, (random.unit() * (i + 1) as f64) as usize);
    }
    let mut points = points.clone();
    points.columns().into_iter().for_each(|column| column.reorder(&order));
    points
}

fn sorted_again<K: Kinematics<D>, const D: usize>() {
    for regime in [Regime::Dynamic, Regime::QuasiStatic] {
        let scene = varied::<K, D>(regime);
        for seed in 0..10 {
            let mut points = shuffled(&scene.points, seed);
            assert_ne!(points, scene.points);
            points.sort_by_cell(&scene.model.grid);
            assert_eq!(points, scene.points);
        }
    }
}

#[test]
fn sorting_is_canonical_whatever_the_order_before() {
    sorted_again::<PlaneStrain, 2>();
    sorted_again::<Solid, 3>();
}

#[test]
fn sorted_points_ascend_by_cell_then_id_and_those_outside_the_window_come_last() {
    let scene = varied::<PlaneStrain, 2>(Regime::Dynamic);
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

fn sent<K: Kinematics<D>, const D: usize>() {
    for regime in [Regime::Dynamic, Regime::QuasiStatic] {
        let mut points = varied::<K, D>(regime).points;
        let mut sigma = points.sigma.at(0);
        sigma.0[0] = f64::MIN_POSITIVE / 8.0; // subnormal
        points.sigma.set(0, sigma);
        let mut message = Vec::new();
        for p in 0..points.len() {
            points.columns().iter().for_each(|column| column.put(p, &mut message));
        }
        assert_eq!(message.len(), points.len() * points.bytes());
        let mut received = Points::<D>::from_seeds([], regime == Regime::Dynamic);
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
fn every_column_travels_through_a_message_bit_by_bit() {
    sent::<PlaneStrain, 2>();
    sent::<Solid, 3>();
}

fn bytes_of(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A row of a message is the whole tensor in every dimension; what a plane does not hold is not taken for nothing.
#[test]
fn rows_are_whole_tensors_and_a_plane_refuses_what_leaves_it() {
    let F = Tensor::new(1.1, 0.2, 0.0, 0.3, 1.4, 0.0, 0.0, 0.0, 1.5);
    let sigma = Symmetric([-1.0, -2.0, -3.0, 0.4, 0.0, 0.0]);
    let plane = PackedTensors::<2, Tensor>::from_iter([F; 3]);
    let solid = PackedTensors::<3, Tensor>::from_iter([F; 3]);
    let mut of_plane = Vec::new();
    let mut of_solid = Vec::new();
    plane.put(1, &mut of_plane);
    solid.put(1, &mut of_solid);
    assert_eq!(
        (&of_plane, &of_solid),
        (&bytes_of(F.as_slice()), &bytes_of(F.as_slice()))
    );
    let symmetric = PackedTensors::<2, Symmetric>::from_iter([sigma]);
    let mut of_symmetric = Vec::new();
    symmetric.put(0, &mut of_symmetric);
    assert_eq!(of_symmetric, bytes_of(&sigma.0));
    for strange in [1e-300, f64::NAN, -0.0] {
        for place in [2, 5, 6, 7] {
            let mut other = F;
            other[place] = strange;
            let row = bytes_of(other.as_slice());
            assert_eq!(
                (plane.fits(&row), solid.fits(&row)),
                (strange == 0.0, true),
                "{strange} at {place}"
            );
        }
        for place in [4, 5] {
            let mut other = sigma;
            other.0[place] = strange;
            assert_eq!(
                symmetric.fits(&bytes_of(&other.0)),
                strange == 0.0,
                "{strange} at {place}"
            );
        }
    }
    assert!(plane.fits(&of_plane) && symmetric.fits(&of_symmetric));
}

#[test]
fn quasi_static_points_carry_no_motion() {
    let of = |regime| varied::<PlaneStrain, 2>(regime).points;
    let mut dynamic = of(Regime::Dynamic);
    let mut quasi_static = of(Regime::QuasiStatic);
    (quasi_static.dilation, dynamic.gap) = (None, None);
    assert!(quasi_static.motion.is_none());
    assert_eq!(dynamic.bytes() - quasi_static.bytes(), 4 * 8);
    assert_eq!(dynamic.memory() - quasi_static.memory(), 4 * 8);
    assert_eq!(quasi_static.bytes(), 8 + 2 + 8 * (2 + 2 + 1 + 1 + 9 + 6 + 6 + 1));
}

#[test]
fn in_memory_a_plane_has_no_components_that_couple_it_with_its_normal() {
    let mut plane = Points::<2>::from_seeds([], false);
    assert_eq!(plane.memory(), 8 + 2 + 8 * (2 + 2 + 1 + 1 + 5 + 4 + 4 + 1));
    assert_eq!(plane.bytes() - plane.memory(), 64);
    let mut solid = Points::<3>::from_seeds([], true);
    assert_eq!(solid.memory(), solid.bytes());
}
