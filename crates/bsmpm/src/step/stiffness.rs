//! Symmetric positive definite stiffness K_0, theory-manual equations (T5.7) to (T5.9), assembled at the first guess of
//! a step.

use crate::dynamics::damping::Damping;
use crate::error::SolveError;
use crate::grid::shape::Patch;
use crate::grid::{Shape, transfer};
use crate::kinematics::{Gradient, GradientModuli, Kinematics, Moment, Slope};
use crate::linear::{LinearSolver, MatrixAssembly, Symmetry};
use crate::material::Moduli;
use crate::material::Stiffness;
use crate::model::Model;
use crate::points::Points;
use crate::step::blocks::{MOST, Pairs, add_mass, add_point, complete};
use crate::step::coupling::{Coupling, DilationForce, Dilations, Share};
use crate::step::nodes::GridState;
use crate::step::problem::Problem;
use crate::step::reduced_matrix;
use crate::step::trial::DeformationIncrement;
use crate::tensor::{Tensor, Vector};
use nalgebra::SMatrix;
use rayon::prelude::*;

/// Assembles K_0 as [`assemble`] does, and factorises it.
pub fn factorise<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    at: Option<&DeformationIncrement<K, D>>,
    solver: &mut dyn LinearSolver,
) -> Result<(), SolveError> {
    assemble(problem, at, solver.matrix());
    solver.factorise(Symmetry::Definite)
}

/// Assembles K_0 patch by patch at the state `at`, or for `None` of elastic material without averaged dilation. One
/// exchange with the neighbours if the average couples patches.
pub fn assemble<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    at: Option<&DeformationIncrement<K, D>>,
    matrix: &mut dyn MatrixAssembly,
) {
    reduced_matrix::assemble(problem, matrix, |matrix| assemble_into(problem, at, matrix));
}

fn assemble_into<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    at: Option<&DeformationIncrement<K, D>>,
    matrix: &mut dyn MatrixAssembly,
) {
    let Problem {
        model,
        shape,
        nodes,
        points,
        halo,
        ..
    } = *problem;
    let volume = problem.volume();
    matrix.reinit(&nodes.constraints.free);
    let damping = Damping::of(model, nodes);
    let mut coupling = at.and_then(|_| Coupling::of(model, nodes, DilationForce::Along));
    // Each thread computes columns of patches; the results are added in the order of the patches.
    for columns in shape.columns().chunks(columns_at_a_time(shape)) {
        let state = Assembly {
            model,
            shape,
            nodes,
            points,
            volume,
            at,
            coupling: coupling.as_ref(),
            damping: &damping,
        };
        let parts: Vec<Vec<PatchPart>> = columns
            .par_iter()
            .with_max_len(1)
            .map(|column| column.patches.clone().map(|patch| state.part(patch)).collect())
            .collect();
        let patches = columns.iter().flat_map(|column| column.patches.clone());
        for (patch, part) in patches.zip(parts.into_iter().flatten()) {
            matrix.add_block(shape.patches()[patch].first_node, &part.block);
            if let (Some(coupling), Some(dilations)) = (&mut coupling, &part.dilations) {
                coupling.add(patch, dilations);
            }
        }
    }
    if let Some(coupling) = coupling {
        coupling.assemble(halo, matrix);
    }
    complete(problem, matrix);
}

/// Bytes of blocks that are stored before they are added; threads synchronise once per this amount.
const BLOCKS: usize = 1 << 23;

/// Returns the number of columns whose blocks are stored: at least one per thread; one if there is a single thread.
fn columns_at_a_time<const D: usize>(shape: &Shape<D>) -> usize {
    let threads = rayon::current_num_threads();
    let patches = shape.patches().len().div_ceil(shape.columns().len().max(1));
    let bytes = patches * (shape.offsets().len() * D).pow(2) * size_of::<f64>();
    if threads == 1 {
        1
    } else {
        threads.max(BLOCKS / bytes.max(1))
    }
}

/// Contribution of one patch.
struct PatchPart {
    /// Row-major square block (N/m), D unknowns per node.
    block: Vec<f64>,
    /// Dilations of the patch's points, if their average couples patches.
    dilations: Option<Dilations>,
}

/// Data from which contributions of patches are computed.
struct Assembly<'a, K: Kinematics<D>, const D: usize> {
    model: &'a Model<K, D>,
    shape: &'a Shape<D>,
    nodes: &'a GridState<D>,
    points: &'a Points<D>,
    volume: &'a [f64],
    at: Option<&'a DeformationIncrement<K, D>>,
    coupling: Option<&'a Coupling<'a, D>>,
    damping: &'a Damping,
}

