//! Tests of the inf-sup constant of displacements and pore pressures on whole and cut cells (Chapelle and Bathe, 1993),
//! and of flow in a rotated body.

use super::{Plane, at, flowing};
use crate::support::scene::{axis, hencky};
use crate::support::solver::Dense;
use bsmpm::boundary::Support;
use bsmpm::field::pore_water::flow::PermeabilityLaw;
use bsmpm::field::pore_water::matrix;
use bsmpm::field::pore_water::residual::pressing;
use bsmpm::grid::transfer::scalars;
use bsmpm::grid::{Shape, transfer};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Regime;
use bsmpm::step::problem::Problem;
use bsmpm::step::residual::Residual;
use bsmpm::tensor::Vector;
use nalgebra::DMatrix;

/// A unit square of `cells` x `cells` on rollers but for its top, whose last row of cells is filled by the share `cut`.
fn square(cells: usize, cut: f64) -> Plane {
    let h = 1.0 / cells as f64;
    let mut scene = Plane::new(
        [axis(h, cells, 2), axis(h, cells + 1, 2)],
        hencky(1.0, 0.0),
        Regime::QuasiStatic,
    )
    .body([0..cells, 0..cells], 3, 1.0, |x| x * 0.0)
    .rollers([0])
    .support(Support::roller(1, false));
    let top = 1.0 - h;
    for (x, volume) in scene.points.x.iter_mut().zip(&mut scene.points.volume) {
        if x[1] > top {
            x[1] = top + (x[1] - top) * cut;
            *volume *= cut;
        }
    }
    scene.model.water = Some(flowing(PermeabilityLaw::Constant));
    scene
}

/// A square of 1 m, or a disc of that diameter, that nothing holds, this share of a cell off the lines of its cells of
/// 1 m / `cells`.
fn afloat(cells: usize, off: Vector<2>, is_round: bool) -> Plane {
    let h = 1.0 / cells as f64;
    let scene = Plane::new(
        [axis(h, cells + 2, 2), axis(h, cells + 2, 2)],
        hencky(1.0, 0.0),
        Regime::QuasiStatic,
    );
    let centre = at(0.5 + h, 0.5 + h);
    let off = off * h;
    let mut scene = if is_round {
        let body = scene.body([0..cells + 2, 0..cells + 2], 3, 1.0, |x| x * 0.0);
        body.cut(|x| (x - centre - off).norm() < 0.5)
    } else {
        let mut scene = scene.body([1..cells + 1, 1..cells + 1], 3, 1.0, |x| x * 0.0);
        scene.points.x.iter_mut().for_each(|x| *x += off);
        scene.points.sort_by_cell(&scene.model.grid);
        scene
    };
    scene.model.water = Some(flowing(PermeabilityLaw::Constant));
    scene
}

/// W with W^T A W = 1, over the part of the space in which A is not zero to round-off.
fn whitening(form: &DMatrix<f64>) -> DMatrix<f64> {
    const NONE: f64 = 1e-11;
    let scale = form.diagonal().map(|own| 1.0 / own.sqrt());
    let scaled = DMatrix::from_fn(form.nrows(), form.ncols(), |row, column| {
        form[(row, column)] * scale[row] * scale[column]
    });
    let eigen = scaled.symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let kept: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|&k| eigen.eigenvalues[k] > NONE * largest)
        .collect();
    DMatrix::from_fn(form.nrows(), kept.len(), |row, k| {
        scale[row] * eigen.eigenvectors[(row, kept[k])] / eigen.eigenvalues[kept[k]].sqrt()
    })
}

/// beta: the square root of the smallest eigenvalue of Q^T K^-1 Q + C against the mass of the pressures, K = grad u :
/// grad u, where nothing flows; without C, which is the tau term, and with it.
fn constants(mut scene: Plane) -> [f64; 2] {
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("it flows");
    flow.soils[0].as_mut().expect("a soil").permeability = None;
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let problem = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let pores = nodes.field.as_ref().expect("it flows");
    let free: Vec<usize> = (0..nodes.constraints.free.len())
        .filter(|&c| nodes.constraints.free[c])
        .collect();
    let pressures: Vec<usize> = (0..pores.free.len()).filter(|&c| pores.free[c]).collect();
    let mut stiffness = DMatrix::zeros(free.len(), free.len());
    let mut unit = vec![0.0; nodes.constraints.free.len()];
    for (column, &component) in free.iter().enumerate() {
        unit[component] = 1.0;
        let grad = transfer::gradients::<PlaneStrain, 2, _>(&shape, &points.x, &unit, |_, grad| grad);
        unit[component] = 0.0;
        let force = transfer::divergence::<PlaneStrain, 2>(&shape, &points.x, |p| grad[p] * points.volume[p]).alone();
        free.iter()
            .enumerate()
            .for_each(|(row, &c)| stiffness[(row, column)] = force[c]);
    }
    let mut stand_in = Dense::of_pressures(&model.grid);
    matrix::assemble(&problem, pores, &pores.guess, &mut stand_in);
    let mut q = DMatrix::zeros(free.len(), pressures.len());
    let mut mass = DMatrix::zeros(pressures.len(), pressures.len());
    let mut unit = vec![0.0; pores.free.len()];
    for (column, &function) in pressures.iter().enumerate() {
        unit[function] = 1.0;
        let force = pressing(&problem, pores, &unit);
        let value = scalars::scalars(&pores.shape, &unit, |_, value, _| value);
        let spread = scalars::of_scalars(&pores.shape, |p| [(points.volume[p] * value[p], Vector::zeros())]).alone();
        unit[function] = 0.0;
        free.iter()
            .enumerate()
            .for_each(|(row, &c)| q[(row, column)] = force[c]);
        pressures
            .iter()
            .enumerate()
            .for_each(|(row, &c)| mass[(row, column)] = spread[c]);
    }
    let stored = DMatrix::from_fn(pressures.len(), pressures.len(), |row, column| {
        stand_in.entry(pressures[row], pressures[column]) - mass[(row, column)] // M = 1
    });
    let left = whitening(&stiffness).transpose() * &q;
    let bare = left.transpose() * &left;
    let white = whitening(&mass);
    [bare.clone(), bare + stored].map(|form| {
        let form = white.transpose() * form * &white;
        (&form + form.transpose())
            .scale(0.5)
            .symmetric_eigenvalues()
            .min()
            .max(0.0)
            .sqrt()
    })
}

