//! Step (6): the elastic stiffness K_0 = 4/dt^2 M + sum_p V0 G^T D^e G at the start of the step, symmetric, with the
//! soft background and the hold of strips; numerical damping changes the 4/dt^2. The quasi-Newton method stands for
//! everything that it leaves out.

use crate::error::SolveError;
use crate::grid::shape::Patch;
use crate::grid::transfer;
use crate::kinematics::Kinematics;
use crate::material::Material;
use crate::seam::{LinearSolver, Symmetry};
use crate::step::equilibrium::Scene;
use crate::tensor::{Square, Vector};

/// Assembles K_0 patch by patch into `solver` and factorises it.
pub fn assemble<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    solver: &mut dyn LinearSolver,
) -> Result<(), SolveError> {
    let nodes = scene.nodes;
    solver.begin(&nodes.free);
    let size = scene.shape.offsets().len();
    let mut moments = vec![Square::<D>::zeros(); size * size];
    let mut block = vec![0.0; (size * D).pow(2)];
    for (number, patch) in scene.shape.patches().iter().enumerate() {
        block.fill(0.0);
        for run in runs_of_one_material(patch, &scene.points.material) {
            let material = &scene.model.materials[usize::from(scene.points.material[run.start])];
            accumulate(scene, run, material, &mut moments);
            add_elastic::<K, D>(&moments, material.elastic().lame(), &mut block);
        }
        if let Some(soft) = nodes.background.as_ref().and_then(|background| background.of(number)) {
            add_background::<D>(soft, &mut block);
        }
        solver.add(patch.first_node, &block);
    }
    complete(scene, solver, Symmetry::Definite)
}

/// Adds strips, faces of the background and inertia to a matrix whose patches are assembled, and factorises it.
pub fn complete<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    solver: &mut dyn LinearSolver,
    symmetry: Symmetry,
) -> Result<(), SolveError> {
    let nodes = scene.nodes;
    scene.grips.assemble(solver);
    if let Some(background) = &nodes.background {
        background.assemble(solver);
    }
    if let Some(inertia) = &nodes.inertia {
        let diagonal: Vec<f64> = (0..nodes.free.len()).map(|c| inertia.factor() * nodes.weight[c / D]).collect();
        solver.add_diagonal(&diagonal);
    }
    solver.finish(symmetry)
}

fn runs_of_one_material(patch: &Patch, material: &[u16]) -> Vec<std::ops::Range<usize>> {
    let mut start = patch.points.start;
    material[patch.points.clone()]
        .chunk_by(|a, b| a == b)
        .map(|run| {
            start += run.len();
            start - run.len()..start
        })
        .collect()
}

/// T_ab = sum_p V0 grad N_a (x) grad N_b for a <= b, weighted with the stiffness relative to the material's.
fn accumulate<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    points: std::ops::Range<usize>,
    material: &Material,
    moments: &mut [Square<D>],
) {
    let size = scene.shape.offsets().len();
    let mut grad = [Vector::<D>::zeros(); 64];
    moments.fill(Square::zeros());
    for p in points {
        transfer::gradients_of(scene.shape, p, &mut grad);
        let volume = scene.points.volume[p] * material.relative_stiffness(scene.points.height(p));
        for a in 0..size {
            let weighted = grad[a] * volume;
            for (moment, other) in moments[a * size + a..(a + 1) * size].iter_mut().zip(&grad[a..size]) {
                for j in 0..D {
                    for i in 0..D {
                        moment[(i, j)] += weighted[i] * other[j];
                    }
                }
            }
        }
    }
}

fn add_elastic<K: Kinematics<D>, const D: usize>(moments: &[Square<D>], lame: (f64, f64), block: &mut [f64]) {
    let size = moments.len().isqrt();
    for a in 0..size {
        for b in a..size {
            let pair = K::stiffness(&moments[a * size + b], lame);
            for i in 0..D {
                for j in 0..D {
                    block[(a * D + i) * size * D + b * D + j] += pair[(i, j)];
                    if a != b {
                        block[(b * D + j) * size * D + a * D + i] += pair[(i, j)];
                    }
                }
            }
        }
    }
}

/// Adds the scalar block of the background to every component of a patch's block.
pub fn add_background<const D: usize>(soft: &[f64], block: &mut [f64]) {
    let size = soft.len().isqrt();
    for (entry, value) in soft.iter().enumerate() {
        let (a, b) = (entry / size, entry % size);
        for i in 0..D {
            block[(a * D + i) * size * D + b * D + i] += value;
        }
    }
}