impl<K: Kinematics<D>, const D: usize> Assembly<'_, K, D> {
    fn part(&self, number: usize) -> PatchPart {
        let Self {
            model,
            shape,
            points,
            coupling,
            ..
        } = *self;
        let patch = &shape.patches()[number];
        let size = shape.offsets().len();
        let mut part = PatchPart {
            block: vec![0.0; (size * D).pow(2)],
            dilations: coupling.map(Coupling::of_patch),
        };
        let mut slopes = [K::Gradient::NO_SLOPE; MOST];
        // All responses first: those of neighbouring points are independent, and the processor overlaps them.
        let yielding: Vec<Option<Stiffness>> = patch.points.clone().map(|p| self.yielding(p)).collect();
        for run in runs_of_one_material(patch, &points.material) {
            let mut moments = vec![K::Gradient::NO_MOMENT; size * size];
            let material = &model.materials[usize::from(points.material[run.start])];
            let Moduli { lambda, mu } = material.elastic().moduli();
            // F-bar averages the part (lambda + 2 mu/dof) times dilation of isotropic stiffness; in the rest lambda
            // becomes -2 mu/dof.
            let averaged = 2.0 * mu * K::dilation().norm_squared();
            for p in run {
                let stiffness = yielding[p - patch.points.start].as_ref();
                self.add(
                    p,
                    &mut slopes[..size],
                    stiffness,
                    lambda + averaged,
                    &mut moments,
                    &mut part,
                );
            }
            let lambda = if coupling.is_some() { -averaged } else { lambda };
            add_elastic::<K, D>(&moments, Moduli { lambda, mu }, &mut part.block);
        }
        mirror(size * D, &mut part.block);
        add_mass(model.mass, self.nodes, shape, patch, &points.mass, &mut part.block);
        for interaction in self.nodes.interactions.iter() {
            interaction.add_to_cell(number, &mut part.block);
        }
        part
    }

    /// Returns the stiffness of point `p` if it yields.
    #[inline(always)]
    fn yielding(&self, p: usize) -> Option<Stiffness> {
        self.at?.respond(self.model, self.points, p).ok()?.yielding()
    }

    /// Adds a point: an elastic one to the `moments` of its material, a yielding one with its own stiffness to the
    /// block. Where dilation is averaged, adds its dilation, with the elastic bulk stiffness `bulk` (Pa). `slopes` is
    /// workspace.
    fn add(
        &self,
        p: usize,
        slopes: &mut [Slope<K, D>],
        stiffness: Option<&Stiffness>,
        bulk: f64,
        moments: &mut [Moment<K, D>],
        part: &mut PatchPart,
    ) {
        let Self {
            model,
            shape,
            nodes,
            points,
            coupling,
            ..
        } = *self;
        transfer::slopes_of::<K, D>(shape, &points.x, p, slopes);
        let volume = self.volume[p];
        // Damping adds a fraction of the stiffness.
        let damped = 1.0 + self.damping.relative(points.material[p]).unwrap_or(0.0);
        let raised = if let Some(stiffness) = stiffness {
            let (moduli, bulk) = of_point::<K, D>(stiffness, volume * damped, coupling.is_some());
            add_point::<K, D>(&moduli, slopes, Pairs::Upper, &mut part.block);
            bulk * damped
        } else {
            let material = &model.materials[usize::from(points.material[p])];
            let relative = damped * material.relative_stiffness(points.height(p));
            accumulate::<K, D>(volume * relative, slopes, moments);
            bulk * relative
        };
        if let Some(dilations) = &mut part.dilations {
            let mut dilation = [Vector::zeros(); MOST];
            let dilation = &mut dilation[..slopes.len()];
            dilation
                .iter_mut()
                .zip(slopes)
                .for_each(|(of_node, slope)| *of_node = K::divergence(slope) * volume);
            let group = model.groups.of(points.material[p]);
            dilations.add(
                nodes,
                p,
                &Share {
                    group,
                    weight: volume,
                    bulk: raised,
                    dilation,
                    force: &[],
                },
            );
        }
    }
}