/// Chapelle and Bathe (1993): numerical inf-sup test of displacement and pressure.
#[test]
fn the_pair_is_stable_on_any_grid_whole_and_cut() {
    for cells in [4, 8, 12] {
        let found = [1.0, 0.65, 0.35, 0.05].map(|cut| constants(square(cells, cut)));
        println!(
            "{cells} cells, top row filled by 1, 0.65, 0.35, 0.05: beta without and with the tau term {found:.3?}"
        );
        assert!(found.iter().all(|[_, with]| *with > 0.7));
    }
}

/// Bodies afloat in twenty places of their cells. Without the term the constant falls as cells shrink: modes of the
/// pressure that no force feels. With it the place changes it by less than 2 %, and it stays above 1.
#[test]
fn the_tau_term_keeps_the_pair_stable_wherever_a_body_cuts_its_cells() {
    let places: Vec<Vector<2>> = (0..20)
        .map(|k| at(f64::from(k), f64::from(7 * k % 20)) / 20.0)
        .collect();
    for is_round in [false, true] {
        let found = [4, 8, 12].map(|cells| {
            let all = places.iter().map(|&place| constants(afloat(cells, place, is_round)));
            let range = |[low, high]: [f64; 2], beta: f64| [low.min(beta), high.max(beta)];
            let none = [f64::INFINITY, 0.0];
            all.fold([none; 2], |[bare, with], beta| {
                [range(bare, beta[0]), range(with, beta[1])]
            })
        });
        println!("round: {is_round}; 4, 8, 12 cells, beta without and with the tau term: {found:.3?}");
        assert!(
            found.iter().all(|[_, with]| with[0] > 1.0 && with[1] < 1.02 * with[0]),
            "{found:?}"
        );
        assert!(
            found[2][0][1] < 0.5 && found[2][0][1] < 0.75 * found[0][0][1],
            "{found:?}"
        );
    }
}

#[test]
fn a_rotation_changes_neither_the_flow_nor_the_content_and_turns_the_forces() {
    let mut scene = square(4, 0.35);
    scene.model.boundary.supports.clear();
    let model = &scene.model;
    let points = &scene.points;
    let halo = scene.halo();
    let shape = Shape::at(&model.grid, points).unwrap();
    let nodes = scene.nodes(&shape, 1.0);
    let problem = Problem {
        model,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &halo,
    };
    let number = |node: usize| model.grid.node_at(node);
    let place = |node: usize| {
        at(
            model.grid.axes()[0].greville(number(node)[0]),
            model.grid.axes()[1].greville(number(node)[1]),
        )
    };
    let pressure: Vec<f64> = (0..model.grid.nodes())
        .map(|node| 0.01 * ((7 * node % 11) as f64 - 4.0))
        .collect();
    let (sin, cos) = 0.7_f64.sin_cos();
    let turned = |v: Vector<2>| at(cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]);
    let state = |u: &dyn Fn(usize) -> Vector<2>| {
        let u = (0..model.grid.nodes()).flat_map(|node| [u(node)[0], u(node)[1]]);
        Residual::of(&problem, &u.chain(pressure.iter().copied()).collect::<Vec<_>>()).balance
    };
    let still = state(&|_| at(0.0, 0.0));
    let moved = state(&|node| turned(place(node)) - place(node));
    let excess = |balance: &bsmpm::step::residual::Balance| balance.field.as_ref().expect("it flows").excess.clone();
    let scale = excess(&still).iter().map(|value| value.abs()).fold(0.0, f64::max);
    let off = excess(&still)
        .iter()
        .zip(excess(&moved))
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
        / scale;
    let largest = still.f_oob.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let force = |balance: &bsmpm::step::residual::Balance, node: usize| {
        at(balance.f_oob[2 * node], balance.f_oob[2 * node + 1])
    };
    let forces = (0..model.grid.nodes()).map(|node| (turned(force(&still, node)) - force(&moved, node)).norm());
    let forces = forces.fold(0.0, f64::max) / largest;
    println!("water off by {off:.1e}, forces by {forces:.1e}");
    assert!(scale > 0.0 && off < 1e-12 && forces < 1e-12);
}
