//! Artificial elastic stiffness of all occupied cells, equation (T2.13) of the theory manual, because some splines
//! contain almost no material. It resists the displacement of a step or, in steady motion, the
//! change from the last step (T2.14).

mod form;
mod integrals;
mod tensor;

use super::{EquilibriumState, Interaction, InteractionReports, InteractionWork, StepContext, StepStart};
use crate::error::StepError;
use crate::exact::Exact;
use crate::grid::shape::Shape;
use crate::grid::{Contributions, Grid};
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::lanes::LANES;
use crate::material::LayeredMaterial;
use crate::nodal::Nodal;
use crate::points::Points;
use form::{CellForms, Forms};
use std::borrow::Cow;

/// Artificial stiffness of all occupied cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArtificialStiffness {
    /// Fraction c of the largest Young's modulus in the cell (-).
    pub coefficient: f64,
}

/// Results of the artificial stiffness in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArtificialStiffnessReport {
    /// Cells with the stiffness, over all ranks.
    pub cells: usize,
    /// Work (u - w) . B (u - w) on the stiffness, which does not resist the displacement w (J).
    pub work: f64,
    /// The larger of two sums of magnitudes: the works f_int u of all nodes and components, those of the stiffness
    /// included, and the works of the points' stresses (J).
    pub internal_work: f64,
    /// Largest force of the stiffness on a node divided by the RMS force of the nodes (-); `None` in steps with
    /// prescribed motion, and without forces.
    pub force_share: Option<f64>,
}

/// Displacement that the artificial stiffness resists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ResistedDisplacement {
    /// The whole displacement of the step.
    #[default]
    Whole,
    /// Its change from the last step, scaled to the length of this one, so that steady flow meets no force.
    Change,
}

/// Stiffness blocks of the artificial stiffness in one step, one per occupied cell.
#[derive(Clone, Debug)]
pub struct Blocks {
    cells: Vec<SoftCell>, // by patch
    forms: CellForms,
}

/// Artificial stiffness of a cell: `factor` times a geometric block.
#[derive(Clone, Copy, Debug)]
struct SoftCell {
    form: usize,
    factor: f64, // Pa, c E times the geometry weight
}

impl ArtificialStiffness {
    /// Computes the blocks of the occupied cells: c E times the integral of eps : eps, with the geometry weight at the
    /// cell's centre. E is the largest Young's modulus of the material points in the cell.
    pub fn blocks<K: Kinematics<D>, const D: usize>(
        &self,
        grid: &Grid<D>,
        shape: &Shape<D>,
        points: &Points<D>,
        materials: &[LayeredMaterial],
    ) -> Blocks {
        let mut forms = Forms::new(grid);
        let mut cells = Vec::with_capacity(shape.patches().len());
        for patch in shape.patches() {
            let cell = grid.cell_at(patch.cell);
            let (lower, size) = grid.cell_box(&cell);
            let points = patch
                .points
                .clone()
                .map(|p| (usize::from(points.material[p]), points.height(p)));
            let young = points.map(|(material, height)| materials[material].young_at(height));
            let modulus = young.fold(0.0, f64::max);
            let factor = self.coefficient * modulus * K::weight(&(lower + size * 0.5));
            cells.push(SoftCell {
                form: forms.of(&cell),
                factor,
            });
        }
        Blocks {
            cells,
            forms: forms.found,
        }
    }
}

/// Largest number of nodes of a cell: (3 + 1)^3.
const MOST_NODES: usize = 64;

impl Blocks {
    /// Adds B u to `f`, D numbers per node.
    pub fn multiply<const D: usize>(&self, shape: &Shape<D>, u: &[f64], f: &mut Contributions) {
        self.each_product::<D>(shape, u, |first, _, forces| {
            let f = f.patch(first);
            for (force, offset) in forces.iter().zip(shape.offsets()) {
                (0..D).for_each(|i| f[Nodal::<D>::at(*offset, i)] += force[i]);
            }
        });
    }

    /// Returns u . B u of this rank's cells (N m): the work that the stiffness absorbs.
    pub fn work<const D: usize>(&self, shape: &Shape<D>, u: &[f64]) -> Exact {
        let mut works: Vec<f64> = Vec::with_capacity(self.cells.len());
        self.each_product::<D>(shape, u, |_, u, forces| {
            let terms = u
                .iter()
                .zip(forces)
                .map(|(u, force)| (0..D).map(|i| u[i] * force[i]).sum::<f64>());
            works.push(terms.sum());
        });
        works.into_iter().collect()
    }

    /// Calls `product` for every cell with its first node, its nodal values of `u` and their product with its block.
    fn each_product<const D: usize>(
        &self,
        shape: &Shape<D>,
        u: &[f64],
        mut product: impl FnMut(usize, &[[f64; D]], &[[f64; D]]),
    ) {
        let size = shape.offsets().len();
        let mut u_of = [[0.0; D]; LANES * MOST_NODES];
        let mut forces = [[0.0; D]; LANES * MOST_NODES];
        for (cells, patches) in self.cells.chunks(LANES).zip(shape.patches().chunks(LANES)) {
            for (patch, own) in patches.iter().zip(u_of.chunks_exact_mut(size)) {
                for (at_node, offset) in own.iter_mut().zip(shape.offsets()) {
                    at_node.copy_from_slice(&u[Nodal::<D>::of(patch.first_node + offset)]);
                }
            }
            let numbers = cells.iter().map(|soft| soft.form);
            self.forms.multiply(numbers, &u_of, &mut forces[..cells.len() * size]);
            let products = u_of.chunks(size).zip(forces.chunks_mut(size));
            for ((soft, patch), (own, forces)) in cells.iter().zip(patches).zip(products) {
                forces
                    .as_flattened_mut()
                    .iter_mut()
                    .for_each(|force| *force *= soft.factor);
                product(patch.first_node, own, forces);
            }
        }
    }