/// Returns V0 D_p of a yielding point, one unit gradient after the other, and its stiffness against dilation (Pa). If
/// dilation is `averaged`, the first excludes this stiffness.
#[inline]
fn of_point<K: Kinematics<D>, const D: usize>(
    stiffness: &Stiffness,
    volume: f64,
    averaged: bool,
) -> (GradientModuli<K, D>, f64) {
    let dilation = K::dilation().diagonal();
    let works = |stress: &Tensor| stress.diagonal().dot(&dilation);
    let bulk = stiffness.moduli::<SMatrix<f64, 1, 1>, 1>(|stress| SMatrix::from_element(works(stress)))[(0, 0)].x;
    let mut moduli = stiffness.moduli::<K::Gradient, D>(|stress| {
        let mean = if averaged { works(stress) } else { 0.0 };
        K::working(&(stress - Tensor::identity() * mean))
    });
    for (k, l) in (0..D).flat_map(|k| (0..K::Gradient::SLOPES).map(move |l| (k, l))) {
        moduli[(k, l)] *= volume;
    }
    (moduli, bulk)
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

/// Adds V0 grad N_a (x) grad N_b for a <= b to the moments. `volume` includes the stiffness relative to the material's.
fn accumulate<K: Kinematics<D>, const D: usize>(volume: f64, slopes: &[Slope<K, D>], moments: &mut [Moment<K, D>]) {
    let size = slopes.len();
    for a in 0..size {
        let weighted = slopes[a] * volume;
        for (moment, other) in moments[a * size + a..(a + 1) * size].iter_mut().zip(&slopes[a..]) {
            for j in 0..K::Gradient::SLOPES {
                for i in 0..K::Gradient::SLOPES {
                    moment[(i, j)] += weighted[i] * other[j];
                }
            }
        }
    }
}

/// Adds the elastic stiffness of node pairs a <= b.
fn add_elastic<K: Kinematics<D>, const D: usize>(moments: &[Moment<K, D>], moduli: Moduli, block: &mut [f64]) {
    let size = moments.len().isqrt();
    for a in 0..size {
        for b in a..size {
            let pair = K::stiffness(&moments[a * size + b], moduli);
            for i in 0..D {
                for j in 0..D {
                    block[(a * D + i) * size * D + b * D + j] += pair[(i, j)];
                }
            }
        }
    }
}

/// Completes a symmetric matrix of `order` rows whose node pairs a <= b are filled.
fn mirror(order: usize, block: &mut [f64]) {
    for row in 0..order {
        for column in 0..row {
            block[row * order + column] = block[column * order + row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::material::{Elastic, Material, MohrCoulomb};
    use crate::tensor::{Square, Symmetric};

    /// One unit gradient after the other, each turned into a stress by the three-dimensional moduli: averaged, without
    /// the part of its dilation, and without what the stress works on it.
    #[test]
    fn moduli_of_a_point_are_those_of_unit_gradients_averaged_or_not() {
        let law = MohrCoulomb::new(
            Elastic {
                young: 1e3,
                poisson: 0.3,
            },
            0.4,
            0.1,
            1.0,
        );
        let b = Symmetric([1.02, 0.96, 0.99, 0.015, 0.0, 0.0]);
        let stiffness = Material::MohrCoulomb(law)
            .respond(&b, &[])
            .unwrap()
            .yielding()
            .expect("it yields");
        let whole = stiffness.moduli::<Tensor, 3>(|stress| *stress);
        let apply = |l: &Tensor| -> Tensor { (0..9).map(|at| whole[(at / 3, at % 3)] * l[(at / 3, at % 3)]).sum() };
        let volume = 0.7;
        let dilation = <PlaneStrain as Kinematics<2>>::dilation();
        let expected_bulk = apply(&dilation).dot(&dilation);
        for averaged in [false, true] {
            let (moduli, bulk) = of_point::<PlaneStrain, 2>(&stiffness, volume, averaged);
            assert!((bulk - expected_bulk).abs() <= 1e-12 * expected_bulk);
            for (k, l) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let unit = Square::<2>::from_fn(|i, j| f64::from(u8::from((i, j) == (k, l))));
                let mut strain = PlaneStrain::gradient(&unit);
                if averaged {
                    strain -= dilation * strain.trace();
                }
                let mut stress = apply(&strain);
                if averaged {
                    stress -= Tensor::identity() * stress.dot(&dilation);
                }
                let expected = <PlaneStrain as Kinematics<2>>::working(&stress) * volume;
                assert!(
                    (moduli[(k, l)] - expected).amax() <= 1e-10 * 1e3,
                    "{averaged} {k}{l}: {expected}"
                );
            }
        }
    }
}
