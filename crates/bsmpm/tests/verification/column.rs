//! Tests of a confined column under self-weight. At any strain, the vertical stress at a point is the initial weight of
//! the soil above.

use crate::support::scene::{Scene, axis, hencky, rms};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::stabilisation::Stabilisation;

/// A column of height 1, density 1 and oedometric modulus 1, one cell wide: gravity is S = rho0 g l0 / M.
///
/// nu = 0.3, but 0 for cubic splines: three points across under-integrate their one cell, whose inner nodes lateral
/// stress would push for no reason (the error then stalls at 1.5 %).
fn column<K: Kinematics<D>, const D: usize>(order: usize, cells: usize, S: f64, steps: usize) -> Scene<K, D> {
    let h = 1.0 / cells as f64;
    let poisson = if order == 3 { 0.0 } else { 0.3 };
    let young = (1.0 + poisson) * (1.0 - 2.0 * poisson) / (1.0 - poisson);
    let count = |k: usize| if k == D - 1 { cells } else { 1 };
    let axes = std::array::from_fn(|k| axis(h, count(k), order));
    Scene::<K, D>::new(axes, hencky(young, poisson), Regime::QuasiStatic)
        .body(std::array::from_fn(|k| 0..count(k)), 3, 1.0, |x| x * 0.0)
        .rollers(0..D)
        .gravity(S, steps as f64)
        .free_top()
}

impl<K: Kinematics<D>, const D: usize> Scene<K, D> {
    /// Without the support at the upper end of the last axis.
    fn free_top(mut self) -> Self {
        self.model
            .boundary
            .supports
            .retain(|support| !(support.axis == D - 1 && support.upper));
        self
    }

    /// Error of the vertical stress: mean of its absolute value over rho0 g l0, and its relative root mean square.
    fn stress_error(&self, S: f64) -> [f64; 2] {
        let points = &self.points;
        let exact = |p: usize| -S * (1.0 - (points.x[p][D - 1] - points.u[p][D - 1]));
        let error = |p: usize| points.sigma.at(p).0[D - 1] - exact(p);
        let mean: f64 = (0..points.len()).map(|p| points.volume[p] * error(p).abs()).sum();
        [
            mean / points.volume.iter().sum::<f64>() / S,
            rms(points, error) / rms(points, exact),
        ]
    }

    /// y of the top point + half its spacing x its stretch.
    fn height(&self, spacing: f64) -> f64 {
        let points = &self.points;
        let y = |p: &usize| points.x[*p][D - 1];
        let top = (0..points.len()).max_by(|a, b| y(a).total_cmp(&y(b))).expect("points");
        points.x[top][D - 1] + 0.5 * spacing * points.F.at(top)[(D - 1, D - 1)]
    }
}

/// Mean and RMS error of the stress under S = 1e-7, in one step.
fn small_strain_error<K: Kinematics<D>, const D: usize>(order: usize, cells: usize) -> [f64; 2] {
    let (scene, steps) = column::<K, D>(order, cells, 1e-7, 1).solved(1.0, 1.0);
    assert_eq!(steps.len(), 1);
    // K_0 is the tangent of a stress-free body: one direction leaves what is quadratic in the strain.
    assert_eq!(steps[0].report.iterations, 1);
    assert!(steps[0].report.force <= 1e-6); // measured 5.4e-8
    scene.stress_error(1e-7)
}

/// Orders of convergence from 8 to 64 cells, of the mean and of the RMS error, with the errors' last values.
fn orders(q: usize) -> ([f64; 2], [f64; 2]) {
    let [coarse, .., fine] = [8, 16, 32, 64].map(|cells| {
        let errors = small_strain_error::<PlaneStrain, 2>(q, cells);
        println!("q = {q}, {cells} cells: mean {:.2e}, RMS {:.2e}", errors[0], errors[1]);
        errors
    });
    let orders = [0, 1].map(|k| (coarse[k] / fine[k]).log2() / 3.0);
    println!(
        "q = {q}: order {:.3} of the mean, {:.3} of the RMS",
        orders[0], orders[1]
    );
    (orders, fine)
}

/// Closed form: stress of an elastic column under its weight at small strain.
#[test]
fn small_strain_stress_of_linear_splines_converges_with_order_one() {
    let (orders, fine) = orders(1);
    assert!(orders.iter().all(|order| (0.97..1.03).contains(order))); // measured 1.000, 1.000
    assert!(fine[0] <= 3.6e-3); // measured 3.47e-3
}

/// Closed form: stress of an elastic column under its weight at small strain.
#[test]
fn small_strain_stress_of_quadratic_splines_converges_with_order_two() {
    // The errors sit in the two end cells, whose volume shrinks with h: the RMS loses half an order against the mean,
    // which has 9.1e-4 -> 1.5e-5, order 1.98, in a prototype.
    let (orders, fine) = orders(2);
    assert!(orders[0] >= 1.95); // measured 1.996
    assert!((1.45..1.6).contains(&orders[1])); // measured 1.500
    assert!(fine[0] <= 1.5e-5); // measured 1.44e-5
}