    /// Returns the number of occupied cells of this rank.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// Adds the block of a cell, by index `patch`, to `block`.
    pub fn add_to(&self, patch: usize, block: &mut [f64]) {
        let soft = self.cells[patch];
        self.forms.add_to(soft.form, soft.factor, block);
    }
}

/// Artificial stiffness of one step.
#[derive(Debug)]
struct AppliedStiffness {
    blocks: Blocks,
    resisted: ResistedDisplacement,
    /// Part of the step's displacement that the stiffness does not resist (m), D numbers per node; `None`: it resists
    /// all.
    unresisted: Option<Vec<f64>>,
    /// Whether the step has prescribed motion.
    is_driven: bool,
}

/// Begins the artificial stiffness of a step, if the model has one.
pub fn begin<K: Kinematics<D>, const D: usize>(start: &StepStart<'_, K, D>) -> Option<Box<dyn Interaction<D>>> {
    let model = start.model;
    let soft = model.artificial_stiffness?;
    Some(Box::new(AppliedStiffness {
        blocks: soft.blocks::<K, D>(&model.grid, start.shape, start.points, &model.materials),
        resisted: start.input.resisted,
        unresisted: None,
        is_driven: model
            .boundary
            .moves(start.input.interval.start, start.input.interval.dt),
    }))
}

impl AppliedStiffness {
    /// Returns the part of a nodal displacement that the stiffness resists (m).
    fn resisted<'a>(&self, u: &'a [f64]) -> Cow<'a, [f64]> {
        match &self.unresisted {
            Some(unresisted) => u.iter().zip(unresisted).map(|(u, unresisted)| u - unresisted).collect(),
            None => Cow::Borrowed(u),
        }
    }

    /// Returns the force on the nodes under the displacement `u` (N), this rank's contributions only.
    fn force<const D: usize>(&self, context: &StepContext<'_, D>, u: &[f64]) -> Contributions {
        let mut force = Contributions::none(context.grid, D, Vec::new());
        self.blocks.multiply::<D>(context.shape, &self.resisted(u), &mut force);
        force
    }

    /// Returns the largest force of the stiffness on a free node of all ranks, divided by the RMS force of the active
    /// nodes (-). A spline without other stiffness creeps under this force. `None` without forces.
    ///
    /// One exchange with the neighbours, one reduction, and one gather if ties are published.
    fn share<const D: usize>(&self, context: &StepContext<'_, D>, at: &EquilibriumState<'_>) -> Option<f64> {
        let mut force = context.halo.assemble_ghosts(&self.force(context, at.u));
        context.constraints.reduce(&mut [&mut force], context.halo);
        let sizes = context.halo.owned().nodes().map(|node| {
            let free = Nodal::<D>::of(node).filter(|&at| context.constraints.free[at]);
            free.map(|at| force[at].powi(2)).sum::<f64>().sqrt()
        });
        let mut largest = [sizes.fold(0.0, f64::max)];
        context.halo.all_reduce_max(&mut largest);
        let mean = at.scale / (context.constraints.active_nodes.max(1) as f64).sqrt();
        (mean > 0.0).then(|| largest[0] / mean)
    }
}

impl<const D: usize> Interaction<D> for AppliedStiffness {
    /// Limits the resistance to the difference from the displacement `last`, if only changes are resisted. In `last`,
    /// outer splines take the values that their homes imply, because their own have next to no stiffness.
    fn note_unknowns(&mut self, context: &StepContext<'_, D>, last: &[f64]) {
        if self.resisted == ResistedDisplacement::Whole {
            return;
        }
        let mut unresisted = last.to_vec();
        let inactive = context
            .constraints
            .active
            .iter()
            .enumerate()
            .filter(|(_, active)| !**active);
        inactive.for_each(|(node, _)| unresisted[Nodal::<D>::of(node)].fill(0.0));
        if let Some(extension) = &context.constraints.extension {
            extension.drop_loose(&mut unresisted);
            extension.extend(context.grid, &mut unresisted, context.halo);
        }
        self.unresisted = Some(unresisted);
    }

    fn needs_internal_work(&self) -> bool {
        true
    }

    fn add_internal_force(&self, context: &StepContext<'_, D>, u: &[f64], out: &mut Contributions) {
        self.blocks.multiply::<D>(context.shape, &self.resisted(u), out);
    }

    fn add_product(&self, context: &StepContext<'_, D>, v: &[f64], out: &mut Contributions) {
        self.blocks.multiply::<D>(context.shape, v, out);
    }

    fn add_to_cell(&self, number: usize, block: &mut [f64]) {
        self.blocks.add_to(number, block);
    }

    fn add_work(&self, context: &StepContext<'_, D>, at: &EquilibriumState<'_>, work: &mut InteractionWork) {
        work.artificial_stiffness += &self.force(context, at.u).dot(at.u);
    }

    fn finish(
        &self,
        context: &StepContext<'_, D>,
        at: &EquilibriumState<'_>,
        _after: &mut InteractionState<D>,
        reports: &mut InteractionReports,
    ) -> Result<(), StepError> {
        let work = self.blocks.work::<D>(context.shape, &self.resisted(at.u));
        let mut cells = [self.blocks.count() as f64];
        context.halo.all_reduce_sum(&mut cells);
        reports.artificial_stiffness = Some(ArtificialStiffnessReport {
            cells: cells[0] as usize,
            work: context.halo.reproducible_sum(&[work])[0],
            internal_work: at.internal_work,
            force_share: (!self.is_driven).then(|| self.share(context, at)).flatten(),
        });
        Ok(())
    }
}
