//! Compares the factorised stiffness K_0 with the complete derivative.

use crate::support::random::Random;
use crate::support::scene::{Scene, axis};
use crate::support::solver::Dense;
use bsmpm::boundary::Support;
use bsmpm::grid::Shape;
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::material::{Elastic, Material, MohrCoulomb};
use bsmpm::model::Regime;
use bsmpm::solve::linearised::ForceTangent;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::problem::Problem;
use bsmpm::step::residual::Residual;
use bsmpm::step::stiffness;
use bsmpm::tensor::Vector;

/// Nearly incompressible soil on a fixed base, without stress, its points off the lattice.
fn body<K: Kinematics<D>, const D: usize>(order: usize, cohesion: f64, regime: Regime) -> Scene<K, D> {
    averaged(Stabilisation::ConsistentFBar, 4, 3, order, cohesion, regime)
}

/// The same, averaged over pairs of cells where none is cut: at one end, as it fills the grid's height.
fn paired<K: Kinematics<D>, const D: usize>(order: usize, cohesion: f64, regime: Regime) -> Scene<K, D> {
    averaged(
        Stabilisation::SubgridFBar,
        if D == 2 { 10 } else { 7 },
        2,
        order,
        cohesion,
        regime,
    )
}

/// In a grid of so many cells along the first axis, all but one of which it fills, and along the others, of which it
/// fills two.
fn averaged<K: Kinematics<D>, const D: usize>(
    method: Stabilisation,
    length: usize,
    width: usize,
    order: usize,
    cohesion: f64,
    regime: Regime,
) -> Scene<K, D> {
    let soil = MohrCoulomb::new(
        Elastic {
            young: 1000.0,
            poisson: 0.49,
        },
        0.5,
        0.1,
        cohesion,
    );
    let axes = std::array::from_fn(|k| axis(1.0, if k == 0 { length } else { width }, order));
    let scene = Scene::<K, D>::new(axes, Material::MohrCoulomb(soil), regime);
    let cells = std::array::from_fn(|k| 0..if k == 0 { length - 1 } else { 2 });
    let mut scene = scene
        .stabilised(method)
        .body(cells, 3, 1.0, |_| Vector::zeros())
        .support(Support::fixed(D - 1, false));
    let mut random = Random::new(3);
    scene
        .points
        .x
        .iter_mut()
        .for_each(|x| *x += random.vector::<D>() * 0.02);
    scene.points.sort_by_cell(&scene.model.grid);
    scene
}

/// Which matrix is held against the complete derivative.
enum Kind {
    /// K_0, at the displacement.
    Factorised,
    /// That of Newton's method.
    General,
}

/// A matrix at a displacement of this size, its product with the free part of a nodal array, and the complete
/// derivative's.
fn products<K: Kinematics<D>, const D: usize>(
    scene: &Scene<K, D>,
    size: f64,
    kind: Kind,
) -> (Dense, Vec<f64>, Vec<f64>) {
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 0.01);
    let pieces = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let mut random = Random::new(11);
    let mut free = |size: f64| -> Vec<f64> {
        nodes
            .constraints
            .free
            .iter()
            .map(|&free| if free { size * random.signed() } else { 0.0 })
            .collect()
    };
    let u = free(size);
    let v = free(1.0);
    let residual = Residual::of(&pieces, &u);
    let derivative = ForceTangent::at(&pieces, &residual);
    let mut matrix = Dense::new(&model.grid);
    let mut product = vec![0.0; v.len()];
    match kind {
        Kind::Factorised => stiffness::assemble(&pieces, Some(&residual.trial), &mut matrix),
        Kind::General => derivative.assemble(&mut matrix),
    }
    derivative.multiply(&v, &mut product);
    let image = matrix.multiply(&v);
    (matrix, image, product)
}

/// Largest difference of the two, over the largest force.
fn error(image: &[f64], product: &[f64]) -> f64 {
    let size = product.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
    assert!(size > 0.0);
    image
        .iter()
        .zip(product)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
        / size
}

/// F-bar's average included, which reaches over q cells.
fn is_the_derivative_of_elastic_material<K: Kinematics<D>, const D: usize>(order: usize) {
    for scene in [
        body::<K, D>(order, 1e6, Regime::Dynamic),
        paired(order, 1e6, Regime::Dynamic),
    ] {
        for kind in [Kind::Factorised, Kind::General] {
            let (_, image, product) = products(&scene, 0.0, kind);
            let error = error(&image, &product);
            println!(
                "{:?}, {D} dimensions, order {order}: {error:e}",
                scene.model.stabilisation
            );
            assert!(error <= 1e-12, "order {order}: {error:e}"); // measured 1e-15
        }
    }
}

#[test]
fn the_factorised_stiffness_is_the_derivative_of_elastic_material() {
    for order in [1, 2, 3] {
        is_the_derivative_of_elastic_material::<PlaneStrain, 2>(order);
        is_the_derivative_of_elastic_material::<Axisymmetric, 2>(order);
    }
    is_the_derivative_of_elastic_material::<Solid, 3>(2);
}

/// Each averaged by itself: no function sees a mean of two stiffnesses.
#[test]
fn it_is_the_derivative_of_two_elastic_materials_that_meet_inside_cells() {
    let stiff = MohrCoulomb::new(
        Elastic {
            young: 1e5,
            poisson: 0.3,
        },
        0.5,
        0.1,
        1e8,
    );
    for order in [1, 2, 3] {
        let scene = body::<PlaneStrain, 2>(order, 1e6, Regime::Dynamic)
            .with(Material::MohrCoulomb(stiff.clone()), |x| x[0] > 0.4 + 0.5 * x[1]);
        for kind in [Kind::Factorised, Kind::General] {
            let (_, image, product) = products(&scene, 0.0, kind);
            let error = error(&image, &product);
            println!("order {order}: {error:e}");
            assert!(error <= 1e-12, "order {order}: {error:e}"); // measured 1e-15
        }
    }
}

#[test]
fn it_is_positive_where_everything_yields() {
    let condition = |cohesion: f64| {
        let scene = body::<PlaneStrain, 2>(2, cohesion, Regime::QuasiStatic);
        let (matrix, ..) = products(&scene, 1e-2, Kind::Factorised);
        let order = 2 * scene.model.grid.nodes();
        let skew = |k: usize| matrix.entry(k / order, k % order) - matrix.entry(k % order, k / order);
        let largest = (0..order).map(|c| matrix.entry(c, c)).fold(0.0, f64::max);
        assert!(
            (0..order * order).all(|k| skew(k).abs() <= 1e-12 * largest),
            "symmetric"
        );
        matrix.conditions()[0]
    };
    let [elastic, yielding] = [1e6, 1e-6].map(condition);
    println!("condition: elastic {elastic:.1e}, yielding {yielding:.1e}");
    // A tenth of the elastic stiffness is left everywhere, so the condition is ten times the elastic one at most.
    assert!(
        elastic < yielding && yielding <= 10.0 * elastic,
        "{elastic:e} {yielding:e}"
    );
}

/// The general matrix of Newton's method, which yields, is deformed and is averaged: it is the product.
#[test]
fn the_general_matrix_is_the_complete_derivative() {
    for order in [1, 2, 3] {
        let scene = body::<PlaneStrain, 2>(order, 1e-1, Regime::Dynamic);
        let (_, image, product) = products(&scene, 0.01, Kind::General);
        let error = error(&image, &product);
        println!("order {order}: {error:e}");
        assert!(error <= 1e-12, "order {order}: {error:e}"); // measured 1e-15
    }
}