/// Closed form: stress of an elastic column under its weight at small strain.
#[test]
fn small_strain_stress_of_cubic_splines_is_only_of_first_order_as_documented() {
    let (orders, _) = orders(3);
    assert!((0.95..1.2).contains(&orders[0])); // measured 1.040; a prototype: 1.05
}

#[test]
fn the_same_column_in_three_dimensions_has_the_same_error() {
    let plane = small_strain_error::<PlaneStrain, 2>(2, 8);
    let solid = small_strain_error::<Solid, 3>(2, 8);
    println!("stress error {plane:?} {solid:?}");
    assert!((plane[0] / solid[0] - 1.0).abs() <= 1e-9); // measured 5e-15
}

/// Closed form: stress of a Hencky column under its weight.
#[test]
fn large_strain_stress_stalls_with_linear_splines_ten_times_above_quadratic_ones() {
    // A prototype, shortened by 24 %: q = 1 stalls at 6-12 %, q = 2 has 0.26-0.53 % left (point quadrature).
    let error = |q, cells| {
        let (scene, _) = column::<PlaneStrain, 2>(q, cells, 0.8, 20).solved(1.0, 20.0);
        let [mean, square] = scene.stress_error(0.8);
        println!("q = {q}, {cells} cells: mean {mean:.2e}, RMS {square:.2e}");
        mean
    };
    for cells in [16, 32] {
        assert!((0.04..0.12).contains(&error(1, cells))); // measured 5.5e-2, 5.7e-2
        assert!(error(2, cells) <= 6e-3); // measured 2.3e-3, 5.4e-3
    }
}

/// Closed form: height of a confined Hencky column under its weight (Lambert W function).
#[test]
fn heights_of_the_hencky_column_agree_with_lamberts_function() {
    // Height / l0 as in reference/hencky_column.csv; 20 cells, gravity in 10 steps.
    // The last number bounds the error: a few times the measured 1.5e-6, 2.3e-4, 2.4e-4.
    for (S, exact, bound) in [
        (0.04, 0.9807598284, 1e-5),
        (0.4, 0.8533052167, 5e-4),
        (1.0, 0.7279690463, 5e-4),
    ] {
        for method in [Stabilisation::None, Stabilisation::FBar, Stabilisation::ModifiedFBar] {
            let (scene, steps) = column::<PlaneStrain, 2>(2, 20, S, 10)
                .stabilised(method)
                .solved(1.0, 10.0);
            let height = scene.height(1.0 / 60.0);
            println!(
                "S = {S}, {method:?}: {height:.6}, exact {exact:.6}, {} steps",
                steps.len()
            );
            assert!((height - exact).abs() <= bound);
        }
    }
}

/// Closed form: the reaction is the weight.
#[test]
fn the_base_carries_the_columns_weight_at_any_strain_and_any_time_of_the_ramp() {
    let (_, steps) = column::<PlaneStrain, 2>(2, 10, 1.0, 10).solved(1.0, 12.0);
    for step in &steps {
        let weight = 0.1 * (step.t / 10.0).min(1.0); // one cell of 0.1 m wide
        assert!((step.report.reactions[2][1] / weight - 1.0).abs() <= 1e-9);
    }
}

/// A bar that its weight compresses to half its height, nu = 0, on `points` points a cell and axis: mean error of the
/// stress.
fn compressed(cells: usize, points: usize, fitted: bool) -> f64 {
    let h = 1.0 / cells as f64;
    let mut scene = Scene::<PlaneStrain, 2>::new(
        [axis(h, 1, 2), axis(h, cells, 2)],
        hencky(1.0, 0.0),
        Regime::QuasiStatic,
    )
    .body([0..1, 0..cells], points, 1.0, |x| x * 0.0)
    .rollers(0..2)
    .gravity(4.0, 40.0)
    .free_top();
    scene.model.criteria.energy = 1e-10;
    scene.model.criteria.force = 1e-7;
    let scene = if fitted { scene.fitted() } else { scene };
    let (scene, _) = scene.solved(1.0, 40.0);
    let [mean, square] = scene.stress_error(4.0);
    println!("{cells} cells, {points} points a cell and axis, fitted: {fitted}: mean {mean:.2e}, RMS {square:.2e}");
    mean
}

#[test]
fn stress_of_a_bar_compressed_to_half_falls_with_the_cells_where_volumes_are_fitted_only() {
    // Points, most of the coarse error, most of the fine one, least order of the fitted one's fall.
    for (points, coarse, fine, order) in COMPRESSED {
        let [[own, own_fine], [fitted, fitted_fine]] =
            [false, true].map(|fitted| [64, 256].map(|cells| compressed(cells, points, fitted)));
        assert!(own_fine >= 0.8 * own, "points alone stall"); // measured 0.98, 0.93
        assert!(fitted <= coarse && fitted_fine <= fine);
        assert!((fitted / fitted_fine).log2() / 2.0 >= order);
    }
}

/// Measured: 3.0e-4, 6.5e-5, order 1.1 with 2 points, 1.2e-4, 3.1e-5, 1.0 with 3.
const COMPRESSED: [(usize, f64, f64, f64); 2] = [(2, 4e-4, 1e-4, 0.9), (3, 2e-4, 5e-5, 0.8)];
